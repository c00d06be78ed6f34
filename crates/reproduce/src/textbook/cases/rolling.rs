//! Rolling resistance: a sphere on an incline, and one that comes to rest on a plane.

use peristalsis_figures::chart::{ChartFigure, ChartPanel, Reference};
use peristalsis_physics::contact::RollingResistance;

use super::plot::{closed_form, points};
use super::roll::{self, TIME_STEP};
use crate::columns::Columns;
use crate::error::Result;
use crate::textbook::case::Circumstances;
use crate::textbook::experiment::Means;
use crate::textbook::experiment::sliding::Throw;
use crate::{Check, Finding, Prose};

pub(super) const PROSE: Prose = Prose::new(include_str!("rolling.md"));

const ROLLING: RollingResistance = RollingResistance {
    rolling_friction: 0.1,
    rolling_stiffness: 1.0,
    rolling_damping: 0.1,
};

const THROW: Throw = Throw {
    rolling: Some(ROLLING),
    ..roll::THROW
};
const DURATION: f64 = 400.0;
/// tan(theta) of the inclines: at all of them the sphere rolls without slip, if it does.
const SLOPES: [f64; 9] = [0.03, 0.06, 0.09, 0.098, 0.102, 0.12, 0.2, 0.4, 0.8];

/// Largest error of a/g on an incline, none of it of the time step: the integrators differ by 1e-9.
///
/// The springs of the contact swing out: u'' = -K u - C u' of centre and spin, with the masses 1 and 2/5,
/// K = \[\[1, -1\], \[-1, 2\]\] and C = K/10, decays slowest at the rate 0.0225 with the frequency 0.67. From slopes up to 0.1
/// on, 0.1 g/0.67 exp(-0.0225 * 200) of the velocity are left after half of the time, 8e-6 of g times the other half. The
/// plane is bent: after 3 d it is steeper by 6e-6.
const INCLINE: f64 = 1.5e-5;

/// a/g of a solid sphere on an incline of this slope that it overlaps: friction acts at the arm l = (1 - xi)/2, the rolling
/// couple is mu_r f_n/2.
fn acceleration(slope: f64, overlap: f64) -> f64 {
    let cosine = 1.0 / (1.0 + slope * slope).sqrt();
    let arm = 0.5 * (1.0 - overlap);
    let held = ROLLING.rolling_friction * 0.5 / arm;
    cosine * (slope - held).max(0.0) / (1.0 + 0.1 / (arm * arm))
}

pub(super) fn examine(circumstances: Circumstances<'_>) -> Result<Finding> {
    let mut finding = PROSE.described(&[]);
    let mut rows = Vec::new();
    for means in Means::INTEGRATORS {
        circumstances.go_on()?;
        let name = means.name();
        for slope in SLOPES {
            let throw = Throw {
                slope,
                speed: 0.0,
                ..THROW
            };
            let expected = acceleration(slope, throw.overlap());
            let found = throw.late_acceleration(means, TIME_STEP, DURATION)?;
            let setting = format!("tan(theta) = {slope}, {name}");
            let quantity = "a/g from rest on an incline";
            let check = Check::absolute(quantity, &setting, expected, found, INCLINE);
            finding.checks.push(check.by("held, or rolling"));
            if means == Means::USUAL {
                rows.push((slope, found));
            }
        }
        let slowed = -THROW.late_acceleration(means, TIME_STEP, DURATION)?;
        let expected = 5.0 / 7.0 * ROLLING.rolling_friction;
        let quantity = "deceleration of a sphere that rolls on a plane, over g";
        let check = Check::relative(quantity, name, expected, slowed, 5e-3);
        finding.checks.push(check.by("5/7 mu_r"));
    }
    finding.data = Columns::of(&rows)
        .number("slope", "1", "tan(theta)", |row| row.0)
        .number("acceleration", "1", "a/g", |row| row.1)
        .data()?;
    finding.figures = vec![PROSE.chart("rolling-resistance", &[], drawing(&rows))?];
    Ok(finding)
}

fn drawing(rows: &[(f64, f64)]) -> ChartFigure {
    let slopes: Vec<f64> = (0..=90_u32).map(|step| 0.01 * f64::from(step)).collect();
    let rolls = closed_form("closed form", &slopes, |slope| acceleration(slope, 0.0));
    let panel = ChartPanel::new("slope tan *θ*", "acceleration *a*/*g*")
        .x_range(0.0..=0.9)
        .y_range(-0.02..=0.45)
        .with(rolls)
        .with(Reference::vertical(ROLLING.rolling_friction).label("*μ*_{r}"))
        .with(points("a sphere from rest", rows, |row| *row).series(0));
    ChartFigure::new(panel)
}
