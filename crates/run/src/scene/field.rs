//! What the grains of a picture are coloured by.

use peristalsis_engine::Wall;
use peristalsis_figures::{ColourScale, Palette, Units};
use peristalsis_formats::Frame;

use super::caption::cycles;
use super::drawn::{GRAINS_COVERED, MOST_CONTACTS};
use super::{refused, units};
use crate::error::RunError;
use crate::run::Run;

/// A number that each grain has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Field {
    /// v_z/c along the wave.
    #[default]
    AxialVelocity,
    /// |v|/c.
    Speed,
    /// d_i.
    Diameter,
    /// Way along the wave since the first frame, in wavelengths.
    AxialDisplacement,
    /// |omega| d_i/(2 c), the surface's speed by rotation over the speed of the wave.
    AngularVelocity,
    /// (z - c t)/lambda with z along the wave, folded to \[0, 1).
    Position,
    /// Spheres that a grain touches, those of the wall included.
    Coordination,
    /// Mean normal stress from the normal forces of its contacts, sum f_n r/(3 V_i), r the distance from its centre to the contact.
    Pressure,
}

/// A field of a run, with what its values need besides the frame.
#[derive(Clone, Debug)]
pub(super) struct Coloured {
    field: Field,
    /// Along the wave, turns round the tube counted \[d\].
    origin: Vec<f64>,
    range: (f64, f64),
    /// Least and largest value in the samples.
    found: (f64, f64),
    /// Whether the wave moves, so that speeds are told in its speed.
    is_moving: bool,
    label: String,
    /// Pressure of grains that are packed, for pictures that begin with grains apart.
    usual_pressure: f64,
}

/// Pressures of packed grains in units of k/d and of Y.
const USUAL_PRESSURES: [f64; 2] = [0.2, 0.01];

impl Coloured {
    pub(super) fn new(field: Field, run: &Run, samples: &[Frame]) -> Result<Self, RunError> {
        let first = &samples[0];
        if field == Field::AngularVelocity && first.rotation.is_none() {
            return Err(refused(
                "grains without friction do not rotate, and have no angular velocity",
                "take another field",
            ));
        }
        let touch = |frame: &Frame| coordination(frame).iter().any(|contacts| *contacts > 0.0);
        if field == Field::Pressure
            && samples.iter().all(|frame| frame.contacts.is_empty())
            && samples.iter().any(touch)
        {
            return Err(refused(
                "the frames hold no forces of contacts, of which pressure is made",
                "a GSD trajectory has none: draw from the saved state or from the start",
            ));
        }
        let wall = run.simulation().wall();
        let is_moving = wall.frequency(first.time) != 0.0;
        let units = units(run.configuration());
        let per = |symbol: &str| {
            if is_moving {
                format!("{symbol}/*c*")
            } else {
                format!("{symbol} {}/*d*", units.time())
            }
        };
        let label = match field {
            Field::AxialVelocity => {
                let way = if is_moving { "wave" } else { "tube" };
                format!("axial velocity along the {way}, {}", per("*v_z*"))
            }
            Field::Speed => format!("speed, {}", per("|*v*|")),
            Field::Diameter => "diameter, *d_i*/*d*".to_owned(),
            Field::AxialDisplacement => "displacement along the wave, Δ*z*/*λ*".to_owned(),
            Field::AngularVelocity => format!("speed of rotation, {}", per("½|*ω*|*d_i*")),
            Field::Position => "position in the wave frame, (*z* \u{2212} *ct*)/*λ*".to_owned(),
            Field::Coordination => "contacts of a grain".to_owned(),
            Field::Pressure => format!("pressure, *p*{}", units.per_pressure()),
        };
        let heading = wall.heading();
        let mut coloured = Self {
            field,
            origin: (0..first.grains)
                .map(|it| along(first, it, heading))
                .collect(),
            range: (0.0, 1.0),
            found: (0.0, 1.0),
            is_moving,
            label,
            usual_pressure: match units {
                Units::Linear => USUAL_PRESSURES[0],
                Units::Hertz => USUAL_PRESSURES[1],
            },
        };
        let mut found = Vec::new();
        for sample in samples {
            found.extend(coloured.values(sample, wall)?);
        }
        coloured.found = found.iter().fold(
            (f64::INFINITY, f64::NEG_INFINITY),
            |(least, largest), it| (least.min(*it), largest.max(*it)),
        );
        coloured.range = coloured.usual_range(found);
        Ok(coloured)
    }

    /// Values of the first and the last colour that suit the field.
    fn usual_range(&self, mut found: Vec<f64>) -> (f64, f64) {
        found.retain(|value| value.is_finite());
        found.sort_unstable_by(f64::total_cmp);
        let at = |part: f64| match found.len() {
            0 => 0.0,
            number => found[(part * (number - 1) as f64) as usize],
        };
        // Two ends that differ, with a little room where all is equal.
        let between = |least: f64, largest: f64| {
            if largest > least {
                (least, largest)
            } else {
                (least - 0.5, least + 0.5)
            }
        };
        match self.field {
            Field::AxialVelocity if self.is_moving => (-1.0, 1.0),
            Field::AxialVelocity => {
                let largest = at(0.0).abs().max(at(1.0).abs()).max(1e-9);
                (-largest, largest)
            }
            Field::Speed | Field::AngularVelocity if self.is_moving => (0.0, 1.0),
            Field::Speed | Field::AngularVelocity => (0.0, at(GRAINS_COVERED).max(1e-9)),
            Field::Diameter => between(at(0.0), at(1.0)),
            Field::AxialDisplacement => {
                let farthest = at(0.0).abs().max(at(1.0).abs());
                let reach = if farthest > 0.0 { farthest } else { 1.0 };
                (-reach, reach)
            }
            Field::Position => (0.0, 1.0),
            Field::Coordination => (0.0, MOST_CONTACTS),
            Field::Pressure if at(GRAINS_COVERED) > 0.0 => (0.0, at(GRAINS_COVERED)),
            Field::Pressure => (0.0, self.usual_pressure),
        }
    }

    /// The colours, over a range or the usual one.
    pub(super) fn scale(&self, range: Option<(f64, f64)>) -> ColourScale {
        let (least, largest) = range.unwrap_or(self.range);
        let palette = match self.field {
            Field::AxialVelocity | Field::AxialDisplacement => Palette::Diverging,
            Field::Position => Palette::Cyclic,
            _ => Palette::Sequential,
        };
        ColourScale::new(&self.label, least, largest)
            .palette(palette)
            .found(self.found.0, self.found.1)
    }

    /// The field's value of each grain.
    pub(super) fn values(&self, frame: &Frame, wall: &Wall) -> Result<Vec<f64>, RunError> {
        if frame.grains != self.origin.len() {
            let (found, expected) = (frame.grains, self.origin.len());
            let reason = format!("the frame has {found} grains, and the first had {expected}");
            return Err(refused(&reason, "name the trajectory of this run"));
        }
        let heading = wall.heading();
        let wavelength = wall.wavelength();
        let speed = match wall.wave_speed(frame.time) {
            _ if !self.is_moving => 1.0,
            speed if speed > 0.0 => speed,
            _ => f64::NAN,
        };
        let of_grains = |value: &dyn Fn(usize) -> f64| (0..frame.grains).map(value).collect();
        let size = |[x, y, z]: [f64; 3]| (x * x + y * y + z * z).sqrt();
        Ok(match self.field {
            Field::AxialVelocity => of_grains(&|it| heading * frame.velocity[it][2] / speed),
            Field::Speed => of_grains(&|it| size(frame.velocity[it]) / speed),
            Field::Diameter => of_grains(&|it| frame.diameter[it]),
            Field::AxialDisplacement => {
                of_grains(&|it| (along(frame, it, heading) - self.origin[it]) / wavelength)
            }
            Field::AngularVelocity => of_grains(&|it| {
                let turning = frame.rotation.as_ref().map(|it| &it.angular_velocity);
                let turning = turning.map_or(f64::NAN, |turning| size(turning[it]));
                0.5 * turning * frame.diameter[it] / speed
            }),
            Field::Position => of_grains(&|it| {
                (heading * frame.position[it][2] / wavelength - cycles(frame)).rem_euclid(1.0)
            }),
            Field::Coordination => coordination(frame),
            Field::Pressure => pressure(frame),
        })
    }
}

/// Place of a grain along the wave, turns round the tube counted \[d\].
fn along(frame: &Frame, grain: usize, heading: f64) -> f64 {
    heading * (frame.position[grain][2] + f64::from(frame.turns[grain]) * frame.length)
}

/// Spheres that overlap with each grain.
fn coordination(frame: &Frame) -> Vec<f64> {
    let mut order: Vec<usize> = (0..frame.spheres()).collect();
    order.sort_by(|&one, &other| frame.position[one][2].total_cmp(&frame.position[other][2]));
    let largest = frame.diameter.iter().copied().fold(0.0, f64::max);
    let mut contacts = vec![0.0; frame.grains];
    for (place, &one) in order.iter().enumerate() {
        // Upwards, and round the end of the tube.
        for &other in order[place + 1..].iter().chain(&order[..place]) {
            let mut apart = frame.position[other][2] - frame.position[one][2];
            if apart < 0.0 {
                apart += frame.length;
            }
            if apart >= largest {
                break;
            }
            let [dx, dy] =
                [0, 1].map(|axis| frame.position[other][axis] - frame.position[one][axis]);
            let reach = 0.5 * (frame.diameter[one] + frame.diameter[other]);
            if dx * dx + dy * dy + apart * apart < reach * reach {
                for sphere in [one, other] {
                    if let Some(number) = contacts.get_mut(sphere)
                        && one.min(other) < frame.grains
                    {
                        *number += 1.0;
                    }
                }
            }
        }
    }
    contacts
}

/// Mean normal stress of each grain by its contacts.
fn pressure(frame: &Frame) -> Vec<f64> {
    let mut sums = vec![0.0; frame.grains];
    for contact in &frame.contacts {
        for sphere in contact.spheres {
            if let Some(sum) = sums.get_mut(sphere) {
                *sum += contact.normal_force * 0.5 * (frame.diameter[sphere] - contact.overlap);
            }
        }
    }
    let volume = |diameter: f64| std::f64::consts::PI * diameter.powi(3) / 6.0;
    let sums = sums.into_iter().zip(&frame.diameter);
    let pressures = sums.map(|(sum, &diameter)| sum / (3.0 * volume(diameter)));
    pressures.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contacts_are_counted_across_the_end_of_the_tube_and_with_the_wall() {
        let frame = Frame {
            length: 10.0,
            grains: 3,
            // Two that touch through the end, one alone, a wall sphere at the first, and one at that.
            position: vec![
                [0.0, 0.0, 9.8],
                [0.0, 0.0, 0.3],
                [0.0, 0.0, 5.0],
                [0.9, 0.0, 9.8],
                [1.7, 0.0, 9.8],
            ],
            diameter: vec![1.0; 5],
            ..Frame::default()
        };
        assert_eq!(coordination(&frame), [2.0, 1.0, 0.0]);
    }

    #[test]
    fn pressure_of_a_pair_by_hand() {
        let mut frame = Frame {
            grains: 2,
            position: vec![[0.0; 3], [0.9, 0.0, 0.0]],
            diameter: vec![1.0, 1.0],
            ..Frame::default()
        };
        frame.contacts = vec![peristalsis_formats::trajectory::FrameContact {
            spheres: [0, 1],
            separation: [-0.9, 0.0, 0.0],
            overlap: 0.1,
            normal_force: 0.2,
            tangential_force: 0.0,
            sliding: false,
        }];
        // 0.2 * 0.45/(3 pi/6)
        let expected = 0.2 * 0.45 / (std::f64::consts::PI / 2.0);
        for found in pressure(&frame) {
            assert!((found - expected).abs() < 1e-12, "{found}");
        }
    }
}
