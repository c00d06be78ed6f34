//! The claims of the source, and what our studies say of them.
//!
//! A [`Claim`] names the studies that it needs and turns what they found, the [`Evidence`], into a [`Finding`]: numbers
//! with errors, tables, figures, and a [`Verdict`]. One claim is one file in `claims/` and one row of [`CLAIMS`]. The
//! studies are those of the folder `studies/` of this repository, in two sizes ([`Size`]). Nothing here prints or exits.

#![forbid(unsafe_code)]

mod branch;
mod check;
mod claim;
mod claims;
mod collapse;
mod columns;
mod contents;
mod critical;
pub mod design;
mod draft;
mod error;
mod estimates;
mod evidence;
mod examination;
mod exhibit;
mod finding;
mod forces;
mod judgement;
mod near;
mod prose;
pub mod report;
mod reproduction;
mod row;
mod studies;
pub mod textbook;
mod thresholds;
mod walls;

pub use check::{Check, Convergence};
pub use claim::Claim;
pub use claims::CLAIMS;
pub use error::ReproduceError;
pub use evidence::{Evidence, StudyResults};
pub use examination::Examination;
pub use finding::{
    Finding, Quantity, ReportFigure, ReportTable, Statistics, Verdict, WallVerdict, Without,
};
pub use prose::Prose;
pub use reproduction::{
    DifferingRow, Drawn, Event, Extent, Import, ImportedRuns, Outcome, PublishedRows, Reproduction,
    STORES, Sample, Sampling, Stage, StudyOutcome, chosen, published_in_words,
};
pub use row::{Lattice, Row, Start};
pub use studies::{STUDIES, Size, StudyFile};
