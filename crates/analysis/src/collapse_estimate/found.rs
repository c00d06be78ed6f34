//! The place where curves collapse best, its intervals, and why not to trust it.

use super::STIFFNESS;
use super::likelihood::Likelihood;
use crate::collapse::CurvePoint;
use crate::collapse_fit::place_of_start;
use crate::error::Error;
use crate::numerics::quasi_newton::Smallest;
use crate::numerics::simplex::nelder_mead;
use crate::uncertain::{Interval, NARROW, Uncertain, WIDE};
use std::cell::RefCell;
use std::cmp::Ordering;

/// Evaluations of the coarse search from one start, for each parameter.
const EVALUATIONS: usize = 80;
/// Steps from the best value within which an end of an interval is sought.
const REACH: f64 = 50.0;
/// Most places at which an end is sought once it is enclosed.
const MOST_CUTS: u32 = 12;
/// Factor of the errors from which on either the errors or the scaling are wrong: twenty points exceed it by
/// chance once in a thousand data sets.
const MOST_STRETCH: f64 = 1.5;
/// Ratio of the lengths of two scaled curves up to which intervals cover: at 4.6 they were seen to, at 5.8 not.
const MOST_UNLIKE: f64 = 5.0;
/// Most free parameters beside a correction for which intervals were found to cover as they should.
const MOST_BESIDE_A_CORRECTION: usize = 3;

/// How far a walk along one parameter has come within an interval, and how the others go with it.
struct Walk {
    /// Distance from the best value, and the standard deviations there.
    near: f64,
    at_near: f64,
    /// Value of the parameter, and those of the others.
    held: f64,
    rest: Vec<f64>,
    /// Their changes with it, and the inverse of their second derivatives.
    slopes: Vec<f64>,
    inverse: Vec<Vec<f64>>,
}

/// A place found, with what its intervals are made of.
pub(super) struct Found<'a> {
    pub(super) likelihood: Likelihood<'a>,
    pub(super) best: Smallest,
    pub(super) others: Vec<Smallest>,
}

impl<'a> Found<'a> {
    /// The best place by searches from several starts.
    pub(super) fn search(
        likelihood: Likelihood<'a>,
        start: &[f64],
        starts: usize,
        seed: u64,
    ) -> Result<Self, Error> {
        let start = [start, &[STIFFNESS.0]].concat();
        let steps = likelihood.steps;
        let places = (0..starts as u64).map(|number| {
            let place = place_of_start(&start, steps, seed, number);
            let evaluations = EVALUATIONS * start.len();
            nelder_mead(
                |p| likelihood.value_or_wall(p),
                &place,
                steps,
                1e-2,
                evaluations,
            )
            .place
        });
        let places: Vec<Vec<f64>> = places.collect();
        let settled = places.iter().filter_map(|place| likelihood.settle(place));
        let mut others: Vec<Smallest> = settled.collect();
        // Stable: of equal ones the first search comes first.
        others.sort_by(|a, b| a.value.total_cmp(&b.value));
        let best = others.first().cloned();
        let ended = &places[0][..start.len() - 1];
        let best = best.ok_or_else(|| likelihood.collapse.no_overlap(ended))?;
        Ok(Self {
            likelihood,
            best,
            others,
        })
    }

    /// Standard deviations of a place from the best.
    fn excess(&self, other: &Smallest) -> f64 {
        (other.value - self.best.value).max(0.0).sqrt()
    }

    /// Where a walk begins, with the error of the parameter there: at the farthest place to that side that another search
    /// found as good.
    fn begin(&self, axis: usize, deviations: f64) -> (Walk, f64) {
        let centre = self.best.place[axis];
        let beyond = |other: &Smallest| (other.place[axis] - centre) * deviations.signum();
        let others = self.others.iter();
        let others = others.filter(|other| self.excess(other) < deviations.abs());
        let others = others.filter(|other| beyond(other) > 0.0);
        let first = others.max_by(|a, b| beyond(a).total_cmp(&beyond(b)));
        let first = first.unwrap_or(&self.best);
        let (inverse, slopes) = first.beside(axis);
        let mut rest = first.place.clone();
        let walk = Walk {
            near: beyond(first),
            at_near: self.excess(first),
            held: rest.remove(axis),
            rest,
            slopes,
            inverse,
        };
        (walk, (2.0 * first.inverse[axis][axis]).max(0.0).sqrt())
    }

    /// End of an interval of a parameter, so many standard deviations to a side, by the profile of the likelihood;
    /// infinite where the points leave it open. The walk [begins](Self::begin) at another search, or where `walked`, the walk
    /// to a nearer end, has come farther. A better place that is met on the way goes to
    /// `better`.
    fn end(
        &self,
        axis: usize,
        deviations: f64,
        walked: Option<Walk>,
        better: &RefCell<Option<Smallest>>,
    ) -> (f64, Walk) {
        let wanted = deviations.abs();
        let centre = self.best.place[axis];
        let (mut walk, error) = self.begin(axis, deviations);
        if let Some(walked) = walked.filter(|walked| walked.near > walk.near) {
            walk = walked;
        }
        let (mut near, mut at_near) = (walk.near, walk.at_near);
        // Standard deviations from the best value: about linear in the distance.
        let mut deviations_at = |distance: f64| {
            let value = centre + distance * deviations.signum();
            let likelihood = &self.likelihood;
            let moved = walk.rest.iter().zip(&walk.slopes);
            let moved: Vec<f64> = moved
                .map(|(one, slope)| one + slope * (value - walk.held))
                .collect();
            let level = self.best.value + deviations * deviations;
            let doubtful = level + 0.5 * deviations * deviations;
            let settle = |rest: &[f64]| {
                likelihood.settle_beside((axis, value), rest, &walk.inverse, doubtful)
            };
            let is_astray = |one: &Smallest| one.value >= doubtful;
            let ahead = settle(&moved);
            // What has gone astray on its way ahead may not from where it was.
            let back = ahead
                .as_ref()
                .is_none_or(is_astray)
                .then(|| settle(&walk.rest));
            let both = ahead.into_iter().chain(back.flatten());
            let Some(found) = both.min_by(|a, b| a.value.total_cmp(&b.value)) else {
                return f64::INFINITY;
            };
            if found.value < level {
                let ways = found.place.iter().zip(&walk.rest);
                walk.slopes = ways
                    .map(|(to, from)| (to - from) / (value - walk.held))
                    .collect();
                walk.held = value;
                walk.rest.clone_from(&found.place);
                walk.inverse.clone_from(&found.inverse);
            }
            if found.value < self.best.value - 0.02 && better.borrow().is_none() {
                let mut place = found.place.clone();
                place.insert(axis, value);
                better.replace(self.likelihood.settle(&place));
            }
            self.excess(&found)
        };
        let step = self.likelihood.steps[axis];
        let mut far = near + (wanted - at_near) * error.clamp(1e-3 * step, 5.0 * step);
        let mut at_far = deviations_at(far);
        let open = deviations.signum() * f64::INFINITY;
        while at_far < wanted {
            let farther = far * (wanted / at_far).clamp(1.2, 4.0);
            // Steps that are all but 0 lead nowhere.
            if far > REACH * step || farther.partial_cmp(&far) != Some(Ordering::Greater) {
                return (open, walk);
            }
            (near, at_near) = (far, at_far);
            far = farther;
            at_far = deviations_at(far);
        }
        let mut end = None;
        for _ in 0..MOST_CUTS {
            let share = match at_far < 3.0 * wanted {
                true => ((wanted - at_near) / (at_far - at_near)).clamp(0.05, 0.95),
                false => 0.5,
            };
            let between = near + share * (far - near);
            let found = deviations_at(between);
            if found < wanted {
                (near, at_near) = (between, found);
            } else {
                (far, at_far) = (between, found);
            }
            if (found - wanted).abs() < 0.01 * wanted {
                end = Some(between);
                break;
            }
        }
        (walk.near, walk.at_near) = (near, at_near);
        // Where the curves stop overlapping the likelihood ends, but the points have not said so.
        let end = end.or_else(|| at_far.is_finite().then_some(far));
        let end = end.map_or(open, |end| centre + end * deviations.signum());
        (end, walk)
    }

    /// Value and intervals of every parameter, or a better place.
    pub(super) fn intervals(&self) -> Result<Vec<Uncertain>, Smallest> {
        let better = RefCell::new(None);
        let mut found = Vec::new();
        for axis in 0..self.best.place.len() - 1 {
            let ends = [-1.0, 1.0].map(|side| {
                let (narrow, walked) = self.end(axis, side * NARROW, None, &better);
                let (wide, _) = self.end(axis, side * WIDE, Some(walked), &better);
                // Two walks may settle differently; the wide interval holds the narrow one.
                [narrow, side * (side * wide).max(side * narrow)]
            });
            let interval = |width: usize| Interval::new(ends[0][width], ends[1][width]);
            let intervals = [interval(0), interval(1)];
            if let Some(better) = better.take() {
                return Err(better);
            }
            found.push(Uncertain::between(self.best.place[axis], intervals));
        }
        Ok(found)
    }

    /// The first parameter that a correction to scaling may take out of its interval, as far as the points say: one that
    /// fades for large or for small parameters of the curves.
    fn moved_by_a_correction(&self, parameters: &[Uncertain]) -> Option<usize> {
        let moved_by = |power| {
            let likelihood = self.likelihood.allowing(power)?;
            let best = likelihood.settle(&self.best.place)?;
            let level = best.value + NARROW * NARROW;
            (0..parameters.len()).find(|&axis| {
                let interval = parameters[axis].interval_95;
                let (inverse, slopes) = best.beside(axis);
                let mut rest = best.place.clone();
                let centre = rest.remove(axis);
                let is_possible = |end: f64| {
                    let moved = rest.iter().zip(&slopes);
                    let moved = moved.map(|(one, slope)| one + slope * (end - centre));
                    let moved: Vec<f64> = moved.collect();
                    let found = likelihood.settle_beside((axis, end), &moved, &inverse, level);
                    found.is_some_and(|found| found.value < level)
                };
                !interval.contains(centre)
                    || [interval.lower, interval.upper]
                        .into_iter()
                        .any(is_possible)
            })
        };
        [-1.0, 1.0].into_iter().find_map(moved_by)
    }

    /// The first parameter that leaves its interval if the common curve may bend more sharply.
    fn moved_by_knots(&self, parameters: &[Uncertain]) -> Option<usize> {
        let best = self.likelihood.refined().settle(&self.best.place)?;
        let mut places = parameters.iter().zip(best.place);
        places.position(|(one, place)| !one.interval_95.contains(place))
    }

    /// How far the points of each curve reach along the scaled abscissa, of those that have two or more.
    fn lengths(&self, parameters: &[f64]) -> Vec<f64> {
        let scaled = self.likelihood.collapse.scaled(parameters);
        let length = |points: Vec<CurvePoint>| {
            let usable = points.iter().filter(|point| point.is_usable());
            let (least, most) = usable.fold((f64::INFINITY, f64::NEG_INFINITY), |ends, point| {
                (ends.0.min(point.x), ends.1.max(point.x))
            });
            (most > least).then_some(most - least)
        };
        scaled.into_iter().filter_map(length).collect()
    }

    /// Why not to trust the parameters.
    pub(super) fn doubts(&self, parameters: &[Uncertain]) -> Vec<String> {
        let mut doubts = Vec::new();
        let curves = self.likelihood.collapse.curves.len();
        if curves < 3 {
            doubts.push(
                "two curves can be made to agree in many ways: take three or more".to_owned(),
            );
        }
        for (place, parameter) in parameters.iter().enumerate() {
            let Interval { lower, upper } = parameter.interval_95;
            if !lower.is_finite() || !upper.is_finite() {
                let number = place + 1;
                doubts.push(format!(
                    "the points leave parameter {number} open: the curves collapse as well at other values, with the other parameters changed to suit"
                ));
            }
        }
        if self.others.len() > 3 && self.agreeing() < 2 {
            doubts.push(
                "only one of the searches ended here: begin closer to it, or with more starts"
                    .to_owned(),
            );
        }
        let Some((curve, lost)) = self.likelihood.curve(&self.best.place) else {
            return doubts;
        };
        if lost > 0 {
            doubts.push(format!(
                "{lost} points lie beyond the critical value, or have no scaled value"
            ));
        }
        let places = &self.best.place[..parameters.len()];
        let lengths = self.lengths(places).into_iter();
        let (least, most) = lengths.fold((f64::INFINITY, 0.0_f64), |(least, most), length| {
            (least.min(length), most.max(length))
        });
        if most > MOST_UNLIKE * least {
            doubts.push(format!(
                "one curve is {:.1} times as long as another along the scaled abscissa, and on made-up data of this kind the exponents are biased: choose the points of each curve so that they cover the same range of it",
                most / least
            ));
        }
        let stretch = self.likelihood.variance(&curve, lost).sqrt();
        if stretch > MOST_STRETCH {
            doubts.push(format!(
                "the points lie {stretch:.1} times as far from one curve as their errors say: the scaling does not hold, or the errors are wrong"
            ));
        }
        if let Some(place) = self.moved_by_knots(parameters) {
            let number = place + 1;
            doubts.push(format!(
                "the common curve bends too sharply for its knots, and with more of them parameter {number} leaves its interval: take points nearer to where the curves bend"
            ));
        }
        let is_corrected = self.likelihood.is_corrected();
        if is_corrected && self.likelihood.unknown() > MOST_BESIDE_A_CORRECTION {
            doubts.push(
                "the intervals of four parameters or more beside a correction are too narrow: on made-up data they covered 60 per cent or fewer rather than 68, and 90 or fewer rather than 95"
                    .to_owned(),
            );
        }
        if !is_corrected && let Some(place) = self.moved_by_a_correction(parameters) {
            let number = place + 1;
            doubts.push(format!(
                "the points do not rule out a correction to scaling that takes parameter {number} out of its interval: allow for one"
            ));
        }
        doubts
    }

    /// Searches that ended at the best place.
    pub(super) fn agreeing(&self) -> usize {
        let is_near = |other: &&Smallest| other.value <= self.best.value + 0.1;
        self.others.iter().filter(is_near).count()
    }
}
