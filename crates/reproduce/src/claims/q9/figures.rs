//! Figures of Q9: the characteristic curves of the pumps, and what acts on their walls.

use peristalsis_figures::chart::{
    Band, ChartFigure, ChartPanel, LegendPlace, Line, Pattern, Points, Reference, Tint,
};
use peristalsis_figures::{Quantity as Axis, Scale, Units, Width};
use peristalsis_formats::Table;

use super::{Characteristic, Pump, WAVEFORMS, Working};
use crate::error::ClaimError;
use crate::finding::ReportFigure;
use crate::rows::Mean;

/// Loads at which the curves of a Newtonian fluid are drawn.
const LOADS: i32 = 100;
/// What every panel says of the fluid.
const FLUID: &str = "Newtonian fluid";
/// Lowest flow that is drawn: grains that fall back go beyond.
const LEAST_FLOW: f64 = -0.5;

/// Label of an axis for a pump, in its units.
type Label = fn(&Pump<'_>) -> String;

/// All figures, the most important first.
pub(super) fn all(pumps: &[Pump<'_>]) -> Result<Vec<ReportFigure>, ClaimError> {
    let mut figures = vec![characteristic(pumps)?];
    figures.extend(on_the_wall(pumps)?);
    Ok(figures)
}

/// Flow, efficiency and dispersion against the back pressure, a column a pump.
fn characteristic(pumps: &[Pump<'_>]) -> Result<ReportFigure, ClaimError> {
    let mut panels = Vec::new();
    for pump in pumps {
        let panel = ChartPanel::new("", &Axis::FlowRateRatio.label(Units::Linear))
            .title(pump.model.name)
            .y_range(LEAST_FLOW..=1.1)
            .with(Reference::horizontal(0.0));
        panels.push(with_fluid(
            with_series(panel, pump, |point| Some(point.flow)),
            pump,
            |load| Some(pump.newtonian(load)?.flow_rate_ratio()),
        ));
    }
    for pump in pumps {
        let panel = ChartPanel::new("", "efficiency, *η*").y_range(0.0..=1.0);
        let pumps_along = |point: &Working<'_>| {
            point
                .efficiency
                .filter(|_| point.flow.value > 0.0)
                // Nothing is done against no pressure.
                .or((point.pressure == 0.0).then_some(Mean {
                    value: 0.0,
                    error: 0.0,
                    runs: 0,
                }))
        };
        panels.push(with_fluid(
            with_series(panel, pump, pumps_along),
            pump,
            |load| match load {
                // Nothing is done against no pressure.
                0.0 => Some(0.0),
                load => pump.newtonian(load)?.efficiency(),
            },
        ));
    }
    for pump in pumps {
        let panel = ChartPanel::new(
            &format!("pressure rise, Δ*p*{}", pump.model.per_unit),
            "dispersion, *D*/*cλ*",
        )
        .y_scale(Scale::Logarithmic);
        panels.push(with_series(panel, pump, |point| {
            point
                .dispersion
                .filter(|dispersion| dispersion.value > 0.0 && point.flow.value > 0.0)
        }));
    }
    Ok(ReportFigure {
        name: "pump-characteristic".to_owned(),
        caption: "The characteristic curves of the pumps: flow, efficiency and axial dispersion against the pressure rise over a \
                  wavelength. The line of the Newtonian fluid is that of the sine, with a viscosity such that it stops where the \
                  grains turn round; below −0.5 the flow is not drawn."
            .to_owned(),
        drawing: ChartFigure::grid(pumps.len(), panels)
            .width(Width::DoubleColumn)
            .panel_height(38.0)
            .share_x()
            .legend(LegendPlace::Below)
            .description("Flow, efficiency and dispersion against back pressure for both models and three waveforms.")
            .draw()?,
    })
}

/// A series for each waveform.
fn with_series(
    mut panel: ChartPanel,
    pump: &Pump<'_>,
    value: impl Fn(&Working<'_>) -> Option<Mean>,
) -> ChartPanel {
    let largest = pump
        .characteristics
        .iter()
        .flat_map(|one| &one.points)
        .map(|point| point.pressure)
        .fold(0.0, f64::max);
    if largest > 0.0 {
        panel = panel.x_range(-0.02 * largest..=1.04 * largest);
    }
    let mut is_empty = true;
    for one in &pump.characteristics {
        let known: Vec<(f64, Mean)> = one
            .points
            .iter()
            .filter_map(|point| Some((point.pressure, value(point)?)))
            .collect();
        if known.is_empty() {
            continue;
        }
        let x: Vec<f64> = known.iter().map(|one| one.0).collect();
        let y: Vec<f64> = known.iter().map(|one| one.1.value).collect();
        let error: Vec<f64> = known.iter().map(|one| one.1.error).collect();
        let series = WAVEFORMS.iter().position(|name| *name == one.waveform);
        let points = Points::new(one.waveform, &x, &y)
            .y_errors(&error)
            .series(series.unwrap_or(0))
            .joined();
        panel = panel.with(points);
        is_empty = false;
    }
    if is_empty {
        // An empty panel has a range to itself, whatever its scale.
        panel = panel.y_range(0.01..=1.0);
    }
    panel
}

/// The curve of a Newtonian fluid that stops where the grains turn round.
fn with_fluid(
    panel: ChartPanel,
    pump: &Pump<'_>,
    value: impl Fn(f64) -> Option<f64>,
) -> ChartPanel {
    let Some(stop) = pump.sine().and_then(Characteristic::stop) else {
        return panel;
    };
    let (x, y): (Vec<f64>, Vec<f64>) = (0..=LOADS)
        .filter_map(|part| {
            let load = f64::from(part) / f64::from(LOADS);
            Some((load * stop.value, value(load)?))
        })
        .unzip();
    if x.len() < 2 {
        return panel;
    }
    panel.with(
        Line::new(FLUID, &x, &y)
            .tint(Tint::Black)
            .pattern(Pattern::Dashed),
    )
}

/// Radius, pressure and shear against the phase of the wave, a column a pump, without back pressure and against the largest
/// that it still pumps against; `None` where no profile is at hand.
fn on_the_wall(pumps: &[Pump<'_>]) -> Result<Option<ReportFigure>, ClaimError> {
    let mut columns: Vec<(&Pump<'_>, Vec<(String, Table)>)> = Vec::new();
    for pump in pumps {
        let mut profiles = Vec::new();
        let Some(sine) = pump.sine() else { continue };
        let last = sine.last().filter(|point| point.pressure > 0.0);
        for point in sine.points.first().into_iter().chain(last) {
            for row in &point.rows {
                if let Some(profile) = pump.results.profile_of(row)? {
                    let name = if point.pressure == 0.0 {
                        "Δ*p* = 0".to_owned()
                    } else {
                        "largest Δ*p* pumped against".to_owned()
                    };
                    profiles.push((name, profile));
                    break;
                }
            }
        }
        if !profiles.is_empty() {
            columns.push((pump, profiles));
        }
    }
    if columns.is_empty() {
        return Ok(None);
    }
    let quantities: [(&str, Label); 3] = [
        ("radius", |_| "radius, *R*/*d*".to_owned()),
        ("wall_pressure", |pump| {
            format!("pressure, *p*{}", pump.model.per_unit)
        }),
        ("wall_shear", |pump| {
            format!("shear, *τ*{}", pump.model.per_unit)
        }),
    ];
    let mut panels = Vec::new();
    for (row, (column, label)) in quantities.iter().enumerate() {
        for (pump, profiles) in &columns {
            let last = row + 1 == quantities.len();
            let x_label = if last {
                Axis::Phase.label(Units::Linear)
            } else {
                String::new()
            };
            let mut panel = ChartPanel::new(&x_label, &label(pump)).x_range(0.0..=1.0);
            if row == 0 {
                panel = panel.title(pump.model.name);
            }
            if *column == "wall_shear" {
                panel = panel.with(Reference::horizontal(0.0));
            }
            for (series, (name, profile)) in profiles.iter().enumerate() {
                let position = profile.reals("position")?;
                let value = profile.reals(column)?;
                panel = panel.with(Line::new(name, position, value).series(series));
                if let Ok(error) = profile.reals(&format!("{column}_error")) {
                    let end = |sign: f64| -> Vec<f64> {
                        value.iter().zip(error).map(|(v, e)| v + sign * e).collect()
                    };
                    panel =
                        panel.with(Band::new("", position, &end(-1.0), &end(1.0)).series(series));
                }
            }
            panels.push(panel);
        }
    }
    Ok(Some(ReportFigure {
        name: "pump-wall".to_owned(),
        caption: "Radius of the tube, pressure and shear on its wall against the phase of the wave, the sine; bands are standard \
                  errors. The wave runs to the right; shear is positive along it."
            .to_owned(),
        drawing: ChartFigure::grid(columns.len(), panels)
            .width(Width::DoubleColumn)
            .panel_height(32.0)
            .share_x()
            .legend(LegendPlace::Below)
            .description("Radius, pressure and shear against phase for both models.")
            .draw()?,
    }))
}
