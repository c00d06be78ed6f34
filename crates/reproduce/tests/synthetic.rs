//! Claims on runs whose law is known: the verdict must follow it, whichever way it goes.

#![allow(missing_docs)]
#![expect(clippy::unwrap_used, reason = "a test may")]

mod rows;

use peristalsis_reproduce::{CLAIMS, Evidence, Finding, Lattice, STUDIES, Size, Start, Verdict};
use peristalsis_study::Specification;

use rows::{Rows, assert_verdict, examine, value};

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

    fn run(self, rows: &mut Rows, start: Start, rate: f64, width: f64, replicate: i64) {
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
        let (start, jams) = match start {
            Start::Rest => ("rest", distance > 0.0),
            Start::Jammed => ("jammed", distance + self.hysteresis > 0.0),
        };
        let slow = 0.3 - 0.2 * (width - self.critical(rate));
        let flow = slow + if jams { self.jump } else { 0.0 } + 0.002 * normal(replicate);
        let columns = (1..=9).map(|place| format!("transition_time_{}", 10 * place));
        let columns: Vec<String> = columns.collect();
        let mut numbers = vec![
            ("width", width),
            ("strain_rate", rate),
            ("time", time),
            ("flow_rate_ratio", flow),
            ("transition_time", tau),
            ("replicate", replicate as f64),
        ];
        numbers.extend(columns.iter().map(|column| (column.as_str(), tau)));
        rows.add(&[("initial_state", start)], &numbers);
    }

    /// Twelve widths about the critical one.
    fn divergence(self, lattice: Lattice) -> Rows {
        let mut rows = tubes(lattice);
        for rate in RATES {
            for distance in [
                0.3, 0.2, 0.14, 0.1, 0.07, 0.05, 0.035, 0.025, 0.018, 0.012, -0.01, -0.04,
            ] {
                let width = self.critical(rate) - distance;
                for replicate in 0..REPLICATES {
                    self.run(&mut rows, Start::Rest, rate, width, replicate);
                }
            }
        }
        rows
    }

    /// A grid of widths from both starts.
    fn branches(self, lattice: Lattice) -> Rows {
        let mut rows = tubes(lattice);
        for rate in RATES {
            for place in -14..=14 {
                // No width is the critical one itself.
                let width = self.critical(rate) + 0.02 * f64::from(place) + 0.003;
                for start in [Start::Rest, Start::Jammed] {
                    for replicate in 0..10 {
                        self.run(&mut rows, start, rate, width, replicate);
                    }
                }
            }
        }
        rows
    }

    fn on(self, lattice: Lattice, name: &str, evidence: &mut Evidence) {
        let (divergence, branches) = (self.divergence(lattice), self.branches(lattice));
        for (study, rows) in [("divergence", divergence), ("branches", branches)] {
            let study = format!("{study}-{name}");
            evidence.add_table(&study, rows.table()).unwrap();
        }
    }

    fn evidence(self) -> Evidence {
        let mut evidence = rows::evidence(&[]);
        self.on(Lattice::FINE, "fine", &mut evidence);
        self.on(Lattice::COARSE, "coarse", &mut evidence);
        evidence
    }
}

/// No runs yet, of tubes with this wall.
fn tubes(lattice: Lattice) -> Rows {
    Rows::with(&[
        ("spheres_per_ring", lattice.spheres_per_ring as f64),
        ("rings_per_wave", lattice.rings_per_wave as f64),
        ("volume_fraction", 0.15),
        ("grains", 203.0),
        ("radius", 1.5),
        ("wavelength", 10.0),
        ("waves", 10.0),
        ("flow_rate_ratio_error", 0.002),
        ("flow_rate_ratio_drift", 0.0),
        ("transition_threshold", 0.5),
    ])
}

fn find(id: &str, tube: Tube) -> Finding {
    examine(id, &tube.evidence())
}

#[test]
fn every_claim_is_open_without_runs_and_needs_known_studies_only() {
    for claim in CLAIMS {
        let finding = examine(claim.id, &rows::evidence(&[]));
        assert_eq!(finding.verdict, Verdict::Open, "{}", claim.id);
        for study in claim.studies {
            assert!(STUDIES.iter().any(|known| known.name == *study), "{study}");
        }
    }
}

#[test]
fn one_lattice_alone_is_examined() {
    let mut evidence = rows::evidence(&[]);
    SOURCE.on(Lattice::FINE, "fine", &mut evidence);
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
            assert!(!specification.plan().runs().is_empty());
        }
    }
}

/// Each claim on a tube that does as the source says, and on one that does not.
#[test]
fn verdicts_follow_the_law_of_the_tube() {
    let other = |id| {
        let mut tube = SOURCE;
        match id {
            "F1" => tube.jump = 0.4,
            "F2" => tube.alpha = 2.0,
            "F6" => tube.jump = 0.0,
            "F7" => tube.slope = 2.0,
            _ => tube.hysteresis = 0.0,
        }
        tube
    };
    for id in ["F1", "F2", "F6", "F7", "F9"] {
        let as_said = find(id, SOURCE);
        assert_eq!(
            as_said.verdict,
            Verdict::Reproduced,
            "{id}: {}",
            as_said.summary
        );
        let differs = find(id, other(id));
        assert_eq!(
            differs.verdict,
            Verdict::Differs,
            "{id}: {}",
            differs.summary
        );
    }
    let scatter = find("F4", SOURCE);
    assert_verdict(&scatter, Verdict::Reproduced);
    let steeper = find("F2", other("F2"));
    assert!((value(&steeper, "fine lattice") - 2.0).abs() < 0.2);
}

/// Claim, name of the quantity, its value by the law of the tube, and how near it must come.
#[test]
fn the_numbers_of_the_tube_are_found() {
    for (id, name, law, within) in [
        ("F2", "fine lattice", 1.0, 0.1),
        // chi/tau^2 ~ 1/(w_c - w): beta = 2 alpha + 1.
        ("F4", "variance of the transition time, fine", 3.0, 0.4),
        ("F6", "fine lattice, mean", 0.7, 0.03),
        (
            "F7",
            "slope of the critical width, fine lattice, div",
            -3.75,
            0.2,
        ),
        (
            "F9",
            "width of the loop, fine lattice, strain rate 0.1",
            0.1,
            0.03,
        ),
    ] {
        let found = value(&find(id, SOURCE), name);
        assert!((found - law).abs() < within, "{id}: {found}");
    }
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
