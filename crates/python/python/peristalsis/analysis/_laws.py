"""Laws of how a quantity grows with a width, fitted to values or to the runs themselves."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy.typing as npt

from .. import _core
from ._columns import Numbers, law_of, result, run_table
from ._results import LawRunsFit, ScatterLawFit, WidthEnsemble, WindowRunsFit

if TYPE_CHECKING:
    from ._columns import _Family, _Law


def fit_law_to_runs(
    law: _Law,
    width: Numbers,
    time: Numbers,
    observed: npt.ArrayLike | None = None,
    *,
    family: _Family = "gamma",
) -> LawRunsFit:
    """A law of the mean transition time, by the likelihood of every single run, the censored ones included.

    ln L = sum of ln f(t_i; tau(w_i), k) over transitions + sum of ln S(t_i; tau(w_i), k) over censored runs.

    Parameters
    ----------
    law : str or mapping
        ``"power"``: tau = A (w_c - w)^-B; ``"exponential"``: tau = A exp(B w);
        ``{"barrier": {"power": p}}``: tau = A exp(B/(w_c - w)^p).
    width : array_like
        w of each run, shape (runs,).
    time : array_like
        Its transition time; without one, the time up to which it was watched (column `watched`).
    observed : array_like of bool, optional
        Whether there was a transition; all, by default.
    family : {"gamma", "exponential", "weibull"}
        Distribution of the times about their mean.

    Returns
    -------
    LawRunsFit
        Critical width, exponent and the shape k common to all widths.

    Raises
    ------
    AnalysisError
        Where fewer widths saw a transition than the law has parameters, or the likelihood has no maximum.
    ValueError
        For columns of unequal length.

    Notes
    -----
    Kalbfleisch & Prentice, The Statistical Analysis of Failure Time Data (2002), chapter 3; the intervals: Venzon &
    Moolgavkar, Appl. Stat. 37, 87 (1988).

    Examples
    --------
    >>> import numpy as np
    >>> from peristalsis import analysis
    >>> width = np.repeat([2.4, 2.5, 2.6, 2.7], 30)
    >>> time = np.random.default_rng(1).exponential(2.0 / (2.8 - width))
    >>> fit = analysis.fit_law_to_runs("power", width, time, family="exponential")
    >>> fit.observed, fit.exponent.interval_95.lower < 1.0 < fit.exponent.interval_95.upper
    (120, True)
    """
    table = run_table(width, time, observed)
    return result(LawRunsFit, _core.fit_law_to_runs(law_of(law), family, table))


def fit_law_to_runs_in_windows(
    law: _Law,
    width: Numbers,
    time: Numbers,
    observed: npt.ArrayLike | None = None,
    *,
    family: _Family = "gamma",
) -> list[WindowRunsFit]:
    """`fit_law_to_runs` in windows that leave out the smallest, then the largest widths one by one.

    The first window holds all widths. An exponent that is one moves by no more than its error from window to window.

    Parameters
    ----------
    law : str or mapping
        ``"power"``: tau = A (w_c - w)^-B; ``"exponential"``: tau = A exp(B w);
        ``{"barrier": {"power": p}}``: tau = A exp(B/(w_c - w)^p).
    width : array_like
        w of each run, shape (runs,).
    time : array_like
        Its transition time; without one, the time up to which it was watched (column `watched`).
    observed : array_like of bool, optional
        Whether there was a transition; all, by default.
    family : {"gamma", "exponential", "weibull"}
        Distribution of the times about their mean.

    Returns
    -------
    list of WindowRunsFit
        Windows without a fit are left out; the fits share their runs.

    Raises
    ------
    AnalysisError
        Where fewer widths saw a transition than the law has parameters, or the likelihood has no maximum.
    ValueError
        For columns of unequal length.

    Examples
    --------
    >>> import numpy as np
    >>> from peristalsis import analysis
    >>> width = np.repeat([2.4, 2.5, 2.6, 2.7], 30)
    >>> time = np.random.default_rng(1).exponential(2.0 / (2.8 - width))
    >>> windows = analysis.fit_law_to_runs_in_windows("exponential", width, time, family="exponential")
    >>> windows[0].least, windows[0].largest, windows[0].fit.observed
    (2.4, 2.7, 120)
    """
    table = run_table(width, time, observed)
    answers = _core.fit_law_to_runs_in_windows(law_of(law), family, table)
    return [result(WindowRunsFit, answer) for answer in answers]


def fit_law_with_scatter(
    width: Numbers, time: Numbers, observed: npt.ArrayLike | None = None
) -> ScatterLawFit:
    """Power laws of the mean transition time and of its relative variance at once, censored runs included.

    tau = A (w_c - w)^-alpha and chi_tau/tau^2 = C (w_c - w)^-q, gamma distributions of shape tau^2/chi_tau; so
    chi_tau ~ (w_c - w)^-(2 alpha + q).

    Parameters
    ----------
    width : array_like
        w of each run, shape (runs,).
    time : array_like
        Its transition time; without one, the time up to which it was watched (column `watched`).
    observed : array_like of bool, optional
        Whether there was a transition; all, by default.

    Returns
    -------
    ScatterLawFit
        w_c, alpha, q, and how probable simpler laws of the scatter are.

    Raises
    ------
    AnalysisError
        Where fewer than three widths saw a transition, or the likelihood has no maximum.
    ValueError
        For columns of unequal length.

    Notes
    -----
    Kalbfleisch & Prentice, The Statistical Analysis of Failure Time Data (2002), chapter 3.

    Examples
    --------
    >>> import numpy as np
    >>> from peristalsis import analysis
    >>> width = np.repeat([2.4, 2.5, 2.6, 2.7], 30)
    >>> time = np.random.default_rng(1).exponential(2.0 / (2.8 - width))
    >>> fit = analysis.fit_law_with_scatter(width, time)
    >>> fit.observed, fit.chance_probability > 0.01
    (120, True)
    """
    table = run_table(width, time, observed)
    return result(ScatterLawFit, _core.fit_law_with_scatter(table))


def ensembles_by_width(
    width: Numbers,
    time: Numbers,
    observed: npt.ArrayLike | None = None,
    *,
    family: _Family = "gamma",
) -> list[WidthEnsemble]:
    """Transition times of a table of runs, one row per run, estimated width by width in three ways.

    Mean and variance chi_tau with errors for `fit_law` are those of each answer's `fit`.

    Parameters
    ----------
    width : array_like
        w of each run, shape (runs,).
    time : array_like
        Its transition time; without one, the time up to which it was watched (column `watched`).
    observed : array_like of bool, optional
        Whether there was a transition; all, by default.
    family : {"gamma", "exponential", "weibull"}
        Distribution of the times about their mean.

    Returns
    -------
    list of WidthEnsemble
        In order of width.

    Raises
    ------
    AnalysisError
        For values that are not finite, or times that are negative.
    ValueError
        For columns of unequal length.

    Examples
    --------
    >>> import numpy as np
    >>> from peristalsis import analysis
    >>> width = np.repeat([2.4, 2.5, 2.6, 2.7], 30)
    >>> time = np.random.default_rng(1).exponential(2.0 / (2.8 - width))
    >>> ensembles = analysis.ensembles_by_width(width, time)
    >>> [(ensemble.width, ensemble.observed) for ensemble in ensembles][:2]
    [(2.4, 30), (2.5, 30)]
    """
    table = run_table(width, time, observed)
    answers = _core.ensembles_by_width(family, table)
    return [result(WidthEnsemble, answer) for answer in answers]
