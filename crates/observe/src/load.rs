//! The load on the grains: forces, and the stress that follows from them.

use glam::{DMat3, DVec3};
use peristalsis_engine::{Bodies, Simulation, Touching};
use peristalsis_physics::wall::{Contraction, RadiusWave};

use crate::shape::TubeShape;

/// Places along the tube at which its cross-section is taken, a wavelength, at least.
const PLACES_A_WAVE: f64 = 256.0;
/// Instants of a period that a mean over it is from.
const PHASES: u32 = 128;

/// A contact of a grain, with where it is and the lever arms of its spheres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GrainContact {
    /// The contact; its first sphere is a grain.
    pub touching: Touching,
    /// Whether the second sphere is one of the wall.
    pub is_with_wall: bool,
    /// n, from the second sphere to the first.
    pub normal: DVec3,
    /// Where they touch, on the line of centres; z may lie a little outside \[0, L) \[d\].
    pub point: DVec3,
    /// l = (d - xi)/2 of the first and of the second sphere \[d\].
    arms: [f64; 2],
}

impl GrainContact {
    fn of(touching: Touching, bodies: &Bodies, wall_diameter: f64) -> Self {
        let diameter = |sphere: usize| bodies.diameter.get(sphere).copied();
        let diameters = [touching.first, touching.second].map(diameter);
        let arms = diameters.map(|it| 0.5 * (it.unwrap_or(wall_diameter) - touching.overlap));
        let normal = touching.separation.normalize();
        Self {
            touching,
            is_with_wall: touching.second >= bodies.grains,
            normal,
            point: bodies.position[touching.first] - arms[0] * normal,
            arms,
        }
    }

    /// f_t, the part of the force on the first sphere that lies in the plane of contact \[m d/t^2\].
    pub fn tangential_force(&self) -> DVec3 {
        if self.touching.tangential_force == 0.0 {
            return DVec3::ZERO;
        }
        self.touching.force - self.touching.normal_force * self.normal
    }

    /// Torque on the first and on the second sphere, -l n x f_t and the couple that resists rolling \[m d^2/t^2\].
    fn torques(&self) -> [DVec3; 2] {
        let per_arm = -self.normal.cross(self.tangential_force());
        let [first, second] = self.arms.map(|arm| arm * per_arm);
        [first + self.touching.couple, second - self.touching.couple]
    }

    /// Branch vector: from the second grain to the first, or to it from where it touches the wall \[d\].
    fn branch(&self) -> DVec3 {
        match self.is_with_wall {
            true => self.arms[0] * self.normal,
            false => self.touching.separation,
        }
    }
}

/// Calls `visit` for each of the [`grain_contacts`], which are not collected.
pub(crate) fn for_each_grain_contact(simulation: &Simulation, mut visit: impl FnMut(GrainContact)) {
    let bodies = simulation.bodies();
    let wall_diameter = simulation.wall().sphere_diameter();
    simulation.for_each_touching(&mut |touching| {
        if touching.first < bodies.grains {
            visit(GrainContact::of(touching, bodies, wall_diameter));
        }
    });
}

/// The contacts of the grains as they stand, grain by grain; those of the wall with itself are left out.
pub fn grain_contacts(simulation: &Simulation) -> Vec<GrainContact> {
    let mut contacts = Vec::new();
    for_each_grain_contact(simulation, |contact| contacts.push(contact));
    contacts
}

/// Forces and torques on the grains at the present positions and velocities, and the stress in them.
#[derive(Clone, Debug, PartialEq)]
pub struct Load {
    /// Force on each grain: the sum over its contacts, and the body force; 0 of one that waits outside an open tube
    /// \[m d/t^2\].
    pub forces: Vec<DVec3>,
    /// Torque on each grain, the sum over its contacts; 0 without friction \[m d^2/t^2\].
    pub torques: Vec<DVec3>,
    /// sigma_ab = (sum over contacts of l_a f_b + sum over grains of m dv_a dv_b)/V \[m/(d t^2)\].
    ///
    /// l is the branch vector: from the partner's centre to the grain's or, of a contact with the wall, from the point of
    /// contact; f is the force on the grain; dv its velocity less that of the centre of mass; V the [`clear_volume`].
    /// Positive in compression; a third of the trace is the pressure. Rows are a. In a straight tube at rest its part across
    /// is the pressure on the clear bore, R/(R - d_w/2) times that of a [profile](crate::ProfileBin).
    pub stress: DMat3,
}

impl Load {
    /// The load now.
    pub fn of(simulation: &Simulation) -> Self {
        let bodies = simulation.bodies();
        let body_force = simulation.parameters().body_force;
        let masses = &bodies.mass[..bodies.grains];
        let weight = |(grain, mass): (usize, &f64)| match simulation.is_present(grain) {
            true => *mass * body_force,
            false => DVec3::ZERO,
        };
        let mut forces: Vec<DVec3> = masses.iter().enumerate().map(weight).collect();
        let mut torques = vec![DVec3::ZERO; bodies.grains];
        let mut virial = kinetic_part(simulation);
        for_each_grain_contact(simulation, |contact| {
            let Touching {
                first,
                second,
                force,
                ..
            } = contact.touching;
            let [on_first, on_second] = contact.torques();
            forces[first] += force;
            torques[first] += on_first;
            if !contact.is_with_wall {
                forces[second] -= force;
                torques[second] += on_second;
            }
            virial += dyad(contact.branch(), force);
        });
        Self {
            forces,
            torques,
            stress: virial * (1.0 / clear_volume(simulation)),
        }
    }
}

/// sum m dv dv of the grains, dv counted from their mean velocity.
fn kinetic_part(simulation: &Simulation) -> DMat3 {
    let bodies = simulation.bodies();
    let grains = || {
        let present = (0..bodies.grains).filter(|&grain| simulation.is_present(grain));
        present.map(|grain| (&bodies.mass[grain], &bodies.velocity[grain]))
    };
    let mass: f64 = grains().map(|(mass, _)| mass).sum();
    if mass == 0.0 {
        return DMat3::ZERO;
    }
    let momentum: DVec3 = grains().map(|(mass, velocity)| *mass * *velocity).sum();
    let mean = momentum / mass;
    let parts = grains().map(|(mass, velocity)| dyad(*mass * (*velocity - mean), *velocity - mean));
    parts.fold(DMat3::ZERO, |sum, part| sum + part)
}

/// a b^T
fn dyad(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

/// Volume that the wall's spheres leave clear, the integral of pi (R - d_w/2)^2 along the tube, between its ends where it is
/// open; R to their centres and d_w their diameter \[d^3\].
pub fn clear_volume(simulation: &Simulation) -> f64 {
    clear_volume_along(simulation, &TubeShape::of(simulation), simulation.length())
}

/// Clear volume of a wavelength, the mean over those of the wall: the ends of an open tube do not count \[d^3\].
///
/// That of segments, which close in turn, is the mean over a period.
pub fn clear_volume_of_wave(simulation: &Simulation) -> f64 {
    let wall = simulation.wall();
    let of = |shape: &TubeShape| clear_volume_along(simulation, shape, wall.length());
    let whole = match TubeShape::of(simulation) {
        TubeShape::Wave(
            wave @ RadiusWave {
                contraction: Contraction::Segments(_),
                ..
            },
            cycles,
        ) => {
            let at =
                |phase: u32| TubeShape::Wave(wave, cycles + f64::from(phase) / f64::from(PHASES));
            (0..PHASES).map(|phase| of(&at(phase))).sum::<f64>() / f64::from(PHASES)
        }
        shape => of(&shape),
    };
    whole / f64::from(wall.waves())
}

/// Clear volume along so much of the tube from where z is 0, of an open tube from its inlet \[d^3\].
fn clear_volume_along(simulation: &Simulation, shape: &TubeShape, length: f64) -> f64 {
    let wall = simulation.wall();
    let half = 0.5 * wall.sphere_diameter();
    let least = PLACES_A_WAVE * f64::from(wall.waves());
    let places = match shape {
        // As many in each slice.
        TubeShape::Slices(slices, _) => (least / slices.len() as f64).ceil() * slices.len() as f64,
        TubeShape::Wave(..) => least.max(1.0),
    };
    let spacing = length / places;
    let from_outlet = simulation.ends().is_some() && wall.heading() < 0.0;
    let area = |place: u32| {
        let along = (f64::from(place) + 0.5) * spacing;
        let z = if from_outlet {
            wall.length() - along
        } else {
            along
        };
        let clear = (shape.radius(z) - half).max(0.0);
        core::f64::consts::PI * clear * clear
    };
    (0..places as u32).map(area).sum::<f64>() * spacing
}
