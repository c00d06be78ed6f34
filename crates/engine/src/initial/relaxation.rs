//! Growth of a packing to its size while its elastic energy is minimised.

use glam::DVec3;
use peristalsis_physics::contact::{ContactLaw, Frictionless, NormalLaw};

use super::packing::{LARGEST_MEAN_OVERLAP, PackingReport};
use crate::bodies::Bodies;
use crate::contacts::Contacts;
use crate::error::EngineError;
use crate::fast::sorted::Sorted;
use crate::forces::evaluate;
use crate::ledger::Tally;
use crate::wall::Wall;

/// Sizes that the grains grow through, in units of their own.
const STAGES: [f64; 6] = [0.5, 0.6, 0.7, 0.8, 0.9, 1.0];
/// Iterations of each stage but the last.
const STAGE_ITERATIONS: usize = 100;
/// Iterations of the last.
const LAST_ITERATIONS: usize = 3_000;
/// Largest force that counts as balanced, in units of the force at an overlap of a tenth of a diameter.
const BALANCED: f64 = 1e-6;
/// Overlap in units of the largest diameter above which, after the first iterations at full size, nothing will help.
const HOPELESS: f64 = 0.65;
/// Part of the grains that may stand outside the wall: a lattice that leaks lets a few through, a tube that is too full
/// presses out all that are too many and relaxes to a moderate overlap.
const LARGEST_PART_OUTSIDE: f64 = 0.01;

/// Grows and relaxes the grains; the wall stands still.
pub(super) fn grow<N: NormalLaw>(
    normal: &N,
    bodies: &mut Bodies,
    wall: &Wall,
    stop: &dyn Fn() -> bool,
) -> Result<PackingReport, EngineError> {
    let law = ContactLaw {
        normal: normal.undamped(),
        tangential: Frictionless,
    };
    let full: Vec<f64> = bodies.diameter.clone();
    let largest = full[..bodies.grains].iter().copied().fold(0.0, f64::max);
    let grains = bodies.grains;
    let does_not_fit = |mean_overlap: f64, outside: usize| EngineError::DoesNotFit {
        grains,
        mean_overlap,
        limit: LARGEST_MEAN_OVERLAP * largest,
        outside,
    };
    let mut bodies_now = core::mem::take(bodies);
    let mut descent = Descent::new(&law, &bodies_now, largest);
    for scale in STAGES {
        for (diameter, full) in bodies_now.diameter[..bodies.grains].iter_mut().zip(&full) {
            *diameter = scale * full;
        }
        descent.restart(0.2 * descent.longest_step);
        // The kernel of the last stage makes room first.
        descent.forces = Forces::Listed(Box::new(Contacts::none()));
        descent.forces = Forces::between(&bodies_now, wall);
        descent.run(&law, &mut bodies_now, wall, STAGE_ITERATIONS, stop)?;
    }
    let overlap = descent.report.mean_overlap;
    let outside = pressed_out(&bodies_now, wall);
    if overlap > HOPELESS * largest || too_many(outside, grains) {
        return Err(does_not_fit(overlap, outside));
    }
    descent.run(&law, &mut bodies_now, wall, LAST_ITERATIONS, stop)?;
    let report = descent.report;
    let outside = pressed_out(&bodies_now, wall);
    if report.mean_overlap > LARGEST_MEAN_OVERLAP * largest || too_many(outside, grains) {
        return Err(does_not_fit(report.mean_overlap, outside));
    }
    bodies_now.turns.fill(0);
    bodies_now.velocity.fill(DVec3::ZERO);
    bodies_now.acceleration.fill(DVec3::ZERO);
    *bodies = bodies_now;
    Ok(report)
}

/// Grains whose centres lie outside R + d/2, R the radius of the standing wall at their place and d their diameter.
fn pressed_out(bodies: &Bodies, wall: &Wall) -> usize {
    (0..bodies.grains)
        .filter(|&grain| {
            let place = bodies.position[grain];
            let limit = wall.radius(place.z) + 0.5 * bodies.diameter[grain];
            place.x * place.x + place.y * place.y > limit * limit
        })
        .count()
}

fn too_many(outside: usize, grains: usize) -> bool {
    outside as f64 > LARGEST_PART_OUTSIDE * grains as f64
}

/// The kernel that finds the forces: the one for equal grains in a prescribed tube where it serves, else the reference.
enum Forces {
    Listed(Box<Contacts<()>>),
    Sorted(Box<Sorted>),
}

/// Skin of the neighbour search \[d\].
const SKIN: f64 = 0.3;

impl Forces {
    fn between(bodies: &Bodies, wall: &Wall) -> Self {
        match Sorted::new(bodies, wall, SKIN, None) {
            Some(sorted) => Self::Sorted(Box::new(sorted)),
            None => Self::Listed(Box::new(Contacts::none())),
        }
    }

    fn evaluate<N: NormalLaw>(
        &mut self,
        law: &ContactLaw<N, Frictionless>,
        bodies: &mut Bodies,
        wall: &Wall,
    ) -> Tally {
        match self {
            Self::Sorted(sorted) => sorted.evaluate(&law.normal, wall, bodies),
            Self::Listed(contacts) => {
                contacts.refresh(bodies, wall, SKIN);
                evaluate(law, bodies, wall, contacts, 0.0)
            }
        }
    }
}

/// Damped descent in energy: motion under the elastic forces whose velocity is turned towards the force and stopped when
/// it runs uphill (FIRE; Bitzek et al., Phys. Rev. Lett. 97, 170201 (2006)).
struct Descent {
    forces: Forces,
    velocity: Vec<DVec3>,
    time_step: f64,
    longest_step: f64,
    mixing: f64,
    downhill: usize,
    balanced: f64,
    largest_move: f64,
    report: PackingReport,
}

/// Mixing of force direction into the velocity at the start of a descent.
const MIXING: f64 = 0.1;

impl Descent {
    fn new<N: NormalLaw>(law: &ContactLaw<N, Frictionless>, bodies: &Bodies, largest: f64) -> Self {
        let overlap = 0.1 * largest;
        // A grain among twelve partners, with mass 1: omega^2 = 12 k; the explicit limit is 2/omega.
        let stiffness = law.normal.stiffness(overlap, 0.25 * largest);
        let longest_step = 1.0 / (12.0 * stiffness).sqrt();
        Self {
            forces: Forces::Listed(Box::new(Contacts::none())),
            velocity: vec![DVec3::ZERO; bodies.grains],
            time_step: 0.2 * longest_step,
            longest_step,
            mixing: MIXING,
            downhill: 0,
            balanced: BALANCED * stiffness * overlap,
            largest_move: overlap,
            report: PackingReport::default(),
        }
    }

    /// Stops all motion and goes on with another step.
    fn restart(&mut self, time_step: f64) {
        self.velocity.fill(DVec3::ZERO);
        self.time_step = time_step;
        self.mixing = MIXING;
        self.downhill = 0;
    }

    fn run<N: NormalLaw>(
        &mut self,
        law: &ContactLaw<N, Frictionless>,
        bodies: &mut Bodies,
        wall: &Wall,
        iterations: usize,
        stop: &dyn Fn() -> bool,
    ) -> Result<(), EngineError> {
        for _ in 0..iterations {
            if stop() {
                return Err(EngineError::Stopped);
            }
            let tally = self.forces.evaluate(law, bodies, wall);
            self.report.iterations += 1;
            self.report.stored_energy = tally.contact_energy;
            self.report.largest_overlap = tally.largest_overlap;
            let contacts = (tally.grain_contacts + tally.wall_contacts).max(1);
            self.report.mean_overlap = tally.total_overlap / contacts as f64;
            if self.step(bodies) {
                break;
            }
            bodies.fold(wall.length());
        }
        Ok(())
    }

    /// One move; `true` where all forces are balanced.
    fn step(&mut self, bodies: &mut Bodies) -> bool {
        // Forces, with mass 1 for each grain whatever its size.
        let force = |i: usize| bodies.acceleration[i] * bodies.mass[i];
        let (mut power, mut speed, mut strength, mut largest) = (0.0, 0.0, 0.0, 0.0_f64);
        for (i, velocity) in self.velocity.iter().enumerate() {
            let force = force(i);
            power += force.dot(*velocity);
            speed += velocity.length_squared();
            strength += force.length_squared();
            largest = largest.max(force.length_squared());
        }
        if largest.sqrt() < self.balanced {
            return true;
        }
        if power > 0.0 {
            let along = self.mixing * (speed / strength).sqrt();
            for (i, velocity) in self.velocity.iter_mut().enumerate() {
                *velocity = (1.0 - self.mixing) * *velocity + along * force(i);
            }
            self.downhill += 1;
            if self.downhill > 5 {
                self.time_step = (1.1 * self.time_step).min(self.longest_step);
                self.mixing *= 0.99;
            }
        } else {
            self.restart(0.5 * self.time_step);
        }
        for i in 0..self.velocity.len() {
            self.velocity[i] += self.time_step * force(i);
        }
        for (i, velocity) in self.velocity.iter().enumerate() {
            let mut by = self.time_step * *velocity;
            let length = by.length();
            if length > self.largest_move {
                by *= self.largest_move / length;
            }
            bodies.position[i] += by;
        }
        false
    }
}
