//! What must be seen of frictionless grains in the prescribed wall.
//!
//! Bounds come from the scatter over seeds, which is written beside each: mean (least to largest; number of seeds).
//! Transition times are the crossing of 0.5 by the averages over whole periods, interpolated between their middles.

mod common;

use common::{Outcome, on_both_kernels, run, within};
use peristalsis_engine::Kernel;

/// The fine lattice at strain rate 0.1: a period lasts 10, N = 203.
fn fine(kernel: Kernel, width: f64, periods: u32, state: &str, seed: u64) -> Outcome {
    dense(kernel, 0.15, width, periods, state, seed)
}

fn dense(
    kernel: Kernel,
    volume_fraction: f64,
    width: f64,
    periods: u32,
    state: &str,
    seed: u64,
) -> Outcome {
    let settings = format!(
        "grains.volume_fraction={volume_fraction} drive.width={width} run.periods={periods} initial.state={state} \
         drive.strain_rate=0.1 tube.waves=10"
    );
    run(kernel, "frictionless-fine", &settings, seed)
}

/// The coarse lattice at strain rate 0.05: a period lasts 20, N = 203.
fn coarse(kernel: Kernel, width: f64, periods: u32, seed: u64) -> Outcome {
    let settings = format!(
        "drive.width={width} run.periods={periods} drive.strain_rate=0.05 initial.state=rest"
    );
    run(kernel, "frictionless", &settings, seed)
}

fn late(outcome: &Outcome) -> f64 {
    outcome.summary.flow_rate_ratio.0
}

#[track_caller]
fn transition(outcome: &Outcome) -> f64 {
    let time = outcome.summary.transition_time;
    time.unwrap_or_else(|| panic!("no transition: {:?}", outcome.averages))
}

/// The fine lattice is tight, and the ledger closes to the order of the step.
#[track_caller]
fn sound(outcome: &Outcome) {
    assert_eq!(outcome.summary.escaped_most, 0);
    // Largest of 78 runs: 2.2e-3.
    assert!(
        outcome.summary.energy_residual < 5e-3,
        "{}",
        outcome.summary.energy_residual
    );
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    if values.len() % 2 == 1 {
        values[middle]
    } else {
        0.5 * (values[middle - 1] + values[middle])
    }
}

#[test]
fn a_narrow_tube_jams_soon() {
    on_both_kernels(|kernel| {
        for seed in [1, 2] {
            let outcome = fine(kernel, 2.5, 100, "rest", seed);
            sound(&outcome);
            // 60.0 (55.2 to 65.3; 6), asked for: 50 to 100.
            within(transition(&outcome), 50.0, 75.0);
            // 0.9971 (0.9946 to 0.9987; 6), asked for: above 0.99.
            within(late(&outcome), 0.99, 1.001);
        }
    });
}

#[test]
fn a_wider_tube_jams_late() {
    on_both_kernels(|kernel| {
        let outcome = fine(kernel, 2.7, 100, "rest", 1);
        sound(&outcome);
        // 683 (618 to 741; 12), standard deviation 36.
        within(transition(&outcome), 500.0, 870.0);
        // Long before it, slow and slowly growing flow: 0.13 in period 20 (0.12 to 0.14; 12).
        within(outcome.averages[19], 0.1, 0.16);
    });
}

#[test]
#[ignore = "long: run by just full-check"]
fn the_median_transition_of_a_wider_tube() {
    on_both_kernels(|kernel| {
        let outcomes: Vec<Outcome> = (1..=6)
            .map(|seed| fine(kernel, 2.7, 400, "rest", seed))
            .collect();
        for outcome in &outcomes {
            sound(outcome);
            // 0.9970 (0.9965 to 0.9974; 6); after 200 periods it is still 0.987 (0.983 to 0.991; 12).
            within(late(outcome), 0.99, 1.001);
        }
        // Median 685 of 12 seeds, asked for: 500 to 950.
        within(
            median(outcomes.iter().map(transition).collect()),
            600.0,
            780.0,
        );
    });
}

#[test]
fn a_wide_tube_does_not_jam() {
    on_both_kernels(|kernel| {
        let outcome = fine(kernel, 2.9, 100, "rest", 1);
        sound(&outcome);
        assert_eq!(outcome.summary.transition_time, None);
        // 0.0557 (0.0526 to 0.0611; 6): it grows slowly, to 0.100 after 400 periods and 0.109 after 1000.
        within(late(&outcome), 0.03, 0.09);
    });
}

#[test]
#[ignore = "long: run by just full-check"]
fn a_wide_tube_does_not_jam_within_four_hundred_periods() {
    on_both_kernels(|kernel| {
        for seed in 1..=6 {
            let outcome = fine(kernel, 2.9, 400, "rest", seed);
            sound(&outcome);
            assert_eq!(outcome.summary.transition_time, None);
            // 0.0998 (0.0971 to 0.1043; 6), asked for: below 0.15.
            within(late(&outcome), 0.08, 0.12);
        }
    });
}

#[test]
fn a_jammed_flow_stays_jammed_where_none_would_arise() {
    on_both_kernels(|kernel| {
        let outcome = fine(kernel, 2.8, 100, "jammed", 1);
        sound(&outcome);
        assert_eq!(outcome.summary.transition_time, None);
        // 0.9988 (0.9987 to 0.9989; 6), asked for: above 0.97; at no time below it.
        within(late(&outcome), 0.995, 1.001);
        assert!(outcome.averages.iter().all(|average| *average > 0.97));
    });
}

#[test]
#[ignore = "long: run by just full-check"]
fn a_jammed_flow_stays_jammed_for_four_hundred_periods() {
    on_both_kernels(|kernel| {
        for seed in 1..=6 {
            let outcome = fine(kernel, 2.8, 400, "jammed", seed);
            sound(&outcome);
            // 0.9986 (0.9984 to 0.9987; 6).
            within(late(&outcome), 0.995, 1.001);
            assert!(outcome.averages.iter().all(|average| *average > 0.97));
        }
    });
}

#[test]
fn more_grains_flow_more_slowly_once_jammed() {
    on_both_kernels(|kernel| {
        // 0.992 (0.989 to 0.994; 6), 0.944 (0.940 to 0.948; 6), 0.860 (0.853 to 0.864; 6) after 100 periods; before some 50
        // periods the thinnest has not settled yet. The densest has 0.847 (0.846 to 0.848; 3) after 40.
        let thin = dense(kernel, 0.15, 2.6, 100, "rest", 1);
        let middle = dense(kernel, 0.3, 2.6, 100, "rest", 1);
        let thick = dense(kernel, 0.6, 2.6, 40, "rest", 1);
        within(late(&thin), 0.98, 1.0);
        within(late(&middle), 0.925, 0.96);
        within(late(&thick), 0.83, 0.865);
        // 157 (130 to 176; 6), 28.7 (28.4 to 29.2; 6), 16.9 (16.6 to 17.3; 6): more grains jam sooner.
        within(transition(&thin), 100.0, 210.0);
        within(transition(&middle), 25.0, 33.0);
        within(transition(&thick), 14.0, 20.0);
    });
}

#[test]
#[ignore = "long: run by just full-check"]
fn more_grains_flow_more_slowly_once_jammed_for_every_seed() {
    on_both_kernels(|kernel| {
        for seed in 1..=6 {
            let [thin, middle, thick] = [0.15, 0.3, 0.6]
                .map(|fraction| late(&dense(kernel, fraction, 2.6, 100, "rest", seed)));
            within(thin, 0.98, 1.0);
            within(middle, 0.93, 0.96);
            within(thick, 0.845, 0.875);
        }
    });
}

#[test]
fn the_coarse_lattice_jams_sooner() {
    on_both_kernels(|kernel| {
        let outcome = coarse(kernel, 2.7, 20, 1);
        // 140 (126 to 148; 6): the middle of the crossing; the first period above 0.5 ends at 140 or 160.
        within(transition(&outcome), 110.0, 180.0);
        // 0.789 (0.764 to 0.818; 6) after 20 periods, still rising: 0.838 (0.801 to 0.862; 6) after 40. A few grains leak.
        within(late(&outcome), 0.7, 0.88);
        assert!(outcome.summary.escaped_most <= 6);
    });
}

#[test]
fn the_coarse_lattice_lets_a_wide_tube_stand() {
    on_both_kernels(|kernel| {
        let outcome = coarse(kernel, 2.9, 40, 1);
        assert_eq!(outcome.summary.transition_time, None);
        assert_eq!(outcome.summary.escaped_most, 0);
        // -0.008 (-0.017 to -0.003; 6).
        within(late(&outcome), -0.05, 0.04);
    });
}

#[test]
#[ignore = "long: run by just full-check"]
fn the_coarse_lattice_for_every_seed() {
    on_both_kernels(|kernel| {
        let outcomes: Vec<Outcome> = (1..=6).map(|seed| coarse(kernel, 2.7, 40, seed)).collect();
        within(
            median(outcomes.iter().map(transition).collect()),
            125.0,
            160.0,
        );
        for outcome in &outcomes {
            within(late(outcome), 0.77, 0.9);
        }
        for seed in 1..=6 {
            let outcome = coarse(kernel, 2.9, 200, seed);
            assert_eq!(outcome.summary.transition_time, None);
            // -0.0025 (-0.0040 to -0.0005; 6).
            within(late(&outcome), -0.02, 0.015);
        }
    });
}
