//! Rows of finished runs for tests of claims.

#![allow(dead_code, reason = "not every test needs all of it")]

use std::collections::{BTreeMap, BTreeSet};

use peristalsis_formats::{Table, Values};
use peristalsis_reproduce::{CLAIMS, Evidence, Finding, STUDIES};

/// Columns that every row has: whole numbers, then numbers.
const WHOLE: [&str; 6] = [
    "spheres_per_ring",
    "rings_per_wave",
    "grains",
    "waves",
    "escaped",
    "replicate",
];
const NUMBERS: [&str; 11] = [
    "width",
    "strain_rate",
    "volume_fraction",
    "radius",
    "wavelength",
    "time",
    "periods",
    "flow_rate_ratio",
    "flow_rate_ratio_error",
    "transition_time",
    "transition_threshold",
];

/// Rows as they are put together: texts and numbers by column.
#[derive(Clone, Default)]
pub(crate) struct Rows {
    /// Numbers that every row has unless it says otherwise.
    common: Vec<(&'static str, f64)>,
    rows: Vec<(BTreeMap<String, String>, BTreeMap<String, f64>)>,
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
        let texts = texts
            .iter()
            .map(|(name, text)| ((*name).to_owned(), (*text).to_owned()))
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
        let mut numbers: BTreeSet<&str> = NUMBERS.into();
        let ladder: Vec<String> = (1..=9)
            .map(|n| format!("transition_time_{}", 10 * n))
            .collect();
        numbers.extend(ladder.iter().map(String::as_str));
        for (some_texts, some_numbers) in &self.rows {
            texts.extend(some_texts.keys().map(String::as_str));
            numbers.extend(some_numbers.keys().map(String::as_str));
        }
        let mut table = Table::builder();
        for name in texts {
            let text = |row: &(BTreeMap<String, String>, _)| row.0.get(name).cloned();
            let column = self
                .rows
                .iter()
                .map(|row| text(row).unwrap_or_default())
                .collect();
            table = table.column(name, "", "", Values::Text(column));
        }
        for name in WHOLE {
            let column = self
                .rows
                .iter()
                .map(|row| row.1.get(name).map_or(0, |value| *value as i64))
                .collect();
            table = table.column(name, "", "", Values::Integer(column));
        }
        for name in numbers {
            if WHOLE.contains(&name) {
                continue;
            }
            let column = self
                .rows
                .iter()
                .map(|row| row.1.get(name).copied().unwrap_or(f64::NAN))
                .collect();
            table = table.column(name, "", "", Values::Real(column));
        }
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
    let claim = CLAIMS.iter().find(|claim| claim.id == id).unwrap();
    (claim.examine)(evidence).unwrap()
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
