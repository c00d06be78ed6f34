//! Haff's law: a gas of inelastic grains cools.

use peristalsis_analysis::mean_and_error;
use peristalsis_figures::Scale;
use peristalsis_figures::chart::{ChartFigure, ChartPanel, Points, Tint};

use super::plot::{curve, open_if};
use super::restitution::{linear_damping, measured_with, spring};
use crate::columns::Columns;
use crate::error::Result;
use crate::exhibit::spaced;
use crate::textbook::case::Circumstances;
use crate::textbook::experiment::Means;
use crate::textbook::experiment::gas::Gas;
use crate::textbook::reference::kinetic::CoolingGas;
use crate::{Check, Finding, Prose};

pub(super) const PROSE: Prose = Prose::new(include_str!("haff.md"));

/// Restitutions of the gases.
const RESTITUTIONS: [f64; 2] = [0.8, 0.6];
const VOLUME_FRACTION: f64 = 0.02;
const GRAINS: usize = 300;
/// Period of the cylinder, which is then about as long as wide: slow modes of the flow decay faster than grains cool.
const LENGTH: f64 = 20.0;
/// Collisions of a grain in the duration of one, at the start: how far grains are from hard spheres.
const OVERLAPPING: f64 = 0.01;
/// Steps in a contact.
const STEPS_PER_CONTACT: f64 = 10.0;
/// Duration in units of tau: the temperature falls to 1/9.
const TIMES_TAU: f64 = 2.0;
const SAMPLES: usize = 60;

/// A gas with its theory.
struct Experiment {
    gas: Gas,
    theory: CoolingGas,
    time_step: f64,
}

impl Experiment {
    fn new(restitution: f64) -> Result<Self> {
        let law = spring(linear_damping(restitution));
        let contact_time = law.contact_time(0.5);
        let time_step = contact_time / STEPS_PER_CONTACT;
        let mut gas = Gas {
            law,
            grains: GRAINS,
            volume_fraction: VOLUME_FRACTION,
            length: LENGTH,
            temperature: 0.0,
        };
        let theory = CoolingGas {
            // The restitution of the engine's collisions at this step.
            restitution: measured_with(law.normal_damping, STEPS_PER_CONTACT)?,
            density: gas.density(),
            surface: 2.0 / gas.radius(),
        };
        gas.temperature = (OVERLAPPING / (theory.collision_rate() * contact_time)).powi(2);
        Ok(Self {
            gas,
            theory,
            time_step,
        })
    }

    /// tau of Haff's law at the start.
    fn cooling_time(&self) -> f64 {
        1.0 / (self.theory.haff_rate() * self.gas.temperature.sqrt())
    }

    /// How far the temperature fell over a course, over how far it should have.
    ///
    /// ln sqrt(T_0/T) = integral of lambda sqrt(T) (1 - K t_c sqrt(T)) dt, lambda the rate of Haff's law: the slope of 1/sqrt(T),
    /// each piece with the weight that its scatter gives it.
    fn ratio(&self, course: &[[f64; 2]]) -> f64 {
        let softness = self.theory.softness() * self.gas.law.contact_time(0.5);
        let speed = |sample: &[f64; 2]| sample[1].sqrt() * (1.0 - softness * sample[1].sqrt());
        let expected: f64 = course
            .windows(2)
            .map(|pair| 0.5 * (pair[1][0] - pair[0][0]) * (speed(&pair[0]) + speed(&pair[1])))
            .sum();
        let fallen = 0.5 * libm::log(course[0][1] / course[course.len() - 1][1]);
        fallen / (self.theory.haff_rate() * expected)
    }
}

/// Part of the rate that theory and experiment may differ by besides three standard errors.
///
/// Known and left out: velocities that collisions correlate (0.2 % for hard spheres at e = 0.6), terms of order 1/N (0.2 %), a
/// third grain in 1 % of the contacts, the square of the softness, which is 2 % at the start.
const SYSTEMATIC: f64 = 0.01;

/// A sample of a cooling gas.
struct Row {
    restitution: f64,
    replicate: u64,
    /// In units of tau.
    time: f64,
    /// In units of T_0.
    temperature: f64,
}

pub(super) fn examine(circumstances: Circumstances<'_>) -> Result<Finding> {
    let replicates = circumstances.size.choose(4, 28);
    let mut finding = PROSE.described(&[
        ("replicates", &replicates),
        ("grains", &GRAINS),
        ("fraction", &VOLUME_FRACTION),
        ("systematic", &(100.0 * SYSTEMATIC)),
    ]);
    let mut rows: Vec<Row> = Vec::new();
    for restitution in RESTITUTIONS {
        let experiment = Experiment::new(restitution)?;
        let tau = experiment.cooling_time();
        let mut ratios = Vec::new();
        for replicate in 0..replicates {
            let course = experiment.gas.cool(
                replicate,
                // A state that is taken out and put back every few contacts is cheapest for the reference kernel.
                Means::USUAL.by_reference(),
                experiment.time_step,
                [TIMES_TAU * tau, SAMPLES as f64],
                circumstances,
            )?;
            ratios.push(experiment.ratio(&course));
            rows.extend(course.iter().map(|sample| Row {
                restitution,
                replicate,
                time: sample[0] / tau,
                temperature: sample[1] / experiment.gas.temperature,
            }));
        }
        let (found, error) = mean_and_error(&ratios);
        let quantity = "rate of cooling over that of theory";
        let setting = format!("e = {restitution}");
        let check = Check::absolute(quantity, &setting, 1.0, found, 3.0 * error + SYSTEMATIC)
            .by("Haff 1983, van Noije & Ernst 1998");
        finding.checks.push(check.with_error(error));
    }
    finding.figures = vec![PROSE.chart("haff", &[], drawing(&rows))?];
    finding.data = Columns::of(&rows)
        .number("restitution", "", "e", |row| row.restitution)
        .number("replicate", "", "number", |row| row.replicate as f64)
        .number("time", "tau", "time", |row| row.time)
        .number("temperature", "T_0", "temperature", |row| row.temperature)
        .data()?;
    Ok(finding)
}

fn drawing(rows: &[Row]) -> ChartFigure {
    let law = |time: f64| 1.0 / ((1.0 + time) * (1.0 + time));
    let mut panel = ChartPanel::new("time *t*/*τ*", "temperature *T*/*T*_{0}")
        .x_range(0.0..)
        .y_scale(Scale::Logarithmic)
        .with(curve("(1 + *t*/*τ*)^{−2}", &spaced(0.0, TIMES_TAU, 100), law).tint(Tint::Black));
    for (series, restitution) in RESTITUTIONS.into_iter().enumerate() {
        let mine: Vec<&Row> = rows
            .iter()
            .filter(|row| row.restitution == restitution)
            .collect();
        let courses: Vec<&[&Row]> = mine.chunks(SAMPLES + 1).collect();
        // The mean over replicates of so few samples that the law shows between them.
        let (time, temperature): (Vec<f64>, Vec<f64>) = (0..=SAMPLES)
            .step_by(SAMPLES / 15)
            .map(|sample| {
                let temperatures = courses.iter().map(|course| course[sample].temperature);
                let mean = temperatures.sum::<f64>() / courses.len() as f64;
                (mine[sample].time, mean)
            })
            .unzip();
        let name = format!("*e* = {restitution}");
        let points = Points::new(&name, &time, &temperature).series(series);
        panel = panel.with(open_if(series > 0, points));
    }
    ChartFigure::new(panel)
}
