//! Q5: is the divergence real?

use peristalsis_analysis::{
    Law, LawEvidence, ScatterLawFit, Survival, Transition, compare_laws_with_scatter,
};
use peristalsis_figures::ColourScale;

use super::prelude::*;

const PROSE: Prose = Prose::new(include_str!("q5.md"));

pub(super) const CLAIM: Claim = Claim::new("Q5", PROSE, TRANSITIONS, examine);

/// The laws that are compared.
const LAWS: [Law; 4] = [
    Law::Power,
    Law::Barrier { power: 1.0 },
    Law::Barrier { power: 2.0 },
    Law::Exponential,
];

/// The laws at one strain rate.
struct Compared<'a> {
    wall: &'a str,
    line: &'a Line<'a>,
    scatter: ScatterLawFit,
    laws: Vec<LawEvidence>,
}

impl<'a> Compared<'a> {
    fn of(wall: &'a str, line: &'a Line<'a>, scatter: ScatterLawFit) -> Option<Self> {
        let (width, transitions) = line.window(WINDOW)?;
        let laws = compare_laws_with_scatter(&LAWS, &width, &transitions);
        Some(Self {
            wall,
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
        [self.wall.to_owned(), number(self.line.strain_rate, 3)]
            .into_iter()
            .chain(LAWS.map(|law| cell_of(self.excess(law), |excess| number(excess, 1))))
            .chain([
                scatter.scatter_exponent.to_string(),
                probability(scatter.chance_probability),
                probability(scatter.constant_probability),
                probability(scatter.inverse_probability),
            ])
            .collect()
    }

    /// Relative variance against the distance from the critical width.
    fn variances(&self) -> Vec<(f64, Uncertain)> {
        let critical = self.scatter.critical_width.value;
        let ensembles = self.line.ensembles.iter();
        ensembles
            .filter(|one| one.observed_fraction() >= MOSTLY_SEEN && one.width < critical)
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

fn examine(evidence: &Evidence) -> Result<Finding> {
    let walls = OnWall::<Line<'_>>::all(evidence)?;
    let statistics = best(walls.iter().map(OnWall::statistics), &CLAIM.needed);
    let (mut draft, mut compared) = (Draft::of(PROSE), Vec::new());
    let (mut all, mut excluded) = (0, 0);
    for one in &walls {
        let exponents = one.scattered().map(|(_, fit)| fit.scatter_exponent);
        let exponents: Vec<Uncertain> = exponents.collect();
        let (wall, rates) = (&one.name, exponents.len());
        let mean = weighted_mean(&exponents);
        draft.compared("exponent", values!(wall, rates), mean, 1.0);
        all += exponents.len();
        let is_excluded = |fit: ScatterLawFit| fit.chance_probability < EXCLUDED;
        excluded += one.scattered().filter(|(_, fit)| is_excluded(*fit)).count();
        let laws = |(line, fit)| Compared::of(&one.name, line, fit);
        compared.extend(one.scattered().filter_map(laws));
    }
    if compared.is_empty() {
        return Ok(PROSE.nothing(statistics));
    }
    let good = |laws: &[Law]| compared.iter().filter(|one| one.is_good(laws)).count();
    let with_power = |one: &&Compared<'_>| one.excess(Law::Power).is_some();
    let [power, barrier, exponential] = [&LAWS[..1], &LAWS[1..3], &LAWS[3..]].map(good);
    draft.table("laws", &[], compared.iter().map(Compared::row));
    relative_variance(&mut draft, &compared)?;
    let number = compared.iter().filter(with_power).count();
    let summary = PROSE.text(
        "summary",
        values!(
            excluded,
            all,
            power,
            compared = number,
            barrier,
            exponential
        ),
    );
    let survival = compared
        .iter()
        .filter(|one| (one.line.strain_rate - 0.1).abs() < 0.03)
        .find_map(|one| {
            let drawn = survival_panel(one.line, one.scatter.critical_width.value)?;
            Some((one, drawn))
        });
    if let Some((of, (panel, scale))) = survival {
        let chart = ChartFigure::new(panel).colour_scale(scale);
        let (wall, rate) = (of.wall, of.line.strain_rate);
        draft.chart("survival", values!(wall, rate), chart)?;
    }
    Ok(draft.concluded(Verdict::Answered, summary, statistics))
}

fn relative_variance(draft: &mut Draft, compared: &[Compared<'_>]) -> Result<()> {
    let mut rates = Vec::new();
    let of_wall = |here: &[Compared<'_>]| {
        let of_rate = |one: &Compared<'_>| {
            let points = joined("", one.variances())?;
            rates.push(one.line.strain_rate);
            Some((one.line.strain_rate, Some(points)))
        };
        let drawn: Vec<_> = here.iter().filter_map(of_rate).collect();
        let relative = "relative variance, *χ_{τ}*/*τ*^2";
        let panel = ChartPanel::new("distance, (*w*_{c} − *w*)/*d*", relative)
            .x_scale(Scale::Logarithmic)
            .y_scale(Scale::Logarithmic)
            .with(Reference::horizontal(1.0).label("pure chance"))
            .title(here[0].wall);
        (!drawn.is_empty()).then(|| panel.with_all(coloured(drawn)))
    };
    let walls = compared.chunk_by(|one, next| one.wall == next.wall);
    let panels: Vec<ChartPanel> = walls.filter_map(of_wall).collect();
    if panels.is_empty() {
        return Ok(());
    }
    let chart = grid(2, panels)
        .share_y()
        .alike_y()
        .colour_scale(rate_colours(rates.into_iter()));
    draft.chart("relative-variance", &[], chart)
}

/// Survival against time over its mean at each width below the critical one, coloured by the width.
fn survival_panel(line: &Line<'_>, critical: f64) -> Option<(ChartPanel, ColourScale)> {
    let mut panel = ChartPanel::new("time over its mean, *t*/*τ*_{mean}", &label(Axis::Survival))
        .x_range(0.0..=2.5)
        .y_range(0.0..=1.05);
    let (width, transitions) = line.columns();
    let mut widths = Vec::new();
    for ensemble in &line.ensembles {
        let is_resolved = line.resolves(ensemble, 10.0);
        if ensemble.observed_fraction() < MOSTLY_SEEN || !is_resolved || ensemble.width >= critical
        {
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
