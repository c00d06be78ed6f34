//! A sphere thrown without spin slides, and ends up rolling.

use peristalsis_figures::chart::{ChartFigure, ChartPanel, Reference};
use peristalsis_physics::contact::{CundallStrack, Sliding};

use super::plot::{closed_form, points};
use super::restitution::spring;
use crate::columns::Columns;
use crate::error::Result;
use crate::textbook::case::Circumstances;
use crate::textbook::experiment::Means;
use crate::textbook::experiment::sliding::{Instant, Throw};
use crate::{Check, Finding, Prose};

pub(super) const PROSE: Prose = Prose::new(include_str!("roll.md"));

pub(super) const FRICTION: CundallStrack = CundallStrack {
    tangential_stiffness: 1.0,
    tangential_damping: 0.1,
    static_friction: 0.5,
    kinetic_friction: 0.4,
    sliding: Sliding::Spring,
};

/// On a level plane, thrown without spin.
pub(super) const THROW: Throw = Throw {
    normal: spring(0.1),
    friction: FRICTION,
    rolling: None,
    gravity: 1e-4,
    slope: 0.0,
    speed: 0.02,
};
pub(super) const TIME_STEP: f64 = 0.05;
/// Duration over the time that it slides.
const DURATION: f64 = 2.0;

/// t_s = 2 v_0/(7 mu g), when slip ends.
fn slip_time() -> f64 {
    2.0 * THROW.speed / (7.0 * THROW.friction.kinetic_friction * THROW.gravity)
}

pub(super) fn examine(circumstances: Circumstances<'_>) -> Result<Finding> {
    let mut finding = PROSE.described(&[]);
    let duration = DURATION * slip_time();
    let mut usual = Vec::new();
    for means in Means::INTEGRATORS {
        for (kernel, means) in [("fast", means), ("reference", means.by_reference())] {
            circumstances.go_on()?;
            let course = THROW.simulate(means, TIME_STEP, duration)?;
            let setting = format!("{}, {kernel} kernel", means.name());
            finding.checks.extend(checks(&course, &setting));
            if usual.is_empty() {
                usual = course;
            }
        }
    }
    let thinned: Vec<Instant> = usual.iter().copied().step_by(usual.len() / 24).collect();
    finding.data = Columns::of(&thinned)
        .number("time", "t", "since the throw", |row| row.time)
        .number("velocity", "d/t", "of the centre", |row| row.velocity)
        .number("rolling", "d/t", "r omega", |row| row.rolling)
        .data()?;
    finding.figures = vec![PROSE.chart("slip-to-roll", &[], drawing(&thinned))?];
    Ok(finding)
}

fn checks(course: &[Instant], setting: &str) -> Vec<Check> {
    let last = course[course.len() - 1];
    // Half way through the slip, at the step next to it.
    let middle = course[(0.5 * slip_time() / TIME_STEP) as usize];
    let slowed = THROW.friction.kinetic_friction * THROW.gravity * middle.time;
    // Where velocity and spin cross the line between their values and those of rolling.
    let mut instants = course.iter();
    let rolls = instants.find(|instant| instant.rolling >= instant.velocity);
    let rolls = rolls.map_or(f64::NAN, |instant| instant.time);
    let over_start = |velocity: f64| velocity / THROW.speed;
    let check = |quantity, reference, expected, found, tolerance| {
        Check::relative(quantity, setting, expected, found, tolerance).by(reference)
    };
    let [v, r_omega] = [last.velocity, last.rolling].map(over_start);
    let (slow, slowed) = (over_start(middle.velocity), 1.0 - over_start(slowed));
    let half_way = "v half way through the slip, over v_0";
    let (spin, end) = ("r omega at the end, over v_0", 5.0 / 7.0);
    let (rolling, time) = ("time at which it rolls", slip_time());
    vec![
        check("v at the end, over v_0", "5/7", end, v, 1e-4),
        check(spin, "5/7", end, r_omega, 1e-4),
        check(half_way, "v_0 - mu g t", slowed, slow, 1e-3),
        check(rolling, "2 v_0/(7 mu g)", time, rolls, 5e-3),
    ]
}

fn drawing(course: &[Instant]) -> ChartFigure {
    let ends = [0.0, slip_time()];
    let slowed = THROW.friction.kinetic_friction * THROW.gravity / THROW.speed;
    let line = |name: &str, of: fn(f64) -> f64| closed_form(name, &ends, |time| of(slowed * time));
    let series = |name: &str, of: fn(&Instant) -> f64| {
        points(name, course, |row| (row.time, of(row) / THROW.speed))
    };
    let panel = ChartPanel::new("time *t*", "over *v*_{0}")
        .x_range(0.0..)
        .y_range(0.0..=1.05)
        .with(line("sliding", |slowed| 1.0 - slowed))
        .with(line("", |slowed| 2.5 * slowed))
        .with(Reference::horizontal(5.0 / 7.0).label("5/7"))
        .with(series("velocity *v*", |row| row.velocity).series(0))
        .with(series("spin *rω*", |row| row.rolling).series(1).open());
    ChartFigure::new(panel)
}
