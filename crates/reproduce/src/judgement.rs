//! From numbers to verdicts.

use peristalsis_analysis::Uncertain;

use crate::finding::{Statistics, Verdict};
use crate::thresholds::{AGREES_WITHIN, LARGE_ERROR};

/// Whether a value agrees with the source within its errors; `None` where these are so large that hardly any would not.
pub(crate) fn agrees(found: &Uncertain, source: f64) -> Option<bool> {
    let within = found.deviations_from(source).abs() <= AGREES_WITHIN;
    (!within || found.error <= LARGE_ERROR * source.abs()).then_some(within)
}

/// Whether all parts of a claim hold: not, where one does not; `None` where one of the others cannot be told.
pub(crate) fn all_hold(parts: &[Option<bool>]) -> Option<bool> {
    if parts.contains(&Some(false)) {
        return Some(false);
    }
    parts.iter().all(Option::is_some).then_some(true)
}

/// What one lattice says of a claim.
pub(crate) struct Part {
    /// Its name.
    pub(crate) lattice: String,
    /// Whether the claim holds there; `None` where the errors are too large to say.
    pub(crate) holds: Option<bool>,
    /// How much is behind it.
    pub(crate) statistics: Statistics,
}

/// The verdict of several lattices: the one on which the lattices with enough evidence agree, else open. With it
/// the statistics of the lattice that has most, and why the verdict is open, if it is.
pub(crate) fn judge(parts: &[Part], needed: &Statistics) -> (Verdict, Statistics, String) {
    let enough: Vec<&Part> = parts
        .iter()
        .filter(|part| part.statistics.suffice(needed))
        .collect();
    let named = |holds: bool| -> String {
        let those = enough.iter().filter(|part| part.holds == Some(holds));
        let names: Vec<&str> = those.map(|part| part.lattice.as_str()).collect();
        names.join(" and ")
    };
    let (holding, failing) = (named(true), named(false));
    let (verdict, why) = match (holding.is_empty(), failing.is_empty()) {
        (false, true) => (Verdict::Reproduced, String::new()),
        (true, false) => (Verdict::Differs, String::new()),
        (false, false) => (
            Verdict::Open,
            format!(" It holds on the {holding} lattice and not on the {failing} one: open."),
        ),
        (true, true) if enough.is_empty() => (Verdict::Open, String::new()),
        (true, true) => (
            Verdict::Open,
            " The errors are too large to tell.".to_owned(),
        ),
    };
    let statistics = best(parts.iter().map(|part| part.statistics), needed);
    (verdict, statistics, why)
}

/// The statistics that suffice, or come nearest to that.
pub(crate) fn best(all: impl Iterator<Item = Statistics>, needed: &Statistics) -> Statistics {
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
