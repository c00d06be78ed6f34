"""The order of the transition: jumps, loops, and distributions with two peaks."""

from __future__ import annotations


import numpy.typing as npt

from .. import _core
from .._arrays import Array
from ._columns import Numbers, columns, outcomes, pair, reals, resampling, result
from ._results import DipTest, FractionCrossing, Hysteresis, Jump, TwoPeaks, Uncertain


def fraction_crossing(width: Numbers, jammed: npt.ArrayLike) -> FractionCrossing:
    """Width at which the fraction of jammed runs falls through one half; one row per run.

    By maximum likelihood of a logistic curve in w; where the runs are separated, the bracket that they leave.

    Parameters
    ----------
    width : array_like
        w of each run, shape (runs,).
    jammed : array_like of bool
        Whether it ended jammed.

    Returns
    -------
    FractionCrossing
        The width, in the unit of `width`.

    Raises
    ------
    AnalysisError
        Where all runs have one outcome, or one is missing.
    ValueError
        For columns of unequal length.

    Notes
    -----
    Where all runs jam up to one width and none from the next on, the width is the middle of that bracket. The interval of
    95 per cent holds the bracket, and what the likelihood does not exclude: with one or two runs a width more than the bracket.
    Cox & Snell, Analysis of Binary Data (1989), chapter 2; Albert & Anderson, Biometrika 71, 1 (1984).

    Examples
    --------
    >>> import numpy as np
    >>> from peristalsis import analysis
    >>> width = np.repeat(np.linspace(2.5, 2.9, 9), 4)
    >>> found = analysis.fraction_crossing(width, width < 2.66)
    >>> round(found.last_all, 2), round(found.first_none, 2), found.is_separated
    (2.65, 2.7, True)
    """
    return result(FractionCrossing, _core.fraction_crossing(outcomes("width", width, "jammed", jammed)))


def hysteresis(
    rest_width: Numbers,
    rest_jammed: npt.ArrayLike,
    jammed_width: Numbers,
    jammed_jammed: npt.ArrayLike,
) -> Hysteresis:
    """Whether runs from rest and runs from jammed flow part at different widths, and by how much; one row per run.

    The loop is w_c' - w_c, each the `fraction_crossing` of one start; it narrows with the time that runs are watched.

    Parameters
    ----------
    rest_width, jammed_width : array_like
        w of the runs from rest, and of those from jammed flow.
    rest_jammed, jammed_jammed : array_like of bool
        Whether they ended jammed.

    Returns
    -------
    Hysteresis
        The loop, and the probability of so wide a one by chance.

    Raises
    ------
    AnalysisError
        Where all runs of a start have one outcome, or one is missing.
    ValueError
        For columns of unequal length.

    Notes
    -----
    The interval combines both: Zou & Donner, Stat. Med. 27, 1693 (2008).

    Examples
    --------
    >>> import numpy as np
    >>> from peristalsis import analysis
    >>> width = np.repeat(np.linspace(2.5, 2.9, 9), 4)
    >>> loop = analysis.hysteresis(width, width < 2.66, width, width < 2.81)
    >>> round(loop.loop_width.value, 2)
    0.15
    """
    rest = outcomes("rest_width", rest_width, "rest_jammed", rest_jammed)
    jammed = outcomes("jammed_width", jammed_width, "jammed_jammed", jammed_jammed)
    return result(Hysteresis, _core.hysteresis(rest, jammed))


def jump_height(
    upper: tuple[Numbers, Numbers, Numbers],
    lower: tuple[Numbers, Numbers, Numbers],
    critical_width: Uncertain | float | tuple[float, float],
) -> Jump:
    """The two branches of a flow rate, carried on to the critical width as straight lines, and their difference.

    error^2 = error_upper^2 + error_lower^2 + (slope_upper - slope_lower)^2 error_w^2.

    Parameters
    ----------
    upper, lower : tuple of array_like
        Widths, values and errors of the jammed branch (w < w_c), and of the other.
    critical_width : Uncertain, float or pair
        w_c, with its error as a pair or an `Uncertain`.

    Returns
    -------
    Jump
        In the unit of the values.

    Raises
    ------
    AnalysisError
        For a branch without points, or an error that is not positive.
    ValueError
        For columns of unequal length.

    Examples
    --------
    >>> from peristalsis import analysis
    >>> upper, lower = ([2.6, 2.7], [1.0, 0.9], [0.01, 0.01]), ([2.9], [0.2], [0.03])
    >>> jump = analysis.jump_height(upper, lower, 2.8)
    >>> round(jump.upper.value, 3), round(jump.height.value, 3)
    (0.8, 0.6)
    """
    above, below = _branch("upper", upper), _branch("lower", lower)
    return result(Jump, _core.jump_height(above, below, pair("critical_width", critical_width)))


def _branch(name: str, given: tuple[Numbers, Numbers, Numbers]) -> list[Array]:
    """The columns of a branch."""
    names = [f"{name} {column}" for column in ("widths", "values", "errors")]
    if len(given) != len(names):
        raise ValueError(f"{name} is three columns, widths, values and errors, not {len(given)}")
    return columns(names[2:], **dict(zip(names, given, strict=True)))


def dip_test(values: Numbers, *, resamples: int = 1000, seed: int = 0) -> DipTest:
    """Hartigan's dip test: whether a sample has more than one peak.

    dip = the least sup |F_n(x) - F(x)| over distributions F with a single peak.

    Parameters
    ----------
    values : array_like
        Independent values, one a run, shape (n,).
    resamples : int
        Simulated samples for the probability, 20 at least.
    seed : int
        Of these.

    Returns
    -------
    DipTest
        The dip and its probability with a single peak.

    Raises
    ------
    AnalysisError
        Below 4 values, or for values that are not finite.

    Notes
    -----
    Values that are rounded to a tenth of their range look like several peaks: 12 to 31 per cent of 10 to 30 uniform ones, not 5.
    Hartigan & Hartigan, Ann. Stat. 13, 70 (1985).

    Examples
    --------
    >>> import numpy as np
    >>> from peristalsis import analysis
    >>> apart = np.append(np.linspace(0, 1, 50), np.linspace(8, 9, 50))
    >>> analysis.dip_test(apart, resamples=200).probability < 0.01
    True
    """
    return result(DipTest, _core.dip_test(reals("values", values), *resampling(resamples, seed)))


def two_peaks(values: Numbers) -> TwoPeaks:
    """A mixture of two normal distributions against a single one.

    f(x) = p N(x; m_1, s_1) + (1 - p) N(x; m_2, s_2); read the gain beside the separation and the `dip_test`.

    Parameters
    ----------
    values : array_like
        Independent values, one a run, shape (n,).

    Returns
    -------
    TwoPeaks
        Both peaks, and what Schwarz's criterion says for two.

    Raises
    ------
    AnalysisError
        Below 8 values, for values that are not finite, and for equal ones.

    Notes
    -----
    For 8 or 10 values of one peak the gain is positive in a quarter of the cases or more. Dempster, Laird & Rubin, J. R. Stat.
    Soc. B 39, 1 (1977); Hathaway, Ann. Stat. 13, 795 (1985); Schwarz, Ann. Stat. 6, 461 (1978).

    Examples
    --------
    >>> import numpy as np
    >>> from peristalsis import analysis
    >>> apart = np.append(np.linspace(0, 1, 50), np.linspace(8, 9, 50))
    >>> peaks = analysis.two_peaks(apart)
    >>> round(peaks.lower.mean, 2), peaks.separation > 2
    (0.5, True)
    """
    return result(TwoPeaks, _core.two_peaks(reals("values", values)))
