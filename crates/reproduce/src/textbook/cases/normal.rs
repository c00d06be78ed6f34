//! Elastic normal impact of two spheres, and of a sphere on a plane.

use core::f64::consts::PI;

use glam::DVec3;
use peristalsis_physics::contact::{Normal, ViscoelasticHertz};

use super::errors::error_chart;
use super::material::Material;
use super::trial::{PER_CONTACT, Trial};
use crate::columns::Columns;
use crate::error::Result;
use crate::textbook::case::Circumstances;
use crate::textbook::experiment::impact::{Impact, Rebound};
use crate::textbook::experiment::{Means, frictionless};
use crate::textbook::reference::hertz::HertzImpact;
use crate::{Check, Finding, Prose};

pub(super) const PROSE: Prose = Prose::new(include_str!("normal.md"));

/// An experiment as the source states it, in SI.
struct Experiment {
    material: Material,
    on_plane: bool,
    /// Errors depend on the shape of the force alone: one material says it for all.
    shows_errors: bool,
}

const EXPERIMENTS: [Experiment; 4] = [
    Experiment::new("glass", [4.8e10, 0.2, 2800.0], false, true),
    Experiment::new("limestone", [2.0e10, 0.25, 2500.0], false, false),
    Experiment::new("aluminium alloy", [7.0e10, 0.3, 2699.0], true, true),
    Experiment::new("magnesium alloy", [4.0e10, 0.35, 1800.0], true, false),
];

impl Experiment {
    const fn new(
        name: &'static str,
        [young_modulus, poisson_ratio, density]: [f64; 3],
        on_plane: bool,
        shows_errors: bool,
    ) -> Self {
        Self {
            material: Material::new(name, young_modulus, poisson_ratio, density),
            on_plane,
            shows_errors,
        }
    }

    /// Diameter \[m\], and speed of each sphere \[m/s\].
    fn diameter_and_speed(&self) -> [f64; 2] {
        if self.on_plane {
            [0.2, 0.2]
        } else {
            [0.02, 10.0]
        }
    }

    fn name(&self) -> String {
        let partner = if self.on_plane {
            "on a plane"
        } else {
            "two spheres"
        };
        format!("{}, {partner}", self.material.name)
    }

    fn law(&self) -> ViscoelasticHertz {
        if self.on_plane {
            self.material.against_rigid(0.0)
        } else {
            self.material.spheres(0.0)
        }
    }

    fn impact(&self) -> Impact {
        let speed = self.diameter_and_speed()[1] / self.material.speed();
        let contact = frictionless(Normal::Hertz(self.law()));
        if self.on_plane {
            Impact::on_plane(contact, DVec3::new(-speed, 0.0, 0.0))
        } else {
            Impact::of_twins(contact, speed)
        }
    }

    /// The units of time, length and force in microseconds, micrometres and kilonewtons.
    fn units(&self) -> [f64; 3] {
        let ([diameter, _], modulus) = (self.diameter_and_speed(), self.material.young_modulus);
        let mass = self.material.density * PI / 6.0 * diameter.powi(3);
        let time = (mass / (modulus * diameter)).sqrt();
        let force = modulus * diameter * diameter;
        [1e6 * time, 1e6 * diameter, 1e-3 * force]
    }
}

/// Quantities of an impact with their units.
const QUANTITIES: [[&str; 2]; 3] = [
    ["contact time", "µs"],
    ["largest overlap", "µm"],
    ["peak force", "kN"],
];

fn found(rebound: &Rebound) -> [f64; 3] {
    let (time, force) = (rebound.contact_time, rebound.peak_force);
    [time, rebound.largest_overlap, force]
}

fn expected(reference: &HertzImpact) -> [f64; 3] {
    let (time, force) = (reference.contact_time(), reference.peak_force());
    [time, reference.largest_overlap(), force]
}

pub(super) fn examine(circumstances: Circumstances<'_>) -> Result<Finding> {
    let mut finding = PROSE.described(&[]);
    let mut rows: Vec<(String, &str, f64, f64)> = Vec::new();
    for experiment in &EXPERIMENTS {
        circumstances.go_on()?;
        let setting = experiment.name();
        let trial = Trial::of(experiment.impact());
        let expected = expected(&HertzImpact::of(&experiment.law(), &trial.impact));
        let at_finest_step = found(&trial.rebound(Means::USUAL)?);
        for (place, [name, unit]) in QUANTITIES.into_iter().enumerate() {
            let in_unit = |values: [f64; 3]| experiment.units()[place] * values[place];
            let (expected, found) = (in_unit(expected), in_unit(at_finest_step));
            let quantity = format!("{name} ({unit})");
            let check = Check::relative(&quantity, &setting, expected, found, 2e-4);
            finding.checks.push(check.by("Hertz 1882"));
            rows.push((setting.clone(), name, expected, found));
        }
        finding.checks.push(trial.kernels_agree(&setting)?);
        if experiment.shows_errors {
            for (place, [name, _]) in QUANTITIES.into_iter().enumerate() {
                let error = |rebound: &Rebound| found(rebound)[place] / expected[place] - 1.0;
                let errors = trial.convergences((name, &setting), [1.8, 2.5], error)?;
                finding.convergences.extend(errors);
            }
        }
    }
    finding.data = Columns::of(&rows)
        .word("setting", "experiment", |row| row.0.clone())
        .word("quantity", "what", |row| row.1.to_owned())
        .number("expected", "", "closed form", |row| row.2)
        .number("found", "", "engine", |row| row.3)
        .data()?;
    let errors = error_chart(&PER_CONTACT, &[("", &finding.convergences[..6])]);
    finding.figures = vec![PROSE.chart("normal-impact-errors", &[], errors)?];
    Ok(finding)
}
