//! F1: slow unjammed flow at large widths, a transition to fast jammed flow at small ones.

use peristalsis_configuration::Configuration;
use peristalsis_run::{Run, RunError, snapshot_stack};

use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("f1.md"));
const STUDIES: &[&str] = &["flow-in-time", "branches-*"];

pub(super) const CLAIM: Claim = Claim::new("F1", PROSE, STUDIES, examine);

/// What the branch from rest on one wall at one strain rate says.
struct Kind<'a> {
    branch: Branch<'a>,
    /// Fractions of the runs beyond the jump that stay slow, and of those below it that become fast.
    slow: f64,
    fast: f64,
    /// J/Jmax just beyond the jump, and [`BELOW_THE_JUMP`].
    slow_flow: Uncertain,
    fast_flow: Uncertain,
    /// Contacts of a grain in that fast flow.
    contacts: Option<Uncertain>,
    /// Whether J/Jmax comes near 1 at some width below the jump.
    comes_near: bool,
}

impl<'a> AtRate<'a> for Kind<'a> {
    fn of(runs: &Runs<'a>) -> Option<Self> {
        let mut rows = runs.branches.clone();
        rows.retain(|row| row.start() == Start::Rest);
        let branch = Branch::of(&rows, Start::Rest, Control::Width);
        let [before, after] = branch.step()?.controls;
        let threshold = branch.threshold()?;
        let fraction = |is_beyond: bool| {
            let side = rows.iter().filter(|row| match is_beyond {
                _ if !row.is_stationary() => false,
                true => row.width() >= after,
                false => row.width() <= before,
            });
            let right = |row: &&Row<'_>| (row.flow_rate_ratio() < threshold) == is_beyond;
            side.clone().filter(right).count() as f64 / side.count().max(1) as f64
        };
        let mut points = branch.points.iter();
        let is_below = |point: &&Point<'_>| point.control <= before - BELOW_THE_JUMP;
        let is_near = |point: &Point<'_>| point.control <= before && point.flow.value >= NEAR_ONE;
        let fast_point = points.clone().rfind(is_below)?;
        Some(Self {
            comes_near: points.clone().any(is_near),
            slow: fraction(true),
            fast: fraction(false),
            fast_flow: fast_point.flow,
            contacts: fast_point.mean("contacts"),
            slow_flow: points.find(|point| point.control >= after)?.flow,
            branch,
        })
    }

    fn statistics(&self) -> Statistics {
        self.branch.statistics()
    }
}

impl Kind<'_> {
    /// Whether there are two kinds, whatever the fast flow is.
    fn has_two(&self) -> bool {
        self.branch.jumps()
            && self.slow >= NEARLY_ALL
            && self.fast >= NEARLY_ALL
            && self.slow_flow.value < SLOW
    }

    fn holds(&self) -> bool {
        self.has_two() && self.fast_flow.value >= NEAR_ONE
    }

    /// Whether only the distance decides: the flow comes near J_max, but farther below the jump.
    fn holds_farther(&self) -> bool {
        self.has_two() && self.comes_near && !self.holds()
    }

    /// Whether it holds with grains that F9 does not count as jammed.
    fn coasts(&self) -> bool {
        let touches_little = |contacts: Uncertain| contacts.value < LEAST_CONTACTS;
        self.holds() && self.contacts.is_some_and(touches_little)
    }

    fn row(wall: &str, one: &Shown<Self>) -> Vec<String> {
        let kind = &one.found;
        vec![
            wall.to_owned(),
            number(one.strain_rate, 3),
            number(kind.slow, 2),
            number(kind.fast, 2),
            kind.slow_flow.to_string(),
            kind.fast_flow.to_string(),
            if kind.holds() { "yes" } else { "no" }.to_owned(),
            number(one.escaped, 2),
        ]
    }
}

fn examine(evidence: &Evidence) -> Result<Finding> {
    let walls = OnWall::<Kind<'_>>::all(evidence)?;
    let (mut draft, mut parts, mut rows) = (Draft::of(PROSE), Vec::new(), Vec::new());
    let (mut farther, mut coasting) = (Vec::new(), Vec::new());
    for one in &walls {
        let rates = |one: &OnWall<Kind<'_>>| one.rates(|kind| Some(kind.holds()));
        let place = |is_meant: fn(&Kind<'_>) -> bool| {
            let those = one.tight().filter(|kind| is_meant(&kind.found));
            let those = listed(those.map(|kind| kind.strain_rate));
            (!those.is_empty()).then(|| PROSE.text("place", values!(wall = one.name, those)))
        };
        farther.extend(place(|kind| kind.holds_farther()));
        coasting.extend(place(|kind| kind.coasts()));
        let count = PROSE.text("count", values!(count = rates(one).count()));
        let why = rates(one).in_words();
        parts.push(one.part(|one| rates(one).hold(), count, why));
        rows.extend(one.all.iter().map(|kind| Kind::row(&one.name, kind)));
        for kind in one.tight() {
            let (wall, rate, below) = (&one.name, kind.strain_rate, BELOW_THE_JUMP);
            let flow = kind.found.fast_flow;
            draft.quantity("jammed flow", values!(wall, rate, below), flow);
        }
    }
    let judgement = Judgement::of(parts, &CLAIM.needed);
    if walls.is_empty() {
        return Ok(PROSE.nothing(judgement.statistics));
    }
    let (slow, below, near) = (SLOW, BELOW_THE_JUMP, NEAR_ONE);
    let most = number(100.0 * NEARLY_ALL, 0);
    let summary = PROSE.text("summary", values!(slow, below, near, most));
    draft.table("kinds", values!(below), rows);
    let periods = walls.iter().map(|one| one.periods).fold(0.0, f64::max);
    draft.finding.weaknesses = PROSE.paragraphs("weaknesses", values!(periods));
    if !farther.is_empty() {
        let places = farther.join("; ");
        draft.weakness("farther", values!(below, near, places));
    }
    if !coasting.is_empty() {
        let (contacts, coasting) = (LEAST_CONTACTS, coasting.join("; "));
        draft.weakness("coasting", values!(contacts, coasting));
    }
    in_time(&mut draft, evidence.study("flow-in-time")?)?;
    draft.finding.figures.push(snapshots()?);
    Ok(draft.judged(judgement, &summary))
}

/// J/Jmax in time for several widths, a panel a wall; nothing where only rows were imported.
fn in_time(draft: &mut Draft, study: &StudyResults) -> Result<()> {
    let mut panels = Vec::new();
    let mut widths: Vec<f64> = Vec::new();
    for lattice in [Lattice::COARSE, Lattice::FINE] {
        let mut panel = panel(Axis::Period, Axis::FlowRateRatio).y_range(-0.05..=1.1);
        let mut drawn = None;
        let is_shown = |row: &Row<'_>| row.lattice() == lattice && row.replicate() == 0;
        for row in study.rows().into_iter().filter(is_shown) {
            if let Some(averages) = study.period_averages(&row)? {
                panel = panel.with(course(row.width(), &averages));
                widths.push(row.width());
                drawn = Some(row.strain_rate());
            }
        }
        let name = format!("{} × {}", lattice.spheres_per_ring, lattice.rings_per_wave);
        panels.extend(drawn.map(|rate| panel.title(&format!("{name}, *ε̇* = {rate}"))));
    }
    let Some(first) = widths.first() else {
        return Ok(());
    };
    let (all, otherwise) = (widths.iter().copied(), (*first, first + 0.01));
    let scale = colours(&label(Axis::Width), all, otherwise);
    let chart = grid(2, panels).share_y().colour_scale(scale);
    draft.chart("flow-in-time", &[], chart)
}

/// Widths of the snapshots \[d\]: jammed and unjammed at this strain rate on the wall 24 × 26, after so many periods.
const SNAPSHOTS: [(f64, &str); 2] = [
    (2.9, "unjammed, *w* = 2.9 *d*"),
    (2.5, "jammed, *w* = 2.5 *d*"),
];

/// Both kinds of flow, coloured by the axial velocity; two runs of a tenth of a second.
fn snapshots() -> Result<ReportFigure> {
    let mut runs = Vec::new();
    for (width, name) in SNAPSHOTS {
        let overrides = [
            format!("drive.width={width}"),
            "drive.strain_rate=0.1".to_owned(),
            "run.periods=60".to_owned(),
        ];
        let configuration =
            Configuration::from_preset("frictionless-fine", &overrides).map_err(RunError::from)?;
        let mut run = Run::new(configuration)?;
        while !run.is_complete() {
            run.advance()?;
        }
        runs.push((name, run));
    }
    let labelled: Vec<(&str, &Run)> = runs.iter().map(|(name, run)| (*name, run)).collect();
    Ok(PROSE.figure("snapshots", &[], snapshot_stack(&labelled)?))
}
