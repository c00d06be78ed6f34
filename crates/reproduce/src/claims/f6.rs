//! F6: the stationary flow jumps, which a Newtonian fluid's does not.

use peristalsis_physics::newtonian::NewtonianPeristalsis;

use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("f6.md"));

pub(super) const CLAIM: Claim =
    Claim::new("F6", PROSE, &["branches-fine", "branches-coarse"], examine);

/// The branch from rest at one strain rate, with its largest fall.
struct Line<'a> {
    strain_rate: f64,
    branch: Branch<'a>,
    fall: Step,
    height: Option<Uncertain>,
    /// J/Jmax of the runs from rest near the fall.
    near: Vec<f64>,
    runs: usize,
}

impl<'a> AtRate<'a> for Line<'a> {
    fn of(_: Lattice, strain_rate: f64, rows: Vec<Row<'a>>) -> Option<Self> {
        let branch = Branch::of(&rows, Start::Rest, Control::Width);
        let fall = branch.step()?;
        let [before, after] = fall.controls;
        let is_near = |row: &&Row<'_>| {
            row.start() == Start::Rest
                && row.width() > before - NEAR_THE_JUMP
                && row.width() < after + NEAR_THE_JUMP
        };
        let near = rows.iter().filter(is_near).map(Row::flow_rate_ratio);
        Some(Self {
            strain_rate,
            near: near.filter(|ratio| ratio.is_finite()).collect(),
            height: branch.jump().map(|jump| jump.height),
            runs: rows.len(),
            branch,
            fall,
        })
    }

    fn escaped(&self) -> f64 {
        self.branch.escaped()
    }

    fn statistics(&self) -> Statistics {
        self.branch.statistics(self.runs)
    }
}

impl Line<'_> {
    fn row(&self, lattice: &str) -> Vec<String> {
        let [before, after] = self.fall.controls;
        let jumps = self.branch.jumps();
        let [peaks, dip] = cells_of_peaks(&self.near);
        vec![
            lattice.to_owned(),
            number(self.strain_rate, 3),
            format!("{} … {}", number(before, 3), number(after, 3)),
            cell(self.height),
            if jumps { "jump" } else { "none seen" }.to_owned(),
            peaks,
            dip,
            number(self.escaped(), 2),
        ]
    }
}

fn examine(evidence: &Evidence) -> Result<Finding> {
    let needed = Statistics::FOR_A_VERDICT;
    let both = Shown::<Line<'_>>::on_both(evidence)?;
    let (mut parts, mut counts, mut rows) = (Vec::new(), Vec::new(), Vec::new());
    let (mut draft, mut means) = (Draft::of(PROSE), Vec::new());
    for one in &both {
        let name = &one.name;
        let all = one.tight().count();
        let jumping = one.tight().filter(|line| line.branch.jumps()).count();
        counts.push(PROSE.text("count", values!(jumping, all, lattice = name)));
        parts.push(one.part(jumping == all));
        let heights: Vec<Uncertain> = one.tight().filter_map(|line| line.height).collect();
        means.extend(weighted_mean(&heights).map(|mean| {
            let rates = heights.len();
            PROSE.quantity("mean height", values!(lattice = name, rates), mean)
        }));
        for line in one.tight() {
            let rate = &line.strain_rate;
            draft.quantity("height", values!(lattice = name, rate), line.height);
        }
        rows.extend(one.all.iter().map(|line| line.row(name)));
    }
    let (verdict, statistics, why) = judge(&parts, &needed);
    if rows.is_empty() {
        return Ok(PROSE.nothing(statistics, &needed));
    }
    let summary = PROSE.text("summary", values!(counts = counts.join(" and "), why));
    let quantities = &mut draft.finding.quantities;
    quantities.splice(0..0, means.into_iter().rev());
    draft.table("jumps", values!(near = NEAR_THE_JUMP), rows);
    let periods = both.iter().map(|one| one.periods).fold(0.0, f64::max);
    draft.finding.paragraphs = PROSE.paragraphs("method", values!(periods));
    let rates = both.iter().flat_map(|one| &one.all);
    let chart = grid(2, both.iter().map(beside_a_fluid))
        .share_y()
        .colour_scale(rate_colours(rates.map(|line| line.strain_rate)));
    draft.chart("stationary-flow", &[], chart)?;
    let [fine, _] = &both;
    let near: Vec<f64> = fine.tight().flat_map(|line| &line.near).copied().collect();
    if let Some(bars) = flow_histogram(&near, -0.05, 1.05, 22) {
        let panel = ChartPanel::new(&label(Axis::FlowRateRatio), "runs").with(bars);
        let chart = ChartFigure::new(panel);
        draft.chart("two-peaks", values!(near = NEAR_THE_JUMP), chart)?;
    }
    Ok(draft.concluded(verdict, summary, statistics, &needed))
}

/// The branches of one lattice beside the flow of a Newtonian fluid.
fn beside_a_fluid(lattice: &Shown<Line<'_>>) -> ChartPanel {
    let branches = lattice.all.iter();
    let branches = branches.map(|line| (line.strain_rate, branch_points("", &line.branch)));
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
        .title(&format!("{} lattice", lattice.name))
        .with_all(coloured(branches))
        .with(newtonian("Newtonian", 0.0, Tint::Black))
        .with(newtonian("Newtonian, clear bore", half, Tint::Grey))
}
