//! The cases in turn, and how their findings are written.

use std::fs;
use std::path::Path;

use peristalsis_formats::{atomic, csv};
use serde::Serialize;

use crate::check::verdict;
use crate::error::{Result, make_folder};
use crate::examination::without_panic;
use crate::report::{json_text, markdown, write_drawing};
use crate::row::extremes;
use crate::textbook::case::{Case, Circumstances};
use crate::{Check, Convergence, Examination, ReportTable, ReproduceError, Size};

/// Version of the layout of `validation.json`.
const FORMAT: u32 = 1;

/// Folder of figures beside a document.
const FIGURES: &str = "images/validation";

/// The findings of several cases.
#[derive(Clone)]
pub struct Validation {
    /// How much was computed.
    pub size: Size,
    /// The cases in their order.
    pub examinations: Vec<Examination<Case>>,
}

impl Validation {
    /// Examines cases in turn, telling of each as it ends. A case that fails, even by a panic, costs no other.
    ///
    /// # Errors
    /// [`ReproduceError::Stopped`] once `stops` says so.
    pub fn run(
        size: Size,
        cases: &[Case],
        stops: &dyn Fn() -> bool,
        tell: &mut dyn FnMut(&Examination<Case>),
    ) -> Result<Self> {
        let mut examinations = Vec::with_capacity(cases.len());
        for case in cases {
            let outcome = without_panic(|| (case.examine)(Circumstances { size, stops }));
            let outcome = match outcome {
                Err(ReproduceError::Stopped) => return Err(ReproduceError::Stopped),
                outcome => outcome.map_err(|error| error.to_string()),
            };
            let mut examination = Examination::new(*case, outcome);
            examination.finding.verdict = examination.finding.verdict_of_checks();
            tell(&examination);
            examinations.push(examination);
        }
        Ok(Self { size, examinations })
    }

    /// Whether every case passed.
    pub fn passed(&self) -> bool {
        self.examinations.iter().all(Examination::passed)
    }

    /// Everything for programs.
    pub fn json(&self) -> String {
        json_text(&Document {
            format: FORMAT,
            extent: self.size.name(),
            passed: self.passed(),
            cases: self.examinations.iter().map(CaseDocument::of).collect(),
        })
    }

    /// Writes into a folder `validation.json`, `NAME.md` and `NAME.csv` of every case, and `figures/FIGURE.svg` and `.png`,
    /// each file whole or not at all.
    ///
    /// # Errors
    /// Errors of making folders, drawing and writing.
    pub fn write(&self, folder: &Path) -> Result<()> {
        let figures = folder.join("figures");
        make_folder(&figures)?;
        for examination in &self.examinations {
            let path = folder.join(examination.experiment.name);
            if let Some(data) = &examination.finding.data {
                csv::write(&path.with_extension("csv"), data)?;
            }
            let text = block(examination, "figures");
            atomic::write(&path.with_extension("md"), text.as_bytes())?;
            for figure in &examination.finding.figures {
                write_drawing(&figures, &figure.name, &figure.drawing)?;
            }
        }
        atomic::write(&folder.join("validation.json"), self.json().as_bytes())?;
        Ok(())
    }

    /// Whether a document has a place for each of these cases.
    ///
    /// # Errors
    /// [`ReproduceError::Read`] and [`ReproduceError::NoPlace`].
    pub fn check_places(path: &Path, cases: &[Case]) -> Result<()> {
        let document = document(path)?;
        for case in cases {
            markdown::replaced(path, &document, case.name, "")?;
        }
        Ok(())
    }

    /// Replaces in a Markdown document the text between `<!-- validate NAME -->` and `<!-- /validate -->` for each case,
    /// and, where all cases were examined, for `summary`; figures go to `images/validation` beside the document.
    ///
    /// # Errors
    /// [`ReproduceError::Read`], and [`ReproduceError::NoPlace`] where a marker is missing; nothing is changed then.
    pub fn write_into(&self, path: &Path, all_cases: &[Case]) -> Result<()> {
        let mut document = document(path)?;
        for examination in &self.examinations {
            let (name, block) = (examination.experiment.name, block(examination, FIGURES));
            document = markdown::replaced(path, &document, name, &block)?;
        }
        let was_examined = |case: &Case| {
            let mut examined = self.examinations.iter().map(|one| one.experiment.name);
            examined.any(|name| name == case.name)
        };
        if all_cases.iter().all(was_examined) {
            let summary = markdown::table(&self.summary());
            document = markdown::replaced(path, &document, "summary", &summary)?;
        }
        let figures = path.parent().unwrap_or(Path::new("")).join(FIGURES);
        make_folder(&figures)?;
        let examinations = self.examinations.iter();
        for figure in examinations.flat_map(|one| &one.finding.figures) {
            let file = figures.join(&figure.name).with_extension("svg");
            atomic::write(&file, figure.drawing.svg().as_bytes())?;
        }
        atomic::write(path, document.as_bytes())?;
        Ok(())
    }

    /// All cases, a row each.
    fn summary(&self) -> ReportTable {
        let row = |examination: &Examination<Case>| {
            let finding = &examination.finding;
            let checks = finding.checks.iter();
            let used = checks.map(|check| check.deviation / check.tolerance);
            let orders = finding.convergences.iter().filter_map(|one| one.order);
            let [least, largest] = extremes(orders);
            let orders = if least > largest {
                "–".to_owned()
            } else {
                format!("{least:.2} – {largest:.2}")
            };
            vec![
                examination.experiment.name.to_owned(),
                finding.checks.len().to_string(),
                format!("{:.2}", used.fold(0.0, f64::max)),
                orders,
                verdict(examination.passed()).to_owned(),
            ]
        };
        let head = "case, checks, largest deviation over what is allowed, orders, ".split(", ");
        ReportTable::new("", head, self.examinations.iter().map(row))
    }
}

/// The text on a case; `figures` is the folder of its pictures as the document sees it.
fn block(examination: &Examination<Case>, figures: &str) -> String {
    let Case { name, prose, .. } = examination.experiment;
    let (title, source) = (prose.title(), prose.source());
    let verdict = verdict(examination.passed());
    let mut text =
        format!("**{title}** – {source}. `peristalsis validate --only {name}`: {verdict}.\n");
    if let Some(failure) = &examination.failure {
        text.push_str(&format!("\nIt could not be examined: {failure}.\n"));
    }
    text + &markdown::finding(&examination.finding, figures)
}

/// The text of a document with places for findings.
fn document(path: &Path) -> Result<String> {
    fs::read_to_string(path).map_err(|source| ReproduceError::Read {
        path: path.to_owned(),
        source,
    })
}

#[derive(Serialize)]
struct Document<'a> {
    format: u32,
    extent: &'static str,
    passed: bool,
    cases: Vec<CaseDocument<'a>>,
}

#[derive(Serialize)]
struct CaseDocument<'a> {
    name: &'a str,
    title: &'a str,
    source: &'a str,
    passed: bool,
    failure: Option<&'a str>,
    paragraphs: &'a [String],
    checks: &'a [Check],
    convergences: &'a [Convergence],
    figures: Vec<&'a str>,
}

impl<'a> CaseDocument<'a> {
    fn of(examination: &'a Examination<Case>) -> Self {
        let finding = &examination.finding;
        Self {
            name: examination.experiment.name,
            title: examination.experiment.prose.title(),
            source: examination.experiment.prose.source(),
            passed: examination.passed(),
            failure: examination.failure.as_deref(),
            paragraphs: &finding.paragraphs,
            checks: &finding.checks,
            convergences: &finding.convergences,
            figures: finding.figures.iter().map(|figure| &*figure.name).collect(),
        }
    }
}
