//! Why a run of a store is no longer part of its study.

use std::collections::BTreeMap;

use serde_json::Value;

use super::run_files::{STATEPOINT, statepoint};
use super::{Assignment, Store, Survey};
use crate::identity::Identity;

/// The difference between a run in the store and the study as it is now.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Staleness {
    /// The run of the study that is most like it, in words.
    pub nearest: String,
    /// The difference in words, such as "run.periods: 200.0, now 300.0".
    pub differences: Vec<String>,
}

impl Store {
    /// Compares a run with those of the study; `None` where it is one of them, or its files are not here.
    pub fn staleness(&self, survey: &Survey, identity: Identity) -> Option<Staleness> {
        let runs = survey.plan.runs();
        if runs.iter().any(|run| run.identity == identity) {
            return None;
        }
        let text = std::fs::read_to_string(self.run_folder(identity).join(STATEPOINT)).ok()?;
        let found = flat(&serde_json::from_str(&text).ok()?);
        // Points are compared by their first replicate: the others differ from it in nothing else.
        let firsts = runs.iter().filter(|run| run.replicate == 0);
        let (run, mut differences) = firsts
            .map(|run| {
                let wanted = flat(&statepoint(&Assignment::of(&survey.plan, run)));
                (run, differences(&found, &wanted))
            })
            .min_by_key(|(_, differences)| differences.len())?;
        let replicate = found.get("replicate").and_then(|text| text.parse().ok());
        let replicate: u32 = replicate.unwrap_or(0);
        if replicate >= survey.study.replicates {
            differences.push(format!(
                "replicates: more than {replicate}, now {}",
                survey.study.replicates
            ));
        }
        Some(Staleness {
            nearest: format!(
                "{}, replicate {replicate}",
                survey.plan.point(run).in_words()
            ),
            differences,
        })
    }
}

/// Every leaf of nested tables with its full name.
fn flat(value: &Value) -> BTreeMap<String, String> {
    fn collect(value: &Value, path: &str, leaves: &mut BTreeMap<String, String>) {
        let Value::Object(table) = value else {
            leaves.insert(path.to_owned(), value.to_string());
            return;
        };
        for (key, inner) in table {
            let path = if path.is_empty() {
                key.clone()
            } else {
                format!("{path}.{key}")
            };
            collect(inner, &path, leaves);
        }
    }
    let mut leaves = BTreeMap::new();
    collect(value, "", &mut leaves);
    leaves
}

/// The differences between two runs apart from the random numbers.
fn differences(found: &BTreeMap<String, String>, wanted: &BTreeMap<String, String>) -> Vec<String> {
    let missing = "missing".to_owned();
    let keys = found
        .keys()
        .chain(wanted.keys().filter(|key| !found.contains_key(*key)));
    keys.filter(|key| !matches!(key.as_str(), "run.seed" | "replicate"))
        .filter_map(|key| {
            let [was, is] = [found, wanted].map(|leaves| leaves.get(key).unwrap_or(&missing));
            (was != is).then(|| format!("{key}: {was}, now {is}"))
        })
        .collect()
}
