//! F3: whether transition times of several strain rates collapse.

use crate::claim::Claim;
use crate::collapse::{Collapsed, collapse, drawing};
use crate::critical::OnLattice;
use crate::error::ClaimError;
use crate::evidence::Evidence;
use crate::finding::{Finding, Statistics};
use crate::judgement::judge;
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

/// Powers of the strain rate that the source gives: of the time, and of the distance.
const EXPONENTS: [f64; 2] = [3.5, 1.5];

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let needed = Statistics::FOR_A_VERDICT;
    let mut found: Vec<(String, Collapsed)> = Vec::new();
    let mut parts = Vec::new();
    for one in OnLattice::all(evidence)? {
        let mean = |ensemble: &peristalsis_analysis::WidthEnsemble| Some(ensemble.fit?.mean);
        let collapsed = collapse(&one, EXPONENTS, 1.0, mean);
        parts.push(one.part(collapsed.as_ref().and_then(Collapsed::agrees)));
        found.extend(collapsed.map(|collapsed| (one.name, collapsed)));
    }
    let (verdict, statistics, why) = judge(&parts, &needed);
    if found.is_empty() {
        let nothing = PROSE.text("nothing", &[]);
        return Ok(Finding::nothing(&nothing, statistics, &needed));
    }
    let words: Vec<String> = found
        .iter()
        .map(|(name, collapsed)| format!("{name} lattice: {}", collapsed.in_words()))
        .collect();
    let summary = PROSE.text("summary", &[("found", &words.join("; ")), ("why", &why)]);
    let mut finding = Finding::new(verdict, summary, statistics, &needed);
    for (name, collapsed) in &found {
        let of = format!("{name} lattice");
        finding
            .quantities
            .extend(collapsed.quantities(&of, ["*a*", "*b*"]));
        finding.tables.push(collapsed.table(&of));
    }
    finding.paragraphs = PROSE.paragraphs("method", &[]);
    finding.weaknesses = PROSE.paragraphs("weaknesses", &[]);
    let labels = ["(*w*_{c} − *w*)/*ε̇*^{3/2}", "*τε̇*^{7/2}"];
    finding.figures.push(PROSE.figure(
        "collapse-of-transition-times",
        &[],
        drawing(&found, labels, "*τε̇*^{*a*}", -1.0)?,
    ));
    Ok(finding)
}
