//! The module `peristalsis._core`: what the Python package `peristalsis` asks of Rust.
//!
//! The package's classes are written in Python (`python/peristalsis`); here is what they stand on. Every call that takes
//! long lets go of the interpreter, and every lock is taken and given back without holding it, so that neither can wait
//! for the other.

mod analysis;
mod configuration;
mod error;
mod newtonian;
mod run;
mod study;
mod table;

use pyo3::prelude::*;

#[pymodule]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", peristalsis_run::VERSION)?;
    module.add("REVISION", peristalsis_run::REVISION)?;
    module.add_class::<configuration::Configuration>()?;
    module.add_class::<run::Run>()?;
    module.add_class::<table::Table>()?;
    module.add_class::<newtonian::Newtonian>()?;
    module.add_class::<study::Study>()?;
    study::add(module)?;
    error::add(module)?;
    configuration::add(module)?;
    newtonian::add(module)?;
    analysis::add(module)
}
