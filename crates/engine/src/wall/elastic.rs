//! A wall of mobile spheres joined by springs and driven by a travelling force: stress control.

use glam::DVec3;
use peristalsis_physics::wall::{
    DriveAngle, ElasticNetwork, Lattice, NetForce, Schedule, Tethers, WallSphere, Waveform,
};

use crate::bodies::Bodies;
use crate::ledger::Tally;
use crate::neighbours::periodic;

/// Parameters of an elastic wall; the lattice's triangles have springs along all their sides.
#[derive(Clone, Debug, PartialEq)]
pub struct ElasticParameters {
    /// The lattice of the reference tube.
    pub lattice: Lattice,
    /// Radius of the reference tube, to the centres \[d\].
    pub mean_radius: f64,
    /// The spheres, their springs and tethers; the natural length of the springs is in d.
    pub network: ElasticNetwork,
    /// f^P(t) \[m d/t^2\].
    pub force_amplitude: Schedule,
    /// c(t)/lambda \[1/t\].
    pub frequency: Schedule,
    /// +1 for a wave towards +z, -1 towards -z.
    pub heading: f64,
    /// Shape of the force along the wave.
    pub waveform: Waveform,
    /// Along which radius the force acts.
    pub angle: DriveAngle,
}

/// An elastic wall: its reference tube and its forces. Its spheres are the last of the [`Bodies`].
///
/// Each sphere feels f^P(t) sin(2 pi (z - c t)/lambda) radially outward, its springs -k_w (|r_ij| - l) n_ij, and f_keep.
#[derive(Clone, Debug)]
pub struct ElasticWall {
    parameters: ElasticParameters,
    /// (cos, sin) of each sphere's reference angle.
    pub(crate) directions: Vec<(f64, f64)>,
    /// Each bond once: for each sphere its next on the ring and its two on the ring above.
    bonds: Vec<[u32; 3]>,
    /// Ring of each sphere, and half steps to it around the ring.
    places: Vec<(u32, u32)>,
    /// Whether spheres so many rings and half steps apart may touch.
    far: Vec<bool>,
    /// Radial force that balances the springs of the reference tube; the same for all spheres.
    pub(crate) balance: f64,
    /// Wavelengths that the wave has run since the start.
    pub(crate) cycles: f64,
    /// f^P now \[m d/t^2\].
    pub(crate) amplitude: f64,
}

impl ElasticWall {
    /// The wall at time 0.
    pub fn new(parameters: ElasticParameters) -> Self {
        let lattice = parameters.lattice;
        let spheres = || (0..lattice.spheres()).map(|index| lattice.sphere(index));
        let direction = |sphere| {
            let angle = lattice.angle(sphere);
            (libm::cos(angle), libm::sin(angle))
        };
        let directions = spheres().map(direction).collect();
        let place = |sphere: WallSphere| (sphere.ring, lattice.half_steps(sphere));
        let places = spheres().map(place).collect();
        let bonds = |sphere| {
            let around = lattice.neighbours(sphere);
            [around[1], around[4], around[5]].map(|sphere| lattice.index(sphere) as u32)
        };
        let bonds = spheres().map(bonds).collect();
        let far = distances(&parameters)
            .map(|distance| distance > parameters.network.contact_range)
            .collect();
        let mut wall = Self {
            amplitude: parameters.force_amplitude.value(0.0),
            parameters,
            directions,
            bonds,
            places,
            far,
            balance: 0.0,
            cycles: 0.0,
        };
        if wall.parameters.network.tethers.balance {
            wall.balance = -wall.reference_spring_force();
        }
        wall
    }

    /// Radial force of the springs on a sphere of the reference tube \[m d/t^2\]; negative inwards.
    fn reference_spring_force(&self) -> f64 {
        let lattice = &self.parameters.lattice;
        let here = self.reference(0);
        let sum: DVec3 = lattice
            .neighbours(WallSphere { ring: 0, place: 0 })
            .iter()
            .map(|&neighbour| {
                let separation = periodic(
                    here - self.reference(lattice.index(neighbour)),
                    lattice.length(),
                );
                let stretch = separation.length() - self.parameters.network.natural_length;
                -self.parameters.network.spring_stiffness * stretch * separation.normalize()
            })
            .sum();
        let (cos, sin) = self.directions[0];
        sum.x * cos + sum.y * sin
    }

    /// Moves the drive to `time`.
    pub(crate) fn move_to(&mut self, time: f64) {
        self.cycles = self.parameters.frequency.integral(time);
        self.amplitude = self.parameters.force_amplitude.value(time);
    }

    /// The parameters.
    pub fn parameters(&self) -> &ElasticParameters {
        &self.parameters
    }

    /// The lattice.
    pub fn lattice(&self) -> &Lattice {
        &self.parameters.lattice
    }

    /// Reference place of a wall sphere \[d\].
    pub fn reference(&self, sphere: usize) -> DVec3 {
        let (cos, sin) = self.directions[sphere];
        let lattice = &self.parameters.lattice;
        let radius = self.parameters.mean_radius;
        DVec3::new(
            radius * cos,
            radius * sin,
            lattice.axial_position(lattice.sphere(sphere).ring),
        )
    }

    /// Displacement of a wall sphere from its reference place: (radial, azimuthal, axial) along the reference directions
    /// \[d\].
    pub(crate) fn displacement(&self, bodies: &Bodies, sphere: usize) -> DVec3 {
        let body = bodies.grains + sphere;
        let reference = self.reference(sphere);
        let (cos, sin) = self.directions[sphere];
        let position = bodies.position[body];
        let (x, y) = (position.x - reference.x, position.y - reference.y);
        DVec3::new(
            x * cos + y * sin,
            y * cos - x * sin,
            bodies.unfolded(body, self.parameters.lattice.length()) - reference.z,
        )
    }

    /// Whether two wall spheres may touch: those that are far apart in the reference tube.
    pub(crate) fn may_touch(&self, one: usize, other: usize) -> bool {
        let lattice = &self.parameters.lattice;
        let (one, other) = (self.places[one], self.places[other]);
        let turn = 2 * lattice.spheres_per_ring;
        let (rings, steps) = (one.0.abs_diff(other.0), one.1.abs_diff(other.1));
        let rings = rings.min(lattice.rings() - rings);
        let steps = steps.min(turn - steps);
        self.far[(rings * turn + steps) as usize]
    }

    /// Adds springs, tethers, drag and drive to the forces on the wall; the contact forces must be there already, for
    /// the mean force is removed last.
    pub(crate) fn add_forces(&self, bodies: &mut Bodies, tally: &mut Tally) {
        self.add_springs(bodies, tally);
        self.add_tethers_and_drive(bodies, tally);
        let spheres = self.directions.len();
        match self.parameters.network.tethers.net_force {
            NetForce::Free => {}
            NetForce::Removed => remove_mean(bodies, bodies.grains..bodies.grains + spheres, tally),
            NetForce::RemovedPerRing => {
                let per_ring = self.parameters.lattice.spheres_per_ring as usize;
                for ring in 0..self.parameters.lattice.rings() as usize {
                    let first = bodies.grains + ring * per_ring;
                    remove_mean(bodies, first..first + per_ring, tally);
                }
            }
        }
    }

    fn add_springs(&self, bodies: &mut Bodies, tally: &mut Tally) {
        let ElasticNetwork {
            spring_stiffness,
            natural_length,
            spring_damping,
            ..
        } = self.parameters.network;
        let first = bodies.grains;
        let length = self.parameters.lattice.length();
        for (sphere, partners) in self.bonds.iter().enumerate() {
            let i = first + sphere;
            let mut force = bodies.acceleration[i];
            for &partner in partners {
                let j = first + partner as usize;
                let separation = periodic(bodies.position[i] - bodies.position[j], length);
                let distance = separation.length();
                let normal = separation / distance;
                let stretch = distance - natural_length;
                let rate = (bodies.velocity[i] - bodies.velocity[j]).dot(normal);
                let on_this = -(spring_stiffness * stretch + spring_damping * rate) * normal;
                force += on_this;
                bodies.acceleration[j] -= on_this;
                tally.network_energy += 0.5 * spring_stiffness * stretch * stretch;
                tally.network_dissipation += spring_damping * rate * rate;
            }
            bodies.acceleration[i] = force;
        }
    }

    fn add_tethers_and_drive(&self, bodies: &mut Bodies, tally: &mut Tally) {
        let Tethers {
            radial,
            azimuthal,
            axial,
            ..
        } = self.parameters.network.tethers;
        let drag = self.parameters.network.drag;
        let wavelength = self.parameters.lattice.wavelength;
        for (sphere, &(cos, sin)) in self.directions.iter().enumerate() {
            let i = bodies.grains + sphere;
            let away = self.displacement(bodies, sphere);
            let velocity = bodies.velocity[i];
            let outward = self.balance - radial * away.x;
            let across = -azimuthal * away.y;
            tally.keep_energy += 0.5
                * (radial * away.x * away.x
                    + azimuthal * away.y * away.y
                    + axial * away.z * away.z)
                - self.balance * away.x;

            let position = bodies.position[i];
            let phase = self.parameters.heading * position.z / wavelength - self.cycles;
            let push = self.amplitude * self.parameters.waveform.value(phase - phase.floor());
            let (drive_cos, drive_sin) = match self.parameters.angle {
                DriveAngle::Reference => (cos, sin),
                DriveAngle::Current => {
                    let from_axis = (position.x * position.x + position.y * position.y).sqrt();
                    if from_axis > 0.0 {
                        (position.x / from_axis, position.y / from_axis)
                    } else {
                        (0.0, 0.0)
                    }
                }
            };
            let drive = DVec3::new(push * drive_cos, push * drive_sin, 0.0);
            tally.drive_power += drive.dot(velocity);
            tally.drag_dissipation += drag * velocity.length_squared();
            bodies.acceleration[i] += drive - drag * velocity
                + DVec3::new(
                    outward * cos - across * sin,
                    outward * sin + across * cos,
                    -axial * away.z,
                );
        }
    }
}

/// Distances in the reference tube of spheres up to half the tube's rings apart, by half steps up to a turn \[d\].
fn distances(parameters: &ElasticParameters) -> impl Iterator<Item = f64> {
    let ElasticParameters {
        lattice,
        mean_radius: radius,
        ..
    } = *parameters;
    (0..=lattice.rings() / 2).flat_map(move |rings| {
        (0..2 * lattice.spheres_per_ring).map(move |half_steps| {
            let half_angle = 0.5 * core::f64::consts::PI * f64::from(half_steps)
                / f64::from(lattice.spheres_per_ring);
            let across = 2.0 * radius * libm::sin(half_angle);
            let along = f64::from(rings) * lattice.spacing();
            (across * across + along * along).sqrt()
        })
    })
}

/// Takes the mean force of a range of spheres off each of them.
fn remove_mean(bodies: &mut Bodies, range: core::ops::Range<usize>, tally: &mut Tally) {
    let number = range.len() as f64;
    let mean = range.clone().map(|i| bodies.acceleration[i]).sum::<DVec3>() / number;
    for i in range {
        bodies.acceleration[i] -= mean;
        tally.keep_power -= mean.dot(bodies.velocity[i]);
    }
}
