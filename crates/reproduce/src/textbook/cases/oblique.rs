//! Oblique impact of a sphere on a plane with a constant resultant velocity.

use glam::DVec3;
use peristalsis_figures::chart::{
    ChartFigure, ChartPanel, LegendPlace, Line, Pattern, Points, Tint,
};
use peristalsis_figures::{Drawing, FigureError, Width};
use peristalsis_physics::contact::{ContactModel, CundallStrack, Normal};

use super::errors::{FINE, PER_CONTACT, error_drawing, impact_convergences, kernels_agree};
use super::material::{ALUMINIUM_OXIDE, ALUMINIUM_OXIDE_SPEED};
use super::restitution::dissipation_time;
use crate::check::Check;
use crate::columns::Columns;
use crate::error::ClaimError;
use crate::exhibit::spaced;
use crate::finding::Finding;
use crate::prose::Prose;
use crate::textbook::case::{Case, Circumstances};
use crate::textbook::experiment::impact::Impact;
use crate::textbook::experiment::{Means, smooth};
use crate::textbook::reference::hertz::HertzImpact;
use crate::textbook::reference::impact::outcome;
use crate::textbook::reference::maw::MindlinImpact;

const PROSE: Prose = Prose::new(include_str!("oblique.md"));

pub(super) const CASE: Case = Case {
    name: "oblique-impact",
    prose: PROSE,
    examine,
};

const FRICTION: f64 = 0.092;
const RESTITUTION: f64 = 0.98;

/// The motion after an impact, in units of the motion before it.
#[derive(Clone, Copy, Debug)]
struct Rebound {
    /// v_t'/v_t
    tangential_restitution: f64,
    /// r omega'/v
    spin: f64,
    /// Angle between the normal and the velocity of the surface where it touched \[degrees\].
    angle: f64,
}

/// A quantity of a rebound.
struct Quantity {
    column: &'static str,
    name: &'static str,
    label: &'static str,
    of: fn(&Rebound) -> f64,
}

const QUANTITIES: [Quantity; 3] = [
    Quantity {
        column: "tangential_restitution",
        name: "v_t'/v_t",
        label: "tangential restitution *v*_{t}′/*v*_{t}",
        of: |rebound| rebound.tangential_restitution,
    },
    Quantity {
        column: "spin",
        name: "r omega'/v",
        label: "spin *rω*′/*v*",
        of: |rebound| rebound.spin,
    },
    Quantity {
        column: "rebound_angle",
        name: "angle of rebound (degrees)",
        label: "angle of rebound (degrees)",
        of: |rebound| rebound.angle,
    },
];

/// The rebounds at one angle of incidence.
struct Row {
    /// \[degrees\]
    angle: f64,
    engine: Rebound,
    equation_of_motion: Rebound,
    mindlin: Rebound,
    sliding: Rebound,
}

/// A method that gives a rebound.
type Method = fn(&Row) -> &Rebound;

/// The methods by the ends of the names of their columns.
const METHODS: [(&str, Method); 4] = [
    ("", |row| &row.engine),
    ("_expected", |row| &row.equation_of_motion),
    ("_mindlin", |row| &row.mindlin),
    ("_sliding", |row| &row.sliding),
];

/// The experiment with its constants.
struct Experiment {
    speed: f64,
    contact_time: f64,
    dissipation_time: f64,
    friction: CundallStrack,
}

impl Experiment {
    fn new() -> Self {
        let speed = ALUMINIUM_OXIDE_SPEED / ALUMINIUM_OXIDE.speed();
        let head_on = |dissipation_time: f64| {
            let law = ALUMINIUM_OXIDE.against_rigid(dissipation_time);
            Impact::on_plane(smooth(Normal::Hertz(law)), DVec3::new(-speed, 0.0, 0.0))
        };
        let elastic = HertzImpact::of(&ALUMINIUM_OXIDE.against_rigid(0.0), &head_on(0.0));
        let contact_time = elastic.contact_time();
        Self {
            speed,
            contact_time,
            dissipation_time: dissipation_time(RESTITUTION, contact_time, head_on),
            friction: ALUMINIUM_OXIDE.friction(FRICTION, 1.0, contact_time),
        }
    }

    fn impact(&self, degrees: f64) -> Impact {
        let (sin, cos) = libm::sincos(degrees.to_radians());
        let contact = ContactModel {
            normal: Normal::Hertz(ALUMINIUM_OXIDE.against_rigid(self.dissipation_time)),
            friction: Some(self.friction),
        };
        Impact::on_plane(contact, self.speed * DVec3::new(-cos, sin, 0.0))
    }

    /// The rebound from velocity and spin after an impact.
    fn rebound(&self, degrees: f64, velocity: DVec3, spin: f64) -> Rebound {
        let lateral = self.speed * libm::sin(degrees.to_radians());
        // The surface moves with v_t - r omega against a normal along x, tangent along y, spin about z.
        let surface = velocity.y - 0.5 * spin;
        Rebound {
            tangential_restitution: velocity.y / lateral,
            spin: 0.5 * spin / self.speed,
            angle: libm::atan2(surface, velocity.x).to_degrees(),
        }
    }

    /// By the engine.
    fn simulated(&self, degrees: f64) -> Result<Rebound, ClaimError> {
        let time_step = self.contact_time / FINE;
        let found = self
            .impact(degrees)
            .simulate(Means::USUAL, time_step, 0.5)?;
        Ok(self.rebound(degrees, found.velocity[0], found.spin[0]))
    }

    /// By the equation of motion.
    fn integrated(&self, degrees: f64) -> Rebound {
        let found = outcome(&self.impact(degrees));
        self.rebound(degrees, found.velocity[0], found.spin[0])
    }

    /// From a tangential impulse, as a part of mu times the normal one, and a restitution, for a rigid sphere.
    fn after_impulse(&self, degrees: f64, part: f64, restitution: f64) -> Rebound {
        let (sin, cos) = libm::sincos(degrees.to_radians());
        let (lateral, normal) = (self.speed * sin, self.speed * cos);
        let impulse = part * FRICTION * (1.0 + restitution) * normal;
        // I = 2 m r^2/5, r = 1/2.
        let velocity = DVec3::new(restitution * normal, lateral - impulse, 0.0);
        self.rebound(degrees, velocity, 5.0 * impulse)
    }

    /// Gross sliding: the tangential impulse is mu times the normal one, at the restitution of the normal speed.
    fn sliding(&self, degrees: f64) -> Rebound {
        let normal = self.speed * libm::cos(degrees.to_radians());
        let mut head_on = self.impact(0.0);
        head_on.contact.friction = None;
        head_on.sphere.velocity = DVec3::new(-normal, 0.0, 0.0);
        let restitution = outcome(&head_on).velocity[0].x / normal;
        self.after_impulse(degrees, 1.0, restitution)
    }

    /// Mindlin's contact without dissipation.
    fn mindlin(&self, degrees: f64) -> Rebound {
        let impact = MindlinImpact {
            poisson_ratio: ALUMINIUM_OXIDE.poisson_ratio,
            friction: FRICTION,
            normal_speed: 1e-3,
            slip_ratio: libm::tan(degrees.to_radians()),
        };
        self.after_impulse(degrees, impact.impulse_ratio(), 1.0)
    }

    /// By all methods.
    fn row(&self, angle: f64) -> Result<Row, ClaimError> {
        Ok(Row {
            angle,
            engine: self.simulated(angle)?,
            equation_of_motion: self.integrated(angle),
            mindlin: self.mindlin(angle),
            sliding: self.sliding(angle),
        })
    }

    /// The engine beside the equation of motion, and at large angles beside sliding throughout.
    fn checks(&self) -> Result<Vec<Check>, ClaimError> {
        let mut checks = Vec::new();
        for angle in [5.0, 15.0, 25.0, 60.0] {
            let (found, expected) = (self.simulated(angle)?, self.integrated(angle));
            for Quantity { name, of, .. } in &QUANTITIES[..2] {
                let setting = format!("{angle} degrees");
                let check = Check::absolute(name, &setting, of(&expected), of(&found), 1e-3);
                checks.push(check.by("equation of motion"));
            }
        }
        for angle in [45.0, 60.0, 80.0] {
            let (found, expected) = (self.simulated(angle)?, self.sliding(angle));
            for Quantity { name, of, .. } in &QUANTITIES {
                let setting = format!("{angle} degrees");
                let check = Check::relative(name, &setting, of(&expected), of(&found), 2e-3);
                checks.push(check.by("sliding throughout"));
            }
        }
        Ok(checks)
    }
}

/// The largest difference of the engine from Mindlin's contact.
fn beside_mindlin(quantity: &Quantity, rows: &[Row], tolerance: f64) -> Check {
    let largest = rows.iter().fold(0.0_f64, |largest, row| {
        largest.max(((quantity.of)(&row.engine) - (quantity.of)(&row.mindlin)).abs())
    });
    let name = format!("{}, largest difference", quantity.name);
    Check::absolute(&name, "all angles", 0.0, largest, tolerance).by("Maw et al. 1976")
}

fn examine(circumstances: Circumstances<'_>) -> Result<Finding, ClaimError> {
    let experiment = Experiment::new();
    let angles = circumstances.size.choose(
        vec![2.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 40.0, 60.0, 80.0],
        spaced(2.0, 86.0, 29),
    );
    let mut rows = Vec::new();
    for angle in angles {
        circumstances.go_on()?;
        rows.push(experiment.row(angle)?);
    }
    let mut finding = Finding::described(&PROSE, &[]);
    finding.checks = experiment.checks()?;
    let [restitution, spin, _] = &QUANTITIES;
    let sticking = experiment.impact(15.0);
    let time_step = experiment.contact_time / FINE;
    finding.checks.extend([
        beside_mindlin(spin, &rows, 0.05),
        beside_mindlin(restitution, &rows, 0.1),
        kernels_agree("15 degrees", &sticking, time_step)?,
    ]);
    for (angle, order) in [(15.0, [0.8, 3.0]), (60.0, [1.5, 4.0])] {
        let impact = experiment.impact(angle);
        let expected = outcome(&impact).spin[0];
        finding.convergences.extend(impact_convergences(
            ("spin", &format!("{angle} degrees")),
            &impact,
            experiment.contact_time,
            order,
            |rebound| rebound.spin[0] / expected - 1.0,
        )?);
    }
    let (sticks, slides) = finding.convergences.split_at(2);
    finding.figures = vec![
        PROSE.figure("oblique-impact", &[], drawing(&experiment, &rows)?),
        PROSE.figure(
            "oblique-impact-errors",
            &[],
            error_drawing(
                "Errors of the spin fall with the time step.",
                &PER_CONTACT,
                &[
                    ("15 degrees, sticks and slides", sticks),
                    ("60 degrees, slides", slides),
                ],
            )?,
        ),
    ];
    let incidence = "angle of incidence";
    let mut data = Columns::of(&rows).number("angle", "degrees", incidence, |row| row.angle);
    for quantity in &QUANTITIES {
        for (method, rebound) in METHODS {
            let name = format!("{}{method}", quantity.column);
            data = data.number(&name, "", "", |row| (quantity.of)(rebound(row)));
        }
    }
    finding.data = Some(data.table()?);
    Ok(finding)
}

fn drawing(experiment: &Experiment, rows: &[Row]) -> Result<Drawing, FigureError> {
    let angles: Vec<f64> = rows.iter().map(|row| row.angle).collect();
    let dense = spaced(1.0, 89.0, 89);
    let over = |method: fn(&Experiment, f64) -> Rebound| -> Vec<Rebound> {
        dense
            .iter()
            .map(|angle| method(experiment, *angle))
            .collect()
    };
    let equation_of_motion = over(Experiment::integrated);
    let mindlin = over(Experiment::mindlin);
    let sliding = over(Experiment::sliding);
    let panels = QUANTITIES.iter().map(|Quantity { label, of, .. }| {
        let line = |name: &str, rebounds: &[Rebound]| {
            let values: Vec<f64> = rebounds.iter().map(of).collect();
            Line::new(name, &dense, &values)
        };
        // Sliding throughout makes sense only where the slip that is left is not far below zero.
        let slides = |rebound: &Rebound| rebound.angle > -10.0;
        let slid = sliding
            .iter()
            .map(|one| if slides(one) { of(one) } else { f64::NAN });
        let sliding = Line::new("sliding throughout", &dense, &slid.collect::<Vec<f64>>());
        let found: Vec<f64> = rows.iter().map(|row| of(&row.engine)).collect();
        let mindlin = line("Mindlin (Maw et al. 1976)", &mindlin).pattern(Pattern::Dashed);
        ChartPanel::new("angle of incidence (degrees)", label)
            .x_range(0.0..=90.0)
            .with(sliding.tint(Tint::Grey).weight(2.4))
            .with(mindlin.tint(Tint::Vermillion))
            .with(line("equation of motion", &equation_of_motion).tint(Tint::Black))
            .with(Points::new("engine", &angles, &found).series(0))
    });
    ChartFigure::grid(3, panels)
        .description("Steep impacts stick, turn back and spin; grazing ones slide. The engine lies on the equation of motion of its own law, and near Mindlin's contact.")
        .width(Width::DoubleColumn)
        .legend(LegendPlace::Below)
        .draw()
}
