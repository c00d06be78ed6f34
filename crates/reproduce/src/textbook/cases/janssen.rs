//! Janssen's silo: what the floor bears of a column with friction at the wall.

use peristalsis_analysis::mean_and_error;
use peristalsis_figures::chart::{ChartFigure, ChartPanel, Tint};

use super::plot::{closed_form, curve, named_once, open_if, points};
use crate::columns::Columns;
use crate::error::Result;
use crate::exhibit::spaced;
use crate::textbook::case::Circumstances;
use crate::textbook::experiment::column::{BORE, Column, Load};
use crate::{Check, Finding, Prose};

pub(super) const PROSE: Prose = Prose::new(include_str!("janssen.md"));

/// mu at which the grains at the wall slide.
const SLIDING: f64 = 0.1;
/// mu of grains and wall; at the other many roll.
const FRICTIONS: [f64; 2] = [SLIDING, 0.3];
/// Part by which an apparent mass and a length may differ from Janssen's: his K is not the same at all heights.
const ALLOWED: f64 = 0.1;

/// A column with its load.
struct Row {
    column: Column,
    load: Load,
}

/// M_app, from M and M_sat.
fn janssen(filling: f64, saturation: f64) -> f64 {
    -saturation * libm::expm1(-filling / saturation)
}

/// M_sat of these columns: least squares of M_app.
fn saturation(rows: &[&Row]) -> f64 {
    let largest = rows.iter().map(|row| row.load.filling).fold(0.0, f64::max);
    let residual = |saturation: f64| -> f64 {
        let apart = |row: &&Row| row.load.apparent - janssen(row.load.filling, saturation);
        rows.iter().map(|row| apart(row).powi(2)).sum()
    };
    // Golden section.
    let (mut low, mut high) = (0.01 * largest, 100.0 * largest);
    let part = 0.5 * (5.0_f64.sqrt() - 1.0);
    for _ in 0..80 {
        let [one, other] = [high - part * (high - low), low + part * (high - low)];
        if residual(one) < residual(other) {
            high = other;
        } else {
            low = one;
        }
    }
    0.5 * (low + high)
}

/// Of the columns of one packing: sums over them, lengths in D.
struct Replicate {
    saturation: f64,
    /// lambda = M_sat/(rho A)
    fitted: f64,
    /// D/(4 K mu)
    predicted: f64,
    /// The same with the friction that acts instead of mu.
    mobilised: f64,
    stress_ratio: f64,
    /// Friction that acts, over mu times the normal force.
    part: f64,
}

impl Replicate {
    fn of(rows: &[&Row], friction: f64) -> Self {
        let sum = |value: fn(&Load) -> f64| rows.iter().map(|row| value(&row.load)).sum::<f64>();
        let mass = sum(|load| load.filling);
        let whole = Load {
            vertical: sum(|load| load.vertical),
            radial: sum(|load| load.radial),
            friction: sum(|load| load.friction),
            ..Load::default()
        };
        let line_density = sum(|load| load.line_density() * load.filling) / mass;
        let (stress_ratio, saturation) = (whole.stress_ratio(), saturation(rows));
        let part = whole.friction / (friction * whole.radial);
        let predicted = 1.0 / (4.0 * stress_ratio * friction);
        Self {
            saturation,
            fitted: saturation / (line_density * BORE),
            predicted,
            mobilised: predicted / part,
            stress_ratio,
            part,
        }
    }
}

pub(super) fn examine(circumstances: Circumstances<'_>) -> Result<Finding> {
    let replicates = 2;
    let heights: &[f64] = circumstances
        .size
        .choose(&[1.0, 4.0], &[1.0, 2.0, 4.0, 6.0]);
    let load = |friction: f64, height: f64, seed: u64| -> Result<Row> {
        circumstances.go_on()?;
        let column = Column {
            friction,
            height,
            seed,
        };
        let load = column.load()?;
        Ok(Row { column, load })
    };
    let mut checks = Vec::new();
    let mut rows = Vec::new();
    for height in [heights[0], heights[heights.len() - 1]] {
        let row = load(0.0, height, 1)?;
        checks.push(hydrostatic(&row));
        rows.push(row);
    }
    let (mut told, mut curves) = (Vec::new(), Vec::new());
    for friction in FRICTIONS {
        let mut here = Vec::new();
        for seed in 1..=replicates {
            for height in heights {
                here.push(load(friction, *height, seed)?);
            }
        }
        let of_seed =
            |seed| -> Vec<&Row> { here.iter().filter(|row| row.column.seed == seed).collect() };
        let all: Vec<Replicate> = (1..=replicates)
            .map(|seed| Replicate::of(&of_seed(seed), friction))
            .collect();
        let of_all = |value: fn(&Replicate) -> f64| -> (f64, f64) {
            mean_and_error(&all.iter().map(value).collect::<Vec<_>>())
        };
        let (saturation, _) = of_all(|it| it.saturation);
        checks.extend(
            heights
                .iter()
                .map(|height| on_curve(&here, friction, *height, saturation)),
        );
        let (fitted, error) = of_all(|it| it.fitted);
        if friction == SLIDING {
            let quantity = "lambda of the curve, over D";
            let setting = format!("mu = {friction}");
            let mut check = |reference, (expected, _): (f64, f64)| {
                let check = Check::relative(quantity, &setting, expected, fitted, ALLOWED);
                checks.push(check.by(reference).with_error(error));
            };
            check("K and friction of the contacts", of_all(|it| it.mobilised));
            check("D/(4 K mu)", of_all(|it| it.predicted));
        }
        let number = |value| {
            let (mean, error) = of_all(value);
            peristalsis_analysis::number::with_error(mean, error)
        };
        told.push([
            number(|it| it.stress_ratio),
            number(|it| it.part),
            number(|it| it.predicted),
            number(|it| it.mobilised),
            number(|it| it.fitted),
        ]);
        curves.push((friction, saturation));
        rows.extend(here);
    }
    let mut finding = PROSE.described(&[
        ("replicates", &replicates),
        ("allowed", &(100.0 * ALLOWED)),
        ("ratio", &told[0][0]),
        ("part", &told[0][1]),
        ("rough_ratio", &told[1][0]),
        ("rough_part", &told[1][1]),
        ("rough_predicted", &told[1][2]),
        ("rough_mobilised", &told[1][3]),
        ("rough_fitted", &told[1][4]),
    ]);
    finding.checks = checks;
    finding.data = Columns::of(&rows)
        .number("friction", "1", "mu", |row| row.column.friction)
        .number("height", "D", "nominal", |row| row.column.height)
        .number("seed", "", "number", |row| row.column.seed as f64)
        .number("filling", "m", "M", |row| row.load.filling)
        .number("apparent", "m", "M_app", |row| row.load.apparent)
        .number("stress_ratio", "1", "K", |row| row.load.stress_ratio())
        .data()?;
    finding.figures = vec![PROSE.chart("janssen", &[], drawing(&rows, &curves))?];
    Ok(finding)
}

/// That without friction the floor bears the filling.
fn hydrostatic(row: &Row) -> Check {
    let found = row.load.apparent / row.load.filling;
    let setting = format!("frictionless, {} D", row.column.height);
    let quantity = "apparent mass over filling mass";
    Check::relative(quantity, &setting, 1.0, found, 0.01).by("hydrostatics")
}

/// That the columns of a height, of these of one friction, are on the curve of M_sat.
fn on_curve(rows: &[Row], friction: f64, height: f64, saturation: f64) -> Check {
    let here = rows.iter().filter(|row| row.column.height == height);
    let ratio = |row: &Row| row.load.apparent / janssen(row.load.filling, saturation);
    let (found, error) = mean_and_error(&here.map(ratio).collect::<Vec<_>>());
    let setting = format!("mu = {friction}, {height} D");
    let quantity = "apparent mass over that of the curve";
    let check = Check::relative(quantity, &setting, 1.0, found, ALLOWED);
    check.by("one M_sat for all heights").with_error(error)
}

fn drawing(rows: &[Row], curves: &[(f64, f64)]) -> ChartFigure {
    let most = rows.iter().map(|row| row.load.filling).fold(0.0, f64::max);
    let fillings = spaced(0.0, most, 100);
    let mut panel = ChartPanel::new("filling mass *M* (*m*)", "apparent mass *M*_{app} (*m*)")
        .with(curve("hydrostatic", &fillings, |filling| filling).tint(Tint::Black));
    for (number, (_, saturation)) in curves.iter().enumerate() {
        let name = named_once("Janssen", number);
        let of = |filling| janssen(filling, *saturation);
        panel = panel.with(closed_form(name, &fillings, of));
    }
    let frictionless = [0.0].into_iter();
    for (series, friction) in frictionless.chain(FRICTIONS).enumerate() {
        let mine = rows.iter().filter(|row| row.column.friction == friction);
        let found = points(&format!("*μ* = {friction}"), mine, |row| {
            (row.load.filling, row.load.apparent)
        });
        panel = panel.with(open_if(series > 0, found.series(series)));
    }
    ChartFigure::new(panel)
}
