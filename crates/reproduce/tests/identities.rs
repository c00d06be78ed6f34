//! Who the runs behind the claims are: identities and seeds of every study, against those on record. The rows in
//! `validation/results` belong to these.
//!
//! `UPDATE_EXPECT=1 cargo test -p peristalsis-reproduce --test identities` writes the record anew: right where runs were added.

#![allow(
    clippy::unwrap_used,
    reason = "a test fails where what it needs is missing"
)]

use std::fmt::Write;

use expect_test::expect_file;
use peristalsis_formats::hexadecimal;
use peristalsis_reproduce::{STUDIES, Size};
use sha2::{Digest, Sha256};

#[test]
fn runs_are_who_they_were() {
    let mut found = String::new();
    for study in STUDIES {
        for size in [Size::Quick, Size::Full] {
            let specification = study.specification(size).unwrap();
            let plan = specification.plan();
            let mut digest = Sha256::new();
            for run in plan.runs() {
                let seed = plan.configuration(run).run.seed;
                digest.update(format!("{} {seed}\n", run.identity));
            }
            let digest = hexadecimal(&digest.finalize()[..8]);
            let runs = plan.runs().len();
            writeln!(
                found,
                "{digest} {}, {}, {runs} runs",
                study.name,
                size.name()
            )
            .unwrap();
        }
    }
    expect_file!["identities.txt"].assert_eq(&found);
}
