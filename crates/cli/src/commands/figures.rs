//! `peristalsis figures`

use std::process::ExitCode;

use peristalsis_run::{RunError, RunFolder, Status, Summary};

use crate::arguments::FiguresArguments;
use crate::commands::print;
use crate::failure::Failure;

pub(crate) fn figures(arguments: &FiguresArguments) -> Result<ExitCode, Failure> {
    for path in &arguments.folders {
        let (folder, run) = RunFolder::open(path).map_err(|error| match error {
            RunError::NothingToResume { folder, reason } => Failure::usage(
                format!("{} holds no run to draw: {reason}", folder.display()),
                "name the folder of a run; `peristalsis runs DIR` lists those below a folder",
            ),
            error => error.into(),
        })?;
        let status = match run.is_complete() {
            true => Status::Complete,
            false => Status::Interrupted,
        };
        for file in folder.draw(&run, &Summary::of(&run, status, None))? {
            print(&format!("{}\n", file.display()))?;
        }
    }
    Ok(ExitCode::SUCCESS)
}
