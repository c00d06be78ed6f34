//! Forces and velocities in a part of the wave: its narrow half or its front.

use super::{Sums, WaveFrameProfile, standard_error, total};

/// A part of the wavelength. The rest of `Narrow` is the wide half, the rest of `Front` the rear.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WavePart {
    /// All of it.
    Whole,
    /// Where the tube is narrower than on its mean.
    Narrow,
    /// From the narrowest place to the widest one ahead: where the wave closes the tube.
    Front,
}

/// Forces and velocities in a part of the wave: late means, each with its error, positive along the wave.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartOfWave {
    /// Axial force of the wall on the grains of the part along the normals of contacts \[m d/t^2\].
    pub normal_force: (f64, f64),
    /// The same by friction \[m d/t^2\].
    pub tangential_force: (f64, f64),
    /// Power that its grains lose where they slide on the wall \[m d^2/t^3\].
    pub sliding_power: (f64, f64),
    /// Mean axial velocity of its grains, laboratory frame \[d/t\].
    pub axial_velocity: (f64, f64),
    /// Mean axial velocity of the wall's spheres there \[d/t\]; 0 for a prescribed wall.
    pub wall_velocity: (f64, f64),
}

impl WaveFrameProfile {
    /// A part of the wave over the last part of what was added, as [`WaveFrameProfile::late`] with its errors.
    ///
    /// A straight tube has no proper parts: all is NaN.
    pub fn late_part(&self, fraction: f64, part: WavePart) -> PartOfWave {
        let (groups, whole) = self.blocks.late(fraction);
        let radius = |bin: usize| {
            let all = total(groups.iter().map(|group| &group[bin]));
            all.radius / all.looks
        };
        let bins = bins_of(part, &(0..self.bins).map(radius).collect::<Vec<f64>>());
        let inside: Vec<Sums> = groups
            .iter()
            .map(|group| total(bins.iter().map(|&bin| &group[bin])))
            .collect();
        let all = total(&inside);
        let with_error = |value: &dyn Fn(&Sums) -> f64| {
            let error = standard_error(inside[..whole].iter().map(value));
            (value(&all), error)
        };
        // Every bin was looked at as often.
        let looks = |sums: &Sums| sums.wall.looks / bins.len() as f64;
        PartOfWave {
            normal_force: with_error(&|sums| sums.wall.normal / looks(sums)),
            tangential_force: with_error(&|sums| sums.wall.tangential / looks(sums)),
            sliding_power: with_error(&|sums| sums.wall.sliding / looks(sums)),
            axial_velocity: with_error(&Sums::velocity),
            wall_velocity: with_error(&|sums| sums.wall.velocity()),
        }
    }
}

/// Difference below which two radii are the same \[d\].
const SAME: f64 = 1e-9;

/// The bins of a part of a wave of these radii.
fn bins_of(part: WavePart, radii: &[f64]) -> Vec<usize> {
    let number = radii.len();
    match part {
        WavePart::Whole => (0..number).collect(),
        WavePart::Narrow => {
            let mean = radii.iter().sum::<f64>() / number as f64;
            (0..number).filter(|&bin| radii[bin] < mean).collect()
        }
        WavePart::Front => {
            let least = radii.iter().copied().fold(f64::INFINITY, f64::min);
            let largest = radii.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let is_narrowest = |bin: usize| radii[bin] <= least + SAME;
            let is_widest = |bin: usize| radii[bin] >= largest - SAME;
            if least + SAME >= largest {
                return Vec::new();
            }
            // Of bins that are equally narrow the last, and of equally wide ones the first ahead, wherever the bins are
            // counted from; where two are the widest, the widest place lies between them.
            let on_from = |bin: usize| (bin..bin + number).map(|bin| bin % number);
            let any = (0..number).find(|&bin| is_narrowest(bin));
            let widest = any.and_then(|bin| on_from(bin).find(|&bin| is_widest(bin)));
            let Some(widest) = widest else {
                return Vec::new();
            };
            let between = is_widest((widest + 1) % number);
            let back = (0..number).map(|step| (widest + number - step) % number);
            let skipped = usize::from(!between);
            let length = back.clone().position(is_narrowest).unwrap_or(0);
            let mut front: Vec<usize> = back.take(length + 1).skip(skipped).collect();
            front.reverse();
            front
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_leads_from_the_narrowest_place_to_the_widest_ahead() {
        // Narrowest at 5, widest at 1 of the next wavelength.
        let radii = [3.5, 4.0, 3.8, 3.2, 3.0, 2.5, 3.0, 3.2];
        assert_eq!(bins_of(WavePart::Front, &radii), [5, 6, 7, 0]);
        assert_eq!(bins_of(WavePart::Narrow, &radii), [3, 4, 5, 6, 7]);
        assert_eq!(bins_of(WavePart::Front, &[3.0; 4]), [0; 0]);
    }

    #[test]
    fn the_front_of_a_wave_with_flat_parts_does_not_hang_on_where_bins_are_counted_from() {
        // Two bins about the throat, two about the belly: half the wave. A flat throat, and a flat belly, of three.
        let sine = [2.0, 2.0, 3.0, 4.0, 4.0, 3.0];
        let flat = [2.0, 2.0, 2.0, 3.0, 4.0, 4.0, 4.0, 3.0];
        for (radii, first, length) in [(&sine[..], 1, 3), (&flat[..], 2, 3)] {
            for turned in 0..radii.len() {
                let mut of = radii.to_vec();
                of.rotate_right(turned);
                // Means over many samples differ by rounding.
                of[0] += 1e-13;
                let expected = (0..length).map(|step| (first + step + turned) % radii.len());
                let expected: Vec<usize> = expected.collect();
                assert_eq!(bins_of(WavePart::Front, &of), expected, "{of:?}");
            }
        }
    }
}
