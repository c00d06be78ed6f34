//! Oblique impact of a sphere on a plane with a constant resultant velocity.

use core::f64::consts::PI;

use glam::DVec3;
use peristalsis_figures::chart::{
    ChartFigure, ChartPanel, LegendPlace, Line, Pattern, Points, Tint,
};
use peristalsis_figures::{Drawing, Width};
use peristalsis_physics::contact::{ContactModel, CundallStrack, Normal, Sliding};

use super::restitution::dissipation_time;
use super::study::{
    FINE, Material, convergences, error_figure, evenly, hertz_stiffness, kernels_agree, numbers,
    table,
};
use crate::textbook::case::{Case, Circumstances};
use crate::textbook::error::ValidateError;
use crate::textbook::experiment::Means;
use crate::textbook::experiment::impact::{Impact, Partner, Sphere};
use crate::textbook::finding::{CaseFigure, Check, Finding};
use crate::textbook::reference::hertz::HertzImpact;
use crate::textbook::reference::impact::outcome;
use crate::textbook::reference::maw::MindlinImpact;

pub(super) const CASE: Case = Case {
    name: "oblique-impact",
    title: "Oblique impact of a sphere on a plane, angle varied",
    source: "Chung & Ooi 2011, test 4; Maw, Barber & Fawcett 1976",
    examine,
};

const ALUMINIUM_OXIDE: Material = Material {
    name: "aluminium oxide",
    young_modulus: 3.8e11,
    poisson_ratio: 0.23,
    density: 4000.0,
};
/// \[m/s\]
const SPEED: f64 = 3.9;
const FRICTION: f64 = 0.092;
const RESTITUTION: f64 = 0.98;

/// What is made of the velocity v, the spin omega of the sphere and the angle of incidence.
#[derive(Clone, Copy, Debug)]
struct Rebound {
    /// v_t'/v_t
    tangential_restitution: f64,
    /// r omega'/v
    spin: f64,
    /// Angle between the normal and the velocity of the surface where it touched \[degrees\].
    angle: f64,
}

/// The experiment with its constants worked out once.
struct Experiment {
    speed: f64,
    contact_time: f64,
    dissipation_time: f64,
    friction: CundallStrack,
}

impl Experiment {
    fn new() -> Self {
        let speed = SPEED / ALUMINIUM_OXIDE.speed();
        let head_on = |friction: Option<CundallStrack>, dissipation_time: f64| Impact {
            contact: ContactModel {
                normal: Normal::Hertz(ALUMINIUM_OXIDE.against_rigid(dissipation_time)),
                friction,
            },
            sphere: Sphere::unit(DVec3::new(-speed, 0.0, 0.0), 0.0),
            partner: Partner::Plane,
        };
        let elastic = head_on(None, 0.0);
        let contact_time = HertzImpact {
            stiffness: hertz_stiffness(&ALUMINIUM_OXIDE.against_rigid(0.0), &elastic),
            reduced_mass: 1.0,
            speed,
        }
        .contact_time();
        let dissipation_time =
            dissipation_time(RESTITUTION, contact_time, |time| head_on(None, time));
        // A linear normal spring with this contact time has k = m (pi/t_c)^2; Mindlin's ratio of the stiffnesses is 2 (1 - nu)/
        // (2 - nu).
        let nu = ALUMINIUM_OXIDE.poisson_ratio;
        let equal = (PI / contact_time) * (PI / contact_time);
        let friction = CundallStrack {
            tangential_stiffness: 2.0 * (1.0 - nu) / (2.0 - nu) * equal,
            tangential_damping: 0.0,
            static_friction: FRICTION,
            kinetic_friction: FRICTION,
            sliding: Sliding::Spring,
        };
        Self {
            speed,
            contact_time,
            dissipation_time,
            friction,
        }
    }

    fn impact(&self, degrees: f64) -> Impact {
        let (sin, cos) = libm::sincos(degrees.to_radians());
        Impact {
            contact: ContactModel {
                normal: Normal::Hertz(ALUMINIUM_OXIDE.against_rigid(self.dissipation_time)),
                friction: Some(self.friction),
            },
            sphere: Sphere::unit(self.speed * DVec3::new(-cos, sin, 0.0), 0.0),
            partner: Partner::Plane,
        }
    }

    /// Reads off velocity and spin after an impact.
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
    fn simulated(&self, degrees: f64) -> Result<Rebound, ValidateError> {
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
}

fn examine(circumstances: Circumstances<'_>) -> Result<Finding, ValidateError> {
    let experiment = Experiment::new();
    let angles = circumstances.extent.choose(
        vec![2.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 40.0, 60.0, 80.0],
        evenly(2.0, 86.0, 29),
    );
    let (mut simulated, mut integrated, mut mindlin) = (Vec::new(), Vec::new(), Vec::new());
    for angle in &angles {
        circumstances.go_on()?;
        simulated.push(experiment.simulated(*angle)?);
        integrated.push(experiment.integrated(*angle));
        mindlin.push(experiment.mindlin(*angle));
    }
    let sliding: Vec<Rebound> = angles
        .iter()
        .map(|angle| experiment.sliding(*angle))
        .collect();
    let mut finding = Finding {
        paragraphs: vec![
            "A sphere of 5 mm of aluminium oxide at 3.9 m/s, mu = 0.092, e = 0.98 head-on (viscoelastic; A from the equation of motion). \
             r omega' is given over v; the angle of rebound is that of the surface where it touched. Beyond some 32 degrees the \
             contact slides throughout, and the closed form v_t' = v_t - mu (1 + e) v_n, omega' = 5 mu (1 + e) v_n/(2 r) holds \
             but for the arm of the friction, which is shorter than r by half the overlap (1e-3 here)."
                .to_owned(),
            "Where the contact sticks for a while, our law and Mindlin's differ by nature: our tangential spring (Cundall & Strack) \
             has one stiffness for all of the impact, Mindlin's grows with the contact and gives way from its rim inwards. With \
             k_t = 2 (1 - nu)/(2 - nu) times the linear normal stiffness of the same contact time the two agree as the last two \
             rows say. Theirs is computed as a foundation of independent springs with Coulomb's law in each, which is exact \
             for that problem, and without dissipation (e = 1)."
                .to_owned(),
        ],
        ..Finding::default()
    };
    for angle in [5.0, 15.0, 25.0, 60.0] {
        let (found, expected) = (experiment.simulated(angle)?, experiment.integrated(angle));
        let setting = format!("{angle} degrees");
        for (name, found, expected) in [
            (
                "v_t'/v_t",
                found.tangential_restitution,
                expected.tangential_restitution,
            ),
            ("r omega'/v", found.spin, expected.spin),
        ] {
            let check = Check::absolute(name, &setting, expected, found, 1e-3);
            finding.checks.push(check.by("equation of motion"));
        }
    }
    for angle in [45.0, 60.0, 80.0] {
        let (found, expected) = (experiment.simulated(angle)?, experiment.sliding(angle));
        let setting = format!("{angle} degrees");
        for (name, found, expected) in [
            (
                "v_t'/v_t",
                found.tangential_restitution,
                expected.tangential_restitution,
            ),
            ("r omega'/v", found.spin, expected.spin),
            ("angle of rebound (degrees)", found.angle, expected.angle),
        ] {
            let check = Check::relative(name, &setting, expected, found, 2e-3);
            finding.checks.push(check.by("sliding throughout"));
        }
    }
    let largest = |difference: &dyn Fn(&Rebound, &Rebound) -> f64| {
        let pairs = simulated.iter().zip(&mindlin);
        pairs.fold(0.0_f64, |largest, (one, other)| {
            largest.max(difference(one, other).abs())
        })
    };
    for (name, found, tolerance) in [
        (
            "r omega'/v, largest difference",
            largest(&|one, other| one.spin - other.spin),
            0.05,
        ),
        (
            "v_t'/v_t, largest difference",
            largest(&|one, other| one.tangential_restitution - other.tangential_restitution),
            0.1,
        ),
    ] {
        let check = Check::absolute(name, "all angles", 0.0, found, tolerance);
        finding.checks.push(check.by("Maw et al. 1976"));
    }
    let time_step = experiment.contact_time / FINE;
    let sticking = experiment.impact(15.0);
    finding
        .checks
        .push(kernels_agree("15 degrees", &sticking, time_step)?);
    for (angle, order) in [(15.0, [0.8, 3.0]), (60.0, [1.5, 4.0])] {
        let impact = experiment.impact(angle);
        let expected = outcome(&impact).spin[0];
        finding.convergences.extend(convergences(
            ("spin", &format!("{angle} degrees")),
            &impact,
            experiment.contact_time,
            order,
            |rebound| rebound.spin[0] / expected - 1.0,
        )?);
    }
    finding.figures.push(CaseFigure {
        name: "oblique-impact",
        caption: "Tangential restitution, spin and angle of rebound against the angle of incidence, measured from the normal: \
                  engine, the equation of motion of the same law, Mindlin's contact (Maw et al.), and sliding throughout.",
        drawing: drawing(&experiment, &angles, &simulated)?,
    });
    let errors = |from: usize| finding.convergences[from..from + 2].iter().collect();
    finding.figures.push(CaseFigure {
        name: "oblique-impact-errors",
        caption: "Error of the spin after an oblique impact against the time step.",
        drawing: error_figure(
            "Errors of the spin fall with the time step.",
            "*h*/*t*_{c}",
            &[
                ("15 degrees, sticks and slides", errors(0)),
                ("60 degrees, slides", errors(2)),
            ],
        )?,
    });
    let column = |name: &str, of: &dyn Fn(usize) -> f64| {
        numbers(name, "", "", (0..angles.len()).map(of).collect())
    };
    let columns = [
        numbers("angle", "degrees", "angle of incidence", angles.clone()),
        column("tangential_restitution", &|i| {
            simulated[i].tangential_restitution
        }),
        column("tangential_restitution_expected", &|i| {
            integrated[i].tangential_restitution
        }),
        column("tangential_restitution_mindlin", &|i| {
            mindlin[i].tangential_restitution
        }),
        column("tangential_restitution_sliding", &|i| {
            sliding[i].tangential_restitution
        }),
        column("spin", &|i| simulated[i].spin),
        column("spin_expected", &|i| integrated[i].spin),
        column("spin_mindlin", &|i| mindlin[i].spin),
        column("spin_sliding", &|i| sliding[i].spin),
        column("rebound_angle", &|i| simulated[i].angle),
        column("rebound_angle_expected", &|i| integrated[i].angle),
        column("rebound_angle_mindlin", &|i| mindlin[i].angle),
        column("rebound_angle_sliding", &|i| sliding[i].angle),
    ];
    finding.table = table(columns)?;
    Ok(finding)
}

fn drawing(
    experiment: &Experiment,
    angles: &[f64],
    simulated: &[Rebound],
) -> Result<Drawing, ValidateError> {
    type Read = fn(&Rebound) -> f64;
    let quantities: [(&str, Read); 3] = [
        ("tangential restitution *v*_{t}′/*v*_{t}", |r| {
            r.tangential_restitution
        }),
        ("spin *rω*′/*v*", |r| r.spin),
        ("angle of rebound (degrees)", |r| r.angle),
    ];
    let dense = evenly(1.0, 89.0, 89);
    let over = |of: &dyn Fn(f64) -> Rebound| -> Vec<Rebound> {
        dense.iter().map(|angle| of(*angle)).collect()
    };
    let integrated = over(&|angle| experiment.integrated(angle));
    let mindlin = over(&|angle| experiment.mindlin(angle));
    let sliding = over(&|angle| experiment.sliding(angle));
    let panels = quantities.iter().map(|(label, read)| {
        let values = |rebounds: &[Rebound]| -> Vec<f64> { rebounds.iter().map(read).collect() };
        // Sliding throughout has a meaning where what is left of the slip is not far beyond zero.
        let slid: Vec<f64> = sliding
            .iter()
            .map(|rebound| {
                if rebound.angle > -10.0 {
                    read(rebound)
                } else {
                    f64::NAN
                }
            })
            .collect();
        ChartPanel::new("angle of incidence (degrees)", label)
            .x_range(0.0..=90.0)
            .with(
                Line::new("sliding throughout", &dense, &slid)
                    .tint(Tint::Grey)
                    .weight(2.4),
            )
            .with(
                Line::new("Mindlin (Maw et al. 1976)", &dense, &values(&mindlin))
                    .pattern(Pattern::Dashed)
                    .tint(Tint::Vermillion),
            )
            .with(Line::new("equation of motion", &dense, &values(&integrated)).tint(Tint::Black))
            .with(Points::new("engine", angles, &values(simulated)).series(0))
    });
    Ok(ChartFigure::grid(3, panels)
        .description("Steep impacts stick, turn back and spin; grazing ones slide. The engine lies on the equation of motion of its own law, and near Mindlin's contact.")
        .width(Width::DoubleColumn)
        .legend(LegendPlace::Below)
        .draw()?)
}
