//! Findings as one page, one JSON file, figures and tables.
//!
//! [`Report`] holds the claims with their findings and the studies behind them; [`Report::html`] is a page that needs
//! no other file, [`Report::json`] the same for programs, and [`Report::write`] puts both into a folder with every figure as
//! SVG and PNG and every table as CSV. Nothing in them depends on when or how the runs were computed: the same runs give the
//! same bytes. Nothing here prints or exits.

mod document;
mod files;
mod json;
pub(crate) mod markdown;
mod markup;
mod page;
mod picture;

pub use markup::plain_text;

use std::path::{Path, PathBuf};

use peristalsis_figures::Drawing;
use peristalsis_formats::{atomic, csv};

use self::files::{figure_files, table_files};
use crate::error::{ReproduceError, make_folder};
use crate::{Drawn, Examination, Outcome, PublishedRows, Size, StudyOutcome, Verdict};

pub(crate) use json::json_text;
pub(crate) use page::STYLE;

/// The page.
const PAGE: &str = "report.html";
/// The same for programs.
const JSON: &str = "claims.json";
/// The same to read where no browser is.
const DOCUMENT: &str = "report.md";

/// The program that made a report.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Program {
    /// Its version.
    pub version: String,
    /// Revision of its source.
    pub revision: String,
    /// Version of the physics: runs of different ones are different.
    pub physics_version: u32,
}

impl Program {
    /// The program that this is part of.
    pub fn this() -> Self {
        Self {
            version: peristalsis_run::VERSION.to_owned(),
            revision: peristalsis_run::REVISION.to_owned(),
            physics_version: peristalsis_study::PHYSICS_VERSION,
        }
    }
}

/// The claims with their findings, and the studies behind them.
#[derive(Clone, Debug)]
pub struct Report {
    /// Size of the designs.
    pub size: Size,
    /// The program that made it.
    pub program: Program,
    /// The claims in their order.
    pub examinations: Vec<Examination>,
    /// The studies behind them.
    pub studies: Vec<StudyOutcome>,
    /// What has become of the published rows, of each study that has any.
    pub published: Vec<PublishedRows>,
    /// The sample of them that was drawn, if one was.
    pub drawn: Option<Drawn>,
}

/// How many claims a wall meets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
pub(crate) struct WallTally<'a> {
    /// Name of the wall.
    pub(crate) wall: &'a str,
    /// Claims that are reproduced there.
    pub(crate) met: usize,
    /// Claims that are reproduced there or differ.
    pub(crate) judged: usize,
}

impl Report {
    /// The report of what this program found.
    pub fn of(size: Size, outcome: Outcome) -> Self {
        Self {
            size,
            program: Program::this(),
            examinations: outcome.examinations,
            studies: outcome.studies,
            published: outcome.published,
            drawn: outcome.drawn,
        }
    }

    /// A page that needs no other file, with every figure in it.
    pub fn html(&self) -> String {
        page::page(self).into_string()
    }

    /// The findings for programs, as `docs/book/src/reference/claims-json.md` describes them.
    pub fn json(&self) -> String {
        json::text(self)
    }

    /// The findings as Markdown with the first figure of each claim; `figures` is the folder of the pictures as the document sees it.
    /// `VALIDATION.md` of the repository is the document of the rows in `validation/results`.
    pub fn markdown(&self, figures: &str) -> String {
        document::text(self, figures)
    }

    /// The figures of the document, each with the name of its file.
    pub fn main_figures(&self) -> Vec<(String, &Drawing)> {
        let files = figure_files(&self.examinations);
        let mut places: Vec<usize> = files
            .places
            .iter()
            .filter_map(|of| of.first().copied())
            .collect();
        places.sort_unstable();
        places.dedup();
        places
            .into_iter()
            .map(|place| (files.files[place].0.clone(), &files.files[place].1.drawing))
            .collect()
    }

    /// Writes `report.html`, `report.md`, `claims.json`, `figures/NAME.svg` and `.png`, and `tables/NAME.csv` into a folder, each file
    /// whole or not at all; answers the path of the page.
    ///
    /// # Errors
    /// Errors of making folders and writing files, and of drawing pictures.
    pub fn write(&self, folder: &Path) -> Result<PathBuf, ReproduceError> {
        let (figures, tables) = (figure_files(&self.examinations), table_files(self)?);
        make_folder(folder)?;
        for name in ["figures", "tables"] {
            make_folder(&folder.join(name))?;
        }
        for (name, figure) in &figures.files {
            write_drawing(&folder.join("figures"), name, &figure.drawing)?;
        }
        for (name, table) in &tables {
            csv::write(&folder.join("tables").join(name), table)?;
        }
        atomic::write(&folder.join(JSON), self.json().as_bytes())?;
        atomic::write(&folder.join(DOCUMENT), self.markdown("figures").as_bytes())?;
        // Last, so that the page never speaks of files that are not there.
        let page = folder.join(PAGE);
        atomic::write(&page, self.html().as_bytes())?;
        Ok(page)
    }

    /// Every wall that a claim was asked of, with the number of claims that it meets and of those that could be judged there.
    pub(crate) fn walls(&self) -> Vec<WallTally<'_>> {
        let mut tallies: Vec<WallTally<'_>> = Vec::new();
        let verdicts = self.examinations.iter().flat_map(|one| &one.finding.walls);
        for on_wall in verdicts {
            let place = tallies.iter().position(|tally| tally.wall == on_wall.wall);
            let place = place.unwrap_or_else(|| {
                let wall = on_wall.wall.as_str();
                tallies.push(WallTally {
                    wall,
                    met: 0,
                    judged: 0,
                });
                tallies.len() - 1
            });
            tallies[place].met += usize::from(on_wall.verdict == Verdict::Reproduced);
            tallies[place].judged += usize::from(on_wall.verdict != Verdict::Open);
        }
        tallies
    }

    /// The study of this name.
    pub(crate) fn study(&self, name: &str) -> Option<&StudyOutcome> {
        self.studies.iter().find(|study| study.file.name == name)
    }
}

/// Writes a figure as `NAME.svg` and `NAME.png` into a folder.
pub(crate) fn write_drawing(
    folder: &Path,
    name: &str,
    drawing: &Drawing,
) -> Result<(), ReproduceError> {
    let path = folder.join(name);
    atomic::write(&path.with_extension("svg"), drawing.svg().as_bytes())?;
    atomic::write(&path.with_extension("png"), &drawing.png()?)?;
    Ok(())
}
