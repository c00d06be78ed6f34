//! Dispersion and speed of sound of a chain of grains.

use core::f64::consts::PI;

use peristalsis_figures::Width;
use peristalsis_figures::chart::{ChartFigure, ChartPanel, Line, Tint};
use peristalsis_physics::contact::{DissipationForm, Normal, ViscoelasticHertz};

use super::errors::{Steps, convergences, error_chart};
use super::plot::{curve, open_if, points};
use super::restitution::spring;
use crate::columns::Columns;
use crate::error::Result;
use crate::exhibit::spaced;
use crate::textbook::case::Circumstances;
use crate::textbook::experiment::Means;
use crate::textbook::experiment::chain::Chain;
use crate::textbook::reference::hertz;
use crate::{Check, Finding, Prose};

pub(super) const PROSE: Prose = Prose::new(include_str!("chain.md"));

const HERTZ: ViscoelasticHertz = ViscoelasticHertz {
    young_modulus: 1.0,
    poisson_ratio: 0.5,
    dissipation_time: 0.0,
    dissipation_form: DissipationForm::Viscoelastic,
};
/// xi_0 \[d\]
const OVERLAP: f64 = 0.01;
/// Grains of the chains whose dispersion is measured.
const GRAINS: usize = 32;
/// Steps h sqrt(k/m).
const STEPS: Steps = Steps {
    unit: "sqrt(m/k)",
    label: "*h* √(*k*/*m*)",
    lengths: [0.1, 0.05, 0.025, 0.0125],
};

/// A chain with its stiffness for small waves.
struct Experiment {
    name: &'static str,
    chain: Chain,
    stiffness: f64,
}

fn experiments(grains: usize) -> [Experiment; 2] {
    // (3/2) kappa sqrt(xi_0); the reduced radius of two equal grains is d/4.
    let hertz = 1.5 * hertz::stiffness(&HERTZ, 0.25) * OVERLAP.sqrt();
    [
        ("linear law", Normal::Linear(spring(0.0)), 1.0),
        ("Hertz law", Normal::Hertz(HERTZ), hertz),
    ]
    .map(|(name, normal, stiffness)| Experiment {
        name,
        stiffness,
        chain: Chain {
            normal,
            grains,
            overlap: OVERLAP,
            amplitude: 1e-4,
        },
    })
}

impl Experiment {
    /// omega(k) = 2 sqrt(k/m) |sin(k a/2)|.
    fn expected(&self, mode: usize) -> f64 {
        2.0 * self.stiffness.sqrt() * libm::sin(PI * mode as f64 / self.chain.grains as f64)
    }

    /// The frequency of a mode; the step is in units of sqrt(m/k).
    fn frequency(&self, mode: usize, half_periods: usize, means: Means, step: f64) -> Result<f64> {
        let time_step = step / self.stiffness.sqrt();
        self.chain.frequency(mode, half_periods, means, time_step)
    }
}

/// A mode of a chain.
struct Row {
    law: &'static str,
    /// k a
    wavenumber: f64,
    expected: f64,
    found: f64,
    /// Frequency in units of sqrt(k/m).
    scaled: f64,
}

pub(super) fn examine(circumstances: Circumstances<'_>) -> Result<Finding> {
    let half_periods = circumstances.size.choose(4, 10);
    let mut finding = PROSE.described(&[]);
    let mut rows: Vec<Row> = Vec::new();
    for experiment in experiments(GRAINS) {
        for mode in [1, 2, 4, 8, 12, 16] {
            circumstances.go_on()?;
            let expected = experiment.expected(mode);
            let found = experiment.frequency(mode, half_periods, Means::USUAL, STEPS.lengths[3])?;
            let wavenumber = experiment.chain.wavenumber(mode) * experiment.chain.spacing();
            if [1, 8, 16].contains(&mode) {
                let setting = format!("{}, k a = {:.3} pi", experiment.name, wavenumber / PI);
                let check = Check::relative("frequency", &setting, expected, found, 1e-4);
                finding.checks.push(check.by("2 sqrt(k/m) sin(k a/2)"));
            }
            rows.push(Row {
                law: experiment.name,
                wavenumber,
                expected,
                found,
                scaled: found / experiment.stiffness.sqrt(),
            });
        }
        for means in Means::INTEGRATORS {
            let with = |means| experiment.frequency(8, half_periods, means, STEPS.lengths[3]);
            let (reference, fast) = (with(means.by_reference())?, with(means)?);
            let quantity = "frequency, fast kernel against the reference";
            let setting = format!("{}, {}", experiment.name, means.name());
            let check = Check::relative(quantity, &setting, reference, fast, 1e-9);
            finding.checks.push(check.by("the reference kernel"));
        }
        let setting = format!("{}, k a = pi/2", experiment.name);
        let error = |means, step| {
            circumstances.go_on()?;
            let found = experiment.frequency(8, half_periods, means, step)?;
            // The expected value is the limit of small amplitude: amplitudes are small, but the Hertz law is not linear.
            Ok((found / experiment.expected(8) - 1.0).abs())
        };
        let errors = convergences(("frequency", &setting), &STEPS, [1.8, 2.2], error)?;
        finding.convergences.extend(errors);
    }
    for experiment in experiments(128) {
        circumstances.go_on()?;
        let frequency = experiment.frequency(1, 4, Means::USUAL, STEPS.lengths[1])?;
        let found = frequency / experiment.chain.wavenumber(1);
        let expected = experiment.chain.spacing() * experiment.stiffness.sqrt();
        let check = Check::relative("speed of sound", experiment.name, expected, found, 3e-4);
        finding.checks.push(check.by("a sqrt(k/m)"));
    }
    let errors = error_chart(&STEPS, &[("", &finding.convergences[..2])]);
    finding.figures = vec![
        PROSE.chart("chain", &[], dispersion(&rows))?,
        PROSE.chart("chain-errors", &[], errors)?,
    ];
    finding.data = Columns::of(&rows)
        .word("law", "contact law", |row| row.law.to_owned())
        .number("wavenumber", "1/a", "k a", |row| row.wavenumber)
        .number("expected", "1/t", "frequency", |row| row.expected)
        .number("found", "1/t", "frequency", |row| row.found)
        .data()?;
    Ok(finding)
}

fn dispersion(rows: &[Row]) -> ChartFigure {
    let over_pi = spaced(0.0, 1.0, 80);
    let sound = [0.0, 0.6];
    let mut panel = ChartPanel::new("*ka*/π", "*ω* / √(*k*/*m*)")
        .x_range(0.0..=1.05)
        .y_range(0.0..=2.2)
        .with(
            Line::new("sound", &sound, &sound.map(|k| PI * k))
                .tint(Tint::Grey)
                .weight(2.0),
        )
        .with(
            curve("2 sin(*ka*/2)", &over_pi, |k| 2.0 * libm::sin(0.5 * PI * k)).tint(Tint::Black),
        );
    for (series, rows) in rows.chunk_by(|one, other| one.law == other.law).enumerate() {
        let found = points(rows[0].law, rows, |row| (row.wavenumber / PI, row.scaled));
        panel = panel.with(open_if(series > 0, found.series(series)));
    }
    ChartFigure::new(panel).width(Width::SingleColumn)
}
