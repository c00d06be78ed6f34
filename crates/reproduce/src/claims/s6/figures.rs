//! The figure of S6: profiles of the flows that are compared.

use crate::claims::elastic::label;
use crate::claims::elastic::*;
use crate::claims::prelude::*;

/// A profile about the throat: place, density over its mean, v/c, T/(m c^2), each with its error.
struct Curves {
    name: String,
    place: Vec<f64>,
    columns: Vec<[Vec<f64>; 2]>,
}

impl Curves {
    /// The profile of one run, the throat in the middle; `None` where it was not kept.
    fn of(name: String, study: &StudyResults, row: &Row<'_>) -> Result<Option<Self>> {
        let Some(table) = study.product(row, files::PROFILE)? else {
            return Ok(None);
        };
        let radius = table.reals("radius")?;
        let bins = radius.len();
        let throat = (0..bins)
            .min_by(|&one, &other| radius[one].total_cmp(&radius[other]))
            .unwrap_or(0);
        let speed = row.wave_speed();
        let density = table.reals("density")?;
        let mean = density.iter().sum::<f64>() / bins.max(1) as f64;
        let order = |k: usize| (throat + k + bins - bins / 2) % bins;
        let column = |name: &str, unit: f64| -> Result<Vec<f64>> {
            let values = table.reals(name)?;
            Ok((0..bins).map(|k| values[order(k)] / unit).collect())
        };
        let units = [
            ("density", mean),
            ("axial_velocity", speed),
            ("granular_temperature", speed * speed),
        ];
        let mut columns = Vec::new();
        for (name, unit) in units {
            let error = column(&format!("{name}_error"), unit)?;
            columns.push([column(name, unit)?, error]);
        }
        let place = |k: usize| (k as f64 - (bins / 2) as f64) / bins as f64;
        Ok(Some(Self {
            name,
            place: (0..bins).map(place).collect(),
            columns,
        }))
    }
}

/// One run of each flow: of frictional grains at the smallest force, of frictionless ones in the same tube, and between
/// prescribed walls.
fn curves(elastic: &StudyResults, prescribed: &StudyResults) -> Result<Vec<Curves>> {
    let is_unjammed = |row: &Row<'_>| row.flow_rate_ratio() < UNJAMMED;
    let rows = elastic.rows();
    let frictional = rows
        .iter()
        .filter(|row| is_unjammed(row) && !is_frictionless(row))
        .min_by(|one, other| one.force().total_cmp(&other.force()))
        .map(|row| (format!("frictional, *f*^{{P}} = {}", row.force()), row));
    let frictionless = rows
        .iter()
        .find(|row| is_frictionless(row))
        .map(|row| (format!("frictionless, *f*^{{P}} = {}", row.force()), row));
    let mut curves = Vec::new();
    for (name, row) in frictional.into_iter().chain(frictionless) {
        curves.extend(Curves::of(name, elastic, row)?);
    }
    for (rate, rows) in by_strain_rate(prescribed.rows()) {
        if let Some(row) = rows.iter().find(|row| is_unjammed(row)) {
            let name = format!("prescribed wall, *ε̇* = {rate}");
            curves.extend(Curves::of(name, prescribed, row)?);
        }
    }
    Ok(curves)
}

/// Profiles of one run of each flow; `None` where none is at hand.
pub(super) fn profiles(
    draft: &mut Draft,
    elastic: &StudyResults,
    prescribed: &StudyResults,
) -> Result<()> {
    let curves = curves(elastic, prescribed)?;
    if curves.is_empty() {
        return Ok(());
    }
    let panel = |label: &str| {
        ChartPanel::new("distance from the throat, *ζ*/*λ*", label).x_range(-0.5..=0.5)
    };
    let panels = [
        panel("grains per length, *n*_{1}*L*/*N*"),
        panel(&label(Axis::AxialVelocity)).with(Reference::horizontal(0.0)),
        panel("temperature, *T*_{g}/*mc*^{2}").y_scale(Scale::Logarithmic),
    ];
    let panels = panels.into_iter().enumerate().map(|(quantity, panel)| {
        let curves = curves.iter().enumerate();
        curves.fold(panel, |panel, (series, curve)| {
            let [value, error] = &curve.columns[quantity];
            panel
                .with(error_band(&curve.place, value, error).series(series))
                .with(Curve::new(&curve.name, &curve.place, value).series(series))
        })
    });
    let chart = grid(3, panels).legend(LegendPlace::Below);
    draft.chart("profiles", &[], chart)
}
