//! Numerical tools behind the estimators: special functions, minimisation, small linear systems.
//!
//! Written here because the libraries that offer them call the platform's exp and log, and the same table must give
//! the same bits on every machine.

pub(crate) mod gamma;
pub(crate) mod linear;
pub(crate) mod minimum;
pub(crate) mod quasi_newton;
pub(crate) mod simplex;
pub(crate) mod student;
