//! A claim and how it is examined.

use crate::error::ClaimError;
use crate::evidence::Evidence;
use crate::finding::Finding;

/// A claim of the source, or a question that it left open.
#[derive(Clone, Copy, Debug)]
pub struct Claim {
    /// Short name, such as F3.
    pub id: &'static str,
    /// What it is about, a few words.
    pub title: &'static str,
    /// What the source says, in our words and in the markup of figures; or the question.
    pub statement: &'static str,
    /// Where the source says it.
    pub source: &'static str,
    /// Names of the studies that it needs, all of [`STUDIES`](crate::STUDIES).
    pub studies: &'static [&'static str],
    /// What the evidence says.
    pub examine: fn(&Evidence) -> Result<Finding, ClaimError>,
}
