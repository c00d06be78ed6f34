//! The drive: alternatives resolved to width and strain rate, and the elastic wall of a stress-controlled tube.

use super::{Context, schedules, units};
use crate::configuration::{Control, Drive, ElasticWall, Tube, WallKeep};
use crate::defaults;
use crate::error::ProblemKind;
use crate::keys::{DriveKeys, Keys, WallKeys};
use crate::options::{ControlName, DriveAngle, NetForce, WaveDirection, Waveform};
use crate::units::Units;

/// The drive of a given tube.
pub(super) fn drive(
    keys: &Keys,
    tube: &Tube,
    units: Option<&Units>,
    context: &mut Context<'_>,
) -> Option<Drive> {
    let control = match keys.drive.control? {
        ControlName::Strain => Control::Strain {
            width: width(&keys.drive, tube, context)?,
        },
        ControlName::Stress => Control::Stress {
            force_amplitude: keys.drive.force_amplitude?,
            angle: keys.drive.angle.unwrap_or(DriveAngle::Reference),
            wall: elastic_wall(&keys.wall, tube),
        },
    };
    let rates = (keys.drive.strain_rate, keys.drive.wave_speed);
    let strain_rate = match (rates, keys.units.wave_frequency, units) {
        ((Some(strain_rate), _), ..) => strain_rate,
        ((_, Some(wave_speed)), ..) => wave_speed / tube.wavelength,
        (_, Some(frequency), Some(units)) => units::strain_rate(frequency, units),
        _ => return None,
    };
    // A TOML -0.0 is a static wave like 0.0, and must be the same bits.
    let strain_rate = strain_rate + 0.0;
    let mut drive = Drive {
        control,
        strain_rate,
        waveform: keys.drive.waveform.unwrap_or(Waveform::Sine),
        // One zero, not two.
        body_force: keys.drive.body_force.unwrap_or(0.0) + 0.0,
        direction: keys.drive.direction.unwrap_or(WaveDirection::Forward),
        schedules: Vec::new(),
    };
    drive.schedules = schedules::schedules(&keys.drive, &drive, tube, context)?;
    Some(drive)
}

/// w = 2 (a - b), between 0 and 2 a.
fn width(keys: &DriveKeys, tube: &Tube, context: &mut Context<'_>) -> Option<f64> {
    let diameter = 2.0 * tube.radius;
    if let Some(width) = keys.width {
        if width > diameter {
            context.refuse(
                ProblemKind::Inconsistent,
                &["drive.width", "tube.radius"],
                format!(
                    "drive.width = {width} is wider than the tube, 2 a = {diameter} between the centres of the wall spheres"
                ),
                format!("0 <= drive.width <= 2 tube.radius = {diameter}; {diameter} is a straight tube"),
            );
            return None;
        }
        return Some(width + 0.0);
    }
    let amplitude = keys.amplitude?;
    if amplitude > tube.radius {
        context.refuse(
            ProblemKind::Inconsistent,
            &["drive.amplitude", "tube.radius"],
            format!(
                "drive.amplitude = {amplitude} is larger than the radius of the tube, a = {}",
                tube.radius
            ),
            format!(
                "0 <= drive.amplitude <= tube.radius = {}; 0 is a straight tube",
                tube.radius
            ),
        );
        return None;
    }
    Some(2.0 * (tube.radius - amplitude))
}

fn elastic_wall(keys: &WallKeys, tube: &Tube) -> ElasticWall {
    let natural_length = || defaults::WALL_NATURAL_LENGTH_RATIO * tube.mean_neighbour_distance();
    ElasticWall {
        sphere_mass: keys.sphere_mass.unwrap_or(defaults::WALL_SPHERE_MASS),
        spring_stiffness: keys
            .spring_stiffness
            .unwrap_or(defaults::WALL_SPRING_STIFFNESS),
        natural_length: keys.natural_length.unwrap_or_else(natural_length),
        contact_range: keys.contact_range.unwrap_or(defaults::WALL_CONTACT_RANGE),
        drag: keys.drag.unwrap_or(0.0),
        spring_damping: keys.spring_damping.unwrap_or(0.0),
        keep: WallKeep {
            balance: keys.keep.balance.unwrap_or(true),
            radial: keys.keep.radial.unwrap_or(0.0),
            azimuthal: keys.keep.azimuthal.unwrap_or(defaults::KEEP_AZIMUTHAL),
            axial: keys.keep.axial.unwrap_or(defaults::KEEP_AXIAL),
            net_force: keys.keep.net_force.unwrap_or(NetForce::Removed),
        },
    }
}
