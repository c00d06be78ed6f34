//! The section of a claim.

use crate::claim::Claim;
use crate::{Examination, Finding, Quantity, ReportFigure, ReportTable, WallVerdict};
use maud::{Markup, html};
use peristalsis_analysis::number::{counted, distance, interval, plain};

use super::parts::{anchor, counts, study_anchor, verdict_badge};
use crate::report::Report;
use crate::report::markup::{plain_text, rich};
use crate::report::picture::embedded;

/// Width of a page's column in millimetres: a wider figure may take the whole width.
const COLUMN: f64 = 120.0;

/// All that is said of a claim.
pub(super) fn section(report: &Report, place: usize, examination: &Examination) -> Markup {
    let Examination {
        experiment: claim,
        finding,
        failure,
    } = examination;
    let name = anchor(claim.id);
    html! {
        section.claim #(name) aria-labelledby={ (name) "-title" } {
            header {
                h2 id={ (name) "-title" } { span.id { (claim.id) } " " (rich(claim.prose.title())) }
                (verdict_badge(examination))
            }
            blockquote {
                p { (rich(&claim.prose.statement())) }
                @if !claim.prose.source().is_empty() { footer { (rich(claim.prose.source())) } }
            }
            @if let Some(failure) = failure {
                p.failure role="note" { b { "This claim could not be examined. " } (failure) }
            } @else {
                p.lead { (rich(&finding.summary)) }
                (statistics(examination))
                @if !finding.walls.is_empty() { (walls(&finding.walls)) }
            }
            @if !finding.quantities.is_empty() { (quantities(&finding.quantities)) }
            @for (number, figure) in finding.figures.iter().enumerate() {
                (drawing(claim.id, place, number, figure))
            }
            (missing_figures(claim, finding))
            @for paragraph in &finding.paragraphs { p { (rich(paragraph)) } }
            @for (number, one) in finding.tables.iter().enumerate() { (table(claim.id, number, one)) }
            @if !finding.weaknesses.is_empty() {
                aside.weaknesses {
                    h3 { "What a critical reader should know" }
                    ul { @for weakness in &finding.weaknesses { li { (rich(weakness)) } } }
                }
            }
            @if !claim.studies.is_empty() {
                p.meta.sources {
                    "From "
                    @for (place, study) in claim.all_studies().into_iter().filter_map(|name| report.study(name)).enumerate() {
                        @if place > 0 { "; " }
                        a href={ "#" (study_anchor(study.file.name)) } { (study.file.name) }
                        " (" (counts(study)) ")"
                    }
                    "."
                }
            }
        }
    }
}

/// The figures of a claim that the runs at hand do not suffice for, and the command that draws them.
fn missing_figures(claim: &Claim, finding: &Finding) -> Markup {
    let is_missing = |name: &&str| finding.figures.iter().all(|figure| figure.name != *name);
    let missing: Vec<String> = claim
        .prose
        .figures()
        .filter(is_missing)
        .map(|name| name.replace('-', " "))
        .collect();
    html! {
        @if !missing.is_empty() {
            p.meta {
                "Not drawn, for it takes runs that are missing here, or their time series, profiles or spheres, which tables do not hold: "
                (missing.join(", ")) ". "
                code { "peristalsis reproduce --full --only " (claim.id) }
                " computes them."
            }
        }
    }
}

/// The runs behind the finding, and whether they are enough.
fn statistics(examination: &Examination) -> Markup {
    let found = examination.finding.statistics;
    let needed = examination.experiment.needed;
    html! {
        @if found.runs == 0 {
            p.statistics { "No finished runs yet." }
        } @else {
            p.statistics {
                (counted(found.strain_rates, "strain rate")) " × " (counted(found.widths, examination.experiment.varied)) " × "
                (counted(found.replicates, "replicate")) ", " (counted(found.runs, "run")) " in all: "
                @if examination.is_sufficient() { "enough for a verdict." }
                @else {
                    "too few for a verdict, which takes " (needed) "."
                }
            }
        }
    }
}

/// The verdict on each wall, and why.
fn walls(walls: &[WallVerdict]) -> Markup {
    let depends = walls.iter().any(|one| !one.depends_on.is_empty());
    html! {
        div.scroll tabindex="0" role="region" aria-label="Verdict by wall" {
            table.walls {
                thead {
                    tr { th scope="col" { "Wall" } th scope="col" { "Verdict" } th scope="col" { "Result" } th scope="col" { "Details" }
                        @if depends { th scope="col" { "Depends on " (rich("*ε\u{307}* =")) } }
                    }
                }
                tbody {
                    @for one in walls {
                        tr {
                            th scope="row" { (one.wall) }
                            td { (one.verdict.name()) }
                            td { (rich(&one.number)) }
                            td { (rich(&one.why)) }
                            @if depends { td { (one.depends_on_in_words()) } }
                        }
                    }
                }
            }
        }
    }
}

fn quantities(quantities: &[Quantity]) -> Markup {
    html! {
        div.scroll tabindex="0" role="region" aria-label="Numbers" {
            table.quantities {
                thead {
                    tr {
                        th scope="col" { "Quantity, and how it was got" }
                        th.number scope="col" { "Ours" }
                        th.number scope="col" { "95 % interval" }
                        th.number scope="col" { "Source" }
                        th.number scope="col" { "Difference" }
                    }
                }
                tbody { @for quantity in quantities { (quantity_row(quantity)) } }
            }
        }
    }
}

fn quantity_row(quantity: &Quantity) -> Markup {
    let ours = quantity.ours.as_ref();
    let none = || "–".to_owned();
    let difference = ours
        .zip(quantity.source)
        .and_then(|(ours, source)| distance(ours, source));
    html! {
        tr {
            th scope="row" {
                @if !quantity.symbol.is_empty() { span.symbol { (rich(&quantity.symbol)) } " " }
                span.what { (rich(&quantity.name)) @if !quantity.unit.is_empty() { " [" (rich(&quantity.unit)) "]" } }
                @if !quantity.method.is_empty() { span.method { (rich(&quantity.method)) } }
            }
            (cell("Ours", html! {
                @match ours { Some(ours) => b { (rich(&ours.to_string())) }, None => span.none { "not determined" } }
            }))
            (cell("95 % interval", rich(&ours.map_or_else(none, interval))))
            (cell("Source", rich(&quantity.source.map_or_else(none, plain))))
            (cell("Difference", rich(&difference.unwrap_or_else(none))))
        }
    }
}

/// A cell that names its column, for pages too narrow for columns.
fn cell(column: &str, content: Markup) -> Markup {
    html! { td.number data-label=(column) { span { (content) } } }
}

fn drawing(claim: &str, place: usize, number: usize, figure: &ReportFigure) -> Markup {
    let wide = figure.drawing.width_millimetres() > COLUMN;
    let prefix = format!("c{place}f{number}-");
    html! {
        figure.wide[wide] {
            div.drawing { (embedded(&figure.drawing, &prefix, &plain_text(&figure.caption))) }
            figcaption { b { "Figure " (claim) "." (number + 1) } " " (rich(&figure.caption)) }
        }
    }
}

fn table(claim: &str, number: usize, table: &ReportTable) -> Markup {
    let caption = format!("{}-table-{}", anchor(claim), number + 1);
    let numeric: Vec<bool> = (0..table.head.len())
        .map(|column| {
            let mut cells = table.rows.iter().filter_map(|row| row.get(column));
            cells.all(|cell| is_number(cell))
        })
        .collect();
    let is_numeric = |column: usize| numeric.get(column).copied().unwrap_or(false);
    html! {
        figure.table {
            figcaption #(caption) { b { "Table " (claim) "." (number + 1) } " " (rich(&table.caption)) }
            div.scroll tabindex="0" role="region" aria-labelledby=(caption) {
                table aria-labelledby=(caption) {
                    thead {
                        tr {
                            @for (column, head) in table.head.iter().enumerate() {
                                th.number[is_numeric(column)] scope="col" { (rich(head)) }
                            }
                        }
                    }
                    tbody {
                        @for row in &table.rows {
                            tr {
                                @for (column, cell) in row.iter().enumerate() {
                                    td.number[is_numeric(column)] { (rich(cell)) }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Whether a cell is empty or begins like a number: a column of such cells is set to the right.
fn is_number(cell: &str) -> bool {
    let first = plain_text(cell).chars().next();
    first.is_none_or(|first| first.is_ascii_digit() || "−+–-≤≥<>[(".contains(first))
}
