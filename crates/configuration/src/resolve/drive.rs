//! The drive: alternatives resolved to width and strain rate.

use super::{Context, plain, schedules};
use peristalsis_physics::wall::table::MOST_POINTS;
use peristalsis_physics::wall::{Arrangement, LONGEST_CYCLE, RadiusTable, SegmentDrive, Segments};

use crate::configuration::{Control, Drive, Tube};
use crate::keys::Keys;
use crate::units::Units;
use crate::waveform::WaveformName;

/// The drive of a tube.
pub(super) fn drive(
    keys: &Keys,
    units: Option<&Units>,
    context: &mut Context<'_>,
) -> Option<Drive> {
    let (written, tube) = (&keys.drive, &keys.tube.tube);
    let mut drive = written.drive.clone();
    if let Control::Strain { width: resolved } = &mut drive.control {
        *resolved = width(*resolved, written.amplitude, tube, context)?;
    }
    let strain_rate = match (written.wave_speed, keys.units.wave_frequency) {
        (None, None) => drive.strain_rate,
        (Some(wave_speed), _) => wave_speed / tube.wavelength,
        (None, Some(frequency)) => frequency * units?.time(),
    };
    // A TOML -0.0 is a static wave like 0.0, and must be the same bits.
    drive.strain_rate = strain_rate + 0.0;
    drive.body_force += 0.0;
    drive.segments = segments(&drive, tube, context)?;
    check_table(&drive, context)?;
    drive.schedules = schedules::schedules(written, &drive, tube, context)?;
    Some(drive)
}

/// The segments, with the order in which they close; `Some(None)` for a wave.
fn segments(drive: &Drive, tube: &Tube, context: &mut Context<'_>) -> Option<Option<SegmentDrive>> {
    if drive.waveform != WaveformName::Segments {
        return Some(None);
    }
    let mut segments = drive.segments.clone().unwrap_or_default();
    let number = segments.segments;
    if segments.order.is_empty() {
        segments.order = (1..=number).collect();
    }
    check_strain_control(drive, "segments set", context)?;
    if tube.arrangement != Arrangement::Smooth && tube.rings_per_wave < 2 * number {
        return context.refuse(
            &["drive.segments", "tube.rings_per_wave"],
            format!(
                "{number} segments in {} rings of wall spheres: a segment needs two rings at least",
                tube.rings_per_wave
            ),
            format!("drive.segments is at most {} here", tube.rings_per_wave / 2),
        );
    }
    let cycle = segments.cycle();
    if cycle > LONGEST_CYCLE {
        return context.refuse(
            &["drive.duty", "drive.rise", "drive.fall"],
            format!(
                "a segment closes, stays closed and opens within {cycle:.4} periods, more than one"
            ),
            "drive.duty + drive.rise + drive.fall is at most 1",
        );
    }
    if Segments::new(&segments).is_none() {
        return context.refuse(
            &["drive.order", "drive.segments"],
            format!("drive.order does not name each of the {number} segments once"),
            format!("a list of the numbers from 1 to {number}, each once, in the order in which the segments close"),
        );
    }
    Some(Some(segments))
}

/// Whether the radius can be set as it is: under stress control nothing sets it.
fn check_strain_control(drive: &Drive, setting: &str, context: &mut Context<'_>) -> Option<()> {
    let Control::Stress { .. } = drive.control else {
        return Some(());
    };
    context.refuse(
        &["drive.waveform", "drive.control"],
        format!("{setting} the radius of the tube, and under stress control nothing does"),
        "drive.control = \"strain\", or the waveform \"sine\", \"bolus\" or \"roller\"",
    )
}

/// Whether the table of a wave that one gives is a curve.
fn check_table(drive: &Drive, context: &mut Context<'_>) -> Option<()> {
    if drive.waveform != WaveformName::Table {
        return Some(());
    }
    check_strain_control(drive, "a table sets", context)?;
    if let Err(reason) = RadiusTable::new(&drive.phases, &drive.radii) {
        let message = match drive.phases.is_empty() && drive.radii.is_empty() {
            true => "the table of the wave is missing".into(),
            false => format!("this is no curve over a wavelength: {reason}"),
        };
        return context.refuse(
            &["drive.phases", "drive.radii", "drive.waveform"],
            message,
            format!(
                "give drive.table, or drive.phases and drive.radii: 3 to {MOST_POINTS} phases, ascending from 0 to below 1, and a radius for each, not all alike"
            ),
        );
    }
    Some(())
}

/// w = 2 (a - b), between 0 and 2 a.
fn width(
    width: f64,
    amplitude: Option<f64>,
    tube: &Tube,
    context: &mut Context<'_>,
) -> Option<f64> {
    let diameter = 2.0 * tube.radius;
    let Some(amplitude) = amplitude else {
        if width > diameter {
            let [width, diameter] = [width, diameter].map(plain);
            return context.refuse(
                &["drive.width", "tube.radius"],
                format!(
                    "drive.width = {width} is wider than the tube, 2 a = {diameter} between the centres of the wall spheres"
                ),
                format!("0 <= drive.width <= 2 tube.radius = {diameter}; {diameter} is a straight tube"),
            );
        }
        return Some(width + 0.0);
    };
    let radius = tube.radius;
    if amplitude > radius {
        let [amplitude, radius] = [amplitude, radius].map(plain);
        return context.refuse(
            &["drive.amplitude", "tube.radius"],
            format!(
                "drive.amplitude = {amplitude} is larger than the radius of the tube, a = {radius}"
            ),
            format!("0 <= drive.amplitude <= tube.radius = {radius}; 0 is a straight tube"),
        );
    }
    Some(2.0 * (radius - amplitude))
}
