//! What the claims about the stress-controlled tube share.

use peristalsis_figures::chart::{Points, Tint};
use peristalsis_figures::{ColourScale, Quantity as Axis, Units};

use crate::error::ClaimError;
use crate::evidence::Evidence;
use crate::finding::{Finding, Statistics, Verdict};
use crate::forces::{FOR_A_VERDICT, ForceBranch, ForceLine, WHAT_COUNTS};
use crate::runs::Run;

/// Strain rate of the source's pictures.
pub(super) const SOURCE_RATE: f64 = 4.01e-3;

/// The studies of the stationary flow of frictional grains, at all strain rates.
const BRANCHES: [&str; 2] = ["elastic-branches", "elastic-extremes"];

/// The runs of these studies.
pub(super) fn branch_runs(evidence: &Evidence) -> Result<Vec<Run>, ClaimError> {
    let mut runs = Vec::new();
    for study in BRANCHES {
        runs.extend(evidence.study(study)?.runs.iter().cloned());
    }
    Ok(runs)
}

/// The lines that are judged: those with points on them, stationary flows of grains that stay in the tube.
pub(super) fn judged(lines: &[ForceLine]) -> Vec<&ForceLine> {
    lines.iter().filter(|line| !line.is_empty()).collect()
}

/// Label of an axis, in the units of Hertz contacts.
pub(super) fn label(quantity: Axis) -> String {
    quantity.label(Units::Hertz)
}

/// A strain rate as text.
pub(super) fn rate_text(rate: f64) -> String {
    format!("{rate}")
}

/// Colours for the strain rates of some lines, whether or not they are judged.
pub(super) fn rate_colours(lines: &[ForceLine]) -> ColourScale {
    let ends = lines
        .iter()
        .map(|line| line.strain_rate)
        .fold((f64::INFINITY, 0.0_f64), |(least, largest), rate| {
            (least.min(rate), largest.max(rate))
        });
    let (least, largest) = if ends.0 < ends.1 { ends } else { (1e-3, 8e-3) };
    ColourScale::new(&label(Axis::StrainRate), least, largest).logarithmic()
}

/// A branch as points with error bars, coloured by the strain rate.
pub(super) fn branch_points(
    branch: &ForceBranch,
    name: &str,
    series: usize,
    strain_rate: f64,
) -> Option<Points> {
    let [force, mean, error] = branch.columns();
    (!force.is_empty()).then(|| {
        Points::new(name, &force, &mean)
            .y_errors(&error)
            .series(series)
            .tint(Tint::Value(strain_rate))
            .joined()
    })
}

/// A finding on forces, with what counts for its verdict.
pub(super) fn finding(verdict: Verdict, summary: String, statistics: Statistics) -> Finding {
    let mut finding = Finding::new(verdict, summary, statistics, &FOR_A_VERDICT);
    finding.varied = "force";
    finding.paragraphs.push(WHAT_COUNTS.to_owned());
    finding
}

/// A finding on forces without runs.
pub(super) fn nothing(reason: &str) -> Finding {
    let mut finding = Finding::nothing(reason, Statistics::default(), &FOR_A_VERDICT);
    finding.varied = "force";
    finding
}

/// Coefficient of kinetic friction of a run, where its study varies it.
pub(super) fn friction(run: &Run) -> f64 {
    run.axis("contact.kinetic_friction").unwrap_or(f64::NAN)
}

/// Whether the grains of a run are frictionless.
pub(super) fn is_frictionless(run: &Run) -> bool {
    friction(run) == 0.0
}
