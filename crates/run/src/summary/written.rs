//! A summary as it is written: `summary.json` and the row of a study, both from the table of quantities.

use std::sync::LazyLock;

use peristalsis_configuration::Configuration;
use peristalsis_engine::initial::PackingReport;
use peristalsis_formats::ValueKind;
use peristalsis_observe::{Quantity, Value};
use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema};
use serde::{Serialize, Serializer};

use super::Summary;
use super::table::{QUANTITIES, RunQuantity, Source};
use crate::recorder::THRESHOLDS;
use crate::tables::kind;
use crate::trajectory::TrajectoryReport;
use crate::warnings::Warning;

/// A column of the rows of studies.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RowColumn {
    /// Name.
    pub name: String,
    /// Unit, in m, d, t or SI; "1" for pure numbers, empty for words.
    pub unit: &'static str,
    /// Its meaning, in a line.
    pub text: &'static str,
    /// Kind of its values.
    pub kind: ValueKind,
    /// Whether rows of earlier programs lack it; it is missing there.
    pub is_later: bool,
}

impl RowColumn {
    fn of<Of>(quantity: &Quantity<Of>, is_later: bool) -> Vec<Self> {
        let headings = quantity.headings().into_iter();
        headings
            .map(|(name, text)| Self {
                name,
                unit: quantity.unit,
                text,
                kind: kind(&quantity.reading),
                is_later,
            })
            .collect()
    }
}

impl RunQuantity {
    pub(super) fn name(&self) -> &'static str {
        match &self.source {
            Source::Setting(quantity) => quantity.name,
            Source::Result(quantity) => quantity.name,
        }
    }

    pub(super) fn unit(&self) -> &'static str {
        match &self.source {
            Source::Setting(quantity) => quantity.unit,
            Source::Result(quantity) => quantity.unit,
        }
    }

    fn columns(&self) -> Vec<RowColumn> {
        match &self.source {
            Source::Setting(quantity) => RowColumn::of(quantity, self.is_later),
            Source::Result(quantity) => RowColumn::of(quantity, self.is_later),
        }
    }

    fn values(&self, summary: &Summary) -> Vec<Value> {
        match &self.source {
            Source::Setting(quantity) => quantity.values(&summary.configuration),
            Source::Result(quantity) => quantity.values(summary),
        }
    }

    /// Keys and values below `group`, that is before the dot of the key.
    fn entries(&self, group: &str, summary: &Summary) -> Vec<(String, Value)> {
        let (of, key) = self.key.split_once('.').unwrap_or(("", self.key));
        if of != group || key.is_empty() {
            return Vec::new();
        }
        let keys = [key.to_owned(), format!("{key}_error")];
        keys.into_iter().zip(self.values(summary)).collect()
    }
}

/// The columns of a run's quantities in the rows of studies.
pub fn row_columns() -> &'static [RowColumn] {
    static COLUMNS: LazyLock<Vec<RowColumn>> = LazyLock::new(|| {
        let in_rows = QUANTITIES.iter().filter(|quantity| quantity.in_rows);
        in_rows.flat_map(RunQuantity::columns).collect()
    });
    &COLUMNS
}

/// The columns of rows that a configuration alone decides, with their values for this one.
pub fn set_by(configuration: &Configuration) -> Vec<(&'static str, Value)> {
    QUANTITIES
        .iter()
        .filter_map(|quantity| match &quantity.source {
            Source::Setting(setting) if quantity.in_rows => {
                let value = setting.values(configuration).pop()?;
                Some((setting.name, value))
            }
            _ => None,
        })
        .collect()
}

/// A key of a summary.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SummaryKey {
    /// The key, after a dot where it stands in an object of its own.
    pub key: String,
    /// Unit, meaning and kind of its value.
    pub column: RowColumn,
    /// Whether not every run has it.
    pub is_optional: bool,
}

/// The keys of a summary that hold the run's quantities, in their order.
pub fn summary_keys() -> Vec<SummaryKey> {
    let written = QUANTITIES
        .iter()
        .filter(|quantity| !quantity.key.is_empty());
    let keys = written.flat_map(|quantity| {
        let names = [quantity.key.to_owned(), format!("{}_error", quantity.key)];
        let is_optional = match &quantity.source {
            Source::Setting(setting) => setting.is_optional(),
            Source::Result(result) => result.is_optional(),
        };
        names
            .into_iter()
            .zip(quantity.columns())
            .map(move |(key, column)| SummaryKey {
                key,
                column,
                is_optional,
            })
    });
    keys.collect()
}

impl Summary {
    /// The values of [`row_columns`].
    pub fn row(&self) -> Vec<Value> {
        let in_rows = QUANTITIES.iter().filter(|quantity| quantity.in_rows);
        in_rows.flat_map(|quantity| quantity.values(self)).collect()
    }

    /// As JSON, indented.
    pub fn to_json(&self) -> String {
        let mut text = serde_json::to_string_pretty(self)
            .expect("a summary is plain numbers and text, which always serialise");
        text.push('\n');
        text
    }

    fn entries(&self, group: &str) -> Vec<(String, Value)> {
        let quantities = QUANTITIES.iter();
        quantities.flat_map(|it| it.entries(group, self)).collect()
    }
}

/// Keys and values as an object.
#[derive(JsonSchema)]
#[schemars(inline)]
struct Object(
    #[schemars(with = "serde_json::Map<String, serde_json::Value>")] Vec<(String, Value)>,
);

impl Serialize for Object {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(key, value)| (key, value)))
    }
}

/// The transition as another threshold sees it.
#[derive(Serialize, JsonSchema)]
struct ThresholdTime {
    /// J/Jmax whose crossing counts.
    threshold: f64,
    /// tau \[t\]; `None` where there was no transition.
    time: Option<f64>,
}

/// A summary as an object: the quantities of its table, those below a name of their own, and what is no single number.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "Summary")]
struct Written<'a> {
    #[serde(flatten)]
    #[schemars(skip)]
    quantities: Object,
    /// Pumping against a body force; `None` without one.
    pumping: Option<Object>,
    /// About a fifth of the wavelength, where the tube is narrowest.
    throat: Object,
    /// About a fifth of the wavelength, where it is widest.
    belly: Object,
    /// What passes through an open tube; `None` of a periodic one.
    open: Option<Object>,
    /// Quantities in SI; `None` without the table `units`.
    si: Option<Object>,
    /// The transition as other thresholds see it.
    transition_times: Vec<ThresholdTime>,
    /// How the grains were placed.
    packing: &'a PackingReport,
    /// Why the run diverged, where it did.
    message: Option<&'a str>,
    /// Faults of an elastic wall: when, where, and the likely cause.
    wall_diagnosis: &'a [String],
    /// What looks doubtful.
    warnings: &'a [Warning],
    /// The trajectory that was written; only where there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "TrajectoryReport")]
    trajectory: Option<&'a TrajectoryReport>,
}

impl Serialize for Summary {
    /// As an object; numbers that are missing are `null` in JSON.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let group = |name| Object(self.entries(name));
        let times = THRESHOLDS.into_iter().zip(self.transition_times);
        let times = times.map(|(threshold, time)| ThresholdTime { threshold, time });
        let written = Written {
            quantities: group(""),
            pumping: self.pumping.is_some().then(|| group("pumping")),
            throat: group("throat"),
            belly: group("belly"),
            open: self.discharge.is_some().then(|| group("open")),
            si: self.configuration.units.is_some().then(|| group("si")),
            transition_times: times.collect(),
            packing: &self.packing,
            message: self.message.as_deref(),
            wall_diagnosis: &self.wall_diagnosis,
            warnings: &self.warnings,
            trajectory: self.trajectory.as_ref(),
        };
        written.serialize(serializer)
    }
}

/// The JSON schema of what a summary holds besides [`summary_keys`]: an object of theirs has no properties here.
pub fn summary_schema() -> Schema {
    let settings = SchemaSettings::draft2020_12().for_serialize();
    settings
        .into_generator()
        .into_root_schema_for::<Written<'_>>()
}

#[cfg(test)]
mod tests {
    use super::super::Status;
    use super::*;
    use crate::run::Run;

    #[test]
    fn columns_have_distinct_names_and_all_are_explained() {
        let columns = row_columns();
        for (index, column) in columns.iter().enumerate() {
            let before = &columns[..index];
            let is_new = before.iter().all(|other| other.name != column.name);
            assert!(is_new && !column.text.is_empty(), "{}", column.name);
        }
    }

    #[test]
    fn every_key_is_in_the_summary_of_a_run_that_has_it() {
        let open = [
            "tube.ends=\"open\"",
            "inlet.waiting=4",
            "drive.body_force=-0.002",
        ];
        let small = ["tube.waves=1", "grains.number=30", "run.periods=0.1"];
        let of = |settings: Vec<&str>| {
            let configuration = Configuration::from_preset("frictionless", &settings).unwrap();
            let mut run = Run::new(configuration).unwrap();
            run.advance().unwrap();
            let json = Summary::of(&run, Status::Interrupted, None).to_json();
            serde_json::from_str::<serde_json::Value>(&json).unwrap()
        };
        let found = [of(small.to_vec()), of([small.as_slice(), &open].concat())];
        for key in summary_keys() {
            let path = format!("/{}", key.key.replace('.', "/"));
            let is_in_one = found.iter().any(|it| it.pointer(&path).is_some());
            // Neither has units.
            assert!(is_in_one || key.key.starts_with("si."), "{}", key.key);
        }
    }
}
