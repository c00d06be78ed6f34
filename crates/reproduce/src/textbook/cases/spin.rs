//! Impacts with spin: on a plane, of two spheres alike, and of two of different sizes.

use core::f64::consts::PI;

use glam::DVec3;
use peristalsis_figures::chart::{ChartFigure, ChartPanel, LegendPlace, Line, Points, Tint};
use peristalsis_figures::{Drawing, Width};
use peristalsis_physics::contact::{ContactModel, CundallStrack, Normal, Sliding};

use super::restitution::dissipation_time;
use super::study::{
    FINE, Material, convergences, evenly, hertz_stiffness, kernels_agree, numbers, table, words,
};
use crate::textbook::case::{Case, Circumstances};
use crate::textbook::error::ValidateError;
use crate::textbook::experiment::Means;
use crate::textbook::experiment::impact::{Impact, Partner, Sphere};
use crate::textbook::finding::{CaseFigure, Check, Finding};
use crate::textbook::reference::hertz::HertzImpact;
use crate::textbook::reference::impact::outcome;

pub(super) const CASE: Case = Case {
    name: "spin",
    title: "Normal impact with spin: on a plane, and of two spheres",
    source: "Chung & Ooi 2011, tests 5 to 8",
    examine,
};

const ALUMINIUM_ALLOY: Material = Material {
    name: "aluminium alloy",
    young_modulus: 7.0e10,
    poisson_ratio: 0.33,
    density: 2700.0,
};
/// Of each sphere \[m/s\].
const SPEED: f64 = 0.2;
const FRICTION: f64 = 0.4;
const RESTITUTION: f64 = 0.5;
/// Radius of the other sphere over that of the spinning one, where sizes differ.
const RATIO: f64 = 2.0;

/// Largest r omega/v of the figure.
const LARGEST_SPIN: f64 = 6.0;

/// What the spinning sphere meets.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Meets {
    Plane,
    Twin,
    Larger,
}

const MEETS: [Meets; 3] = [Meets::Plane, Meets::Twin, Meets::Larger];

impl Meets {
    fn name(self) -> &'static str {
        match self {
            Self::Plane => "a plane",
            Self::Twin => "a sphere alike, not spinning",
            Self::Larger => "one twice as large, spinning too",
        }
    }
}

/// An experiment with its constants worked out.
struct Experiment {
    meets: Meets,
    speed: f64,
    dissipation_time: f64,
    contact_time: f64,
    friction: CundallStrack,
}

impl Experiment {
    fn new(meets: Meets) -> Self {
        let mut experiment = Self {
            meets,
            speed: SPEED / ALUMINIUM_ALLOY.speed(),
            dissipation_time: 0.0,
            contact_time: 0.0,
            friction: CundallStrack {
                tangential_stiffness: 0.0,
                tangential_damping: 0.0,
                static_friction: FRICTION,
                kinetic_friction: FRICTION,
                sliding: Sliding::Spring,
            },
        };
        let elastic = experiment.smooth(0.0);
        let Normal::Hertz(law) = elastic.contact.normal else {
            unreachable!("the experiment was made with a Hertz law")
        };
        experiment.contact_time = HertzImpact {
            stiffness: hertz_stiffness(&law, &elastic),
            reduced_mass: elastic.reduced_mass(),
            speed: elastic.relative_velocity().length(),
        }
        .contact_time();
        let equal = elastic.reduced_mass() * (PI / experiment.contact_time).powi(2);
        let nu = ALUMINIUM_ALLOY.poisson_ratio;
        experiment.friction.tangential_stiffness = 2.0 * (1.0 - nu) / (2.0 - nu) * equal;
        experiment.dissipation_time =
            dissipation_time(RESTITUTION, experiment.contact_time, |time| {
                experiment.smooth(time)
            });
        experiment
    }

    /// The impact without friction or spin.
    fn smooth(&self, dissipation_time: f64) -> Impact {
        let arriving = Sphere::unit(DVec3::new(-self.speed, 0.0, 0.0), 0.0);
        let other = |diameter: f64| {
            Partner::Grain(Sphere {
                diameter,
                mass: diameter.powi(3),
                velocity: DVec3::new(self.speed, 0.0, 0.0),
                spin: 0.0,
            })
        };
        let (law, partner) = match self.meets {
            Meets::Plane => (
                ALUMINIUM_ALLOY.against_rigid(dissipation_time),
                Partner::Plane,
            ),
            Meets::Twin => (ALUMINIUM_ALLOY.spheres(dissipation_time), other(1.0)),
            Meets::Larger => (ALUMINIUM_ALLOY.spheres(dissipation_time), other(RATIO)),
        };
        Impact {
            contact: ContactModel {
                normal: Normal::Hertz(law),
                friction: None,
            },
            sphere: arriving,
            partner,
        }
    }

    /// The impact at r omega/v.
    fn impact(&self, spin: f64) -> Impact {
        let mut impact = self.smooth(self.dissipation_time);
        impact.contact.friction = Some(self.friction);
        impact.sphere.spin = 2.0 * spin * self.speed;
        if let (Meets::Larger, Partner::Grain(other)) = (self.meets, &mut impact.partner) {
            other.spin = impact.sphere.spin;
        }
        impact
    }

    /// v_t'/v and r omega'/v of the spinning sphere.
    fn read(&self, velocity: DVec3, spin: f64) -> [f64; 2] {
        [velocity.y / self.speed, 0.5 * spin / self.speed]
    }

    fn simulated(&self, spin: f64) -> Result<[f64; 2], ValidateError> {
        let time_step = self.contact_time / FINE;
        let found = self.impact(spin).simulate(Means::USUAL, time_step, 0.5)?;
        Ok(self.read(found.velocity[0], found.spin[0]))
    }

    fn integrated(&self, spin: f64) -> [f64; 2] {
        let found = outcome(&self.impact(spin));
        self.read(found.velocity[0], found.spin[0])
    }

    /// Sliding throughout: the tangential impulse is mu (1 + e) m v_n, m the reduced mass.
    fn sliding(&self, spin: f64) -> [f64; 2] {
        let impact = self.impact(spin);
        let normal = impact.relative_velocity().length();
        let impulse = FRICTION * (1.0 + RESTITUTION) * impact.reduced_mass() * normal;
        // The surface of the spinning sphere moves towards -y; friction drives it towards +y and slows the spin.
        let velocity = DVec3::new(0.0, impulse, 0.0);
        self.read(
            velocity,
            impact.sphere.spin - 0.5 * impulse / impact.sphere.inertia(),
        )
    }
}

fn examine(circumstances: Circumstances<'_>) -> Result<Finding, ValidateError> {
    let mut finding = Finding {
        paragraphs: vec![
            "Spheres of aluminium alloy that meet head-on at 0.2 m/s each, mu = 0.4, e = 0.5 (viscoelastic), the first of them \
             spinning about an axis in the plane of contact. Velocities and spins after the impact are given over v. At large \
             spin the contact slides throughout: v_t' = J/m, omega' = omega - r J/I with J = mu (1 + e) m_ij v_n (arms shorter than \
             r by half the overlap make 3e-4). A sphere that spins slowly is held by its tangential spring, whose equation of \
             motion is the reference there."
                .to_owned(),
        ],
        ..Finding::default()
    };
    let spins = evenly(0.25, LARGEST_SPIN, circumstances.extent.choose(12, 24));
    let mut rows: Vec<Row> = Vec::new();
    let mut curves = Vec::new();
    for meets in MEETS {
        circumstances.go_on()?;
        let experiment = Experiment::new(meets);
        for spin in &spins {
            rows.push((
                meets,
                *spin,
                experiment.simulated(*spin)?,
                experiment.integrated(*spin),
            ));
        }
        for (spin, is_sliding) in [(0.5, false), (1.5, false), (8.0, true)] {
            let found = experiment.simulated(spin)?;
            let (expected, reference) = if is_sliding {
                (experiment.sliding(spin), "sliding throughout")
            } else {
                (experiment.integrated(spin), "equation of motion")
            };
            for (name, found, expected) in [
                ("v_t'/v", found[0], expected[0]),
                ("r omega'/v", found[1], expected[1]),
            ] {
                let setting = format!("{}, r omega/v = {spin}", meets.name());
                let check = Check::absolute(name, &setting, expected, found, 4e-3);
                finding.checks.push(check.by(reference));
            }
        }
        let impact = experiment.impact(1.5);
        let time_step = experiment.contact_time / FINE;
        finding
            .checks
            .push(kernels_agree(meets.name(), &impact, time_step)?);
        let expected = outcome(&impact).spin[0];
        finding.convergences.extend(convergences(
            ("spin", &format!("{}, r omega/v = 1.5", meets.name())),
            &impact,
            experiment.contact_time,
            [0.7, 3.0],
            // Over the spin before: what is left of it may be next to nothing.
            |rebound| (rebound.spin[0] - expected) / impact.sphere.spin,
        )?);
        let dense = evenly(0.0, LARGEST_SPIN, 121);
        curves.push(Curves {
            meets,
            sliding: dense.iter().map(|spin| experiment.sliding(*spin)).collect(),
            // A contact without slip at all has no scale of its own.
            integrated: dense
                .iter()
                .map(|spin| experiment.integrated(spin.max(1e-3)))
                .collect(),
            spins: dense,
        });
    }
    finding.figures.push(CaseFigure {
        name: "spin",
        caption: "Tangential velocity and spin after a normal impact against the spin before it: engine, equation of motion, and \
                  sliding throughout.",
        drawing: drawing(&spins, &rows, &curves)?,
    });
    let of = |read: &dyn Fn(&Row) -> f64| rows.iter().map(read).collect();
    finding.table = table([
        words(
            "meets",
            "partner",
            rows.iter().map(|row| row.0.name().to_owned()).collect(),
        ),
        numbers("spin_before", "", "r omega/v", of(&|row| row.1)),
        numbers("velocity", "", "v_t'/v", of(&|row| row.2[0])),
        numbers("velocity_expected", "", "v_t'/v", of(&|row| row.3[0])),
        numbers("spin", "", "r omega'/v", of(&|row| row.2[1])),
        numbers("spin_expected", "", "r omega'/v", of(&|row| row.3[1])),
    ])?;
    Ok(finding)
}

/// Partner, spin before, and velocity and spin after: by the engine and by the equation of motion.
type Row = (Meets, f64, [f64; 2], [f64; 2]);

/// What is expected against a partner, over a fine grid of spins.
struct Curves {
    meets: Meets,
    spins: Vec<f64>,
    sliding: Vec<[f64; 2]>,
    integrated: Vec<[f64; 2]>,
}

fn drawing(spins: &[f64], rows: &[Row], curves: &[Curves]) -> Result<Drawing, ValidateError> {
    let panels = curves.iter().map(|curves| {
        let mut panel = ChartPanel::new("*rω*/*v* before", "after the impact")
            .title(curves.meets.name())
            .x_range(0.0..=6.2);
        for (place, name) in [(0, "*v*_{t}′/*v*"), (1, "*rω*′/*v*")] {
            let part =
                |values: &[[f64; 2]]| -> Vec<f64> { values.iter().map(|v| v[place]).collect() };
            let of_meets = rows.iter().filter(|row| row.0 == curves.meets);
            let found: Vec<f64> = of_meets.map(|row| row.2[place]).collect();
            let only_once = |name| if place == 0 { name } else { "" };
            panel = panel
                .with(
                    Line::new(
                        only_once("sliding throughout"),
                        &curves.spins,
                        &part(&curves.sliding),
                    )
                    .tint(Tint::Grey)
                    .weight(2.4),
                )
                .with(
                    Line::new(
                        only_once("equation of motion"),
                        &curves.spins,
                        &part(&curves.integrated),
                    )
                    .tint(Tint::Black),
                )
                .with(Points::new(&format!("{name}, engine"), spins, &found).series(place));
        }
        panel
    });
    Ok(ChartFigure::grid(3, panels)
        .description(
            "Slow spins are held and turned back, fast ones lose what sliding friction takes.",
        )
        .width(Width::DoubleColumn)
        .legend(LegendPlace::Below)
        .draw()?)
}
