//! What was found of a claim.

use peristalsis_analysis::{Interval, Uncertain};
use peristalsis_figures::Drawing;
use serde::{Serialize, Serializer};

/// What our runs say of a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// What the source says holds within our errors.
    Reproduced,
    /// It does not.
    Differs,
    /// A question that the source left open has an answer.
    Answered,
    /// The statistics do not allow a verdict, or what they show is none.
    Open,
}

impl Verdict {
    /// The word for it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Reproduced => "reproduced",
            Self::Differs => "differs",
            Self::Answered => "answered",
            Self::Open => "open",
        }
    }
}

/// How much is behind a finding: strain rates and runs of the parts that are compared together, the fewest widths and
/// replicates of any.
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

impl Statistics {
    /// What a verdict takes: 4 strain rates, 8 widths at each, 10 replicates of each point.
    pub const FOR_A_VERDICT: Self = Self {
        strain_rates: 4,
        widths: 8,
        replicates: 10,
        runs: 320,
    };

    /// What is behind runs at one strain rate, from what is varied in each.
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

    /// What is behind several parts that are compared: their strain rates and runs together, and the fewest widths and
    /// replicates of any; nothing where there is no part.
    #[must_use]
    pub fn weakest(parts: impl Iterator<Item = Self>) -> Self {
        parts
            .reduce(|one, other| Self {
                strain_rates: one.strain_rates + other.strain_rates,
                widths: one.widths.min(other.widths),
                replicates: one.replicates.min(other.replicates),
                runs: one.runs + other.runs,
            })
            .unwrap_or_default()
    }

    /// Whether there is as much as that in every respect.
    #[must_use]
    pub fn suffice(&self, needed: &Self) -> bool {
        self.strain_rates >= needed.strain_rates
            && self.widths >= needed.widths
            && self.replicates >= needed.replicates
    }
}

/// A number that a claim is about.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Quantity {
    /// What it is, in words, such as "exponent of the mean transition time, fine lattice, strain rate 0.1".
    pub name: String,
    /// Symbol in the markup of figures, such as `*α*`.
    pub symbol: String,
    /// Unit, empty for a pure number.
    pub unit: String,
    /// What the source says, where it gives a number.
    pub source: Option<f64>,
    /// What we find; `None` where the runs do not determine it.
    #[serde(serialize_with = "uncertain")]
    pub ours: Option<Uncertain>,
    /// How it was got, in a few words.
    pub method: String,
}

/// A table of the report.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ReportTable {
    /// What it shows, one sentence.
    pub caption: String,
    /// Heads of the columns, in markup.
    pub head: Vec<String>,
    /// Rows of cells, in markup.
    pub rows: Vec<Vec<String>>,
}

/// A figure of the report.
#[derive(Clone, Debug)]
pub struct ReportFigure {
    /// Short name, used for files: letters, digits and hyphens.
    pub name: String,
    /// What it shows and how to read it, in markup.
    pub caption: String,
    /// The drawing.
    pub drawing: Drawing,
}

/// What was found of a claim.
#[derive(Clone, Debug)]
pub struct Finding {
    /// The verdict.
    pub verdict: Verdict,
    /// Why this verdict, in one or two sentences with numbers, in markup.
    pub summary: String,
    /// What is behind it.
    pub statistics: Statistics,
    /// What a verdict would take.
    pub needed: Statistics,
    /// What is varied at each strain rate: "width", "force", "back pressure".
    pub varied: &'static str,
    /// Numbers, the most important first.
    pub quantities: Vec<Quantity>,
    /// Paragraphs about method and outcome, in markup.
    pub paragraphs: Vec<String>,
    /// What a critical reader should know, in markup.
    pub weaknesses: Vec<String>,
    /// Tables.
    pub tables: Vec<ReportTable>,
    /// Figures, the most important first.
    pub figures: Vec<ReportFigure>,
}

/// A number with its error as JSON: ends of intervals that are open are null.
fn uncertain<S: Serializer>(number: &Option<Uncertain>, serializer: S) -> Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    struct Plain {
        value: f64,
        error: Option<f64>,
        interval_68: [Option<f64>; 2],
        interval_95: [Option<f64>; 2],
    }
    let finite = |value: f64| value.is_finite().then_some(value);
    let ends = |interval: Interval| [finite(interval.lower), finite(interval.upper)];
    number
        .map(|number| Plain {
            value: number.value,
            error: finite(number.error),
            interval_68: ends(number.interval_68),
            interval_95: ends(number.interval_95),
        })
        .serialize(serializer)
}

impl Finding {
    /// A finding of which nothing but the verdict is known yet; the verdict is open where the statistics do not suffice.
    #[must_use]
    pub fn new(
        verdict: Verdict,
        summary: String,
        statistics: Statistics,
        needed: &Statistics,
    ) -> Self {
        let verdict = if statistics.suffice(needed) {
            verdict
        } else {
            Verdict::Open
        };
        Self {
            verdict,
            summary,
            statistics,
            needed: *needed,
            varied: "width",
            quantities: Vec::new(),
            paragraphs: Vec::new(),
            weaknesses: Vec::new(),
            tables: Vec::new(),
            figures: Vec::new(),
        }
    }

    /// A finding for which there are too few runs to say anything.
    #[must_use]
    pub fn nothing(reason: &str, statistics: Statistics, needed: &Statistics) -> Self {
        Self::new(Verdict::Open, reason.to_owned(), statistics, needed)
    }
}
