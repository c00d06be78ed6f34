//! From numbers to verdicts.
//!
//! A verdict belongs to a claim and a wall. The source had one tube and does not say which, so that its claim counts as
//! reproduced where at least one wall with enough evidence reproduces it; it differs where all walls that could be judged
//! differ; else it is open. The headline names the walls.

use peristalsis_analysis::Uncertain;

use crate::exhibit::listed;
use crate::finding::{Statistics, Verdict, WallVerdict, Without};
use crate::thresholds::{LEAST_RATES, LONG, MOST_RATES};

/// Whether the source's value lies in the 95 per cent interval of ours; `None` where that interval is not known, or so
/// wide that it says little.
pub(crate) fn agrees(found: &Uncertain, source: f64) -> Option<bool> {
    let (within, length) = (
        found.interval_95.contains(source),
        found.interval_95.length(),
    );
    let is_narrow = length <= LONG * source.abs();
    (is_narrow || !within && !length.is_nan()).then_some(within)
}

/// What is said of a part of a claim.
pub(crate) const fn said(holds: Option<bool>) -> &'static str {
    match holds {
        Some(true) => "holds",
        Some(false) => "does not hold",
        None => "undecided",
    }
}

/// Whether all parts of a claim hold: not, where one does not; `None` where one of the others is undecided.
pub(crate) fn all_hold(parts: &[Option<bool>]) -> Option<bool> {
    if parts.contains(&Some(false)) {
        return Some(false);
    }
    parts.iter().all(Option::is_some).then_some(true)
}

/// The same with a last part, which takes long and is asked only where the others do not decide.
pub(crate) fn all_hold_with(
    parts: &[Option<bool>],
    last: impl FnOnce() -> Option<bool>,
) -> Option<bool> {
    match all_hold(parts) {
        Some(false) => Some(false),
        rest => all_hold(&[rest, last()]),
    }
}

/// At which strain rates, or other values of a parameter, a claim holds.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rates {
    /// Where it does, where it does not, and where that is undecided, each ascending.
    pub(crate) holding: Vec<f64>,
    pub(crate) failing: Vec<f64>,
    pub(crate) unknown: Vec<f64>,
}

impl Rates {
    /// From each strain rate and whether the claim holds there.
    pub(crate) fn of(all: impl IntoIterator<Item = (f64, Option<bool>)>) -> Self {
        let mut rates = Self::default();
        for (rate, holds) in all {
            match holds {
                Some(true) => rates.holding.push(rate),
                Some(false) => rates.failing.push(rate),
                None => rates.unknown.push(rate),
            }
        }
        rates
    }

    /// Whether the claim holds at nearly all strain rates: one alone decides nothing. `None` where too few are decided, or
    /// they are divided.
    pub(crate) fn hold(&self) -> Option<bool> {
        let decided = self.holding.len() + self.failing.len();
        let part = self.holding.len() as f64 / decided as f64;
        match decided >= LEAST_RATES {
            true if part >= MOST_RATES => Some(true),
            true if part <= 1.0 - MOST_RATES => Some(false),
            _ => None,
        }
    }

    /// "4 of 5".
    pub(crate) fn count(&self) -> String {
        let all = self.holding.len() + self.failing.len() + self.unknown.len();
        format!("{} of {all}", self.holding.len())
    }

    /// "at *ε̇* = 0.05, 0.1; not at 0.03; undecided at 0.2".
    pub(crate) fn in_words(&self) -> String {
        let parts = [
            ("at *ε̇* = ", &self.holding),
            ("not at ", &self.failing),
            ("undecided at ", &self.unknown),
        ];
        let texts: Vec<String> = parts
            .iter()
            .filter(|(_, rates)| !rates.is_empty())
            .map(|(word, rates)| format!("{word}{}", listed(rates.iter().copied())))
            .collect();
        texts.join("; ")
    }
}

/// What one wall says of a claim.
pub(crate) struct Part {
    /// Its name.
    pub(crate) wall: String,
    /// Whether the claim holds there; `None` where the errors are too large to say.
    pub(crate) holds: Option<bool>,
    /// Strain rates without which it would be another, with what it would be.
    pub(crate) depends_on: Vec<(f64, Option<bool>)>,
    /// How much is behind it.
    pub(crate) statistics: Statistics,
    /// The number that decides, with its error, in a few words.
    pub(crate) number: String,
    /// Why.
    pub(crate) why: String,
}

/// The verdict on a claim from all walls.
pub(crate) struct Judgement {
    /// The claim's own verdict.
    pub(crate) verdict: Verdict,
    /// The statistics of the wall that has most.
    pub(crate) statistics: Statistics,
    /// The verdict on each wall.
    pub(crate) walls: Vec<WallVerdict>,
}

impl Judgement {
    /// Of what each wall says.
    pub(crate) fn of(parts: Vec<Part>, needed: &Statistics) -> Self {
        let statistics = best(parts.iter().map(|part| part.statistics), needed);
        let on_wall = |part: Part| {
            let is_enough = part.statistics.suffice(needed);
            let verdict = Verdict::of(part.holds.filter(|_| is_enough));
            let depends_on = part.depends_on.into_iter().filter(|_| is_enough);
            let depends_on = depends_on.map(|(strain_rate, holds)| Without {
                strain_rate,
                verdict: Verdict::of(holds),
            });
            let depends_on: Vec<Without> = depends_on.collect();
            let why = match is_enough {
                true => part.why,
                false => format!("too few runs or widths for a verdict; {}", part.why),
            };
            let (wall, number) = (part.wall, part.number);
            WallVerdict {
                wall,
                verdict,
                depends_on,
                number,
                why,
            }
        };
        let walls: Vec<WallVerdict> = parts.into_iter().map(on_wall).collect();
        let any = |verdict| walls.iter().any(|wall| wall.verdict == verdict);
        let verdict = match (any(Verdict::Reproduced), any(Verdict::Differs)) {
            (true, _) => Verdict::Reproduced,
            (false, true) => Verdict::Differs,
            (false, false) => Verdict::Open,
        };
        Self {
            verdict,
            statistics,
            walls,
        }
    }

    /// "Reproduced on 24 × 26; differs on 12 × 14."
    pub(crate) fn headline(&self) -> String {
        let verdicts = [Verdict::Reproduced, Verdict::Differs, Verdict::Open];
        let on = |verdict: Verdict| {
            let walls = self.walls.iter().filter(|wall| wall.verdict == verdict);
            let names: Vec<&str> = walls.map(|wall| wall.wall.as_str()).collect();
            (!names.is_empty()).then(|| format!("{} on {}", verdict.name(), names.join(", ")))
        };
        let text = verdicts.into_iter().filter_map(on).collect::<Vec<_>>();
        let mut letters = text.join("; ");
        if let Some(first) = letters.get_mut(..1) {
            first.make_ascii_uppercase();
        }
        letters
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    fn part(wall: &str, holds: Option<bool>, replicates: usize) -> Part {
        Part {
            wall: wall.to_owned(),
            holds,
            depends_on: Vec::new(),
            statistics: Statistics::of(4, 8, replicates, 320),
            number: String::new(),
            why: String::new(),
        }
    }

    #[test]
    fn a_value_agrees_where_its_interval_is_narrow_and_holds_the_source() {
        let of = |found: Uncertain| agrees(&found, 2.0);
        assert_eq!(of(Uncertain::normal(2.1, 0.1)), Some(true));
        assert_eq!(of(Uncertain::normal(2.3, 0.1)), Some(false));
        // Three errors off, but the error comes from three values: the interval reaches 4.3 errors.
        assert_eq!(of(Uncertain::student(2.3, 0.1, 2)), Some(true));
        // Wide, open or not known.
        assert_eq!(of(Uncertain::student(2.3, 0.2, 1)), None);
        assert_eq!(of(Uncertain::student(2.3, f64::NAN, 0)), None);
        assert_eq!(of(Uncertain::normal(2.3, f64::NAN)), None);
        // Wide, and yet without the source's value.
        assert_eq!(of(Uncertain::normal(5.0, 1.0)), Some(false));
    }

    #[test]
    fn one_wall_that_reproduces_suffices_and_all_must_differ() {
        let (yes, no) = (Some(true), Some(false));
        for (parts, verdict, headline) in [
            (
                vec![part("a", yes, 10), part("b", no, 10)],
                Verdict::Reproduced,
                "Reproduced on a; differs on b",
            ),
            (
                vec![part("a", yes, 9), part("b", no, 10)],
                Verdict::Differs,
                "Differs on b; open on a",
            ),
            (vec![part("a", None, 10)], Verdict::Open, "Open on a"),
            (Vec::new(), Verdict::Open, ""),
        ] {
            let found = Judgement::of(parts, &Statistics::FOR_A_VERDICT);
            assert_eq!((found.verdict, &*found.headline()), (verdict, headline));
        }
    }

    #[test]
    fn what_a_verdict_depends_on_is_said() {
        let found = |depends_on: &[(f64, Option<bool>)], replicates| {
            let part = Part {
                depends_on: depends_on.to_vec(),
                ..part("a", Some(true), replicates)
            };
            let mut found = Judgement::of(vec![part], &Statistics::FOR_A_VERDICT);
            let wall = found.walls.remove(0);
            (wall.verdict_with_mark(), wall.depends_on_in_words())
        };
        let words = |verdict: &str, depends_on: &str| (verdict.to_owned(), depends_on.to_owned());
        assert_eq!(found(&[], 10), words("reproduced", ""));
        let open = [(0.1, None), (0.2, None)];
        assert_eq!(found(&open, 10), words("reproduced †", "0.1, 0.2 (open)"));
        let opposite = [(0.1, None), (0.2, Some(false))];
        let both = words("reproduced ‡", "0.2 (differs); 0.1 (open)");
        assert_eq!(found(&opposite, 10), both);
        // With too few runs there is no verdict that could hang on anything.
        assert_eq!(found(&opposite, 9), words("open", ""));
    }

    #[test]
    fn one_strain_rate_alone_decides_nothing() {
        let rates = |holds: &[bool]| {
            Rates::of(
                (1..)
                    .zip(holds)
                    .map(|(rate, holds)| (f64::from(rate), Some(*holds))),
            )
        };
        assert_eq!(rates(&[true, true, false, true]).hold(), Some(true));
        assert_eq!(rates(&[false, true, false, false]).hold(), Some(false));
        assert_eq!(rates(&[false, true, false, true]).hold(), None);
        assert_eq!(rates(&[true, true]).hold(), None);
        let words = rates(&[true, false, true]).in_words();
        assert_eq!(words, "at *ε̇* = 1, 3; not at 2");
    }
}
