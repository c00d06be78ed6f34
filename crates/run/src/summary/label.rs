//! What stands at the axes of columns of rows.

use peristalsis_configuration::unit_of;

use super::table::QUANTITIES;

/// Words and symbols of keys of the configuration that are no quantities, by their last part.
const KEYS: &[(&str, &str)] = &[
    ("axial", "axial tether of the wall"),
    ("end", "end of the schedule"),
    ("form", "form of the schedule"),
    ("from", "schedule from"),
    ("gravity", "gravity g"),
    ("kinetic_friction", "friction μ"),
    ("late_fraction", "late part of the run"),
    ("periods", "periods of the run"),
    ("static_friction", "static friction μₛ"),
    ("to", "schedule to"),
    ("wave_speed", "wave speed c"),
];

const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];

/// Words or symbol of a column of rows at an axis, with its unit. The column is a quantity of the run or a key of the
/// configuration, whose units are known, or another of this unit.
///
/// ```
/// use peristalsis_run::label;
///
/// assert_eq!(label("drive.width", ""), "width w / d");
/// assert_eq!(label("granular_temperature", ""), "granular temperature / (m d²/t²)");
/// assert_eq!(label("flow_rate", ""), "flow rate J / t⁻¹");
/// assert_eq!(label("measured_by_hand", "m d^-1 t^-2"), "measured by hand / (m/(d t²))");
/// ```
pub fn label(column: &str, unit: &str) -> String {
    let name = column.rsplit('.').next().unwrap_or_default();
    let is_key = column.contains('.');
    let quantity = QUANTITIES.iter().find(|quantity| quantity.name() == name);
    let key = KEYS.iter().find(|(key, _)| is_key && *key == name);
    let words = match (key, quantity) {
        (Some((_, words)), _) => (*words).to_owned(),
        (None, Some(quantity)) if !quantity.label.is_empty() => quantity.label.to_owned(),
        _ => name.replace('_', " "),
    };
    let known = match quantity {
        Some(quantity) if !is_key => Some(quantity.unit()),
        _ => unit_of(column),
    };
    match in_print(known.unwrap_or(unit)) {
        unit if unit.is_empty() => words,
        unit if unit.contains([' ', '/']) => format!("{words} / ({unit})"),
        unit => format!("{words} / {unit}"),
    }
}

/// A unit as it is printed: "m d^2/t^2" and "m d^2 t^-2" become "m d²/t²", and "1/t" becomes "t⁻¹".
fn in_print(unit: &str) -> String {
    let (over, under) = unit.split_once('/').unwrap_or((unit, ""));
    let powers = |text: &str, sign: i32| -> Vec<(String, i32)> {
        let words = text
            .split([' ', '(', ')'])
            .filter(|word| !["", "1"].contains(word));
        let power = |word: &str| match word.split_once('^') {
            Some((symbol, power)) => (symbol.to_owned(), sign * power.parse().unwrap_or(1)),
            None => (word.to_owned(), sign),
        };
        words.map(power).collect()
    };
    let all = [powers(over, 1), powers(under, -1)].concat();
    let (over, under): (Vec<_>, Vec<_>) = all.into_iter().partition(|(_, power)| *power > 0);
    let written = |factors: &[(String, i32)], sign: i32| {
        let words = factors
            .iter()
            .map(|(symbol, power)| raised(symbol, sign * power));
        words.collect::<Vec<_>>().join(" ")
    };
    match (over.len(), under.len()) {
        (0, _) => written(&under, 1),
        (_, 0) => written(&over, 1),
        (_, 1) => format!("{}/{}", written(&over, 1), written(&under, -1)),
        _ => format!("{}/({})", written(&over, 1), written(&under, -1)),
    }
}

/// A symbol with its power.
fn raised(symbol: &str, power: i32) -> String {
    if power == 1 {
        return symbol.to_owned();
    }
    let sign = if power < 0 { "⁻" } else { "" };
    let digits = power.unsigned_abs().to_string().into_bytes().into_iter();
    let digits: String = digits
        .map(|digit| RAISED[usize::from(digit - b'0')])
        .collect();
    format!("{symbol}{sign}{digits}")
}

#[cfg(test)]
mod tests {
    use peristalsis_formats::ValueKind;

    use super::super::row_columns;
    use super::*;

    #[test]
    fn every_number_of_a_row_has_words_and_no_unit_is_in_plain_letters() {
        for column in row_columns() {
            let is_number = matches!(column.kind, ValueKind::Real | ValueKind::Integer);
            let is_error = column.name.ends_with("_error");
            if !is_number || is_error || column.name == "seed" {
                continue;
            }
            let quantity = QUANTITIES
                .iter()
                .find(|it| it.name() == column.name)
                .unwrap();
            assert!(!quantity.label.is_empty(), "{}", column.name);
            let label = label(&column.name, column.unit);
            assert!(!label.contains(['^', '_']), "{label}");
            assert_eq!(label.contains(" / "), column.unit != "1", "{label}");
        }
    }

    #[test]
    fn units_are_printed_in_one_way() {
        for (unit, printed) in [
            ("1", ""),
            ("", ""),
            ("t", "t"),
            ("t^-1", "t⁻¹"),
            ("m d t^-2", "m d/t²"),
            ("m/(d t^2)", "m/(d t²)"),
            ("m d^-1 t^-2", "m/(d t²)"),
            ("W/m^2", "W/m²"),
        ] {
            assert_eq!(in_print(unit), printed, "{unit}");
        }
    }
}
