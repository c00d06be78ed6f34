//! The branches of both lattices, strain rate by strain rate.

use crate::error::Result;
use crate::evidence::Evidence;
use crate::finding::Statistics;
use crate::judgement::Part;
use crate::row::{Lattice, Row, by_strain_rate, longest};
use crate::thresholds::MOST_ESCAPED;

/// Both lattices, whose names end those of their studies.
pub(crate) const LATTICES: [Lattice; 2] = [Lattice::FINE, Lattice::COARSE];

/// What the runs of one lattice at one strain rate show.
pub(crate) trait AtRate<'a>: Sized {
    /// Of these runs; `None` where they show nothing.
    fn of(lattice: Lattice, strain_rate: f64, rows: Vec<Row<'a>>) -> Option<Self>;

    /// Largest fraction of grains outside near the transition.
    fn escaped(&self) -> f64;

    /// How much is behind it.
    fn statistics(&self) -> Statistics;

    /// Whether it holds its grains, so that it counts.
    fn is_tight(&self) -> bool {
        self.escaped() <= MOST_ESCAPED
    }
}

/// What the branches of one lattice show.
pub(crate) struct Shown<T> {
    /// Name of the lattice.
    pub(crate) name: String,
    /// By ascending strain rate.
    pub(crate) all: Vec<T>,
    /// Longest time that a run was given, in periods.
    pub(crate) periods: f64,
}

impl<'a, T: AtRate<'a>> Shown<T> {
    /// On both lattices.
    pub(crate) fn on_both(evidence: &'a Evidence) -> Result<[Self; 2]> {
        let on = |lattice: Lattice| -> Result<Self> {
            let name = lattice.name();
            let rows = evidence.study(&format!("branches-{name}"))?.rows();
            Ok(Self {
                name,
                periods: longest(&rows),
                all: by_strain_rate(rows)
                    .into_iter()
                    .filter_map(|(rate, rows)| T::of(lattice, rate, rows))
                    .collect(),
            })
        };
        let [fine, coarse] = LATTICES;
        Ok([on(fine)?, on(coarse)?])
    }

    /// Those that hold their grains.
    pub(crate) fn tight(&self) -> impl Iterator<Item = &T> {
        self.all.iter().filter(|one| one.is_tight())
    }

    /// What it says of a claim, where any counts.
    pub(crate) fn part(&self, holds: bool) -> Part {
        Part {
            lattice: self.name.clone(),
            holds: self.tight().next().map(|_| holds),
            statistics: Statistics::weakest(self.tight().map(AtRate::statistics)),
        }
    }
}
