"""Means of correlated series, and moments over ensembles of them."""

from __future__ import annotations

from collections.abc import Iterable

from .. import _core
from .._arrays import Array
from .._given import whole
from ._columns import Numbers, columns, reals, resampling, result
from ._results import AutocorrelationTime, Estimate, MomentPeak, Moments, SecondMoment, Stationarity, StationaryMean


def mean_with_error(series: Numbers) -> Estimate:
    """Mean of a correlated series with its standard error, by blocks.

    error^2 = sum (x_i - <x>)^2/(n (n - 1)) over n block averages x_i, the blocks as long as correlations need.

    Parameters
    ----------
    series : array_like
        Samples at equal distances in time, shape (n,), of any unit.

    Returns
    -------
    Estimate
        Mean and error in the unit of the series.

    Raises
    ------
    AnalysisError
        Below 4 samples, or where one is not finite.

    Notes
    -----
    Flyvbjerg & Petersen, J. Chem. Phys. 91, 461 (1989); the length of the blocks: Lee, Foulkes & Needs, Phys. Rev. E 83,
    066706 (2011).

    Examples
    --------
    >>> from peristalsis import analysis
    >>> mean = analysis.mean_with_error([1.0, 3.0] * 64)
    >>> mean.mean, mean.converged
    (2.0, True)
    """
    return result(Estimate, _core.mean_with_error(reals("series", series)))


def autocorrelation_time(series: Numbers) -> AutocorrelationTime:
    """Integrated autocorrelation time of a stationary series, in samples.

    tau = 1/2 + sum of the normalised autocorrelations up to the least lag W >= 5 tau; the variance of the mean is 2 tau/n
    times that of a sample.

    Parameters
    ----------
    series : array_like
        Samples at equal distances in time, shape (n,), of any unit.

    Returns
    -------
    AutocorrelationTime
        In samples.

    Raises
    ------
    AnalysisError
        Below 16 samples, or where one is not finite.

    Notes
    -----
    Madras & Sokal, J. Stat. Phys. 50, 109 (1988), appendix C.

    Examples
    --------
    >>> import numpy as np
    >>> from peristalsis import analysis
    >>> series = np.random.default_rng(1).normal(size=4096)
    >>> found = analysis.autocorrelation_time(series)
    >>> found.converged, abs(found.time - 0.5) < 3 * found.error
    (True, True)
    """
    return result(AutocorrelationTime, _core.autocorrelation_time(reals("series", series)))


def stationary_mean(series: Numbers) -> StationaryMean:
    """Mean of the stationary part of a series, its transient cut off.

    Parameters
    ----------
    series : array_like
        Samples at equal distances in time, shape (n,), of any unit.

    Returns
    -------
    StationaryMean
        The mean, what was cut off, and how the halves of the rest compare.

    Raises
    ------
    AnalysisError
        Where the series is too short, or not finite.

    Notes
    -----
    A series whose halves differ by more than three of their errors is refused: it drifts. Of white noise that is one in ten
    with 100 samples, one in a hundred with 400. White, Simulation 69, 323 (1997): MSER-5; Geweke, in Bayesian Statistics 4
    (1992).

    Examples
    --------
    >>> import numpy as np
    >>> from peristalsis import analysis
    >>> series = np.append(np.zeros(64), np.random.default_rng(1).normal(1.0, 0.1, size=512))
    >>> found = analysis.stationary_mean(series)
    >>> found.discarded >= 64, round(found.estimate.mean, 1)
    (True, 1.0)
    """
    return result(StationaryMean, _core.stationary_mean(reals("series", series)))


def stationarity(series: Numbers) -> Stationarity:
    """Comparison of the two halves of a series.

    Parameters
    ----------
    series : array_like
        Samples at equal distances in time, shape (n,), of any unit.

    Returns
    -------
    Stationarity
        Means of the halves, and their difference over its standard error: beyond 3 the series drifts.

    Raises
    ------
    AnalysisError
        Where the series is too short, or not finite.

    Notes
    -----
    z = (m_2 - m_1)/sqrt(error_1^2 + error_2^2), m the means of the halves; Geweke, Bayesian Statistics 4, 169 (1992), there with
    the first tenth and the last half.

    Examples
    --------
    >>> import numpy as np
    >>> from peristalsis import analysis
    >>> halves = analysis.stationarity(np.random.default_rng(1).normal(size=1024))
    >>> abs(halves.score) < 3
    True
    """
    return result(Stationarity, _core.stationarity(reals("series", series)))


def ensemble_moments(replicates: Iterable[Numbers]) -> list[Moments]:
    """Mean and variance over replicates, at each place of their series, with jackknife errors.

    Parameters
    ----------
    replicates : iterable of array_like
        Series of equal length, one a replicate.

    Returns
    -------
    list of Moments
        One for each place of the series.

    Raises
    ------
    ValueError
        For series of unequal length.
    AnalysisError
        For too few replicates, or values that are not finite.

    Notes
    -----
    Errors of variances by the jackknife: Efron, The Jackknife, the Bootstrap and Other Resampling Plans (SIAM, 1982), chapter 3.

    Examples
    --------
    >>> from peristalsis import analysis
    >>> moments = analysis.ensemble_moments([[1.0], [2.0], [3.0]])[0]
    >>> moments.mean, moments.variance
    (2.0, 1.0)
    """
    rows = columns(**{f"replicate {number}": series for number, series in enumerate(replicates)})
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

    Returns
    -------
    list of SecondMoment
        One for each time.

    Raises
    ------
    AnalysisError
        Below 3 runs, or for values that are not finite.

    Examples
    --------
    >>> from peristalsis import analysis
    >>> runs = [[0.0, 1.0], [0.0, 0.5], [0.0, 0.0]]
    >>> moment = analysis.second_moment(runs)[1]
    >>> moment.mean, moment.variance, moment.runs
    (0.5, 0.25, 3)
    """
    answers = _core.second_moment(_rows(runs), _held(held))
    return [result(SecondMoment, answer) for answer in answers]


def second_moment_peak(
    runs: Iterable[Numbers], *, held: int | None = None, resamples: int = 200, seed: int = 0
) -> MomentPeak:
    """The peak over time of `second_moment`, with errors by resampling whole runs.

    Parameters
    ----------
    runs : iterable of array_like
        j(t) of each run, at common times.
    held : int, optional
        As of `second_moment`.
    resamples : int
        Resampled ensembles, 20 at least.
    seed : int
        Of the resampling.

    Returns
    -------
    MomentPeak
        Place and height; the percentile intervals are pulled upward by the bias that stands beside them.

    Raises
    ------
    AnalysisError
        As `second_moment`, and for too few resamples.

    Examples
    --------
    >>> from peristalsis import analysis
    >>> runs = [[0.0, 1.0, 1.0], [0.0, 0.5, 1.0], [0.0, 0.0, 1.0]] * 4
    >>> peak = analysis.second_moment_peak(runs, resamples=50)
    >>> peak.index.value, round(peak.value.value, 3)
    (1.0, 0.182)
    """
    rows = _rows(runs)
    return result(MomentPeak, _core.second_moment_peak(rows, _held(held), *resampling(resamples, seed)))


def _rows(runs: Iterable[Numbers]) -> list[Array]:
    return [reals(f"run {number}", run) for number, run in enumerate(runs)]


def _held(samples: int | None) -> int | None:
    """Last samples at whose mean a run stays that ended."""
    return None if samples is None else whole("held", samples, 1)
