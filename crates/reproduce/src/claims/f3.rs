//! F3: whether transition times of several strain rates collapse.

use super::{LATTICES, Part, fitted, judge, lines_of, statistics};
use crate::claim::Claim;
use crate::collapse::{Collapsed, collapse, figure};
use crate::critical::Line;
use crate::error::ClaimError;
use crate::evidence::Evidence;
use crate::finding::{Finding, Statistics};
use crate::prose::Prose;

const PROSE: Prose = Prose::new(include_str!("f3.md"));

pub(super) const CLAIM: Claim = Claim {
    id: "F3",
    prose: PROSE,
    studies: &[
        "divergence-fine",
        "divergence-coarse",
        "branches-fine",
        "branches-coarse",
    ],
    examine,
};

/// Powers of the strain rate that the source gives: that of the time, and that of the distance.
const EXPONENTS: [f64; 2] = [3.5, 1.5];

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let mut found: Vec<(String, Collapsed)> = Vec::new();
    let mut parts = Vec::new();
    for study in LATTICES {
        let lines = lines_of(evidence, study)?;
        let fits = fitted(&lines);
        let used: Vec<&Line<'_>> = fits.iter().map(|(line, _)| *line).collect();
        let mean =
            |ensemble: &peristalsis_analysis::WidthEnsemble| ensemble.fit.map(|fit| fit.mean);
        let collapsed = collapse(&fits, EXPONENTS, 1.0, mean);
        parts.push(Part {
            lattice: study.0.name(),
            holds: collapsed.as_ref().and_then(Collapsed::agrees),
            statistics: statistics(&used),
        });
        if let Some(collapsed) = collapsed {
            found.push((study.0.name(), collapsed));
        }
    }
    let (verdict, statistics_found, why) = judge(&parts, &Statistics::FOR_A_VERDICT);
    if found.is_empty() {
        return Ok(Finding::nothing(
            "Too few strain rates with transitions to compare.",
            statistics_found,
            &Statistics::FOR_A_VERDICT,
        ));
    }
    let words: Vec<String> = found
        .iter()
        .map(|(name, collapsed)| format!("{name} lattice: {}", collapsed.in_words()))
        .collect();
    let mut finding = Finding::new(
        verdict,
        format!("{}. The source says 7/2 and 3/2.{why}", words.join("; ")),
        statistics_found,
        &Statistics::FOR_A_VERDICT,
    );
    for (name, collapsed) in &found {
        finding
            .quantities
            .extend(collapsed.quantities(&format!("{name} lattice"), ["*a*", "*b*"]));
        finding
            .tables
            .extend(collapsed.tables(&format!("{name} lattice")));
    }
    finding.paragraphs.push(
        "*τε̇*^{*a*} against (*w*_{c} − *w*)/*ε̇*^{*b*} with *w*_{c} of each strain rate as fitted for F2, and *a* and *b* \
         free: Houdayer and Hartmann's *S* over the mean transition times, at least three quarters of the points \
         overlapping. Errors by resampling the points within their errors, stretched by the root of *S* where that exceeds \
         1, or by leaving out one curve at a time, whichever is larger. Where *f* is one power *x*^{−*α*} over the whole range, only *a* − *αb* is determined, and *a* and *b* apart only by its bend."
            .to_owned(),
    );
    finding.weaknesses.push(
        "*S* well above 1 says that the curves differ by more than their errors, which are small: then the collapse is \
         approximate at best."
            .to_owned(),
    );
    finding.figures.push(figure(
        &found,
        "collapse-of-transition-times",
        ["(*w*_{c} − *w*)/*ε̇*^{3/2}", "*τε̇*^{7/2}"],
        "*τε̇*^{*a*}",
        -1.0,
        "Mean transition times scaled with the exponents of the source (left) and with those that collapse them best \
         (right), lattice by lattice; dashed: slope −1.",
    )?);
    Ok(finding)
}
