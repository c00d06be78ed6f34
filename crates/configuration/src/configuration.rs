//! The resolved configuration: values that have passed every check.
//!
//! A field is a key of the TOML form: its documentation, unit, range and default are stated here, or where its type is
//! from `physics`, there. Schema, reader, errors, reference and canonical form follow.

use std::f64::consts::PI;

use peristalsis_physics::contact::ContactModel;
use peristalsis_physics::ends::{Ends, Inlet, STEPS_PER_LOOK};
use peristalsis_physics::method::{InitialState, Integrator, Kernel};
use peristalsis_physics::wall::{
    Arrangement, Contraction, DriveAngle, ElasticNetwork, RadiusTable, SegmentDrive, Segments,
    WaveDirection,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::grains::{Body, Grains};
use crate::schedule::{Schedule, ScheduledParameter};
use crate::units::Units;
use crate::waveform::WaveformName;

/// Everything that determines one run; alternatives of the TOML form are resolved to one value.
///
/// Units: mass m, diameter d, time t as on the page "Symbols, units, signs" of the book. Equal values make equal
/// runs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Configuration {
    /// The grains.
    pub grains: Grains,
    /// What acts on every grain.
    pub body: Body,
    /// The contact of two spheres, grain or wall.
    pub contact: ContactModel,
    /// The tube.
    pub tube: Tube,
    /// The travelling wave.
    pub drive: Drive,
    /// The wall.
    pub wall: Wall,
    /// The inlet of an open tube; `None` of a periodic one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub inlet: Option<Inlet>,
    /// The grains at t = 0.
    pub initial: Initial,
    /// Time: how long, in which steps.
    pub run: Run,
    /// What is measured.
    pub observe: Observe,
    /// What the units m, d, t are in SI, where that was said.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub units: Option<Units>,
}

/// The tube: wall spheres in rings or at random places. It is periodic along its axis, or its ends are open.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Tube {
    /// Radius a of the tube, to the centres of the wall spheres: the mean one of a sine, the largest of other waveforms. The
    /// wall's surface, also of a smooth wall, lies half of wall.sphere_diameter inside it.
    #[schemars(extend("x-unit" = "d", "exclusiveMinimum" = 0, "maximum" = 1e6))]
    pub radius: f64,
    /// Wavelength lambda.
    #[schemars(extend("x-unit" = "d", "exclusiveMinimum" = 0, "maximum" = 1e6))]
    pub wavelength: f64,
    /// Number of waves in the tube; its length is L = waves * wavelength.
    #[schemars(extend("x-unit" = "1", "minimum" = 1, "maximum" = 1_000_000))]
    pub waves: u32,
    /// How the tube ends.
    #[serde(default, skip_serializing_if = "Ends::is_periodic")]
    pub ends: Ends,
    /// How the wall spheres stand.
    #[serde(default)]
    pub arrangement: Arrangement,
    /// Seed of a random or disordered arrangement.
    #[serde(default = "first_seed")]
    #[schemars(extend("x-unit" = "1", "minimum" = 0))]
    pub arrangement_seed: u64,
    /// Angle of each wall sphere about the axis, from x towards y; under arrangement = "file".
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(extend("x-unit" = "rad", "items" = {"type": "number", "minimum": -1e6, "maximum": 1e6}))]
    pub angles: Vec<f64>,
    /// Place z of each wall sphere along the tube, from 0 to below L; under arrangement = "file".
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(extend("x-unit" = "d", "items" = {"type": "number", "minimum": 0, "maximum": 1e9}))]
    pub places: Vec<f64>,
    /// Wall spheres in a ring. A smooth wall has none: there the key is left out, and results show 0.
    #[schemars(extend("x-unit" = "1", "minimum" = 3, "maximum" = 1_000_000))]
    pub spheres_per_ring: u32,
    /// Rings in a wavelength. Staggered rings under strain control need an even number; under stress control an odd number
    /// needs an even number of waves. Random and disordered walls have as many spheres as so many rings would have; a wall
    /// from a file does not use it. A smooth wall has none: there the key is left out, and results show 0.
    #[schemars(extend("x-unit" = "1", "minimum" = 1, "maximum" = 1_000_000))]
    pub rings_per_wave: u32,
}

/// The default of [`Tube::arrangement_seed`].
pub(crate) const FIRST_SEED: u64 = 1;

fn first_seed() -> u64 {
    FIRST_SEED
}

impl Tube {
    /// Length L = (waves) lambda \[d\].
    pub fn length(&self) -> f64 {
        f64::from(self.waves) * self.wavelength
    }

    /// Wall spheres in the whole tube.
    pub fn wall_spheres(&self) -> u64 {
        match self.arrangement {
            Arrangement::File => return self.places.len() as u64,
            Arrangement::Smooth => return 0,
            _ => {}
        }
        u64::from(self.spheres_per_ring) * u64::from(self.rings_per_wave) * u64::from(self.waves)
    }

    /// About how many wall spheres a grain at the wall has within a distance \[d\] along the tube and around it.
    pub(crate) fn wall_spheres_within(&self, reach: f64) -> f64 {
        let one_of_a_ring = 1.0 / f64::from(self.spheres_per_ring);
        let around = (reach / (PI * self.radius)).min(1.0).max(one_of_a_ring);
        let along = (2.0 * reach / self.length()).min(1.0);
        self.wall_spheres() as f64 * along * around
    }

    /// Distances of lattice neighbours in the straight tube \[d\]: those in a ring, and those in rings side by side.
    pub fn neighbour_distances(&self) -> [f64; 2] {
        let spacing = self.wavelength / f64::from(self.rings_per_wave);
        let half_turn = PI / f64::from(self.spheres_per_ring);
        let in_ring = 2.0 * self.radius * libm::sin(half_turn);
        let chord = 2.0 * self.radius * libm::sin(0.5 * half_turn);
        [in_ring, (chord * chord + spacing * spacing).sqrt()]
    }

    /// Mean distance of lattice neighbours in the straight tube \[d\]: a sphere has two neighbours in its ring and four
    /// in the rings beside it.
    pub fn mean_neighbour_distance(&self) -> f64 {
        let [in_ring, between] = self.neighbour_distances();
        (2.0 * in_ring + 4.0 * between) / 6.0
    }
}

/// The travelling wave that drives the grains.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Drive {
    /// What is prescribed, and by how much.
    #[serde(flatten)]
    pub control: Control,
    /// Strain rate c/lambda, one over the wave's period; 0 is a static wave and needs run.duration.
    #[serde(default)]
    #[schemars(extend("x-unit" = "t^-1", "minimum" = 0, "maximum" = 1e6, "default" = null))]
    pub strain_rate: f64,
    /// Shape of the wave.
    #[serde(default)]
    pub waveform: WaveformName,
    /// Phases of the points of waveform = "table" in cycles, ascending from 0 on; 3 to 128 of them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(extend("x-unit" = "1", "items" = {"type": "number", "minimum": 0, "exclusiveMaximum": 1}))]
    pub phases: Vec<f64>,
    /// Radius at each phase. Only the shape counts: the largest becomes tube.radius, the least half of drive.width.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(extend("x-unit" = "1", "items" = {"type": "number", "minimum": 0, "maximum": 1e6}))]
    pub radii: Vec<f64>,
    /// The segments of waveform = "segments", otherwise `None`.
    #[serde(flatten)]
    pub segments: Option<SegmentDrive>,
    /// Which way the wave runs: forward is towards -z under strain control and towards +z under stress control, as the
    /// source writes them. Flow rates are positive along the wave in either case.
    #[serde(default)]
    pub direction: WaveDirection,
    /// Body force g on the grains, force over mass along the wave. Negative is back pressure, against which the wave has to
    /// pump. body.gravity adds to it. Both together stand for a pressure rise over a wavelength of
    /// N m (-g) lambda/(L pi a^2).
    #[serde(default)]
    #[schemars(extend("x-unit" = "d t^-2", "minimum" = -1e6, "maximum" = 1e6))]
    pub body_force: f64,
    /// Parameters that follow time, each at most once; empty: all are constant from t = 0 on. In the order of
    /// [`ScheduledParameter`](crate::ScheduledParameter).
    #[serde(skip)]
    pub schedules: Vec<Schedule>,
}

impl Drive {
    /// How a wavelength of the tube is squeezed.
    pub fn contraction(&self) -> Contraction {
        let segments = self.segments.as_ref().and_then(Segments::new);
        let table = RadiusTable::new(&self.phases, &self.radii).ok();
        let table = table.map(Contraction::Table);
        let wave = || self.waveform.travelling().unwrap_or_default().into();
        let segments = segments.map(Contraction::Segments);
        segments.or(table).unwrap_or_else(wave)
    }

    /// Period of the wave T = lambda/c \[t\]; `None` for a static wave.
    pub fn period(&self) -> Option<f64> {
        (self.strain_rate > 0.0).then(|| 1.0 / self.strain_rate)
    }

    /// A parameter's own value, which its schedule may lead elsewhere; `None` for the amplitude of the other control.
    pub fn own(&self, parameter: ScheduledParameter) -> Option<f64> {
        match (parameter, self.control.amplitude()) {
            (ScheduledParameter::StrainRate, _) => Some(self.strain_rate),
            (asked, (own, value)) => (asked == own).then_some(value),
        }
    }

    /// The schedule of a parameter, if it has one.
    pub fn schedule(&self, parameter: ScheduledParameter) -> Option<&Schedule> {
        let mut schedules = self.schedules.iter();
        schedules.find(|schedule| schedule.parameter == parameter)
    }
}

/// Whether the radius of the wall is prescribed (strain) or the radial force on its spheres (stress).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "control", rename_all = "snake_case")]
pub enum Control {
    /// The radius of the wall, R(z, t).
    Strain {
        /// Width of the bottleneck w = 2 (a - b) between the centres of wall spheres, at most 2 a; strain control.
        #[serde(default)]
        #[schemars(extend("x-unit" = "d", "minimum" = 0, "default" = null))]
        width: f64,
    },
    /// The radial force on each sphere of an elastic wall.
    Stress {
        /// Amplitude f^P of the radial force on each wall sphere; stress control.
        #[schemars(extend("x-unit" = "m d t^-2", "minimum" = 0, "maximum" = 1e6))]
        force_amplitude: f64,
        /// Angle that fixes the radial direction of the force on a wall sphere; stress control.
        #[serde(default)]
        angle: DriveAngle,
    },
}

impl Control {
    /// The parameter that gives the amplitude of the wave, and its value.
    pub fn amplitude(self) -> (ScheduledParameter, f64) {
        match self {
            Self::Strain { width } => (ScheduledParameter::Width, width),
            Self::Stress {
                force_amplitude, ..
            } => (ScheduledParameter::ForceAmplitude, force_amplitude),
        }
    }
}

/// The wall. Under strain control its spheres only have a diameter; under stress control they are mobile, joined by
/// springs and kept by tethers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Wall {
    /// Diameter d_w of a wall sphere. The surface of the wall lies d_w/2 inside the tube's radius, so that the clear opening
    /// of the bottleneck is w - d_w. Under arrangement = "smooth" it is the same offset, and may be 0.
    #[schemars(extend("x-unit" = "d", "minimum" = 0, "maximum" = 1e6))]
    pub sphere_diameter: f64,
    /// What a wall under stress control has besides; `None` under strain control.
    #[serde(flatten)]
    pub elastic: Option<ElasticNetwork>,
}

impl Default for Wall {
    fn default() -> Self {
        Self {
            sphere_diameter: 1.0,
            elastic: None,
        }
    }
}

/// The grains at t = 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Initial {
    /// How the grains stand at t = 0: spread over the tube at rest, settled under gravity, or gathered in the bellies and
    /// moving with the wave. Only a program can place them otherwise.
    pub state: InitialState,
    /// Velocity of every grain along the wave at t = 0. Default: 0 from rest, the wave's speed at t = 0 from jammed.
    #[schemars(extend("x-unit" = "d t^-1", "minimum" = -1e9, "maximum" = 1e9, "default" = null))]
    pub axial_velocity: f64,
    /// Granular temperature at t = 0: besides the velocity along the wave every component of a grain's velocity is drawn
    /// from a normal distribution of variance temperature/mass.
    #[schemars(extend("x-unit" = "m d^2 t^-2", "minimum" = 0, "maximum" = 1e6))]
    pub temperature: f64,
}

/// The run. Exactly one of periods and duration is given.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Run {
    /// Length of the run in periods of drive.strain_rate, rounded up to whole samples. Where a schedule changes the strain
    /// rate, the wave runs more or fewer wavelengths (column period).
    #[schemars(extend("x-unit" = "periods", "exclusiveMinimum" = 0, "maximum" = 1e9))]
    pub periods: Option<f64>,
    /// Length of the run in time, rounded up to whole samples; the only choice for a static wave.
    #[schemars(extend("x-unit" = "t", "exclusiveMinimum" = 0, "maximum" = 1e12, "default" = null))]
    pub duration: f64,
    /// Largest time step allowed. The step is chosen so that a whole number of steps lies between two samples.
    #[schemars(extend("x-unit" = "t", "exclusiveMinimum" = 0, "maximum" = 1e6))]
    pub time_step: f64,
    /// Steps from one sample to the next.
    #[serde(skip)]
    pub steps_per_sample: u64,
    /// Samples after the one at t = 0.
    #[serde(skip)]
    pub samples: u64,
    /// How the equations of motion are stepped.
    pub integrator: Integrator,
    /// Which kernel computes the forces.
    pub kernel: Kernel,
    /// Seed of the random numbers of the grains: their places, diameters, initial temperature and choice of place at an inlet.
    #[schemars(extend("x-unit" = "1", "maximum" = i64::MAX))]
    pub seed: u64,
    /// How much farther the neighbour search looks than contacts reach. It changes speed and rounding, not the physics.
    /// Default: 0.3 of the largest grain diameter.
    #[schemars(extend("x-unit" = "d", "exclusiveMinimum" = 0, "maximum" = 1e6, "default" = null))]
    pub neighbour_skin: f64,
}

impl Default for Run {
    fn default() -> Self {
        Self {
            periods: None,
            duration: 0.0,
            time_step: 0.05,
            steps_per_sample: 0,
            samples: 0,
            integrator: Integrator::Verlet,
            kernel: Kernel::Fast,
            seed: 1,
            neighbour_skin: 0.3,
        }
    }
}

impl Run {
    /// Steps of the whole run.
    pub fn steps(&self) -> u64 {
        self.samples * self.steps_per_sample
    }
}

/// What is measured.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Observe {
    /// Samples of the time series in one period of the wave; with a static wave, 200 in the whole run. Beyond 262,144
    /// samples every two neighbours become one, so that memory is bounded.
    #[schemars(extend("x-unit" = "1", "minimum" = 1, "maximum" = 1_000_000))]
    pub samples_per_period: u32,
    /// Bins of the profiles over one wavelength. The largest pressure on the wall is the largest of any bin: it grows
    /// with the number of bins.
    #[schemars(extend("x-unit" = "1", "minimum" = 1, "maximum" = 100_000))]
    pub profile_bins: u32,
    /// Part of the run, at its end, over which late means and profiles are taken.
    #[schemars(extend("x-unit" = "1", "exclusiveMinimum" = 0, "maximum" = 1))]
    pub late_fraction: f64,
    /// J/Jmax that the average over a period crosses at a transition. From rest (J/Jmax = 0) it is crossed upward, or
    /// downward if it is below 0; from jammed (J/Jmax = 1) downward, or upward if it is above 1.
    #[schemars(extend("x-unit" = "1", "minimum" = -2, "maximum" = 2))]
    pub transition_threshold: f64,
}

impl Default for Observe {
    fn default() -> Self {
        Self {
            samples_per_period: 20,
            profile_bins: 50,
            late_fraction: 0.25,
            transition_threshold: 0.5,
        }
    }
}

/// Time from one filling of an inlet to the next where the wave stands \[t\].
const TIME_TO_FILL: f64 = 2.0;

impl Configuration {
    /// Volume fraction of a straight tube: rho = N d^3/(6 a^2 L), d^3 averaged.
    pub fn volume_fraction(&self) -> f64 {
        let Tube { radius, .. } = self.tube;
        self.grains.number as f64 * self.grains.mean_cubed_diameter()
            / (6.0 * radius * radius * self.tube.length())
    }

    /// Standard deviation of the volume fraction between seeds; `None` where all grains have one size.
    ///
    /// rho ((<d^6>/<d^3>^2 - 1)/N)^(1/2): the diameters of N grains are drawn independently.
    pub fn volume_fraction_scatter(&self) -> Option<f64> {
        let sizes = self.grains.distribution();
        let variance = sizes.mean(6) / sizes.mean(3).powi(2) - 1.0;
        let scatter = self.volume_fraction() * (variance / self.grains.number as f64).sqrt();
        (scatter > 1e-9).then_some(scatter)
    }

    /// Number density n = N d*^3/(pi a^2 L), d* the largest diameter.
    pub fn number_density(&self) -> f64 {
        let largest = self.grains.diameter_max;
        let volume = PI * self.tube.radius * self.tube.radius * self.tube.length();
        self.grains.number as f64 * largest * largest * largest / volume
    }

    /// Whether contacts are kept from step to step: with friction or cohesion, or in an elastic tube.
    pub fn remembers_contacts(&self) -> bool {
        let contact = &self.contact;
        contact.friction.is_some() || contact.cohesion.is_some() || self.wall.elastic.is_some()
    }

    /// About how many wall spheres a grain at the wall meets at once.
    pub fn wall_spheres_in_reach(&self) -> f64 {
        let reach = self.grains.diameter_max.max(self.wall.sphere_diameter);
        self.tube.wall_spheres_within(reach)
    }

    /// Speed of the wave c \[d t^-1\].
    pub fn wave_speed(&self) -> f64 {
        self.drive.strain_rate * self.tube.wavelength
    }

    /// +1 for a wave towards +z, -1 towards -z: the source's strain-controlled wave runs towards -z.
    pub fn heading(&self) -> f64 {
        let along = match self.drive.direction {
            WaveDirection::Forward => 1.0,
            WaveDirection::Backward => -1.0,
        };
        match self.drive.control {
            Control::Strain { .. } => -along,
            Control::Stress { .. } => along,
        }
    }

    /// Whether gravity or the drive's body force acts on the grains.
    pub fn has_body_force(&self) -> bool {
        self.drive.body_force != 0.0 || self.body != Body::default()
    }

    /// Force over mass on the grains along the wave: the drive's body force and that part of gravity \[d t^-2\].
    pub fn axial_body_force(&self) -> f64 {
        self.drive.body_force + self.heading() * self.body.gravity[2]
    }

    /// Mean mass of a grain, from the mean of its cubed diameter \[m\].
    pub fn mean_grain_mass(&self) -> f64 {
        self.grains.mean_cubed_diameter()
    }

    /// Pressure rise over one wavelength that the wave has to pump against \[m d^-1 t^-2\]: the weight of the grains of a
    /// wavelength under [`Configuration::axial_body_force`] g over the section of the straight tube, Dp = -N m g lambda/(L pi a^2).
    pub fn pressure_rise(&self) -> f64 {
        let Tube {
            radius, wavelength, ..
        } = self.tube;
        let weight = self.grains.number as f64 * self.mean_grain_mass() * self.axial_body_force();
        // One zero, not two.
        0.0 - weight * wavelength / (self.tube.length() * PI * radius * radius)
    }

    /// Amplitude b = a - w/2 of the wall's radius \[d\]; `None` under stress control.
    pub fn amplitude(&self) -> Option<f64> {
        let width = self.drive.own(ScheduledParameter::Width)?;
        Some(self.tube.radius - 0.5 * width)
    }

    /// Looks at the ends of an open tube from one at which the inlet fills up to the next: about the time in which the wave
    /// runs one d, or 2 t where it stands, so that no result depends on the length of a step. 1 with a feed rate.
    pub fn looks_per_feeding(&self) -> u64 {
        let fills_up = self.inlet.is_some_and(|inlet| inlet.feed_rate.is_none());
        let interval = match self.wave_speed() {
            0.0 => TIME_TO_FILL,
            speed => 1.0 / speed,
        };
        let looks = interval / (STEPS_PER_LOOK as f64 * self.run.time_step);
        if fills_up {
            looks.round().max(1.0) as u64
        } else {
            1
        }
    }

    /// Speed of the wave at t = 0 \[d t^-1\]: a schedule may have led it away from [`wave_speed`](Self::wave_speed).
    pub fn initial_wave_speed(&self) -> f64 {
        match self.drive.schedule(ScheduledParameter::StrainRate) {
            Some(schedule) => schedule.value(0.0) * self.tube.wavelength,
            None => self.wave_speed(),
        }
    }

    /// Velocity along the wave that the initial state has of itself, in a wave of a speed \[d t^-1\].
    pub fn natural_axial_velocity(&self, wave_speed: f64) -> f64 {
        match self.initial.state {
            InitialState::Rest | InitialState::Settled | InitialState::Placed => 0.0,
            InitialState::Jammed => wave_speed,
        }
    }
}
