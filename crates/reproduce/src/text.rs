//! Numbers as sentences and cells of tables say them.

use peristalsis_analysis::Uncertain;
pub(crate) use peristalsis_analysis::number::{decimal as number, interval, with_error};

/// A number with its error.
pub(crate) fn estimate(number: &Uncertain) -> String {
    number.to_string()
}

/// A probability; very small ones come from the tails of approximate distributions, and are called small.
pub(crate) fn probability(value: f64) -> String {
    if value < 1e-3 {
        "< 0.001".to_owned()
    } else {
        number(value, 3)
    }
}
