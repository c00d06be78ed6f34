"""Estimators with error bars, on NumPy arrays of any origin.

Columns come in, result objects go out, each with its uncertainties. Nothing here knows of grains, but for the names:
a *width* is any control parameter that a *transition time* may diverge in.

Runs that ended before a transition are *censored*: give the time at which they ended and ``observed=False``. They are
used, not dropped.

Scaling collapse
----------------
`Collapse` finds the exponents with which curves of several parameters fall on one another, for any scaling::

    curves = [(L, x, y, error) for L in sizes]              # any data
    collapse = Collapse(curves, "finite_size")              # y = L^-a f((x - x_c) L^b)
    fit = collapse.fit(start=[0.1, 1.0, 0.5], steps=[0.1, 0.2, 0.05])
    print(fit.parameters, fit.errors, fit.quality)

The quality S of Houdayer & Hartmann, Phys. Rev. B 70, 014418 (2004): near 1 where the curves agree within their errors.
A collapse must keep curves overlapping, so that a search cannot win by pulling them apart.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._results import (
    AutocorrelationTime,
    CollapseFit,
    CollapseQuality,
    CurveFit,
    DipTest,
    Estimate,
    FractionCrossing,
    Hysteresis,
    Interval,
    Jump,
    LawEvidence,
    LawFit,
    LawRunsFit,
    LifetimeFit,
    LineFit,
    MomentPeak,
    Moments,
    Peak,
    Resampled,
    RestrictedMoments,
    ScatterLawFit,
    SecondMoment,
    ShiftedExponentialFit,
    Stationarity,
    StationaryMean,
    SurvivalStep,
    TwoPeaks,
    Uncertain,
    WidthEnsemble,
    WindowRunsFit,
    result,
)

__all__ = [
    "AutocorrelationTime",
    "Collapse",
    "CollapseFit",
    "CollapseQuality",
    "CollapseResult",
    "CurveFit",
    "DipTest",
    "Estimate",
    "FractionCrossing",
    "Hysteresis",
    "Interval",
    "Jump",
    "LawEvidence",
    "LawFit",
    "LawRunsFit",
    "LifetimeFit",
    "LineFit",
    "MomentPeak",
    "Moments",
    "Peak",
    "Resampled",
    "RestrictedMoments",
    "ScatterLawFit",
    "SecondMoment",
    "ShiftedExponentialFit",
    "Stationarity",
    "StationaryMean",
    "Survival",
    "SurvivalStep",
    "TransitionTime",
    "TwoPeaks",
    "Uncertain",
    "WidthEnsemble",
    "WindowRunsFit",
    "autocorrelation_time",
    "compare_laws",
    "dip_test",
    "ensemble_moments",
    "ensembles_by_width",
    "fit_law",
    "fit_law_to_runs",
    "fit_law_to_runs_in_windows",
    "fit_law_with_scatter",
    "fit_lifetime",
    "fit_line",
    "fit_parabola",
    "fit_shifted_exponential",
    "fraction_crossing",
    "hysteresis",
    "jump_height",
    "mean_with_error",
    "power_exponent",
    "restricted_moments",
    "second_moment",
    "second_moment_peak",
    "stationarity",
    "stationary_mean",
    "transition_time",
    "two_peaks",
]

Array = npt.NDArray[np.float64]
#: Times, and whether there was a transition.
Runs = tuple[Array, npt.NDArray[np.bool_]]
Numbers = npt.ArrayLike
#: ``"power"``, ``"exponential"``, or ``{"barrier": {"power": 2.0}}``.
Law = str | Mapping[str, Any]
#: ``x, y, error`` scaled, from ``(parameters, p, x, y, error)``.
Scaling = Callable[[list[float], float, float, float, float], tuple[float, float, float]]


def _reals(values: Numbers) -> Array:
    array = np.ascontiguousarray(values, dtype=np.float64)
    if array.ndim != 1:
        raise ValueError(f"a column has one dimension, not {array.ndim}")
    return array


def _columns(*columns: Numbers) -> list[Array]:
    arrays = [_reals(column) for column in columns]
    if len({len(array) for array in arrays}) > 1:
        raise ValueError(f"columns of unequal length: {', '.join(str(len(array)) for array in arrays)}")
    return arrays


def _runs(time: Numbers, observed: npt.ArrayLike | None) -> Runs:
    times = _reals(time)
    if observed is None:
        return times, np.ones(len(times), dtype=bool)
    truths = np.ascontiguousarray(observed, dtype=bool)
    if truths.shape != times.shape:
        raise ValueError(f"{len(times)} times, but {truths.size} observed")
    return times, truths


def _table(width: Numbers, time: Numbers, observed: npt.ArrayLike | None) -> tuple[Array, Runs]:
    times, truths = _runs(time, observed)
    widths, times = _columns(width, times)
    return widths, (times, truths)


def _pair(value: Uncertain | float | tuple[float, float]) -> tuple[float, float]:
    if isinstance(value, Uncertain):
        return value.value, value.error
    if isinstance(value, tuple):
        return value
    return float(value), 0.0


def _law(law: Law) -> str | dict[str, Any]:
    return law if isinstance(law, str) else dict(law)


# Series


def mean_with_error(series: Numbers) -> Estimate:
    """Mean of a correlated series with its standard error, by blocks (Flyvbjerg & Petersen).

    Examples
    --------
    >>> mean_with_error([1.0, 3.0] * 64).mean
    2.0
    """
    return result(Estimate, _core.mean_with_error(_reals(series)))


def autocorrelation_time(series: Numbers) -> AutocorrelationTime:
    """Integrated autocorrelation time of a series, in samples."""
    return result(AutocorrelationTime, _core.autocorrelation_time(_reals(series)))


def stationary_mean(series: Numbers) -> StationaryMean:
    """Mean of the stationary part of a series, its transient cut off."""
    return result(StationaryMean, _core.stationary_mean(_reals(series)))


def stationarity(series: Numbers) -> Stationarity:
    """Comparison of the two halves of a series."""
    return result(Stationarity, _core.stationarity(_reals(series)))


# Transition times


@dataclass(frozen=True)
class TransitionTime:
    """When a run changed, or how long it was watched without.

    Attributes
    ----------
    time : float
        tau, or the end of the run.
    observed : bool
        Whether there was a transition.
    """

    time: float
    observed: bool


def transition_time(
    averages: Numbers,
    *,
    direction: str = "upward",
    threshold: float = 0.5,
    period_duration: float = 1.0,
) -> TransitionTime:
    """Time at which the line through period averages crosses a threshold for good: three whole periods beyond it.

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
    """
    return TransitionTime(*_core.transition_time(_reals(averages), direction, threshold, period_duration))


class Survival:
    """Part of the runs without a transition yet (Kaplan & Meier), from times some of which are censored.

    Parameters
    ----------
    time : array_like
        Transition times, and ends of runs without a transition.
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
    """

    def __init__(self, time: Numbers, observed: npt.ArrayLike | None = None) -> None:
        self._runs = _runs(time, observed)
        answer = _core.survival(self._runs)
        self.steps = tuple(result(SurvivalStep, step) for step in answer["steps"])
        self.runs: int = answer["runs"]
        self.observed: int = answer["observed"]
        self.watched: float = answer["watched"]

    def at(self, time: Numbers) -> Array:
        """Survival at times; 1 before the first transition."""
        times = np.array([step.time for step in self.steps])
        levels = np.array([1.0, *(step.survival.value for step in self.steps)])
        return levels[np.searchsorted(times, np.asarray(time, dtype=np.float64), side="right")]

    @property
    def median(self) -> Uncertain:
        """Median transition time; raises where fewer than half of the runs had a transition."""
        return result(Uncertain, _core.survival_median(self._runs))

    def restricted_moments(self, horizon: float) -> RestrictedMoments:
        """Mean and variance of min(tau, horizon)."""
        return result(RestrictedMoments, _core.restricted_moments(self._runs, float(horizon)))

    def __repr__(self) -> str:
        return f"<Survival: {self.observed} transitions in {self.runs} runs, watched up to {self.watched:g}>"


def restricted_moments(
    time: Numbers, observed: npt.ArrayLike | None = None, *, horizon: float
) -> RestrictedMoments:
    """Mean and variance of min(tau, horizon), censoring accounted for."""
    return Survival(time, observed).restricted_moments(horizon)


def fit_lifetime(
    time: Numbers, observed: npt.ArrayLike | None = None, *, family: str = "gamma"
) -> LifetimeFit:
    """A distribution of transition times by maximum likelihood; `family` is exponential, gamma or weibull."""
    return result(LifetimeFit, _core.fit_lifetime(family, _runs(time, observed)))


def fit_shifted_exponential(
    time: Numbers, observed: npt.ArrayLike | None = None
) -> ShiftedExponentialFit:
    """A dead time, and exponential waiting after it."""
    return result(ShiftedExponentialFit, _core.fit_shifted_exponential(_runs(time, observed)))


# Laws


def fit_law(
    law: Law,
    width: Numbers,
    value: Numbers,
    error: Numbers,
    *,
    critical_width: Uncertain | float | tuple[float, float] | None = None,
) -> LawFit:
    """A law of divergence through values with errors at several widths.

    Parameters
    ----------
    law : str or mapping
        ``"power"``: y = A (w_c - w)^-B; ``"exponential"``: y = A exp(B w);
        ``{"barrier": {"power": p}}``: y = A exp(B/(w_c - w)^p).
    width, value, error : array_like
        w, y and its standard error.
    critical_width : optional
        w_c where it is known: a number, with its error as a pair or an `Uncertain`.
    """
    known = None if critical_width is None else _pair(critical_width)
    widths, values, errors = _columns(width, value, error)
    return result(LawFit, _core.fit_law(_law(law), widths, values, errors, known))


def fit_law_to_runs(
    law: Law,
    width: Numbers,
    time: Numbers,
    observed: npt.ArrayLike | None = None,
    *,
    family: str = "gamma",
) -> LawRunsFit:
    """A law of the mean transition time, by the likelihood of every single run, the censored ones included."""
    table = _table(width, time, observed)
    return result(LawRunsFit, _core.fit_law_to_runs(_law(law), family, table))


def fit_law_to_runs_in_windows(
    law: Law,
    width: Numbers,
    time: Numbers,
    observed: npt.ArrayLike | None = None,
    *,
    family: str = "gamma",
) -> list[WindowRunsFit]:
    """`fit_law_to_runs` in windows that leave out the smallest, then the largest widths one by one.

    The first window holds all widths. An exponent that is one moves by no more than its error from window to window.
    """
    table = _table(width, time, observed)
    answers = _core.fit_law_to_runs_in_windows(_law(law), family, table)
    return [result(WindowRunsFit, answer) for answer in answers]


def fit_law_with_scatter(
    width: Numbers, time: Numbers, observed: npt.ArrayLike | None = None
) -> ScatterLawFit:
    """Power laws of the mean transition time and of its relative variance at once, censored runs included.

    tau = A (w_c - w)^-alpha and chi_tau/tau^2 = C (w_c - w)^-q, gamma distributions of shape tau^2/chi_tau; so
    chi_tau ~ (w_c - w)^-(2 alpha + q). Needs three widths with transitions.
    """
    table = _table(width, time, observed)
    return result(ScatterLawFit, _core.fit_law_with_scatter(table))


def ensembles_by_width(
    width: Numbers,
    time: Numbers,
    observed: npt.ArrayLike | None = None,
    *,
    family: str = "gamma",
) -> list[WidthEnsemble]:
    """Transition times of a table of runs, one row a run, estimated width by width in three ways.

    Mean and variance chi_tau with errors for `fit_law` are those of each answer's `fit`.
    """
    table = _table(width, time, observed)
    answers = _core.ensembles_by_width(family, table)
    return [result(WidthEnsemble, answer) for answer in answers]


def compare_laws(
    laws: Iterable[Law],
    width: Numbers,
    time: Numbers,
    observed: npt.ArrayLike | None = None,
    *,
    family: str = "gamma",
) -> list[LawEvidence]:
    """What the runs say for each of several laws, by Akaike's criterion."""
    table = _table(width, time, observed)
    answers = _core.compare_laws([_law(law) for law in laws], family, table)
    return [result(LawEvidence, answer) for answer in answers]


def fit_line(x: Numbers, y: Numbers, error: Numbers) -> LineFit:
    """A straight line through points with errors."""
    return result(LineFit, _core.fit_line(*_columns(x, y, error)))


def fit_parabola(x: Numbers, y: Numbers, error: Numbers) -> CurveFit:
    """A parabola through points with errors, beside the straight line."""
    return result(CurveFit, _core.fit_parabola(*_columns(x, y, error)))


def power_exponent(x: Numbers, y: Numbers, error: Numbers) -> LineFit:
    """A power law through positive points with errors: the line through their logarithms, its slope the exponent."""
    return result(LineFit, _core.power_exponent(*_columns(x, y, error)))


# Order of the transition


def fraction_crossing(width: Numbers, jammed: npt.ArrayLike) -> FractionCrossing:
    """Width at which the fraction of jammed runs falls through one half; one row a run."""
    return result(FractionCrossing, _core.fraction_crossing(_runs(width, jammed)))


def hysteresis(
    rest_width: Numbers,
    rest_jammed: npt.ArrayLike,
    jammed_width: Numbers,
    jammed_jammed: npt.ArrayLike,
) -> Hysteresis:
    """Whether runs from rest and runs from jammed flow part at different widths, and by how much; one row a run."""
    rest, jammed = _runs(rest_width, rest_jammed), _runs(jammed_width, jammed_jammed)
    return result(Hysteresis, _core.hysteresis(rest, jammed))


def jump_height(
    upper: tuple[Numbers, Numbers, Numbers],
    lower: tuple[Numbers, Numbers, Numbers],
    critical_width: Uncertain | float | tuple[float, float],
) -> Jump:
    """The two branches (width, value, error) of a flow rate, carried on to the critical width, and their difference."""
    above, below = _columns(*upper), _columns(*lower)
    return result(Jump, _core.jump_height(above, below, _pair(critical_width)))


def dip_test(values: Numbers, *, resamples: int = 1000, seed: int = 0) -> DipTest:
    """Hartigan's dip test: whether a sample has more than one peak."""
    return result(DipTest, _core.dip_test(_reals(values), int(resamples), int(seed)))


def two_peaks(values: Numbers) -> TwoPeaks:
    """A mixture of two normal distributions against a single one."""
    return result(TwoPeaks, _core.two_peaks(_reals(values)))


def ensemble_moments(replicas: Iterable[Numbers]) -> list[Moments]:
    """Mean and variance over replicas of equal length, at each place of their series, with jackknife errors."""
    rows = _columns(*replicas)
    return [result(Moments, answer) for answer in _core.ensemble_moments(rows)]


def second_moment(runs: Iterable[Numbers], *, held: int | None = None) -> list[SecondMoment]:
    """chi_J(t) = <j^2> - <j>^2 over runs of unequal length, up to the last time that three runs have reached.

    Parameters
    ----------
    runs : iterable of array_like
        j(t) of each run, at common times.
    held : int, optional
        A run that ended stays at the mean of so many of its last samples: right where runs were stopped because they
        had settled. Without it runs that ended are left out from then on.
    """
    answers = _core.second_moment([_reals(run) for run in runs], held)
    return [result(SecondMoment, answer) for answer in answers]


def second_moment_peak(
    runs: Iterable[Numbers], *, held: int | None = None, resamples: int = 200, seed: int = 0
) -> MomentPeak:
    """The peak over time of `second_moment`, with errors by resampling whole runs."""
    rows = [_reals(run) for run in runs]
    return result(MomentPeak, _core.second_moment_peak(rows, held, int(resamples), int(seed)))


# Collapse


@dataclass(frozen=True)
class CollapseResult:
    """Best parameters of a scaling, with their errors and what to judge them by.

    Attributes
    ----------
    parameters : tuple of float
        The best.
    errors : tuple of float
        Standard errors from resampled ordinates; NaN where none were resampled. Right where `quality` is near 1.
    quality : float
        S: mean squared deviation from the common curve over its variance; near 1 where the curves agree.
    overlap : float
        Part of the points that were compared with other curves.
    contour : tuple of Interval
        Range of each parameter in which S stays within 1 of its minimum, the others free: a safe outer bound.
    leave_one_out : ndarray
        Parameters with each curve left out in turn, shape (curves, parameters); empty unless asked for. Exponents that
        hang on one curve move.
    fit, resampled
        The whole of what the search and the resampling answered.
    """

    parameters: tuple[float, ...]
    errors: tuple[float, ...]
    quality: float
    overlap: float
    contour: tuple[Interval, ...]
    leave_one_out: Array
    fit: CollapseFit
    resampled: Resampled | None


class Collapse:
    """Curves of several parameters and a scaling in which they may fall on one another.

    Parameters
    ----------
    curves : iterable of (p, x, y, error)
        One entry a curve: its own parameter, and columns.
    scaling : str, mapping or callable
        ``"finite_size"``: y = p^-a f((x - x_c) p^b), parameters (a, b, x_c).
        ``"critical_line"``: y = p^-a f((x_c - x)/p^b) with x_c = slope p + x_max, parameters (a, b, slope, x_max), in
        logarithms. ``"critical_each"``: x_c of its own for each curve, parameters (a, b, x_c...).
        ``{"critical_known": [...]}``: known x_c, parameters (a, b).
        A function ``(parameters, p, x, y, error) -> (x, y, error)`` of numbers: anything else.
    least_overlap : float
        Least part of the points that must be compared. At 0 a search may win by pulling the curves apart.

    Examples
    --------
    y = p x collapses as y/p^a at a = 1:

    >>> x = np.arange(9.0)
    >>> curves = [(p, x, p * x, np.full(9, 0.1)) for p in (1.0, 2.0)]
    >>> collapse = Collapse(curves, lambda a, p, x, y, e: (x, y * p ** -a[0], e))
    >>> round(collapse.fit([0.5], [0.2], starts=1, resamples=0).parameters[0], 2)
    1.0
    """

    def __init__(
        self,
        curves: Iterable[tuple[float, Numbers, Numbers, Numbers]],
        scaling: str | Mapping[str, Any] | Scaling,
        *,
        least_overlap: float = 0.5,
    ) -> None:
        self.curves: list[tuple[float, Array, Array, Array]] = []
        for parameter, *columns in curves:
            x, y, error = _columns(*columns)
            self.curves.append((float(parameter), x, y, error))
        self.scaling = dict(scaling) if isinstance(scaling, Mapping) else scaling
        self.least_overlap = float(least_overlap)

    def fit(
        self,
        start: Sequence[float],
        steps: Sequence[float],
        *,
        starts: int = 8,
        seed: int = 0,
        resamples: int = 100,
        leave_one_out: bool = False,
    ) -> CollapseResult:
        """Search for the best parameters.

        Parameters
        ----------
        start, steps : sequence of float
            Where to begin, and how far to look about in each parameter.
        starts : int
            Searches, the others from random places within two steps of `start`.
        seed : int
            Of these and of the resamples.
        resamples : int
            Resampled sets of ordinates for the errors, 20 at least; 0 for none.
        leave_one_out : bool
            Whether to repeat the search without each curve in turn.

        Raises
        ------
        AnalysisError
            Where no start finds enough overlap, or the data are not finite.
        """
        search = {
            "start": [float(value) for value in start],
            "steps": [float(value) for value in steps],
            "starts": int(starts),
            "seed": int(seed),
            "least_overlap": self.least_overlap,
            "resamples": int(resamples),
            "leave_one_out": bool(leave_one_out),
        }
        found, scatter, contour, left_out = _core.fit_collapse(self.curves, self.scaling, search)
        fit = result(CollapseFit, found)
        resampled = None if scatter is None else result(Resampled, scatter)
        errors = (
            (float("nan"),) * len(fit.parameters)
            if resampled is None
            else tuple(estimate.error for estimate in resampled.estimates)
        )
        return CollapseResult(
            parameters=fit.parameters,
            errors=errors,
            quality=fit.quality.quality,
            overlap=fit.quality.overlap,
            contour=tuple(result(Interval, interval) for interval in contour),
            leave_one_out=np.array([other["parameters"] for other in left_out], dtype=np.float64),
            fit=fit,
            resampled=resampled,
        )

    def quality(self, parameters: Sequence[float]) -> CollapseQuality:
        """How well the curves collapse at given parameters."""
        quality, _ = _core.apply_collapse(self.curves, self.scaling, [float(p) for p in parameters])
        return result(CollapseQuality, quality)

    def scaled(self, parameters: Sequence[float]) -> list[tuple[float, Array, Array, Array]]:
        """The scaled curves (p, x, y, error)."""
        _, scaled = _core.apply_collapse(self.curves, self.scaling, [float(p) for p in parameters])

        def column(points: list[dict[str, float]], name: str) -> Array:
            return np.array([point[name] for point in points], dtype=np.float64)

        return [
            (curve[0], column(points, "x"), column(points, "y"), column(points, "error"))
            for curve, points in zip(self.curves, scaled, strict=True)
        ]
