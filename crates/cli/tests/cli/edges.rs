//! Configurations at the edge of what there can be: each is checked and run, or refused with its key and what to do.

use crate::{Outcome, Place};

/// What is to become of a configuration.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fate {
    /// It runs.
    Runs,
    /// It is refused, with this in the message.
    Refused(&'static str),
    /// It may run or diverge, with step and grain; it may not end otherwise.
    Tried,
}

use Fate::{Refused, Runs, Tried};

/// Settings for any preset.
const ANY: &[(&str, Fate)] = &[
    ("grains.number=0", Runs),
    ("grains.number=1", Runs),
    ("grains.number=2", Runs),
    ("grains.number=0 initial.state=jammed", Runs),
    ("grains.number=900_000_000_000", Refused("grains.number")),
    ("grains.number=20_000_000", Refused("do not fit")),
    ("grains.volume_fraction=1e300", Refused("at most 10")),
    ("grains.diameter_min=0.01", Tried),
    ("grains.diameter_min=0.1 grains.diameter_max=0.1", Tried),
    ("grains.diameter_max=100", Refused("closes on itself")),
    ("grains.diameter_min=1e-300", Tried),
    ("drive.strain_rate=0", Refused("run.duration")),
    ("drive.strain_rate=0 run.duration=2", Runs),
    ("drive.strain_rate=1e-300", Refused("beyond reach")),
    ("drive.strain_rate=1e6", Tried),
    ("drive.body_force=1e300", Refused("drive.body_force")),
    ("run.time_step=1e-300", Refused("beyond reach")),
    ("run.time_step=1", Tried),
    ("run.time_step=100", Tried),
    ("run.periods=1e300", Refused("run.periods")),
    ("run.seed=18446744073709551616", Refused("run.seed")),
    ("tube.waves=18446744073709551614", Refused("tube.waves")),
    ("tube.radius=1e-6", Tried),
    ("tube.wavelength=1e-6", Refused("tube.wavelength")),
    (
        "observe.samples_per_period=1_000_000_000_000",
        Refused("observe.samples_per_period"),
    ),
    ("observe.late_fraction=1e-300", Runs),
    ("resolved.length=3", Refused("cannot be set")),
];

/// Settings for a prescribed wall and the linear law.
const STRAIN: &[(&str, Fate)] = &[
    ("grains.number=3000", Refused("do not fit")),
    ("tube.waves=1", Runs),
    ("tube.waves=1000", Runs),
    // A straight tube, a tube that is closed, and one that is turned inside out.
    ("drive.width=3", Runs),
    ("drive.amplitude=0", Runs),
    ("drive.width=0", Tried),
    ("drive.width=0 initial.state=jammed", Tried),
    ("contact.normal_damping=0", Runs),
    ("contact.normal_damping=1.5", Runs),
    ("contact.normal_damping=1e3", Tried),
    (
        "contact.normal_damping=1e300",
        Refused("contact.normal_damping"),
    ),
    ("contact.normal_stiffness=1e-6", Runs),
];

/// Settings for an elastic wall and the Hertz law.
const STRESS: &[(&str, Fate)] = &[
    ("tube.waves=1", Refused("tube.waves")),
    ("drive.force_amplitude=0", Runs),
    ("drive.force_amplitude=10", Tried),
    ("contact.dissipation_time=0", Runs),
    ("contact.dissipation_time=1e3", Tried),
    ("contact.static_friction=0 contact.kinetic_friction=0", Runs),
    ("contact.static_friction=1e3", Tried),
    ("wall.sphere_mass=1e-300", Tried),
    ("wall.sphere_mass=1e6", Runs),
    ("wall.spring_stiffness=0", Tried),
    ("wall.spring_stiffness=1e6", Tried),
    ("wall.drag=1e6", Tried),
];

fn try_all(preset: &str, tables: &[&[(&str, Fate)]]) {
    let mut wrong = Vec::new();
    for &(settings, fate) in tables.iter().copied().flatten() {
        let place = Place::new();
        let is_set = |key: &str| settings.split(' ').any(|setting| setting.starts_with(key));
        // Short, but where the case says otherwise.
        let mut all = settings.to_owned();
        if !is_set("grains.number") && !is_set("grains.volume_fraction") {
            all.push_str(" grains.number=20");
        }
        if !is_set("tube.waves") {
            all.push_str(" tube.waves=2");
        }
        if !is_set("run.periods") && !is_set("run.duration") {
            all.push_str(" run.periods=0.05");
        }
        // What is refused is refused before anything is computed, by either command.
        let commands: &[&str] = match fate {
            Refused(_) => &["run --out out"],
            Runs | Tried => &["check", "run --out out"],
        };
        for command in commands {
            let line = format!("{command} --preset {preset} {all}");
            if let Err(what) = judge(&place, &place.call(&line), fate) {
                wrong.push(format!("{line}: {what}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{preset}: {wrong:#?}");
}

/// Whether a call ended as it may: with a documented code, no panic, and a message that says what to do.
fn judge(place: &Place, outcome: &Outcome, fate: Fate) -> Result<(), String> {
    let message = outcome.message();
    let state = place.path("out/state.checkpoint");
    let is_right = match (outcome.code, fate) {
        (Some(0), Runs | Tried) => true,
        (Some(1), Tried) => message.contains("diverged at step") && state.is_file(),
        (Some(2), Refused(part)) => message.contains(part) && !place.path("out").exists(),
        // A trial may as well be refused, where it says why.
        (Some(2), Tried) => true,
        _ => false,
    };
    let is_helpful =
        outcome.code == Some(0) || message.contains("error:") && message.contains("help:");
    if is_right && is_helpful && !message.contains("panicked") {
        Ok(())
    } else {
        Err(format!("{:?} instead of {fate:?}: {message}", outcome.code))
    }
}

#[test]
fn edges_of_the_frictionless_tube() {
    try_all("frictionless", &[ANY, STRAIN]);
}

#[test]
fn edges_of_the_elastic_tube() {
    try_all("frictional", &[ANY, STRESS]);
}
