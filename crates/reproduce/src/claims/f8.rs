//! F8: what the volume fraction changes.

use peristalsis_analysis::fit_line_to_scatter;
use peristalsis_figures::chart::{Corner, Note};

use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("f8.md"));

const STUDIES: &[&str] = &["density-*", "divergence-*", "near-*", "branches-*"];

pub(super) const CLAIM: Claim =
    Claim::new("F8", PROSE, STUDIES, examine).varying("width", F8_NEEDED);

/// What the source says of the transition time.
const EXPONENT: f64 = 1.0;

/// One density.
struct Density<'a> {
    fraction: f64,
    strain_rate: f64,
    branch: Branch<'a>,
    critical: Option<Uncertain>,
    /// The laws of the transition time next to w_c.
    near: Option<Near>,
    /// J/Jmax at [`COMPARED_WIDTH`].
    flow: Option<Uncertain>,
    /// Fraction of the grains outside the tube near w_c.
    escaped: f64,
    statistics: Statistics,
}

impl<'a> Density<'a> {
    fn of(rows: &[Row<'a>]) -> Self {
        let branch = Branch::of(rows, Start::Rest, Control::Width);
        let is_compared = |point: &&Point<'_>| (point.control - COMPARED_WIDTH).abs() < 1e-9;
        let bracket = || branch.step().map(|step| step.place());
        let compared = branch.points.iter().find(is_compared);
        let critical = crossing(rows).map(|found| found.width).or_else(bracket);
        Self {
            fraction: rows[0].volume_fraction(),
            strain_rate: rows[0].strain_rate(),
            critical,
            escaped: leak(rows, critical.map(|width| width.value)),
            near: Line::at_own_threshold(rows).and_then(|line| Near::of(&line)),
            flow: compared.map(|point| point.flow),
            statistics: branch.statistics(),
            branch,
        }
    }

    /// Takes over the laws of F2, whose widths lie nearer to w_c, at the density and strain rate that it has.
    fn take_over(&mut self, lines: &OnWall<Line<'_>>) {
        let is_same = |line: &&Line<'_>| {
            line.strain_rate == self.strain_rate && line.volume_fraction() == self.fraction
        };
        let mut lines = lines.tight().map(|shown| &shown.found);
        if let Some(near) = lines.find(is_same).and_then(|line| line.near.clone()) {
            self.near = Some(near);
        }
    }

    /// 2a \[d\].
    fn diameter(&self) -> f64 {
        let rows = self.branch.points.iter().flat_map(|point| &point.rows);
        rows.map(|row| 2.0 * row.radius())
            .next()
            .unwrap_or(f64::NAN)
    }

    /// The densities of a study, ascending.
    fn all_of(rows: Vec<Row<'a>>) -> Vec<Self> {
        let groups = grouped(rows, Row::volume_fraction).into_iter();
        groups.map(|(_, rows)| Self::of(&rows)).collect()
    }

    /// Whether the tube holds its grains, so that it counts.
    fn is_tight(&self) -> bool {
        self.escaped <= MOST_ESCAPED
    }

    /// alpha next to w_c.
    fn exponent(&self) -> Option<Uncertain> {
        self.near.as_ref()?.exponent()
    }

    fn row(&self, wall: &str) -> Vec<String> {
        let diameter = self.diameter();
        vec![
            wall.to_owned(),
            number(self.fraction, 2),
            cell(self.flow),
            cell(self.critical),
            cell(
                self.critical
                    .map(|width| Uncertain::normal(diameter, 0.0) - width),
            ),
            cell(self.exponent()),
            number(self.escaped, 2),
        ]
    }
}

/// The three parts of the claim.
struct Judged {
    /// Whether the flow falls with every density, by more than its errors; `None` without one at each.
    slower: Option<bool>,
    /// d w_c/d rho, and the range of 2a − w_c over its mean.
    change: Option<Uncertain>,
    relative_change: f64,
    /// Range of w_c over its mean.
    change_of_width: f64,
    /// Densities at which alpha = 1 next to w_c.
    linear: Rates,
    exponent: Option<Uncertain>,
}

impl Judged {
    fn of(densities: &[Density<'_>]) -> Self {
        let flows: Option<Vec<Uncertain>> = densities.iter().map(|density| density.flow).collect();
        let falls = |pair: &[Uncertain]| distance(&pair[0], &pair[1]).is_above(0.0);
        let critical = densities
            .iter()
            .filter_map(|density| Some((density.fraction, density.critical?)));
        let [fraction, width, error] = columns(critical, 0.0);
        let line = fit_line_to_scatter(&fraction, &width, &error).ok();
        let diameter = densities[0].diameter();
        let relative = |from: &dyn Fn(f64) -> f64| {
            let values = width.iter().map(|width| from(*width));
            let mean = values.clone().sum::<f64>() / width.len().max(1) as f64;
            ends(values).map_or(0.0, |(least, largest)| (largest - least) / mean)
        };
        let linear = densities.iter().map(|density| {
            let near = density.near.as_ref();
            let holds = near.and_then(|near| near.is_linear(|one| agrees(one, EXPONENT)));
            (density.fraction, holds)
        });
        let exponents = densities.iter().filter_map(Density::exponent);
        Self {
            slower: flows.map(|flows| flows.windows(2).all(falls)),
            change: line.map(|line| line.line.slope),
            relative_change: relative(&|width| diameter - width),
            change_of_width: relative(&|width| width),
            linear: Rates::of(linear),
            exponent: weighted_mean(&exponents.collect::<Vec<_>>()),
        }
    }

    /// Whether all three hold; `None` where one of them cannot be told.
    fn all(&self) -> Option<bool> {
        all_hold(&[
            self.slower,
            Some(self.relative_change < HARDLY),
            self.linear.hold(),
        ])
    }

    fn number(&self) -> String {
        let change = number(100.0 * self.relative_change, 0);
        let of_width = number(100.0 * self.change_of_width, 1);
        let exponent = cell(self.exponent);
        PROSE.text("number", values!(change, of_width, exponent))
    }

    fn why(&self) -> String {
        let how = match self.slower {
            Some(true) => "decreases",
            Some(false) => "does not always fall",
            None => "is not known at every density",
        };
        let hardly = match self.relative_change < HARDLY {
            true => "hardly depends",
            false => "depends",
        };
        let linear = self.linear.in_words().replace("*ε̇*", "*ρ*");
        PROSE.text("why", values!(how, hardly, linear))
    }

    fn quantities(&self, wall: &str) -> [Quantity; 2] {
        // What is not known stands there without a number.
        let change = PROSE.quantity("change", values!(wall), self.change);
        let exponent = PROSE.quantity("exponent", values!(wall), self.exponent);
        [change.sourced(0.0), exponent.sourced(EXPONENT)]
    }
}

fn examine(evidence: &Evidence) -> Result<Finding> {
    let mut parts = Vec::new();
    let (mut draft, mut rows, mut panels) = (Draft::of(PROSE), Vec::new(), Vec::new());
    let lines = OnWall::<Line<'_>>::all(evidence)?;
    for wall in WALLS {
        let mut densities = Density::all_of(wall.rows("density", evidence));
        if let Some(lines) = lines.iter().find(|lines| lines.name == wall.name()) {
            densities
                .iter_mut()
                .for_each(|density| density.take_over(lines));
        }
        if densities.is_empty() {
            continue;
        }
        let wall = wall.name();
        rows.extend(densities.iter().map(|density| density.row(&wall)));
        let (tight, leaking): (Vec<_>, Vec<_>) = densities.into_iter().partition(Density::is_tight);
        if tight.is_empty() {
            continue;
        }
        panels.extend(panels_of(&wall, &tight));
        let judged = Judged::of(&tight);
        let is_enough = tight.len() >= LEAST_DENSITIES;
        let each = tight.iter().map(|density| density.statistics);
        let left_out = match listed(leaking.iter().map(|density| density.fraction)) {
            none if none.is_empty() => none,
            leaking => PROSE.text("left out", values!(leaking)),
        };
        parts.push(Part {
            wall: wall.clone(),
            holds: judged.all().filter(|_| is_enough),
            depends_on: Vec::new(),
            statistics: Statistics::weakest_at_one_rate(each),
            number: judged.number(),
            why: judged.why() + &left_out,
        });
        draft.finding.quantities.extend(judged.quantities(&wall));
    }
    let judgement = Judgement::of(parts, &CLAIM.needed);
    if rows.is_empty() {
        return Ok(PROSE.nothing(judgement.statistics));
    }
    let hardly = number(100.0 * HARDLY, 0);
    let summary = PROSE.text("summary", values!(hardly, least = LEAST_DENSITIES));
    let compared = COMPARED_WIDTH;
    draft.finding.paragraphs = PROSE.paragraphs("method", values!(compared));
    draft.table("densities", values!(compared), rows);
    if !panels.is_empty() {
        let widths = STRAIGHT;
        draft.chart("density", values!(widths), grid(3, panels).alike_y())?;
    }
    Ok(draft.judged(judgement, &summary))
}

fn panels_of(wall: &str, densities: &[Density<'_>]) -> [ChartPanel; 3] {
    let flow = |density: &Density<'_>| {
        let name = format!("*ρ* = {}", number(density.fraction, 2));
        branch_points(&name, &density.branch)
    };
    let flow = flow_panel()
        .title(wall)
        .with_all(numbered(densities.iter().map(flow)));
    let against = |name: &str, value: &dyn Fn(&Density<'_>) -> Option<Uncertain>| {
        let known = densities
            .iter()
            .filter_map(|density| Some((density.fraction, value(density)?)));
        let panel = ChartPanel::new(&label(Axis::VolumeFraction), name).x_range(0.0..=0.7);
        match points("", known) {
            Some(points) => panel.with(points),
            None => panel.with(Note::corner(Corner::TopLeft, "too few transitions")),
        }
    };
    [
        flow,
        against(&label(Axis::CriticalWidth), &|density| density.critical),
        against("exponent, *α*", &|density| density.exponent()),
    ]
}
