//! What the cases share: materials, errors of impacts against the time step, columns of tables, the figure of errors.

use core::f64::consts::PI;

use peristalsis_figures::chart::{ChartFigure, ChartPanel, Line, Pattern, Points, Tint};
use peristalsis_figures::{Drawing, FigureError, Scale};
use peristalsis_formats::{Column, FormatError, Table, Values};
use peristalsis_physics::contact::{ContactModel, DissipationForm, Normal, ViscoelasticHertz};

use crate::textbook::error::ValidateError;
use crate::textbook::experiment::Means;
use crate::textbook::experiment::impact::{Impact, Rebound};
use crate::textbook::finding::{Check, Convergence};

/// Steps that errors are looked at: so many in a contact.
pub(super) const STEPS_PER_CONTACT: [f64; 4] = [10.0, 20.0, 40.0, 80.0];
/// The finest of them.
pub(super) const FINE: f64 = 80.0;
/// Places within a step at which spheres meet, and steps, over which errors are averaged.
const PHASES: usize = 8;
/// How the steps are called in documents.
pub(super) const STEP_UNIT: &str = "t_c";

/// An elastic material.
#[derive(Clone, Copy, Debug)]
pub(super) struct Material {
    pub(super) name: &'static str,
    /// Young's modulus \[Pa\].
    pub(super) young_modulus: f64,
    pub(super) poisson_ratio: f64,
    /// \[kg/m^3\]
    pub(super) density: f64,
}

impl Material {
    /// d/t in m/s: sqrt(6 Y/(pi rho)), whatever the diameter.
    pub(super) fn speed(&self) -> f64 {
        (6.0 * self.young_modulus / (PI * self.density)).sqrt()
    }

    /// The law of two spheres of this material, in units of its own modulus.
    pub(super) fn spheres(&self, dissipation_time: f64) -> ViscoelasticHertz {
        ViscoelasticHertz {
            young_modulus: 1.0,
            poisson_ratio: self.poisson_ratio,
            dissipation_time,
            dissipation_form: DissipationForm::Viscoelastic,
        }
    }

    /// The law of a sphere of this material and a rigid body: only one of the two gives way, which doubles the modulus.
    pub(super) fn against_rigid(&self, dissipation_time: f64) -> ViscoelasticHertz {
        ViscoelasticHertz {
            young_modulus: 2.0,
            ..self.spheres(dissipation_time)
        }
    }
}

pub(super) fn smooth(normal: Normal) -> ContactModel {
    ContactModel {
        normal,
        friction: None,
    }
}

/// kappa of the Hertz force kappa xi^(3/2) of an impact.
pub(super) fn hertz_stiffness(law: &ViscoelasticHertz, impact: &Impact) -> f64 {
    let nu = law.poisson_ratio;
    2.0 * law.young_modulus * impact.reduced_radius().sqrt() / (3.0 * (1.0 - nu * nu))
}

/// Root mean square of a relative error, over places of the onset within a step and over steps that fit between `steps` and
/// one more of them into the contact.
///
/// Where it ends within a step matters as much as where it begins: with one step only, the two could cancel.
pub(super) fn error_of(
    impact: &Impact,
    means: Means,
    (contact_time, steps): (f64, f64),
    error: impl Fn(&Rebound) -> f64,
) -> Result<f64, ValidateError> {
    let mut sum = 0.0;
    for place in 0..PHASES {
        let part = |number: usize| ((number % PHASES) as f64 + 0.5) / PHASES as f64;
        let time_step = contact_time / (steps + part(3 * place));
        sum += error(&impact.simulate(means, time_step, part(place))?).powi(2);
    }
    Ok((sum / PHASES as f64).sqrt())
}

/// Errors at the usual steps with both integrators.
pub(super) fn convergences(
    (quantity, setting): (&str, &str),
    impact: &Impact,
    contact_time: f64,
    expected_order: [f64; 2],
    error: impl Fn(&Rebound) -> f64,
) -> Result<Vec<Convergence>, ValidateError> {
    let mut found = Vec::new();
    for means in Means::INTEGRATORS {
        let mut errors = Vec::new();
        for steps in STEPS_PER_CONTACT {
            errors.push(error_of(impact, means, (contact_time, steps), &error)?);
        }
        found.push(Convergence::new(
            quantity,
            &format!("{setting}, {}", means.name()),
            STEP_UNIT,
            &STEPS_PER_CONTACT.map(|steps| 1.0 / steps),
            &errors,
            expected_order,
        ));
    }
    Ok(found)
}

/// Largest difference that rounding may make between two kernels after an impact, over the speed.
const KERNELS_AGREE: f64 = 1e-9;

/// The fast kernels against the plain one, with both integrators: largest difference of velocities and spins after the
/// impact, over its speed.
pub(super) fn kernels_agree(
    setting: &str,
    impact: &Impact,
    time_step: f64,
) -> Result<Check, ValidateError> {
    let mut largest = 0.0_f64;
    for means in Means::INTEGRATORS {
        let fast = impact.simulate(means, time_step, 0.5)?;
        let plain = impact.simulate(means.plainly(), time_step, 0.5)?;
        for i in 0..2 {
            let apart = (fast.velocity[i] - plain.velocity[i]).length();
            largest = largest.max(apart).max((fast.spin[i] - plain.spin[i]).abs());
        }
    }
    let speed = impact.relative_velocity().length();
    Ok(Check::absolute(
        "fast kernels less plain kernel, over the speed",
        setting,
        0.0,
        largest / speed,
        KERNELS_AGREE,
    )
    .by("the plain kernel"))
}

/// A column of numbers.
pub(super) fn numbers(name: &str, unit: &str, description: &str, values: Vec<f64>) -> Column {
    Column {
        name: name.to_owned(),
        unit: unit.to_owned(),
        description: description.to_owned(),
        values: Values::Real(values),
    }
}

/// A column of words.
pub(super) fn words(name: &str, description: &str, values: Vec<String>) -> Column {
    Column {
        name: name.to_owned(),
        unit: String::new(),
        description: description.to_owned(),
        values: Values::Text(values),
    }
}

/// Columns together.
pub(super) fn table(
    columns: impl IntoIterator<Item = Column>,
) -> Result<Option<Table>, FormatError> {
    Table::builder().columns(columns).build().map(Some)
}

/// Numbers at equal distances, ends included.
pub(super) fn evenly(from: f64, to: f64, number: usize) -> Vec<f64> {
    let last = (number - 1) as f64;
    (0..number)
        .map(|i| from + (to - from) * i as f64 / last)
        .collect()
}

/// Errors against the time step, one panel for each group with its title, with slopes of order 1 and 2 to compare with.
pub(super) fn error_figure(
    description: &str,
    label: &str,
    groups: &[(&str, Vec<&Convergence>)],
) -> Result<Drawing, FigureError> {
    let panels = groups.iter().map(|(title, convergences)| {
        let mut panel = ChartPanel::new(label, "relative error")
            .title(title)
            .x_scale(Scale::Logarithmic)
            .y_scale(Scale::Logarithmic);
        let (mut top, mut steps) = (0.0_f64, [1.0_f64, 0.0]);
        for (number, convergence) in convergences.iter().enumerate() {
            for (step, error) in convergence.steps.iter().zip(&convergence.errors) {
                top = top.max(*error);
                steps = [steps[0].min(*step), steps[1].max(*step)];
            }
            let name = format!("{}, {}", convergence.quantity, integrator(convergence));
            let points = Points::new(&name, &convergence.steps, &convergence.errors);
            let points = points.series(number / 2).joined();
            panel = panel.with(if number % 2 == 0 {
                points
            } else {
                points.open()
            });
        }
        for (order, pattern) in [(1.0, Pattern::Dotted), (2.0, Pattern::Dashed)] {
            let at = |step: f64| 2.0 * top * libm::pow(step / steps[1], order);
            panel = panel.with(
                Line::new(&format!("order {order}"), &steps, &steps.map(at))
                    .pattern(pattern)
                    .tint(Tint::Grey),
            );
        }
        panel
    });
    ChartFigure::grid(groups.len(), panels)
        .description(description)
        .width(if groups.len() > 1 {
            peristalsis_figures::Width::DoubleColumn
        } else {
            peristalsis_figures::Width::SingleColumn
        })
        .draw()
}

/// The integrator that a setting ends with.
fn integrator(convergence: &Convergence) -> &str {
    convergence.setting.rsplit(", ").next().unwrap_or_default()
}
