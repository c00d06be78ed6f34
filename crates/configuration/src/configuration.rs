//! The resolved configuration: plain values that have passed every check.

use std::f64::consts::PI;

use crate::options::{
    DissipationForm, DriveAngle, InitialState, Integrator, Kernel, NetForce, Sliding,
    WaveDirection, Waveform,
};
use crate::schedule::{Schedule, ScheduledParameter};
use crate::units::Units;

/// Everything that determines one run; what is alternative in TOML is resolved to one value.
///
/// Units: mass m, diameter d, time t as in CONVENTIONS. Two configurations with the same values here run the same.
#[derive(Clone, Debug, PartialEq)]
pub struct Configuration {
    /// The grains.
    pub grains: Grains,
    /// The contact of two spheres.
    pub contact: Contact,
    /// The tube.
    pub tube: Tube,
    /// The travelling wave.
    pub drive: Drive,
    /// The spheres of the wall.
    pub wall: Wall,
    /// The grains at t = 0.
    pub initial: Initial,
    /// Time: how long, in which steps.
    pub run: Run,
    /// What is measured.
    pub observe: Observe,
    /// What the units m, d, t are in SI, where that was said.
    pub units: Option<Units>,
}

/// The grains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grains {
    /// N, in the whole tube.
    pub number: u64,
    /// Smallest diameter \[d\].
    pub diameter_min: f64,
    /// Largest diameter \[d\], not below `diameter_min`.
    pub diameter_max: f64,
}

impl Grains {
    /// Mean of the cubed diameter over uniformly distributed diameters \[d^3\]:
    /// (d_min + d_max) (d_min^2 + d_max^2)/4
    #[must_use]
    pub fn mean_cubed_diameter(&self) -> f64 {
        let (least, most) = (self.diameter_min, self.diameter_max);
        (least + most) * (least * least + most * most) / 4.0
    }
}

/// The contact of two spheres: a normal law, and friction or none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Normal law.
    pub normal: NormalLaw,
    /// Tangential law; without it grains do not rotate.
    pub friction: Option<Friction>,
}

/// Normal contact law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NormalLaw {
    /// f_n = k xi - eta v_n
    Linear {
        /// k \[m t^-2\], positive.
        normal_stiffness: f64,
        /// eta \[m t^-1\], 0 or more.
        normal_damping: f64,
    },
    /// f_n = 2 Y sqrt(R)/(3 (1 - nu^2)) (xi^(3/2) - A sqrt(xi) v_n), A times 3/2 in the viscoelastic form
    Hertz {
        /// Y \[m d^-1 t^-2\], positive.
        young_modulus: f64,
        /// nu, above -1, at most 1/2.
        poisson_ratio: f64,
        /// A \[t\], 0 or more.
        dissipation_time: f64,
        /// Factor of A.
        dissipation_form: DissipationForm,
    },
}

/// Tangential contact law of Cundall and Strack.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    /// k_t \[m t^-2\], positive.
    pub tangential_stiffness: f64,
    /// eta_t \[m t^-1\], 0 or more.
    pub tangential_damping: f64,
    /// mu_s, positive.
    pub static_friction: f64,
    /// mu_k, 0 or more, not above mu_s.
    pub kinetic_friction: f64,
    /// What the tangential displacement does while the contact slides.
    pub sliding: Sliding,
}

/// The tube and the lattice of its wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tube {
    /// a \[d\], to the centres of the wall spheres.
    pub radius: f64,
    /// lambda \[d\].
    pub wavelength: f64,
    /// Waves in the tube.
    pub waves: u32,
    /// Wall spheres in a ring.
    pub spheres_per_ring: u32,
    /// Rings in a wavelength; the number of rings in the tube is even.
    pub rings_per_wave: u32,
}

impl Tube {
    /// Length L = (waves) lambda \[d\].
    #[must_use]
    pub fn length(&self) -> f64 {
        f64::from(self.waves) * self.wavelength
    }

    /// Wall spheres in the whole tube.
    #[must_use]
    pub fn wall_spheres(&self) -> u64 {
        u64::from(self.spheres_per_ring) * u64::from(self.rings_per_wave) * u64::from(self.waves)
    }

    /// Distances of lattice neighbours in the straight tube \[d\]: those in a ring, and those in rings side by side.
    #[must_use]
    pub fn neighbour_distances(&self) -> [f64; 2] {
        let spacing = self.wavelength / f64::from(self.rings_per_wave);
        let half_turn = PI / f64::from(self.spheres_per_ring);
        let in_ring = 2.0 * self.radius * libm::sin(half_turn);
        let chord = 2.0 * self.radius * libm::sin(0.5 * half_turn);
        [in_ring, (chord * chord + spacing * spacing).sqrt()]
    }

    /// Mean distance of lattice neighbours in the straight tube \[d\]: a sphere has two neighbours in its ring and four
    /// in the rings beside it.
    #[must_use]
    pub fn mean_neighbour_distance(&self) -> f64 {
        let [in_ring, between] = self.neighbour_distances();
        (2.0 * in_ring + 4.0 * between) / 6.0
    }
}

/// The travelling wave of contraction.
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    /// What is prescribed, and by how much.
    pub control: Control,
    /// c/lambda \[t^-1\]; 0 is a static wave.
    pub strain_rate: f64,
    /// Shape of the wave.
    pub waveform: Waveform,
    /// g, body force on the grains: force over mass along the wave, negative against it \[d t^-2\].
    pub body_force: f64,
    /// Which way it runs; forward is towards -z under strain control, towards +z under stress control.
    pub direction: WaveDirection,
    /// Parameters that follow time, each at most once; empty: all are constant from t = 0 on. In the order of
    /// [`ScheduledParameter`](crate::ScheduledParameter).
    pub schedules: Vec<Schedule>,
}

impl Drive {
    /// Period of the wave T = lambda/c \[t\]; `None` for a static wave.
    #[must_use]
    pub fn period(&self) -> Option<f64> {
        (self.strain_rate > 0.0).then(|| 1.0 / self.strain_rate)
    }

    /// A parameter's own value, which its schedule may lead elsewhere; `None` for the amplitude of the other control.
    #[must_use]
    pub fn own(&self, parameter: ScheduledParameter) -> Option<f64> {
        match (parameter, self.control) {
            (ScheduledParameter::StrainRate, _) => Some(self.strain_rate),
            (ScheduledParameter::Width, Control::Strain { width }) => Some(width),
            (
                ScheduledParameter::ForceAmplitude,
                Control::Stress {
                    force_amplitude, ..
                },
            ) => Some(force_amplitude),
            _ => None,
        }
    }

    /// The schedule of a parameter, if it has one.
    #[must_use]
    pub fn schedule(&self, parameter: ScheduledParameter) -> Option<&Schedule> {
        self.schedules
            .iter()
            .find(|schedule| schedule.parameter == parameter)
    }
}

/// What of the wall is prescribed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Control {
    /// The radius of the wall and its velocity.
    Strain {
        /// w = 2 (a - b) \[d\], between 0 and 2 a.
        width: f64,
    },
    /// The radial force on each sphere of an elastic wall.
    Stress {
        /// f^P \[m d t^-2\], 0 or more.
        force_amplitude: f64,
        /// Angle that fixes the direction of the force.
        angle: DriveAngle,
        /// The elastic wall.
        wall: ElasticWall,
    },
}

/// What prescribed and elastic walls have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wall {
    /// Diameter of a wall sphere \[d\].
    pub sphere_diameter: f64,
}

/// A wall of mobile spheres joined by springs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElasticWall {
    /// m_w \[m\].
    pub sphere_mass: f64,
    /// k_w \[m t^-2\].
    pub spring_stiffness: f64,
    /// l \[d\].
    pub natural_length: f64,
    /// Wall spheres whose reference places are farther apart repel on contact \[d\].
    pub contact_range: f64,
    /// Drag coefficient against the laboratory \[m t^-1\].
    pub drag: f64,
    /// Damping of each spring \[m t^-1\].
    pub spring_damping: f64,
    /// Forces that keep it in place.
    pub keep: WallKeep,
}

/// Forces that keep an elastic wall in place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallKeep {
    /// Whether a constant force balances the springs in the straight tube.
    pub balance: bool,
    /// Radial tether \[m t^-2\].
    pub radial: f64,
    /// Azimuthal tether \[m t^-2\].
    pub azimuthal: f64,
    /// Axial tether \[m t^-2\].
    pub axial: f64,
    /// What is done with the mean force.
    pub net_force: NetForce,
}

/// The grains at t = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Initial {
    /// How they stand.
    pub state: InitialState,
    /// Velocity along the wave \[d t^-1\].
    pub axial_velocity: f64,
}

/// Time: how long, in which steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run {
    /// Length in wave periods, a whole number of samples; `None` for a static wave.
    pub periods: Option<f64>,
    /// Length \[t\].
    pub duration: f64,
    /// The step taken \[t\]: the time between two samples over `steps_per_sample`.
    pub time_step: f64,
    /// Steps from one sample to the next.
    pub steps_per_sample: u64,
    /// Samples after the one at t = 0.
    pub samples: u64,
    /// How the equations of motion are stepped.
    pub integrator: Integrator,
    /// Which kernel computes the forces.
    pub kernel: Kernel,
    /// Seed of the random numbers.
    pub seed: u64,
    /// How much farther the neighbour search looks than contacts reach \[d\].
    pub neighbour_skin: f64,
}

impl Run {
    /// Steps of the whole run.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.samples * self.steps_per_sample
    }
}

/// What is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observe {
    /// Samples in one wave period.
    pub samples_per_period: u32,
    /// Bins of a profile over one wavelength.
    pub profile_bins: u32,
    /// Part of the run, at its end, of the late means and profiles.
    pub late_fraction: f64,
    /// J/Jmax crossed at a transition.
    pub transition_threshold: f64,
}

impl Configuration {
    /// Volume fraction of a straight tube: rho = N d^3/(6 a^2 L), d^3 averaged.
    #[must_use]
    pub fn volume_fraction(&self) -> f64 {
        let Tube { radius, .. } = self.tube;
        self.grains.number as f64 * self.grains.mean_cubed_diameter()
            / (6.0 * radius * radius * self.tube.length())
    }

    /// Number density n = N d*^3/(pi a^2 L), d* the largest diameter.
    #[must_use]
    pub fn number_density(&self) -> f64 {
        let largest = self.grains.diameter_max;
        let volume = PI * self.tube.radius * self.tube.radius * self.tube.length();
        self.grains.number as f64 * largest * largest * largest / volume
    }

    /// Speed of the wave c \[d t^-1\].
    #[must_use]
    pub fn wave_speed(&self) -> f64 {
        self.drive.strain_rate * self.tube.wavelength
    }

    /// The same run under a constant drive that is as hard on the grains as the schedules ever become: the least width, the
    /// largest force amplitude and the fastest wave that the run reaches. Without schedules it is the run itself.
    #[must_use]
    pub fn at_its_hardest(&self) -> Self {
        let mut hardest = self.clone();
        let periods = self.run.periods.unwrap_or(0.0);
        for schedule in hardest.drive.schedules.drain(..) {
            let (least, most) = schedule.range(periods);
            match (schedule.parameter, &mut hardest.drive.control) {
                (ScheduledParameter::StrainRate, _) => hardest.drive.strain_rate = most,
                (ScheduledParameter::Width, Control::Strain { width }) => *width = least,
                (
                    ScheduledParameter::ForceAmplitude,
                    Control::Stress {
                        force_amplitude, ..
                    },
                ) => *force_amplitude = most,
                _ => {}
            }
        }
        hardest
    }

    /// Mean mass of a grain: that of its mean cubed diameter \[m\].
    #[must_use]
    pub fn mean_grain_mass(&self) -> f64 {
        self.grains.mean_cubed_diameter()
    }

    /// Pressure rise over one wavelength that the wave has to pump against \[m d^-1 t^-2\]: the weight of the grains of a
    /// wavelength under the body force g over the section of the straight tube, Dp = -N m g lambda/(L pi a^2).
    #[must_use]
    pub fn pressure_rise(&self) -> f64 {
        let Tube {
            radius, wavelength, ..
        } = self.tube;
        let weight = self.grains.number as f64 * self.mean_grain_mass() * self.drive.body_force;
        // One zero, not two.
        0.0 - weight * wavelength / (self.tube.length() * PI * radius * radius)
    }

    /// Amplitude b = a - w/2 of the wall's radius \[d\]; `None` under stress control.
    #[must_use]
    pub fn amplitude(&self) -> Option<f64> {
        match self.drive.control {
            Control::Strain { width } => Some(self.tube.radius - 0.5 * width),
            Control::Stress { .. } => None,
        }
    }

    /// Longest distance of centres over which two spheres act on each other \[d\].
    #[must_use]
    pub fn interaction_reach(&self) -> f64 {
        self.grains.diameter_max.max(self.wall.sphere_diameter)
    }

    /// Velocity along the wave that the initial state has of itself \[d t^-1\].
    pub(crate) fn natural_axial_velocity(&self) -> f64 {
        match self.initial.state {
            InitialState::Rest => 0.0,
            InitialState::Jammed => self.wave_speed(),
        }
    }
}
