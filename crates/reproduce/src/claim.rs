//! A claim and how it is examined.

use crate::error::Result;
use crate::evidence::Evidence;
use crate::finding::{Finding, Statistics, Verdict};
use crate::prose::Prose;
use crate::walls::of_every_wall;

/// A claim of the source, or a question that it left open.
#[derive(Clone, Copy, Debug)]
pub struct Claim {
    /// Short name, such as F3.
    pub id: &'static str,
    /// Its title, its statement with the place in the source, and what the report says of it.
    pub prose: Prose,
    /// Names of the studies that it needs, all of [`STUDIES`](crate::STUDIES); `branches-*` stands for that study of every wall.
    pub studies: &'static [&'static str],
    /// What the evidence says, whether or not it suffices.
    pub finding: fn(&Evidence) -> Result<Finding>,
    /// The runs that a verdict takes.
    pub needed: Statistics,
    /// The parameter that is varied at each strain rate: "width", "force", "friction", "bottleneck", "back pressure" or
    /// "outlet".
    pub varied: &'static str,
}

impl Claim {
    /// A claim from what its file says: of widths, and with as many runs as the claims on walls of fixed spheres take.
    pub const fn new(
        id: &'static str,
        prose: Prose,
        studies: &'static [&'static str],
        finding: fn(&Evidence) -> Result<Finding>,
    ) -> Self {
        Self {
            id,
            prose,
            studies,
            finding,
            needed: Statistics::FOR_A_VERDICT,
            varied: "width",
        }
    }

    /// The same with the parameter that is varied, and the runs that a verdict takes.
    #[must_use]
    pub const fn varying(self, varied: &'static str, needed: Statistics) -> Self {
        Self {
            needed,
            varied,
            ..self
        }
    }

    /// What the evidence says; the verdict is open where it does not suffice.
    ///
    /// # Errors
    /// [`ReproduceError`](crate::ReproduceError) where a study is missing or its rows are wrong.
    pub fn examine(&self, evidence: &Evidence) -> Result<Finding> {
        let mut finding = (self.finding)(evidence)?;
        if !finding.statistics.suffice(&self.needed) {
            finding.verdict = Verdict::Open;
        }
        Ok(finding)
    }

    /// Names of the studies that it needs, those of every wall among them.
    pub fn all_studies(&self) -> Vec<&'static str> {
        self.studies
            .iter()
            .flat_map(|name| of_every_wall(name))
            .collect()
    }
}
