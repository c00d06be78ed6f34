//! Stretches of the spheres, for threads to share.

use core::ops::Range;

use super::motion::Moved;
use super::network::Rings;
use super::spheres::Spheres;
use crate::fast::threads::{PER_THREAD, Threads};
use crate::neighbours::{Drift, Neighbours};
use crate::wall::Wall;
use crate::wall::memory::WallMemory;
use crate::wall::sums::Waiting;

/// The work that a grain makes besides its pairs, in listed pairs.
const PAIRS_OF_A_GRAIN: usize = 16;

/// A stretch of the spheres, all grains or all of the wall.
#[derive(Clone, Debug, Default)]
pub(super) struct Stretch {
    pub(super) number: usize,
    pub(super) of_grains: bool,
    pub(super) spheres: Range<usize>,
    pub(super) moved: Moved,
    pub(super) rings: Rings,
    /// Since the list was made.
    pub(super) drift: Drift,
}

impl Stretch {
    pub(super) fn length(&self) -> usize {
        self.spheres.len()
    }
}

/// A stretch of grains in a prescribed wall.
pub(super) struct BesideWall<H> {
    /// Its number.
    pub(super) stretch: usize,
    pub(super) grains: usize,
    /// Histories of contacts with the wall; its grains are counted from 0.
    pub(super) memory: WallMemory<H>,
    pub(super) sums: Waiting,
}

/// Cuts the spheres into stretches: the grains, then the wall ring by ring. One thread has one of each.
pub(super) fn share_out<H: Copy + Default + PartialEq>(
    stretches: &mut Vec<Stretch>,
    spheres: &Spheres,
    list: &Neighbours<H>,
    wall: &Wall,
    threads: &Threads,
) {
    let most = match threads.number() {
        1 => 1,
        // As many of the wall.
        threads => PER_THREAD * threads,
    };
    let grains = spheres.grains;
    let pairs_before = |grain: usize| list.pairs_above(grain.min(list.rows()));
    let work_before = |grain: usize| pairs_before(grain) + PAIRS_OF_A_GRAIN * grain;
    let (rings, per_ring) = wall.elastic().map_or((0, 0), |wall| {
        let lattice = wall.lattice();
        (lattice.rings() as usize, lattice.spheres_per_ring as usize)
    });
    let of_grains = most.min(grains).max(1);
    let of_wall = most.min(rings);
    let ends_of_wall = ends(rings, of_wall, |ring| ring).map(|ring| grains + ring * per_ring);
    let ends = ends(grains, of_grains, work_before).chain(ends_of_wall);
    stretches.resize_with(of_grains + of_wall, Stretch::default);
    let mut begin = 0;
    for (number, (stretch, end)) in stretches.iter_mut().zip(ends).enumerate() {
        stretch.number = number;
        stretch.of_grains = number < of_grains;
        stretch.spheres = begin..end;
        begin = end;
    }
}

/// The ends of so many stretches of items, of about the same work each; `before` answers the work of all items before one.
fn ends(
    items: usize,
    stretches: usize,
    before: impl Fn(usize) -> usize,
) -> impl Iterator<Item = usize> {
    let all = before(items);
    let mut end = 0;
    (1..=stretches).map(move |stretch| {
        while end < items && (stretch == stretches || before(end) * stretches < all * stretch) {
            end += 1;
        }
        end
    })
}
