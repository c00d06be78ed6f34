//! `peristalsis study run`

use std::process::ExitCode;

use peristalsis_formats::shell_word;
use peristalsis_study::{Ending, State, Store, work_on};

use super::progress::StudyDisplay;
use super::status::print_status;
use super::{RunArguments, store_path};
use crate::commands::{counted, say, tell};
use crate::failure::Failure;
use crate::sources;
use crate::stop::Stop;

pub(crate) fn run(arguments: &RunArguments) -> Result<ExitCode, Failure> {
    let stop = Stop::watch()?;
    let study = sources::study(&arguments.file)?;
    let path = store_path(&arguments.store, &study);
    let store = Store::create(&path, &study)?;
    let effort = arguments.work.effort(arguments.checkpoint_every);
    stop.keep_results();
    let mut display = StudyDisplay::new(arguments.quiet);
    let ending = work_on(
        &store,
        &study,
        effort,
        &|| stop.requested().is_some(),
        &mut |board| display.update(board),
    );
    display.finish();
    let ending = ending?;
    let survey = store.survey()?;
    print_status(arguments.json, &store, &survey)?;
    let tell = |text: String| tell(arguments.quiet, &text);
    let (file, place) = (shell_word(&arguments.file), shell_word(&path));
    let again = format!("go on with: peristalsis study run {file} --store {place}");
    match ending {
        Ending::Complete => {
            let failed = survey.counts().get(&State::Failed).copied().unwrap_or(0);
            if failed > 0 {
                tell(format!(
                    "{} failed; see: peristalsis study why {place} RUN",
                    counted(failed, "run")
                ));
                return Ok(ExitCode::FAILURE);
            }
            tell(format!(
                "all runs are done; tables: peristalsis study export {place}"
            ));
            Ok(ExitCode::SUCCESS)
        }
        Ending::TimeUp => {
            say(&format!("time is up, every run is saved; {again}"));
            Ok(ExitCode::SUCCESS)
        }
        Ending::Stopped => {
            say(&format!("stopped, every run is saved; {again}"));
            Ok(stop.exit_code())
        }
    }
}
