//! The claims of the source, and what our studies say of them.
//!
//! A [`Claim`] names the studies that it needs and turns what they found, the [`Evidence`], into a [`Finding`]: numbers
//! with errors, tables, figures, and a [`Verdict`]. One claim is one file in `claims/` and one row of [`CLAIMS`]. The
//! studies are those of the folder `studies/` of this repository, in two sizes ([`Size`]). Nothing here prints or exits.

#![forbid(unsafe_code)]

mod branches;
mod claim;
mod claims;
mod collapse;
mod critical;
mod crossing;
mod error;
mod evidence;
mod finding;
mod forces;
pub mod report;
mod reproduction;
mod rows;
mod runs;
mod studies;
mod text;
pub mod textbook;

pub use claim::Claim;
pub use claims::CLAIMS;
pub use error::ClaimError;
pub use evidence::{Evidence, StudyResults};
pub use finding::{Finding, Quantity, ReportFigure, ReportTable, Statistics, Verdict};
pub use reproduction::{
    Event, Examination, Import, ImportedRuns, Outcome, Reproduction, Stage, StudyOutcome, chosen,
};
pub use runs::{Lattice, Run, Start};
pub use studies::{Products, STUDIES, Size, StudyFile};
