//! Figures of Q6: the flow against what might cause its turning back, and the momentum balance against the position.

use peristalsis_figures::chart::{Corner, Note};

use super::{PINNED, PRESET, Point, Sampled, Samples};
use crate::claims::elastic::label;
use crate::claims::prelude::*;

/// Where a wall without a tether stands on the logarithmic axis.
const FREE_TETHER: f64 = 3e-4;

/// A value of some samples against one of what is varied; `None` where none has it.
fn series<'a: 'b, 'b>(
    name: &str,
    samples: impl Iterator<Item = &'b Sampled<'a>>,
    x: fn(&Point) -> f64,
    y: impl Fn(&Sampled<'_>) -> Option<Uncertain>,
) -> Option<Points> {
    joined(
        name,
        samples.filter_map(|one| Some((x(&one.point), y(one)?))),
    )
}

/// The flow against friction, tether and strain rate, and the forces of the wall against friction.
pub(super) fn causes(draft: &mut Draft, samples: &Samples<'_>) -> Result<()> {
    let panel = |x: &str, y: &str| ChartPanel::new(x, y).with(Reference::horizontal(0.0));
    let flow_panel = |x: &str| panel(x, &label(Axis::FlowRateRatio));
    let flow = |one: &Sampled<'_>| Some(one.flow);
    let of_friction = series("", samples.friction(), |point| point.friction, flow);
    let friction = flow_panel(&label(Axis::StaticFriction)).with_all(numbered([of_friction]));
    let of_tether = series(
        "",
        samples.tether(),
        |point| point.tether.max(FREE_TETHER),
        flow,
    );
    let tether = flow_panel("axial tether of the wall, *k*_{z}/*Yd*")
        .with_all(numbered([of_tether]))
        .x_scale(Scale::Logarithmic)
        .x_range(1.5e-4..)
        .with(Reference::vertical(FREE_TETHER).label("free"));
    let of_rate = [("preset", PRESET.tether), ("wall pinned", PINNED)]
        .map(|(name, tether)| series(name, samples.rate(tether), |point| point.rate, flow));
    let rate = flow_panel(&label(Axis::StrainRate))
        .with_all(numbered(of_rate))
        .x_scale(Scale::Logarithmic);
    let force = |name: &str, force: fn(&Sampled<'_>) -> Option<Uncertain>| {
        series(name, samples.friction(), |point| point.friction, force)
    };
    let forces = [
        force("normal", |one| one.force("wall_normal_force")),
        force("friction, front", |one| one.force("front_tangential_force")),
        force("friction, rear", |one| {
            one.rest("wall_tangential_force", "front_tangential_force")
        }),
    ];
    let of_wall = "force of the wall, 10^{3}*F*/*Yd*^{2}";
    let forces = panel(&label(Axis::StaticFriction), of_wall).with_all(numbered(forces));
    let panels = [friction, tether, rate, forces];
    let chart = grid(2, panels);
    let (friction, tether, rate) = (PRESET.friction, PRESET.tether, PRESET.rate);
    draft.chart("cause-of-back-flow", values!(friction, tether, rate), chart)
}

/// Radius, velocities and forces against the position in the wave frame, with and without friction; `None` where no profile is at hand.
pub(super) fn balance(
    draft: &mut Draft,
    results: &StudyResults,
    samples: &Samples<'_>,
) -> Result<()> {
    let mut columns = Vec::new();
    for friction in [PRESET.friction, 0.0] {
        let Some(one) = samples.at(Point { friction, ..PRESET }) else {
            continue;
        };
        if let Some((row, profile)) =
            first_kept(&one.rows, |row| results.product(row, files::PROFILE))?
        {
            columns.push(column(friction, row.wave_speed(), &profile)?);
        }
    }
    let Some([radius, ..]) = columns.first_mut() else {
        return Ok(());
    };
    *radius = radius
        .clone()
        .with(Note::corner(Corner::BottomLeft, "wave →"));
    let panels = (0..3).flat_map(|row| columns.iter().map(move |column| column[row].clone()));
    let chart = grid(columns.len(), panels)
        .panel_height(34.0)
        .share_x()
        .legend(LegendPlace::Below);
    draft.chart("axial-balance", &[], chart)
}

/// Radius, velocities and forces against the position in the wave frame, of one run.
fn column(friction: f64, wave_speed: f64, profile: &Table) -> Result<[ChartPanel; 3]> {
    let position = profile.reals("position")?;
    let scaled = |name: &str, factor: f64| -> Result<Vec<f64>> {
        let values = profile.reals(name)?;
        Ok(values.iter().map(|value| factor * value).collect())
    };
    let panel = |x_label: &str, y_label: &str| ChartPanel::new(x_label, y_label).x_range(0.0..=1.0);
    let radius = panel("", "radius, *R*/*d*")
        .title(&format!("*μ*_{{s}} = {friction}"))
        .with(Curve::new("", position, profile.reals("radius")?).series(6));
    let grains = scaled("axial_velocity", 1.0 / wave_speed)?;
    let wall = scaled("wall_axial_velocity", 1.0 / wave_speed)?;
    let velocity = panel("", &label(Axis::AxialVelocity))
        .with(Reference::horizontal(0.0))
        .with(Curve::new("grains", position, &grains).series(0))
        .with(
            Curve::new("wall", position, &wall)
                .series(4)
                .pattern(Pattern::Dashed),
        );
    let mut forces = panel(&label(Axis::Position), "force per length, 10^{3}*f*/*Yd*")
        .with(Reference::horizontal(0.0));
    let kinds = [
        ("normal", "wall_normal_force"),
        ("friction", "wall_tangential_force"),
    ];
    for (number, (name, column)) in kinds.into_iter().enumerate() {
        let (value, error) = (
            scaled(column, 1e3)?,
            scaled(&format!("{column}_error"), 1e3)?,
        );
        let points = Points::new(name, position, &value).y_errors(&error);
        forces = forces.with(points.series(number).joined());
    }
    Ok([radius, velocity, forces])
}
