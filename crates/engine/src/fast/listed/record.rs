//! Four numbers side by side: a vector in space and one number more.

use core::ops::Mul;

use glam::DVec3;
use peristalsis_physics::real::Real;

use crate::fast::lanes::{LANES, LaneVector, Lanes, Numbers, Quad};
use crate::fast::machine::{Arithmetic, Machine};

/// A vector in space and a fourth number, in memory.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(32))]
pub(crate) struct Record(pub(super) [f64; 4]);

impl Record {
    pub(super) const ZERO: Self = Self([0.0; 4]);

    #[inline(always)]
    pub(super) fn new(vector: DVec3, fourth: f64) -> Self {
        Self([vector.x, vector.y, vector.z, fourth])
    }

    #[inline(always)]
    pub(super) fn vector(self) -> DVec3 {
        DVec3::new(self.0[0], self.0[1], self.0[2])
    }

    /// The place with the turns round a tube of this length, its fourth number, counted.
    #[inline(always)]
    pub(super) fn unfolded(&self, length: f64) -> DVec3 {
        let [x, y, z, turns] = self.0;
        DVec3::new(x, y, z + turns * length)
    }

    #[inline(always)]
    pub(super) fn quad<A: Arithmetic<4>>(&self) -> Numbers<A, 4> {
        Numbers::from_array(&self.0)
    }
}

/// Sums and multiples take the fourth number along.
impl<A: Arithmetic<4>> Numbers<A, 4> {
    #[inline(always)]
    pub(super) fn record(self) -> Record {
        Record(self.to_array())
    }
}

impl<A: Arithmetic<4>> Mul<f64> for Numbers<A, 4> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, by: f64) -> Self {
        self * Self::splat(by)
    }
}

/// Eight quads turned into lanes: their vectors and their fourth numbers.
#[inline(always)]
pub(super) fn into_lanes<M: Machine>(quads: [Quad<M>; LANES]) -> (LaneVector<M>, Lanes<M>) {
    let [x, y, z, fourth] = Lanes::of_quads(quads);
    (LaneVector::new(x, y, z), fourth)
}

/// Lanes turned into eight quads.
#[inline(always)]
pub(super) fn from_lanes<M: Machine>(of: LaneVector<M>, fourth: Lanes<M>) -> [Quad<M>; LANES] {
    Lanes::to_quads([of.x, of.y, of.z, fourth])
}

/// Separation with z brought to the nearest image, as [`crate::neighbours::periodic`] does.
#[inline(always)]
pub(super) fn periodic<M: Machine>(mut separation: LaneVector<M>, length: f64) -> LaneVector<M> {
    let z = separation.z;
    let (half, whole) = (Lanes::splat(0.5 * length), Lanes::splat(length));
    let nearer = Lanes::select(z.less(-half), z + whole, z);
    separation.z = Lanes::select(half.less(z), z - whole, nearer);
    separation
}
