//! F3: whether transition times of several strain rates collapse.

use peristalsis_analysis::WidthEnsemble;

use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("f3.md"));

pub(super) const CLAIM: Claim = Claim::new("F3", PROSE, DIVERGENCES, examine);

/// Powers of the strain rate that the source gives: of the time, and of the distance.
const EXPONENTS: [f64; 2] = [3.5, 1.5];

fn examine(evidence: &Evidence) -> Result<Finding> {
    let needed = Statistics::FOR_A_VERDICT;
    let mut found: Vec<(String, Collapsed)> = Vec::new();
    let mut parts = Vec::new();
    for one in OnLattice::all(evidence)? {
        let mean = |ensemble: &WidthEnsemble| Some(ensemble.fit?.mean);
        let collapsed = collapse(&one, EXPONENTS, 1.0, mean);
        parts.push(one.part(collapsed.as_ref().and_then(Collapsed::agrees)));
        found.extend(collapsed.map(|collapsed| (one.name, collapsed)));
    }
    let (verdict, statistics, why) = judge(&parts, &needed);
    if found.is_empty() {
        return Ok(PROSE.nothing(statistics, &needed));
    }
    let words =
        |(name, found): &(String, Collapsed)| format!("{name} lattice: {}", found.in_words());
    let words: Vec<String> = found.iter().map(words).collect();
    let summary = PROSE.text("summary", values!(found = words.join("; "), why));
    let mut draft = Draft::of(PROSE);
    for (name, collapsed) in &found {
        let of = format!("{name} lattice");
        let exponents = collapsed.quantities(&of, ["*a*", "*b*"]);
        draft.finding.quantities.extend(exponents);
        draft.finding.tables.push(collapsed.table(&of));
    }
    let labels = ["(*w*_{c} − *w*)/*ε̇*^{3/2}", "*τε̇*^{7/2}"];
    let chart = chart(&found, labels, "*τε̇*^{*a*}", -1.0);
    draft.chart("collapse-of-transition-times", &[], chart)?;
    Ok(draft.concluded(verdict, summary, statistics, &needed))
}
