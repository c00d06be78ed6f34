//! Collapse of the curves of several strain rates, with free exponents.

use peristalsis_analysis::number::decimal as number;
use peristalsis_analysis::{
    Collapse, CollapseEstimate, Curve, CurvePoint, JointTest, Scaling, Uncertain, WidthEnsemble,
};
use peristalsis_figures::Scale;
use peristalsis_figures::chart::{ChartFigure, ChartPanel, Line as Drawn, Pattern, Tint};

use crate::critical::Line;
use crate::draft::Draft;
use crate::exhibit::{cell, cell_of, coloured, ends, grid, points, probability, rate_colours};
use crate::finding::{Quantity, ReportTable};
use crate::thresholds::{
    BY_CHANCE, COLLAPSED_WITHIN, MOSTLY_SEEN, NO_COLLAPSE_BEYOND, OVERLAP, RESOLVED,
};
use crate::walls::OnWall;

/// Searches for the best collapse, and the seed of their starts.
const STARTS: usize = 8;
const SEED: u64 = 20_120_331;
/// Powers of the strain rate in corrections to scaling that are allowed for: one that fades at large rates, and one that
/// fades at small ones.
const CORRECTIONS: [f64; 2] = [-1.0, 1.0];
/// Height of a panel in millimetres, so that all walls are on one page.
const COLLAPSE_HEIGHT: f64 = 33.0;
/// First steps of the exponents.
const STEPS: [f64; 2] = [0.3, 0.15];

/// What the source says of a collapse.
#[derive(Clone, Debug)]
struct Claimed {
    exponents: [f64; 2],
    /// S and the overlap there, where curves can be compared at all.
    quality: Option<(f64, f64)>,
    /// Both exponents at once, by the likelihood there and at the best.
    joint: Option<JointTest>,
    /// Where that excludes them: the power of the strain rate in a correction to scaling that leaves them possible, and
    /// their probability with it.
    corrected: Option<(f64, f64)>,
}

/// Curves of several strain rates, and how well they collapse.
#[derive(Clone, Debug)]
pub(crate) struct Collapsed {
    curves: Vec<Curve>,
    /// Exponents of the source, if it gives any.
    claimed: Option<Claimed>,
    /// Both exponents, then the critical width of each curve, which is known within its error.
    found: CollapseEstimate,
}

/// Collapses a quantity of the transition times, mean or variance; `None` where too few strain rates have it.
pub(crate) fn collapse(
    wall: &OnWall<Line<'_>>,
    claimed: [f64; 2],
    quantity: impl Fn(&WidthEnsemble) -> Option<Uncertain>,
) -> Option<Collapsed> {
    let mut curves = Curves::default();
    for (line, fit) in wall.fitted() {
        let known = |one: &&WidthEnsemble| {
            one.observed_fraction() >= MOSTLY_SEEN
                && one.observed > 2
                && one.width < fit.critical_width.value
                && line.resolves(one, RESOLVED)
        };
        let points = line.ensembles.iter().filter(known);
        let points = points.filter_map(|one| Some((one.width, quantity(one)?)));
        curves.add(line.strain_rate, fit.critical_width, points);
    }
    curves.collapse(claimed, Some(claimed))
}

/// Curves of known critical widths.
#[derive(Default)]
pub(crate) struct Curves {
    critical: Vec<Uncertain>,
    curves: Vec<Curve>,
}

impl Curves {
    /// Adds a quantity, where three positive points or more have an error.
    pub(crate) fn add(
        &mut self,
        parameter: f64,
        critical: Uncertain,
        points: impl Iterator<Item = (f64, Uncertain)>,
    ) {
        let known = points.filter(|(_, found)| found.value > 0.0 && found.error > 0.0);
        let point = |(x, found): (f64, Uncertain)| CurvePoint {
            x,
            y: found.value,
            error: found.error,
        };
        let points: Vec<CurvePoint> = known.map(point).collect();
        if points.len() >= 3 && critical.error > 0.0 {
            self.critical.push(critical);
            self.curves.push(Curve { parameter, points });
        }
    }

    /// Collapses them, beginning the search at `start`; `None` where there are fewer than three.
    pub(crate) fn collapse(self, start: [f64; 2], claimed: Option<[f64; 2]>) -> Option<Collapsed> {
        let Self { critical, curves } = self;
        if curves.len() < 3 {
            return None;
        }
        let scaling = Scaling::CriticalEach;
        let transform = |parameters: &[f64], curve: usize, parameter: f64, point: CurvePoint| {
            scaling.apply(parameters, curve, parameter, point)
        };
        let collapse = Collapse {
            curves: &curves,
            transform: &transform,
            least_overlap: OVERLAP,
        };
        // The error of one w_c moves all points of its curve together.
        let known: Vec<(usize, Uncertain)> = (2..).zip(critical.iter().copied()).collect();
        let with = |exponents: [f64; 2], of: fn(&Uncertain) -> f64| -> Vec<f64> {
            exponents
                .into_iter()
                .chain(critical.iter().map(of))
                .collect()
        };
        let (start, steps) = (with(start, |one| one.value), with(STEPS, |one| one.error));
        let found = collapse.estimate(&known, &start, &steps, STARTS, SEED, None);
        let found = found.ok()?;
        let claimed = claimed.map(|exponents| {
            let quality = collapse.quality(&with(exponents, |one| one.value)).ok();
            let both = [(0, exponents[0]), (1, exponents[1])];
            let test = |correction: Option<f64>| {
                let of = CollapseEstimate {
                    correction,
                    ..found.clone()
                };
                collapse.joint_test(&known, &of, &steps, &both).ok()
            };
            let joint = test(None);
            let is_excluded = joint.is_some_and(|joint| joint.probability < BY_CHANCE);
            let corrected = CORRECTIONS.into_iter().filter(|_| is_excluded);
            let corrected =
                corrected.filter_map(|power| Some((power, test(Some(power))?.probability)));
            let corrected = corrected.max_by(|one, other| one.1.total_cmp(&other.1));
            Claimed {
                exponents,
                quality: quality.map(|found| (found.quality, found.overlap)),
                joint,
                corrected: corrected.filter(|(_, probability)| *probability >= BY_CHANCE),
            }
        });
        Some(Collapsed {
            curves,
            claimed,
            found,
        })
    }
}

impl Collapsed {
    /// Both exponents.
    fn exponents(&self) -> [Uncertain; 2] {
        [self.found.parameters[0], self.found.parameters[1]]
    }

    /// Whether both exponents of the source together are possible; `None` where that cannot be told, or depends on a
    /// correction to scaling.
    pub(crate) fn agrees(&self) -> Option<bool> {
        let claimed = self.claimed.as_ref()?;
        let agrees = claimed.joint?.probability >= BY_CHANCE;
        (agrees || claimed.corrected.is_none()).then_some(agrees)
    }

    /// Whether the curves collapse with any exponents, be these known well or not; `None` in between.
    pub(crate) fn holds(&self) -> Option<bool> {
        match self.found.stretch {
            stretch if stretch <= COLLAPSED_WITHIN => Some(true),
            stretch if stretch > NO_COLLAPSE_BEYOND => Some(false),
            _ => None,
        }
    }

    /// Probability of the source's exponents, both at once, and what a correction to scaling makes of it.
    pub(crate) fn chance(&self) -> String {
        let Some(claimed) = &self.claimed else {
            return cell_of(None::<f64>, probability);
        };
        let plain = cell_of(claimed.joint, |joint| probability(joint.probability));
        match claimed.corrected {
            Some((power, chance)) => format!(
                "{plain}, with a correction ~ *ε̇*^{{{}}} {}",
                number(power, 0),
                probability(chance)
            ),
            None => plain,
        }
    }

    /// The exponents, where there is a collapse, S and the overlap as text.
    fn best(&self) -> [String; 4] {
        let exponents = self.exponents().map(|one| self.is_found().then_some(one));
        let [a, b] = exponents.map(cell);
        let quality = self.found.quality;
        [a, b, number(quality.quality, 1), number(quality.overlap, 2)]
    }

    /// The exponents with the quality of the collapse.
    pub(crate) fn in_words(&self) -> String {
        if !self.is_found() {
            return format!("no collapse (at best {:.0} errors off)", self.found.stretch);
        }
        let [a, b, quality, overlap] = self.best();
        format!("collapsed at *a* = {a}, *b* = {b} (*S* = {quality}, overlap {overlap})")
    }

    /// Whether the curves collapse at the best exponents, which otherwise mean nothing: a search may pull the curves apart.
    fn is_found(&self) -> bool {
        self.found.stretch <= NO_COLLAPSE_BEYOND
    }

    /// The exponents as quantities, where there is a collapse.
    pub(crate) fn quantities(&self, of: &str, symbols: [&str; 2]) -> Vec<Quantity> {
        let words = [
            "power of the strain rate in the ordinate",
            "power of the strain rate in the distance",
        ];
        if !self.is_found() {
            return Vec::new();
        }
        (0..2)
            .map(|place| Quantity {
                name: format!("{}, {of}", words[place]),
                symbol: symbols[place].to_owned(),
                unit: String::new(),
                source: self
                    .claimed
                    .as_ref()
                    .map(|claimed| claimed.exponents[place]),
                ours: Some(self.exponents()[place]),
                method: format!(
                    "collapse of {} curves, profile likelihood",
                    self.curves.len()
                ),
            })
            .collect()
    }

    /// Quality at the exponents of the source and at the best.
    pub(crate) fn table(&self, of: &str) -> ReportTable {
        let row = |name: &str, cells: [String; 4], chance: String| {
            [vec![name.to_owned()], cells.to_vec(), vec![chance]].concat()
        };
        let source = self.claimed.as_ref().map(|claimed| {
            let [a, b] = claimed.exponents.map(|exponent| number(exponent, 2));
            let overlap = cell_of(claimed.quality, |found| number(found.1, 2));
            let quality = cell_of(claimed.quality, |found| number(found.0, 1));
            row("source", [a, b, quality, overlap], self.chance())
        });
        let best = row("best", self.best(), String::new());
        ReportTable::new(
            &format!(
                "Collapse, {of}: exponents, Houdayer and Hartmann's *S*, overlap of the curves, probability of the \
                 source's exponents, both at once."
            ),
            ["", "*a*", "*b*", "*S*", "overlap", "chance"],
            source.into_iter().chain([best]),
        )
    }

    /// The geometric mean of the strain rates, in which figures scale: with large exponents the numbers stay about one.
    fn unit(&self) -> f64 {
        let logarithms = self.curves.iter().map(|curve| curve.parameter.ln());
        (logarithms.sum::<f64>() / self.curves.len() as f64).exp()
    }

    /// The scaled points of every curve by its strain rate: abscissa and ordinate.
    fn scaled(&self, exponents: [f64; 2]) -> Vec<(f64, Vec<(f64, Uncertain)>)> {
        let widths = self.found.parameters[2..].iter().map(|width| width.value);
        let parameters: Vec<f64> = exponents.into_iter().chain(widths).collect();
        let unit = self.unit();
        let scaled = |(place, curve): (usize, &Curve)| {
            let points = curve.points.iter().map(|point| {
                let point =
                    Scaling::CriticalEach.apply(&parameters, place, curve.parameter / unit, *point);
                // The scaling works in logarithms.
                let (x, y) = (point.x.exp(), point.y.exp());
                (x, Uncertain::normal(y, y * point.error))
            });
            (curve.parameter, points.collect())
        };
        self.curves.iter().enumerate().map(scaled).collect()
    }

    /// The curves in a panel, beside a line of the given slope through their middle.
    fn panel(&self, exponents: [f64; 2], title: &str, labels: [&str; 2], slope: f64) -> ChartPanel {
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

/// Says among the weaknesses on which walls the exponents of the best collapse are not to be trusted.
pub(crate) fn distrust(draft: &mut Draft, found: &[(String, Collapsed)]) {
    let doubted = || found.iter().filter(|(_, one)| !one.found.trusted);
    let walls: Vec<&str> = doubted().map(|(wall, _)| wall.as_str()).collect();
    let stretch = doubted().map(|(_, one)| one.found.stretch);
    let stretch = number(stretch.fold(1.0, f64::max), 1);
    if !walls.is_empty() {
        draft.finding.weaknesses.push(format!(
            "Do not trust the best exponents on {}: errors were stretched by up to {stretch}, or corrections to scaling or unlike \
             curves may matter.",
            match walls.len() == found.len() {
                true => "any wall".to_owned(),
                false => walls.join(", "),
            }
        ));
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
        if let Some(claimed) = &collapsed.claimed {
            let title = format!("{of}, exponents of the source");
            panels.push(collapsed.panel(claimed.exponents, &title, claimed_labels, slope));
        }
        let [a, b] = collapsed.exponents();
        let title = match collapsed.is_found() {
            true => format!("{of}, *a* = {a}, *b* = {b}"),
            false => format!("{of}, no collapse"),
        };
        let best = [a.value, b.value];
        let labels = ["(*w*_{c} − *w*)/*r*^{*b*}", best_label];
        panels.push(collapsed.panel(best, &title, labels, slope));
    }
    let curves = found.iter().flat_map(|(_, collapsed)| &collapsed.curves);
    grid(panels.len().min(2), panels)
        .panel_height(COLLAPSE_HEIGHT)
        .colour_scale(rate_colours(curves.map(|curve| curve.parameter)))
}
