//! The estimate of a run before it runs: its size, and its time from a short trial.

use std::time::Instant;

use peristalsis_configuration::{Configuration, Control, Kernel};
use peristalsis_engine::{Instructions, processors, threads_that_pay};
use peristalsis_physics::contact::{Impact, Normal, NormalLaw};

use crate::RunError;
use crate::assemble::{check_number, newtonian_reference, scheduled_wavelengths, walls};
use crate::memory::{check_memory, memory, moving_spheres};
use crate::run::Run;
use crate::si::SiEstimate;
use crate::spheres::SPHERE;
use crate::trajectory::{self, TrajectoryEstimate, TrajectoryPlan, TrajectoryRequest};
use crate::warnings::{Warning, contact_time, warnings};

/// Grains of the trial that measures speed.
const TRIAL_GRAINS: u64 = 20_000;
/// Grains above which it is made in a narrower tube, where a shorter one does not do.
const MOST_TRIAL_GRAINS: u64 = 10 * TRIAL_GRAINS;
/// Radius of such a tube at least, in diameters of the largest grains.
const LEAST_RADII: f64 = 3.0;
/// Steps of all its grains together: a second or less of one processor.
const TRIAL_GRAIN_STEPS: f64 = 3e6;
/// Its steps at least, unless the run has fewer.
const LEAST_STEPS: u64 = 100;
/// Wall spheres in reach of a grain that take as long as the grain itself.
const WALL_SPHERES_OF_A_GRAIN: f64 = 20.0;
/// A run before it runs.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Estimate {
    /// Grains.
    pub grains: u64,
    /// Grains of them that wait outside the inlet at the start, where the tube is open.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub waiting_grains: Option<u64>,
    /// Spheres of the wall.
    pub wall_spheres: u64,
    /// Grains, and spheres of an elastic wall.
    pub moving_spheres: u64,
    /// rho = N/(6 a^2 L), grain volumes averaged.
    pub volume_fraction: f64,
    /// Standard deviation of the volume fraction between seeds, where sizes are drawn: rho ((⟨d^6⟩/⟨d^3⟩^2 - 1)/N)^(1/2).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub volume_fraction_scatter: Option<f64>,
    /// n = N d*^3/(pi a^2 L).
    pub number_density: f64,
    /// Length of the tube \[d\].
    pub length: f64,
    /// Clear opening of a prescribed wall at the throats and in the bellies, at the least width that a schedule
    /// comes to \[d\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clear_openings: Option<[f64; 2]>,
    /// Wave period \[t\].
    pub period: Option<f64>,
    /// Length of the run in periods.
    pub periods: Option<f64>,
    /// Wavelengths that the wave runs, where a schedule changes its rate.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wavelengths: Option<f64>,
    /// Length of the run \[t\].
    pub duration: f64,
    /// Step taken \[t\].
    pub time_step: f64,
    /// Steps.
    pub steps: u64,
    /// Duration of a usual contact \[t\].
    pub contact_time: f64,
    /// Steps in such a contact.
    pub steps_per_contact: f64,
    /// e of two grains of the mean diameter that meet at the speed of the wave; `None` with a static wave where it depends on
    /// the speed, and with cohesion, with which slow grains stick.
    pub restitution: Option<f64>,
    /// J/Jmax of a Newtonian fluid in this tube, phi = b/a, without load.
    pub newtonian_flow_rate_ratio: Option<f64>,
    /// The same in the clear bore, phi = b/(a - d_w/2).
    pub newtonian_flow_rate_ratio_clear_bore: Option<f64>,
    /// The estimate in SI, where the configuration says its units.
    pub si: Option<SiEstimate>,
    /// Seconds that packing the grains is expected to take, from the packing of a trial on this machine.
    pub packing_seconds: f64,
    /// Expected seconds after that, from a short trial on this machine.
    pub expected_seconds: f64,
    /// Threads with which the trial was computed.
    pub threads: usize,
    /// The kernel that computes the forces.
    pub kernel: Kernel,
    /// The reason why this run needs the reference kernel, if it does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reference_only: Option<&'static str>,
    /// Bytes of memory, at most, about.
    pub memory_bytes: f64,
    /// The size of the trajectory, if one is wanted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub trajectory: Option<TrajectoryEstimate>,
    /// Doubts.
    pub warnings: Vec<Warning>,
}

/// The estimate of a run, with the time it would take, measured by a short trial of it.
///
/// # Errors
/// [`RunError::Engine`] where the grains do not fit; [`RunError::Trajectory`] where there cannot be such a trajectory.
pub fn estimate(
    configuration: &Configuration,
    trajectory: Option<&TrajectoryRequest>,
) -> Result<Estimate, RunError> {
    estimate_by(threads(configuration), configuration, trajectory)
}

/// As [`estimate`], with `threads` threads.
///
/// # Errors
/// As [`estimate`].
pub fn estimate_by(
    threads: usize,
    configuration: &Configuration,
    trajectory: Option<&TrajectoryRequest>,
) -> Result<Estimate, RunError> {
    check_number(configuration)?;
    if let Some(request) = trajectory {
        TrajectoryPlan::new(request, configuration, 0, configuration.run.steps())?;
    }
    let mut trial = trial(configuration, threads)?;
    trial.run.follow_orientations();
    let trajectory = trajectory
        .map(|request| trajectory::estimate(request, configuration, &trial.run, trial.scale))
        .transpose()?;
    let mut warnings = warnings(configuration);
    warnings.extend(trial.warnings(configuration));
    // The end of the schedules is tried as well; a tube that cannot be packed in that shape is no fault.
    if !configuration.drive.schedules.is_empty()
        && let hardest = configuration.at_its_hardest()
        && let Ok(later) = self::trial(&hardest, threads)
    {
        let later = later.warnings(&hardest).into_iter();
        let is_new = |warning: &Warning| warnings.iter().all(|known| known.key != warning.key);
        let later: Vec<Warning> = later.filter(is_new).map(in_the_end).collect();
        warnings.extend(later);
    }
    warnings.extend(no_memory(configuration));
    let si = configuration.units.as_ref();
    let newtonian = newtonian_reference(configuration);
    Ok(Estimate {
        grains: configuration.grains.number,
        waiting_grains: configuration.inlet.map(|inlet| inlet.waiting),
        moving_spheres: moving_spheres(configuration),
        wall_spheres: configuration.tube.wall_spheres(),
        volume_fraction: configuration.volume_fraction(),
        volume_fraction_scatter: configuration.volume_fraction_scatter(),
        number_density: configuration.number_density(),
        length: configuration.tube.length(),
        clear_openings: clear_openings(&configuration.at_its_hardest()),
        period: configuration.drive.period(),
        periods: configuration.run.periods,
        wavelengths: scheduled_wavelengths(configuration),
        duration: configuration.run.duration,
        time_step: configuration.run.time_step,
        steps: configuration.run.steps(),
        contact_time: contact_time(configuration),
        steps_per_contact: contact_time(configuration) / configuration.run.time_step,
        restitution: has_restitution(configuration)
            .then(|| restitution_at_wave_speed(configuration)),
        newtonian_flow_rate_ratio: newtonian.map(|fluid| fluid.0),
        newtonian_flow_rate_ratio_clear_bore: newtonian.and_then(|fluid| fluid.1),
        si: si.map(|units| SiEstimate::of(configuration, units)),
        packing_seconds: trial.packing_seconds,
        expected_seconds: trial.expected_seconds,
        threads,
        kernel: configuration.run.kernel,
        reference_only: configuration.reference_only(),
        memory_bytes: memory(configuration),
        trajectory,
        warnings,
    })
}

/// Clear opening of a prescribed wall at the throats and in the bellies \[d\].
fn clear_openings(configuration: &Configuration) -> Option<[f64; 2]> {
    let Control::Strain { .. } = configuration.drive.control else {
        return None;
    };
    let wall = walls(configuration);
    let wave = wall.wave()?;
    let radii = [wave.throat_radius(), wave.belly_radius()];
    Some(radii.map(|radius| (2.0 * radius - wall.sphere_diameter()).max(0.0)))
}

/// A warning under the hardest drive of drive.schedule.
fn in_the_end(warning: Warning) -> Warning {
    warning.under("with the drive at the hardest that drive.schedule comes to,")
}

/// Whether the speed of the wave decides the restitution, or the law has one for all speeds.
fn has_restitution(configuration: &Configuration) -> bool {
    let contact = &configuration.contact;
    let is_known = configuration.wave_speed() > 0.0 || matches!(contact.normal, Normal::Linear(_));
    is_known && contact.cohesion.is_none()
}

/// e of two grains of the mean diameter that meet at the speed of the wave, without cohesion.
pub fn restitution_at_wave_speed(configuration: &Configuration) -> f64 {
    let diameter = configuration.grains.distribution().mean(1);
    let impact = Impact::of_twins(diameter, configuration.wave_speed());
    configuration.contact.normal.impact_restitution(impact)
}

/// Numbers in the table of a run's spheres, about.
pub fn snapshot_numbers(configuration: &Configuration) -> f64 {
    SPHERE.len() as f64 * moving_spheres(configuration) as f64
}

/// That this machine would refuse the run.
fn no_memory(configuration: &Configuration) -> Option<Warning> {
    let refused = check_memory(configuration).err()?;
    Some(Warning {
        key: "tube.waves",
        message: format!("{refused} here: on this machine it would not run"),
    })
}

/// Threads that pay for a configuration on this machine.
fn threads(configuration: &Configuration) -> usize {
    let spheres = moving_spheres(configuration) as usize;
    threads_that_pay(configuration.run.kernel, spheres, processors())
}

/// The outcome of a trial.
struct Trial {
    packing_seconds: f64,
    expected_seconds: f64,
    /// That it diverged, which the whole run would do as well.
    divergence: Option<Warning>,
    /// The trial where it ended.
    run: Run,
    /// How many times more grains the configuration has.
    scale: f64,
    /// Whether the tube is the same but for its length: else what was seen in it says nothing of the other.
    is_same_tube: bool,
}

impl Trial {
    /// Warnings of the trial that do not follow from the configuration alone.
    fn warnings(&self, configuration: &Configuration) -> Vec<Warning> {
        if !self.is_same_tube {
            return Vec::new();
        }
        let known = warnings(configuration);
        let seen = self.run.warnings().into_iter();
        let seen = seen.filter(|warning| !known.contains(warning));
        let seen = seen.map(|warning| warning.under("in a short trial"));
        self.divergence.iter().cloned().chain(seen).collect()
    }
}

/// Steps of a trial, from the configuration alone, so that it warns of the same on every machine; at most the whole run.
fn trial_steps(configuration: &Configuration) -> u64 {
    let met = configuration.wall_spheres_in_reach();
    let work = moving_spheres(configuration).max(1) as f64 * (1.0 + met / WALL_SPHERES_OF_A_GRAIN);
    let steps = (TRIAL_GRAIN_STEPS / work).ceil() as u64;
    steps.clamp(LEAST_STEPS, configuration.run.steps().max(LEAST_STEPS))
}

/// A tube like the configured one with fewer grains, the ratio of their numbers of grains, and whether the two tubes differ
/// in length alone.
fn smaller(configuration: &Configuration) -> (Configuration, f64, bool) {
    let mut trial = configuration.clone();
    let mut scale = 1.0;
    if configuration.inlet.is_some() {
        return (trial, scale, true);
    }
    if trial.grains.number > TRIAL_GRAINS {
        let waves = trial.tube.waves;
        let per_wave = trial.grains.number as f64 / f64::from(waves);
        // An even number of waves suits every lattice.
        let even = 2 * (TRIAL_GRAINS as f64 / per_wave / 2.0) as u32;
        let kept = even.max(2).min(waves);
        trial.tube.waves = kept;
        trial.grains.number = (per_wave * f64::from(kept)).round() as u64;
        scale = f64::from(waves) / f64::from(kept);
    }
    let narrower = (TRIAL_GRAINS as f64 / trial.grains.number.max(1) as f64).sqrt();
    let Control::Strain { width } = &mut trial.drive.control else {
        return (trial, scale, true);
    };
    let radius = narrower * trial.tube.radius;
    if trial.grains.number <= MOST_TRIAL_GRAINS || radius < LEAST_RADII * trial.grains.diameter_max
    {
        return (trial, scale, true);
    }
    *width *= narrower;
    trial.tube.radius = radius;
    trial.drive.schedules.clear();
    trial.grains.number = TRIAL_GRAINS;
    (trial, scale / (narrower * narrower), false)
}

/// Tries [`trial_steps`] of a run; of a large tube in a [smaller] one like it.
fn trial(configuration: &Configuration, threads: usize) -> Result<Trial, RunError> {
    let (trial, scale, is_same_tube) = smaller(configuration);
    let steps = trial_steps(&trial);
    let packing = Instant::now();
    let mut run = Run::new(trial)?;
    let packing_seconds = scale * packing.elapsed().as_secs_f64();
    run.compute_with(Instructions::widest(), threads)?;
    // The second half is timed, for a packing at rest has fewer contacts than a flow.
    let (mut start, mut first) = (Instant::now(), 0);
    let mut divergence = None;
    for end in [steps / 2, steps] {
        (start, first) = (Instant::now(), run.simulation().step());
        let advanced = advance_to(&mut run, end);
        if let Err(error) = advanced {
            let Some(advice) = error.against_divergence() else {
                return Err(error);
            };
            let (key, message) = ("run.time_step", format!("a short trial {error}; {advice}"));
            divergence = Some(Warning { key, message });
            break;
        }
    }
    let timed = (run.simulation().step() - first).max(1);
    let seconds_per_step = start.elapsed().as_secs_f64() / timed as f64;
    Ok(Trial {
        packing_seconds,
        expected_seconds: scale * seconds_per_step * configuration.run.steps() as f64,
        divergence,
        run,
        scale,
        is_same_tube,
    })
}

/// Advances to a step, or to the end of the run.
fn advance_to(run: &mut Run, step: u64) -> Result<(), RunError> {
    while run.simulation().step() < step && !run.is_complete() {
        run.advance_at_most(step - run.simulation().step())?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a trial saw, and so its warnings, depended on the speed of the machine.
    #[test]
    fn a_trial_has_as_many_steps_on_every_machine() {
        let configuration = |settings: &str| {
            let text = format!("preset = \"frictionless\"\ntube.waves = 2\n{settings}");
            Configuration::from_toml("test", &text).expect("a tube that can be")
        };
        for (settings, is_whole_run) in [
            ("grains.number = 60\nrun.periods = 400", false),
            ("grains.number = 20\nrun.periods = 5", true),
        ] {
            let configuration = configuration(settings);
            let steps = trial_steps(&configuration);
            let tried = trial(&configuration, threads(&configuration)).expect("grains that fit");
            assert_eq!(tried.run.simulation().step(), steps);
            assert_eq!(is_whole_run, steps == configuration.run.steps());
        }
    }
}
