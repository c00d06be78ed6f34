//! `peristalsis study run`

use std::process::ExitCode;

use peristalsis_study::{Effort, Ending, Specification, Store, work_on};

use super::progress::Display;
use super::status::{in_words, report};
use super::{RunArguments, usual_store};
use crate::commands::{print, print_json, say};
use crate::failure::Failure;
use crate::stop::Stop;

/// Computes the missing runs of a study.
pub(crate) fn run(arguments: &RunArguments) -> Result<ExitCode, Failure> {
    let stop = Stop::watch()?;
    let study = Specification::read(&arguments.file)?;
    let path = arguments
        .store
        .clone()
        .unwrap_or_else(|| usual_store(&study.name));
    let store = Store::create(&path, &study)?;
    let processors = std::thread::available_parallelism().map_or(1, |number| number.get());
    let effort = Effort {
        workers: arguments.workers.map_or(processors, usize::from),
        checkpoint_interval: arguments.checkpoint_every,
        limit: arguments.limit,
    };
    stop.keep_results();
    let mut display = Display::new(arguments.quiet, effort.workers);
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
    if arguments.json {
        print_json(&report(&store, &survey))?;
    } else {
        print(&in_words(&store, &survey))?;
    }
    let tell = |text: String| {
        if !arguments.quiet {
            say(&text);
        }
    };
    let again = || {
        format!(
            "go on with: peristalsis study run {} --store {}",
            arguments.file.display(),
            path.display()
        )
    };
    match ending {
        Ending::Complete => {
            let failed = survey.counts().get("failed").copied().unwrap_or(0);
            if failed > 0 {
                tell(format!(
                    "{failed} runs failed; see: peristalsis study why {} RUN",
                    path.display()
                ));
                return Ok(ExitCode::FAILURE);
            }
            tell(format!(
                "all runs are done; tables: peristalsis study export {}",
                path.display()
            ));
            Ok(ExitCode::SUCCESS)
        }
        Ending::TimeUp => {
            tell(format!("time is up, every run is saved; {}", again()));
            Ok(ExitCode::SUCCESS)
        }
        Ending::Stopped => {
            tell(format!("stopped, every run is saved; {}", again()));
            Ok(stop.requested().map_or(ExitCode::SUCCESS, ExitCode::from))
        }
    }
}
