//! Runs that differ in their seed alone, side by side: a folder each, and mean and scatter of what they came to.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Mutex;
use std::time::Instant;

use peristalsis_analysis::mean_and_error;
use peristalsis_analysis::number::known_error;
use peristalsis_engine::processors;
use peristalsis_formats::shell_word;
use peristalsis_run::{
    RunError, RunFolder, Status, Summary, Warning, files, next_folder, warnings,
};
use serde_json::{Value, json};

use super::words::{DISCHARGE, MASS_FLOW, is_too_short, mass_flow, measured};
use super::work::{Ending, Outcome, Work};
use super::{RUNS, checked, compute_with, lasting, not_diverged, packed};
use crate::arguments::{RunArguments, Seeds, Threads};
use crate::commands::{code_of, counted, print, print_json, say, significant, tell, warn_besides};
use crate::failure::Failure;
use crate::progress::Display;
use crate::sources::{configuration, name};
use crate::stop::Stop;

/// Name of the folder of a replicate, before its seed.
const STEM: &str = "seed-";

/// The folders of replicates.
pub(super) struct Replicates {
    /// Locked, so that no other program goes on with the replicates. That of each replicate is locked when its turn comes.
    folder: RunFolder,
    each: Vec<(u64, PathBuf)>,
    /// The warnings that were said already.
    said: Vec<Warning>,
}

/// A replicate that was worked on: its seed, its folder, and what it came to.
type Worked = (u64, PathBuf, Result<Outcome, Failure>);

/// The replicates that are asked for or gone on with; `None` where the call is for one run.
pub(super) fn replicates(arguments: &RunArguments) -> Result<Option<Replicates>, Failure> {
    if let Some(seeds) = &arguments.seeds {
        return begin(arguments, seeds).map(Some);
    }
    let Some(folder) = &arguments.resume else {
        return Ok(None);
    };
    if arguments.out.is_some() || folder.join(files::CONFIGURATION).exists() {
        return Ok(None);
    }
    let below = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let replicate = |path: PathBuf| {
        let seed = path
            .file_name()?
            .to_str()?
            .strip_prefix(STEM)?
            .parse()
            .ok()?;
        Some((seed, path))
    };
    let mut each: Vec<_> = below.filter_map(|entry| replicate(entry.path())).collect();
    each.sort_by_key(|(seed, _)| *seed);
    if each.is_empty() {
        return Ok(None);
    }
    let folder = RunFolder::named(folder).claim()?;
    let said = Vec::new();
    Ok(Some(Replicates { folder, each, said }))
}

/// Makes a folder for each seed; where one cannot be made, none is.
fn begin(arguments: &RunArguments, seeds: &Seeds) -> Result<Replicates, Failure> {
    let mut sources = arguments.configuration.clone();
    let is_seed = |setting: &&String| {
        setting
            .split('=')
            .next()
            .is_some_and(|key| key.trim() == "run.seed")
    };
    if let Some(setting) = sources.overrides.iter().find(is_seed) {
        return Err(Failure::usage(
            format!("--seeds and --set {setting} exclude one another"),
            "leave one of them out",
        ));
    }
    // The largest: where it can be a seed, all can.
    let largest = seeds.0.iter().max();
    let setting = largest.map(|seed| format!("run.seed={seed}"));
    sources.overrides.extend(setting);
    let configuration = checked(arguments, configuration(&sources)?)?;
    let said = warnings(&configuration);
    warn_besides(&[], &said);
    let folder = match &arguments.out {
        Some(folder) => {
            RunFolder::check(folder)?;
            folder.clone()
        }
        None => next_folder(Path::new(RUNS), &name(&arguments.configuration))?,
    };
    let mut each = Vec::new();
    for &seed in &seeds.0 {
        let mut own = configuration.clone();
        own.run.seed = seed;
        match RunFolder::create(&folder.join(format!("{STEM}{seed}")), &own) {
            Ok(made) => each.push((seed, made.path().to_owned())),
            Err(error) => return Err(none_of(&each, error)),
        }
    }
    let folder = RunFolder::named(&folder).claim();
    let folder = folder.map_err(|error| none_of(&each, error))?;
    Ok(Replicates { folder, each, said })
}

/// Takes the folders of new replicates away again, for an error.
fn none_of(each: &[(u64, PathBuf)], error: RunError) -> Failure {
    let made = each.iter().map(|(_, path)| RunFolder::named(path));
    made.for_each(RunFolder::abandon);
    error.into()
}

/// Runs as many replicates at a time as there are processors for, and says what they came to.
pub(super) fn run(arguments: &RunArguments, replicates: Replicates) -> Result<ExitCode, Failure> {
    let stop = Stop::watch()?;
    // Every replicate has its folder, and can be gone on with from the first moment.
    stop.keep_results();
    let number = replicates.each.len();
    let each = match arguments.threads {
        Threads::Auto => 1,
        Threads::Number(threads) => usize::from(threads),
    };
    let at_once = (processors() / each).clamp(1, number);
    // What the replicates leave free, the threads of each may take.
    let free = processors() / at_once;
    let begin = Instant::now();
    let display = Mutex::new((Display::new(arguments.quiet, 1000), vec![0.0; number]));
    let waiting: Mutex<VecDeque<_>> = Mutex::new(replicates.each.into_iter().enumerate().collect());
    let worked: Mutex<Vec<Worked>> = Mutex::default();
    // What has not begun when a signal comes begins when the replicates are gone on with.
    let next = || match stop.requested() {
        None => locked(&waiting).pop_front(),
        Some(_) => None,
    };
    let work = || {
        while let Some((index, (seed, path))) = next() {
            let mut show = |part: f64| {
                let (display, parts) = &mut *locked(&display);
                parts[index] = part;
                let done = 1000.0 * parts.iter().sum::<f64>() / number as f64;
                let ended = parts.iter().filter(|part| **part >= 1.0).count();
                let words = || format!("{ended} of {}", counted(number, "seed"));
                display.show([done as u64, 1000], begin.elapsed(), words);
            };
            let outcome = replicate(arguments, &path, free, &stop, &mut show);
            if matches!(&outcome, Err(Failure::Run(error)) if error.is_stop()) {
                // It has not begun.
                continue;
            }
            if let Ok(outcome) = &outcome {
                locked(&display).0.tell(&line(seed, outcome));
            }
            locked(&worked).push((seed, path, outcome));
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..at_once {
            scope.spawn(work);
        }
    });
    locked(&display).0.finish();
    let mut worked = worked.into_inner().unwrap_or_default();
    worked.sort_by_key(|(seed, ..)| *seed);
    warn_besides(&[], &seen(&worked, &replicates.said));
    conclude(arguments, replicates.folder.path(), worked, &stop)
}

/// The content of a lock; a thread that panicked ends the program anyway.
fn locked<T>(guarded: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    guarded
        .lock()
        .unwrap_or_else(std::sync::PoisonError::into_inner)
}

/// Begins or goes on with one replicate.
fn replicate(
    arguments: &RunArguments,
    path: &Path,
    free: usize,
    stop: &Stop,
    show: &mut dyn FnMut(f64),
) -> Result<Outcome, Failure> {
    let folder = RunFolder::named(path).claim()?;
    let is_begun = folder.has_state();
    let mut run = match is_begun {
        true => not_diverged(&folder)?,
        false => packed(arguments, folder.configuration()?, stop)?,
    };
    let length = run.configuration().run.samples;
    if arguments.resume.is_some() && arguments.configuration.length().is_some() {
        run = lasting(arguments, run, folder.path(), stop)?;
    }
    let is_as_asked = run.configuration().run.samples == length;
    if is_as_asked
        && run.is_complete()
        && folder.has_final_results_of(&run)
        && !asks_for_files(arguments)
    {
        // Nothing is left to do, and nothing is written again.
        let summary = Summary::of(&run, Status::Complete, None);
        return Ok(Outcome {
            ending: Ending::Complete,
            summary,
            finished: Ok(Vec::new()),
        });
    }
    compute_with(arguments, &mut run, free)?;
    let work = Work::begin(arguments, folder, run)?;
    let total = work.run.configuration().run.samples as f64;
    let (_, outcome) = work.finish(stop, &mut |progress| show(progress.samples as f64 / total));
    Ok(outcome)
}

/// Whether files are asked for besides those that every run leaves.
fn asks_for_files(arguments: &RunArguments) -> bool {
    arguments.csv || !arguments.frames.trajectory.is_empty()
}

/// What [`mass_flow`] is.
fn name_of_flow(summary: &Summary) -> &'static str {
    match summary.discharge {
        Some(_) => DISCHARGE,
        None => MASS_FLOW,
    }
}

/// The result of a replicate, in a line.
fn line(seed: u64, outcome: &Outcome) -> String {
    let summary = &outcome.summary;
    let (ratio, error) = summary.flow_rate_ratio;
    let said = measured(summary.flow_rate_ratio);
    let mut words = Vec::new();
    if ratio.is_finite() {
        let within = known_error(ratio, error).map_or("", |_| " within this run");
        words.push(format!("J/Jmax = {said}{within}"));
        words.push(match summary.transition_time {
            Some(time) => format!("transition at t = {time:.1}"),
            None if is_too_short(summary) => "too short for a transition".to_owned(),
            None => "no transition".to_owned(),
        });
    }
    if let Some((flow, unit)) = mass_flow(summary) {
        words.push(format!(
            "{} {} {unit}",
            name_of_flow(summary),
            measured(flow)
        ));
    }
    if words.is_empty() {
        words.push("no J/Jmax".to_owned());
    }
    let ending = match &outcome.ending {
        Ending::Complete => "",
        Ending::Stopped(_) => "; stopped",
        Ending::Unwritten(_) => "; stopped, since its trajectory cannot be written",
        Ending::Failed(_) => "; diverged",
    };
    format!("seed {seed}: {}{ending}", words.join("; "))
}

/// New warnings of the replicates: of each key the first, with its seed and the number of other seeds that have one.
fn seen(worked: &[Worked], said: &[Warning]) -> Vec<Warning> {
    let mut seen: Vec<(&Warning, Vec<u64>)> = Vec::new();
    for (seed, _, outcome) in worked {
        let warnings = outcome.iter().flat_map(|outcome| &outcome.summary.warnings);
        for warning in warnings.filter(|warning| !said.contains(warning)) {
            match seen.iter_mut().find(|(known, ..)| known.key == warning.key) {
                Some((_, seeds)) => seeds.push(*seed),
                None => seen.push((warning, vec![*seed])),
            }
        }
    }
    let told = |(warning, mut seeds): (&Warning, Vec<u64>)| {
        seeds.dedup();
        let seed = seeds[0];
        let alike = match seeds.len() - 1 {
            0 => String::new(),
            1 => " (1 more seed has such a warning)".to_owned(),
            others => format!(" ({others} more seeds have such a warning)"),
        };
        warning.clone().under(&format!("with seed {seed}{alike}"))
    };
    seen.into_iter().map(told).collect()
}

/// Prints what the replicates came to, and answers the exit code.
fn conclude(
    arguments: &RunArguments,
    folder: &Path,
    worked: Vec<Worked>,
    stop: &Stop,
) -> Result<ExitCode, Failure> {
    let came_to = Ensemble::of(&worked);
    let printed = match arguments.json {
        true => print_json(&came_to.report(folder, &worked)),
        false => print(&came_to.in_words(&worked)),
    };
    printed?;
    let (place, complete) = (shell_word(folder), counted(came_to.complete.len(), "seed"));
    let mut is_well = true;
    for (seed, _, outcome) in worked {
        let failure = match outcome {
            Err(failure) => failure,
            Ok(Outcome {
                ending: Ending::Failed(error) | Ending::Unwritten(error),
                ..
            }) => error.into(),
            Ok(Outcome {
                finished: Err(error),
                ..
            }) => error.into(),
            Ok(_) => continue,
        };
        crate::failure::say(&format!("seed {seed}:"));
        failure.report();
        is_well = false;
    }
    if let Some(code) = stop.requested() {
        let again = format!(
            "stopped with {complete} complete; the results so far are in {place}\ngo on with: peristalsis run --resume {place}"
        );
        say(&again);
        return Ok(ExitCode::from(code));
    }
    tell(arguments.quiet, &format!("written to {place}"));
    Ok(code_of(is_well))
}

/// What the complete ones of the replicates came to.
struct Ensemble<'a> {
    complete: Vec<&'a Outcome>,
    /// J/Jmax.
    flow: Option<Scatter>,
    /// With its unit.
    mass_flow: Option<(Scatter, &'static str)>,
    /// How many had a transition.
    transitions: usize,
    /// Its time, where all had one: the mean of some would be too early.
    transition: Option<Scatter>,
}

impl<'a> Ensemble<'a> {
    fn of(worked: &'a [Worked]) -> Self {
        let outcomes = worked
            .iter()
            .filter_map(|(.., outcome)| outcome.as_ref().ok());
        let complete: Vec<&Outcome> = outcomes
            .filter(|it| matches!(it.ending, Ending::Complete))
            .collect();
        let summaries = || complete.iter().map(|it| &it.summary);
        let ratios = summaries().map(|it| it.flow_rate_ratio.0);
        let flows = summaries().filter_map(mass_flow);
        let (mass_flows, units): (Vec<_>, Vec<_>) =
            flows.map(|((rate, _), unit)| (rate, unit)).unzip();
        let times: Vec<f64> = summaries().filter_map(|it| it.transition_time).collect();
        let transitions = times.len();
        Self {
            flow: Scatter::of(ratios.filter(|ratio| ratio.is_finite()).collect()),
            mass_flow: Scatter::of(mass_flows).zip(units.first().copied()),
            transitions,
            transition: (transitions == complete.len())
                .then(|| Scatter::of(times))
                .flatten(),
            complete,
        }
    }

    /// In JSON, with each replicate.
    fn report(&self, folder: &Path, worked: &[Worked]) -> serde_json::Value {
        let of_replicate = |(seed, folder, outcome): &Worked| {
            let mut all = match outcome {
                Ok(outcome) => serde_json::to_value(&outcome.summary).unwrap_or_default(),
                Err(error) => json!({ "status": "failed", "message": error.to_string() }),
            };
            all["seed"] = json!(seed);
            all["folder"] = json!(folder.to_string_lossy());
            all
        };
        json!({
            "folder": folder.to_string_lossy(),
            "replicates": worked.iter().map(of_replicate).collect::<Vec<_>>(),
            "complete": self.complete.len(),
            "flow_rate_ratio": self.flow.as_ref().map(Scatter::report),
            "mass_flow": self.mass_flow.as_ref().map(|(flow, unit)| {
                let mut report = flow.report();
                report["unit"] = json!(unit);
                report
            }),
            "transitions": self.transitions,
            "transition_time": self.transition.as_ref().map(Scatter::report),
        })
    }

    /// A line for each replicate, then for each number of all.
    fn in_words(&self, worked: &[Worked]) -> String {
        let lines = worked
            .iter()
            .filter_map(|(seed, _, outcome)| Some(line(*seed, outcome.as_ref().ok()?)));
        let mut text: String = lines.map(|line| line + "\n").collect();
        if let Some(flow) = &self.flow {
            text += &format!("J/Jmax = {}\n", flow.in_words());
        }
        if let Some((flow, unit)) = &self.mass_flow {
            let first = self.complete.first();
            let name = first.map_or(MASS_FLOW, |it| name_of_flow(&it.summary));
            text += &format!("{name} in {unit} = {}\n", flow.in_words());
        }
        // Without a wave there is nothing to pass through.
        let tell = self.complete.iter().filter(|it| !is_too_short(&it.summary));
        let runs = self.flow.as_ref().map_or(0, |_| tell.count());
        match (&self.transition, runs) {
            (Some(times), _) => text += &format!("transition at t = {}\n", times.in_words()),
            (None, 0) => {}
            (None, number) => {
                let (transitions, runs) = (self.transitions, counted(number, "run"));
                text += &format!("transition in {transitions} of {runs}\n");
            }
        }
        text
    }
}

/// Mean and scatter of a number over the seeds.
struct Scatter {
    mean: f64,
    /// Standard error of the mean; `None` of one.
    error: Option<f64>,
    number: usize,
}

impl Scatter {
    fn of(values: Vec<f64>) -> Option<Self> {
        let number = values.len();
        let (mean, error) = mean_and_error(&values);
        let error = (number > 1).then_some(error);
        (number > 0).then_some(Self {
            mean,
            error,
            number,
        })
    }

    /// Standard deviation between seeds.
    fn deviation(&self) -> Option<f64> {
        Some(self.error? * (self.number as f64).sqrt())
    }

    fn in_words(&self) -> String {
        let mean = measured((self.mean, self.error.unwrap_or(f64::NAN)));
        let Some(deviation) = self.deviation() else {
            return format!("{mean}, of one seed: no scatter is known");
        };
        format!(
            "{mean}, mean of {} seeds and its standard error; scatter between seeds {} (standard deviation)",
            self.number,
            significant(deviation, 2)
        )
    }

    fn report(&self) -> Value {
        json!({
            "mean": self.mean,
            "error_of_mean": self.error,
            "standard_deviation": self.deviation(),
            "number": self.number,
        })
    }
}
