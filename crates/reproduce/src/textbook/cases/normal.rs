//! Elastic normal impact of two spheres, and of a sphere on a plane.

use core::f64::consts::PI;

use glam::DVec3;
use peristalsis_physics::contact::Normal;

use super::study::{
    FINE, Material, convergences, error_figure, hertz_stiffness, kernels_agree, numbers, smooth,
    table, words,
};
use crate::textbook::case::{Case, Circumstances};
use crate::textbook::error::ValidateError;
use crate::textbook::experiment::Means;
use crate::textbook::experiment::impact::{Impact, Partner, Rebound, Sphere};
use crate::textbook::finding::{CaseFigure, Check, Finding};
use crate::textbook::reference::hertz::HertzImpact;

pub(super) const CASE: Case = Case {
    name: "normal-impact",
    title: "Elastic normal impact of two spheres, and of a sphere on a plane",
    source: "Chung & Ooi 2011, tests 1 and 2; Hertz 1882",
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
    Experiment {
        material: Material {
            name: "glass",
            young_modulus: 4.8e10,
            poisson_ratio: 0.2,
            density: 2800.0,
        },
        on_plane: false,
        diameter: 0.02,
        speed: 10.0,
    },
    Experiment {
        material: Material {
            name: "limestone",
            young_modulus: 2.0e10,
            poisson_ratio: 0.25,
            density: 2500.0,
        },
        on_plane: false,
        diameter: 0.02,
        speed: 10.0,
    },
    Experiment {
        material: Material {
            name: "aluminium alloy",
            young_modulus: 7.0e10,
            poisson_ratio: 0.3,
            density: 2699.0,
        },
        on_plane: true,
        diameter: 0.2,
        speed: 0.2,
    },
    Experiment {
        material: Material {
            name: "magnesium alloy",
            young_modulus: 4.0e10,
            poisson_ratio: 0.35,
            density: 1800.0,
        },
        on_plane: true,
        diameter: 0.2,
        speed: 0.2,
    },
];

impl Experiment {
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

    fn impact(&self) -> Impact {
        let speed = self.speed / self.material.speed();
        let arriving = Sphere::unit(DVec3::new(-speed, 0.0, 0.0), 0.0);
        let (law, partner) = if self.on_plane {
            (self.material.against_rigid(0.0), Partner::Plane)
        } else {
            let other = Sphere::unit(DVec3::new(speed, 0.0, 0.0), 0.0);
            (self.material.spheres(0.0), Partner::Grain(other))
        };
        Impact {
            contact: smooth(Normal::Hertz(law)),
            sphere: arriving,
            partner,
        }
    }

    fn reference(&self, impact: &Impact) -> HertzImpact {
        let law = if self.on_plane {
            self.material.against_rigid(0.0)
        } else {
            self.material.spheres(0.0)
        };
        HertzImpact {
            stiffness: hertz_stiffness(&law, impact),
            reduced_mass: impact.reduced_mass(),
            speed: impact.relative_velocity().length(),
        }
    }

    /// Microseconds, micrometres and kilonewtons in units of the simulation.
    fn units(&self) -> [f64; 3] {
        let Material {
            young_modulus,
            density,
            ..
        } = self.material;
        let mass = density * PI / 6.0 * self.diameter.powi(3);
        let time = (mass / (young_modulus * self.diameter)).sqrt();
        let force = young_modulus * self.diameter * self.diameter;
        [1e6 * time, 1e6 * self.diameter, 1e-3 * force]
    }
}

/// A quantity of an impact: its name, and how it is read off a rebound and off the closed form.
type Quantity = (&'static str, fn(&Rebound) -> f64, fn(&HertzImpact) -> f64);

const QUANTITIES: [Quantity; 3] = [
    (
        "contact time",
        |r| r.contact_time,
        HertzImpact::contact_time,
    ),
    (
        "largest overlap",
        |r| r.largest_overlap,
        HertzImpact::largest_overlap,
    ),
    ("peak force", |r| r.peak_force, HertzImpact::peak_force),
];

fn examine(circumstances: Circumstances<'_>) -> Result<Finding, ValidateError> {
    let mut finding = Finding {
        paragraphs: vec![
            "Contact time, largest overlap and peak force of the elastic Hertz law (h = t_c/80, Verlet). A plane is a sphere of \
             the wall 10,000 times as large as the grain and twice as stiff as two spheres are, for only the grain gives way; \
             its curvature, which the expected values have, makes the contact longer and the force smaller by 2e-5 than \
             those of a plane."
                .to_owned(),
        ],
        ..Finding::default()
    };
    let mut rows: Vec<(String, &str, f64, f64)> = Vec::new();
    for experiment in &EXPERIMENTS {
        circumstances.go_on()?;
        let impact = experiment.impact();
        let reference = experiment.reference(&impact);
        let time_step = reference.contact_time() / FINE;
        let rebound = impact.simulate(Means::USUAL, time_step, 0.5)?;
        let units = [("µs", 0), ("µm", 1), ("kN", 2)];
        for ((name, read, expect), (unit, place)) in QUANTITIES.iter().zip(units) {
            let scale = experiment.units()[place];
            let (expected, found) = (scale * expect(&reference), scale * read(&rebound));
            let check = Check::relative(
                &format!("{name} ({unit})"),
                &experiment.name(),
                expected,
                found,
                2e-4,
            );
            finding.checks.push(check.by("Hertz 1882"));
            rows.push((experiment.name(), name, expected, found));
        }
        finding
            .checks
            .push(kernels_agree(&experiment.name(), &impact, time_step)?);
        // Errors are those of the shape of the force alone: one material says it for all.
        if !experiment.is_first_of_its_kind() {
            continue;
        }
        for (name, read, expect) in QUANTITIES {
            let expected = expect(&reference);
            finding.convergences.extend(convergences(
                (name, &experiment.name()),
                &impact,
                reference.contact_time(),
                [1.8, 2.5],
                |rebound| read(rebound) / expected - 1.0,
            )?);
        }
    }
    finding.table = table([
        words(
            "setting",
            "experiment",
            rows.iter().map(|row| row.0.clone()).collect(),
        ),
        words(
            "quantity",
            "what",
            rows.iter().map(|row| row.1.to_owned()).collect(),
        ),
        numbers(
            "expected",
            "",
            "closed form",
            rows.iter().map(|row| row.2).collect(),
        ),
        numbers(
            "found",
            "",
            "engine",
            rows.iter().map(|row| row.3).collect(),
        ),
    ])?;
    let spheres = finding.convergences[..6].iter().collect();
    let drawing = error_figure(
        "Errors of contact time, largest overlap and peak force fall with the square of the time step.",
        "*h*/*t*_{c}",
        &[("", spheres)],
    )?;
    finding.figures.push(CaseFigure {
        name: "normal-impact-errors",
        caption: "Errors of an elastic normal impact of two spheres against the time step; those of a sphere on a plane are the \
                  same.",
        drawing,
    });
    Ok(finding)
}
