//! Collapse of the curves of several strain rates, with free exponents.

use peristalsis_analysis::{
    Bootstrap, Collapse, CollapseFit, Curve, CurvePoint, Scaling, Uncertain, WidthEnsemble,
};
use peristalsis_figures::chart::{ChartFigure, ChartPanel, Line as Drawn, Pattern, Points, Tint};
use peristalsis_figures::{ColourScale, Quantity as Axis, Scale, Units, Width};

use crate::critical::{Divergence, Line};
use crate::error::ClaimError;
use crate::finding::{Quantity, ReportFigure, ReportTable};
use crate::text::{estimate, number};

/// Searches for the best collapse, resamples for its errors, and the seed of both.
const STARTS: usize = 12;
const RESAMPLES: usize = 200;
const SEED: u64 = 20_120_331;
/// Fraction of the points that must be compared: with less a search wins by pulling the curves apart.
const OVERLAP: f64 = 0.75;
/// S up to which curves count as collapsed: their distance is a few of their errors.
const COLLAPSED: f64 = 10.0;
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
    fits: &[(&Line<'_>, Divergence)],
    claimed: [f64; 2],
    slope: f64,
    quantity: impl Fn(&WidthEnsemble) -> Option<Uncertain>,
) -> Option<Collapsed> {
    let mut critical = Vec::new();
    let mut curves = Vec::new();
    for (line, fit) in fits {
        let critical_width = fit.critical_width;
        let points: Vec<CurvePoint> = line
            .ensembles
            .iter()
            .filter(|ensemble| ensemble.observed >= 3 * ensemble.censored && ensemble.observed > 2)
            .filter(|ensemble| ensemble.width < fit.critical_width.value)
            .filter(|ensemble| {
                ensemble
                    .naive_mean
                    .is_some_and(|mean| mean > 3.0 * line.period())
            })
            .filter_map(|ensemble| {
                let found =
                    quantity(ensemble).filter(|found| found.value > 0.0 && found.error > 0.0)?;
                // A critical width that is off by its error moves a point along the curve.
                let steepness = slope * found.value / (critical_width.value - ensemble.width);
                Some(CurvePoint {
                    x: ensemble.width,
                    y: found.value,
                    error: found.error.hypot(steepness * critical_width.error),
                })
            })
            .collect();
        if points.len() >= 3 {
            critical.push(fit.critical_width.value);
            curves.push(Curve {
                parameter: line.strain_rate,
                points,
            });
        }
    }
    collapse_curves(critical, curves, claimed, Some(claimed))
}

/// Collapses curves of known critical widths, beginning the search at `start`; `None` where there are fewer than three.
pub(crate) fn collapse_curves(
    critical: Vec<f64>,
    curves: Vec<Curve>,
    start: [f64; 2],
    claimed: Option<[f64; 2]>,
) -> Option<Collapsed> {
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
    let bootstrap = Bootstrap {
        resamples: RESAMPLES,
        seed: SEED,
    };
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

/// Standard error from estimates that leave out one of n curves each, [(n - 1)/n sum (t_i - mean)^2]^(1/2); 0 without any.
/// Source: Efron & Tibshirani, An Introduction to the Bootstrap (1993), chapter 11.
fn jackknife(estimates: &[f64]) -> f64 {
    let number = estimates.len().max(1) as f64;
    let mean = estimates.iter().sum::<f64>() / number;
    let squares: f64 = estimates.iter().map(|one| (one - mean).powi(2)).sum();
    (squares * (number - 1.0) / number).sqrt()
}

impl Collapsed {
    /// Houdayer and Hartmann's S at the best exponents.
    pub(crate) fn quality(&self) -> f64 {
        self.fit.quality.quality
    }

    /// Whether the curves fall on one within a few of their errors.
    pub(crate) fn holds(&self) -> bool {
        self.fit.quality.quality <= COLLAPSED
    }

    /// Whether both exponents are those of the source; not, where the curves do not collapse at all; `None` where the errors
    /// are too large to say or the source gives none.
    pub(crate) fn agrees(&self) -> Option<bool> {
        if !self.holds() {
            return Some(false);
        }
        let (claimed, _) = self.claimed?;
        let each: Vec<Option<bool>> = (0..2)
            .map(|place| super::claims::agrees(&self.exponents[place], claimed[place]))
            .collect();
        if each.contains(&Some(false)) {
            return Some(false);
        }
        each.iter().all(Option::is_some).then_some(true)
    }

    /// The exponents with the quality of the collapse.
    pub(crate) fn in_words(&self) -> String {
        format!(
            "*a* = {}, *b* = {} with *S* = {} at an overlap of {}",
            estimate(&self.exponents[0]),
            estimate(&self.exponents[1]),
            number(self.fit.quality.quality, 1),
            number(self.fit.quality.overlap, 2),
        )
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
    pub(crate) fn tables(&self, of: &str) -> Vec<ReportTable> {
        let in_table = |value: Option<f64>, digits| {
            value.map_or("–".to_owned(), |value| number(value, digits))
        };
        let mut rows = Vec::new();
        if let Some((claimed, quality)) = self.claimed {
            rows.push(vec![
                "source".to_owned(),
                number(claimed[0], 2),
                number(claimed[1], 2),
                in_table(quality.map(|found| found.0), 1),
                in_table(quality.map(|found| found.1), 2),
            ]);
        }
        rows.push(vec![
            "best".to_owned(),
            estimate(&self.exponents[0]),
            estimate(&self.exponents[1]),
            number(self.fit.quality.quality, 1),
            number(self.fit.quality.overlap, 2),
        ]);
        rows.extend(self.left_out.iter().map(|(rate, parameters)| {
            vec![
                format!("without *ε̇* = {rate}"),
                number(parameters[0], 2),
                number(parameters[1], 2),
                String::new(),
                String::new(),
            ]
        }));
        vec![ReportTable {
            caption: format!(
                "Collapse, {of}: exponents, Houdayer and Hartmann's *S*, overlap of the curves."
            ),
            head: ["", "*a*", "*b*", "*S*", "overlap"]
                .map(str::to_owned)
                .to_vec(),
            rows,
        }]
    }

    /// The scaled points of every curve: abscissa, ordinate, error.
    fn scaled(&self, exponents: &[f64]) -> Vec<(f64, [Vec<f64>; 3])> {
        let scaling = Scaling::CriticalKnown(self.critical.clone());
        self.curves
            .iter()
            .enumerate()
            .map(|(place, curve)| {
                let mut columns: [Vec<f64>; 3] = Default::default();
                for point in &curve.points {
                    let scaled = scaling.apply(exponents, place, curve.parameter, *point);
                    // The scaling works in logarithms.
                    let (x, y) = (scaled.x.exp(), scaled.y.exp());
                    for (column, value) in columns.iter_mut().zip([x, y, y * scaled.error]) {
                        column.push(value);
                    }
                }
                (curve.parameter, columns)
            })
            .collect()
    }
}

/// All curves scaled as the source says, if it does, and as collapses best: `found` with what each belongs to, and the
/// labels of the axes at the exponents of the source (none where it gives none) and of the ordinate at the best.
pub(crate) fn figure(
    found: &[(String, Collapsed)],
    name: &str,
    claimed_labels: [&str; 2],
    best_label: &str,
    slope: f64,
    caption: &str,
) -> Result<ReportFigure, ClaimError> {
    let mut panels = Vec::new();
    for (of, collapsed) in found {
        let best = &collapsed.fit.parameters;
        let mut scalings = Vec::new();
        if let Some((claimed, _)) = collapsed.claimed {
            let title = format!("{of}, exponents of the source");
            scalings.push((title, claimed.to_vec(), claimed_labels));
        }
        let title = format!("{of}, {} and {}", number(best[0], 2), number(best[1], 2));
        let labels = ["(*w*_{c} − *w*)/*ε̇*^{*b*}", best_label];
        scalings.push((title, best.clone(), labels));
        for (title, exponents, [x_label, y_label]) in &scalings {
            let mut panel = ChartPanel::new(x_label, y_label)
                .title(title)
                .x_scale(Scale::Logarithmic)
                .y_scale(Scale::Logarithmic);
            let scaled = collapsed.scaled(exponents);
            for (number, (rate, [x, y, error])) in scaled.iter().enumerate() {
                panel = panel.with(
                    Points::new("", x, y)
                        .y_errors(error)
                        .series(number)
                        .tint(Tint::Value(*rate)),
                );
            }
            let all = || scaled.iter().flat_map(|(_, [x, y, _])| x.iter().zip(y));
            let (least, largest) = all()
                .fold((f64::INFINITY, 0.0_f64), |(least, largest), (x, _)| {
                    (least.min(*x), largest.max(*x))
                });
            let middle = all().map(|(x, y)| y.ln() - slope * x.ln()).sum::<f64>()
                / all().count().max(1) as f64;
            let ends = [least, largest];
            panel = panel.with(
                Drawn::new("", &ends, &ends.map(|x| (middle + slope * x.ln()).exp()))
                    .tint(Tint::Black)
                    .pattern(Pattern::Dashed)
                    .weight(0.8),
            );
            panels.push(panel);
        }
    }
    let rates = || {
        found
            .iter()
            .flat_map(|(_, collapsed)| collapsed.curves.iter().map(|curve| curve.parameter))
    };
    let scale = ColourScale::new(
        &Axis::StrainRate.label(Units::Linear),
        rates().fold(f64::INFINITY, f64::min),
        rates().fold(0.0, f64::max),
    )
    .logarithmic();
    Ok(ReportFigure {
        name: name.to_owned(),
        caption: caption.to_owned(),
        drawing: ChartFigure::grid(panels.len().min(2), panels)
            .colour_scale(scale)
            .width(Width::DoubleColumn)
            .description("Scaled curves of several strain rates.")
            .draw()?,
    })
}
