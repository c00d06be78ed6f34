//! The published rows, and what came out of those that were computed again.

use maud::{Markup, html};

use crate::published_in_words;
use crate::report::Report;

/// Rows that differ which are shown; `claims.json` has them all.
const SHOWN: usize = 20;

/// What has become of the published rows of each study.
pub(super) fn section(report: &Report) -> Markup {
    html! {
        @if let Some(words) = published_in_words(&report.published, report.drawn.as_ref()) {
            section #rows {
                h2 { "The published rows" }
                p { (words) }
                @if report.published.iter().any(|study| !study.differing.is_empty()) {
                    p.failure role="note" { "Rows that are not what their runs give decide about the claims of this page all the same." }
                    table {
                        thead { tr { th { "Study" } th { "Run" } th { "Column" } th { "Published" } th { "Computed again" } } }
                        tbody { @for row in differing(report).take(SHOWN) { tr { @for cell in row { td { (cell) } } } } }
                    }
                }
                details {
                    summary { "Study by study" }
                    table {
                        thead { tr { th { "Study" } th { "Published" } th { "Computed again" } th { "The same" } } }
                        tbody {
                            @for study in &report.published {
                                tr {
                                    td { (study.study) }
                                    td { (study.rows) }
                                    td { (study.checked) }
                                    td { (study.checked - study.differing.len()) }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Study, run, column and both values of each row that differs, by its first column that does.
fn differing(report: &Report) -> impl Iterator<Item = [String; 5]> {
    report.published.iter().flat_map(|study| {
        let rows = study.differing.iter();
        rows.filter_map(|row| {
            let first = row.columns.first()?;
            let [published, computed] = first.values.clone();
            let (study, identity) = (study.study.to_owned(), row.identity.to_string());
            Some([study, identity, first.column.clone(), published, computed])
        })
    })
}
