//! Gravity in any direction: on an incline, in free fall, and on the wall.

use glam::DVec3;
use peristalsis_figures::chart::{ChartFigure, ChartPanel, Reference};
use peristalsis_physics::contact::{ContactModel, CundallStrack, Normal};

use super::plot::{closed_form, points};
use super::restitution::spring;
use super::roll::{self, TIME_STEP};
use crate::columns::Columns;
use crate::error::Result;
use crate::exhibit::spaced;
use crate::textbook::case::Circumstances;
use crate::textbook::experiment::Means;
use crate::textbook::experiment::falling::{borne_weight, fall};
use crate::textbook::experiment::sliding::Throw;
use crate::{Check, Finding, Prose};

pub(super) const PROSE: Prose = Prose::new(include_str!("gravity.md"));

const DURATION: f64 = 200.0;
/// One coefficient: between two of them the start decides what a sphere does.
const FRICTION: CundallStrack = CundallStrack {
    static_friction: roll::FRICTION.kinetic_friction,
    ..roll::FRICTION
};
/// tan(theta) from which on it gives way, 1.4.
const STEEPEST_ROLLING: f64 = 3.5 * FRICTION.kinetic_friction;
/// tan(theta) of the inclines.
const SLOPES: [f64; 8] = [0.25, 0.5, 1.0, 1.2, 1.6, 2.0, 3.0, 4.0];

/// a/g of a solid sphere on an incline of this slope.
fn acceleration(slope: f64) -> f64 {
    let sine = slope / (1.0 + slope * slope).sqrt();
    if slope <= STEEPEST_ROLLING {
        5.0 / 7.0 * sine
    } else {
        sine * (1.0 - FRICTION.kinetic_friction / slope)
    }
}

/// a/g of a sphere on an incline, from rest.
fn simulated(slope: f64, means: Means) -> Result<f64> {
    let throw = Throw {
        friction: FRICTION,
        slope,
        speed: 0.0,
        ..roll::THROW
    };
    throw.late_acceleration(means, TIME_STEP, DURATION)
}

pub(super) fn examine(circumstances: Circumstances<'_>) -> Result<Finding> {
    let mut finding = PROSE.described(&[]);
    let mut rows = Vec::new();
    for means in Means::INTEGRATORS {
        for (kernel, means) in [("fast", means), ("reference", means.by_reference())] {
            circumstances.go_on()?;
            let setting = format!("{}, {kernel} kernel", means.name());
            let mut inclines = Vec::new();
            for slope in SLOPES {
                let setting = format!("tan(theta) = {slope}, {setting}");
                let (expected, found) = (acceleration(slope), simulated(slope, means)?);
                inclines.push((slope, found));
                let check = Check::relative("a/g on an incline", &setting, expected, found, 5e-3);
                finding.checks.push(check.by("rolling or sliding"));
            }
            finding.checks.extend(falls(means, &setting)?);
            finding.checks.extend(weights(means, &setting)?);
            if rows.is_empty() {
                rows = inclines;
            }
        }
    }
    finding.data = Columns::of(&rows)
        .number("slope", "1", "tan(theta)", |row| row.0)
        .number("acceleration", "1", "a/g", |row| row.1)
        .data()?;
    finding.figures = vec![PROSE.chart("incline", &[], drawing(&rows))?];
    Ok(finding)
}

/// Without friction and with it: each has its own kernel.
fn contacts() -> [(&'static str, ContactModel); 2] {
    let normal = Normal::Linear(spring(0.1));
    [("frictionless", None), ("frictional", Some(FRICTION))]
        .map(|(name, friction)| (name, ContactModel::new(normal, friction)))
}

fn falls(means: Means, setting: &str) -> Result<Vec<Check>> {
    let gravity = 1e-3 * DVec3::new(1.0, -2.0, 2.0);
    let depth = 0.5 * gravity.length() * DURATION * DURATION;
    let checks = contacts().into_iter().map(|(name, contact)| {
        let found = fall(contact, means, gravity, (TIME_STEP, DURATION))?;
        let apart = (found - 0.5 * gravity * DURATION * DURATION).length() / depth;
        let check = Check::absolute(
            "distance from where a grain falls to, over the depth",
            &format!("{name}, {setting}"),
            0.0,
            apart,
            1e-9,
        );
        Ok(check.by("g t^2/2"))
    });
    checks.collect()
}

fn weights(means: Means, setting: &str) -> Result<Vec<Check>> {
    let mut checks = Vec::new();
    for (name, contact) in contacts() {
        for (tube, gravity) in [
            ("horizontal", -2e-3 * DVec3::Y),
            ("upright", -2e-3 * DVec3::Z),
        ] {
            let borne = borne_weight(contact, means, gravity)?;
            let setting = format!("{tube} tube, {name} grains, {setting}");
            let quantity = "force on the wall over the weight of settled grains";
            let check = Check::relative(quantity, &setting, 1.0, borne, 0.01);
            checks.push(check.by("balance of forces"));
        }
    }
    Ok(checks)
}

fn drawing(rows: &[(f64, f64)]) -> ChartFigure {
    let line =
        |name: &str, from: f64, to: f64| closed_form(name, &spaced(from, to, 41), acceleration);
    let panel = ChartPanel::new("slope tan *θ*", "acceleration *a*/*g*")
        .x_range(0.0..=4.2)
        .y_range(0.0..=1.0)
        .with(line("closed forms", 0.0, STEEPEST_ROLLING))
        .with(line("", STEEPEST_ROLLING * (1.0 + 1e-9), 4.2))
        .with(Reference::vertical(STEEPEST_ROLLING).label("7/2 *μ*"))
        .with(points("a sphere from rest", rows, |row| *row).series(0));
    ChartFigure::new(panel)
}
