//! Numbers and their errors as text, in the markup of figures.
//!
//! The rule: an error keeps two significant digits if it begins with 1 when rounded to two, else one; the value ends at the
//! same place: 2.794 ± 0.003, 2.79 ± 0.12, 1230 ± 60. The error is half the 68 per cent interval where its two sides agree
//! within a fifth; else both sides are written, and the smaller sets the place: 2.79^{+0.09}_{−0.03}. A side that the data
//! leave open is infinite. Numbers from 10^6 on and below 10^{−3} have a power of ten: (3.2 ± 0.4) × 10^{−6}.

use core::fmt;

use crate::uncertain::{Interval, Uncertain};

/// Sides of an interval count as equal up to this ratio.
const EQUAL_SIDES: f64 = 1.2;
/// Significant digits of a number without error.
const PLAIN_DIGITS: usize = 4;
/// Powers of ten of the first digit that are not written apart.
const ORDINARY_POWERS: core::ops::Range<i32> = -3..6;
/// Errors whose digits are below this have two of them: 1.95 is rounded to 2.
const TWO_DIGITS: f64 = 1.95;

/// Errors below this part of their number are rounding only, like none.
const ROUNDING: f64 = 1e-12;

/// Sign for a number that is not known.
const MISSING: &str = "–";

/// The number with its error, such as `2.794 ± 0.003`; alone where no error [is known](known_error).
impl fmt::Display for Uncertain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let layout = Layout::of(self);
        let digits = |value| layout.digits(value);
        let value = digits(self.value);
        let text = match Sides::of(self) {
            _ if !self.value.is_finite() => plain(self.value),
            Sides::Equal(error) if known_error(self.value, error).is_some() => {
                let error = digits(error);
                match layout.power {
                    0 => format!("{value} ± {error}"),
                    _ => layout.times_power(format!("({value} ± {error})")),
                }
            }
            Sides::Equal(_) | Sides::Unknown => plain(self.value),
            Sides::Unequal { up, down } => {
                layout.times_power(format!("{value}^{{+{}}}_{{−{}}}", digits(up), digits(down)))
            }
        };
        f.write_str(&text)
    }
}

/// The error of a value, where one is known: neither infinite nor rounding only, below 1e-12 of the value.
pub fn known_error(value: f64, error: f64) -> Option<f64> {
    let is_known = error.is_finite() && error > ROUNDING * value.abs();
    is_known.then_some(error)
}

/// A value with its standard error, such as `2.794 ± 0.003`.
pub fn with_error(value: f64, error: f64) -> String {
    Uncertain::normal(value, error).to_string()
}

/// The 95 per cent interval of a number to the digits of the number, such as `[2.788, 2.800]`, with a parenthesis at an
/// open end.
pub fn interval(number: &Uncertain) -> String {
    let Interval { lower, upper } = number.interval_95;
    if lower.is_nan() || upper.is_nan() || !number.value.is_finite() {
        return MISSING.to_owned();
    }
    let layout = Layout::of(number);
    let before = if lower.is_finite() { '[' } else { '(' };
    let behind = if upper.is_finite() { ']' } else { ')' };
    let (lower, upper) = (layout.digits(lower), layout.digits(upper));
    layout.times_power(format!("{before}{lower}, {upper}{behind}"))
}

/// A number without error to four significant digits, without zeros at its end.
pub fn plain(value: f64) -> String {
    if !value.is_finite() {
        return not_finite(value);
    }
    let text = format!("{value:.*e}", PLAIN_DIGITS - 1);
    let (mantissa, power) = text.split_once('e').unwrap_or((&text, "0"));
    let power: i32 = power.parse().unwrap_or(0);
    if value == 0.0 || ORDINARY_POWERS.contains(&power) {
        // The shortest digits of the rounded number.
        let rounded: f64 = text.parse().unwrap_or(value);
        return typeset(&rounded.to_string());
    }
    let mantissa = mantissa.trim_end_matches('0').trim_end_matches('.');
    Layout { power, decimals: 0 }.times_power(typeset(mantissa))
}

/// A number with `decimals` decimals.
pub fn decimal(value: f64, decimals: usize) -> String {
    if !value.is_finite() {
        return not_finite(value);
    }
    typeset(&format!("{value:.decimals$}"))
}

/// A number with so many significant digits, one at least, as programs write it: plain where that reads well, else with a power of ten.
pub fn significant(value: f64, digits: usize) -> String {
    let after_the_first = digits.saturating_sub(1);
    let scientific = format!("{value:.after_the_first$e}");
    let power = scientific.split_once('e');
    match power.and_then(|(_, power)| power.parse::<i32>().ok()) {
        Some(power) if ORDINARY_POWERS.contains(&power) => {
            let decimals = usize::try_from(after_the_first as i32 - power).unwrap_or(0);
            format!("{value:.decimals$}")
        }
        _ => scientific,
    }
}

/// A number rounded to so many significant digits, one at least.
pub fn rounded(value: f64, digits: usize) -> f64 {
    let after_the_first = digits.saturating_sub(1);
    let text = format!("{value:.after_the_first$e}");
    text.parse().unwrap_or(value)
}

/// A number of bytes in a unit that suits it: "12.3 MB".
pub fn bytes(number: f64) -> String {
    // What would be written as a thousand of a unit is one of the next.
    for (factor, unit) in [(1e12, "TB"), (1e9, "GB"), (1e6, "MB")] {
        if number >= 0.99995 * factor {
            return format!("{:.1} {unit}", number / factor);
        }
    }
    match number < 999.5 {
        true => format!("{number:.0} B"),
        false => format!("{:.1} kB", number / 1e3),
    }
}

/// So many of something, in the plural where it is not one: "1 run", "2 finished runs".
pub fn counted(number: impl fmt::Display, of: &str) -> String {
    let number = number.to_string();
    let plural = if number == "1" { "" } else { "s" };
    format!("{number} {of}{plural}")
}

/// How far a number is from a reference in standard errors on that side, such as `+1.3 σ`; `None` where the data leave that
/// side open.
pub fn distance(number: &Uncertain, reference: f64) -> Option<String> {
    let side = match Sides::of(number) {
        Sides::Equal(error) => error,
        Sides::Unequal { up, .. } if reference > number.value => up,
        Sides::Unequal { down, .. } => down,
        Sides::Unknown => return None,
    };
    let distance = (number.value - reference) / side;
    if !distance.is_finite() || !side.is_finite() {
        return None;
    }
    let decimals = usize::from(distance.abs() < 9.95);
    Some(typeset(&format!("{distance:+.decimals$} σ")))
}

/// The error of a number on either side.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Sides {
    /// The same on both.
    Equal(f64),
    /// Up and down; infinite where open.
    Unequal { up: f64, down: f64 },
    /// Nothing is known.
    Unknown,
}

impl Sides {
    fn of(number: &Uncertain) -> Self {
        let up = number.interval_68.upper - number.value;
        let down = number.value - number.interval_68.lower;
        let is_inside = up >= 0.0 && down >= 0.0;
        if !is_inside || (up.is_infinite() && down.is_infinite()) {
            // A resampled interval may miss the estimate; then only the standard error can be written.
            let known = Some(number.error).filter(|error| error.is_finite() && *error >= 0.0);
            return known.map_or(Self::Unknown, Self::Equal);
        }
        match up.max(down) <= EQUAL_SIDES * up.min(down) {
            true => Self::Equal(0.5 * (up + down)),
            false => Self::Unequal { up, down },
        }
    }

    /// The error from which the place of the last digit follows, if one does.
    fn least(self) -> Option<f64> {
        let sides = match self {
            Self::Equal(error) => [error, error],
            Self::Unequal { up, down } => [up, down],
            Self::Unknown => return None,
        };
        let known = sides
            .into_iter()
            .filter(|side| side.is_finite() && *side > 0.0);
        known.min_by(f64::total_cmp)
    }
}

/// How the digits of a number are laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Layout {
    /// Power of ten that is written apart; 0 for none.
    power: i32,
    /// Digits behind the point of the mantissa; negative where digits before the point are rounded.
    decimals: i32,
}

impl Layout {
    fn of(number: &Uncertain) -> Self {
        let error = Sides::of(number).least();
        let largest = number.value.abs().max(error.unwrap_or(0.0));
        let power = match scientific(largest) {
            Some((_, power)) if !ORDINARY_POWERS.contains(&power) => power,
            _ => 0,
        };
        let decimals = match error.and_then(scientific) {
            Some((mantissa, place)) => power - place + i32::from(mantissa < TWO_DIGITS),
            None => {
                let place = scientific(number.value).map_or(0, |(_, place)| place);
                power - place + PLAIN_DIGITS as i32 - 1
            }
        };
        Self { power, decimals }
    }

    /// A value in this layout, without its power of ten.
    fn digits(self, value: f64) -> String {
        if !value.is_finite() {
            return not_finite(value);
        }
        let value = value / power_of_ten(self.power);
        match usize::try_from(self.decimals) {
            Ok(decimals) => decimal(value, decimals),
            Err(_) => {
                let unit = power_of_ten(-self.decimals);
                decimal((value / unit).round() * unit, 0)
            }
        }
    }

    fn times_power(self, digits: String) -> String {
        match self.power {
            0 => digits,
            power => format!("{digits} × 10^{{{}}}", typeset(&power.to_string())),
        }
    }
}

/// Mantissa from 1 to 10 and power of ten; `None` for zero and for values that are not finite.
fn scientific(value: f64) -> Option<(f64, i32)> {
    let text = format!("{:e}", value.abs());
    let (mantissa, power) = text.split_once('e')?;
    let mantissa: f64 = mantissa.parse().ok()?;
    (mantissa > 0.0).then_some((mantissa, power.parse().ok()?))
}

/// 10^power, rounded correctly.
fn power_of_ten(power: i32) -> f64 {
    let text = format!("1e{power}");
    text.parse().expect("a power of ten is a number")
}

fn not_finite(value: f64) -> String {
    match value {
        f64::INFINITY => "∞",
        f64::NEG_INFINITY => "−∞",
        _ => MISSING,
    }
    .to_owned()
}

/// Digits as they are printed: with a minus sign in place of the hyphen, and none before zero.
fn typeset(text: &str) -> String {
    match text.strip_prefix('-') {
        Some(digits) if digits.chars().any(|digit| ('1'..='9').contains(&digit)) => {
            format!("−{digits}")
        }
        Some(digits) => digits.to_owned(),
        None => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn between(value: f64, lower: f64, upper: f64) -> Uncertain {
        Uncertain {
            interval_68: Interval { lower, upper },
            ..Uncertain::normal(value, 0.05)
        }
    }

    #[test]
    fn errors_keep_one_digit_or_two_if_the_first_is_one() {
        for (value, error, text) in [
            (2.794_1, 0.003, "2.794 ± 0.003"),
            (2.794_1, 0.002_6, "2.794 ± 0.003"),
            (2.794_1, 0.014_7, "2.794 ± 0.015"),
            (2.794_1, 0.001_96, "2.794 ± 0.002"),
            (2.79, 0.12, "2.79 ± 0.12"),
            // Rounding carries over: 0.0096 at its own place is 0.010.
            (2.794_1, 0.009_6, "2.794 ± 0.010"),
            (12.34, 1.4, "12.3 ± 1.4"),
            (12.34, 3.6, "12 ± 4"),
            (1234.0, 56.0, "1230 ± 60"),
            (1234.0, 156.0, "1230 ± 160"),
            (-3.75, 0.2, "−3.8 ± 0.2"),
            (-0.01, 0.3, "0.0 ± 0.3"),
            // Large and small numbers have a power of ten.
            (3.21e-6, 4e-7, "(3.2 ± 0.4) × 10^{−6}"),
            (-1.234e8, 1.7e6, "(−1.234 ± 0.017) × 10^{8}"),
            (2e-9, 3e-6, "(0 ± 3) × 10^{−6}"),
            (0.001_2, 0.000_3, "0.0012 ± 0.0003"),
            (123_456.0, 5_000.0, "123000 ± 5000"),
            // Without an error worth the name.
            (2.5, 0.0, "2.5"),
            (-0.012, 1.7e-18, "−0.012"),
            (2.5, f64::NAN, "2.5"),
            (f64::NAN, 1.0, "–"),
        ] {
            assert_eq!(with_error(value, error), text, "{value} {error}");
        }
    }

    #[test]
    fn unequal_sides_are_both_written_and_open_ones_are_infinite() {
        let open = between(2.79, f64::NEG_INFINITY, f64::INFINITY);
        let unknown = Uncertain {
            error: f64::INFINITY,
            ..open
        };
        for (number, text) in [
            (between(2.79, 2.76, 2.88), "2.79^{+0.09}_{−0.03}"),
            (between(2.79, 2.76, 2.825), "2.79 ± 0.03"),
            (between(2.79, 2.76, f64::INFINITY), "2.79^{+∞}_{−0.03}"),
            (between(5e6, 4e6, 9e6), "5.0^{+4.0}_{−1.0} × 10^{6}"),
            // Only the standard error is left where both ends are open or the interval misses the estimate.
            (open, "2.79 ± 0.05"),
            (between(2.79, 2.8, 2.9), "2.79 ± 0.05"),
            (unknown, "2.79"),
        ] {
            assert_eq!(number.to_string(), text);
        }
    }

    #[test]
    fn intervals_have_the_digits_of_the_number() {
        let with_ends = |lower: f64, upper: f64| Uncertain {
            interval_95: Interval { lower, upper },
            ..Uncertain::normal(2.794_1, 0.003)
        };
        for (number, text) in [
            (Uncertain::normal(2.794_1, 0.003), "[2.788, 2.800]"),
            (Uncertain::normal(-0.1, 0.2), "[−0.5, 0.3]"),
            (Uncertain::normal(3.21e-6, 4e-7), "[2.4, 4.0] × 10^{−6}"),
            (with_ends(2.788, f64::INFINITY), "[2.788, ∞)"),
            (with_ends(f64::NEG_INFINITY, f64::INFINITY), "(−∞, ∞)"),
            (with_ends(f64::NAN, f64::INFINITY), "–"),
        ] {
            assert_eq!(interval(&number), text);
        }
    }

    #[test]
    fn numbers_without_error_are_short() {
        for (value, text) in [
            (3.5, "3.5"),
            (-3.75, "−3.75"),
            (1.0 / 3.0, "0.3333"),
            (-0.0, "0"),
            (1000.0, "1000"),
            (0.000_25, "2.5 × 10^{−4}"),
            (2e7, "2 × 10^{7}"),
            (f64::NEG_INFINITY, "−∞"),
            (f64::NAN, "–"),
        ] {
            assert_eq!(plain(value), text, "{value}");
        }
        assert_eq!(decimal(-0.004, 2), "0.00");
        assert_eq!(decimal(-0.25, 1), "−0.2");
        assert_eq!(decimal(f64::NAN, 1), "–");
    }

    #[test]
    fn numbers_keep_their_digits_however_small_they_are() {
        for (value, digits, text) in [
            (43.7012, 4, "43.70"),
            (2.2e-5, 4, "2.200e-5"),
            (0.0123456, 4, "0.01235"),
            (0.99999, 4, "1.000"),
            (123456.7, 4, "123457"),
            (1.234567e7, 4, "1.235e7"),
            (999_999.7, 6, "1.00000e6"),
            (0.0, 4, "0.000"),
            (-0.5, 4, "-0.5000"),
            (f64::NAN, 4, "NaN"),
        ] {
            assert_eq!(significant(value, digits), text);
        }
    }

    #[test]
    fn numbers_are_rounded_to_significant_digits() {
        assert_eq!(
            [12302.02, 1.234, 0.61, -0.0].map(|value| rounded(value, 2)),
            [12000.0, 1.2, 0.61, -0.0]
        );
        assert!(rounded(f64::NAN, 2).is_nan());
    }

    #[test]
    fn bytes_have_the_unit_that_suits_them() {
        for (number, text) in [
            (999.0, "999 B"),
            (1e3, "1.0 kB"),
            (12.34e6, "12.3 MB"),
            (2.02e12, "2.0 TB"),
        ] {
            assert_eq!(bytes(number), text);
        }
    }

    #[test]
    fn one_is_no_plural() {
        let texts = [counted(1, "run"), counted("1", "run"), counted(0, "run")];
        assert_eq!(texts, ["1 run", "1 run", "0 runs"]);
    }

    #[test]
    fn distances_are_in_standard_errors_of_the_side_toward_the_reference() {
        let symmetric = Uncertain::normal(1.02, 0.04);
        assert_eq!(distance(&symmetric, 1.0).as_deref(), Some("+0.5 σ"));
        assert_eq!(distance(&symmetric, 3.02).as_deref(), Some("−50 σ"));
        let skew = between(2.0, 1.9, 2.5);
        assert_eq!(distance(&skew, 3.0).as_deref(), Some("−2.0 σ"));
        assert_eq!(distance(&skew, 1.8).as_deref(), Some("+2.0 σ"));
        assert_eq!(distance(&between(2.0, 1.9, f64::INFINITY), 3.0), None);
        assert_eq!(distance(&Uncertain::normal(2.0, 0.0), 3.0), None);
    }
}
