"""What estimators answer. Made by scripts/python_results.py from the schemas of these types in Rust."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal


@dataclass(frozen=True)
class AutocorrelationTime:
    """Integrated autocorrelation time of a series.

    Attributes
    ----------
    time : float
        tau = 1/2 + sum of the normalised autocorrelations, in samples; 1/2 for uncorrelated samples.
    error : float
        Its standard error, 2 |tau| sqrt((W + 1/2 - tau)/n); for exponential correlations some 15 per cent too large,
        and meaningless unless converged.
    window : int
        Largest lag W of the sum, in samples.
    converged : bool
        Whether the window closed by itself; if not, `time` is a lower bound, and the series is too short. Of a series
        shorter than 100 tau the time comes out too small even so.

    Examples
    --------
    >>> import numpy as np
    >>> from peristalsis import analysis
    >>> series = np.random.default_rng(1).normal(size=4096)
    >>> found = analysis.autocorrelation_time(series)
    >>> found.converged, abs(found.time - 0.5) < 3 * found.error
    (True, True)
    """

    time: float
    error: float
    window: int
    converged: bool


@dataclass(frozen=True)
class CollapseEstimate:
    """Parameters of a scaling by the likelihood of one common curve, with intervals, and whether they can be trusted.

    Attributes
    ----------
    parameters : tuple[Uncertain, ...]
        Parameters, in the order of the scaling; intervals from the profile of the likelihood, infinite to a side that
        the points leave open.
    correction : float | None
        Power of the curves' parameter in the correction to scaling that was allowed for, if one was.
    quality : CollapseQuality
        Quality S and overlap of the collapse there; S knows no correction.
    stretch : float
        Factor by which the errors are stretched, 1 at least: how much more the points scatter than their errors say.
    agreeing : int
        Searches that ended here, of all.
    starts : int
        Searches made.
    trusted : bool
        Whether there is no doubt.
    doubts : tuple[str, ...]
        Reasons not to trust the parameters or their errors, in words.

    Examples
    --------
    >>> import numpy as np
    >>> from peristalsis import analysis
    >>> x = np.linspace(-0.5, 0.5, 21)
    >>> curves = [(size, x, size**-0.5 / (1 + np.exp(x * size)), np.full(21, 0.003)) for size in (4.0, 8.0, 16.0)]
    >>> collapse = analysis.Collapse(curves, "finite_size")
    >>> estimate = collapse.fit([0.4, 0.9, 0.0], [0.1, 0.1, 0.02], starts=2).estimate
    >>> [round(parameter.value, 1) for parameter in estimate.parameters], estimate.starts
    ([0.5, 1.0, 0.0], 2)
    """

    parameters: tuple[Uncertain, ...]
    correction: float | None
    quality: CollapseQuality
    stretch: float
    agreeing: int
    starts: int
    trusted: bool
    doubts: tuple[str, ...]


@dataclass(frozen=True)
class CollapseQuality:
    """How well scaled curves lie on a common one.

    Attributes
    ----------
    quality : float
        Mean squared distance S from the master curve in units of the errors: about 1 for a perfect collapse, the larger
        the worse. Meaningless without the overlap.
    overlap : float
        Fraction of all points that lie within the range of another curve, and so are compared at all. Points that the
        scaling sends to infinity, such as those beyond the critical width, count among all.
    compared : int
        Points compared.
    is_connected : bool
        Whether the curves hang together: each is compared with another, and no group stands apart from the rest.

    Examples
    --------
    >>> import numpy as np
    >>> from peristalsis import analysis
    >>> x = np.linspace(-0.5, 0.5, 21)
    >>> curves = [(size, x, size**-0.5 / (1 + np.exp(x * size)), np.full(21, 0.003)) for size in (4.0, 8.0, 16.0)]
    >>> collapse = analysis.Collapse(curves, "finite_size")
    >>> found = collapse.quality([0.5, 1.0, 0.0])
    >>> found.quality < 0.1, found.is_connected, found.compared, found.overlap > 0.5
    (True, True, 51, True)
    """

    quality: float
    overlap: float
    compared: int
    is_connected: bool


@dataclass(frozen=True)
class CurveFit:
    """A parabola through points with errors, beside the straight line.

    Attributes
    ----------
    constant : Uncertain
        Value of the parabola at x = 0.
    linear : Uncertain
        Its slope at x = 0.
    quadratic : Uncertain
        Coefficient of x^2.
    chi_squared : float
        chi^2 of the parabola.
    degrees_of_freedom : int
        Points less parameters.
    probability : float
        Probability of a chi^2 at least as large if the parabola and the errors are right.
    line : LineFit
        The straight line through the same points.
    linearity : float
        Probability of a quadratic term at least as large, of either sign, if the points lie on a line.

    Examples
    --------
    >>> from peristalsis import analysis
    >>> fit = analysis.fit_parabola([0, 1, 2, 3], [1, 2, 5, 10], [0.1] * 4)
    >>> round(fit.quadratic.value, 6), fit.linearity < 0.01
    (1.0, True)
    """

    constant: Uncertain
    linear: Uncertain
    quadratic: Uncertain
    chi_squared: float
    degrees_of_freedom: int
    probability: float
    line: LineFit
    linearity: float


@dataclass(frozen=True)
class DipTest:
    """The dip of a sample with its significance.

    Attributes
    ----------
    dip : float
        Largest distance of the empirical distribution from the nearest one with a single peak: 1/(2n) at least, 1/4 at
        most (two equal atoms).
    probability : float
        Probability of a dip at least as large in as many uniform numbers, the single-peaked case that is hardest to
        tell.
    simulations : int
        Simulated samples behind it.

    Examples
    --------
    >>> import numpy as np
    >>> from peristalsis import analysis
    >>> apart = np.append(np.linspace(0, 1, 50), np.linspace(8, 9, 50))
    >>> analysis.dip_test(apart, resamples=200).probability < 0.01
    True
    """

    dip: float
    probability: float
    simulations: int


@dataclass(frozen=True)
class Estimate:
    """Mean of a series with its statistical error.

    Attributes
    ----------
    mean : float
        Mean of all samples.
    error : float
        Standard error of the mean (one standard deviation), correlations included.
    error_uncertainty : float
        Standard error of `error` itself: error/sqrt(2 (blocks - 1)), times sqrt(5/2) where shorter blocks have their
        part in it.
    autocorrelation_time : float
        Integrated autocorrelation time that the error implies, in samples: (error/error of uncorrelated samples)^2/2.
    block_length : int
        Samples in a block.
    blocks : int
        Blocks behind the error.
    samples : int
        Samples in the series.
    converged : bool
        Whether the error has reached its plateau. Of a series shorter than some 100 correlation times it comes out too
        small in most cases, with a plateau or without.

    Examples
    --------
    >>> from peristalsis import analysis
    >>> estimate = analysis.mean_with_error([1.0, 3.0] * 64)
    >>> estimate.mean, estimate.samples
    (2.0, 128)
    """

    mean: float
    error: float
    error_uncertainty: float
    autocorrelation_time: float
    block_length: int
    blocks: int
    samples: int
    converged: bool


@dataclass(frozen=True)
class FractionCrossing:
    """The width at which the fraction of jammed runs falls through one half.

    Attributes
    ----------
    width : Uncertain
        The width, with intervals by profile likelihood; where the runs are separated from the bracket that they leave.
    spread : float
        Range of widths over which the fraction falls, 1/steepness, by maximum likelihood; 0 where the runs are
        separated.
    last_all : float | None
        Largest width at which all runs jam, with all below it doing so; `None` where already at the least some do not.
    first_none : float | None
        Smallest width at which none jams, nor above it; `None` where at the largest some still do.
    is_separated : bool
        Whether the fraction falls from 1 to 0 between two neighbouring widths, or at a single one between: the data
        then bracket the width and say nothing of the spread.
    log_likelihood : float
        Largest log-likelihood.
    runs : int
        Runs.

    Examples
    --------
    >>> import numpy as np
    >>> from peristalsis import analysis
    >>> width = np.repeat(np.linspace(2.5, 2.9, 9), 4)
    >>> found = analysis.fraction_crossing(width, width < 2.66)
    >>> round(found.last_all, 2), round(found.first_none, 2), found.is_separated
    (2.65, 2.7, True)
    """

    width: Uncertain
    spread: float
    last_all: float | None
    first_none: float | None
    is_separated: bool
    log_likelihood: float
    runs: int


@dataclass(frozen=True)
class Hysteresis:
    """Width of the hysteresis loop and whether there is one.

    Attributes
    ----------
    from_rest : FractionCrossing
        w_c: half of the runs started from rest jam.
    from_jammed : FractionCrossing
        w_c': half of the runs started jammed stay so.
    loop_width : Uncertain
        Width of the loop, w_c' - w_c.
    likelihood_ratio : float
        Twice the log-likelihood lost when both starts must have one critical width.
    probability : float
        Probability of so large a ratio without a loop (chi^2 with one degree of freedom).

    Examples
    --------
    >>> import numpy as np
    >>> from peristalsis import analysis
    >>> width = np.repeat(np.linspace(2.5, 2.9, 9), 4)
    >>> loop = analysis.hysteresis(width, width < 2.66, width, width < 2.81)
    >>> round(loop.loop_width.value, 2)
    0.15
    """

    from_rest: FractionCrossing
    from_jammed: FractionCrossing
    loop_width: Uncertain
    likelihood_ratio: float
    probability: float


@dataclass(frozen=True)
class Interval:
    """Confidence interval; a side that the data leave open is infinite.

    Attributes
    ----------
    lower : float
        Lower end.
    upper : float
        Upper end.

    Examples
    --------
    >>> from peristalsis import analysis
    >>> analysis.Interval(0.5, 1.5).upper
    1.5
    """

    lower: float
    upper: float


@dataclass(frozen=True)
class InverseFit:
    """1/y = B (w_c - w) + C (w_c - w)^2 fitted to values with errors: a divergence with an exponent of 1 exactly.

    Attributes
    ----------
    critical_width : Uncertain
        Critical width w_c, where 1/y falls through 0; intervals by the profile of chi^2, infinite where the points
        leave them open.
    linear : Uncertain
        B, positive; normal intervals.
    quadratic : Uncertain | None
        C; `None` for a line.
    chi_squared : float
        Sum of the squared deviations of 1/y in units of their errors.
    degrees_of_freedom : int
        Points less free parameters.
    probability : float
        Probability of a chi^2 at least as large if the law and the errors are right; 1 without degrees of freedom.
    explained : float
        R^2 = 1 - chi^2/chi^2 of a constant: the part of the weighted scatter of 1/y that the law accounts for.

    Examples
    --------
    >>> from peristalsis import analysis
    >>> fit = analysis.fit_inverse_line([2, 2.5, 2.75], [2, 4, 8], [0.1, 0.2, 0.4])     # tau = 2/(3 - w)
    >>> round(fit.critical_width.value, 6), round(fit.linear.value, 6), fit.quadratic, fit.degrees_of_freedom
    (3.0, 0.5, None, 1)
    """

    critical_width: Uncertain
    linear: Uncertain
    quadratic: Uncertain | None
    chi_squared: float
    degrees_of_freedom: int
    probability: float
    explained: float


@dataclass(frozen=True)
class JointTest:
    """Several parameters of a collapse against values claimed for them, all at once.

    Attributes
    ----------
    chi_squared : float
        Rise of -2 ln likelihood, minimal over all else, from the best to the values claimed.
    degrees_of_freedom : int
        Parameters compared.
    probability : float
        Probability of a rise at least as large if the values claimed are right.

    Examples
    --------
    >>> import numpy as np
    >>> from peristalsis import analysis
    >>> x = np.linspace(-0.5, 0.5, 21)
    >>> curves = [(size, x, size**-0.5 / (1 + np.exp(x * size)), np.full(21, 0.003)) for size in (4.0, 8.0, 16.0)]
    >>> collapse, steps = analysis.Collapse(curves, "finite_size"), [0.1, 0.1, 0.02]
    >>> found = collapse.fit([0.4, 0.9, 0.0], steps, starts=2)
    >>> right, wrong = (collapse.joint_test(found, values, steps) for values in ([0.5, 1.0, None], [0.7, 1.0, None]))
    >>> right.probability > 0.5, wrong.probability < 0.001, right.degrees_of_freedom
    (True, True, 2)
    """

    chi_squared: float
    degrees_of_freedom: int
    probability: float


@dataclass(frozen=True)
class Jump:
    """The two branches of the stationary flow rate at the critical width.

    Attributes
    ----------
    upper : Uncertain
        Jammed branch at w_c.
    lower : Uncertain
        Unjammed branch at w_c.
    height : Uncertain
        Their difference.

    Examples
    --------
    >>> from peristalsis import analysis
    >>> upper, lower = ([2.6, 2.7], [1.0, 0.9], [0.01, 0.01]), ([2.9], [0.2], [0.03])
    >>> jump = analysis.jump_height(upper, lower, 2.8)
    >>> round(jump.upper.value, 3), round(jump.height.value, 3)
    (0.8, 0.6)
    """

    upper: Uncertain
    lower: Uncertain
    height: Uncertain


@dataclass(frozen=True)
class LawEvidence:
    """What the runs say for one law.

    Attributes
    ----------
    law : Literal["power", "exponential"] | dict[str, Any]
        The law.
    log_likelihood : float
        Largest log-likelihood.
    akaike : float
        Akaike's criterion 2 p - 2 ln L.
    excess : float
        Akaike's criterion minus the criterion of the best law: beyond some 10 the law has next to no support.
    weight : float
        Akaike weight exp(-excess/2) over the sum of all laws compared: how probable it is to be the nearest of them.
    critical_width : float | None
        Best w_c, infinite where the law does best as an exponential one; `None` for a law without w_c.

    Examples
    --------
    >>> import numpy as np
    >>> from peristalsis import analysis
    >>> width = np.repeat([2.4, 2.5, 2.6, 2.7], 30)
    >>> time = np.random.default_rng(1).exponential(2.0 / (2.8 - width))
    >>> evidence = analysis.compare_laws(["power", "exponential"], width, time, family="exponential")
    >>> round(sum(law.weight for law in evidence), 6)
    1.0
    """

    law: Literal["power", "exponential"] | dict[str, Any]
    log_likelihood: float
    akaike: float
    excess: float
    weight: float
    critical_width: float | None


@dataclass(frozen=True)
class LawFit:
    """A law fitted to values with errors at several widths.

    Attributes
    ----------
    law : Literal["power", "exponential"] | dict[str, Any]
        The law.
    critical_width : Uncertain | None
        Critical width w_c, with intervals by the profile of chi^2; `None` for a law without one. An upper end of
        infinity says that the points do not tell the law from an exponential.
    exponent : Uncertain
        Exponent, or coefficient of the barrier, B, with intervals by the profile of chi^2.
    ln_amplitude : Uncertain
        ln A, in the normal approximation.
    chi_squared : float
        Sum of the squared deviations of ln y in units of their errors, the term of a known w_c included.
    degrees_of_freedom : int
        Points less free parameters.
    probability : float
        Probability of a chi^2 at least as large if the law and the errors are right.

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

    law: Literal["power", "exponential"] | dict[str, Any]
    critical_width: Uncertain | None
    exponent: Uncertain
    ln_amplitude: Uncertain
    chi_squared: float
    degrees_of_freedom: int
    probability: float


@dataclass(frozen=True)
class LawRunsFit:
    """A law of the mean transition time fitted to the runs at all widths.

    Attributes
    ----------
    law : Literal["power", "exponential"] | dict[str, Any]
        The law of the mean.
    family : Literal["exponential", "gamma", "weibull"]
        The family of the distribution about the mean.
    critical_width : Uncertain | None
        Critical width w_c; `None` for a law without one. Its lower end never lies below a width that saw a transition;
        an upper end of infinity says that the runs do not tell the law from an exponential.
    exponent : Uncertain
        Exponent, or coefficient of the barrier, B.
    ln_amplitude : float
        ln A.
    shape : Uncertain | None
        Shape k, common to all widths; `None` for the exponential family.
    log_likelihood : float
        Largest log-likelihood.
    observed : int
        Runs with an observed transition.
    censored : int
        Censored runs.

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

    law: Literal["power", "exponential"] | dict[str, Any]
    family: Literal["exponential", "gamma", "weibull"]
    critical_width: Uncertain | None
    exponent: Uncertain
    ln_amplitude: float
    shape: Uncertain | None
    log_likelihood: float
    observed: int
    censored: int


@dataclass(frozen=True)
class LifetimeFit:
    """A distribution fitted to the transition times of one ensemble.

    Attributes
    ----------
    family : Literal["exponential", "gamma", "weibull"]
        Family of the distribution.
    mean : Uncertain
        Mean `<tau>`, of the whole distribution, beyond the time watched too.
    variance : Uncertain
        Variance `chi_tau = <tau^2> - <tau>^2`.
    shape : Uncertain | None
        Shape k; `None` for the exponential.
    log_likelihood : float
        Largest log-likelihood, of densities in the unit of the times: comparable between families on the same runs.
    observed : int
        Runs with an observed transition.
    censored : int
        Censored runs.

    Examples
    --------
    >>> from peristalsis import analysis
    >>> fit = analysis.fit_lifetime([10.0, 20.0, 30.0], [True, True, False], family="exponential")
    >>> round(fit.mean.value, 6), fit.observed, fit.censored
    (30.0, 2, 1)
    """

    family: Literal["exponential", "gamma", "weibull"]
    mean: Uncertain
    variance: Uncertain
    shape: Uncertain | None
    log_likelihood: float
    observed: int
    censored: int


@dataclass(frozen=True)
class LineFit:
    """A straight line through points with errors.

    Attributes
    ----------
    intercept : Uncertain
        Value at x = 0.
    slope : Uncertain
        Slope.
    covariance : float
        Covariance of intercept and slope.
    chi_squared : float
        Sum of the squared deviations in units of their errors.
    degrees_of_freedom : int
        Points less parameters.
    probability : float
        Probability of a chi^2 at least as large if the line and the errors are right; 1 without degrees of freedom.

    Examples
    --------
    >>> from peristalsis import analysis
    >>> fit = analysis.fit_line([0, 1, 2], [1, 3, 5], [0.1, 0.1, 0.1])
    >>> round(fit.intercept.value, 6), round(fit.slope.value, 6), fit.degrees_of_freedom
    (1.0, 2.0, 1)
    """

    intercept: Uncertain
    slope: Uncertain
    covariance: float
    chi_squared: float
    degrees_of_freedom: int
    probability: float


@dataclass(frozen=True)
class MomentPeak:
    """Peak over time of the second moment.

    Attributes
    ----------
    index : Uncertain
        Position of the peak in the series, from 0, with bootstrap errors.
    value : Uncertain
        Height of the peak, with bootstrap errors.
    bias : float
        Mean height of the resampled peaks less the variance of the n runs themselves there, `value` (n - 1)/n: the
        largest of many noisy values lies too high, and a resample repeats that. The true height is likely near `value -
        bias`.

    Examples
    --------
    >>> from peristalsis import analysis
    >>> runs = [[0.0, 1.0, 1.0], [0.0, 0.5, 1.0], [0.0, 0.0, 1.0]] * 4
    >>> peak = analysis.second_moment_peak(runs, resamples=50)
    >>> peak.index.value, round(peak.value.value, 3)
    (1.0, 0.182)
    """

    index: Uncertain
    value: Uncertain
    bias: float


@dataclass(frozen=True)
class Moments:
    """Mean and variance of independent values, with jackknife errors.

    Attributes
    ----------
    mean : float
        Mean.
    mean_error : float
        Standard error of the mean.
    variance : float
        Variance `<x^2> - <x>^2` of the distribution, estimated without bias (divisor n - 1).
    variance_error : float
        Standard error of the variance, by the jackknife.

    Examples
    --------
    >>> from peristalsis import analysis
    >>> moments = analysis.ensemble_moments([[1.0], [2.0], [3.0]])[0]
    >>> moments.mean, moments.variance
    (2.0, 1.0)
    """

    mean: float
    mean_error: float
    variance: float
    variance_error: float


@dataclass(frozen=True)
class NearestFit:
    """A law fitted to the values at the largest widths alone.

    Attributes
    ----------
    widths : int
        How many widths, the largest ones.
    least : float
        The least of them.
    fit : LawFit
        The fit.

    Examples
    --------
    >>> import numpy as np
    >>> from peristalsis import analysis
    >>> width = np.linspace(2.4, 2.7, 8)
    >>> time = 3.0 * (2.8 - width) ** -1.5
    >>> fits = analysis.fit_law_to_nearest("power", width, time, 0.01 * time)
    >>> fits[0].widths, round(fits[0].fit.exponent.value, 3)
    (4, 1.5)
    """

    widths: int
    least: float
    fit: LawFit


@dataclass(frozen=True)
class Peak:
    """One peak of a mixture.

    Attributes
    ----------
    weight : float
        Fraction of the values that belong to it.
    mean : float
        Its mean.
    mean_error : float
        Standard error of the mean, as if it were known which values belong to the peak: too small where peaks overlap.
    deviation : float
        Its standard deviation.

    Examples
    --------
    >>> import numpy as np
    >>> from peristalsis import analysis
    >>> apart = np.append(np.linspace(0, 1, 50), np.linspace(8, 9, 50))
    >>> peak = analysis.two_peaks(apart).upper
    >>> round(peak.mean, 2), round(peak.weight, 2)
    (8.5, 0.5)
    """

    weight: float
    mean: float
    mean_error: float
    deviation: float


@dataclass(frozen=True)
class RestrictedMoments:
    """Mean and variance of min(tau, horizon).

    Attributes
    ----------
    horizon : float
        Time at which every longer transition time is cut off.
    mean : Uncertain
        Restricted mean, with normal intervals.
    variance : Uncertain
        Restricted variance, with its error by the jackknife over runs.

    Examples
    --------
    >>> from peristalsis import analysis
    >>> analysis.restricted_moments([1.0, 2.0, 3.0, 4.0], horizon=2.0).mean.value
    1.75
    """

    horizon: float
    mean: Uncertain
    variance: Uncertain


@dataclass(frozen=True)
class ScatterLawFit:
    """Power laws of the mean transition time and of its relative variance, fitted to the runs at all widths.

    Attributes
    ----------
    critical_width : Uncertain
        Critical width w_c; intervals normal in ln(w_c - largest width that saw a transition).
    exponent : Uncertain
        alpha of tau ~ (w_c - w)^-alpha. Intervals of alpha, q and beta are normal: where the largest width that saw a
        transition is far from w_c, those of 95 per cent cover 87 to 90.
    scatter_exponent : Uncertain
        q of chi_tau/tau^2 ~ (w_c - w)^-q.
    variance_exponent : Uncertain
        beta = 2 alpha + q of chi_tau ~ (w_c - w)^-beta.
    ln_amplitude : float
        ln A of tau = A (w_c - w)^-alpha.
    ln_scatter : float
        ln C of chi_tau/tau^2 = C (w_c - w)^-q.
    log_likelihood : float
        Largest log-likelihood; five parameters.
    chance_probability : float
        Probability of so large a likelihood ratio if chi_tau/tau^2 = 1 at all widths: nucleation at a constant rate.
    constant_probability : float
        The same if chi_tau/tau^2 has one value at all widths, q = 0.
    inverse_probability : float
        The same if chi_tau/tau^2 ~ 1/(w_c - w), q = 1.
    observed : int
        Runs with an observed transition.
    censored : int
        Censored runs.

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

    critical_width: Uncertain
    exponent: Uncertain
    scatter_exponent: Uncertain
    variance_exponent: Uncertain
    ln_amplitude: float
    ln_scatter: float
    log_likelihood: float
    chance_probability: float
    constant_probability: float
    inverse_probability: float
    observed: int
    censored: int


@dataclass(frozen=True)
class ScatteredLine:
    """A straight line through points that scatter about it by more than their errors.

    Attributes
    ----------
    line : LineFit
        The line; its errors are those of points and scatter, the intervals of intercept and slope Student's.
    determination : float
        R^2, the part of the weighted variance of y that the line explains.
    linearity : float | None
        Probability of a quadratic term at least as large if the points scatter about a line: F-test of line against
        parabola; `None` with three places, through which every parabola goes.

    Examples
    --------
    >>> from peristalsis import analysis
    >>> fit = analysis.fit_line_to_scatter([0, 1, 2], [1, 2, 6])
    >>> round(fit.line.slope.error, 4), round(fit.determination, 4), fit.linearity
    (0.866, 0.8929, None)
    """

    line: LineFit
    determination: float
    linearity: float | None


@dataclass(frozen=True)
class SecondMoment:
    """Mean and variance of j = J/Jmax across an ensemble at one time.

    Attributes
    ----------
    mean : float
        Mean `<j>`.
    variance : float
        `chi_J = <j^2> - <j>^2`, estimated without bias (divisor n - 1).
    runs : int
        Runs behind it, held ones included.

    Examples
    --------
    >>> from peristalsis import analysis
    >>> runs = [[0.0, 1.0], [0.0, 0.5], [0.0, 0.0]]
    >>> moment = analysis.second_moment(runs)[1]
    >>> moment.mean, moment.variance, moment.runs
    (0.5, 0.25, 3)
    """

    mean: float
    variance: float
    runs: int


@dataclass(frozen=True)
class ShiftedExponentialFit:
    """Shifted exponential distribution fitted to the transition times of one ensemble.

    Attributes
    ----------
    dead_time : Uncertain
        Dead time t_0 before which no transition happens, corrected for its bias; 0 at least.
    waiting_time : Uncertain
        Mean waiting time theta after the dead time; 1/theta is the rate.
    mean : Uncertain
        Mean `<tau>` = t_0 + theta.
    variance : Uncertain
        Variance `chi_tau = theta^2`.
    log_likelihood : float
        Largest log-likelihood, comparable with that of a `LifetimeFit` on the same runs.
    observed : int
        Runs with an observed transition.
    censored : int
        Censored runs.

    Examples
    --------
    >>> from peristalsis import analysis
    >>> fit = analysis.fit_shifted_exponential([10.0, 12.0, 16.0, 22.0])
    >>> fit.dead_time.value < 10.0 < fit.mean.value
    True
    """

    dead_time: Uncertain
    waiting_time: Uncertain
    mean: Uncertain
    variance: Uncertain
    log_likelihood: float
    observed: int
    censored: int


@dataclass(frozen=True)
class Stationarity:
    """Comparison of the two halves of a series.

    Attributes
    ----------
    first : Estimate
        Mean of the first half.
    second : Estimate
        Mean of the second half.
    score : float
        Difference of the means, second less first, in units of its standard error.

    Examples
    --------
    >>> import numpy as np
    >>> from peristalsis import analysis
    >>> halves = analysis.stationarity(np.random.default_rng(1).normal(size=1024))
    >>> abs(halves.score) < 3
    True
    """

    first: Estimate
    second: Estimate
    score: float


@dataclass(frozen=True)
class StationaryMean:
    """Mean of the stationary part of a series.

    Attributes
    ----------
    discarded : int
        Samples left out at the beginning.
    estimate : Estimate
        Mean of the rest with its error.
    halves : Stationarity
        Comparison of the halves of the rest.

    Examples
    --------
    >>> import numpy as np
    >>> from peristalsis import analysis
    >>> series = np.append(np.zeros(64), np.random.default_rng(1).normal(1.0, 0.1, size=512))
    >>> found = analysis.stationary_mean(series)
    >>> found.discarded >= 64, round(found.estimate.mean, 1)
    (True, 1.0)
    """

    discarded: int
    estimate: Estimate
    halves: Stationarity


@dataclass(frozen=True)
class SurvivalStep:
    """The survival curve just after one transition time.

    Attributes
    ----------
    time : float
        Time of the step, in the unit of the input.
    at_risk : int
        Runs watched up to this time without a transition before it.
    transitions : int
        Runs with their transition at this time.
    survival : Uncertain
        Probability S of no transition up to and including this time, with Greenwood's error and log-log intervals.

    Examples
    --------
    >>> from peristalsis import analysis
    >>> step = analysis.Survival([1.0, 2.0, 3.0], [True, False, True]).steps[0]
    >>> step.time, step.at_risk, round(step.survival.value, 3)
    (1.0, 3, 0.667)
    """

    time: float
    at_risk: int
    transitions: int
    survival: Uncertain


@dataclass(frozen=True)
class TwoPeaks:
    """Mixture of two normal distributions against a single one.

    Attributes
    ----------
    single : Peak
        Mean and deviation of all values as one peak.
    lower : Peak
        Peak at the smaller mean.
    upper : Peak
        Peak at the larger mean.
    criterion_gain : float
        Schwarz's criterion of one peak less that of two: positive for two peaks, beyond 10 very clearly so.
    separation : float
        Distance of the peaks over their widths, sqrt(2) |m_2 - m_1|/sqrt(s_1^2 + s_2^2): two peaks can be seen beyond
        2.

    Examples
    --------
    >>> import numpy as np
    >>> from peristalsis import analysis
    >>> apart = np.append(np.linspace(0, 1, 50), np.linspace(8, 9, 50))
    >>> peaks = analysis.two_peaks(apart)
    >>> round(peaks.lower.mean, 2), peaks.separation > 2
    (0.5, True)
    """

    single: Peak
    lower: Peak
    upper: Peak
    criterion_gain: float
    separation: float


@dataclass(frozen=True)
class Uncertain:
    """A number with its standard error and its confidence intervals.

    The intervals need not be symmetric, nor the error half of the narrow one: each estimator states whether they come
    from a profile likelihood, a bootstrap or the normal approximation.

    Attributes
    ----------
    value : float
        The estimate.
    error : float
        Its standard error (one standard deviation).
    interval_68 : Interval
        Interval that covers the truth in 68.27 per cent of repetitions.
    interval_95 : Interval
        Interval that covers the truth in 95 per cent of repetitions.

    Examples
    --------
    >>> from peristalsis import analysis
    >>> slope = analysis.fit_line([0, 1, 2], [1, 3, 5], [0.1, 0.1, 0.1]).slope
    >>> print(slope)
    2 +- 0.071
    >>> slope.interval_68.lower < 2.0 < slope.interval_68.upper
    True
    """

    value: float
    error: float
    interval_68: Interval
    interval_95: Interval

    def __str__(self) -> str:
        return f"{self.value:.6g} +- {self.error:.2g}"


@dataclass(frozen=True)
class WidthEnsemble:
    """Transition times of the runs at one width, estimated in three ways.

    Attributes
    ----------
    width : float
        Width w.
    observed : int
        Runs with an observed transition.
    censored : int
        Censored runs.
    watched : float
        Longest time at which a run was watched.
    naive_mean : float | None
        Mean of the observed times alone, which near w_c lies below the truth for want of the long ones; `None` without
        any.
    restricted : RestrictedMoments | None
        Mean and variance of min(tau, `watched`): no distribution assumed. `None` below 3 transitions.
    fit : LifetimeFit | None
        Maximum likelihood under censoring, chi_tau its variance; `None` where it has no estimate (no transition, no
        scatter).

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

    width: float
    observed: int
    censored: int
    watched: float
    naive_mean: float | None
    restricted: RestrictedMoments | None
    fit: LifetimeFit | None


@dataclass(frozen=True)
class WindowRunsFit:
    """A law fitted to the runs within a window of widths.

    Attributes
    ----------
    least : float
        Smallest width of the window.
    largest : float
        Largest width of the window.
    fit : LawRunsFit
        The fit.

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

    least: float
    largest: float
    fit: LawRunsFit
