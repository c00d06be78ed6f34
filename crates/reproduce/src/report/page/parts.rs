//! Pieces that several parts of the page share.

use crate::{Examination, StudyOutcome};
use maud::{Markup, html};

use crate::report::files::plain_name;

/// Name of a claim's section within the page.
pub(crate) fn anchor(claim: &str) -> String {
    format!("claim-{}", plain_name(claim))
}

/// Name of a study's entry within the page.
pub(crate) fn study_anchor(study: &str) -> String {
    format!("study-{}", plain_name(study))
}

/// The verdict, and whether there was enough for one.
pub(crate) fn verdict_badge(examination: &Examination) -> Markup {
    let verdict = examination.finding.verdict.name();
    html! {
        span.badges {
            span.badge.(verdict) { span.mark.(verdict) aria-hidden="true" {} (verdict) }
            @if examination.failure.is_some() {
                " " span.badge.failed { "not examined" }
            } @else if !examination.is_sufficient() {
                " " span.badge.thin { "thin statistics" }
            }
        }
    }
}

/// The states of the runs of a study, such as "60 of 72 runs finished, 2 failed, 10 missing".
pub(crate) fn counts(study: &StudyOutcome) -> String {
    let mut text = format!("{} of {} runs finished", study.done, study.runs);
    for (number, state) in [(study.failed, "failed"), (study.missing(), "missing")] {
        if number > 0 {
            text.push_str(&format!(", {number} {state}"));
        }
    }
    text
}
