//! Four numbers side by side: a vector in space and one number more.

use core::ops::{Add, Mul, Sub};

use glam::DVec3;
use peristalsis_physics::real::Real;

use crate::fast::lanes::{LANES, LaneVector, Lanes};
use crate::fast::machine::Machine;

/// A vector in space and a fourth number, in memory.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(32))]
pub(crate) struct Record(pub(super) [f64; 4]);

/// The same in a register; sums and multiples take the fourth number along.
#[derive(Clone, Copy)]
pub(crate) struct Quad<M: Machine>(M::Quad);

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

    #[inline(always)]
    pub(super) fn quad<M: Machine>(&self) -> Quad<M> {
        Quad(M::load_quad(&self.0))
    }
}

impl<M: Machine> Quad<M> {
    #[inline(always)]
    pub(super) fn splat(value: f64) -> Self {
        Self(M::splat_quad(value))
    }

    #[inline(always)]
    pub(super) fn record(self) -> Record {
        let mut record = Record::ZERO;
        M::store_quad(self.0, &mut record.0);
        record
    }

    #[inline(always)]
    pub(super) fn min(self, other: Self) -> Self {
        Self(M::min_quad(self.0, other.0))
    }

    #[inline(always)]
    pub(super) fn max(self, other: Self) -> Self {
        Self(M::max_quad(self.0, other.0))
    }
}

impl<M: Machine> Add for Quad<M> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(M::add_quads(self.0, other.0))
    }
}

impl<M: Machine> Sub for Quad<M> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(M::sub_quads(self.0, other.0))
    }
}

impl<M: Machine> Mul for Quad<M> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self(M::mul_quads(self.0, other.0))
    }
}

impl<M: Machine> Mul<f64> for Quad<M> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, by: f64) -> Self {
        self * Self::splat(by)
    }
}

/// Eight quads turned into lanes: their vectors and their fourth numbers.
#[inline(always)]
pub(super) fn into_lanes<M: Machine>(quads: [Quad<M>; LANES]) -> (LaneVector<M>, Lanes<M>) {
    let [a, b, c, d, e, f, g, h] = quads;
    let [x, y, z, fourth] = Lanes::of_quads([a.0, b.0, c.0, d.0, e.0, f.0, g.0, h.0]);
    (LaneVector::new(x, y, z), fourth)
}

/// Lanes turned into eight quads.
#[inline(always)]
pub(super) fn from_lanes<M: Machine>(of: LaneVector<M>, fourth: Lanes<M>) -> [Quad<M>; LANES] {
    let [a, b, c, d, e, f, g, h] = Lanes::to_quads([of.x, of.y, of.z, fourth]);
    [
        Quad(a),
        Quad(b),
        Quad(c),
        Quad(d),
        Quad(e),
        Quad(f),
        Quad(g),
        Quad(h),
    ]
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
