//! S3: the stationary flow against the force, a jump at large strain rates and none at small ones.

use super::elastic::label;
use super::elastic::*;
use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("s3.md"));

pub(super) const CLAIM: Claim = claim("S3", PROSE, BRANCHES, examine);

fn examine(evidence: &Evidence) -> Result<Finding> {
    let rows = evidence.rows(BRANCHES)?;
    let lines = ForceLine::all_of(&rows);
    let tight = judged(&lines);
    if tight.is_empty() {
        return Ok(PROSE.nothing(Statistics::default()));
    }
    let of_kind = |kind: Kind, replicates: usize| -> Vec<f64> {
        let lines = tight
            .iter()
            .filter(|line| line.kind() == kind && line.statistics.replicates >= replicates);
        lines.map(|line| line.strain_rate).collect()
    };
    // The interval rests on strain rates with replicates; single runs are told and drawn.
    let [firm_jumps, firm_smooth] =
        [Kind::Jump, Kind::Smooth].map(|kind| of_kind(kind, CLAIM.needed.replicates));
    let vanishing = vanishing(&firm_jumps, &firm_smooth);
    let is_firm = |line: &&&ForceLine<'_>| line.statistics.replicates >= CLAIM.needed.replicates;
    let firm = tight.iter().filter(is_firm).count();
    let verdict = if vanishing.is_some() {
        Verdict::Reproduced
    } else if [&firm_jumps, &firm_smooth]
        .iter()
        .any(|those| those.len() == firm)
    {
        Verdict::Differs
    } else {
        Verdict::Open
    };
    let (jumping, smooth) = (of_kind(Kind::Jump, 0), of_kind(Kind::Smooth, 0));
    let (jumping, smooth) = (in_words(jumping), in_words(smooth));
    let mut summary = PROSE.text("summary", values!(jumping, smooth));
    if let Some(rate) = vanishing {
        let (lower, upper) = (rate.interval_95.lower, rate.interval_95.upper);
        let sentence = PROSE.text("vanishing", values!(lower, upper));
        summary = format!("{summary} {sentence}");
    }
    let statistics = together(tight.iter().copied());
    let mut draft = Draft::of(PROSE);
    draft.quantity("vanishing", &[], vanishing);
    for line in &tight {
        draft.quantity("height", values!(rate = line.strain_rate), line.height());
    }
    draft.table("rises", &[], lines.iter().map(|line| cells(&rows, line)));
    let escaped = number(100.0 * MOST_ESCAPED, 0);
    draft.paragraph(
        "method",
        values!(least = LEAST_JUMP_AGAINST_FORCE, clear = CLEAR, escaped),
    );
    for line in &tight {
        if let (Kind::Undecided, Some(height)) = (line.kind(), line.height())
            && height.value > LEAST_JUMP_AGAINST_FORCE
        {
            draft.weakness("undecided", values!(rate = line.strain_rate, height));
        }
    }
    draft.chart("branches", &[], branches(&lines, &tight))?;
    let panels = peaks(&rows, &tight);
    if !panels.is_empty() {
        let chart = grid(2, panels);
        draft.chart("peaks-against-force", &[], chart)?;
    }
    Ok(draft.concluded(verdict, summary, statistics))
}

/// The bracket of the strain rate at which the jump vanishes: all that jump are faster than all that do not.
fn vanishing(jumping: &[f64], smooth: &[f64]) -> Option<Uncertain> {
    let slowest = jumping.iter().copied().reduce(f64::min)?;
    let fastest = smooth.iter().copied().reduce(f64::max)?;
    (fastest < slowest).then(|| bracket(fastest, slowest))
}

/// Strain rates in words.
fn in_words(rates: Vec<f64>) -> String {
    match &*listed(rates) {
        "" => "no strain rate".to_owned(),
        rates => format!("*ε̇* = {rates}"),
    }
}

/// J/Jmax of all stationary runs of a line.
fn flows(rows: &[Row<'_>], line: &ForceLine<'_>) -> Vec<f64> {
    rows.iter()
        .filter(|row| row.strain_rate() == line.strain_rate && row.is_stationary())
        .filter(|row| !line.leaking.contains(&row.force()))
        .map(Row::flow_rate_ratio)
        .filter(|ratio| ratio.is_finite())
        .collect()
}

/// The row of the table for one strain rate.
fn cells(rows: &[Row<'_>], line: &ForceLine<'_>) -> Vec<String> {
    let flows = flows(rows, line);
    let rise = |branch: &Branch<'_>| {
        cell_of(branch.rise(), |rise| {
            format!("{} … {}", rise.controls[0], rise.controls[1])
        })
    };
    let window = |(least, largest): (f64, f64)| {
        if largest.is_finite() {
            format!("{} … {}", number(least, 4), number(largest, 4))
        } else if least > 0.0 {
            format!("> {}", number(least, 4))
        } else {
            // One force, the last that was tried.
            "> 0".to_owned()
        }
    };
    let leaks_all_along = line.is_empty() && !line.leaking.is_empty();
    let kind = match line.kind() {
        _ if leaks_all_along => "leaks",
        Kind::Jump => "jump",
        Kind::Smooth => "smooth",
        Kind::Undecided => "undecided",
    };
    let left_out: &[f64] = if leaks_all_along { &[] } else { &line.leaking };
    let [peaks, dip] = cells_of_peaks(&flows);
    vec![
        line.strain_rate.to_string(),
        rise(&line.flow.rest),
        rise(&line.flow.jammed),
        cell(line.height()),
        cell_of(line.window(), window),
        peaks,
        dip,
        outside(line.escaped, left_out),
        kind.to_owned(),
    ]
}

/// Both branches at each strain rate, and the height of the rise against the strain rate.
fn branches(lines: &[ForceLine<'_>], tight: &[&ForceLine<'_>]) -> ChartFigure {
    let window = |line: &&ForceLine<'_>| {
        let (first, last) = line.both_ends().filter(|(first, last)| last > first)?;
        Some(Window::new("", first, last).tint(Tint::Value(line.strain_rate)))
    };
    let windows: Vec<Window> = tight.iter().filter_map(window).collect();
    let shaded = (!windows.is_empty()).then(|| Key::area("both flows"));
    let flow = with_branches(flow_against_force(), tight)
        .with_all(windows)
        .with_all(shaded);
    grid(2, [flow].into_iter().chain(heights(tight))).colour_scale(colours_of_rates(lines))
}

/// The height of the rise against the strain rate; `None` where no height is known.
fn heights(tight: &[&ForceLine<'_>]) -> Option<ChartPanel> {
    let point = |line: &&ForceLine<'_>| {
        let point = points("", line.height().map(|height| (line.strain_rate, height)));
        let point = match line.kind() {
            Kind::Undecided => point.map(Points::open),
            Kind::Jump | Kind::Smooth => point,
        };
        (line.strain_rate, point)
    };
    let points: Vec<Points> = coloured(tight.iter().map(point)).collect();
    let panel = ChartPanel::new(
        &label(Axis::StrainRate),
        "height of the jump, Δ*J*/*J*_{max}",
    )
    .x_scale(Scale::Logarithmic)
    .with(Reference::horizontal(LEAST_JUMP_AGAINST_FORCE).label("counts as a jump"))
    .with(Key::open("forces too far apart to tell"));
    (!points.is_empty()).then(|| panel.with_all(points))
}

/// Histograms of J/Jmax, for the slowest and the fastest wave of those with most runs.
fn peaks(rows: &[Row<'_>], tight: &[&ForceLine<'_>]) -> Vec<ChartPanel> {
    let runs = |line: &ForceLine<'_>| line.statistics.runs;
    let most = tight.iter().map(|line| runs(line)).max().unwrap_or(0);
    let many: Vec<&&ForceLine<'_>> = tight.iter().filter(|line| 2 * runs(line) >= most).collect();
    let last = many.last().filter(|_| many.len() > 1);
    let panel = |line: &&&ForceLine<'_>| {
        let bars = flow_histogram(&flows(rows, line), -0.2, 1.0)?;
        let panel = ChartPanel::new(&label(Axis::FlowRateRatio), "runs");
        let panel = panel.title(&format!("*ε̇* = {}", line.strain_rate));
        Some(panel.with(bars.tint(Tint::Blue)))
    };
    let shown = many.first().into_iter().chain(last);
    shown.filter_map(panel).collect()
}
