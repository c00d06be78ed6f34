//! Claims on the stress-controlled tube, on runs whose law is known: the verdict must follow it, whichever way it goes.

#![allow(missing_docs)]
#![expect(clippy::unwrap_used, reason = "a test may")]

use peristalsis_reproduce::{
    CLAIMS, Evidence, Finding, Lattice, Run, STUDIES, Size, Start, Statistics, Verdict,
};
use peristalsis_run::THRESHOLDS;
use peristalsis_study::{Plan, Specification};

/// An elastic tube whose flow follows a given law.
#[derive(Clone, Copy)]
struct Tube {
    /// Strain rate from which on the flow jumps with the force; below it the flow rises in a straight line.
    jumps_from: f64,
    /// J/Jmax of the unjammed flow.
    unjammed: f64,
    /// Force at which the flow from rest jumps, and by how much less that from jammed.
    critical: f64,
    window: f64,
    /// Scatter of J/Jmax over the replicates.
    scatter: f64,
    /// Replicates.
    replicates: i64,
    /// Periods behind the late means, and by how much J/Jmax still drifts.
    late_periods: f64,
    drift: f64,
    /// Mean time in periods until a jam gives way below the critical force; NaN if it never does.
    lifetime: f64,
    /// Axial velocity in the throat over c.
    throat_velocity: f64,
    /// Grains outside, of 1093.
    escaped: i64,
}

/// The tube of the source.
const SOURCE: Tube = Tube {
    jumps_from: 3e-3,
    unjammed: -0.05,
    critical: 0.0052,
    window: 0.001,
    scatter: 0.004,
    replicates: 5,
    late_periods: 50.0,
    drift: 0.0,
    lifetime: 8.0,
    throat_velocity: -0.2,
    escaped: 0,
};

const RATES: [f64; 4] = [1.5e-3, 2.5e-3, 4.01e-3, 5.6e-3];
const FORCES: [f64; 8] = [0.002, 0.003, 0.0035, 0.004, 0.0045, 0.005, 0.0055, 0.0065];
/// Height of the jump.
const JUMP: f64 = 0.8;

/// Numbers of mean 0 and variance 1 in a scrambled order, the same each time.
fn scattered(number: i64, of: i64) -> f64 {
    if of < 2 {
        return 0.0;
    }
    let place = (number * 7 + 3) % of;
    let centred = place as f64 - 0.5 * (of - 1) as f64;
    centred / ((of * of - 1) as f64 / 12.0).sqrt()
}

impl Tube {
    fn flow(self, rate: f64, force: f64, start: Start) -> f64 {
        if rate < self.jumps_from {
            return 160.0 * (force - 0.001);
        }
        let critical = match start {
            Start::Rest => self.critical,
            Start::Jammed => self.critical - self.window,
        };
        self.unjammed + if force > critical { JUMP } else { 0.0 }
    }

    fn run(self, rate: f64, force: f64, start: Start, replicate: i64) -> Run {
        let flow = self.flow(rate, force, start);
        let periods = 16.0 + self.late_periods;
        let noise = scattered(replicate, self.replicates);
        // Quantiles of an exponential distribution: the times of a process without memory.
        let quantile = ((replicate * 7 + 3) % self.replicates) as f64 + 0.5;
        let life = -self.lifetime * (1.0 - quantile / self.replicates as f64).ln();
        let gives_way = start == Start::Jammed && flow < 0.3 && life < periods;
        let transition = if gives_way { life / rate } else { f64::NAN };
        let speed = 20.0 * rate;
        let numbers = [
            ("force_amplitude", force),
            ("late_periods", self.late_periods),
            ("throat_density", 20.0 + noise),
            (
                "throat_axial_velocity",
                (self.throat_velocity + 0.01 * noise) * speed,
            ),
            ("throat_granular_temperature", 0.01 * speed * speed),
            ("belly_density", 40.0),
            ("belly_axial_velocity", 0.01 * noise * speed),
            ("belly_granular_temperature", 0.01 * speed * speed),
        ];
        Run {
            identity: String::new(),
            start,
            lattice: Lattice {
                spheres_per_ring: 22,
                rings_per_wave: 23,
            },
            width: f64::NAN,
            strain_rate: rate,
            volume_fraction: 0.27,
            grains: 1093,
            radius: 3.5,
            wavelength: 20.0,
            waves: 2,
            time: periods / rate,
            flow_rate_ratio: flow + self.scatter * noise,
            flow_rate_ratio_error: self.scatter,
            flow_rate_ratio_drift: self.drift,
            escaped: self.escaped,
            transition_time: transition,
            transition_threshold: 0.3,
            transition_times: [transition; THRESHOLDS.len()],
            replicate,
            axes: numbers
                .into_iter()
                .map(|(name, value)| (name.to_owned(), value))
                .collect(),
        }
    }

    fn replicated(self, rate: f64, force: f64, start: Start) -> Vec<Run> {
        (0..self.replicates)
            .map(|replicate| self.run(rate, force, start, replicate))
            .collect()
    }

    /// Both branches at some strain rates.
    fn branches(self, rates: &[f64]) -> Vec<Run> {
        let mut runs = Vec::new();
        for &rate in rates {
            for force in FORCES {
                for start in [Start::Rest, Start::Jammed] {
                    runs.extend(self.replicated(rate, force, start));
                }
            }
        }
        runs
    }

    /// The three forces of the pictures, and the smallest without friction.
    fn pictures(self, without_friction: Self) -> Vec<Run> {
        let mut runs = Vec::new();
        for (tube, force, friction) in [
            (self, 0.005, 0.4),
            (self, 0.004, 0.4),
            (self, 0.002, 0.4),
            (without_friction, 0.002, 0.0),
        ] {
            for mut run in tube.replicated(4.01e-3, force, Start::Jammed) {
                run.axes
                    .push(("contact.kinetic_friction".to_owned(), friction));
                runs.push(run);
            }
        }
        runs
    }

    /// Everything, the frictionless grains in a tube of their own law.
    fn evidence(self, frictionless: Self) -> Evidence {
        let mut evidence = empty();
        evidence.add_runs("elastic-branches", self.branches(&RATES));
        evidence.add_runs("elastic-frictionless", frictionless.branches(&RATES));
        evidence.add_runs("elastic-flow", self.pictures(frictionless));
        let ladder = Self {
            replicates: 30,
            ..self
        };
        let ladder = FORCES
            .iter()
            .flat_map(|force| ladder.replicated(4.01e-3, *force, Start::Jammed));
        evidence.add_runs("elastic-yielding", ladder.collect());
        let reference = [0.018, 0.1].map(|rate| frictionless.replicated(rate, 0.0, Start::Rest));
        evidence.add_runs("unjammed-frictionless", reference.concat());
        evidence
    }
}

/// Grains without friction: the flow is along the wave, the throat is no fast place.
const FRICTIONLESS: Tube = Tube {
    unjammed: 0.02,
    throat_velocity: 0.0,
    ..SOURCE
};

fn empty() -> Evidence {
    let mut evidence = Evidence::default();
    for study in STUDIES {
        evidence.add_runs(study.name, Vec::new());
    }
    evidence
}

fn examine(id: &str, evidence: &Evidence) -> Finding {
    let claim = CLAIMS.iter().find(|claim| claim.id == id).unwrap();
    (claim.examine)(evidence).unwrap()
}

fn find(id: &str, tube: Tube) -> Finding {
    examine(id, &tube.evidence(FRICTIONLESS))
}

fn value(finding: &Finding, name: &str) -> f64 {
    let found = finding
        .quantities
        .iter()
        .find(|one| one.name.contains(name));
    found.unwrap().ours.unwrap().value
}

const ALL: [&str; 6] = ["S1", "S2", "S3", "S4", "S5", "S6"];

#[test]
fn the_source_s_tube_is_recognised() {
    for id in ALL {
        let finding = find(id, SOURCE);
        assert_eq!(
            finding.verdict,
            Verdict::Reproduced,
            "{id}: {}",
            finding.summary
        );
        assert_eq!(finding.varied, "force");
        assert!(!finding.paragraphs.is_empty());
    }
}

#[test]
fn too_little_of_anything_leaves_the_verdict_open() {
    let thin = [
        Tube {
            replicates: 4,
            ..SOURCE
        },
        Tube {
            late_periods: 40.0,
            ..SOURCE
        },
        Tube {
            drift: 0.1,
            ..SOURCE
        },
    ];
    for id in ALL {
        for tube in thin {
            let frictionless = Tube {
                replicates: tube.replicates,
                late_periods: tube.late_periods,
                drift: tube.drift,
                ..FRICTIONLESS
            };
            let finding = examine(id, &tube.evidence(frictionless));
            assert_eq!(finding.verdict, Verdict::Open, "{id}: {}", finding.summary);
        }
        // Two strain rates, five forces, one start.
        let mut evidence = SOURCE.evidence(FRICTIONLESS);
        for (study, tube) in [
            ("elastic-branches", SOURCE),
            ("elastic-frictionless", FRICTIONLESS),
        ] {
            evidence.add_runs(study, tube.branches(&RATES[1..3]));
        }
        assert_eq!(examine(id, &evidence).verdict, Verdict::Open, "{id}");
        for (study, tube) in [
            ("elastic-branches", SOURCE),
            ("elastic-frictionless", FRICTIONLESS),
        ] {
            let few = tube
                .branches(&RATES)
                .into_iter()
                .filter(|run| run.force() < 0.0048);
            evidence.add_runs(study, few.collect());
        }
        assert_eq!(examine(id, &evidence).verdict, Verdict::Open, "{id}");
        for (study, tube) in [
            ("elastic-branches", SOURCE),
            ("elastic-frictionless", FRICTIONLESS),
        ] {
            let one = tube
                .branches(&RATES)
                .into_iter()
                .filter(|run| run.start == Start::Rest);
            evidence.add_runs(study, one.collect());
        }
        assert_eq!(examine(id, &evidence).verdict, Verdict::Open, "{id}");
    }
}

#[test]
fn forces_without_stationary_runs_do_not_count_and_cost_nothing() {
    let mut evidence = SOURCE.evidence(FRICTIONLESS);
    let mut runs = SOURCE.branches(&RATES);
    for run in runs.iter_mut().filter(|run| run.force() == 0.005) {
        run.flow_rate_ratio_drift = 0.2;
    }
    evidence.add_runs("elastic-branches", runs);
    let finding = examine("S4", &evidence);
    let expected = Statistics {
        strain_rates: 4,
        widths: 7,
        replicates: 5,
        runs: 4 * 8 * 2 * 5,
    };
    assert_eq!(finding.statistics, expected);
    assert_eq!(finding.verdict, Verdict::Reproduced);
}

#[test]
fn pictures_are_judged_by_the_direction_of_the_flow() {
    let forward = Tube {
        unjammed: 0.05,
        ..SOURCE
    };
    assert_eq!(find("S1", forward).verdict, Verdict::Differs);
    let backward = Tube {
        unjammed: -0.05,
        ..FRICTIONLESS
    };
    let finding = examine("S1", &SOURCE.evidence(backward));
    assert_eq!(finding.verdict, Verdict::Differs);
    let noisy = Tube {
        scatter: 0.2,
        ..SOURCE
    };
    assert_eq!(find("S1", noisy).verdict, Verdict::Open);
}

#[test]
fn the_time_until_a_jam_gives_way_counts_what_was_censored() {
    let finding = find("S2", SOURCE);
    assert!((value(&finding, "*f*^{P} = 0.003") - 8.0).abs() < 1.0);
    // Of lifetimes as long as the runs a third is censored: the mean must not be that of the others.
    let slow = Tube {
        lifetime: 66.0,
        ..SOURCE
    };
    let finding = find("S2", slow);
    assert!((value(&finding, "*f*^{P} = 0.003") - 66.0).abs() < 12.0);
    assert_eq!(finding.verdict, Verdict::Reproduced, "{}", finding.summary);
    let rare = Tube {
        lifetime: 300.0,
        ..SOURCE
    };
    assert_eq!(find("S2", rare).verdict, Verdict::Open);
    let never = Tube {
        lifetime: f64::NAN,
        ..SOURCE
    };
    assert_eq!(find("S2", never).verdict, Verdict::Differs);
}

#[test]
fn the_jump_and_the_rate_at_which_it_vanishes_are_found() {
    let finding = find("S3", SOURCE);
    let rate = finding.quantities[0].ours.unwrap();
    assert_eq!(
        (rate.interval_95.lower, rate.interval_95.upper),
        (2.5e-3, 4.01e-3)
    );
    assert!((value(&finding, "strain rate 0.00401") - JUMP).abs() < 0.02);
    assert!(value(&finding, "strain rate 0.0015").abs() < 0.1);
    // The window of both flows, from 0.0045 to 0.005, is at least as wide as that and less than to the forces beyond.
    let row = finding.tables[0]
        .rows
        .iter()
        .find(|row| row[0] == "0.00401")
        .unwrap();
    assert_eq!(row[4], "0.0005 … 0.0015");
    assert_eq!(row[8], "jump");
    // Without a force beyond the window its width has no upper end.
    let mut evidence = empty();
    let runs = SOURCE.branches(&RATES).into_iter();
    evidence.add_runs(
        "elastic-branches",
        runs.filter(|run| run.force() < 0.0052).collect(),
    );
    let open = &examine("S3", &evidence).tables[0].rows[2];
    assert_eq!(
        (open[0].as_str(), open[4].as_str()),
        ("0.00401", "> 0.0005")
    );
    assert_eq!(finding.figures.len(), 2);
    for jumps_from in [0.0, 1.0] {
        let finding = find(
            "S3",
            Tube {
                jumps_from,
                ..SOURCE
            },
        );
        assert_eq!(finding.verdict, Verdict::Differs, "{}", finding.summary);
    }
}

#[test]
fn neither_a_coarse_grid_nor_one_beside_the_transition_decides() {
    let kinds = |forces: &[f64]| -> Vec<String> {
        let tube = Tube {
            window: 0.0,
            ..SOURCE
        };
        let runs = tube.branches(&RATES).into_iter();
        let mut evidence = empty();
        evidence.add_runs(
            "elastic-branches",
            runs.filter(|run| forces.contains(&run.force())).collect(),
        );
        let rows = &examine("S3", &evidence).tables[0].rows;
        rows.iter().map(|row| row[8].clone()).collect()
    };
    assert_eq!(kinds(&FORCES), ["smooth", "smooth", "jump", "jump"]);
    let coarse = [0.002, 0.003, 0.004, 0.0055, 0.0065];
    assert_eq!(kinds(&coarse), ["smooth", "smooth", "unclear", "unclear"]);
    let below = [0.002, 0.003, 0.0035, 0.004];
    assert_eq!(kinds(&below)[2..], ["unclear", "unclear"]);
}

#[test]
fn strain_rates_at_which_grains_leave_are_not_judged() {
    let mut evidence = SOURCE.evidence(FRICTIONLESS);
    let leaky = Tube {
        jumps_from: 1.0,
        escaped: 200,
        ..SOURCE
    };
    evidence.add_runs("elastic-extremes", leaky.branches(&[8e-3]));
    let finding = examine("S3", &evidence);
    assert_eq!(finding.verdict, Verdict::Reproduced, "{}", finding.summary);
    let row = finding.tables[0].rows.last().unwrap();
    assert_eq!((row[0].as_str(), row[8].as_str()), ("0.008", "leaks"));
}

#[test]
fn forces_at_which_grains_leave_are_left_out() {
    // Without the force at which they leave, and jam, nothing is left of the jump.
    let mut evidence = empty();
    let runs = SOURCE.branches(&[4.01e-3]).into_iter().map(|mut run| {
        if run.force() > 0.004 {
            run.escaped = 80;
        }
        run
    });
    evidence.add_runs("elastic-branches", runs.collect());
    let finding = examine("S3", &evidence);
    let row = &finding.tables[0].rows[0];
    assert_eq!(row[8], "unclear");
    assert_eq!(row[7], "0.07 (left out: 0.0045, 0.005, 0.0055, 0.0065)");
    assert!(!finding.summary.contains("0.00401"), "{}", finding.summary);
}

#[test]
fn back_flow_is_seen_and_its_absence_too() {
    let finding = find("S4", SOURCE);
    assert!((value(&finding, "strain rate 0.00401") + 0.05).abs() < 0.01);
    assert_eq!(
        find(
            "S4",
            Tube {
                unjammed: 0.01,
                ..SOURCE
            }
        )
        .verdict,
        Verdict::Differs
    );
    // Where both flows exist the slow one counts.
    assert!(
        find("S4", SOURCE).summary.contains("0.005"),
        "{}",
        find("S4", SOURCE).summary
    );
    // Negative from one start only is none.
    let mut evidence = empty();
    let mut runs = SOURCE.branches(&RATES);
    for run in runs.iter_mut().filter(|run| run.start == Start::Jammed) {
        run.flow_rate_ratio = 0.0;
    }
    evidence.add_runs("elastic-branches", runs);
    assert_eq!(examine("S4", &evidence).verdict, Verdict::Differs);
}

#[test]
fn frictionless_grains_are_judged_by_all_their_means() {
    let backward = Tube {
        unjammed: -0.05,
        ..FRICTIONLESS
    };
    let finding = examine("S5", &SOURCE.evidence(backward));
    assert_eq!(finding.verdict, Verdict::Differs, "{}", finding.summary);
    let noisy = Tube {
        unjammed: 0.0,
        scatter: 0.05,
        ..FRICTIONLESS
    };
    let finding = examine("S5", &SOURCE.evidence(noisy));
    assert_eq!(finding.verdict, Verdict::Open, "{}", finding.summary);
    let finding = find("S5", SOURCE);
    assert!((value(&finding, "strain rate 0.00401, *f*^{P} = 0.003") - 0.07).abs() < 0.01);
}

#[test]
fn two_unjammed_flows_are_compared_by_throat_and_belly() {
    let finding = find("S6", SOURCE);
    assert!((value(&finding, "axial velocity in the throat, frictional") + 0.2).abs() < 1e-6);
    let alike = Tube {
        throat_velocity: -0.2,
        ..FRICTIONLESS
    };
    let finding = examine("S6", &SOURCE.evidence(alike));
    assert_eq!(finding.verdict, Verdict::Differs, "{}", finding.summary);
    // Temperatures count by their ratio.
    for (ratio, verdict) in [(1.5, Verdict::Differs), (3.0, Verdict::Reproduced)] {
        let mut evidence = SOURCE.evidence(alike);
        let mut warm = evidence
            .study("unjammed-frictionless")
            .unwrap()
            .runs
            .clone();
        for (name, value) in warm.iter_mut().flat_map(|run| &mut run.axes) {
            if name == "belly_granular_temperature" {
                *value *= ratio;
            }
        }
        evidence.add_runs("unjammed-frictionless", warm);
        let finding = examine("S6", &evidence);
        assert_eq!(finding.verdict, verdict, "{}", finding.summary);
    }
}

/// Runs of one setting: its keys, and the tube that it makes.
fn of_setting(tube: Tube, keys: &[(&str, f64)]) -> Vec<Run> {
    let mut runs = Vec::new();
    for force in [0.002, 0.003, 0.004, 0.005, 0.0065] {
        for start in [Start::Rest, Start::Jammed] {
            runs.extend(
                tube.replicated(4.01e-3, force, start)
                    .into_iter()
                    .map(|run| (run, 0.4)),
            );
        }
    }
    let without = FRICTIONLESS.replicated(4.01e-3, 0.002, Start::Rest);
    runs.extend(without.into_iter().map(|run| (run, 0.0)));
    runs.into_iter()
        .map(|(mut run, friction)| {
            run.axes
                .push(("contact.kinetic_friction".to_owned(), friction));
            let keys = keys.iter().map(|(key, value)| ((*key).to_owned(), *value));
            run.axes.extend(keys);
            run
        })
        .collect()
}

#[test]
fn settings_are_named_and_counted() {
    let preset = ("wall.spring_stiffness", 0.018);
    let forward = Tube {
        unjammed: 0.05,
        ..SOURCE
    };
    let mut runs = of_setting(SOURCE, &[preset, ("wall.keep.balance=true", 1.0)]);
    runs.extend(of_setting(SOURCE, &[("wall.spring_stiffness", 0.012)]));
    runs.extend(of_setting(forward, &[preset, ("wall.keep.axial", 0.0)]));
    runs.extend(of_setting(
        SOURCE,
        &[preset, ("wall.keep.net_force=free", 1.0)],
    ));
    runs.extend(of_setting(
        Tube {
            escaped: 200,
            ..forward
        },
        &[("wall.keep.balance=false", 1.0)],
    ));
    let mut evidence = empty();
    evidence.add_runs("elastic-sensitivity", runs.clone());
    let finding = examine("Q10", &evidence);
    let names: Vec<&str> = finding.tables[0]
        .rows
        .iter()
        .map(|row| row[0].as_str())
        .collect();
    assert_eq!(
        names,
        [
            "the preset",
            "*k*_{w} = 0.012",
            "no axial tether",
            "mean force not removed",
            "springs not balanced"
        ]
    );
    assert!(
        finding.summary.contains("Of 5 settings")
            && finding.summary.contains("4 hold their grains"),
        "{}",
        finding.summary
    );
    assert!(
        finding.summary.contains("S4 in 3 of 4") && finding.summary.contains("S5 in 4 of 4"),
        "{}",
        finding.summary
    );
    assert_eq!(finding.verdict, Verdict::Open);
    // A leak at one force leaves that force out, not the setting.
    let mut leaks = runs.clone();
    for run in leaks.iter_mut().filter(|run| run.force() == 0.0065) {
        run.escaped = 200;
    }
    let mut at_one = empty();
    at_one.add_runs("elastic-sensitivity", leaks);
    let finding = examine("Q10", &at_one);
    assert!(
        finding.summary.contains("4 hold their grains"),
        "{}",
        finding.summary
    );
    assert!(finding.tables[0].rows[0][5].ends_with("(left out: 0.0065)"));
    // With enough settings there is an answer.
    for stiffness in [0.013, 0.014, 0.015] {
        runs.extend(of_setting(SOURCE, &[("wall.spring_stiffness", stiffness)]));
    }
    evidence.add_runs("elastic-sensitivity", runs);
    assert_eq!(examine("Q10", &evidence).verdict, Verdict::Answered);
}

#[test]
fn the_full_designs_allow_verdicts() {
    let study = |name: &str| STUDIES.iter().find(|study| study.name == name).unwrap();
    let file = study("elastic-sensitivity");
    let specification =
        Specification::from_toml(file.path, file.text(Size::Full), |_| unreachable!()).unwrap();
    let plan = Plan::of(&specification).unwrap();
    let with_friction = plan.points().iter().filter(|point| {
        let friction = point.configuration.contact.friction.as_ref();
        friction.is_some_and(|friction| friction.kinetic_friction > 0.0)
    });
    // Eight settings, five forces, two states.
    assert!(with_friction.count() >= 8 * 5 * 2 && specification.replicates >= 2);
    for name in ["elastic-branches", "elastic-frictionless"] {
        let file = study(name);
        let specification =
            Specification::from_toml(file.path, file.text(Size::Full), |_| unreachable!()).unwrap();
        let plan = Plan::of(&specification).unwrap();
        let mut rates: Vec<(f64, usize)> = Vec::new();
        for point in plan.points() {
            let configuration = &point.configuration;
            let late = configuration.observe.late_fraction * configuration.run.periods.unwrap();
            assert!(late >= 50.0, "{name}: {late} periods");
            let rate = configuration.drive.strain_rate;
            match rates.iter_mut().find(|known| known.0 == rate) {
                Some(known) => known.1 += 1,
                None => rates.push((rate, 1)),
            }
        }
        assert!(specification.replicates >= 5 && rates.len() >= 3, "{name}");
        // Two states of each force.
        assert!(rates.iter().all(|rate| rate.1 >= 12), "{name}: {rates:?}");
    }
}
