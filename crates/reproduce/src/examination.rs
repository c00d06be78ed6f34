//! An experiment with its finding.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc;

use crate::claim::Claim;
use crate::error::ReproduceError;
use crate::evidence::Evidence;
use crate::finding::{Finding, Verdict};

/// An experiment, a claim or a textbook case, with its finding.
#[derive(Clone, Debug)]
pub struct Examination<E = Claim> {
    /// The experiment.
    pub experiment: E,
    /// The finding; open and empty where the examination failed.
    pub finding: Finding,
    /// Why the examination failed, if it did.
    pub failure: Option<String>,
}

impl<E> Examination<E> {
    /// The examination from its finding or the reason of its failure.
    pub(crate) fn new(experiment: E, outcome: Result<Finding, String>) -> Self {
        let (finding, failure) = match outcome {
            Ok(finding) => (finding, None),
            Err(reason) => {
                let summary = "It could not be examined.".to_owned();
                let finding = Finding {
                    summary,
                    ..Finding::default()
                };
                (finding, Some(reason))
            }
        };
        Self {
            experiment,
            finding,
            failure,
        }
    }

    /// Whether the experiment agrees with its expectation.
    pub fn passed(&self) -> bool {
        self.finding.verdict == Verdict::Reproduced
    }
}

impl Examination {
    /// Whether there was enough for a verdict.
    pub fn is_sufficient(&self) -> bool {
        self.finding.statistics.suffice(&self.experiment.needed)
    }
}

/// Examines claims side by side; `answered` takes the outcome of each, with the claim's place, as it comes.
pub(crate) fn examine(
    claims: Vec<(usize, Claim)>,
    evidence: &Evidence,
    mut answered: impl FnMut(usize, Result<Finding, ReproduceError>),
) {
    let (sender, receiver) = mpsc::channel();
    rayon::in_place_scope(|scope| {
        for (place, claim) in claims {
            let sender = sender.clone();
            scope.spawn(move |_| {
                let outcome = without_panic(|| claim.examine(evidence));
                // The receiver goes after the last answer.
                let _ = sender.send((place, outcome));
            });
        }
        drop(sender);
        for (place, outcome) in receiver {
            answered(place, outcome);
        }
    });
}

/// Calls an examination; a panic, which is a bug in this one, costs no other.
pub(crate) fn without_panic(
    examine: impl FnOnce() -> Result<Finding, ReproduceError>,
) -> Result<Finding, ReproduceError> {
    catch_unwind(AssertUnwindSafe(examine)).unwrap_or(Err(ReproduceError::Panicked))
}

/// The experiments of these names, in the order of `all`; all of them where no name is given. Case does not matter.
///
/// # Errors
/// [`ReproduceError::NoSuchExperiment`].
pub(crate) fn experiments_named<E: Copy>(
    kind: &'static str,
    all: &[E],
    name_of: impl Fn(&E) -> &'static str,
    names: &[String],
) -> Result<Vec<E>, ReproduceError> {
    let has = |experiment: &E, name: &String| name_of(experiment).eq_ignore_ascii_case(name.trim());
    if let Some(unknown) = names
        .iter()
        .find(|name| !all.iter().any(|one| has(one, name)))
    {
        return Err(ReproduceError::NoSuchExperiment {
            kind,
            asked: unknown.clone(),
            known: all.iter().map(name_of).collect(),
        });
    }
    let is_wanted = |one: &&E| names.is_empty() || names.iter().any(|name| has(one, name));
    Ok(all.iter().filter(is_wanted).copied().collect())
}
