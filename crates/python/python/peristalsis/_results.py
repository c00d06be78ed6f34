"""What the estimators answer: numbers with their errors and with what has to be known of them."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any, TypeVar, get_args, get_type_hints

Result = TypeVar("Result")


def result(kind: type[Result], answer: Any) -> Result:
    """A dictionary as the result class of the same fields."""
    hints = get_type_hints(kind)
    values = {field.name: _value(hints[field.name], answer[field.name]) for field in fields(kind)}  # type: ignore[arg-type]
    return kind(**values)


def _value(hint: Any, value: Any) -> Any:
    kinds = [kind for kind in get_args(hint) or (hint,) if hasattr(kind, "__dataclass_fields__")]
    if value is None or not kinds:
        return tuple(value) if isinstance(value, list) else value
    if isinstance(value, list):
        return tuple(result(kinds[0], item) for item in value)
    return result(kinds[0], value)


@dataclass(frozen=True)
class Interval:
    """Confidence interval; a side that the data leave open is infinite."""

    lower: float
    """Lower end."""
    upper: float
    """Upper end."""


@dataclass(frozen=True)
class Uncertain:
    """A number with its standard error and its confidence intervals."""

    value: float
    """The estimate."""
    error: float
    """Its standard error (one standard deviation)."""
    interval_68: Interval
    """Interval that covers the truth in 68.27 per cent of repetitions."""
    interval_95: Interval
    """Interval that covers the truth in 95 per cent of repetitions."""

    def __str__(self) -> str:
        return f"{self.value:.6g} +- {self.error:.2g}"


@dataclass(frozen=True)
class Estimate:
    """Mean of a series with its statistical error."""

    mean: float
    """Mean of all samples."""
    error: float
    """Standard error of the mean (one standard deviation), correlations included."""
    error_uncertainty: float
    """Standard error of `error` itself: error/sqrt(2 (blocks - 1))."""
    autocorrelation_time: float
    """Integrated autocorrelation time that the error implies, in samples: (error/error of uncorrelated samples)^2/2."""
    block_length: int
    """Samples in a block."""
    blocks: int
    """Blocks behind the error."""
    samples: int
    """Samples in the series."""
    converged: bool
    """Whether the error has reached its plateau; if not it is a lower bound, and the series is too short."""


@dataclass(frozen=True)
class AutocorrelationTime:
    """Integrated autocorrelation time of a series."""

    time: float
    """tau = 1/2 + sum of the normalised autocorrelations, in samples; 1/2 for uncorrelated samples."""
    error: float
    """Its standard error, 2 tau sqrt((W + 1/2 - tau)/n); for exponential correlations some 15 per cent too large, and
    meaningless unless converged."""
    window: int
    """Largest lag W of the sum, in samples."""
    converged: bool
    """Whether the window closed by itself; if not, `time` is a lower bound, and the series is too short."""


@dataclass(frozen=True)
class StationaryMean:
    """Mean of the stationary part of a series."""

    discarded: int
    """Samples left out at the beginning."""
    estimate: Estimate
    """Mean of the rest with its error."""
    halves: Stationarity
    """Comparison of the halves of the rest."""


@dataclass(frozen=True)
class Stationarity:
    """Comparison of the two halves of a series."""

    first: Estimate
    """Mean of the first half."""
    second: Estimate
    """Mean of the second half."""
    score: float
    """Difference of the means, second less first, in units of its standard error."""


@dataclass(frozen=True)
class SurvivalStep:
    """The survival curve just after one transition time."""

    time: float
    """Time of the step, in the unit of the input."""
    at_risk: int
    """Runs watched up to this time without a transition before it."""
    transitions: int
    """Runs with their transition at this time."""
    survival: Uncertain
    """Probability S of no transition up to and including this time, with Greenwood's error and log-log intervals."""


@dataclass(frozen=True)
class RestrictedMoments:
    """Mean and variance of min(tau, horizon)."""

    horizon: float
    """Time at which every longer transition time is cut off."""
    mean: Uncertain
    """Restricted mean, with normal intervals."""
    variance: Uncertain
    """Restricted variance, with its error by the jackknife over runs."""


@dataclass(frozen=True)
class LifetimeFit:
    """A distribution fitted to the transition times of one ensemble."""

    family: str
    """Family of the distribution."""
    mean: Uncertain
    """Mean `<tau>`, of the whole distribution, beyond the time watched too."""
    variance: Uncertain
    """Variance `chi_tau = <tau^2> - <tau>^2`."""
    shape: Uncertain | None
    """Shape k; `None` for the exponential."""
    log_likelihood: float
    """Largest log-likelihood, of densities in the unit of the times: comparable between families on the same runs."""
    observed: int
    """Runs with an observed transition."""
    censored: int
    """Censored runs."""


@dataclass(frozen=True)
class ShiftedExponentialFit:
    """Shifted exponential distribution fitted to the transition times of one ensemble."""

    dead_time: Uncertain
    """Dead time t_0 before which no transition happens, corrected for its bias; 0 at least."""
    waiting_time: Uncertain
    """Mean waiting time theta after the dead time; 1/theta is the rate."""
    mean: Uncertain
    """Mean `<tau>` = t_0 + theta."""
    variance: Uncertain
    """Variance `chi_tau = theta^2`."""
    log_likelihood: float
    """Largest log-likelihood, comparable with that of a `LifetimeFit` on the same runs."""
    observed: int
    """Runs with an observed transition."""
    censored: int
    """Censored runs."""


@dataclass(frozen=True)
class LawFit:
    """A law fitted to values with errors at several widths."""

    law: str | dict[str, Any]
    """The law."""
    critical_width: Uncertain | None
    """Critical width w_c, with intervals by the profile of chi^2; `None` for a law without one. An upper end of
    infinity says that the points do not tell the law from an exponential."""
    exponent: Uncertain
    """Exponent, or coefficient of the barrier, B, with intervals by the profile of chi^2."""
    ln_amplitude: Uncertain
    """ln A, in the normal approximation."""
    chi_squared: float
    """Sum of the squared deviations of ln y in units of their errors, that of a known w_c included."""
    degrees_of_freedom: int
    """Points less free parameters."""
    probability: float
    """Probability of a chi^2 at least as large if the law and the errors are right."""


@dataclass(frozen=True)
class LawRunsFit:
    """A law of the mean transition time fitted to the runs at all widths."""

    law: str | dict[str, Any]
    """The law of the mean."""
    family: str
    """The family of the distribution about the mean."""
    critical_width: Uncertain | None
    """Critical width w_c; `None` for a law without one. Its lower end never lies below a width that saw a transition;
    an upper end of infinity says that the runs do not tell the law from an exponential."""
    exponent: Uncertain
    """Exponent, or coefficient of the barrier, B."""
    ln_amplitude: float
    """ln A."""
    shape: Uncertain | None
    """Shape k, common to all widths; `None` for the exponential family."""
    log_likelihood: float
    """Largest log-likelihood."""
    observed: int
    """Runs with an observed transition."""
    censored: int
    """Censored runs."""


@dataclass(frozen=True)
class LawEvidence:
    """What the runs say for one law."""

    law: str | dict[str, Any]
    """The law."""
    log_likelihood: float
    """Largest log-likelihood."""
    akaike: float
    """Akaike's criterion 2 p - 2 ln L."""
    excess: float
    """Akaike's criterion less that of the best law: beyond some 10 the law has next to no support."""
    weight: float
    """Akaike weight exp(-excess/2) over the sum of all laws compared: how probable it is to be the nearest of them."""
    critical_width: float | None
    """Best w_c, infinite where the law does best as an exponential one; `None` for a law without w_c."""


@dataclass(frozen=True)
class FractionCrossing:
    """The width at which the fraction of jammed runs falls through one half."""

    width: Uncertain
    """The width, with intervals by profile likelihood; where the runs are separated the bracket that they leave."""
    spread: float
    """Range of widths over which the fraction falls, 1/steepness, by maximum likelihood; 0 where the runs are
    separated."""
    last_all: float | None
    """Largest width at which all runs jam, with all below it doing so; `None` where already at the least some do not."""
    first_none: float | None
    """Smallest width at which none jams, nor above it; `None` where at the largest some still do."""
    is_separated: bool
    """Whether the fraction falls from 1 to 0 between two neighbouring widths, or at a single one between: the data
    then bracket the width and say nothing of the spread."""
    log_likelihood: float
    """Largest log-likelihood."""
    runs: int
    """Runs."""


@dataclass(frozen=True)
class Hysteresis:
    """Width of the hysteresis loop and whether there is one."""

    from_rest: FractionCrossing
    """w_c: half of the runs started from rest jam."""
    from_jammed: FractionCrossing
    """w_c': half of the runs started jammed stay so."""
    loop_width: Uncertain
    """Width of the loop, w_c' - w_c."""
    likelihood_ratio: float
    """Twice the log-likelihood lost when both starts must have one critical width."""
    probability: float
    """Probability of so large a ratio without a loop (chi^2 with one degree of freedom)."""


@dataclass(frozen=True)
class Jump:
    """The two branches of the stationary flow rate at the critical width."""

    upper: Uncertain
    """Jammed branch at w_c."""
    lower: Uncertain
    """Unjammed branch at w_c."""
    height: Uncertain
    """Their difference."""


@dataclass(frozen=True)
class DipTest:
    """The dip of a sample with its significance."""

    dip: float
    """Largest distance of the empirical distribution from the nearest one with a single peak: 1/(2n) at least, 1/4 at
    most (two equal atoms)."""
    probability: float
    """Probability of a dip at least as large in as many uniform numbers, the single-peaked case that is hardest to
    tell."""
    simulations: int
    """Simulated samples behind it."""


@dataclass(frozen=True)
class Peak:
    """One peak of a mixture."""

    weight: float
    """Fraction of the values that belong to it."""
    mean: float
    """Its mean."""
    mean_error: float
    """Standard error of the mean."""
    deviation: float
    """Its standard deviation."""


@dataclass(frozen=True)
class TwoPeaks:
    """Mixture of two normal distributions against a single one."""

    single: Peak
    """Mean and deviation of all values as one peak."""
    lower: Peak
    """Peak at the smaller mean."""
    upper: Peak
    """Peak at the larger mean."""
    criterion_gain: float
    """Schwarz's criterion of one peak less that of two: positive for two peaks, beyond 10 very clearly so."""
    separation: float
    """Distance of the peaks over their widths, sqrt(2) |m_2 - m_1|/sqrt(s_1^2 + s_2^2): two peaks can be seen beyond
    2."""


@dataclass(frozen=True)
class LineFit:
    """A straight line through points with errors."""

    intercept: Uncertain
    """Value at x = 0."""
    slope: Uncertain
    """Slope."""
    covariance: float
    """Covariance of intercept and slope."""
    chi_squared: float
    """Sum of the squared deviations in units of their errors."""
    degrees_of_freedom: int
    """Points less parameters."""
    probability: float
    """Probability of a chi^2 at least as large if the line and the errors are right; 1 without degrees of freedom."""


@dataclass(frozen=True)
class CurveFit:
    """A parabola through points with errors, beside the straight line."""

    constant: Uncertain
    """Value of the parabola at x = 0."""
    linear: Uncertain
    """Its slope at x = 0."""
    quadratic: Uncertain
    """Coefficient of x^2."""
    chi_squared: float
    """chi^2 of the parabola."""
    degrees_of_freedom: int
    """Points less parameters."""
    probability: float
    """Probability of a chi^2 at least as large if the parabola and the errors are right."""
    line: LineFit
    """The straight line through the same points."""
    linearity: float
    """Probability of a quadratic term at least as large, of either sign, if the points lie on a line."""


@dataclass(frozen=True)
class WidthEnsemble:
    """Transition times of the runs at one width, estimated in three ways."""

    width: float
    """Width w."""
    observed: int
    """Runs with an observed transition."""
    censored: int
    """Censored runs."""
    watched: float
    """Longest time at which a run was watched."""
    naive_mean: float | None
    """Mean of the observed times alone, which near w_c lies below the truth for want of the long ones."""
    restricted: RestrictedMoments | None
    """Mean and variance of min(tau, `watched`): no distribution assumed. `None` below 3 transitions."""
    fit: LifetimeFit | None
    """Maximum likelihood under censoring, chi_tau its variance; `None` where it has no estimate."""


@dataclass(frozen=True)
class WindowRunsFit:
    """A law fitted to the runs within a window of widths."""

    least: float
    """Smallest width of the window."""
    largest: float
    """Largest width of the window."""
    fit: LawRunsFit
    """The fit."""


@dataclass(frozen=True)
class ScatterLawFit:
    """Power laws of the mean transition time and of its relative variance, fitted to the runs at all widths."""

    critical_width: Uncertain
    """Critical width w_c."""
    exponent: Uncertain
    """alpha of tau ~ (w_c - w)^-alpha."""
    scatter_exponent: Uncertain
    """q of chi_tau/tau^2 ~ (w_c - w)^-q."""
    variance_exponent: Uncertain
    """beta = 2 alpha + q of chi_tau ~ (w_c - w)^-beta."""
    ln_amplitude: float
    """ln A of tau = A (w_c - w)^-alpha."""
    ln_scatter: float
    """ln C of chi_tau/tau^2 = C (w_c - w)^-q."""
    log_likelihood: float
    """Largest log-likelihood; five parameters."""
    chance_probability: float
    """Probability of so large a likelihood ratio if chi_tau/tau^2 = 1 at all widths: nucleation at a constant rate."""
    constant_probability: float
    """The same if chi_tau/tau^2 has one value at all widths, q = 0."""
    inverse_probability: float
    """The same if chi_tau/tau^2 ~ 1/(w_c - w), q = 1."""
    observed: int
    """Runs with an observed transition."""
    censored: int
    """Censored runs."""


@dataclass(frozen=True)
class SecondMoment:
    """Mean and variance of j = J/Jmax across an ensemble at one time."""

    mean: float
    """Mean `<j>`."""
    variance: float
    """`chi_J = <j^2> - <j>^2`, estimated without bias (divisor n - 1)."""
    runs: int
    """Runs behind it, held ones included."""


@dataclass(frozen=True)
class MomentPeak:
    """Peak over time of the second moment."""

    index: Uncertain
    """Position of the peak in the series, from 0, with bootstrap errors."""
    value: Uncertain
    """Height of the peak, with bootstrap errors."""
    bias: float
    """Mean height of the resampled peaks less `value`; the true height is likely near `value - bias`."""


@dataclass(frozen=True)
class Moments:
    """Mean and variance of independent values, with jackknife errors."""

    mean: float
    """Mean."""
    mean_error: float
    """Standard error of the mean."""
    variance: float
    """Variance `<x^2> - <x>^2` of the distribution, estimated without bias (divisor n - 1)."""
    variance_error: float
    """Standard error of the variance, by the jackknife."""


@dataclass(frozen=True)
class CollapseQuality:
    """How well scaled curves lie on a common one."""

    quality: float
    """Mean squared distance S from the master curve in units of the errors: about 1 for a perfect collapse, the larger
    the worse. Meaningless without the overlap."""
    overlap: float
    """Fraction of all points that lie within the range of another curve, and so are compared at all. Points that the
    scaling sends to infinity, such as those beyond the critical width, count among all."""
    compared: int
    """Points compared."""
    is_connected: bool
    """Whether the curves hang together: each is compared with another, and no group stands apart from the rest."""


@dataclass(frozen=True)
class CollapseFit:
    """Best parameters of a scaling."""

    parameters: tuple[float, ...]
    """Parameters, in the order of the scaling."""
    quality: CollapseQuality
    """Quality and overlap of the collapse."""
    agreeing: int
    """Starts whose search ended at this minimum to within 1 per cent of S, of all starts: few say that there are
    others."""
    starts: int
    """Searches made."""
    converged: bool
    """Whether the best search converged."""


@dataclass(frozen=True)
class Resampled:
    """Estimates from resampled data."""

    estimates: tuple[Uncertain, ...]
    """The estimates with their bootstrap errors and percentile intervals."""
    succeeded: int
    """Resamples that gave estimates."""
    failed: int
    """Resamples that did not, such as those left without a transition. Where these are more than a few, the intervals
    are too short."""
