//! The cases in turn, and how what they found is written.

use std::fs;
use std::panic::{self, AssertUnwindSafe};
use std::path::{Path, PathBuf};

use peristalsis_formats::{atomic, csv};
use serde::Serialize;

use crate::textbook::case::{Case, Circumstances, Extent};
use crate::textbook::document;
use crate::textbook::error::ValidateError;
use crate::textbook::finding::{Check, Convergence, Finding};

/// Version of the layout of `validation.json`.
const FORMAT: u32 = 1;

/// A case with what was found of it.
#[derive(Clone)]
pub struct Examination {
    /// The case.
    pub case: Case,
    /// What it found; empty where it failed.
    pub finding: Finding,
    /// Why it could not be examined, if so.
    pub failure: Option<String>,
}

impl Examination {
    /// Whether it was examined and everything passed.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.failure.is_none() && self.finding.passed()
    }
}

/// What was found of several cases.
#[derive(Clone)]
pub struct Validation {
    /// How much was computed.
    pub extent: Extent,
    /// The cases in their order.
    pub examinations: Vec<Examination>,
}

impl Validation {
    /// Examines cases in turn, telling of each as it ends. A case that fails, even by a panic, costs no other.
    ///
    /// # Errors
    /// [`ValidateError::Stopped`] once `stops` says so.
    pub fn run(
        extent: Extent,
        cases: &[Case],
        stops: &dyn Fn() -> bool,
        tell: &mut dyn FnMut(&Examination),
    ) -> Result<Self, ValidateError> {
        let mut examinations = Vec::with_capacity(cases.len());
        for case in cases {
            let circumstances = Circumstances { extent, stops };
            let outcome = panic::catch_unwind(AssertUnwindSafe(|| (case.examine)(circumstances)));
            let (finding, failure) = match outcome {
                Ok(Ok(finding)) => (finding, None),
                Ok(Err(ValidateError::Stopped)) => return Err(ValidateError::Stopped),
                Ok(Err(error)) => (Finding::default(), Some(error.to_string())),
                Err(_) => (
                    Finding::default(),
                    Some("an error of this program: it panicked".to_owned()),
                ),
            };
            let examination = Examination {
                case: *case,
                finding,
                failure,
            };
            tell(&examination);
            examinations.push(examination);
        }
        Ok(Self {
            extent,
            examinations,
        })
    }

    /// Whether every case passed.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.examinations.iter().all(Examination::passed)
    }

    /// Everything for programs.
    #[must_use]
    pub fn json(&self) -> String {
        let document = Document {
            format: FORMAT,
            extent: self.extent.name(),
            passed: self.passed(),
            cases: self.examinations.iter().map(CaseDocument::of).collect(),
        };
        let mut text = serde_json::to_string_pretty(&document)
            .expect("all keys are texts, and numbers that are not finite become null");
        text.push('\n');
        text
    }

    /// Writes into a folder `validation.json`, `NAME.md` and `NAME.csv` of every case, and `figures/FIGURE.svg` and `.png`,
    /// each file whole or not at all.
    ///
    /// # Errors
    /// Errors of making folders, drawing and writing.
    pub fn write(&self, folder: &Path) -> Result<(), ValidateError> {
        let figures = folder.join("figures");
        make(&figures)?;
        for examination in &self.examinations {
            let path = folder.join(examination.case.name);
            if let Some(table) = &examination.finding.table {
                csv::write(&path.with_extension("csv"), table)?;
            }
            let text = document::text_of(examination, "figures");
            atomic::write(&path.with_extension("md"), text.as_bytes())?;
            self.write_figures(examination, &figures)?;
        }
        atomic::write(&folder.join("validation.json"), self.json().as_bytes())?;
        Ok(())
    }

    fn write_figures(&self, examination: &Examination, folder: &Path) -> Result<(), ValidateError> {
        for figure in &examination.finding.figures {
            let path = folder.join(figure.name);
            atomic::write(&path.with_extension("svg"), figure.drawing.svg().as_bytes())?;
            atomic::write(&path.with_extension("png"), &figure.drawing.png()?)?;
        }
        Ok(())
    }

    /// Whether a document has a place for each of these cases.
    ///
    /// # Errors
    /// [`ValidateError::Read`] and [`ValidateError::NoPlace`].
    pub fn check_places(path: &Path, cases: &[Case]) -> Result<(), ValidateError> {
        let text = read(path)?;
        for case in cases {
            document::replaced(&text, case.name, "").map_err(no_place(path))?;
        }
        Ok(())
    }

    /// Replaces in a Markdown document what stands between `<!-- validate NAME -->` and `<!-- /validate -->` for each case,
    /// and, where all cases were examined, for `summary`; figures go to `docs/images/validation` beside the document.
    ///
    /// # Errors
    /// [`ValidateError::Read`], and [`ValidateError::NoPlace`] where a marker is missing; nothing is changed then.
    pub fn write_into(&self, path: &Path, all_cases: &[Case]) -> Result<(), ValidateError> {
        let mut text = read(path)?;
        for examination in &self.examinations {
            let block = document::text_of(examination, FIGURES);
            text =
                document::replaced(&text, examination.case.name, &block).map_err(no_place(path))?;
        }
        let is_whole = all_cases.iter().all(|case| {
            self.examinations
                .iter()
                .any(|examination| examination.case.name == case.name)
        });
        if is_whole {
            let summary = document::summary(&self.examinations);
            text = document::replaced(&text, "summary", &summary).map_err(no_place(path))?;
        }
        let figures = path.parent().unwrap_or(Path::new("")).join(FIGURES);
        make(&figures)?;
        for examination in &self.examinations {
            for figure in &examination.finding.figures {
                let file = figures.join(figure.name).with_extension("svg");
                atomic::write(&file, figure.drawing.svg().as_bytes())?;
            }
        }
        atomic::write(path, text.as_bytes())?;
        Ok(())
    }
}

/// Where the figures of a document stand, beside it.
const FIGURES: &str = "docs/images/validation";

fn read(path: &Path) -> Result<String, ValidateError> {
    fs::read_to_string(path).map_err(|source| ValidateError::Read {
        path: path.to_owned(),
        source,
    })
}

fn no_place(path: &Path) -> impl Fn((String, String)) -> ValidateError {
    |(block, line)| ValidateError::NoPlace {
        path: path.to_owned(),
        block,
        line,
    }
}

fn make(folder: &Path) -> Result<(), ValidateError> {
    fs::create_dir_all(folder).map_err(|source| ValidateError::Folder {
        path: PathBuf::from(folder),
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
    fn of(examination: &'a Examination) -> Self {
        let Examination {
            case,
            finding,
            failure,
        } = examination;
        Self {
            name: case.name,
            title: case.title,
            source: case.source,
            passed: examination.passed(),
            failure: failure.as_deref(),
            paragraphs: &finding.paragraphs,
            checks: &finding.checks,
            convergences: &finding.convergences,
            figures: finding.figures.iter().map(|figure| figure.name).collect(),
        }
    }
}
