//! Restitution of viscoelastic spheres against the speed of impact.

use glam::DVec3;
use peristalsis_figures::chart::{ChartFigure, ChartPanel, Pattern, Points, Reference, Tint};
use peristalsis_figures::{Drawing, FigureError, Scale};
use peristalsis_physics::contact::{DissipationForm, Normal, ViscoelasticHertz};

use super::errors::{FINE, PER_CONTACT, error_drawing, impact_convergences, measured_restitution};
use super::plot::{curve, named_once};
use super::restitution;
use crate::check::Check;
use crate::columns::Columns;
use crate::error::ClaimError;
use crate::exhibit::spaced;
use crate::finding::Finding;
use crate::prose::Prose;
use crate::textbook::case::{Case, Circumstances};
use crate::textbook::experiment::impact::{Impact, Partner, Sphere};
use crate::textbook::experiment::smooth;
use crate::textbook::reference::hertz::{HertzImpact, viscoelastic_series};

const PROSE: Prose = Prose::new(include_str!("viscoelastic.md"));

pub(super) const CASE: Case = Case {
    name: "viscoelastic",
    prose: PROSE,
    examine,
};

/// Diameter of the spheres that stand for grains of diameter 1 \[d\].
///
/// At v = 1 grains of diameter 1 would pass through each other. Spheres of mass 1 and diameter 10, sqrt(10) times softer, have
/// the same force at the same overlap, and so the same equation of motion head-on.
const LARGE: f64 = 10.0;

/// The factors of the dissipation time, by their names in the table and in the figure.
const FORMS: [(&str, &str, DissipationForm); 2] = [
    (
        "viscoelastic",
        "viscoelastic",
        DissipationForm::Viscoelastic,
    ),
    ("as_printed", "as printed", DissipationForm::Printed),
];

/// A head-on impact of the preset's grains.
struct Experiment {
    law: ViscoelasticHertz,
    impact: Impact,
}

impl Experiment {
    fn new(dissipation_form: DissipationForm, speed: f64) -> Self {
        let law = ViscoelasticHertz {
            young_modulus: 1.0 / LARGE.sqrt(),
            poisson_ratio: 0.5,
            dissipation_time: 0.1,
            dissipation_form,
        };
        let sphere = |velocity: f64| Sphere {
            diameter: LARGE,
            mass: 1.0,
            velocity: DVec3::new(velocity, 0.0, 0.0),
            spin: 0.0,
        };
        let impact = Impact {
            contact: smooth(Normal::Hertz(law)),
            sphere: sphere(-0.5 * speed),
            partner: Partner::Grain(sphere(0.5 * speed)),
        };
        Self { law, impact }
    }

    fn elastic(&self) -> HertzImpact {
        HertzImpact::of(&self.law, &self.impact)
    }

    /// s of the series.
    fn small_parameter(&self) -> f64 {
        let elastic = self.elastic();
        let ratio = elastic.stiffness / elastic.reduced_mass;
        self.law.relaxation_time() * libm::pow(ratio, 0.4) * libm::pow(elastic.speed, 0.2)
    }

    /// e by the equation of motion.
    fn integrated(&self) -> f64 {
        restitution::integrated(&self.impact)
    }

    /// e that the engine gives with so many steps in a contact.
    fn measured(&self, steps: f64) -> Result<f64, ClaimError> {
        measured_restitution(&self.impact, self.elastic().contact_time(), steps)
    }
}

/// Restitutions at one speed, under either form of the dissipation.
struct Row {
    speed: f64,
    expected: [f64; 2],
    found: [f64; 2],
}

fn examine(circumstances: Circumstances<'_>) -> Result<Finding, ClaimError> {
    let preset = |speed: f64| Experiment::new(DissipationForm::Viscoelastic, speed);
    let mut finding = Finding::described(&PROSE, &[]);
    let mut check = |speed: &str, reference: &str, expected, found, tolerance| {
        let setting = format!("v = {speed}");
        let check = Check::absolute("restitution", &setting, expected, found, tolerance);
        finding.checks.push(check.by(reference));
    };
    for speed in [1e-3, 1e-2, 0.1, 1.0] {
        circumstances.go_on()?;
        let (expected, found) = (preset(speed).integrated(), preset(speed).measured(FINE)?);
        check(
            &speed.to_string(),
            "equation of motion",
            expected,
            found,
            2e-4,
        );
    }
    let fast = preset(1.0);
    check("1", "the source", 0.85, fast.measured(FINE)?, 5e-3);
    let slow = preset(1e-4);
    let s = slow.small_parameter();
    let found = slow.measured(8.0 * FINE)?;
    check("1e-4", "series", viscoelastic_series(s), found, s * s * s);

    let expected = fast.integrated();
    finding.convergences = impact_convergences(
        ("restitution", "v = 1"),
        &fast.impact,
        fast.elastic().contact_time(),
        [1.3, 2.4],
        |rebound| fast.impact.restitution(rebound.velocity) / expected - 1.0,
    )?;

    let mut rows: Vec<Row> = Vec::new();
    for speed in speeds(circumstances.size.choose(9, 25)) {
        circumstances.go_on()?;
        let [one, other] = FORMS.map(|(.., form)| Experiment::new(form, speed));
        rows.push(Row {
            speed,
            expected: [one.integrated(), other.integrated()],
            found: [one.measured(FINE)?, other.measured(FINE)?],
        });
    }
    finding.figures = vec![
        PROSE.figure("viscoelastic", &[], drawing(&rows)?),
        PROSE.figure(
            "viscoelastic-errors",
            &[],
            error_drawing(
                "Errors of the restitution fall with the power 3/2 to 2 of the time step.",
                &PER_CONTACT,
                &[("", &finding.convergences)],
            )?,
        ),
    ];
    let mut data = Columns::of(&rows).number("speed", "d/t", "relative speed", |row| row.speed);
    for (place, (name, ..)) in FORMS.into_iter().enumerate() {
        let [expected, found] = ["expected", "found"].map(|whose| format!("{name}_{whose}"));
        data = data
            .number(&expected, "", "equation of motion", |row| {
                row.expected[place]
            })
            .number(&found, "", "engine", |row| row.found[place]);
    }
    finding.data = Some(data.table()?);
    Ok(finding)
}

/// Speeds from 1e-6 to 1 at equal ratios.
fn speeds(number: usize) -> Vec<f64> {
    let exponents = spaced(-6.0, 0.0, number);
    exponents
        .iter()
        .map(|exponent| libm::pow(10.0, *exponent))
        .collect()
}

fn drawing(rows: &[Row]) -> Result<Drawing, FigureError> {
    let (speed, dense): (Vec<f64>, _) = (rows.iter().map(|row| row.speed).collect(), speeds(61));
    let mut panel = ChartPanel::new("speed *v* (*d*/*t*\\*)", "restitution *e*")
        .x_scale(Scale::Logarithmic)
        .y_range(0.84..=1.0);
    for (place, (_, name, form)) in FORMS.into_iter().enumerate() {
        let found: Vec<f64> = rows.iter().map(|row| row.found[place]).collect();
        let equation = |speed| Experiment::new(form, speed).integrated();
        let series = |speed| viscoelastic_series(Experiment::new(form, speed).small_parameter());
        let [equation_name, series_name] =
            ["equation of motion", "series"].map(|name| named_once(name, place));
        let series = curve(series_name, &dense, series).tint(Tint::Green);
        panel = panel
            .with(curve(equation_name, &dense, equation).tint(Tint::Black))
            .with(series.pattern(Pattern::Dashed))
            .with(Points::new(name, &speed, &found).series(place));
    }
    let source = Reference::horizontal(0.85).label("0.85, the source at *v* = 1");
    ChartFigure::new(panel.with(source))
        .description("Restitution falls slowly with speed; the engine lies on the equation of motion, and on the series at small speed.")
        .draw()
}
