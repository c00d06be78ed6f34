//! Restitution of normal impacts against damping.

use core::f64::consts::PI;

use glam::DVec3;
use peristalsis_figures::chart::{ChartFigure, ChartPanel, Line};
use peristalsis_figures::{Drawing, FigureError, Width};
use peristalsis_physics::contact::{LinearSpringDashpot, Normal};

use super::errors::{FINE, impact_convergences, kernels_agree, measured_restitution};
use super::material::{ALUMINIUM_OXIDE, ALUMINIUM_OXIDE_SPEED};
use super::plot::{curve, points};
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

const PROSE: Prose = Prose::new(include_str!("restitution.md"));

pub(super) const CASE: Case = Case {
    name: "restitution",
    prose: PROSE,
    examine,
};

/// Restitutions of the impacts.
const WANTED: [f64; 5] = [0.2, 0.4, 0.6, 0.8, 1.0];
/// The one of them at which kernels and steps are compared.
const EXAMPLE: f64 = 0.6;

/// Two grains of mass 1 under the linear law, k = 1.
fn linear(damping: f64) -> (LinearSpringDashpot, Impact) {
    let law = LinearSpringDashpot {
        normal_stiffness: 1.0,
        normal_damping: damping,
    };
    (law, Impact::of_twins(smooth(Normal::Linear(law)), 0.05))
}

/// The damping of that law for a restitution: e = exp(-pi eta/sqrt(2 - eta^2)).
pub(super) fn linear_damping(restitution: f64) -> f64 {
    let ratio = -libm::log(restitution) / PI;
    (2.0 * ratio * ratio / (1.0 + ratio * ratio)).sqrt()
}

/// A sphere of aluminium oxide on a plane.
fn viscoelastic(dissipation_time: f64) -> Impact {
    let speed = ALUMINIUM_OXIDE_SPEED / ALUMINIUM_OXIDE.speed();
    let law = ALUMINIUM_OXIDE.against_rigid(dissipation_time);
    Impact::on_plane(smooth(Normal::Hertz(law)), DVec3::new(-speed, 0.0, 0.0))
}

/// e by the equation of motion.
pub(super) fn integrated(impact: &Impact) -> f64 {
    impact.restitution(outcome(impact).velocity)
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
        if integrated(&impact(middle)) > wanted {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// Root mean square restitution of two grains under the linear law with exactly so many steps in a contact, over places of
/// the onset within a step: the restitution of a gas of them.
pub(super) fn measured_with(damping: f64, steps: f64) -> Result<f64, ClaimError> {
    const PLACES: usize = 16;
    let (law, impact) = linear(damping);
    let time_step = law.contact_time(0.5) / steps;
    let mut sum = 0.0;
    for place in 0..PLACES {
        let phase = (place as f64 + 0.5) / PLACES as f64;
        let rebound = impact.simulate(Means::USUAL, time_step, phase)?;
        sum += impact.restitution(rebound.velocity).powi(2);
    }
    Ok((sum / PLACES as f64).sqrt())
}

/// An impact with its reference.
struct Row {
    law: &'static str,
    damping: f64,
    impact: Impact,
    /// Duration of the undamped contact, which sets the step.
    contact_time: f64,
    expected: f64,
    found: f64,
}

impl Row {
    fn measure(
        law: &'static str,
        damping: f64,
        impact: Impact,
        contact_time: f64,
        expected: f64,
    ) -> Result<Self, ClaimError> {
        Ok(Self {
            law,
            damping,
            impact,
            contact_time,
            expected,
            found: measured_restitution(&impact, contact_time, FINE)?,
        })
    }

    fn of_linear_law(wanted: f64) -> Result<Self, ClaimError> {
        let (law, impact) = linear(linear_damping(wanted));
        let contact_time = PI / 2.0_f64.sqrt();
        let expected = law.restitution(0.5);
        Self::measure("linear", law.normal_damping, impact, contact_time, expected)
    }

    fn of_hertz_law(wanted: f64) -> Result<Self, ClaimError> {
        let elastic = HertzImpact::of(&ALUMINIUM_OXIDE.against_rigid(0.0), &viscoelastic(0.0));
        let contact_time = elastic.contact_time();
        let time = dissipation_time(wanted, contact_time, viscoelastic);
        let impact = viscoelastic(time);
        Self::measure("hertz", time, impact, contact_time, integrated(&impact))
    }
}

/// The experiment under one law.
struct Series {
    name: &'static str,
    setting: &'static str,
    reference: &'static str,
    tolerance: f64,
    expected_order: [f64; 2],
    measure: fn(f64) -> Result<Row, ClaimError>,
}

const SERIES: [Series; 2] = [
    Series {
        name: "linear law",
        setting: "linear law, two grains",
        reference: "closed form",
        tolerance: 4e-3,
        expected_order: [0.7, 1.4],
        measure: Row::of_linear_law,
    },
    Series {
        name: "Hertz law",
        setting: "Hertz law, sphere on a plane",
        reference: "equation of motion",
        tolerance: 2e-3,
        expected_order: [1.3, 2.4],
        measure: Row::of_hertz_law,
    },
];

fn examine(circumstances: Circumstances<'_>) -> Result<Finding, ClaimError> {
    let mut finding = Finding::described(&PROSE, &[]);
    let mut rows: Vec<Row> = Vec::new();
    for series in &SERIES {
        for wanted in WANTED {
            circumstances.go_on()?;
            let row = (series.measure)(wanted)?;
            let check = Check::absolute(
                "restitution",
                series.setting,
                row.expected,
                row.found,
                series.tolerance,
            );
            finding.checks.push(check.by(series.reference));
            if wanted == EXAMPLE {
                let setting = format!("{}, e = {wanted}", series.setting);
                let agree = kernels_agree(&setting, &row.impact, row.contact_time / FINE)?;
                finding.checks.push(agree);
                finding.convergences.extend(impact_convergences(
                    ("restitution", &format!("{}, e = {wanted}", series.name)),
                    &row.impact,
                    row.contact_time,
                    series.expected_order,
                    |rebound| row.impact.restitution(rebound.velocity) / row.expected - 1.0,
                )?);
            }
            rows.push(row);
        }
    }
    finding.figures = vec![PROSE.figure("restitution", &[], drawing(&rows)?)];
    finding.data = Some(
        Columns::of(&rows)
            .word("law", "normal law", |row| row.law.to_owned())
            .number("damping", "m/t or t", "eta, or A", |row| row.damping)
            .number("expected", "", "restitution", |row| row.expected)
            .number("found", "", "restitution", |row| row.found)
            .table()?,
    );
    Ok(finding)
}

fn drawing(rows: &[Row]) -> Result<Drawing, FigureError> {
    let (linear_rows, hertz_rows) = rows.split_at(WANTED.len());
    let upto = |rows: &[Row], number| {
        let largest = rows.iter().map(|row| row.damping).fold(0.0, f64::max);
        spaced(0.0, 1.15 * largest, number)
    };
    let panel = |damping: &str, title: &str| {
        ChartPanel::new(damping, "restitution *e*")
            .title(title)
            .y_range(0.0..=1.05)
    };
    let closed_form = |eta| linear(eta).0.restitution(0.5);
    let contact_time = hertz_rows[0].contact_time;
    let times = upto(hertz_rows, 40);
    let scaled: Vec<f64> = times.iter().map(|time| time / contact_time).collect();
    let equation: Vec<f64> = times
        .iter()
        .map(|time| integrated(&viscoelastic(*time)))
        .collect();
    let panels = [
        panel("damping *η* / √(*mk*)", "linear law")
            .with(curve("closed form", &upto(linear_rows, 80), closed_form).series(0))
            .with(points("engine", linear_rows, |row| (row.damping, row.found)).series(1)),
        panel("dissipation time *A*/*t*_{c}", "Hertz law")
            .with(Line::new("equation of motion", &scaled, &equation).series(0))
            .with(
                points("engine", hertz_rows, |row| {
                    (row.damping / contact_time, row.found)
                })
                .series(1),
            ),
    ];
    ChartFigure::grid(2, panels)
        .description(
            "Restitution falls with damping; the engine's points lie on the curves of the references.",
        )
        .width(Width::DoubleColumn)
        .panel_height(52.0)
        .draw()
}
