//! Findings of experiments.

use core::fmt;

use peristalsis_formats::Table;
use serde::Serialize;

use crate::check::{Check, Convergence};
pub use crate::contents::{Quantity, ReportFigure, ReportTable};
use crate::exhibit::listed;

/// The verdict on a claim or a textbook case.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// The statement of the source holds within our errors; every check of a textbook case passed.
    Reproduced,
    /// It does not hold.
    Differs,
    /// A question that the source left open has an answer.
    Answered,
    /// There are too few runs for a verdict, or they show neither.
    #[default]
    Open,
}

impl Verdict {
    /// All of them, in the order in which they are counted.
    pub const ALL: [Self; 4] = [Self::Reproduced, Self::Differs, Self::Answered, Self::Open];

    /// The verdict on a claim that holds or not; open where that is not known.
    pub(crate) fn of(holds: Option<bool>) -> Self {
        match holds {
            Some(true) => Self::Reproduced,
            Some(false) => Self::Differs,
            None => Self::Open,
        }
    }

    /// The verdict on a question of which enough is known, or not.
    pub(crate) fn answered_if(is_known: bool) -> Self {
        if is_known { Self::Answered } else { Self::Open }
    }

    /// The word for it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Reproduced => "reproduced",
            Self::Differs => "differs",
            Self::Answered => "answered",
            Self::Open => "open",
        }
    }
}

/// The number of runs behind a finding: strain rates and runs of all parts that are compared, the fewest widths and replicates
/// of any part.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Statistics {
    /// Strain rates.
    pub strain_rates: usize,
    /// Widths at each; forces under stress control, or what else is varied.
    pub widths: usize,
    /// Replicates of each point.
    pub replicates: usize,
    /// Runs in all.
    pub runs: usize,
}

/// Strain rates × widths × replicates.
impl fmt::Display for Statistics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            strain_rates,
            widths,
            replicates,
            ..
        } = self;
        write!(f, "{strain_rates} × {widths} × {replicates}")
    }
}

impl Statistics {
    /// The least for a verdict: 4 strain rates, 8 widths at each, 10 replicates of each point.
    pub const FOR_A_VERDICT: Self = Self::needed(4, 8, 10);

    /// At least so many strain rates, widths and replicates, and so a run of each.
    pub(crate) const fn needed(strain_rates: usize, widths: usize, replicates: usize) -> Self {
        let runs = strain_rates * widths * replicates;
        Self::of(strain_rates, widths, replicates, runs)
    }

    /// So many strain rates, widths, replicates and runs.
    pub(crate) const fn of(
        strain_rates: usize,
        widths: usize,
        replicates: usize,
        runs: usize,
    ) -> Self {
        Self {
            strain_rates,
            widths,
            replicates,
            runs,
        }
    }

    /// Statistics of runs at one strain rate, from the value in each run of the parameter that is varied.
    pub(crate) fn at_one_rate(varied: impl Iterator<Item = f64>) -> Self {
        let mut varied: Vec<f64> = varied.collect();
        varied.sort_by(f64::total_cmp);
        let runs = varied.len();
        let same = |one: &f64, other: &f64| one == other;
        let replicates = varied.chunk_by(same).map(<[f64]>::len).min().unwrap_or(0);
        varied.dedup();
        Self {
            strain_rates: 1,
            widths: varied.len(),
            replicates,
            runs,
        }
    }

    /// Statistics of several parts that are compared: all strain rates and runs, and the fewest widths and replicates of any
    /// part; zero where there is no part.
    pub(crate) fn weakest(parts: impl Iterator<Item = Self>) -> Self {
        parts
            .reduce(|one, other| Self {
                strain_rates: one.strain_rates + other.strain_rates,
                widths: one.widths.min(other.widths),
                replicates: one.replicates.min(other.replicates),
                runs: one.runs + other.runs,
            })
            .unwrap_or_default()
    }

    /// Statistics of several parts that are compared at one strain rate.
    pub(crate) fn weakest_at_one_rate(parts: impl Iterator<Item = Self>) -> Self {
        Self {
            strain_rates: 1,
            ..Self::weakest(parts)
        }
    }

    /// Whether there are at least as many strain rates, widths and replicates as are needed.
    pub fn suffice(&self, needed: &Self) -> bool {
        self.strain_rates >= needed.strain_rates
            && self.widths >= needed.widths
            && self.replicates >= needed.replicates
    }
}

/// The verdict on a wall without its runs at one strain rate.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Without {
    /// The strain rate that is left out.
    pub strain_rate: f64,
    /// What the others say.
    pub verdict: Verdict,
}

/// What one wall says of a claim.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WallVerdict {
    /// Name of the wall: spheres a ring, rings a wave, and how they stand.
    pub wall: String,
    /// The verdict there: reproduced, differs or open.
    pub verdict: Verdict,
    /// The strain rates without any one of which the verdict would be another; none where no single one decides.
    pub depends_on: Vec<Without>,
    /// The number that decides, with its error, in a few words of markup.
    pub number: String,
    /// Why this verdict, in markup.
    pub why: String,
}

impl WallVerdict {
    /// The word for the verdict, with a dagger where it would be open without one of the strain rates, and with a double one
    /// where it would be the opposite.
    pub(crate) fn verdict_with_mark(&self) -> String {
        let is_opposite = |one: &Without| one.verdict != Verdict::Open;
        let mark = match self.depends_on.as_slice() {
            [] => "",
            those if those.iter().any(is_opposite) => " ‡",
            _ => " †",
        };
        format!("{}{mark}", self.verdict.name())
    }

    /// "0.2 (differs); 0.1, 0.14 (open)": the strain rates that it depends on, and what it would be without one of them.
    pub(crate) fn depends_on_in_words(&self) -> String {
        let words = |verdict: Verdict| {
            let those = self.depends_on.iter().filter(|one| one.verdict == verdict);
            let rates = listed(those.map(|one| one.strain_rate));
            (!rates.is_empty()).then(|| format!("{rates} ({})", verdict.name()))
        };
        let words = Verdict::ALL.into_iter().filter_map(words);
        words.collect::<Vec<_>>().join("; ")
    }
}

/// The finding on a claim, or on a textbook case.
#[derive(Clone, Debug, Default)]
pub struct Finding {
    /// The verdict.
    pub verdict: Verdict,
    /// The verdict on each wall that was examined; none where a claim is not about walls of fixed spheres.
    pub walls: Vec<WallVerdict>,
    /// Why this verdict, in one or two sentences with numbers, in markup.
    pub summary: String,
    /// The runs behind it.
    pub statistics: Statistics,
    /// Numbers, the most important first.
    pub quantities: Vec<Quantity>,
    /// Numbers beside their expected values.
    pub checks: Vec<Check>,
    /// Errors against the time step.
    pub convergences: Vec<Convergence>,
    /// Paragraphs about method and outcome, in markup.
    pub paragraphs: Vec<String>,
    /// Objections that a reader should know, in markup.
    pub weaknesses: Vec<String>,
    /// Tables.
    pub tables: Vec<ReportTable>,
    /// Figures, the most important first.
    pub figures: Vec<ReportFigure>,
    /// Everything that was measured, for programs.
    pub data: Option<Table>,
}

impl Finding {
    /// The verdict that follows from checks and orders alone; open where nothing was checked.
    pub(crate) fn verdict_of_checks(&self) -> Verdict {
        let all_pass = self.checks.iter().all(|check| check.passed)
            && self
                .convergences
                .iter()
                .all(|convergence| convergence.passed);
        match all_pass {
            _ if self.checks.is_empty() => Verdict::Open,
            true => Verdict::Reproduced,
            false => Verdict::Differs,
        }
    }
}
