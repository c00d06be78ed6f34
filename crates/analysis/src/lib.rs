//! Estimators with error bars, on plain slices of numbers.
//!
//! Tables come in as columns and answers go out with their uncertainties. One estimator is one file. This crate knows
//! nothing of grains, engines or file formats; every sum is taken in the order of its input and every random number
//! comes from a given seed, so that an answer is the same on every machine.
//!
//! | question | estimators |
//! |---|---|
//! | when does a run change? | [`TransitionDetector`], [`transition_time`] |
//! | is a series stationary, and its mean? | [`stationary_mean`], [`stationarity`], [`mean_with_error`], [`autocorrelation_time`] |
//! | how are transition times distributed? | [`Survival`], [`restricted_moments`], [`fit_lifetime`], [`fit_shifted_exponential`], [`ensembles_by_width`] |
//! | where and how does the time diverge? | [`fit_law_to_runs`], [`fit_law_to_runs_in_windows`], [`fit_law`], [`fit_law_to_nearest`], [`fit_inverse_line`], [`fit_inverse_parabola`] |
//! | does it diverge at all? | [`compare_laws`], [`compare_laws_with_scatter`], [`fit_law_with_scatter`], [`power_exponent`] |
//! | how does the flow rate fluctuate? | [`ensemble_moments`], [`second_moment`], [`second_moment_peak`] |
//! | do the curves collapse? | [`Collapse`], [`Scaling`], [`collapse_quality`] |
//! | is the transition of first order? | [`dip_test`], [`two_peaks`], [`jump_height`], [`fraction_crossing`], [`hysteresis`] |
//! | how does w_c depend on the strain rate? | [`fit_line`], [`fit_line_to_scatter`], [`fit_parabola`] |
//!
//! Numbers with uncertainties are [`Uncertain`]: value, standard error, and intervals of 68 and 95 per cent. They display
//! themselves as `2.794 ± 0.003`; [`number`] writes other numbers in the same way.

#![forbid(unsafe_code)]

#[cfg(test)]
#[macro_use]
mod tests;

mod autocorrelation;
mod blocks;
mod bootstrap;
mod collapse;
mod collapse_estimate;
mod collapse_fit;
mod columns;
mod dip;
mod divergence;
mod ensemble;
mod ensembles;
mod error;
mod family;
mod hysteresis;
mod inverse_law;
mod jump;
mod law;
mod law_fit;
mod law_likelihood;
mod law_runs;
mod lifetime;
mod line;
mod logistic;
mod master_curve;
mod mixture;
pub mod number;
mod numerics;
mod regression;
mod scaling;
mod scatter_law;
mod second_moment;
mod shifted;
mod stationarity;
mod survival;
mod transition;
mod truncation;
mod uncertain;

pub use autocorrelation::{AutocorrelationTime, autocorrelation_time};
pub use blocks::{Estimate, mean_with_error};
pub use bootstrap::Bootstrap;
pub use collapse::{CollapseQuality, Curve, CurvePoint, collapse_quality};
pub use collapse_estimate::{CollapseEstimate, JointTest};
pub use collapse_fit::{Collapse, Transform};
pub use columns::jackknife_error;
pub use dip::{DipTest, dip_test};
pub use divergence::{LawEvidence, compare_laws, compare_laws_with_scatter};
pub use ensemble::{Moments, ensemble_moments, mean_and_error, variance};
pub use ensembles::{WidthEnsemble, ensembles_by_width};
pub use error::Error;
pub use family::Family;
pub use hysteresis::{Hysteresis, hysteresis};
pub use inverse_law::{InverseFit, fit_inverse_line, fit_inverse_parabola};
pub use jump::{Jump, jump_height};
pub use law::Law;
pub use law_fit::{LawFit, NearestFit, fit_law, fit_law_to_nearest};
pub use law_runs::{LawRunsFit, WindowRunsFit, fit_law_to_runs, fit_law_to_runs_in_windows};
pub use lifetime::{LifetimeFit, fit_lifetime};
pub use line::{
    CurveFit, LineFit, ScatteredLine, fit_line, fit_line_to_scatter, fit_parabola, power_exponent,
};
pub use logistic::{FractionCrossing, fraction_crossing};
pub use mixture::{Histogram, Peak, TwoPeaks, histogram, two_peaks};
pub use numerics::gamma::chi_squared_tail;
pub use scaling::Scaling;
pub use scatter_law::{ScatterLawFit, fit_law_with_scatter};
pub use second_moment::{AfterEnd, MomentPeak, SecondMoment, second_moment, second_moment_peak};
pub use shifted::{ShiftedExponentialFit, fit_shifted_exponential};
pub use stationarity::{Stationarity, stationarity};
pub use survival::{RestrictedMoments, Survival, SurvivalStep, restricted_moments};
pub use transition::{
    CONFIRMATION_PERIODS, Direction, Transition, TransitionDetector, transition_time, watched,
};
pub use truncation::{StationaryMean, stationary_mean};
pub use uncertain::{Interval, Uncertain};
