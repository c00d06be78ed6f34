//! Impacts with spin: on a plane, of two equal spheres, and of two of different sizes.

use glam::DVec3;
use peristalsis_figures::chart::{ChartFigure, ChartPanel, LegendPlace, Line, Points, Tint};
use peristalsis_figures::{Drawing, FigureError, Width};
use peristalsis_physics::contact::{CundallStrack, Normal, ViscoelasticHertz};

use super::errors::{FINE, impact_convergences, kernels_agree};
use super::material::Material;
use super::plot::named_once;
use super::restitution::dissipation_time;
use crate::check::Check;
use crate::columns::Columns;
use crate::error::ClaimError;
use crate::exhibit::spaced;
use crate::finding::Finding;
use crate::prose::Prose;
use crate::textbook::case::{Case, Circumstances};
use crate::textbook::experiment::impact::{Impact, Partner, Sphere};
use crate::textbook::experiment::{Means, smooth};
use crate::textbook::reference::hertz::HertzImpact;
use crate::textbook::reference::impact::outcome;

const PROSE: Prose = Prose::new(include_str!("spin.md"));

pub(super) const CASE: Case = Case {
    name: "spin",
    prose: PROSE,
    examine,
};

const ALUMINIUM_ALLOY: Material = Material::new("aluminium alloy", 7.0e10, 0.33, 2700.0);
/// Of each sphere \[m/s\].
const SPEED: f64 = 0.2;
const FRICTION: f64 = 0.4;
const RESTITUTION: f64 = 0.5;
/// Radius of the other sphere over that of the spinning one, where sizes differ.
const RATIO: f64 = 2.0;

/// Largest r omega/v of the figure.
const LARGEST_SPIN: f64 = 6.0;

/// The partner of the spinning sphere.
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

    fn law(self, dissipation_time: f64) -> ViscoelasticHertz {
        match self {
            Self::Plane => ALUMINIUM_ALLOY.against_rigid(dissipation_time),
            Self::Twin | Self::Larger => ALUMINIUM_ALLOY.spheres(dissipation_time),
        }
    }

    fn partner(self, speed: f64) -> Partner {
        let sphere = |diameter: f64| {
            Partner::Grain(Sphere {
                diameter,
                mass: diameter.powi(3),
                velocity: DVec3::new(speed, 0.0, 0.0),
                spin: 0.0,
            })
        };
        match self {
            Self::Plane => Partner::Plane,
            Self::Twin => sphere(1.0),
            Self::Larger => sphere(RATIO),
        }
    }

    /// The impact without friction or spin.
    fn smooth_impact(self, speed: f64, dissipation_time: f64) -> Impact {
        Impact {
            contact: smooth(Normal::Hertz(self.law(dissipation_time))),
            sphere: Sphere::unit(DVec3::new(-speed, 0.0, 0.0), 0.0),
            partner: self.partner(speed),
        }
    }
}

/// An experiment with its constants.
struct Experiment {
    meets: Meets,
    speed: f64,
    dissipation_time: f64,
    contact_time: f64,
    friction: CundallStrack,
}

impl Experiment {
    fn new(meets: Meets) -> Self {
        let speed = SPEED / ALUMINIUM_ALLOY.speed();
        let impact = |dissipation_time| meets.smooth_impact(speed, dissipation_time);
        let elastic = HertzImpact::of(&meets.law(0.0), &impact(0.0));
        let contact_time = elastic.contact_time();
        Self {
            meets,
            speed,
            dissipation_time: dissipation_time(RESTITUTION, contact_time, impact),
            contact_time,
            friction: ALUMINIUM_ALLOY.friction(FRICTION, elastic.reduced_mass, contact_time),
        }
    }

    /// The impact at r omega/v.
    fn impact(&self, spin: f64) -> Impact {
        let mut impact = self.meets.smooth_impact(self.speed, self.dissipation_time);
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

    fn simulated(&self, spin: f64) -> Result<[f64; 2], ClaimError> {
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
        let spin = impact.sphere.spin - 0.5 * impulse / impact.sphere.inertia();
        self.read(velocity, spin)
    }

    /// Slow spins beside the equation of motion, a fast one beside sliding throughout.
    fn checks(&self) -> Result<Vec<Check>, ClaimError> {
        let mut checks = Vec::new();
        for (spin, expected, reference) in [
            (0.5, self.integrated(0.5), "equation of motion"),
            (1.5, self.integrated(1.5), "equation of motion"),
            (8.0, self.sliding(8.0), "sliding throughout"),
        ] {
            let found = self.simulated(spin)?;
            for (place, name) in ["v_t'/v", "r omega'/v"].into_iter().enumerate() {
                let setting = format!("{}, r omega/v = {spin}", self.meets.name());
                let check = Check::absolute(name, &setting, expected[place], found[place], 4e-3);
                checks.push(check.by(reference));
            }
        }
        let time_step = self.contact_time / FINE;
        checks.push(kernels_agree(
            self.meets.name(),
            &self.impact(1.5),
            time_step,
        )?);
        Ok(checks)
    }
}

/// Velocity and spin after an impact: by the engine and by the equation of motion.
struct Row {
    meets: Meets,
    /// r omega/v before.
    spin: f64,
    found: [f64; 2],
    expected: [f64; 2],
}

fn examine(circumstances: Circumstances<'_>) -> Result<Finding, ClaimError> {
    let mut finding = Finding::described(&PROSE, &[]);
    let experiments = MEETS.map(Experiment::new);
    let mut rows: Vec<Row> = Vec::new();
    for experiment in &experiments {
        circumstances.go_on()?;
        let meets = experiment.meets;
        for spin in spaced(0.25, LARGEST_SPIN, circumstances.size.choose(12, 24)) {
            rows.push(Row {
                meets,
                spin,
                found: experiment.simulated(spin)?,
                expected: experiment.integrated(spin),
            });
        }
        finding.checks.extend(experiment.checks()?);
        let impact = experiment.impact(1.5);
        let expected = outcome(&impact).spin[0];
        finding.convergences.extend(impact_convergences(
            ("spin", &format!("{}, r omega/v = 1.5", meets.name())),
            &impact,
            experiment.contact_time,
            [0.7, 3.0],
            // Over the spin before: the spin after may be next to nothing.
            |rebound| (rebound.spin[0] - expected) / impact.sphere.spin,
        )?);
    }
    finding.figures = vec![PROSE.figure("spin", &[], drawing(&experiments, &rows)?)];
    finding.data = Some(
        Columns::of(&rows)
            .word("meets", "partner", |row| row.meets.name().to_owned())
            .number("spin_before", "", "r omega/v", |row| row.spin)
            .number("velocity", "", "v_t'/v", |row| row.found[0])
            .number("velocity_expected", "", "v_t'/v", |row| row.expected[0])
            .number("spin", "", "r omega'/v", |row| row.found[1])
            .number("spin_expected", "", "r omega'/v", |row| row.expected[1])
            .table()?,
    );
    Ok(finding)
}

fn drawing(experiments: &[Experiment], rows: &[Row]) -> Result<Drawing, FigureError> {
    let dense = spaced(0.0, LARGEST_SPIN, 121);
    let panels = experiments.iter().map(|experiment| {
        let sliding: Vec<[f64; 2]> = dense.iter().map(|spin| experiment.sliding(*spin)).collect();
        // A contact without slip at all has no scale of its own.
        let integrated = dense
            .iter()
            .map(|spin| experiment.integrated(spin.max(1e-3)));
        let integrated: Vec<[f64; 2]> = integrated.collect();
        let mine = || rows.iter().filter(|row| row.meets == experiment.meets);
        let spins: Vec<f64> = mine().map(|row| row.spin).collect();
        let mut panel = ChartPanel::new("*rω*/*v* before", "after the impact")
            .title(experiment.meets.name())
            .x_range(0.0..=6.2);
        for (place, name) in ["*v*_{t}′/*v*", "*rω*′/*v*"].into_iter().enumerate() {
            let line = |name: &str, values: &[[f64; 2]]| {
                let values: Vec<f64> = values.iter().map(|value| value[place]).collect();
                Line::new(named_once(name, place), &dense, &values)
            };
            let found: Vec<f64> = mine().map(|row| row.found[place]).collect();
            let sliding = line("sliding throughout", &sliding).tint(Tint::Grey);
            panel = panel
                .with(sliding.weight(2.4))
                .with(line("equation of motion", &integrated).tint(Tint::Black))
                .with(Points::new(&format!("{name}, engine"), &spins, &found).series(place));
        }
        panel
    });
    ChartFigure::grid(3, panels)
        .description(
            "Slow spins are held and turned back, fast ones lose what sliding friction takes.",
        )
        .width(Width::DoubleColumn)
        .legend(LegendPlace::Below)
        .draw()
}
