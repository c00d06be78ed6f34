//! `peristalsis view`

use std::path::Path;
use std::process::ExitCode;

use peristalsis_configuration::{PRESETS, preset};
use peristalsis_engine::Instructions;
use peristalsis_run::{Run, RunFolder};
use peristalsis_viewer::{Options, Viewer};

use crate::arguments::{ConfigurationArguments, ViewArguments};
use crate::commands::{print, say};
use crate::failure::Failure;
use crate::sources;
use crate::stop::Stop;

/// Serves the viewer until a signal.
pub(crate) fn view(arguments: &ViewArguments) -> Result<ExitCode, Failure> {
    let stop = Stop::watch()?;
    let (mut run, options) = open(arguments)?;
    run.compute_with(Instructions::widest(), usize::from(arguments.threads))?;
    let viewer = Viewer::open(run, options)?;
    print(&format!("{}\n", viewer.address()))?;
    say("open this address in a browser; Ctrl-C ends");
    stop.keep_results();
    viewer.serve(|| stop.requested().is_some())?;
    Ok(ExitCode::SUCCESS)
}

/// The run to show, with what is known of it.
fn open(arguments: &ViewArguments) -> Result<(Run, Options), Failure> {
    let options = |title: String, record| Options {
        port: arguments.port,
        title,
        saves: arguments.saves.clone(),
        record,
    };
    if arguments.source.is_dir() {
        let (folder, run) = RunFolder::open(&arguments.source)?;
        let title = name(folder.path());
        if arguments.from_state {
            return Ok((run, options(title, Vec::new())));
        }
        let record = run.recorder().samples().to_vec();
        let again = Run::new(run.configuration().clone())?;
        return Ok((again, options(title, record)));
    }
    let named = arguments.source.to_str().filter(|it| preset(it).is_some());
    if named.is_none() && !arguments.source.exists() {
        let names: Vec<&str> = PRESETS.iter().map(|preset| preset.name).collect();
        return Err(Failure::Usage {
            message: format!(
                "{} is no folder, no file and no preset",
                arguments.source.display()
            ),
            help: Some(format!("presets: {}", names.join(", "))),
        });
    }
    let configuration = ConfigurationArguments {
        file: named.is_none().then(|| arguments.source.clone()),
        preset: named.map(str::to_owned),
        overrides: arguments.overrides.clone(),
    };
    let title = sources::name(&configuration);
    let run = Run::new(sources::configuration(&configuration)?)
        .map_err(|error| sources::locate(error, &configuration))?;
    Ok((run, options(title, Vec::new())))
}

/// What a folder is called.
fn name(folder: &Path) -> String {
    let known = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    let name = known
        .file_name()
        .map(|it| it.to_string_lossy().into_owned());
    name.unwrap_or_else(|| "run".to_owned())
}
