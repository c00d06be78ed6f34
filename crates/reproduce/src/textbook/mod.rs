//! Textbook experiments with the engine, each beside a reference that owes nothing to it.
//!
//! A [`Case`] runs the real kernels (fast and plain, both integrators) on a small system whose outcome is known, in closed
//! form or from equations of motion integrated to twelve digits, and answers a [`Finding`]: numbers beside what they must be,
//! errors against the time step with their order, a table and figures. [`CASES`] are all of them; [`Validation`] works on
//! them in turn and writes what was found. Nothing here prints or exits.

mod case;
mod cases;
mod document;
mod error;
mod experiment;
mod finding;
mod reference;
mod validation;

pub use case::{Case, Circumstances, Extent};
pub use cases::{CASES, chosen};
pub use document::{replaced, text_of};
pub use error::ValidateError;
pub use finding::{CaseFigure, Check, Convergence, Finding};
pub use validation::{Examination, Validation};
