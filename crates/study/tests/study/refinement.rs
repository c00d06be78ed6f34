//! Refinement against runs whose jamming time is known.

use std::collections::{HashMap, HashSet};

use peristalsis_configuration::InitialState;
use peristalsis_study::{Finding, Identity, Plan, brackets, refine};

use crate::study;

const STUDY: &str = r#"
name = "refined"
preset = "frictionless"
states = ["rest", "jammed"]
replicates = 3
[[axes]]
key = "drive.strain_rate"
values = [0.05, 0.1]
[[axes]]
key = "drive.width"
from = 2.5
to = 2.9
count = 3
[refine]
key = "drive.width"
tolerance = 0.01
"#;

/// w_c of runs from rest, and of those from jammed.
fn critical(strain_rate: f64, state: InitialState) -> f64 {
    match state {
        InitialState::Rest | InitialState::Settled => 2.95 - 2.0 * strain_rate,
        InitialState::Jammed | InitialState::Placed => 2.88,
    }
}

/// What a run would find.
fn truth(plan: &Plan, identity: &Identity) -> Finding {
    let mut runs = plan.runs().iter();
    let run = runs.find(|run| run.identity == *identity).unwrap();
    let point = plan.point(run);
    let [strain_rate, width] =
        [0, 1].map(|index: usize| point.settings[index].value.number().unwrap());
    let is_below = width < critical(strain_rate, point.state);
    // The last replicate always differs from the others: the majority counts.
    let turned = is_below == (point.state == InitialState::Rest);
    if turned == (run.replicate != 2) {
        Finding::Transition
    } else {
        Finding::NoTransition
    }
}

/// Runs the plan in the order that `next` chooses among what has not ended, refining after each.
fn grown(next: impl Fn(usize) -> usize) -> Plan {
    let study = study(STUDY);
    let mut plan = study.plan().clone();
    let mut ended: Vec<(Identity, Finding)> = Vec::new();
    loop {
        let open: Vec<Identity> = plan
            .runs()
            .iter()
            .map(|run| run.identity)
            .filter(|identity| !ended.iter().any(|(other, _)| other == identity))
            .collect();
        if open.is_empty() {
            return plan;
        }
        let identity = open[next(open.len())];
        ended.push((identity, truth(&plan, &identity)));
        let found = |identity: &Identity| {
            let known = ended.iter().find(|(other, _)| other == identity);
            known.map(|(_, finding)| *finding)
        };
        refine(&study, &mut plan, &found);
    }
}

#[test]
fn bisection_ends_within_the_tolerance_of_each_line() {
    let plan = grown(|_| 0);
    let study = study(STUDY);
    let found = |identity: &Identity| Some(truth(&plan, identity));
    let brackets = brackets(&study, &plan, &found);
    assert_eq!(brackets.len(), 4);
    for (bracket, strain_rate) in brackets.iter().zip([0.05, 0.05, 0.1, 0.1]) {
        assert!(
            bracket.of.contains(&format!("strain_rate {strain_rate}")),
            "{bracket:?}"
        );
        let critical = critical(strain_rate, bracket.state);
        assert!(
            bracket.lower < critical && critical <= bracket.upper,
            "{bracket:?}"
        );
        assert!(bracket.upper - bracket.lower <= 0.01, "{bracket:?}");
        // Grains at rest jam in narrow tubes, and jams give way in wide ones.
        let is_rest = bracket.state == InitialState::Rest;
        assert_eq!(bracket.has_transitions_below, is_rest, "{bracket:?}");
    }
    // 0.2 is halved five times to be at most 0.01, in each of four lines, by three replicates.
    assert_eq!(plan.runs().len(), 3 * 4 * (3 + 5));
}

#[test]
fn where_some_runs_jam_the_points_are_dense_between_all_and_none() {
    let study = study(&STUDY.replace(r#"["rest", "jammed"]"#, r#"["rest"]"#));
    let mut plan = study.plan().clone();
    loop {
        // Each replicate jams up to a width of its own: 2.64, 2.67, 2.70.
        let known: Vec<(Identity, Finding)> = plan
            .runs()
            .iter()
            .map(|run| {
                let width = plan.point(run).settings[1].value.number().unwrap();
                let found = if width < 2.64 + 0.03 * f64::from(run.replicate) {
                    Finding::Transition
                } else {
                    Finding::NoTransition
                };
                (run.identity, found)
            })
            .collect();
        let found = |identity: &Identity| {
            let known = known.iter().find(|(other, _)| other == identity);
            known.map(|(_, finding)| *finding)
        };
        if !refine(&study, &mut plan, &found) {
            break;
        }
    }
    for strain_rate in [0.05, 0.1] {
        let mut widths: Vec<f64> = plan
            .points()
            .iter()
            .filter(|point| point.settings[0].value.number() == Some(strain_rate))
            .map(|point| point.settings[1].value.number().unwrap())
            .collect();
        widths.sort_by(f64::total_cmp);
        let gaps = widths
            .windows(2)
            .filter(|pair| pair[1] > 2.64 && pair[0] < 2.70);
        for gap in gaps {
            assert!(gap[1] - gap[0] <= 0.01, "{gap:?}");
        }
        // 2.5, 2.7, 2.9, and the sixteenths and thirty-seconds of 0.2 from 2.64 to 2.70 with what led to them.
        assert_eq!(widths.len(), 15, "{widths:?}");
    }
}

#[test]
fn the_points_added_do_not_depend_on_the_order_in_which_runs_end() {
    let sorted = |plan: Plan| {
        let mut identities: Vec<Identity> = plan.runs().iter().map(|run| run.identity).collect();
        identities.sort();
        identities
    };
    let expected = sorted(grown(|_| 0));
    assert_eq!(sorted(grown(|open| open - 1)), expected);
    assert_eq!(sorted(grown(|open| open / 2)), expected);
}

#[test]
fn nothing_is_added_before_a_line_has_ended_nor_where_nothing_changes() {
    let study = study(STUDY);
    let mut plan = study.plan().clone();
    let runs = plan.runs().len();
    let last = plan.runs().last().unwrap().identity;
    let reference = plan.clone();
    let is_known = |identity: &Identity| {
        *identity != last && reference.runs().iter().any(|run| run.identity == *identity)
    };
    let but_one = |identity: &Identity| is_known(identity).then(|| truth(&reference, identity));
    assert!(refine(&study, &mut plan, &but_one));
    // Three of the four lines have ended.
    assert_eq!(plan.runs().len(), runs + 3 * 3);
    let mut plan = reference.clone();
    for all in [Finding::Transition, Finding::NoTransition, Finding::Nothing] {
        assert!(!refine(&study, &mut plan, &|_| Some(all)));
        assert!(brackets(&study, &plan, &|_| Some(all)).is_empty());
    }
    assert!(!refine(&study, &mut plan, &|_| None));
}

#[test]
fn the_estimate_runs_along_before_everything_has_ended() {
    let study = study(&STUDY.replace("[refine]\nkey = \"drive.width\"\ntolerance = 0.01\n", ""));
    let plan = study.plan();
    // Only the first replicates have ended; no refinement is asked for, widths are watched all the same.
    let first: Vec<Identity> = plan
        .runs()
        .iter()
        .filter(|run| run.replicate == 0)
        .map(|run| run.identity)
        .collect();
    let found = |identity: &Identity| first.contains(identity).then(|| truth(plan, identity));
    let brackets = brackets(&study, plan, &found);
    assert_eq!(brackets.len(), 4);
    assert_eq!((brackets[2].lower, brackets[2].upper), (2.7, 2.9));
    assert!((brackets[2].middle() - 2.8).abs() < 1e-12);
}

/// A physicist with a cluster: a middle of 37.5 grains locked the store, with 12 finished runs in it.
#[test]
fn whole_numbers_are_halved_in_whole_numbers_that_can_be() {
    let refined = |axis: &str, critical: f64| {
        let study = study(&format!(
            "name = \"whole\"\npreset = \"frictionless\"\n[[axes]]\n{axis}\n[refine]\nkey = \"{}\"\ntolerance = 1",
            axis.split('"').nth(1).unwrap()
        ));
        let mut plan = study.plan().clone();
        let values = |plan: &Plan| -> Vec<(Identity, f64)> {
            let runs = plan.runs().iter();
            let value = |run| plan.point(run).settings[0].value.number().unwrap();
            runs.map(|run| (run.identity, value(run))).collect()
        };
        loop {
            let known = values(&plan);
            let found = |identity: &Identity| {
                let (_, value) = known.iter().find(|(other, _)| other == identity)?;
                Some(match *value < critical {
                    true => Finding::Transition,
                    false => Finding::NoTransition,
                })
            };
            if !refine(&study, &mut plan, &found) {
                break;
            }
        }
        let mut values: Vec<f64> = values(&plan).into_iter().map(|(_, value)| value).collect();
        values.sort_by(f64::total_cmp);
        values
    };
    let grains = refined("key = \"grains.number\"\nvalues = [30, 45]", 38.0);
    assert_eq!(grains, [30.0, 37.0, 38.0, 39.0, 41.0, 45.0]);
    // Staggered rings are even in number: an odd middle gives way to its neighbour, and 14 and 16 stay apart.
    let rings = refined("key = \"tube.rings_per_wave\"\nvalues = [12, 18]", 15.0);
    assert_eq!(rings, [12.0, 14.0, 16.0, 18.0]);
}

/// Refines until nothing is added, runs that end as `finding` says of the value of the last axis.
fn refined(text: &str, finding: impl Fn(f64) -> Finding) -> Plan {
    let study = study(text);
    let mut plan = study.plan().clone();
    loop {
        let known: HashMap<Identity, Finding> = plan
            .runs()
            .iter()
            .map(|run| {
                let setting = plan.point(run).settings.last().unwrap();
                (run.identity, finding(setting.value.number().unwrap()))
            })
            .collect();
        if !refine(&study, &mut plan, &|identity| known.get(identity).copied()) {
            return plan;
        }
    }
}

/// A tester: a middle that had failed was added again and again, for ever.
#[test]
fn a_middle_that_has_failed_is_not_added_again() {
    let plan = refined(STUDY, |width| match width {
        ..2.75 => Finding::Transition,
        2.85.. => Finding::NoTransition,
        _ => Finding::Nothing,
    });
    // 2.8, once in each of the four lines.
    assert_eq!(plan.points().len(), 4 * (3 + 1));
}

/// A tester: numbers of periods that become the same number of samples were added as runs of their own.
#[test]
fn a_middle_that_is_a_run_of_the_plan_is_not_added() {
    let text = r#"
name = "refined"
preset = "frictionless"
[[axes]]
key = "run.periods"
values = [5, 40]
[refine]
key = "run.periods"
tolerance = 0.003
"#;
    let plan = refined(text, |periods| match periods < 5.94 {
        true => Finding::NoTransition,
        false => Finding::Transition,
    });
    let distinct: HashSet<Identity> = plan.runs().iter().map(|run| run.identity).collect();
    assert_eq!(distinct.len(), plan.runs().len());
    assert!(plan.runs().len() > 8);
}
