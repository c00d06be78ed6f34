//! Elastic normal impact of two spheres, and of a sphere on a plane.

use core::f64::consts::PI;

use glam::DVec3;
use peristalsis_physics::contact::{Normal, ViscoelasticHertz};

use super::errors::{FINE, PER_CONTACT, error_drawing, impact_convergences, kernels_agree};
use super::material::Material;
use crate::check::Check;
use crate::columns::Columns;
use crate::error::ClaimError;
use crate::finding::Finding;
use crate::prose::Prose;
use crate::textbook::case::{Case, Circumstances};
use crate::textbook::experiment::impact::{Impact, Rebound};
use crate::textbook::experiment::{Means, smooth};
use crate::textbook::reference::hertz::HertzImpact;

const PROSE: Prose = Prose::new(include_str!("normal.md"));

pub(super) const CASE: Case = Case {
    name: "normal-impact",
    prose: PROSE,
    examine,
};

/// An experiment as the source states it, in SI.
struct Experiment {
    material: Material,
    on_plane: bool,
    /// \[m\]
    diameter: f64,
    /// Of each sphere \[m/s\].
    speed: f64,
}

const EXPERIMENTS: [Experiment; 4] = [
    Experiment::of_spheres(Material::new("glass", 4.8e10, 0.2, 2800.0)),
    Experiment::of_spheres(Material::new("limestone", 2.0e10, 0.25, 2500.0)),
    Experiment::on_plane(Material::new("aluminium alloy", 7.0e10, 0.3, 2699.0)),
    Experiment::on_plane(Material::new("magnesium alloy", 4.0e10, 0.35, 1800.0)),
];

impl Experiment {
    const fn of_spheres(material: Material) -> Self {
        Self {
            material,
            on_plane: false,
            diameter: 0.02,
            speed: 10.0,
        }
    }

    const fn on_plane(material: Material) -> Self {
        Self {
            material,
            on_plane: true,
            diameter: 0.2,
            speed: 0.2,
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

    fn is_first_of_its_kind(&self) -> bool {
        matches!(self.material.name, "glass" | "aluminium alloy")
    }

    fn law(&self) -> ViscoelasticHertz {
        if self.on_plane {
            self.material.against_rigid(0.0)
        } else {
            self.material.spheres(0.0)
        }
    }

    fn impact(&self) -> Impact {
        let speed = self.speed / self.material.speed();
        let contact = smooth(Normal::Hertz(self.law()));
        if self.on_plane {
            Impact::on_plane(contact, DVec3::new(-speed, 0.0, 0.0))
        } else {
            Impact::of_twins(contact, speed)
        }
    }

    /// The units of time, length and force in microseconds, micrometres and kilonewtons.
    fn units(&self) -> [f64; 3] {
        let modulus = self.material.young_modulus;
        let mass = self.material.density * PI / 6.0 * self.diameter.powi(3);
        let time = (mass / (modulus * self.diameter)).sqrt();
        let force = modulus * self.diameter * self.diameter;
        [1e6 * time, 1e6 * self.diameter, 1e-3 * force]
    }
}

/// A quantity of an impact, read off a rebound and off the closed form.
struct Quantity {
    name: &'static str,
    unit: &'static str,
    found: fn(&Rebound) -> f64,
    expected: fn(&HertzImpact) -> f64,
}

const QUANTITIES: [Quantity; 3] = [
    Quantity {
        name: "contact time",
        unit: "µs",
        found: |rebound| rebound.contact_time,
        expected: HertzImpact::contact_time,
    },
    Quantity {
        name: "largest overlap",
        unit: "µm",
        found: |rebound| rebound.largest_overlap,
        expected: HertzImpact::largest_overlap,
    },
    Quantity {
        name: "peak force",
        unit: "kN",
        found: |rebound| rebound.peak_force,
        expected: HertzImpact::peak_force,
    },
];

fn examine(circumstances: Circumstances<'_>) -> Result<Finding, ClaimError> {
    let mut finding = Finding::described(&PROSE, &[]);
    let mut rows: Vec<(String, &str, f64, f64)> = Vec::new();
    for experiment in &EXPERIMENTS {
        circumstances.go_on()?;
        let setting = experiment.name();
        let impact = experiment.impact();
        let reference = HertzImpact::of(&experiment.law(), &impact);
        let time_step = reference.contact_time() / FINE;
        let rebound = impact.simulate(Means::USUAL, time_step, 0.5)?;
        for (quantity, unit) in QUANTITIES.iter().zip(experiment.units()) {
            let expected = unit * (quantity.expected)(&reference);
            let found = unit * (quantity.found)(&rebound);
            let name = format!("{} ({})", quantity.name, quantity.unit);
            let check = Check::relative(&name, &setting, expected, found, 2e-4);
            finding.checks.push(check.by("Hertz 1882"));
            rows.push((setting.clone(), quantity.name, expected, found));
        }
        let agree = kernels_agree(&setting, &impact, time_step)?;
        finding.checks.push(agree);
        // Errors depend on the shape of the force alone: one material says it for all.
        if !experiment.is_first_of_its_kind() {
            continue;
        }
        for quantity in &QUANTITIES {
            let expected = (quantity.expected)(&reference);
            finding.convergences.extend(impact_convergences(
                (quantity.name, &setting),
                &impact,
                reference.contact_time(),
                [1.8, 2.5],
                |rebound| (quantity.found)(rebound) / expected - 1.0,
            )?);
        }
    }
    finding.data = Some(
        Columns::of(&rows)
            .word("setting", "experiment", |row| row.0.clone())
            .word("quantity", "what", |row| row.1.to_owned())
            .number("expected", "", "closed form", |row| row.2)
            .number("found", "", "engine", |row| row.3)
            .table()?,
    );
    finding.figures = vec![PROSE.figure("normal-impact-errors", &[], error_drawing("Errors of contact time, largest overlap and peak force fall with the square of the time step.",
        &PER_CONTACT,
        &[("", &finding.convergences[..6])],)?)];
    Ok(finding)
}
