//! A wave whose shape a table gives: radius against phase.

/// Most points of a table.
pub const MOST_POINTS: usize = 128;

/// A periodic curve through the points of a table, as a waveform g: 0 where the radius is largest, -1 where it is least.
///
/// Between points a cubic whose slopes make no new extremes (F. N. Fritsch and J. Butland, SIAM J. Sci. Stat. Comput. 5,
/// 300 (1984)): the curve and its slope are continuous.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadiusTable {
    number: usize,
    /// In cycles, ascending.
    phases: [f64; MOST_POINTS],
    values: [f64; MOST_POINTS],
    /// dg/d phase
    slopes: [f64; MOST_POINTS],
}

/// Why points are no curve over a wavelength.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum NoCurve {
    /// There are not as many radii as phases.
    #[error("{phases} phases and {radii} radii: each phase needs a radius")]
    Unpaired {
        /// Number of phases.
        phases: usize,
        /// Number of radii.
        radii: usize,
    },
    /// There are too few or too many points.
    #[error("{0} points, and a curve needs 3 to {MOST_POINTS}")]
    Points(usize),
    /// A phase is not from 0 to below 1.
    #[error("phase {0} is not from 0 to below 1")]
    Outside(f64),
    /// A phase is not above the one before it.
    #[error("phase {after} follows {before}: phases must ascend")]
    Descending {
        /// The one before.
        before: f64,
        /// The phase.
        after: f64,
    },
    /// A radius is infinite or not a number.
    #[error("radius {0} is not finite")]
    NotFinite(f64),
    /// All radii are alike.
    #[error("all radii are {0}")]
    Straight(f64),
}

impl RadiusTable {
    /// The curve through points of one wavelength.
    ///
    /// # Errors
    /// What is wrong with the points, unless there are 3 to [`MOST_POINTS`] phases, ascending from 0 on and below 1, and as
    /// many finite radii, not all alike.
    pub fn new(phases: &[f64], radii: &[f64]) -> Result<Self, NoCurve> {
        let number = phases.len();
        if radii.len() != number {
            let (phases, radii) = (number, radii.len());
            return Err(NoCurve::Unpaired { phases, radii });
        }
        if !(3..=MOST_POINTS).contains(&number) {
            return Err(NoCurve::Points(number));
        }
        if let Some(phase) = phases.iter().find(|phase| !(0.0..1.0).contains(*phase)) {
            return Err(NoCurve::Outside(*phase));
        }
        if let Some(pair) = phases.windows(2).find(|pair| pair[0] >= pair[1]) {
            let (before, after) = (pair[0], pair[1]);
            return Err(NoCurve::Descending { before, after });
        }
        if let Some(radius) = radii.iter().find(|radius| !radius.is_finite()) {
            return Err(NoCurve::NotFinite(*radius));
        }
        let least = radii.iter().copied().fold(f64::INFINITY, f64::min);
        let most = radii.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if least == most {
            return Err(NoCurve::Straight(least));
        }
        let mut table = Self {
            number,
            phases: [0.0; MOST_POINTS],
            values: [0.0; MOST_POINTS],
            slopes: [0.0; MOST_POINTS],
        };
        table.phases[..number].copy_from_slice(phases);
        for (value, radius) in table.values.iter_mut().zip(radii) {
            *value = (radius - most) / (most - least);
        }
        for point in 0..number {
            let (before, rise_before) = table.piece((point + number - 1) % number);
            let (after, rise_after) = table.piece(point);
            let (steep_before, steep_after) = (rise_before / before, rise_after / after);
            if steep_before * steep_after > 0.0 {
                let (one, other) = (2.0 * after + before, after + 2.0 * before);
                table.slopes[point] = (one + other) / (one / steep_before + other / steep_after);
            }
        }
        Ok(table)
    }

    /// Least distance of two neighbouring points \[cycles\].
    pub fn closest(&self) -> f64 {
        let lengths = (0..self.number).map(|point| self.piece(point).0);
        lengths.fold(1.0, f64::min)
    }

    /// A size that the slope nowhere exceeds: of a cubic that makes no new extremes three times its mean rise.
    pub fn steepest(&self) -> f64 {
        let steepness = |point| {
            let (length, rise) = self.piece(point);
            3.0 * rise.abs() / length
        };
        (0..self.number).map(steepness).fold(0.0, f64::max)
    }

    /// Phase at which the radius is least, in the middle of the first stretch where it is \[cycles\].
    pub fn narrowest(&self) -> f64 {
        self.middle_of(-1.0)
    }

    /// Phase at which the radius is largest, in the middle of the first stretch where it is \[cycles\].
    pub fn widest(&self) -> f64 {
        self.middle_of(0.0)
    }

    /// Middle of the first stretch of points with the value -1 or 0, which some point has and some has not.
    fn middle_of(&self, value: f64) -> f64 {
        let has = |point: &usize| self.values[point % self.number] == value;
        let before = |point: usize| point + self.number - 1;
        let first = (0..self.number).find(|point| has(point) && !has(&before(*point)));
        let first = first.unwrap_or_default();
        let stretch = (first..first + self.number).take_while(|point| has(&(point + 1)));
        let length = stretch.fold(0.0, |sum, point| sum + self.piece(point % self.number).0);
        (self.phases[first] + 0.5 * length).fract()
    }

    /// Length and rise of the curve from a point to the next, round the end.
    fn piece(&self, point: usize) -> (f64, f64) {
        let next = (point + 1) % self.number;
        let turn = if next == 0 { 1.0 } else { 0.0 };
        let length = self.phases[next] + turn - self.phases[point];
        (length, self.values[next] - self.values[point])
    }

    /// Value, and derivative with respect to the phase in cycles.
    pub fn value_and_slope(&self, phase: f64) -> (f64, f64) {
        let phase = phase - phase.floor();
        let passed = self.phases[..self.number].partition_point(|point| *point <= phase);
        let point = (passed + self.number - 1) % self.number;
        let since = phase - self.phases[point] + if passed == 0 { 1.0 } else { 0.0 };
        let (length, rise) = self.piece(point);
        let next = (point + 1) % self.number;
        let x = since / length;
        let [from, to] = [point, next].map(|point| length * self.slopes[point]);
        // g = v + from x + (3 rise - 2 from - to) x^2 + (from + to - 2 rise) x^3
        let (square, cube) = (3.0 * rise - 2.0 * from - to, from + to - 2.0 * rise);
        let value = self.values[point] + x * (from + x * (square + x * cube));
        let slope = (from + x * (2.0 * square + x * 3.0 * cube)) / length;
        (value.clamp(-1.0, 0.0), slope)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_goes_through_its_points_and_makes_no_new_extremes() {
        let (phases, radii) = ([0.1, 0.3, 0.35, 0.8], [1.5, 1.5, 0.5, 1.0]);
        let table = RadiusTable::new(&phases, &radii).unwrap();
        for (phase, radius) in phases.into_iter().zip(radii) {
            let (value, _) = table.value_and_slope(phase + 2.0);
            assert!((value - (radius - 1.5)).abs() < 1e-12, "{phase}: {value}");
        }
        let h = 1e-7;
        let mut before = table.value_and_slope(0.0);
        for step in 1..=100_000_u32 {
            let phase = f64::from(step) / 1e5;
            let (value, slope) = table.value_and_slope(phase);
            assert!((-1.0..=0.0).contains(&value));
            // Flat where two neighbours are alike, monotonic between the others.
            assert!(!(0.1..0.3).contains(&phase) || value.abs() < 1e-14);
            assert!(!(0.36..0.79).contains(&phase) || slope >= 0.0);
            assert!((value - before.0).abs() < 1e-3 && (slope - before.1).abs() < 0.1);
            before = (value, slope);
            if step % 97 == 0 {
                let [ahead, behind] = [phase + h, phase - h].map(|at| table.value_and_slope(at).0);
                assert!(
                    (slope - (ahead - behind) / (2.0 * h)).abs() < 1e-4,
                    "{phase}"
                );
            }
        }
    }

    /// A sine at 64 points is a sine.
    #[test]
    fn a_fine_table_is_the_curve_that_it_was_taken_from() {
        let phases: Vec<f64> = (0..64).map(|point| f64::from(point) / 64.0).collect();
        let sine = |phase: f64| libm::sin(core::f64::consts::TAU * phase);
        let radii: Vec<f64> = phases
            .iter()
            .map(|phase| 1.5 + 0.25 * sine(*phase))
            .collect();
        let table = RadiusTable::new(&phases, &radii).unwrap();
        for step in 0..1000_u32 {
            let phase = f64::from(step) / 1000.0;
            let (value, _) = table.value_and_slope(phase);
            let apart = 2.0 * value + 1.0 - sine(phase);
            assert!(apart.abs() < 1e-3, "{phase}: {apart}");
        }
    }

    #[test]
    fn a_flat_throat_is_narrowest_in_its_middle() {
        let of = |phases: &[f64], radii: &[f64]| {
            let table = RadiusTable::new(phases, radii).unwrap();
            [table.narrowest(), table.widest()]
        };
        let near = |found: [f64; 2], expected: [f64; 2]| {
            let far = found.into_iter().zip(expected).map(|(a, b)| (a - b).abs());
            assert!(far.into_iter().all(|far| far < 1e-12), "{found:?}");
        };
        near(of(&[0.1, 0.3, 0.7], &[1.0, 2.0, 1.5]), [0.1, 0.3]);
        // Flat from 0.9 over the end to 0.2; the belly at 0.5 comes before the one at 0.7.
        let radii = [1.0, 1.0, 2.0, 1.5, 2.0, 1.0];
        near(of(&[0.0, 0.2, 0.5, 0.6, 0.7, 0.9], &radii), [0.05, 0.5]);
    }

    #[test]
    fn what_is_no_curve_is_refused() {
        let no_curve: [(&[f64], &[f64], &str); 7] = [
            (&[0.0, 0.5], &[1.0, 2.0], "2 points"),
            (&[0.0, 0.5, 0.4], &[1.0, 2.0, 1.0], "0.4 follows 0.5"),
            (&[0.0, 0.5, 1.0], &[1.0, 2.0, 1.0], "phase 1 is not"),
            (&[-0.1, 0.5, 0.9], &[1.0, 2.0, 1.0], "phase -0.1 is not"),
            (&[0.0, 0.5, 0.9], &[1.0, 2.0], "3 phases and 2 radii"),
            (&[0.0, 0.5, 0.9], &[1.0, 1.0, 1.0], "all radii are 1"),
            (
                &[0.0, 0.5, 0.9],
                &[1.0, f64::NAN, 2.0],
                "radius NaN is not finite",
            ),
        ];
        for (phases, radii, reason) in no_curve {
            let refused = RadiusTable::new(phases, radii).unwrap_err().to_string();
            assert!(refused.contains(reason), "{phases:?} {radii:?}: {refused}");
        }
    }
}
