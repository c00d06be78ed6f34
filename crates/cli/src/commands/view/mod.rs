//! `peristalsis view`

mod studies;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use peristalsis_configuration::{Configuration, preset};
use peristalsis_engine::{Instructions, processors};
use peristalsis_run::files::CONFIGURATION;
use peristalsis_run::{Run, RunFolder, TrajectoryFormat};
use peristalsis_viewer::{Options, Recording, Viewer};

use crate::arguments::{ConfigurationArguments, ViewArguments};
use crate::commands::run::threads_of;
use crate::commands::{counted, packing, print, say};
use crate::failure::Failure;
use crate::sources::{self, known_presets};
use crate::stop::Stop;
use studies::Studies;

pub(crate) fn view(arguments: &ViewArguments) -> Result<ExitCode, Failure> {
    let stop = Stop::watch()?;
    let viewer = match (studies(arguments)?, trajectory(arguments)?) {
        (Some(found), _) => {
            let saves = arguments.saves.clone();
            Viewer::exhibit(found.studies, found.figures, saves, arguments.port)?
        }
        (None, Some(path)) => play(&path, arguments.port)?,
        (None, None) => {
            // A signal is how it ends, also while it packs.
            stop.keep_results();
            let (mut run, options) = match open(arguments, &stop) {
                Err(_) if stop.is_asked_for() => return Ok(ExitCode::SUCCESS),
                outcome => outcome?,
            };
            let threads = threads_of(arguments.threads, &run, processors());
            run.compute_with(Instructions::widest(), threads)?;
            Viewer::open(run, options)?
        }
    };
    print(&format!("{}\n", viewer.address()))?;
    say("open this address in a browser; Ctrl-C ends");
    stop.keep_results();
    viewer.serve(|| stop.requested().is_some());
    Ok(ExitCode::SUCCESS)
}

/// The studies that are to be shown.
fn studies(arguments: &ViewArguments) -> Result<Option<Studies>, Failure> {
    let found = Studies::at(&arguments.source)?;
    let asks = arguments.live || arguments.from_state || !arguments.overrides.is_empty();
    if found.is_some() && asks {
        return Err(Failure::usage(
            format!("{} is a study", arguments.source.display()),
            "--set, --live and --from-state are for a run; a study's runs are opened in the page",
        ));
    }
    Ok(found)
}

/// The trajectory that is to be played: the source itself or, unless the run is to be computed, the one in its folder.
fn trajectory(arguments: &ViewArguments) -> Result<Option<PathBuf>, Failure> {
    let source = &arguments.source;
    let is_file = source.extension().is_some_and(|ending| ending == "gsd");
    let computed = arguments.live || arguments.from_state;
    if (is_file || source.is_dir()) && !arguments.overrides.is_empty() {
        return Err(Failure::usage(
            format!("{} is a run that --set cannot change", source.display()),
            format!("view the {CONFIGURATION} of the run with --set"),
        ));
    }
    if is_file && computed {
        return Err(Failure::usage(
            "a trajectory is played, not computed",
            "name the folder of its run",
        ));
    }
    let in_folder = source.join(TrajectoryFormat::Gsd.file_name());
    Ok(match is_file {
        true => Some(source.clone()),
        false => (!computed && in_folder.is_file()).then_some(in_folder),
    })
}

/// A viewer that plays a trajectory. Its run is in its own folder or, as after `peristalsis trajectory`, in the one above.
fn play(path: &Path, port: u16) -> Result<Viewer, Failure> {
    let place = path.canonicalize().map_err(Failure::read(path))?;
    let above = place.ancestors().skip(1).take(2);
    let Some(folder) = above.clone().find(|it| it.join(CONFIGURATION).is_file()) else {
        let path = path.display();
        return Err(Failure::usage(
            format!("beside {path} there is no {CONFIGURATION}, which says what tube it is of"),
            "leave trajectories in the folders of their runs",
        ));
    };
    // What a kill left has no state, and a trajectory tells J/Jmax itself.
    let (configuration, known) = match RunFolder::open(folder) {
        Ok((_, run)) => {
            let samples = run.recorder().samples().to_vec();
            (run.configuration().clone(), Some((samples, run.warnings())))
        }
        Err(_) => {
            let path = folder.join(CONFIGURATION);
            let text = std::fs::read_to_string(&path).map_err(Failure::read(&path))?;
            let name = path.display().to_string();
            (Configuration::from_toml(&name, &text)?, None)
        }
    };
    let recording = match known {
        Some((samples, warnings)) => {
            Recording::open(&place, configuration, samples)?.with_warnings(warnings)
        }
        None => Recording::open(&place, configuration, Vec::new())?,
    };
    let lost = recording.lost_frames();
    if lost > 0 {
        let whole = recording.frames();
        say(&format!(
            "the trajectory was cut short: {} left, {lost} lost",
            counted(whole, "whole frame")
        ));
    }
    Ok(Viewer::play(recording, name(folder), port)?)
}

/// Refuses what is for the folder of a run alone.
fn check(arguments: &ViewArguments) -> Result<(), Failure> {
    match arguments.live || arguments.from_state {
        true => Err(Failure::usage(
            format!(
                "--live and --from-state are for the folder of a run, and {} is none",
                arguments.source.display()
            ),
            "leave them out, or name such a folder",
        )),
        false => Ok(()),
    }
}

/// The run to show, and how to serve it.
fn open(arguments: &ViewArguments, stop: &Stop) -> Result<(Run, Options), Failure> {
    let packed = |configuration: Configuration| {
        let described = configuration.clone();
        packing(&described, &[], || {
            Run::new_unless(configuration, &|| stop.is_asked_for())
        })
    };
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
        let again = packed(run.configuration().clone())?;
        return Ok((again, options(title, record)));
    }
    let named = arguments.source.to_str().filter(|it| preset(it).is_some());
    if named.is_none() && !arguments.source.exists() {
        let source = arguments.source.display();
        let unknown = format!("{source} is no folder, no file and no preset");
        return Err(Failure::usage(unknown, known_presets()));
    }
    check(arguments)?;
    let configuration = ConfigurationArguments {
        file: named.is_none().then(|| arguments.source.clone()),
        preset: named.map(str::to_owned),
        overrides: arguments.overrides.clone(),
        ..ConfigurationArguments::default()
    };
    let title = sources::name(&configuration);
    let run = packed(sources::configuration(&configuration)?)
        .map_err(|error| sources::locate(error, &configuration))?;
    Ok((run, options(title, Vec::new())))
}

/// What a folder is called.
fn name(folder: &Path) -> String {
    let known = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    let name = known.file_name().unwrap_or("run".as_ref());
    name.to_string_lossy().into_owned()
}
