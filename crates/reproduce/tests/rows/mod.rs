//! Rows of finished runs for tests of claims.

#![allow(dead_code, reason = "not every test needs all of it")]

use std::collections::{BTreeMap, BTreeSet};
use std::sync::atomic::{AtomicUsize, Ordering};

use peristalsis_formats::{Table, Values};
use peristalsis_reproduce::{CLAIMS, Claim, Evidence, Finding, STUDIES, Verdict};

/// Columns of whole numbers that every row has.
const WHOLE: [&str; 6] = peristalsis_reproduce::Row::WHOLE_NUMBERS;

/// Texts and numbers of a run by column.
type Row = (BTreeMap<String, String>, BTreeMap<String, f64>);

/// Rows as they are put together.
#[derive(Clone, Default)]
pub(crate) struct Rows {
    /// Numbers that every row has unless it says otherwise.
    common: Vec<(&'static str, f64)>,
    rows: Vec<Row>,
}

impl Rows {
    /// No rows yet; those to come have these numbers unless they say otherwise.
    pub(crate) fn with(common: &[(&'static str, f64)]) -> Self {
        Self {
            common: common.to_vec(),
            rows: Vec::new(),
        }
    }

    /// Adds a run.
    pub(crate) fn add(&mut self, texts: &[(&str, &str)], numbers: &[(&str, f64)]) {
        // No two runs that are added are the same.
        static RUNS: AtomicUsize = AtomicUsize::new(0);
        let identity = format!("{:032x}", RUNS.fetch_add(1, Ordering::Relaxed));
        let texts = texts
            .iter()
            .map(|(name, text)| ((*name).to_owned(), (*text).to_owned()))
            .chain([("identity".to_owned(), identity)])
            .collect();
        let numbers = self
            .common
            .iter()
            .chain(numbers)
            .map(|(name, value)| ((*name).to_owned(), *value))
            .collect();
        self.rows.push((texts, numbers));
    }

    /// Adds the runs of others.
    pub(crate) fn extend(&mut self, others: &Self) {
        self.rows.extend(others.rows.iter().cloned());
    }

    /// Each run alone.
    pub(crate) fn each(&self) -> Vec<Self> {
        let rows = self.rows.iter().map(|row| Self {
            common: self.common.clone(),
            rows: vec![row.clone()],
        });
        rows.collect()
    }

    /// Sets a number of all runs.
    pub(crate) fn set(&mut self, name: &str, value: f64) {
        for (_, numbers) in &mut self.rows {
            numbers.insert(name.to_owned(), value);
        }
    }

    /// Adds to a number of all runs.
    pub(crate) fn shift(&mut self, name: &str, by: f64) {
        for (_, numbers) in &mut self.rows {
            numbers
                .entry(name.to_owned())
                .and_modify(|value| *value += by);
        }
    }

    /// Those runs of which `keep` holds, given their texts and numbers.
    pub(crate) fn only(
        &self,
        keep: impl Fn(&BTreeMap<String, String>, &BTreeMap<String, f64>) -> bool,
    ) -> Self {
        let rows = self
            .rows
            .iter()
            .filter(|(texts, numbers)| keep(texts, numbers));
        Self {
            common: self.common.clone(),
            rows: rows.cloned().collect(),
        }
    }

    /// The table of a study; every column that a claim may need is there.
    pub(crate) fn table(&self) -> Table {
        let mut texts: BTreeSet<&str> = BTreeSet::from(["identity", "initial_state"]);
        let mut numbers: BTreeSet<&str> = peristalsis_reproduce::Row::NUMBERS.into();
        numbers.extend(["periods", "transition_threshold"]);
        let ladder: Vec<String> = (1..=9)
            .map(|n| format!("transition_time_{}", 10 * n))
            .collect();
        numbers.extend(ladder.iter().map(String::as_str));
        for (some_texts, some_numbers) in &self.rows {
            texts.extend(some_texts.keys().map(String::as_str));
            numbers.extend(some_numbers.keys().map(String::as_str));
        }
        let texts = texts.into_iter().map(|name| {
            let text = |row: &Row| row.0.get(name).cloned().unwrap_or_default();
            (name, Values::Text(self.rows.iter().map(text).collect()))
        });
        let whole = WHOLE.into_iter().map(|name| {
            let number = |row: &Row| row.1.get(name).map_or(0, |value| *value as i64);
            (
                name,
                Values::Integer(self.rows.iter().map(number).collect()),
            )
        });
        let numbers = numbers.into_iter().filter(|name| !WHOLE.contains(name));
        let numbers = numbers.map(|name| {
            let number = |row: &Row| row.1.get(name).copied().unwrap_or(f64::NAN);
            (name, Values::Real(self.rows.iter().map(number).collect()))
        });
        let columns = texts.chain(whole).chain(numbers);
        let table = columns.fold(Table::builder(), |table, (name, values)| {
            table.column(name, "", "", values)
        });
        table.build().unwrap()
    }
}

/// Evidence with every study, of which all but these are without a run.
pub(crate) fn evidence(studies: &[(&str, &Rows)]) -> Evidence {
    let mut evidence = Evidence::default();
    for study in STUDIES {
        evidence
            .add_table(study.name, Rows::default().table())
            .unwrap();
    }
    for (name, rows) in studies {
        evidence.add_table(name, rows.table()).unwrap();
    }
    evidence
}

/// What a claim says of some studies.
pub(crate) fn examine(id: &str, evidence: &Evidence) -> Finding {
    claim(id).examine(evidence).unwrap()
}

/// A claim by its name.
pub(crate) fn claim(id: &str) -> &'static Claim {
    CLAIMS.iter().find(|claim| claim.id == id).unwrap()
}

/// Asserts a verdict; where it differs, says what was found.
pub(crate) fn assert_verdict(finding: &Finding, verdict: Verdict) {
    let found = (&finding.summary, finding.statistics);
    assert_eq!(finding.verdict, verdict, "{found:?}");
}

/// Asserts that a text says something.
pub(crate) fn assert_says(text: &str, part: &str) {
    assert!(text.contains(part), "{part:?} in {text:?}");
}

/// The value of the first quantity whose name contains this.
pub(crate) fn value(finding: &Finding, name: &str) -> f64 {
    let found = finding
        .quantities
        .iter()
        .find(|one| one.name.contains(name))
        .unwrap_or_else(|| panic!("{name}"));
    found.ours.unwrap().value
}
