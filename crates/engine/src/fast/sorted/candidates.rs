//! Pairs of a grain and a ring of the wall that may touch, packed: only some grains are near the wall, each with rings of
//! its own.

use crate::fast::columns::ColumnsMut;
use crate::fast::lanes::{LANES, LaneVector, Lanes, Mask};
use crate::fast::machine::Machine;

/// How many candidates are worked out at a time.
const MOST: usize = 512;

/// How many eights of them.
pub(super) const MOST_EIGHTS: usize = MOST / LANES;

/// Rings that a grain may touch, at most: the candidates of a block are worked out at once.
pub(super) const MOST_RINGS: usize = MOST_EIGHTS;

/// A number for each candidate; the numbers behind them are arbitrary.
///
/// Columns of 4096 bytes would all fall on the same lines of a processor's first cache, which then holds too few of them.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(super) struct Column([f64; MOST + LANES]);

impl Column {
    #[inline(always)]
    pub(super) fn load<M: Machine>(&self, at: usize) -> Lanes<M> {
        Lanes::load(&self.0, at)
    }

    #[inline(always)]
    pub(super) fn store<M: Machine>(&mut self, at: usize, of: Lanes<M>) {
        of.store(&mut self.0, at);
    }
}

/// A vector for each candidate, by component.
#[derive(Debug)]
pub(super) struct Vectors([Column; 3]);

impl Vectors {
    #[inline(always)]
    pub(super) fn load<M: Machine>(&self, at: usize) -> LaneVector<M> {
        let Self([x, y, z]) = self;
        LaneVector::new(x.load(at), y.load(at), z.load(at))
    }

    #[inline(always)]
    pub(super) fn store<M: Machine>(&mut self, at: usize, of: LaneVector<M>) {
        let Self([x, y, z]) = self;
        x.store(at, of.x);
        y.store(at, of.y);
        z.store(at, of.z);
    }
}

/// Pairs of a grain and a ring that may touch.
///
/// They stand in the order of the blocks of grains; within a block first the first ring of each of its grains, then the
/// second of each that has two.
#[derive(Debug)]
pub(super) struct Candidates {
    number: usize,
    /// Place of the grain in its tile.
    places: [u32; MOST + LANES],
    /// How many rings within its reach come before this one.
    before: Column,
    /// Place of the grain relative to the nearest sphere of the ring: along the radius to this sphere, along the ring, and
    /// along the tube from there.
    pub(super) position: Vectors,
    /// Its velocity along the same directions.
    pub(super) velocity: Vectors,
    /// Radius of the ring.
    pub(super) radius: Column,
    /// How fast it grows.
    pub(super) ring_velocity: Column,
    /// cos and sin of the angle of the nearest sphere, and -1 where the grain lies at a smaller angle.
    pub(super) cos: Column,
    pub(super) sin: Column,
    pub(super) side: Column,
    /// How many spheres of their ring each eight candidates look at.
    pub(super) visits: [usize; MOST_EIGHTS],
}

impl Default for Candidates {
    fn default() -> Self {
        let none = Column([0.0; MOST + LANES]);
        Self {
            number: 0,
            places: [0; MOST + LANES],
            before: none,
            position: Vectors([none; 3]),
            velocity: Vectors([none; 3]),
            radius: none,
            ring_velocity: none,
            cos: none,
            sin: none,
            side: none,
            visits: [0; MOST_EIGHTS],
        }
    }
}

impl Candidates {
    /// Begins anew.
    pub(super) fn clear(&mut self) {
        self.number = 0;
    }

    /// Whether there is room for a block whose grains may touch so many rings each.
    pub(super) fn have_room(&self, rings: usize) -> bool {
        self.number + rings * LANES <= MOST
    }

    /// Adds a ring, the one behind `before` others, for some grains of the block that begins at `block` in its tile.
    #[inline(always)]
    pub(super) fn add<M: Machine>(&mut self, block: usize, meet: Mask<M>, before: f64) {
        let to = self.places[self.number..].first_chunk_mut();
        meet.write_down(block as u32, to.expect("room for eight more"));
        self.before.store(self.number, Lanes::<M>::splat(before));
        self.number += meet.count() as usize;
    }

    /// Fills the last eight up with any grain of the tile.
    pub(super) fn fill_up(&mut self) {
        self.places[self.number..][..LANES].fill(0);
    }

    /// First of each eight candidates, and the lanes that hold one.
    #[inline(always)]
    pub(super) fn eights<M: Machine>(&self) -> impl Iterator<Item = (usize, Mask<M>)> + use<M> {
        let number = self.number;
        assert!(number <= MOST);
        let starts = (0..number).step_by(LANES);
        starts.map(move |start| (start, Mask::first(number - start)))
    }

    /// Places in their tile of the grains of eight candidates, and how many rings within reach come before theirs.
    #[inline(always)]
    pub(super) fn pairs<M: Machine>(&self, at: usize) -> (&[u32; LANES], Lanes<M>) {
        let places = self.places[at..].first_chunk().expect("eight candidates");
        (places, self.before.load(at))
    }

    /// Adds the forces on the grains of eight candidates to the forces on all grains of the tile.
    #[inline(always)]
    pub(super) fn add_forces<M: Machine>(
        &self,
        at: usize,
        force: LaneVector<M>,
        to: &mut ColumnsMut<'_>,
    ) {
        let (x, y, z) = (force.x.to_array(), force.y.to_array(), force.z.to_array());
        let places = &self.places[at..self.number.min(at + LANES)];
        for (lane, &place) in places.iter().enumerate() {
            let place = place as usize;
            to.x[place] += x[lane];
            to.y[place] += y[lane];
            to.z[place] += z[lane];
        }
    }
}
