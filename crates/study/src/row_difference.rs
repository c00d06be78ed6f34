//! Where a published row and the same row computed again differ.

use peristalsis_formats::Values;
use peristalsis_run::row_columns;

use crate::row::Row;

/// Columns that say by which program a run was computed, and not what came out.
const PROGRAM: [&str; 2] = ["version", "revision"];
/// How the names of columns begin that were added at one time, without a new version of the physics. A row without
/// `late_periods`, which every run has, is of a program before that.
const ADDED: [&str; 7] = [
    "late_periods",
    "flow_rate_ratio_drift",
    "flow_rate_ratio_variance",
    "narrow_",
    "front_",
    "throat_",
    "belly_",
];
/// Columns whose sums have been added up in another order since: programs may differ in their last digits.
pub const RESUMMED: [&str; 3] = [
    "flow_rate_ratio_variance",
    "wall_pressure",
    "wall_pressure_largest",
];
/// How the names of columns begin that older programs read off otherwise, and how the names of errors end, which they estimated
/// otherwise.
const REREAD: [&str; 4] = [
    "contact_force_",
    "front_",
    "axial_dispersion",
    "refill_efficiency",
];
const ERROR: &str = "_error";
/// The same of averages from profiles, in runs of more periods than older programs kept apart.
const FROM_PROFILES: [&str; 8] = [
    "narrow_",
    "throat_",
    "belly_",
    "wall_normal_force",
    "wall_tangential_force",
    "wall_pressure",
    "wear_power",
    "wall_wear",
];
const KEPT_APART: f64 = 64.0;
/// Revisions of these older programs, of which there are published rows.
const OLDER: &str = "02cca9a5 09e123c9 22d78410 3e027db7 3ef2fbdf 46d2f6bc 5387f8e8 7054742a 738c4535 7a7ea524 \
                     838dd934 8c796c31 986612dc 9a877dee a201c8d9 a9f9b863 aab4d0fb b61afc95 c9010838 d343008e \
                     d37676b7 e727d128 e9316dd1 f0520a9b f3c3b457 f5678a2f fa5872ef fb932a73 ffb1ca34";
/// Largest relative difference that the order of a sum makes there: a variance is a small difference of large numbers.
const ROUNDING: f64 = 1e-9;

/// A column in which a published row and the same row computed again differ, with both values as they are written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RowDifference {
    /// Name of the column.
    pub column: String,
    /// The published value and the one that was computed again.
    pub values: [String; 2],
    /// Whether the program of the published row is known to have added up the sum in another order, or to have read the
    /// column off at other moments.
    pub is_known: bool,
}

impl Row {
    /// The columns in which this published row differs in a bit from the same row computed again. Columns that name the
    /// program are left out, and columns that its program did not have.
    pub fn differences(&self, computed: &Self) -> Vec<RowDifference> {
        let number = |row: &Self, name: &str| row.table().reals(name).map_or(f64::NAN, |it| it[0]);
        let is_older = number(self, "late_periods").is_nan();
        let revision = |row: &Self| row.table().texts("revision").map(|it| it[0].clone()).ok();
        let is_of_other = revision(self) != revision(computed);
        let is_of_older = revision(self)
            .is_some_and(|revision| OLDER.split(' ').any(|older| revision.starts_with(older)));
        let is_long = number(self, "periods") > KEPT_APART;
        let is_reread = |name: &str| {
            let begins = |names: &[&str]| names.iter().any(|begin| name.starts_with(begin));
            let from_long = is_long && begins(&FROM_PROFILES);
            is_of_older && (begins(&REREAD) || from_long || name.ends_with(ERROR))
        };
        let later = |name: &str| {
            row_columns()
                .iter()
                .any(|it| it.is_later && it.name == name)
        };
        let mut differences = Vec::new();
        for column in self.table().columns() {
            let name = column.name.as_str();
            let here = number(self, name);
            let was_added = ADDED.iter().any(|begin| name.starts_with(begin));
            let was_unknown = is_older && was_added || later(name);
            if PROGRAM.contains(&name) || was_unknown && here.is_nan() {
                continue;
            }
            let there = computed.table().column(name).ok().map(|it| &it.values);
            let there_number = number(computed, name);
            // A zero is the same with either sign.
            if there != Some(&column.values) && here != there_number {
                let is_near = (there_number - here).abs() <= ROUNDING * here.abs();
                differences.push(RowDifference {
                    column: name.to_owned(),
                    values: [Some(&column.values), there]
                        .map(|values| values.map_or_else(String::new, written)),
                    is_known: is_of_other
                        && (is_near && RESUMMED.contains(&name) || is_reread(name)),
                });
            }
        }
        differences
    }
}

/// The one value of a column, a number with all its digits.
fn written(values: &Values) -> String {
    match values {
        Values::Real(values) => format!("{:?}", values[0]),
        Values::Integer(values) => values[0].to_string(),
        Values::Boolean(values) => values[0].to_string(),
        Values::Text(values) => values[0].clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::row::tests::without;

    #[test]
    fn rows_differ_by_the_bit_and_not_by_the_program() {
        let text = without("nothing");
        let row = Row::from_csv(&text).unwrap();
        let place = text.lines().next().unwrap().split(',');
        let place = |name: &str| place.clone().position(|column| column == name).unwrap();
        let with = |settings: &[(&str, &'static str)]| {
            let (head, line) = text.split_once('\n').unwrap();
            let mut cells: Vec<&str> = line.trim().split(',').collect();
            for (name, value) in settings {
                cells[place(name)] = value;
            }
            Row::from_csv(&format!("{head}\n{}\n", cells.join(","))).unwrap()
        };
        let least = with(&[("flow_rate", "0.5000000000000001")]);
        let expected = RowDifference {
            column: "flow_rate".to_owned(),
            values: ["0.5", "0.5000000000000001"].map(str::to_owned),
            is_known: false,
        };
        assert_eq!(row.differences(&least), [expected]);
        assert_eq!(row.differences(&with(&[("revision", "\"other\"")])), []);
        // The rounding of a sum counts between programs only, and what a program did not have yet is not compared.
        let other = [
            ("revision", "\"other\""),
            ("flow_rate_ratio_variance", "0.5000000000000001"),
        ];
        let row = with(&[("flow_rate_ratio_variance", "0.5")]);
        let known = |row: &Row, other: &Row| -> Vec<bool> {
            let differences = row.differences(other).into_iter();
            differences.map(|it| it.is_known).collect()
        };
        assert_eq!(known(&row, &with(&other)), [true]);
        assert_eq!(known(&row, &with(&other[1..])), [false]);
        assert_eq!(
            known(
                &row,
                &with(&[other[0], ("flow_rate_ratio_variance", "0.500001")])
            ),
            [false]
        );
        // What is read off otherwise counts where the program of the row was an older one.
        let of_older = ("revision", "\"3ef2fbdf0\"");
        for (column, periods, is_known) in [
            ("contact_force_99", "20.0", true),
            ("flow_rate_ratio_error", "20.0", true),
            ("wall_pressure", "65.0", true),
            ("wall_pressure", "20.0", false),
            ("flow_rate", "65.0", false),
        ] {
            let of = |settings: &[(&str, &'static str)]| {
                with(&[settings, &[("periods", periods)]].concat())
            };
            let computed = of(&[other[0], (column, "0.25")]);
            assert_eq!(known(&of(&[of_older]), &computed), [is_known], "{column}");
            assert_eq!(known(&of(&[]), &computed), [false], "{column}");
        }
        let older = with(&[("late_periods", ""), ("belly_density", "")]);
        assert_eq!(older.differences(&row), []);
        assert_eq!(with(&[("belly_density", "")]).differences(&row).len(), 1);
        assert_eq!(
            with(&[("late_periods", ""), ("transition_time", "")])
                .differences(&row)
                .len(),
            1
        );
        let (zero, negative) = (
            with(&[("flow_rate", "0.0")]),
            with(&[("flow_rate", "-0.0")]),
        );
        assert_eq!(zero.differences(&negative), []);
        let unknown = with(&[("flow_rate", "")]);
        assert_eq!(unknown.differences(&unknown.clone()), []);
    }
}
