//! Q5: is the divergence real?

use peristalsis_analysis::{
    Family, Law, LawEvidence, ScatterLawFit, Survival, Transition, Uncertain, compare_laws,
};
use peristalsis_figures::chart::{ChartFigure, ChartPanel, Line as Curve, Tint};
use peristalsis_figures::{ColourScale, Quantity as Axis, Scale, Width};

use crate::claim::Claim;
use crate::critical::{Line, OnLattice, weighted_mean};
use crate::error::ClaimError;
use crate::evidence::Evidence;
use crate::exhibit::{cell_of, ends, label, points, rate_colours, spaced};
use crate::finding::{Finding, Quantity, ReportFigure, Statistics, Verdict};
use crate::judgement::best;
use crate::prose::Prose;
use crate::text::{number, probability};
use crate::thresholds::{EXCLUDED, WINDOW, WORSE};

const PROSE: Prose = Prose::new(include_str!("q5.md"));

pub(super) const CLAIM: Claim = Claim {
    id: "Q5",
    prose: PROSE,
    studies: &[
        "divergence-fine",
        "divergence-coarse",
        "branches-fine",
        "branches-coarse",
    ],
    examine,
};

/// The laws that are compared.
const LAWS: [Law; 4] = [
    Law::Power,
    Law::Barrier { power: 1.0 },
    Law::Barrier { power: 2.0 },
    Law::Exponential,
];

/// The laws at one strain rate.
struct Compared<'a> {
    lattice: &'a str,
    line: &'a Line<'a>,
    scatter: ScatterLawFit,
    laws: Vec<LawEvidence>,
}

impl<'a> Compared<'a> {
    fn of(lattice: &'a str, line: &'a Line<'a>, scatter: ScatterLawFit) -> Option<Self> {
        let (width, transitions) = line.window(WINDOW)?;
        let laws = compare_laws(&LAWS, Family::Gamma, &width, &transitions);
        Some(Self {
            lattice,
            line,
            scatter,
            laws: laws.unwrap_or_default(),
        })
    }

    fn excess(&self, law: Law) -> Option<f64> {
        let found = self.laws.iter().find(|one| one.law == law)?;
        Some(found.excess)
    }

    /// Whether the data can be compared, and one of these laws is as good as the best.
    fn is_good(&self, laws: &[Law]) -> bool {
        let is_good = |law: &Law| self.excess(*law).is_some_and(|excess| excess < WORSE);
        self.excess(Law::Power).is_some() && laws.iter().any(is_good)
    }

    fn row(&self) -> Vec<String> {
        let scatter = &self.scatter;
        [self.lattice.to_owned(), number(self.line.strain_rate, 3)]
            .into_iter()
            .chain(LAWS.map(|law| cell_of(self.excess(law), |excess| number(excess, 1))))
            .chain([
                scatter.scatter_exponent.to_string(),
                probability(scatter.chance_probability),
                number(scatter.constant_probability, 3),
                number(scatter.inverse_probability, 3),
            ])
            .collect()
    }

    /// Relative variance against the distance from the critical width.
    fn variances(&self) -> Vec<(f64, Uncertain)> {
        let critical = self.scatter.critical_width.value;
        let ensembles = self.line.ensembles.iter();
        ensembles
            .filter(|one| one.observed > 2 * one.censored && one.width < critical)
            .filter_map(|one| {
                let fit = one.fit?;
                let squared = fit.mean.value.powi(2);
                let ratio =
                    Uncertain::normal(fit.variance.value / squared, fit.variance.error / squared);
                (ratio.value > 0.0).then_some((critical - one.width, ratio))
            })
            .collect()
    }
}

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let needed = Statistics::FOR_A_VERDICT;
    let lattices = OnLattice::all(evidence)?;
    let statistics = best(lattices.iter().map(OnLattice::statistics), &needed);
    let (mut compared, mut quantities) = (Vec::new(), Vec::new());
    let (mut all, mut excluded) = (0, 0);
    for one in &lattices {
        let scatters = || {
            one.fitted()
                .filter_map(|(line, fit)| Some((line, fit.scatter?)))
        };
        let exponents: Vec<Uncertain> = scatters().map(|(_, fit)| fit.scatter_exponent).collect();
        quantities.extend(weighted_mean(&exponents).map(|mean| Quantity {
            source: Some(1.0),
            ..PROSE.quantity(
                "exponent",
                &[("lattice", &one.name), ("rates", &exponents.len())],
                mean,
            )
        }));
        all += exponents.len();
        excluded += scatters()
            .filter(|(_, fit)| fit.chance_probability < EXCLUDED)
            .count();
        compared.extend(scatters().filter_map(|(line, fit)| Compared::of(&one.name, line, fit)));
    }
    if compared.is_empty() {
        let nothing = PROSE.text("nothing", &[]);
        return Ok(Finding::nothing(&nothing, statistics, &needed));
    }
    let good = |laws: &[Law]| compared.iter().filter(|one| one.is_good(laws)).count();
    let with_power = |one: &&Compared<'_>| one.excess(Law::Power).is_some();
    let summary = PROSE.text(
        "summary",
        &[
            ("excluded", &excluded),
            ("all", &all),
            ("power", &good(&LAWS[..1])),
            ("compared", &compared.iter().filter(with_power).count()),
            ("barrier", &good(&LAWS[1..3])),
            ("exponential", &good(&LAWS[3..])),
        ],
    );
    let mut finding = Finding::new(Verdict::Answered, summary, statistics, &needed);
    finding.quantities = quantities;
    let rows = compared.iter().map(Compared::row).collect();
    finding.tables.push(PROSE.table("laws", &[], rows));
    finding.paragraphs = PROSE.paragraphs("method", &[]);
    finding.weaknesses = PROSE.paragraphs("weaknesses", &[]);
    finding.figures.extend(relative_variance(&compared)?);
    let survival = compared
        .iter()
        .filter(|one| one.lattice == "fine" && (one.line.strain_rate - 0.1).abs() < 0.03)
        .find_map(|one| survival_panel(one.line, one.scatter.critical_width.value));
    if let Some((panel, scale)) = survival {
        let drawing = ChartFigure::new(panel)
            .colour_scale(scale)
            .description("Survival curves beside an exponential.")
            .draw()?;
        finding.figures.push(PROSE.figure("survival", &[], drawing));
    }
    Ok(finding)
}

fn relative_variance(compared: &[Compared<'_>]) -> Result<Option<ReportFigure>, ClaimError> {
    let mut panel = ChartPanel::new("distance, (*w*_{c} − *w*)/*d*", "*χ_{τ}*/*τ*^2")
        .x_scale(Scale::Logarithmic)
        .y_scale(Scale::Logarithmic);
    let mut rates = Vec::new();
    for one in compared {
        let rate = one.line.strain_rate;
        if let Some(points) = points("", one.variances()) {
            rates.push(rate);
            panel = panel.with(
                points
                    .series(usize::from(one.lattice == "coarse"))
                    .tint(Tint::Value(rate)),
            );
        }
    }
    if rates.is_empty() {
        return Ok(None);
    }
    let drawing = ChartFigure::new(panel)
        .colour_scale(rate_colours(rates.into_iter()))
        .width(Width::SingleColumn)
        .description("Relative variance against distance from the critical width.")
        .draw()?;
    Ok(Some(PROSE.figure("relative-variance", &[], drawing)))
}

/// Survival against time over its mean at each width below the critical one, coloured by the width.
fn survival_panel(line: &Line<'_>, critical: f64) -> Option<(ChartPanel, ColourScale)> {
    let mut panel = ChartPanel::new("time over its mean, *t*/*τ*_{mean}", &label(Axis::Survival))
        .x_range(0.0..=2.5)
        .y_range(0.0..=1.05);
    let (width, transitions) = line.columns();
    let mut widths = Vec::new();
    for ensemble in &line.ensembles {
        let resolved = ensemble
            .naive_mean
            .is_some_and(|mean| mean > 10.0 * line.period());
        if ensemble.observed <= 2 * ensemble.censored || !resolved || ensemble.width >= critical {
            continue;
        }
        let of_width = width.iter().zip(&transitions);
        let here: Vec<Transition> = of_width
            .filter(|(width, _)| **width == ensemble.width)
            .map(|(_, transition)| *transition)
            .collect();
        let (Some(fit), Ok(survival)) = (ensemble.fit, Survival::new(&here)) else {
            continue;
        };
        let (mut time, mut left) = (vec![0.0], vec![1.0]);
        for step in &survival.steps {
            time.push(step.time / fit.mean.value);
            left.push(step.survival.value);
        }
        let curve = Curve::new("", &time, &left).stepped();
        panel = panel.with(curve.tint(Tint::Value(ensemble.width)));
        widths.push(ensemble.width);
    }
    let (least, largest) = ends(widths.into_iter())?;
    let time = spaced(0.0, 2.5, 60);
    let chance: Vec<f64> = time.iter().map(|time| (-time).exp()).collect();
    panel = panel.with(Curve::new("chance", &time, &chance).tint(Tint::Grey));
    Some((panel, ColourScale::new(&label(Axis::Width), least, largest)))
}
