//! F2: how the mean transition time diverges.

use peristalsis_analysis::{InverseFit, WidthEnsemble};

use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("f2.md"));

pub(super) const CLAIM: Claim = Claim::new("F2", PROSE, TRANSITIONS, examine);

/// What the source says.
const EXPONENT: f64 = 1.0;
/// (w_c − w)/epsdot^(3/2) within which a line is to have transition times.
const NEXT: f64 = 0.5;
/// Other thresholds that the fits are made with, relative to the one midway.
const SHIFTS: [f64; 3] = [-0.1, 0.0, 0.1];
/// Most of the runs that may have ended before they came to another threshold.
const STOPPED: f64 = 0.05;

fn examine(evidence: &Evidence) -> Result<Finding> {
    let walls = OnWall::<Line<'_>>::all(evidence)?;
    let (mut draft, mut parts) = (Draft::of(PROSE), Vec::new());
    let (mut rows, mut laws, mut sensitivity) = (Vec::new(), Vec::new(), Vec::new());
    for one in &walls {
        parts.push(part(&mut draft, one));
        for shown in &one.all {
            rows.push(row(&one.name, shown));
        }
        laws.extend(one.tight().filter_map(|shown| law_row(&one.name, shown)));
        let fitted = one.fitted();
        sensitivity.extend(fitted.map(|(line, _)| shifted(&one.name, line)));
    }
    let judgement = Judgement::of(parts, &CLAIM.needed);
    if sensitivity.is_empty() {
        return Ok(PROSE.nothing(judgement.statistics));
    }
    poor_fits(&mut draft, &walls);
    let far = far_lines(&walls);
    if !far.is_empty() {
        draft.weakness("far", values!(near = NEXT, far = far.join("; ")));
    }
    let summary = PROSE.text("summary", &[]);
    let (window, worse, near) = (WINDOW, WORSE, NEAR);
    draft.finding.paragraphs = PROSE.paragraphs("method", values!(window, worse));
    draft.table("laws", values!(window, near), laws);
    draft.table("exponents", &[], rows);
    draft.table("sensitivity", &[], sensitivity);
    let lines = walls.iter().flat_map(|one| &one.all);
    let chart = grid(2, walls.iter().filter_map(times))
        .share_y()
        .colour_scale(rate_colours(lines.map(|line| line.strain_rate)));
    draft.chart("transition-times", values!(resolved = RESOLVED), chart)?;
    Ok(draft.judged(judgement, &summary))
}

/// What one wall says, by the laws next to w_c at each strain rate.
fn part(draft: &mut Draft, one: &OnWall<Line<'_>>) -> Part {
    let agrees = |exponent: &Uncertain| agrees(exponent, EXPONENT);
    let judged = |one: &OnWall<Line<'_>>| one.rates(|line| line.near.as_ref()?.is_linear(agrees));
    let rates = judged(one);
    let exponents: Vec<Uncertain> = one.near().filter_map(Near::exponent).collect();
    let mean = weighted_mean(&exponents);
    let (wall, count) = (&one.name, exponents.len());
    let widths = STRAIGHT;
    draft.compared("exponent", values!(wall, count, widths), mean, EXPONENT);
    let sum = |of: fn(&Near) -> Option<f64>| -> f64 { one.near().filter_map(of).sum() };
    let curved = sum(|near| near.power.and(near.curved).map(|fit| fit.chi_squared));
    let power = sum(|near| near.curved.and(near.power).map(|fit| fit.chi_squared));
    let (curved, power) = (number(curved, 1), number(power, 1));
    let number = PROSE.text("number", values!(exponent = cell(mean)));
    let both = one.near().filter_map(|near| near.curved.and(near.power));
    let freedom: usize = both.map(|fit| fit.degrees_of_freedom).sum();
    let words = rates.in_words();
    let why = PROSE.text("why", values!(words, curved, power, freedom));
    if rates.hold() == Some(true) && mean.is_some_and(|mean| agrees(&mean) == Some(false)) {
        let (count, exponent) = (rates.count(), cell(mean));
        draft.weakness("led", values!(wall, count, exponent));
    }
    one.part(|one| judged(one).hold(), number, why)
}

/// Wall, strain rate and distance of those lines whose nearest transition times lie farther from w_c than [`NEXT`].
fn far_lines(walls: &[OnWall<Line<'_>>]) -> Vec<String> {
    let of_wall = |one: &OnWall<Line<'_>>| {
        let distances = at_rates(one.near(), Near::nearest_distance).into_iter();
        let far = distances.filter(|(_, distance)| *distance > NEXT);
        let words = far.map(|(rate, distance)| format!("{rate} ({})", number(distance, 1)));
        let words: Vec<String> = words.collect();
        (!words.is_empty()).then(|| format!("{}, *ε̇* = {}", one.name, words.join(", ")))
    };
    walls.iter().filter_map(of_wall).collect()
}

/// How many fits of either law the data exclude: a law can be the better one and still not be the whole truth.
fn poor_fits(draft: &mut Draft, walls: &[OnWall<Line<'_>>]) {
    let of = |probability: fn(&Near) -> Option<f64>| {
        let known: Vec<f64> = walls
            .iter()
            .flat_map(OnWall::near)
            .filter_map(probability)
            .collect();
        let poor = known.iter().filter(|chance| **chance < BY_CHANCE).count();
        (poor, known.len())
    };
    let (curved, all) = of(|near| near.curved.map(|fit| fit.probability));
    let (power, of_power) = of(|near| near.power.map(|fit| fit.probability));
    if curved + power > 0 {
        let chance = number(100.0 * BY_CHANCE, 0);
        draft.weakness("poor fits", values!(curved, all, power, of_power, chance));
    }
}

/// The laws next to w_c, each with its goodness.
fn law_row(wall: &str, shown: &Shown<Line<'_>>) -> Option<Vec<String>> {
    let near = shown.found.near.as_ref()?;
    let goodness = |chi_squared: f64, freedom: usize, chance: f64| {
        format!(
            "{}/{freedom}, {}",
            number(chi_squared, 1),
            probability(chance)
        )
    };
    let of = |fit: &InverseFit| goodness(fit.chi_squared, fit.degrees_of_freedom, fit.probability);
    let power = near.power.as_ref();
    Some(vec![
        wall.to_owned(),
        number(shown.strain_rate, 3),
        cell(near.straight.map(|fit| fit.critical_width)),
        cell_of(near.straight, |fit| number(fit.explained, 3)),
        cell_of(near.straight.as_ref(), of),
        cell(near.curved.map(|fit| fit.critical_width)),
        cell_of(near.curved.as_ref(), of),
        cell(power.map(|fit| fit.exponent)),
        cell_of(power, |fit| {
            goodness(fit.chi_squared, fit.degrees_of_freedom, fit.probability)
        }),
    ])
}

/// Critical width and exponents in windows of growing size.
fn row(wall: &str, shown: &Shown<Line<'_>>) -> Vec<String> {
    let line = &shown.found;
    let fit = line.fit.as_ref().filter(|_| shown.is_tight());
    let first = match fit {
        Some(fit) => fit.critical_width.to_string(),
        None if shown.is_tight() => "no fit".to_owned(),
        None => "left out".to_owned(),
    };
    let fits = if fit.is_some() {
        line.fits()
    } else {
        Vec::new()
    };
    let exponent = |fit: Option<&Divergence>| cell_of(fit, |fit| fit.exponent.to_string());
    let mut row = vec![
        wall.to_owned(),
        number(shown.strain_rate, 3),
        number(line.threshold, 1),
        first,
    ];
    row.extend((0..3).map(|place| exponent(fits.get(place))));
    row.push(exponent(fits.last().filter(|_| fits.len() > 3)));
    row.push(cell_of(fit, |fit| {
        format!("{}/{}", fit.observed, fit.observed + fit.censored)
    }));
    row.push(number(shown.escaped, 2));
    row
}

/// Critical width and exponent at other thresholds.
fn shifted(wall: &str, line: &Line<'_>) -> Vec<String> {
    let at = |shift: f64| {
        let shifted = line.at_threshold(line.threshold + shift);
        // Runs that ended after a transition at their own threshold tell nothing of one that they did not come to.
        if shifted.stopped_before() > STOPPED {
            return cell_of(None::<()>, |()| String::new());
        }
        // At the first of the thresholds there is none below.
        let fit = shifted
            .fit
            .filter(|_| shift == 0.0 || shifted.threshold != line.threshold);
        cell_of(fit, |fit| {
            format!("{}; {}", fit.critical_width, fit.exponent)
        })
    };
    let names = [wall.to_owned(), number(line.strain_rate, 3)];
    names.into_iter().chain(SHIFTS.map(at)).collect()
}

/// Mean transition times on one wall with the fitted laws; `None` without any.
fn times(one: &OnWall<Line<'_>>) -> Option<ChartPanel> {
    let mut drawn = false;
    let mut panel = panel(Axis::Width, Axis::TransitionPeriod)
        .y_scale(Scale::Logarithmic)
        .title(&one.name);
    for shown in &one.all {
        let line = &shown.found;
        let seen = |one: &WidthEnsemble| one.observed_fraction() >= SEEN;
        let time = |one: &WidthEnsemble| {
            let naive = || Uncertain::normal(one.naive_mean.unwrap_or(f64::NAN), 0.0);
            let time = match seen(one) {
                true => one.fit.map_or_else(naive, |fit| fit.mean),
                false => Uncertain::normal(one.watched, 0.0),
            };
            (one.width, time.scaled(line.strain_rate))
        };
        let known = |one: &&WidthEnsemble| !seen(one) || line.resolves(one, RESOLVED);
        let known = || line.ensembles.iter().filter(known);
        let times: Vec<(f64, Uncertain)> = known().map(time).collect();
        let limits: Vec<bool> = known().map(|one| !seen(one)).collect();
        let Some(points) = points("", times.iter().copied()) else {
            continue;
        };
        drawn = true;
        let points = points.lower_limits(&limits);
        panel = panel.with(points.tint(Tint::Value(line.strain_rate)));
        let near = line.near.as_ref().filter(|_| shown.is_tight());
        if let Some(law) = near.and_then(Near::judged) {
            let critical = law.critical_width.value;
            let curvature = law.quadratic.map_or(0.0, |one| one.value);
            let mean = |width| {
                let distance = critical - width;
                line.strain_rate / (distance * (law.linear.value + curvature * distance))
            };
            panel = panel.with_all(fitted_curve(line, critical, &times, mean));
        }
    }
    drawn.then_some(panel)
}
