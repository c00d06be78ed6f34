//! An axis of a study: keys of the configuration and the values that they take.

use std::collections::HashMap;

use peristalsis_configuration::document::{self, Entry, Item, Node, Table};
use peristalsis_configuration::{Origin, Problem, ProblemKind, Problems};

use crate::plan::SettingValue;

/// Keys that an axis cannot vary, with what to do instead.
const NOT_VARIED: [(&str, &str); 3] = [
    (
        "preset",
        "all runs of a study build on one preset: write a study file for each, or vary the keys in which they differ",
    ),
    (
        "run.seed",
        "every run of a study has a seed of its own: take more `replicates`",
    ),
    ("initial.state", "name the states in `states`"),
];

/// A step that misses the end of its range by less than this part of itself is taken to hit it.
const STEP_TOLERANCE: f64 = 1e-6;

/// Keys that vary together and the rows of values that they take.
#[derive(Clone, Debug)]
pub(crate) struct Axis {
    /// Each key with the place where it is named.
    pub(crate) keys: Vec<(String, Origin)>,
    /// One value for each key.
    pub(crate) rows: Vec<Vec<Item>>,
}

impl Axis {
    /// Reads one table of `axes`, which follows the schema.
    pub(super) fn read(entry: &Item, problems: &mut Problems) -> Option<Self> {
        let Node::Table(table) = &entry.node else {
            return None;
        };
        let given: Vec<&str> = table.keys().map(String::as_str).collect();
        let axis = match given.as_slice() {
            ["key", "values"] => Self::of_values(table),
            ["count", "from", "key", "to"] => {
                let count = number(&item(table, "count").node) as u64;
                Self::of_range(table, count - 1)
            }
            ["from", "key", "step", "to"] => Self::of_step(table, problems)?,
            ["keys", "rows"] => Self::of_rows(table, problems)?,
            _ => {
                let problem = Problem::new(
                    ProblemKind::Conflict,
                    if given.is_empty() {
                        "an axis without keys".to_owned()
                    } else {
                        format!("{} do not make an axis", given.join(", "))
                    },
                )
                .key("axes")
                .at(&entry.origin, "this axis")
                .help("give key and values; or key, from, to and one of step and count; or keys and rows");
                problems.push(problem);
                return None;
            }
        };
        for (key, origin) in &axis.keys {
            if let Some((_, instead)) = NOT_VARIED.iter().find(|(name, _)| name == key) {
                let problem =
                    Problem::new(ProblemKind::Conflict, format!("{key} cannot be an axis"))
                        .key(key)
                        .at(origin, "here")
                        .help(*instead);
                problems.push(problem);
                return None;
            }
        }
        Some(axis)
    }

    fn of_values(table: &Table) -> Self {
        Self {
            keys: vec![named(item(table, "key"))],
            rows: list(item(table, "values"))
                .iter()
                .map(|value| vec![value.clone()])
                .collect(),
        }
    }

    fn of_step(table: &Table, problems: &mut Problems) -> Option<Self> {
        let [from, to, step] = ["from", "to", "step"].map(|key| number(&item(table, key).node));
        let intervals = ((to - from) / step).abs();
        let whole = intervals.round();
        if (intervals - whole).abs() > STEP_TOLERANCE * whole.max(1.0) || whole > 100_000.0 {
            let origin = &item(table, "step").origin;
            let problem = Problem::new(
                ProblemKind::Inconsistent,
                format!("from {from} to {to} is {intervals:.3} steps of {step}"),
            )
            .key("axes.step")
            .at(origin, "this step")
            .help("the step divides the range into at most 100000 whole steps; or give count");
            problems.push(problem);
            return None;
        }
        Some(Self::of_range(table, whole as u64))
    }

    /// Values at equal distances, `from` and `to` among them.
    fn of_range(table: &Table, intervals: u64) -> Self {
        let [from, to] = ["from", "to"].map(|key| item(table, key));
        let [first, last] = [from, to].map(|item| number(&item.node));
        let value = |index: u64| {
            let along = index as f64 / intervals.max(1) as f64;
            let origin = if index == 0 { from } else { to };
            Item {
                origin: origin.origin.clone(),
                node: numeric(neat(first + (last - first) * along)),
            }
        };
        Self {
            keys: vec![named(item(table, "key"))],
            rows: (0..=intervals).map(|index| vec![value(index)]).collect(),
        }
    }

    fn of_rows(table: &Table, problems: &mut Problems) -> Option<Self> {
        let keys: Vec<(String, Origin)> = list(item(table, "keys")).iter().map(named).collect();
        let rows: Vec<Vec<Item>> = list(item(table, "rows"))
            .iter()
            .map(|row| list(row).to_vec())
            .collect();
        for (row, place) in rows.iter().zip(list(item(table, "rows"))) {
            if row.len() != keys.len() {
                let problem = Problem::new(
                    ProblemKind::Inconsistent,
                    format!("a row of {} values for {} keys", row.len(), keys.len()),
                )
                .key("axes.rows")
                .at(&place.origin, "this row")
                .help("one value for each of keys");
                problems.push(problem);
                return None;
            }
        }
        Some(Self { keys, rows })
    }

    /// Refuses a row that stands in the axis twice.
    pub(super) fn check_distinct(&self, problems: &mut Problems) {
        let mut seen: HashMap<Vec<String>, &Item> = HashMap::new();
        for row in self.rows.iter().filter(|row| !row.is_empty()) {
            let values = row.iter().map(|item| match item.node {
                Node::Integer(_) | Node::Float(_) => number(&item.node).to_string(),
                _ => item.origin.text().to_owned(),
            });
            let values: Vec<String> = values.collect();
            let message = format!("the axis has {} twice", values.join(", "));
            if let Some(first) = seen.insert(values, &row[0]) {
                let problem = Problem::new(ProblemKind::Conflict, message)
                    .key("axes")
                    .at(&row[0].origin, "here")
                    .at(&first.origin, "and here")
                    .help("an axis names a value once; `replicates` are runs of the same point");
                problems.push(problem);
                return;
            }
        }
    }

    /// Whether this axis varies one key through numbers.
    pub(crate) fn is_numeric(&self) -> bool {
        self.keys.len() == 1
            && self
                .rows
                .iter()
                .flatten()
                .all(|item| matches!(item.node, Node::Integer(_) | Node::Float(_)))
    }
}

/// The number nearest to this one that has twelve digits: 0.1 + 2 * 0.05 and 0.2 are then the same bits, and so the same
/// run.
pub(crate) fn neat(number: f64) -> f64 {
    format!("{number:.11e}")
        .parse()
        .expect("a number that was written reads back")
}

/// A number as a person writes it: keys that take whole numbers take no 10.0.
pub(crate) fn numeric(number: f64) -> Node {
    let whole = number as i64;
    if whole as f64 == number && whole.unsigned_abs() < 1 << 53 {
        Node::Integer(whole)
    } else {
        Node::Float(number)
    }
}

/// A number of the file.
pub(crate) fn number(node: &Node) -> f64 {
    let number = SettingValue::of(node).number();
    number.expect("the schema takes numbers here")
}

fn item<'a>(table: &'a Table, key: &str) -> &'a Item {
    let entry: &Entry = document::entry(table, key).expect("the form of the axis has this key");
    &entry.item
}

fn list(item: &Item) -> &[Item] {
    match &item.node {
        Node::Array(items) => items,
        other => unreachable!("the schema takes a list here, not {}", other.description()),
    }
}

fn named(item: &Item) -> (String, Origin) {
    match &item.node {
        Node::Text(text) => (text.clone(), item.origin.clone()),
        other => unreachable!("the schema takes a text here, not {}", other.description()),
    }
}

#[cfg(test)]
mod tests {
    use super::neat;

    #[test]
    fn neat_numbers_are_those_that_a_person_types() {
        assert_eq!(neat(0.1 + 0.2), 0.3);
        assert_eq!(neat(0.5 * (2.65 + 2.7)), 2.675);
        assert_eq!(neat(0.03 + 0.17 * (3.0 / 4.0)), 0.1575);
        assert_eq!(neat(0.0), 0.0);
        assert_eq!(neat(-1e300), -1e300);
    }
}
