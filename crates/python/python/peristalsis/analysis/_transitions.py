"""Transition times of one ensemble, those of runs that ended before included."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np
import numpy.typing as npt

from .. import _core
from .._arrays import Array
from .._core import AnalysisError
from .._given import number, numeric
from ._columns import Numbers, reals, result, runs
from ._results import LifetimeFit, RestrictedMoments, ShiftedExponentialFit, SurvivalStep, Uncertain

if TYPE_CHECKING:
    from ._columns import _Family


@dataclass(frozen=True)
class TransitionTime:
    """When a run changed, or how long it was watched without.

    Attributes
    ----------
    time : float
        tau, or the time up to which the run was watched: 2.5 periods before its end, for a later crossing is not confirmed.
    observed : bool
        Whether there was a transition.

    Examples
    --------
    >>> from peristalsis import analysis
    >>> analysis.TransitionTime(time=20.0, observed=True).observed
    True
    """

    time: float
    observed: bool


class Survival:
    """Part of the runs without a transition yet (Kaplan & Meier), from times some of which are censored.

    S(t) = product over transition times t_i <= t of (1 - d_i/n_i): d_i transitions among n_i runs still at risk.

    Parameters
    ----------
    time : array_like
        Transition times; without one, the times up to which runs were watched (column `watched`), shape (runs,).
    observed : array_like of bool, optional
        Whether there was a transition; all, by default.

    Attributes
    ----------
    steps : tuple of SurvivalStep
        The curve, one step a transition time.
    runs, observed : int
        Runs, and those with a transition.
    watched : float
        Longest time that a run was watched.

    Raises
    ------
    AnalysisError
        For times that are negative or not finite, and where an outcome is missing.

    Examples
    --------
    >>> from peristalsis import analysis
    >>> curve = analysis.Survival([1.0, 2.0, 3.0, 4.0], [True, False, True, True])
    >>> curve.at([0.5, 2.5, 3.5]).tolist()
    [1.0, 0.75, 0.375]
    """

    steps: tuple[SurvivalStep, ...]
    runs: int
    observed: int
    watched: float

    def __init__(self, time: Numbers, observed: npt.ArrayLike | None = None) -> None:
        self._runs = runs(time, observed, at_once=True)
        answer = _core.survival(self._runs)
        self.steps = tuple(result(SurvivalStep, step) for step in answer["steps"])
        self.runs = answer["runs"]
        self.observed = answer["observed"]
        self.watched = answer["watched"]

    def at(self, time: Numbers) -> Array:
        """Survival at times; 1 before the first transition.

        Parameters
        ----------
        time : array_like
            Any times, of any shape.

        Returns
        -------
        ndarray
            S, of the shape of `time`; NaN where that is NaN.

        Examples
        --------
        >>> from peristalsis import analysis
        >>> analysis.Survival([1.0, 2.0]).at([0.0, 1.5]).tolist()
        [1.0, 0.5]
        """
        numeric("time", time, AnalysisError)
        asked = np.asarray(time, dtype=np.float64)
        times = np.array([step.time for step in self.steps])
        levels = np.array([1.0, *(step.survival.value for step in self.steps)])
        return np.where(np.isnan(asked), np.nan, levels[np.searchsorted(times, asked, side="right")])

    @property
    def median(self) -> Uncertain:
        """Median transition time, in the unit of the times.

        Raises
        ------
        AnalysisError
            Where the survival does not fall to 1/2.

        Examples
        --------
        >>> from peristalsis import analysis
        >>> analysis.Survival([1.0, 2.0, 3.0]).median.value
        2.0
        """
        return result(Uncertain, _core.survival_median(self._runs))

    def restricted_moments(self, horizon: float) -> RestrictedMoments:
        """Mean and variance of min(tau, horizon), without assuming a distribution.

        Parameters
        ----------
        horizon : float
            Time at which every longer time is cut off, at most the longest time watched.

        Returns
        -------
        RestrictedMoments
            In the unit of the times.

        Raises
        ------
        AnalysisError
            Below 3 transitions, or for a horizon beyond the time watched, unless the curve has come to 0 by then.

        Examples
        --------
        >>> from peristalsis import analysis
        >>> analysis.Survival([1.0, 2.0, 3.0]).restricted_moments(2.5).mean.value
        1.8333333333333335
        """
        return result(RestrictedMoments, _core.restricted_moments(self._runs, number("horizon", horizon)))

    def __repr__(self) -> str:
        return f"<Survival: {self.observed} transitions in {self.runs} runs, watched up to {self.watched:g}>"


def transition_time(
    averages: Numbers,
    *,
    direction: Literal["upward", "downward"] = "upward",
    threshold: float = 0.5,
    period_duration: float = 1.0,
) -> TransitionTime:
    """Time at which the line through period averages crosses a threshold for good: three whole periods beyond it.

    Each average stands at the middle of its period. The line begins at time 0 with J/Jmax of the initial state: 0 upward, 1
    downward. If that lies beyond the threshold already, the line crosses it at time 0.

    Parameters
    ----------
    averages : array_like
        Average over each whole period since the start, such as J/Jmax.
    direction : {"upward", "downward"}
        From rest, or from jammed flow.
    threshold : float
        Value that is crossed.
    period_duration : float
        T; the answer is in its unit.

    Returns
    -------
    TransitionTime
        tau, or how long the series was watched where there was no transition.

    Raises
    ------
    AnalysisError
        For averages that are not finite.

    Examples
    --------
    >>> from peristalsis import analysis
    >>> analysis.transition_time([0.1, 0.1, 0.9, 0.9, 0.9, 0.9], period_duration=10.0)
    TransitionTime(time=20.0, observed=True)
    """
    if direction not in ("upward", "downward"):
        raise AnalysisError(f'direction is "upward" or "downward", not {direction!r}')
    level, period = number("threshold", threshold), number("period_duration", period_duration)
    return TransitionTime(*_core.transition_time(reals("averages", averages), direction, level, period))


def restricted_moments(
    time: Numbers, observed: npt.ArrayLike | None = None, *, horizon: float
) -> RestrictedMoments:
    """Mean and variance of min(tau, horizon), censoring accounted for.

    <tau> = integral of S(t) from 0 to the horizon, S the survival of Kaplan & Meier: no distribution is assumed.

    Parameters
    ----------
    time : array_like
        Transition times; without one, the times up to which runs were watched (column `watched`), shape (runs,).
    observed : array_like of bool, optional
        Whether there was a transition; all, by default.
    horizon : float
        Time at which every longer time is cut off.

    Returns
    -------
    RestrictedMoments
        In the unit of the times.

    Raises
    ------
    AnalysisError
        Below 3 transitions, or for a horizon beyond the time watched, unless the curve has come to 0 by then.

    Notes
    -----
    Kaplan & Meier, J. Am. Stat. Assoc. 53, 457 (1958); Royston & Parmar, BMC Med. Res. Methodol. 13, 152 (2013); intervals of
    the variance from the jackknife of its logarithm: Miller, Ann. Math. Stat. 39, 567 (1968).

    Examples
    --------
    >>> from peristalsis import analysis
    >>> analysis.restricted_moments([1.0, 2.0, 3.0, 4.0], horizon=2.0).mean.value
    1.75
    """
    return Survival(time, observed).restricted_moments(horizon)


def fit_lifetime(
    time: Numbers, observed: npt.ArrayLike | None = None, *, family: _Family = "gamma"
) -> LifetimeFit:
    """A distribution of transition times by maximum likelihood under censoring.

    ln L = sum of ln f(t) over transitions + sum of ln S(t) over censored runs, f = -dS/dt.

    Parameters
    ----------
    time : array_like
        Transition times; without one, the times up to which runs were watched (column `watched`), shape (runs,).
    observed : array_like of bool, optional
        Whether there was a transition; all, by default.
    family : {"gamma", "exponential", "weibull"}
        The distribution. A mean far beyond the time watched rests on its being right.

    Returns
    -------
    LifetimeFit
        Mean, variance and shape with intervals by profile likelihood.

    Raises
    ------
    AnalysisError
        Without a transition (exponential) or below 3 (others), and where the times do not scatter.

    Notes
    -----
    Kalbfleisch & Prentice, The Statistical Analysis of Failure Time Data (2002), chapter 3.

    Examples
    --------
    >>> from peristalsis import analysis
    >>> fit = analysis.fit_lifetime([10.0, 20.0, 30.0], [True, True, False], family="exponential")
    >>> round(fit.mean.value, 6), fit.observed, fit.censored
    (30.0, 2, 1)
    """
    return result(LifetimeFit, _core.fit_lifetime(family, runs(time, observed)))


def fit_shifted_exponential(
    time: Numbers, observed: npt.ArrayLike | None = None
) -> ShiftedExponentialFit:
    """A dead time, and exponential waiting after it: S(t) = exp(-(t - t_0)/theta) beyond t_0, 1 before.

    Parameters
    ----------
    time : array_like
        Transition times; without one, the times up to which runs were watched (column `watched`), shape (runs,).
    observed : array_like of bool, optional
        Whether there was a transition; all, by default.

    Returns
    -------
    ShiftedExponentialFit
        t_0 and theta, both without bias, in the unit of the times.

    Raises
    ------
    AnalysisError
        Below 3 transitions, or where all are at one time.

    Notes
    -----
    Lawless, Statistical Models and Methods for Lifetime Data (2003), section 4.5.

    Examples
    --------
    >>> from peristalsis import analysis
    >>> fit = analysis.fit_shifted_exponential([10.0, 12.0, 16.0, 22.0])
    >>> fit.dead_time.value < 10.0 < fit.mean.value
    True
    """
    return result(ShiftedExponentialFit, _core.fit_shifted_exponential(runs(time, observed)))
