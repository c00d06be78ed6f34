//! Minimum of a smooth function of several variables, by its slopes.

/// Place of a minimum, with the inverse of the matrix of second derivatives there.
#[derive(Clone, Debug)]
pub(crate) struct Smallest {
    pub(crate) place: Vec<f64>,
    pub(crate) value: f64,
    pub(crate) inverse: Vec<Vec<f64>>,
}

impl Smallest {
    /// With one variable held: the inverse for the others, and how they move with it while the function stays smallest.
    pub(crate) fn beside(&self, axis: usize) -> (Vec<Vec<f64>>, Vec<f64>) {
        let own = self.inverse[axis][axis];
        let others = || (0..self.place.len()).filter(move |&k| k != axis);
        let slope = |row: usize| self.inverse[row][axis] / own;
        let entry =
            |row: usize, k: usize| self.inverse[row][k] - slope(row) * self.inverse[axis][k];
        let rows = others().map(|row| others().map(|k| entry(row, k)).collect());
        (rows.collect(), others().map(slope).collect())
    }
}

/// Most steps of a search.
const MOST_STEPS: u32 = 80;
/// Gain in value, of a step and of what the slope promises, that ends a search.
const GAIN: f64 = 1e-5;
/// Part of a step over which a slope is taken.
const DIFFERENCE: f64 = 1e-4;

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

fn scaled(matrix: &[Vec<f64>], factor: impl Fn(usize, usize) -> f64) -> Vec<Vec<f64>> {
    let mut scaled = matrix.to_vec();
    for (row, entries) in scaled.iter_mut().enumerate() {
        for (column, entry) in entries.iter_mut().enumerate() {
            *entry *= factor(row, column);
        }
    }
    scaled
}

/// Slopes by central differences, or to the side where the function has a value.
fn slope_of(function: &impl Fn(&[f64]) -> f64, offset: &[f64], here: f64) -> Vec<f64> {
    let slope = |axis: usize| {
        let moved = |by: f64| {
            let mut offset = offset.to_vec();
            offset[axis] += by;
            function(&offset)
        };
        let [up, down] = [moved(DIFFERENCE), moved(-DIFFERENCE)];
        match [up.is_finite(), down.is_finite()] {
            [true, true] => (up - down) / (2.0 * DIFFERENCE),
            [true, false] => (up - here) / DIFFERENCE,
            [false, true] => (here - down) / DIFFERENCE,
            [false, false] => 0.0,
        }
    };
    (0..offset.len()).map(slope).collect()
}

fn diagonal(dimensions: usize, entry: f64) -> Vec<Vec<f64>> {
    let row = |row| {
        let entries = (0..dimensions).map(|k| if k == row { entry } else { 0.0 });
        entries.collect()
    };
    (0..dimensions).map(row).collect()
}

/// Adds to the inverse what a change of the slope along a way says of it; `bend` is their product.
fn learn(inverse: &mut [Vec<f64>], way: &[f64], change: &[f64], bend: f64) {
    let turned: Vec<f64> = inverse.iter().map(|row| dot(row, change)).collect();
    let factor = 1.0 + dot(change, &turned) / bend;
    for (row, entries) in inverse.iter_mut().enumerate() {
        for (column, entry) in entries.iter_mut().enumerate() {
            let mixed = turned[row] * way[column] + way[row] * turned[column];
            *entry += (factor * way[row] * way[column] - mixed) / bend;
        }
    }
}

/// Local minimum by the method of Broyden, Fletcher, Goldfarb & Shanno (Nocedal & Wright, Numerical Optimization
/// (2006), chapter 6), with slopes from central differences.
///
/// `steps` scale the variables. `inverse`: a guess of the inverse of the matrix of second derivatives, from a search close
/// by, that saves most of the steps. Where the function is not a number or infinite the search does not go; `None` where
/// it begins there.
pub(crate) fn quasi_newton(
    function: impl Fn(&[f64]) -> f64,
    start: &[f64],
    steps: &[f64],
    inverse: Option<&[Vec<f64>]>,
) -> Option<Smallest> {
    let dimensions = start.len();
    let place = |offset: &[f64]| -> Vec<f64> {
        let places = offset.iter().zip(start).zip(steps);
        places
            .map(|((offset, start), step)| start + offset * step)
            .collect()
    };
    let at = |offset: &[f64]| function(&place(offset));
    let steepest = |slope: &[f64]| diagonal(dimensions, 1.0 / dot(slope, slope).sqrt().max(10.0));
    let mut offset = vec![0.0; dimensions];
    let mut value = Some(at(&offset)).filter(|value| value.is_finite())?;
    let mut slope = slope_of(&at, &offset, value);
    let mut is_fresh = inverse.is_none();
    let mut inverse = match inverse {
        Some(inverse) => scaled(inverse, |row, column| 1.0 / (steps[row] * steps[column])),
        None => steepest(&slope),
    };
    for _ in 0..MOST_STEPS {
        let mut step: Vec<f64> = inverse.iter().map(|row| -dot(row, &slope)).collect();
        let longest = step
            .iter()
            .fold(0.0, |longest: f64, one| longest.max(one.abs()));
        if longest > 3.0 {
            step.iter_mut().for_each(|one| *one *= 3.0 / longest);
        }
        let promised = dot(&step, &slope);
        let mut fraction = 1.0;
        let accepted = loop {
            let moved = offset
                .iter()
                .zip(&step)
                .map(|(offset, step)| offset + fraction * step);
            let moved: Vec<f64> = moved.collect();
            let there = at(&moved);
            if there.is_finite() && there <= value + 1e-4 * fraction * promised {
                break Some((moved, there));
            }
            fraction *= 0.3;
            if fraction < 1e-6 {
                break None;
            }
        };
        let Some((moved, there)) = accepted else {
            if is_fresh {
                break;
            }
            inverse = steepest(&slope);
            is_fresh = true;
            continue;
        };
        let gain = value - there;
        let next = slope_of(&at, &moved, there);
        let [change, way] = [difference(&next, &slope), difference(&moved, &offset)];
        let bend = dot(&change, &way);
        if bend > 1e-12 {
            if is_fresh {
                inverse = diagonal(dimensions, bend / dot(&change, &change));
            }
            is_fresh = false;
            learn(&mut inverse, &way, &change, bend);
        }
        (offset, value, slope) = (moved, there, next);
        if gain <= GAIN && promised.abs() <= 10.0 * GAIN {
            break;
        }
    }
    Some(Smallest {
        place: place(&offset),
        value,
        inverse: scaled(&inverse, |row, column| steps[row] * steps[column]),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bent_valley_of_rosenbrock_and_its_curvature() {
        let valley = |p: &[f64]| {
            let (across, along) = (p[1] - p[0] * p[0], 1.0 - p[0]);
            100.0 * across * across + along * along
        };
        let found = quasi_newton(valley, &[-1.2, 1.0], &[0.5, 0.5], None).unwrap();
        assert!(
            (found.place[0] - 1.0).abs() < 1e-2 && (found.place[1] - 1.0).abs() < 2e-2,
            "{found:?}"
        );
        // The inverse of (802 -400; -400 200) is (0.5 1; 1 2.005).
        assert!(
            (found.inverse[0][0] - 0.5).abs() < 0.1 && (found.inverse[1][1] - 2.0).abs() < 0.4,
            "{found:?}"
        );
        // With the inverse known it is a step of Newton's method.
        let bowl = |p: &[f64]| p[0] * p[0] + p[0] * p[1] + 2.0 * p[1] * p[1];
        let calls = std::cell::Cell::new(0);
        let counted = |p: &[f64]| {
            calls.set(calls.get() + 1);
            bowl(p)
        };
        let inverse = [vec![4.0 / 7.0, -1.0 / 7.0], vec![-1.0 / 7.0, 2.0 / 7.0]];
        let found = quasi_newton(counted, &[3.0, 1.0], &[0.5, 0.2], Some(&inverse)).unwrap();
        assert!(
            found.value < 1e-8 && calls.get() < 22,
            "{found:?} {calls:?}"
        );
        assert!(quasi_newton(|_| f64::NAN, &[0.0], &[1.0], None).is_none());
        assert_eq!(quasi_newton(|_| 2.0, &[], &[], None).unwrap().value, 2.0);
    }
}
