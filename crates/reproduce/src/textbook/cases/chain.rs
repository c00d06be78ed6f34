//! Dispersion and speed of sound of a chain of grains.

use core::f64::consts::PI;

use peristalsis_figures::chart::{ChartFigure, ChartPanel, Line, Points, Tint};
use peristalsis_figures::{Drawing, Width};
use peristalsis_physics::contact::{
    DissipationForm, LinearSpringDashpot, Normal, ViscoelasticHertz,
};

use super::study::{error_figure, evenly, numbers, table, words};
use crate::textbook::case::{Case, Circumstances};
use crate::textbook::error::ValidateError;
use crate::textbook::experiment::Means;
use crate::textbook::experiment::chain::Chain;
use crate::textbook::finding::{CaseFigure, Check, Convergence, Finding};

pub(super) const CASE: Case = Case {
    name: "chain",
    title: "Sound in a chain of grains: dispersion, speed, order in the time step",
    source: "Brillouin 1946; Nesterenko 1983 (Hertz, precompressed)",
    examine,
};

const LINEAR: Normal = Normal::Linear(LinearSpringDashpot {
    normal_stiffness: 1.0,
    normal_damping: 0.0,
});
const HERTZ: ViscoelasticHertz = ViscoelasticHertz {
    young_modulus: 1.0,
    poisson_ratio: 0.5,
    dissipation_time: 0.0,
    dissipation_form: DissipationForm::Viscoelastic,
};
/// Grains of the chains whose dispersion is measured.
const GRAINS: usize = 32;
/// Steps h sqrt(k/m).
const STEPS: [f64; 4] = [0.1, 0.05, 0.025, 0.0125];

/// A chain with the stiffness that small waves feel.
struct Row {
    name: &'static str,
    chain: Chain,
    stiffness: f64,
}

fn rows(grains: usize) -> [Row; 2] {
    let overlap = 0.01;
    let chain = |normal: Normal| Chain {
        normal,
        grains,
        overlap,
        amplitude: 1e-4,
    };
    // (3/2) kappa sqrt(xi_0), kappa = 2 Y sqrt(R)/(3 (1 - nu^2)) with R = 1/4.
    let nu = HERTZ.poisson_ratio;
    let kappa = 2.0 * 0.5 / (3.0 * (1.0 - nu * nu));
    [
        Row {
            name: "linear law",
            chain: chain(LINEAR),
            stiffness: 1.0,
        },
        Row {
            name: "Hertz law",
            chain: chain(Normal::Hertz(HERTZ)),
            stiffness: 1.5 * kappa * overlap.sqrt(),
        },
    ]
}

impl Row {
    /// omega(k) = 2 sqrt(k/m) |sin(k a/2)|.
    fn expected(&self, mode: usize) -> f64 {
        2.0 * self.stiffness.sqrt() * libm::sin(PI * mode as f64 / self.chain.grains as f64)
    }

    /// h of a step in units of sqrt(m/k).
    fn time_step(&self, scaled: f64) -> f64 {
        scaled / self.stiffness.sqrt()
    }
}

fn examine(circumstances: Circumstances<'_>) -> Result<Finding, ValidateError> {
    let half_periods = circumstances.extent.choose(4, 10);
    let mut finding = Finding {
        paragraphs: vec![
            "A ring of grains on the axis of the tube, closed by its period; each overlaps its neighbours by xi_0 = 0.01 (spacing a \
             = d - xi_0). The frequency of a standing wave of amplitude 1e-4 xi_0 is that of the passages of its mode through 0. \
             Under the Hertz law k = (3/2) kappa sqrt(xi_0). Speed of sound: omega/k of one wave around a ring of 128 grains, whose \
             dispersion takes 1e-4 off a sqrt(k/m)."
                .to_owned(),
        ],
        ..Finding::default()
    };
    let mut measured: Vec<(&str, f64, f64, f64)> = Vec::new();
    for row in rows(GRAINS) {
        let time_step = row.time_step(STEPS[3]);
        for mode in [1, 2, 4, 8, 12, 16] {
            circumstances.go_on()?;
            let found = row
                .chain
                .frequency(mode, half_periods, Means::USUAL, time_step)?;
            let expected = row.expected(mode);
            let wavenumber = row.chain.wavenumber(mode) * row.chain.spacing();
            measured.push((row.name, wavenumber, expected, found));
            if [1, 8, 16].contains(&mode) {
                let setting = format!("{}, k a = {:.3} pi", row.name, wavenumber / PI);
                let check = Check::relative("frequency", &setting, expected, found, 1e-4);
                finding.checks.push(check.by("2 sqrt(k/m) sin(k a/2)"));
            }
        }
        let plain = |means| row.chain.frequency(8, half_periods, means, time_step);
        for means in Means::INTEGRATORS {
            let check = Check::relative(
                "frequency, fast kernel against plain",
                &format!("{}, {}", row.name, means.name()),
                plain(means.plainly())?,
                plain(means)?,
                1e-9,
            );
            finding.checks.push(check.by("the plain kernel"));
            let mut errors = Vec::new();
            for step in STEPS {
                circumstances.go_on()?;
                let found = row
                    .chain
                    .frequency(8, half_periods, means, row.time_step(step))?;
                // Amplitudes are small, but the Hertz law is not linear: the limit of small amplitude is what is expected.
                errors.push((found / row.expected(8) - 1.0).abs());
            }
            finding.convergences.push(Convergence::new(
                "frequency",
                &format!("{}, k a = pi/2, {}", row.name, means.name()),
                "sqrt(m/k)",
                &STEPS,
                &errors,
                [1.8, 2.2],
            ));
        }
    }
    for row in rows(128) {
        circumstances.go_on()?;
        let time_step = row.time_step(STEPS[1]);
        let frequency = row.chain.frequency(1, 4, Means::USUAL, time_step)?;
        let found = frequency / row.chain.wavenumber(1);
        let expected = row.chain.spacing() * row.stiffness.sqrt();
        let check = Check::relative("speed of sound", row.name, expected, found, 3e-4);
        finding.checks.push(check.by("a sqrt(k/m)"));
    }
    finding.figures.push(CaseFigure {
        name: "chain",
        caption: "Frequencies of standing waves in chains under the linear and the Hertz law against the wavenumber, with 2 sin(ka/2) \
                  and the line of sound.",
        drawing: dispersion(&measured)?,
    });
    let linear = finding.convergences[..2].iter().collect();
    finding.figures.push(CaseFigure {
        name: "chain-errors",
        caption: "Error of the frequency at ka = π/2 against the time step, linear law; that under the Hertz law is the same.",
        drawing: error_figure(
            "Errors of the frequency fall with the square of the time step.",
            "*h* √(*k*/*m*)",
            &[("", linear)],
        )?,
    });
    finding.table = table([
        words(
            "law",
            "contact law",
            measured.iter().map(|row| row.0.to_owned()).collect(),
        ),
        numbers(
            "wavenumber",
            "1/a",
            "k a",
            measured.iter().map(|row| row.1).collect(),
        ),
        numbers(
            "expected",
            "1/t",
            "frequency",
            measured.iter().map(|row| row.2).collect(),
        ),
        numbers(
            "found",
            "1/t",
            "frequency",
            measured.iter().map(|row| row.3).collect(),
        ),
    ])?;
    Ok(finding)
}

fn dispersion(measured: &[(&str, f64, f64, f64)]) -> Result<Drawing, ValidateError> {
    let wavenumbers = evenly(0.0, PI, 80);
    let over_pi = |values: &[f64]| -> Vec<f64> { values.iter().map(|k| k / PI).collect() };
    let curve: Vec<f64> = wavenumbers
        .iter()
        .map(|k| 2.0 * libm::sin(0.5 * k))
        .collect();
    let sound = [0.0, 0.6 * PI];
    let mut panel = ChartPanel::new("*ka*/π", "*ω* / √(*k*/*m*)")
        .x_range(0.0..=1.05)
        .y_range(0.0..=2.2)
        .with(
            Line::new("sound", &over_pi(&sound), &sound)
                .tint(Tint::Grey)
                .weight(2.0),
        )
        .with(Line::new("2 sin(*ka*/2)", &over_pi(&wavenumbers), &curve).tint(Tint::Black));
    for (series, row) in rows(GRAINS).iter().enumerate() {
        let of_law = measured.iter().filter(|point| point.0 == row.name);
        let (x, y): (Vec<f64>, Vec<f64>) = of_law
            .map(|point| (point.1 / PI, point.3 / row.stiffness.sqrt()))
            .unzip();
        let points = Points::new(row.name, &x, &y).series(series);
        panel = panel.with(if series == 0 { points } else { points.open() });
    }
    Ok(ChartFigure::new(panel)
        .description("Frequencies of both laws lie on 2 sin(ka/2), which leaves the line of sound as waves become short.")
        .width(Width::SingleColumn)
        .draw()?)
}
