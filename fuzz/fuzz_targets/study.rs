//! No study file makes the reader panic, every place that an error points at lies within its text, and a study that is
//! accepted has runs that are all different.
//!
//! The input is a study file; what follows a line `---` is the configuration file that it may build on.
#![no_main]

use std::collections::HashSet;

use libfuzzer_sys::fuzz_target;
use peristalsis_study::{Specification, StudyError};

fuzz_target!(|input: &str| {
    let (text, base) = input.split_once("\n---\n").unwrap_or((input, ""));
    let file = |name: &str| Ok((name.to_owned(), base.to_owned()));
    match Specification::from_toml("fuzz.toml", text, file) {
        Ok(study) => {
            let plan = study.plan();
            let identities: HashSet<_> = plan.runs().iter().map(|run| run.identity).collect();
            assert_eq!(identities.len(), plan.runs().len());
            assert!(!plan.runs().is_empty());
        }
        Err(StudyError::Configuration(error)) => {
            assert!(!error.problems().is_empty());
            for label in error.problems().iter().flat_map(|problem| &problem.labels) {
                assert!(label.source_text.get(label.span.clone()).is_some());
            }
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});
