//! What would run, before it runs.

use std::time::{Duration, Instant};

use peristalsis_configuration::{Configuration, Control, ScheduledParameter};
use peristalsis_physics::contact::NormalLaw;

use crate::RunError;
use crate::assemble::walls;
use crate::holding;
use crate::leaking;
use crate::run::Run;
use crate::si::SiEstimate;
use crate::softness;
use crate::trajectory::{self, TrajectoryEstimate, TrajectoryRequest};

/// Steps that a contact should last.
const STEPS_PER_CONTACT: f64 = 15.0;
/// Overlap at which contact stiffness is judged, in units of the least diameter.
const USUAL_OVERLAP: f64 = 0.1;
/// Grains of the trial that measures speed.
const TRIAL_GRAINS: u64 = 20_000;
/// Length of the trial; its second half is timed, for a packing at rest has fewer contacts than a flow.
const TRIAL: Duration = Duration::from_millis(800);
/// Time that a piece of the trial should take.
const PIECE: Duration = Duration::from_millis(20);

/// Something that will run but may not mean what was intended.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Warning {
    /// The key to look at.
    pub key: &'static str,
    /// What is to be expected.
    pub message: String,
}

impl Warning {
    /// The same, said of a circumstance.
    fn under(self, circumstance: &str) -> Self {
        Self {
            message: format!("{circumstance} {}", self.message),
            ..self
        }
    }
}

/// What would run.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Estimate {
    /// Grains.
    pub grains: u64,
    /// Spheres of the wall.
    pub wall_spheres: u64,
    /// rho = N/(6 a^2 L), grain volumes averaged.
    pub volume_fraction: f64,
    /// n = N d*^3/(pi a^2 L).
    pub number_density: f64,
    /// Length of the tube \[d\].
    pub length: f64,
    /// Wave period \[t\].
    pub period: Option<f64>,
    /// Length of the run in periods.
    pub periods: Option<f64>,
    /// Length of the run \[t\].
    pub duration: f64,
    /// Step taken \[t\].
    pub time_step: f64,
    /// Steps.
    pub steps: u64,
    /// Duration of a usual contact \[t\].
    pub contact_time: f64,
    /// J/Jmax of a Newtonian fluid in this tube, without load.
    pub newtonian_flow_rate_ratio: Option<f64>,
    /// The same in SI, where the units are said.
    pub si: Option<SiEstimate>,
    /// Expected seconds, from a short trial on this machine.
    pub expected_seconds: f64,
    /// What a trajectory would take, if one is wanted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub trajectory: Option<TrajectoryEstimate>,
    /// What looks doubtful.
    pub warnings: Vec<Warning>,
}

/// What would run, with the time it would take, measured by a short trial of it.
///
/// # Errors
/// [`RunError::Engine`] where the grains do not fit; [`RunError::Trajectory`] where there cannot be such a trajectory.
pub fn estimate(
    configuration: &Configuration,
    trajectory: Option<&TrajectoryRequest>,
) -> Result<Estimate, RunError> {
    let mut trial = trial(configuration)?;
    trial.run.follow_orientations();
    let trajectory = trajectory
        .map(|request| trajectory::estimate(request, configuration, &trial.run, trial.scale))
        .transpose()?;
    let mut warnings = warnings(configuration);
    // What the schedules lead to is tried as well; a tube that cannot be packed as it becomes later is no fault.
    let later = if configuration.drive.schedules.is_empty() {
        None
    } else {
        self::trial(&configuration.at_its_hardest()).ok()
    };
    let (divergence, overlap) = match later {
        None => (trial.divergence, softness::overlap_warning(&trial.run)),
        Some(later) => (
            trial.divergence.or(later.divergence.map(in_the_end)),
            softness::overlap_warning(&trial.run)
                .or_else(|| softness::overlap_warning(&later.run).map(in_the_end)),
        ),
    };
    warnings.extend(divergence);
    warnings.extend(overlap.map(|warning| warning.under("in a short trial")));
    Ok(Estimate {
        grains: configuration.grains.number,
        wall_spheres: configuration.tube.wall_spheres(),
        volume_fraction: configuration.volume_fraction(),
        number_density: configuration.number_density(),
        length: configuration.tube.length(),
        period: configuration.drive.period(),
        periods: configuration.run.periods,
        duration: configuration.run.duration,
        time_step: configuration.run.time_step,
        steps: configuration.run.steps(),
        contact_time: contact_time(configuration),
        newtonian_flow_rate_ratio: crate::newtonian_reference(configuration)
            .map(|reference| reference.0),
        si: configuration
            .units
            .as_ref()
            .map(|units| SiEstimate::of(configuration, units)),
        expected_seconds: trial.expected_seconds,
        trajectory,
        warnings,
    })
}

/// A warning of what drive.schedule comes to.
fn in_the_end(warning: Warning) -> Warning {
    warning.under("with the drive at the hardest that drive.schedule comes to,")
}

/// What a trial showed.
struct Trial {
    expected_seconds: f64,
    /// That it diverged, which the whole run would do as well.
    divergence: Option<Warning>,
    /// The trial where it ended.
    run: Run,
    /// How many times more grains the configuration has.
    scale: f64,
}

/// Tries a run for at most [`TRIAL`]; a large tube is tried in a shorter one like it.
fn trial(configuration: &Configuration) -> Result<Trial, RunError> {
    let mut trial = configuration.clone();
    let mut scale = 1.0;
    if trial.grains.number > TRIAL_GRAINS {
        let waves = trial.tube.waves;
        let per_wave = trial.grains.number as f64 / f64::from(waves);
        // An even number of waves suits every lattice.
        let kept = (2 * ((TRIAL_GRAINS as f64 / per_wave / 2.0) as u32))
            .max(2)
            .min(waves);
        trial.tube.waves = kept;
        trial.grains.number = (per_wave * f64::from(kept)).round() as u64;
        scale = f64::from(waves) / f64::from(kept);
    }
    let mut run = Run::new(trial)?;
    let mut timed = (0, Duration::ZERO);
    let mut divergence = None;
    // Pieces grow until they last long enough to be timed: a single sample may be a billion steps away.
    let mut piece = 1;
    let start = Instant::now();
    while start.elapsed() < TRIAL && !run.is_complete() {
        let (before, first) = (start.elapsed(), run.simulation().step());
        if let Err(error) = run.advance_at_most(piece) {
            let Some(advice) = error.against_divergence() else {
                return Err(error);
            };
            divergence = Some(Warning {
                key: "run.time_step",
                message: format!("a short trial {error}; {advice}"),
            });
            break;
        }
        let took = start.elapsed() - before;
        if took < PIECE {
            piece = piece.saturating_mul(2);
        }
        let steps = run.simulation().step() - first;
        if before > TRIAL / 2 {
            timed = (timed.0 + steps, timed.1 + took);
        }
    }
    // A trial that ended early is timed as a whole.
    let (steps, time) = match timed.0 {
        0 => (run.simulation().step(), start.elapsed()),
        _ => timed,
    };
    let seconds_per_step = time.as_secs_f64() / steps.max(1) as f64;
    Ok(Trial {
        expected_seconds: scale * seconds_per_step * configuration.run.steps() as f64,
        divergence,
        run,
        scale,
    })
}

/// Half a period of the fastest oscillation of a sphere on its contacts \[t\]: how long a contact lasts.
fn contact_time(configuration: &Configuration) -> f64 {
    let model = configuration.contact;
    let diameter = configuration.grains.diameter_min;
    let mut lightest = diameter * diameter * diameter;
    if let Some(wall) = configuration.wall.elastic {
        lightest = lightest.min(wall.sphere_mass);
    }
    let reduced_mass = match configuration.drive.control {
        // Two grains; against a prescribed wall a contact lasts longer.
        Control::Strain { .. } => 0.5 * lightest,
        Control::Stress { .. } => {
            let grain = diameter * diameter * diameter;
            lightest * grain / (lightest + grain)
        }
    };
    let overlap = USUAL_OVERLAP * diameter;
    let normal = model.normal.stiffness(overlap, 0.25 * diameter);
    let tangential = model.friction.map_or(0.0, |law| law.tangential_stiffness);
    let stiffest = normal.max(tangential);
    std::f64::consts::PI / (stiffest / reduced_mass).sqrt()
}

/// A time with three digits that say something, however short it is.
fn span(time: f64) -> String {
    if time < 0.01 {
        format!("{time:.2e}")
    } else {
        format!("{time:.3}")
    }
}

/// What looks doubtful in a configuration.
#[must_use]
pub fn warnings(configuration: &Configuration) -> Vec<Warning> {
    let mut warnings = Vec::new();
    let contact_time = contact_time(configuration);
    let step = configuration.run.time_step;
    if step * STEPS_PER_CONTACT > contact_time {
        warnings.push(Warning {
            key: "run.time_step",
            message: format!(
                "a step of {} is too long for a contact that lasts {}: take {} or less",
                span(step),
                span(contact_time),
                span(contact_time / STEPS_PER_CONTACT)
            ),
        });
    }
    if let Some(units) = &configuration.units {
        warnings.extend(softness::warning(configuration, units));
    }
    warnings.extend(holding::warnings(configuration));
    warnings.extend(prescribed_wall_warnings(configuration));
    warnings.extend(unfinished_schedule(configuration));
    warnings
}

/// What looks doubtful in a prescribed wall where its drive is at its hardest.
fn prescribed_wall_warnings(configuration: &Configuration) -> Vec<Warning> {
    let mut warnings = Vec::new();
    let hardest = configuration.at_its_hardest();
    // An elastic wall, which may be large, is not made for nothing.
    if let Control::Strain { .. } = hardest.drive.control
        && let wall = walls(&hardest)
        && let Some(wave) = wall.wave()
    {
        warnings.extend(leaking::warning(&hardest, wave, wall.lattice()));
        let opening =
            2.0 * (wave.mean_radius - wave.amplitude.abs()) - wall.lattice().sphere_diameter;
        if opening <= 0.0 {
            let led = configuration.drive.schedule(ScheduledParameter::Width);
            warnings.push(Warning {
                key: led.map_or("drive.width", |_| "drive.schedule"),
                message: format!(
                    "the tube closes on itself: the clear opening of the bottleneck, w - d, is {opening:.2}; grains there \
                     are squeezed through the wall"
                ),
            });
        }
    }
    warnings
}

/// That the run ends before a schedule has come to its last value.
fn unfinished_schedule(configuration: &Configuration) -> Option<Warning> {
    let periods = configuration.run.periods?;
    let schedules = configuration.drive.schedules.iter();
    let rest = schedules
        .map(|schedule| schedule.rest())
        .fold(0.0, f64::max);
    (rest > periods).then(|| Warning {
        key: "drive.schedule",
        message: format!(
            "it goes on until {rest} periods, and the run ends after {periods}: take a longer run (run.periods) or a shorter \
             schedule"
        ),
    })
}
