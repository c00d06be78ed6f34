//! The tables of a run.

use peristalsis_configuration::{Configuration, Control};
use peristalsis_formats::{FormatError, Table, Values};
use peristalsis_observe::columns::Scope;
use peristalsis_observe::{COLUMNS, ProfileBin, WaveFlow};

use crate::run::Run;
use crate::spheres::{SeenSphere, seen_spheres};
use crate::{REVISION, VERSION};

/// The time series: one row a sample, one column for each row of [`COLUMNS`] that applies.
///
/// # Errors
/// None that a caller can mend: the columns are of equal length.
pub fn timeseries_table(run: &Run) -> Result<Table, FormatError> {
    let configuration = run.configuration();
    let samples = run.recorder().samples();
    let mut table = Table::builder();
    for column in COLUMNS
        .iter()
        .filter(|column| applies(column.scope, configuration))
    {
        let values = samples.iter().map(column.value).collect();
        table = table.column(
            column.name,
            column.unit,
            column.description,
            Values::Real(values),
        );
    }
    with_origin(table, configuration).build()
}

/// The profile in the wave's frame over the late part of the run: one row a bin.
///
/// # Errors
/// None that a caller can mend: the columns are of equal length.
pub fn profile_table(run: &Run) -> Result<Table, FormatError> {
    let configuration = run.configuration();
    let bins = late_profile(run);
    let column = |value: fn(&ProfileBin) -> f64| Values::Real(bins.iter().map(value).collect());
    let table = Table::builder()
        .column(
            "position",
            "1",
            "middle of the bin: (z - c t)/lambda folded to one wavelength, z along the wave",
            column(|bin| bin.position),
        )
        .column(
            "density",
            "1/d",
            "grains per length of tube",
            column(|bin| bin.density.0),
        )
        .column(
            "density_error",
            "1/d",
            "its standard error",
            column(|bin| bin.density.1),
        )
        .column(
            "axial_velocity",
            "d/t",
            "mean axial velocity along the wave, laboratory frame",
            column(|bin| bin.axial_velocity.0),
        )
        .column(
            "axial_velocity_error",
            "d/t",
            "its standard error",
            column(|bin| bin.axial_velocity.1),
        )
        .column(
            "granular_temperature",
            "m d^2/t^2",
            "sum m |v - <v>|^2/(3 N) about the bin's mean velocity",
            column(|bin| bin.temperature.0),
        )
        .column(
            "granular_temperature_error",
            "m d^2/t^2",
            "its standard error",
            column(|bin| bin.temperature.1),
        )
        .column(
            "radius",
            "d",
            "mean radius of the tube",
            column(|bin| bin.radius),
        )
        .column(
            "least_radius",
            "d",
            "least radius seen",
            column(|bin| bin.least_radius),
        )
        .column(
            "largest_radius",
            "d",
            "largest radius seen",
            column(|bin| bin.largest_radius),
        )
        .column(
            "wall_normal_force",
            "m/t^2",
            "axial force of the wall on the grains along the normals of contacts, per length of tube, along the wave",
            column(|bin| bin.wall_normal_force.0),
        )
        .column(
            "wall_normal_force_error",
            "m/t^2",
            "its standard error",
            column(|bin| bin.wall_normal_force.1),
        )
        .column(
            "wall_tangential_force",
            "m/t^2",
            "axial force of the wall on the grains by friction, per length of tube, along the wave",
            column(|bin| bin.wall_tangential_force.0),
        )
        .column(
            "wall_tangential_force_error",
            "m/t^2",
            "its standard error",
            column(|bin| bin.wall_tangential_force.1),
        )
        .column(
            "wall_pressure",
            "m/(d t^2)",
            "pressure on the wall: radial force per area 2 pi R dz, outward",
            column(|bin| bin.wall_pressure.0),
        )
        .column(
            "wall_pressure_error",
            "m/(d t^2)",
            "its standard error",
            column(|bin| bin.wall_pressure.1),
        )
        .column(
            "wall_shear",
            "m/(d t^2)",
            "shear on the wall along the wave: axial force on it per area 2 pi R dz, less that of the pressure",
            column(|bin| bin.wall_shear.0),
        )
        .column(
            "wall_shear_error",
            "m/(d t^2)",
            "its standard error",
            column(|bin| bin.wall_shear.1),
        )
        .column(
            "wall_axial_velocity",
            "d/t",
            "mean axial velocity of the wall's spheres along the wave; 0 for a prescribed wall",
            column(|bin| bin.wall_axial_velocity.0),
        )
        .column(
            "wall_axial_velocity_error",
            "d/t",
            "its standard error",
            column(|bin| bin.wall_axial_velocity.1),
        );
    with_origin(table, configuration).build()
}

/// The flow wave by wave: one row for each wave of each whole period, period by period.
///
/// # Errors
/// None that a caller can mend: the columns are of equal length.
pub fn waves_table(run: &Run) -> Result<Table, FormatError> {
    let flows = run.recorder().waves();
    let column = |value: fn(&WaveFlow) -> f64| Values::Real(flows.iter().map(value).collect());
    let table = Table::builder()
        .column(
            "period",
            "1",
            "wavelengths that the wave has run by the end of the period that the row is about",
            column(|flow| flow.period),
        )
        .column("time", "t", "end of that period", column(|flow| flow.time))
        .column(
            "wave",
            "1",
            "number of the wave, from 0 on along the wave: from throat to throat, moving with them",
            Values::Integer(flows.iter().map(|flow| flow.wave.into()).collect()),
        )
        .column(
            "grains",
            "1",
            "mean number of grains in the wave",
            column(|flow| flow.grains),
        )
        .column(
            "flow_rate",
            "1/t",
            "J of these grains along the wave: sum of dz/dt over lambda",
            column(|flow| flow.flow_rate),
        )
        .column(
            "flow_rate_ratio",
            "1",
            "J/Jmax of these grains",
            column(|flow| flow.flow_rate_ratio),
        );
    with_origin(table, run.configuration()).build()
}

/// The spheres as they stand: one row each, grains first, then those of an elastic wall.
///
/// # Errors
/// None that a caller can mend: the columns are of equal length.
pub fn snapshot_table(run: &Run) -> Result<Table, FormatError> {
    let spheres = seen_spheres(run);
    let column = |value: fn(&SeenSphere) -> f64| Values::Real(spheres.iter().map(value).collect());
    let table = Table::builder()
        .column(
            "grain",
            "",
            "whether it is a grain; otherwise a sphere of the wall",
            Values::Boolean(spheres.iter().map(|seen| seen.is_grain).collect()),
        )
        .column(
            "along",
            "d",
            "place along the tube, the wave running towards larger ones",
            column(|seen| seen.sphere.along),
        )
        .column(
            "across",
            "d",
            "place across the tube, from its axis",
            column(|seen| seen.sphere.across),
        )
        .column(
            "depth",
            "d",
            "place across the tube and across that",
            column(|seen| seen.sphere.depth),
        )
        .column(
            "diameter",
            "d",
            "diameter",
            column(|seen| seen.sphere.diameter),
        )
        .column(
            "axial_velocity",
            "d/t",
            "axial velocity along the wave, laboratory frame",
            column(|seen| seen.axial_velocity),
        );
    with_origin(table, run.configuration()).build()
}

/// The bins of the late profile.
pub(crate) fn late_profile(run: &Run) -> Vec<ProfileBin> {
    let configuration = run.configuration();
    run.recorder()
        .profile()
        .late(run.late_fraction(), configuration.tube.wavelength)
}

fn applies(scope: Scope, configuration: &Configuration) -> bool {
    match scope {
        Scope::Always => true,
        Scope::Friction => configuration.contact.friction.is_some(),
        Scope::BodyForce => configuration.drive.body_force != 0.0,
        Scope::ElasticWall => matches!(configuration.drive.control, Control::Stress { .. }),
    }
}

fn with_origin(
    table: peristalsis_formats::TableBuilder,
    configuration: &Configuration,
) -> peristalsis_formats::TableBuilder {
    table
        .metadata("peristalsis.version", VERSION)
        .metadata("peristalsis.revision", REVISION)
        .metadata("peristalsis.configuration", configuration.to_toml())
}
