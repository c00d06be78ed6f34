//! Transition times at one strain rate, and the power laws fitted to them.

use peristalsis_analysis::{
    Family, FractionCrossing, Law, ScatterLawFit, Transition, Uncertain, WidthEnsemble,
    ensembles_by_width, fit_law_to_runs, fit_law_with_scatter, fraction_crossing,
};
use peristalsis_run::THRESHOLDS;

use crate::branch::{Branch, Control};
use crate::finding::Statistics;
use crate::near::Near;
use crate::row::{Row, Start, behind, by_strain_rate, grouped, nearest_threshold};
use crate::thresholds::{HIGHER, RESOLVED, SEEN, SHARP, STRAIGHT, WINDOW};
use crate::walls::{AtRate, OnWall, Runs};

/// The studies that [`OnWall::all`] reads.
pub(crate) const TRANSITIONS: &[&str] = &["divergence-*", "near-*", "branches-*"];

impl<'a> OnWall<Line<'a>> {
    /// The laws next to w_c where the tube holds its grains.
    pub(crate) fn near(&self) -> impl Iterator<Item = &Near> {
        self.tight().filter_map(|one| one.found.near.as_ref())
    }

    /// The lines that count and have a fit, with it.
    pub(crate) fn fitted(&self) -> impl Iterator<Item = (&Line<'a>, &Divergence)> {
        let lines = self.tight().map(|one| &one.found);
        lines.filter_map(|line| Some((line, line.fit.as_ref()?)))
    }

    /// Those of which the scatter has a law of its own, with it.
    pub(crate) fn scattered(&self) -> impl Iterator<Item = (&Line<'a>, ScatterLawFit)> {
        self.fitted()
            .filter_map(|(line, fit)| Some((line, fit.scatter?)))
    }
}

impl<'a> AtRate<'a> for Line<'a> {
    fn of(runs: &Runs<'a>) -> Option<Self> {
        if runs.times.is_empty() {
            return None;
        }
        let line = Self::new(runs.strain_rate, runs.threshold, runs.times.clone());
        let near = Near::of(&line);
        Some(Self { near, ..line })
    }

    fn rows<'b>(runs: &'b Runs<'a>) -> &'b [Row<'a>] {
        &runs.times
    }

    fn statistics(&self) -> Statistics {
        behind(&self.rows, Row::width)
    }
}

/// The runs from rest of one tube at one strain rate, watched at one threshold.
#[derive(Clone, Debug)]
pub(crate) struct Line<'a> {
    /// c/lambda \[1/t\].
    pub(crate) strain_rate: f64,
    /// J/Jmax whose crossing counts.
    pub(crate) threshold: f64,
    rows: Vec<Row<'a>>,
    /// The transition times at each width.
    pub(crate) ensembles: Vec<WidthEnsemble>,
    /// The power law in the window of [`WINDOW`] widths.
    pub(crate) fit: Option<Divergence>,
    /// The laws next to w_c, of the lines of a wall.
    pub(crate) near: Option<Near>,
}

/// Thresholds midway between the branches at the strain rates where these are known.
#[derive(Clone, Debug, Default)]
pub(crate) struct Thresholds {
    /// Strain rate and threshold, ascending.
    known: Vec<(f64, f64)>,
}

impl Thresholds {
    /// The thresholds that the branches from rest of some runs suggest.
    pub(crate) fn of<'a>(rows: impl Iterator<Item = Row<'a>>) -> Self {
        let threshold =
            |rows: &[Row<'_>]| Branch::of(rows, Start::Rest, Control::Width).threshold();
        let known = by_strain_rate(rows)
            .into_iter()
            .filter_map(|(rate, rows)| Some((rate, threshold(&rows)?)))
            .collect();
        Self { known }
    }

    /// The threshold at a strain rate, between known ones on a straight line, of [`THRESHOLDS`] the nearest.
    pub(crate) fn at(&self, strain_rate: f64) -> f64 {
        let above = self.known.iter().find(|known| known.0 >= strain_rate);
        let below = self.known.iter().rev().find(|known| known.0 <= strain_rate);
        let wanted = match (below, above) {
            (Some(below), Some(above)) if above.0 > below.0 => {
                below.1 + (above.1 - below.1) * (strain_rate - below.0) / (above.0 - below.0)
            }
            (Some(one), _) | (None, Some(one)) => one.1,
            (None, None) => 0.5,
        };
        THRESHOLDS[nearest_threshold(wanted)]
    }
}

/// The width at which half of some runs from rest have a transition at the threshold of their study; `None` where all of
/// them have one, or none.
pub(crate) fn crossing(rows: &[Row<'_>]) -> Option<FractionCrossing> {
    crossing_of(rows, |row| row.transition())
}

fn crossing_of(
    rows: &[Row<'_>],
    transition: impl Fn(&Row<'_>) -> Transition,
) -> Option<FractionCrossing> {
    let (width, jammed): (Vec<f64>, Vec<bool>) = rows
        .iter()
        .filter(|row| row.start() == Start::Rest)
        .map(|row| (row.width(), transition(row).observed().is_some()))
        .unzip();
    fraction_crossing(&width, &jammed).ok()
}

/// [`crossing`], and the same at the threshold [`HIGHER`].
pub(crate) struct Crossing {
    /// w_c \[d\].
    pub(crate) width: Uncertain,
    /// That at the higher threshold; `None` where the runs pass it at every width, or at none.
    pub(crate) higher: Option<Uncertain>,
    /// 2 a \[d\].
    diameter: f64,
}

impl Crossing {
    pub(crate) fn of(rows: &[Row<'_>]) -> Option<Self> {
        let higher = crossing_of(rows, |row| row.transition_at(HIGHER));
        Some(Self {
            width: crossing(rows)?.width,
            higher: higher.map(|found| found.width),
            diameter: 2.0 * rows.first()?.radius(),
        })
    }

    /// Whether the threshold hardly matters: flows that creep through it, and are watched for a time, have no w_c.
    pub(crate) fn is_sharp(&self) -> bool {
        let apart = |higher: Uncertain| (higher.value - self.width.value).abs();
        let is_near = |higher| apart(higher) <= SHARP * self.diameter;
        self.higher.is_some_and(is_near)
    }
}

/// Width and transition of every run at a threshold.
fn columns(rows: &[Row<'_>], threshold: f64) -> (Vec<f64>, Vec<Transition>) {
    rows.iter()
        .map(|row| (row.width(), row.transition_at(threshold)))
        .unzip()
}

impl<'a> Line<'a> {
    /// rho; NaN without runs.
    pub(crate) fn volume_fraction(&self) -> f64 {
        self.rows.first().map_or(f64::NAN, Row::volume_fraction)
    }

    fn new(strain_rate: f64, threshold: f64, rows: Vec<Row<'a>>) -> Self {
        let (width, transitions) = columns(&rows, threshold);
        let mut line = Self {
            strain_rate,
            threshold,
            rows,
            ensembles: ensembles_by_width(Family::Gamma, &width, &transitions).unwrap_or_default(),
            fit: None,
            near: None,
        };
        line.fit = line.fit_in(WINDOW);
        line
    }

    /// The line of some runs at one strain rate, watched at the threshold nearest to that of their study.
    pub(crate) fn at_own_threshold(rows: &[Row<'a>]) -> Option<Self> {
        let first = rows.first()?;
        let known = vec![(first.strain_rate(), first.number("transition_threshold"))];
        let threshold = Thresholds { known }.at(first.strain_rate());
        let from_rest = rows.iter().filter(|row| row.start() == Start::Rest);
        Some(Self::new(
            first.strain_rate(),
            threshold,
            from_rest.copied().collect(),
        ))
    }

    /// The same runs watched at another threshold.
    pub(crate) fn at_threshold(&self, threshold: f64) -> Self {
        Self::new(self.strain_rate, threshold, self.rows.clone())
    }

    /// Part of the runs that their transition ended before they came to this threshold.
    pub(crate) fn stopped_before(&self) -> f64 {
        let stopped = |row: &&Row<'_>| row.is_stopped_before(self.threshold);
        self.rows.iter().filter(stopped).count() as f64 / self.rows.len() as f64
    }

    /// Width and transition of every run.
    pub(crate) fn columns(&self) -> (Vec<f64>, Vec<Transition>) {
        columns(&self.rows, self.threshold)
    }

    /// Whether the mean transition time at a width is longer than so many periods.
    pub(crate) fn resolves(&self, ensemble: &WidthEnsemble, periods: f64) -> bool {
        let period = 1.0 / self.strain_rate;
        ensemble
            .naive_mean
            .is_some_and(|mean| mean > periods * period)
    }

    /// The first of the last so many widths at which at least half of the runs had a transition that averages over periods
    /// resolve; `None` with fewer than three such widths.
    pub(crate) fn window_from(&self, number: usize) -> Option<f64> {
        let usable: Vec<f64> = self
            .ensembles
            .iter()
            .filter(|ensemble| ensemble.observed_fraction() >= SEEN)
            .filter(|ensemble| self.resolves(ensemble, RESOLVED))
            .map(|ensemble| ensemble.width)
            .collect();
        if usable.len() < 3 {
            return None;
        }
        Some(usable[usable.len().saturating_sub(number)])
    }

    /// The runs from there on, the widths beyond included.
    pub(crate) fn window(&self, number: usize) -> Option<(Vec<f64>, Vec<Transition>)> {
        let from = self.window_from(number)?;
        let (width, transitions) = self.columns();
        Some(
            width
                .into_iter()
                .zip(transitions)
                .filter(|(width, _)| *width >= from)
                .unzip(),
        )
    }

    /// The width at which half of the runs have a transition before their end.
    pub(crate) fn crossing(&self) -> Option<FractionCrossing> {
        crossing_of(&self.rows, |row| row.transition_at(self.threshold))
    }

    /// The power law in a window of so many widths next to the critical one.
    fn fit_in(&self, number: usize) -> Option<Divergence> {
        let (width, transitions) = self.window(number)?;
        Divergence::of(&width, &transitions)
    }

    /// The power law of the fewest widths that a fit can use.
    pub(crate) fn nearest(&self) -> Option<Divergence> {
        self.fit_in(STRAIGHT)
    }

    /// Power laws in all windows, from the fewest widths to all: stability against the choice.
    pub(crate) fn fits(&self) -> Vec<Divergence> {
        let mut windows: Vec<f64> = (STRAIGHT
            ..=grouped(self.rows.iter().copied(), Row::width).len())
            .filter_map(|number| self.window_from(number))
            .collect();
        // Beyond the last usable width nothing changes.
        windows.dedup();
        (STRAIGHT..STRAIGHT + windows.len())
            .filter_map(|number| self.fit_in(number))
            .collect()
    }
}

/// A power law of the mean transition time, tau = A (w_c - w)^-alpha.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Divergence {
    /// w_c \[d\].
    pub(crate) critical_width: Uncertain,
    /// alpha.
    pub(crate) exponent: Uncertain,
    /// Transitions seen, and runs without one.
    pub(crate) observed: usize,
    pub(crate) censored: usize,
    /// With the relative variance as a power of the distance, too; `None` where the runs do not determine that.
    pub(crate) scatter: Option<ScatterLawFit>,
}

impl Divergence {
    /// Maximum likelihood with the scatter as a power law of its own; with one scatter for all widths where that has no
    /// maximum.
    fn of(width: &[f64], transitions: &[Transition]) -> Option<Self> {
        if let Ok(fit) = fit_law_with_scatter(width, transitions) {
            return Some(Self {
                critical_width: fit.critical_width,
                exponent: fit.exponent,
                observed: fit.observed,
                censored: fit.censored,
                scatter: Some(fit),
            });
        }
        let fit = fit_law_to_runs(Law::Power, Family::Gamma, width, transitions).ok()?;
        Some(Self {
            critical_width: fit.critical_width?,
            exponent: fit.exponent,
            observed: fit.observed,
            censored: fit.censored,
            scatter: None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thresholds_lie_between_known_ones() {
        let thresholds = Thresholds {
            known: vec![(0.05, 0.3), (0.1, 0.62)],
        };
        assert_eq!(thresholds.at(0.05), 0.3);
        assert_eq!(thresholds.at(0.075), 0.5);
        assert_eq!(thresholds.at(0.2), 0.6);
        assert_eq!(Thresholds::default().at(0.1), 0.5);
    }
}
