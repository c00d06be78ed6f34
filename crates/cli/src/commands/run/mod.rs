//! `peristalsis run`

mod replicates;
mod words;
mod work;

use std::path::Path;
use std::process::ExitCode;
use std::sync::Once;

use peristalsis_configuration::{Configuration, InitialState, SourceFile, Sources};
use peristalsis_engine::{Instructions, processors};
use peristalsis_formats::shell_word;
use peristalsis_run::{
    Run, RunError, RunFolder, Trajectory, TrajectoryPlan, files, read_state, scheduled_wavelengths,
    warnings,
};

use crate::arguments::{RunArguments, Threads};
use crate::commands::trajectory::{in_words as in_one_line, request};
use crate::commands::{counted, packing, print, rounded, say, tell, warn_besides};
use crate::failure::Failure;
use crate::progress::Display;
use crate::sources::{configuration, locate, name};
use crate::stop::Stop;

pub(crate) use self::words::{DISCHARGE, MASS_FLOW, measured};
use self::words::{how_far, in_words};
use self::work::{Ending, Work, goes_on_as_begun};

/// Where runs go that are given no folder.
pub(crate) const RUNS: &str = "runs";

pub(crate) fn run(arguments: &RunArguments) -> Result<ExitCode, Failure> {
    check_instructions(arguments)?;
    check_frames(arguments)?;
    check_resume(arguments)?;
    if let Some(replicates) = replicates::replicates(arguments)? {
        return replicates::run(arguments, replicates);
    }
    let stop = Stop::watch()?;
    let (folder, mut run) = match &arguments.resume {
        Some(source) => go_on(arguments, source, &stop)?,
        None => begin(arguments, &stop)?,
    };
    let said = match &arguments.resume {
        Some(_) => Vec::new(),
        None => run.warnings(),
    };
    compute_with(arguments, &mut run, processors())?;
    let work = Work::begin(arguments, folder, run)?;
    let mut display = Display::new(arguments.quiet, work.run.configuration().run.samples);
    let (work, outcome) = work.finish(&stop, &mut |progress| display.update(progress));
    display.finish();
    let (run, summary) = (&work.run, &outcome.summary);
    print(&match arguments.json {
        true => summary.to_json(),
        false => in_words(run, summary),
    })?;
    warn_besides(&said, &summary.warnings);
    let tell = |text: String| tell(arguments.quiet, &text);
    if let Some(report) = &summary.trajectory {
        tell(format!("trajectory: {}", in_one_line(report)));
    }
    let finished = outcome.finished.map_err(|source| Failure::Results {
        folder: work.folder.clone(),
        source,
    });
    let is_saved = finished.is_ok();
    match finished {
        Ok(figures) if figures.is_empty() => {
            tell("there are no grains to draw: the run has no figures".to_owned());
        }
        Ok(_) => {}
        Err(error) => match outcome.ending {
            // Where the disk is full, what could not be written first is what to speak of.
            Ending::Unwritten(_) => {}
            // What has diverged may have no place in a figure.
            Ending::Failed(_) => say(&format!("not all is in the folder: {error}")),
            _ => return Err(error),
        },
    }
    let place = shell_word(work.folder.path());
    match outcome.ending {
        Ending::Unwritten(source) => Err(Failure::Trajectory {
            folder: work.folder.path().to_owned(),
            source,
            is_saved,
        }),
        Ending::Complete => {
            tell(format!("written to {place}"));
            Ok(ExitCode::SUCCESS)
        }
        Ending::Stopped(code) => {
            say(&format!(
                "stopped {}; the results so far are in {place}\ngo on with: peristalsis run --resume {place}",
                how_far(run, summary)
            ));
            Ok(ExitCode::from(code))
        }
        Ending::Failed(error) => {
            tell(format!("what was measured, and the state, are in {place}"));
            Err(error.into())
        }
    }
}

/// Refuses instructions that this machine lacks, before anything is made.
fn check_instructions(arguments: &RunArguments) -> Result<(), Failure> {
    if arguments.instructions.is_none_or(Instructions::available) {
        return Ok(());
    }
    Err(Failure::usage(
        "this machine does not have the instructions that --instructions asks for",
        "leave it out: the widest that there are is the default",
    ))
}

/// Refuses frames that no trajectory can have: those of one that goes on stay as they were.
fn check_frames(arguments: &RunArguments) -> Result<(), Failure> {
    match &arguments.resume {
        Some(folder)
            if arguments.out.is_none() && arguments.frames.asks() && Trajectory::is_in(folder) =>
        {
            Err(goes_on_as_begun(folder))
        }
        _ => request(&arguments.frames).map(drop),
    }
}

/// A run goes on with the physics that it began with.
fn check_resume(arguments: &RunArguments) -> Result<(), Failure> {
    let asked = &arguments.configuration;
    let Some(folder) = &arguments.resume else {
        return Ok(());
    };
    if asked.file.is_none() && asked.preset.is_none() && asked.overrides.is_empty() {
        return Ok(());
    }
    let configuration = folder.join(files::CONFIGURATION);
    let help = "to another length: --periods N or --duration T";
    let help = match configuration.is_file() {
        true => format!(
            "{help}; to begin another run: peristalsis run {} --set KEY=VALUE",
            shell_word(&configuration)
        ),
        false => help.to_owned(),
    };
    let message = "a run goes on with the physics that it began with: --resume takes no FILE, --preset or --set";
    Err(Failure::usage(message, help))
}

/// Takes the instructions and threads asked for, where so many processors are free.
fn compute_with(arguments: &RunArguments, run: &mut Run, processors: usize) -> Result<(), Failure> {
    let instructions = arguments.instructions.unwrap_or_default();
    let threads = threads_of(arguments.threads, run, processors);
    Ok(run.compute_with(instructions, threads)?)
}

/// Threads that compute a run where so many processors are free; says which of them are in vain.
pub(super) fn threads_of(asked: Threads, run: &Run, processors: usize) -> usize {
    let threads = asked.of(run, processors);
    if threads > 1 && !run.simulation().takes_threads() {
        // Once, however many replicates there are.
        static SAID: Once = Once::new();
        SAID.call_once(|| {
            say(
                "--threads changes nothing here: the reference kernel computes with one (check says why it is needed)",
            );
        });
    } else if threads > processors {
        static SAID: Once = Once::new();
        SAID.call_once(|| {
            say(&format!(
                "{threads} threads wait for each other on {}: fewer are faster",
                counted(processors, "processor")
            ));
        });
    }
    threads
}

/// Reads the configuration, packs the grains, makes the folder.
fn begin(arguments: &RunArguments, stop: &Stop) -> Result<(RunFolder, Run), Failure> {
    let configuration = checked(arguments, configuration(&arguments.configuration)?)?;
    warn_besides(&[], &warnings(&configuration));
    if let Some(path) = &arguments.out {
        // Before the work of packing, and again when the folder is made.
        RunFolder::check(path)?;
    }
    let run = packed(arguments, configuration, stop)?;
    warn_besides(&warnings(run.configuration()), &run.warnings());
    stop.keep_results();
    let folder = new_folder(arguments, &name(&arguments.configuration), &run)?;
    Ok((folder, run))
}

/// A configuration that can run as asked for. Every refusal comes before a folder is made.
fn checked(
    arguments: &RunArguments,
    configuration: Configuration,
) -> Result<Configuration, Failure> {
    if configuration.initial.state == InitialState::Placed {
        return Err(locate(RunError::NotPlaced, &arguments.configuration));
    }
    if let Some(request) = request(&arguments.frames)? {
        TrajectoryPlan::new(&request, &configuration, 0, configuration.run.steps())?;
    }
    say_which_periods(arguments, &configuration);
    Ok(configuration)
}

/// Says of a wave whose rate changes which periods its run counts.
fn say_which_periods(arguments: &RunArguments, configuration: &Configuration) {
    if let (Some(wavelengths), Some(periods), Some(period)) = (
        scheduled_wavelengths(configuration),
        configuration.run.periods,
        configuration.drive.period(),
    ) {
        let [wavelengths, period] = [wavelengths, period].map(rounded);
        let periods = counted(rounded(periods), "period");
        tell(
            arguments.quiet,
            &format!(
                "run.periods counts periods of drive.strain_rate: {periods} of {period} t, in which drive.schedule lets the \
                 wave run {wavelengths} wavelengths"
            ),
        );
    }
}

/// A new run with its grains packed, unless it is asked to stop.
fn packed(
    arguments: &RunArguments,
    configuration: Configuration,
    stop: &Stop,
) -> Result<Run, Failure> {
    let described = configuration.clone();
    let pack = || Run::new_unless(configuration, &|| stop.is_asked_for());
    let run = match arguments.quiet {
        true => pack(),
        false => packing(&described, &[], pack),
    };
    run.map_err(|error| locate(error, &arguments.configuration))
}

/// The folder asked for, or else the first free one runs/NAME-K.
fn new_folder(arguments: &RunArguments, name: &str, run: &Run) -> Result<RunFolder, Failure> {
    Ok(match &arguments.out {
        Some(path) => RunFolder::create(path, run.configuration())?,
        None => RunFolder::create_next(Path::new(RUNS), name, run.configuration())?,
    })
}

/// Goes on with the run of a folder in it, or with the state in a file in a new folder.
fn go_on(
    arguments: &RunArguments,
    source: &Path,
    stop: &Stop,
) -> Result<(RunFolder, Run), Failure> {
    if !source.is_file() && arguments.out.is_none() {
        return go_on_in(arguments, source, stop);
    }
    let run = match source.is_file() {
        true => read_state(source)?,
        false => not_diverged(&RunFolder::named(source))?,
    };
    if Trajectory::is_in(source) && arguments.frames.trajectory.is_empty() {
        tell(
            arguments.quiet,
            "the trajectory ends here: in the new folder --trajectory begins another",
        );
    }
    let run = lasting(arguments, run, source, stop)?;
    stop.keep_results();
    let name = source.file_stem().unwrap_or_default().to_string_lossy();
    let folder = new_folder(arguments, &name, &run)?;
    Ok((folder, run))
}

/// The run of a folder, unless it diverged: it would do so again, and its state be lost.
fn not_diverged(folder: &RunFolder) -> Result<Run, RunError> {
    match folder.divergence() {
        Some(reason) => Err(RunError::NothingToResume {
            folder: folder.path().to_owned(),
            reason,
        }),
        None => folder.run(),
    }
}

/// Goes on with the run of a folder, in it.
fn go_on_in(
    arguments: &RunArguments,
    path: &Path,
    stop: &Stop,
) -> Result<(RunFolder, Run), Failure> {
    let folder = RunFolder::named(path).claim()?;
    let run = not_diverged(&folder)?;
    let run = lasting(arguments, run, path, stop)?;
    stop.keep_results();
    Ok((folder, run))
}

/// The run with the length asked for, if one is, and with something left to do.
fn lasting(arguments: &RunArguments, run: Run, source: &Path, stop: &Stop) -> Result<Run, Failure> {
    let length = match arguments.configuration.length() {
        Some(length) => length,
        // A full disk or a kill may have taken what comes after the state.
        None if run.is_complete()
            && !arguments.csv
            && (source.is_file() || RunFolder::named(source).has_final_results_of(&run)) =>
        {
            let folder = source.to_owned();
            return Err(RunError::Complete { folder }.into());
        }
        None => return Ok(run),
    };
    let text = run.configuration().to_toml();
    let name = source.display().to_string();
    let configuration = Configuration::from_sources(&Sources {
        file: Some(SourceFile {
            name: &name,
            text: &text,
        }),
        preset: None,
        overrides: &[length],
    })?;
    if run.configuration().drive.period().is_some() {
        say_which_periods(arguments, &configuration);
        return Ok(run.under(configuration)?);
    }
    let (done, asked) = (run.simulation().time(), configuration.run.duration);
    if asked < done {
        let unit = "t";
        return Err(RunError::TooShort { done, asked, unit }.into());
    }
    if Trajectory::is_in(source) {
        return Err(Failure::usage(
            "a run of a wave that stands still is sampled at other times when it is longer, and its trajectory would not fit",
            format!(
                "begin it anew: peristalsis run {name}/config.toml --set run.duration={asked} --out DIR"
            ),
        ));
    }
    tell(
        arguments.quiet,
        "the wave stands still: a longer run is sampled at other times, and is computed from its start",
    );
    packed(arguments, configuration, stop)
}
