//! Grains in an upright smooth tube on a floor that sinks slowly: what the floor bears.

use glam::DVec3;
use peristalsis_engine::initial::{InitialState, Packing, pack};
use peristalsis_engine::wall::PrescribedWall;
use peristalsis_engine::{Parameters, Simulation, Wall};
use peristalsis_physics::contact::{
    ContactModel, CundallStrack, LinearSpringDashpot, Normal, Sliding,
};
use peristalsis_physics::sizes::Sizes;
use peristalsis_physics::wall::{Contraction, Lattice, RadiusTable, Schedule};

use super::Means;
use crate::error::Result;

/// Clear width of the tube \[d\].
pub(crate) const BORE: f64 = 5.0;
/// \[d/t^2\]
const GRAVITY: f64 = 1e-3;
/// Some 15 steps in a contact.
const TIME_STEP: f64 = 0.15;
/// Diameters are uniform in between, so that grains do not order.
const DIAMETERS: [f64; 2] = [0.8, 1.0];
/// Grains that fill the tube as high as it is wide, about.
const PER_BORE: f64 = 150.0;
/// Height of the closed throat below the straight tube \[d\].
const THROAT: f64 = 4.0;
/// How fast the floor sinks \[d/t\]: so slowly that half the speed gives the same.
const SINKING: f64 = 1e-3;
/// Times at which the floor begins to sink, and has that speed: grains fall to it and come to rest before \[t\].
const STARTS: [f64; 2] = [1500.0, 1550.0];
/// How far the floor sinks before and while forces are read \[d\].
const SUNK: [f64; 2] = [0.3, 0.2];
const READINGS: u32 = 20;

/// A filling of the tube.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Column {
    /// mu of grains and wall; 0: neither has friction.
    pub(crate) friction: f64,
    /// About \[D\], the width of the tube.
    pub(crate) height: f64,
    pub(crate) seed: u64,
}

/// Forces on and in a column above a section just above the floor, over g; means over readings.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Load {
    /// M, mass above the section \[m\].
    pub(crate) filling: f64,
    /// M_app, what the floor bears of it \[m\].
    pub(crate) apparent: f64,
    /// Its moment about the section \[m d\].
    pub(crate) moment: f64,
    /// Integral over the height of the vertical force that contacts between grains carry \[m d\].
    pub(crate) vertical: f64,
    /// Sum of the normal forces on the wall \[m\].
    pub(crate) radial: f64,
    /// Vertical friction of the wall, upward \[m\].
    pub(crate) friction: f64,
}

impl Column {
    /// What the floor bears after it has sunk by some tenths of a grain.
    ///
    /// The floor is a closed throat that runs downward; the straight tube above it stands.
    ///
    /// # Errors
    /// Errors of the engine.
    pub(crate) fn load(&self) -> Result<Load> {
        let wall = self.wall();
        let normal = Normal::Linear(LinearSpringDashpot {
            normal_stiffness: 1.0,
            normal_damping: 0.3,
        });
        let friction = (self.friction > 0.0).then_some(CundallStrack {
            tangential_stiffness: 0.8,
            tangential_damping: 0.1,
            static_friction: self.friction,
            kinetic_friction: self.friction,
            sliding: Sliding::Spring,
        });
        let packing = Packing {
            number: (PER_BORE * (self.height + 0.1)).round() as usize,
            sizes: Sizes::Uniform(DIAMETERS),
            state: InitialState::Rest,
            axial_velocity: 0.0,
            temperature: 0.0,
            seed: self.seed,
        };
        let parameters = Parameters {
            body_force: -GRAVITY * DVec3::Z,
            ..Means::USUAL.parameters(ContactModel::new(normal, friction), TIME_STEP, 0.3)
        };
        let (bodies, _) = pack(&packing, &wall, normal)?;
        // Frictionless grains may turn round the axis for ever, and grains roll on for long; neither changes a weight.
        let mut simulation = Simulation::new(bodies, wall, parameters);
        let before = STARTS[1] + SUNK[0] / SINKING;
        simulation.advance((before / TIME_STEP) as u64)?;
        let interval = SUNK[1] / (SINKING * f64::from(READINGS) * TIME_STEP);
        let mut load = Load::default();
        for _ in 0..READINGS {
            simulation.advance(interval as u64)?;
            let sunk = SINKING * (simulation.time() - 0.5 * (STARTS[0] + STARTS[1]));
            load.add(&simulation, sunk, 1.0 / f64::from(READINGS));
        }
        Ok(load)
    }

    fn wall(&self) -> Wall {
        let length = THROAT + 1.25 * BORE * self.height + 5.0;
        let [radius, closed] = [0.5 * (BORE + 1.0), 0.3];
        let phases = [0.0, 1.0 / length, THROAT / length, 1.0 - 2.0 / length];
        let radii = [closed, closed, radius, radius];
        let table = RadiusTable::new(&phases, &radii).expect("phases ascend");
        let lattice = Lattice {
            spheres_per_ring: 12,
            rings_per_wave: 20,
            waves: 1,
            wavelength: length,
            sphere_diameter: 1.0,
            staggered: true,
        };
        let frequency = SINKING / length;
        let [begins, sinks] = STARTS;
        let knots = vec![(begins, 0.0), (sinks, frequency), (1e9, frequency)];
        let wall = PrescribedWall::new(
            lattice,
            radius,
            Contraction::Table(table),
            -1.0,
            Schedule::constant(radius - closed),
            Schedule::through(knots).expect("times ascend"),
        );
        Wall::Prescribed(wall.smooth())
    }
}

impl Load {
    /// Adds a part of what there is now, where the floor has sunk so far.
    fn add(&mut self, simulation: &Simulation, sunk: f64, part: f64) {
        let bodies = simulation.bodies();
        let section = THROAT + 1.0 - sunk;
        let place = |grain: usize| bodies.position[grain].z;
        for grain in 0..bodies.grains {
            let (above, mass) = (place(grain) - section, part * bodies.mass[grain]);
            if above < 0.0 {
                self.apparent -= mass;
            } else {
                self.filling += mass;
                self.moment += mass * above;
            }
        }
        for touch in simulation.touching() {
            let force = part * touch.force.z / GRAVITY;
            let here = place(touch.first);
            if touch.second < bodies.grains {
                let there = place(touch.second);
                self.vertical += force * (here.max(section) - there.max(section));
            } else if here < section {
                self.apparent += force;
            } else {
                self.radial += part * touch.normal_force / GRAVITY;
                self.friction += force;
            }
        }
    }

    /// rho A, mass per length of a column of the same mass and centre of mass \[m/d\].
    pub(crate) fn line_density(&self) -> f64 {
        0.5 * self.filling * self.filling / self.moment
    }

    /// K, the radial stress at the wall over the mean vertical one: D N/(4 integral of F dz), N the normal force on the wall.
    pub(crate) fn stress_ratio(&self) -> f64 {
        0.25 * BORE * self.radial / self.vertical
    }
}
