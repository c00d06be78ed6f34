//! Claims on runs whose law is known: the verdict must follow it, whichever way it goes.

#![allow(missing_docs)]
#![expect(clippy::unwrap_used, reason = "a test may")]

mod rows;

use std::collections::BTreeMap;

use peristalsis_reproduce::{CLAIMS, Evidence, Finding, Lattice, STUDIES, Size, Start, Verdict};

use rows::{Rows, assert_says, assert_verdict, claim, examine, value};

/// A tube whose transition times and branches follow given laws.
#[derive(Clone, Copy)]
struct Tube {
    /// w_c = 3 - slope epsdot + bend (epsdot - 0.08)^2, and wander more or less by turns.
    slope: f64,
    bend: f64,
    wander: f64,
    /// tau = 200 (epsdot/0.05)^scaling (w_c - w)^-alpha (1 + 4 shape (w_c - w))/(1 + bow (w_c - w)), and a factor of uneven more
    /// or less by turns.
    alpha: f64,
    scaling: f64,
    shape: f64,
    bow: f64,
    uneven: f64,
    /// The relative variance of tau goes as epsdot^(3/2) (w_c - w)^-roughens.
    roughens: f64,
    /// J/Jmax of the slow flow at w_c.
    slow: f64,
    /// Periods that the jump itself takes.
    duration: f64,
    /// Fall of J/Jmax with the volume fraction.
    falls: f64,
    /// Height of the jump at w_c.
    jump: f64,
    /// Distance of w_c' from w_c.
    hysteresis: f64,
}

/// The tube of the source.
const SOURCE: Tube = Tube {
    slope: 3.75,
    bend: 0.0,
    wander: 0.0,
    alpha: 1.0,
    scaling: -2.0,
    shape: 0.0,
    bow: 0.0,
    uneven: 1.0,
    roughens: 1.0,
    slow: 0.3,
    duration: 0.0,
    falls: 0.2,
    jump: 0.7,
    hysteresis: 0.1,
};

const RATES: [f64; 5] = [0.03, 0.05, 0.07, 0.1, 0.14];
const REPLICATES: i64 = 30;

/// 1 and −1 by turns, from strain rate to strain rate.
fn turn(rate: f64) -> f64 {
    let place = RATES.iter().position(|one| *one == rate).unwrap();
    [1.0, -1.0][place % 2]
}

/// Quantiles of a normal distribution in a scrambled order, the same numbers each time.
fn normal(replicate: i64) -> f64 {
    let place = ((replicate * 7 + 3) % REPLICATES) as f64 + 0.5;
    let uniform = place / REPLICATES as f64;
    // Logistic numbers of variance 1 are near enough.
    (uniform / (1.0 - uniform)).ln() * 3_f64.sqrt() / std::f64::consts::PI
}

impl Tube {
    fn critical(self, rate: f64) -> f64 {
        let bent = self.bend * (rate - 0.08).powi(2);
        3.0 - self.slope * rate + bent + self.wander * turn(rate)
    }

    fn run(self, rows: &mut Rows, start: Start, rate: f64, width: f64, replicate: i64) {
        let distance = self.critical(rate) - width;
        let time = 1000.0 / rate;
        let tau = if distance > 0.0 && start == Start::Rest {
            let factor = (1.0 + 4.0 * self.shape * distance) * self.uneven.powf(turn(rate));
            let mean = 200.0 * (rate / 0.05).powf(self.scaling) * distance.powf(-self.alpha);
            let mean = mean * factor / (1.0 + self.bow * distance);
            let variance = 0.0125 * rate.powf(1.5) * distance.powf(-self.roughens);
            let deviation = variance.sqrt().min(0.4);
            mean * (1.0 + deviation * normal(replicate)).max(0.05)
        } else {
            f64::NAN
        };
        let tau = if tau < time { tau } else { f64::NAN };
        let (start, jams) = match start {
            Start::Rest => ("rest", distance > 0.0),
            Start::Jammed => ("jammed", distance + self.hysteresis > 0.0),
        };
        let slow = self.slow - 0.2 * (width - self.critical(rate));
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
        for (place, column) in columns.iter().enumerate() {
            let passed = tau + (place as f64 / 8.0 - 0.5) * self.duration / rate;
            let passed = if passed < time { passed } else { f64::NAN };
            numbers.push((column.as_str(), passed));
        }
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

    /// The widths of [`Self::divergence`] for several densities at one strain rate.
    fn density(self, lattice: Lattice) -> Rows {
        Self::densities(lattice, |_| self)
    }

    /// The same, each density with a tube of its own.
    fn densities(lattice: Lattice, tube: impl Fn(f64) -> Self) -> Rows {
        let mut rows = Rows::default();
        for fraction in [0.15, 0.3, 0.45, 0.6] {
            let tube = tube(fraction);
            let of_rate = tube
                .divergence(lattice)
                .only(|_, numbers| numbers["strain_rate"] == 0.1);
            let mut here = of_rate.clone();
            here.set("volume_fraction", fraction);
            here.shift("flow_rate_ratio", -tube.falls * fraction);
            rows.extend(&here);
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
        let density = self.density(lattice);
        for (study, rows) in [
            ("divergence", divergence),
            ("branches", branches),
            ("density", density),
        ] {
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
        for study in claim.all_studies() {
            assert!(STUDIES.iter().any(|known| known.name == study), "{study}");
        }
    }
}

#[test]
fn one_lattice_alone_is_examined() {
    let mut evidence = rows::evidence(&[]);
    SOURCE.on(Lattice::FINE, "fine", &mut evidence);
    for claim in CLAIMS {
        let finding = claim.examine(&evidence).unwrap();
        assert!(!finding.summary.is_empty(), "{}", claim.id);
    }
}

#[test]
fn every_study_file_is_valid_and_named_for_itself() {
    for study in STUDIES {
        for size in [Size::Quick, Size::Full] {
            let specification = study.specification(size).unwrap();
            assert_eq!(specification.name, study.name);
            assert!(!specification.plan().runs().is_empty());
        }
    }
}

/// Each claim on a tube that does as the source says, and on one that does not: every verdict can be reached both ways.
#[test]
fn verdicts_follow_the_law_of_the_tube() {
    type Change = fn(&mut Tube);
    let same: Change = |_| ();
    // What makes the claim true, where the tube of the source is not enough, and what makes it false.
    let cases: [(&str, Change, Change); 9] = [
        ("F1", same, |tube| tube.jump = 0.4),
        ("F2", same, |tube| tube.alpha = 2.0),
        ("F3", same, |tube| tube.scaling = 0.0),
        ("F4", same, |tube| tube.scaling = 0.0),
        // A jump that takes long leaves the second moment room to grow.
        ("F5", |tube| tube.duration = 300.0, |_| ()),
        ("F6", same, |tube| tube.jump = 0.0),
        ("F7", same, |tube| tube.slope = 2.0),
        ("F8", same, |tube| tube.falls = 0.0),
        ("F9", same, |tube| tube.hysteresis = 0.0),
    ];
    for (id, makes_true, makes_false) in cases {
        for (change, verdict) in [
            (makes_true, Verdict::Reproduced),
            (makes_false, Verdict::Differs),
        ] {
            let mut tube = SOURCE;
            change(&mut tube);
            let found = find(id, tube);
            assert_eq!(found.verdict, verdict, "{id}: {:?}", found.walls);
            assert_eq!(found.walls.len(), 2, "{id}");
            assert!(
                found.walls.iter().all(|wall| wall.verdict == verdict),
                "{id}"
            );
        }
    }
    let mut steeper = SOURCE;
    steeper.alpha = 2.0;
    assert!((value(&find("F2", steeper), "wall 24 × 26") - 2.0).abs() < 0.2);
}

/// A claim of several parts differs where one of them does, whichever it is.
#[test]
fn each_part_of_a_claim_can_fail_alone() {
    type Change = fn(&mut Tube);
    let cases: [(&str, Change, &str); 8] = [
        // The slow flow is fast.
        (
            "F1",
            |tube| (tube.slow, tube.jump) = (0.6, 0.4),
            "not at 0.03",
        ),
        // The jammed flow stays below J_max.
        ("F1", |tube| tube.jump = 0.4, "not at 0.03"),
        // tau (w_c - w) goes as epsdot^-2, but the curves have a shape that no distance over epsdot^(3/2) brings together.
        (
            "F3",
            |tube| tube.shape = 1.0,
            "source's pair: probability < 0.001",
        ),
        ("F4", |tube| tube.roughens = 0.0, "*β* = 3: does not hold"),
        ("F4", |tube| tube.scaling = 0.0, "*β* = 3: holds"),
        ("F7", |tube| tube.slope = 2.0, "straight: "),
        (
            "F7",
            |tube| tube.bend = 10.0,
            "straight: probability < 0.001",
        ),
        (
            "F8",
            |tube| tube.alpha = 2.0,
            "flow decreases with density; *w*_{c} hardly depends",
        ),
    ];
    for (id, change, why) in cases {
        let mut tube = SOURCE;
        change(&mut tube);
        let mut evidence = rows::evidence(&[]);
        tube.on(Lattice::FINE, "fine", &mut evidence);
        let found = examine(id, &evidence);
        assert_verdict(&found, Verdict::Differs);
        assert_says(&found.walls[0].why, why);
    }
    let wider = |fraction: f64| Tube {
        slope: SOURCE.slope - 2.0 * fraction,
        ..SOURCE
    };
    let rows = Tube::densities(Lattice::FINE, wider);
    let found = examine("F8", &rows::evidence(&[("density-fine", &rows)]));
    assert_verdict(&found, Verdict::Differs);
    assert_says(&found.walls[0].why, "*w*_{c} depends on it");
}

/// 1/tau has a correction next to w_c, and chi_tau has it twice; chi_tau/tau^2 goes as 1/(w_c - w).
#[test]
fn a_correction_of_the_times_leaves_the_power_of_their_scatter() {
    for (roughens, says) in [(1.0, "*β* = 3: holds"), (0.0, "*β* = 3: does not hold")] {
        let tube = Tube {
            bow: 20.0,
            roughens,
            ..SOURCE
        };
        let mut evidence = rows::evidence(&[]);
        tube.on(Lattice::FINE, "fine", &mut evidence);
        assert_says(&examine("F4", &evidence).walls[0].why, says);
    }
}

/// With runs enough a claim is open where strain rates are divided, or where its numbers are too uncertain to tell.
#[test]
fn what_is_divided_or_uncertain_stays_open() {
    type Change = fn(&mut Tube);
    let divided: [(&str, Change, Change); 4] = [
        ("F1", |_| (), |tube| tube.jump = 0.4),
        ("F2", |_| (), |tube| tube.alpha = 2.0),
        ("F6", |_| (), |tube| tube.jump = 0.0),
        ("F9", |_| (), |tube| tube.hysteresis = 0.0),
    ];
    for (id, of_slow, of_fast) in divided {
        let [mut slow, mut fast] = [SOURCE; 2];
        of_slow(&mut slow);
        of_fast(&mut fast);
        let both = |of: fn(Tube, Lattice) -> Rows| {
            let is_slow = |numbers: &BTreeMap<String, f64>| numbers["strain_rate"] < 0.06;
            let mut rows = of(slow, Lattice::FINE).only(|_, numbers| is_slow(numbers));
            rows.extend(&of(fast, Lattice::FINE).only(|_, numbers| !is_slow(numbers)));
            rows
        };
        let (divergence, branches) = (both(Tube::divergence), both(Tube::branches));
        let studies = [
            ("divergence-fine", &divergence),
            ("branches-fine", &branches),
        ];
        let found = examine(id, &rows::evidence(&studies));
        assert_eq!(found.verdict, Verdict::Open, "{id}: {:?}", found.walls);
        assert!(found.statistics.suffice(&claim(id).needed), "{id}");
    }
    let uncertain: [(&str, Change); 3] = [
        ("F3", |tube| tube.uneven = 3.0),
        ("F4", |tube| tube.uneven = 1.7),
        ("F7", |tube| tube.wander = 0.15),
    ];
    for (id, change) in uncertain {
        let mut tube = SOURCE;
        change(&mut tube);
        let mut evidence = rows::evidence(&[]);
        tube.on(Lattice::FINE, "fine", &mut evidence);
        let found = examine(id, &evidence);
        assert_eq!(found.verdict, Verdict::Open, "{id}: {:?}", found.walls);
        assert!(found.statistics.suffice(&claim(id).needed), "{id}");
    }
    let divided = |fraction: f64| Tube {
        alpha: if fraction < 0.4 { 1.0 } else { 2.0 },
        ..SOURCE
    };
    let rows = Tube::densities(Lattice::FINE, divided);
    let found = examine("F8", &rows::evidence(&[("density-fine", &rows)]));
    assert_eq!(found.verdict, Verdict::Open, "{:?}", found.walls);
    assert!(found.statistics.suffice(&claim("F8").needed));
}

/// Claim, name of the quantity, its value by the law of the tube, and how near it must come.
#[test]
fn the_numbers_of_the_tube_are_found() {
    for (id, name, law, within) in [
        ("F2", "wall 24 × 26", 1.0, 0.1),
        (
            "F3",
            "power of the strain rate in *τ*(*w*_{c} − *w*) next",
            -2.0,
            0.1,
        ),
        // chi/tau^2 ~ 1/(w_c - w): beta = 2 alpha + 1.
        ("F4", "variance of the transition time next", 3.0, 0.4),
        ("F4", "power of the strain rate in *χ_{τ}*", -2.5, 0.3),
        ("F6", "wall 24 × 26, strain rate 0.1", 0.7, 0.03),
        (
            "F7",
            "slope of the critical width, wall 24 × 26",
            -3.75,
            0.2,
        ),
    ] {
        let found = value(&find(id, SOURCE), name);
        assert!((found - law).abs() < within, "{id}, {name}: {found}");
    }
}

#[test]
fn a_collapse_finds_the_powers_of_the_strain_rate() {
    // tau = epsdot^-2 (w_c - w)^-1 = epsdot^(-a) ((w_c - w)/epsdot^b)^-1 for a - b = 2.
    let finding = find("F3", SOURCE);
    // The power is the same at every distance from w_c.
    let windows = &finding.tables[1];
    assert!(windows.rows.len() == 2 && windows.head.len() == 7);
    for cell in windows.rows.iter().flat_map(|row| &row[1..]) {
        assert!(
            cell.starts_with("−2.0") || cell.starts_with("−1.9") || cell == "–",
            "{cell}"
        );
    }
    let [a, b] =
        ["in the ordinate, wall 24", "in the distance, wall 24"].map(|name| value(&finding, name));
    assert!((a - b - 2.0).abs() < 0.15, "{a} {b}");
    assert!(!finding.figures.is_empty());
}

/// One wall that does as the source says is enough, one that does not is named, and one without runs is not examined.
#[test]
fn a_verdict_belongs_to_a_wall() {
    let mut evidence = rows::evidence(&[]);
    SOURCE.on(Lattice::FINE, "fine", &mut evidence);
    assert_eq!(examine("F7", &evidence).walls.len(), 1);
    let mut other = SOURCE;
    other.slope = 2.0;
    other.on(Lattice::COARSE, "coarse", &mut evidence);
    let found = examine("F7", &evidence);
    assert_verdict(&found, Verdict::Reproduced);
    assert_says(&found.summary, "Reproduced on 24 × 26; differs on 12 × 14.");
}

/// Grains that coast without contacts are no jam.
#[test]
fn a_flow_without_contacts_is_void() {
    let mut evidence = rows::evidence(&[]);
    SOURCE.on(Lattice::FINE, "fine", &mut evidence);
    let mut branches = SOURCE.branches(Lattice::FINE);
    branches.set("contacts", 0.01);
    evidence
        .add_table("branches-fine", branches.table())
        .unwrap();
    assert_verdict(&examine("F9", &evidence), Verdict::Open);
    branches.set("contacts", 2.0);
    evidence
        .add_table("branches-fine", branches.table())
        .unwrap();
    assert_verdict(&examine("F9", &evidence), Verdict::Reproduced);
}

/// One rule for leaks; a strain rate at which grains leave the tube counts for no claim.
#[test]
fn leaking_strain_rates_are_left_out_everywhere() {
    let mut evidence = rows::evidence(&[]);
    let leak = |rows: Rows| {
        let mut leaking = rows.only(|_, numbers| numbers["strain_rate"] == 0.14);
        leaking.set("escaped", 100.0);
        let mut all = rows.only(|_, numbers| numbers["strain_rate"] != 0.14);
        all.extend(&leaking);
        all
    };
    let (branches, divergence) = (
        SOURCE.branches(Lattice::FINE),
        SOURCE.divergence(Lattice::FINE),
    );
    for (study, rows) in [("branches-fine", branches), ("divergence-fine", divergence)] {
        evidence.add_table(study, leak(rows).table()).unwrap();
    }
    for id in ["F1", "F2", "F3", "F4", "F6", "F7", "F9"] {
        let found = examine(id, &evidence);
        assert_eq!(found.statistics.strain_rates, RATES.len() - 1, "{id}");
    }
    // The densest grains leave: three densities are too few.
    let densities = SOURCE.density(Lattice::FINE);
    let is_dense = |numbers: &BTreeMap<String, f64>| numbers["volume_fraction"] == 0.6;
    let mut leaking = densities.only(|_, numbers| is_dense(numbers));
    leaking.set("escaped", 100.0);
    let mut all = densities.only(|_, numbers| !is_dense(numbers));
    all.extend(&leaking);
    evidence.add_table("density-fine", all.table()).unwrap();
    let found = examine("F8", &evidence);
    assert_verdict(&found, Verdict::Open);
    assert_says(&found.walls[0].why, "left out for leaks: *ρ* = 0.6");
}

/// Nine replicates are too few for any verdict: each claim can also stay open.
#[test]
fn too_few_runs_leave_every_verdict_open() {
    let mut evidence = rows::evidence(&[]);
    for (study, rows) in [
        ("divergence-fine", SOURCE.divergence(Lattice::FINE)),
        ("branches-fine", SOURCE.branches(Lattice::FINE)),
        ("density-fine", SOURCE.density(Lattice::FINE)),
    ] {
        let few = rows.only(|_, numbers| numbers["replicate"] < 9.0);
        evidence.add_table(study, few.table()).unwrap();
    }
    for id in ["F1", "F2", "F3", "F4", "F5", "F6", "F7", "F8", "F9"] {
        let found = examine(id, &evidence);
        assert_verdict(&found, Verdict::Open);
        assert_says(&found.walls[0].why, "too few runs or widths for a verdict");
    }
}

/// Fast grains that hardly touch are no jam by F9, and count in F1.
#[test]
fn a_fast_flow_that_coasts_is_told() {
    for (contacts, is_told) in [(0.3, true), (2.0, false)] {
        let mut rows = SOURCE.branches(Lattice::FINE);
        rows.set("contacts", contacts);
        let found = examine("F1", &rows::evidence(&[("branches-fine", &rows)]));
        assert_verdict(&found, Verdict::Reproduced);
        let told = "fewer than 1 contact each";
        let is_found = found.weaknesses.iter().any(|it| it.contains(told));
        assert_eq!(is_found, is_told, "{:?}", found.weaknesses);
    }
}

/// What a single run from jammed cannot tell is not told.
#[test]
fn so_few_runs_from_jammed_cannot_tell_that_the_start_does_not_matter() {
    let tube = Tube {
        hysteresis: 0.0,
        ..SOURCE
    };
    for (most, why) in [(9.0, "not at"), (0.0, "undecided at")] {
        let mut evidence = rows::evidence(&[]);
        let rows = tube.branches(Lattice::FINE);
        let kept = rows.only(|texts, numbers| {
            texts["initial_state"] == "rest" || numbers["replicate"] <= most
        });
        evidence.add_table("branches-fine", kept.table()).unwrap();
        assert_says(&examine("F9", &evidence).walls[0].why, why);
    }
}

/// Jams of denser grains have contacts; whether the start matters there is told, either way.
#[test]
fn denser_grains_are_told_from_both_starts() {
    let mut evidence = rows::evidence(&[]);
    SOURCE.on(Lattice::FINE, "fine", &mut evidence);
    let mut dense = Rows::default();
    for (fraction, hysteresis) in [(0.3, 0.1), (0.45, 0.0)] {
        let tube = Tube {
            hysteresis,
            ..SOURCE
        };
        let branches = tube.branches(Lattice::FINE);
        let mut rows = branches.only(|_, numbers| numbers["strain_rate"] == 0.1);
        rows.set("volume_fraction", fraction);
        rows.set("contacts", 5.0);
        dense.extend(&rows);
    }
    evidence.add_table("dense-jams", dense.table()).unwrap();
    let found = examine("F9", &evidence);
    let told = found.paragraphs.last().unwrap();
    assert_says(told, "depends on the start at *ρ* = 0.3, not at 0.45, most");
    assert_says(told, "with 5.0 contacts a grain");
}

/// Runs next to w_c, of a study of their own, are read with those of the divergence.
#[test]
fn runs_near_the_critical_width_are_joined() {
    let all = SOURCE.divergence(Lattice::FINE);
    let near = |rows: &Rows, is_near: bool| {
        rows.only(|_, numbers| {
            let distance = SOURCE.critical(numbers["strain_rate"]) - numbers["width"];
            (distance < 0.03) == is_near
        })
    };
    let whole = rows::evidence(&[("divergence-fine", &all)]);
    let mut parted = rows::evidence(&[("divergence-fine", &near(&all, false))]);
    parted
        .add_table("near-fine", near(&all, true).table())
        .unwrap();
    let exponent = |evidence| value(&examine("F2", evidence), "wall 24 × 26");
    assert_eq!(exponent(&whole), exponent(&parted));
    // A run that both have counts once.
    let shared = rows::evidence(&[("divergence-fine", &all), ("near-fine", &all)]);
    let runs = |evidence| examine("F2", evidence).statistics.runs;
    assert_eq!(runs(&whole), runs(&shared));
}

/// Q1 to Q5 have an answer with enough runs, and none with two of each.
#[test]
fn questions_of_prescribed_walls_are_answered_by_enough_runs() {
    let fine = Lattice::FINE;
    let of_lattices = [12, 14, 16, 20, 24].map(|spheres| {
        SOURCE.divergence(Lattice {
            spheres_per_ring: spheres,
            rings_per_wave: spheres + 2,
        })
    });
    let of_lengths = of_lengths();
    let divergence = SOURCE.divergence(fine);
    for (id, study, rows) in [
        ("Q1", "small-strain-rate-fine", SOURCE.branches(fine)),
        ("Q2", "roughness", all(&of_lattices)),
        ("Q3", "radius", divergence.clone()),
        ("Q4", "length", all(&of_lengths)),
        ("Q5", "divergence-fine", divergence),
    ] {
        let found = |rows: &Rows| examine(id, &rows::evidence(&[(study, rows)]));
        assert_verdict(&found(&rows), Verdict::Answered);
        let few = rows.only(|_, numbers| numbers["replicate"] < 2.0);
        assert_verdict(&found(&few), Verdict::Open);
    }
}

/// Where all runs jam up to a width and none from the next on, the range over which they cease to is not 0 but unknown.
#[test]
fn a_fall_between_two_widths_has_a_bound_for_its_spread() {
    let finding = examine("Q4", &rows::evidence(&[("length", &all(&of_lengths()))]));
    for row in &finding.tables[0].rows {
        assert_says(&row[2], "< 0.0");
        assert_says(&row[4], " ± ");
    }
}

/// Tubes of three lengths at one strain rate.
fn of_lengths() -> [Rows; 3] {
    [5.0, 10.0, 20.0].map(|waves| {
        let mut rows = SOURCE.divergence(Lattice::FINE);
        rows.set("waves", waves);
        rows.only(|_, numbers| numbers["strain_rate"] == 0.1)
    })
}

fn all(some: &[Rows]) -> Rows {
    let mut all = Rows::default();
    some.iter().for_each(|one| all.extend(one));
    all
}

/// Runs from jammed that a study of their own adds to the branches count for the loop.
#[test]
fn runs_of_the_loop_are_joined_to_the_branches() {
    let all = SOURCE.branches(Lattice::COARSE);
    let of = |start: &str| all.only(|texts, _| texts["initial_state"] == start);
    let mut evidence = rows::evidence(&[("branches-coarse", &of("rest"))]);
    assert_verdict(&examine("F9", &evidence), Verdict::Open);
    evidence
        .add_table("loop-coarse", of("jammed").table())
        .unwrap();
    assert_verdict(&examine("F9", &evidence), Verdict::Reproduced);
}
