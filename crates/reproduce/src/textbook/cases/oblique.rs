//! Oblique impact of a sphere on a plane with a constant resultant velocity.

use glam::DVec3;
use peristalsis_figures::Width;
use peristalsis_figures::chart::{ChartFigure, ChartPanel, LegendPlace, Line, Pattern, Tint};
use peristalsis_physics::contact::{
    ContactModel, CundallStrack, LinearSpringDashpot, Normal, Sliding,
};

use super::errors::error_chart;
use super::material::{ALUMINIUM_OXIDE, aluminium_oxide_impact};
use super::plot::points;
use super::trial::{PER_CONTACT, Sweep, Trial, dissipation_time};
use crate::columns::Columns;
use crate::error::Result;
use crate::exhibit::spaced;
use crate::textbook::case::Circumstances;
use crate::textbook::experiment::Means;
use crate::textbook::experiment::impact::{Impact, Rebound};
use crate::textbook::reference::impact::outcome;
use crate::textbook::reference::maw::MindlinImpact;
use crate::{Check, Finding, Prose};

pub(super) const PROSE: Prose = Prose::new(include_str!("oblique.md"));

const FRICTION: f64 = 0.092;
const RESTITUTION: f64 = 0.98;

/// The quantities of a rebound, in units of the motion before the impact; the angle is that between the normal and the
/// velocity of the surface where it touched.
const NAMES: [&str; 3] = ["v_t'/v_t", "r omega'/v", "angle of rebound (degrees)"];
const COLUMNS: [&str; 3] = ["tangential_restitution", "spin", "rebound_angle"];
const LABELS: [&str; 3] = [
    "tangential restitution *v*_{t}′/*v*_{t}",
    "spin *rω*′/*v*",
    "angle of rebound (degrees)",
];

/// The quantities at one angle of incidence by each of [`METHODS`].
struct Row {
    /// \[degrees\]
    angle: f64,
    by: [[f64; 3]; 4],
}

/// Engine, equation of motion, Mindlin's contact and sliding throughout, by the ends of the names of their columns.
const METHODS: [&str; 4] = ["", "_expected", "_mindlin", "_sliding"];

/// The experiment with its constants.
struct Experiment {
    speed: f64,
    head_on: Trial,
}

impl Sweep<3> for Experiment {
    /// The impact at an angle of incidence.
    fn trial(&self, degrees: f64) -> Trial {
        let (sin, cos) = libm::sincos(degrees.to_radians());
        let mut trial = self.head_on;
        trial.impact.sphere.velocity = self.speed * DVec3::new(-cos, sin, 0.0);
        trial
    }

    fn read(&self, degrees: f64, velocity: DVec3, spin: f64) -> [f64; 3] {
        let lateral = self.speed * libm::sin(degrees.to_radians());
        // The surface moves with v_t - r omega against a normal along x, tangent along y, spin about z.
        let surface = velocity.y - 0.5 * spin;
        let angle = libm::atan2(surface, velocity.x).to_degrees();
        [velocity.y / lateral, 0.5 * spin / self.speed, angle]
    }
}

impl Experiment {
    fn new() -> Self {
        let time = dissipation_time(RESTITUTION, aluminium_oxide_impact);
        let frictionless = Trial::of(aluminium_oxide_impact(time));
        Self {
            speed: -frictionless.impact.sphere.velocity.x,
            head_on: frictionless.with_friction(&ALUMINIUM_OXIDE, FRICTION),
        }
    }

    /// From a tangential impulse, as a part of mu times the normal one, and a restitution, for a rigid sphere.
    fn after_impulse(&self, degrees: f64, part: f64, restitution: f64) -> [f64; 3] {
        let (sin, cos) = libm::sincos(degrees.to_radians());
        let (lateral, normal) = (self.speed * sin, self.speed * cos);
        let impulse = part * FRICTION * (1.0 + restitution) * normal;
        // I = 2 m r^2/5, r = 1/2.
        let velocity = DVec3::new(restitution * normal, lateral - impulse, 0.0);
        self.read(degrees, velocity, 5.0 * impulse)
    }

    /// Gross sliding: the tangential impulse is mu times the normal one, at the restitution of the normal speed.
    fn sliding(&self, degrees: f64) -> [f64; 3] {
        let normal = self.speed * libm::cos(degrees.to_radians());
        let mut head_on = self.head_on.impact;
        head_on.contact.friction = None;
        head_on.sphere.velocity = DVec3::new(-normal, 0.0, 0.0);
        let restitution = outcome(&head_on).velocity[0].x / normal;
        self.after_impulse(degrees, 1.0, restitution)
    }

    /// Mindlin's contact without dissipation.
    fn mindlin(&self, degrees: f64) -> [f64; 3] {
        let impact = MindlinImpact {
            poisson_ratio: ALUMINIUM_OXIDE.poisson_ratio,
            friction: FRICTION,
            normal_speed: 1e-3,
            slip_ratio: libm::tan(degrees.to_radians()),
        };
        self.after_impulse(degrees, impact.impulse_ratio(), 1.0)
    }

    /// The references.
    fn expected(&self, angle: f64) -> [[f64; 3]; 3] {
        let (integrated, mindlin) = (self.integrated(angle), self.mindlin(angle));
        [integrated, mindlin, self.sliding(angle)]
    }

    /// The engine beside the equation of motion, and at large angles beside sliding throughout.
    fn checks(&self) -> Result<Vec<Check>> {
        let mut checks = Vec::new();
        for angle in [5.0, 15.0, 25.0, 60.0] {
            let (found, expected) = (self.simulated(angle)?, self.integrated(angle));
            for (place, name) in NAMES[..2].iter().enumerate() {
                let setting = format!("{angle} degrees");
                let check = Check::absolute(name, &setting, expected[place], found[place], 1e-3);
                checks.push(check.by("equation of motion"));
            }
        }
        for angle in [45.0, 60.0, 80.0] {
            let (found, expected) = (self.simulated(angle)?, self.sliding(angle));
            for (place, name) in NAMES.iter().enumerate() {
                let setting = format!("{angle} degrees");
                let check = Check::relative(name, &setting, expected[place], found[place], 2e-3);
                checks.push(check.by("sliding throughout"));
            }
        }
        Ok(checks)
    }
}

/// Two grains with linear springs and dashpots, the presets' in the plane of contact, that stick until they part.
fn with_a_dashpot() -> Trial {
    let friction = CundallStrack {
        tangential_stiffness: 2.0 / 7.0,
        tangential_damping: 0.1,
        static_friction: 5.0,
        kinetic_friction: 5.0,
        sliding: Sliding::Spring,
    };
    let normal = LinearSpringDashpot {
        normal_stiffness: 1.0,
        normal_damping: 0.1,
    };
    let contact = ContactModel::new(Normal::Linear(normal), Some(friction));
    let velocity = DVec3::new(-0.01, 0.01, 0.0);
    Trial::of(Impact::between(contact, velocity, DVec3::ZERO))
}

/// The engine beside the equation of motion where the dashpot in the plane of contact takes its part.
fn dashpot_checks() -> Result<[Check; 2]> {
    let trial = with_a_dashpot();
    let (found, expected) = (trial.rebound(Means::USUAL)?, outcome(&trial.impact));
    let speed = trial.impact.relative_velocity().length();
    let check = |name: &str, value: fn([DVec3; 2], [f64; 2]) -> f64| {
        let expected = value(expected.velocity, expected.spin) / speed;
        let found = value(found.velocity, found.spin) / speed;
        let setting = "45 degrees, dashpot";
        Check::relative(name, setting, expected, found, 2e-3).by("equation of motion")
    };
    Ok([
        check("v_t'/v", |velocity, _| velocity[0].y - velocity[1].y),
        check("r omega'/v", |_, spin| 0.5 * spin[0]),
    ])
}

/// The largest difference of the engine from Mindlin's contact.
fn beside_mindlin(place: usize, rows: &[Row], tolerance: f64) -> Check {
    let largest = rows.iter().fold(0.0_f64, |largest, Row { by, .. }| {
        largest.max((by[0][place] - by[2][place]).abs())
    });
    let name = format!("{}, largest difference", NAMES[place]);
    Check::absolute(&name, "all angles", 0.0, largest, tolerance).by("Maw et al. 1976")
}

pub(super) fn examine(circumstances: Circumstances<'_>) -> Result<Finding> {
    let experiment = Experiment::new();
    let angles = circumstances.size.choose(
        vec![2.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 40.0, 60.0, 80.0],
        spaced(2.0, 86.0, 29),
    );
    let mut rows = Vec::new();
    for angle in angles {
        circumstances.go_on()?;
        let [integrated, mindlin, sliding] = experiment.expected(angle);
        let by = [experiment.simulated(angle)?, integrated, mindlin, sliding];
        rows.push(Row { angle, by });
    }
    let mut finding = PROSE.described(&[]);
    finding.checks = experiment.checks()?;
    finding.checks.extend([
        beside_mindlin(1, &rows, 0.05),
        beside_mindlin(0, &rows, 0.1),
        experiment.trial(15.0).kernels_agree("15 degrees")?,
    ]);
    finding.checks.extend(dashpot_checks()?);
    for (angle, order) in [(15.0, [0.8, 3.0]), (60.0, [1.5, 4.0])] {
        let trial = experiment.trial(angle);
        let expected = outcome(&trial.impact).spin[0];
        let error = |rebound: &Rebound| rebound.spin[0] / expected - 1.0;
        let setting = format!("{angle} degrees");
        let errors = trial.convergences(("spin", &setting), order, error)?;
        finding.convergences.extend(errors);
    }
    let (sticks, slides) = finding.convergences.split_at(2);
    let groups = [
        ("15 degrees, sticks and slides", sticks),
        ("60 degrees, slides", slides),
    ];
    let errors = error_chart(&PER_CONTACT, &groups);
    finding.figures = vec![
        PROSE.chart("oblique-impact", &[], drawing(&experiment, &rows))?,
        PROSE.chart("oblique-impact-errors", &[], errors)?,
    ];
    let incidence = "angle of incidence";
    let mut data = Columns::of(&rows).number("angle", "degrees", incidence, |row| row.angle);
    for (place, column) in COLUMNS.iter().enumerate() {
        for (method, ending) in METHODS.into_iter().enumerate() {
            let name = format!("{column}{ending}");
            data = data.number(&name, "", "", |row| row.by[method][place]);
        }
    }
    finding.data = data.data()?;
    Ok(finding)
}

fn drawing(experiment: &Experiment, rows: &[Row]) -> ChartFigure {
    let dense = spaced(1.0, 89.0, 89);
    let expected: Vec<[[f64; 3]; 3]> = dense.iter().map(|x| experiment.expected(*x)).collect();
    let panels = LABELS.iter().enumerate().map(|(place, label)| {
        let line = |name: &str, of: &dyn Fn(&[[f64; 3]; 3]) -> f64| {
            Line::new(name, &dense, &expected.iter().map(of).collect::<Vec<f64>>())
        };
        // Sliding throughout makes sense only where the slip that is left is not far below zero.
        let slides = |slid: &[f64; 3]| {
            if slid[2] > -10.0 {
                slid[place]
            } else {
                f64::NAN
            }
        };
        let sliding = line("sliding throughout", &|[.., slid]| slides(slid));
        let mindlin = line("Mindlin (Maw et al. 1976)", &|expected| expected[1][place]);
        let integrated = line("equation of motion", &|[integrated, ..]| integrated[place]);
        ChartPanel::new("angle of incidence (degrees)", label)
            .x_range(0.0..=90.0)
            .with(sliding.tint(Tint::Grey).weight(2.4))
            .with(mindlin.pattern(Pattern::Dashed).tint(Tint::Vermillion))
            .with(integrated.tint(Tint::Black))
            .with(points("engine", rows, |row| (row.angle, row.by[0][place])).series(0))
    });
    ChartFigure::grid(3, panels)
        .width(Width::DoubleColumn)
        .legend(LegendPlace::Below)
}
