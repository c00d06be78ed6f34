//! The studies behind the claims.

use crate::{Size, StudyOutcome};
use maud::{Markup, html};

use super::parts::{anchor, counts, study_anchor};
use crate::report::Report;

/// All studies with their files.
pub(super) fn section(report: &Report) -> Markup {
    html! {
        @if !report.studies.is_empty() {
            section #studies {
                h2 { "The studies" }
                p {
                    "Each study is a file; its runs are named by what they compute, so that any of them can be made again or compared \
                    alone."
                    @if report.size == Size::Quick {
                        " The texts are those of the quick designs: the full ones with what " code { "studies/quick.toml" } " has in their place."
                    }
                }
                @for study in &report.studies { (entry(report, study)) }
            }
        }
    }
}

fn entry(report: &Report, study: &StudyOutcome) -> Markup {
    let claims: Vec<&str> = report
        .examinations
        .iter()
        .map(|examination| &examination.experiment)
        .filter(|claim| claim.all_studies().contains(&study.file.name))
        .map(|claim| claim.id)
        .collect();
    html! {
        article.study #(study_anchor(study.file.name)) {
            h3 { (if study.title.is_empty() { study.file.name } else { &study.title }) }
            p.meta {
                code { (study.file.path) } " · " (counts(study)) " · for "
                @for (place, claim) in claims.iter().enumerate() {
                    @if place > 0 { ", " }
                    a href={ "#" (anchor(claim)) } { (claim) }
                }
            }
            @if let Some(failure) = &study.failure { p.failure role="note" { (failure) } }
            details {
                summary { "Study file" }
                pre tabindex="0" { code { (study.file.text(report.size).trim_end()) } }
            }
        }
    }
}
