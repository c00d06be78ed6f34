//! Impacts: of two grains, and of a grain on a plane.

use glam::DVec3;
use peristalsis_engine::{Bodies, Simulation};
use peristalsis_physics::contact::ContactModel;

use super::{Means, far_away, plane};
use crate::error::{ReproduceError, Result};

/// Diameter of the wall's sphere that stands for a plane \[d\].
///
/// The engine knows no plane. Against this one the reduced radius of a grain of diameter d is less than its own radius by
/// d/D, one part in ten thousand, which references are given too.
pub(crate) const PLANE_DIAMETER: f64 = 1e4;

/// A sphere before or after an impact. The normal of the contact is x, its plane y, spins are about z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sphere {
    pub(crate) diameter: f64,
    pub(crate) mass: f64,
    pub(crate) velocity: DVec3,
    pub(crate) spin: f64,
}

impl Sphere {
    /// A sphere of diameter 1 and mass 1.
    pub(crate) fn unit(velocity: DVec3, spin: f64) -> Self {
        Self {
            diameter: 1.0,
            mass: 1.0,
            velocity,
            spin,
        }
    }

    pub(crate) fn inertia(&self) -> f64 {
        self.mass * self.diameter * self.diameter / 10.0
    }
}

/// A sphere that arrives at positive x, and its partner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Impact {
    pub(crate) contact: ContactModel,
    pub(crate) sphere: Sphere,
    /// Another grain, at the side of negative x; `None`: a sphere of the wall, at rest and so large that it stands for a
    /// plane.
    pub(crate) partner: Option<Sphere>,
}

/// Motion after an impact, and extremes in it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Rebound {
    /// Velocities after it; a plane stays at rest.
    pub(crate) velocity: [DVec3; 2],
    /// Spins about z after it.
    pub(crate) spin: [f64; 2],
    /// Time from touching to parting, found from the free flights before and after \[t\].
    pub(crate) contact_time: f64,
    /// Largest overlap, between steps by a cubic \[d\].
    pub(crate) largest_overlap: f64,
    /// Largest force on the sphere, between steps by a parabola \[m d/t^2\].
    pub(crate) peak_force: f64,
}

/// More steps than any impact takes.
const MOST_STEPS: u64 = 1 << 22;

impl Impact {
    /// Two grains of diameter and mass 1 that meet head-on, each with this speed.
    pub(crate) fn of_twins(contact: ContactModel, speed: f64) -> Self {
        let [one, other] = [-speed, speed].map(|speed| DVec3::new(speed, 0.0, 0.0));
        Self::between(contact, one, other)
    }

    /// Two grains of diameter and mass 1 with these velocities.
    pub(crate) fn between(contact: ContactModel, one: DVec3, other: DVec3) -> Self {
        Self {
            contact,
            sphere: Sphere::unit(one, 0.0),
            partner: Some(Sphere::unit(other, 0.0)),
        }
    }

    /// A grain of diameter and mass 1 that hits a plane.
    pub(crate) fn on_plane(contact: ContactModel, velocity: DVec3) -> Self {
        Self {
            contact,
            sphere: Sphere::unit(velocity, 0.0),
            partner: None,
        }
    }

    /// e from the velocities after the impact.
    pub(crate) fn restitution(&self, velocity: [DVec3; 2]) -> f64 {
        -(velocity[0].x - velocity[1].x) / self.relative_velocity().x
    }

    /// The partner as a sphere; a plane is at rest, very large and infinitely heavy.
    pub(crate) fn other(&self) -> Sphere {
        self.partner.unwrap_or(Sphere {
            diameter: PLANE_DIAMETER,
            mass: f64::INFINITY,
            ..Sphere::unit(DVec3::ZERO, 0.0)
        })
    }

    /// Half the sum of the diameters \[d\].
    pub(crate) fn reach(&self) -> f64 {
        0.5 * (self.sphere.diameter + self.other().diameter)
    }

    /// d_i d_j/(2 (d_i + d_j)).
    pub(crate) fn reduced_radius(&self) -> f64 {
        let (one, other) = (self.sphere.diameter, self.other().diameter);
        one * other / (2.0 * (one + other))
    }

    /// m_j/(m_i + m_j), the share of the sphere in a change of the relative velocity.
    pub(crate) fn share(&self) -> f64 {
        self.reduced_mass() / self.sphere.mass
    }

    /// m_i m_j/(m_i + m_j).
    pub(crate) fn reduced_mass(&self) -> f64 {
        let mass = self.sphere.mass;
        let reduced = |other: Sphere| mass * other.mass / (mass + other.mass);
        self.partner.map_or(mass, reduced)
    }

    /// v_i - v_j before the impact.
    pub(crate) fn relative_velocity(&self) -> DVec3 {
        self.sphere.velocity - self.other().velocity
    }

    /// Simulates the impact in steps of `time_step`, the spheres touching a fraction `phase` of a step after a step's
    /// beginning.
    ///
    /// # Errors
    /// Errors of the engine, and spheres that do not part.
    pub(crate) fn simulate(&self, means: Means, time_step: f64, phase: f64) -> Result<Rebound> {
        let lead = (1.0 + phase) * time_step;
        let mut experiment = Experiment::new(self, means, time_step, lead);
        let mut past = [experiment.look(); 3];
        let mut answer = Rebound::default();
        let mut met = false;
        for step in 1..=MOST_STEPS {
            experiment.simulation.advance(1)?;
            past = [past[1], past[2], experiment.look()];
            let [before, middle, now] = past;
            if middle.overlap > 0.0 && middle.rate >= 0.0 && now.rate < 0.0 {
                answer.largest_overlap = largest_of_cubic(middle, now, time_step);
            }
            if middle.force >= before.force && middle.force > now.force {
                answer.peak_force = answer.peak_force.max(top_of_parabola(before, middle, now));
            }
            met |= now.overlap > 0.0;
            if met && now.overlap <= 0.0 {
                let parted = time_since_parting(now, self.reach());
                answer.contact_time = step as f64 * time_step - parted - lead;
                (answer.velocity, answer.spin) = experiment.motion();
                return Ok(answer);
            }
        }
        Err(ReproduceError::NoRebound {
            steps: MOST_STEPS,
            time_step,
        })
    }
}

/// One instant of an impact.
#[derive(Clone, Copy)]
struct Look {
    separation: DVec3,
    relative_velocity: DVec3,
    overlap: f64,
    /// d overlap/dt.
    rate: f64,
    force: f64,
}

struct Experiment {
    simulation: Simulation,
    reach: f64,
    /// Centre of the sphere that stands for a plane.
    plane: Option<DVec3>,
}

impl Experiment {
    /// The spheres `lead` before they touch.
    fn new(impact: &Impact, means: Means, time_step: f64, lead: f64) -> Self {
        let sphere = impact.sphere;
        let reach = impact.reach();
        let skin = 0.3 * sphere.diameter;
        let (wall, mut spheres, plane) = match impact.partner {
            Some(other) => {
                let length = 40.0 * reach;
                let wall = far_away(100.0 * reach, length);
                let centre = DVec3::new(0.0, 0.0, 0.5 * length);
                let half = DVec3::new(0.5 * reach, 0.0, 0.0);
                let spheres = vec![(sphere, centre + half), (other, centre - half)];
                (wall, spheres, None)
            }
            None => {
                let wall = plane(PLANE_DIAMETER, reach);
                // The sphere of the second ring stands at the side of negative x.
                let centre = wall
                    .prescribed_spheres()
                    .nth(1)
                    .expect("a ring of one sphere is followed by another")
                    .position;
                // The grain is near the axis, where its place has the finest grid of numbers.
                let place = DVec3::new(centre.x + reach, centre.y, centre.z);
                (wall, vec![(sphere, place)], Some(centre))
            }
        };
        for (sphere, place) in &mut spheres {
            *place -= lead * sphere.velocity;
        }
        let mut bodies = Bodies::grains_at_rest(
            spheres.iter().map(|(_, place)| *place).collect(),
            spheres.iter().map(|(sphere, _)| sphere.diameter).collect(),
        );
        for (i, (sphere, _)) in spheres.iter().enumerate() {
            bodies.velocity[i] = sphere.velocity;
            bodies.mass[i] = sphere.mass;
            bodies.inertia[i] = sphere.inertia();
            bodies.angular_velocity[i] = DVec3::new(0.0, 0.0, sphere.spin);
        }
        let parameters = means.parameters(impact.contact, time_step, skin);
        Self {
            simulation: Simulation::new(bodies, wall, parameters),
            reach,
            plane,
        }
    }

    fn look(&self) -> Look {
        let bodies = self.simulation.bodies();
        let (there, velocity) = match self.plane {
            Some(centre) => (centre, DVec3::ZERO),
            None => (bodies.position[1], bodies.velocity[1]),
        };
        let separation = bodies.position[0] - there;
        let relative_velocity = bodies.velocity[0] - velocity;
        let distance = separation.length();
        Look {
            separation,
            relative_velocity,
            overlap: self.reach - distance,
            rate: -relative_velocity.dot(separation) / distance,
            force: bodies.mass[0] * bodies.acceleration[0].length(),
        }
    }

    fn motion(&self) -> ([DVec3; 2], [f64; 2]) {
        let bodies = self.simulation.bodies();
        let both = |vectors: &[DVec3]| [vectors[0], vectors.get(1).copied().unwrap_or_default()];
        let spins = both(&bodies.angular_velocity).map(|spin| spin.z);
        (both(&bodies.velocity), spins)
    }
}

/// Largest value between two instants, of the cubic through values and rates.
fn largest_of_cubic(from: Look, to: Look, time_step: f64) -> f64 {
    let (p0, p1) = (from.overlap, to.overlap);
    let (m0, m1) = (time_step * from.rate, time_step * to.rate);
    let cubic = 2.0 * (p0 - p1) + m0 + m1;
    let square = 3.0 * (p1 - p0) - 2.0 * m0 - m1;
    // The root of the derivative 3 c s^2 + 2 q s + m0 where it falls through 0.
    let root = (square * square - 3.0 * cubic * m0).max(0.0).sqrt();
    let s = m0 / (root - square);
    ((cubic * s + square) * s + m0) * s + p0
}

/// Top of the parabola through three forces at equal distances in time.
fn top_of_parabola(before: Look, middle: Look, after: Look) -> f64 {
    let slope = 0.5 * (after.force - before.force);
    let curvature = after.force - 2.0 * middle.force + before.force;
    if curvature < 0.0 {
        middle.force - 0.5 * slope * slope / curvature
    } else {
        middle.force
    }
}

/// How long ago spheres that fly apart touched last.
fn time_since_parting(now: Look, reach: f64) -> f64 {
    let along = now.separation.dot(now.relative_velocity);
    let speed_squared = now.relative_velocity.length_squared();
    let distance = now.separation.length();
    let beyond = (distance - reach) * (distance + reach);
    // The smaller root of |r - v t|^2 = reach^2, without a difference of like numbers.
    beyond / (along + (along * along - speed_squared * beyond).max(0.0).sqrt())
}
