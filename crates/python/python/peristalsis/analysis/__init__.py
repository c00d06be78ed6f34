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

from ._collapse import Collapse, CollapseResult
from ._evidence import compare_laws, compare_laws_with_scatter
from ._inverse import fit_inverse_line, fit_inverse_parabola
from ._laws import ensembles_by_width, fit_law_to_runs, fit_law_to_runs_in_windows, fit_law_with_scatter
from ._order import dip_test, fraction_crossing, hysteresis, jump_height, two_peaks
from ._points import fit_law, fit_law_to_nearest, fit_line, fit_line_to_scatter, fit_parabola, power_exponent
from ._results import (
    AutocorrelationTime,
    CollapseEstimate,
    CollapseQuality,
    CurveFit,
    DipTest,
    Estimate,
    FractionCrossing,
    Hysteresis,
    Interval,
    InverseFit,
    JointTest,
    Jump,
    LawEvidence,
    LawFit,
    LawRunsFit,
    LifetimeFit,
    LineFit,
    MomentPeak,
    Moments,
    NearestFit,
    Peak,
    RestrictedMoments,
    ScatterLawFit,
    ScatteredLine,
    SecondMoment,
    ShiftedExponentialFit,
    Stationarity,
    StationaryMean,
    SurvivalStep,
    TwoPeaks,
    Uncertain,
    WidthEnsemble,
    WindowRunsFit,
)
from ._series import (
    autocorrelation_time,
    ensemble_moments,
    mean_with_error,
    second_moment,
    second_moment_peak,
    stationarity,
    stationary_mean,
)
from ._transitions import (
    Survival,
    TransitionTime,
    fit_lifetime,
    fit_shifted_exponential,
    restricted_moments,
    transition_time,
)

__all__ = [
    "AutocorrelationTime",
    "Collapse",
    "CollapseEstimate",
    "CollapseQuality",
    "CollapseResult",
    "CurveFit",
    "DipTest",
    "Estimate",
    "FractionCrossing",
    "Hysteresis",
    "Interval",
    "InverseFit",
    "JointTest",
    "Jump",
    "LawEvidence",
    "LawFit",
    "LawRunsFit",
    "LifetimeFit",
    "LineFit",
    "MomentPeak",
    "Moments",
    "NearestFit",
    "Peak",
    "RestrictedMoments",
    "ScatterLawFit",
    "ScatteredLine",
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
    "compare_laws_with_scatter",
    "dip_test",
    "ensemble_moments",
    "ensembles_by_width",
    "fit_inverse_line",
    "fit_inverse_parabola",
    "fit_law",
    "fit_law_to_nearest",
    "fit_law_to_runs",
    "fit_law_to_runs_in_windows",
    "fit_law_with_scatter",
    "fit_lifetime",
    "fit_line",
    "fit_line_to_scatter",
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


def __dir__() -> list[str]:
    return sorted(__all__)
