//! The published rows beside what the same runs gave when they were computed again.

use std::path::{Path, PathBuf};

use peristalsis_run::files;
use peristalsis_study::{Identity, RESUMMED, RowDifference, State, Store, StudyError};

use super::{Drawn, Work};

/// What has become of the published rows of a study: those that were imported.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PublishedRows {
    /// Name of the study.
    pub study: &'static str,
    /// How many there are.
    pub rows: usize,
    /// Those whose runs were computed again, drawn at random or for what a row does not hold.
    pub checked: usize,
    /// Of these, those that are the same but for what their program, an older one, read off otherwise
    /// ([`RowDifference::is_known`]).
    pub older: usize,
    /// Of these, those that did not come out the same.
    pub differing: Vec<DifferingRow>,
}

/// A published row that is not what its run gives.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DifferingRow {
    /// Whose it is.
    pub identity: Identity,
    /// The columns that differ.
    pub columns: Vec<RowDifference>,
    /// Configuration of the run.
    pub configuration: PathBuf,
}

/// What has become of the published rows of all studies, in a sentence or two; `None` where there are none.
pub fn published_in_words(all: &[PublishedRows], drawn: Option<&Drawn>) -> Option<String> {
    let sum = |number: fn(&PublishedRows) -> usize| all.iter().map(number).sum::<usize>();
    let (rows, checked) = (sum(|it| it.rows), sum(|it| it.checked));
    let (older, differing) = (sum(|it| it.older), sum(|it| it.differing.len()));
    if rows == 0 {
        return None;
    }
    if checked == 0 {
        return Some(format!(
            "None of the {rows} published rows was computed again."
        ));
    }
    let studies = all.iter().filter(|it| it.checked > 0).count();
    let seed = drawn.map(|drawn| format!(", drawn with the seed {}", drawn.sample.seed));
    let same = match differing {
        0 => "all came out the same".to_owned(),
        1 => "one came out different, all others the same".to_owned(),
        several => format!("{several} came out different, all others the same"),
    };
    let but = match older {
        0 => " to the bit".to_owned(),
        several => format!(
            " to the bit, in {several} of them but for what an older program read off otherwise, as the changelog says: errors, \
             averages over the late part of long runs, forces of contacts and in the front of the wave, dispersion, and last \
             digits of {}",
            RESUMMED.join(", ")
        ),
    };
    let mut words = format!(
        "Of {rows} published rows {checked}, from {studies} of {} studies, were computed again{}: {same}{but}.",
        all.len(),
        seed.unwrap_or_default(),
    );
    let none = all.iter().filter(|it| it.checked == 0).map(|it| it.study);
    let none: Vec<&str> = none.collect();
    if !none.is_empty() {
        let none = none.join(", ");
        words.push_str(&format!(
            " None was computed again of {none}: there was too little time."
        ));
    }
    Some(words)
}

impl PublishedRows {
    /// Compares the published rows of a study with the rows of the runs that were computed again, those in the store at
    /// `again`.
    pub(super) fn of(work: &Work, store: &Store, again: &Path) -> Result<Self, StudyError> {
        let survey = store.survey()?;
        let mut published = Self {
            study: work.file.name,
            rows: 0,
            checked: 0,
            older: 0,
            differing: Vec::new(),
        };
        let again = match Store::open(again) {
            Ok(again) => Some((again.survey()?, again)),
            Err(_) => None,
        };
        for run in survey.plan.runs() {
            let identity = run.identity;
            if !survey.is_imported(identity) {
                continue;
            }
            published.rows += 1;
            let Some((found, again)) = &again else {
                continue;
            };
            let mut columns = match found.state(identity) {
                State::Done => match (survey.row(identity), found.row(identity)) {
                    (Some(row), Some(found)) => row.differences(&found),
                    _ => continue,
                },
                State::Failed => vec![failure(found.reason(identity))],
                _ => continue,
            };
            published.checked += 1;
            if !columns.is_empty() && columns.iter().all(|column| column.is_known) {
                published.older += 1;
            } else if !columns.is_empty() {
                columns.retain(|column| !column.is_known);
                published.differing.push(DifferingRow {
                    identity,
                    columns,
                    configuration: again.run_folder(identity).join(files::CONFIGURATION),
                });
            }
        }
        Ok(published)
    }
}

/// The difference of a run that failed when it was computed again.
fn failure(reason: &str) -> RowDifference {
    RowDifference {
        column: "status".to_owned(),
        is_known: false,
        values: ["finished".to_owned(), format!("failed: {reason}")],
    }
}
