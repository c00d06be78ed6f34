//! Claims on runs whose law is known: the verdict must follow it, whichever way it goes.

#![allow(missing_docs)]
#![expect(clippy::unwrap_used, reason = "a test may")]

use peristalsis_reproduce::{
    CLAIMS, Claim, Evidence, Finding, Lattice, Run, STUDIES, Size, Start, Verdict,
};
use peristalsis_run::THRESHOLDS;
use peristalsis_study::{Plan, Specification};

/// A tube whose transition times and branches follow given laws.
#[derive(Clone, Copy)]
struct Tube {
    /// w_c = 3 - slope epsdot.
    slope: f64,
    /// tau = epsdot^(-2) (w_c - w)^-alpha/2 with a relative standard deviation that grows toward w_c.
    alpha: f64,
    /// Height of the jump at w_c.
    jump: f64,
    /// Distance of w_c' from w_c.
    hysteresis: f64,
}

/// The tube of the source.
const SOURCE: Tube = Tube {
    slope: 3.75,
    alpha: 1.0,
    jump: 0.7,
    hysteresis: 0.1,
};

const RATES: [f64; 5] = [0.03, 0.05, 0.07, 0.1, 0.14];
const REPLICATES: i64 = 30;

/// Quantiles of a normal distribution in a scrambled order, the same numbers each time.
fn normal(replicate: i64) -> f64 {
    let place = ((replicate * 7 + 3) % REPLICATES) as f64 + 0.5;
    let uniform = place / REPLICATES as f64;
    // Logistic numbers of variance 1 are near enough.
    (uniform / (1.0 - uniform)).ln() * 3_f64.sqrt() / std::f64::consts::PI
}

impl Tube {
    fn critical(self, rate: f64) -> f64 {
        3.0 - self.slope * rate
    }

    fn run(self, lattice: Lattice, start: Start, rate: f64, width: f64, replicate: i64) -> Run {
        let distance = self.critical(rate) - width;
        let time = 1000.0 / rate;
        let tau = if distance > 0.0 && start == Start::Rest {
            let mean = 0.5 * rate.powi(-2) * distance.powf(-self.alpha) * (1.0 + 0.01 * width);
            let deviation = (0.02 * distance.powf(-0.5)).min(0.4);
            mean * (1.0 + deviation * normal(replicate)).max(0.05)
        } else {
            f64::NAN
        };
        let tau = if tau < time { tau } else { f64::NAN };
        let end = match start {
            Start::Rest => distance > 0.0,
            Start::Jammed => distance + self.hysteresis > 0.0,
        };
        let slow = 0.3 - 0.2 * (width - self.critical(rate));
        Run {
            identity: String::new(),
            start,
            lattice,
            width,
            strain_rate: rate,
            volume_fraction: 0.15,
            grains: 203,
            radius: 1.5,
            wavelength: 10.0,
            waves: 10,
            time,
            flow_rate_ratio: slow + if end { self.jump } else { 0.0 } + 0.002 * normal(replicate),
            flow_rate_ratio_error: 0.002,
            flow_rate_ratio_drift: 0.0,
            escaped: 0,
            transition_time: tau,
            transition_threshold: 0.5,
            transition_times: [tau; THRESHOLDS.len()],
            replicate,
            axes: Vec::new(),
        }
    }

    /// Twelve widths about the critical one.
    fn divergence(self, lattice: Lattice) -> Vec<Run> {
        let mut runs = Vec::new();
        for rate in RATES {
            for distance in [
                0.3, 0.2, 0.14, 0.1, 0.07, 0.05, 0.035, 0.025, 0.018, 0.012, -0.01, -0.04,
            ] {
                let width = self.critical(rate) - distance;
                for replicate in 0..REPLICATES {
                    runs.push(self.run(lattice, Start::Rest, rate, width, replicate));
                }
            }
        }
        runs
    }

    /// A grid of widths from both starts.
    fn branches(self, lattice: Lattice) -> Vec<Run> {
        let mut runs = Vec::new();
        for rate in RATES {
            for place in -14..=14 {
                // No width is the critical one itself.
                let width = self.critical(rate) + 0.02 * f64::from(place) + 0.003;
                for start in [Start::Rest, Start::Jammed] {
                    for replicate in 0..10 {
                        runs.push(self.run(lattice, start, rate, width, replicate));
                    }
                }
            }
        }
        runs
    }

    fn evidence(self) -> Evidence {
        let mut evidence = empty();
        for (lattice, name) in [(Lattice::FINE, "fine"), (Lattice::COARSE, "coarse")] {
            evidence.add_runs(&format!("divergence-{name}"), self.divergence(lattice));
            evidence.add_runs(&format!("branches-{name}"), self.branches(lattice));
        }
        evidence
    }
}

/// Every study, without a run.
fn empty() -> Evidence {
    let mut evidence = Evidence::default();
    for study in STUDIES {
        evidence.add_runs(study.name, Vec::new());
    }
    evidence
}

fn claim(id: &str) -> &'static Claim {
    CLAIMS.iter().find(|claim| claim.id == id).unwrap()
}

fn find(id: &str, tube: Tube) -> Finding {
    (claim(id).examine)(&tube.evidence()).unwrap()
}

fn value(finding: &Finding, name: &str) -> f64 {
    let found = finding
        .quantities
        .iter()
        .find(|one| one.name.contains(name));
    found.unwrap().ours.unwrap().value
}

#[test]
fn every_claim_is_open_without_runs_and_needs_known_studies_only() {
    for claim in CLAIMS {
        let finding = (claim.examine)(&empty()).unwrap();
        assert_eq!(finding.verdict, Verdict::Open, "{}", claim.id);
        for study in claim.studies {
            assert!(STUDIES.iter().any(|known| known.name == *study), "{study}");
        }
    }
}

#[test]
fn one_lattice_alone_is_examined() {
    let mut evidence = empty();
    evidence.add_runs("divergence-fine", SOURCE.divergence(Lattice::FINE));
    evidence.add_runs("branches-fine", SOURCE.branches(Lattice::FINE));
    for claim in CLAIMS {
        let finding = (claim.examine)(&evidence).unwrap();
        assert!(!finding.summary.is_empty(), "{}", claim.id);
    }
}

#[test]
fn every_study_file_is_valid_and_named_for_itself() {
    for study in STUDIES {
        for size in [Size::Quick, Size::Full] {
            let specification =
                Specification::from_toml(study.path, study.text(size), |_| unreachable!()).unwrap();
            assert_eq!(specification.name, study.name);
            assert!(!Plan::of(&specification).unwrap().runs().is_empty());
        }
    }
}

#[test]
fn the_divergence_is_judged_by_its_exponent() {
    let as_said = find("F2", SOURCE);
    assert_eq!(as_said.verdict, Verdict::Reproduced, "{}", as_said.summary);
    assert!((value(&as_said, "fine lattice") - 1.0).abs() < 0.1);
    let steeper = find(
        "F2",
        Tube {
            alpha: 2.0,
            ..SOURCE
        },
    );
    assert_eq!(steeper.verdict, Verdict::Differs, "{}", steeper.summary);
    assert!((value(&steeper, "fine lattice") - 2.0).abs() < 0.2);
}

#[test]
fn a_collapse_finds_the_powers_of_the_strain_rate() {
    // tau = epsdot^-2 (w_c - w)^-1 = epsdot^(-a) ((w_c - w)/epsdot^b)^-1 for a - b = 2.
    let finding = find("F3", SOURCE);
    let [a, b] =
        ["in the ordinate, fine", "in the distance, fine"].map(|name| value(&finding, name));
    assert!((a - b - 2.0).abs() < 0.15, "{a} {b}");
    assert!(!finding.figures.is_empty());
}

#[test]
fn the_scatter_is_judged_by_its_exponent() {
    // chi/tau^2 ~ 1/(w_c - w): beta = 2 alpha + 1.
    let finding = find("F4", SOURCE);
    assert_eq!(finding.verdict, Verdict::Reproduced, "{}", finding.summary);
    assert!((value(&finding, "variance of the transition time, fine") - 3.0).abs() < 0.4);
}

#[test]
fn a_jump_is_told_from_a_slope() {
    let jump = find("F6", SOURCE);
    assert_eq!(jump.verdict, Verdict::Reproduced, "{}", jump.summary);
    assert!((value(&jump, "fine lattice, mean") - 0.7).abs() < 0.03);
    let none = find(
        "F6",
        Tube {
            jump: 0.0,
            ..SOURCE
        },
    );
    assert_eq!(none.verdict, Verdict::Differs, "{}", none.summary);
}

#[test]
fn the_slope_of_the_critical_width_is_found() {
    let finding = find("F7", SOURCE);
    assert_eq!(finding.verdict, Verdict::Reproduced, "{}", finding.summary);
    assert!((value(&finding, "slope of the critical width, fine lattice, div") + 3.75).abs() < 0.2);
    let flatter = find(
        "F7",
        Tube {
            slope: 2.0,
            ..SOURCE
        },
    );
    assert_eq!(flatter.verdict, Verdict::Differs, "{}", flatter.summary);
}

#[test]
fn a_loop_is_seen_and_its_absence_too() {
    let finding = find("F9", SOURCE);
    assert_eq!(finding.verdict, Verdict::Reproduced, "{}", finding.summary);
    assert!(
        (value(&finding, "width of the loop, fine lattice, strain rate 0.1") - 0.1).abs() < 0.03
    );
    let none = find(
        "F9",
        Tube {
            hysteresis: 0.0,
            ..SOURCE
        },
    );
    assert_eq!(none.verdict, Verdict::Differs, "{}", none.summary);
}

#[test]
fn two_kinds_of_flow_are_told_apart() {
    let finding = find("F1", SOURCE);
    assert_eq!(finding.verdict, Verdict::Reproduced, "{}", finding.summary);
    let slower = find(
        "F1",
        Tube {
            jump: 0.4,
            ..SOURCE
        },
    );
    assert_eq!(slower.verdict, Verdict::Differs, "{}", slower.summary);
}
