//! The study files behind the claims, as they stand in `studies/` of this repository.

use std::borrow::Cow;

use peristalsis_study::{Specification, StudyError};
use toml::{Table, Value};

/// The size of a design, or of a textbook case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    /// A few runs of everything: minutes.
    Quick,
    /// Enough for verdicts: hours.
    Full,
}

impl Size {
    /// One of two values.
    pub(crate) fn choose<T>(self, quick: T, full: T) -> T {
        match self {
            Self::Quick => quick,
            Self::Full => full,
        }
    }

    /// "quick" or "full".
    pub fn name(self) -> &'static str {
        self.choose("quick", "full")
    }
}

/// A study in both sizes; both have the same name, and so share a store and the runs that they have in common.
#[derive(Clone, Copy, Debug)]
pub struct StudyFile {
    /// Name of the study.
    pub name: &'static str,
    /// Path of the full design within the repository.
    pub path: &'static str,
    /// Whether figures of claims need more than the rows: time series, profile, flow of the waves or spheres of the first
    /// replicate of each point. Where only its row is there, as it was imported, that run is computed again.
    pub needs_products: bool,
    full: &'static str,
    quick_designs: &'static str,
}

impl StudyFile {
    /// A study from the text of its full file, and from a text in which the table of its name has what the quick design has in
    /// place of the full one; without one both are the same.
    pub const fn new(
        name: &'static str,
        path: &'static str,
        full: &'static str,
        quick_designs: &'static str,
    ) -> Self {
        Self {
            name,
            path,
            needs_products: false,
            full,
            quick_designs,
        }
    }

    /// The same, with products that claims need.
    #[must_use]
    pub const fn needing_products(self) -> Self {
        Self {
            needs_products: true,
            ..self
        }
    }

    /// The text of the study file.
    pub fn text(&self, size: Size) -> Cow<'static, str> {
        match size {
            Size::Full => Cow::Borrowed(self.full),
            // A file that is no TOML is refused where it is read.
            Size::Quick => self
                .quick()
                .map_or(Cow::Borrowed(self.full), |design| design.to_string().into()),
        }
    }

    /// The quick design, where it is another than the full one.
    fn quick(&self) -> Option<Table> {
        let mut designs: Table = self.quick_designs.parse().ok()?;
        let Value::Table(changes) = designs.remove(self.name)? else {
            return None;
        };
        let mut design = self.full.parse().ok()?;
        change(&mut design, changes);
        Some(design)
    }

    /// What the study file says.
    ///
    /// # Errors
    /// [`StudyError`] where the file is wrong.
    pub fn specification(&self, size: Size) -> Result<Specification, StudyError> {
        Specification::alone(self.path, &self.text(size))
    }

    /// The study of this name.
    pub fn named(name: &str) -> Option<&'static Self> {
        STUDIES.iter().find(|study| study.name == name)
    }
}

/// Puts values in the place of those of a table; tables within it, and lists of tables, are changed in their turn.
fn change(design: &mut Table, changes: Table) {
    for (key, to) in changes {
        match (design.get_mut(&key), to) {
            (Some(Value::Table(table)), Value::Table(changes)) => change(table, changes),
            (Some(Value::Array(tables)), Value::Array(changes))
                if tables.iter().all(Value::is_table) =>
            {
                for (table, changes) in tables.iter_mut().zip(changes) {
                    if let (Value::Table(table), Value::Table(changes)) = (table, changes) {
                        change(table, changes);
                    }
                }
            }
            (_, to) => drop(design.insert(key, to)),
        }
    }
}

/// A study by its name.
macro_rules! study {
    ($name:literal) => {
        StudyFile::new(
            $name,
            concat!("studies/", $name, ".toml"),
            include_str!(concat!("../../../studies/", $name, ".toml")),
            include_str!("../../../studies/quick.toml"),
        )
    };
}

/// All studies behind the claims.
pub const STUDIES: &[StudyFile] = &[
    study!("divergence-fine"),
    study!("divergence-coarse"),
    study!("near-12x16"),
    study!("near-coarse"),
    study!("near-fine"),
    study!("near-aligned"),
    study!("near-disordered"),
    study!("branches-12x16"),
    study!("branches-fine"),
    study!("branches-coarse"),
    study!("branches-aligned"),
    study!("branches-disordered"),
    study!("loop-coarse"),
    study!("loop-aligned"),
    study!("loop-disordered"),
    study!("dense-jams"),
    study!("flow-in-time"),
    study!("second-moment"),
    study!("jam-lifetime"),
    study!("density-12x16"),
    study!("density-fine"),
    study!("density-coarse"),
    study!("small-strain-rate-coarse"),
    study!("small-strain-rate-fine"),
    study!("roughness"),
    study!("walls"),
    study!("walls-dense"),
    study!("walls-drawn"),
    study!("walls-sought"),
    study!("restitution"),
    study!("softness"),
    study!("wavelength"),
    study!("radius"),
    study!("wall-stiffness"),
    study!("drag-of-the-waves"),
    study!("drag-of-the-wall"),
    study!("length"),
    study!("longest-tubes"),
    study!("method-fine"),
    study!("method-coarse"),
    study!("back-flow").needing_products(),
    study!("two-by-two-stress"),
    study!("two-by-two-strain"),
    study!("matched-bottlenecks"),
    study!("small-speed-size"),
    study!("sweep-up"),
    study!("sweep-down"),
    study!("pumping-frictionless").needing_products(),
    study!("pumping-frictional").needing_products(),
    study!("elastic-flow").needing_products(),
    study!("elastic-branches"),
    study!("elastic-extremes"),
    study!("elastic-yielding").needing_products(),
    study!("elastic-frictionless"),
    study!("elastic-sensitivity"),
    study!("unjammed-frictionless").needing_products(),
    study!("closure"),
    study!("segments"),
    study!("segments-wave"),
    study!("silo"),
    study!("silo-arches"),
    study!("silo-head"),
    study!("silo-feed"),
];

#[cfg(test)]
mod tests {
    use super::*;

    /// What no study, or no axis of one, stands for would be left out without a word.
    #[test]
    fn every_quick_design_is_of_a_study_and_changes_axes_that_it_has() {
        let designs: Table = STUDIES[0].quick_designs.parse().unwrap();
        assert_eq!(designs.len(), STUDIES.len());
        let axes = |design: &Table| design.get("axes")?.as_array().map(Vec::len);
        for (name, changes) in &designs {
            let full: Table = StudyFile::named(name).unwrap().full.parse().unwrap();
            let changed = axes(changes.as_table().unwrap());
            assert!(changed.is_none() || changed == axes(&full), "{name}");
        }
    }
}
