//! The hysteresis loop: critical widths from rest and from jammed flow.

use crate::error::Error;
use crate::logistic::{FractionCrossing, Fractions};
use crate::numerics::gamma::chi_squared_tail;
use crate::numerics::minimum::minimise_from_grid;
use crate::uncertain::Uncertain;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Width of the hysteresis loop and whether there is one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Hysteresis {
    /// w_c: half of the runs started from rest jam.
    pub from_rest: FractionCrossing,
    /// w_c': half of the runs started jammed stay so.
    pub from_jammed: FractionCrossing,
    /// Width of the loop, w_c' - w_c.
    pub loop_width: Uncertain,
    /// Twice the log-likelihood lost when both starts must have one critical width.
    pub likelihood_ratio: f64,
    /// Probability of so large a ratio without a loop (chi^2 with one degree of freedom).
    pub probability: f64,
}

/// Hysteresis loop from runs of both starts.
///
/// `rest`, `jammed`: the widths of the runs from either start and whether each *ended* jammed; see
/// [`fraction_crossing`](crate::fraction_crossing) for w_c and w_c'. The interval of the loop combines the distances to the ends of both
/// intervals in quadrature (Zou & Donner, Stat. Med. 27, 1693 (2008)), brackets included. The ratio of the likelihoods
/// compares two half widths with one, the spreads free in either case. w_c in this sense depends on the time for which
/// runs are watched: from rest it rises with it and from jammed w_c' falls, so that a loop narrows with time where the
/// states are metastable.
///
/// # Errors
/// Those of [`fraction_crossing`](crate::fraction_crossing) for either start.
///
/// ```
/// use peristalsis_analysis::hysteresis;
/// let width = [2.6, 2.7, 2.8, 2.9, 3.0];
/// let rest = [true, true, false, false, false];
/// let jammed = [true, true, true, true, false];
/// let found = hysteresis((&width, &rest), (&width, &jammed))?;
/// // Brackets 2.7 to 2.8 and 2.9 to 3.0.
/// assert!((found.loop_width.value - 0.2).abs() < 1e-12);
/// # Ok::<(), peristalsis_analysis::Error>(())
/// ```
pub fn hysteresis(rest: (&[f64], &[bool]), jammed: (&[f64], &[bool])) -> Result<Hysteresis, Error> {
    let rest = Fractions::new(rest.0, rest.1)?;
    let from_rest = rest.crossing()?;
    let jammed = Fractions::new(jammed.0, jammed.1)?;
    let from_jammed = jammed.crossing()?;
    let (low, high) = (from_rest.width, from_jammed.width);
    let least = rest.least().min(jammed.least());
    let largest = rest.largest().max(jammed.largest());
    let common = |half: f64| rest.at_half(half).value + jammed.at_half(half).value;
    // A sharp fall makes the likelihood a box between two widths: the middles of the intervals must be in the grid.
    let mut grid = Fractions::grid(least, largest);
    grid.extend([low.value, high.value, 0.5 * (low.value + high.value)]);
    grid.sort_by(f64::total_cmp);
    let together_best = minimise_from_grid(common, &grid, 1e-7 * (largest - least));
    let together_best = together_best.map_or(f64::INFINITY, |best| best.value);
    let apart = -from_rest.log_likelihood - from_jammed.log_likelihood;
    let likelihood_ratio = 2.0 * (together_best - apart).max(0.0);
    Ok(Hysteresis {
        from_rest,
        from_jammed,
        loop_width: high - low,
        likelihood_ratio,
        probability: chi_squared_tail(likelihood_ratio, 1),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bootstrap::Randomness;
    use crate::tests::{Coverage, assert_coverage, jams_at};

    fn found(seed: u64, halves: (f64, f64), spread: f64) -> Hysteresis {
        let mut randomness = Randomness::new(seed, 7);
        let rest = jams_at(&mut randomness, [11, 8], halves.0, spread);
        let jammed = jams_at(&mut randomness, [11, 8], halves.1, spread);
        hysteresis((&rest.0, &rest.1), (&jammed.0, &jammed.1)).unwrap()
    }

    #[test]
    fn intervals_of_the_loop_cover_and_the_test_keeps_its_level() {
        let trials = 200;
        let mut coverage = Coverage::of([("loop", 0.1)]);
        let (mut false_loops, mut seen) = (0, 0);
        for seed in 0..trials {
            let open = found(seed, (2.78, 2.88), 0.04);
            coverage.count([open.loop_width]);
            seen += usize::from(open.probability < 0.05);
            let closed = found(seed + 5000, (2.83, 2.83), 0.04);
            false_loops += usize::from(closed.probability < 0.05);
        }
        coverage.judge([0.01; 2]);
        assert_coverage(false_loops, trials as usize, 0.05, 0.015, "false loops");
        assert!(seen > 195, "{seen}");
    }

    #[test]
    fn sharp_loops_are_bracketed_and_significant() {
        let sharp = found(1, (2.77, 2.93), 1e-4);
        assert!(sharp.from_rest.is_separated && sharp.from_jammed.is_separated);
        assert!((sharp.loop_width.value - 0.15).abs() < 1e-9);
        assert!(sharp.loop_width.interval_95.contains(0.16));
        assert!((sharp.loop_width.error - 0.05 / 6.0_f64.sqrt()).abs() < 1e-9);
        // Between w_c and w_c' three widths with eight runs a start disagree.
        assert!(sharp.probability < 1e-6 && sharp.likelihood_ratio > 20.0);
        let closed = found(1, (2.83, 2.83), 1e-4);
        assert_eq!(closed.loop_width.value, 0.0);
        assert!(closed.probability > 0.9, "{closed:?}");
    }

    #[test]
    fn a_start_with_one_outcome_is_refused() {
        let width = [2.6, 2.7, 2.8];
        let refused = hysteresis((&width, &[true, false, false]), (&width, &[true; 3]));
        assert_eq!(refused, Err(Error::OneOutcome { runs: 3 }));
    }
}
