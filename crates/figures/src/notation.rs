//! How the numbers of an axis are written, in markup.

/// How the labels of one linear axis are written: all with the same decimals and the same power of ten.
pub(crate) struct Notation {
    power: f64,
    decimals: usize,
}

impl Notation {
    /// For values up to a magnitude, in steps of 10^exponent.
    pub(crate) fn new(magnitude: f64, exponent: f64) -> Self {
        let leading = libm::floor(libm::log10(magnitude) + 1e-9);
        let is_plain = (-3.0..5.0).contains(&leading);
        let power = if is_plain { 0.0 } else { leading };
        Self {
            power,
            decimals: (power - exponent).max(0.0) as usize,
        }
    }

    pub(crate) fn label(&self, value: f64) -> String {
        let digits = decimal(value / libm::pow(10.0, self.power), self.decimals);
        if self.power == 0.0 || value == 0.0 {
            digits
        } else {
            format!("{digits}×10^{{{}}}", decimal(self.power, 0))
        }
    }
}

/// A multiple of a power of ten.
pub(crate) fn power_label(multiple: u8, exponent: f64) -> String {
    match (multiple, exponent) {
        (1, 0.0) => "1".to_owned(),
        (_, 0.0) => multiple.to_string(),
        (1, _) => format!("10^{{{}}}", decimal(exponent, 0)),
        _ => format!("{multiple}×10^{{{}}}", decimal(exponent, 0)),
    }
}

/// A number with fixed decimals and a true minus sign, never minus zero.
pub(crate) fn decimal(value: f64, decimals: usize) -> String {
    let digits = format!("{:.decimals$}", value.abs());
    let is_zero = digits.chars().all(|digit| matches!(digit, '0' | '.'));
    if value < 0.0 && !is_zero {
        format!("\u{2212}{digits}")
    } else {
        digits
    }
}
