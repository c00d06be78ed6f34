//! The report of made-up findings: everything in it, nothing twice, the same bytes.

#![allow(
    clippy::unwrap_used,
    reason = "a test fails where what it needs is missing"
)]

#[path = "../../examples/specimen/findings.rs"]
mod findings;

mod document;
mod files;
mod json;
mod page;

use findings::specimen;
use peristalsis_reproduce::Examination;
use peristalsis_reproduce::report::Report;

/// Text that would break a page, a table or a path if it were taken as it is.
const HOSTILE: &str = "</section><script>alert(\"x\")</script> & 'q' --> ]]> \u{7}";

/// The specimen with hostile text wherever a text can stand.
fn hostile() -> Report {
    let mut report = specimen().unwrap();
    let Examination {
        finding, failure, ..
    } = &mut report.examinations[1];
    finding.summary = HOSTILE.to_owned();
    finding.paragraphs.push(HOSTILE.to_owned());
    finding.weaknesses.push(HOSTILE.to_owned());
    finding.quantities[0].name = HOSTILE.to_owned();
    finding.quantities[0].symbol = HOSTILE.to_owned();
    finding.quantities[0].unit = HOSTILE.to_owned();
    finding.quantities[0].method = HOSTILE.to_owned();
    finding.tables[0].caption = HOSTILE.to_owned();
    finding.tables[0].head[0] = HOSTILE.to_owned();
    finding.tables[0].rows[0][0] = HOSTILE.to_owned();
    finding.figures[0].caption = HOSTILE.to_owned();
    finding.figures[0].name = format!("../../{HOSTILE}");
    assert!(failure.is_none());
    report.examinations[0].failure = Some(HOSTILE.to_owned());
    report.studies[0].title = HOSTILE.to_owned();
    report.studies[0].failure = Some(HOSTILE.to_owned());
    report.program.revision = HOSTILE.to_owned();
    report
}
