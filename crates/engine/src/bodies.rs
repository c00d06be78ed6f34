//! State of the moving spheres: a structure of arrays.

use glam::DVec3;
use peristalsis_physics::contact::Contact;

/// Moving spheres: the grains first, then the spheres of an elastic wall, if there is one.
///
/// Positions have z in \[0, L); `turns` counts how often a sphere went round the tube, so that z + turns L is its
/// unfolded position. All arrays have the same length.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Bodies {
    /// Number of grains: the first so many entries of each array.
    pub grains: usize,
    /// Centres \[d\].
    pub position: Vec<DVec3>,
    /// Times round the tube.
    pub turns: Vec<i32>,
    /// Velocities \[d/t\].
    pub velocity: Vec<DVec3>,
    /// Accelerations at the end of the last step \[d/t^2\].
    pub acceleration: Vec<DVec3>,
    /// Angular velocities \[1/t\].
    pub angular_velocity: Vec<DVec3>,
    /// Angular accelerations at the end of the last step \[1/t^2\].
    pub angular_acceleration: Vec<DVec3>,
    /// Diameters \[d\].
    pub diameter: Vec<f64>,
    /// Masses \[m\].
    pub mass: Vec<f64>,
    /// Moments of inertia \[m d^2\]; infinite for a sphere that does not rotate.
    pub inertia: Vec<f64>,
}

/// A sphere as a contact sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Centre \[d\].
    pub position: DVec3,
    /// Velocity \[d/t\].
    pub velocity: DVec3,
    /// Angular velocity \[1/t\].
    pub angular_velocity: DVec3,
    /// Diameter \[d\].
    pub diameter: f64,
}

impl Sphere {
    /// The contact with another sphere at this one's place less `separation`, whether they touch or not.
    pub(crate) fn contact(&self, other: &Self, separation: DVec3) -> Contact {
        let diameters = (self.diameter, other.diameter);
        let contact = Contact::new(diameters, separation, self.velocity - other.velocity);
        let rotation = contact.arm(self.diameter) * self.angular_velocity
            + contact.arm(other.diameter) * other.angular_velocity;
        contact.rotating(rotation, self.angular_velocity - other.angular_velocity)
    }

    /// A contact with a wall that does not turn.
    pub(crate) fn on_wall(&self, contact: Contact) -> Contact {
        let rotation = contact.arm(self.diameter) * self.angular_velocity;
        contact.rotating(rotation, self.angular_velocity)
    }
}

impl Bodies {
    /// One of the spheres.
    #[inline(always)]
    pub fn sphere(&self, index: usize) -> Sphere {
        Sphere {
            position: self.position[index],
            velocity: self.velocity[index],
            angular_velocity: self.angular_velocity[index],
            diameter: self.diameter[index],
        }
    }

    /// Spheres at rest at the given places, with the given diameters and masses d^3 (in units of the mass of a sphere
    /// of diameter 1) and moments of inertia m d^2/10.
    pub fn grains_at_rest(position: Vec<DVec3>, diameter: Vec<f64>) -> Self {
        let number = position.len();
        let mass: Vec<f64> = diameter.iter().map(|d| d * d * d).collect();
        let inertia = mass
            .iter()
            .zip(&diameter)
            .map(|(m, d)| m * d * d / 10.0)
            .collect();
        Self {
            grains: number,
            position,
            turns: vec![0; number],
            velocity: vec![DVec3::ZERO; number],
            acceleration: vec![DVec3::ZERO; number],
            angular_velocity: vec![DVec3::ZERO; number],
            angular_acceleration: vec![DVec3::ZERO; number],
            diameter,
            mass,
            inertia,
        }
    }

    /// Appends grains at rest with these diameters to spheres that are grains all, at the origin.
    pub(crate) fn push_grains_at_rest(&mut self, diameter: &[f64]) {
        let more = Self::grains_at_rest(vec![DVec3::ZERO; diameter.len()], diameter.to_vec());
        self.grains += more.grains;
        self.position.extend(more.position);
        self.turns.extend(more.turns);
        self.velocity.extend(more.velocity);
        self.acceleration.extend(more.acceleration);
        self.angular_velocity.extend(more.angular_velocity);
        self.angular_acceleration.extend(more.angular_acceleration);
        self.diameter.extend(more.diameter);
        self.mass.extend(more.mass);
        self.inertia.extend(more.inertia);
    }

    /// Appends a sphere of an elastic wall, at rest; it does not rotate.
    pub fn push_wall_sphere(&mut self, position: DVec3, diameter: f64, mass: f64) {
        self.position.push(position);
        self.turns.push(0);
        self.velocity.push(DVec3::ZERO);
        self.acceleration.push(DVec3::ZERO);
        self.angular_velocity.push(DVec3::ZERO);
        self.angular_acceleration.push(DVec3::ZERO);
        self.diameter.push(diameter);
        self.mass.push(mass);
        self.inertia.push(f64::INFINITY);
    }

    /// Number of moving spheres, grains and wall.
    pub fn number(&self) -> usize {
        self.position.len()
    }

    /// Kinetic energy of translation of the spheres of a range, sum m v^2/2 \[m d^2/t^2\].
    pub fn kinetic_energy(&self, range: core::ops::Range<usize>) -> f64 {
        range
            .map(|i| 0.5 * self.mass[i] * self.velocity[i].length_squared())
            .sum()
    }

    /// Kinetic energy of rotation of the grains, sum I omega^2/2 \[m d^2/t^2\].
    pub fn rotational_energy(&self) -> f64 {
        (0..self.grains)
            .map(|i| 0.5 * self.inertia[i] * self.angular_velocity[i].length_squared())
            .sum()
    }

    /// Unfolded axial position z + turns L of a sphere \[d\].
    pub fn unfolded(&self, index: usize, length: f64) -> f64 {
        self.position[index].z + f64::from(self.turns[index]) * length
    }

    /// Brings every z back into \[0, L), counting turns.
    pub(crate) fn fold(&mut self, length: f64) {
        for (position, turns) in self.position.iter_mut().zip(&mut self.turns) {
            let more;
            (position.z, more) = fold(position.z, length);
            *turns += more;
        }
    }
}

/// No sphere that is followed step by step is ever so many lengths of the tube away.
const FAR: f64 = 64.0;

/// z brought back into \[0, L), and the turns that this takes off it.
#[inline(always)]
pub(crate) fn fold(mut z: f64, length: f64) -> (f64, i32) {
    let mut turns = 0;
    // Only in a state from elsewhere; the loops below would take long.
    if z.abs() > FAR * length {
        let folded = z.rem_euclid(length);
        turns = ((z - folded) / length).round() as i32;
        z = folded;
    }
    while z >= length {
        z -= length;
        turns += 1;
    }
    while z < 0.0 {
        z += length;
        turns -= 1;
        // A tiny negative z plus L may round to L itself.
        if z >= length {
            z = 0.0;
            turns += 1;
        }
    }
    (z, turns)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folding_keeps_the_unfolded_place() {
        let length = 20.0;
        for z in [
            0.0, 19.999, 20.0, 45.0, -0.25, -1e-18, -60.0, 1e5, -123_456.7,
        ] {
            let mut bodies = Bodies::grains_at_rest(vec![DVec3::new(1.0, 2.0, z)], vec![1.0]);
            bodies.fold(length);
            let folded = bodies.position[0];
            assert!((0.0..length).contains(&folded.z), "{z} folds to {folded}");
            assert!(
                (bodies.unfolded(0, length) - z).abs() <= 1e-13 * z.abs().max(1.0),
                "{z}"
            );
            assert_eq!((folded.x, folded.y), (1.0, 2.0));
        }
        for z in [1e300, -1e300, 1e17] {
            assert!((0.0..length).contains(&fold(z, length).0));
        }
    }

    #[test]
    fn energies_by_hand() {
        let mut bodies = Bodies::grains_at_rest(vec![DVec3::ZERO; 2], vec![1.0, 0.5]);
        bodies.push_wall_sphere(DVec3::X, 1.0, 0.1);
        bodies.velocity = vec![DVec3::X, 2.0 * DVec3::Y, 3.0 * DVec3::Z];
        bodies.angular_velocity = vec![DVec3::X, DVec3::Z, DVec3::ZERO];
        assert_eq!(
            (bodies.grains, bodies.number(), bodies.mass[1]),
            (2, 3, 0.125)
        );
        assert!((bodies.kinetic_energy(0..2) - 0.75).abs() < 1e-15);
        assert!((bodies.kinetic_energy(0..3) - 1.2).abs() < 1e-15);
        // m d^2/10 of each: 0.1 and 0.003125; a wall sphere does not turn.
        assert!((bodies.rotational_energy() - 0.051_562_5).abs() < 1e-15);
    }
}
