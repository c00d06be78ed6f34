//! F8: what the volume fraction changes.

use peristalsis_analysis::fit_line;
use peristalsis_figures::chart::{Corner, Note};

use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("f8.md"));

pub(super) const CLAIM: Claim =
    Claim::new("F8", PROSE, &["density-fine", "density-coarse"], examine);

/// What the source says of the transition time.
const EXPONENT: f64 = 1.0;

/// One density.
struct Density<'a> {
    fraction: f64,
    branch: Branch<'a>,
    critical: Option<Uncertain>,
    exponent: Option<Uncertain>,
    /// J/Jmax at [`COMPARED_WIDTH`].
    flow: Option<Uncertain>,
    statistics: Statistics,
}

impl<'a> Density<'a> {
    fn of(rows: &[Row<'a>]) -> Self {
        let branch = Branch::of(rows, Start::Rest, Control::Width);
        let is_compared = |point: &&Point<'_>| (point.control - COMPARED_WIDTH).abs() < 1e-9;
        let bracket = || branch.step().map(|step| step.place());
        let compared = branch.points.iter().find(is_compared);
        Self {
            fraction: rows[0].number("volume_fraction"),
            critical: crossing(rows).map(|found| found.width).or_else(bracket),
            exponent: Line::at_own_threshold(rows)
                .and_then(|line| line.fit)
                .map(|fit| fit.exponent),
            flow: compared.map(|point| point.flow),
            statistics: branch.statistics(rows.len()),
            branch,
        }
    }

    /// The densities of a study, ascending.
    fn all_of(rows: Vec<Row<'a>>) -> Vec<Self> {
        // The number of grains is whole, so that fractions differ a little from those asked for.
        let key = |row: &Row<'_>| (row.number("volume_fraction") * 100.0).round();
        let groups = grouped(rows, key).into_iter();
        groups.map(|(_, rows)| Self::of(&rows)).collect()
    }

    fn row(&self, lattice: &str) -> Vec<String> {
        vec![
            lattice.to_owned(),
            number(self.fraction, 2),
            cell(self.flow),
            cell(self.critical),
            cell(self.exponent),
        ]
    }
}

/// The three parts of the claim.
struct Judged {
    /// Whether the flow falls with every density, by more than its errors; `None` without one at each.
    slower: Option<bool>,
    /// d w_c/d rho, and the range of w_c over the largest.
    change: Option<Uncertain>,
    relative_change: f64,
    exponent: Option<Uncertain>,
}

impl Judged {
    fn of(densities: &[Density<'_>]) -> Self {
        let flows: Option<Vec<Uncertain>> = densities.iter().map(|density| density.flow).collect();
        let falls = |pair: &[Uncertain]| {
            let fall = distance(&pair[0], &pair[1]);
            fall.value > AGREES_WITHIN * fall.error
        };
        let critical = densities
            .iter()
            .filter_map(|density| Some((density.fraction, density.critical?)));
        let [fraction, width, error] = columns(critical, LEAST_ERROR_OF_A_WIDTH);
        let line = fit_line(&fraction, &width, &error).ok();
        let relative = |(least, largest): (f64, f64)| (largest - least) / largest;
        let exponents = densities.iter().filter_map(|density| density.exponent);
        Self {
            slower: flows.map(|flows| flows.windows(2).all(falls)),
            change: line.as_ref().map(slope),
            relative_change: ends(width.iter().copied()).map_or(0.0, relative),
            exponent: weighted_mean(&exponents.collect::<Vec<_>>()),
        }
    }

    /// Whether all three hold; `None` where one of them cannot be told.
    fn all(&self) -> Option<bool> {
        all_hold(&[
            self.slower,
            Some(self.relative_change < HARDLY),
            self.exponent
                .and_then(|exponent| agrees(&exponent, EXPONENT)),
        ])
    }

    fn in_words(&self, lattice: &str) -> String {
        let how = match self.slower {
            Some(true) => "decreases",
            Some(false) => "does not always decrease",
            None => "is not known at every density, hence not how it changes",
        };
        let change = number(100.0 * self.relative_change, 1);
        let exponent = cell(self.exponent);
        PROSE.text("lattice", values!(lattice, how, change, exponent))
    }

    fn quantities(&self, lattice: &str) -> [Quantity; 2] {
        // What is not known stands there without a number.
        let change = PROSE.quantity("change", values!(lattice), self.change);
        let exponent = PROSE.quantity("exponent", values!(lattice), self.exponent);
        [change.sourced(0.0), exponent.sourced(EXPONENT)]
    }
}

fn examine(evidence: &Evidence) -> Result<Finding> {
    let (mut parts, mut all, mut words) = (Vec::new(), Vec::new(), Vec::new());
    let (mut draft, mut rows, mut panels) = (Draft::of(PROSE), Vec::new(), Vec::new());
    for (lattice, study) in [("fine", "density-fine"), ("coarse", "density-coarse")] {
        let densities = Density::all_of(evidence.study(study)?.rows());
        if densities.is_empty() {
            continue;
        }
        let each = densities.iter().map(|density| density.statistics);
        let statistics = Statistics::weakest_at_one_rate(each);
        all.push(statistics);
        let judged = Judged::of(&densities);
        let mut said = judged.in_words(lattice);
        if densities.len() >= LEAST_DENSITIES {
            parts.push(Part {
                lattice: lattice.to_owned(),
                holds: judged.all(),
                statistics,
            });
        } else {
            said.push_str(&PROSE.text("too few", values!(densities = LEAST_DENSITIES)));
        }
        words.push(said);
        draft.finding.quantities.extend(judged.quantities(lattice));
        rows.extend(densities.iter().map(|density| density.row(lattice)));
        panels.extend(panels_of(lattice, &densities));
    }
    let (verdict, _, why) = judge(&parts, &F8_NEEDED);
    let found = best(all.into_iter(), &F8_NEEDED);
    if words.is_empty() {
        return Ok(PROSE.nothing(found, &F8_NEEDED));
    }
    let summary = PROSE.text("summary", values!(found = words.join(". "), why));
    let (compared, hardly) = (COMPARED_WIDTH, 100.0 * HARDLY);
    draft.finding.paragraphs = PROSE.paragraphs("method", values!(compared, hardly));
    draft.table("densities", values!(compared), rows);
    let chart = grid(3, panels);
    draft.chart("density", &[], chart)?;
    Ok(draft.concluded(verdict, summary, found, &F8_NEEDED))
}

fn panels_of(lattice: &str, densities: &[Density<'_>]) -> [ChartPanel; 3] {
    let flow = |density: &Density<'_>| {
        let name = format!("*ρ* = {}", number(density.fraction, 2));
        branch_points(&name, &density.branch)
    };
    let flow = flow_panel()
        .title(&format!("{lattice} lattice"))
        .with_all(numbered(densities.iter().map(flow)));
    let against = |name: &str, value: fn(&Density<'_>) -> Option<Uncertain>| {
        let known = densities
            .iter()
            .filter_map(|density| Some((density.fraction, value(density)?)))
            .filter(|(_, one)| one.error.is_finite());
        let panel = ChartPanel::new(&label(Axis::VolumeFraction), name);
        match points("", known) {
            Some(points) => panel.with(points),
            None => panel
                .x_range(0.0..=0.7)
                .y_range(0.0..=2.0)
                .with(Note::corner(Corner::TopLeft, "too few transitions")),
        }
    };
    [
        flow,
        against(&label(Axis::CriticalWidth), |density| density.critical),
        against("exponent, *α*", |density| density.exponent),
    ]
}
