//! The table of all cases, one file each.

mod chain;
mod haff;
mod normal;
mod oblique;
mod restitution;
mod roll;
mod spin;
mod study;
mod viscoelastic;

use crate::textbook::case::Case;
use crate::textbook::error::ValidateError;

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
/// [`ValidateError::NoSuchCase`] for a name that no case has.
pub fn chosen(cases: &[Case], names: &[String]) -> Result<Vec<Case>, ValidateError> {
    if let Some(unknown) = names
        .iter()
        .find(|name| cases.iter().all(|case| case.name != **name))
    {
        return Err(ValidateError::NoSuchCase {
            asked: unknown.clone(),
            known: cases.iter().map(|case| case.name).collect(),
        });
    }
    let wanted = |case: &&Case| names.is_empty() || names.iter().any(|name| name == case.name);
    Ok(cases.iter().filter(wanted).copied().collect())
}
