//! From findings to what a person reads: one page, one JSON file, figures and tables.
//!
//! [`Report`] holds the claims with what was found of them and the studies behind them; [`Report::html`] is a page that needs
//! no other file, [`Report::json`] the same for programs, and [`Report::write`] puts both into a folder with every figure as
//! SVG and PNG and every table as CSV. Nothing in them depends on when or how the runs were computed: the same runs give the
//! same bytes. [`number`] writes numbers with errors as physicists do. Nothing here prints or exits.

#![forbid(unsafe_code)]

mod error;
mod files;
mod json;
mod markup;
pub mod number;
mod page;
mod picture;
mod report;

pub use error::ReportError;
pub use markup::plain_text;
pub use report::{Program, Report};
