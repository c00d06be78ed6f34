//! Grains that meet rings of the wall, packed: only some grains are near the wall, and each with rings of its own.

use super::columns::Columns;
use crate::fast::lanes::{LANES, LaneVector, Lanes, Mask};
use crate::fast::machine::Machine;

/// How many meetings are worked out at a time.
const MOST: usize = 512;

/// Rings that a grain can meet, at most.
pub(super) const MOST_RINGS: usize = MOST / LANES;

/// A number for each meeting; what stands behind them is anything.
type Column = [f64; MOST + LANES];

/// Meetings of grains with rings that they may touch.
///
/// Meetings stand in the order of their blocks, and those of a block in that of the rings: first the first ring of each
/// of its grains, then the second of each that has two.
#[derive(Debug)]
pub(super) struct Meetings {
    number: usize,
    rounds: [Round; MOST],
    rounds_used: usize,
    /// Where the grain is; then by the sphere of the ring that is nearest to it: along the radius to this sphere, along
    /// the ring, and along the tube from there. In the end the force on the grain.
    pub(super) x: Column,
    pub(super) y: Column,
    pub(super) z: Column,
    /// Its velocity; then along the same directions.
    pub(super) velocity_x: Column,
    pub(super) velocity_y: Column,
    pub(super) velocity_z: Column,
    /// Number of the ring, counted on beyond the ends of the tube; then its radius.
    pub(super) ring: Column,
    /// How fast the ring's radius grows.
    pub(super) ring_velocity: Column,
    /// cos and sin of the angle of the nearest sphere, and -1 where the grain lies at a smaller angle.
    pub(super) cos: Column,
    pub(super) sin: Column,
    pub(super) side: Column,
}

/// Meetings of one ring each of the grains of a block.
#[derive(Clone, Copy, Debug, Default)]
struct Round {
    /// Where the block begins.
    block: u32,
    /// Which of its lanes have such a ring.
    bits: u8,
}

impl Default for Meetings {
    fn default() -> Self {
        let none = [0.0; MOST + LANES];
        Self {
            number: 0,
            rounds: [Round::default(); MOST],
            rounds_used: 0,
            x: none,
            y: none,
            z: none,
            velocity_x: none,
            velocity_y: none,
            velocity_z: none,
            ring: none,
            ring_velocity: none,
            cos: none,
            sin: none,
            side: none,
        }
    }
}

impl Meetings {
    /// Begins anew.
    pub(super) fn clear(&mut self) {
        (self.number, self.rounds_used) = (0, 0);
    }

    /// Whether there is room for a block whose grains meet so many rings each.
    pub(super) fn have_room(&self, rings: usize) -> bool {
        self.number + rings * LANES <= MOST
    }

    /// Adds meetings of some grains of the block that begins at `block` with a ring each.
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
        // Said once for all columns.
        assert!(at <= MOST);
        position.x.pack(meet, &mut self.x, at);
        position.y.pack(meet, &mut self.y, at);
        position.z.pack(meet, &mut self.z, at);
        velocity.x.pack(meet, &mut self.velocity_x, at);
        velocity.y.pack(meet, &mut self.velocity_y, at);
        velocity.z.pack(meet, &mut self.velocity_z, at);
        ring.pack(meet, &mut self.ring, at);
        self.rounds[self.rounds_used] = Round {
            block: block as u32,
            bits: meet.to_bits(),
        };
        self.rounds_used += 1;
        self.number = at + meet.count() as usize;
    }

    /// Where each eight meetings begin, and which lanes hold one.
    #[inline(always)]
    pub(super) fn eights<M: Machine>(&self) -> impl Iterator<Item = (usize, Mask<M>)> + use<M> {
        let number = self.number;
        assert!(number <= MOST);
        let starts = (0..number).step_by(LANES);
        starts.map(move |start| (start, Mask::first(number - start)))
    }

    /// Adds the forces to those of the grains.
    #[inline(always)]
    pub(super) fn add_forces<M: Machine>(&self, to: &mut Columns) {
        let mut at = 0;
        for of_block in
            self.rounds[..self.rounds_used].chunk_by(|one, other| one.block == other.block)
        {
            let block = of_block[0].block as usize;
            let LaneVector {
                mut x,
                mut y,
                mut z,
            } = to.load::<M>(block);
            for round in of_block {
                let meet = Mask::from_bits(round.bits);
                assert!(at <= MOST);
                x += Lanes::unpack(meet, &self.x, at);
                y += Lanes::unpack(meet, &self.y, at);
                z += Lanes::unpack(meet, &self.z, at);
                at += meet.count() as usize;
            }
            to.as_mut().store(block, LaneVector::new(x, y, z));
        }
    }
}
