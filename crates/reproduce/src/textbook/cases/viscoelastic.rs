//! Restitution of viscoelastic spheres against the speed of impact.

use glam::DVec3;
use peristalsis_figures::Scale;
use peristalsis_figures::chart::{ChartFigure, ChartPanel, Pattern, Reference, Tint};
use peristalsis_physics::contact::{DissipationForm, Normal, ViscoelasticHertz};

use super::errors::error_chart;
use super::plot::{curve, named_once, points};
use super::trial::{FINE, PER_CONTACT, Trial, expected_restitution};
use crate::columns::Columns;
use crate::error::Result;
use crate::exhibit::spaced;
use crate::textbook::case::Circumstances;
use crate::textbook::experiment::frictionless;
use crate::textbook::experiment::impact::{Impact, Rebound, Sphere};
use crate::textbook::reference::hertz::{HertzImpact, viscoelastic_series};
use crate::{Check, Finding, Prose};

pub(super) const PROSE: Prose = Prose::new(include_str!("viscoelastic.md"));

/// Diameter of the spheres that stand for grains of diameter 1 \[d\].
///
/// At v = 1 grains of diameter 1 would pass through each other. Spheres of mass 1 and diameter 10, sqrt(10) times softer, have
/// the same force at the same overlap, and so the same equation of motion head-on.
const LARGE: f64 = 10.0;

/// The factors of the dissipation time, by their names.
const FORMS: [(&str, DissipationForm); 2] = [
    ("viscoelastic", DissipationForm::Viscoelastic),
    ("as printed", DissipationForm::Printed),
];

fn law(dissipation_form: DissipationForm) -> ViscoelasticHertz {
    ViscoelasticHertz {
        young_modulus: 1.0 / LARGE.sqrt(),
        poisson_ratio: 0.5,
        dissipation_time: 0.1,
        dissipation_form,
    }
}

/// A head-on impact of the preset's grains.
fn impact(form: DissipationForm, speed: f64) -> Impact {
    let sphere = |velocity: f64| Sphere {
        diameter: LARGE,
        mass: 1.0,
        velocity: DVec3::new(velocity, 0.0, 0.0),
        spin: 0.0,
    };
    Impact {
        contact: frictionless(Normal::Hertz(law(form))),
        sphere: sphere(-0.5 * speed),
        partner: Some(sphere(0.5 * speed)),
    }
}

/// s of the series.
fn small_parameter(form: DissipationForm, speed: f64) -> f64 {
    let elastic = HertzImpact::of(&law(form), &impact(form, speed));
    let ratio = elastic.stiffness / elastic.reduced_mass;
    law(form).relaxation_time() * libm::pow(ratio, 0.4) * libm::pow(elastic.speed, 0.2)
}

/// Restitutions at one speed, under either form of the dissipation.
struct Row {
    speed: f64,
    expected: [f64; 2],
    found: [f64; 2],
}

pub(super) fn examine(circumstances: Circumstances<'_>) -> Result<Finding> {
    const PRESET: DissipationForm = DissipationForm::Viscoelastic;
    let preset = |speed: f64| Trial::of(impact(PRESET, speed));
    let mut finding = PROSE.described(&[]);
    let mut check = |speed: &str, reference: &str, expected, found, tolerance| {
        let setting = format!("v = {speed}");
        let check = Check::absolute("restitution", &setting, expected, found, tolerance);
        finding.checks.push(check.by(reference));
    };
    for speed in [1e-3, 1e-2, 0.1, 1.0] {
        circumstances.go_on()?;
        let expected = expected_restitution(&preset(speed).impact);
        let (speed, found) = (speed.to_string(), preset(speed).restitution(FINE)?);
        check(&speed, "equation of motion", expected, found, 2e-4);
    }
    let fast = preset(1.0);
    check("1", "the source", 0.85, fast.restitution(FINE)?, 5e-3);
    let s = small_parameter(PRESET, 1e-4);
    let found = preset(1e-4).restitution(8.0 * FINE)?;
    check("1e-4", "series", viscoelastic_series(s), found, s * s * s);

    let expected = expected_restitution(&fast.impact);
    let error = |rebound: &Rebound| fast.impact.restitution(rebound.velocity) / expected - 1.0;
    finding.convergences = fast.convergences(("restitution", "v = 1"), [1.3, 2.4], error)?;

    let mut rows: Vec<Row> = Vec::new();
    for speed in speeds(circumstances.size.choose(9, 25)) {
        circumstances.go_on()?;
        let [one, other] = FORMS.map(|(_, form)| Trial::of(impact(form, speed)));
        rows.push(Row {
            speed,
            expected: [&one, &other].map(|trial| expected_restitution(&trial.impact)),
            found: [one.restitution(FINE)?, other.restitution(FINE)?],
        });
    }
    let errors = error_chart(&PER_CONTACT, &[("", &finding.convergences)]);
    finding.figures = vec![
        PROSE.chart("viscoelastic", &[], drawing(&rows))?,
        PROSE.chart("viscoelastic-errors", &[], errors)?,
    ];
    let mut data = Columns::of(&rows).number("speed", "d/t", "relative speed", |row| row.speed);
    for (place, (name, _)) in FORMS.into_iter().enumerate() {
        let name = name.replace(' ', "_");
        let [expected, found] = ["expected", "found"].map(|whose| format!("{name}_{whose}"));
        let equation = "equation of motion";
        data = data
            .number(&expected, "", equation, |row| row.expected[place])
            .number(&found, "", "engine", |row| row.found[place]);
    }
    finding.data = data.data()?;
    Ok(finding)
}

/// Speeds from 1e-6 to 1 at equal ratios.
fn speeds(number: usize) -> Vec<f64> {
    let exponents = spaced(-6.0, 0.0, number).into_iter();
    exponents
        .map(|exponent| libm::pow(10.0, exponent))
        .collect()
}

fn drawing(rows: &[Row]) -> ChartFigure {
    let dense = speeds(61);
    let mut panel = ChartPanel::new("speed *v* (*d*/*t*\\*)", "restitution *e*")
        .x_scale(Scale::Logarithmic)
        .y_range(0.84..=1.0);
    for (place, (name, form)) in FORMS.into_iter().enumerate() {
        let equation = |speed| expected_restitution(&impact(form, speed));
        let series = |speed| viscoelastic_series(small_parameter(form, speed));
        let curve = |name, of: &dyn Fn(f64) -> f64| curve(named_once(name, place), &dense, of);
        let found = points(name, rows, |row: &Row| (row.speed, row.found[place]));
        let series = curve("series", &series).pattern(Pattern::Dashed);
        panel = panel
            .with(curve("equation of motion", &equation).tint(Tint::Black))
            .with(series.tint(Tint::Green))
            .with(found.series(place));
    }
    let source = Reference::horizontal(0.85).label("0.85, the source at *v* = 1");
    ChartFigure::new(panel.with(source))
}
