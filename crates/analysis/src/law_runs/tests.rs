use super::*;
use crate::bootstrap::Randomness;
use crate::tests::{Coverage, assert_coverage, exponential, runs_at};

const WIDTHS: [f64; 9] = [2.4, 2.5, 2.6, 2.65, 2.7, 2.75, 2.78, 2.81, 2.85];

/// tau = 10 (2.8 - w)^-1, watched for 300 in most tests: all censored at 2.81 and 2.85, a third or so at 2.75 and more
/// at 2.78.
fn runs(
    seed: u64,
    replicates: usize,
    until: f64,
    draw: impl Fn(&mut Randomness) -> f64,
) -> (Vec<f64>, Vec<Transition>) {
    let mut randomness = Randomness::new(seed, 3);
    runs_at(&WIDTHS, replicates, until, |place| match place < 2.8 {
        true => 10.0 / (2.8 - place) * draw(&mut randomness),
        false => f64::INFINITY * draw(&mut randomness),
    })
}

#[test]
fn profile_intervals_of_critical_width_and_exponent_cover() {
    let mut coverage = Coverage::of([("w_c", 2.8), ("exponent", 1.0)]);
    for seed in 0..200 {
        let (width, transitions) = runs(seed, 15, 300.0, exponential);
        let fit = fit_law_to_runs(Law::Power, Family::Exponential, &width, &transitions).unwrap();
        coverage.count([fit.critical_width.unwrap(), fit.exponent]);
    }
    coverage.judge([0.02; 2]);
}

#[test]
fn the_shape_is_found_with_the_law() {
    let sharp = |randomness: &mut Randomness| {
        // Weibull of shape 3 and mean 1.
        libm::pow(exponential(randomness), 1.0 / 3.0) / libm::tgamma(4.0 / 3.0)
    };
    let trials = 24;
    let mut covered = [0; 3];
    for seed in 0..trials {
        let (width, transitions) = runs(seed, 12, 300.0, sharp);
        let fit = fit_law_to_runs(Law::Power, Family::Weibull, &width, &transitions).unwrap();
        covered[0] += usize::from(fit.critical_width.unwrap().interval_95.contains(2.8));
        covered[1] += usize::from(fit.exponent.interval_95.contains(1.0));
        covered[2] += usize::from(fit.shape.unwrap().interval_95.contains(3.0));
    }
    for (covered, what) in covered.into_iter().zip(["w_c", "exponent", "shape"]) {
        assert_coverage(covered, trials as usize, 0.95, 0.01, what);
    }
    let (width, transitions) = runs(1, 12, 300.0, sharp);
    let fit = |family| fit_law_to_runs(Law::Power, family, &width, &transitions).unwrap();
    let (weibull, plain) = (fit(Family::Weibull), fit(Family::Exponential));
    assert!(weibull.log_likelihood > plain.log_likelihood + 11.0);
    assert_eq!(weibull.observed + weibull.censored, 108);
    let distance = weibull.critical_width.unwrap().value - 2.5;
    let mean = weibull.ln_amplitude.exp() * distance.powf(-weibull.exponent.value);
    assert!((mean * 0.3 / 10.0 - 1.0).abs() < 0.25);
}

#[test]
fn the_gamma_family_finds_the_same_critical_width() {
    let steps =
        |randomness: &mut Randomness| (exponential(randomness) + exponential(randomness)) / 2.0;
    let (width, transitions) = runs(4, 20, 300.0, steps);
    let fit = fit_law_to_runs(Law::Power, Family::Gamma, &width, &transitions).unwrap();
    assert!(fit.critical_width.unwrap().interval_95.contains(2.8));
    assert!(fit.exponent.interval_95.contains(1.0));
    assert!(fit.shape.unwrap().interval_95.contains(2.0));
}

#[test]
fn dropping_censored_runs_moves_the_critical_width() {
    let (width, transitions) = runs(11, 60, 300.0, exponential);
    let honest = fit_law_to_runs(Law::Power, Family::Exponential, &width, &transitions).unwrap();
    let observed: Vec<usize> = (0..width.len())
        .filter(|&i| transitions[i].observed().is_some())
        .collect();
    let kept_width: Vec<f64> = observed.iter().map(|&i| width[i]).collect();
    let kept: Vec<Transition> = observed.iter().map(|&i| transitions[i]).collect();
    let naive = fit_law_to_runs(Law::Power, Family::Exponential, &kept_width, &kept);
    assert!(honest.exponent.interval_95.contains(1.0));
    // Without its long runs the growth of tau is gone.
    let naive_critical = naive.map(|fit| fit.critical_width.unwrap().value);
    let is_off = naive_critical.is_err() || naive_critical.unwrap() > 2.84;
    assert!(is_off, "{naive_critical:?}");
}

#[test]
fn windows_begin_with_all_widths_and_agree_where_the_law_holds() {
    let (width, transitions) = runs(2, 30, 300.0, exponential);
    let windows =
        fit_law_to_runs_in_windows(Law::Power, Family::Exponential, &width, &transitions).unwrap();
    assert!(windows.len() > 5);
    assert_eq!((windows[0].least, windows[0].largest), (2.4, 2.85));
    assert_eq!((windows[1].least, windows[1].largest), (2.5, 2.85));
    for window in &windows {
        assert!(window.fit.exponent.interval_95.lower < 1.3, "{window:?}");
    }
}

#[test]
fn what_does_not_determine_a_law_is_refused() {
    let at = |time| Transition::At { time, period: 0 };
    let censored = Transition::Censored { time: 9.0 };
    let fit = |width: &[f64], runs: &[Transition]| {
        fit_law_to_runs(Law::Power, Family::Exponential, width, runs)
    };
    assert_refused!(
        fit(&[2.0, 2.1, 2.2], &[at(1.0), at(2.0), censored]) =>
        TooFewPlaces { needed: 3, found: 2 }
    );
    assert!(fit(&[], &[]).is_err());
    assert!(fit(&[2.0; 4], &[at(1.0); 4]).is_err());
    assert_refused!(fit(&[2.0, 2.1], &[at(1.0)]) => LengthMismatch { .. });
    // Shrinking with the width: w_c at infinity, and B below 0.
    let falling = fit(&[2.0, 2.1, 2.2, 2.3], &[at(8.0), at(4.0), at(2.0), at(1.0)]);
    assert_refused!(falling => Undetermined { .. });
    let equal = fit_law_to_runs(
        Law::Power,
        Family::Weibull,
        &[2.0, 2.1, 2.2],
        &[at(1.0), at(2.0), at(4.0)],
    );
    assert_eq!(equal, Err(Error::NoScatter { observed: 3 }));
}

/// A numerical auditor: in metres the intervals of a barrier's height were others, and with widths of 1e-6 nonsense.
#[test]
fn the_unit_of_the_width_changes_no_interval() {
    let (width, transitions) = runs(4, 12, 300.0, exponential);
    for law in [Law::Exponential, Law::Barrier { power: 3.0 }, Law::Power] {
        let fit = |unit: f64| {
            let width: Vec<f64> = width.iter().map(|width| width * unit).collect();
            fit_law_to_runs(law, Family::Exponential, &width, &transitions).unwrap()
        };
        let plain = fit(1.0).exponent;
        for unit in [2e-3_f64, 1e-6, 1e6] {
            let per_exponent = match law {
                Law::Exponential => 1.0 / unit,
                Law::Barrier { power } => unit.powf(power),
                Law::Power => 1.0,
            };
            let scaled = fit(unit).exponent;
            let is_near = |one: f64, other: f64| {
                one == other || (one / per_exponent / other - 1.0).abs() < 1e-3
            };
            assert!(is_near(scaled.error, plain.error), "{law:?} {unit}");
            for side in [
                |it: &Uncertain| it.interval_95.lower,
                |it: &Uncertain| it.interval_95.upper,
            ] {
                assert!(is_near(side(&scaled), side(&plain)), "{law:?} {unit}");
            }
        }
    }
}
