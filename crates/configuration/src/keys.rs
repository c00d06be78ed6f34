//! The keys of the TOML form as they are written, each with its meaning, unit, default and range.
//!
//! The documentation here is the documentation of the JSON schema; `x-unit` is added to it, and the ranges are what
//! the reader enforces. m, d and t are the units of mass, length and time; "1" marks a pure number.

use schemars::JsonSchema;
use serde::Deserialize;

use crate::defaults;
use crate::options::{
    ControlName, DissipationForm, DriveAngle, InitialState, Integrator, Kernel, NetForce,
    NormalLawName, ScheduleFormName, ScheduleName, ScheduledParameterName, Sliding, WaveDirection,
    Waveform,
};

/// Configuration of one simulation of grains in a peristaltic tube.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct Keys {
    pub(crate) grains: GrainsKeys,
    pub(crate) contact: ContactKeys,
    pub(crate) tube: TubeKeys,
    pub(crate) drive: DriveKeys,
    pub(crate) wall: WallKeys,
    pub(crate) initial: InitialKeys,
    pub(crate) run: RunKeys,
    pub(crate) observe: ObserveKeys,
    pub(crate) units: UnitsKeys,
}

/// The grains: how many and how large. Exactly one of number, volume_fraction and number_density is given.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct GrainsKeys {
    /// Number of grains N in the whole tube.
    #[schemars(extend("x-unit" = "1", "minimum" = 0, "maximum" = defaults::MOST_GRAINS))]
    pub(crate) number: Option<u64>,
    /// Volume fraction rho = N d^3/(6 a^2 L) of grains in a straight tube of radius a and length L, d^3 averaged over
    /// the diameters; N is rounded to the nearest whole number.
    #[schemars(extend("x-unit" = "1", "minimum" = 0, "maximum" = 10))]
    pub(crate) volume_fraction: Option<f64>,
    /// Number density n = N d*^3/(pi a^2 L), d* the largest grain diameter; N is rounded to the nearest whole number.
    #[schemars(extend("x-unit" = "1", "minimum" = 0, "maximum" = 10))]
    pub(crate) number_density: Option<f64>,
    /// Smallest grain diameter; diameters are uniformly distributed and the mass of a grain is its diameter cubed.
    #[schemars(extend("x-unit" = "d", "exclusiveMinimum" = 0, "maximum" = 1e6, "default" = defaults::DIAMETER))]
    pub(crate) diameter_min: Option<f64>,
    /// Largest grain diameter, not below diameter_min.
    #[schemars(extend("x-unit" = "d", "exclusiveMinimum" = 0, "maximum" = 1e6, "default" = defaults::DIAMETER))]
    pub(crate) diameter_max: Option<f64>,
}

/// The contact of two spheres, grain or wall.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct ContactKeys {
    /// Normal contact law: linear takes normal_stiffness and normal_damping, hertz takes young_modulus, poisson_ratio,
    /// dissipation_time and dissipation_form; friction goes with both.
    pub(crate) law: Option<NormalLawName>,
    /// Stiffness k of the linear law, f_n = k xi - eta v_n.
    #[schemars(extend("x-unit" = "m t^-2", "exclusiveMinimum" = 0, "maximum" = 1e12, "default" = defaults::NORMAL_STIFFNESS))]
    pub(crate) normal_stiffness: Option<f64>,
    /// Damping eta of the linear law.
    #[schemars(extend("x-unit" = "m t^-1", "minimum" = 0, "maximum" = 1e12, "default" = defaults::NORMAL_DAMPING))]
    pub(crate) normal_damping: Option<f64>,
    /// Young's modulus Y of the Hertz law, f_n = 2 Y sqrt(R)/(3 (1 - nu^2)) (xi^(3/2) - A sqrt(xi) v_n).
    #[schemars(extend("x-unit" = "m d^-1 t^-2", "exclusiveMinimum" = 0, "maximum" = 1e12, "default" = defaults::YOUNG_MODULUS))]
    pub(crate) young_modulus: Option<f64>,
    /// Poisson's ratio nu of the Hertz law.
    #[schemars(extend("x-unit" = "1", "exclusiveMinimum" = -1, "maximum" = 0.5, "default" = defaults::POISSON_RATIO))]
    pub(crate) poisson_ratio: Option<f64>,
    /// Dissipation time A of the Hertz law.
    #[schemars(extend("x-unit" = "t", "minimum" = 0, "maximum" = 1e12, "default" = defaults::DISSIPATION_TIME))]
    pub(crate) dissipation_time: Option<f64>,
    /// Factor of the damping of the Hertz law: 1 as printed, 3/2 for the standard viscoelastic sphere.
    #[schemars(extend("default" = "viscoelastic"))]
    pub(crate) dissipation_form: Option<DissipationForm>,
    /// Tangential stiffness k_t, f_t = -k_t u - eta_t v_t below the Coulomb limit. Without effect while both frictions
    /// are 0.
    #[schemars(extend("x-unit" = "m t^-2", "exclusiveMinimum" = 0, "maximum" = 1e12, "default" = defaults::TANGENTIAL_STIFFNESS))]
    pub(crate) tangential_stiffness: Option<f64>,
    /// Tangential damping eta_t. Without effect while both frictions are 0.
    #[schemars(extend("x-unit" = "m t^-1", "minimum" = 0, "maximum" = 1e12, "default" = defaults::TANGENTIAL_DAMPING))]
    pub(crate) tangential_damping: Option<f64>,
    /// Static friction mu_s: a contact sticks while |f_t| < mu_s f_n. If only kinetic_friction is given, equal to it;
    /// with both 0 grains are frictionless and do not rotate.
    #[schemars(extend("x-unit" = "1", "minimum" = 0, "maximum" = 1e6, "default" = 0))]
    pub(crate) static_friction: Option<f64>,
    /// Kinetic friction mu_k, not above static_friction. If only static_friction is given, equal to it.
    #[schemars(extend("x-unit" = "1", "minimum" = 0, "maximum" = 1e6, "default" = 0))]
    pub(crate) kinetic_friction: Option<f64>,
    /// What becomes of the tangential displacement while a contact slides. Without effect while both frictions are 0.
    #[schemars(extend("default" = "spring"))]
    pub(crate) sliding: Option<Sliding>,
}

/// The tube: a lattice of wall spheres in staggered rings, periodic along its axis.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct TubeKeys {
    /// Mean radius a, to the centres of the wall spheres.
    #[schemars(extend("x-unit" = "d", "exclusiveMinimum" = 0, "maximum" = 1e6))]
    pub(crate) radius: Option<f64>,
    /// Wavelength lambda.
    #[schemars(extend("x-unit" = "d", "exclusiveMinimum" = 0, "maximum" = 1e6))]
    pub(crate) wavelength: Option<f64>,
    /// Number of waves in the tube; its length is L = waves * wavelength.
    #[schemars(extend("x-unit" = "1", "minimum" = 1, "maximum" = 1_000_000))]
    pub(crate) waves: Option<u32>,
    /// Wall spheres in a ring.
    #[schemars(extend("x-unit" = "1", "minimum" = 3, "maximum" = 1_000_000))]
    pub(crate) spheres_per_ring: Option<u32>,
    /// Rings in a wavelength, alternate rings turned by half a spacing: even under strain control; under stress control
    /// an odd number needs an even number of waves.
    #[schemars(extend("x-unit" = "1", "minimum" = 1, "maximum" = 1_000_000))]
    pub(crate) rings_per_wave: Option<u32>,
}

/// The travelling wave that drives the grains. Exactly one of strain_rate, wave_speed and units.wave_frequency is given;
/// under strain control exactly one of width and amplitude, under stress control force_amplitude.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct DriveKeys {
    /// What of the wall is prescribed: its radius (strain) or the radial force on its spheres (stress).
    pub(crate) control: Option<ControlName>,
    /// Width of the bottleneck w = 2 (a - b) between the centres of wall spheres, at most 2 a; strain control.
    #[schemars(extend("x-unit" = "d", "minimum" = 0))]
    pub(crate) width: Option<f64>,
    /// Amplitude b of the radius R = a + b g((c t + z)/lambda), g the waveform, at most a; strain control.
    #[schemars(extend("x-unit" = "d", "minimum" = 0))]
    pub(crate) amplitude: Option<f64>,
    /// Amplitude f^P of the radial force on each wall sphere; stress control.
    #[schemars(extend("x-unit" = "m d t^-2", "minimum" = 0, "maximum" = 1e6))]
    pub(crate) force_amplitude: Option<f64>,
    /// Strain rate c/lambda, one over the wave's period; 0 is a static wave and needs run.duration.
    #[schemars(extend("x-unit" = "t^-1", "minimum" = 0, "maximum" = 1e6))]
    pub(crate) strain_rate: Option<f64>,
    /// Speed c of the wave; 0 is a static wave and needs run.duration.
    #[schemars(extend("x-unit" = "d t^-1", "minimum" = 0, "maximum" = 1e6))]
    pub(crate) wave_speed: Option<f64>,
    /// Shape of the wave.
    #[schemars(extend("default" = "sine"))]
    pub(crate) waveform: Option<Waveform>,
    /// Body force on the grains g, force over mass along the wave: negative is back pressure, against which the wave has to
    /// pump. With grains of several sizes it acts as gravity along the tube. The pressure rise over a wavelength that it
    /// stands for is N m (-g) lambda/(L pi a^2).
    #[schemars(extend("x-unit" = "d t^-2", "minimum" = -1e6, "maximum" = 1e6, "default" = 0))]
    pub(crate) body_force: Option<f64>,
    /// Which way the wave runs: forward is towards -z under strain control and towards +z under stress control, as the
    /// source writes them. Flow rates are positive along the wave in either case.
    #[schemars(extend("default" = "forward"))]
    pub(crate) direction: Option<WaveDirection>,
    /// Angle that fixes the radial direction of the force on a wall sphere; stress control.
    #[schemars(extend("default" = "reference"))]
    pub(crate) angle: Option<DriveAngle>,
    /// How the drive's parameters follow time: "sudden" (constant from t = 0), "ramp" (the amplitude grows from nothing
    /// within ramp_periods), a table such as { form = "ramp", parameter = "width", from = 3.0, to = 2.6, end = 100 } or
    /// { form = "steps", parameter = "width", at = [0, 100], values = [2.9, 2.7] }, in which "course" instead of "steps"
    /// goes from value to value in straight lines, or a list of such tables, not an empty one.
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
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ScheduleTableKeys {
    /// Course in time: ramp takes from, to, start and end; steps and course take at and values.
    pub(crate) form: ScheduleFormName,
    /// The parameter that follows the schedule. Missing: the amplitude of the drive (width under strain control,
    /// force_amplitude under stress control).
    pub(crate) parameter: Option<ScheduledParameterName>,
    /// Value of a ramp until start, in the unit of the parameter. Missing: no drive (width 2 a, otherwise 0).
    #[schemars(extend("x-unit" = "that of the parameter", "minimum" = 0, "maximum" = 1e6))]
    pub(crate) from: Option<f64>,
    /// Value of a ramp from end on, in the unit of the parameter. Missing: the parameter's own value.
    #[schemars(extend("x-unit" = "that of the parameter", "minimum" = 0, "maximum" = 1e6))]
    pub(crate) to: Option<f64>,
    /// When a ramp begins.
    #[schemars(extend("x-unit" = "periods", "minimum" = 0, "maximum" = 1e9, "default" = 0))]
    pub(crate) start: Option<f64>,
    /// When a ramp ends, after start.
    #[schemars(extend("x-unit" = "periods", "exclusiveMinimum" = 0, "maximum" = 1e9))]
    pub(crate) end: Option<f64>,
    /// When each of the values of steps begins to hold, or a course has it, ascending; before the first of steps the
    /// parameter has its own value. A course jumps where two of its times are equal.
    #[schemars(extend("x-unit" = "periods", "minItems" = 1, "items" = {"type": "number", "minimum": 0, "maximum": 1e9}))]
    pub(crate) at: Option<Vec<f64>>,
    /// The values of steps or of a course, as many as at, in the unit of the parameter.
    #[schemars(extend("x-unit" = "that of the parameter", "minItems" = 1, "items" = {"type": "number", "minimum": 0, "maximum": 1e6}))]
    pub(crate) values: Option<Vec<f64>>,
}

/// The wall. Under strain control its spheres only have a diameter; under stress control they are mobile, joined by
/// springs and kept by tethers.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct WallKeys {
    /// Diameter of a wall sphere.
    #[schemars(extend("x-unit" = "d", "exclusiveMinimum" = 0, "maximum" = 1e6, "default" = defaults::DIAMETER))]
    pub(crate) sphere_diameter: Option<f64>,
    /// Mass of a wall sphere; stress control.
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0, "maximum" = 1e12, "default" = defaults::WALL_SPHERE_MASS))]
    pub(crate) sphere_mass: Option<f64>,
    /// Stiffness k_w of the spring between lattice neighbours; stress control.
    #[schemars(extend("x-unit" = "m t^-2", "minimum" = 0, "maximum" = 1e12, "default" = defaults::WALL_SPRING_STIFFNESS))]
    pub(crate) spring_stiffness: Option<f64>,
    /// Natural length l of these springs; stress control. Missing: 0.7 of the mean distance of lattice neighbours. An
    /// unstretched network buckles: keep it below the distance of neighbours.
    #[schemars(extend("x-unit" = "d", "minimum" = 0, "maximum" = 1e6))]
    pub(crate) natural_length: Option<f64>,
    /// Wall spheres whose places in the straight tube are farther apart than this repel on contact, so that opposite
    /// sides of a throat do not pass through each other; stress control.
    #[schemars(extend("x-unit" = "d", "minimum" = 0, "maximum" = 1e6, "default" = defaults::WALL_CONTACT_RANGE))]
    pub(crate) contact_range: Option<f64>,
    /// Drag coefficient of a wall sphere against the laboratory, force -drag v; stress control.
    #[schemars(extend("x-unit" = "m t^-1", "minimum" = 0, "maximum" = 1e12, "default" = 0))]
    pub(crate) drag: Option<f64>,
    /// Damping of each spring along its length; stress control.
    #[schemars(extend("x-unit" = "m t^-1", "minimum" = 0, "maximum" = 1e12, "default" = 0))]
    pub(crate) spring_damping: Option<f64>,
    /// Forces that keep the elastic wall in place; stress control.
    pub(crate) keep: KeepKeys,
}

/// Forces that keep the elastic wall in place; stress control.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct KeepKeys {
    /// Whether a constant force on each wall sphere balances the springs in the straight tube.
    #[schemars(extend("default" = true))]
    pub(crate) balance: Option<bool>,
    /// Stiffness of the radial tether of a wall sphere to its place.
    #[schemars(extend("x-unit" = "m t^-2", "minimum" = 0, "maximum" = 1e12, "default" = 0))]
    pub(crate) radial: Option<f64>,
    /// Stiffness of the azimuthal tether of a wall sphere to its place.
    #[schemars(extend("x-unit" = "m t^-2", "minimum" = 0, "maximum" = 1e12, "default" = defaults::KEEP_AZIMUTHAL))]
    pub(crate) azimuthal: Option<f64>,
    /// Stiffness of the axial tether of a wall sphere to its place.
    #[schemars(extend("x-unit" = "m t^-2", "minimum" = 0, "maximum" = 1e12, "default" = defaults::KEEP_AXIAL))]
    pub(crate) axial: Option<f64>,
    /// What is done with the mean force on the wall at each step.
    #[schemars(extend("default" = "removed"))]
    pub(crate) net_force: Option<NetForce>,
}

/// The grains at t = 0.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct InitialKeys {
    /// How the grains stand at t = 0: spread over the tube at rest, or gathered in the bellies and moving with the
    /// wave.
    #[schemars(extend("default" = "rest"))]
    pub(crate) state: Option<InitialState>,
    /// Velocity of every grain along the wave at t = 0. Missing: 0 from rest, the wave's speed when jammed.
    #[schemars(extend("x-unit" = "d t^-1", "minimum" = -1e9, "maximum" = 1e9))]
    pub(crate) axial_velocity: Option<f64>,
}

/// The run. Exactly one of periods and duration is given.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct RunKeys {
    /// Length of the run in wave periods, rounded up to whole samples.
    #[schemars(extend("x-unit" = "periods", "exclusiveMinimum" = 0, "maximum" = 1e9))]
    pub(crate) periods: Option<f64>,
    /// Length of the run in time, rounded up to whole samples; the only choice for a static wave.
    #[schemars(extend("x-unit" = "t", "exclusiveMinimum" = 0, "maximum" = 1e12))]
    pub(crate) duration: Option<f64>,
    /// Longest time step allowed; the step taken divides the time between two samples.
    #[schemars(extend("x-unit" = "t", "exclusiveMinimum" = 0, "maximum" = 1e6, "default" = defaults::TIME_STEP))]
    pub(crate) time_step: Option<f64>,
    /// How the equations of motion are stepped.
    #[schemars(extend("default" = "verlet"))]
    pub(crate) integrator: Option<Integrator>,
    /// Which kernel computes the forces.
    #[schemars(extend("default" = "fast"))]
    pub(crate) kernel: Option<Kernel>,
    /// Seed of the random numbers that place the grains.
    #[schemars(extend("x-unit" = "1", "maximum" = i64::MAX, "default" = defaults::SEED))]
    pub(crate) seed: Option<u64>,
    /// Distance by which the neighbour search looks farther than contacts reach: it sets the speed, and the order of sums.
    /// Missing: 0.3 of the largest grain diameter.
    #[schemars(extend("x-unit" = "d", "exclusiveMinimum" = 0, "maximum" = 1e6))]
    pub(crate) neighbour_skin: Option<f64>,
}

/// What is measured.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct ObserveKeys {
    /// Samples of the time series in one wave period; a static run has 200 samples in all.
    #[schemars(extend("x-unit" = "1", "minimum" = 1, "maximum" = 1_000_000, "default" = defaults::SAMPLES_PER_PERIOD))]
    pub(crate) samples_per_period: Option<u32>,
    /// Bins of the profiles over one wavelength. The largest pressure on the wall is that of one of them.
    #[schemars(extend("x-unit" = "1", "minimum" = 1, "maximum" = 100_000, "default" = defaults::PROFILE_BINS))]
    pub(crate) profile_bins: Option<u32>,
    /// Part of the run, at its end, that late means and profiles are taken over.
    #[schemars(extend("x-unit" = "1", "exclusiveMinimum" = 0, "maximum" = 1, "default" = defaults::LATE_FRACTION))]
    pub(crate) late_fraction: Option<f64>,
    /// J/Jmax that the period average crosses at a transition, upward from rest and downward from jammed.
    #[schemars(extend("x-unit" = "1", "minimum" = -2, "maximum" = 2, "default" = defaults::TRANSITION_THRESHOLD))]
    pub(crate) transition_threshold: Option<f64>,
}

/// What the units m, d and t are in SI: grain_diameter, density, and by contact.law stiffness (linear) or young_modulus
/// (hertz), all three or none. Results are then also given in kg, m, s, Pa and W; the trajectory does not depend on them.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct UnitsKeys {
    /// Diameter of a grain whose diameter is 1 here: the unit of length d.
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0, "maximum" = 1e6))]
    pub(crate) grain_diameter: Option<f64>,
    /// Density of the grains' material; the unit of mass is that of a sphere of diameter d, m = pi density d^3/6.
    #[schemars(extend("x-unit" = "kg m^-3", "exclusiveMinimum" = 0, "maximum" = 1e6))]
    pub(crate) density: Option<f64>,
    /// Stiffness of a contact, what contact.normal_stiffness stands for: it fixes the unit of time, sqrt(m/k) for k = 1.
    #[schemars(extend("x-unit" = "N m^-1", "exclusiveMinimum" = 0, "maximum" = 1e15))]
    pub(crate) stiffness: Option<f64>,
    /// Young's modulus, what contact.young_modulus stands for: it fixes the unit of time, sqrt(m/(Y d)) for Y = 1.
    #[schemars(extend("x-unit" = "Pa", "exclusiveMinimum" = 0, "maximum" = 1e15))]
    pub(crate) young_modulus: Option<f64>,
    /// Frequency of the wave, c/lambda in SI; instead of drive.strain_rate and drive.wave_speed, with which the wave in SI
    /// follows stiffness or young_modulus.
    #[schemars(extend("x-unit" = "Hz", "minimum" = 0, "maximum" = 1e9))]
    pub(crate) wave_frequency: Option<f64>,
}
