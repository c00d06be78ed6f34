//! Minimum of a function of several variables without derivatives.

/// Place and value of a minimum of several variables.
#[derive(Clone, Debug)]
pub(crate) struct Lowest {
    pub(crate) place: Vec<f64>,
    pub(crate) value: f64,
}

/// Minimum by the downhill simplex of Nelder & Mead (Comput. J. 7, 308 (1965)).
///
/// `steps`: length of the first simplex along each variable, none 0. Ends when the values at the corners agree within
/// `tolerance` (relative, and absolute near 0) and the simplex is smaller than `tolerance` of the steps, or after
/// `evaluations`. Values that are not numbers count as +infinity.
pub(crate) fn nelder_mead(
    mut function: impl FnMut(&[f64]) -> f64,
    start: &[f64],
    steps: &[f64],
    tolerance: f64,
    evaluations: usize,
) -> Lowest {
    let mut left = evaluations;
    let mut evaluate = |place: Vec<f64>| {
        let value = function(&place);
        left = left.saturating_sub(1);
        let value = if value.is_nan() { f64::INFINITY } else { value };
        ((place, value), left > 0)
    };
    let dimensions = start.len();
    let mut corners = vec![evaluate(start.to_vec()).0];
    for axis in 0..dimensions {
        let mut place = start.to_vec();
        place[axis] += steps[axis];
        corners.push(evaluate(place).0);
    }
    let by_value = |a: &(Vec<f64>, f64), b: &(Vec<f64>, f64)| a.1.total_cmp(&b.1);
    let mut go_on = dimensions > 0;
    while go_on {
        corners.sort_by(by_value);
        let (best, worst) = (corners[0].1, corners[dimensions].1);
        let distance = |place: &[f64], axis: usize| (place[axis] - corners[0].0[axis]).abs();
        let small = corners[1..].iter().all(|(place, _)| {
            (0..dimensions).all(|axis| distance(place, axis) <= tolerance * steps[axis].abs())
        });
        if small && (worst - best <= tolerance * (1.0 + best.abs()) || worst.is_infinite()) {
            break;
        }
        let mean = |axis: usize| {
            let coordinates = corners[..dimensions].iter().map(|(place, _)| place[axis]);
            coordinates.sum::<f64>() / dimensions as f64
        };
        let centre: Vec<f64> = (0..dimensions).map(mean).collect();
        let outward = |factor: f64, corner: &[f64]| -> Vec<f64> {
            let pairs = centre.iter().zip(corner);
            pairs
                .map(|(centre, corner)| centre + factor * (centre - corner))
                .collect()
        };
        let second_worst = corners[dimensions - 1].1;
        let (reflected, more) = evaluate(outward(1.0, &corners[dimensions].0));
        go_on = more;
        let replacement = if reflected.1 < best {
            let (expanded, more) = evaluate(outward(2.0, &corners[dimensions].0));
            go_on &= more;
            let is_better = expanded.1 < reflected.1;
            Some(if is_better { expanded } else { reflected })
        } else if reflected.1 < second_worst {
            Some(reflected)
        } else {
            let factor = if reflected.1 < worst { 0.5 } else { -0.5 };
            let (contracted, more) = evaluate(outward(factor, &corners[dimensions].0));
            go_on &= more;
            (contracted.1 < worst.min(reflected.1)).then_some(contracted)
        };
        if let Some(corner) = replacement {
            corners[dimensions] = corner;
        } else {
            let anchor = corners[0].0.clone();
            for corner in &mut corners[1..] {
                let pairs = corner.0.iter().zip(&anchor);
                let place = pairs.map(|(corner, anchor)| 0.5 * (corner + anchor));
                let (shrunk, more) = evaluate(place.collect());
                *corner = shrunk;
                go_on &= more;
            }
        }
    }
    corners.sort_by(by_value);
    let (place, value) = corners.swap_remove(0);
    Lowest { place, value }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bent_valley_of_rosenbrock() {
        let valley = |p: &[f64]| {
            let (across, along) = (p[1] - p[0] * p[0], 1.0 - p[0]);
            100.0 * across * across + along * along
        };
        let found = nelder_mead(valley, &[-1.2, 1.0], &[0.5, 0.5], 1e-8, 2000);
        assert!((found.place[0] - 1.0).abs() < 1e-5, "{found:?}");
        assert!((found.place[1] - 1.0).abs() < 1e-5, "{found:?}");
    }

    #[test]
    fn forbidden_ground_and_no_ground_at_all() {
        let half_plane = |p: &[f64]| {
            if p[0] < 0.5 {
                f64::NAN
            } else {
                p[0] + p[1] * p[1]
            }
        };
        let found = nelder_mead(half_plane, &[2.0, 1.0], &[0.3, 0.3], 1e-7, 2000);
        assert!((found.place[0] - 0.5).abs() < 1e-4, "{found:?}");
        let nowhere = nelder_mead(|_| f64::NAN, &[0.0, 0.0], &[1.0, 1.0], 1e-6, 500);
        assert_eq!(nowhere.value, f64::INFINITY);
        assert_eq!(nelder_mead(|_| 3.0, &[], &[], 1e-6, 10).value, 3.0);
    }
}
