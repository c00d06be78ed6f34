//! A sphere thrown without spin slides, and ends up rolling.

use peristalsis_figures::Drawing;
use peristalsis_figures::chart::{ChartFigure, ChartPanel, Line, Pattern, Points, Reference, Tint};
use peristalsis_physics::contact::{CundallStrack, LinearSpringDashpot, Sliding};

use super::study::{numbers, table};
use crate::textbook::case::{Case, Circumstances};
use crate::textbook::error::ValidateError;
use crate::textbook::experiment::Means;
use crate::textbook::experiment::sliding::{Instant, Throw};
use crate::textbook::finding::{CaseFigure, Check, Finding};

pub(super) const CASE: Case = Case {
    name: "slip-to-roll",
    title: "A sphere thrown along a plane slides until it rolls at 5/7 of its speed",
    source: "textbooks of mechanics (Coriolis 1835); LAMMPS, MFiX",
    examine,
};

const THROW: Throw = Throw {
    normal: LinearSpringDashpot {
        normal_stiffness: 1.0,
        normal_damping: 0.1,
    },
    friction: CundallStrack {
        tangential_stiffness: 1.0,
        tangential_damping: 0.1,
        static_friction: 0.5,
        kinetic_friction: 0.4,
        sliding: Sliding::Spring,
    },
    gravity: 1e-4,
    speed: 0.02,
};
const TIME_STEP: f64 = 0.05;
/// How long it is looked at, over the time that it slides.
const LOOKED_AT: f64 = 2.0;

/// t_s = 2 v_0/(7 mu g), when slip ends.
fn slip_time() -> f64 {
    2.0 * THROW.speed / (7.0 * THROW.friction.kinetic_friction * THROW.gravity)
}

fn examine(circumstances: Circumstances<'_>) -> Result<Finding, ValidateError> {
    let mut finding = Finding {
        paragraphs: vec![
            "Static friction 0.5, kinetic 0.4, with the default tangential dashpot, which damps what the spring still holds when \
             slip ends. The weight is the engine's body force, which acts along the tube: the plane is the top of a sphere of \
             the wall a million times as large as the grain. While it slides v = v_0 - mu g t, r omega = (5/2) mu g t."
                .to_owned(),
        ],
        ..Finding::default()
    };
    let duration = LOOKED_AT * slip_time();
    let mut usual = Vec::new();
    for means in Means::INTEGRATORS {
        for means in [means, means.plainly()] {
            circumstances.go_on()?;
            let course = THROW.simulate(means, TIME_STEP, duration)?;
            let kernel = if means.kernel == peristalsis_engine::Kernel::Fast {
                "fast"
            } else {
                "plain"
            };
            let setting = format!("{}, {kernel} kernel", means.name());
            finding.checks.extend(checks(&course, &setting));
            if usual.is_empty() {
                usual = course;
            }
        }
    }
    let thinned: Vec<&Instant> = usual.iter().step_by(usual.len() / 24).collect();
    let of = |read: fn(&Instant) -> f64| thinned.iter().map(|i| read(i)).collect::<Vec<f64>>();
    finding.table = table([
        numbers("time", "t", "since the throw", of(|i| i.time)),
        numbers("velocity", "d/t", "of the centre", of(|i| i.velocity)),
        numbers("rolling", "d/t", "r omega", of(|i| i.rolling)),
    ])?;
    finding.figures.push(CaseFigure {
        name: "slip-to-roll",
        caption: "Velocity and spin of a sphere thrown without spin, with the closed forms for sliding and the 5/7 of rolling.",
        drawing: drawing(&of(|i| i.time), &of(|i| i.velocity), &of(|i| i.rolling))?,
    });
    Ok(finding)
}

fn checks(course: &[Instant], setting: &str) -> Vec<Check> {
    let last = course[course.len() - 1];
    // Half way through the slip, at the step next to it.
    let middle = course[(0.5 * slip_time() / TIME_STEP) as usize];
    let slowed = THROW.friction.kinetic_friction * THROW.gravity * middle.time;
    // Where velocity and spin cross the line between their values and those of rolling.
    let rolls = course
        .iter()
        .find(|instant| instant.rolling >= instant.velocity)
        .map_or(f64::NAN, |instant| instant.time);
    vec![
        Check::relative(
            "v at the end, over v_0",
            setting,
            5.0 / 7.0,
            last.velocity / THROW.speed,
            1e-4,
        )
        .by("5/7"),
        Check::relative(
            "r omega at the end, over v_0",
            setting,
            5.0 / 7.0,
            last.rolling / THROW.speed,
            1e-4,
        )
        .by("5/7"),
        Check::relative(
            "v half way through the slip, over v_0",
            setting,
            1.0 - slowed / THROW.speed,
            middle.velocity / THROW.speed,
            1e-3,
        )
        .by("v_0 - mu g t"),
        Check::relative("time at which it rolls", setting, slip_time(), rolls, 5e-3)
            .by("2 v_0/(7 mu g)"),
    ]
}

fn drawing(time: &[f64], velocity: &[f64], rolling: &[f64]) -> Result<Drawing, ValidateError> {
    let ends = [0.0, slip_time()];
    let slowed = THROW.friction.kinetic_friction * THROW.gravity / THROW.speed;
    let scaled = |values: &[f64]| -> Vec<f64> { values.iter().map(|v| v / THROW.speed).collect() };
    let panel = ChartPanel::new("time *t*", "over *v*_{0}")
        .x_range(0.0..)
        .y_range(0.0..=1.05)
        .with(
            Line::new("sliding", &ends, &ends.map(|t| 1.0 - slowed * t))
                .tint(Tint::Black)
                .pattern(Pattern::Dashed),
        )
        .with(
            Line::new("", &ends, &ends.map(|t| 2.5 * slowed * t))
                .tint(Tint::Black)
                .pattern(Pattern::Dashed),
        )
        .with(Reference::horizontal(5.0 / 7.0).label("5/7"))
        .with(Points::new("velocity *v*", time, &scaled(velocity)).series(0))
        .with(
            Points::new("spin *rω*", time, &scaled(rolling))
                .series(1)
                .open(),
        );
    Ok(ChartFigure::new(panel)
        .description(
            "Velocity falls and spin rises until both are 5/7 of the velocity at the start.",
        )
        .draw()?)
}
