//! Studies: ensembles of runs over grids of parameters, kept safe.
//!
//! A [`Specification`] is a study file that has been read and checked as a whole; [`Plan`] names its runs. Each has an
//! [`Identity`], a hash of what determines its products, and a seed that follows from it: a point that is added changes
//! no other. A [`Store`] keeps the runs in a folder, whose files are the truth and whose index can be made again from
//! them. [`work_on`] computes the missing runs, in several workers and beside other processes; wherever it is interrupted,
//! the tables that [`Store::export`] writes in the end are the same bytes. Nothing here prints or exits.
//!
//! ```
//! use peristalsis_study::Specification;
//!
//! let study = Specification::alone(
//!     "study.toml",
//!     r#"
//!         name = "widths"
//!         preset = "frictionless"
//!         replicates = 3
//!         [[axes]]
//!         key = "drive.width"
//!         from = 2.6
//!         to = 2.9
//!         step = 0.1
//!     "#,
//! )?;
//! assert_eq!(study.plan().runs().len(), 12);
//! # Ok::<(), peristalsis_study::StudyError>(())
//! ```

#![forbid(unsafe_code)]

mod error;
mod estimate;
mod identity;
mod plan;
mod refinement;
mod row;
mod row_difference;
mod scheduler;
mod specification;
mod store;

pub use error::StudyError;
pub use estimate::{SECONDS_A_RUN, StudyEstimate, StudyWarning, study_estimate};
pub use identity::{Identity, NotAnIdentity, PHYSICS_VERSION, Record};
pub use plan::{Plan, PlannedRun, Point, Setting, SettingValue};
pub use refinement::{Bracket, Finding, brackets, refine};
pub use row::Row;
pub use row_difference::{RESUMMED, RowDifference};
pub use scheduler::{Board, Effort, Ending, Working, work_on};
pub use specification::{Specification, schema};
pub use store::{
    Entry, Exported, Packed, SEAL, STUDY, Staleness, State, Store, Survey, Verification, not_whole,
};
