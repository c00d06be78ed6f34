//! The table of all cases, one file each.

mod chain;
mod errors;
mod haff;
mod material;
mod normal;
mod oblique;
mod plot;
mod restitution;
mod roll;
mod spin;
mod viscoelastic;

use crate::error::ClaimError;
use crate::examination::experiments_named;
use crate::textbook::case::Case;

/// All cases, in the order of the document.
pub const CASES: &[Case] = &[
    normal::CASE,
    restitution::CASE,
    viscoelastic::CASE,
    oblique::CASE,
    spin::CASE,
    roll::CASE,
    chain::CASE,
    haff::CASE,
];

/// The cases of these names, in the order of the table; all where none is named.
///
/// # Errors
/// [`ClaimError::NoSuchExperiment`].
pub fn chosen(cases: &[Case], names: &[String]) -> Result<Vec<Case>, ClaimError> {
    experiments_named("case", cases, |case| case.name, names)
}
