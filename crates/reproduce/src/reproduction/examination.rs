//! A claim with what was found of it.

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::claim::Claim;
use crate::evidence::Evidence;
use crate::finding::{Finding, Statistics};

/// A claim with what was found of it.
#[derive(Clone, Debug)]
pub struct Examination {
    /// The claim.
    pub claim: Claim,
    /// What was found; open and empty where the examination failed.
    pub finding: Finding,
    /// Why the examination failed, if it did.
    pub failure: Option<String>,
}

impl Examination {
    /// Examines a claim; `failures` says of studies why they are not among the evidence.
    pub(super) fn of(
        claim: &Claim,
        evidence: &Evidence,
        failures: &BTreeMap<&'static str, String>,
    ) -> Self {
        // A panic is a bug of ours, in one claim: the others are reported.
        let outcome = catch_unwind(AssertUnwindSafe(|| (claim.examine)(evidence)));
        let failure = match outcome {
            Ok(Ok(finding)) => {
                return Self {
                    claim: *claim,
                    finding,
                    failure: None,
                };
            }
            // What is missing is missing because a study failed, and that is the reason to tell.
            Ok(Err(error)) => claim
                .studies
                .iter()
                .find_map(|name| Some(format!("study {name}: {}", failures.get(name)?)))
                .unwrap_or_else(|| error.to_string()),
            Err(_) => "the analysis panicked: please report this".to_owned(),
        };
        Self {
            claim: *claim,
            finding: Finding::nothing(
                "It could not be examined.",
                Statistics::default(),
                &Statistics::FOR_A_VERDICT,
            ),
            failure: Some(failure),
        }
    }

    /// Whether there was enough for a verdict.
    #[must_use]
    pub fn is_sufficient(&self) -> bool {
        self.finding.statistics.suffice(&self.finding.needed)
    }
}
