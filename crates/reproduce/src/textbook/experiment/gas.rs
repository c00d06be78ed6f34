//! A dilute gas of grains that cools by their collisions.

use core::f64::consts::{PI, TAU};

use glam::DVec3;
use peristalsis_engine::{Bodies, Simulation};
use peristalsis_physics::contact::{LinearSpringDashpot, Normal};
use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};

use super::{Means, far_away, frictionless};
use crate::error::Result;
use crate::textbook::case::Circumstances;

/// Grains of diameter and mass 1 in a cylinder that is periodic along its axis and whose side is a mirror for centres.
///
/// The tube's wall stands outside and is never touched. The engine has no mirror: every few contact times the state is
/// taken out, the radial velocity of each grain that leaves is reversed, and the simulation continued. Nothing is lost
/// there, and the collisions are the engine's own.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gas {
    pub(crate) law: LinearSpringDashpot,
    pub(crate) grains: usize,
    pub(crate) volume_fraction: f64,
    /// Length of the period \[d\].
    pub(crate) length: f64,
    /// T at the start, m v^2/3 \[m d^2/t^2\].
    pub(crate) temperature: f64,
}

/// Time between two looks at the mirror, over the duration of a contact.
const LOOK: f64 = 5.0;

impl Gas {
    /// n \[1/d^3\]
    pub(crate) fn density(&self) -> f64 {
        6.0 * self.volume_fraction / PI
    }

    /// Radius of the mirror \[d\].
    pub(crate) fn radius(&self) -> f64 {
        (self.grains as f64 / (PI * self.density() * self.length)).sqrt()
    }

    /// Grains put one after the other where there is room, with velocities of a normal distribution that neither drift along
    /// the axis nor turn about it, brought to the temperature.
    ///
    /// The mirror keeps angular momentum about the axis: what there was would outlive all other motion.
    fn start(&self, seed: u64) -> Bodies {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut uniform = move || (random.next_u64() >> 11) as f64 / 9_007_199_254_740_992.0;
        let radius = self.radius();
        let mut places: Vec<DVec3> = Vec::new();
        while places.len() < self.grains {
            let place = DVec3::new(
                radius * (2.0 * uniform() - 1.0),
                radius * (2.0 * uniform() - 1.0),
                self.length * uniform(),
            );
            let is_free = |other: &DVec3| {
                let mut apart = place - *other;
                apart.z -= self.length * (apart.z / self.length).round();
                apart.length_squared() > 1.0
            };
            if libm::hypot(place.x, place.y) < radius && places.iter().all(is_free) {
                places.push(place);
            }
        }
        let mut bodies = Bodies::grains_at_rest(places, vec![1.0; self.grains]);
        let mut normal = || {
            let (size, angle) = (uniform().max(f64::MIN_POSITIVE), uniform());
            (-2.0 * libm::log(size)).sqrt() * libm::cos(TAU * angle)
        };
        for velocity in &mut bodies.velocity {
            *velocity = DVec3::new(normal(), normal(), normal());
        }
        let mean = bodies.velocity.iter().sum::<DVec3>() / self.grains as f64;
        for velocity in &mut bodies.velocity {
            *velocity -= mean;
        }
        let (mut momentum, mut inertia) = (0.0, 0.0);
        for (place, velocity) in bodies.position.iter().zip(&bodies.velocity) {
            momentum += place.x * velocity.y - place.y * velocity.x;
            inertia += place.x * place.x + place.y * place.y;
        }
        let spin = DVec3::new(0.0, 0.0, momentum / inertia);
        for (place, velocity) in bodies.position.iter().zip(&mut bodies.velocity) {
            *velocity -= spin.cross(*place);
        }
        let scale = (self.temperature / temperature(&bodies)).sqrt();
        for velocity in &mut bodies.velocity {
            *velocity *= scale;
        }
        bodies
    }

    /// Time and temperature, `samples` times in equal parts of `duration`.
    ///
    /// # Errors
    /// Errors of the engine, and a request to stop.
    pub(crate) fn cool(
        &self,
        seed: u64,
        means: Means,
        time_step: f64,
        [duration, samples]: [f64; 2],
        circumstances: Circumstances<'_>,
    ) -> Result<Vec<[f64; 2]>> {
        let contact = frictionless(Normal::Linear(self.law));
        let radius = self.radius();
        let wall = far_away(radius + 3.0, self.length);
        let parameters = means.parameters(contact, time_step, 0.3);
        let mut simulation = Simulation::new(self.start(seed), wall.clone(), parameters);
        let whole = |number: f64| number.round().max(1.0) as u64;
        let look = whole(LOOK * self.law.contact_time(0.5) / time_step);
        let looks = whole(duration / samples / (time_step * look as f64));
        let mut course = vec![[0.0, temperature(simulation.bodies())]];
        for _ in 0..samples as u64 {
            circumstances.go_on()?;
            for _ in 0..looks {
                simulation.advance(look)?;
                simulation = reflected(simulation, radius, 0.5 * time_step * look as f64)?;
            }
            course.push([simulation.time(), temperature(simulation.bodies())]);
        }
        Ok(course)
    }
}

/// The simulation with the grains turned back that will be outside in a time `ahead`.
///
/// Half of the time between two looks: so the mirror stands where it should in the mean.
fn reflected(simulation: Simulation, radius: f64, ahead: f64) -> Result<Simulation> {
    let leaves = |position: &DVec3, velocity: &DVec3| {
        let outward = position.x * velocity.x + position.y * velocity.y;
        let place = *position + ahead * *velocity;
        place.x * place.x + place.y * place.y > radius * radius && outward > 0.0
    };
    let bodies = simulation.bodies();
    let mut grains = bodies.position.iter().zip(&bodies.velocity);
    if !grains.any(|(position, velocity)| leaves(position, velocity)) {
        return Ok(simulation);
    }
    let mut snapshot = simulation.snapshot();
    let bodies = &mut snapshot.bodies;
    for (position, velocity) in bodies.position.iter().zip(&mut bodies.velocity) {
        if leaves(position, velocity) {
            let normal = DVec3::new(position.x, position.y, 0.0).normalize();
            *velocity -= 2.0 * velocity.dot(normal) * normal;
        }
    }
    let (wall, parameters) = (simulation.wall().clone(), *simulation.parameters());
    Ok(Simulation::restore(snapshot, wall, parameters)?)
}

/// T = sum m |v - <v>|^2/(3 N).
fn temperature(bodies: &Bodies) -> f64 {
    let number = bodies.grains as f64;
    let mean = bodies.velocity.iter().sum::<DVec3>() / number;
    let squares = bodies.velocity.iter().map(|v| (*v - mean).length_squared());
    squares.sum::<f64>() / (3.0 * number)
}
