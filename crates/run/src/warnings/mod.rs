//! Warnings: settings that can be computed but look doubtful.

mod damping;
mod holding;
mod leaking;
mod sampling;
mod seen;
mod softness;
mod threshold;
mod warning;

use peristalsis_configuration::{Configuration, Control, Schedule, ScheduledParameter};
use peristalsis_physics::contact::NormalLaw;
use peristalsis_physics::wall::Arrangement;

pub use sampling::samples_that_meet;
pub use softness::overlap_at_wave_speed;
pub use warning::Warning;

use crate::assemble::walls;
use crate::run::Run;

/// Steps that a contact should last.
const STEPS_PER_CONTACT: f64 = 15.0;
/// Steps that a period of the wave should last.
const STEPS_PER_PERIOD: f64 = 20.0;
/// Overlap at which contact stiffness is judged, in units of the least diameter.
const USUAL_OVERLAP: f64 = 0.1;

/// The warnings of a configuration: what can be known before it runs.
pub fn warnings(configuration: &Configuration) -> Vec<Warning> {
    let mut warnings = of_constants(configuration);
    warnings.extend(unfinished_schedule(configuration));
    warnings
}

impl Run {
    /// Every warning of this run: those of its [configuration](warnings), then what has been seen so far (grains that
    /// overlap or have left the tube, a threshold that cannot tell two kinds of flow apart). The course that the drive took
    /// since [`Run::drive_to`] led it is no schedule of the configuration's, and is not warned of.
    pub fn warnings(&self) -> Vec<Warning> {
        let configuration = self.configuration();
        let mut warnings = match self.is_steered() {
            true => of_constants(configuration),
            false => warnings(configuration),
        };
        warnings.extend(seen::warnings(self));
        warnings
    }
}

/// The warnings of all but the length of the schedules.
fn of_constants(configuration: &Configuration) -> Vec<Warning> {
    let mut warnings = Vec::new();
    let contact_time = contact_time(configuration);
    let step = configuration.run.time_step;
    if step * STEPS_PER_CONTACT > contact_time {
        let lengths = [step, contact_time, contact_time / STEPS_PER_CONTACT];
        let [step, lasts, most] = lengths.map(span);
        let message = format!(
            "a step of {step} is too long for a contact that lasts {lasts}: take {most} or less"
        );
        let key = "run.time_step";
        warnings.push(Warning { key, message });
    }
    warnings.extend(damping::warnings(configuration));
    warnings.extend(few_steps_a_period(configuration));
    if let Some(units) = &configuration.units {
        warnings.extend(softness::warning(configuration, units));
    }
    warnings.extend(holding::warnings(configuration));
    warnings.extend(prescribed_wall_warnings(configuration));
    warnings.extend(wide_grains(configuration));
    warnings.extend(threshold::out_of_reach(configuration));
    warnings.extend(sampling::warning(configuration));
    warnings
}

/// That the fastest wave passes in a few steps.
fn few_steps_a_period(configuration: &Configuration) -> Option<Warning> {
    let period = configuration.at_its_hardest().drive.period()?;
    let steps = period / configuration.run.time_step;
    let message = format!(
        "a period of the wave, {}, lasts {steps:.1} steps only: take steps of {} or less, or a lower drive.strain_rate",
        span(period),
        span(period / STEPS_PER_PERIOD)
    );
    let key = "run.time_step";
    // Whole steps fit into a period up to rounding.
    (steps < STEPS_PER_PERIOD - 0.5).then_some(Warning { key, message })
}

/// The warnings of a prescribed wall where its drive is at its hardest.
fn prescribed_wall_warnings(configuration: &Configuration) -> Vec<Warning> {
    let mut warnings = Vec::new();
    let hardest = configuration.at_its_hardest();
    // An elastic wall, which may be large, is not made for nothing.
    if let Control::Strain { .. } = hardest.drive.control
        && let wall = walls(&hardest)
        && let Some(wave) = wall.wave()
    {
        let lattice = wall.lattice();
        warnings.extend(lattice.and_then(|lattice| leaking::warning(&hardest, wave, lattice)));
        warnings.extend(leaking::bare_stretch(&hardest));
        let opening = 2.0 * wave.throat_radius() - wall.sphere_diameter();
        if opening <= 0.0 {
            let led = configuration.drive.schedule(ScheduledParameter::Width);
            let key = led.map_or("drive.width", |_| "drive.schedule");
            let closes = "the tube closes on itself: the clear opening of the bottleneck, w - d_w";
            let message = match configuration.tube.arrangement {
                Arrangement::Smooth => format!(
                    "{closes}, would be {opening:.2}; a grain that it closes on is pressed into the wall by up to {:.2} d on \
                     either side: soft grains there no longer pass for solid ones",
                    0.5 * (configuration.grains.diameter_max - opening)
                ),
                _ => {
                    format!(
                        "{closes}, would be {opening:.2}; grains there are squeezed through the wall"
                    )
                }
            };
            warnings.push(Warning { key, message });
        }
    }
    warnings
}

/// That a grain does not fit into the straight tube.
fn wide_grains(configuration: &Configuration) -> Option<Warning> {
    let (largest, wall) = (configuration.grains.diameter_max, configuration.wall);
    let bore = 2.0 * configuration.tube.radius - wall.sphere_diameter;
    let message = format!(
        "a grain of diameter {largest} is wider than the clear bore of the straight tube, 2 a - d_w = {bore:.3}: the wall \
         presses into it, however weak the drive; take smaller grains, or tube.radius = {:.3} or more",
        (500.0 * (largest + wall.sphere_diameter)).ceil() / 1000.0
    );
    let key = "grains.diameter_max";
    (largest > bore && configuration.grains.number > 0).then_some(Warning { key, message })
}

/// That the run ends before a schedule has come to its last value.
fn unfinished_schedule(configuration: &Configuration) -> Option<Warning> {
    let periods = configuration.run.periods?;
    let schedules = configuration.drive.schedules.iter();
    let rest = schedules.map(Schedule::rest).fold(0.0, f64::max);
    let key = "drive.schedule";
    let message = format!(
        "it goes on until {rest} periods, and the run ends after {periods}: take a longer run (run.periods) or a shorter \
         schedule"
    );
    (rest > periods).then_some(Warning { key, message })
}

/// The longest time step that a contact is resolved with \[t\].
pub fn longest_time_step(configuration: &Configuration) -> f64 {
    contact_time(configuration) / STEPS_PER_CONTACT
}

/// Half a period of the fastest oscillation of a sphere on its contacts \[t\]: how long a linear contact lasts.
pub(crate) fn contact_time(configuration: &Configuration) -> f64 {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grains_that_are_wider_than_the_tube_are_warned_of() {
        // Clear bore 2 a - d_w = 2.
        for (diameter, key) in [
            ("1.8", None),
            ("2", None),
            ("2.4", Some("grains.diameter_max")),
        ] {
            let sizes = ["min", "max"].map(|it| format!("grains.diameter_{it}={diameter}"));
            let [least, largest] = sizes;
            let settings = [least, largest, "grains.number=3".to_owned()];
            let configuration = Configuration::from_preset("frictionless", &settings).unwrap();
            let found = wide_grains(&configuration);
            assert_eq!(found.as_ref().map(|it| it.key), key, "{found:?}");
        }
    }
}
