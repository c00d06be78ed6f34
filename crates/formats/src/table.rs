//! Tables: the one shape of every tabular result, whatever file it ends up in.

use std::collections::{BTreeMap, HashSet};

use crate::error::FormatError;
use crate::value_kind::ValueKind;

/// Beginning of the metadata keys that Arrow keeps for itself.
const ARROW_PREFIX: &str = "ARROW:";

/// The metadata key that holds units and descriptions of the columns in a Parquet file.
pub(crate) const COLUMNS_KEY: &str = "peristalsis.columns";

/// Whether a file format keeps this metadata key for itself.
pub(crate) fn is_reserved(key: &str) -> bool {
    key.starts_with(ARROW_PREFIX) || key == COLUMNS_KEY
}

/// The values of one column, one a row.
///
/// A missing value exists for reals only: NaN, which becomes null in Parquet and an empty field in CSV.
///
/// Two columns of reals are equal if they agree bit for bit, so 0.0 differs from -0.0; any NaN equals any other, since
/// all of them mean "missing".
#[derive(Clone, Debug, serde::Serialize)]
#[serde(untagged)]
pub enum Values {
    /// Double-precision numbers; NaN is a missing value.
    Real(Vec<f64>),
    /// Signed 64-bit integers.
    Integer(Vec<i64>),
    /// Unicode text.
    Text(Vec<String>),
    /// True or false.
    Boolean(Vec<bool>),
}

impl Values {
    /// No values of the given kind.
    pub fn empty(kind: ValueKind) -> Self {
        match kind {
            ValueKind::Real => Self::Real(Vec::new()),
            ValueKind::Integer => Self::Integer(Vec::new()),
            ValueKind::Text => Self::Text(Vec::new()),
            ValueKind::Boolean => Self::Boolean(Vec::new()),
        }
    }

    /// The kind of these values.
    pub fn kind(&self) -> ValueKind {
        match self {
            Self::Real(_) => ValueKind::Real,
            Self::Integer(_) => ValueKind::Integer,
            Self::Text(_) => ValueKind::Text,
            Self::Boolean(_) => ValueKind::Boolean,
        }
    }

    /// Number of values, missing ones included.
    pub fn len(&self) -> usize {
        match self {
            Self::Real(values) => values.len(),
            Self::Integer(values) => values.len(),
            Self::Text(values) => values.len(),
            Self::Boolean(values) => values.len(),
        }
    }

    /// Whether there are no values.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// Reals as equality sees them: their bits, with one pattern for every NaN.
fn canonical_bits(values: &[f64]) -> impl Iterator<Item = u64> {
    values.iter().map(|value| match value.is_nan() {
        true => f64::NAN.to_bits(),
        false => value.to_bits(),
    })
}

impl PartialEq for Values {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Real(left), Self::Real(right)) => canonical_bits(left).eq(canonical_bits(right)),
            (Self::Integer(left), Self::Integer(right)) => left == right,
            (Self::Text(left), Self::Text(right)) => left == right,
            (Self::Boolean(left), Self::Boolean(right)) => left == right,
            _ => false,
        }
    }
}

impl Eq for Values {}

/// One named column of a [`Table`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Name, unique in its table.
    pub name: String,
    /// Unit of the values, such as `d t^-1`; empty for counts, ratios and text.
    pub unit: String,
    /// Meaning of the values, in one line.
    pub description: String,
    /// The values, one a row.
    pub values: Values,
}

impl Column {
    fn same_header(&self, other: &Self) -> bool {
        self.name == other.name
            && self.unit == other.unit
            && self.description == other.description
            && self.values.kind() == other.values.kind()
    }
}

/// Equally long columns with distinct names, and text metadata about the whole.
///
/// ```
/// use peristalsis_formats::{Table, Values};
///
/// let table = Table::builder()
///     .column("time", "t", "Time since the start.", Values::Real(vec![0.0, 0.5]))
///     .column("contacts", "", "Grain pairs in contact.", Values::Integer(vec![12, 15]))
///     .metadata("version", "0.1.0")
///     .build()?;
/// assert_eq!(table.rows(), 2);
/// assert_eq!(table.reals("time")?[1], 0.5);
/// # Ok::<(), peristalsis_formats::FormatError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Table {
    columns: Vec<Column>,
    metadata: BTreeMap<String, String>,
}

impl Table {
    /// Begins a table without columns.
    pub fn builder() -> TableBuilder {
        TableBuilder::default()
    }

    /// The columns, in the order in which they were added.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Number of rows, the same in every column.
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, |column| column.values.len())
    }

    /// Metadata about the whole table: version, revision, configuration.
    pub fn metadata(&self) -> &BTreeMap<String, String> {
        &self.metadata
    }

    /// The column of this name.
    ///
    /// # Errors
    /// [`FormatError::MissingColumn`].
    pub fn column(&self, name: &str) -> Result<&Column, FormatError> {
        let column = self.columns.iter().find(|column| column.name == name);
        column.ok_or_else(|| FormatError::MissingColumn(name.to_owned()))
    }

    /// The values of a column of reals; NaN is a missing value.
    ///
    /// # Errors
    /// [`FormatError::MissingColumn`], [`FormatError::OtherKind`].
    pub fn reals(&self, name: &str) -> Result<&[f64], FormatError> {
        match &self.column(name)?.values {
            Values::Real(values) => Ok(values),
            other => Err(other_kind(name, ValueKind::Real, other)),
        }
    }

    /// The values of a column of integers.
    ///
    /// # Errors
    /// [`FormatError::MissingColumn`], [`FormatError::OtherKind`].
    pub fn integers(&self, name: &str) -> Result<&[i64], FormatError> {
        match &self.column(name)?.values {
            Values::Integer(values) => Ok(values),
            other => Err(other_kind(name, ValueKind::Integer, other)),
        }
    }

    /// The values of a column of text.
    ///
    /// # Errors
    /// [`FormatError::MissingColumn`], [`FormatError::OtherKind`].
    pub fn texts(&self, name: &str) -> Result<&[String], FormatError> {
        match &self.column(name)?.values {
            Values::Text(values) => Ok(values),
            other => Err(other_kind(name, ValueKind::Text, other)),
        }
    }

    /// The values of a column of booleans.
    ///
    /// # Errors
    /// [`FormatError::MissingColumn`], [`FormatError::OtherKind`].
    pub fn booleans(&self, name: &str) -> Result<&[bool], FormatError> {
        match &self.column(name)?.values {
            Values::Boolean(values) => Ok(values),
            other => Err(other_kind(name, ValueKind::Boolean, other)),
        }
    }

    /// Adds the rows of another table below the rows of this one; the metadata of this one stays.
    ///
    /// # Errors
    /// [`FormatError::DifferentColumns`] unless names, kinds, units and descriptions agree in order; this table is then
    /// unchanged.
    pub fn append(&mut self, other: Self) -> Result<(), FormatError> {
        let differing = (0..self.columns.len().max(other.columns.len())).find_map(|index| {
            match (self.columns.get(index), other.columns.get(index)) {
                (Some(upper), Some(lower)) if upper.same_header(lower) => None,
                (upper, lower) => upper.or(lower),
            }
        });
        if let Some(column) = differing {
            return Err(FormatError::DifferentColumns(column.name.clone()));
        }
        for (upper, lower) in self.columns.iter_mut().zip(other.columns) {
            match (&mut upper.values, lower.values) {
                (Values::Real(values), Values::Real(more)) => values.extend(more),
                (Values::Integer(values), Values::Integer(more)) => values.extend(more),
                (Values::Text(values), Values::Text(more)) => values.extend(more),
                (Values::Boolean(values), Values::Boolean(more)) => values.extend(more),
                _ => unreachable!("the kinds were compared above"),
            }
        }
        Ok(())
    }
}

fn other_kind(name: &str, expected: ValueKind, found: &Values) -> FormatError {
    FormatError::OtherKind {
        name: name.to_owned(),
        expected,
        found: found.kind(),
    }
}

/// Collects the columns and the metadata of a [`Table`]; [`build`](Self::build) checks them.
#[derive(Clone, Debug, Default)]
pub struct TableBuilder {
    columns: Vec<Column>,
    metadata: BTreeMap<String, String>,
}

impl TableBuilder {
    /// Adds a column to the right.
    pub fn column(
        mut self,
        name: impl Into<String>,
        unit: impl Into<String>,
        description: impl Into<String>,
        values: Values,
    ) -> Self {
        self.columns.push(Column {
            name: name.into(),
            unit: unit.into(),
            description: description.into(),
            values,
        });
        self
    }

    /// Adds finished columns to the right.
    #[must_use]
    pub fn columns(mut self, columns: impl IntoIterator<Item = Column>) -> Self {
        self.columns.extend(columns);
        self
    }

    /// Sets one entry of the metadata; a later value replaces an earlier one.
    #[must_use]
    pub fn metadata(mut self, key: impl Into<String>, value: impl Into<String>) -> Self {
        self.metadata.insert(key.into(), value.into());
        self
    }

    /// Checks the parts and joins them.
    ///
    /// # Errors
    /// [`FormatError::NoColumns`], [`FormatError::UnnamedColumn`], [`FormatError::DuplicateColumn`],
    /// [`FormatError::UnequalLength`], [`FormatError::ReservedMetadata`].
    pub fn build(self) -> Result<Table, FormatError> {
        let Self { columns, metadata } = self;
        let expected = columns.first().ok_or(FormatError::NoColumns)?.values.len();
        let mut names = HashSet::with_capacity(columns.len());
        for (index, column) in columns.iter().enumerate() {
            if column.name.is_empty() {
                return Err(FormatError::UnnamedColumn(index));
            }
            if !names.insert(column.name.as_str()) {
                return Err(FormatError::DuplicateColumn(column.name.clone()));
            }
            let found = column.values.len();
            if found != expected {
                return Err(FormatError::UnequalLength {
                    name: column.name.clone(),
                    found,
                    expected,
                });
            }
        }
        if let Some(key) = metadata.keys().find(|key| is_reserved(key)) {
            return Err(FormatError::ReservedMetadata(key.clone()));
        }
        Ok(Table { columns, metadata })
    }
}

#[cfg(test)]
mod tests;
