//! The wall in motion: prescribed, or elastic.

mod elastic;
pub(crate) mod memory;
mod prescribed;
pub(crate) mod sums;

pub use elastic::{ElasticParameters, ElasticWall};
pub use peristalsis_physics::wall::{DriveAngle, ElasticNetwork, NetForce, Tethers};
pub use prescribed::{PrescribedWall, Scattered};

use core::ops::Range;

use glam::DVec3;
use peristalsis_physics::contact::{Contact, ContactLaw, NormalLaw, TangentialLaw};
use peristalsis_physics::wall::{Contraction, Lattice, RadiusWave};

use self::memory::WallMemory;
use self::sums::{WallSums, WallTerms};
use crate::bodies::{Bodies, Sphere};

/// The wall of a simulation.
#[derive(Clone, Debug)]
#[allow(
    clippy::large_enum_variant,
    reason = "a tube has one, and asks it by reference"
)]
pub enum Wall {
    /// Spheres, or a smooth surface, that move as prescribed (strain control); found by arithmetic, never stored.
    Prescribed(PrescribedWall),
    /// Mobile spheres joined by springs (stress control); they are the last of the [`crate::Bodies`].
    Elastic(ElasticWall),
}

impl Wall {
    /// Brings a prescribed wall, or the force on an elastic one, to `time`.
    pub(crate) fn move_to(&mut self, time: f64) {
        match self {
            Self::Prescribed(wall) => wall.move_to(time),
            Self::Elastic(wall) => wall.move_to(time),
        }
    }

    /// Brings a prescribed wall to where it would be at `time` had it not jumped since `start`; `false` where it has not.
    pub(crate) fn move_without_jump(&mut self, start: f64, time: f64) -> bool {
        match self {
            Self::Prescribed(wall) => wall.move_without_jump(start, time),
            // The force on an elastic wall may jump; its spheres do not.
            Self::Elastic(_) => false,
        }
    }

    /// The reason why `other`, brought to the same time, cannot take this wall's place; `None` where it can.
    pub(crate) fn difference(&self, other: &Self, time: f64) -> Option<&'static str> {
        let (same_kind, amplitudes) = match (self, other) {
            (Self::Prescribed(this), Self::Prescribed(other)) => {
                let stands = this.stands_as(other);
                let (this, other) = (this.wave(), other.wave());
                let same = stands
                    && this.mean_radius == other.mean_radius
                    && this.contraction == other.contraction
                    && this.heading == other.heading;
                (same, (this.amplitude, other.amplitude))
            }
            (Self::Elastic(this), Self::Elastic(other)) => {
                let (theirs, ours) = (other.parameters(), this.parameters());
                let rescheduled = ElasticParameters {
                    force_amplitude: ours.force_amplitude.clone(),
                    frequency: ours.frequency.clone(),
                    ..theirs.clone()
                };
                (rescheduled == *ours, (this.amplitude, other.amplitude))
            }
            _ => (false, (0.0, 0.0)),
        };
        // Sums over more pieces of a schedule round differently.
        let apart = |one: f64, other: f64| (one - other).abs() > 1e-9 * one.abs().max(1.0);
        if !same_kind || self.lattice() != other.lattice() {
            Some("it differs in more than its schedules")
        } else if apart(amplitudes.0, amplitudes.1)
            || apart(self.frequency(time), other.frequency(time))
            || apart(self.cycles(), other.cycles())
        {
            Some("its schedules have other values now, and it would jump")
        } else {
            None
        }
    }

    /// The lattice of the wall's spheres; `None` where they stand anywhere.
    pub fn lattice(&self) -> Option<&Lattice> {
        match self {
            Self::Prescribed(wall) => wall.lattice(),
            Self::Elastic(wall) => Some(wall.lattice()),
        }
    }

    /// Length of the tube, wavelengths in it, and diameter of the wall's spheres.
    fn extent(&self) -> (f64, u32, f64) {
        match self {
            Self::Prescribed(wall) => wall.extent(),
            Self::Elastic(wall) => {
                let lattice = wall.lattice();
                (lattice.length(), lattice.waves, lattice.sphere_diameter)
            }
        }
    }

    /// L, the period of the tube \[d\].
    pub fn length(&self) -> f64 {
        self.extent().0
    }

    /// lambda \[d\]
    pub fn wavelength(&self) -> f64 {
        match self {
            Self::Prescribed(wall) => wall.wave().wavelength,
            Self::Elastic(wall) => wall.lattice().wavelength,
        }
    }

    /// Wavelengths in the tube.
    pub fn waves(&self) -> u32 {
        self.extent().1
    }

    /// Diameter of the wall's spheres \[d\]: the wall's surface, also of a smooth wall, lies half of it inside its radius.
    pub fn sphere_diameter(&self) -> f64 {
        self.extent().2
    }

    /// Wavelengths that the wave has run since the start, the integral of c/lambda.
    pub fn cycles(&self) -> f64 {
        match self {
            Self::Prescribed(wall) => wall.cycles,
            Self::Elastic(wall) => wall.cycles,
        }
    }

    /// +1 where the wave runs towards +z, -1 towards -z.
    pub fn heading(&self) -> f64 {
        match self {
            Self::Prescribed(wall) => wall.wave().heading,
            Self::Elastic(wall) => wall.parameters().heading,
        }
    }

    /// c/lambda at `time` \[1/t\].
    pub fn frequency(&self, time: f64) -> f64 {
        match self {
            Self::Prescribed(wall) => wall.frequency(time),
            Self::Elastic(wall) => wall.parameters().frequency.value(time),
        }
    }

    /// Speed c of the wave at `time` \[d/t\].
    pub fn wave_speed(&self, time: f64) -> f64 {
        self.frequency(time) * self.wavelength()
    }

    /// Largest radius that the tube is expected to reach, to the centres \[d\].
    pub fn usual_radius(&self) -> f64 {
        match self {
            Self::Prescribed(wall) => wall.wave().mean_radius + wall.wave().amplitude.abs(),
            Self::Elastic(wall) => 2.0 * wall.parameters().mean_radius,
        }
    }

    /// Mean radius of the tube, to the centres: a of a prescribed wave, the reference radius of an elastic wall \[d\].
    pub fn mean_radius(&self) -> f64 {
        match self {
            Self::Prescribed(wall) => wall.wave().mean_radius,
            Self::Elastic(wall) => wall.parameters().mean_radius,
        }
    }

    /// The wave that the radius follows; `None` where the radius follows from forces.
    pub fn wave(&self) -> Option<&RadiusWave> {
        self.prescribed().map(PrescribedWall::wave)
    }

    /// Radius at z as far as it is known without the spheres: of the wave, or of the reference tube \[d\].
    pub(crate) fn radius(&self, z: f64) -> f64 {
        self.wave()
            .map_or_else(|| self.mean_radius(), |wave| wave.radius(z, self.cycles()))
    }

    /// Place of the throat in the wave frame \[lambda\]: under strain control the radius is least there, under
    /// stress control the inward force is largest.
    pub fn throat(&self) -> f64 {
        match self {
            // The phase runs against the position.
            Self::Prescribed(wall) => match &wall.wave().contraction {
                Contraction::Table(table) => 1.0 - table.narrowest(),
                Contraction::Wave(_) | Contraction::Segments(_) => 0.25,
            },
            Self::Elastic(_) => 0.75,
        }
    }

    /// Place of the belly, where the tube is widest: of a waveform without a table half a wavelength from the throat
    /// \[lambda\].
    pub fn belly(&self) -> f64 {
        match self.wave().map(|wave| &wave.contraction) {
            Some(Contraction::Table(table)) => 1.0 - table.widest(),
            _ => self.throat() + 0.5,
        }
    }

    /// Number of the wall's spheres that forces move: the last of the [`Bodies`].
    pub fn mobile_spheres(&self) -> usize {
        self.elastic().map_or(0, |wall| wall.lattice().spheres())
    }

    /// The wall's spheres that move as prescribed, in the order of their numbers.
    pub fn prescribed_spheres(&self) -> impl Iterator<Item = Sphere> {
        self.prescribed()
            .into_iter()
            .flat_map(|wall| (0..wall.number()).map(|index| wall.sphere(index)))
    }

    /// A smooth wall as it is drawn, as it stands at `time`: a lattice of beads whose inner side is its surface; `None` for
    /// a wall of spheres.
    pub fn drawn(&self, time: f64) -> Option<Self> {
        self.prescribed()?.drawn(time).map(Self::Prescribed)
    }

    /// Displacements of the mobile spheres from their reference places: (radial, azimuthal, axial) along the reference
    /// directions \[d\].
    pub fn displacements(&self, bodies: &Bodies) -> impl Iterator<Item = DVec3> {
        self.elastic().into_iter().flat_map(|wall| {
            (0..wall.lattice().spheres()).map(|sphere| wall.displacement(bodies, sphere))
        })
    }

    /// Appends the mobile spheres to the grains, in the reference tube.
    pub fn append_spheres(&self, bodies: &mut Bodies) {
        let Some(wall) = self.elastic() else { return };
        for sphere in 0..wall.lattice().spheres() {
            bodies.push_wall_sphere(
                wall.reference(sphere),
                wall.lattice().sphere_diameter,
                wall.parameters().network.sphere_mass,
            );
        }
    }

    /// The prescribed wall, if it is one.
    pub(crate) fn prescribed(&self) -> Option<&PrescribedWall> {
        match self {
            Self::Prescribed(wall) => Some(wall),
            _ => None,
        }
    }

    /// The elastic wall, if it is one.
    pub(crate) fn elastic(&self) -> Option<&ElasticWall> {
        match self {
            Self::Elastic(wall) => Some(wall),
            _ => None,
        }
    }

    /// Whether two of the mobile spheres may touch.
    pub(crate) fn may_touch(&self, one: usize, other: usize) -> bool {
        self.elastic()
            .is_some_and(|wall| wall.may_touch(one, other))
    }

    /// Calls `touch` for each contact of a grain with what of the wall no force moves, or each gap up to `range`: with the
    /// number of the wall's sphere, the contact (the grain not rotating) and the velocity of the wall there.
    #[inline(always)]
    pub(crate) fn for_each_contact(
        &self,
        grain: &Sphere,
        range: f64,
        touch: impl FnMut(u32, Contact, DVec3),
    ) {
        if let Self::Prescribed(wall) = self {
            wall.for_each_contact(grain, range, touch);
        }
    }

    /// Adds the forces and torques on some grains of what of the wall no force moves; `memory` counts these grains from 0.
    pub(crate) fn add_forces<N: NormalLaw, T: TangentialLaw>(
        &self,
        law: &ContactLaw<N, T>,
        grains: &mut impl Grains,
        memory: &mut WallMemory<T::History<f64>>,
        time_step: f64,
        sums: &mut impl WallSums,
    ) {
        if self.mobile_spheres() > 0 {
            return;
        }
        if T::ROTATES {
            memory.begin();
        }
        let numbers = grains.grains();
        for grain in numbers.clone() {
            let remembered = grain - numbers.start;
            let sphere = grains.sphere(grain);
            let (mut force, mut torque) = grains.force(grain);
            let range = law.range(sphere.diameter);
            self.for_each_contact(&sphere, range, |number, mut contact, wall_velocity| {
                let arm = contact.arm(sphere.diameter);
                let mut history = T::History::<f64>::default();
                if T::ROTATES {
                    contact = sphere.on_wall(contact);
                    history = memory.take(remembered, number);
                }
                if T::IS_GENERAL && !law.acts(&contact, &history) {
                    sums.add_ended(law.tangential.stored_energy(&history));
                    return sums.add_general(0.0, law.tangential.bond(&history));
                }
                let answer = law.force(&contact, &mut history, time_step);
                if T::ROTATES {
                    memory.put(number, history);
                    torque += arm * answer.torque_per_arm;
                }
                if T::IS_GENERAL {
                    torque += answer.rolling.couple;
                    sums.add_general(answer.rolling.lost, 0.0);
                }
                force += answer.force;
                sums.add(&WallTerms {
                    answer,
                    overlap: contact.overlap,
                    wall_velocity,
                });
            });
            grains.set_force(grain, force, torque);
            if T::ROTATES {
                for ended in memory.end_grain(remembered) {
                    sums.add_ended(law.tangential.stored_energy(ended));
                    if T::IS_GENERAL {
                        sums.add_general(0.0, law.tangential.bond(ended));
                    }
                }
            }
            sums.end_grain();
        }
        if T::ROTATES {
            memory.end();
        }
    }
}

/// Grains, as a kernel keeps them, with the forces and torques on them.
pub(crate) trait Grains {
    /// Their numbers.
    fn grains(&self) -> Range<usize>;
    /// One of them.
    fn sphere(&self, grain: usize) -> Sphere;
    /// Force and torque on one of them.
    fn force(&self, grain: usize) -> (DVec3, DVec3);
    /// Writes both.
    fn set_force(&mut self, grain: usize, force: DVec3, torque: DVec3);
}

/// Until all forces are known accelerations stand for them.
impl Grains for Bodies {
    fn grains(&self) -> Range<usize> {
        0..self.grains
    }

    #[inline(always)]
    fn sphere(&self, grain: usize) -> Sphere {
        self.sphere(grain)
    }

    #[inline(always)]
    fn force(&self, grain: usize) -> (DVec3, DVec3) {
        (self.acceleration[grain], self.angular_acceleration[grain])
    }

    #[inline(always)]
    fn set_force(&mut self, grain: usize, force: DVec3, torque: DVec3) {
        (self.acceleration[grain], self.angular_acceleration[grain]) = (force, torque);
    }
}
