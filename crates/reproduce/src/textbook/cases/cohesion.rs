//! Cohesion: the force that parts two spheres, and what making and breaking a contact takes.

use core::f64::consts::PI;

use peristalsis_figures::chart::{ChartFigure, ChartPanel, Line, Pattern, Reference, Tint};
use peristalsis_physics::contact::{
    Cohesion, ContactModel, DissipationForm, Normal, NormalLaw, ViscoelasticHertz,
};

use super::plot::points;
use crate::columns::Columns;
use crate::error::Result;
use crate::textbook::case::Circumstances;
use crate::textbook::experiment::cohering::{pull_off, restitution};
use crate::textbook::experiment::{Means, smooth};
use crate::{Check, Finding, Prose};

pub(super) const PROSE: Prose = Prose::new(include_str!("cohesion.md"));

const HERTZ: ViscoelasticHertz = ViscoelasticHertz {
    young_modulus: 1.0,
    poisson_ratio: 0.3,
    dissipation_time: 1.0,
    dissipation_form: DissipationForm::Viscoelastic,
};
const JKR: Cohesion = Cohesion {
    cohesion_force: 0.0,
    cohesion_range: 0.0,
    surface_energy: 1e-4,
};
const LINEAR: Cohesion = Cohesion {
    cohesion_force: 5e-4,
    cohesion_range: 0.01,
    surface_energy: 0.0,
};
const TIME_STEP: f64 = 0.02;
/// Speeds over the sticking speed.
const SPEEDS: [f64; 7] = [0.9, 0.98, 1.05, 1.2, 1.6, 2.5, 5.0];

fn contact(normal: ViscoelasticHertz, cohesion: Cohesion) -> ContactModel {
    ContactModel {
        cohesion: Some(cohesion),
        ..smooth(Normal::Hertz(normal))
    }
}

/// W of two spheres of diameter 1, 7.09 (w^5 R^4/E*^2)^(1/3).
fn energy_of_a_cycle() -> f64 {
    let (work, reduced_radius): (f64, f64) = (2.0 * JKR.surface_energy, 0.25);
    let modulus = HERTZ.young_modulus / (2.0 * (1.0 - HERTZ.poisson_ratio * HERTZ.poisson_ratio));
    7.09 * (work.powi(5) * reduced_radius.powi(4) / (modulus * modulus)).cbrt()
}

/// e at a speed over the sticking speed.
fn closed_form(speed: f64) -> f64 {
    (1.0 - 1.0 / (speed * speed)).max(0.0).sqrt()
}

pub(super) fn examine(circumstances: Circumstances<'_>) -> Result<Finding> {
    let mut finding = PROSE.described(&[]);
    let mut rows = Vec::new();
    // m_ij v^2/2 = W with m_ij = 1/2.
    let sticking = (4.0 * energy_of_a_cycle()).sqrt();
    for means in Means::INTEGRATORS {
        let name = means.name();
        for (kind, cohesion, expected, reference) in [
            ("JKR", JKR, 1.5 * PI * JKR.surface_energy, "3 pi gamma R"),
            ("linear", LINEAR, 2.0 * LINEAR.cohesion_force, "4 R f_c"),
        ] {
            circumstances.go_on()?;
            let found = pull_off(contact(HERTZ, cohesion), means, TIME_STEP, expected)?;
            let setting = format!("{kind}, a grain on a plane, {name}");
            let check = Check::relative("pull-off force", &setting, expected, found, 0.01);
            finding.checks.push(check.by(reference));
        }
        for speed in SPEEDS {
            circumstances.go_on()?;
            let undamped = contact(HERTZ.undamped(), JKR);
            let found = restitution(undamped, means, TIME_STEP, speed * sticking)?;
            let setting = format!("JKR, {speed} of the sticking speed, {name}");
            let expected = closed_form(speed);
            let check = Check::absolute("restitution", &setting, expected, found, 0.02);
            finding.checks.push(check.by("Thornton & Ning 1998"));
            if means == Means::USUAL {
                rows.push((speed, found));
            }
        }
        let undamped = contact(HERTZ.undamped(), LINEAR);
        let found = restitution(undamped, means, TIME_STEP, sticking)?;
        let setting = format!("linear, two spheres, {name}");
        let check = Check::relative("restitution", &setting, 1.0, found, 5e-3);
        finding.checks.push(check.by("no loss"));
    }
    finding.data = Some(
        Columns::of(&rows)
            .number("speed", "1", "over the sticking speed", |row| row.0)
            .number("restitution", "1", "0 where they stick", |row| row.1)
            .table()?,
    );
    finding.figures = vec![PROSE.chart("sticking", &[], drawing(&rows))?];
    Ok(finding)
}

fn drawing(rows: &[(f64, f64)]) -> ChartFigure {
    let speeds: Vec<f64> = (0..=550_u32).map(|step| 0.01 * f64::from(step)).collect();
    let values: Vec<f64> = speeds.iter().map(|speed| closed_form(*speed)).collect();
    let line = Line::new("closed form", &speeds, &values)
        .tint(Tint::Black)
        .pattern(Pattern::Dashed);
    let panel = ChartPanel::new("speed over the sticking speed", "restitution *e*")
        .x_range(0.0..=5.5)
        .y_range(-0.05..=1.05)
        .with(line)
        .with(Reference::vertical(1.0))
        .with(points("two spheres", rows, |row| *row).series(0));
    ChartFigure::new(panel)
}
