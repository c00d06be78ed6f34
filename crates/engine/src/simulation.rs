//! A simulation: spheres, wall, laws and clock, advanced step by step.

use std::sync::Arc;

use peristalsis_physics::contact::{
    ContactLaw, ContactModel, CundallStrack, Frictionless, Normal, NormalLaw, TangentialHistory,
};

pub use peristalsis_physics::method::Kernel;

use crate::bodies::Bodies;
use crate::error::EngineError;
use crate::fast;
use crate::fast::machine::Instructions;
use crate::fast::sorted::{Course, Sorted, Sorting};
use crate::forces::{Contacts, add_body_force, evaluate};
use crate::integrate::{Integrator, Past, Runaway, after_forces, before_forces};
use crate::ledger::{Ledger, Tally};
use crate::snapshot::{Snapshot, SnapshotView};
use crate::touching::{Touching, touching};
use crate::wall::Wall;
use crate::wall::contacts::{WallContact, add_up_smooth_contacts, for_each_contact};
use crate::wall::memory::WallMemory;

/// How a simulation is computed.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Parameters {
    /// The contact law.
    pub contact: ContactModel,
    /// The integrator of the motion.
    pub integrator: Integrator,
    /// Length of a step \[t\].
    pub time_step: f64,
    /// Skin of the neighbour list \[d\]; results depend on it by rounding at most.
    pub skin: f64,
    /// Which kernel computes the forces.
    pub kernel: Kernel,
    /// Body force on the grains: force over mass along +z, the same at all times \[d/t^2\].
    pub body_force: f64,
}

/// Grains in a peristaltic tube, advanced in time.
#[derive(Clone, Debug)]
pub struct Simulation {
    system: System,
    memory: Memory,
    /// The kernel that keeps the grains in the order of z, where it serves.
    sorted: Option<Box<Sorted>>,
}

/// Everything but the memory of contacts, whose type depends on the law.
#[derive(Clone, Debug)]
struct System {
    bodies: Bodies,
    wall: Wall,
    parameters: Parameters,
    past: Past,
    tally: Tally,
    ledger: Ledger,
    step: u64,
    limit: f64,
    scratch: fast::listed::Scratch,
}

/// A law in the plane of contact together with what its contacts remember, so that they cannot disagree.
#[derive(Clone, Debug)]
enum Memory {
    Smooth(Contacts<()>),
    Frictional(CundallStrack, Contacts<TangentialHistory>),
}

impl Simulation {
    /// A simulation that starts at time 0 with the given spheres.
    #[must_use]
    pub fn new(bodies: Bodies, wall: Wall, parameters: Parameters) -> Self {
        let mut simulation = Self::assemble(bodies, wall, parameters);
        let Self { system, memory, .. } = &mut simulation;
        memory.with_law(parameters.contact.normal, StartForces { system });
        system.ledger.initial_energy = system.energy();
        system.ledger.initial_axial_moment = system.axial_moment();
        simulation.choose_kernel(None);
        simulation
    }

    fn assemble(mut bodies: Bodies, mut wall: Wall, parameters: Parameters) -> Self {
        bodies.fold(wall.lattice().length());
        wall.move_to(0.0);
        let least_diameter = bodies
            .diameter
            .iter()
            .copied()
            .fold(f64::INFINITY, f64::min);
        Self {
            system: System {
                bodies,
                wall,
                parameters,
                past: Past::default(),
                tally: Tally::default(),
                ledger: Ledger::default(),
                step: 0,
                limit: 0.5 * least_diameter,
                scratch: fast::listed::Scratch::default(),
            },
            memory: match parameters.contact.friction {
                None => Memory::Smooth(Contacts::none()),
                Some(law) => Memory::Frictional(law, Contacts::none()),
            },
            sorted: None,
        }
    }

    /// Hands equal smooth grains in a prescribed tube to the kernel that is made for them.
    fn choose_kernel(&mut self, sorting: Option<&Sorting>) {
        let System {
            bodies,
            wall,
            parameters,
            ..
        } = &self.system;
        if let Wall::Prescribed(prescribed) = wall
            && parameters.kernel == Kernel::Fast
            && Sorted::serves(bodies, wall, parameters)
        {
            // No list is needed any more; what it took serves the kernel.
            self.memory = Memory::Smooth(Contacts::none());
            let sorted = Sorted::new(bodies, prescribed, parameters.skin, sorting);
            self.sorted = Some(Box::new(sorted));
        }
    }

    /// Advances by `steps` steps.
    ///
    /// # Errors
    /// [`EngineError::Diverged`] where a sphere moves by more than half the smallest diameter in one step, or its
    /// position is no longer finite; the state is then that of the step that failed.
    pub fn advance(&mut self, steps: u64) -> Result<(), EngineError> {
        let Self {
            system,
            memory,
            sorted,
        } = self;
        let outcome = match sorted {
            None => memory.with_law(system.parameters.contact.normal, Advance { system, steps }),
            Some(sorted) => system.advance_sorted(sorted, steps),
        };
        system.book_body_force();
        outcome
    }

    /// Computes with the given instructions (or the widest that the machine has, if it lacks them) and so many threads
    /// from now on, where a fast kernel runs; neither changes a bit of the results.
    ///
    /// Threads serve equal smooth grains in a prescribed tube, and pay from some ten thousand grains on.
    ///
    /// # Errors
    /// [`EngineError::Threads`] where the system gives no more threads.
    pub fn compute_with(
        &mut self,
        instructions: Instructions,
        threads: usize,
    ) -> Result<(), EngineError> {
        self.system.scratch.instructions = instructions;
        if let Some(sorted) = &mut self.sorted {
            let pool = (threads > 1)
                .then(|| rayon::ThreadPoolBuilder::new().num_threads(threads).build())
                .transpose()
                .map_err(|error| EngineError::Threads {
                    threads,
                    reason: error.to_string(),
                })?;
            sorted.compute_with(instructions, pool.map(Arc::new));
        }
        Ok(())
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
        let difference = self.system.wall.difference(&wall, self.time());
        if let Some(reason) = difference {
            return Err(EngineError::OtherWall { reason });
        }
        self.system.wall = wall;
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
        let (Memory::Frictional(law, _), Some(known)) = (
            &mut self.memory,
            &mut self.system.parameters.contact.friction,
        ) else {
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
    #[must_use]
    pub fn bodies(&self) -> &Bodies {
        &self.system.bodies
    }

    /// The wall as it is now.
    #[must_use]
    pub fn wall(&self) -> &Wall {
        &self.system.wall
    }

    /// How the simulation is computed.
    #[must_use]
    pub fn parameters(&self) -> &Parameters {
        &self.system.parameters
    }

    /// Sums over the contacts at the end of the last step.
    #[must_use]
    pub fn tally(&self) -> &Tally {
        &self.system.tally
    }

    /// Energies accumulated since the start.
    #[must_use]
    pub fn ledger(&self) -> &Ledger {
        &self.system.ledger
    }

    /// Steps done since the start.
    #[must_use]
    pub fn step(&self) -> u64 {
        self.system.step
    }

    /// Time since the start \[t\].
    #[must_use]
    pub fn time(&self) -> f64 {
        self.system.time()
    }

    /// Kinetic plus potential energy of grains and elastic wall \[m d^2/t^2\].
    #[must_use]
    pub fn energy(&self) -> f64 {
        self.system.energy()
    }

    /// Energy that the ledger cannot account for over the integral of |power that enters|.
    #[must_use]
    pub fn energy_residual(&self) -> f64 {
        self.system.ledger.relative_residual(self.system.energy())
    }

    /// Calls `visit` for each contact of a grain with the wall as all stands now, in a fixed order.
    ///
    /// The forces are those of the last step but for the velocities, which the integrator has corrected since.
    pub fn for_each_wall_contact(&self, visit: impl FnMut(WallContact)) {
        let System { bodies, wall, .. } = &self.system;
        match self.system.parameters.contact.normal {
            Normal::Linear(normal) => self.memory.visit(normal, bodies, wall, visit),
            Normal::Hertz(normal) => self.memory.visit(normal, bodies, wall, visit),
        }
    }

    /// Adds up what contacts of grains with the wall are, as [`Simulation::for_each_wall_contact`] visits them, piece by
    /// piece of the grains: `begin` gives what the sums of a piece begin with, pieces counted from 0, and `add` adds a
    /// contact to them. There is one piece at least; pieces, and so all sums, are the same for any number of threads.
    pub fn add_up_wall_contacts<S: Send>(
        &self,
        begin: impl Fn(usize) -> S + Sync,
        add: impl Fn(&mut S, WallContact) + Sync,
    ) -> Vec<S> {
        let System { bodies, wall, .. } = &self.system;
        if let (Wall::Prescribed(wall), Memory::Smooth(_)) = (wall, &self.memory) {
            let pool = self.sorted.as_ref().and_then(|sorted| sorted.pool());
            return match self.system.parameters.contact.normal {
                Normal::Linear(law) => add_up_smooth_contacts(law, bodies, wall, pool, begin, add),
                Normal::Hertz(law) => add_up_smooth_contacts(law, bodies, wall, pool, begin, add),
            };
        }
        let mut sums = begin(0);
        self.for_each_wall_contact(|contact| add(&mut sums, contact));
        vec![sums]
    }

    /// All contacts as they are now, with their forces; grain by grain.
    #[must_use]
    pub fn touching(&self) -> Vec<Touching> {
        let system = &self.system;
        // What contacts remember is taken out on the way.
        let mut memory = self.memory.clone();
        memory.with_law(system.parameters.contact.normal, Touch { system })
    }

    /// Everything that a restart needs to go on with the same bits.
    #[must_use]
    pub fn snapshot(&self) -> Snapshot {
        self.snapshot_view().into_owned()
    }

    /// The same, to be written down at once.
    #[must_use]
    pub fn snapshot_view(&self) -> SnapshotView<'_> {
        let (pair_histories, wall_histories) = match &self.memory {
            Memory::Smooth(_) => (Vec::new(), Vec::new()),
            Memory::Frictional(_, contacts) => (
                contacts
                    .pairs
                    .iter()
                    .filter(|entry| *entry.2 != TangentialHistory::default())
                    .map(|(i, j, history)| (i, j, *history))
                    .collect(),
                contacts
                    .wall
                    .iter()
                    .map(|(grain, sphere, history)| (grain, sphere, *history))
                    .collect(),
            ),
        };
        SnapshotView {
            step: self.system.step,
            bodies: &self.system.bodies,
            past: &self.system.past,
            tally: &self.system.tally,
            ledger: &self.system.ledger,
            pair_histories,
            wall_histories,
            sorting: self.sorted.as_ref().map(|sorted| sorted.sorting()),
        }
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
        let Self { system, memory, .. } = &mut simulation;
        system.past = snapshot.past;
        system.tally = snapshot.tally;
        system.ledger = snapshot.ledger;
        system.step = snapshot.step;
        system.wall.move_to(system.time());
        // Contacts with an elastic wall are found in the list.
        if let (Memory::Smooth(contacts), Wall::Elastic(_)) = (&mut *memory, &system.wall) {
            contacts.refresh(&system.bodies, &system.wall, parameters.skin);
        }
        if let Memory::Frictional(_, contacts) = memory {
            contacts.refresh(&system.bodies, &system.wall, parameters.skin);
            for (i, j, history) in snapshot.pair_histories {
                if !contacts.pairs.set_history(i, j, history) {
                    return Err(EngineError::SnapshotMismatch {
                        reason: format!(
                            "it remembers a contact of spheres {i} and {j}, which are far apart"
                        ),
                    });
                }
            }
            contacts.wall =
                WallMemory::from_entries(system.bodies.grains, &snapshot.wall_histories);
        }
        simulation.choose_kernel(snapshot.sorting.as_ref());
        Ok(simulation)
    }
}

impl System {
    fn time(&self) -> f64 {
        self.step as f64 * self.parameters.time_step
    }

    fn energy(&self) -> f64 {
        self.bodies.kinetic_energy(0..self.bodies.number())
            + self.bodies.rotational_energy()
            + self.tally.potential_energy()
    }
}

impl System {
    /// First moment of the grains' mass along the tube, sum m z with turns round it counted \[m d\].
    fn axial_moment(&self) -> f64 {
        let length = self.wall.lattice().length();
        (0..self.bodies.grains)
            .map(|i| self.bodies.mass[i] * self.bodies.unfolded(i, length))
            .sum()
    }

    /// The work of the body force, g sum m (z - z_0): exact whatever the path, so that no step need look at it.
    fn book_body_force(&mut self) {
        let body_force = self.parameters.body_force;
        if body_force != 0.0 {
            self.ledger.body_work =
                body_force * (self.axial_moment() - self.ledger.initial_axial_moment);
        }
    }

    fn advance_sorted(&mut self, sorted: &mut Sorted, steps: u64) -> Result<(), EngineError> {
        let Self {
            bodies,
            wall,
            parameters,
            tally,
            ledger,
            step,
            limit,
            ..
        } = self;
        let Wall::Prescribed(wall) = wall else {
            unreachable!("the sorted kernel serves prescribed walls only")
        };
        let course = Course {
            wall,
            tally,
            ledger,
            step,
            time_step: parameters.time_step,
            body_force: parameters.body_force,
            limit: *limit,
        };
        let outcome = match parameters.contact.normal {
            Normal::Linear(law) => sorted.advance(&law, course, bodies, steps),
            Normal::Hertz(law) => sorted.advance(&law, course, bodies, steps),
        };
        outcome.map_err(|runaway| self.diverged(runaway))
    }

    fn diverged(&self, runaway: Runaway) -> EngineError {
        EngineError::Diverged {
            step: self.step,
            time: self.time(),
            grain: runaway.body,
            grains: self.bodies.grains,
            displacement: runaway.displacement,
            limit: self.limit,
        }
    }
}

/// Work to be done with the laws known at compile time.
trait WithLaw {
    type Answer;
    fn run<N: NormalLaw, T: fast::listed::Remember>(
        self,
        law: &ContactLaw<N, T>,
        contacts: &mut Contacts<T::History<f64>>,
    ) -> Self::Answer;
}

impl Memory {
    /// Calls `visit` for each contact with the wall.
    fn visit<N: NormalLaw>(
        &self,
        normal: N,
        bodies: &Bodies,
        wall: &Wall,
        visit: impl FnMut(WallContact),
    ) {
        match self {
            Self::Smooth(contacts) => {
                let tangential = Frictionless;
                let law = ContactLaw { normal, tangential };
                for_each_contact(&law, bodies, wall, contacts, visit);
            }
            Self::Frictional(tangential, contacts) => {
                let tangential = *tangential;
                let law = ContactLaw { normal, tangential };
                for_each_contact(&law, bodies, wall, contacts, visit);
            }
        }
    }

    /// The one place where names of laws become types.
    fn with_law<W: WithLaw>(&mut self, normal: Normal, work: W) -> W::Answer {
        match (normal, self) {
            (Normal::Linear(normal), Self::Smooth(contacts)) => work.run(
                &ContactLaw {
                    normal,
                    tangential: Frictionless,
                },
                contacts,
            ),
            (Normal::Hertz(normal), Self::Smooth(contacts)) => work.run(
                &ContactLaw {
                    normal,
                    tangential: Frictionless,
                },
                contacts,
            ),
            (Normal::Linear(normal), Self::Frictional(tangential, contacts)) => work.run(
                &ContactLaw {
                    normal,
                    tangential: *tangential,
                },
                contacts,
            ),
            (Normal::Hertz(normal), Self::Frictional(tangential, contacts)) => work.run(
                &ContactLaw {
                    normal,
                    tangential: *tangential,
                },
                contacts,
            ),
        }
    }
}

/// Forces at the start, so that the first step knows its accelerations.
struct StartForces<'a> {
    system: &'a mut System,
}

impl WithLaw for StartForces<'_> {
    type Answer = ();

    fn run<N: NormalLaw, T: fast::listed::Remember>(
        self,
        law: &ContactLaw<N, T>,
        contacts: &mut Contacts<T::History<f64>>,
    ) {
        let System {
            bodies,
            wall,
            parameters,
            tally,
            ..
        } = self.system;
        contacts.refresh(bodies, wall, parameters.skin);
        *tally = evaluate(law, bodies, wall, contacts, 0.0);
        add_body_force(bodies, parameters.body_force);
    }
}

/// A look at the contacts.
struct Touch<'a> {
    system: &'a System,
}

impl WithLaw for Touch<'_> {
    type Answer = Vec<Touching>;

    fn run<N: NormalLaw, T: fast::listed::Remember>(
        self,
        law: &ContactLaw<N, T>,
        contacts: &mut Contacts<T::History<f64>>,
    ) -> Self::Answer {
        touching(law, &self.system.bodies, &self.system.wall, contacts)
    }
}

struct Advance<'a> {
    system: &'a mut System,
    steps: u64,
}

impl WithLaw for Advance<'_> {
    type Answer = Result<(), EngineError>;

    fn run<N: NormalLaw, T: fast::listed::Remember>(
        self,
        law: &ContactLaw<N, T>,
        contacts: &mut Contacts<T::History<f64>>,
    ) -> Self::Answer {
        let system = self.system;
        if system.parameters.kernel == Kernel::Fast {
            let course = fast::listed::Course {
                bodies: &mut system.bodies,
                wall: &mut system.wall,
                past: &mut system.past,
                tally: &mut system.tally,
                ledger: &mut system.ledger,
                step: &mut system.step,
                parameters: system.parameters,
                limit: system.limit,
            };
            let scratch = &mut system.scratch;
            return fast::listed::advance(law, course, contacts, scratch, self.steps)
                .map_err(|runaway| system.diverged(runaway));
        }
        let Parameters {
            integrator,
            time_step,
            skin,
            body_force,
            ..
        } = system.parameters;
        let length = system.wall.lattice().length();
        for _ in 0..self.steps {
            let System {
                bodies,
                wall,
                past,
                tally,
                ledger,
                step,
                limit,
                ..
            } = system;
            *step += 1;
            let time = *step as f64 * time_step;
            let grains = bodies.grains;
            before_forces(integrator, bodies, past, time_step, *limit).map_err(|runaway| {
                EngineError::Diverged {
                    step: *step,
                    time,
                    grain: runaway.body,
                    grains,
                    displacement: runaway.displacement,
                    limit: *limit,
                }
            })?;
            bodies.fold(length);
            // A wall that jumps does work on the contacts that it finds: what they store after the jump but not before.
            let stored_before_jump = wall.move_without_jump(time - time_step, time).then(|| {
                let (mut bodies, mut contacts) = (bodies.clone(), contacts.clone());
                contacts.refresh(&bodies, wall, skin);
                evaluate(law, &mut bodies, wall, &mut contacts, 0.0).contact_energy
            });
            wall.move_to(time);
            contacts.refresh(bodies, wall, skin);
            let after = evaluate(law, bodies, wall, contacts, time_step);
            add_body_force(bodies, body_force);
            if let Some(stored) = stored_before_jump {
                ledger.add_jump(after.contact_energy - stored);
            }
            after_forces(integrator, bodies, past, time_step);
            ledger.add_step(tally, &after, time_step);
            *tally = after;
        }
        Ok(())
    }
}
