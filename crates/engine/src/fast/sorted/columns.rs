//! Vectors in space, stored by component.

use glam::DVec3;

use crate::fast::lanes::{LaneVector, Lanes};
use crate::fast::machine::Machine;

/// Vectors in space, a column for each component.
#[derive(Clone, Debug, Default)]
pub(super) struct Columns {
    pub(super) x: Vec<f64>,
    pub(super) y: Vec<f64>,
    pub(super) z: Vec<f64>,
}

/// A stretch of [`Columns`] to be written to.
pub(super) struct ColumnsMut<'a> {
    pub(super) x: &'a mut [f64],
    pub(super) y: &'a mut [f64],
    pub(super) z: &'a mut [f64],
}

impl Columns {
    pub(super) fn each(&mut self) -> [&mut Vec<f64>; 3] {
        [&mut self.x, &mut self.y, &mut self.z]
    }

    pub(super) fn resize(&mut self, length: usize) {
        for column in self.each() {
            column.resize(length, 0.0);
        }
    }

    pub(super) fn push(&mut self, vector: DVec3) {
        self.x.push(vector.x);
        self.y.push(vector.y);
        self.z.push(vector.z);
    }

    pub(super) fn get(&self, place: usize) -> DVec3 {
        DVec3::new(self.x[place], self.y[place], self.z[place])
    }

    pub(super) fn set(&mut self, place: usize, vector: DVec3) {
        self.x[place] = vector.x;
        self.y[place] = vector.y;
        self.z[place] = vector.z;
    }

    /// Copies entry `from` to entry `to`, moved by `shift` along z.
    pub(super) fn copy(&mut self, from: usize, to: usize, shift: f64) {
        self.x[to] = self.x[from];
        self.y[to] = self.y[from];
        self.z[to] = self.z[from] + shift;
    }

    #[inline(always)]
    pub(super) fn load<M: Machine>(&self, start: usize) -> LaneVector<M> {
        LaneVector::new(
            Lanes::load(&self.x, start),
            Lanes::load(&self.y, start),
            Lanes::load(&self.z, start),
        )
    }

    #[inline(always)]
    pub(super) fn add<M: Machine>(&mut self, start: usize, vector: LaneVector<M>) {
        self.as_mut().add(start, vector);
    }

    #[inline(always)]
    pub(super) fn as_mut(&mut self) -> ColumnsMut<'_> {
        ColumnsMut {
            x: &mut self.x,
            y: &mut self.y,
            z: &mut self.z,
        }
    }
}

impl ColumnsMut<'_> {
    #[inline(always)]
    pub(super) fn load<M: Machine>(&self, start: usize) -> LaneVector<M> {
        LaneVector::new(
            Lanes::load(self.x, start),
            Lanes::load(self.y, start),
            Lanes::load(self.z, start),
        )
    }

    #[inline(always)]
    pub(super) fn store<M: Machine>(&mut self, start: usize, vector: LaneVector<M>) {
        vector.x.store(self.x, start);
        vector.y.store(self.y, start);
        vector.z.store(self.z, start);
    }

    #[inline(always)]
    pub(super) fn add<M: Machine>(&mut self, start: usize, vector: LaneVector<M>) {
        let sum = self.load(start) + vector;
        self.store(start, sum);
    }
}
