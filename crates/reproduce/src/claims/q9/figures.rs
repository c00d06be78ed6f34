//! Figures of Q9: the characteristic curves of the pumps, and what acts on their walls.

use super::{Pump, WAVEFORMS, dispersion, efficiency};
use crate::claims::prelude::*;

/// Loads at which the curves of a Newtonian fluid are drawn.
const LOADS: i32 = 100;
/// Lowest flow that is drawn: grains that fall back go beyond.
const LEAST_FLOW: f64 = -0.5;

/// Flow, efficiency and dispersion against the back pressure, a column a pump.
pub(super) fn characteristic(pumps: &[Pump<'_>]) -> ChartFigure {
    let panels = [flow_panel, efficiency_panel, dispersion_panel];
    let panels = panels.into_iter().flat_map(|panel| pumps.iter().map(panel));
    grid(pumps.len(), panels)
        .panel_height(38.0)
        .share_x()
        .legend(LegendPlace::Below)
}

fn flow_panel(pump: &Pump<'_>) -> ChartPanel {
    let panel = ChartPanel::new("", &label(Axis::FlowRateRatio))
        .title(pump.model.name)
        .y_range(LEAST_FLOW..=1.1)
        .with(Reference::horizontal(0.0));
    with_series(panel, pump, |point| Some(point.flow)).with_all(of_fluid(pump, |load| {
        Some(pump.newtonian(load)?.flow_rate_ratio())
    }))
}

/// Of grains there is none without a pressure; that of the fluid rises from 0.
fn efficiency_panel(pump: &Pump<'_>) -> ChartPanel {
    let panel = ChartPanel::new("", "efficiency, *η*").y_range(0.0..=1.0);
    let of_grains = |point: &Point<'_>| {
        let pumps = point.flow.value > 0.0 && point.control != 0.0;
        pumps.then(|| efficiency(point)).flatten()
    };
    with_series(panel, pump, of_grains).with_all(of_fluid(pump, |load| match load {
        0.0 => Some(0.0),
        load => pump.newtonian(load)?.efficiency(),
    }))
}

fn dispersion_panel(pump: &Pump<'_>) -> ChartPanel {
    let x_label = format!("pressure rise, Δ*p*{}", pump.model.units.per_pressure());
    let panel = ChartPanel::new(&x_label, "dispersion, *D*/*cλ*").y_scale(Scale::Logarithmic);
    with_series(panel, pump, |point| {
        dispersion(point).filter(|dispersion| dispersion.value > 0.0 && point.flow.value > 0.0)
    })
}

/// A series for each waveform.
fn with_series(
    mut panel: ChartPanel,
    pump: &Pump<'_>,
    value: impl Fn(&Point<'_>) -> Option<Uncertain>,
) -> ChartPanel {
    let all = pump
        .characteristics
        .iter()
        .flat_map(|one| &one.branch.points);
    let shown = all.filter(|point| point.flow.value >= LEAST_FLOW);
    let largest = shown.map(|point| point.control).fold(0.0, f64::max);
    if largest > 0.0 {
        panel = panel.x_range(-0.02 * largest..=1.1 * largest);
    }
    let series = pump.characteristics.iter().filter_map(|one| {
        let known = one.branch.points.iter();
        let known = known.filter_map(|point| Some((point.control, value(point)?)));
        let series = WAVEFORMS.iter().position(|name| *name == one.waveform)?;
        Some(joined(one.waveform, known)?.series(series))
    });
    let series: Vec<Points> = series.collect();
    if series.is_empty() {
        // An empty panel has a range to itself, whatever its scale.
        return panel.y_range(0.01..=1.0);
    }
    panel.with_all(series)
}

/// The curve of a Newtonian fluid that stops where the grains turn round.
fn of_fluid(pump: &Pump<'_>, value: impl Fn(f64) -> Option<f64>) -> Option<Curve> {
    let stop = pump.sine().stop()?.value;
    let loads = (0..=LOADS).map(|part| f64::from(part) / f64::from(LOADS));
    fluid(
        Tint::Black,
        loads.map(|load| Some((load * stop, value(load)?))),
    )
}

/// The profiles of the sine without back pressure and against the largest that it still pumps against, with their names.
fn profiles(pump: &Pump<'_>) -> Result<Vec<(&'static str, Table)>> {
    let mut profiles = Vec::new();
    let last = pump.sine().last().filter(|point| point.control > 0.0);
    for point in [pump.sine().free()].into_iter().chain(last) {
        let name = if point.control == 0.0 {
            "Δ*p* = 0"
        } else {
            "largest Δ*p* pumped against"
        };
        let kept = first_kept(&point.rows, |row| pump.results.product(row, files::PROFILE))?;
        profiles.extend(kept.map(|(_, profile)| (name, profile)));
    }
    Ok(profiles)
}

/// Radius, pressure and shear against the position in the wave frame, a column a pump; `None` where no profile is at hand.
pub(super) fn on_the_wall(draft: &mut Draft, pumps: &[Pump<'_>]) -> Result<()> {
    let mut columns = Vec::new();
    for pump in pumps {
        let profiles = profiles(pump)?;
        if !profiles.is_empty() {
            columns.push((pump, profiles));
        }
    }
    if columns.is_empty() {
        return Ok(());
    }
    let mut panels = Vec::new();
    for column in ["radius", "wall_pressure", "wall_shear"] {
        for (pump, profiles) in &columns {
            let unit = pump.model.units.per_pressure();
            let panel = match column {
                "radius" => ChartPanel::new("", "radius, *R*/*d*").title(pump.model.name),
                "wall_pressure" => ChartPanel::new("", &format!("pressure, *p*{unit}")),
                _ => ChartPanel::new(&label(Axis::Position), &format!("shear, *τ*{unit}"))
                    .with(Reference::horizontal(0.0)),
            };
            panels.push(with_profiles(panel, profiles, column)?);
        }
    }
    let chart = grid(columns.len(), panels)
        .panel_height(32.0)
        .share_x()
        .legend(LegendPlace::Below);
    draft.chart("pump-wall", &[], chart)
}

/// A column of each profile against the position in the wave frame, with bands where it has errors.
fn with_profiles(
    panel: ChartPanel,
    profiles: &[(&str, Table)],
    column: &str,
) -> Result<ChartPanel> {
    let mut panel = panel.x_range(0.0..=1.0);
    for (series, (name, profile)) in profiles.iter().enumerate() {
        let (position, value) = (profile.reals("position")?, profile.reals(column)?);
        panel = panel.with(Curve::new(name, position, value).series(series));
        if let Ok(error) = profile.reals(&format!("{column}_error")) {
            panel = panel.with(error_band(position, value, error).series(series));
        }
    }
    Ok(panel)
}
