//! The ends of an open tube: grains leave through them, wait outside, and are put in again at the inlet.
//!
//! The tube stays one period of the cell in which neighbours are sought. A gap at its end, in which no grain stays, keeps
//! what leaves from what comes in. u is the distance from the inlet towards the outlet: the tube is 0 <= u <= L - gap.
//! All of it is done at fixed steps, with random numbers of that step, so that no bit depends on how a run is divided.

mod opening;
mod transit_times;

use glam::DVec3;
use peristalsis_physics::ends::{Inlet, STEPS_PER_LOOK, gap};
use rand_chacha::ChaCha8Rng;
use rand_core::SeedableRng;

use self::opening::Opening;
pub use self::transit_times::TransitTimes;
use crate::bodies::Bodies;
use crate::wall::Wall;

/// Stream of the random numbers of the inlet.
const STREAM: u64 = 11;
/// Numbers that a look may draw: the looks of a run never share one.
const NUMBERS_PER_LOOK: u128 = 1 << 24;
/// Radii of the tube from the axis to the nearest waiting grain.
const FAR: f64 = 3.0;
/// From one waiting grain to the next, in largest diameters: they never touch.
const APART: f64 = 2.0;

/// The open ends of a tube.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct OpenEnds {
    /// +1 where the outlet is the end towards +z, -1 where it is the end towards -z.
    pub heading: f64,
    /// How grains come in.
    pub inlet: Inlet,
    /// Seed of the places where they are put.
    pub seed: u64,
    /// Looks from one at which an inlet without a feed rate puts grains in to the next; 1 or more.
    pub looks_per_feeding: u64,
}

/// Grains that passed, and their mass.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Passed {
    /// Grains.
    pub grains: u64,
    /// Mass \[m\].
    pub mass: f64,
}

impl Passed {
    fn add(&mut self, mass: f64) {
        self.grains += 1;
        self.mass += mass;
    }
}

/// Grains, mass and energy that have passed the ends since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Passages {
    /// Left through the outlet.
    pub discharged: Passed,
    /// Left through the inlet, against the flow.
    pub returned: Passed,
    /// Left beside the tube: they had gone through its wall.
    pub leaked: Passed,
    /// Put in at the inlet.
    pub fed: Passed,
    /// Looks at which a grain would have been put in, and none waited.
    pub starved: u64,
}

/// Where a grain is, beside its place.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
struct Station {
    /// Whether it waits outside.
    waits: bool,
    /// Time at which it was put in; `None` for one that was there at the start \[t\].
    entered: Option<f64>,
    /// Change of its z by being put elsewhere, turns counted \[d\].
    carried: f64,
}

/// The ends of an open tube, and the grains outside it.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Ends {
    open: OpenEnds,
    gap: f64,
    largest_diameter: f64,
    stations: Vec<Station>,
    /// Grains that wait outside, the next one first.
    queue: Vec<u32>,
    passages: Passages,
    transit_times: TransitTimes,
}

/// The changes that a look at the ends has made.
pub(crate) struct Look {
    /// Whether a grain has left the tube or come in.
    pub(crate) passed: bool,
    /// Grains that were put elsewhere, or held where they wait.
    pub(crate) placed: Vec<usize>,
}

impl Ends {
    /// Opens the ends at time 0. Grains in the gap wait outside, and so do `more` with these diameters, which are added.
    pub(crate) fn begin(
        open: OpenEnds,
        bodies: &mut Bodies,
        wall: &Wall,
        time_step: f64,
        more: &[f64],
    ) -> Self {
        bodies.fold(wall.length());
        bodies.turns.fill(0);
        let inside = bodies.grains;
        bodies.push_grains_at_rest(more);
        let largest_diameter = bodies.diameter.iter().copied().fold(0.0, f64::max);
        let station = Station {
            waits: false,
            entered: None,
            carried: 0.0,
        };
        let mut ends = Self {
            open,
            gap: gap(largest_diameter),
            largest_diameter,
            stations: vec![station; bodies.grains],
            queue: Vec::new(),
            passages: Passages::default(),
            transit_times: TransitTimes::new(STEPS_PER_LOOK as f64 * time_step),
        };
        let length = ends.length(wall);
        for grain in 0..bodies.grains {
            if grain >= inside || !(0.0..=length).contains(&ends.along(bodies, grain, wall)) {
                ends.stations[grain].waits = true;
                ends.queue.push(grain as u32);
                ends.park(bodies, grain, wall);
            }
        }
        ends
    }

    /// Steps from `step` to the next look.
    pub(crate) fn steps_to_look(step: u64) -> u64 {
        STEPS_PER_LOOK - step % STEPS_PER_LOOK
    }

    /// Whether this can be the ends of a tube with so many grains.
    pub(crate) fn fits(&self, grains: usize) -> bool {
        let waiting = self.stations.iter().filter(|it| it.waits).count();
        let waits = |&grain: &u32| {
            let station = self.stations.get(grain as usize);
            station.is_some_and(|station| station.waits)
        };
        self.stations.len() == grains
            && self.queue.len() == waiting
            && self.queue.iter().all(waits)
            && self.transit_times.fits()
    }

    /// Length of the tube between its ends \[d\].
    pub fn length(&self, wall: &Wall) -> f64 {
        wall.length() - self.gap
    }

    /// Whether a grain waits outside.
    pub fn waits(&self, grain: usize) -> bool {
        self.stations[grain].waits
    }

    /// Steps from one look at which the inlet may put grains in to the next.
    pub fn steps_per_feeding(&self) -> u64 {
        match self.open.inlet.feed_rate {
            Some(_) => STEPS_PER_LOOK,
            None => STEPS_PER_LOOK * self.open.looks_per_feeding,
        }
    }

    /// Grains that wait outside.
    pub fn waiting(&self) -> usize {
        self.queue.len()
    }

    /// Grains, mass and energy that have passed the ends since the start.
    pub fn passages(&self) -> &Passages {
        &self.passages
    }

    /// Transit times of the grains that the inlet put in and that left through the outlet.
    pub fn transit_times(&self) -> &TransitTimes {
        &self.transit_times
    }

    /// Change of a grain's z by being put in again, turns counted \[d\].
    pub fn carried(&self, grain: usize) -> f64 {
        self.stations[grain].carried
    }

    /// Takes out the grains that have left, and puts others in, at the end of a step.
    pub(crate) fn look(
        &mut self,
        bodies: &mut Bodies,
        wall: &Wall,
        (step, time): (u64, f64),
    ) -> Look {
        let mut look = Look {
            passed: false,
            placed: Vec::new(),
        };
        // Those that wait fall a little between two looks.
        for place in 0..self.queue.len() {
            let grain = self.queue[place] as usize;
            set(bodies, grain, self.parking_place(grain, wall), 0.0);
            look.placed.push(grain);
        }
        let length = self.length(wall);
        for grain in 0..bodies.grains {
            let along = self.along(bodies, grain, wall);
            if self.stations[grain].waits || (0.0..=length).contains(&along) {
                continue;
            }
            self.count(bodies, grain, wall, along > length, time);
            self.stations[grain].waits = true;
            self.queue.push(grain as u32);
            self.park(bodies, grain, wall);
            look.placed.push(grain);
            look.passed = true;
        }
        self.feed(bodies, wall, (step, time), &mut look);
        look
    }

    /// Counts a grain that has left.
    fn count(&mut self, bodies: &Bodies, grain: usize, wall: &Wall, at_outlet: bool, time: f64) {
        let (place, mass) = (bodies.position[grain], bodies.mass[grain]);
        let from_axis = libm::hypot(place.x, place.y);
        let passages = &mut self.passages;
        if from_axis > wall.radius(place.z) + 0.5 * bodies.diameter[grain] {
            passages.leaked.add(mass);
        } else if at_outlet {
            passages.discharged.add(mass);
            if let Some(entered) = self.stations[grain].entered {
                self.transit_times.add(time - entered);
            }
        } else {
            passages.returned.add(mass);
        }
    }

    /// Puts in as many of the waiting grains as are due and find a place.
    fn feed(
        &mut self,
        bodies: &mut Bodies,
        wall: &Wall,
        (step, time): (u64, f64),
        look: &mut Look,
    ) {
        let mut due = match self.open.inlet.feed_rate {
            Some(rate) => ((rate * time) as u64).saturating_sub(self.passages.fed.grains),
            None if (step / STEPS_PER_LOOK).is_multiple_of(self.open.looks_per_feeding) => u64::MAX,
            None => 0,
        };
        if due == 0 {
            return;
        }
        let mut random = ChaCha8Rng::seed_from_u64(self.open.seed);
        random.set_stream(STREAM);
        random.set_word_pos(u128::from(step / STEPS_PER_LOOK) * NUMBERS_PER_LOOK);
        let mut opening = self.opening(bodies, wall);
        let mut put_in = 0;
        while due > 0 && put_in < self.queue.len() {
            let grain = self.queue[put_in] as usize;
            let diameter = bodies.diameter[grain];
            let Some(place) = opening.place(diameter, &mut random) else {
                break;
            };
            let velocity = self.open.heading * self.open.inlet.velocity;
            self.put(bodies, grain, wall, place, velocity);
            look.placed.push(grain);
            look.passed = true;
            self.stations[grain].waits = false;
            self.stations[grain].entered = Some(time);
            self.passages.fed.add(bodies.mass[grain]);
            opening.fill(place, diameter);
            (put_in, due) = (put_in + 1, due.saturating_sub(1));
        }
        self.queue.drain(..put_in);
        if due > 0
            && self.queue.is_empty()
            && opening.place(self.largest_diameter, &mut random).is_some()
        {
            self.passages.starved += 1;
        }
    }

    /// The stretch where grains are put in, as it is now.
    fn opening<'a>(&self, bodies: &Bodies, wall: &'a Wall) -> Opening<'a> {
        let inlet = self.open.inlet;
        let begin = (self.length(wall) - inlet.head).max(0.0);
        let reach = begin - self.largest_diameter..begin + inlet.length + self.largest_diameter;
        let is_near = |grain: &usize| {
            !self.stations[*grain].waits && reach.contains(&self.along(bodies, *grain, wall))
        };
        let near = (0..bodies.grains).filter(is_near);
        let near = near.map(|grain| (bodies.position[grain], bodies.diameter[grain]));
        let ends = [begin, begin + inlet.length].map(|along| self.z(along, wall));
        Opening::new(wall, ends, near.collect())
    }

    /// u of a grain.
    fn along(&self, bodies: &Bodies, grain: usize, wall: &Wall) -> f64 {
        let length = wall.length();
        let unfolded = bodies.unfolded(grain, length);
        match self.open.heading > 0.0 {
            true => unfolded,
            false => length - unfolded,
        }
    }

    /// z of u.
    fn z(&self, along: f64, wall: &Wall) -> f64 {
        match self.open.heading > 0.0 {
            true => along,
            false => wall.length() - along,
        }
    }

    /// Brings a grain to where it waits.
    fn park(&mut self, bodies: &mut Bodies, grain: usize, wall: &Wall) {
        let place = self.parking_place(grain, wall);
        self.put(bodies, grain, wall, place, 0.0);
    }

    /// Puts a grain elsewhere, with an axial velocity and without spin.
    fn put(&mut self, bodies: &mut Bodies, grain: usize, wall: &Wall, place: DVec3, velocity: f64) {
        self.stations[grain].carried += place.z - bodies.unfolded(grain, wall.length());
        set(bodies, grain, place, velocity);
    }

    /// Where a grain waits: beside the tube, clear of its wall and of all others.
    pub(crate) fn parking_place(&self, grain: usize, wall: &Wall) -> DVec3 {
        let spacing = APART * self.largest_diameter;
        let layers = (wall.length() / spacing).floor().max(1.0) as usize;
        let mut ring = grain / layers;
        let mut radius = FAR * wall.usual_radius() + wall.sphere_diameter() + spacing;
        loop {
            let places = core::f64::consts::PI / libm::asin(0.5 * spacing / radius);
            let places = places.floor() as usize;
            if ring < places {
                let angle = core::f64::consts::TAU * ring as f64 / places as f64;
                let (sin, cos) = libm::sincos(angle);
                let z = (grain % layers) as f64 * wall.length() / layers as f64;
                return DVec3::new(radius * cos, radius * sin, z);
            }
            ring -= places;
            radius += spacing;
        }
    }
}

/// Sets place and axial velocity of a grain that does not spin.
fn set(bodies: &mut Bodies, grain: usize, place: DVec3, velocity: f64) {
    bodies.position[grain] = place;
    bodies.turns[grain] = 0;
    bodies.velocity[grain] = DVec3::new(0.0, 0.0, velocity);
    bodies.angular_velocity[grain] = DVec3::ZERO;
}
