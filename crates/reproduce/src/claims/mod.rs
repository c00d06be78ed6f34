//! One claim a file, and what they share.

mod elastic;
mod f1;
mod f2;
mod f3;
mod f4;
mod f5;
mod f6;
mod f7;
mod f8;
mod f9;
mod q1;
mod q10;
mod q11;
mod q2;
mod q3;
mod q4;
mod q5;
mod q6;
mod q7;
mod q8;
mod q9;
mod s1;
mod s2;
mod s3;
mod s4;
mod s5;
mod s6;

use peristalsis_analysis::Uncertain;
use peristalsis_figures::chart::{Line as Curve, Tint};
use peristalsis_figures::{ColourScale, Quantity as Axis, Units};

use crate::claim::Claim;
use crate::critical::{Divergence, Line, Thresholds, WINDOW, lines, weighted_mean};
use crate::error::ClaimError;
use crate::evidence::Evidence;
use crate::finding::{Quantity, Statistics, Verdict};
use crate::runs::Lattice;

/// All claims, in the order of the report.
pub const CLAIMS: &[Claim] = &[
    f1::CLAIM,
    f2::CLAIM,
    f3::CLAIM,
    f4::CLAIM,
    f5::CLAIM,
    f6::CLAIM,
    f7::CLAIM,
    f8::CLAIM,
    f9::CLAIM,
    s1::CLAIM,
    s2::CLAIM,
    s3::CLAIM,
    s4::CLAIM,
    s5::CLAIM,
    s6::CLAIM,
    q1::CLAIM,
    q2::CLAIM,
    q3::CLAIM,
    q4::CLAIM,
    q5::CLAIM,
    q6::CLAIM,
    q7::CLAIM,
    q8::CLAIM,
    q9::CLAIM,
    q10::CLAIM,
    q11::CLAIM,
];

/// Fraction of grains outside the tube beyond which a strain rate is left out of fits: another system flows then.
const MOST_ESCAPED: f64 = 0.05;

/// Both lattices with the names of their studies of transition times and of branches.
const LATTICES: [(Lattice, &str, &str); 2] = [
    (Lattice::FINE, "divergence-fine", "branches-fine"),
    (Lattice::COARSE, "divergence-coarse", "branches-coarse"),
];

/// Label of an axis.
fn label(quantity: Axis) -> String {
    quantity.label(Units::Linear)
}

/// The lines of the study of transition times on one lattice, watched midway between the branches.
fn lines_of<'a>(
    evidence: &'a Evidence,
    (lattice, divergence, branches): (Lattice, &str, &str),
) -> Result<Vec<Line<'a>>, ClaimError> {
    let thresholds = Thresholds::of(&evidence.study(branches)?.runs, lattice);
    Ok(lines(
        &evidence.study(divergence)?.runs,
        lattice,
        &thresholds,
    ))
}

/// The lines that hold their grains, each with its fit; those of which too many grains are outside are left out.
fn fitted<'a, 'b>(lines: &'b [Line<'a>]) -> Vec<(&'b Line<'a>, Divergence)> {
    lines
        .iter()
        .filter(|line| line.escaped() <= MOST_ESCAPED)
        .filter_map(|line| Some((line, line.fit(WINDOW)?)))
        .collect()
}

/// How much is behind some lines.
fn statistics(lines: &[&Line<'_>]) -> Statistics {
    Statistics::weakest(lines.iter().map(|line| line.statistics()))
}

/// What one lattice says of a claim: whether it holds there (`None`: errors too large to say) and what is behind it.
struct Part {
    lattice: String,
    holds: Option<bool>,
    statistics: Statistics,
}

/// The verdict of several lattices: that of those with enough behind them, where they agree; open where they do not. With it
/// the statistics of the lattice that has most, and why the verdict is open, if it is.
fn judge(parts: &[Part], needed: &Statistics) -> (Verdict, Statistics, String) {
    let enough: Vec<&Part> = parts
        .iter()
        .filter(|part| part.statistics.suffice(needed))
        .collect();
    let statistics = best(parts.iter().map(|part| part.statistics), needed);
    let named = |holds: bool| -> Vec<&str> {
        enough
            .iter()
            .filter(|part| part.holds == Some(holds))
            .map(|part| part.lattice.as_str())
            .collect()
    };
    let (holding, failing) = (named(true), named(false));
    let (verdict, why) = match (holding.is_empty(), failing.is_empty()) {
        (false, true) => (Verdict::Reproduced, String::new()),
        (true, false) => (Verdict::Differs, String::new()),
        (false, false) => (
            Verdict::Open,
            format!(
                " It holds on the {} lattice and not on the {} one: open.",
                holding.join(" and "),
                failing.join(" and ")
            ),
        ),
        (true, true) if enough.is_empty() => (Verdict::Open, String::new()),
        (true, true) => (
            Verdict::Open,
            " The errors are too large to tell.".to_owned(),
        ),
    };
    (verdict, statistics, why)
}

/// The statistics that suffice, or come nearest to that.
fn best(all: impl Iterator<Item = Statistics>, needed: &Statistics) -> Statistics {
    all.max_by_key(|one| {
        (
            one.suffice(needed),
            one.strain_rates,
            one.replicates,
            one.widths,
        )
    })
    .unwrap_or_default()
}

/// A fitted law in the window of its fit, as far as it stays in sight of the points; `None` where nothing of it does.
fn fitted_curve(
    line: &Line<'_>,
    critical: f64,
    points: &[f64],
    law: impl Fn(f64) -> f64,
) -> Option<Curve> {
    let largest = points.iter().copied().fold(0.0, f64::max);
    let (x, y): (Vec<f64>, Vec<f64>) = spaced(line.window_from(WINDOW)?, critical, 200)
        .into_iter()
        .map(|width| (width, law(width)))
        .filter(|point| point.1.is_finite() && point.1 < 3.0 * largest)
        .unzip();
    (x.len() > 1).then(|| {
        Curve::new("", &x, &y)
            .tint(Tint::Value(line.strain_rate))
            .weight(0.8)
    })
}

/// What one lattice says of an exponent, the weighted mean over its strain rates, with the quantity of the report.
fn of_exponents(
    lattice: &str,
    exponents: &[Uncertain],
    source: f64,
    [what, symbol]: [&str; 2],
    statistics: Statistics,
) -> (Part, Option<(Uncertain, Quantity)>) {
    let mean = weighted_mean(exponents);
    let part = Part {
        lattice: lattice.to_owned(),
        holds: mean.and_then(|mean| agrees(&mean, source)),
        statistics,
    };
    let quantity = |mean| Quantity {
        name: format!("exponent of the {what}, {lattice} lattice"),
        symbol: symbol.to_owned(),
        unit: String::new(),
        source: Some(source),
        ours: Some(mean),
        method: format!(
            "weighted mean over {} strain rates of likelihood fits to the {WINDOW} widths next to *w*_{{c}}",
            exponents.len()
        ),
    };
    (part, mean.map(|mean| (mean, quantity(mean))))
}

/// Colours for strain rates.
fn rate_colours(rates: impl Iterator<Item = f64>) -> ColourScale {
    let (least, largest) = rates.fold((f64::INFINITY, 0.0_f64), |(least, largest), rate| {
        (least.min(rate), largest.max(rate))
    });
    let (least, largest) = if least < largest {
        (least, largest)
    } else {
        (0.02, 0.2)
    };
    ColourScale::new(&label(Axis::StrainRate), least, largest).logarithmic()
}

/// Error beyond which a value says nothing of one that the source gives, as a fraction of the latter.
const LARGE_ERROR: f64 = 0.25;

/// Whether a value is within two standard errors of what the source says; `None` where these are so large that hardly
/// anything would not be.
pub(crate) fn agrees(found: &Uncertain, source: f64) -> Option<bool> {
    let within = found.deviations_from(source).abs() <= 2.0;
    (!within || found.error <= LARGE_ERROR * source.abs()).then_some(within)
}

/// Equally spaced numbers from end to end.
fn spaced(from: f64, to: f64, count: usize) -> Vec<f64> {
    (0..count)
        .map(|place| from + (to - from) * place as f64 / (count.max(2) - 1) as f64)
        .collect()
}
