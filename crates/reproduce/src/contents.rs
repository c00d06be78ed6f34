//! The contents of findings: numbers, tables and figures.

use peristalsis_analysis::{Interval, Uncertain};
use peristalsis_figures::Drawing;
use serde::{Serialize, Serializer};

/// A number that a claim is about.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Quantity {
    /// Its name in words, such as "exponent of the mean transition time, fine lattice, strain rate 0.1".
    pub name: String,
    /// Symbol in the markup of figures, such as `*α*`.
    pub symbol: String,
    /// Unit, empty for a pure number.
    pub unit: String,
    /// The value of the source, where it gives one.
    pub source: Option<f64>,
    /// Our value; `None` where the runs do not determine it.
    #[serde(serialize_with = "uncertain")]
    pub ours: Option<Uncertain>,
    /// How it was got, in a few words.
    pub method: String,
}

impl Quantity {
    /// The same, with the value of the source.
    pub(crate) fn sourced(self, source: f64) -> Self {
        let source = Some(source);
        Self { source, ..self }
    }
}

/// A table of the report.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ReportTable {
    /// Its subject in one sentence.
    pub caption: String,
    /// Heads of the columns, in markup.
    pub head: Vec<String>,
    /// Rows of cells, in markup.
    pub rows: Vec<Vec<String>>,
}

impl ReportTable {
    /// A table from its caption, the heads of its columns and its rows.
    pub(crate) fn new<H: Into<String>>(
        caption: &str,
        head: impl IntoIterator<Item = H>,
        rows: impl IntoIterator<Item = Vec<String>>,
    ) -> Self {
        Self {
            caption: caption.to_owned(),
            head: head.into_iter().map(Into::into).collect(),
            rows: rows.into_iter().collect(),
        }
    }
}

/// A figure of the report.
#[derive(Clone, Debug)]
pub struct ReportFigure {
    /// Short name, used for files: letters, digits and hyphens.
    pub name: String,
    /// Its subject and how to read it, in markup.
    pub caption: String,
    /// The drawing.
    pub drawing: Drawing,
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
