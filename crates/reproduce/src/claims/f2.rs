//! F2: how the mean transition time diverges.

use peristalsis_analysis::WidthEnsemble;

use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("f2.md"));

pub(super) const CLAIM: Claim = Claim::new("F2", PROSE, DIVERGENCES, examine);

/// What the source says.
const EXPONENT: f64 = 1.0;
/// Other thresholds that the fits are made with, relative to the one midway.
const SHIFTS: [f64; 3] = [-0.1, 0.0, 0.1];

fn examine(evidence: &Evidence) -> Result<Finding> {
    let needed = Statistics::FOR_A_VERDICT;
    let lattices = OnLattice::all(evidence)?;
    let (mut draft, mut parts, mut means) = (Draft::of(PROSE), Vec::new(), Vec::new());
    let (mut rows, mut sensitivity) = (Vec::new(), Vec::new());
    for one in &lattices {
        let exponents: Vec<Uncertain> = one.fitted().map(|(_, fit)| fit.exponent).collect();
        let (part, words) = mean_exponent(&mut draft, one, EXPONENT, &exponents);
        parts.push(part);
        means.extend(words);
        for (line, fit) in one.fitted() {
            rows.push(row(&one.name, line, fit));
            sensitivity.push(shifted(&one.name, line));
        }
        let is_fitted = |line: &&Line<'_>| line.fit.is_some() && line.escaped() <= MOST_ESCAPED;
        let others = one.lines.iter().filter(|line| !is_fitted(line));
        rows.extend(others.map(|line| row_without_fit(&one.name, line)));
    }
    let (verdict, statistics, why) = judge(&parts, &needed);
    if means.is_empty() {
        return Ok(PROSE.nothing(statistics, &needed));
    }
    let summary = PROSE.text("summary", values!(means = means.join(", "), why));
    draft.finding.paragraphs = PROSE.paragraphs("method", values!(window = WINDOW));
    draft.table("exponents", &[], rows);
    draft.table("sensitivity", &[], sensitivity);
    let lines = lattices.iter().flat_map(|one| &one.lines);
    let chart = grid(2, lattices.iter().filter_map(times))
        .share_y()
        .colour_scale(rate_colours(lines.map(|line| line.strain_rate)));
    draft.chart("transition-times", &[], chart)?;
    Ok(draft.concluded(verdict, summary, statistics, &needed))
}

fn row(lattice: &str, line: &Line<'_>, fit: &Divergence) -> Vec<String> {
    let exponents = line.fits().into_iter().map(|fit| fit.exponent.value);
    let alone = fit.exponent.value;
    let (least, largest) = ends(exponents).unwrap_or((alone, alone));
    vec![
        lattice.to_owned(),
        number(line.strain_rate, 3),
        number(line.threshold, 1),
        fit.critical_width.to_string(),
        fit.exponent.to_string(),
        interval(&fit.exponent),
        format!("{} … {}", number(least, 2), number(largest, 2)),
        format!("{}/{}", fit.observed, fit.observed + fit.censored),
        number(line.escaped(), 2),
    ]
}

fn row_without_fit(lattice: &str, line: &Line<'_>) -> Vec<String> {
    let is_left_out = line.escaped() > MOST_ESCAPED;
    let mut row = vec![
        lattice.to_owned(),
        number(line.strain_rate, 3),
        number(line.threshold, 1),
        if is_left_out { "left out" } else { "no fit" }.to_owned(),
    ];
    row.resize(8, String::new());
    row.push(number(line.escaped(), 2));
    row
}

/// Critical width and exponent at other thresholds.
fn shifted(lattice: &str, line: &Line<'_>) -> Vec<String> {
    let at = |shift: f64| {
        let fit = line.at_threshold(line.threshold + shift).fit;
        cell_of(fit, |fit| {
            format!("{}; {}", fit.critical_width, fit.exponent)
        })
    };
    let names = [lattice.to_owned(), number(line.strain_rate, 3)];
    names.into_iter().chain(SHIFTS.map(at)).collect()
}

/// Mean transition times of one lattice with the fitted laws; `None` without any.
fn times(lattice: &OnLattice<'_>) -> Option<ChartPanel> {
    let mut drawn = false;
    let mut panel = panel(Axis::Width, Axis::TransitionPeriod)
        .y_scale(Scale::Logarithmic)
        .title(&format!("{} lattice", lattice.name));
    for (number, line) in lattice.lines.iter().enumerate() {
        let seen = |one: &WidthEnsemble| one.observed >= one.censored && one.observed > 0;
        let time = |one: &WidthEnsemble| {
            let naive = || Uncertain::normal(one.naive_mean.unwrap_or(f64::NAN), 0.0);
            let time = match seen(one) {
                true => one.fit.map_or_else(naive, |fit| fit.mean),
                false => Uncertain::normal(one.watched, 0.0),
            };
            (one.width, time.scaled(line.strain_rate))
        };
        let times: Vec<(f64, Uncertain)> = line.ensembles.iter().map(time).collect();
        let limits: Vec<bool> = line.ensembles.iter().map(|one| !seen(one)).collect();
        let Some(points) = points("", times.iter().copied()) else {
            continue;
        };
        drawn = true;
        let points = points.lower_limits(&limits).series(number);
        panel = panel.with(points.tint(Tint::Value(line.strain_rate)));
        if let Some(fit) = &line.fit {
            let mean = |width| fit.mean(width) * line.strain_rate;
            panel = panel.with_all(fitted_curve(line, fit.critical_width.value, &times, mean));
        }
    }
    drawn.then_some(panel)
}
