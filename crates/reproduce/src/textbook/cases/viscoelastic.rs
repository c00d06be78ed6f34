//! Restitution of viscoelastic spheres against the speed of impact.

use glam::DVec3;
use peristalsis_figures::chart::{ChartFigure, ChartPanel, Line, Pattern, Points, Tint};
use peristalsis_figures::{Drawing, Scale};
use peristalsis_physics::contact::{DissipationForm, Normal, ViscoelasticHertz};

use super::study::{
    FINE, convergences, error_figure, error_of, evenly, hertz_stiffness, numbers, smooth, table,
};
use crate::textbook::case::{Case, Circumstances};
use crate::textbook::error::ValidateError;
use crate::textbook::experiment::Means;
use crate::textbook::experiment::impact::{Impact, Partner, Rebound, Sphere};
use crate::textbook::finding::{CaseFigure, Check, Finding};
use crate::textbook::reference::hertz::{HertzImpact, viscoelastic_series};
use crate::textbook::reference::impact::outcome;

pub(super) const CASE: Case = Case {
    name: "viscoelastic",
    title: "Restitution of viscoelastic spheres against the speed of impact",
    source: "Schwager & Pöschel 1998, 2008; Ramírez et al. 1999; the source's e = 0.85 at v = 1",
    examine,
};

/// Diameter of the spheres that stand for grains of diameter 1 \[d\].
///
/// At v = 1 grains of diameter 1 would pass through each other. Spheres of mass 1 and diameter 10, sqrt(10) times softer, have
/// the same force at the same overlap, so that the very same equation of motion is met head-on.
const LARGE: f64 = 10.0;

/// The preset's law, for spheres of diameter [`LARGE`].
fn law(dissipation_form: DissipationForm) -> ViscoelasticHertz {
    ViscoelasticHertz {
        young_modulus: 1.0 / LARGE.sqrt(),
        poisson_ratio: 0.5,
        dissipation_time: 0.1,
        dissipation_form,
    }
}

fn impact(law: ViscoelasticHertz, speed: f64) -> Impact {
    let sphere = |velocity: f64| Sphere {
        diameter: LARGE,
        mass: 1.0,
        velocity: DVec3::new(velocity, 0.0, 0.0),
        spin: 0.0,
    };
    Impact {
        contact: smooth(Normal::Hertz(law)),
        sphere: sphere(-0.5 * speed),
        partner: Partner::Grain(sphere(0.5 * speed)),
    }
}

fn restitution(impact: &Impact, velocity: [DVec3; 2]) -> f64 {
    -(velocity[0].x - velocity[1].x) / impact.relative_velocity().x
}

fn contact_time(law: ViscoelasticHertz, impact: &Impact) -> f64 {
    HertzImpact {
        stiffness: hertz_stiffness(&law, impact),
        reduced_mass: impact.reduced_mass(),
        speed: impact.relative_velocity().length(),
    }
    .contact_time()
}

/// s of the series.
fn small_parameter(law: ViscoelasticHertz, impact: &Impact) -> f64 {
    let ratio = hertz_stiffness(&law, impact) / impact.reduced_mass();
    law.relaxation_time()
        * libm::pow(ratio, 0.4)
        * libm::pow(impact.relative_velocity().length(), 0.2)
}

/// e by the equation of motion.
fn integrated(law: ViscoelasticHertz, speed: f64) -> f64 {
    let impact = impact(law, speed);
    restitution(&impact, outcome(&impact).velocity)
}

/// e that the engine gives with so many steps in a contact, mean over places of onset and end within a step.
fn measured(law: ViscoelasticHertz, speed: f64, steps: f64) -> Result<f64, ValidateError> {
    let impact = impact(law, speed);
    let contact = (contact_time(law, &impact), steps);
    error_of(&impact, Means::USUAL, contact, |rebound| {
        restitution(&impact, rebound.velocity)
    })
}

fn examine(circumstances: Circumstances<'_>) -> Result<Finding, ValidateError> {
    let viscoelastic = law(DissipationForm::Viscoelastic);
    let mut finding = Finding {
        paragraphs: vec![
            "The preset's grains (Y = 1, nu = 1/2, A = 0.1). At v = d/t\\* they would pass through each other; spheres of mass 1, \
             ten times as large and softer by sqrt(10), have the same force at the same overlap and so the same head-on \
             impact. The source states e of about 0.85 at v = 1. The series 1 - C s + (3/5) C^2 s^2 + (4/15) s^(5/2), s = B \
             (kappa/m)^(2/5) v^(1/5), leaves out terms of order s^3, which is the tolerance there (with h = t_c/640)."
                .to_owned(),
        ],
        ..Finding::default()
    };
    for speed in [1e-3, 1e-2, 0.1, 1.0] {
        circumstances.go_on()?;
        let expected = integrated(viscoelastic, speed);
        let found = measured(viscoelastic, speed, FINE)?;
        let setting = format!("v = {speed}");
        let check = Check::absolute("restitution", &setting, expected, found, 2e-4);
        finding.checks.push(check.by("equation of motion"));
    }
    let found = measured(viscoelastic, 1.0, FINE)?;
    let check = Check::absolute("restitution", "v = 1", 0.85, found, 5e-3);
    finding.checks.push(check.by("the source"));
    let slow = impact(viscoelastic, 1e-4);
    let s = small_parameter(viscoelastic, &slow);
    let found = measured(viscoelastic, 1e-4, 8.0 * FINE)?;
    let check = Check::absolute(
        "restitution",
        "v = 1e-4",
        viscoelastic_series(s),
        found,
        s * s * s,
    );
    finding.checks.push(check.by("series"));

    let fast = impact(viscoelastic, 1.0);
    let expected = integrated(viscoelastic, 1.0);
    finding.convergences = convergences(
        ("restitution", "v = 1"),
        &fast,
        contact_time(viscoelastic, &fast),
        [1.3, 2.4],
        |rebound: &Rebound| restitution(&fast, rebound.velocity) / expected - 1.0,
    )?;

    let points = circumstances.extent.choose(9, 25);
    let speeds: Vec<f64> = evenly(-6.0, 0.0, points)
        .iter()
        .map(|exponent| libm::pow(10.0, *exponent))
        .collect();
    let mut columns: Vec<(&str, DissipationForm, Vec<f64>, Vec<f64>)> = Vec::new();
    for (name, form) in [
        ("viscoelastic", DissipationForm::Viscoelastic),
        ("as printed", DissipationForm::Printed),
    ] {
        let expected = speeds
            .iter()
            .map(|speed| integrated(law(form), *speed))
            .collect();
        let mut found = Vec::new();
        for speed in &speeds {
            circumstances.go_on()?;
            found.push(measured(law(form), *speed, FINE)?);
        }
        columns.push((name, form, expected, found));
    }
    finding.figures.push(CaseFigure {
        name: "viscoelastic",
        caption: "Restitution of the preset's grains against the speed of a head-on impact, for both factors of the dissipation \
                  time: engine, equation of motion, and the series for small speed.",
        drawing: drawing(&speeds, &columns)?,
    });
    let convergence = finding.convergences.iter().collect();
    finding.figures.push(CaseFigure {
        name: "viscoelastic-errors",
        caption: "Error of the restitution at v = 1 against the time step.",
        drawing: error_figure(
            "Errors of the restitution fall with the power 3/2 to 2 of the time step.",
            "*h*/*t*_{c}",
            &[("", convergence)],
        )?,
    });
    let mut all = vec![numbers("speed", "d/t", "relative speed", speeds)];
    for (name, _, expected, found) in columns {
        let name = name.replace(' ', "_");
        all.push(numbers(
            &format!("{name}_expected"),
            "",
            "equation of motion",
            expected,
        ));
        all.push(numbers(&format!("{name}_found"), "", "engine", found));
    }
    finding.table = table(all)?;
    Ok(finding)
}

fn drawing(
    speeds: &[f64],
    columns: &[(&str, DissipationForm, Vec<f64>, Vec<f64>)],
) -> Result<Drawing, ValidateError> {
    let dense: Vec<f64> = evenly(-6.0, 0.0, 61)
        .iter()
        .map(|exponent| libm::pow(10.0, *exponent))
        .collect();
    let mut panel = ChartPanel::new("speed *v* (*d*/*t*\\*)", "restitution *e*")
        .x_scale(Scale::Logarithmic)
        .y_range(0.84..=1.0);
    for (number, (name, form, _, found)) in columns.iter().enumerate() {
        let expected: Vec<f64> = dense
            .iter()
            .map(|speed| integrated(law(*form), *speed))
            .collect();
        let series: Vec<f64> = dense
            .iter()
            .map(|speed| {
                viscoelastic_series(small_parameter(law(*form), &impact(law(*form), *speed)))
            })
            .collect();
        let only_once = |name| if number == 0 { name } else { "" };
        panel = panel
            .with(Line::new(only_once("equation of motion"), &dense, &expected).tint(Tint::Black))
            .with(
                Line::new(only_once("series"), &dense, &series)
                    .tint(Tint::Green)
                    .pattern(Pattern::Dashed),
            )
            .with(Points::new(name, speeds, found).series(number));
    }
    let panel = panel.with(
        peristalsis_figures::chart::Reference::horizontal(0.85)
            .label("0.85, the source at *v* = 1"),
    );
    Ok(ChartFigure::new(panel)
        .description("Restitution falls slowly with speed; the engine lies on the equation of motion, and on the series at small speed.")
        .draw()?)
}
