//! Every estimator answers any input with an answer or an error, never with a panic or without end.

use peristalsis_analysis::*;
use proptest::prelude::*;

/// Numbers that are not numbers, infinite, subnormal, huge, equal, negative and plain.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => 0.1..5.0_f64,
        2 => prop_oneof![Just(2.5), Just(2.6), Just(2.7), Just(1.0)],
        1 => any::<f64>(),
        1 => prop_oneof![
            Just(f64::NAN), Just(f64::INFINITY), Just(f64::NEG_INFINITY), Just(0.0), Just(-0.0),
            Just(f64::MIN_POSITIVE), Just(5e-324), Just(f64::MAX), Just(f64::MIN), Just(1e-160), Just(1e160),
        ],
    ]
}

/// Numbers that pass the checks and strain the arithmetic.
fn extreme() -> impl Strategy<Value = f64> {
    prop_oneof![
        6 => 0.1..5.0_f64,
        2 => prop_oneof![Just(2.5), Just(2.6), Just(2.7)],
        1 => prop_oneof![Just(1e-300), Just(1e300), Just(1e-160), Just(1e160), Just(5e-324), Just(f64::MAX)],
    ]
}

fn table() -> impl Strategy<Value = Vec<(f64, f64, f64, bool)>> {
    let row = |_: ()| (number(), number(), number(), any::<bool>());
    let strained = (extreme(), extreme(), extreme(), any::<bool>());
    prop_oneof![
        prop::collection::vec(row(()), 0..14),
        prop::collection::vec(strained, 0..14),
    ]
}

const FEW: Bootstrap = Bootstrap {
    resamples: 20,
    seed: 1,
};

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn estimators_of_transition_times(rows in table(), horizon in number()) {
        let width: Vec<f64> = rows.iter().map(|row| row.0).collect();
        let runs: Vec<Transition> = rows
            .iter()
            .map(|&(_, time, _, observed)| match observed {
                true => Transition::At { time, period: 0 },
                false => Transition::Censored { time },
            })
            .collect();
        if let Ok(survival) = Survival::new(&runs) {
            let _ = survival.median();
            let _ = survival.restricted_mean(horizon);
            let _ = survival.at(horizon);
        }
        let _ = restricted_moments(&runs, horizon);
        let _ = fit_shifted_exponential(&runs);
        let families = [Family::Exponential, Family::Gamma, Family::Weibull];
        for family in families {
            if let Ok(fit) = fit_lifetime(family, &runs) {
                let _ = fit.akaike();
            }
            let _ = ensembles_by_width(family, &width, &runs);
        }
        let laws = [Law::Power, Law::Barrier { power: 2.0 }, Law::Exponential];
        for law in laws {
            for family in [Family::Exponential, Family::Gamma] {
                if let Ok(fit) = fit_law_to_runs(law, family, &width, &runs) {
                    let _ = (fit.mean(horizon), fit.akaike());
                }
            }
            let _ = fit_law_to_runs_in_windows(law, Family::Exponential, &width, &runs);
        }
        let _ = fit_law_with_scatter(&width, &runs);
        let _ = compare_laws(&laws, Family::Exponential, &width, &runs);
    }

    #[test]
    fn estimators_of_points(rows in table(), at in number(), error in number()) {
        let x: Vec<f64> = rows.iter().map(|row| row.0).collect();
        let y: Vec<f64> = rows.iter().map(|row| row.1).collect();
        let errors: Vec<f64> = rows.iter().map(|row| row.2).collect();
        if let Ok(line) = fit_line(&x, &y, &errors) {
            let _ = (line.at(at), line.scale_factor());
            prop_assert!(line.chi_squared.is_finite());
        }
        let _ = fit_parabola(&x, &y, &errors);
        let _ = power_exponent(&x, &y, &errors);
        for known in [None, Some(Uncertain::normal(at, error)), Some(Uncertain::normal(at, 0.0))] {
            for law in [Law::Power, Law::Barrier { power: at }, Law::Exponential] {
                let _ = fit_law(law, &x, &y, &errors, known);
            }
        }
        let half = rows.len() / 2;
        let upper = [&x[..half], &y[..half], &errors[..half]];
        let lower = [&x[half..], &y[half..], &errors[half..]];
        let _ = jump_height(upper, lower, Uncertain::normal(at, error));
    }

    #[test]
    fn estimators_of_samples_and_outcomes(rows in table(), at in number()) {
        let values: Vec<f64> = rows.iter().map(|row| row.0).collect();
        let outcomes: Vec<bool> = rows.iter().map(|row| row.3).collect();
        let others: Vec<bool> = outcomes.iter().map(|outcome| !outcome).collect();
        let _ = dip_test(&values, FEW);
        let _ = two_peaks(&values);
        let _ = histogram(&values, at, 3.0, 5);
        let _ = fraction_crossing(&values, &outcomes);
        let _ = hysteresis((&values, &outcomes), (&values, &others));
        let series: Vec<f64> = rows.iter().flat_map(|row| [row.0, row.1, row.2]).collect();
        let _ = stationary_mean(&series);
        let runs: Vec<&[f64]> = series.chunks(5).collect();
        let _ = second_moment_peak(&runs, AfterEnd::Leave, FEW);
        let _ = second_moment_peak(&runs, AfterEnd::Hold { samples: 2 }, FEW);
    }

    #[test]
    fn collapses(rows in table(), start in number(), step in number()) {
        let points: Vec<CurvePoint> = rows
            .iter()
            .map(|&(x, y, error, _)| CurvePoint { x, y, error })
            .collect();
        let curves: Vec<Curve> = points
            .chunks(4)
            .map(|points| Curve { parameter: points[0].error, points: points.to_vec() })
            .collect();
        for scaling in [Scaling::CriticalLine, Scaling::CriticalEach, Scaling::FiniteSize] {
            let transform = |p: &[f64], k: usize, parameter: f64, point| {
                scaling.apply(p, k, parameter, point)
            };
            let collapse = Collapse { curves: &curves, transform: &transform, least_overlap: 0.2 };
            let count = scaling.parameters(curves.len());
            let (start, steps) = (vec![start; count], vec![step; count]);
            if let Ok(fit) = collapse.fit(&start, &steps, 1, 0) {
                let _ = collapse.contour(&fit, &steps);
                let _ = collapse.bootstrap(&fit, &steps, FEW);
            }
            let _ = collapse.leave_one_out(&start, &steps, 1, 0);
        }
    }
}
