//! Warnings about events of a run that solid grains in a tight tube would not show.

use core::f64::consts::PI;

use peristalsis_analysis::number::{plain, significant};
use peristalsis_configuration::{Configuration, Control};
use peristalsis_observe::clear_volume_of_wave;
use peristalsis_physics::wall::Arrangement;

use super::softness::{LARGEST_OVERLAP, Material, scaled_with};
use super::threshold;
use super::warning::Warning;
use crate::run::Run;

/// Overlap over diameter above which soft spheres no longer pass for solid grains, where no units say of what material they
/// are.
const LARGEST_SOFT_OVERLAP: f64 = 0.2;

/// The warnings of what a run has seen so far.
pub(super) fn warnings(run: &Run) -> Vec<Warning> {
    let configuration = run.configuration();
    let limit = match configuration.units {
        Some(_) => LARGEST_OVERLAP,
        None => LARGEST_SOFT_OVERLAP,
    };
    let diameter = configuration.grains.diameter_max;
    let packed = run.packing().largest_overlap / diameter;
    let mut warnings = Vec::new();
    if packed > limit {
        warnings.push(packed_too_densely(configuration, packed, limit));
    }
    let overlap = run.simulation().ledger().largest_overlap / diameter;
    // No drive makes room for grains that are wider than the tube, which is said already.
    let fits = super::wide_grains(configuration).is_none();
    if run.simulation().step() > 0 && overlap > packed.max(limit) && fits {
        warnings.push(overlapped(configuration, overlap, limit));
    }
    warnings.extend(left(run, packed > limit));
    warnings.extend(unaccounted(run));
    warnings.extend(threshold::missed(run));
    warnings.extend(ran_dry(run));
    warnings.extend(fed_less(run));
    warnings.extend(emptied(run));
    warnings
}

fn packed_too_densely(configuration: &Configuration, packed: f64, limit: f64) -> Warning {
    let message = format!(
        "the grains already overlap by up to {:.0} % of {} where they are packed, at a volume fraction of {:.3} of the \
         tube between the centres of its wall; solid grains have no room there, and beyond {:.0} \
         % soft spheres no longer pass for solid ones: take fewer grains or a wider tube",
        100.0 * packed,
        of_whom(configuration),
        configuration.volume_fraction(),
        100.0 * limit
    );
    let key = "grains.volume_fraction";
    Warning { key, message }
}

fn overlapped(configuration: &Configuration, overlap: f64, limit: f64) -> Warning {
    let (key, harder) = match &configuration.units {
        None => ("drive.strain_rate", "a lower drive.strain_rate".to_owned()),
        Some(units) => {
            let Material { key, name, .. } = Material::of(units);
            let harder = format!(
                "a larger {name} (with units.wave_frequency, or the wave becomes faster with it)"
            );
            (key, harder)
        }
    };
    let besides = configuration.units.as_ref().map(|units| {
        let with_it = scaled_with(configuration, Material::of(units).name, None);
        with_it + &squeezed(configuration).unwrap_or_default()
    });
    let message = format!(
        "grains overlapped by up to {} % of {}, with each other or with the wall; beyond {:.0} % soft spheres \
         no longer pass for solid grains: take {harder}, fewer grains, a wider tube or a weaker drive{}",
        significant(100.0 * overlap, if overlap < 1.1 * limit { 3 } else { 2 }),
        of_whom(configuration),
        100.0 * limit,
        besides.unwrap_or_default()
    );
    Warning { key, message }
}

/// Width of a clear throat, in the largest grains, below which its wall may press grains however hard they are.
const NARROW: f64 = 3.0;

/// That a narrow throat may be what presses the grains.
fn squeezed(configuration: &Configuration) -> Option<String> {
    let Control::Strain { width } = configuration.drive.control else {
        return None;
    };
    let clear = (width - configuration.wall.sphere_diameter) / configuration.grains.diameter_max;
    (clear < NARROW).then(|| {
        format!(
            ". Where that does not help, the throat squeezes them, whose clear opening is {} grains: take a wider one",
            significant(clear.max(0.0), 2)
        )
    })
}

fn of_whom(configuration: &Configuration) -> &'static str {
    let grains = &configuration.grains;
    match grains.diameter_min < grains.diameter_max {
        true => "the largest diameter",
        false => "a diameter",
    }
}

/// Part of the energy that entered, or was there at first, which the ledger may miss.
const LARGEST_RESIDUAL: f64 = 0.05;

/// That energy came or went which no force accounts for; of less than a period nothing is said.
fn unaccounted(run: &Run) -> Option<Warning> {
    let residual = run.simulation().energy_residual();
    let message = format!(
        "energy is not accounted for: {:.0} % of what entered, or was there at first, appeared or vanished of itself, so \
         forces change too much in a step; take a shorter run.time_step until energy_residual is small",
        100.0 * residual
    );
    let key = "run.time_step";
    let is_large = residual.is_finite() && residual > LARGEST_RESIDUAL;
    let is_told = run.recorder().periods() > 0 && is_large;
    is_told.then_some(Warning { key, message })
}

/// Part of the feed rate that an inlet takes at least, unless there was no place.
const FED: f64 = 0.9;

/// That the inlet could not put in as many grains as asked for, though they waited.
fn fed_less(run: &Run) -> Option<Warning> {
    let (ends, time) = (run.simulation().ends()?, run.simulation().time());
    let rate = run.configuration().inlet?.feed_rate?;
    let found = ends.passages().fed.grains as f64 / time;
    let message = format!(
        "the inlet put in {found:.3} grains a time, and not {rate:.3}: there was no place for more; take a longer inlet.length, a larger \
         inlet.velocity or a faster wave"
    );
    let key = "inlet.feed_rate";
    let is_less = rate * time > 10.0 && found < FED * rate && ends.waiting() > 0;
    is_less.then_some(Warning { key, message })
}

/// Part of the looks at the inlet at which none waited, above which the inlet counts as dry.
const DRY: f64 = 0.02;

/// That the inlet would have put in grains, and none waited.
fn ran_dry(run: &Run) -> Option<Warning> {
    let ends = run.simulation().ends()?;
    let steps = (ends.passages().starved * ends.steps_per_feeding()) as f64;
    let part = steps / run.simulation().step().max(1) as f64;
    let message = format!(
        "for {:.0} % of the time the inlet had place for a grain, and none waited outside: the tube holds all {} grains, and \
         is not filled to inlet.head; take more (grains.number and inlet.waiting)",
        100.0 * part,
        run.configuration().grains.number
    );
    let key = "inlet.waiting";
    (part > DRY).then_some(Warning { key, message })
}

/// Part of the clear volume that grains at rest fill at least, in a tube that is full.
const FULL: f64 = 0.5;
/// Growth of the mass in the tube over what leaves meanwhile, in the late part, from which on it still fills up.
const FILLS_UP: f64 = 0.1;

/// That an inlet does not keep a tube full whose wave stands, though grains wait: what leaves is what comes in.
fn emptied(run: &Run) -> Option<Warning> {
    let (simulation, configuration) = (run.simulation(), run.configuration());
    let (ends, inlet) = (simulation.ends()?, configuration.inlet?);
    let late = run.recorder().late(run.late_fraction());
    let (first, last) = (late.first()?, late.last()?);
    let clear = f64::from(configuration.tube.waves) * clear_volume_of_wave(simulation);
    // A grain of mass m has the volume pi m/6.
    let filled = PI / 6.0 * last.hold_up / clear;
    let grown = last.hold_up - first.hold_up;
    let left = last.discharged - first.discharged;
    let message = format!(
        "grains fill {:.0} % of the tube and no more, though {} wait: the outlet lets out what the inlet puts in, and could let \
         out more; take a larger inlet.velocity ({}) and a longer inlet.length ({})",
        100.0 * filled,
        ends.waiting(),
        plain(inlet.velocity),
        plain(inlet.length),
    );
    let key = "inlet.velocity";
    let stands = configuration.drive.period().is_none() && inlet.feed_rate.is_none();
    let is_emptied = filled < FULL && left > 0.0 && grown < FILLS_UP * left;
    (stands && ends.waiting() > 0 && is_emptied).then_some(Warning { key, message })
}

/// That grains have left the tube.
fn left(run: &Run, is_too_dense: bool) -> Option<Warning> {
    let configuration = run.configuration();
    let most = run.recorder().escaped_most();
    let (key, advice) = match configuration.drive.control {
        _ if is_too_dense => ("grains.volume_fraction", "fewer grains"),
        Control::Strain { .. } if configuration.tube.arrangement == Arrangement::Smooth => (
            "run.time_step",
            "stiffer contacts with shorter steps, a wider throat or a lower drive.strain_rate",
        ),
        Control::Strain { .. } => (
            "tube.rings_per_wave",
            "more spheres per ring and more rings per wave, or a lower drive.strain_rate",
        ),
        Control::Stress { .. } => (
            "wall.spring_stiffness",
            "a stiffer wall, more spheres per ring and more rings per wave, or a weaker drive.force_amplitude",
        ),
    };
    let message = format!(
        "the tube leaks: up to {most} of {} grains were outside ({:.1} %), and flow rates are those of the grains inside: \
         take {advice}",
        configuration.grains.number,
        100.0 * most / configuration.grains.number as f64
    );
    (most > 0.0).then_some(Warning { key, message })
}
