//! Minima and level crossings of functions of one variable.

/// Ratio of the golden section, (3 - sqrt(5))/2.
const GOLDEN: f64 = 0.381_966_011_250_105_1;
/// Most evaluations of one search.
const MOST_STEPS: u32 = 120;

/// Place and value of a minimum.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Minimum {
    pub(crate) place: f64,
    pub(crate) value: f64,
}

/// Minimum of a unimodal function between two bounds, to an absolute tolerance of the place.
///
/// Parabolic interpolation safeguarded by the golden section (Brent, Algorithms for Minimization without Derivatives,
/// 1973, chapter 5). A value that is not a number counts as +infinity.
pub(crate) fn minimise(
    mut function: impl FnMut(f64) -> f64,
    bounds: (f64, f64),
    tolerance: f64,
) -> Minimum {
    let mut evaluate = |place: f64| {
        let value = function(place);
        let value = if value.is_nan() { f64::INFINITY } else { value };
        Minimum { place, value }
    };
    let (mut low, mut high) = bounds;
    let mut best = evaluate(low + GOLDEN * (high - low));
    let (mut second, mut third) = (best, best);
    let (mut step, mut step_before_last) = (0.0_f64, 0.0_f64);
    for _ in 0..MOST_STEPS {
        let middle = 0.5 * (low + high);
        if (best.place - middle).abs() <= 2.0 * tolerance - 0.5 * (high - low) {
            break;
        }
        let parabola = (step_before_last.abs() > tolerance)
            .then(|| parabolic_step(best, second, third))
            .filter(|&step| {
                let place = best.place + step;
                step.abs() < 0.5 * step_before_last.abs() && place > low && place < high
            });
        if let Some(parabola) = parabola {
            step_before_last = step;
            step = parabola;
            let place = best.place + step;
            if place - low < 2.0 * tolerance || high - place < 2.0 * tolerance {
                step = tolerance.copysign(middle - best.place);
            }
        } else {
            step_before_last = if best.place < middle {
                high - best.place
            } else {
                low - best.place
            };
            step = GOLDEN * step_before_last;
        }
        let trial = evaluate(best.place + tolerance.max(step.abs()).copysign(step));
        if trial.value <= best.value {
            if trial.place < best.place {
                high = best.place;
            } else {
                low = best.place;
            }
            (third, second, best) = (second, best, trial);
        } else {
            if trial.place < best.place {
                low = trial.place;
            } else {
                high = trial.place;
            }
            if trial.value <= second.value || second.place == best.place {
                (third, second) = (second, trial);
            } else if trial.value <= third.value
                || third.place == best.place
                || third.place == second.place
            {
                third = trial;
            }
        }
    }
    best
}

/// Step from the best of three points to the vertex of their parabola; not a number where they have none.
fn parabolic_step(best: Minimum, second: Minimum, third: Minimum) -> f64 {
    let r = (best.place - second.place) * (best.value - third.value);
    let q = (best.place - third.place) * (best.value - second.value);
    let numerator = (best.place - third.place) * q - (best.place - second.place) * r;
    -0.5 * numerator / (q - r)
}

/// Least value of a function on a grid, refined between the neighbours of the best grid point.
///
/// Serves functions with several minima that the grid can tell apart. The grid must be in order; `None` for an empty
/// one or where no grid point has a finite value.
pub(crate) fn minimise_from_grid(
    mut function: impl FnMut(f64) -> f64,
    grid: &[f64],
    tolerance: f64,
) -> Option<Minimum> {
    let mut best: Option<(usize, Minimum)> = None;
    for (index, &place) in grid.iter().enumerate() {
        let value = function(place);
        if value.is_finite() && best.is_none_or(|(_, least)| value < least.value) {
            best = Some((index, Minimum { place, value }));
        }
    }
    let (index, best) = best?;
    let before = grid[index.saturating_sub(1)];
    let behind = grid[(index + 1).min(grid.len() - 1)];
    let refined = minimise(function, (before, behind), tolerance);
    let is_better = refined.value < best.value;
    Some(if is_better { refined } else { best })
}

/// Place where a function, at most 0 at `inside`, becomes positive on the way to `limit`.
///
/// Steps of growing length look for the crossing, bisection finds it to a tolerance relative to the first step. `None`
/// where the function stays at or below 0 as far as `limit`: an interval open to that side. A value that is not a
/// number counts as positive; places that are not numbers have no crossing.
pub(crate) fn crossing(
    mut function: impl FnMut(f64) -> f64,
    inside: f64,
    first_step: f64,
    limit: f64,
) -> Option<f64> {
    let mut is_outside = |place: f64| {
        let value = function(place);
        value > 0.0 || value.is_nan()
    };
    if inside.is_nan() || limit.is_nan() {
        return None;
    }
    let toward = (limit - inside).signum();
    let mut step = first_step.abs().max(1e-12 * inside.abs().max(1e-12));
    let mut far = inside;
    let mut near = loop {
        if far == limit {
            return None;
        }
        let near = far;
        far += toward * step;
        if (limit - far) * toward <= 0.0 || !far.is_finite() {
            far = limit;
        }
        if is_outside(far) {
            break near;
        }
        step *= 1.6;
    };
    let tolerance = 1e-5 * first_step.abs();
    for _ in 0..MOST_STEPS {
        let middle = 0.5 * (near + far);
        if (far - near).abs() <= tolerance || middle == near || middle == far {
            break;
        }
        if is_outside(middle) {
            far = middle;
        } else {
            near = middle;
        }
    }
    Some(0.5 * (near + far))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smooth_and_kinked_minima_are_found() {
        let smooth = minimise(|x| libm::cosh(x - 0.3), (-4.0, 9.0), 1e-8);
        assert!((smooth.place - 0.3).abs() < 1e-7, "{smooth:?}");
        let kinked = minimise(|x| (x - 2.5).abs(), (-4.0, 9.0), 1e-8);
        assert!((kinked.place - 2.5).abs() < 1e-7, "{kinked:?}");
        let edge = minimise(|x| x, (1.0, 2.0), 1e-8);
        assert!((edge.place - 1.0).abs() < 1e-7, "{edge:?}");
    }

    #[test]
    fn a_smooth_minimum_takes_few_evaluations() {
        let mut evaluations = 0;
        let _ = minimise(
            |x| {
                evaluations += 1;
                libm::exp(x) - 2.0 * x
            },
            (-5.0, 5.0),
            1e-6,
        );
        assert!(evaluations < 25, "{evaluations}");
    }

    #[test]
    fn the_grid_finds_the_deeper_of_two_minima() {
        let double = |x: f64| (x * x - 1.0) * (x * x - 1.0) + 0.2 * x;
        let grid: Vec<f64> = (0..21).map(|k| -2.0 + 0.2 * f64::from(k)).collect();
        let found = minimise_from_grid(double, &grid, 1e-9).unwrap();
        assert!((found.place + 1.0241).abs() < 1e-3, "{found:?}");
        assert!(minimise_from_grid(|_| f64::NAN, &grid, 1e-9).is_none());
        assert!(minimise_from_grid(double, &[], 1e-9).is_none());
    }

    #[test]
    fn crossings_to_either_side_and_none() {
        let parabola = |x: f64| x * x - 2.0;
        let up = crossing(parabola, 0.0, 0.1, 10.0).unwrap();
        assert!((up - 2.0_f64.sqrt()).abs() < 1e-5, "{up}");
        let down = crossing(parabola, 0.0, 5.0, -10.0).unwrap();
        assert!((down + 2.0_f64.sqrt()).abs() < 1e-4, "{down}");
        assert_eq!(crossing(parabola, 0.0, 0.1, 1.0), None);
        assert_eq!(crossing(|_| -1.0, 0.0, 0.1, f64::INFINITY), None);
        assert!(crossing(|_| f64::NAN, 0.0, 0.1, 1.0).is_some());
    }
}
