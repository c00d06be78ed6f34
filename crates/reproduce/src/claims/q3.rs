//! Q3: softness or geometry.

use peristalsis_analysis::Uncertain;
use peristalsis_figures::chart::{ChartFigure, ChartPanel, Points};
use peristalsis_figures::{Scale, Width};

use crate::claim::Claim;
use crate::crossing::{behind, crossing, grouped};
use crate::error::ClaimError;
use crate::evidence::Evidence;
use crate::finding::{Finding, Quantity, ReportFigure, ReportTable, Statistics, Verdict};
use crate::prose::Prose;
use crate::runs::Run;
use crate::text::{estimate, number};

const PROSE: Prose = Prose::new(include_str!("q3.md"));

pub(super) const CLAIM: Claim = Claim {
    id: "Q3",
    prose: PROSE,
    studies: &["restitution", "softness", "wavelength", "radius"],
    examine,
};

const NEEDED: Statistics = Statistics {
    strain_rates: 1,
    widths: 7,
    replicates: 3,
    runs: 300,
};

/// One parameter that is varied.
struct Part {
    study: &'static str,
    name: &'static str,
    axis: &'static str,
    scale: Scale,
    value: fn(&Run) -> f64,
}

/// e = exp(-pi eta/(2 m k - eta^2)^{1/2}), two equal grains.
fn restitution(run: &Run) -> f64 {
    let damping = run.axis("contact.normal_damping").unwrap_or(0.00548);
    (-core::f64::consts::PI * damping / (2.0 - damping * damping).sqrt()).exp()
}

fn softness(run: &Run) -> f64 {
    let stiffness = run.axis("contact.normal_stiffness").unwrap_or(1.0);
    run.strain_rate * run.wavelength / stiffness.sqrt()
}

const PARTS: [Part; 4] = [
    Part {
        study: "restitution",
        name: "restitution",
        axis: "restitution, *e*",
        scale: Scale::Linear,
        value: restitution,
    },
    Part {
        study: "softness",
        name: "softness",
        axis: "softness, *c*(*m*/*k*)^{1/2}/*d*",
        scale: Scale::Logarithmic,
        value: softness,
    },
    Part {
        study: "wavelength",
        name: "wavelength",
        axis: "wavelength, *λ*/*a*",
        scale: Scale::Logarithmic,
        value: |run| run.wavelength / run.radius,
    },
    Part {
        study: "radius",
        name: "radius",
        axis: "radius, *a*/*d*",
        scale: Scale::Logarithmic,
        value: |run| run.radius,
    },
];

/// Place of the wavelength among them, and what is kept as it varies.
const WAVELENGTH: usize = 2;
const AT_FIXED: [Kind; 2] = [
    ("*c* = 1", |row| (row.wave_speed - 1.0).abs() < 1e-6),
    ("*ε̇* = 0.1", |row| (row.strain_rate - 0.1).abs() < 1e-6),
];

/// Name of a series and what belongs to it.
type Kind = (&'static str, fn(&Row) -> bool);

/// A critical width with what belongs to it.
struct Row {
    part: usize,
    value: f64,
    wave_speed: f64,
    strain_rate: f64,
    radius: f64,
    critical: Uncertain,
}

fn examine(evidence: &Evidence) -> Result<Finding, ClaimError> {
    let mut of_values = Vec::new();
    let mut rows = Vec::new();
    for (part, Part { study, value, .. }) in PARTS.iter().enumerate() {
        let runs = &evidence.study(study)?.runs;
        for ((value, strain_rate), here) in grouped(runs, |run| (value(run), run.strain_rate)) {
            of_values.push(behind(&here));
            if let Some(crossing) = crossing(&here) {
                rows.push(Row {
                    part,
                    value,
                    strain_rate,
                    wave_speed: strain_rate * here[0].wavelength,
                    radius: here[0].radius,
                    critical: crossing.width,
                });
            }
        }
    }
    if rows.is_empty() {
        return Ok(Finding::nothing(
            "No critical width yet.",
            Statistics::default(),
            &NEEDED,
        ));
    }
    let span = |part: usize| -> f64 {
        let widths = || {
            rows.iter()
                .filter(move |row| row.part == part)
                .map(|row| row.critical.value / (2.0 * row.radius))
        };
        widths().fold(0.0, f64::max) - widths().fold(f64::INFINITY, f64::min)
    };
    let spans: Vec<String> = PARTS
        .iter()
        .enumerate()
        .filter(|(part, _)| rows.iter().filter(|row| row.part == *part).count() > 1)
        .map(|(part, Part { name, .. })| format!("{} with {name}", number(span(part), 3)))
        .collect();
    let mut finding = Finding::new(
        Verdict::Answered,
        format!(
            "Over the ranges looked at, *w*_{{c}}/(2*a*) changes by {}.",
            spans.join(", ")
        ),
        Statistics {
            strain_rates: 1,
            ..Statistics::weakest(of_values.into_iter())
        },
        &NEEDED,
    );
    finding.tables.push(ReportTable {
        caption: "Critical width from rest on the fine lattice, one parameter varied at a time."
            .to_owned(),
        head: [
            "varied",
            "value",
            "*c*",
            "*ε̇*",
            "*w*_{c}/*d*",
            "*w*_{c}/(2*a*)",
        ]
        .map(str::to_owned)
        .to_vec(),
        rows: rows
            .iter()
            .map(|row| {
                vec![
                    PARTS[row.part].name.to_owned(),
                    number(row.value, 3),
                    number(row.wave_speed, 2),
                    number(row.strain_rate, 4),
                    estimate(&row.critical),
                    number(row.critical.value / (2.0 * row.radius), 3),
                ]
            })
            .collect(),
    });
    for row in &rows {
        finding.quantities.push(Quantity {
            name: format!(
                "critical width, {} {}, wave speed {}",
                PARTS[row.part].name,
                number(row.value, 3),
                number(row.wave_speed, 2)
            ),
            symbol: "*w*_{c}".to_owned(),
            unit: "d".to_owned(),
            source: None,
            ours: Some(row.critical),
            method: "half of the runs from rest jam".to_owned(),
        });
    }
    finding.paragraphs.push(
        "Grains of stiffness *k* in a wave of strain rate *ε̇* are, in units of their own, grains of stiffness 1 in one of \
         *ε̇*/*k*^{1/2}: in a given tube the strain rate *is* the softness, and *w*_{c}(*ε̇*) the dependence on it. Only a \
         different wavelength tells them apart: at one wave speed the softness is the same and the strain rate is not. On the \
         radius: *λ*/*a*, *c* and the spacings of the wall's spheres are kept, and widths compared as fractions of the diameter."
            .to_owned(),
    );
    finding.weaknesses.push(
        "One threshold, 0.5; the radius at fixed fractions of the diameter. What has no row saw a transition at every width, or at none."
            .to_owned(),
    );
    let panels = PARTS
        .iter()
        .enumerate()
        .filter_map(|(part, Part { axis, scale, .. })| {
            let of: Vec<&Row> = rows.iter().filter(|row| row.part == part).collect();
            if of.is_empty() {
                return None;
            }
            let mut panel = ChartPanel::new(axis, "critical width, *w*_{c}/(2*a*)").x_scale(*scale);
            let kinds: &[Kind] = if part == WAVELENGTH {
                &AT_FIXED
            } else {
                &[("", |_| true)]
            };
            for (series, (name, belongs)) in kinds.iter().enumerate() {
                let of: Vec<&&Row> = of.iter().filter(|row| belongs(row)).collect();
                if of.is_empty() {
                    continue;
                }
                let x: Vec<f64> = of.iter().map(|row| row.value).collect();
                let y: Vec<f64> = of
                    .iter()
                    .map(|row| row.critical.value / (2.0 * row.radius))
                    .collect();
                let error: Vec<f64> = of
                    .iter()
                    .map(|row| row.critical.interval_95.length() / (4.0 * row.radius))
                    .map(|error| if error.is_finite() { error } else { 0.0 })
                    .collect();
                let points = Points::new(name, &x, &y)
                    .y_errors(&error)
                    .series(series)
                    .joined();
                panel = panel.with(if series == 1 { points.open() } else { points });
            }
            Some(panel)
        });
    let panels: Vec<ChartPanel> = panels.collect();
    finding.figures.push(ReportFigure {
        name: "softness-or-geometry".to_owned(),
        caption: "Critical width as a fraction of the tube's diameter against restitution, softness, wavelength and radius."
            .to_owned(),
        drawing: ChartFigure::grid(2, panels)
            .width(Width::DoubleColumn)
            .description("Four panels: critical width against one parameter each.")
            .draw()?,
    });
    Ok(finding)
}
