"""Laws, straight lines and parabolas through points with errors."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .. import _core
from ._columns import Numbers, columns, law_of, pair, reals, refuse, result
from ._results import CurveFit, LawFit, LineFit, NearestFit, ScatteredLine, Uncertain

if TYPE_CHECKING:
    from ._columns import _Law


def fit_law(
    law: _Law,
    width: Numbers,
    value: Numbers,
    error: Numbers,
    *,
    critical_width: Uncertain | float | tuple[float, float] | None = None,
) -> LawFit:
    """A law of divergence through values with errors at several widths.

    The least sum of (ln y_i - ln A - B x(w_i))^2 y_i^2/error_i^2 over ln A, B and w_c.

    Parameters
    ----------
    law : str or mapping
        ``"power"``: y = A (w_c - w)^-B; ``"exponential"``: y = A exp(B w);
        ``{"barrier": {"power": p}}``: y = A exp(B/(w_c - w)^p).
    width, value, error : array_like
        w, y and its standard error, shape (n,).
    critical_width : optional
        w_c where it is known: a number, with its error as a pair or an `Uncertain`.

    Returns
    -------
    LawFit
        Critical width in the unit of `width`, exponent and amplitude.

    Raises
    ------
    AnalysisError
        Where there are fewer points than parameters, or a value or error is not positive.
    ValueError
        For columns of unequal length.

    Notes
    -----
    Errors of some 20 per cent or more bias ln y: prefer `fit_law_to_runs` where the runs are at hand. Seber & Wild,
    Nonlinear Regression (1989), sections 5.4 and 14.7.

    Examples
    --------
    >>> import numpy as np
    >>> from peristalsis import analysis
    >>> width = np.linspace(2.4, 2.7, 8)
    >>> time = 3.0 * (2.8 - width) ** -1.5
    >>> fit = analysis.fit_law("power", width, time, 0.01 * time)
    >>> round(fit.critical_width.value, 3), round(fit.exponent.value, 3), fit.degrees_of_freedom
    (2.8, 1.5, 5)
    """
    known = None if critical_width is None else pair("critical_width", critical_width)
    widths, values, errors = columns(("value", "error"), width=width, value=value, error=error)
    return result(LawFit, _core.fit_law(law_of(law), widths, values, errors, known))


def fit_law_to_nearest(
    law: _Law,
    width: Numbers,
    value: Numbers,
    error: Numbers,
    *,
    critical_width: Uncertain | float | tuple[float, float] | None = None,
) -> list[NearestFit]:
    """A law of divergence through the values at the k largest widths, for every k: the exponent against the window.

    An exponent that moves with the window by more than its error describes the window, not w_c. The fits
    share their values and do not scatter independently.

    Parameters
    ----------
    law, width, value, error, critical_width
        As of `fit_law`.

    Returns
    -------
    list of NearestFit
        From one width more than the law has free parameters up to all; windows without a fit are left out.

    Raises
    ------
    AnalysisError, ValueError
        As of `fit_law` for all values.

    Examples
    --------
    1/tau = d + d^2 with d = 3 - w: the exponent goes to 1 as the window closes.

    >>> import numpy as np
    >>> from peristalsis import analysis
    >>> d = np.array([1, 0.5, 0.25, 0.125, 0.0625, 0.03125])
    >>> time = 1 / (d + d**2)
    >>> fits = analysis.fit_law_to_nearest("power", 3 - d, time, 0.01 * time)
    >>> [(one.widths, round(one.fit.exponent.value, 2)) for one in fits]
    [(4, 1.18), (5, 1.25), (6, 1.34)]
    """
    known = None if critical_width is None else pair("critical_width", critical_width)
    widths, values, errors = columns(("value", "error"), width=width, value=value, error=error)
    answers = _core.fit_law_to_nearest(law_of(law), widths, values, errors, known)
    return [result(NearestFit, answer) for answer in answers]


def fit_line(x: Numbers, y: Numbers, error: Numbers) -> LineFit:
    """A straight line through points with errors: the least sum of (y - a - b x)^2/error^2.

    Parameters
    ----------
    x, y, error : array_like
        Abscissae, ordinates and their standard errors, shape (n,).

    Returns
    -------
    LineFit
        Intercept and slope, in the units of y and of y/x.

    Raises
    ------
    AnalysisError
        Below 2 points, or for an error that is not positive.
    ValueError
        For columns of unequal length.

    Notes
    -----
    Weights 1/error^2: Bevington & Robinson, Data Reduction and Error Analysis (2003), chapter 6.

    Examples
    --------
    >>> from peristalsis import analysis
    >>> fit = analysis.fit_line([0, 1, 2], [1, 3, 5], [0.1, 0.1, 0.1])
    >>> round(fit.intercept.value, 6), round(fit.slope.value, 6), fit.degrees_of_freedom
    (1.0, 2.0, 1)
    """
    return result(LineFit, _core.fit_line(*columns(("error",), x=x, y=y, error=error)))


def fit_parabola(x: Numbers, y: Numbers, error: Numbers) -> CurveFit:
    """A parabola through points with errors, beside the straight line.

    Parameters
    ----------
    x, y, error : array_like
        Abscissae, ordinates and their standard errors, shape (n,).

    Returns
    -------
    CurveFit
        Its coefficients, and the probability of its bend if the points lie on a line.

    Raises
    ------
    AnalysisError
        Below 3 points, or for an error that is not positive.
    ValueError
        For columns of unequal length.

    Examples
    --------
    >>> from peristalsis import analysis
    >>> fit = analysis.fit_parabola([0, 1, 2, 3], [1, 2, 5, 10], [0.1] * 4)
    >>> round(fit.quadratic.value, 6), fit.linearity < 0.01
    (1.0, True)
    """
    return result(CurveFit, _core.fit_parabola(*columns(("error",), x=x, y=y, error=error)))


def fit_line_to_scatter(x: Numbers, y: Numbers, error: Numbers | None = None) -> ScatteredLine:
    """A straight line through points that scatter by more than their errors, or whose errors are unknown.

    Each point gets the error (error_i^2 + s^2)^(1/2), with the scatter s at which chi^2 about the line is n - 2, or 0 where
    the errors suffice. Intercept and slope follow Student's distribution of n - 2 degrees of freedom.

    Parameters
    ----------
    x, y : array_like
        Abscissae and ordinates, shape (n,).
    error : array_like, optional
        Standard errors of y, 0 or more, shape (n,). Without them all points weigh alike, as one draws a line through them.

    Returns
    -------
    ScatteredLine
        The line, the part of the variance that it explains, and whether the points bend.

    Raises
    ------
    AnalysisError
        Below 3 distinct abscissae, for an error below 0.
    ValueError
        For columns of unequal length.

    Notes
    -----
    Paule & Mandel, J. Res. Natl. Bur. Stand. 87, 377 (1982); Bevington & Robinson, Data Reduction and Error Analysis (2003),
    chapters 6 and 11.

    Examples
    --------
    >>> from peristalsis import analysis
    >>> fit = analysis.fit_line_to_scatter([0, 1, 2, 3], [0.1, 0.9, 2.1, 2.9])
    >>> print(fit.line.slope)
    0.96 +- 0.057
    """
    x, y, errors = columns(x=x, y=y, error=[0.0] * len(reals("y", y)) if error is None else error)
    refuse("error", errors, errors < 0.0, "but must not be negative")
    return result(ScatteredLine, _core.fit_line_to_scatter(x, y, errors))


def power_exponent(x: Numbers, y: Numbers, error: Numbers) -> LineFit:
    """A power law y = A x^B through positive points with errors: the line through their logarithms, its slope B.

    Parameters
    ----------
    x, y, error : array_like
        Abscissae, ordinates and their standard errors, shape (n,).

    Returns
    -------
    LineFit
        Intercept ln A and slope B.

    Raises
    ------
    AnalysisError
        Below 2 points, or for an abscissa, ordinate or error that is not positive.
    ValueError
        For columns of unequal length.

    Examples
    --------
    >>> from peristalsis import analysis
    >>> round(analysis.power_exponent([1, 2, 4], [1, 8, 64], [0.1, 0.8, 6.4]).slope.value, 6)
    3.0
    """
    return result(LineFit, _core.power_exponent(*columns(("x", "y", "error"), x=x, y=y, error=error)))
