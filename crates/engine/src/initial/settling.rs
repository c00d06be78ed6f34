//! Grains that come to rest under a body force.

use glam::DVec3;
use peristalsis_physics::method::Integrator;

use super::packing::PackingReport;
use crate::bodies::Bodies;
use crate::error::EngineError;
use crate::parameters::Parameters;
use crate::simulation::Simulation;
use crate::snapshot::Snapshot;
use crate::wall::Wall;

/// Mean kinetic energy of a grain at rest, with its rotation, in units of m g d: the mean mass, the body force and the
/// largest diameter.
pub const AT_REST: f64 = 1e-6;
/// How long grains fall at least before they are asked whether they rest, in units of sqrt(d/g).
const LEAST_TIME: f64 = 5.0;
/// How long they may take, in the same units.
const LONGEST_TIME: f64 = 500.0;
/// Time from one look to the next, and from one touch of the drag to the next, in the same units.
const INTERVAL: f64 = 0.1;

/// Lets grains fall in a wall that stands still as it is at t = 0, until they rest; then starts `wall` with them.
///
/// The grains move by their own contact law, and a drag slows them at the rate sqrt(g/d), g the body force and d their
/// largest diameter, so that a grain falls at sqrt(g d) at most. They rest where their mean kinetic energy is below
/// [`AT_REST`] m g d. Velocities are then set to zero; tangential springs of contacts stay. Answers with the simulation
/// at t = 0, and with what the contacts then bear.
///
/// # Errors
/// [`EngineError::NotSettled`] where they do not come to rest, as in a tube that is open along the body force;
/// [`EngineError::InvalidParameter`] without a body force, or for an elastic wall; [`EngineError::Diverged`];
/// [`EngineError::Stopped`] where `stop`, which is asked often, says so.
pub fn settle(
    bodies: Bodies,
    wall: Wall,
    parameters: Parameters,
    packed: PackingReport,
    stop: &dyn Fn() -> bool,
) -> Result<(Simulation, PackingReport), EngineError> {
    let force = parameters.body_force.length();
    let Some(standing) = wall.prescribed().filter(|_| force > 0.0) else {
        return Err(EngineError::InvalidParameter {
            parameter: "body.gravity",
            value: force,
            allowed: "grains settle under a positive one, in a wall under strain control",
        });
    };
    let standing = Wall::Prescribed(standing.at_rest());
    let grains = bodies.grains;
    let diameters = bodies.diameter[..grains].iter().copied();
    let largest = diameters.fold(0.0, f64::max);
    let rate = (force / largest.max(f64::MIN_POSITIVE)).sqrt();
    let mass: f64 = bodies.mass[..grains].iter().sum();
    let limit = AT_REST * mass * force * largest;

    let parameters_here = Parameters {
        // Its past would have to be slowed as well.
        integrator: Integrator::Verlet,
        ..parameters
    };
    let steps = (INTERVAL / (rate * parameters.time_step)).ceil().max(1.0);
    let interval = steps * parameters.time_step;
    let slower = libm::exp(-rate * interval);
    let mut simulation = Simulation::new(bodies, standing.clone(), parameters_here);
    let mut time = 0.0;
    loop {
        if stop() {
            return Err(EngineError::Stopped);
        }
        simulation.advance(steps as u64)?;
        time += rate * interval;
        let bodies = simulation.bodies();
        let kinetic = bodies.kinetic_energy(0..grains) + bodies.rotational_energy();
        if kinetic <= limit && time >= LEAST_TIME {
            break;
        }
        if time > LONGEST_TIME {
            return Err(EngineError::NotSettled {
                time: time / rate,
                energy: kinetic / (mass * force * largest),
                limit: AT_REST,
            });
        }
        let mut snapshot = simulation.snapshot();
        slow(&mut snapshot, slower);
        simulation = Simulation::restore(snapshot, standing.clone(), parameters_here)?;
    }
    let mut snapshot = simulation.snapshot();
    slow(&mut snapshot, 0.0);
    snapshot.bodies.turns.fill(0);
    let settled = Simulation::starting_with(snapshot, wall, parameters)?;
    let tally = settled.tally();
    let contacts = (tally.grain_contacts + tally.wall_contacts).max(1);
    let report = PackingReport {
        mean_overlap: tally.total_overlap / contacts as f64,
        largest_overlap: tally.largest_overlap,
        stored_energy: tally.contact_energy,
        ..packed
    };
    Ok((settled, report))
}

/// Velocities and spins times a factor.
fn slow(snapshot: &mut Snapshot, factor: f64) {
    let scale = |vectors: &mut [DVec3]| vectors.iter_mut().for_each(|it| *it *= factor);
    scale(&mut snapshot.bodies.velocity);
    scale(&mut snapshot.bodies.angular_velocity);
}
