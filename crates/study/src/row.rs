//! The row of a finished run: all that tables and analyses need of it, and nothing that depends on when it was computed.

use peristalsis_configuration::{Arrangement, Configuration, word};
use peristalsis_formats::{Column, FormatError, Table, ValueKind, Values, csv};
use peristalsis_run::{RowColumn, Status, Summary, Value, gathered, row_columns, set_by};

use crate::identity::{Identity, PHYSICS_VERSION};

/// Metadata of a table of rows: the version of the physics that computed them.
pub(crate) const PHYSICS: &str = "peristalsis.physics_version";
/// How a finished run has ended.
const FINISHED: [Status; 2] = [Status::Complete, Status::Settled];

/// The row of one finished run, a table of one row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    identity: Identity,
    table: Table,
}

/// The columns of a row, in order: the run's place in its study, then the quantities of the run.
fn columns() -> impl Iterator<Item = RowColumn> {
    let identity = "hash of configuration, physics version and replicate";
    let replicate = "number of the replicate, from 0";
    let place = [
        ("identity", "", identity, ValueKind::Text),
        ("replicate", "1", replicate, ValueKind::Integer),
    ];
    let place = place.map(|(name, unit, text, kind)| RowColumn {
        name: name.to_owned(),
        unit,
        text,
        kind,
        is_later: false,
    });
    place.into_iter().chain(row_columns().iter().cloned())
}

impl Row {
    /// The row of a run that has just ended.
    pub(crate) fn of(identity: Identity, replicate: u32, summary: &Summary) -> Self {
        let place = [
            Value::Text(identity.to_string()),
            Value::Whole(replicate.into()),
        ];
        let values = place.into_iter().chain(summary.row());
        let table = joined(columns().zip(values).map(|(column, value)| {
            let values = gathered(column.kind, [value].into_iter());
            with_values(column, values)
        }));
        Self { identity, table }
    }

    /// Every row of a table that has the columns of rows; other columns are left out.
    ///
    /// # Errors
    /// A sentence: the column that is missing or of another kind, the text that is no identity, or the physics of another
    /// version, whose runs have other identities.
    pub fn all_of(table: &Table) -> Result<Vec<Self>, String> {
        let physics = table.metadata().get(PHYSICS);
        if let Some(version) = physics.filter(|it| **it != PHYSICS_VERSION.to_string()) {
            return Err(format!(
                "its rows are of physics version {version}, and this program computes version {PHYSICS_VERSION}, whose \
                 runs are others"
            ));
        }
        let in_words = |error: FormatError| error.to_string();
        let identities = table.texts("identity").map_err(in_words)?.iter();
        let row_of = |(row, identity): (usize, &String)| {
            let identity = identity.parse();
            let identity = identity.map_err(|error| format!("row {}: {error}", row + 1))?;
            let column_of = |column: RowColumn| {
                let values = one_of(table, &column, row).map_err(in_words)?;
                Ok(with_values(column, values))
            };
            let columns: Result<Vec<Column>, String> = columns().map(column_of).collect();
            let table = joined(columns?);
            Ok(Self { identity, table })
        };
        identities.enumerate().map(row_of).collect()
    }

    /// Reads the text that [`Row::to_csv`] wrote.
    ///
    /// # Errors
    /// A sentence: the fault of the text.
    pub(crate) fn from_csv(text: &str) -> Result<Self, String> {
        let table = csv::decode(text).map_err(|error| error.to_string())?;
        let mut rows = Self::all_of(&table)?;
        match (rows.pop(), rows.is_empty()) {
            (Some(row), true) => Ok(row),
            _ => Err("it is not one row".to_owned()),
        }
    }

    /// The first setting in this row that its run cannot have, in words; `None` where all agree. A table is believed by its
    /// identities: one that was edited, or joined wrongly, must not pass.
    pub(crate) fn contradiction(
        &self,
        replicate: u32,
        configuration: &Configuration,
    ) -> Option<String> {
        let replicate = ("replicate", Value::Whole(replicate.into()));
        let mut expected = set_by(configuration).into_iter().chain([replicate]);
        expected.find_map(|(name, value)| {
            let found = &self.table.column(name).ok()?.values;
            let expected = gathered(found.kind(), [value].into_iter());
            let is_same = match (&expected, found) {
                // 0 and -0 are the same setting.
                (Values::Real(expected), Values::Real(found)) => {
                    found[0] == expected[0] || found[0].is_nan() && expected[0].is_nan()
                }
                _ => expected == *found,
            };
            (!is_same).then(|| format!("the run {} has another {name}", self.identity))
        })
    }

    /// In words where this row and another of the same run differ: one of them is wrong.
    pub(crate) fn conflict(&self, other: &Self) -> Option<String> {
        let difference = self.differences(other).into_iter().next()?;
        Some(format!(
            "the run {} stands in it twice, with another {}",
            self.identity, difference.column
        ))
    }

    /// A value of this row that no finished run has, in words.
    pub(crate) fn impossible(&self) -> Option<String> {
        let status = self.table.texts("status").ok()?.first()?;
        if !FINISHED.iter().any(|it| word(it) == *status) {
            return Some(format!(
                "the run {} has the status {status:?}, and not that of a finished run",
                self.identity
            ));
        }
        let value = |name: &str| self.table.reals(name).map_or(f64::NAN, |found| found[0]);
        let is_censored = self.table.booleans("censored").is_ok_and(|it| it[0]);
        // An empty cell reads as NaN: a quantity that the run does not have, such as J/Jmax of a wave that pauses, or of a tube
        // that all grains have left.
        let is_wrong = |name: &str, found: f64| match name {
            "time" => !(found > 0.0 && found.is_finite()),
            "transition_time" => {
                // A censored run ended before a transition.
                found < 0.0 || found > value("time") || is_censored == found.is_finite()
            }
            "watched" => found < 0.0 || found > value("time"),
            "flow_rate" => !found.is_finite(),
            "flow_rate_ratio" => found.is_infinite(),
            _ => found < 0.0 || found.is_infinite(),
        };
        let measured = [
            "time",
            "periods",
            "transition_time",
            "watched",
            "flow_rate",
            "flow_rate_ratio",
            "largest_overlap",
        ];
        let (name, found) = measured
            .map(|name| (name, value(name)))
            .into_iter()
            .find(|(name, found)| is_wrong(name, *found))?;
        Some(format!("the run {} has the {name} {found}", self.identity))
    }

    /// As CSV with its header, exact to the bit.
    pub(crate) fn to_csv(&self) -> String {
        csv::encode(&self.table)
    }

    /// The identity of its run.
    pub fn identity(&self) -> Identity {
        self.identity
    }

    /// As a table of one row.
    pub fn table(&self) -> &Table {
        &self.table
    }

    /// tau \[t\]; `None` without a transition.
    pub fn transition_time(&self) -> Option<f64> {
        let times = self.table.reals("transition_time").ok()?;
        times.first().copied().filter(|time| !time.is_nan())
    }

    /// Whether a grain was outside the tube at any sample.
    pub(crate) fn leaks(&self) -> bool {
        let most = self.table.integers("escaped_most");
        most.is_ok_and(|most| most.first().is_some_and(|most| *most > 0))
    }

    /// A table without rows, for studies without a finished run.
    pub(crate) fn no_rows() -> Table {
        joined(columns().map(|column| {
            let values = Values::empty(column.kind);
            with_values(column, values)
        }))
    }
}

fn with_values(column: RowColumn, values: Values) -> Column {
    Column {
        name: column.name,
        unit: column.unit.to_owned(),
        description: column.text.to_owned(),
        values,
    }
}

fn joined(columns: impl IntoIterator<Item = Column>) -> Table {
    Table::builder()
        .columns(columns)
        .build()
        .expect("the columns of a row have distinct names and one length")
}

/// One value of a column of another table; an empty column of a CSV file reads as reals.
fn one_of(table: &Table, column: &RowColumn, row: usize) -> Result<Values, FormatError> {
    if table.column(&column.name).is_err() {
        match &*column.name {
            // Walls of rows without it stood as a wall does unless it is said.
            "arrangement" => return Ok(Values::Text(vec![word(Arrangement::default())])),
            _ if column.is_later => return Ok(Values::Real(vec![f64::NAN])),
            _ => {}
        }
    }
    let found = table.column(&column.name)?;
    match (column.kind, &found.values) {
        (ValueKind::Real, Values::Real(values)) => Ok(Values::Real(vec![values[row]])),
        (ValueKind::Real, Values::Integer(values)) => Ok(Values::Real(vec![values[row] as f64])),
        (ValueKind::Integer, Values::Integer(values)) => Ok(Values::Integer(vec![values[row]])),
        (ValueKind::Text, Values::Text(values)) => Ok(Values::Text(vec![values[row].clone()])),
        (ValueKind::Boolean, Values::Boolean(values)) => Ok(Values::Boolean(vec![values[row]])),
        (expected, other) => Err(FormatError::OtherKind {
            name: column.name.clone(),
            expected,
            found: other.kind(),
        }),
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// A table of one row but for this column.
    pub(crate) fn without(left_out: &str) -> String {
        let one = |column: RowColumn| {
            let values = match (column.name.as_str(), column.kind) {
                ("identity", _) => Values::Text(vec!["0f".repeat(16)]),
                (_, ValueKind::Real) => Values::Real(vec![0.5]),
                (_, ValueKind::Integer) => Values::Integer(vec![7]),
                (_, ValueKind::Text) => Values::Text(vec!["x".to_owned()]),
                (_, ValueKind::Boolean) => Values::Boolean(vec![true]),
            };
            with_values(column, values)
        };
        let kept = columns().filter(|column| column.name != left_out);
        csv::encode(&joined(kept.map(one)))
    }

    #[test]
    fn rows_of_another_physics_are_refused_in_words() {
        let table = csv::decode(&without("nothing")).unwrap();
        let of = |version: u32| {
            let table = Table::builder().columns(table.columns().iter().cloned());
            let table = table.metadata(PHYSICS, version.to_string()).build();
            Row::all_of(&table.unwrap())
        };
        assert_eq!(of(PHYSICS_VERSION).unwrap().len(), 1);
        let error = of(PHYSICS_VERSION - 1).unwrap_err();
        assert!(
            error.contains("physics version 1, and this program"),
            "{error}"
        );
    }

    #[test]
    fn a_row_reads_back_and_lacks_no_column() {
        let row = Row::from_csv(&without("nothing")).unwrap();
        assert_eq!(row.table().columns().len(), columns().count());
        assert_eq!(Row::from_csv(&row.to_csv()).unwrap(), row);
        let earlier = Row::from_csv(&without("arrangement")).unwrap();
        assert_eq!(earlier.table().texts("arrangement").unwrap(), ["staggered"]);
        let earlier = Row::from_csv(&without("contact_force_largest")).unwrap();
        assert!(earlier.table().reals("contact_force_largest").unwrap()[0].is_nan());
        assert_eq!(earlier.differences(&row), []);
        let error = Row::from_csv(&without("wall_power")).unwrap_err();
        assert!(error.contains("wall_power"), "{error}");
    }
}
