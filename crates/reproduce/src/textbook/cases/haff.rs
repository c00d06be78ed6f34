//! Haff's law: a gas of inelastic grains cools.

use peristalsis_figures::chart::{ChartFigure, ChartPanel, Line, Points, Tint};
use peristalsis_figures::{Drawing, Scale};
use peristalsis_physics::contact::LinearSpringDashpot;

use super::restitution::{linear_damping, measured_with};
use super::study::{numbers, table};
use crate::textbook::case::{Case, Circumstances};
use crate::textbook::error::ValidateError;
use crate::textbook::experiment::Means;
use crate::textbook::experiment::gas::Gas;
use crate::textbook::finding::{CaseFigure, Check, Finding};
use crate::textbook::reference::kinetic::CoolingGas;

pub(super) const CASE: Case = Case {
    name: "haff",
    title: "Haff's law: the cooling of a homogeneous gas of inelastic grains",
    source: "Haff 1983; van Noije & Ernst 1998",
    examine,
};

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
    fn new(restitution: f64) -> Result<Self, ValidateError> {
        let law = LinearSpringDashpot {
            normal_stiffness: 1.0,
            normal_damping: linear_damping(restitution),
        };
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
            // What the engine's collisions have at this step.
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

/// Mean and standard error.
fn mean_and_error(values: &[f64]) -> (f64, f64) {
    let number = values.len() as f64;
    let mean = values.iter().sum::<f64>() / number;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    (mean, (squares / (number * (number - 1.0))).sqrt())
}

/// Part of the rate that theory and experiment may differ by besides three standard errors.
///
/// Known and left out: velocities that collisions correlate (0.2 % for hard spheres at e = 0.6), terms of order 1/N (0.2 %), a
/// third grain in 1 % of the contacts, the square of the softness, which is 2 % at the start.
const SYSTEMATIC: f64 = 0.01;

fn examine(circumstances: Circumstances<'_>) -> Result<Finding, ValidateError> {
    let replicates = circumstances.extent.choose(4, 28);
    let mut finding = Finding {
        paragraphs: vec![
            format!(
                "{replicates} replicates of {GRAINS} grains each (volume fraction {VOLUME_FRACTION}, plain kernel) under the linear law, \
                 whose e does not depend on speed. 1/sqrt(T) grows linearly in time; its slope, each piece with the weight that its \
                 scatter gives it, divided by that of kinetic theory (contact value of Carnahan & Starling, second Sonine coefficient, \
                 e as the engine's own collisions have it at this step), is 1. The error is that of the mean over replicates; three of \
                 them and {:.0} % are allowed. The engine has no fully periodic box: the gas is in a cylinder that is periodic along \
                 its axis and has a mirror for a side (the state is taken out and radial velocities of grains that leave are \
                 reversed), which takes no energy.",
                100.0 * SYSTEMATIC
            ),
            "Theory is that of this gas. (1) Grains at the mirror lack partners and gather there: the collision rate is that of \
             hard spheres with the surface tension of Henderson & Plischke (1987), which a Monte Carlo of hard spheres in a narrow \
             cylinder confirms within 2 % where the correction of a dilute gas is 9 % off (`cargo test -p peristalsis-validate \
             kinetic`). (2) Soft grains turn about each other while they touch, and lose less, by 2 % at the start and 0.7 % at the \
             end. (3) The gas does not turn about the axis at the start: the mirror keeps angular momentum, and what there is stays \
             while the rest cools. (4) The cylinder is so small, in mean free paths, that shear along its axis decays faster than \
             the gas cools. A wide flat cylinder without (1), (3) and (4) cools some percent more slowly."
                .to_owned(),
        ],
        ..Finding::default()
    };
    let mut curves: Vec<(f64, Vec<[f64; 2]>)> = Vec::new();
    let (mut all_times, mut all_temperatures) = (Vec::new(), Vec::new());
    let (mut all_restitutions, mut all_replicates) = (Vec::new(), Vec::new());
    for restitution in RESTITUTIONS {
        let experiment = Experiment::new(restitution)?;
        let tau = experiment.cooling_time();
        let mut ratios = Vec::new();
        let mut mean = vec![[0.0; 2]; SAMPLES + 1];
        for replicate in 0..replicates {
            let course = experiment.gas.cool(
                replicate,
                // A state that is taken out and put back every few contacts is cheapest for the plain kernel.
                Means::USUAL.plainly(),
                experiment.time_step,
                [TIMES_TAU * tau, SAMPLES as f64],
                circumstances,
            )?;
            ratios.push(experiment.ratio(&course));
            for (sum, sample) in mean.iter_mut().zip(&course) {
                sum[0] = sample[0] / tau;
                sum[1] += sample[1] / (experiment.gas.temperature * f64::from(replicates as u32));
                all_times.push(sample[0] / tau);
                all_temperatures.push(sample[1] / experiment.gas.temperature);
                all_restitutions.push(restitution);
                all_replicates.push(replicate as f64);
            }
        }
        let (found, error) = mean_and_error(&ratios);
        finding.checks.push(
            Check::absolute(
                "rate of cooling over that of theory",
                &format!("e = {restitution}"),
                1.0,
                found,
                3.0 * error + SYSTEMATIC,
            )
            .by("Haff 1983, van Noije & Ernst 1998")
            .with_error(error),
        );
        curves.push((restitution, mean));
    }
    finding.figures.push(CaseFigure {
        name: "haff",
        caption: "Temperature of gases of two restitutions, mean over replicates, against time in units of their tau from kinetic \
                  theory, with Haff's law for hard grains (no parameter is fitted; soft ones stay 1 to 2 % warmer).",
        drawing: drawing(&curves)?,
    });
    finding.table = table([
        numbers("restitution", "", "e", all_restitutions),
        numbers("replicate", "", "number", all_replicates),
        numbers("time", "tau", "time", all_times),
        numbers("temperature", "T_0", "temperature", all_temperatures),
    ])?;
    Ok(finding)
}

fn drawing(curves: &[(f64, Vec<[f64; 2]>)]) -> Result<Drawing, ValidateError> {
    let times = super::study::evenly(0.0, TIMES_TAU, 100);
    let law: Vec<f64> = times
        .iter()
        .map(|t| 1.0 / ((1.0 + t) * (1.0 + t)))
        .collect();
    let mut panel = ChartPanel::new("time *t*/*τ*", "temperature *T*/*T*_{0}")
        .x_range(0.0..)
        .y_scale(Scale::Logarithmic)
        .with(Line::new("(1 + *t*/*τ*)^{−2}", &times, &law).tint(Tint::Black));
    for (series, (restitution, course)) in curves.iter().enumerate() {
        // So many that the law shows between them.
        let some = course.iter().step_by(SAMPLES / 15);
        let (x, y): (Vec<f64>, Vec<f64>) = some.map(|sample| (sample[0], sample[1])).unzip();
        let points = Points::new(&format!("*e* = {restitution}"), &x, &y).series(series);
        panel = panel.with(if series == 0 { points } else { points.open() });
    }
    Ok(ChartFigure::new(panel)
        .description("Both gases cool along Haff's law.")
        .draw()?)
}
