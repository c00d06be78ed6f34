//! The wall in motion: prescribed, or elastic.

pub mod contacts;
pub mod elastic;
pub mod memory;
pub mod prescribed;

pub use contacts::WallContact;
pub use elastic::{ElasticParameters, ElasticWall};
pub use peristalsis_physics::wall::{DriveAngle, NetForce, Tethers};
pub use prescribed::PrescribedWall;

use peristalsis_physics::wall::Lattice;

/// The wall of a simulation.
#[derive(Clone, Debug)]
pub enum Wall {
    /// Spheres that move as prescribed (strain control); found by arithmetic, never stored.
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

    /// What keeps `other`, brought to the same time, from taking this wall's place.
    pub(crate) fn difference(&self, other: &Self, time: f64) -> Option<&'static str> {
        let (same_kind, amplitudes) = match (self, other) {
            (Self::Prescribed(this), Self::Prescribed(other)) => {
                let (this, other) = (this.wave(), other.wave());
                let same = this.mean_radius == other.mean_radius
                    && this.waveform == other.waveform
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
                (rescheduled == *ours, (this.amplitude(), other.amplitude()))
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

    /// The lattice of the wall's spheres.
    #[must_use]
    pub fn lattice(&self) -> &Lattice {
        match self {
            Self::Prescribed(wall) => wall.lattice(),
            Self::Elastic(wall) => wall.lattice(),
        }
    }

    /// Wavelengths that the wave has run since the start, the integral of c/lambda.
    #[must_use]
    pub fn cycles(&self) -> f64 {
        match self {
            Self::Prescribed(wall) => wall.cycles(),
            Self::Elastic(wall) => wall.cycles(),
        }
    }

    /// +1 where the wave runs towards +z, -1 towards -z.
    #[must_use]
    pub fn heading(&self) -> f64 {
        match self {
            Self::Prescribed(wall) => wall.wave().heading,
            Self::Elastic(wall) => wall.parameters().heading,
        }
    }

    /// c/lambda at `time` \[1/t\].
    #[must_use]
    pub fn frequency(&self, time: f64) -> f64 {
        match self {
            Self::Prescribed(wall) => wall.frequency(time),
            Self::Elastic(wall) => wall.parameters().frequency.value(time),
        }
    }

    /// Largest radius that the tube is expected to have, to the centres \[d\].
    #[must_use]
    pub fn usual_radius(&self) -> f64 {
        match self {
            Self::Prescribed(wall) => wall.wave().mean_radius + wall.wave().amplitude.abs(),
            Self::Elastic(wall) => 2.0 * wall.parameters().mean_radius,
        }
    }
}
