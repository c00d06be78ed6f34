//! The module `peristalsis._core`: what the Python package `peristalsis` asks of Rust.
//!
//! The package's classes are written in Python (`python/peristalsis`); here is what they stand on. Every call that takes
//! long lets go of the interpreter, and every lock is taken and given back without holding it, so that neither can wait
//! for the other.

mod analysis;
mod collapse;
mod command;
mod configuration;
mod error;
mod frames;
mod heard;
mod load;
mod newtonian;
mod onlooker;
mod run;
mod schema;
mod study;
mod table;
mod title;
mod value;

use pyo3::prelude::*;

/// What a function of the package, written in Python, makes of one of our objects.
fn helped<'py, T: pyo3::PyTypeInfo>(
    object: &Bound<'py, T>,
    function: &str,
) -> PyResult<Bound<'py, PyAny>> {
    let module = object.py().import("peristalsis._tables")?;
    module.call_method1(function, (object,))
}

#[pyo3::pymodule]
mod _core {
    use super::*;

    #[pymodule_export]
    use crate::analysis::{
        autocorrelation_time, compare_laws, compare_laws_with_scatter, dip_test, ensemble_moments,
        ensembles_by_width, fit_inverse_line, fit_inverse_parabola, fit_law, fit_law_to_nearest,
        fit_law_to_runs, fit_law_to_runs_in_windows, fit_law_with_scatter, fit_lifetime, fit_line,
        fit_line_to_scatter, fit_parabola, fit_shifted_exponential, fraction_crossing, hysteresis,
        jump_height, mean_with_error, power_exponent, restricted_moments, second_moment,
        second_moment_peak, stationarity, stationary_mean, survival, survival_median,
        transition_time, two_peaks,
    };
    #[pymodule_export]
    use crate::collapse::{apply_collapse, fit_collapse, test_collapse};
    #[pymodule_export]
    use crate::command::command;
    #[pymodule_export]
    use crate::configuration::{Configuration, presets};
    #[pymodule_export]
    use crate::error::{
        AnalysisError, ConfigurationError, DivergedError, DoesNotFitError, SnapshotError,
        StudyFailure,
    };
    #[pymodule_export]
    use crate::frames::{Frames, check_frame_format, render, write_frame};
    #[pymodule_export]
    use crate::load::{contacts, load, volume, wall_radius};
    #[pymodule_export]
    use crate::newtonian::{Newtonian, trapping_threshold_at};
    #[pymodule_export]
    use crate::onlooker::{Onlooker, page};
    #[pymodule_export]
    use crate::run::Run;
    #[pymodule_export]
    use crate::schema::{results_schema, schema, summary_keys, summary_schema};
    #[pymodule_export]
    use crate::study::Study;
    #[pymodule_export]
    use crate::table::Table;
    #[pymodule_export]
    use crate::title::{flow_in_time, title, with_error};

    #[pymodule_export]
    #[allow(non_upper_case_globals, reason = "the name in Python")]
    const __version__: &str = peristalsis_run::VERSION;
    #[pymodule_export]
    const REVISION: &str = peristalsis_run::REVISION;

    /// Everything here is for the package alone: what is public says `peristalsis` itself.
    #[pymodule_init]
    fn without_all(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.delattr("__all__")
    }
}
