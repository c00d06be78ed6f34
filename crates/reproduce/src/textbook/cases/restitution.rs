//! Restitution of normal impacts against damping.

use core::f64::consts::PI;

use peristalsis_figures::Width;
use peristalsis_figures::chart::{ChartFigure, ChartPanel, Line};
use peristalsis_physics::contact::{LinearSpringDashpot, Normal};

use super::material::aluminium_oxide_impact;
use super::plot::points;
use super::trial::{FINE, Trial, dissipation_time, expected_restitution};
use crate::columns::Columns;
use crate::error::Result;
use crate::exhibit::spaced;
use crate::textbook::case::Circumstances;
use crate::textbook::experiment::impact::Impact;
use crate::textbook::experiment::{Means, frictionless};
use crate::{Check, Finding, Prose};

pub(super) const PROSE: Prose = Prose::new(include_str!("restitution.md"));

/// Restitutions of the impacts.
const WANTED: [f64; 5] = [0.2, 0.4, 0.6, 0.8, 1.0];
/// The one of them at which kernels and steps are compared.
const EXAMPLE: f64 = 0.6;

/// The linear law of grains of mass 1, k = 1.
pub(super) const fn spring(damping: f64) -> LinearSpringDashpot {
    LinearSpringDashpot {
        normal_stiffness: 1.0,
        normal_damping: damping,
    }
}

/// Two grains under that law.
fn linear(damping: f64) -> Impact {
    Impact::of_twins(frictionless(Normal::Linear(spring(damping))), 0.05)
}

/// The damping of that law for a restitution: e = exp(-pi eta/sqrt(2 - eta^2)).
pub(super) fn linear_damping(restitution: f64) -> f64 {
    let ratio = -libm::log(restitution) / PI;
    (2.0 * ratio * ratio / (1.0 + ratio * ratio)).sqrt()
}

/// Root mean square restitution of two grains under the linear law with exactly so many steps in a contact, over places of
/// the onset within a step: the restitution of a gas of them.
pub(super) fn measured_with(damping: f64, steps: f64) -> Result<f64> {
    const PLACES: usize = 16;
    let impact = linear(damping);
    let time_step = spring(damping).contact_time(0.5) / steps;
    let mut sum = 0.0;
    for place in 0..PLACES {
        let phase = (place as f64 + 0.5) / PLACES as f64;
        let rebound = impact.simulate(Means::USUAL, time_step, phase)?;
        sum += impact.restitution(rebound.velocity).powi(2);
    }
    Ok((sum / PLACES as f64).sqrt())
}

/// The experiment under one law.
struct Series {
    law: &'static str,
    name: &'static str,
    setting: &'static str,
    reference: &'static str,
    tolerance: f64,
    expected_order: [f64; 2],
    /// The damping for a restitution.
    damping: fn(f64) -> f64,
    /// The impact and its restitution by the reference with a damping.
    impact: fn(f64) -> Impact,
    expected: fn(f64) -> f64,
    /// Damping of the figure and its unit.
    label: &'static str,
    unit: fn(&Row) -> f64,
    /// Places of the curve.
    places: usize,
}

const SERIES: [Series; 2] = [
    Series {
        law: "linear",
        name: "linear law",
        setting: "linear law, two grains",
        reference: "closed form",
        tolerance: 4e-3,
        expected_order: [0.7, 1.4],
        damping: linear_damping,
        impact: linear,
        expected: |damping| spring(damping).restitution(0.5),
        label: "damping *η* / √(*mk*)",
        unit: |_| 1.0,
        places: 80,
    },
    Series {
        law: "hertz",
        name: "Hertz law",
        setting: "Hertz law, sphere on a plane",
        reference: "equation of motion",
        tolerance: 2e-3,
        expected_order: [1.3, 2.4],
        damping: |restitution| dissipation_time(restitution, aluminium_oxide_impact),
        impact: aluminium_oxide_impact,
        expected: |time| expected_restitution(&aluminium_oxide_impact(time)),
        label: "dissipation time *A*/*t*_{c}",
        unit: |row| row.contact_time,
        places: 40,
    },
];

/// An impact with its reference.
struct Row {
    law: &'static str,
    damping: f64,
    /// Duration of the undamped contact.
    contact_time: f64,
    expected: f64,
    found: f64,
}

pub(super) fn examine(circumstances: Circumstances<'_>) -> Result<Finding> {
    let mut finding = PROSE.described(&[]);
    let mut rows: Vec<Row> = Vec::new();
    for series in &SERIES {
        for wanted in WANTED {
            circumstances.go_on()?;
            let damping = (series.damping)(wanted);
            let trial = Trial::of((series.impact)(damping));
            let (expected, found) = ((series.expected)(damping), trial.restitution(FINE)?);
            let (setting, tolerance) = (series.setting, series.tolerance);
            let check = Check::absolute("restitution", setting, expected, found, tolerance);
            finding.checks.push(check.by(series.reference));
            if wanted == EXAMPLE {
                let agree = trial.kernels_agree(&format!("{setting}, e = {wanted}"))?;
                finding.checks.push(agree);
                finding.convergences.extend(trial.convergences(
                    ("restitution", &format!("{}, e = {wanted}", series.name)),
                    series.expected_order,
                    |rebound| trial.impact.restitution(rebound.velocity) / expected - 1.0,
                )?);
            }
            rows.push(Row {
                law: series.law,
                damping,
                contact_time: trial.contact_time,
                expected,
                found,
            });
        }
    }
    finding.figures = vec![PROSE.chart("restitution", &[], drawing(&rows))?];
    finding.data = Columns::of(&rows)
        .word("law", "normal law", |row| row.law.to_owned())
        .number("damping", "m/t or t", "eta, or A", |row| row.damping)
        .number("expected", "", "restitution", |row| row.expected)
        .number("found", "", "restitution", |row| row.found)
        .data()?;
    Ok(finding)
}

fn drawing(rows: &[Row]) -> ChartFigure {
    let of_series = |(series, rows): (&Series, &[Row])| {
        let unit = (series.unit)(&rows[0]);
        let largest = rows.iter().map(|row| row.damping).fold(0.0, f64::max);
        let damping = spaced(0.0, 1.15 * largest, series.places);
        let scaled: Vec<f64> = damping.iter().map(|damping| damping / unit).collect();
        let expected: Vec<f64> = damping.iter().map(|it| (series.expected)(*it)).collect();
        let found = points("engine", rows, |row| (row.damping / unit, row.found));
        ChartPanel::new(series.label, "restitution *e*")
            .title(series.name)
            .y_range(0.0..=1.05)
            .with(Line::new(series.reference, &scaled, &expected).series(0))
            .with(found.series(1))
    };
    ChartFigure::grid(
        2,
        SERIES.iter().zip(rows.chunks(WANTED.len())).map(of_series),
    )
    .width(Width::DoubleColumn)
    .panel_height(52.0)
}
