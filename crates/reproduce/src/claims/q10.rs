//! Q10: how far the conclusions on the elastic tube depend on what the source does not give.

use peristalsis_figures::chart::{ChartFigure, ChartPanel, Points, Reference, Tint};
use peristalsis_figures::{Quantity as Axis, Width};

use super::elastic::{is_frictionless, label};
use crate::claim::Claim;
use crate::crossing::grouped;
use crate::error::ClaimError;
use crate::evidence::Evidence;
use crate::finding::{Finding, ReportFigure, ReportTable, Statistics, Verdict};
use crate::forces::{ForceBranch, LEAST_JUMP, escaped_at, leaking, outside};
use crate::prose::Prose;
use crate::runs::{Run, Start};
use crate::text::{number, with_error};

const PROSE: Prose = Prose::new(include_str!("q10.md"));

pub(super) const CLAIM: Claim = Claim {
    id: "Q10",
    prose: PROSE,
    studies: &["elastic-sensitivity"],
    examine,
};

/// For an answer, of each setting: so many forces and replicates at one strain rate. The number of settings is asked for
/// apart.
const NEEDED: Statistics = Statistics {
    strain_rates: 1,
    widths: 5,
    replicates: 2,
    runs: 200,
};
const LEAST_SETTINGS: usize = 8;

/// J/Jmax below which a jam has given way, and from which on a flow is jammed.
const GIVEN_WAY: f64 = 0.3;
/// Forces without a leak from which on a setting is judged.
const LEAST_FORCES: usize = 3;
/// J/Jmax from which on a flow against the wave counts.
const LEAST_FLOW: f64 = 0.01;

/// The preset's wall and density, and how each key departs from it in words; `None` for keys with texts.
const KEYS: [(&str, f64, &str); 8] = [
    ("grains.number_density", 0.71, "*n*"),
    ("wall.spring_stiffness", 0.018, "*k*_{w}"),
    ("wall.natural_length", 0.7, "*l*"),
    ("wall.keep.azimuthal", 0.1, "azimuthal tether"),
    ("wall.keep.axial", 0.01, "axial tether"),
    ("wall.keep.radial", 0.0, "radial tether"),
    ("wall.drag", 0.0, "drag"),
    ("wall.sphere_mass", 0.1, "*m*_{w}"),
];
const TEXTS: [(&str, &str); 4] = [
    ("wall.keep.balance=false", "springs not balanced"),
    ("wall.keep.net_force=free", "mean force not removed"),
    ("drive.angle=current", "force along the current angle"),
    ("contact.sliding=literal", "sliding as printed"),
];

/// The setting of the preset.
const PRESET: &str = "the preset";
/// All that keeps the wall, taken away.
const NOTHING_KEEPS: [&str; 4] = [
    "no azimuthal tether",
    "no axial tether",
    "springs not balanced",
    "mean force not removed",
];

/// How a run departs from the preset, in words.
fn setting(run: &Run) -> String {
    let numbers = KEYS.iter().filter_map(|(key, preset, name)| {
        let value = run.axis(key)?;
        (value != *preset).then(|| {
            if value == 0.0 {
                format!("no {name}")
            } else {
                format!("{name} = {value}")
            }
        })
    });
    let texts = TEXTS
        .iter()
        .filter(|(key, _)| run.axis(key).is_some())
        .map(|(_, name)| (*name).to_owned());
    let words: Vec<String> = numbers.chain(texts).collect();
    match words.len() {
        0 => PRESET.to_owned(),
        1 => words.join(""),
        _ if words == NOTHING_KEEPS => "nothing keeps the wall".to_owned(),
        _ => words.join(", "),
    }
}

/// What the claims come to under one setting; `None` where it cannot be said.
struct Outcome<'a> {
    name: String,
    runs: Vec<&'a Run>,
    /// Those at forces at which grains stay in the tube.
    tight: Vec<&'a Run>,
    rest: ForceBranch,
    jammed: ForceBranch,
}

impl<'a> Outcome<'a> {
    fn of(name: String, runs: Vec<&'a Run>) -> Self {
        // Grains with friction and without fill the tube differently: one kind may stay where the other leaves.
        let leaking = [false, true].map(|frictionless| {
            let kind = runs.iter().copied();
            let kind = kind.filter(move |run| is_frictionless(run) == frictionless);
            leaking(&escaped_at(kind))
        });
        let is_tight =
            |run: &&Run| !leaking[usize::from(is_frictionless(run))].contains(&run.force());
        let tight: Vec<&Run> = runs.iter().copied().filter(is_tight).collect();
        let frictional = || tight.iter().copied().filter(|run| !is_frictionless(run));
        Self {
            rest: ForceBranch::of(frictional(), Start::Rest),
            jammed: ForceBranch::of(frictional(), Start::Jammed),
            name,
            runs,
            tight,
        }
    }

    /// Whether grains stay in the tube at so many forces that the claims can be told.
    fn holds_its_grains(&self) -> bool {
        let forces = grouped(self.tight.iter().copied(), |run| run.force());
        forces.len() >= LEAST_FORCES
    }

    /// Forces at which they do not.
    fn left_out(&self) -> Vec<f64> {
        let forces = grouped(self.runs.iter().copied(), |run| run.force());
        forces
            .into_iter()
            .map(|(force, _)| force)
            .filter(|force| self.tight.iter().all(|run| run.force() != *force))
            .collect()
    }

    fn escaped(&self) -> f64 {
        self.runs
            .iter()
            .map(|run| run.escaped_fraction())
            .fold(0.0, f64::max)
    }

    fn frictional(&self, start: Start) -> impl Iterator<Item = &&'a Run> {
        self.tight
            .iter()
            .filter(move |run| run.start == start && !is_frictionless(run))
    }

    /// Forces from jammed at which the jam gave way, of all: S2.
    fn gives_way(&self) -> Option<(usize, usize)> {
        let all = self.frictional(Start::Jammed).count();
        let gave = self
            .frictional(Start::Jammed)
            .filter(|run| run.transition_at(GIVEN_WAY).observed().is_some())
            .count();
        (all > 0).then_some((gave, all))
    }

    /// Height of the largest rise between neighbouring forces, and where: S3.
    fn rise(&self) -> Option<(f64, f64, f64)> {
        let rise = self.rest.rise()?;
        let (before, after) = (self.rest.at(rise.before)?, self.rest.at(rise.after)?);
        Some((after.mean - before.mean, rise.before, rise.after))
    }

    /// The smallest flow rate, with its force: S4.
    fn lowest(&self) -> Option<(f64, f64, f64)> {
        self.rest
            .points
            .iter()
            .chain(&self.jammed.points)
            .min_by(|one, other| one.mean.total_cmp(&other.mean))
            .map(|point| (point.mean, point.error, point.force))
    }

    /// The flow rate of frictionless grains, the smallest of all runs: S5.
    fn frictionless(&self) -> Option<f64> {
        self.tight
            .iter()
            .filter(|run| is_frictionless(run))
            .map(|run| run.flow_rate_ratio)
            .filter(|ratio| ratio.is_finite())
            .reduce(f64::min)
    }

    /// Whether each of S2 to S5 holds.
    fn holds(&self) -> [Option<bool>; 4] {
        [
            self.gives_way().map(|(gave, all)| gave > 0 && gave < all),
            self.rise().map(|(height, ..)| height > LEAST_JUMP),
            self.lowest()
                .map(|(mean, error, _)| mean + 2.0 * error < -LEAST_FLOW),
            self.frictionless().map(|flow| flow > -LEAST_FLOW),
        ]
    }

    fn statistics(&self) -> Statistics {
        // What was run, whether or not grains left the tube.
        let from_rest = self.runs.iter().filter(|run| run.start == Start::Rest);
        let frictional = from_rest.filter(|run| !is_frictionless(run));
        Statistics {
            runs: self.runs.len(),
            ..Statistics::at_one_rate(frictional.map(|run| run.force()))
        }
    }
}

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let runs = &evidence.study("elastic-sensitivity")?.runs;
    let mut groups: Vec<(String, Vec<&Run>)> = Vec::new();
    for run in runs {
        let name = setting(run);
        match groups.iter_mut().find(|group| group.0 == name) {
            Some(group) => group.1.push(run),
            None => groups.push((name, vec![run])),
        }
    }
    // The preset first, whatever the order of the rows.
    groups.sort_by_key(|(name, _)| name != PRESET);
    let outcomes: Vec<Outcome<'_>> = groups
        .into_iter()
        .map(|(name, runs)| Outcome::of(name, runs))
        .collect();
    if outcomes.is_empty() {
        let mut nothing = Finding::nothing("No runs yet.", Statistics::default(), &NEEDED);
        nothing.varied = "force";
        return Ok(nothing);
    }
    let tight: Vec<&Outcome<'_>> = outcomes
        .iter()
        .filter(|outcome| outcome.holds_its_grains())
        .collect();
    let statistics = Statistics {
        strain_rates: 1,
        ..Statistics::weakest(outcomes.iter().map(Outcome::statistics))
    };
    let names = ["S2", "S3", "S4", "S5"];
    let words: Vec<String> = names
        .iter()
        .enumerate()
        .map(|(place, name)| {
            let of = |value: bool| {
                tight
                    .iter()
                    .filter(|outcome| outcome.holds()[place] == Some(value))
                    .count()
            };
            format!("{name} in {} of {}", of(true), of(true) + of(false))
        })
        .collect();
    let mut found = Finding::new(
        if outcomes.len() >= LEAST_SETTINGS {
            Verdict::Answered
        } else {
            Verdict::Open
        },
        format!(
            "Of {} settings of wall and density, {} hold their grains at three forces or more; of these, as far as they say, hold \
             {}.",
            outcomes.len(),
            tight.len(),
            words.join(", ")
        ),
        statistics,
        &NEEDED,
    );
    found.varied = "force";
    found.tables.push(table(&outcomes));
    found.paragraphs.push(
        "Each row departs from the preset in what it names. S2: jams give way at some forces and last at others. S3: the flow from rest \
         rises by more than 0.25 from one force to the next. S4: the smallest flow rate is below −0.01 by two errors. S5: that of \
         frictionless grains at *f*^{P} = 0.002 *Yd*^{2} is not. Forces at which more than a twentieth of the grains leave the tube \
         from either start are left out. Differences of forces are 0.001 and more here: a rise of this size \
         is no proof of a jump."
            .to_owned(),
    );
    found.weaknesses.push(
        "One strain rate, short runs: near the transition a jam that lasts here may give way later.".to_owned(),
    );
    found.figures.extend(figure(&outcomes)?);
    Ok(found)
}

fn table(outcomes: &[Outcome<'_>]) -> ReportTable {
    let mark = |holds: Option<bool>| match holds {
        Some(true) => "yes",
        Some(false) => "no",
        None => "–",
    };
    let rows = outcomes
        .iter()
        .map(|outcome| {
            let [gives_way, jumps, back, forward] = outcome.holds().map(mark);
            let none = || "–".to_owned();
            vec![
                outcome.name.clone(),
                outcome
                    .gives_way()
                    .map_or_else(none, |(gave, all)| format!("{gives_way}: {gave} of {all}")),
                outcome.rise().map_or_else(none, |(height, before, after)| {
                    format!("{jumps}: {} at {before} … {after}", number(height, 2))
                }),
                outcome.lowest().map_or_else(none, |(mean, error, force)| {
                    format!("{back}: {} at {force}", with_error(mean, error))
                }),
                outcome
                    .frictionless()
                    .map_or_else(none, |flow| format!("{forward}: {}", number(flow, 2))),
                outside(outcome.escaped(), &outcome.left_out()),
            ]
        })
        .collect();
    ReportTable {
        caption: "Claims against settings: jams that give way (S2), the largest rise of the flow from rest and its forces (S3), the \
                  smallest flow rate and its force (S4), that of frictionless grains (S5), largest part of the grains outside."
            .to_owned(),
        head: [
            "setting",
            "S2: gives way",
            "S3: rise",
            "S4: smallest *J*/*J*_{max}",
            "S5: frictionless",
            "outside",
        ]
        .map(str::to_owned)
        .to_vec(),
        rows,
    }
}

/// Small panels, one a setting: both branches against the force.
fn figure(outcomes: &[Outcome<'_>]) -> Result<Option<ReportFigure>, ClaimError> {
    let panels: Vec<ChartPanel> = outcomes
        .iter()
        .filter(|outcome| !outcome.rest.points.is_empty() || !outcome.jammed.points.is_empty())
        .map(|outcome| {
            let mut panel =
                ChartPanel::new(&label(Axis::ForceAmplitude), &label(Axis::FlowRateRatio))
                    .y_range(-0.2..=1.05)
                    .with(Reference::horizontal(0.0))
                    .title(&outcome.name);
            for (series, name, branch, tint) in [
                (0, "from rest", &outcome.rest, Tint::Blue),
                (1, "from jammed", &outcome.jammed, Tint::Vermillion),
            ] {
                let [force, mean, error] = branch.columns();
                if !force.is_empty() {
                    let points = Points::new(name, &force, &mean)
                        .y_errors(&error)
                        .series(series)
                        .tint(tint)
                        .joined();
                    panel = panel.with(if series == 1 { points.open() } else { points });
                }
            }
            panel
        })
        .collect();
    if panels.is_empty() {
        return Ok(None);
    }
    Ok(Some(ReportFigure {
        name: "sensitivity".to_owned(),
        caption: "Late *J*/*J*_{max} against the force from both starts, for each setting of wall and density.".to_owned(),
        drawing: ChartFigure::grid(3, panels)
            .share_x()
            .share_y()
            .width(Width::DoubleColumn)
            .description("Flow rate against the force for several settings of the wall and of the density.")
            .draw()?,
    }))
}
