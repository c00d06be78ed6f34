//! The keys of the TOML form as they are written: the keys of the resolved configuration, and keys that stand for them.
//!
//! What `schemars` says of a key (`x-unit` and the range beside its documentation) becomes the JSON schema, and the reader
//! enforces it. m, d and t are the units of mass, length and time; "1" marks a pure number. The default "null" says that
//! what holds for a missing key follows from other keys.

use std::sync::LazyLock;

use peristalsis_physics::contact::{Cohesion, CundallStrack, Normal, NormalLaw, RollingResistance};
use peristalsis_physics::ends::Inlet;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::configuration::{Drive, Initial, Observe, Run, Tube, Wall};
use crate::grains::{Body, Grains};
use crate::schema;

/// Keys that give the number of grains.
pub(crate) const NUMBERS: &[&str] = &[
    "grains.number",
    "grains.volume_fraction",
    "grains.number_density",
];
/// Keys that give the speed of the wave.
pub(crate) const RATES: &[&str] = &[
    "drive.strain_rate",
    "drive.wave_speed",
    "units.wave_frequency",
];
/// Keys that give the length of the run.
pub(crate) const LENGTHS: &[&str] = &["run.periods", "run.duration"];
/// Lists of keys; a configuration gives exactly one key of each list. A higher layer replaces the choice of a lower one.
pub(crate) const ALTERNATIVES: [&[&str]; 4] =
    [NUMBERS, &["drive.width", "drive.amplitude"], RATES, LENGTHS];

/// Lists of keys; a configuration gives at most one key of each list: the damping of a law, or the restitution instead.
pub(crate) static DAMPINGS: LazyLock<Vec<[&str; 2]>> = LazyLock::new(|| {
    schema::laws()
        .map(|law| [law.damping().0, RESTITUTION])
        .collect()
});
/// Restitution of an impact, instead of a damping.
pub(crate) const RESTITUTION: &str = "contact.restitution";

/// Keys of the lattice of a wall of spheres; a smooth wall has none of them.
pub(crate) const RINGS: [&str; 2] = ["tube.spheres_per_ring", "tube.rings_per_wave"];

/// Where the wall spheres of arrangement = "file" come from; at most one is given.
const SPHERES: &[&str] = &["tube.file", "tube.places"];

/// Where the points of waveform = "table" come from; at most one is given.
const POINTS: &[&str] = &["drive.table", "drive.phases"];
/// Keys of gravity: at most one is given.
const GRAVITIES: &[&str] = &["body.gravity", "units.acceleration"];

/// Keys of distributions of sizes: at most one of each list is given.
const SIZES: [&[&str]; 2] = [
    &["grains.large_fraction", "grains.large_volume_fraction"],
    &["grains.file", "grains.diameters"],
];

/// Keys of either kind of cohesion: at most one of each list is given.
const COHESIONS: [&[&str]; 2] = [
    &["contact.cohesion_force", "units.cohesion_force"],
    &["contact.surface_energy", "units.surface_energy"],
];

/// Keys of the rate of the inlet: at most one is given.
const FEEDS: &[&str] = &["inlet.feed_rate", "units.feed_rate"];

/// Keys that only an open tube has.
pub(crate) const OPEN: [&str; 6] = [
    "inlet.head",
    "inlet.length",
    "inlet.feed_rate",
    "inlet.velocity",
    "inlet.waiting",
    "units.feed_rate",
];

/// All groups of keys that exclude one another.
pub(crate) fn exclusive_groups() -> impl Iterator<Item = &'static [&'static str]> {
    ALTERNATIVES
        .into_iter()
        .chain(DAMPINGS.iter().map(<[_; 2]>::as_slice))
        .chain([SPHERES, POINTS, GRAVITIES, FEEDS])
        .chain(COHESIONS)
        .chain(SIZES)
}

/// Configuration of one simulation of grains in a peristaltic tube.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
pub(crate) struct Keys {
    #[serde(default)]
    pub(crate) grains: GrainsKeys,
    #[serde(default)]
    pub(crate) body: Body,
    pub(crate) contact: ContactKeys,
    pub(crate) tube: TubeKeys,
    pub(crate) drive: DriveKeys,
    #[serde(default)]
    pub(crate) wall: Wall,
    #[serde(default)]
    pub(crate) inlet: Inlet,
    #[serde(default)]
    pub(crate) initial: Initial,
    #[serde(default)]
    pub(crate) run: Run,
    #[serde(default)]
    pub(crate) observe: Observe,
    #[serde(default)]
    pub(crate) units: UnitsKeys,
}

/// The tube and the places of its wall spheres.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
pub(crate) struct TubeKeys {
    #[serde(flatten)]
    pub(crate) tube: Tube,
    /// Table of the wall spheres under arrangement = "file", instead of angles and places: CSV with the columns angle (rad)
    /// and place (d), one sphere per line. Its path is relative to the configuration file, with --set to where the program runs.
    #[serde(rename = "file")]
    #[schemars(extend("default" = null))]
    pub(crate) _file: Option<String>,
}

/// The grains: how many and how large. Exactly one of number, volume_fraction and number_density is given.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
pub(crate) struct GrainsKeys {
    #[serde(flatten)]
    pub(crate) grains: Grains,
    /// Volume fraction rho = N d^3/(6 a^2 L) of grains in a straight tube of radius a and length L, d^3 averaged over
    /// the diameters; N is rounded to the nearest whole number.
    #[schemars(extend("x-unit" = "1", "minimum" = 0, "maximum" = 10))]
    pub(crate) volume_fraction: Option<f64>,
    /// Number density n = N d*^3/(pi a^2 L), d* the largest grain diameter; N is rounded to the nearest whole number.
    #[schemars(extend("x-unit" = "1", "minimum" = 0, "maximum" = 10))]
    pub(crate) number_density: Option<f64>,
    /// Part of the volume of all grains that the grains of diameter_max have, instead of large_fraction.
    #[schemars(extend("x-unit" = "1", "minimum" = 0, "maximum" = 1))]
    pub(crate) large_volume_fraction: Option<f64>,
    /// Table of the diameters under sizes = "table", instead of diameters and fractions: CSV with the columns diameter and
    /// fraction (by number), one size per line. Its path is relative to the configuration file, with --set to where the
    /// program runs.
    #[serde(rename = "file")]
    #[schemars(extend("default" = null))]
    pub(crate) _file: Option<String>,
}

/// The contact of two spheres, grain or wall.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
pub(crate) struct ContactKeys {
    #[serde(flatten)]
    pub(crate) normal: Normal,
    #[serde(flatten)]
    pub(crate) friction: CundallStrack,
    #[serde(flatten)]
    pub(crate) rolling: RollingResistance,
    #[serde(flatten)]
    pub(crate) cohesion: Cohesion,
    /// Restitution e of two grains of the mean diameter that meet head-on. Give it instead of normal_damping (linear law) or
    /// dissipation_time (Hertz law), which then follow. Linear law: e = exp(-pi beta/sqrt(k/m_ij - beta^2)), beta =
    /// eta/(2 m_ij), at any speed. Hertz law: by integration of an impact at restitution_speed; e falls with the speed.
    /// Cohesion is left out of it: with cohesion impacts give back less, and slow grains stick.
    #[schemars(extend("x-unit" = "1", "minimum" = 1e-3, "maximum" = 1))]
    pub(crate) restitution: Option<f64>,
    /// Relative speed at which restitution holds under the Hertz law. Default: the speed of the wave. Give it in a study of
    /// several strain rates, or each has its own material. A static wave needs it.
    #[schemars(extend("x-unit" = "d t^-1", "exclusiveMinimum" = 0, "maximum" = 1e6))]
    pub(crate) restitution_speed: Option<f64>,
}

/// The travelling wave that drives the grains. Exactly one of strain_rate, wave_speed and units.wave_frequency is given;
/// under strain control exactly one of width and amplitude, under stress control force_amplitude.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
pub(crate) struct DriveKeys {
    #[serde(flatten)]
    pub(crate) drive: Drive,
    /// Table of waveform = "table" instead of phases and radii: CSV with the columns phase (cycles) and radius, one point
    /// per line. Its path is relative to the configuration file, with --set to where the program runs.
    #[serde(rename = "table")]
    #[schemars(extend("default" = null))]
    pub(crate) _table: Option<String>,
    /// Amplitude b of the radius R = a + b g((c t + z)/lambda), g the waveform, at most a; strain control.
    #[schemars(extend("x-unit" = "d", "minimum" = 0))]
    pub(crate) amplitude: Option<f64>,
    /// Speed c of the wave; 0 is a static wave and needs run.duration.
    #[schemars(extend("x-unit" = "d t^-1", "minimum" = 0, "maximum" = 1e6))]
    pub(crate) wave_speed: Option<f64>,
    /// How parameters of the drive follow time. "sudden": constant from t = 0. "ramp": the amplitude grows from nothing
    /// within ramp_periods. Or a table such as { form = "ramp", parameter = "width", from = 3.0, to = 2.6, end = 100 } or
    /// { form = "steps", parameter = "width", at = [0, 100], values = [2.9, 2.7] }; with form = "course" straight lines
    /// lead from value to value. Or a list of such tables, one for each parameter.
    #[schemars(extend("default" = "sudden"))]
    pub(crate) schedule: Option<ScheduleKeys>,
    /// Length of the ramp of schedule = "ramp", in wave periods.
    #[schemars(extend("x-unit" = "periods", "exclusiveMinimum" = 0, "maximum" = 1e9))]
    pub(crate) ramp_periods: Option<f64>,
}

/// A schedule by name, as a table, or a list of tables.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum ScheduleKeys {
    /// By name.
    Named(ScheduleName),
    /// One scheduled parameter.
    One(ScheduleTableKeys),
    /// Several scheduled parameters.
    Several(Vec<ScheduleTableKeys>),
}

/// The course of one parameter of the drive. Times are in periods of drive.strain_rate.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ScheduleTableKeys {
    /// Course in time: ramp takes from, to, start and end; steps and course take at and values.
    pub(crate) form: ScheduleFormName,
    /// The parameter that follows the schedule. Default: the amplitude of the drive (width under strain control,
    /// force_amplitude under stress control).
    pub(crate) parameter: Option<ScheduledParameterName>,
    /// Value of a ramp until start, in the unit of the parameter. Default: no drive (width 2 a, otherwise 0).
    #[schemars(extend("x-unit" = "that of the parameter", "minimum" = 0, "maximum" = 1e6))]
    pub(crate) from: Option<f64>,
    /// Value of a ramp from end on, in the unit of the parameter. Default: the parameter's own value.
    #[schemars(extend("x-unit" = "that of the parameter", "minimum" = 0, "maximum" = 1e6))]
    pub(crate) to: Option<f64>,
    /// When a ramp begins.
    #[schemars(extend("x-unit" = "periods", "minimum" = 0, "maximum" = 1e9, "default" = 0))]
    pub(crate) start: Option<f64>,
    /// When a ramp ends, after start.
    #[schemars(extend("x-unit" = "periods", "exclusiveMinimum" = 0, "maximum" = 1e9))]
    pub(crate) end: Option<f64>,
    /// Times of the values, ascending. With steps a value holds from its time on, and before the first the parameter has
    /// its own value. A course has a value at its time, and jumps where two times are equal.
    #[schemars(extend("x-unit" = "periods", "minItems" = 1, "items" = {"type": "number", "minimum": 0, "maximum": 1e9}))]
    pub(crate) at: Option<Vec<f64>>,
    /// Values of steps or of a course, one for each time of at, in the unit of the parameter.
    #[schemars(extend("x-unit" = "that of the parameter", "minItems" = 1, "items" = {"type": "number", "minimum": 0, "maximum": 1e6}))]
    pub(crate) values: Option<Vec<f64>>,
}

/// Schedule of the drive by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(crate) enum ScheduleName {
    /// The drive has its values from t = 0 on.
    Sudden,
    /// The amplitude grows linearly from nothing to its value within drive.ramp_periods.
    Ramp,
}

/// Course of a scheduled parameter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(crate) enum ScheduleFormName {
    /// Linear in time between start and end, constant before and after.
    #[default]
    Ramp,
    /// Constant between the times given.
    Steps,
    /// Linear in time from each value to the next, constant before the first and after the last.
    Course,
}

/// A parameter of the drive that may follow a schedule.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(crate) enum ScheduledParameterName {
    /// drive.width (strain control).
    Width,
    /// drive.amplitude (strain control).
    Amplitude,
    /// drive.force_amplitude (stress control).
    ForceAmplitude,
    /// drive.strain_rate.
    StrainRate,
    /// drive.wave_speed.
    WaveSpeed,
}

/// What the units m, d and t are in SI: grain_diameter, density, and by contact.law stiffness (linear) or young_modulus
/// (hertz), all three or none. Results are then also given in kg, m, s, Pa and W; the trajectory does not depend on them.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(default)]
pub(crate) struct UnitsKeys {
    /// The unit of length d: diameter of a grain whose diameter is 1 in the other tables.
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0, "maximum" = 1e6))]
    pub(crate) grain_diameter: Option<f64>,
    /// What the grains are made of: stands for units.density, contact.static_friction and kinetic_friction, the restitution
    /// (contact.restitution), and under contact.law = "hertz" for contact.poisson_ratio and units.young_modulus. They
    /// replace the values of a preset, except a Young's modulus. Values that the same file gives, or a later setting, replace
    /// them. Grains as hard as the material take long: give a smaller modulus.
    #[serde(rename = "material")]
    #[schemars(extend("default" = null))]
    pub(crate) _material: Option<String>,
    /// Density of the grains' material. The unit of mass is m = pi density d^3/6.
    #[schemars(extend("x-unit" = "kg m^-3", "exclusiveMinimum" = 0, "maximum" = 1e6))]
    pub(crate) density: Option<f64>,
    /// Stiffness of a contact in SI. With contact.normal_stiffness it fixes the unit of time, sqrt(m/k) for k = 1.
    #[schemars(extend("x-unit" = "N m^-1", "exclusiveMinimum" = 0, "maximum" = 1e15))]
    pub(crate) stiffness: Option<f64>,
    /// Young's modulus in SI. With contact.young_modulus it fixes the unit of time, sqrt(m/(Y d)) for Y = 1.
    #[schemars(extend("x-unit" = "Pa", "exclusiveMinimum" = 0, "maximum" = 1e15))]
    pub(crate) young_modulus: Option<f64>,
    /// Frequency of the wave, c/lambda. Give it instead of drive.strain_rate or drive.wave_speed: with those the wave in SI
    /// gets faster when stiffness or young_modulus grows.
    #[schemars(extend("x-unit" = "Hz", "minimum" = 0, "maximum" = 1e9))]
    pub(crate) wave_frequency: Option<f64>,
    /// Gravity [x, y, z] in SI, instead of body.gravity: [0, -9.81, 0] is a horizontal tube on Earth.
    #[schemars(extend("x-unit" = "m s^-2", "items" = {"type": "number", "minimum": -1e9, "maximum": 1e9}))]
    pub(crate) acceleration: Option<[f64; 3]>,
    /// The force that parts two grains of diameter 1 under linear cohesion, instead of contact.cohesion_force.
    #[schemars(extend("x-unit" = "N", "minimum" = 0, "maximum" = 1e9))]
    pub(crate) cohesion_force: Option<f64>,
    /// Surface energy gamma of JKR cohesion, half the work of adhesion, instead of contact.surface_energy. Dry glass has some
    /// 0.05; grains that are softer in the computation than in reality cling more.
    #[schemars(extend("x-unit" = "J m^-2", "minimum" = 0, "maximum" = 1e6))]
    pub(crate) surface_energy: Option<f64>,
    /// Mass that the inlet of an open tube takes in an hour, instead of inlet.feed_rate.
    #[schemars(extend("x-unit" = "kg h^-1", "minimum" = 0, "maximum" = 1e12))]
    pub(crate) feed_rate: Option<f64>,
}
