//! A passive contact, at any angle, spin and friction: what becomes of the energy.

mod common;

use common::{Collision, SLIDINGS, friction, hertz, normals};
use glam::DVec3;
use peristalsis_physics::contact::{ContactModel, CundallStrack, DissipationForm, LinearSpringDashpot, Normal, Sliding};
use proptest::prelude::*;

const TIME_STEP: f64 = 2e-3;

/// Kinetic energy after a collision over that before, less 1.
fn gain(mut spheres: Collision) -> f64 {
    let before = spheres.kinetic_energy();
    spheres.run(TIME_STEP);
    spheres.kinetic_energy() / before - 1.0
}

#[test]
fn explore() {
    let mut state = 12345u64;
    let mut uniform = || { state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407); (state >> 11) as f64 / 9007199254740992.0 };
    for default in [true, false] {
    for (name, normal) in normals() {
        for sliding in SLIDINGS {
            let mut worst = (-1.0, 0.0, 0.0, DVec3::ZERO, DVec3::ZERO, friction(sliding));
            for _ in 0..1000 {
                let ks = uniform();
                let law = if default { friction(sliding) } else { CundallStrack { static_friction: ks, kinetic_friction: ks * uniform(), tangential_stiffness: 0.05 + 3.0 * uniform(), tangential_damping: 0.3 * uniform(), sliding } };
                let model = ContactModel { normal, friction: Some(law) };
                let angle = 1.57 * uniform(); let speed = 0.01 + 0.2 * uniform();
                let mut c = Collision::oblique(model, speed, angle);
                let size = speed * 4.0;
                for i in 0..2 { c.angular_velocity[i] = size * DVec3::new(2.0 * uniform() - 1.0, 2.0 * uniform() - 1.0, 2.0 * uniform() - 1.0); }
                let w = c.angular_velocity;
                let g = gain(c);
                if g > worst.0 { worst = (g, angle.to_degrees(), speed, w[0] / speed, w[1] / speed, law); }
            }
            println!("{default} {name} {sliding:?} worst {worst:?}");
        }
    }
    }
}
