//! F6: the stationary flow jumps, which a Newtonian fluid's does not.

use peristalsis_physics::newtonian::NewtonianPeristalsis;

use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("f6.md"));

pub(super) const CLAIM: Claim = Claim::new("F6", PROSE, &["branches-*"], examine);

/// The branch from rest at one strain rate, with its largest fall.
struct Jump<'a> {
    branch: Branch<'a>,
    fall: Step,
    height: Option<Uncertain>,
    /// J/Jmax of the runs from rest near the fall, for the histogram.
    near: Vec<f64>,
}

impl<'a> AtRate<'a> for Jump<'a> {
    fn of(runs: &Runs<'a>) -> Option<Self> {
        let rows = &runs.branches;
        let branch = Branch::of(rows, Start::Rest, Control::Width);
        let fall = branch.step()?;
        let [before, after] = fall.controls;
        let is_near = |row: &&Row<'_>| {
            row.start() == Start::Rest
                && row.width() > before - NEAR_THE_JUMP
                && row.width() < after + NEAR_THE_JUMP
        };
        let near = rows.iter().filter(is_near).map(Row::flow_rate_ratio);
        Some(Self {
            near: near.filter(|ratio| ratio.is_finite()).collect(),
            height: branch.jump().map(|jump| jump.height),
            branch,
            fall,
        })
    }

    fn statistics(&self) -> Statistics {
        self.branch.statistics()
    }
}

impl Jump<'_> {
    fn row(wall: &str, one: &Shown<Self>) -> Vec<String> {
        let jump = &one.found;
        let [before, after] = jump.fall.controls;
        vec![
            wall.to_owned(),
            number(one.strain_rate, 3),
            format!("{} … {}", number(before, 3), number(after, 3)),
            cell(jump.height),
            if jump.branch.jumps() {
                "jump"
            } else {
                "none seen"
            }
            .to_owned(),
            number(one.escaped, 2),
        ]
    }
}

/// What one wall says: at how many strain rates the flow jumps, and from the lowest jump to the highest.
fn part(one: &OnWall<Jump<'_>>) -> Part {
    let judged = |one: &OnWall<Jump<'_>>| one.rates(|jump| Some(jump.branch.jumps()));
    let rates = judged(one);
    let jumping = one.tight().filter(|one| one.found.branch.jumps());
    let heights = jumping.filter_map(|one| Some(one.found.height?.value));
    let heights = match ends(heights) {
        Some((least, most)) => format!(", {} to {}", number(least, 2), number(most, 2)),
        None => String::new(),
    };
    let count = PROSE.text("count", values!(count = rates.count(), heights));
    one.part(|one| judged(one).hold(), count, rates.in_words())
}

fn examine(evidence: &Evidence) -> Result<Finding> {
    let walls = OnWall::<Jump<'_>>::all(evidence)?;
    let (mut draft, mut rows) = (Draft::of(PROSE), Vec::new());
    for one in &walls {
        for jump in one.tight() {
            let (wall, rate) = (&one.name, jump.strain_rate);
            draft.quantity("height", values!(wall, rate), jump.found.height);
        }
        rows.extend(one.all.iter().map(|jump| Jump::row(&one.name, jump)));
    }
    let judgement = Judgement::of(walls.iter().map(part).collect(), &CLAIM.needed);
    if rows.is_empty() {
        return Ok(PROSE.nothing(judgement.statistics));
    }
    let summary = PROSE.text("summary", values!(least = LEAST_JUMP, clear = CLEAR));
    draft.table("jumps", &[], rows);
    let periods = walls.iter().map(|one| one.periods).fold(0.0, f64::max);
    draft.finding.paragraphs = PROSE.paragraphs("method", values!(periods));
    let rates = walls.iter().flat_map(|one| &one.all);
    let chart = grid(2, walls.iter().map(beside_a_fluid))
        .share_y()
        .colour_scale(rate_colours(rates.map(|one| one.strain_rate)));
    draft.chart("stationary-flow", &[], chart)?;
    let histogram = |one: &OnWall<Jump<'_>>| {
        let near = one.tight().flat_map(|one| &one.found.near);
        let bars = flow_histogram(&near.copied().collect::<Vec<_>>(), -0.05, 1.05)?;
        let panel = ChartPanel::new(&label(Axis::FlowRateRatio), "runs").with(bars);
        Some(panel.title(&one.name))
    };
    let panels: Vec<ChartPanel> = walls.iter().filter_map(histogram).collect();
    if !panels.is_empty() {
        let chart = grid(2, panels);
        draft.chart("two-peaks", values!(near = NEAR_THE_JUMP), chart)?;
    }
    Ok(draft.judged(judgement, &summary))
}

/// The branches on one wall beside the flow of a Newtonian fluid.
fn beside_a_fluid(one: &OnWall<Jump<'_>>) -> ChartPanel {
    let branches = one.all.iter();
    let branches = branches.map(|one| (one.strain_rate, branch_points("", &one.found.branch)));
    // Radius of the tube to the centres of the wall spheres, and half a diameter.
    let (radius, half) = (1.5, 0.5);
    let widths = spaced(2.4, 3.0, 60);
    let newtonian = |name: &str, inset: f64, tint: Tint| {
        let ratio = |width: &f64| {
            NewtonianPeristalsis::from_width(width - 2.0 * inset, radius - inset, 0.0)
                .map_or(f64::NAN, |fluid| fluid.flow_rate_ratio())
        };
        let ratios: Vec<f64> = widths.iter().map(ratio).collect();
        Curve::new(name, &widths, &ratios)
            .tint(tint)
            .pattern(Pattern::Dashed)
    };
    flow_panel()
        .title(&one.name)
        .with_all(coloured(branches))
        .with(newtonian("Newtonian", 0.0, Tint::Black))
        .with(newtonian("Newtonian, clear bore", half, Tint::Grey))
}
