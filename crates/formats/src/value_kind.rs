//! The kinds of values that a column can hold.

use std::fmt;

/// The kind of the values in one column.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ValueKind {
    /// Double-precision numbers, with NaN for a missing one.
    Real,
    /// Signed 64-bit integers.
    Integer,
    /// Unicode text.
    Text,
    /// True or false.
    Boolean,
}

impl fmt::Display for ValueKind {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Real => "real",
            Self::Integer => "integer",
            Self::Text => "text",
            Self::Boolean => "boolean",
        })
    }
}
