//! Q1: small strain rates.

use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("q1.md"));
const STUDIES: &[&str] = &[
    "small-strain-rate-coarse",
    "small-strain-rate-fine",
    "branches-coarse",
    "branches-fine",
];

pub(super) const CLAIM: Claim =
    Claim::new("Q1", PROSE, STUDIES, examine).varying("width", Q1_NEEDED);

/// The lattices, whose names end those of their studies.
const LATTICES: [&str; 2] = ["coarse", "fine"];

/// One strain rate on one lattice.
struct Line {
    lattice: &'static str,
    strain_rate: f64,
    critical: Uncertain,
    jammed: Option<Uncertain>,
    height: Option<Uncertain>,
    /// The width at which the flow passes one half.
    half: Option<f64>,
    /// Whether the fall counts as a jump.
    jumps: bool,
    /// Whether there are runs from jammed.
    both_starts: bool,
    /// Longest time of a run, in periods.
    periods: f64,
    statistics: Statistics,
}

impl Line {
    /// `None` where there is no branch from rest, or grains leave the tube.
    fn of(lattice: &'static str, strain_rate: f64, rows: &[Row<'_>]) -> Option<Self> {
        let flow = Branches::of(rows, Control::Width);
        let Branches { rest, jammed } = flow;
        let fall = rest.step()?;
        let is_tight = leak(rows, Some(fall.place().value)) <= MOST_ESCAPED;
        let falls = jammed.step().filter(|step| -step.height.value > LEAST_FALL);
        is_tight.then(|| Self {
            lattice,
            strain_rate,
            critical: fall.place(),
            jammed: falls.map(|step| step.place()),
            height: rest.jump().map(|jump| jump.height),
            half: crossing_of_half(&rest),
            jumps: rest.jumps(),
            both_starts: !jammed.points.is_empty(),
            periods: longest(rows),
            statistics: rest.statistics(),
        })
    }

    fn row(&self) -> Vec<String> {
        let none = if self.both_starts { "none seen" } else { NONE };
        vec![
            self.lattice.to_owned(),
            number(self.strain_rate, 4),
            self.critical.to_string(),
            self.jammed
                .map_or(none.to_owned(), |width| width.to_string()),
            cell(self.height),
            if self.jumps { "jump" } else { "none seen" }.to_owned(),
            number(self.periods, 0),
            cell_of(self.half, |width| number(width, 3)),
        ]
    }
}

fn examine(evidence: &Evidence) -> Result<Finding> {
    let mut lines: Vec<Line> = Vec::new();
    let mut all = Vec::new();
    for lattice in LATTICES {
        let of = |study: &str| -> Result<Vec<Line>> {
            let study = evidence.study(&format!("{study}-{lattice}"))?;
            let rates = by_strain_rate(study.rows()).into_iter();
            Ok(rates
                .filter_map(|(rate, rows)| Line::of(lattice, rate, &rows))
                .collect())
        };
        let mut here = of("small-strain-rate")?;
        all.push(Statistics::weakest(here.iter().map(|line| line.statistics)));
        // Strain rates of both studies are taken from the one that is about them.
        let is_new = |line: &Line| {
            let mut known = here.iter().map(|known| known.strain_rate);
            !known.any(|rate| rate == line.strain_rate)
        };
        let usual: Vec<Line> = of("branches")?.into_iter().filter(is_new).collect();
        here.extend(usual);
        here.sort_by(|one, other| one.strain_rate.total_cmp(&other.strain_rate));
        lines.extend(here);
    }
    let statistics = best(all.into_iter(), &CLAIM.needed);
    if lines.is_empty() {
        return Ok(PROSE.nothing(statistics));
    }
    let words = LATTICES.map(|lattice| {
        let here = lines.iter().filter(|line| line.lattice == lattice);
        in_words(lattice, &here.collect::<Vec<_>>())
    });
    let summary = PROSE.text("summary", values!(lattices = words.join(". ")));
    let mut draft = Draft::of(PROSE);
    for line in lines.iter().filter(|line| line.jumps) {
        let (lattice, rate) = (line.lattice, line.strain_rate);
        draft.quantity("critical width", values!(lattice, rate), line.critical);
    }
    draft.table("falls", &[], lines.iter().map(Line::row));
    draft.chart("small-strain-rates", &[], figure(&lines))?;
    Ok(draft.concluded(Verdict::Answered, summary, statistics))
}

/// What the lines of one lattice say.
fn in_words(lattice: &str, lines: &[&Line]) -> String {
    let slowest = lines.iter().find(|line| line.jumps);
    let jump = slowest.map_or_else(
        || PROSE.text("no jump", &[]),
        |line| {
            let (rate, width) = (line.strain_rate, line.critical);
            PROSE.text("jump", values!(rate, width))
        },
    );
    let steady = lines.iter().filter(|line| !line.jumps);
    let steady = match &*listed(steady.map(|line| line.strain_rate)) {
        "" => String::new(),
        rates => format!(" {}", PROSE.text("steady", values!(rates))),
    };
    let (turning, half) = (turning(lines), turning_of_half(lines));
    PROSE.text("lattice", values!(lattice, jump, steady, turning, half))
}

/// Whether the critical width falls toward the smallest strain rates at which there is a jump, by more than its errors.
fn turning(lines: &[&Line]) -> String {
    let jumps = || lines.iter().filter(|line| line.jumps);
    let highest = jumps().max_by(|one, other| one.critical.value.total_cmp(&other.critical.value));
    let (Some(slowest), Some(highest)) = (jumps().next(), highest) else {
        return PROSE.text("cannot turn", &[]);
    };
    let fall = highest.critical - slowest.critical;
    if fall.deviations_from(0.0) > CLEAR_TURN {
        let (rate, fall) = (highest.strain_rate, number(fall.value, 3));
        PROSE.text("turns", values!(rate, fall))
    } else {
        PROSE.text("does not turn", &[])
    }
}

/// The strain rate at which the flow passes one half in the widest tube, in words.
fn turning_of_half(lines: &[&Line]) -> String {
    let half = |line: &&Line| Some((line.strain_rate, line.half?));
    let halves = || lines.iter().filter_map(half);
    let widest = halves().max_by(|one, other| one.1.total_cmp(&other.1));
    match (halves().next(), widest) {
        (Some(slowest), Some(widest)) if widest.0 > slowest.0 => {
            let (rate, smallest) = (widest.0, slowest.0);
            let [widest, slowest] = [widest, slowest].map(|half| number(half.1, 3));
            PROSE.text("half turns", values!(rate, widest, slowest, smallest))
        }
        _ => PROSE.text("half does not turn", &[]),
    }
}

/// The width at which a branch passes one half, between two points on a straight line.
fn crossing_of_half(branch: &Branch<'_>) -> Option<f64> {
    let mut steps: Vec<_> = branch.steps().collect();
    steps.reverse();
    let step = steps
        .iter()
        .find(|step| step.flows[0] >= HALF && step.flows[1] < HALF)?;
    let part = (step.flows[0] - HALF) / (step.flows[0] - step.flows[1]);
    Some(step.controls[0] + part * (step.controls[1] - step.controls[0]))
}

fn figure(lines: &[Line]) -> ChartFigure {
    let panel =
        |name: &str| ChartPanel::new(&label(Axis::StrainRate), name).x_scale(Scale::Logarithmic);
    let mut width = panel(&label(Axis::CriticalWidth));
    let mut height = panel("height of the largest fall, Δ*J*/*J*_{max}").y_range(0.0..);
    for (series, lattice) in LATTICES.into_iter().enumerate() {
        let of = || lines.iter().filter(|line| line.lattice == lattice);
        // Where nothing jumps, the largest fall has no meaning.
        let jumps = of().filter(|line| line.jumps);
        let jumps = jumps.map(|line| (line.strain_rate, line.critical));
        let exact = |half| Uncertain::normal(half, 0.0);
        let halves = of().filter_map(|line| Some((line.strain_rate, exact(line.half?))));
        let heights = of().filter_map(|line| Some((line.strain_rate, line.height?)));
        let halves = points(&format!("{lattice}, *J* = *J*_{{max}}/2"), halves);
        let widths = [
            joined(&format!("{lattice}, jump"), jumps),
            halves.map(Points::open),
        ];
        let numbered = |points: Points| points.series(series);
        width = width.with_all(widths.into_iter().flatten().map(numbered));
        let heights = joined(&format!("{lattice} lattice"), heights);
        height = height.with_all(heights.map(numbered));
    }
    grid(2, [width, height])
}
