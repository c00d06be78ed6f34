//! Q15 on rows whose answer is known.

#![allow(missing_docs)]
#![expect(clippy::unwrap_used, reason = "a test may")]

mod rows;

use peristalsis_reproduce::{Finding, Verdict};

use rows::{Rows, assert_says, assert_verdict, evidence, value};

const RUN: [(&str, f64); 6] = [
    ("time", 100.0),
    ("radius", 7.5),
    ("wavelength", 30.0),
    ("waves", 1.0),
    ("strain_rate", 0.0),
    ("body_force", 2.5e-4),
];

/// Runs at some values of a column; the rate with an error of a hundredth, and the mass in the tube.
fn runs(column: &str, values: &[f64], replicates: i32, rate: impl Fn(f64, i32) -> f64) -> Rows {
    let mut rows = Rows::with(&RUN);
    for &at in values {
        for replicate in 0..replicates {
            let flow = rate(at, replicate);
            rows.add(
                &[("initial_state", "rest")],
                &[
                    (column, at),
                    ("discharge_rate", flow),
                    ("discharge_rate_error", 0.01 * flow),
                    ("discharged", 100.0 * flow + 10.0),
                    ("hold_up", if flow < at { 2000.0 } else { 100.0 }),
                    ("hold_up_error", 1.0),
                ],
            );
        }
    }
    rows
}

/// A silo of this k and exponent, which arches stop below 3.2, and which takes a feed up to 1.
fn silo(offset: f64, exponent: f64, replicates: i32, head: f64) -> Finding {
    let widths = [3.0, 3.5, 4.0, 5.0, 5.5, 6.0, 6.5, 7.0, 8.0];
    let outlets = runs("width", &widths, replicates, |width, replicate| {
        let outlet = width - 1.0;
        let flow = 0.02 * (outlet - offset).powf(exponent);
        // Errors that no fit must follow.
        let error = 1.0 + 0.01 * f64::from(replicate - 1);
        if outlet < 3.2 && replicate == 0 {
            0.0
        } else {
            flow * error
        }
    });
    let heads = runs(
        "inlet.head",
        &[9.0, 15.0, 16.0, 20.0],
        replicates,
        |filling, _| {
            if filling < 10.0 {
                0.5
            } else {
                0.8 + head * filling
            }
        },
    );
    let feeds = runs(
        "inlet.feed_rate",
        &[0.4, 0.8, 1.2],
        replicates,
        |feed, _| {
            if feed < 1.0 { feed } else { 0.7 }
        },
    );
    let evidence = evidence(&[
        ("silo", &outlets),
        ("silo-head", &heads),
        ("silo-feed", &feeds),
    ]);
    rows::examine("Q15", &evidence)
}

#[test]
fn the_law_of_a_silo_is_found_again() {
    for (offset, exponent) in [(1.4, 2.5), (0.8, 2.0)] {
        let finding = silo(offset, exponent, 3, 0.0);
        assert_verdict(&finding, Verdict::Answered);
        let found = value(&finding, "exponent");
        assert!((found - exponent).abs() < 0.1, "{found}");
        if exponent == 2.5 {
            assert!((value(&finding, "*k* with") - offset).abs() < 0.03);
        }
        // One of three stopped: the mass of all in the half in which it did, over one arch.
        let rate = |outlet: f64| 0.02 * (outlet - offset).powf(exponent);
        let mass = |outlet: f64| 30.0 + 50.0 * rate(outlet) * 2.01;
        let found = value(&finding, "outlet 3.00");
        assert!((found - mass(3.0)).abs() < 0.5, "{found}");
        assert_says(&finding.summary, "at 3.00 *d*");
        assert_says(&finding.summary, "agree within errors");
        assert_says(&finding.summary, "8 *d* gives 38 ");
        assert_says(&finding.summary, "rate is 0.700 ± 0.004: a drop");
        assert_eq!((finding.tables.len(), finding.figures.len()), (4, 1));
    }
}

#[test]
fn a_rate_that_grows_with_the_filling_is_told() {
    let finding = silo(1.4, 2.5, 3, 0.01);
    assert_says(&finding.summary, "differ by more than their errors");
}

#[test]
fn one_run_of_each_outlet_decides_nothing() {
    assert_verdict(&silo(1.4, 2.5, 1, 0.0), Verdict::Open);
}
