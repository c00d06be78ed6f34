//! Rows of finished runs: the one form in which claims read runs.

use std::cmp::Ordering;

use peristalsis_analysis::{Transition, Uncertain, mean_and_error, watched};
use peristalsis_formats::{FormatError, Table, Values};
use peristalsis_physics::contact::LinearSpringDashpot;
use peristalsis_run::THRESHOLDS;

use crate::finding::Statistics;
use crate::thresholds::MOST_DRIFT;

/// The arrangement that a name leaves out.
pub(crate) const STAGGERED: &str = "staggered";

/// How the grains stood at t = 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Start {
    /// J = 0.
    Rest,
    /// J = Jmax.
    Jammed,
}

impl Start {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Rest, Self::Jammed];

    /// Its name in configurations and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rest => "rest",
            Self::Jammed => "jammed",
        }
    }

    /// The start of this name; all others but "jammed" begin at rest.
    pub(crate) fn of_name(name: &str) -> Self {
        let named = Self::ALL.into_iter().find(|start| start.name() == name);
        named.unwrap_or(Self::Rest)
    }
}

/// Arrangement of the wall spheres.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Lattice {
    /// Spheres a ring.
    pub spheres_per_ring: i64,
    /// Rings a wavelength.
    pub rings_per_wave: i64,
}

impl Lattice {
    /// 24 x 26.
    pub const FINE: Self = Self::new(24, 26);
    /// 12 x 14.
    pub const COARSE: Self = Self::new(12, 14);

    pub(crate) const fn new(spheres_per_ring: i64, rings_per_wave: i64) -> Self {
        Self {
            spheres_per_ring,
            rings_per_wave,
        }
    }

    /// Spheres per area \[1/d^2\] of a straight tube of this radius and wavelength \[d\].
    pub(crate) fn density(self, radius: f64, wavelength: f64) -> f64 {
        let spheres = self.spheres_per_ring * self.rings_per_wave;
        spheres as f64 / (core::f64::consts::TAU * radius * wavelength)
    }

    /// "fine", "coarse", or the numbers.
    pub fn name(self) -> String {
        match self {
            Self::FINE => "fine".to_owned(),
            Self::COARSE => "coarse".to_owned(),
            _ => wall_name(self, STAGGERED),
        }
    }
}

/// A wall's name for readers, such as "24 × 26" or "12 × 14 aligned": spheres per ring, rings per wave, and how they stand.
pub(crate) fn wall_name(lattice: Lattice, arrangement: &str) -> String {
    let Lattice {
        spheres_per_ring,
        rings_per_wave,
    } = lattice;
    let lattice = format!("{spheres_per_ring} × {rings_per_wave}");
    match arrangement {
        STAGGERED => lattice,
        arrangement => format!("{lattice} {arrangement}"),
    }
}

/// How the wall spheres of a run stand; a table without the column knows staggered walls only.
pub(crate) fn arrangement<'a>(row: &Row<'a>) -> &'a str {
    match row.text("arrangement") {
        "" => STAGGERED,
        arrangement => arrangement,
    }
}

/// One finished run: a row of a study's table.
#[derive(Clone, Copy, Debug)]
pub struct Row<'a> {
    table: &'a Table,
    row: usize,
}

/// Checks that a table has the columns that every table of runs has.
pub(crate) fn check(table: &Table) -> Result<(), FormatError> {
    if table.rows() == 0 {
        return Ok(());
    }
    for name in ["identity", "initial_state"] {
        table.texts(name)?;
    }
    for name in Row::NUMBERS {
        table.reals(name)?;
    }
    for name in Row::WHOLE_NUMBERS {
        table.integers(name)?;
    }
    for place in 0..THRESHOLDS.len() {
        table.reals(&threshold_column(place))?;
    }
    Ok(())
}

/// All rows of a table.
pub(crate) fn rows_of(table: &Table) -> Vec<Row<'_>> {
    (0..table.rows()).map(|row| Row { table, row }).collect()
}

/// Column of the transition time at one of [`THRESHOLDS`].
fn threshold_column(place: usize) -> String {
    format!("transition_time_{:.0}", 100.0 * THRESHOLDS[place])
}

/// Place of the one of [`THRESHOLDS`] that is nearest.
pub(crate) fn nearest_threshold(wanted: f64) -> usize {
    let distance = |place: &usize| (THRESHOLDS[*place] - wanted).abs();
    (0..THRESHOLDS.len())
        .min_by(|one, other| distance(one).total_cmp(&distance(other)))
        .unwrap_or(0)
}

impl<'a> Row<'a> {
    /// Columns of numbers that every table of runs has, besides the transition times at [`THRESHOLDS`].
    pub const NUMBERS: [&'static str; 10] = [
        "width",
        "strain_rate",
        "volume_fraction",
        "radius",
        "wavelength",
        "time",
        "flow_rate_ratio",
        "flow_rate_ratio_error",
        "transition_time",
        "transition_threshold",
    ];
    /// Columns of whole numbers that every table of runs has.
    pub const WHOLE_NUMBERS: [&'static str; 6] = [
        "spheres_per_ring",
        "rings_per_wave",
        "grains",
        "waves",
        "escaped",
        "replicate",
    ];

    /// A number; NaN where the column is missing or holds no numbers.
    pub(crate) fn number(&self, column: &str) -> f64 {
        match self.table.column(column).map(|column| &column.values) {
            Ok(Values::Real(values)) => values[self.row],
            Ok(Values::Integer(values)) => values[self.row] as f64,
            _ => f64::NAN,
        }
    }

    /// A number with its error, which stands in the column of the same name with `_error`.
    pub(crate) fn number_and_error(&self, column: &str) -> (f64, f64) {
        (self.number(column), self.number(&format!("{column}_error")))
    }

    /// A text; empty where the column is missing or holds no texts.
    pub(crate) fn text(&self, column: &str) -> &'a str {
        match self.table.column(column).map(|column| &column.values) {
            Ok(Values::Text(values)) => &values[self.row],
            _ => "",
        }
    }

    /// A number; `otherwise` where the column is missing, as it is of a parameter that its study does not vary.
    pub(crate) fn number_or(&self, column: &str, otherwise: f64) -> f64 {
        match self.table.column(column) {
            Ok(_) => self.number(column),
            Err(_) => otherwise,
        }
    }

    /// Name of the run.
    pub fn identity(&self) -> &'a str {
        self.text("identity")
    }

    /// How the grains stood at t = 0.
    pub(crate) fn start(&self) -> Start {
        Start::of_name(self.text("initial_state"))
    }

    /// Arrangement of the wall spheres.
    pub(crate) fn lattice(&self) -> Lattice {
        let number = |column| self.number(column) as i64;
        Lattice::new(number("spheres_per_ring"), number("rings_per_wave"))
    }

    /// Number of the replicate.
    pub(crate) fn replicate(&self) -> i64 {
        self.number("replicate") as i64
    }

    /// w \[d\]; NaN under stress control.
    pub(crate) fn width(&self) -> f64 {
        self.number("width")
    }

    /// f^P; NaN under strain control.
    pub(crate) fn force(&self) -> f64 {
        self.number("force_amplitude")
    }

    /// epsdot = c/lambda \[1/t\].
    pub(crate) fn strain_rate(&self) -> f64 {
        self.number("strain_rate")
    }

    /// lambda \[d\].
    pub(crate) fn wavelength(&self) -> f64 {
        self.number("wavelength")
    }

    /// c \[d/t\].
    pub(crate) fn wave_speed(&self) -> f64 {
        self.strain_rate() * self.wavelength()
    }

    /// a \[d\].
    pub(crate) fn radius(&self) -> f64 {
        self.number("radius")
    }

    /// k_n of two grains; that of the presets where the study does not vary it.
    pub(crate) fn stiffness(&self) -> f64 {
        let of_presets = LinearSpringDashpot::default().normal_stiffness;
        self.number_or("contact.normal_stiffness", of_presets)
    }

    /// eta_n of two grains; that of the presets where the study does not vary it.
    pub(crate) fn damping(&self) -> f64 {
        let of_presets = LinearSpringDashpot::default().normal_damping;
        self.number_or("contact.normal_damping", of_presets)
    }

    /// Of two equal grains.
    pub(crate) fn restitution(&self) -> f64 {
        let law = LinearSpringDashpot {
            normal_stiffness: self.stiffness(),
            normal_damping: self.damping(),
        };
        law.restitution(0.5)
    }

    /// Wall spheres per area of the straight tube \[1/d^2\].
    pub(crate) fn wall_density(&self) -> f64 {
        self.lattice().density(self.radius(), self.wavelength())
    }

    /// Time reached \[t\].
    pub(crate) fn time(&self) -> f64 {
        self.number("time")
    }

    /// Volume fraction in hundredths: the number of grains is whole, so that fractions differ a little from those asked for.
    pub(crate) fn volume_fraction(&self) -> f64 {
        (self.number("volume_fraction") * 100.0).round() / 100.0
    }

    /// Late mean of J/Jmax.
    pub(crate) fn flow_rate_ratio(&self) -> f64 {
        self.number("flow_rate_ratio")
    }

    /// Whether its late mean belongs to a stationary flow: the halves of the late part differ by at most `MOST_DRIFT`, or
    /// the table does not say.
    pub(crate) fn is_stationary(&self) -> bool {
        let drift = self.number("flow_rate_ratio_drift");
        drift.is_nan() || drift.abs() <= MOST_DRIFT
    }

    /// Fraction of the grains outside the tube at the end.
    pub(crate) fn escaped_fraction(&self) -> f64 {
        self.number("escaped") / self.number("grains").max(1.0)
    }

    /// The transition at the threshold of the study; censored where it could no longer have been found where there was none.
    pub(crate) fn transition(&self) -> Transition {
        self.transition_of(self.number("transition_time"))
    }

    /// The transition at another threshold, the nearest of [`THRESHOLDS`].
    pub(crate) fn transition_at(&self, threshold: f64) -> Transition {
        let place = nearest_threshold(threshold);
        self.transition_of(self.number(&threshold_column(place)))
    }

    /// Time up to which a transition is found \[t\]; rows of older programs do not say it.
    pub(crate) fn watched(&self) -> f64 {
        let (strain_rate, end) = (self.strain_rate(), self.time());
        // Of whole periods, which rounding may have left short.
        let periods = (end * strain_rate + 1e-6) as u64;
        match self.number_or("watched", f64::NAN) {
            unknown if unknown.is_nan() => watched(periods, 1.0 / strain_rate),
            known => known,
        }
    }

    /// Whether it was ended by its transition, without one at a threshold.
    pub(crate) fn is_stopped_before(&self, threshold: f64) -> bool {
        self.text("status") == "settled" && self.transition_at(threshold).observed().is_none()
    }

    fn transition_of(&self, time: f64) -> Transition {
        if time.is_nan() {
            return Transition::Censored {
                time: self.watched(),
            };
        }
        Transition::At {
            time,
            period: (time * self.strain_rate()) as u64,
        }
    }
}

/// All that have the same key together, by ascending key.
pub(crate) fn grouped<T: Copy, K: PartialOrd + Copy>(
    all: impl IntoIterator<Item = T>,
    key: impl Fn(&T) -> K,
) -> Vec<(K, Vec<T>)> {
    let mut keyed: Vec<(K, T)> = all.into_iter().map(|one| (key(&one), one)).collect();
    let order = |one: &(K, T), other: &(K, T)| one.0.partial_cmp(&other.0);
    keyed.sort_by(|one, other| order(one, other).unwrap_or(Ordering::Equal));
    keyed
        .chunk_by(|one, other| one.0 == other.0)
        .map(|group| (group[0].0, group.iter().map(|(_, one)| *one).collect()))
        .collect()
}

/// The rows of each strain rate, by ascending one.
pub(crate) fn by_strain_rate<'a>(
    rows: impl IntoIterator<Item = Row<'a>>,
) -> Vec<(f64, Vec<Row<'a>>)> {
    grouped(rows, Row::strain_rate)
}

/// Mean fraction of the grains outside the tube.
pub(crate) fn escaped<'a>(rows: &[Row<'a>]) -> f64 {
    let sum: f64 = rows.iter().map(Row::escaped_fraction).sum();
    sum / rows.len() as f64
}

/// Numbers, each once, ascending.
pub(crate) fn ascending(numbers: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut numbers: Vec<f64> = numbers.collect();
    numbers.sort_by(f64::total_cmp);
    numbers.dedup();
    numbers
}

/// Least and largest of some numbers; infinite, and the largest below the least, without any.
pub(crate) fn extremes(numbers: impl IntoIterator<Item = f64>) -> [f64; 2] {
    let none = [f64::INFINITY, f64::NEG_INFINITY];
    numbers.into_iter().fold(none, |[least, largest], number| {
        [least.min(number), largest.max(number)]
    })
}

/// Longest time that a run was given, in whole periods.
pub(crate) fn longest<'b, 'a: 'b>(rows: impl IntoIterator<Item = &'b Row<'a>>) -> f64 {
    largest(rows, |row| row.time() * row.strain_rate()).round()
}

/// The largest value of a positive number of some runs; 0 without any.
pub(crate) fn largest<'b, 'a: 'b>(
    rows: impl IntoIterator<Item = &'b Row<'a>>,
    number: impl Fn(&Row<'a>) -> f64,
) -> f64 {
    rows.into_iter().map(number).fold(0.0, f64::max)
}

/// The mean of the finite values in a column; its standard error is the larger of two: from the errors in the column of the
/// same name with `_error`, and from the scatter of the values, then with intervals of Student's distribution. NaN where
/// neither is known; `None` without a finite value.
pub(crate) fn mean(rows: &[Row<'_>], column: &str) -> Option<Uncertain> {
    mean_of(rows, |row| row.number_and_error(column))
}

/// [`mean`] of a value with its error.
pub(crate) fn mean_of(
    rows: &[Row<'_>],
    value: impl Fn(&Row<'_>) -> (f64, f64),
) -> Option<Uncertain> {
    let known = rows
        .iter()
        .map(value)
        .filter(|(value, _)| value.is_finite());
    let (values, errors): (Vec<f64>, Vec<f64>) = known.unzip();
    let (mean, scatter) = mean_and_error(&values);
    let squares: f64 = errors.iter().map(|error| error * error).sum();
    let within = squares.sqrt() / values.len() as f64;
    (!values.is_empty()).then(|| match within > scatter || scatter.is_nan() {
        true => Uncertain::normal(mean, within),
        false => Uncertain::student(mean, scatter, values.len() - 1),
    })
}

/// The mean of a number over some rows, with its error from their scatter; not known of a single row.
pub(crate) fn scattered<'a>(rows: &[Row<'a>], value: impl Fn(&Row<'a>) -> f64) -> Uncertain {
    let values: Vec<f64> = rows.iter().map(value).collect();
    let (mean, error) = mean_and_error(&values);
    Uncertain::student(mean, error, values.len().saturating_sub(1))
}

/// How much is behind some rows of one strain rate that differ in a control, which counts as the width, and in the replicate.
pub(crate) fn behind<'a>(rows: &[Row<'a>], control: impl Fn(&Row<'a>) -> f64) -> Statistics {
    Statistics::at_one_rate(rows.iter().map(control))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Table {
        let real = |values: &[f64]| Values::Real(values.to_vec());
        Table::builder()
            .column("width", "d", "", real(&[2.0, 1.0, 2.0, 2.0]))
            .column("flow", "1", "", real(&[0.4, 0.9, 0.6, f64::NAN]))
            .column("flow_error", "1", "", real(&[0.01, 0.02, 0.01, 0.01]))
            .build()
            .unwrap()
    }

    #[test]
    fn replicates_are_averaged_with_the_larger_error() {
        let table = table();
        let groups = grouped(rows_of(&table), Row::width);
        assert_eq!(groups.len(), 2);
        assert_eq!(groups[0].0, 1.0);
        let alone = mean(&groups[0].1, "flow").unwrap();
        assert_eq!((alone.value, alone.error), (0.9, 0.02));
        let both = mean(&groups[1].1, "flow").unwrap();
        assert!((both.value - 0.5).abs() < 1e-12 && (both.error - 0.1).abs() < 1e-12);
        assert_eq!(mean(&groups[0].1, "pressure"), None);
        assert!(groups[0].1[0].number("pressure").is_nan());
        assert_eq!(behind(&groups[1].1, Row::width).replicates, 3);
        assert!(check(&table).is_err());
    }
}
