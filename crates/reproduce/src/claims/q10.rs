//! Q10: how far the conclusions on the elastic tube depend on what the source does not give.

use super::elastic::*;
use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("q10.md"));

pub(super) const CLAIM: Claim =
    Claim::new("Q10", PROSE, &["elastic-sensitivity"], examine).varying("force", Q10_NEEDED);

/// Keys of the wall and of the density with the preset's number, and how a departure from it is called.
const NUMBERS: [(&str, f64, &str); 8] = [
    ("grains.number_density", 0.71, "*n*"),
    ("wall.spring_stiffness", 0.018, "*k*_{w}"),
    ("wall.natural_length", 0.7, "*l*"),
    ("wall.keep.azimuthal", 0.1, "azimuthal tether"),
    ("wall.keep.axial", 0.01, "axial tether"),
    ("wall.keep.radial", 0.0, "radial tether"),
    ("wall.drag", 0.0, "drag"),
    ("wall.sphere_mass", 0.1, "*m*_{w}"),
];
/// Keys with a text that the preset does not have, and how it is called.
const TEXTS: [(&str, &str, &str); 4] = [
    ("wall.keep.balance", "false", "springs not balanced"),
    ("wall.keep.net_force", "free", "mean force not removed"),
    ("drive.angle", "current", "force along the current angle"),
    ("contact.sliding", "literal", "sliding as printed"),
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
fn setting(row: &Row<'_>) -> String {
    let numbers = NUMBERS.iter().filter_map(|(key, preset, name)| {
        let value = row.number(key);
        (!value.is_nan() && value != *preset).then(|| match value {
            0.0 => format!("no {name}"),
            value => format!("{name} = {value}"),
        })
    });
    let texts = TEXTS
        .iter()
        .filter(|(key, text, _)| row.text(key) == *text)
        .map(|(.., name)| (*name).to_owned());
    let words: Vec<String> = numbers.chain(texts).collect();
    if words.is_empty() {
        PRESET.to_owned()
    } else if words == NOTHING_KEEPS {
        "nothing keeps the wall".to_owned()
    } else {
        words.join(", ")
    }
}

/// What the claims come to under one setting; `None` where it cannot be said.
struct Outcome<'a> {
    name: String,
    rows: Vec<Row<'a>>,
    /// Those at forces at which grains stay in the tube.
    tight: Vec<Row<'a>>,
    /// Of grains with friction.
    flow: Branches<'a>,
}

impl<'a> Outcome<'a> {
    /// The outcomes of all settings, the preset first, whatever the order of the rows.
    fn all_of(rows: Vec<Row<'a>>) -> Vec<Self> {
        let mut groups: Vec<(String, Vec<Row<'a>>)> = Vec::new();
        for row in rows {
            let name = setting(&row);
            match groups.iter_mut().find(|group| group.0 == name) {
                Some(group) => group.1.push(row),
                None => groups.push((name, vec![row])),
            }
        }
        groups.sort_by_key(|(name, _)| name != PRESET);
        let outcomes = groups.into_iter();
        outcomes.map(|(name, rows)| Self::of(name, rows)).collect()
    }

    fn of(name: String, rows: Vec<Row<'a>>) -> Self {
        // Grains with friction and without fill the tube differently: one kind may stay where the other leaves.
        let (frictionless, frictional): (Vec<Row<'_>>, Vec<Row<'_>>) =
            rows.iter().partition(|row| is_frictionless(row));
        let leaks = [leaking(&frictional), leaking(&frictionless)];
        let is_tight =
            |row: &&Row<'_>| !leaks[usize::from(is_frictionless(row))].contains(&row.force());
        let tight: Vec<Row<'a>> = rows.iter().filter(is_tight).copied().collect();
        let (_, frictional): (Vec<Row<'a>>, Vec<Row<'a>>) =
            tight.iter().partition(|row| is_frictionless(row));
        Self {
            name,
            flow: Branches::of(&frictional, Control::Force),
            rows,
            tight,
        }
    }

    /// Whether grains stay in the tube at so many forces that the claims can be told.
    fn holds_its_grains(&self) -> bool {
        grouped(self.tight.iter(), |row| row.force()).len() >= LEAST_FORCES
    }

    /// Largest part of the grains outside, and the forces at which too many are, in words.
    fn outside(&self) -> String {
        let escaped = largest(&self.rows, Row::escaped_fraction);
        let left_out: Vec<f64> = grouped(self.rows.iter(), |row| row.force())
            .into_iter()
            .map(|(force, _)| force)
            .filter(|force| self.tight.iter().all(|row| row.force() != *force))
            .collect();
        outside(escaped, &left_out)
    }

    /// Runs from jammed in which the jam gave way, of all: S2.
    fn gives_way(&self) -> Option<(usize, usize)> {
        let jammed = |row: &&Row<'_>| row.start() == Start::Jammed && !is_frictionless(row);
        let jammed: Vec<&Row<'_>> = self.tight.iter().filter(jammed).collect();
        let gave_way = |row: &&&Row<'_>| row.transition_at(GIVEN_WAY).observed().is_some();
        let gave = jammed.iter().filter(gave_way).count();
        (!jammed.is_empty()).then_some((gave, jammed.len()))
    }

    /// The largest rise between neighbouring forces: S3.
    fn rise(&self) -> Option<Step> {
        self.flow.rest.rise()
    }

    /// The flow rate of frictionless grains, the smallest of all runs: S5.
    fn frictionless(&self) -> Option<f64> {
        let frictionless = self.tight.iter().filter(|row| is_frictionless(row));
        frictionless
            .map(Row::flow_rate_ratio)
            .filter(|ratio| ratio.is_finite())
            .reduce(f64::min)
    }

    /// Whether each of S2 to S5 holds. A flow that does not span the rise may rise beyond the forces that were tried.
    fn holds(&self) -> [Option<bool>; 4] {
        let rises = |rise: Step| {
            let is_high = rise.height.value > LEAST_JUMP_AGAINST_FORCE;
            (is_high || self.flow.spans()).then_some(is_high)
        };
        let flows_back = |point: &Point<'_>| is_clearly_below(point, -LEAST_BACK_FLOW);
        [
            self.gives_way().map(|(gave, all)| gave > 0 && gave < all),
            self.rise().and_then(rises),
            self.flow.lowest().map(flows_back),
            self.frictionless().map(|flow| flow > -LEAST_BACK_FLOW),
        ]
    }

    /// What was run, whether or not grains left the tube.
    fn statistics(&self) -> Statistics {
        let from_rest = self.rows.iter().filter(|row| row.start() == Start::Rest);
        let frictional = from_rest.filter(|row| !is_frictionless(row));
        Statistics {
            runs: self.rows.len(),
            ..Statistics::at_one_rate(frictional.map(Row::force))
        }
    }

    fn row(&self) -> Vec<String> {
        let [gives_way, jumps, back, forward] = self.holds().map(|holds| match holds {
            Some(true) => "yes",
            Some(false) => "no",
            None => "–",
        });
        vec![
            self.name.clone(),
            cell_of(self.gives_way(), |(gave, all)| {
                format!("{gives_way}: {gave} of {all}")
            }),
            cell_of(self.rise(), |rise| {
                let (height, [before, after]) = (number(rise.height.value, 2), rise.controls);
                format!("{jumps}: {height} at {before} … {after}")
            }),
            cell_of(self.flow.lowest(), |point| {
                format!("{back}: {} at {}", point.flow, point.control)
            }),
            cell_of(self.frictionless(), |flow| {
                format!("{forward}: {}", number(flow, 2))
            }),
            self.outside(),
        ]
    }
}

fn examine(evidence: &Evidence) -> Result<Finding> {
    let outcomes = Outcome::all_of(evidence.study("elastic-sensitivity")?.rows());
    if outcomes.is_empty() {
        return Ok(PROSE.nothing(Statistics::default()));
    }
    let tight = outcomes.iter().filter(|outcome| outcome.holds_its_grains());
    let tight: Vec<[Option<bool>; 4]> = tight.map(Outcome::holds).collect();
    let words = ["S2", "S3", "S4", "S5"].into_iter().enumerate();
    let words: Vec<String> = words
        .map(|(place, name)| {
            let known: Vec<bool> = tight.iter().filter_map(|holds| holds[place]).collect();
            let holding = known.iter().filter(|holds| **holds).count();
            format!("{name} in {holding} of {}", known.len())
        })
        .collect();
    let verdict = Verdict::answered_if(outcomes.len() >= LEAST_SETTINGS);
    let (settings, tight, holding) = (outcomes.len(), tight.len(), words.join(", "));
    let summary = PROSE.text("summary", values!(settings, tight, holding));
    let statistics = Statistics::weakest_at_one_rate(outcomes.iter().map(Outcome::statistics));
    let mut draft = Draft::of(PROSE);
    draft.table("settings", &[], outcomes.iter().map(Outcome::row));
    let panels: Vec<ChartPanel> = outcomes.iter().filter_map(flow_of).collect();
    if !panels.is_empty() {
        let chart = grid(3, panels).share_x().share_y();
        draft.chart("sensitivity", &[], chart)?;
    }
    Ok(draft.concluded(verdict, summary, statistics))
}

/// Both branches of one setting; `None` where they are empty.
fn flow_of(outcome: &Outcome<'_>) -> Option<ChartPanel> {
    let [rest, jammed] = both_starts(&outcome.flow);
    let rest = rest.map(|points| points.tint(Tint::Blue));
    let jammed = jammed.map(|points| points.tint(Tint::Vermillion));
    (rest.is_some() || jammed.is_some()).then(|| {
        flow_against_force()
            .y_range(-0.2..=1.05)
            .with(Reference::horizontal(0.0))
            .title(&outcome.name)
            .with_all(rest)
            .with_all(jammed)
    })
}
