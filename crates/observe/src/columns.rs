//! The tables of observables: a new one is a field of [`Sample`], [`ProfileBin`] or [`WaveFlow`] and a row here.

use crate::profile::ProfileBin;
use crate::quantity::Quantity;
use crate::quantity::Reading::{Measured, Real, Whole};
use crate::sample::Sample;
use crate::waves::WaveFlow;

/// A column of the time series.
#[derive(Clone, Copy, Debug)]
pub struct Column {
    /// Which runs have it.
    pub scope: Scope,
    /// The quantity, read off a sample.
    pub quantity: Quantity<Sample>,
}

/// Which runs have a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// All.
    Always,
    /// Those with friction.
    Friction,
    /// Those with an elastic wall.
    ElasticWall,
    /// Those with a body force on the grains.
    BodyForce,
    /// Those with rolling resistance.
    Rolling,
    /// Those with cohesion.
    Cohesion,
    /// Those of an open tube.
    OpenTube,
    /// Those of a periodic tube.
    PeriodicTube,
    /// Those with grains of several sizes.
    Sizes,
    /// Those with grains of several sizes, and gravity across the axis.
    SizesUnderGravity,
}

const fn row(
    name: &'static str,
    unit: &'static str,
    scope: Scope,
    text: &'static str,
    value: fn(&Sample) -> f64,
) -> Column {
    Column {
        scope,
        quantity: Quantity::new(name, unit, text, Real(value)),
    }
}

use Scope::{
    Always, BodyForce, Cohesion, ElasticWall, Friction, OpenTube, PeriodicTube, Rolling, Sizes,
    SizesUnderGravity,
};

/// The columns of the time series, in order.
#[rustfmt::skip]
pub const COLUMNS: &[Column] = &[
    row("time", "t", Always, "end of the interval that the row is about", |s| s.time),
    row("period", "1", Always, "wavelengths that the wave has run: time in periods", |s| s.period),
    row("flow_rate", "1/t", Always, "J along the wave, mean over the interval, grains inside", |s| s.flow_rate),
    row("flow_rate_ratio", "1", Always, "J/Jmax, Jmax = N c/L, grains inside", |s| s.flow_rate_ratio),
    row("flow_rate_raw", "1/t", Always, "J of all grains, escaped ones too", |s| s.flow_rate_raw),
    row("flow_rate_ratio_raw", "1", Always, "J/Jmax of all grains", |s| s.flow_rate_ratio_raw),
    row("flow_rate_instantaneous", "1/t", Always, "J from the velocities at the end of the interval", |s| s.flow_rate_instantaneous),
    row("kinetic_energy", "m d^2/t^2", Always, "sum m v^2/2 of the grains, escaped ones too", |s| s.kinetic_energy),
    row("granular_temperature", "m d^2/t^2", Always, "sum m |v - <v>|^2/(3 N), escaped grains too, <v> the mean of their velocities", |s| s.granular_temperature),
    row("contacts", "1", Always, "contacts of a grain, escaped ones too, wall included", |s| s.contacts),
    row("largest_overlap", "d", Always, "largest overlap at the end of the interval", |s| s.largest_overlap),
    row("axial_displacement", "d", Always, "mean axial displacement of the grains inside since the start, along the wave", |s| s.axial_displacement),
    row("axial_displacement_variance", "d^2", Always, "its variance over the grains: grows as 2 D t where they disperse", |s| s.axial_displacement_variance),
    row("escaped", "1", Always, "grains whose centre lies outside R + d/2", |s| s.escaped),
    row("inside", "1", Always, "grains inside", |s| s.inside),
    row("wall_axial_force", "m d/t^2", Always, "axial force of the wall on the grains at the end of the interval, along the wave", |s| s.wall_axial_force),
    row("wall_power", "m d^2/t^3", Always, "mean power that wall or drive put in", |s| s.wall_power),
    row("dissipated_power", "m d^2/t^3", Always, "mean power lost", |s| s.dissipated_power),
    row("potential_energy", "m d^2/t^2", Always, "elastic energy of contacts, wall network and tethers", |s| s.potential_energy),
    row("contact_energy", "m d^2/t^2", Always, "elastic energy of contacts", |s| s.contact_energy),
    row("axial_momentum", "m d/t", Always, "axial momentum of the grains inside, along the wave", |s| s.axial_momentum),
    row("angular_momentum", "m d^2/t", Always, "angular momentum of the grains inside about +z, spin included", |s| s.angular_momentum),
    row("bottleneck", "d", Always, "smallest bottleneck: twice the tube's least radius, to the wall's centres; of an elastic wall the least mean over a slice one ring's spacing thick. Slices begin where rings stand at rest, so it was 0.04 to 0.07 d above the least mean of whole rings; one without a sphere counts as the tube at rest", |s| s.bottleneck),
    row("energy_residual", "1", Always, "|what the ledger misses|/(integral of |power of wall and drive| + |work of the body force|)", |s| s.energy_residual),
    row("wall_work", "m d^2/t^2", Always, "ledger: work of the prescribed wall", |s| s.ledger.wall_work),
    row("normal_dissipated", "m d^2/t^2", Always, "ledger: lost along normals", |s| s.ledger.normal_dissipated),
    row("rotational_energy", "m d^2/t^2", Friction, "sum I omega^2/2", |s| s.rotational_energy),
    row("sliding_fraction", "1", Friction, "part of the contacts that slide; a contact without a normal force counts as sliding", |s| s.sliding_fraction),
    row("tangential_dissipated", "m d^2/t^2", Friction, "ledger: lost to tangential damping", |s| s.ledger.tangential_dissipated),
    row("sliding_dissipated", "m d^2/t^2", Friction, "ledger: lost to sliding", |s| s.ledger.sliding_dissipated),
    row("history_reset", "m d^2/t^2", Friction, "ledger: energy of tangential springs that is lost when spheres part; if the normal force was 0 before, it counts as sliding instead", |s| s.ledger.history_reset),
    row("drive_work", "m d^2/t^2", ElasticWall, "ledger: work of the travelling force", |s| s.ledger.drive_work),
    row("keep_work", "m d^2/t^2", ElasticWall, "ledger: work of the removal of the mean force", |s| s.ledger.keep_work),
    row("drag_dissipated", "m d^2/t^2", ElasticWall, "ledger: lost to drag on the wall", |s| s.ledger.drag_dissipated),
    row("network_dissipated", "m d^2/t^2", ElasticWall, "ledger: lost in the dashpots of the wall's network", |s| s.ledger.network_dissipated),
    row("wall_kinetic_energy", "m d^2/t^2", ElasticWall, "kinetic energy of the wall", |s| s.wall_kinetic_energy),
    row("network_energy", "m d^2/t^2", ElasticWall, "elastic energy of the wall's springs", |s| s.network_energy),
    row("keep_energy", "m d^2/t^2", ElasticWall, "energy of tethers and balancing force", |s| s.keep_energy),
    row("wall_axial_displacement", "d", ElasticWall, "mean axial displacement of the wall, along the wave", |s| s.wall_axial_displacement),
    row("wall_axial_displacement_rms", "d", ElasticWall, "root mean square axial displacement of the wall", |s| s.wall_axial_displacement_rms),
    row("wall_azimuthal_displacement_rms", "d", ElasticWall, "root mean square azimuthal displacement of the wall", |s| s.wall_azimuthal_displacement_rms),
    row("body_power", "m d^2/t^3", BodyForce, "mean power of the body force on the grains inside; negative where they are pumped against it. With gravity across the tube and escaped grains it is of first order in the time between samples", |s| s.body_power),
    row("body_work", "m d^2/t^2", BodyForce, "ledger: work of the body force, on escaped grains too", |s| s.ledger.body_work),
    row("rolling_dissipated", "m d^2/t^2", Rolling, "ledger: lost to rolling resistance", |s| s.ledger.rolling_dissipated),
    row("cohesion_dissipated", "m d^2/t^2", Cohesion, "ledger: lost where contacts that cohered broke", |s| s.ledger.cohesion_dissipated),
    row("mass_flow_rate", "m/t", Always, "mass that flows along the wave, mean over the interval: sum m dz/dt over L, grains inside", |s| s.mass_flow_rate),
    row("discharge_rate", "m/t", OpenTube, "mass that leaves through the outlet, mean over the interval", |s| s.discharge_rate),
    row("return_rate", "m/t", OpenTube, "mass that leaves through the inlet, against the flow", |s| s.return_rate),
    row("feed_rate", "m/t", OpenTube, "mass that is put in at the inlet", |s| s.feed_rate),
    row("discharged", "m", OpenTube, "mass that has left through the outlet since the start", |s| s.discharged),
    row("hold_up", "m", OpenTube, "mass of the grains between the ends", |s| s.hold_up),
    row("exchanged_energy", "m d^2/t^2", OpenTube, "ledger: energy that grains brought in, less what others took out", |s| s.ledger.exchanged),
    row("axial_mixing", "1", PeriodicTube, "Lacey's index at the end of the last whole period, of the halves that began in front and behind: 0 apart, 1 at random", |s| s.mixing.map_or(f64::NAN, |it| it.axial)),
    row("radial_mixing", "1", PeriodicTube, "the same of the halves that began near the axis and near the wall", |s| s.mixing.map_or(f64::NAN, |it| it.radial)),
    row("radial_segregation", "1", Sizes, "correlation of diameter and radial place r/(R - (d_w + d)/2) at the end of the last whole period: positive where large grains are outside", |s| s.segregation.radial.unwrap_or(f64::NAN)),
    row("belly_segregation", "1", Sizes, "the same of diameter and the tube's radius R: positive where large grains are in the bellies", |s| s.segregation.belly.unwrap_or(f64::NAN)),
    row("height_segregation", "1", SizesUnderGravity, "the same of diameter and height over the axis: positive where large grains are on top", |s| s.segregation.height.unwrap_or(f64::NAN)),
];

/// The columns of the profile in the wave frame, in order.
#[rustfmt::skip]
pub const PROFILE: &[Quantity<ProfileBin>] = &[
    Quantity::new("position", "1", "middle of the bin: (z - c t)/lambda folded to one wavelength, z along the wave", Real(|b| b.position)),
    Quantity::new("density", "1/d", "grains per length of tube", Measured(|b| b.density)),
    Quantity::new("axial_velocity", "d/t", "mean axial velocity along the wave, laboratory frame: momentum over mass, so that grains of several sizes count by their mass", Measured(|b| b.axial_velocity)),
    Quantity::new("granular_temperature", "m d^2/t^2", "sum m |v - <v>|^2/(3 N) in the bin, <v> the velocity of its centre of mass", Measured(|b| b.temperature)),
    Quantity::new("radius", "d", "mean radius of the tube", Real(|b| b.radius)),
    Quantity::new("least_radius", "d", "least radius seen", Real(|b| b.least_radius)),
    Quantity::new("largest_radius", "d", "largest radius seen", Real(|b| b.largest_radius)),
    Quantity::new("wall_normal_force", "m/t^2", "axial force of the wall on the grains along the normals of contacts, per length of tube, along the wave", Measured(|b| b.wall_normal_force)),
    Quantity::new("wall_tangential_force", "m/t^2", "axial force of the wall on the grains by friction, per length of tube, along the wave", Measured(|b| b.wall_tangential_force)),
    Quantity::new("wall_pressure", "m/(d t^2)", "pressure on the wall: radial force per area 2 pi R dz through the centres of its spheres, outward; R/(R - d_w/2) times as large on the clear bore", Measured(|b| b.wall_pressure)),
    Quantity::new("wall_shear", "m/(d t^2)", "shear on the wall along the wave: axial force on it per area 2 pi R dz, less that of the mean pressure on the mean radius", Measured(|b| b.wall_shear)),
    Quantity::new("wall_wear", "m/t^3", "power that grains lose where they slide on the wall, per area 2 pi R dz", Measured(|b| b.wall_wear)),
    Quantity::new("mean_diameter", "d", "mean diameter of the grains", Measured(|b| b.diameter)),
    Quantity::new("wall_axial_velocity", "d/t", "mean axial velocity of the wall's spheres along the wave; 0 for a prescribed wall", Measured(|b| b.wall_axial_velocity)),
];

/// The columns of the flow wave by wave, in order.
#[rustfmt::skip]
pub const WAVES: &[Quantity<WaveFlow>] = &[
    Quantity::new("period", "1", "wavelengths that the wave has run by the end of the period that the row is about", Real(|w| w.period)),
    Quantity::new("time", "t", "end of that period", Real(|w| w.time)),
    Quantity::new("wave", "1", "number of the wave, from 0 on along the wave: from throat to throat, moving with them", Whole(|w| w.wave.into())),
    Quantity::new("grains", "1", "mean number of grains in the wave", Real(|w| w.grains)),
    Quantity::new("flow_rate", "1/t", "J of these grains along the wave: sum of dz/dt over lambda", Real(|w| w.flow_rate)),
    Quantity::new("flow_rate_ratio", "1", "J/Jmax of these grains", Real(|w| w.flow_rate_ratio)),
];
