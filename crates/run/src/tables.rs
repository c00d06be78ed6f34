//! The tables of a run, from the tables of quantities.

use peristalsis_configuration::{Configuration, Control};
use peristalsis_formats::{Column, FormatError, Table, ValueKind, Values};
use peristalsis_observe::columns::Scope;
use peristalsis_observe::{
    COLUMNS, PROFILE, ProfileBin, Quantity, Reading, Value, WAVES, grain_contacts,
};

use crate::contacts::{CONTACT, GRAIN, grains};
use crate::run::Run;
use crate::spheres::{SPHERE, seen_spheres};
use crate::{REVISION, VERSION};

/// The time series: one row per sample, one column for each row of [`COLUMNS`] that applies.
///
/// # Errors
/// None that a caller can mend: the columns are of equal length.
pub fn timeseries_table(run: &Run) -> Result<Table, FormatError> {
    let configuration = run.configuration();
    let quantities = COLUMNS
        .iter()
        .filter(|column| applies(column.scope, configuration))
        .map(|column| &column.quantity);
    table(run, quantities, run.recorder().samples())
}

/// The profile in the wave frame over the late part of the run: one row per bin.
///
/// # Errors
/// None that a caller can mend: the columns are of equal length.
pub fn profile_table(run: &Run) -> Result<Table, FormatError> {
    table(run, PROFILE, &late_profile(run))
}

/// The flow wave by wave: one row for each wave of each whole period, period by period.
///
/// # Errors
/// None that a caller can mend: the columns are of equal length.
pub fn waves_table(run: &Run) -> Result<Table, FormatError> {
    table(run, WAVES, run.recorder().waves())
}

/// A bin of the times that grains took from the inlet of an open tube to its outlet.
pub(crate) struct TransitBin {
    from: f64,
    to: f64,
    grains: u64,
    density: f64,
}

/// The columns of the transit times.
#[rustfmt::skip]
const TRANSIT: &[Quantity<TransitBin>] = &[
    Quantity::new("from", "t", "shortest transit time of the bin", Reading::Real(|b| b.from)),
    Quantity::new("to", "t", "longest transit time of the bin", Reading::Real(|b| b.to)),
    Quantity::new("grains", "1", "grains that took so long from the inlet to the outlet", Reading::Whole(|b| b.grains)),
    Quantity::new("density", "1/t", "part of all of them, over the width of the bin", Reading::Real(|b| b.density)),
];

/// How long the grains of an open tube took from the inlet to the outlet, in the whole run: one row per bin; `None` of a
/// periodic tube.
///
/// # Errors
/// None that a caller can mend: the columns are of equal length.
pub(crate) fn transit_table(run: &Run) -> Result<Option<Table>, FormatError> {
    let Some(ends) = run.simulation().ends() else {
        return Ok(None);
    };
    let times = ends.transit_times();
    let (width, bins) = times.distribution();
    let all = times.number() as f64;
    let bin = |(place, &grains): (usize, &u64)| TransitBin {
        from: place as f64 * width,
        to: (place + 1) as f64 * width,
        grains,
        density: grains as f64 / (all * width),
    };
    let bins: Vec<TransitBin> = bins.iter().enumerate().map(bin).collect();
    table(run, TRANSIT, &bins).map(Some)
}

/// The spheres as they stand: one row each, grains first, then those of an elastic wall.
///
/// # Errors
/// None that a caller can mend: the columns are of equal length.
pub fn snapshot_table(run: &Run) -> Result<Table, FormatError> {
    table(run, SPHERE, &seen_spheres(run))
}

/// The contacts of the grains as they stand: one row each, grain by grain.
///
/// # Errors
/// None that a caller can mend: the columns are of equal length.
pub fn contacts_table(run: &Run) -> Result<Table, FormatError> {
    table(run, CONTACT, &grain_contacts(run.simulation()))
}

/// The grains as they stand, in the frame of the tube: one row each, with the step and the time.
///
/// # Errors
/// None that a caller can mend: the columns are of equal length.
pub(crate) fn grains_table(run: &Run) -> Result<Table, FormatError> {
    table(run, GRAIN, &grains(run.simulation()))
}

/// The bins of the late profile.
pub(crate) fn late_profile(run: &Run) -> Vec<ProfileBin> {
    let configuration = run.configuration();
    run.recorder()
        .profile()
        .late(run.late_fraction(), configuration.tube.wavelength)
}

/// The kind of a column that is read so.
pub(crate) fn kind<Of>(reading: &Reading<Of>) -> ValueKind {
    match reading {
        Reading::Whole(_) => ValueKind::Integer,
        Reading::Truth(_) => ValueKind::Boolean,
        Reading::Text(_) => ValueKind::Text,
        _ => ValueKind::Real,
    }
}

/// A column from its values; a missing value is NaN.
pub fn gathered(kind: ValueKind, values: impl Iterator<Item = Value>) -> Values {
    let mut gathered = Values::empty(kind);
    for value in values {
        match (&mut gathered, value) {
            (Values::Real(column), Value::Real(value)) => column.push(value),
            (Values::Real(column), _) => column.push(f64::NAN),
            // Seeds have 63 bits, and counts are smaller.
            (Values::Integer(column), Value::Whole(value)) => {
                column.push(i64::try_from(value).unwrap_or(i64::MAX));
            }
            (Values::Boolean(column), Value::Truth(value)) => column.push(value),
            (Values::Text(column), Value::Text(value)) => column.push(value),
            _ => unreachable!("a quantity is always read as one kind"),
        }
    }
    gathered
}

fn table<'a, Of: 'static>(
    run: &Run,
    quantities: impl IntoIterator<Item = &'a Quantity<Of>>,
    rows: &[Of],
) -> Result<Table, FormatError> {
    let columns = quantities.into_iter().flat_map(|quantity| {
        let headings = quantity.headings().into_iter().enumerate();
        headings.map(|(place, (name, text))| Column {
            name,
            unit: quantity.unit.to_owned(),
            description: text.to_owned(),
            values: gathered(
                kind(&quantity.reading),
                rows.iter()
                    .map(|row| quantity.values(row).swap_remove(place)),
            ),
        })
    });
    Table::builder()
        .columns(columns)
        .metadata("peristalsis.version", VERSION)
        .metadata("peristalsis.revision", REVISION)
        .metadata("peristalsis.configuration", run.configuration().to_toml())
        .build()
}

fn has_sizes(configuration: &Configuration) -> bool {
    configuration.grains.diameter_min < configuration.grains.diameter_max
}

fn applies(scope: Scope, configuration: &Configuration) -> bool {
    match scope {
        Scope::Always => true,
        Scope::Friction => configuration.contact.friction.is_some(),
        Scope::BodyForce => configuration.has_body_force(),
        Scope::Rolling => configuration.contact.rolling.is_some(),
        Scope::Cohesion => configuration.contact.cohesion.is_some(),
        Scope::OpenTube => configuration.inlet.is_some(),
        Scope::PeriodicTube => configuration.inlet.is_none(),
        Scope::Sizes => has_sizes(configuration),
        Scope::SizesUnderGravity => {
            let [across, up, _] = configuration.body.gravity;
            has_sizes(configuration) && (across, up) != (0.0, 0.0)
        }
        Scope::ElasticWall => matches!(configuration.drive.control, Control::Stress { .. }),
    }
}
