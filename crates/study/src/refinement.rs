//! Where the flow changes its kind along an axis, and the points that are added there.

use std::collections::{BTreeMap, HashMap, HashSet};

use peristalsis_configuration::document::Item;
use peristalsis_configuration::{InitialState, takes_whole_numbers, word};

use crate::identity::Identity;
use crate::plan::{Plan, Point};
use crate::specification::{Specification, neat, number, numeric};

/// Axis along which a change is looked for where the study does not refine one.
const USUAL_KEY: &str = "drive.width";

/// Outcome of a run that has ended, for its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finding {
    /// The flow changed its kind.
    Transition,
    /// It did not before the end of the run.
    NoTransition,
    /// The run failed, and says nothing.
    Nothing,
}

/// Two neighbouring values of an axis between which the majority of the runs changes: a running estimate of the critical
/// value.
#[derive(Clone, Debug, PartialEq)]
pub struct Bracket {
    /// Key of the axis.
    pub key: String,
    /// Values of the other axes, and the state, in words.
    pub of: String,
    /// Initial state of the runs.
    pub state: InitialState,
    /// The lower value.
    pub lower: f64,
    /// The upper value.
    pub upper: f64,
    /// Whether most runs have a transition at the lower value, and most have none at the upper; or the other way round.
    pub has_transitions_below: bool,
}

impl Bracket {
    /// Midway between the two values.
    pub fn middle(&self) -> f64 {
        0.5 * (self.lower + self.upper)
    }
}

/// The points that differ in one axis alone, with their values, which ascend, and their places in the plan.
#[derive(Default)]
struct Line<'a>(Vec<(f64, usize, &'a Point)>);

/// Runs of a point: how many had a transition, how many had none, how many have not ended.
#[derive(Clone, Copy, Default)]
struct Count {
    transitions: u32,
    none: u32,
    open: u32,
}

impl Count {
    /// Whether all runs had a transition, or none had; `None` where they differ, or none has ended well.
    fn unanimity(self) -> Option<bool> {
        match (self.transitions, self.none) {
            (0, 0) => None,
            (_, 0) => Some(true),
            (0, _) => Some(false),
            _ => None,
        }
    }

    /// Whether most runs had a transition; `None` while none has ended well.
    fn majority(self) -> Option<bool> {
        (self.transitions + self.none > 0).then_some(self.transitions > self.none)
    }
}

/// The axis along which changes are looked for.
fn watched_axis(study: &Specification) -> Option<usize> {
    match &study.refinement {
        Some(refine) => Some(refine.axis),
        None => study
            .axes
            .iter()
            .position(|axis| axis.is_numeric() && axis.keys[0].0 == USUAL_KEY),
    }
}

/// The first setting of an axis in the settings of a point.
fn setting_of(study: &Specification, axis: usize) -> usize {
    study.axes[..axis].iter().map(|axis| axis.keys.len()).sum()
}

fn lines<'a>(study: &Specification, plan: &'a Plan, axis: usize) -> Vec<Line<'a>> {
    let setting = setting_of(study, axis);
    let mut lines: BTreeMap<(Vec<usize>, String), Line<'a>> = BTreeMap::new();
    for (index, point) in plan.points().iter().enumerate() {
        let mut others = point.rows.clone();
        others[axis] = 0;
        let value = point.settings[setting].value.number();
        let value = value.expect("a watched axis is one of numbers");
        lines
            .entry((others, word(point.state)))
            .or_default()
            .0
            .push((value, index, point));
    }
    let mut lines: Vec<Line<'a>> = lines.into_values().collect();
    for line in &mut lines {
        line.0.sort_by(|one, other| one.0.total_cmp(&other.0));
    }
    lines
}

fn counts(plan: &Plan, found: &dyn Fn(&Identity) -> Option<Finding>) -> HashMap<usize, Count> {
    let mut counts: HashMap<usize, Count> = HashMap::new();
    for run in plan.runs() {
        let count = counts.entry(run.point).or_default();
        match found(&run.identity) {
            Some(Finding::Transition) => count.transitions += 1,
            Some(Finding::NoTransition) => count.none += 1,
            Some(Finding::Nothing) => {}
            None => count.open += 1,
        }
    }
    counts
}

impl Line<'_> {
    /// Values of the points whose runs say something, with what they say.
    fn known(&self, counts: &HashMap<usize, Count>) -> Vec<(f64, Count)> {
        self.0
            .iter()
            .filter_map(|(value, point, _)| Some((*value, *counts.get(point)?)))
            .filter(|(_, count)| count.majority().is_some())
            .collect()
    }

    /// The neighbouring values on the way from the value at which all runs changed to that at which none did, or the
    /// reverse, around the last change of the majority; that change alone where runs differ all the way to an end of the
    /// line.
    fn undecided(&self, counts: &HashMap<usize, Count>) -> Vec<(f64, f64)> {
        let Some((lower, upper, _)) = self.bracket(counts) else {
            return Vec::new();
        };
        let known = self.known(counts);
        let all_agree = |count: &Count| count.unanimity().is_some();
        let mut points = known.iter();
        let below = points.rposition(|(value, count)| *value <= lower && all_agree(count));
        let mut points = known.iter();
        let above = points.position(|(value, count)| *value >= upper && all_agree(count));
        let (Some(below), Some(above)) = (below, above) else {
            return vec![(lower, upper)];
        };
        let pairs = known[below..=above].windows(2);
        pairs.map(|pair| (pair[0].0, pair[1].0)).collect()
    }

    /// The last two neighbouring values between which the majority changes, points that say nothing yet left out; and
    /// whether most runs have a transition at the lower one.
    fn bracket(&self, counts: &HashMap<usize, Count>) -> Option<(f64, f64, bool)> {
        self.known(counts)
            .windows(2)
            .rev()
            .find(|pair| pair[0].1.majority() != pair[1].1.majority())
            .map(|pair| (pair[0].0, pair[1].0, pair[0].1.majority() == Some(true)))
    }
}

/// Where the majority of the runs that have ended changes, for each combination of the other axes and each state; empty
/// where nothing has changed yet, or no axis of numbers is watched.
pub fn brackets(
    study: &Specification,
    plan: &Plan,
    found: &dyn Fn(&Identity) -> Option<Finding>,
) -> Vec<Bracket> {
    let Some(axis) = watched_axis(study) else {
        return Vec::new();
    };
    let setting = setting_of(study, axis);
    let counts = counts(plan, found);
    let of_line = |line: Line<'_>| {
        let (lower, upper, has_transitions_below) = line.bracket(&counts)?;
        let point = line.0[0].2;
        Some(Bracket {
            key: point.settings[setting].key.clone(),
            of: point.in_words_without(setting),
            state: point.state,
            lower,
            upper,
            has_transitions_below,
        })
    };
    let lines = lines(study, plan, axis).into_iter();
    lines.filter_map(of_line).collect()
}

/// Adds the points that refinement asks for, as far as the runs that have ended decide them; answers whether there are
/// any.
///
/// Between the value at which all runs changed their flow and that at which none did, the gaps between points are halved
/// until none is wider than the tolerance. A line of points is bisected only when all its runs have ended, so that the
/// points added do not depend on the order in which runs end. Of a key that takes whole numbers the middle is one, or its
/// neighbour where the configuration allows that alone. A gap stays as it is where no point can be, and where the point in
/// its middle is a run that the plan has: that has failed, or becomes the run of another value.
pub fn refine(
    study: &Specification,
    plan: &mut Plan,
    found: &dyn Fn(&Identity) -> Option<Finding>,
) -> bool {
    let Some(refine) = &study.refinement else {
        return false;
    };
    let is_whole = takes_whole_numbers(&study.axes[refine.axis].keys[0].0);
    let mut grown = false;
    let mut known: HashSet<Identity> = plan.runs().iter().map(|run| run.identity).collect();
    loop {
        let counts = counts(plan, found);
        let mut added = Vec::new();
        for line in lines(study, plan, refine.axis) {
            let has_ended = |point| counts.get(point).is_some_and(|count| count.open == 0);
            if !line.0.iter().all(|(_, point, _)| has_ended(point)) {
                continue;
            }
            for (lower, upper) in line.undecided(&counts) {
                if upper - lower <= refine.tolerance {
                    continue;
                }
                let model = line.0[0].2;
                let between = middles(lower, upper, is_whole).filter_map(|middle| {
                    let item = Item {
                        origin: refine.origin.clone(),
                        node: numeric(middle),
                    };
                    let mut choice = study.choice(&model.rows);
                    choice[setting_of(study, refine.axis)].2 = &item;
                    let state = study.states.as_ref().map(|_| model.state);
                    study.point(&choice, &model.rows, state).ok()
                });
                added.extend({ between }.find(|point| known.insert(plan.first_run(point))));
            }
        }
        if added.is_empty() {
            return grown;
        }
        plan.add(added);
        grown = true;
    }
}

/// Where to put a point between two, best first.
fn middles(lower: f64, upper: f64, is_whole: bool) -> impl Iterator<Item = f64> {
    let middle = 0.5 * (lower + upper);
    let places = match is_whole {
        true => vec![middle.floor(), middle.floor() + 1.0, middle.floor() - 1.0],
        false => vec![neat(middle)],
    };
    let is_between = move |place: &f64| lower < *place && *place < upper;
    places.into_iter().filter(is_between)
}

/// Points that refinement adds where every line changes within one gap between its points and runs differ all the way
/// between; more are added where runs differ over several gaps. For an estimate beforehand.
pub(crate) fn usual_added_points(study: &Specification, plan: &Plan) -> usize {
    let Some(refine) = &study.refinement else {
        return 0;
    };
    let rows = study.axes[refine.axis].rows.iter();
    let mut values: Vec<f64> = rows.map(|row| number(&row[0].node)).collect();
    values.sort_by(f64::total_cmp);
    let gaps = values.windows(2).map(|pair| pair[1] - pair[0]);
    let (mut gap, mut halvings) = (gaps.fold(0.0, f64::max), 0);
    let least = match takes_whole_numbers(&study.axes[refine.axis].keys[0].0) {
        true => refine.tolerance.max(1.0),
        false => refine.tolerance,
    };
    while gap > least && halvings < 60 {
        gap *= 0.5;
        halvings += 1;
    }
    ((1_usize << halvings.min(20)) - 1) * lines(study, plan, refine.axis).len()
}
