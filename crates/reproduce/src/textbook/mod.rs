//! Textbook experiments with the engine, each beside an independent reference.
//!
//! A [`Case`] runs the real kernels (fast and reference, both integrators) on a small system whose outcome is known, in closed
//! form or from equations of motion integrated to twelve digits, and answers a [`Finding`](crate::Finding): numbers beside
//! their expected values, errors against the time step with their order, a table and figures. [`CASES`] are all of them;
//! [`Validation`] works on them in turn and writes the findings. Nothing here prints or exits.

mod case;
mod cases;
mod experiment;
mod reference;
mod validation;

pub use case::{Case, Circumstances};
pub use cases::{CASES, chosen};
pub use validation::Validation;
