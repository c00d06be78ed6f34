//! Claims on the stress-controlled tube, on runs whose law is known: the verdict must follow it, whichever way it goes.

#![allow(missing_docs)]
#![expect(clippy::unwrap_used, reason = "a test may")]

mod rows;

use peristalsis_reproduce::{Evidence, Finding, STUDIES, Size, Start, Statistics, Verdict};
use peristalsis_study::{Plan, Specification};

use rows::{Rows, assert_says, claim, evidence, examine, value};

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
    escaped: f64,
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
    escaped: 0.0,
};

/// Grains without friction: the flow is along the wave, the throat is no fast place.
const FRICTIONLESS: Tube = Tube {
    unjammed: 0.02,
    throat_velocity: 0.0,
    ..SOURCE
};

/// Strain rate of the source's pictures.
const PICTURED: f64 = 4.01e-3;
const RATES: [f64; 5] = [1.5e-3, 2.5e-3, PICTURED, 5.6e-3, 7e-3];
const FORCES: [f64; 8] = [0.002, 0.003, 0.0035, 0.004, 0.0045, 0.005, 0.0055, 0.0065];
const STARTS: [Start; 2] = [Start::Rest, Start::Jammed];
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

    /// Adds the replicates at one point, with other texts and numbers of their study.
    fn replicate(
        self,
        rows: &mut Rows,
        (rate, force, start): (f64, f64, Start),
        texts: &[(&str, &str)],
        numbers: &[(&str, f64)],
    ) {
        let flow = self.flow(rate, force, start);
        let (periods, speed) = (16.0 + self.late_periods, 20.0 * rate);
        let initial_state = match start {
            Start::Rest => "rest",
            Start::Jammed => "jammed",
        };
        for replicate in 0..self.replicates {
            let noise = scattered(replicate, self.replicates);
            // Quantiles of an exponential distribution: the times of a process without memory.
            let quantile = ((replicate * 7 + 3) % self.replicates) as f64 + 0.5;
            let life = -self.lifetime * (1.0 - quantile / self.replicates as f64).ln();
            let gives_way = start == Start::Jammed && flow < 0.3 && life < periods;
            let transition = if gives_way { life / rate } else { f64::NAN };
            let velocity = (self.throat_velocity + 0.01 * noise) * speed;
            let own = [
                ("strain_rate", rate),
                ("force_amplitude", force),
                ("bottleneck", bottleneck(force)),
                ("time", periods / rate),
                ("late_periods", self.late_periods),
                ("flow_rate_ratio", flow + self.scatter * noise),
                ("flow_rate_ratio_error", self.scatter),
                ("flow_rate_ratio_drift", self.drift),
                ("escaped", self.escaped),
                ("transition_time", transition),
                ("transition_time_30", transition),
                ("replicate", replicate as f64),
                ("throat_density", 20.0 + noise),
                ("throat_axial_velocity", velocity),
                ("throat_granular_temperature", 0.01 * speed * speed),
                ("belly_density", 40.0),
                ("belly_axial_velocity", 0.01 * noise * speed),
                ("belly_granular_temperature", 0.01 * speed * speed),
            ];
            let texts = [&[("initial_state", initial_state)], texts].concat();
            rows.add(&texts, &[&own[..], numbers].concat());
        }
    }

    /// Both branches at some strain rates.
    fn branches(self, rates: &[f64]) -> Rows {
        branches(rates, |_, _| Some(self))
    }

    /// The three forces of the pictures, and the smallest without friction.
    fn pictures(self, without_friction: Self) -> Rows {
        let mut rows = empty();
        for (tube, force, friction) in [
            (self, 0.005, 0.4),
            (self, 0.004, 0.4),
            (self, 0.002, 0.4),
            (without_friction, 0.002, 0.0),
        ] {
            let friction = ("contact.kinetic_friction", friction);
            tube.replicate(
                &mut rows,
                (PICTURED, force, Start::Jammed),
                &[],
                &[friction],
            );
        }
        rows
    }

    /// Everything, the frictionless grains in a tube of their own law.
    fn evidence(self, frictionless: Self) -> Evidence {
        let (mut jams, mut unjammed) = (empty(), empty());
        for force in FORCES {
            let many = Self {
                replicates: 30,
                ..self
            };
            many.replicate(&mut jams, (PICTURED, force, Start::Jammed), &[], &[]);
        }
        for rate in [0.018, 0.1] {
            frictionless.replicate(&mut unjammed, (rate, 0.0, Start::Rest), &[], &[]);
        }
        evidence(&[
            ("two-by-two-strain", &prescribed(frictionless)),
            ("elastic-branches", &self.branches(&RATES)),
            ("elastic-frictionless", &frictionless.branches(&RATES)),
            ("elastic-flow", &self.pictures(frictionless)),
            ("elastic-yielding", &jams),
            ("unjammed-frictionless", &unjammed),
        ])
    }
}

/// Frictionless grains between prescribed walls whose bottlenecks are those of three forces.
fn prescribed(frictionless: Tube) -> Rows {
    let mut rows = empty();
    for force in [0.002, 0.003, 0.0035] {
        let width = bottleneck(force);
        let numbers = [
            ("width", width),
            ("bottleneck", width),
            ("contact.kinetic_friction", 0.0),
        ];
        let point = (PICTURED, force, Start::Rest);
        frictionless.replicate(&mut rows, point, &[], &numbers);
    }
    rows
}

/// The bottleneck that the elastic wall takes \[d\].
fn bottleneck(force: f64) -> f64 {
    7.0 - 400.0 * force
}

/// No runs yet of the tube.
fn empty() -> Rows {
    Rows::with(&[
        ("spheres_per_ring", 22.0),
        ("rings_per_wave", 23.0),
        ("volume_fraction", 0.27),
        ("grains", 1093.0),
        ("radius", 3.5),
        ("wavelength", 20.0),
        ("waves", 2.0),
        ("transition_threshold", 0.3),
    ])
}

/// Both branches at some strain rates, each force and start with a tube of its own, or with none.
fn branches(rates: &[f64], tube: impl Fn(f64, Start) -> Option<Tube>) -> Rows {
    let mut rows = empty();
    for &rate in rates {
        for force in FORCES {
            for start in STARTS {
                if let Some(tube) = tube(force, start) {
                    tube.replicate(&mut rows, (rate, force, start), &[], &[]);
                }
            }
        }
    }
    rows
}

fn find(id: &str, tube: Tube) -> Finding {
    examine(id, &tube.evidence(FRICTIONLESS))
}

/// What a claim says where only the branches were run.
fn of_branches(id: &str, rows: &Rows) -> Finding {
    examine(id, &evidence(&[("elastic-branches", rows)]))
}

/// Cells of the first table of a finding.
fn cells(finding: &Finding, column: usize) -> Vec<&str> {
    let rows = finding.tables[0].rows.iter();
    rows.map(|row| row[column].as_str()).collect()
}

fn assert_verdict(id: &str, evidence: &Evidence, verdict: Verdict) {
    let finding = examine(id, evidence);
    assert_eq!(finding.verdict, verdict, "{id}: {}", finding.summary);
}

const ALL: [&str; 6] = ["S1", "S2", "S3", "S4", "S5", "S6"];

/// A change of the law of the source's tube, and of the law without friction.
type Change = fn(&mut Tube, &mut Tube);

/// Everything of a changed law.
fn changed(change: Change) -> Evidence {
    let (mut tube, mut frictionless) = (SOURCE, FRICTIONLESS);
    change(&mut tube, &mut frictionless);
    tube.evidence(frictionless)
}

#[test]
fn verdicts_follow_the_law_of_the_tube() {
    use Verdict::{Differs, Open, Reproduced};
    let cases: [(&str, Change, Verdict); 12] = [
        // Pictures are judged by the direction of the flow.
        ("S1", |tube, _| tube.unjammed = 0.05, Differs),
        ("S1", |_, grains| grains.unjammed = -0.05, Differs),
        ("S1", |tube, _| tube.scatter = 0.2, Open),
        ("S2", |tube, _| tube.lifetime = 66.0, Reproduced),
        ("S2", |tube, _| tube.lifetime = 300.0, Open),
        ("S2", |tube, _| tube.lifetime = f64::NAN, Differs),
        ("S3", |tube, _| tube.jumps_from = 0.0, Differs),
        ("S3", |tube, _| tube.jumps_from = 1.0, Differs),
        ("S4", |tube, _| tube.unjammed = 0.01, Differs),
        // Frictionless grains are judged by all their means.
        ("S5", |_, grains| grains.unjammed = -0.05, Differs),
        (
            "S5",
            |_, grains| (grains.unjammed, grains.scatter) = (0.0, 0.05),
            Open,
        ),
        ("S6", |_, grains| grains.throat_velocity = -0.2, Differs),
    ];
    for id in ALL {
        let finding = find(id, SOURCE);
        assert_eq!(finding.verdict, Reproduced, "{id}: {}", finding.summary);
        assert_eq!(claim(id).varied, "force");
        assert!(!finding.paragraphs.is_empty());
    }
    for (id, change, verdict) in cases {
        assert_verdict(id, &changed(change), verdict);
    }
}

/// Where no jam gives way at one strain rate, those of the others do not decide.
#[test]
fn jams_give_way_at_each_strain_rate_or_the_verdict_is_open() {
    let lasting = Tube {
        critical: 0.0,
        jumps_from: 0.0,
        ..SOURCE
    };
    let mut rows = SOURCE.branches(&RATES[1..]);
    rows.extend(&lasting.branches(&RATES[..1]));
    let mut evidence = SOURCE.evidence(FRICTIONLESS);
    evidence
        .add_table("elastic-branches", rows.table())
        .unwrap();
    assert_verdict("S2", &evidence, Verdict::Open);
}

#[test]
fn too_little_of_anything_leaves_the_verdict_open() {
    let thin: [Change; 3] = [
        |tube, grains| (tube.replicates, grains.replicates) = (4, 4),
        |tube, grains| (tube.late_periods, grains.late_periods) = (40.0, 40.0),
        |tube, grains| (tube.drift, grains.drift) = (0.1, 0.1),
    ];
    for (place, change) in thin.into_iter().enumerate() {
        // A jam that gives way late drifts, and counts for S2 all the same.
        for id in ALL.into_iter().filter(|id| place == 0 || *id != "S2") {
            assert_verdict(id, &changed(change), Verdict::Open);
        }
    }
    // Two strain rates, five forces, one start.
    let few: [fn(Tube) -> Rows; 3] = [
        |tube| tube.branches(&RATES[1..3]),
        |tube| branches(&RATES, |force, _| (force < 0.0048).then_some(tube)),
        |tube| branches(&RATES, |_, start| (start == Start::Rest).then_some(tube)),
    ];
    for branches in few {
        let mut evidence = SOURCE.evidence(FRICTIONLESS);
        for (study, tube) in [
            ("elastic-branches", SOURCE),
            ("elastic-frictionless", FRICTIONLESS),
        ] {
            evidence.add_table(study, branches(tube).table()).unwrap();
        }
        for id in ALL {
            assert_verdict(id, &evidence, Verdict::Open);
        }
    }
}

#[test]
fn forces_without_stationary_runs_do_not_count_and_cost_nothing() {
    let drifting = Tube {
        drift: 0.2,
        ..SOURCE
    };
    let rows = branches(&RATES, |force, _| {
        Some(if force == 0.005 { drifting } else { SOURCE })
    });
    let finding = of_branches("S4", &rows);
    let expected = Statistics {
        strain_rates: RATES.len(),
        widths: 7,
        replicates: 5,
        runs: RATES.len() * 8 * 2 * 5,
    };
    assert_eq!(finding.statistics, expected);
    assert_eq!(finding.verdict, Verdict::Reproduced);
}

#[test]
fn the_time_until_a_jam_gives_way_counts_what_was_censored() {
    // Of lifetimes as long as the runs a third is censored: the mean must not be that of the others.
    for (lifetime, error) in [(8.0, 1.0), (66.0, 12.0)] {
        let finding = find("S2", Tube { lifetime, ..SOURCE });
        assert!((value(&finding, "*f*^{P} = 0.003") - lifetime).abs() < error);
    }
}

#[test]
fn the_jump_and_the_rate_at_which_it_vanishes_are_found() {
    let finding = find("S3", SOURCE);
    let bounds = finding.quantities[0].ours.unwrap().interval_95;
    assert_eq!((bounds.lower, bounds.upper), (2.5e-3, 4.01e-3));
    assert!((value(&finding, "strain rate 0.00401") - JUMP).abs() < 0.02);
    assert!(value(&finding, "strain rate 0.0015").abs() < 0.1);
    assert_eq!(cells(&finding, 0)[2], "0.00401");
    assert_eq!(cells(&finding, 8)[2], "jump");
    // The window of both flows, from 0.0045 to 0.005, is at least as wide as that and less than to the forces beyond.
    assert_eq!(cells(&finding, 4)[2], "0.0005 … 0.0015");
    assert_eq!(finding.figures.len(), 2);
    // Without a force beyond the window its width has no upper end.
    let below = branches(&RATES, |force, _| (force < 0.0052).then_some(SOURCE));
    assert_eq!(cells(&of_branches("S3", &below), 4)[2], "> 0.0005");
}

#[test]
fn neither_a_coarse_grid_nor_one_beside_the_transition_decides() {
    let tube = Tube {
        window: 0.0,
        ..SOURCE
    };
    let cases: [(&[f64], &[&str]); 3] = [
        (&FORCES, &["smooth", "smooth", "jump", "jump", "jump"]),
        (
            &[0.002, 0.003, 0.004, 0.0055, 0.0065],
            &["smooth", "smooth", "undecided", "undecided", "undecided"],
        ),
        (&[0.002, 0.003, 0.0035, 0.004], &["undecided", "undecided"]),
    ];
    for (forces, kinds) in cases {
        let rows = branches(&RATES, |force, _| forces.contains(&force).then_some(tube));
        let finding = of_branches("S3", &rows);
        assert!(cells(&finding, 8).ends_with(kinds), "{forces:?}");
    }
    // Enough of all, but the forces lie too far apart where the flow rises.
    let apart = |force: f64| !(0.0042..0.0052).contains(&force);
    let rows = branches(&RATES, |force, _| apart(force).then_some(tube));
    let finding = of_branches("S3", &rows);
    assert_eq!(finding.verdict, Verdict::Open, "{}", finding.summary);
    assert!(finding.statistics.suffice(&claim("S3").needed));
}

#[test]
fn what_leaks_is_not_judged() {
    // A strain rate of its own.
    let mut evidence = SOURCE.evidence(FRICTIONLESS);
    let leaky = Tube {
        jumps_from: 1.0,
        escaped: 200.0,
        ..SOURCE
    };
    let table = leaky.branches(&[8e-3]).table();
    evidence.add_table("elastic-extremes", table).unwrap();
    let finding = examine("S3", &evidence);
    assert_eq!(finding.verdict, Verdict::Reproduced, "{}", finding.summary);
    assert_eq!(cells(&finding, 0)[5], "0.008");
    assert_eq!(cells(&finding, 8)[5], "leaks");
    // Without the forces at which grains leave, and jam, nothing is left of the jump.
    let rows = branches(&[PICTURED], |force, _| {
        let escaped = if force > 0.004 { 80.0 } else { 0.0 };
        Some(Tube { escaped, ..SOURCE })
    });
    let finding = of_branches("S3", &rows);
    let left_out = "0.07 (left out: 0.0045, 0.005, 0.0055, 0.0065)";
    assert_eq!(finding.tables[0].rows[0][7..], [left_out, "undecided"]);
    assert!(!finding.summary.contains("0.00401"), "{}", finding.summary);
}

#[test]
fn numbers_of_back_flow_and_of_unjammed_flows_are_those_of_the_law() {
    for (id, name, expected, error) in [
        ("S4", "strain rate 0.00401", -0.05, 0.01),
        ("S5", "strain rate 0.00401, *f*^{P} = 0.003", 0.07, 0.01),
        ("S6", "throat velocity, frictional,", -0.2, 1e-6),
    ] {
        let found = value(&find(id, SOURCE), name);
        assert!((found - expected).abs() < error, "{id}: {found}");
    }
    // Where both flows exist the slow one counts.
    let finding = find("S4", SOURCE);
    assert_says(&finding.summary, "0.005");
}

#[test]
fn back_flow_from_one_start_only_is_none() {
    let still = Tube {
        jumps_from: 0.0,
        unjammed: 0.0,
        critical: f64::INFINITY,
        ..SOURCE
    };
    let rows = branches(&RATES, |_, start| {
        Some(if start == Start::Rest { SOURCE } else { still })
    });
    assert_eq!(of_branches("S4", &rows).verdict, Verdict::Differs);
}

/// Where runs of one model differ as much as those of both, nothing tells the models apart.
#[test]
fn pairs_within_a_model_are_the_null() {
    let fast = Tube {
        throat_velocity: 0.2,
        ..SOURCE
    };
    let mut evidence = SOURCE.evidence(FRICTIONLESS);
    let table = fast.branches(&[PICTURED]).table();
    evidence.add_table("two-by-two-stress", table).unwrap();
    assert_verdict("S6", &evidence, Verdict::Differs);
    // Two of three bottlenecks are too few of them.
    let slow = ("throat_axial_velocity", -0.2 * 20.0 * PICTURED);
    let mut prescribed = prescribed(FRICTIONLESS);
    let widest = bottleneck(0.002);
    let mut some = prescribed.only(|_, numbers| numbers["width"] == widest);
    some.set(slow.0, slow.1);
    prescribed = prescribed.only(|_, numbers| numbers["width"] != widest);
    prescribed.extend(&some);
    let mut divided = SOURCE.evidence(FRICTIONLESS);
    let table = prescribed.table();
    divided.add_table("two-by-two-strain", table).unwrap();
    let finding = examine("S6", &divided);
    assert_eq!(finding.verdict, Verdict::Open, "{}", finding.summary);
    assert_says(&finding.summary, "2 of 3 bottlenecks");
    // Without matched bottlenecks nothing is said.
    let none = Rows::default().table();
    evidence.add_table("two-by-two-strain", none).unwrap();
    assert_verdict("S6", &evidence, Verdict::Open);
}

/// The interval in which the jump vanishes rests on strain rates with replicates, not on single runs.
#[test]
fn single_runs_do_not_narrow_the_interval() {
    for (replicates, interval) in [(1, (2.5e-3, PICTURED)), (5, (3e-3, 3.5e-3))] {
        let between = Tube {
            replicates,
            jumps_from: 3.2e-3,
            ..SOURCE
        };
        let mut evidence = SOURCE.evidence(FRICTIONLESS);
        let table = between.branches(&[3e-3, 3.5e-3]).table();
        evidence.add_table("elastic-extremes", table).unwrap();
        let finding = examine("S3", &evidence);
        let bounds = finding.quantities[0].ours.unwrap().interval_95;
        assert_eq!((bounds.lower, bounds.upper), interval);
        assert_says(
            &finding.summary,
            "jumps, or both flows exist at one force, at *ε̇* = 0.0035",
        );
    }
}

/// Adds the runs of one setting: its texts and numbers, and the tube that it makes at each force.
fn add_setting(
    rows: &mut Rows,
    texts: &[(&str, &str)],
    numbers: &[(&str, f64)],
    tube: impl Fn(f64) -> Tube,
) {
    let with = |friction| [&[("contact.kinetic_friction", friction)], numbers].concat();
    for force in [0.002, 0.003, 0.004, 0.005, 0.0065] {
        for start in STARTS {
            tube(force).replicate(rows, (PICTURED, force, start), texts, &with(0.4));
        }
    }
    FRICTIONLESS.replicate(rows, (PICTURED, 0.002, Start::Rest), texts, &with(0.0));
}

/// Runs of five settings; at the largest force so many grains leave.
fn settings(escaped_at_largest: f64) -> Rows {
    let preset = ("wall.spring_stiffness", 0.018);
    let leaks_at_largest = |tube: Tube| {
        move |force| Tube {
            escaped: if force == 0.0065 {
                escaped_at_largest.max(tube.escaped)
            } else {
                tube.escaped
            },
            ..tube
        }
    };
    let forward = Tube {
        unjammed: 0.05,
        ..SOURCE
    };
    let leaky = Tube {
        escaped: 200.0,
        ..forward
    };
    let mut rows = empty();
    let mut add = |texts: &[(&str, &str)], numbers: &[(&str, f64)], tube| {
        add_setting(&mut rows, texts, numbers, leaks_at_largest(tube));
    };
    add(&[("wall.keep.balance", "true")], &[preset], SOURCE);
    add(&[], &[("wall.spring_stiffness", 0.012)], SOURCE);
    add(&[], &[preset, ("wall.keep.axial", 0.0)], forward);
    add(&[("wall.keep.net_force", "free")], &[preset], SOURCE);
    add(&[("wall.keep.balance", "false")], &[], leaky);
    rows
}

#[test]
fn settings_are_named_and_counted() {
    let of = |rows: &Rows| examine("Q10", &evidence(&[("elastic-sensitivity", rows)]));
    let finding = of(&settings(0.0));
    let names = [
        "the preset",
        "*k*_{w} = 0.012",
        "no axial tether",
        "mean force not removed",
        "springs not balanced",
    ];
    assert_eq!(cells(&finding, 0), names);
    for said in [
        "Of 5 settings",
        "4 hold their grains",
        "S4 in 3 of 4",
        "S5 in 4 of 4",
    ] {
        assert_says(&finding.summary, said);
    }
    assert_eq!(finding.verdict, Verdict::Open);
    // A leak at one force leaves that force out, not the setting.
    let leaking = of(&settings(200.0));
    assert_says(&leaking.summary, "4 hold their grains");
    assert!(cells(&leaking, 5)[0].ends_with("(left out: 0.0065)"));
    // With enough settings there is an answer.
    let mut rows = settings(0.0);
    for stiffness in [0.013, 0.014, 0.015] {
        let stiffness = ("wall.spring_stiffness", stiffness);
        add_setting(&mut rows, &[], &[stiffness], |_| SOURCE);
    }
    assert_eq!(of(&rows).verdict, Verdict::Answered);
}

/// The full design of a study.
fn full(name: &str) -> (Specification, Plan) {
    let file = STUDIES.iter().find(|study| study.name == name).unwrap();
    let specification = file.specification(Size::Full).unwrap();
    let plan = specification.plan().clone();
    (specification, plan)
}

#[test]
fn the_full_designs_allow_verdicts() {
    let (specification, plan) = full("elastic-sensitivity");
    let with_friction = plan.points().iter().filter(|point| {
        let friction = point.configuration.contact.friction.as_ref();
        friction.is_some_and(|friction| friction.kinetic_friction > 0.0)
    });
    // Eight settings, five forces, two states.
    assert!(with_friction.count() >= 8 * 5 * 2 && specification.replicates >= 2);
    for name in ["elastic-branches", "elastic-frictionless"] {
        let (specification, plan) = full(name);
        let mut rates: Vec<(f64, usize)> = Vec::new();
        for point in plan.points() {
            let configuration = &point.configuration;
            let late = configuration.observe.late_fraction * configuration.run.periods.unwrap();
            let rate = configuration.drive.strain_rate;
            // Shorter runs may be there besides.
            let counts = usize::from(late >= 50.0);
            match rates.iter_mut().find(|known| known.0 == rate) {
                Some(known) => known.1 += counts,
                None => rates.push((rate, counts)),
            }
        }
        // Two states of each force.
        let whole = rates.iter().filter(|rate| rate.1 >= 12).count();
        assert!(
            specification.replicates >= 5 && whole >= 3,
            "{name}: {rates:?}"
        );
    }
}
