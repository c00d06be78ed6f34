//! All that is known of a study, for whoever wants to look.

use std::collections::{BTreeMap, HashMap, HashSet};

use super::{Entry, LEASE_TIMEOUT, RUNS, State, Store};
use crate::error::{Result, StudyError};
use crate::estimate::work;
use crate::identity::Identity;
use crate::plan::Plan;
use crate::refinement::{Finding, refine};
use crate::row::Row;
use crate::specification::Specification;

/// All that is known of a study and its runs at one moment.
#[derive(Clone, Debug)]
pub struct Survey {
    /// The study.
    pub study: Specification,
    /// Its runs, with those that refinement has added.
    pub plan: Plan,
    /// The entry of each run, also of runs of other plans of the same store.
    pub entries: HashMap<Identity, Entry>,
    /// Which runs are being worked on, and by whom, in words.
    pub leases: HashMap<Identity, String>,
}

impl Survey {
    /// The state of a run.
    pub fn state(&self, identity: Identity) -> State {
        match self.entries.get(&identity).map(|entry| entry.state) {
            Some(State::Done) => State::Done,
            _ if self.leases.contains_key(&identity) => State::Leased,
            state => state.unwrap_or(State::Pending),
        }
    }

    /// Whether the row of a run was imported, and not computed here.
    pub fn is_imported(&self, identity: Identity) -> bool {
        let entry = self.entries.get(&identity);
        entry.is_some_and(|entry| entry.state == State::Done && !entry.is_computed())
    }

    /// Why a run failed; empty where it did not.
    pub fn reason(&self, identity: Identity) -> &str {
        let entry = self.entries.get(&identity);
        entry
            .and_then(|entry| entry.reason.as_deref())
            .unwrap_or_default()
    }

    /// The row of a finished run as the index has it; `None` where the run is not finished, or the index is damaged.
    pub fn row(&self, identity: Identity) -> Option<Row> {
        let entry = self.entries.get(&identity)?;
        Row::from_csv(entry.row.as_deref()?).ok()
    }

    /// Runs of the plan in each state.
    pub fn counts(&self) -> BTreeMap<State, usize> {
        let mut counts = BTreeMap::new();
        for run in self.plan.runs() {
            *counts.entry(self.state(run.identity)).or_default() += 1;
        }
        counts
    }

    /// Finished runs in the store that are not in the plan.
    pub fn others(&self) -> usize {
        let planned: HashSet<Identity> = self.plan.runs().iter().map(|run| run.identity).collect();
        let is_other = |(identity, entry): &(&Identity, &Entry)| {
            entry.state == State::Done && !planned.contains(*identity)
        };
        self.entries.iter().filter(is_other).count()
    }

    /// The work of all runs of the plan, in grains times steps.
    pub fn work(&self) -> f64 {
        self.work_of(|_| true)
    }

    /// The work of the runs that have not ended, in grains times steps.
    pub fn work_left(&self) -> f64 {
        self.work_of(|identity| self.finding(identity).is_none())
    }

    fn work_of(&self, which: impl Fn(&Identity) -> bool) -> f64 {
        let runs = self.plan.runs().iter().filter(|run| which(&run.identity));
        let work = |run| work(&self.plan.point(run).configuration);
        runs.map(work).sum()
    }

    /// Outcome of a run that has ended, for its point.
    pub fn finding(&self, identity: &Identity) -> Option<Finding> {
        finding(&self.entries, identity)
    }

    /// The run whose identity begins with `prefix`, in the plan or not.
    ///
    /// # Errors
    /// [`StudyError::NoSuchRun`] unless there is exactly one.
    pub fn run_beginning(&self, prefix: &str) -> Result<Identity> {
        let mut found: Vec<Identity> = self
            .plan
            .runs()
            .iter()
            .map(|run| run.identity)
            .chain(self.entries.keys().copied())
            .filter(|identity| identity.to_string().starts_with(prefix))
            .collect();
        found.sort();
        found.dedup();
        match found.as_slice() {
            [one] => Ok(*one),
            several => Err(StudyError::NoSuchRun {
                prefix: prefix.to_owned(),
                number: several.len(),
            }),
        }
    }
}

/// Outcome of a run that has ended, for its point.
pub(crate) fn finding(entries: &HashMap<Identity, Entry>, identity: &Identity) -> Option<Finding> {
    let entry = entries.get(identity)?;
    match entry.state {
        State::Done if entry.transition_time.is_some() => Some(Finding::Transition),
        State::Done => Some(Finding::NoTransition),
        State::Failed => Some(Finding::Nothing),
        _ => None,
    }
}

impl Store {
    /// All that is known of the study and its runs.
    ///
    /// # Errors
    /// Errors of reading study file or index.
    pub fn survey(&self) -> Result<Survey> {
        let study = self.specification()?;
        let index = self.index_to_read()?;
        let mut entries = index.entries()?;
        let leases = index.leases(LEASE_TIMEOUT)?;
        // Of a run that was killed the index says nothing: only its folder does.
        for identity in self.identities(RUNS)? {
            let is_known = entries.contains_key(&identity) || leases.contains_key(&identity);
            if !is_known && self.run_files(identity).has_checkpoint() {
                entries.insert(identity, Entry::new(State::Checkpointed, None));
            }
        }
        let leases = leases.into_iter();
        let leases = leases
            .map(|(identity, lease)| (identity, lease.in_words()))
            .collect();
        let mut plan = study.plan().clone();
        refine(&study, &mut plan, &|identity| finding(&entries, identity));
        Ok(Survey {
            study,
            plan,
            entries,
            leases,
        })
    }
}
