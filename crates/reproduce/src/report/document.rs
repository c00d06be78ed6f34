//! The findings as one document in Markdown: the opening table, then a section a claim.

use peristalsis_analysis::number::plain;

use crate::Examination;
use crate::contents::{Quantity, ReportTable};
use crate::finding::{Finding, Statistics, Verdict};
use crate::prose::{filled, values};
use crate::report::files::figure_files;
use crate::report::markdown::table;
use crate::report::markup::markdown;
use crate::report::{Report, page};

/// Numbers, and columns and cells of a table, that a section shows at most; all are in the page and in `claims.json`.
const MOST_NUMBERS: usize = 3;
const MOST_COLUMNS: usize = 6;
const MOST_CELLS: usize = 70;

/// Above the strain rates without which a verdict would be another.
const DEPENDS_ON: &str = "depends on *ε\u{307}* =";

/// What stands above the table.
const OPENING: &str = include_str!("document.md");

/// The text; `figures` is the folder of the pictures as the document sees it.
pub(crate) fn text(report: &Report, figures: &str) -> String {
    let needed = Statistics::FOR_A_VERDICT;
    let count = |verdict: Verdict| {
        let examinations = report.examinations.iter();
        let found = examinations.filter(|one| one.finding.verdict == verdict);
        format!("{}: {}", verdict.name(), found.count())
    };
    let quick = report.size.choose(" --quick", "");
    let command = format!("peristalsis reproduce{quick}{}", page::only(report));
    let mut text = filled(
        OPENING,
        values!(
            command,
            count = Verdict::ALL.map(count).join(", "),
            strain_rates = needed.strain_rates,
            widths = needed.widths,
            replicates = needed.replicates
        ),
    );
    text.push_str(&format!("\n{}", table(&overview(report))));
    let files = figure_files(&report.examinations);
    for (examination, places) in report.examinations.iter().zip(&files.places) {
        let file = places.first().map(|place| files.files[*place].0.as_str());
        text.push_str(&section(examination, file, figures));
    }
    text
}

/// Claims down, walls across: the verdicts, and the number of each.
fn overview(report: &Report) -> ReportTable {
    let walls = report.walls();
    let on = |finding: &Finding, wall: &str| {
        let found = finding.walls.iter().find(|one| one.wall == wall);
        found.map(|one| (one.verdict_with_mark(), markdown(&one.number)))
    };
    let row = |examination: &Examination| {
        let (id, finding) = (examination.experiment.id, &examination.finding);
        let title = markdown(examination.experiment.prose.title());
        let verdicts = walls.iter().map(|tally| {
            let found = on(finding, tally.wall);
            found.map_or_else(String::new, |(verdict, number)| match &*number {
                "" | "–" => verdict,
                number => format!("{verdict}: {number}"),
            })
        });
        let number = finding.quantities.first().map(number_of);
        let number = number.filter(|_| finding.walls.is_empty());
        let mut cells = vec![
            format!("[{id}](#{}) {title}", id.to_lowercase()),
            format!("**{}**", finding.verdict.name()),
        ];
        cells.extend(verdicts);
        cells.push(number.unwrap_or_default());
        cells
    };
    let mut rows: Vec<Vec<String>> = report.examinations.iter().map(row).collect();
    if !walls.is_empty() {
        let met = walls.iter();
        let met = met.map(|tally| format!("{} of {}", tally.met, tally.judged));
        let mut cells = vec!["claims met".to_owned(), String::new()];
        cells.extend(met);
        cells.push(String::new());
        rows.push(cells);
    }
    let head = ["claim", "verdict"].into_iter();
    let head = head.chain(walls.iter().map(|tally| tally.wall));
    ReportTable::new("", head.chain(["result"]), rows)
}

/// A number with its name, its error and the value of the source.
fn number_of(quantity: &Quantity) -> String {
    let [_, ours, source] = cells(quantity);
    let source = match &*source {
        "" => source,
        source => format!(" (source: {source})"),
    };
    markdown(&format!("{}: {ours}{source}", quantity.name))
}

/// What is said of a claim.
fn section(examination: &Examination, file: Option<&str>, figures: &str) -> String {
    let (claim, finding) = (&examination.experiment, &examination.finding);
    let (id, prose) = (claim.id, &claim.prose);
    let mut text = format!(
        "\n<a id=\"{}\"></a>\n\n## {id}. {}\n",
        id.to_lowercase(),
        markdown(prose.title())
    );
    let mut add = |paragraph: &str| text.push_str(&format!("\n{paragraph}\n"));
    let source = match prose.source() {
        "" => String::new(),
        source => format!(" ({})", markdown(source)),
    };
    add(&format!("> {}{source}", markdown(&prose.statement())));
    let summary = match &examination.failure {
        Some(failure) => format!("It could not be examined: {failure}"),
        None => finding.summary.clone(),
    };
    let (verdict, needed) = (finding.verdict.name(), claim.needed);
    let takes = match needed == Statistics::FOR_A_VERDICT {
        true => String::new(),
        false => format!(" ({needed})"),
    };
    add(&format!("**{verdict}**{takes} – {}", markdown(&summary)));
    if let (Some(file), Some(figure)) = (file, finding.figures.first()) {
        // Its first sentence, which stands for the picture where none is seen; a bracket would end it.
        let caption = figure
            .caption
            .split_once(". ")
            .map_or(&*figure.caption, |(first, _)| first)
            .trim_end_matches('.');
        let caption = markdown(caption).replace(['[', ']'], " ");
        add(&format!("![{caption}]({figures}/{file}.svg)"));
    }
    for paragraph in &finding.paragraphs {
        add(&markdown(paragraph));
    }
    if let Some(found) = digest(finding) {
        if !found.caption.is_empty() {
            add(&found.caption);
        }
        add(table(&found).trim_end());
    }
    let weaknesses = finding.weaknesses.iter();
    let weaknesses: String = weaknesses
        .map(|weakness| format!("- {}\n", markdown(weakness)))
        .collect();
    if !weaknesses.is_empty() {
        text.push_str(&format!("\nWeaknesses:\n\n{weaknesses}"));
    }
    text
}

/// The table of a section: what the walls show; or the first table, unless it is large; or the most important numbers that
/// its paragraph does not say.
fn digest(finding: &Finding) -> Option<ReportTable> {
    let first = finding.tables.first();
    let small = first.filter(|one| {
        let cells = one.head.len() * one.rows.len();
        one.head.len() <= MOST_COLUMNS && (1..=MOST_CELLS).contains(&cells)
    });
    let found = if !finding.walls.is_empty() {
        let depends = finding.walls.iter().any(|wall| !wall.depends_on.is_empty());
        let rows = finding.walls.iter().map(|wall| {
            let verdict = wall.verdict.name().to_owned();
            let mut row = vec![
                wall.wall.clone(),
                verdict,
                wall.number.clone(),
                wall.why.clone(),
            ];
            if depends {
                row.push(wall.depends_on_in_words());
            }
            row
        });
        let head = ["wall", "verdict", "result", "details", DEPENDS_ON];
        ReportTable::new("", head.into_iter().take(4 + usize::from(depends)), rows)
    } else if let Some(small) = small {
        small.clone()
    } else {
        let is_said = |one: &&Quantity| {
            let ours = one.ours.as_ref().map(ToString::to_string);
            one.source.is_none() && ours.is_some_and(|ours| finding.summary.contains(&ours))
        };
        let quantities = finding.quantities.iter().take(MOST_NUMBERS);
        let quantities = quantities.filter(|one| !is_said(one));
        let is_sourced = quantities.clone().any(|one| one.source.is_some());
        let shown = if is_sourced { 3 } else { 2 };
        let rows = quantities.map(|one| cells(one)[..shown].to_vec());
        ReportTable::new(
            "",
            ["number", "ours", "source"].into_iter().take(shown),
            rows,
        )
    };
    (!found.rows.is_empty()).then(|| {
        let marked = |cells: &Vec<String>| -> Vec<String> {
            cells.iter().map(|cell| markdown(cell)).collect()
        };
        ReportTable::new(
            &markdown(&found.caption),
            marked(&found.head),
            found.rows.iter().map(marked),
        )
    })
}

/// A number with its unit, ours, and that of the source.
fn cells(quantity: &Quantity) -> [String; 3] {
    let ours = quantity.ours.as_ref();
    let unit = match &*quantity.unit {
        "" | "1" => String::new(),
        unit => format!(" [{unit}]"),
    };
    [
        format!("{}{unit}", quantity.name),
        ours.map_or_else(|| "not determined".to_owned(), ToString::to_string),
        quantity.source.map_or_else(String::new, plain),
    ]
}
