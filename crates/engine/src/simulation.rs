//! A simulation: spheres, wall, laws and clock, advanced step by step.

mod contacts;
mod open;

use glam::DVec3;
use peristalsis_physics::contact::{GeneralHistory, TangentialHistory};
use peristalsis_physics::with_normal_law;

use crate::bodies::Bodies;
use crate::contacts::{Contacts, Memory, Remembered, with_contact_law};
use crate::ends::Ends;
use crate::error::EngineError;
use crate::fast::listed;
use crate::fast::machine::Instructions;
use crate::fast::sorted::{Sorted, Sorting};
use crate::fast::threads::{Threads, threads_that_pay};
use crate::forces::{Reference, add_body_force, evaluate};
use crate::integrate::Past;
use crate::ledger::{Ledger, Tally};
use crate::parameters::{Kernel, Parameters};
use crate::snapshot::{Snapshot, SnapshotView};
use crate::steps::Course;
use crate::wall::Wall;

/// Grains in a peristaltic tube, advanced in time.
#[derive(Clone, Debug)]
pub struct Simulation {
    bodies: Bodies,
    course: Course,
    parameters: Parameters,
    past: Past,
    memory: Memory,
    /// Longest displacement of a step \[d\].
    limit: f64,
    scratch: listed::Scratch,
    /// The kernel that keeps the grains in the order of z, where it serves.
    sorted: Option<Box<Sorted>>,
    /// The ends of an open tube.
    ends: Option<Box<Ends>>,
}

impl Simulation {
    /// A simulation that starts at time 0 with the given spheres.
    pub fn new(bodies: Bodies, wall: Wall, parameters: Parameters) -> Self {
        let mut simulation = Self::assemble(bodies, wall, parameters);
        simulation.refresh_contacts();
        simulation.begin();
        simulation
    }

    /// A simulation that starts at time 0 with the spheres of a snapshot, and with the springs of their contacts.
    ///
    /// # Errors
    /// [`EngineError::SnapshotMismatch`] where the snapshot cannot belong to such a simulation.
    pub(crate) fn starting_with(
        snapshot: Snapshot,
        wall: Wall,
        parameters: Parameters,
    ) -> Result<Self, EngineError> {
        snapshot.check(&wall, &parameters)?;
        let mut simulation = Self::assemble(snapshot.bodies, wall, parameters);
        simulation.ends = snapshot.ends.map(Box::new);
        simulation.refresh_contacts();
        let springs = [snapshot.pair_histories, snapshot.wall_histories];
        simulation.remember(springs, &snapshot.general_histories)?;
        simulation.begin();
        Ok(simulation)
    }

    /// Makes the neighbour list anew where it no longer holds.
    fn refresh_contacts(&mut self) {
        let (bodies, wall) = (&self.bodies, &self.course.wall);
        self.memory.refresh(bodies, wall, self.parameters.skin);
    }

    /// Works out the forces at the start, so that the first step knows its accelerations, and opens the ledger.
    fn begin(&mut self) {
        self.evaluate_here();
        self.course.ledger.initial_energy = self.energy();
        self.course.ledger.initial_moment = self.moment();
        self.choose_kernel(None);
    }

    /// Works out the forces where the spheres are; no time passes.
    fn evaluate_here(&mut self) {
        let Self {
            bodies,
            course,
            memory,
            parameters,
            ..
        } = self;
        with_contact_law!(parameters.contact.normal, memory, |law, contacts| {
            course.tally = evaluate(law, bodies, &course.wall, contacts, 0.0);
        });
        add_body_force(bodies, parameters.body_force);
    }

    /// Takes the springs of contacts from a snapshot; the neighbour list holds their pairs.
    fn remember(
        &mut self,
        springs: Remembered<TangentialHistory>,
        general: &Remembered<GeneralHistory>,
    ) -> Result<(), EngineError> {
        let grains = self.bodies.grains;
        match &mut self.memory {
            Memory::Smooth(_) => Ok(()),
            Memory::Frictional(_, contacts) => contacts.remember(grains, &springs),
            Memory::General(_, contacts) => contacts.remember(grains, general),
        }
    }

    fn assemble(mut bodies: Bodies, mut wall: Wall, mut parameters: Parameters) -> Self {
        if parameters.contact.is_general() {
            // No other knows rolling resistance and cohesion.
            parameters.kernel = Kernel::Reference;
        }
        bodies.fold(wall.length());
        wall.move_to(0.0);
        let diameters = || bodies.diameter.iter().copied();
        let least_diameter = diameters().fold(f64::INFINITY, f64::min);
        let memory = Memory::of(&parameters.contact, diameters().fold(0.0, f64::max));
        Self {
            bodies,
            course: Course {
                wall,
                tally: Tally::default(),
                ledger: Ledger::default(),
                step: 0,
                time_step: parameters.time_step,
            },
            parameters,
            past: Past::default(),
            memory,
            limit: 0.5 * least_diameter,
            scratch: listed::Scratch::default(),
            sorted: None,
            ends: None,
        }
    }

    /// Hands equal frictionless grains in a prescribed tube to the kernel that is made for them.
    fn choose_kernel(&mut self, sorting: Option<&Sorting>) {
        let (bodies, wall, parameters) = (&self.bodies, &self.course.wall, &self.parameters);
        // Its order along the tube is lost where grains are put elsewhere.
        let closed = self.ends.is_none();
        if closed && parameters.kernel == Kernel::Fast && Sorted::serves(bodies, wall, parameters) {
            // No list is needed any more; its memory serves the kernel.
            self.memory = Memory::Smooth(Contacts::none());
            let sorted = Sorted::new(bodies, wall, parameters.skin, sorting);
            self.sorted = sorted.map(Box::new);
        }
    }

    /// Advances by `steps` steps.
    ///
    /// # Errors
    /// [`EngineError::Diverged`] where a sphere moves by more than half the smallest diameter in one step, or its
    /// position is no longer finite; the state is then the one in which the step failed.
    pub fn advance(&mut self, steps: u64) -> Result<(), EngineError> {
        if self.ends.is_none() {
            return self.advance_closed(steps);
        }
        let end = self.step() + steps;
        while self.step() < end {
            let to_look = Ends::steps_to_look(self.step());
            self.advance_closed(to_look.min(end - self.step()))?;
            if Ends::steps_to_look(self.step()) == Ends::steps_to_look(0) {
                self.look_at_ends();
            }
        }
        Ok(())
    }

    /// Advances without a look at open ends.
    fn advance_closed(&mut self, steps: u64) -> Result<(), EngineError> {
        if !self.scratch.threads.are_here() {
            self.compute_with(self.scratch.instructions, self.scratch.threads.number())?;
        }
        let Self {
            bodies,
            course,
            parameters,
            past,
            memory,
            limit,
            scratch,
            sorted,
            ..
        } = self;
        let (normal, body_force) = (parameters.contact.normal, parameters.body_force);
        let outcome = match sorted {
            Some(sorted) => with_normal_law!(normal, law => {
                sorted.advance(&law, course, bodies, (body_force, *limit), steps)
            }),
            None => {
                let length = course.wall.length();
                macro_rules! reference {
                    ($law:ident, $contacts:ident) => {
                        Reference {
                            law: $law,
                            contacts: $contacts,
                            bodies,
                            past,
                            parameters,
                            limit: *limit,
                            length,
                            sums: Tally::default(),
                        }
                    };
                }
                let is_plain = parameters.kernel == Kernel::Reference;
                with_contact_law!(
                    normal,
                    memory,
                    |law, contacts| course.advance(&mut reference!(law, contacts), steps),
                    match is_plain {
                        true => course.advance(&mut reference!(law, contacts), steps),
                        false => listed::advance(reference!(law, contacts), scratch, course, steps),
                    }
                )
            }
        };
        if body_force != DVec3::ZERO {
            // Its work, g . sum m (r - r_0): exact whatever the path, so that no step need look at it.
            let moved = self.moment() - self.course.ledger.initial_moment;
            self.course.ledger.body_work = body_force.dot(moved);
        }
        outcome.map_err(|runaway| EngineError::Diverged {
            step: self.course.step,
            time: self.course.time(),
            grain: runaway.body,
            grains: self.bodies.grains,
            outside: self.is_outside(runaway.body),
            displacement: runaway.displacement,
            limit: self.limit,
        })
    }

    /// Computes with the given instructions (or the widest that the machine has, if it lacks them) and number of threads
    /// from now on, where a fast kernel runs; neither changes a bit of the results.
    ///
    /// # Errors
    /// [`EngineError::Threads`] where the system gives no more threads.
    pub fn compute_with(
        &mut self,
        instructions: Instructions,
        threads: usize,
    ) -> Result<(), EngineError> {
        if threads != self.scratch.threads.number() || !self.scratch.threads.are_here() {
            self.scratch.threads = Threads::new(threads)?;
        }
        self.scratch.instructions = instructions;
        if let Some(sorted) = &mut self.sorted {
            sorted.compute_with(instructions, self.scratch.threads.clone());
        }
        Ok(())
    }

    /// Whether several threads can compute it; the reference kernel uses one.
    pub fn takes_threads(&self) -> bool {
        self.parameters.kernel == Kernel::Fast
    }

    /// Number of threads that pay on a machine with `processors` processors.
    pub fn threads_that_pay(&self, processors: usize) -> usize {
        threads_that_pay(self.parameters.kernel, self.bodies.number(), processors)
    }

    /// Lets the drive take another course from now on: `wall` is this wall with other schedules, which have the values
    /// of the old ones now.
    ///
    /// A simulation that never calls it, and one that calls it with the wall that it has, compute the same bits.
    ///
    /// # Errors
    /// [`EngineError::OtherWall`] where `wall` differs in more, or would not be where the wall is; nothing is changed.
    pub fn drive_by(&mut self, mut wall: Wall) -> Result<(), EngineError> {
        wall.move_to(self.time());
        if let Some(reason) = self.wall().difference(&wall, self.time()) {
            return Err(EngineError::OtherWall { reason });
        }
        self.course.wall = wall;
        Ok(())
    }

    /// Gives contacts other coefficients of friction from now on; a tangential spring beyond the new bound slides.
    ///
    /// # Errors
    /// [`EngineError::InvalidParameter`] where there is no friction to change, or for coefficients that no law has: both
    /// finite, `kinetic` from 0 to `static_friction`, that positive. Nothing is changed.
    pub fn set_friction(&mut self, static_friction: f64, kinetic: f64) -> Result<(), EngineError> {
        let refused = |parameter, value, allowed| {
            Err(EngineError::InvalidParameter {
                parameter,
                value,
                allowed,
            })
        };
        if !(static_friction.is_finite() && static_friction > 0.0) {
            let allowed = "a positive number";
            return refused("contact.static_friction", static_friction, allowed);
        }
        if !(0.0..=static_friction).contains(&kinetic) {
            let allowed = "from 0 to contact.static_friction";
            return refused("contact.kinetic_friction", kinetic, allowed);
        }
        let law = match &mut self.memory {
            Memory::Frictional(law, _) => Some(law),
            Memory::General(law, _) => law.friction.as_mut(),
            Memory::Smooth(_) => None,
        };
        let (Some(law), Some(known)) = (law, &mut self.parameters.contact.friction) else {
            let allowed = "grains that began without friction keep none";
            return refused("contact.static_friction", static_friction, allowed);
        };
        for law in [law, known] {
            law.static_friction = static_friction;
            law.kinetic_friction = kinetic;
        }
        Ok(())
    }

    /// The spheres.
    pub fn bodies(&self) -> &Bodies {
        &self.bodies
    }

    /// The wall as it is now.
    pub fn wall(&self) -> &Wall {
        &self.course.wall
    }

    /// How the simulation is computed.
    pub fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// Sums over the contacts at the end of the last step.
    pub fn tally(&self) -> &Tally {
        &self.course.tally
    }

    /// Energies accumulated since the start.
    pub fn ledger(&self) -> &Ledger {
        &self.course.ledger
    }

    /// Steps done since the start.
    pub fn step(&self) -> u64 {
        self.course.step
    }

    /// Time since the start \[t\].
    pub fn time(&self) -> f64 {
        self.course.time()
    }

    /// Kinetic plus potential energy of elastic wall and grains, without those that wait outside \[m d^2/t^2\].
    pub fn energy(&self) -> f64 {
        let present = (0..self.bodies.number()).filter(|&sphere| self.is_present(sphere));
        let kinetic_energy = present.map(|sphere| self.bodies.kinetic_energy(sphere..sphere + 1));
        kinetic_energy.sum::<f64>()
            + self.bodies.rotational_energy()
            + self.tally().potential_energy()
    }

    /// Energy that the ledger cannot account for over what entered: [`Ledger::relative_residual`].
    pub fn energy_residual(&self) -> f64 {
        self.ledger().relative_residual(self.energy())
    }

    /// Everything that a restart needs to go on with the same bits.
    pub fn snapshot(&self) -> Snapshot {
        self.snapshot_view().into_owned()
    }

    /// As [`Simulation::snapshot`], without a copy: to be written down at once.
    pub fn snapshot_view(&self) -> SnapshotView<'_> {
        let ([pair_histories, wall_histories], general_histories) = match &self.memory {
            Memory::Smooth(_) => Default::default(),
            Memory::Frictional(_, contacts) => (contacts.remembered(), Default::default()),
            Memory::General(_, contacts) => (Default::default(), contacts.remembered()),
        };
        SnapshotView {
            step: self.step(),
            bodies: self.bodies(),
            past: &self.past,
            tally: self.tally(),
            ledger: self.ledger(),
            pair_histories,
            wall_histories,
            general_histories,
            sorting: self.sorting(),
            ends: self.ends(),
        }
    }

    /// The order of the grains in the sorted kernel; `None` with another kernel, or if a grain has left all bounds: the run
    /// diverged.
    fn sorting(&self) -> Option<Sorting> {
        let sorting = self.sorted.as_ref()?.sorting();
        let (bodies, wall) = (self.bodies(), self.wall());
        let strips = Sorted::strips(bodies, wall, self.parameters.skin);
        let is_order = sorting.check(bodies.grains, strips, wall.length()).is_ok();
        is_order.then_some(sorting)
    }

    /// Goes on from a snapshot of a simulation with this wall and these parameters.
    ///
    /// # Errors
    /// [`EngineError::SnapshotMismatch`] where the snapshot cannot belong to such a simulation.
    pub fn restore(
        snapshot: Snapshot,
        wall: Wall,
        parameters: Parameters,
    ) -> Result<Self, EngineError> {
        snapshot.check(&wall, &parameters)?;
        let mut simulation = Self::assemble(snapshot.bodies, wall, parameters);
        simulation.past = snapshot.past;
        simulation.ends = snapshot.ends.map(Box::new);
        let course = &mut simulation.course;
        (course.tally, course.ledger) = (snapshot.tally, snapshot.ledger);
        course.step = snapshot.step;
        course.wall.move_to(course.time());
        // Contacts with mobile spheres of the wall, and all that have a history, are found in the list.
        let is_smooth = matches!(simulation.memory, Memory::Smooth(_));
        if course.wall.mobile_spheres() > 0 || !is_smooth {
            simulation.refresh_contacts();
        }
        let springs = [snapshot.pair_histories, snapshot.wall_histories];
        simulation.remember(springs, &snapshot.general_histories)?;
        simulation.choose_kernel(snapshot.sorting.as_ref());
        Ok(simulation)
    }

    /// Whether a grain is beyond the wall altogether.
    fn is_outside(&self, sphere: usize) -> bool {
        let (place, wall) = (self.bodies.position[sphere], self.wall());
        let reach = 0.5 * (self.bodies.diameter[sphere] + wall.sphere_diameter());
        let from_axis = libm::hypot(place.x, place.y);
        sphere < self.bodies.grains
            && from_axis.is_finite()
            && from_axis > wall.usual_radius() + reach
    }

    /// First moment of the mass of the grains that are there, sum m r with turns round the tube counted \[m d\].
    fn moment(&self) -> DVec3 {
        let (bodies, length) = (&self.bodies, self.wall().length());
        let place = |i: usize| bodies.position[i].with_z(bodies.unfolded(i, length));
        let present = (0..bodies.grains).filter(|&grain| self.is_present(grain));
        present.map(|i| bodies.mass[i] * place(i)).sum()
    }
}
