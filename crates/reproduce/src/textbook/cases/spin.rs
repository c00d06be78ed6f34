//! Impacts with spin: on a plane, of two equal spheres, and of two of different sizes.

use glam::DVec3;
use peristalsis_figures::Width;
use peristalsis_figures::chart::{ChartFigure, ChartPanel, LegendPlace, Line, Tint};
use peristalsis_physics::contact::Normal;

use super::material::Material;
use super::plot::{named_once, points};
use super::trial::{Sweep, Trial, dissipation_time};
use crate::columns::Columns;
use crate::error::Result;
use crate::exhibit::spaced;
use crate::textbook::case::Circumstances;
use crate::textbook::experiment::frictionless;
use crate::textbook::experiment::impact::{Impact, Rebound, Sphere};
use crate::textbook::reference::impact::outcome;
use crate::{Check, Finding, Prose};

pub(super) const PROSE: Prose = Prose::new(include_str!("spin.md"));

const ALUMINIUM_ALLOY: Material = Material::new("aluminium alloy", 7.0e10, 0.33, 2700.0);
/// Of each sphere \[m/s\].
const SPEED: f64 = 0.2;
const FRICTION: f64 = 0.4;
const RESTITUTION: f64 = 0.5;

/// Largest r omega/v of the figure.
const LARGEST_SPIN: f64 = 6.0;

/// The partner of the spinning sphere.
struct Meets {
    name: &'static str,
    /// Its diameter over that of the spinning sphere; `None`: it is a plane.
    diameter: Option<f64>,
    is_spinning: bool,
}

const MEETS: [Meets; 3] = [
    Meets::new("a plane", None, false),
    Meets::new("a sphere alike, not spinning", Some(1.0), false),
    Meets::new("one twice as large, spinning too", Some(2.0), true),
];

impl Meets {
    const fn new(name: &'static str, diameter: Option<f64>, is_spinning: bool) -> Self {
        Self {
            name,
            diameter,
            is_spinning,
        }
    }

    /// The impact without friction or spin.
    fn frictionless_impact(&self, dissipation_time: f64) -> Impact {
        let speed = SPEED / ALUMINIUM_ALLOY.speed();
        let partner = self.diameter.map(|diameter| Sphere {
            diameter,
            mass: diameter.powi(3),
            velocity: DVec3::new(speed, 0.0, 0.0),
            spin: 0.0,
        });
        let law = match partner {
            None => ALUMINIUM_ALLOY.against_rigid(dissipation_time),
            Some(_) => ALUMINIUM_ALLOY.spheres(dissipation_time),
        };
        Impact {
            contact: frictionless(Normal::Hertz(law)),
            sphere: Sphere::unit(DVec3::new(-speed, 0.0, 0.0), 0.0),
            partner,
        }
    }
}

/// An experiment with its constants.
struct Experiment {
    meets: &'static Meets,
    speed: f64,
    without_spin: Trial,
}

impl Sweep<2> for Experiment {
    /// The impact at r omega/v.
    fn trial(&self, spin: f64) -> Trial {
        let mut trial = self.without_spin;
        trial.impact.sphere.spin = 2.0 * spin * self.speed;
        if let Some(other) = &mut trial.impact.partner
            && self.meets.is_spinning
        {
            other.spin = trial.impact.sphere.spin;
        }
        trial
    }

    /// v_t'/v and r omega'/v of the spinning sphere.
    fn read(&self, _: f64, velocity: DVec3, spin: f64) -> [f64; 2] {
        [velocity.y / self.speed, 0.5 * spin / self.speed]
    }
}

impl Experiment {
    fn new(meets: &'static Meets) -> Self {
        let time = dissipation_time(RESTITUTION, |time| meets.frictionless_impact(time));
        let frictionless = Trial::of(meets.frictionless_impact(time));
        Self {
            meets,
            speed: -frictionless.impact.sphere.velocity.x,
            without_spin: frictionless.with_friction(&ALUMINIUM_ALLOY, FRICTION),
        }
    }

    /// Sliding throughout: the tangential impulse is mu (1 + e) m v_n, m the reduced mass.
    fn sliding(&self, spin: f64) -> [f64; 2] {
        let impact = self.trial(spin).impact;
        let normal = impact.relative_velocity().length();
        let impulse = FRICTION * (1.0 + RESTITUTION) * impact.reduced_mass() * normal;
        // The surface of the spinning sphere moves towards -y; friction drives it towards +y and slows the spin.
        let velocity = DVec3::new(0.0, impulse, 0.0);
        let after = impact.sphere.spin - 0.5 * impulse / impact.sphere.inertia();
        self.read(spin, velocity, after)
    }

    /// Slow spins beside the equation of motion, a fast one beside sliding throughout.
    fn checks(&self) -> Result<Vec<Check>> {
        let mut checks = Vec::new();
        for (spin, expected, reference) in [
            (0.5, self.integrated(0.5), "equation of motion"),
            (1.5, self.integrated(1.5), "equation of motion"),
            (8.0, self.sliding(8.0), "sliding throughout"),
        ] {
            let found = self.simulated(spin)?;
            for (place, name) in ["v_t'/v", "r omega'/v"].into_iter().enumerate() {
                let setting = format!("{}, r omega/v = {spin}", self.meets.name);
                let check = Check::absolute(name, &setting, expected[place], found[place], 4e-3);
                checks.push(check.by(reference));
            }
        }
        checks.push(self.trial(1.5).kernels_agree(self.meets.name)?);
        Ok(checks)
    }
}

/// Velocity and spin after an impact: by the engine and by the equation of motion.
struct Row {
    meets: &'static str,
    /// r omega/v before.
    spin: f64,
    found: [f64; 2],
    expected: [f64; 2],
}

pub(super) fn examine(circumstances: Circumstances<'_>) -> Result<Finding> {
    let mut finding = PROSE.described(&[]);
    let experiments = MEETS.each_ref().map(Experiment::new);
    let mut rows: Vec<Row> = Vec::new();
    for experiment in &experiments {
        circumstances.go_on()?;
        let meets = experiment.meets;
        for spin in spaced(0.25, LARGEST_SPIN, circumstances.size.choose(12, 24)) {
            rows.push(Row {
                meets: meets.name,
                spin,
                found: experiment.simulated(spin)?,
                expected: experiment.integrated(spin),
            });
        }
        finding.checks.extend(experiment.checks()?);
        let trial = experiment.trial(1.5);
        let expected = outcome(&trial.impact).spin[0];
        // Over the spin before: the spin after may be next to nothing.
        let before = trial.impact.sphere.spin;
        let error = |rebound: &Rebound| (rebound.spin[0] - expected) / before;
        let setting = format!("{}, r omega/v = 1.5", meets.name);
        let errors = trial.convergences(("spin", &setting), [0.7, 3.0], error)?;
        finding.convergences.extend(errors);
    }
    finding.figures = vec![PROSE.chart("spin", &[], drawing(&experiments, &rows))?];
    finding.data = Columns::of(&rows)
        .word("meets", "partner", |row| row.meets.to_owned())
        .number("spin_before", "", "r omega/v", |row| row.spin)
        .number("velocity", "", "v_t'/v", |row| row.found[0])
        .number("velocity_expected", "", "v_t'/v", |row| row.expected[0])
        .number("spin", "", "r omega'/v", |row| row.found[1])
        .number("spin_expected", "", "r omega'/v", |row| row.expected[1])
        .data()?;
    Ok(finding)
}

fn drawing(experiments: &[Experiment], rows: &[Row]) -> ChartFigure {
    let dense = spaced(0.0, LARGEST_SPIN, 121);
    let panels = experiments.iter().map(|experiment| {
        let over = |of: &dyn Fn(f64) -> [f64; 2]| -> Vec<[f64; 2]> {
            dense.iter().map(|spin| of(*spin)).collect()
        };
        let sliding = over(&|spin| experiment.sliding(spin));
        // A contact without slip at all has no scale of its own.
        let integrated = over(&|spin| experiment.integrated(spin.max(1e-3)));
        let mine = || rows.iter().filter(|row| row.meets == experiment.meets.name);
        let mut panel = ChartPanel::new("*rω*/*v* before", "after the impact")
            .title(experiment.meets.name)
            .x_range(0.0..=6.2);
        for (place, name) in ["*v*_{t}′/*v*", "*rω*′/*v*"].into_iter().enumerate() {
            let line = |name: &str, values: &[[f64; 2]]| {
                let values: Vec<f64> = values.iter().map(|value| value[place]).collect();
                Line::new(named_once(name, place), &dense, &values)
            };
            let sliding = line("sliding throughout", &sliding).tint(Tint::Grey);
            let name = format!("{name}, engine");
            panel = panel
                .with(sliding.weight(2.4))
                .with(line("equation of motion", &integrated).tint(Tint::Black))
                .with(points(&name, mine(), |row| (row.spin, row.found[place])).series(place));
        }
        panel
    });
    ChartFigure::grid(3, panels)
        .width(Width::DoubleColumn)
        .legend(LegendPlace::Below)
}
