//! The table of all cases, one file each.

mod chain;
mod cohesion;
mod errors;
mod gravity;
mod haff;
mod janssen;
mod material;
mod normal;
mod oblique;
mod plot;
mod restitution;
mod roll;
mod rolling;
mod spin;
mod trial;
mod viscoelastic;

use crate::error::Result;
use crate::examination::experiments_named;
use crate::textbook::case::Case;

/// All cases, in the order of the document.
pub const CASES: &[Case] = &[
    Case::new("normal-impact", normal::PROSE, normal::examine),
    Case::new("restitution", restitution::PROSE, restitution::examine),
    Case::new("viscoelastic", viscoelastic::PROSE, viscoelastic::examine),
    Case::new("oblique-impact", oblique::PROSE, oblique::examine),
    Case::new("spin", spin::PROSE, spin::examine),
    Case::new("slip-to-roll", roll::PROSE, roll::examine),
    Case::new("gravity", gravity::PROSE, gravity::examine),
    Case::new("rolling", rolling::PROSE, rolling::examine),
    Case::new("cohesion", cohesion::PROSE, cohesion::examine),
    Case::new("janssen", janssen::PROSE, janssen::examine),
    Case::new("chain", chain::PROSE, chain::examine),
    Case::new("haff", haff::PROSE, haff::examine),
];

/// The cases of these names, in the order of the table; all where none is named.
///
/// # Errors
/// [`ReproduceError::NoSuchExperiment`](crate::ReproduceError::NoSuchExperiment).
pub fn chosen(cases: &[Case], names: &[String]) -> Result<Vec<Case>> {
    experiments_named("case", cases, |case| case.name, names)
}
