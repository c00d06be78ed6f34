//! Restitution of normal impacts against damping.

use glam::DVec3;
use peristalsis_figures::chart::{ChartFigure, ChartPanel, Line, Points};
use peristalsis_physics::contact::{LinearSpringDashpot, Normal};

use super::study::{
    FINE, Material, convergences, error_of, evenly, hertz_stiffness, kernels_agree, numbers,
    smooth, table, words,
};
use crate::textbook::case::{Case, Circumstances};
use crate::textbook::error::ValidateError;
use crate::textbook::experiment::Means;
use crate::textbook::experiment::impact::{Impact, Partner, Rebound, Sphere};
use crate::textbook::finding::{CaseFigure, Check, Finding};
use crate::textbook::reference::hertz::HertzImpact;
use crate::textbook::reference::impact::outcome;

pub(super) const CASE: Case = Case {
    name: "restitution",
    title: "Restitution of a normal impact against damping",
    source: "Chung & Ooi 2011, test 3",
    examine,
};

/// Restitutions that are asked for.
const WANTED: [f64; 5] = [0.2, 0.4, 0.6, 0.8, 1.0];

const ALUMINIUM_OXIDE: Material = Material {
    name: "aluminium oxide",
    young_modulus: 3.8e11,
    poisson_ratio: 0.23,
    density: 4000.0,
};

/// \[m/s\]
const SPEED: f64 = 3.9;

/// Two grains of mass 1 under the linear law, k = 1.
fn linear(damping: f64) -> (LinearSpringDashpot, Impact) {
    let law = LinearSpringDashpot {
        normal_stiffness: 1.0,
        normal_damping: damping,
    };
    let sphere = |speed: f64| Sphere::unit(DVec3::new(speed, 0.0, 0.0), 0.0);
    let impact = Impact {
        contact: smooth(Normal::Linear(law)),
        sphere: sphere(-0.05),
        partner: Partner::Grain(sphere(0.05)),
    };
    (law, impact)
}

/// The damping of that law for a restitution: e = exp(-pi eta/sqrt(2 - eta^2)).
pub(super) fn linear_damping(restitution: f64) -> f64 {
    let ratio = -libm::log(restitution) / core::f64::consts::PI;
    (2.0 * ratio * ratio / (1.0 + ratio * ratio)).sqrt()
}

/// A sphere of aluminium oxide on a plane.
fn viscoelastic(dissipation_time: f64) -> Impact {
    let speed = SPEED / ALUMINIUM_OXIDE.speed();
    Impact {
        contact: smooth(Normal::Hertz(
            ALUMINIUM_OXIDE.against_rigid(dissipation_time),
        )),
        sphere: Sphere::unit(DVec3::new(-speed, 0.0, 0.0), 0.0),
        partner: Partner::Plane,
    }
}

/// e of what came out.
fn restitution(impact: &Impact, velocity: [DVec3; 2]) -> f64 {
    -(velocity[0].x - velocity[1].x) / impact.relative_velocity().x
}

/// The dissipation time with which an impact, made by `impact`, has this restitution: bisection of the reference.
pub(super) fn dissipation_time(
    wanted: f64,
    time_scale: f64,
    impact: impl Fn(f64) -> Impact,
) -> f64 {
    if wanted >= 1.0 {
        return 0.0;
    }
    let (mut low, mut high) = (0.0, 50.0 * time_scale);
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        let impact = impact(middle);
        if restitution(&impact, outcome(&impact).velocity) > wanted {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// Contact time of the impact without damping, which sets the step.
fn elastic_contact_time() -> f64 {
    let impact = viscoelastic(0.0);
    HertzImpact {
        stiffness: hertz_stiffness(&ALUMINIUM_OXIDE.against_rigid(0.0), &impact),
        reduced_mass: impact.reduced_mass(),
        speed: impact.relative_velocity().length(),
    }
    .contact_time()
}

/// Root mean square restitution of two grains under the linear law with exactly so many steps in a contact, over places of
/// the onset within a step: what a gas of them has.
pub(super) fn measured_with(damping: f64, steps: f64) -> Result<f64, ValidateError> {
    const PLACES: usize = 16;
    let (law, impact) = linear(damping);
    let time_step = law.contact_time(0.5) / steps;
    let mut sum = 0.0;
    for place in 0..PLACES {
        let phase = (place as f64 + 0.5) / PLACES as f64;
        let rebound = impact.simulate(Means::USUAL, time_step, phase)?;
        sum += restitution(&impact, rebound.velocity).powi(2);
    }
    Ok((sum / PLACES as f64).sqrt())
}

/// Mean restitution over places of onset and end within a step.
fn measured(impact: &Impact, contact_time: f64, steps: f64) -> Result<f64, ValidateError> {
    // Root mean square of e: its scatter is far below e.
    error_of(impact, Means::USUAL, (contact_time, steps), |rebound| {
        restitution(impact, rebound.velocity)
    })
}

fn examine(circumstances: Circumstances<'_>) -> Result<Finding, ValidateError> {
    let mut finding = Finding {
        paragraphs: vec![
            "Left: the linear law, two grains, with eta from the closed form for the wanted e; the contact ends where the \
             overlap does. Right: the viscoelastic Hertz law, a sphere of 5 mm at 3.9 m/s on a plane; its restitution has no \
             closed form, and the expected value is that of the equation of motion integrated to twelve digits, whose contact \
             ends where the force vanishes. h = t_c/80 with t_c that of the undamped contact; e is the mean over eight places \
             of the onset within a step. The dashpot of the linear law sets in with a jump, which makes the method one of \
             order 1 there; that of the Hertz law begins as sqrt(xi)."
                .to_owned(),
        ],
        ..Finding::default()
    };
    let mut rows: Vec<(&str, f64, f64, f64)> = Vec::new();
    for wanted in WANTED {
        circumstances.go_on()?;
        let (law, impact) = linear(linear_damping(wanted));
        let elastic = core::f64::consts::PI / 2.0_f64.sqrt();
        let found = measured(&impact, elastic, FINE)?;
        let expected = law.restitution(0.5);
        let check = Check::absolute(
            "restitution",
            "linear law, two grains",
            expected,
            found,
            4e-3,
        );
        finding.checks.push(check.by("closed form"));
        rows.push(("linear", law.normal_damping, expected, found));
        if wanted == 0.6 {
            finding.checks.push(kernels_agree(
                "linear law, two grains, e = 0.6",
                &impact,
                elastic / FINE,
            )?);
            let error = |r: &Rebound| restitution(&impact, r.velocity) / expected - 1.0;
            let names = ("restitution", "linear law, e = 0.6");
            let found = convergences(names, &impact, elastic, [0.7, 1.4], error)?;
            finding.convergences.extend(found);
        }
    }
    let contact_time = elastic_contact_time();
    for wanted in WANTED {
        circumstances.go_on()?;
        let time = dissipation_time(wanted, contact_time, viscoelastic);
        let impact = viscoelastic(time);
        let found = measured(&impact, contact_time, FINE)?;
        let expected = restitution(&impact, outcome(&impact).velocity);
        let check = Check::absolute(
            "restitution",
            "Hertz law, sphere on a plane",
            expected,
            found,
            2e-3,
        );
        finding.checks.push(check.by("equation of motion"));
        rows.push(("hertz", time, expected, found));
        if wanted == 0.6 {
            let setting = "Hertz law, sphere on a plane, e = 0.6";
            let time_step = contact_time / FINE;
            finding
                .checks
                .push(kernels_agree(setting, &impact, time_step)?);
            let error = |r: &Rebound| restitution(&impact, r.velocity) / expected - 1.0;
            let names = ("restitution", "Hertz law, e = 0.6");
            let found = convergences(names, &impact, contact_time, [1.3, 2.4], error)?;
            finding.convergences.extend(found);
        }
    }
    finding.figures.push(CaseFigure {
        name: "restitution",
        caption: "Restitution against damping: the linear law with its closed form, and the viscoelastic Hertz law with its \
                  equation of motion (A the dissipation time, t_c the duration of the undamped contact).",
        drawing: drawing(&rows, contact_time)?,
    });
    finding.table = table([
        words(
            "law",
            "normal law",
            rows.iter().map(|row| row.0.to_owned()).collect(),
        ),
        numbers(
            "damping",
            "m/t or t",
            "eta, or A",
            rows.iter().map(|row| row.1).collect(),
        ),
        numbers(
            "expected",
            "",
            "restitution",
            rows.iter().map(|row| row.2).collect(),
        ),
        numbers(
            "found",
            "",
            "restitution",
            rows.iter().map(|row| row.3).collect(),
        ),
    ])?;
    Ok(finding)
}

fn drawing(
    rows: &[(&str, f64, f64, f64)],
    contact_time: f64,
) -> Result<peristalsis_figures::Drawing, ValidateError> {
    let points = |law: &str, scale: f64| {
        let of_law = rows.iter().filter(|row| row.0 == law);
        let (x, y): (Vec<f64>, Vec<f64>) = of_law.map(|row| (row.1 / scale, row.3)).unzip();
        Points::new("engine", &x, &y).series(1)
    };
    let largest = |law: &str| {
        rows.iter()
            .filter(|row| row.0 == law)
            .fold(0.0_f64, |largest, row| largest.max(row.1))
    };
    let damping = evenly(0.0, 1.15 * largest("linear"), 80);
    let closed: Vec<f64> = damping
        .iter()
        .map(|eta| linear(*eta).0.restitution(0.5))
        .collect();
    let times = evenly(0.0, 1.15 * largest("hertz"), 40);
    let integrated: Vec<f64> = times
        .iter()
        .map(|time| {
            let impact = viscoelastic(*time);
            restitution(&impact, outcome(&impact).velocity)
        })
        .collect();
    let scaled: Vec<f64> = times.iter().map(|time| time / contact_time).collect();
    let label = "restitution *e*";
    Ok(ChartFigure::grid(
        2,
        [
            ChartPanel::new("damping *η* / √(*mk*)", label)
                .title("linear law")
                .y_range(0.0..=1.05)
                .with(Line::new("closed form", &damping, &closed).series(0))
                .with(points("linear", 1.0)),
            ChartPanel::new("dissipation time *A*/*t*_{c}", label)
                .title("Hertz law")
                .y_range(0.0..=1.05)
                .with(Line::new("equation of motion", &scaled, &integrated).series(0))
                .with(points("hertz", contact_time)),
        ],
    )
    .description(
        "Restitution falls with damping; the engine's points lie on the curves of the references.",
    )
    .width(peristalsis_figures::Width::DoubleColumn)
    .panel_height(52.0)
    .draw()?)
}
