//! Q11: what the method of computing does to the numbers.

use peristalsis_analysis::{FractionCrossing, Uncertain};
use peristalsis_figures::chart::{ChartFigure, ChartPanel, Points};
use peristalsis_figures::{Quantity as Axis, Scale, Width};

use super::label;
use crate::claim::Claim;
use crate::crossing::{behind, crossing, grouped};
use crate::error::ClaimError;
use crate::evidence::Evidence;
use crate::finding::{Finding, Quantity, ReportFigure, ReportTable, Statistics, Verdict};
use crate::prose::Prose;
use crate::runs::Run;
use crate::text::estimate;

const PROSE: Prose = Prose::new(include_str!("q11.md"));

pub(super) const CLAIM: Claim = Claim {
    id: "Q11",
    prose: PROSE,
    studies: &["method-fine", "method-coarse"],
    examine,
};

const NEEDED: Statistics = Statistics {
    strain_rates: 1,
    widths: 7,
    replicates: 5,
    runs: 150,
};

const STUDIES: [(&str, &str); 2] = [("method-fine", "fine"), ("method-coarse", "coarse")];

/// How a run was computed.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
struct Method {
    /// Two-step Adams-Bashforth instead of velocity Verlet.
    is_adams_bashforth: bool,
    /// Step \[t\].
    time_step: f64,
    /// Skin \[d\].
    skin: f64,
}

impl Method {
    /// That of the presets.
    const DEFAULT: Self = Self {
        is_adams_bashforth: false,
        time_step: 0.05,
        skin: 0.3,
    };

    fn of(run: &Run) -> Self {
        Self {
            is_adams_bashforth: run.axis("run.integrator=adams_bashforth").is_some(),
            time_step: run.axis("run.time_step").unwrap_or(Self::DEFAULT.time_step),
            skin: run.axis("run.neighbour_skin").unwrap_or(Self::DEFAULT.skin),
        }
    }

    fn integrator(self) -> &'static str {
        if self.is_adams_bashforth {
            "Adams-Bashforth"
        } else {
            "Verlet"
        }
    }
}

/// What came out with one method on one lattice.
struct Outcome {
    method: Method,
    critical: FractionCrossing,
    /// Mean J/Jmax at the narrowest and at the widest bottleneck.
    ends: [Uncertain; 2],
}

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let mut behind_all = Vec::new();
    let mut panels = Vec::new();
    let mut rows = Vec::new();
    let mut quantities = Vec::new();
    let mut words = Vec::new();
    for (study, lattice) in STUDIES {
        let mut outcomes = Vec::new();
        for (method, here) in grouped(&evidence.study(study)?.runs, |run| Method::of(run)) {
            behind_all.push(behind(&here));
            outcomes.extend(outcome(method, &here));
        }
        let Some(usual) = outcomes.iter().find(|one| one.method == Method::DEFAULT) else {
            continue;
        };
        let usual_width = usual.critical.width;
        let (mut most, mut most_error) = (0.0, 0.0);
        for one in &outcomes {
            let shift = one.critical.width.value - usual_width.value;
            let error = one.critical.width.error.hypot(usual_width.error);
            let is_other =
                one.method != Method::DEFAULT && one.method.time_step <= Method::DEFAULT.time_step;
            if is_other && shift.abs() >= f64::abs(most) {
                (most, most_error) = (shift, error);
            }
            rows.push(vec![
                lattice.to_owned(),
                one.method.integrator().to_owned(),
                format!("{}", one.method.time_step),
                format!("{}", one.method.skin),
                estimate(&one.critical.width),
                if one.method == Method::DEFAULT {
                    "–".to_owned()
                } else {
                    estimate(&Uncertain::normal(shift, error))
                },
                estimate(&one.ends[0]),
                estimate(&one.ends[1]),
            ]);
            quantities.push(Quantity {
                name: format!(
                    "critical width, {lattice} lattice, {}, step {}, skin {}",
                    one.method.integrator(),
                    one.method.time_step,
                    one.method.skin
                ),
                symbol: "*w*_{c}".to_owned(),
                unit: "d".to_owned(),
                source: None,
                ours: Some(one.critical.width),
                method: "half of the runs from rest jam".to_owned(),
            });
        }
        words.push(format!(
            "{lattice} lattice: against *h* = 0.05 with velocity Verlet no smaller step, other skin or other integrator moves \
             *w*_{{c}} by more than {}",
            estimate(&Uncertain::normal(most, most_error))
        ));
        panels.push(panel(lattice, &outcomes));
    }
    // One strain rate a lattice, whatever the number of methods.
    let statistics = Statistics {
        strain_rates: 1,
        ..Statistics::weakest(behind_all.into_iter())
    };
    if panels.is_empty() {
        return Ok(Finding::nothing(
            "No method has a critical width yet.",
            statistics,
            &NEEDED,
        ));
    }
    let mut finding = Finding::new(
        Verdict::Answered,
        format!("{}.", words.join("; ")),
        statistics,
        &NEEDED,
    );
    finding.quantities = quantities;
    finding.tables.push(ReportTable {
        caption: "Critical width from rest by integrator, time step *h* and neighbour skin, its shift against the presets' \
                  method, and *J*/*J*_{max} at the narrowest and at the widest bottleneck of the study."
            .to_owned(),
        head: ["lattice", "integrator", "*h* (*k*/*m*)^{1/2}", "skin/*d*", "*w*_{c}/*d*", "shift", "narrowest", "widest"]
            .map(str::to_owned)
            .to_vec(),
        rows,
    });
    finding.paragraphs.push(
        "Every method has packings of its own: methods differ by their scatter too. The skin changes only the order of sums, \
         so that its rows show that scatter. A head-on collision at *h* = 0.05 takes 44 steps."
            .to_owned(),
    );
    finding.weaknesses.push(
        "All numbers have 53 bits; single precision is not offered, and so not compared."
            .to_owned(),
    );
    finding.figures.push(ReportFigure {
        name: "method".to_owned(),
        caption: "Critical width against the time step for both integrators.".to_owned(),
        drawing: ChartFigure::grid(panels.len(), panels)
            .width(Width::DoubleColumn)
            .description("Critical width against the time step.")
            .draw()?,
    });
    Ok(finding)
}

fn outcome(method: Method, runs: &[&Run]) -> Option<Outcome> {
    let critical = crossing(runs)?;
    let at_widths = grouped(runs.iter().copied(), |run| run.width);
    let mean = |(_, here): &(f64, Vec<&Run>)| {
        let count = here.len() as f64;
        let mean = here.iter().map(|run| run.flow_rate_ratio).sum::<f64>() / count;
        let squares: f64 = here
            .iter()
            .map(|run| (run.flow_rate_ratio - mean).powi(2))
            .sum();
        Uncertain::normal(mean, (squares / (count * (count - 1.0).max(1.0))).sqrt())
    };
    Some(Outcome {
        method,
        critical,
        ends: [mean(at_widths.first()?), mean(at_widths.last()?)],
    })
}

/// Critical width against the step, one series an integrator, at the usual skin.
fn panel(lattice: &str, outcomes: &[Outcome]) -> ChartPanel {
    let mut panel = ChartPanel::new(
        "time step, *h* (*k*/*m*)^{1/2}",
        &label(Axis::CriticalWidth),
    )
    .title(&format!("{lattice} lattice"))
    .x_scale(Scale::Logarithmic);
    for (series, is_adams_bashforth) in [false, true].into_iter().enumerate() {
        let here: Vec<&Outcome> = outcomes
            .iter()
            .filter(|one| one.method.is_adams_bashforth == is_adams_bashforth)
            .filter(|one| one.method.skin == Method::DEFAULT.skin)
            .collect();
        let Some(first) = here.first() else {
            continue;
        };
        let column = |of: fn(&Outcome) -> f64| here.iter().map(|one| of(one)).collect::<Vec<f64>>();
        let points = Points::new(
            first.method.integrator(),
            &column(|one| one.method.time_step),
            &column(|one| one.critical.width.value),
        )
        .y_errors(&column(|one| one.critical.width.interval_95.length() / 2.0))
        .series(series)
        .joined();
        panel = panel.with(points);
    }
    panel
}
