//! Quantities: a number and all that is said of it, from which columns, keys, labels and documentation follow.

/// A quantity that can be read off a value of type `Of`.
#[derive(Clone, Copy, Debug)]
pub struct Quantity<Of: 'static> {
    /// Name, the same in files, plots and Python.
    pub name: &'static str,
    /// Unit, in m, d, t; "1" for pure numbers, empty for words.
    pub unit: &'static str,
    /// Its meaning, in a line.
    pub text: &'static str,
    /// How it is read.
    pub reading: Reading<Of>,
}

/// How a quantity is read, by the kind of its value.
#[derive(Clone, Copy, Debug)]
pub enum Reading<Of: 'static> {
    /// A number; NaN where it is not known.
    Real(fn(&Of) -> f64),
    /// A number that not every run has.
    Optional(fn(&Of) -> Option<f64>),
    /// A number and its standard error, two columns.
    Measured(fn(&Of) -> (f64, f64)),
    /// A number and its standard error that not every run has.
    OptionalMeasured(fn(&Of) -> Option<(f64, f64)>),
    /// A count.
    Whole(fn(&Of) -> u64),
    /// Yes or no.
    Truth(fn(&Of) -> bool),
    /// Words.
    Text(fn(&Of) -> String),
}

/// The value of a quantity.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
#[serde(untagged)]
pub enum Value {
    /// A number; NaN where it is not known.
    Real(f64),
    /// A number that does not exist.
    Missing,
    /// A count.
    Whole(u64),
    /// Yes or no.
    Truth(bool),
    /// Words.
    Text(String),
}

impl<Of> Quantity<Of> {
    /// A quantity by name, unit and meaning.
    pub const fn new(
        name: &'static str,
        unit: &'static str,
        text: &'static str,
        reading: Reading<Of>,
    ) -> Self {
        Self {
            name,
            unit,
            text,
            reading,
        }
    }

    /// Names and meanings of its columns: the quantity, and where it is measured its standard error.
    pub fn headings(&self) -> Vec<(String, &'static str)> {
        let mut headings = vec![(self.name.to_owned(), self.text)];
        if self.is_measured() {
            headings.push((format!("{}_error", self.name), "its standard error"));
        }
        headings
    }

    /// The values of its columns.
    pub fn values(&self, of: &Of) -> Vec<Value> {
        let optional = |value: Option<f64>| value.map_or(Value::Missing, Value::Real);
        match self.reading {
            Reading::Real(read) => vec![Value::Real(read(of))],
            Reading::Optional(read) => vec![optional(read(of))],
            Reading::Measured(read) => {
                let (value, error) = read(of);
                vec![Value::Real(value), Value::Real(error)]
            }
            Reading::OptionalMeasured(read) => {
                let (value, error) = read(of).unzip();
                vec![optional(value), optional(error)]
            }
            Reading::Whole(read) => vec![Value::Whole(read(of))],
            Reading::Truth(read) => vec![Value::Truth(read(of))],
            Reading::Text(read) => vec![Value::Text(read(of))],
        }
    }

    /// Whether there may be none.
    pub fn is_optional(&self) -> bool {
        matches!(
            self.reading,
            Reading::Optional(_) | Reading::OptionalMeasured(_)
        )
    }

    /// Whether it has a standard error.
    pub fn is_measured(&self) -> bool {
        matches!(
            self.reading,
            Reading::Measured(_) | Reading::OptionalMeasured(_)
        )
    }
}
