//! The figures of a reproduction, with their captions in its report.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::error::ViewerError;

/// The findings beside the report of `peristalsis reproduce`.
const CLAIMS: &str = "claims.json";
/// Folder of the figures.
const FIGURES: &str = "figures";

/// A figure with its caption, and the names of the studies behind it.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(ts_rs::TS))]
pub struct Figure {
    /// Short name of the claim.
    claim: String,
    /// Title of the claim, in markup.
    title: String,
    verdict: String,
    /// Caption, in markup.
    caption: String,
    studies: Vec<String>,
    #[serde(skip)]
    path: PathBuf,
}

#[derive(Deserialize)]
struct Claims {
    claims: Vec<Claim>,
}

#[derive(Deserialize)]
struct Claim {
    id: String,
    title: String,
    verdict: String,
    #[serde(default)]
    figures: Vec<ClaimFigure>,
    #[serde(default)]
    studies: Vec<ClaimStudy>,
}

#[derive(Deserialize)]
struct ClaimFigure {
    file: PathBuf,
    caption: String,
}

#[derive(Deserialize)]
struct ClaimStudy {
    name: String,
}

impl Figure {
    /// The figures of the report in this folder, in its order; none without a report.
    ///
    /// # Errors
    /// [`ViewerError::Claims`] if `claims.json` cannot be read.
    pub fn of_report(folder: &Path) -> Result<Vec<Self>, ViewerError> {
        let path = folder.join(CLAIMS);
        let wrong = |reason: String| ViewerError::Claims {
            path: path.clone(),
            reason,
        };
        let text = match std::fs::read(&path) {
            Ok(text) => text,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(Vec::new()),
            Err(error) => return Err(wrong(error.to_string())),
        };
        let claims: Claims = serde_json::from_slice(&text).map_err(|it| wrong(it.to_string()))?;
        let mut figures = Vec::new();
        for claim in claims.claims {
            for figure in claim.figures {
                // Of the file's name only what follows the folder counts, wherever the report says that it lies.
                let Some(name) = figure.file.file_name() else {
                    continue;
                };
                figures.push(Self {
                    claim: claim.id.clone(),
                    title: claim.title.clone(),
                    verdict: claim.verdict.clone(),
                    caption: figure.caption,
                    studies: claim.studies.iter().map(|it| it.name.clone()).collect(),
                    path: folder.join(FIGURES).join(name),
                });
            }
        }
        Ok(figures)
    }

    /// The picture, SVG.
    pub(crate) fn picture(&self) -> std::io::Result<Vec<u8>> {
        std::fs::read(&self.path)
    }
}
