//! The walls that are examined, and what the studies of each show.

use std::collections::BTreeSet;
use std::rc::Rc;

use crate::branch::{Branch, Branches, Control, leak};
use crate::critical::{Thresholds, crossing};
use crate::error::Result;
use crate::evidence::{Evidence, StudyResults};
use crate::finding::Statistics;
use crate::judgement::{Part, Rates};
use crate::row::{Lattice, Row, STAGGERED, Start, arrangement, grouped, longest, wall_name};
use crate::studies::STUDIES;
use crate::thresholds::MOST_ESCAPED;

/// A wall of spheres of the grains' diameter. Its studies are `branches-NAME`, `loop-NAME` (what the branches lack about the
/// loop), `divergence-NAME`, `near-NAME` and `density-NAME`, as far as [`STUDIES`] has them.
#[derive(Debug)]
pub(crate) struct Wall {
    /// What the names of its studies end with.
    pub(crate) study: &'static str,
    pub(crate) lattice: Lattice,
    arrangement: &'static str,
}

/// All walls that are examined, in the order of the report: the one place where a wall is named.
pub(crate) const WALLS: &[Wall] = &[
    Wall::new("12x16", Lattice::new(12, 16), STAGGERED),
    Wall::new("fine", Lattice::FINE, STAGGERED),
    Wall::new("coarse", Lattice::COARSE, STAGGERED),
    Wall::new("aligned", Lattice::COARSE, "aligned"),
    Wall::new("disordered", Lattice::new(16, 18), "disordered"),
];

impl Wall {
    const fn new(study: &'static str, lattice: Lattice, arrangement: &'static str) -> Self {
        Self {
            study,
            lattice,
            arrangement,
        }
    }

    /// Its name for readers.
    pub(crate) fn name(&self) -> String {
        wall_name(self.lattice, self.arrangement)
    }

    /// Whether a run has this wall.
    fn is_of(&self, row: &Row<'_>) -> bool {
        row.lattice() == self.lattice && arrangement(row) == self.arrangement
    }

    /// The runs of one of its studies; none where there is no such study, or a claim that does without it came before it.
    pub(crate) fn rows<'a>(&self, kind: &str, evidence: &'a Evidence) -> Vec<Row<'a>> {
        let name = format!("{kind}-{}", self.study);
        evidence
            .study(&name)
            .map_or_else(|_| Vec::new(), StudyResults::rows)
    }
}

/// The names that `name` stands for: `branches-*` is that study of every wall that has one.
pub(crate) fn of_every_wall(name: &'static str) -> Vec<&'static str> {
    let Some(kind) = name.strip_suffix('*') else {
        return vec![name];
    };
    let studies = |wall: &Wall| {
        let study = format!("{kind}{}", wall.study);
        STUDIES.iter().find(|known| known.name == study)
    };
    let found = WALLS.iter().filter_map(studies);
    found.map(|study| study.name).collect()
}

/// The runs on one wall at one strain rate.
#[derive(Clone, Debug)]
pub(crate) struct Runs<'a> {
    /// epsdot.
    pub(crate) strain_rate: f64,
    /// The stationary flows, from both starts.
    pub(crate) branches: Vec<Row<'a>>,
    /// The transitions from rest, those of runs next to w_c included.
    pub(crate) times: Vec<Row<'a>>,
    /// J/Jmax whose crossing counts as a transition, midway between the branches.
    pub(crate) threshold: f64,
    /// Fraction of the grains outside the tube near the transition.
    pub(crate) escaped: f64,
}

impl<'a> Runs<'a> {
    /// The one rule of all claims for leaks: see [`leak`], of the branches and of the runs whose transitions count, about the
    /// fall of the branch from rest, or about the width at which half of the runs have a transition where there is no branch.
    fn new(strain_rate: f64, branches: Vec<Row<'a>>, times: Vec<Row<'a>>, threshold: f64) -> Self {
        let fall = Branch::of(&branches, Start::Rest, Control::Width).step();
        let half = || crossing(&times).map(|found| found.width.value);
        let place = fall.map(|step| step.place().value).or_else(half);
        Self {
            strain_rate,
            escaped: leak(&branches, place).max(leak(&times, place)),
            branches,
            times,
            threshold,
        }
    }

    /// All strain rates of a wall, ascending; the runs on it in the studies `also` count among the transitions.
    fn all(wall: &Wall, evidence: &'a Evidence, also: &[&str]) -> Result<Vec<Self>> {
        let mut branches = wall.rows("branches", evidence);
        let thresholds = Thresholds::of(branches.iter().copied());
        branches.extend(wall.rows("loop", evidence));
        let mut times = wall.rows("divergence", evidence);
        times.extend(wall.rows("near", evidence));
        for study in also {
            let rows = evidence.study(study)?.rows().into_iter();
            times.extend(rows.filter(|row| wall.is_of(row)));
        }
        // A run that two studies share counts once.
        let mut seen = BTreeSet::new();
        times.retain(|row| row.start() == Start::Rest && seen.insert(row.identity()));
        let of_branches = branches.len();
        let rows = branches.into_iter().chain(times).enumerate();
        // Each run with whether it is of a branch.
        let marked = rows.map(|(place, row)| (row, place < of_branches));
        let groups = grouped(marked, |(row, _)| row.strain_rate());
        let runs = groups.into_iter().map(|(rate, rows)| {
            let of = |is_branch: bool| -> Vec<Row<'a>> {
                let those = rows.iter().filter(|row| row.1 == is_branch);
                those.map(|row| row.0).collect()
            };
            Self::new(rate, of(true), of(false), thresholds.at(rate))
        });
        Ok(runs.collect())
    }

    /// The branches from both starts.
    pub(crate) fn flow(&self) -> Branches<'a> {
        Branches::of(&self.branches, Control::Width)
    }
}

/// What the runs on one wall at one strain rate show of a claim.
pub(crate) trait AtRate<'a>: Sized {
    /// Studies of several walls, or of one, whose runs from rest count as well.
    const ALSO: &'static [&'static str] = &[];

    /// Of these runs; `None` where they show nothing.
    fn of(runs: &Runs<'a>) -> Option<Self>;

    /// Those of them that it looks at.
    fn rows<'b>(runs: &'b Runs<'a>) -> &'b [Row<'a>] {
        &runs.branches
    }

    /// How much is behind it.
    fn statistics(&self) -> Statistics;
}

/// What is shown at one strain rate.
#[derive(Debug)]
pub(crate) struct Shown<T> {
    /// epsdot.
    pub(crate) strain_rate: f64,
    /// Fraction of the grains outside the tube near the transition.
    pub(crate) escaped: f64,
    /// What it is.
    pub(crate) found: T,
}

impl<T> Shown<T> {
    /// Whether the tube holds its grains, so that it counts.
    pub(crate) fn is_tight(&self) -> bool {
        self.escaped <= MOST_ESCAPED
    }
}

/// What is shown on one wall.
#[derive(Debug)]
pub(crate) struct OnWall<T> {
    /// Name of the wall for readers.
    pub(crate) name: String,
    /// By ascending strain rate.
    pub(crate) all: Vec<Rc<Shown<T>>>,
    /// Longest time that a run was given, in periods.
    pub(crate) periods: f64,
}

impl<'a, T: AtRate<'a>> OnWall<T> {
    /// On every wall that shows something.
    pub(crate) fn all(evidence: &'a Evidence) -> Result<Vec<Self>> {
        let mut walls = Vec::new();
        for wall in WALLS {
            let runs = Runs::all(wall, evidence, T::ALSO)?;
            let periods = longest(runs.iter().flat_map(T::rows));
            let shown = |runs: &Runs<'a>| {
                Some(Rc::new(Shown {
                    strain_rate: runs.strain_rate,
                    escaped: runs.escaped,
                    found: T::of(runs)?,
                }))
            };
            let all: Vec<Rc<Shown<T>>> = runs.iter().filter_map(shown).collect();
            if !all.is_empty() {
                let name = wall.name();
                walls.push(Self { name, all, periods });
            }
        }
        Ok(walls)
    }

    /// Where the tube holds its grains.
    pub(crate) fn tight(&self) -> impl Iterator<Item = &Shown<T>> {
        self.all.iter().map(Rc::as_ref).filter(|one| one.is_tight())
    }

    /// At which of the strain rates that count a claim holds.
    pub(crate) fn rates(&self, holds: impl Fn(&T) -> Option<bool>) -> Rates {
        Rates::of(self.tight().map(|one| (one.strain_rate, holds(&one.found))))
    }

    /// How much is behind those that count.
    pub(crate) fn statistics(&self) -> Statistics {
        Statistics::weakest(self.tight().map(|one| one.found.statistics()))
    }

    /// What it says of a claim, with a number in a few words. `judge` is asked of the whole, and where that decides also of
    /// all strain rates but one in turn.
    pub(crate) fn part(
        &self,
        judge: impl Fn(&Self) -> Option<bool>,
        number: String,
        why: String,
    ) -> Part {
        self.part_judged(judge(self), judge, number, why)
    }

    /// The same where the answer for the whole is known.
    pub(crate) fn part_judged(
        &self,
        holds: Option<bool>,
        judge: impl Fn(&Self) -> Option<bool>,
        number: String,
        why: String,
    ) -> Part {
        let rates = self.tight().map(|one| one.strain_rate);
        let without = rates.filter(|_| holds.is_some()).map(|rate| {
            let is_other = |one: &&Rc<Shown<T>>| one.strain_rate != rate;
            let others = Self {
                name: self.name.clone(),
                all: self.all.iter().filter(is_other).cloned().collect(),
                periods: self.periods,
            };
            (rate, judge(&others))
        });
        Part {
            wall: self.name.clone(),
            holds,
            depends_on: without.filter(|(_, others)| *others != holds).collect(),
            statistics: self.statistics(),
            number,
            why,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studies::StudyFile;

    /// Whether a claim holds at a strain rate.
    struct Told(Option<bool>);

    impl<'a> AtRate<'a> for Told {
        fn of(_: &Runs<'a>) -> Option<Self> {
            None
        }

        fn statistics(&self) -> Statistics {
            Statistics::at_one_rate([1.0].into_iter())
        }
    }

    #[test]
    fn each_strain_rate_is_left_out_in_turn() {
        let depends_on = |told: &[Option<bool>]| {
            let shown = |(rate, holds): (i32, &Option<bool>)| {
                Rc::new(Shown {
                    strain_rate: f64::from(rate),
                    // The fifth leaks, and counts neither way.
                    escaped: if rate == 5 { 1.0 } else { 0.0 },
                    found: Told(*holds),
                })
            };
            let wall = OnWall {
                name: "wall".to_owned(),
                all: (1..).zip(told).map(shown).collect(),
                periods: 1.0,
            };
            let judge = |one: &OnWall<Told>| one.rates(|told| told.0).hold();
            let part = wall.part(judge, String::new(), String::new());
            (part.holds, part.depends_on)
        };
        let (yes, no) = (Some(true), Some(false));
        assert_eq!(depends_on(&[yes; 5]), (yes, vec![]));
        // Without one that holds two of three remain, which is not nearly all.
        let on = vec![(1.0, None), (2.0, None), (4.0, None)];
        assert_eq!(depends_on(&[yes, yes, no, yes, no]), (yes, on));
        // An open verdict depends on none.
        assert_eq!(depends_on(&[yes, no, no, yes, no]), (None, vec![]));
    }

    #[test]
    fn every_study_of_a_wall_has_its_wall() {
        for kind in ["branches", "loop", "divergence", "near", "density"] {
            let is_of_kind = |study: &&StudyFile| study.name.starts_with(&format!("{kind}-"));
            for study in STUDIES.iter().filter(is_of_kind) {
                let name = &study.name[kind.len() + 1..];
                assert!(WALLS.iter().any(|wall| wall.study == name), "{name}");
            }
        }
        let branches = of_every_wall("branches-*");
        assert_eq!(branches.len(), WALLS.len());
        assert!(branches.contains(&"branches-fine") && branches.contains(&"branches-coarse"));
        assert_eq!(of_every_wall("roughness"), ["roughness"]);
        assert_eq!(
            Wall::new("x", Lattice::COARSE, "aligned").name(),
            "12 × 14 aligned"
        );
    }
}
