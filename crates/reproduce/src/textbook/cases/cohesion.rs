//! Cohesion: the force that parts two spheres, and what making and breaking a contact takes.

use core::f64::consts::PI;

use peristalsis_figures::chart::{ChartFigure, ChartPanel};
use peristalsis_physics::contact::{
    Cohesion, ContactModel, DissipationForm, Normal, NormalLaw, PullOff, ViscoelasticHertz,
};

use super::plot::{closed_form, named_once, open_if, points};
use crate::columns::Columns;
use crate::error::Result;
use crate::textbook::case::Circumstances;
use crate::textbook::experiment::cohering::{pull_off, restitution};
use crate::textbook::experiment::{Means, frictionless};
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
    pull_off: PullOff::Displacement,
};
const JKR_FORCE: Cohesion = Cohesion {
    pull_off: PullOff::Force,
    ..JKR
};
const LINEAR: Cohesion = Cohesion {
    cohesion_force: 5e-4,
    cohesion_range: 0.01,
    surface_energy: 0.0,
    pull_off: PullOff::Displacement,
};
/// Both ways in which a neck breaks, by name.
const NECKS: [(&str, Cohesion); 2] = [("JKR", JKR), ("JKR, force control", JKR_FORCE)];
const TIME_STEP: f64 = 0.02;
/// Speeds over the sticking speed.
const SPEEDS: [f64; 7] = [0.9, 0.98, 1.05, 1.2, 1.6, 2.5, 5.0];

fn contact(normal: ViscoelasticHertz, cohesion: Cohesion) -> ContactModel {
    ContactModel {
        cohesion: Some(cohesion),
        ..frictionless(Normal::Hertz(normal))
    }
}

/// W of two spheres of diameter 1: 7.09 (w^5 R^4/E*^2)^(1/3) under displacement control; under force control the integral of
/// -f dxi over the radius a of contact, from touch, xi = 0, to the largest pull, df/da = 0.
fn energy_of_a_cycle(pull_off: PullOff) -> f64 {
    let (work, reduced_radius): (f64, f64) = (2.0 * JKR.surface_energy, 0.25);
    let modulus = HERTZ.young_modulus / (2.0 * (1.0 - HERTZ.poisson_ratio * HERTZ.poisson_ratio));
    if pull_off == PullOff::Displacement {
        return 7.09 * (work.powi(5) * reduced_radius.powi(4) / (modulus * modulus)).cbrt();
    }
    let cubed = PI * work * reduced_radius * reduced_radius / modulus;
    let [touch, largest_pull] = [2.0, 9.0 / 8.0].map(|times: f64| (times * cubed).cbrt());
    let pull = |radius: f64| {
        (8.0 * PI * work * modulus).sqrt() * radius.powf(1.5)
            - 4.0 * modulus * radius.powi(3) / (3.0 * reduced_radius)
    };
    let slope =
        |radius: f64| 2.0 * radius / reduced_radius - (PI * work / (2.0 * modulus * radius)).sqrt();
    let steps = 1000;
    let width = (touch - largest_pull) / f64::from(steps);
    let middles = (0..steps).map(|step| largest_pull + (f64::from(step) + 0.5) * width);
    middles
        .map(|radius| pull(radius) * slope(radius) * width)
        .sum()
}

/// The speed below which two spheres stick: m_ij v^2/2 = W with m_ij = 1/2.
fn sticking_speed(pull_off: PullOff) -> f64 {
    (4.0 * energy_of_a_cycle(pull_off)).sqrt()
}

/// e at a speed over the sticking speed.
fn restitution_at(speed: f64) -> f64 {
    (1.0 - 1.0 / (speed * speed)).max(0.0).sqrt()
}

pub(super) fn examine(circumstances: Circumstances<'_>) -> Result<Finding> {
    let mut finding = PROSE.described(&[]);
    let mut rows = Vec::new();
    for means in Means::INTEGRATORS {
        let name = means.name();
        for (kind, cohesion, expected, reference) in [
            ("JKR", JKR, 1.5 * PI * JKR.surface_energy, "3 pi gamma R"),
            (
                NECKS[1].0,
                JKR_FORCE,
                1.5 * PI * JKR.surface_energy,
                "3 pi gamma R",
            ),
            ("linear", LINEAR, 2.0 * LINEAR.cohesion_force, "4 R f_c"),
        ] {
            circumstances.go_on()?;
            let found = pull_off(contact(HERTZ, cohesion), means, TIME_STEP, expected)?;
            let setting = format!("{kind}, a grain on a plane, {name}");
            let check = Check::relative("pull-off force", &setting, expected, found, 0.01);
            finding.checks.push(check.by(reference));
        }
        for (kind, cohesion) in NECKS {
            for speed in SPEEDS {
                circumstances.go_on()?;
                let undamped = contact(HERTZ.undamped(), cohesion);
                let absolute = speed * sticking_speed(cohesion.pull_off);
                let found = restitution(undamped, means, TIME_STEP, absolute)?;
                let setting = format!("{kind}, {speed} of the sticking speed, {name}");
                let expected = restitution_at(speed);
                let check = Check::absolute("restitution", &setting, expected, found, 0.02);
                finding.checks.push(check.by("Thornton & Ning 1998"));
                if means == Means::USUAL {
                    let speed = absolute / sticking_speed(PullOff::Displacement);
                    rows.push((cohesion.pull_off, speed, found));
                }
            }
        }
        let undamped = contact(HERTZ.undamped(), LINEAR);
        let found = restitution(undamped, means, TIME_STEP, sticking_speed(JKR.pull_off))?;
        let setting = format!("linear, two spheres, {name}");
        let check = Check::relative("restitution", &setting, 1.0, found, 5e-3);
        finding.checks.push(check.by("no loss"));
    }
    finding.data = Columns::of(&rows)
        .word("pull_off", "where the neck breaks", |row| match row.0 {
            PullOff::Displacement => "displacement".into(),
            PullOff::Force => "force".into(),
        })
        .number(
            "speed",
            "1",
            "over the sticking speed under displacement control",
            |row| row.1,
        )
        .number("restitution", "1", "0 where they stick", |row| row.2)
        .data()?;
    finding.figures = vec![PROSE.chart("sticking", &[], drawing(&rows))?];
    Ok(finding)
}

fn drawing(rows: &[(PullOff, f64, f64)]) -> ChartFigure {
    let speeds: Vec<f64> = (0..=550_u32).map(|step| 0.01 * f64::from(step)).collect();
    let mut panel = ChartPanel::new(
        "speed over the sticking speed under displacement control",
        "restitution *e*",
    )
    .x_range(0.0..=5.5)
    .y_range(-0.05..=1.05);
    let names = ["displacement control", "force control"];
    for (series, (name, (_, cohesion))) in names.into_iter().zip(NECKS).enumerate() {
        let pull_off = cohesion.pull_off;
        let part = sticking_speed(pull_off) / sticking_speed(PullOff::Displacement);
        let name_of_form = named_once("closed form", series);
        let form = closed_form(name_of_form, &speeds, |speed| restitution_at(speed / part));
        let mine = rows.iter().filter(|row| row.0 == pull_off);
        let found = points(name, mine, |row| (row.1, row.2)).series(series);
        panel = panel.with(form).with(open_if(series > 0, found));
    }
    ChartFigure::new(panel)
}
