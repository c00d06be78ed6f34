//! F7: how the critical width depends on the strain rate.

use peristalsis_analysis::{LineFit, ScatteredLine, fit_line, fit_line_to_scatter};

use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("f7.md"));

pub(super) const CLAIM: Claim = Claim::new("F7", PROSE, TRANSITIONS, examine);

/// What the source says of dw_c/depsdot.
pub(super) const SLOPE: f64 = -3.75;
/// Strain rates with their critical widths, ascending.
type Critical = Vec<(f64, Uncertain)>;

fn examine(evidence: &Evidence) -> Result<Finding> {
    let (mut draft, mut parts) = (Draft::of(PROSE), Vec::new());
    let (mut rows, mut periods) = (Vec::new(), 0.0_f64);
    let mut panel = panel(Axis::StrainRate, Axis::CriticalWidth).x_range(0.0..);
    for (place, one) in OnWall::<Line<'_>>::all(evidence)?.iter().enumerate() {
        periods = periods.max(one.periods);
        rows.extend(one.all.iter().map(|shown| row(&one.name, shown)));
        let critical = critical_widths(one);
        let drawn = points(&one.name, critical.iter().copied());
        // Points that fall on one another are told apart by open marks.
        let is_open = place % 2 == 1;
        let drawn = drawn.map(|points| if is_open { points.open() } else { points });
        panel = panel.with_all(drawn.map(|points| points.series(place)));
        let line = straight(&critical);
        if let Some(line) = &line {
            panel = with_line(panel, &line.line, &critical, place);
        }
        parts.push(part(&mut draft, one, &critical, line.as_ref()));
    }
    let judgement = Judgement::of(parts, &CLAIM.needed);
    if draft.finding.quantities.is_empty() {
        return Ok(PROSE.nothing(judgement.statistics));
    }
    let ends = [3.0 - 0.075, 3.0 - 0.45];
    panel = panel.with(
        Curve::new("slope −3.75 (talk)", &[0.02, 0.12], &ends)
            .tint(Tint::Black)
            .pattern(Pattern::Dotted),
    );
    let summary = PROSE.text("summary", &[]);
    draft.table("critical widths", values!(periods), rows);
    draft.chart("critical-width", &[], ChartFigure::new(panel))?;
    Ok(draft.judged(judgement, &summary))
}

fn critical_widths(one: &OnWall<Line<'_>>) -> Critical {
    at_rates(one.near(), Near::critical_width)
}

/// The line of a wall, through critical widths with their errors and a scatter of their own. `None` with too few strain rates.
fn straight(critical: &Critical) -> Option<ScatteredLine> {
    let [rate, width, error] = columns(critical.iter().copied(), 0.0);
    let line = fit_line_to_scatter(&rate, &width, &error).ok()?;
    (rate.len() >= LEAST_RATES).then_some(line)
}

/// As the source has it: least squares through the w_c of its straight lines of 1/tau, all alike.
fn as_the_source(one: &OnWall<Line<'_>>) -> Option<ScatteredLine> {
    let critical = at_rates(one.near(), |near| Some(near.straight?.critical_width));
    let [rate, width, _] = columns(critical, 0.0);
    fit_line_to_scatter(&rate, &width, &vec![0.0; rate.len()]).ok()
}

/// What one wall says, by the slope of the line.
fn part(
    draft: &mut Draft,
    one: &OnWall<Line<'_>>,
    critical: &Critical,
    line: Option<&ScatteredLine>,
) -> Part {
    let (wall, rates) = (&one.name, critical.len());
    if let Some(ScatteredLine { line, .. }) = line {
        draft.compared("slope", values!(wall, rates), line.slope, SLOPE);
        draft.quantity("intercept", values!(wall, rates), line.intercept);
    }
    let linearity = line.and_then(|line| line.linearity);
    let (rates, straight) = (rates_in_words(one), cell_of(linearity, probability));
    let way = as_the_source(one);
    let of_source = cell(way.map(|line| line.line.slope));
    let explained = cell_of(way, |line| number(line.determination, 3));
    let [rate, width, error] = columns(critical.iter().copied(), 0.0);
    let alone = fit_line(&rate, &width, &error).ok();
    let chi = cell_of(alone, |line| number(line.chi_squared, 0));
    let freedom = cell_of(alone, |line| line.degrees_of_freedom.to_string());
    let why = PROSE.text(
        "why",
        values!(rates, straight, chi, freedom, of_source, explained),
    );
    let slope = line.map(|line| line.line.slope);
    let determination = cell_of(line, |line| number(line.determination, 3));
    let words = PROSE.text("number", values!(slope = cell(slope), determination));
    one.part(holds, words, why)
}

/// Whether the line is straight, and as steep as the source's.
fn holds(one: &OnWall<Line<'_>>) -> Option<bool> {
    let line = straight(&critical_widths(one))?;
    let is_straight = line.linearity.map(|chance| chance >= BY_CHANCE);
    all_hold(&[is_straight, agrees(&line.line.slope, SLOPE)])
}

/// The strain rates of a line, and those left out.
fn rates_in_words(one: &OnWall<Line<'_>>) -> String {
    let rates = |tight: bool| {
        let those = one.all.iter().filter(|shown| shown.is_tight() == tight);
        listed(those.map(|shown| shown.strain_rate))
    };
    let through = rates(true);
    let left_out = match rates(false) {
        none if none.is_empty() => none,
        leaking => format!(" {}", PROSE.text("left out", values!(leaking))),
    };
    PROSE.text("rates", values!(through, left_out))
}

fn half(line: &Line<'_>) -> Option<Uncertain> {
    Some(line.crossing()?.width)
}

fn row(wall: &str, shown: &Shown<Line<'_>>) -> Vec<String> {
    let line = &shown.found;
    let near = line.near.as_ref();
    let free = near.and_then(|near| near.power?.critical_width);
    vec![
        wall.to_owned(),
        number(shown.strain_rate, 3),
        cell(half(line)),
        cell(free),
        cell(near.and_then(|near| Some(near.curved?.critical_width))),
        cell(near.and_then(Near::critical_width)),
        number(shown.escaped, 2),
    ]
}

fn with_line(panel: ChartPanel, line: &LineFit, critical: &Critical, place: usize) -> ChartPanel {
    let largest = critical.iter().map(|one| one.0).fold(0.0, f64::max);
    let x = spaced(0.0, largest, 40);
    let at: Vec<Uncertain> = x.iter().map(|rate| line.at(*rate)).collect();
    let middle: Vec<f64> = at.iter().map(|one| one.value).collect();
    let error: Vec<f64> = at.iter().map(|one| one.error).collect();
    panel
        .with(error_band(&x, &middle, &error).series(place))
        .with(Curve::new("", &x, &middle).series(place).weight(0.8))
}
