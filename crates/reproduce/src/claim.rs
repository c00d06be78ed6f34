//! A claim and how it is examined.

use crate::error::Result;
use crate::evidence::Evidence;
use crate::finding::Finding;
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
    /// What the evidence says.
    pub examine: fn(&Evidence) -> Result<Finding>,
}

impl Claim {
    /// A claim from what its file says.
    pub(crate) const fn new(
        id: &'static str,
        prose: Prose,
        studies: &'static [&'static str],
        examine: fn(&Evidence) -> Result<Finding>,
    ) -> Self {
        Self {
            id,
            prose,
            studies,
            examine,
        }
    }

    /// Names of the studies that it needs, those of every wall among them.
    pub fn all_studies(&self) -> Vec<&'static str> {
        self.studies
            .iter()
            .flat_map(|name| of_every_wall(name))
            .collect()
    }
}
