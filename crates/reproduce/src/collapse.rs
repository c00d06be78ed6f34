//! Collapse of the curves of several strain rates, with free exponents.

use peristalsis_analysis::number::decimal as number;
use peristalsis_analysis::{
    Bootstrap, Collapse, CollapseFit, Curve, CurvePoint, Scaling, Uncertain, WidthEnsemble,
};
use peristalsis_figures::Scale;
use peristalsis_figures::chart::{ChartFigure, ChartPanel, Line as Drawn, Pattern, Tint};

use crate::critical::Line;
use crate::exhibit::{cell_of, coloured, ends, grid, points, rate_colours};
use crate::finding::{Quantity, ReportTable};
use crate::thresholds::{OVERLAP, RESOLVED};
use crate::walls::OnWall;

/// Searches for the best collapse, resamples for its errors, and the seed of both.
const STARTS: usize = 12;
const RESAMPLES: usize = 200;
const SEED: u64 = 20_120_331;
/// First steps of the exponents.
const STEPS: [f64; 2] = [0.3, 0.15];

/// Exponents of the source, and S with the overlap there, where curves can be compared at all.
type Claimed = ([f64; 2], Option<(f64, f64)>);

/// Curves of several strain rates, and how well they collapse.
#[derive(Clone, Debug)]
pub(crate) struct Collapsed {
    /// Fitted critical width of each curve.
    critical: Vec<f64>,
    curves: Vec<Curve>,
    /// Exponents of the source, if it gives any, and S with the overlap there.
    claimed: Option<Claimed>,
    fit: CollapseFit,
    exponents: Vec<Uncertain>,
    left_out: Vec<(f64, Vec<f64>)>,
}

/// Collapses a quantity of the transition times, mean or variance, that goes about as (w_c - w)^-slope; `None` where too few strain rates have it.
pub(crate) fn collapse(
    wall: &OnWall<Line<'_>>,
    claimed: [f64; 2],
    slope: f64,
    quantity: impl Fn(&WidthEnsemble) -> Option<Uncertain>,
) -> Option<Collapsed> {
    let mut curves = Curves::default();
    for (line, fit) in wall.fitted() {
        let known = |one: &&WidthEnsemble| {
            one.observed >= 3 * one.censored
                && one.observed > 2
                && one.width < fit.critical_width.value
                && line.resolves(one, RESOLVED)
        };
        let points = line.ensembles.iter().filter(known);
        let points = points.filter_map(|one| Some((one.width, quantity(one)?)));
        curves.add(line.strain_rate, &fit.critical_width, slope, points);
    }
    curves.collapse(claimed, Some(claimed))
}

/// Curves of known critical widths.
#[derive(Default)]
pub(crate) struct Curves {
    critical: Vec<f64>,
    curves: Vec<Curve>,
}

impl Curves {
    /// Adds a quantity that goes about as (w_c - w)^-slope, where three positive points or more have an error.
    pub(crate) fn add(
        &mut self,
        parameter: f64,
        critical: &Uncertain,
        slope: f64,
        points: impl Iterator<Item = (f64, Uncertain)>,
    ) {
        let points: Vec<CurvePoint> = points
            .filter(|(_, found)| found.value > 0.0 && found.error > 0.0)
            .map(|(x, found)| {
                // A critical width that is off by its error moves a point along the curve.
                let steepness = slope * found.value / (critical.value - x);
                let error = found.error.hypot(steepness * critical.error);
                CurvePoint {
                    x,
                    y: found.value,
                    error,
                }
            })
            .collect();
        if points.len() >= 3 {
            self.critical.push(critical.value);
            self.curves.push(Curve { parameter, points });
        }
    }

    /// Collapses them, beginning the search at `start`; `None` where there are fewer than three.
    pub(crate) fn collapse(self, start: [f64; 2], claimed: Option<[f64; 2]>) -> Option<Collapsed> {
        let Self { critical, curves } = self;
        if curves.len() < 3 {
            return None;
        }
        let scaling = Scaling::CriticalKnown(critical.clone());
        let transform = |parameters: &[f64], curve: usize, parameter: f64, point: CurvePoint| {
            scaling.apply(parameters, curve, parameter, point)
        };
        let collapse = Collapse {
            curves: &curves,
            transform: &transform,
            least_overlap: OVERLAP,
        };
        let fit = collapse.fit(&start, &STEPS, STARTS, SEED).ok()?;
        let bootstrap = Bootstrap::new(RESAMPLES, SEED);
        let left_out: Vec<(f64, Vec<f64>)> = collapse
            .leave_one_out(&fit.parameters, &STEPS, 3, SEED)
            .map(|fits| {
                curves
                    .iter()
                    .zip(fits)
                    .map(|(curve, fit)| (curve.parameter, fit.parameters))
                    .collect()
            })
            .unwrap_or_default();
        // Curves that differ by more than their errors leave the exponents that much less certain.
        let stretch = fit.quality.quality.max(1.0).sqrt();
        let exponents = collapse
            .bootstrap(&fit, &STEPS, bootstrap)
            .ok()?
            .estimates
            .iter()
            .enumerate()
            .map(|(place, exponent)| {
                let fits: Vec<f64> = left_out.iter().map(|(_, fit)| fit[place]).collect();
                Uncertain::normal(
                    exponent.value,
                    (stretch * exponent.error).max(jackknife(&fits)),
                )
            })
            .collect();
        let claimed = claimed.map(|claimed| {
            let quality = collapse.quality(&claimed).ok();
            (claimed, quality.map(|found| (found.quality, found.overlap)))
        });
        Some(Collapsed {
            critical,
            claimed,
            fit,
            exponents,
            left_out,
            curves,
        })
    }
}

/// Standard error from estimates that leave out one of n curves each, [(n - 1)/n sum (t_i - mean)^2]^(1/2); 0 without any.
/// Source: Efron & Tibshirani, An Introduction to the Bootstrap (1993), chapter 11.
pub(crate) fn jackknife(estimates: &[f64]) -> f64 {
    let number = estimates.len().max(1) as f64;
    let mean = estimates.iter().sum::<f64>() / number;
    let squares: f64 = estimates.iter().map(|one| (one - mean).powi(2)).sum();
    (squares * (number - 1.0) / number).sqrt()
}

impl Collapsed {
    /// The exponents, S and the overlap as text.
    fn best(&self) -> [String; 4] {
        [
            self.exponents[0].to_string(),
            self.exponents[1].to_string(),
            number(self.fit.quality.quality, 1),
            number(self.fit.quality.overlap, 2),
        ]
    }

    /// The exponents with the quality of the collapse.
    pub(crate) fn in_words(&self) -> String {
        let [a, b, quality, overlap] = self.best();
        format!("*a* = {a}, *b* = {b} with *S* = {quality} at an overlap of {overlap}")
    }

    /// The exponents as quantities.
    pub(crate) fn quantities(&self, of: &str, symbols: [&str; 2]) -> Vec<Quantity> {
        let words = [
            "power of the strain rate in the ordinate",
            "power of the strain rate in the distance",
        ];
        (0..2)
            .map(|place| Quantity {
                name: format!("{}, {of}", words[place]),
                symbol: symbols[place].to_owned(),
                unit: String::new(),
                source: self.claimed.map(|(claimed, _)| claimed[place]),
                ours: Some(self.exponents[place]),
                method: format!("collapse of {} curves, resampled points", self.curves.len()),
            })
            .collect()
    }

    /// Quality at the exponents of the source and at the best, and the fits without one curve.
    pub(crate) fn table(&self, of: &str) -> ReportTable {
        let row = |name: String, cells: [String; 4]| [vec![name], cells.to_vec()].concat();
        let source = self.claimed.map(|(claimed, quality)| {
            let [a, b] = claimed.map(|exponent| number(exponent, 2));
            let overlap = cell_of(quality, |found| number(found.1, 2));
            let quality = cell_of(quality, |found| number(found.0, 1));
            row("source".to_owned(), [a, b, quality, overlap])
        });
        let left_out = self.left_out.iter().map(|(rate, parameters)| {
            let [a, b] = [0, 1].map(|place| number(parameters[place], 2));
            let name = format!("without *ε̇* = {rate}");
            row(name, [a, b, String::new(), String::new()])
        });
        let best = row("best".to_owned(), self.best());
        ReportTable::new(
            &format!(
                "Collapse, {of}: exponents, Houdayer and Hartmann's *S*, overlap of the curves."
            ),
            ["", "*a*", "*b*", "*S*", "overlap"],
            source.into_iter().chain([best]).chain(left_out),
        )
    }

    /// The scaled points of every curve by its strain rate: abscissa and ordinate.
    fn scaled(&self, exponents: &[f64]) -> Vec<(f64, Vec<(f64, Uncertain)>)> {
        let scaling = Scaling::CriticalKnown(self.critical.clone());
        let scaled = |(place, curve): (usize, &Curve)| {
            let points = curve.points.iter().map(|point| {
                let point = scaling.apply(exponents, place, curve.parameter, *point);
                // The scaling works in logarithms.
                let (x, y) = (point.x.exp(), point.y.exp());
                (x, Uncertain::normal(y, y * point.error))
            });
            (curve.parameter, points.collect())
        };
        self.curves.iter().enumerate().map(scaled).collect()
    }

    /// The curves in a panel, beside a line of the given slope through their middle.
    fn panel(&self, exponents: &[f64], title: &str, labels: [&str; 2], slope: f64) -> ChartPanel {
        let panel = ChartPanel::new(labels[0], labels[1])
            .title(title)
            .x_scale(Scale::Logarithmic)
            .y_scale(Scale::Logarithmic);
        let scaled = self.scaled(exponents);
        let curves = scaled.iter();
        let curves = curves.map(|(rate, curve)| (*rate, points("", curve.iter().copied())));
        let all = || scaled.iter().flat_map(|(_, curve)| curve);
        let first = all().next().map_or(1.0, |point| point.0);
        let ends = ends(all().map(|point| point.0)).unwrap_or((first, first));
        let middle = all()
            .map(|(x, y)| y.value.ln() - slope * x.ln())
            .sum::<f64>()
            / all().count().max(1) as f64;
        let ends = <[f64; 2]>::from(ends);
        panel.with_all(coloured(curves)).with(
            Drawn::new("", &ends, &ends.map(|x| (middle + slope * x.ln()).exp()))
                .tint(Tint::Black)
                .pattern(Pattern::Dashed)
                .weight(0.8),
        )
    }
}

/// All curves scaled as the source says, if it does, and as collapses best: `found` with what each belongs to, and the
/// labels of the axes at the exponents of the source (none where it gives none) and of the ordinate at the best.
pub(crate) fn chart(
    found: &[(String, Collapsed)],
    claimed_labels: [&str; 2],
    best_label: &str,
    slope: f64,
) -> ChartFigure {
    let mut panels = Vec::new();
    for (of, collapsed) in found {
        if let Some((claimed, _)) = collapsed.claimed {
            let title = format!("{of}, exponents of the source");
            panels.push(collapsed.panel(&claimed, &title, claimed_labels, slope));
        }
        let best = &collapsed.fit.parameters;
        let title = format!("{of}, {} and {}", number(best[0], 2), number(best[1], 2));
        let labels = ["(*w*_{c} − *w*)/*ε̇*^{*b*}", best_label];
        panels.push(collapsed.panel(best, &title, labels, slope));
    }
    let curves = found.iter().flat_map(|(_, collapsed)| &collapsed.curves);
    grid(panels.len().min(2), panels)
        .colour_scale(rate_colours(curves.map(|curve| curve.parameter)))
}
