//! The findings for programs.

use crate::{Examination, Quantity, ReportTable, Statistics, Verdict, WallVerdict};
use peristalsis_study::RowDifference;
use serde::Serialize;

use crate::report::files::{FigureFiles, figure_files, table_names};
use crate::report::{Program, Report, WallTally};

/// Version of the layout of the file.
const FORMAT: u32 = 2;

#[derive(Serialize)]
struct Document<'a> {
    format: u32,
    program: &'a Program,
    size: &'static str,
    walls: Vec<WallTally<'a>>,
    published_rows: Published<'a>,
    claims: Vec<Claim<'a>>,
}

#[derive(Serialize)]
struct Published<'a> {
    /// Of the draw; null where none was made.
    seed: Option<u64>,
    studies: Vec<PublishedStudy<'a>>,
    differing: Vec<Differing<'a>>,
}

#[derive(Serialize)]
struct PublishedStudy<'a> {
    study: &'a str,
    rows: usize,
    within_reach: Option<usize>,
    checked: usize,
    older: usize,
    differing: usize,
}

#[derive(Serialize)]
struct Differing<'a> {
    study: &'a str,
    identity: String,
    column: &'a str,
    published: &'a str,
    computed: &'a str,
}

#[derive(Serialize)]
struct Claim<'a> {
    id: &'a str,
    title: &'a str,
    statement: String,
    source: &'a str,
    verdict: Verdict,
    walls: &'a [WallVerdict],
    summary: &'a str,
    statistics: Statistics,
    /// The parameter that `widths` counts.
    varied: &'a str,
    /// The least for a verdict.
    needed: Statistics,
    sufficient: bool,
    failure: Option<&'a str>,
    quantities: &'a [Quantity],
    paragraphs: &'a [String],
    weaknesses: &'a [String],
    figures: Vec<Figure<'a>>,
    tables: Vec<FiledTable<'a>>,
    studies: Vec<Study<'a>>,
}

#[derive(Serialize)]
struct Figure<'a> {
    file: String,
    caption: &'a str,
}

#[derive(Serialize)]
struct FiledTable<'a> {
    file: Option<String>,
    #[serde(flatten)]
    table: &'a ReportTable,
}

#[derive(Serialize)]
struct Study<'a> {
    name: &'a str,
    path: &'a str,
    runs: usize,
    done: usize,
    missing: usize,
    failed: usize,
    failure: Option<&'a str>,
}

/// The file's text.
pub(crate) fn text(report: &Report) -> String {
    let figures = figure_files(&report.examinations);
    let document = Document {
        format: FORMAT,
        program: &report.program,
        size: report.size.name(),
        walls: report.walls(),
        published_rows: published(report),
        claims: report
            .examinations
            .iter()
            .enumerate()
            .map(|(place, examination)| claim(report, &figures, place, examination))
            .collect(),
    };
    json_text(&document)
}

fn published(report: &Report) -> Published<'_> {
    let drawn = report.drawn.as_ref();
    let reach = |name: &str| {
        let mut studies = drawn?.within_reach.iter();
        Some(studies.find(|(study, _)| *study == name)?.1)
    };
    let studies = report.published.iter().map(|it| PublishedStudy {
        study: it.study,
        rows: it.rows,
        within_reach: reach(it.study),
        checked: it.checked,
        older: it.older,
        differing: it.differing.len(),
    });
    let differing = report.published.iter().flat_map(|published| {
        let rows = published.differing.iter();
        rows.flat_map(|row| row.columns.iter().map(|it| (row.identity, it)))
            .map(
                |(identity, RowDifference { column, values, .. })| Differing {
                    study: published.study,
                    identity: identity.to_string(),
                    column,
                    published: &values[0],
                    computed: &values[1],
                },
            )
    });
    Published {
        seed: drawn.map(|drawn| drawn.sample.seed),
        studies: studies.collect(),
        differing: differing.collect(),
    }
}

/// A document as indented JSON with a line break at its end.
pub(crate) fn json_text(document: &impl Serialize) -> String {
    let text = serde_json::to_string_pretty(document)
        .expect("all keys are texts, and numbers that are not finite become null");
    text + "\n"
}

fn claim<'a>(
    report: &'a Report,
    figures: &FigureFiles<'_>,
    place: usize,
    examination: &'a Examination,
) -> Claim<'a> {
    let Examination {
        experiment: claim,
        finding,
        failure,
    } = examination;
    Claim {
        id: claim.id,
        title: claim.prose.title(),
        statement: claim.prose.statement(),
        source: claim.prose.source(),
        verdict: finding.verdict,
        walls: &finding.walls,
        summary: &finding.summary,
        statistics: finding.statistics,
        varied: claim.varied,
        needed: claim.needed,
        sufficient: examination.is_sufficient(),
        failure: failure.as_deref(),
        quantities: &finding.quantities,
        paragraphs: &finding.paragraphs,
        weaknesses: &finding.weaknesses,
        figures: figures.places[place]
            .iter()
            .zip(&finding.figures)
            .map(|(file, figure)| Figure {
                file: format!("figures/{}.svg", figures.files[*file].0),
                caption: &figure.caption,
            })
            .collect(),
        tables: table_names(examination)
            .into_iter()
            .zip(&finding.tables)
            .map(|(name, table)| FiledTable {
                file: name.map(|name| format!("tables/{name}")),
                table,
            })
            .collect(),
        studies: claim
            .all_studies()
            .into_iter()
            .filter_map(|name| report.study(name))
            .map(|study| Study {
                name: study.file.name,
                path: study.file.path,
                runs: study.runs,
                done: study.done,
                missing: study.missing(),
                failed: study.failed,
                failure: study.failure.as_deref(),
            })
            .collect(),
    }
}
