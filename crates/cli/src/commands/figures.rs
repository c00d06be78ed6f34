//! `peristalsis figures`

use std::process::ExitCode;

use peristalsis_run::{RunFolder, Status, Summary};

use crate::arguments::FiguresArguments;
use crate::commands::print;
use crate::failure::Failure;

pub(crate) fn figures(arguments: &FiguresArguments) -> Result<ExitCode, Failure> {
    for path in &arguments.folders {
        let (folder, run) = RunFolder::open(path)?;
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
