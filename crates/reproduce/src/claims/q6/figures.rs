//! Figures of Q6: the flow against what might cause its turning back, and the momentum balance against the phase.

use peristalsis_figures::chart::{
    ChartFigure, ChartPanel, Corner, LegendPlace, Line, Note, Pattern, Points, Reference,
};
use peristalsis_figures::{Quantity as Axis, Scale, Units, Width};

use super::{FRICTION, PINNED, PRESET, Point, Sampled, Samples};
use crate::error::ClaimError;
use crate::evidence::StudyResults;
use crate::finding::ReportFigure;
use crate::rows::Mean;

/// Where a wall without a tether stands on the logarithmic axis.
const FREE_TETHER: f64 = 3e-4;

/// All figures, the most important first.
pub(super) fn all(
    results: &StudyResults,
    samples: &Samples<'_>,
) -> Result<Vec<ReportFigure>, ClaimError> {
    let mut figures = vec![causes(samples)?];
    figures.extend(balance(results, samples)?);
    Ok(figures)
}

fn label(axis: Axis) -> String {
    axis.label(Units::Hertz)
}

/// Points with errors, joined.
fn series<'a>(
    name: &str,
    number: usize,
    sampled: impl IntoIterator<Item = &'a (f64, Mean)>,
) -> Points {
    let known: Vec<&(f64, Mean)> = sampled.into_iter().collect();
    let column = |value: fn(&(f64, Mean)) -> f64| -> Vec<f64> {
        known.iter().map(|one| value(one)).collect()
    };
    Points::new(name, &column(|one| one.0), &column(|one| one.1.value))
        .y_errors(&column(|one| one.1.error))
        .series(number)
        .joined()
}

/// The flow against friction, tether and strain rate, and the forces of the wall against friction.
fn causes(samples: &Samples<'_>) -> Result<ReportFigure, ClaimError> {
    let flows = |sampled: Vec<&Sampled<'_>>, x: fn(&Point) -> f64| -> Vec<(f64, Mean)> {
        sampled
            .iter()
            .map(|one| (x(&one.point), one.flow))
            .collect()
    };
    let flow = |x_label: &str| {
        ChartPanel::new(x_label, &label(Axis::FlowRateRatio)).with(Reference::horizontal(0.0))
    };
    let friction = flow(&label(Axis::StaticFriction)).with(series(
        "",
        0,
        &flows(samples.friction(), |point| point.friction),
    ));
    let tether = flow("axial tether of the wall, *k*_{z}/*Yd*")
        .x_scale(Scale::Logarithmic)
        .x_range(1.5e-4..)
        .with(series(
            "",
            0,
            &flows(samples.tether(), |point| point.tether.max(FREE_TETHER)),
        ))
        .with(Reference::vertical(FREE_TETHER).label("free"));
    let mut rate = flow(&label(Axis::StrainRate)).x_scale(Scale::Logarithmic);
    for (number, (name, tether)) in [("preset", PRESET.tether), ("wall pinned", PINNED)]
        .into_iter()
        .enumerate()
    {
        let known = flows(samples.rate(tether), |point| point.rate);
        if !known.is_empty() {
            rate = rate.with(series(name, number, &known));
        }
    }
    let mut forces = ChartPanel::new(
        &label(Axis::StaticFriction),
        "force of the wall, 10^{3}*F*/*Yd*^{2}",
    )
    .with(Reference::horizontal(0.0));
    let along = samples.friction();
    let force = |value: &dyn Fn(&Sampled<'_>) -> Option<Mean>| -> Vec<(f64, Mean)> {
        along
            .iter()
            .filter_map(|one| {
                let mean = value(one)?;
                let scaled = Mean {
                    value: 1e3 * mean.value,
                    error: 1e3 * mean.error,
                    ..mean
                };
                Some((one.point.friction, scaled))
            })
            .collect()
    };
    let tangential = "wall_tangential_force";
    let kinds: [(&str, Vec<(f64, Mean)>); 3] = [
        ("normal", force(&|one| one.force("wall_normal_force"))),
        (
            "friction, front",
            force(&|one| one.force("front_tangential_force")),
        ),
        (
            "friction, rear",
            force(&|one| one.rest(tangential, "front_tangential_force")),
        ),
    ];
    for (number, (name, known)) in kinds.iter().enumerate() {
        if !known.is_empty() {
            forces = forces.with(series(name, number, known));
        }
    }
    Ok(ReportFigure {
        name: "cause-of-back-flow".to_owned(),
        caption: format!(
            "Flow at *f*^{{P}} = 0.002 *Y d*^2 from rest against (a) friction, (b) the axial tether of the wall, (c) the strain rate; \
             (d) axial force of the wall on the grains of a wavelength. What is not varied is *μ*_{{s}} = {}, a tether of {} *Y d* \
             and *ε̇* = {}/*t*^{{\\*}}.",
            PRESET.friction, PRESET.tether, PRESET.rate
        ),
        drawing: ChartFigure::grid(2, [friction, tether, rate, forces])
            .width(Width::DoubleColumn)
            .description("Flow against friction, tether and strain rate; forces of the wall against friction.")
            .draw()?,
    })
}

/// Radius, velocities and forces against the phase, with and without friction; `None` where no profile is at hand.
fn balance(
    results: &StudyResults,
    samples: &Samples<'_>,
) -> Result<Option<ReportFigure>, ClaimError> {
    let mut columns = Vec::new();
    for friction in [PRESET.friction, 0.0] {
        let Some(one) = samples.at(Point { friction, ..PRESET }) else {
            continue;
        };
        for row in &one.rows {
            if let Some(profile) = results.profile_of(row)? {
                columns.push((row.number(FRICTION), row.wave_speed(), profile));
                break;
            }
        }
    }
    if columns.is_empty() {
        return Ok(None);
    }
    let mut rows: [Vec<ChartPanel>; 3] = Default::default();
    for (friction, wave_speed, profile) in &columns {
        let position = profile.reals("position")?;
        let scaled = |name: &str, factor: f64| -> Result<Vec<f64>, ClaimError> {
            let values = profile.reals(name)?;
            Ok(values.iter().map(|value| factor * value).collect())
        };
        let radius = ChartPanel::new("", "radius, *R*/*d*")
            .title(&format!("*μ*_{{s}} = {friction}"))
            .x_range(0.0..=1.0)
            .with(Line::new("", position, profile.reals("radius")?).series(6));
        rows[0].push(radius);
        let velocity = ChartPanel::new("", &label(Axis::AxialVelocity))
            .x_range(0.0..=1.0)
            .with(Reference::horizontal(0.0))
            .with(
                Line::new(
                    "grains",
                    position,
                    &scaled("axial_velocity", 1.0 / wave_speed)?,
                )
                .series(0),
            )
            .with(
                Line::new(
                    "wall",
                    position,
                    &scaled("wall_axial_velocity", 1.0 / wave_speed)?,
                )
                .series(4)
                .pattern(Pattern::Dashed),
            );
        rows[1].push(velocity);
        let mut forces = ChartPanel::new(&label(Axis::Phase), "force per length, 10^{3}*f*/*Yd*")
            .x_range(0.0..=1.0)
            .with(Reference::horizontal(0.0));
        for (number, (name, column)) in [
            ("normal", "wall_normal_force"),
            ("friction", "wall_tangential_force"),
        ]
        .into_iter()
        .enumerate()
        {
            let (value, error) = (
                scaled(column, 1e3)?,
                scaled(&format!("{column}_error"), 1e3)?,
            );
            forces = forces.with(
                Points::new(name, position, &value)
                    .y_errors(&error)
                    .series(number)
                    .joined(),
            );
        }
        rows[2].push(forces);
    }
    rows[0][0] = rows[0][0]
        .clone()
        .with(Note::corner(Corner::BottomLeft, "wave →"));
    Ok(Some(ReportFigure {
        name: "axial-balance".to_owned(),
        caption: "Radius of the tube, axial velocities of grains and wall, and axial force of the wall on the grains per length of \
                  tube, along normals of contacts and by friction, in the wave frame. The wave runs to the right: the front of the \
                  throat is at its right, and grains go through the picture from right to left."
            .to_owned(),
        drawing: ChartFigure::grid(columns.len(), rows.into_iter().flatten())
            .width(Width::DoubleColumn)
            .panel_height(34.0)
            .share_x()
            .legend(LegendPlace::Below)
            .description("Radius, velocities and forces against phase with and without friction.")
            .draw()?,
    }))
}
