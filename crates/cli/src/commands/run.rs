//! `peristalsis run`

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};

use peristalsis_configuration::Units;
use peristalsis_engine::Instructions;
use peristalsis_run::{
    Pumping, Run, RunError, RunFolder, Status, Summary, Trajectory, TrajectoryPlan, Written,
    overlap_warning, warnings,
};

use crate::arguments::RunArguments;
use crate::commands::trajectory::{in_words as in_one_line, request};
use crate::commands::{print, say, tell, warn};
use crate::failure::Failure;
use crate::progress::{Display, seconds};
use crate::sources::{configuration, locate, name};
use crate::stop::Stop;

/// Grains whose packing takes long enough to say so.
const SLOW_PACKING: u64 = 5_000;
/// Time between two savings of the state.
const SAVE_INTERVAL: Duration = Duration::from_secs(60);

/// Steps after which signals are looked for and the state is saved at the latest, far fewer than some samples are apart.
const MOST_STEPS: u64 = 50_000;

pub(crate) fn run(arguments: &RunArguments) -> Result<ExitCode, Failure> {
    let stop = Stop::watch()?;
    let (folder, mut run) = match &arguments.resume {
        Some(folder) => RunFolder::resume(folder)?,
        None => begin(arguments)?,
    };
    run.compute_with(instructions(arguments)?, usize::from(arguments.threads))?;
    let trajectory = open_trajectory(arguments, &folder, &mut run)?;
    let mut record = Record { folder, trajectory };
    stop.keep_results();
    let mut display = Display::new(arguments.quiet, run.configuration().run.samples);
    let ending = advance(&mut run, &mut record, &stop, &mut display);
    display.finish();
    let (ending, trajectory) = match (ending, record.synchronize()) {
        (Ending::Complete | Ending::Stopped(_), Err(error)) => (Ending::Unwritten(error), None),
        (ending, _) => (ending, record.trajectory.as_ref().map(Trajectory::report)),
    };
    let folder = record.folder;
    let (status, message) = match &ending {
        Ending::Complete => (Status::Complete, None),
        Ending::Stopped(_) => (Status::Interrupted, None),
        Ending::Unwritten(error) => (Status::Interrupted, Some(error.to_string())),
        Ending::Failed(error) => (Status::Diverged, Some(error.to_string())),
    };
    let mut summary = Summary::of(&run, status, message);
    summary.trajectory = trajectory;
    let written = match arguments.csv {
        true => Written::WithCsv,
        false => Written::Standard,
    };
    let finished = folder.finish(&run, &summary, written);
    print(&match arguments.json {
        true => summary.to_json(),
        false => in_words(&run, &summary),
    })?;
    overlap_warning(&run).iter().for_each(warn);
    let tell = |text: String| tell(arguments.quiet, &text);
    if let Some(report) = &summary.trajectory {
        tell(format!("trajectory: {}", in_one_line(report)));
    }
    // Where the disk is full, what could not be written first is what to speak of.
    if !matches!(ending, Ending::Unwritten(_)) {
        finished?;
    }
    let place = folder.path().display();
    match ending {
        Ending::Unwritten(source) => Err(Failure::Trajectory {
            folder: folder.path().to_owned(),
            source,
        }),
        Ending::Complete => {
            tell(format!("written to {place}"));
            Ok(ExitCode::SUCCESS)
        }
        Ending::Stopped(code) => {
            tell(format!(
                "stopped {}; what there is is in {place}\ngo on with: peristalsis run --resume {place}",
                how_far(&run, &summary)
            ));
            Ok(ExitCode::from(code))
        }
        Ending::Failed(error) => {
            tell(format!("what was measured, and the state, are in {place}"));
            Err(error.into())
        }
    }
}

/// The instructions asked for.
fn instructions(arguments: &RunArguments) -> Result<Instructions, Failure> {
    match arguments.instructions {
        None => Ok(Instructions::widest()),
        Some(wanted) if wanted.available() => Ok(wanted),
        Some(_) => Err(Failure::usage(
            "this machine does not have the instructions that --instructions asks for",
            "leave it out: the widest that there are is the default",
        )),
    }
}

/// Reads the configuration, packs the grains, makes the folder.
fn begin(arguments: &RunArguments) -> Result<(RunFolder, Run), Failure> {
    let configuration = configuration(&arguments.configuration)?;
    let usual = || new_folder(&name(&arguments.configuration));
    let path = arguments.out.clone().unwrap_or_else(usual);
    // What is refused is refused before anything is made.
    if let Some(request) = request(&arguments.frames) {
        TrajectoryPlan::new(&request, &configuration, 0, configuration.run.steps())?;
    }
    // Before the work of packing, and again when the folder is made.
    RunFolder::check(&path)?;
    warnings(&configuration).iter().for_each(warn);
    let grains = configuration.grains.number;
    if grains > SLOW_PACKING {
        tell(arguments.quiet, &format!("packing {grains} grains"));
    }
    let run = Run::new(configuration).map_err(|error| locate(error, &arguments.configuration))?;
    overlap_warning(&run).iter().for_each(warn);
    let folder = RunFolder::create(&path, run.configuration())?;
    Ok((folder, run))
}

/// The first free folder runs/NAME-K.
fn new_folder(name: &str) -> PathBuf {
    let runs = Path::new("runs");
    (1_u32..)
        .map(|number| runs.join(format!("{name}-{number}")))
        .find(|folder| folder.symlink_metadata().is_err())
        .expect("there are fewer folders than numbers")
}

/// How the advance of a run ended.
enum Ending {
    Complete,
    /// By a signal, with its exit code.
    Stopped(u8),
    /// Since its trajectory could not be written.
    Unwritten(RunError),
    Failed(RunError),
}

/// Where a run leaves what it finds.
struct Record {
    folder: RunFolder,
    trajectory: Option<Trajectory>,
}

impl Record {
    /// Saves the state, after the frames that led to it.
    fn save_state(&mut self, run: &Run) -> Result<(), RunError> {
        self.synchronize()?;
        self.folder.save_state(run)
    }

    fn synchronize(&mut self) -> Result<(), RunError> {
        let mut trajectory = self.trajectory.iter_mut();
        trajectory.try_for_each(Trajectory::synchronize)
    }

    fn observe(&mut self, run: &Run) -> Result<(), RunError> {
        let mut trajectory = self.trajectory.iter_mut();
        trajectory.try_for_each(|trajectory| trajectory.observe(run))
    }

    /// Steps after which a frame is due.
    fn steps_to_next(&self, run: &Run) -> u64 {
        let trajectory = self.trajectory.as_ref();
        let steps = trajectory.and_then(|trajectory| trajectory.steps_to_next(run));
        steps.unwrap_or(u64::MAX)
    }
}

/// The trajectory that a run goes on with or begins, if it is to have one.
fn open_trajectory(
    arguments: &RunArguments,
    folder: &RunFolder,
    run: &mut Run,
) -> Result<Option<Trajectory>, Failure> {
    let request = request(&arguments.frames);
    let there = Trajectory::resume(folder.path(), run)?;
    match (there, request) {
        (Some(_), Some(_)) => {
            let folder = folder.path().display();
            let reason = format!("{folder} has a trajectory, which goes on as it was begun");
            Err(Failure::usage(reason, "leave out --trajectory"))
        }
        (None, Some(request)) => {
            let (now, end) = (run.simulation().step(), run.configuration().run.steps());
            let plan = TrajectoryPlan::new(&request, run.configuration(), now, end)?;
            Ok(Some(Trajectory::begin(folder.path(), plan, run)?))
        }
        (there, None) => Ok(there),
    }
}

fn advance(run: &mut Run, record: &mut Record, stop: &Stop, display: &mut Display) -> Ending {
    let mut saved = Instant::now();
    while !run.is_complete() {
        if let Some(code) = stop.requested() {
            return Ending::Stopped(code);
        }
        let most = record.steps_to_next(run).min(MOST_STEPS);
        if let Err(error) = run.advance_at_most(most) {
            return Ending::Failed(error);
        }
        if let Err(error) = record.observe(run) {
            return Ending::Unwritten(error);
        }
        display.update(&run.progress());
        if saved.elapsed() > SAVE_INTERVAL {
            // The run can go on without this state; the final save reports the disk's fault.
            if let Err(error) = record.save_state(run) {
                say(&error.to_string());
            }
            saved = Instant::now();
        }
    }
    Ending::Complete
}

/// How far a run came: in periods, or in time where the wave stands still.
fn how_far(run: &Run, summary: &Summary) -> String {
    let extent = run.configuration().run;
    match extent.periods {
        Some(periods) => format!("after {:.1} of {periods} periods", summary.periods),
        None => format!("at t = {:.1} of {}", summary.time, extent.duration),
    }
}

fn in_words(run: &Run, summary: &Summary) -> String {
    let configuration = run.configuration();
    let transition = match summary.transition_time {
        Some(time) => format!(
            "transition at t = {time:.1} ({:.1} periods): J/Jmax crosses {}",
            time * configuration.drive.strain_rate,
            configuration.observe.transition_threshold
        ),
        None if configuration.drive.period().is_none() => "the wave stands still".to_owned(),
        None => format!("no transition within {:.1} periods", summary.periods),
    };
    let late = 100.0 * configuration.observe.late_fraction;
    let mut flow = match summary.flow_rate_ratio {
        (ratio, error) if error.is_finite() => {
            format!("J/Jmax = {ratio:.4} ± {error:.4}, mean of the last {late:.0} %")
        }
        (ratio, _) if ratio.is_finite() => {
            format!("J/Jmax = {ratio:.4}, mean of the last {late:.0} % (too short for an error)")
        }
        _ => format!(
            "J = {:.4e}, mean of the last {late:.0} %; no J/Jmax without grains inside and a moving wave",
            summary.flow_rate()
        ),
    };
    if let Some((newtonian, _)) = summary.newtonian {
        // The load of a fluid counts against its viscosity, which grains do not have.
        let is_loaded = summary.pumping.is_some();
        let load = if is_loaded { " without load" } else { "" };
        flow.push_str(&format!(" (a Newtonian fluid{load}: {newtonian:.4})"));
    }
    if let Some(pumping) = &summary.pumping {
        let (rise, power) = (pumping.pressure_rise, pumping.useful_power.0);
        flow.push_str(&format!(
            "\nagainst a pressure rise of {rise:.3e} m/(d t^2) a wavelength: useful power {power:.3e}, {}",
            efficiency(pumping)
        ));
    }
    let mass_flow = summary.flow_rate() * configuration.mean_grain_mass();
    if let (Some(mass_flow), Some(power), Some(pressure), Some(largest)) = (
        summary.in_si(mass_flow, Units::mass_flow),
        summary.in_si(summary.wall_power(), Units::power),
        summary.in_si(summary.wall_pressure, Units::pressure),
        summary.in_si(summary.wall_pressure_largest, Units::pressure),
    ) {
        flow.push_str(&format!(
            "\nin SI: {mass_flow:.3e} kg/s, wall power {power:.3e} W, pressure on the wall {pressure:.3e} Pa (at most \
             {largest:.3e} averaged over 1/{} of a wavelength)",
            configuration.observe.profile_bins
        ));
    }
    let mut text = format!(
        "{transition}\n{flow}\n{} grains, {} escaped; largest overlap {:.2} d; energy residual {:.1e}\n{} steps in {}: \
         {:.2} million grain-steps/s\n",
        configuration.grains.number,
        summary.escaped,
        summary.largest_overlap,
        summary.energy_residual,
        summary.steps,
        seconds(summary.seconds),
        summary.grain_steps_per_second() / 1e6
    );
    for diagnosis in &summary.wall_diagnosis {
        text.push_str(&format!("the wall: {diagnosis}\n"));
    }
    text
}

/// The efficiency, or why there is none.
fn efficiency(pumping: &Pumping) -> String {
    let (efficiency, error) = pumping.efficiency;
    if efficiency.is_nan() {
        let reason = match pumping.useful_power.0 > 0.0 {
            true => "the wall gives no power: stored energy is spent",
            false => "the grains do not go against the body force",
        };
        return format!("efficiency – ({reason})");
    }
    let mut text = format!("efficiency {efficiency:.4}");
    if error.is_finite() {
        text.push_str(&format!(" ± {error:.4}"));
    }
    if efficiency > 1.0 {
        text.push_str(" (above 1: stored energy is spent; run longer)");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_efficiency_is_said_where_there_is_one() {
        let said = |useful_power: f64, efficiency: f64| {
            super::efficiency(&Pumping {
                pressure_rise: 0.1,
                useful_power: (useful_power, 0.0),
                efficiency: (efficiency, 0.01),
            })
        };
        assert_eq!(said(1.0, 0.25), "efficiency 0.2500 ± 0.0100");
        assert!(said(1.0, 1.5).contains("stored energy is spent; run longer"));
        assert!(said(1.0, f64::NAN).starts_with("efficiency – (the wall"));
        assert!(said(-1.0, f64::NAN).starts_with("efficiency – (the grains"));
    }
}
