//! Vectors in space, stored by component.

use glam::DVec3;

use super::lanes::{LANES, LaneVector, Lanes};
use super::machine::{Line, Machine};

/// Vectors in space, a column for each component.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Columns {
    pub(crate) x: Vec<f64>,
    pub(crate) y: Vec<f64>,
    pub(crate) z: Vec<f64>,
}

/// The first of [`Columns`] to be read: so many of each column, which the compiler then knows to be of one length.
#[derive(Clone, Copy)]
pub(crate) struct ColumnsRef<'a> {
    x: &'a [f64],
    y: &'a [f64],
    z: &'a [f64],
}

/// A stretch of [`Columns`] to be written to.
pub(crate) struct ColumnsMut<'a> {
    pub(crate) x: &'a mut [f64],
    pub(crate) y: &'a mut [f64],
    pub(crate) z: &'a mut [f64],
}

impl Columns {
    pub(crate) fn each(&mut self) -> [&mut Vec<f64>; 3] {
        [&mut self.x, &mut self.y, &mut self.z]
    }

    /// Makes room for so many vectors, all zero.
    pub(crate) fn clear(&mut self, length: usize) {
        for column in self.each() {
            column.clear();
            column.resize(length, 0.0);
        }
    }

    pub(crate) fn push(&mut self, vector: DVec3) {
        self.x.push(vector.x);
        self.y.push(vector.y);
        self.z.push(vector.z);
    }

    pub(crate) fn get(&self, place: usize) -> DVec3 {
        DVec3::new(self.x[place], self.y[place], self.z[place])
    }

    pub(crate) fn set(&mut self, place: usize, vector: DVec3) {
        self.x[place] = vector.x;
        self.y[place] = vector.y;
        self.z[place] = vector.z;
    }

    /// Copies entry `from` to entry `to`, moved by `shift` along z.
    pub(crate) fn copy(&mut self, from: usize, to: usize, shift: f64) {
        self.x[to] = self.x[from];
        self.y[to] = self.y[from];
        self.z[to] = self.z[from] + shift;
    }

    #[inline(always)]
    pub(crate) fn load<M: Machine>(&self, start: usize) -> LaneVector<M> {
        self.first(self.x.len()).load(start)
    }

    #[inline(always)]
    pub(crate) fn store<M: Machine>(&mut self, start: usize, vector: LaneVector<M>) {
        self.as_mut().store(start, vector);
    }

    /// The first so many vectors.
    #[inline(always)]
    pub(crate) fn first(&self, number: usize) -> ColumnsRef<'_> {
        ColumnsRef {
            x: &self.x[..number],
            y: &self.y[..number],
            z: &self.z[..number],
        }
    }

    /// The same, to be written to.
    #[inline(always)]
    pub(crate) fn first_mut(&mut self, number: usize) -> ColumnsMut<'_> {
        ColumnsMut {
            x: &mut self.x[..number],
            y: &mut self.y[..number],
            z: &mut self.z[..number],
        }
    }

    #[inline(always)]
    pub(crate) fn as_mut(&mut self) -> ColumnsMut<'_> {
        self.first_mut(self.x.len())
    }
}

/// The same, with room up to the end of a line of the cache; each column begins on one.
///
/// Written out for each component: with closures over the three, loads and stores are slower.
#[derive(Clone, Debug, Default)]
pub(crate) struct LineColumns {
    x: Vec<Line>,
    y: Vec<Line>,
    z: Vec<Line>,
}

impl LineColumns {
    /// Makes room for so many vectors, all zero.
    pub(crate) fn clear(&mut self, length: usize) {
        for column in [&mut self.x, &mut self.y, &mut self.z] {
            column.clear();
            column.resize(length.div_ceil(LANES), Line::default());
        }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.x.is_empty()
    }

    #[inline(always)]
    pub(crate) fn each(&mut self) -> [&mut [f64]; 3] {
        [
            Line::numbers_mut(&mut self.x),
            Line::numbers_mut(&mut self.y),
            Line::numbers_mut(&mut self.z),
        ]
    }

    #[inline(always)]
    pub(crate) fn load<M: Machine>(&self, start: usize) -> LaneVector<M> {
        self.first(self.x.len() * LANES).load(start)
    }

    #[inline(always)]
    pub(crate) fn store<M: Machine>(&mut self, start: usize, vector: LaneVector<M>) {
        self.first_mut(self.x.len() * LANES).store(start, vector);
    }

    /// The first so many vectors.
    #[inline(always)]
    pub(crate) fn first(&self, number: usize) -> ColumnsRef<'_> {
        ColumnsRef {
            x: &Line::numbers(&self.x)[..number],
            y: &Line::numbers(&self.y)[..number],
            z: &Line::numbers(&self.z)[..number],
        }
    }

    /// The same, to be written to.
    #[inline(always)]
    pub(crate) fn first_mut(&mut self, number: usize) -> ColumnsMut<'_> {
        ColumnsMut {
            x: &mut Line::numbers_mut(&mut self.x)[..number],
            y: &mut Line::numbers_mut(&mut self.y)[..number],
            z: &mut Line::numbers_mut(&mut self.z)[..number],
        }
    }
}

impl ColumnsRef<'_> {
    /// Without those before `start`.
    #[inline(always)]
    pub(crate) fn from(self, start: usize) -> Self {
        Self {
            x: &self.x[start..],
            y: &self.y[start..],
            z: &self.z[start..],
        }
    }

    /// Those at the given places.
    #[inline(always)]
    pub(crate) fn gather<M: Machine>(&self, places: &[u32; LANES]) -> LaneVector<M> {
        LaneVector::new(
            Lanes::gather(self.x, places),
            Lanes::gather(self.y, places),
            Lanes::gather(self.z, places),
        )
    }

    #[inline(always)]
    pub(crate) fn load<M: Machine>(&self, start: usize) -> LaneVector<M> {
        LaneVector::new(
            Lanes::load(self.x, start),
            Lanes::load(self.y, start),
            Lanes::load(self.z, start),
        )
    }
}

impl ColumnsMut<'_> {
    #[inline(always)]
    pub(crate) fn load<M: Machine>(&self, start: usize) -> LaneVector<M> {
        LaneVector::new(
            Lanes::load(self.x, start),
            Lanes::load(self.y, start),
            Lanes::load(self.z, start),
        )
    }

    #[inline(always)]
    pub(crate) fn store<M: Machine>(&mut self, start: usize, vector: LaneVector<M>) {
        vector.x.store(self.x, start);
        vector.y.store(self.y, start);
        vector.z.store(self.z, start);
    }

    #[inline(always)]
    pub(crate) fn add<M: Machine>(&mut self, start: usize, vector: LaneVector<M>) {
        let sum = self.load(start) + vector;
        self.store(start, sum);
    }
}
