//! `peristalsis render`

use std::process::ExitCode;

use peristalsis_formats::atomic;
use peristalsis_run::{Aspect, RunError, RunFolder, picture};

use crate::arguments::{AspectName, RenderArguments};
use crate::commands::print;
use crate::failure::Failure;

/// Draws the tube of a run.
pub(crate) fn render(arguments: &RenderArguments) -> Result<ExitCode, Failure> {
    let (folder, run) = RunFolder::open(&arguments.folder)?;
    let (aspect, name) = match arguments.view {
        AspectName::Side => (Aspect::Side, "tube-side.png"),
        AspectName::Section => (Aspect::Section, "tube-section.png"),
    };
    let picture = picture(&run, aspect, arguments.width).map_err(RunError::from)?;
    let out = arguments
        .out
        .clone()
        .unwrap_or_else(|| folder.path().join(name));
    let png = picture.png().map_err(RunError::from)?;
    atomic::write(&out, &png).map_err(RunError::from)?;
    print(&format!(
        "{} x {} pixels: {}\n",
        picture.width(),
        picture.height(),
        out.display()
    ))?;
    Ok(ExitCode::SUCCESS)
}
