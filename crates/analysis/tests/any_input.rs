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

/// Runs at up to six widths, at times over eight orders of magnitude, one of them odd at times.
fn runs() -> impl Strategy<Value = (Vec<f64>, Vec<Transition>)> {
    let rows = prop::collection::vec((0_u8..6, -8.0..8.0_f64, any::<bool>()), 0..25);
    let spacing = prop_oneof![1 => Just(0.0), 3 => Just(0.1), 1 => Just(1e-9), 1 => Just(1e8)];
    let odd = prop_oneof![Just(f64::NAN), Just(f64::INFINITY), Just(-1.0), Just(0.0)];
    (rows, spacing, prop::option::weighted(0.3, odd)).prop_map(|(rows, spacing, odd)| {
        let width = rows
            .iter()
            .map(|row| 2.0 + spacing * f64::from(row.0))
            .collect();
        let runs = rows.iter().map(|row| Transition::new(row.1.exp(), row.2));
        let mut runs: Vec<Transition> = runs.collect();
        if let (Some(time), Some(last)) = (odd, runs.last_mut()) {
            *last = Transition::new(time, time == 0.0);
        }
        (width, runs)
    })
}

/// Whether numbers are finite and lie in their own intervals.
fn is_whole(numbers: &[Uncertain]) -> bool {
    numbers.iter().all(|number| {
        let inside = number.interval_68.contains(number.value);
        number.value.is_finite() && inside && number.interval_95.contains(number.value)
    })
}

const FEW: Bootstrap = Bootstrap::new(20, 1);

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn fits_to_runs_are_finite((width, runs) in runs()) {
        let is_odd = |run: &Transition| {
            let (time, observed) = run.time();
            !time.is_finite() || time < 0.0 || (observed && time == 0.0)
        };
        for family in [Family::Exponential, Family::Gamma, Family::Weibull] {
            if let Ok(fit) = fit_lifetime(family, &runs) {
                prop_assert!(!runs.iter().any(is_odd));
                let numbers = [fit.mean, fit.variance, fit.shape.unwrap_or(fit.mean)];
                prop_assert!(is_whole(&numbers), "{:?}", fit);
                for number in numbers {
                    prop_assert!(number.value > 0.0 && number.error > 0.0 && number.error.is_finite());
                    prop_assert!(number.interval_95.lower <= number.interval_68.lower * 1.001);
                }
            }
        }
        for law in [Law::Power, Law::Barrier { power: 1.0 }, Law::Exponential] {
            for family in [Family::Exponential, Family::Weibull] {
                if let Ok(fit) = fit_law_to_runs(law, family, &width, &runs) {
                    prop_assert!(fit.log_likelihood.is_finite() && fit.exponent.value.is_finite());
                    let intervals = [Some(fit.exponent), fit.critical_width].into_iter().flatten();
                    for number in intervals {
                        prop_assert!(number.interval_95.contains(number.value), "{:?}", fit);
                    }
                }
            }
        }
        if let Ok(fit) = fit_law_with_scatter(&width, &runs) {
            prop_assert!(fit.exponent.error.is_finite() && fit.log_likelihood.is_finite());
            prop_assert!(fit.critical_width.interval_95.contains(fit.critical_width.value));
        }
    }

    #[test]
    fn fits_to_points_are_finite(
        points in prop::collection::vec((2.0..3.0_f64, -3.0..6.0_f64, -4.0..2.0_f64), 0..9),
        known in prop::option::of((1.5..3.5_f64, prop_oneof![Just(0.0), 0.001..0.5_f64])),
        equal in any::<bool>(),
        odd in prop::option::of(any::<f64>()),
    ) {
        let width: Vec<f64> = points.iter().map(|p| if equal { 2.5 } else { p.0 }).collect();
        let mut value: Vec<f64> = points.iter().map(|p| p.1.exp()).collect();
        let error: Vec<f64> = points.iter().map(|p| (p.1 + p.2).exp()).collect();
        if let (Some(odd), Some(last)) = (odd, value.last_mut()) {
            *last = odd;
        }
        let known = known.map(|(value, error)| Uncertain::normal(value, error));
        for law in [Law::Power, Law::Barrier { power: 1.0 }, Law::Exponential] {
            if let Ok(fit) = fit_law(law, &width, &value, &error, known) {
                prop_assert!(fit.exponent.value.is_finite() && fit.exponent.error >= 0.0);
                prop_assert!(fit.exponent.interval_68.contains(fit.exponent.value));
                if let Some(critical) = fit.critical_width {
                    prop_assert!(critical.interval_95.contains(critical.value));
                }
            }
        }
    }

    #[test]
    fn a_fraction_crosses_within_its_interval(
        rows in prop::collection::vec((0_u8..6, any::<bool>()), 0..30),
        spacing in prop_oneof![Just(0.1), Just(1e-7), Just(1e9)],
    ) {
        let width: Vec<f64> = rows.iter().map(|row| spacing * f64::from(row.0)).collect();
        let jammed: Vec<bool> = rows.iter().map(|row| row.1).collect();
        if let Ok(found) = fraction_crossing(&width, &jammed) {
            prop_assert!(found.width.interval_95.contains(found.width.value));
            prop_assert!(found.log_likelihood <= 1e-12);
        }
    }

    #[test]
    fn estimators_of_transition_times(rows in table(), horizon in number()) {
        let width: Vec<f64> = rows.iter().map(|row| row.0).collect();
        let runs = rows.iter().map(|row| Transition::new(row.1, row.3));
        let runs: Vec<Transition> = runs.collect();
        if let Ok(survival) = Survival::new(&runs) {
            let _ = survival.median();
            let _ = survival.restricted_mean(horizon);
            let _ = survival.at(horizon);
        }
        let _ = restricted_moments(&runs, horizon);
        let _ = fit_shifted_exponential(&runs);
        let families = [Family::Exponential, Family::Gamma, Family::Weibull];
        for family in families {
            let _ = fit_lifetime(family, &runs);
            let _ = ensembles_by_width(family, &width, &runs);
        }
        let laws = [Law::Power, Law::Barrier { power: 2.0 }, Law::Exponential];
        for law in laws {
            for family in [Family::Exponential, Family::Gamma] {
                let _ = fit_law_to_runs(law, family, &width, &runs);
            }
            let _ = fit_law_to_runs_in_windows(law, Family::Exponential, &width, &runs);
        }
        let _ = fit_law_with_scatter(&width, &runs);
        let _ = compare_laws(&laws, Family::Exponential, &width, &runs);
        let _ = compare_laws_with_scatter(&laws, &width, &runs);
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
        let fits = [fit_inverse_line(&x, &y, &errors), fit_inverse_parabola(&x, &y, &errors)];
        for fit in fits.into_iter().flatten() {
            prop_assert!(is_whole(&[fit.critical_width, fit.linear]), "{:?}", fit);
        }
        for known in [None, Some(Uncertain::normal(at, error)), Some(Uncertain::normal(at, 0.0))] {
            for law in [Law::Power, Law::Barrier { power: at }, Law::Exponential] {
                let _ = fit_law_to_nearest(law, &x, &y, &errors, known);
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
        if let Ok(found) = two_peaks(&values) {
            prop_assert!(found.lower.mean <= found.upper.mean);
        }
        if let Ok(found) = histogram(&values, at, 3.0, 5) {
            prop_assert_eq!(found.counts.iter().sum::<usize>() + found.outside, values.len());
        }
        let _ = fraction_crossing(&values, &outcomes);
        let _ = hysteresis((&values, &outcomes), (&values, &others));
        let series: Vec<f64> = rows.iter().flat_map(|row| [row.0, row.1, row.2]).collect();
        let _ = stationary_mean(&series);
        let runs: Vec<&[f64]> = series.chunks(5).collect();
        let _ = second_moment_peak(&runs, AfterEnd::Leave, FEW);
        let _ = second_moment_peak(&runs, AfterEnd::Hold { samples: 2 }, FEW);
    }

    #[test]
    fn collapses(rows in table(), start in number(), step in number(), at in number()) {
        let points: Vec<CurvePoint> = rows
            .iter()
            .map(|&(x, y, error, _)| CurvePoint { x, y, error })
            .collect();
        let curves: Vec<Curve> = points
            .chunks(4)
            .map(|points| Curve { parameter: points[0].error, points: points.to_vec() })
            .collect();
        let scaled: Vec<Vec<CurvePoint>> = points.chunks(4).map(<[_]>::to_vec).collect();
        if let Ok(found) = collapse_quality(&scaled) {
            prop_assert!(found.overlap > 0.0 && found.overlap <= 1.0);
        }
        for (scaling, count) in [
            (Scaling::CriticalLine, 4),
            (Scaling::CriticalEach, 2 + curves.len()),
            (Scaling::FiniteSize, 3),
        ] {
            let transform = |p: &[f64], k: usize, parameter: f64, point| {
                scaling.apply(p, k, parameter, point)
            };
            let collapse = Collapse { curves: &curves, transform: &transform, least_overlap: 0.2 };
            let (start, steps) = (vec![start; count], vec![step; count]);
            if let Ok(found) = collapse.estimate(&[], &start, &steps, 1, 0, Some(1.0)) {
                prop_assert!(found.quality.overlap >= 0.2);
                let _ = collapse.joint_test(&[], &found, &steps, &[(0, start[0]), (1, at)]);
            }
            let known = [(0, Uncertain::normal(at, steps[0]))];
            let _ = collapse.estimate(&known, &start, &steps, 1, 0, None);
        }
    }
}

proptest! {
    #[test]
    fn any_values_are_judged(
        values in prop::collection::vec(prop_oneof![any::<f64>(), 0.0..1.0_f64], 0..30),
    ) {
        if let Ok(found) = two_peaks(&values) {
            prop_assert!(found.lower.mean <= found.upper.mean);
        }
        if let Ok(found) = histogram(&values, -0.5, 0.5, 7) {
            prop_assert_eq!(found.counts.iter().sum::<usize>() + found.outside, values.len());
        }
    }

    #[test]
    fn any_curves_have_a_quality_or_an_error(
        curves in prop::collection::vec(
            prop::collection::vec((any::<f64>(), -1.0..1.0_f64, any::<f64>()), 0..6), 0..5),
    ) {
        let point = |&(x, y, error): &(f64, f64, f64)| CurvePoint { x, y, error };
        let curves: Vec<Vec<CurvePoint>> =
            curves.iter().map(|curve| curve.iter().map(point).collect()).collect();
        if let Ok(found) = collapse_quality(&curves) {
            prop_assert!(found.overlap > 0.0 && found.overlap <= 1.0);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn curves_that_may_collapse_give_a_fit_or_an_error(
        curves in prop::collection::vec(
            (0.01..1.0_f64, prop::collection::vec((2.0..3.0_f64, -1.0..9.0_f64), 0..6)), 0..4),
    ) {
        let point = |&(x, y): &(f64, f64)| CurvePoint { x, y, error: 0.2 };
        let curves: Vec<Curve> = curves
            .iter()
            .map(|(parameter, points)| Curve {
                parameter: *parameter,
                points: points.iter().map(point).collect(),
            })
            .collect();
        let transform = |p: &[f64], k: usize, rate: f64, point| {
            Scaling::CriticalLine.apply(p, k, rate, point)
        };
        let collapse = Collapse { curves: &curves, transform: &transform, least_overlap: 0.3 };
        let steps = [0.3, 0.3, 0.3, 0.1];
        if let Ok(found) = collapse.estimate(&[], &[1.0, 1.0, 0.0, 3.1], &steps, 1, 0, None) {
            prop_assert!(found.stretch >= 1.0 && found.quality.overlap >= 0.3);
        }
    }
}
