//! Pairs of a grain and a ring of the wall that may touch, packed: only some grains are near the wall, each with rings of
//! its own.

use crate::fast::columns::Columns;
use crate::fast::lanes::{LANES, LaneVector, Lanes, Mask};
use crate::fast::machine::Machine;

/// How many candidates are worked out at a time.
const MOST: usize = 512;

/// Rings that a grain may touch, at most.
pub(super) const MOST_RINGS: usize = MOST / LANES;

/// A number for each candidate; the numbers behind them are arbitrary.
type Column = [f64; MOST + LANES];

/// A vector for each candidate, by component.
#[derive(Debug)]
pub(super) struct Vectors([Column; 3]);

impl Vectors {
    #[inline(always)]
    pub(super) fn load<M: Machine>(&self, at: usize) -> LaneVector<M> {
        let Self([x, y, z]) = self;
        LaneVector::new(Lanes::load(x, at), Lanes::load(y, at), Lanes::load(z, at))
    }

    #[inline(always)]
    pub(super) fn store<M: Machine>(&mut self, at: usize, of: LaneVector<M>) {
        let Self([x, y, z]) = self;
        of.x.store(x, at);
        of.y.store(y, at);
        of.z.store(z, at);
    }

    #[inline(always)]
    fn pack<M: Machine>(&mut self, mask: Mask<M>, of: LaneVector<M>, at: usize) {
        let Self([x, y, z]) = self;
        of.x.pack(mask, x, at);
        of.y.pack(mask, y, at);
        of.z.pack(mask, z, at);
    }

    #[inline(always)]
    fn unpack<M: Machine>(&self, mask: Mask<M>, at: usize) -> LaneVector<M> {
        let Self([x, y, z]) = self;
        LaneVector::new(
            Lanes::unpack(mask, x, at),
            Lanes::unpack(mask, y, at),
            Lanes::unpack(mask, z, at),
        )
    }
}

/// Pairs of a grain and a ring that may touch.
///
/// They stand in the order of the blocks of grains; within a block first the first ring of each of its grains, then the
/// second of each that has two.
#[derive(Debug)]
pub(super) struct Candidates {
    number: usize,
    rounds: [Round; MOST],
    rounds_used: usize,
    /// Place of the grain; then its place relative to the nearest sphere of the ring: along the radius to this sphere, along
    /// the ring, and along the tube from there. In the end the force on the grain.
    pub(super) position: Vectors,
    /// Its velocity; then along the same directions.
    pub(super) velocity: Vectors,
    /// Number of the ring, counted on beyond the ends of the tube; then its radius.
    pub(super) ring: Column,
    /// How fast the ring's radius grows.
    pub(super) ring_velocity: Column,
    /// cos and sin of the angle of the nearest sphere, and -1 where the grain lies at a smaller angle.
    pub(super) cos: Column,
    pub(super) sin: Column,
    pub(super) side: Column,
}

/// Candidates of a block with one ring for each grain.
#[derive(Clone, Copy, Debug, Default)]
struct Round {
    /// First place of the block.
    block: u32,
    /// Which of its lanes have such a ring.
    bits: u8,
}

impl Default for Candidates {
    fn default() -> Self {
        let none = [0.0; MOST + LANES];
        Self {
            number: 0,
            rounds: [Round::default(); MOST],
            rounds_used: 0,
            position: Vectors([none; 3]),
            velocity: Vectors([none; 3]),
            ring: none,
            ring_velocity: none,
            cos: none,
            sin: none,
            side: none,
        }
    }
}

impl Candidates {
    /// Begins anew.
    pub(super) fn clear(&mut self) {
        (self.number, self.rounds_used) = (0, 0);
    }

    /// Whether there is room for a block whose grains may touch so many rings each.
    pub(super) fn have_room(&self, rings: usize) -> bool {
        self.number + rings * LANES <= MOST
    }

    /// Adds a ring each for some grains of the block that begins at `block`.
    #[inline(always)]
    pub(super) fn add<M: Machine>(
        &mut self,
        block: usize,
        meet: Mask<M>,
        position: LaneVector<M>,
        velocity: LaneVector<M>,
        ring: Lanes<M>,
    ) {
        let at = self.number;
        // One check of the bounds for all columns.
        assert!(at <= MOST);
        self.position.pack(meet, position, at);
        self.velocity.pack(meet, velocity, at);
        ring.pack(meet, &mut self.ring, at);
        self.rounds[self.rounds_used] = Round {
            block: block as u32,
            bits: meet.to_bits(),
        };
        self.rounds_used += 1;
        self.number = at + meet.count() as usize;
    }

    /// First of each eight candidates, and the lanes that hold one.
    #[inline(always)]
    pub(super) fn eights<M: Machine>(&self) -> impl Iterator<Item = (usize, Mask<M>)> + use<M> {
        let number = self.number;
        assert!(number <= MOST);
        let starts = (0..number).step_by(LANES);
        starts.map(move |start| (start, Mask::first(number - start)))
    }

    /// Adds the forces to the forces on the grains.
    #[inline(always)]
    pub(super) fn add_forces<M: Machine>(&self, to: &mut Columns) {
        let mut at = 0;
        for of_block in
            self.rounds[..self.rounds_used].chunk_by(|one, other| one.block == other.block)
        {
            let block = of_block[0].block as usize;
            let mut force = to.load::<M>(block);
            for round in of_block {
                let meet = Mask::from_bits(round.bits);
                assert!(at <= MOST);
                force += self.position.unpack(meet, at);
                at += meet.count() as usize;
            }
            to.store(block, force);
        }
    }
}
