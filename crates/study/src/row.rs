//! The row of a finished run: all that tables and analyses need of it, and nothing that depends on when it was computed.

use peristalsis_configuration::{Configuration, Control};
use peristalsis_formats::{Column, FormatError, Table, ValueKind, Values, csv};
use peristalsis_run::{Pumping, SiSummary, Summary};

use crate::identity::Identity;
use crate::plan::state_name;

/// One value of a row.
enum Cell {
    Real(f64),
    Integer(i64),
    Text(String),
    Boolean(bool),
}

impl Cell {
    fn optional(value: Option<f64>) -> Self {
        Self::Real(value.unwrap_or(f64::NAN))
    }

    fn whole(value: u64) -> Self {
        // Seeds have 63 bits, and counts are smaller.
        Self::Integer(i64::try_from(value).unwrap_or(i64::MAX))
    }
}

/// What a row is made from.
struct Origin<'a> {
    identity: Identity,
    replicate: u32,
    configuration: &'a Configuration,
    summary: &'a Summary,
}

/// A column of the row.
struct RowColumn {
    name: &'static str,
    unit: &'static str,
    description: &'static str,
    kind: ValueKind,
    value: fn(&Origin<'_>) -> Cell,
    /// Whether rows from before it may lack it, and hold no number there.
    came_later: bool,
}

/// A column of numbers that came later than the first stores.
const fn later(
    name: &'static str,
    unit: &'static str,
    description: &'static str,
    value: fn(&Origin<'_>) -> Cell,
) -> RowColumn {
    RowColumn {
        came_later: true,
        ..column(name, unit, Real, description, value)
    }
}

const fn column(
    name: &'static str,
    unit: &'static str,
    kind: ValueKind,
    description: &'static str,
    value: fn(&Origin<'_>) -> Cell,
) -> RowColumn {
    RowColumn {
        name,
        unit,
        description,
        kind,
        value,
        came_later: false,
    }
}

use ValueKind::{Boolean, Integer, Real, Text};

/// All columns of a row, in order.
#[rustfmt::skip]
const COLUMNS: &[RowColumn] = &[
    column("identity", "", Text, "hash of configuration, physics version and replicate", |o| Cell::Text(o.identity.to_string())),
    column("replicate", "1", Integer, "number of the replicate, from 0", |o| Cell::Integer(o.replicate.into())),
    column("seed", "1", Integer, "seed of the random numbers", |o| Cell::whole(o.summary.seed)),
    column("initial_state", "", Text, "how the grains stood at t = 0", |o| Cell::Text(state_name(o.configuration.initial.state).into())),
    column("status", "", Text, "complete, or settled: ended early, after its transition", |o| Cell::Text(status_name(o.summary).into())),
    column("width", "d", Real, "w = 2 (a - b); missing under stress control", |o| Cell::optional(width(o.configuration))),
    column("force_amplitude", "m d/t^2", Real, "f^P; missing under strain control", |o| Cell::optional(force_amplitude(o.configuration))),
    column("strain_rate", "1/t", Real, "c/lambda", |o| Cell::Real(o.configuration.drive.strain_rate)),
    column("volume_fraction", "1", Real, "rho = N/(6 a^2 L), grain volumes averaged", |o| Cell::Real(o.configuration.volume_fraction())),
    column("number_density", "1/d^3", Real, "n = N d*^3/(pi a^2 L)", |o| Cell::Real(o.configuration.number_density())),
    column("grains", "1", Integer, "N", |o| Cell::whole(o.summary.grains)),
    column("radius", "d", Real, "a, to the centres of the wall spheres", |o| Cell::Real(o.configuration.tube.radius)),
    column("wavelength", "d", Real, "lambda", |o| Cell::Real(o.configuration.tube.wavelength)),
    column("waves", "1", Integer, "waves in the tube", |o| Cell::Integer(o.configuration.tube.waves.into())),
    column("spheres_per_ring", "1", Integer, "wall spheres in a ring", |o| Cell::Integer(o.configuration.tube.spheres_per_ring.into())),
    column("rings_per_wave", "1", Integer, "rings in a wavelength", |o| Cell::Integer(o.configuration.tube.rings_per_wave.into())),
    column("time", "t", Real, "time reached: where a run without a transition is censored", |o| Cell::Real(o.summary.time)),
    column("periods", "1", Real, "wavelengths that the wave has run", |o| Cell::Real(o.summary.periods)),
    column("transition_time", "t", Real, "tau; missing where there was none", |o| Cell::optional(o.summary.transition_time)),
    column("censored", "", Boolean, "whether the run ended before a transition", |o| Cell::Boolean(o.summary.censored)),
    column("transition_threshold", "1", Real, "J/Jmax whose crossing counts as the transition", |o| Cell::Real(o.summary.transition_threshold)),
    later("transition_time_10", "t", "tau with the threshold 0.1; missing where there was none", |o| Cell::optional(o.summary.transition_times[0].time)),
    later("transition_time_20", "t", "tau with the threshold 0.2; missing where there was none", |o| Cell::optional(o.summary.transition_times[1].time)),
    later("transition_time_30", "t", "tau with the threshold 0.3; missing where there was none", |o| Cell::optional(o.summary.transition_times[2].time)),
    later("transition_time_40", "t", "tau with the threshold 0.4; missing where there was none", |o| Cell::optional(o.summary.transition_times[3].time)),
    later("transition_time_50", "t", "tau with the threshold 0.5; missing where there was none", |o| Cell::optional(o.summary.transition_times[4].time)),
    later("transition_time_60", "t", "tau with the threshold 0.6; missing where there was none", |o| Cell::optional(o.summary.transition_times[5].time)),
    later("transition_time_70", "t", "tau with the threshold 0.7; missing where there was none", |o| Cell::optional(o.summary.transition_times[6].time)),
    later("transition_time_80", "t", "tau with the threshold 0.8; missing where there was none", |o| Cell::optional(o.summary.transition_times[7].time)),
    later("transition_time_90", "t", "tau with the threshold 0.9; missing where there was none", |o| Cell::optional(o.summary.transition_times[8].time)),
    column("flow_rate_ratio", "1", Real, "late mean of J/Jmax, grains inside", |o| Cell::Real(o.summary.flow_rate_ratio)),
    column("flow_rate_ratio_error", "1", Real, "its standard error from block averages", |o| Cell::Real(o.summary.flow_rate_ratio_error)),
    later("flow_rate_ratio_drift", "1", "late J/Jmax, mean of its second half less that of its first", |o| Cell::Real(o.summary.flow_rate_ratio_drift)),
    later("flow_rate_ratio_variance", "1", "variance of the late averages of J/Jmax over a period each", |o| Cell::Real(o.summary.flow_rate_ratio_variance)),
    column("flow_rate_ratio_raw", "1", Real, "late mean of J/Jmax of all grains", |o| Cell::Real(o.summary.flow_rate_ratio_raw)),
    column("flow_rate", "1/t", Real, "late mean of J", |o| Cell::Real(o.summary.flow_rate)),
    column("newtonian_flow_rate_ratio", "1", Real, "J/Jmax of a Newtonian fluid in this tube, phi = b/a", |o| Cell::optional(o.summary.newtonian_flow_rate_ratio)),
    column("newtonian_flow_rate_ratio_clear_bore", "1", Real, "the same for the clear bore, phi = b/(a - d/2)", |o| Cell::optional(o.summary.newtonian_flow_rate_ratio_clear_bore)),
    column("escaped", "1", Integer, "grains outside the tube at the end", |o| Cell::whole(o.summary.escaped)),
    column("escaped_most", "1", Integer, "most grains outside the tube at any sample", |o| Cell::whole(o.summary.escaped_most)),
    column("largest_overlap", "d", Real, "largest overlap of a grain's contact at any step", |o| Cell::Real(o.summary.largest_overlap)),
    column("energy_residual", "1", Real, "|what the energy ledger misses|/integral of |power that entered|", |o| Cell::Real(o.summary.energy_residual)),
    column("granular_temperature", "m d^2/t^2", Real, "late mean of the granular temperature", |o| Cell::Real(o.summary.granular_temperature)),
    column("contacts", "1", Real, "late mean number of contacts of a grain", |o| Cell::Real(o.summary.contacts)),
    column("wall_power", "m d^2/t^3", Real, "late mean power that wall or drive put in", |o| Cell::Real(o.summary.wall_power)),
    column("dissipated_power", "m d^2/t^3", Real, "late mean power lost", |o| Cell::Real(o.summary.dissipated_power)),
    column("bottleneck", "d", Real, "late mean of the smallest bottleneck", |o| Cell::Real(o.summary.bottleneck)),
    column("time_step", "t", Real, "length of a step", |o| Cell::Real(o.summary.time_step)),
    column("steps", "1", Integer, "steps done", |o| Cell::whole(o.summary.steps)),
    later("body_force", "d/t^2", "force over mass on the grains along the wave; negative is back pressure", |o| Cell::Real(o.configuration.drive.body_force)),
    later("pressure_rise", "m/(d t^2)", "pressure rise over a wavelength that the body force stands for", |o| Cell::Real(o.configuration.pressure_rise())),
    later("wall_power_error", "m d^2/t^3", "standard error of wall_power", |o| Cell::Real(o.summary.wall_power_error)),
    later("useful_power", "m d^2/t^3", "late mean power of the flow against the body force", |o| pumping(o, |p| p.useful_power)),
    later("useful_power_error", "m d^2/t^3", "its standard error", |o| pumping(o, |p| p.useful_power_error)),
    later("pumping_efficiency", "1", "useful power over wall power", |o| pumping(o, |p| p.efficiency)),
    later("pumping_efficiency_error", "1", "its standard error", |o| pumping(o, |p| p.efficiency_error)),
    later("wall_normal_force", "m d/t^2", "late mean axial force of the wall on the grains of a wavelength along the normals of contacts", |o| Cell::Real(o.summary.wall_normal_force)),
    later("wall_normal_force_error", "m d/t^2", "its standard error", |o| Cell::Real(o.summary.wall_normal_force_error)),
    later("wall_tangential_force", "m d/t^2", "the same by friction", |o| Cell::Real(o.summary.wall_tangential_force)),
    later("wall_tangential_force_error", "m d/t^2", "its standard error", |o| Cell::Real(o.summary.wall_tangential_force_error)),
    later("narrow_normal_force", "m d/t^2", "part of wall_normal_force where the tube is narrower than on its mean", |o| Cell::Real(o.summary.narrow_normal_force)),
    later("narrow_normal_force_error", "m d/t^2", "its standard error", |o| Cell::Real(o.summary.narrow_normal_force_error)),
    later("narrow_tangential_force", "m d/t^2", "part of wall_tangential_force there", |o| Cell::Real(o.summary.narrow_tangential_force)),
    later("narrow_tangential_force_error", "m d/t^2", "its standard error", |o| Cell::Real(o.summary.narrow_tangential_force_error)),
    later("narrow_axial_velocity", "d/t", "late mean axial velocity of the grains there, laboratory frame", |o| Cell::Real(o.summary.narrow_axial_velocity)),
    later("narrow_axial_velocity_error", "d/t", "its standard error", |o| Cell::Real(o.summary.narrow_axial_velocity_error)),
    later("narrow_wall_velocity", "d/t", "late mean axial velocity of the wall's spheres there; 0 for a prescribed wall", |o| Cell::Real(o.summary.narrow_wall_velocity)),
    later("narrow_wall_velocity_error", "d/t", "its standard error", |o| Cell::Real(o.summary.narrow_wall_velocity_error)),
    later("front_normal_force", "m d/t^2", "part of wall_normal_force in the front of the wave, from its narrowest place to the widest one ahead", |o| Cell::Real(o.summary.front_normal_force)),
    later("front_normal_force_error", "m d/t^2", "its standard error", |o| Cell::Real(o.summary.front_normal_force_error)),
    later("front_tangential_force", "m d/t^2", "part of wall_tangential_force in the front of the wave", |o| Cell::Real(o.summary.front_tangential_force)),
    later("front_tangential_force_error", "m d/t^2", "its standard error", |o| Cell::Real(o.summary.front_tangential_force_error)),
    later("wall_pressure", "m/(d t^2)", "late mean pressure on the wall", |o| Cell::Real(o.summary.wall_pressure)),
    later("wall_pressure_largest", "m/(d t^2)", "largest late mean pressure on the wall over the phases of the wave", |o| Cell::Real(o.summary.wall_pressure_largest)),
    later("residence_time", "t", "late mean time of a grain through the tube, N/J; missing where the flow is not along the wave", |o| Cell::optional(o.summary.residence_time)),
    later("residence_time_error", "t", "its standard error", |o| Cell::optional(o.summary.residence_time_error)),
    later("axial_dispersion", "d^2/t", "half the late rate at which the variance of axial displacements grows from period to period", |o| Cell::Real(o.summary.axial_dispersion)),
    later("axial_dispersion_error", "d^2/t", "its standard error", |o| Cell::Real(o.summary.axial_dispersion_error)),
    later("late_periods", "1", "periods that late means are over", |o| Cell::Real(o.summary.late_periods)),
    later("throat_density", "1/d", "late mean of the grains per length of tube in the fifth of the wavelength where it is narrowest", |o| Cell::Real(o.summary.throat.density)),
    later("throat_axial_velocity", "d/t", "mean axial velocity along the wave there", |o| Cell::Real(o.summary.throat.axial_velocity)),
    later("throat_granular_temperature", "m d^2/t^2", "granular temperature there", |o| Cell::Real(o.summary.throat.granular_temperature)),
    later("belly_density", "1/d", "the same where the tube is widest", |o| Cell::Real(o.summary.belly.density)),
    later("belly_axial_velocity", "d/t", "the same where the tube is widest", |o| Cell::Real(o.summary.belly.axial_velocity)),
    later("belly_granular_temperature", "m d^2/t^2", "the same where the tube is widest", |o| Cell::Real(o.summary.belly.granular_temperature)),
    later("mass_flow_rate_si", "kg/s", "late mean flow J m; missing without the table units", |o| in_si(o, |si| Some(si.mass_flow_rate_kg_per_s))),
    later("wall_power_si", "W", "wall_power in SI; missing without the table units", |o| in_si(o, |si| Some(si.wall_power_w))),
    later("useful_power_si", "W", "useful_power in SI; missing without the table units", |o| in_si(o, |si| si.useful_power_w)),
    later("pressure_rise_si", "Pa", "pressure_rise in SI; missing without the table units", |o| in_si(o, |si| si.pressure_rise_pa)),
    later("wall_pressure_si", "Pa", "wall_pressure in SI; missing without the table units", |o| in_si(o, |si| Some(si.wall_pressure_pa))),
    later("wall_pressure_largest_si", "Pa", "wall_pressure_largest in SI; missing without the table units", |o| in_si(o, |si| Some(si.wall_pressure_largest_pa))),
    column("version", "", Text, "version of the program", |o| Cell::Text(o.summary.version.into())),
    column("revision", "", Text, "revision of its source", |o| Cell::Text(o.summary.revision.into())),
];

fn status_name(summary: &Summary) -> &'static str {
    match summary.status {
        peristalsis_run::Status::Settled => "settled",
        _ => "complete",
    }
}

/// A number that only runs with a body force have.
fn pumping(origin: &Origin<'_>, value: fn(&Pumping) -> f64) -> Cell {
    Cell::optional(origin.summary.pumping.as_ref().map(value))
}

/// A number in SI that only runs with the table `units` have.
fn in_si(origin: &Origin<'_>, value: fn(&SiSummary) -> Option<f64>) -> Cell {
    Cell::optional(origin.summary.si.as_ref().and_then(value))
}

fn width(configuration: &Configuration) -> Option<f64> {
    match configuration.drive.control {
        Control::Strain { width } => Some(width),
        Control::Stress { .. } => None,
    }
}

fn force_amplitude(configuration: &Configuration) -> Option<f64> {
    match configuration.drive.control {
        Control::Strain { .. } => None,
        Control::Stress {
            force_amplitude, ..
        } => Some(force_amplitude),
    }
}

/// The row of one finished run, a table of one row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    identity: Identity,
    table: Table,
}

impl Row {
    /// The row of a run that has just ended.
    pub(crate) fn of(
        identity: Identity,
        replicate: u32,
        configuration: &Configuration,
        summary: &Summary,
    ) -> Self {
        let origin = Origin {
            identity,
            replicate,
            configuration,
            summary,
        };
        let columns = COLUMNS.iter().map(|column| {
            let values = match (column.value)(&origin) {
                Cell::Real(value) => Values::Real(vec![value]),
                Cell::Integer(value) => Values::Integer(vec![value]),
                Cell::Text(value) => Values::Text(vec![value]),
                Cell::Boolean(value) => Values::Boolean(vec![value]),
            };
            of_kind(column, values)
        });
        Self {
            identity,
            table: joined(columns),
        }
    }

    /// Every row of a table that has the columns of rows; others are left out.
    ///
    /// # Errors
    /// A sentence: the column that is missing (columns that came later may be) or of another kind, or the text that is no
    /// identity.
    pub fn all_of(table: &Table) -> Result<Vec<Self>, String> {
        let identities = table
            .texts("identity")
            .map_err(|error| error.to_string())?
            .to_vec();
        (0..table.rows())
            .map(|row| {
                let identity = identities[row]
                    .parse()
                    .map_err(|error| format!("row {}: {error}", row + 1))?;
                let columns: Result<Vec<Column>, String> = COLUMNS
                    .iter()
                    .map(|column| Ok(of_kind(column, one_of(table, column, row)?)))
                    .collect();
                Ok(Self {
                    identity,
                    table: joined(columns?),
                })
            })
            .collect()
    }

    /// Reads what [`Row::to_csv`] wrote.
    ///
    /// # Errors
    /// A sentence: what is wrong with the text.
    pub fn from_csv(text: &str) -> Result<Self, String> {
        let table = csv::decode(text).map_err(|error| error.to_string())?;
        let mut rows = Self::all_of(&table)?;
        match (rows.pop(), rows.is_empty()) {
            (Some(row), true) => Ok(row),
            _ => Err("it is not one row".to_owned()),
        }
    }

    /// What this row says of the configuration that its run cannot have, in words; `None` where all agrees. A table is believed
    /// by its identities: one that was edited, or joined wrongly, must not pass.
    pub(crate) fn contradiction(&self, configuration: &Configuration) -> Option<String> {
        let of_run = configured(configuration);
        of_run.into_iter().find_map(|(name, expected)| {
            let found = &self.table.column(name).ok()?.values;
            let agrees = match (&expected, found) {
                (Cell::Real(expected), Values::Real(found)) => {
                    found[0] == *expected || found[0].is_nan() && expected.is_nan()
                }
                (Cell::Integer(expected), Values::Integer(found)) => found[0] == *expected,
                (Cell::Text(expected), Values::Text(found)) => found[0] == *expected,
                _ => false,
            };
            (!agrees).then(|| format!("the run {} has another {name}", self.identity))
        })
    }

    /// As CSV with its header, exact to the bit.
    #[must_use]
    pub fn to_csv(&self) -> String {
        csv::encode(&self.table)
    }

    /// Whose row it is.
    #[must_use]
    pub fn identity(&self) -> Identity {
        self.identity
    }

    /// As a table of one row.
    #[must_use]
    pub fn table(&self) -> &Table {
        &self.table
    }

    /// tau \[t\]; `None` without a transition.
    #[must_use]
    pub fn transition_time(&self) -> Option<f64> {
        self.table
            .reals("transition_time")
            .ok()
            .and_then(|values| values.first().copied())
            .filter(|time| !time.is_nan())
    }

    /// A table without rows, for studies of which nothing is finished.
    pub(crate) fn no_rows() -> Table {
        joined(
            COLUMNS
                .iter()
                .map(|column| of_kind(column, Values::empty(column.kind))),
        )
    }
}

/// The columns of a row that its configuration alone decides.
fn configured(configuration: &Configuration) -> Vec<(&'static str, Cell)> {
    let tube = &configuration.tube;
    vec![
        (
            "initial_state",
            Cell::Text(state_name(configuration.initial.state).into()),
        ),
        ("width", Cell::optional(width(configuration))),
        (
            "force_amplitude",
            Cell::optional(force_amplitude(configuration)),
        ),
        ("strain_rate", Cell::Real(configuration.drive.strain_rate)),
        (
            "volume_fraction",
            Cell::Real(configuration.volume_fraction()),
        ),
        ("grains", Cell::whole(configuration.grains.number)),
        ("radius", Cell::Real(tube.radius)),
        ("wavelength", Cell::Real(tube.wavelength)),
        ("waves", Cell::Integer(tube.waves.into())),
        (
            "spheres_per_ring",
            Cell::Integer(tube.spheres_per_ring.into()),
        ),
        ("rings_per_wave", Cell::Integer(tube.rings_per_wave.into())),
        (
            "transition_threshold",
            Cell::Real(configuration.observe.transition_threshold),
        ),
        ("time_step", Cell::Real(configuration.run.time_step)),
        ("seed", Cell::whole(configuration.run.seed)),
    ]
}

fn of_kind(column: &RowColumn, values: Values) -> Column {
    Column {
        name: column.name.to_owned(),
        unit: column.unit.to_owned(),
        description: column.description.to_owned(),
        values,
    }
}

fn joined(columns: impl IntoIterator<Item = Column>) -> Table {
    Table::builder()
        .columns(columns)
        .build()
        .expect("the columns of a row have distinct names and one length")
}

/// One value of a column of another table; an empty column of a CSV file reads as reals.
fn one_of(table: &Table, column: &RowColumn, row: usize) -> Result<Values, String> {
    let found = match table.column(column.name) {
        Err(_) if column.came_later => return Ok(Values::Real(vec![f64::NAN])),
        found => found.map_err(|error| error.to_string())?,
    };
    match (column.kind, &found.values) {
        (Real, Values::Real(values)) => Ok(Values::Real(vec![values[row]])),
        (Real, Values::Integer(values)) => Ok(Values::Real(vec![values[row] as f64])),
        (Integer, Values::Integer(values)) => Ok(Values::Integer(vec![values[row]])),
        (Text, Values::Text(values)) => Ok(Values::Text(vec![values[row].clone()])),
        (Boolean, Values::Boolean(values)) => Ok(Values::Boolean(vec![values[row]])),
        (wanted, other) => Err(FormatError::OtherKind {
            name: column.name.to_owned(),
            expected: wanted,
            found: other.kind(),
        }
        .to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows sealed or exported before columns were added are no less whole.
    #[test]
    fn rows_from_before_a_column_hold_no_number_there() {
        let one = |column: &RowColumn| {
            let values = match (column.name, column.kind) {
                ("identity", _) => Values::Text(vec!["0f".repeat(16)]),
                (_, Real) => Values::Real(vec![0.5]),
                (_, Integer) => Values::Integer(vec![7]),
                (_, Text) => Values::Text(vec!["x".to_owned()]),
                (_, Boolean) => Values::Boolean(vec![true]),
            };
            of_kind(column, values)
        };
        let before = COLUMNS.iter().filter(|column| !column.came_later).map(one);
        let row = Row::from_csv(&csv::encode(&joined(before))).unwrap();
        assert_eq!(row.table().columns().len(), COLUMNS.len());
        assert!(row.table().reals("pumping_efficiency").unwrap()[0].is_nan());
        assert_eq!(row.table().reals("wall_power").unwrap(), [0.5]);
        // Read again it is the same.
        assert_eq!(Row::from_csv(&row.to_csv()).unwrap(), row);
        // A column of the first rows must be there.
        let without = COLUMNS.iter().filter(|column| column.name != "wall_power");
        let error = Row::from_csv(&csv::encode(&joined(without.map(one)))).unwrap_err();
        assert!(error.contains("wall_power"), "{error}");
    }
}
