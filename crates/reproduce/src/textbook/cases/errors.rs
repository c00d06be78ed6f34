//! Errors against the time step: measured with both integrators, and drawn.

use peristalsis_figures::chart::{ChartFigure, ChartPanel, Line, Pattern, Points, Tint};
use peristalsis_figures::{Drawing, FigureError, Scale, Width};

use crate::check::{Check, Convergence};
use crate::error::ClaimError;
use crate::textbook::experiment::Means;
use crate::textbook::experiment::impact::{Impact, Rebound};

/// Time steps at which errors are measured, the longest first.
pub(super) struct Steps {
    /// Their unit in documents.
    pub(super) unit: &'static str,
    /// Their unit in figures.
    pub(super) label: &'static str,
    pub(super) lengths: [f64; 4],
}

/// Steps in units of the contact time t_c.
pub(super) const PER_CONTACT: Steps = Steps {
    unit: "t_c",
    label: "*h*/*t*_{c}",
    lengths: [1.0 / 10.0, 1.0 / 20.0, 1.0 / 40.0, 1.0 / 80.0],
};
/// Steps in a contact where values are compared: the finest of those.
pub(super) const FINE: f64 = 80.0;
/// Number of onsets and steps over which errors are averaged.
const PHASES: usize = 8;

/// Errors at each step with both integrators; `error` measures one.
pub(super) fn convergences(
    (quantity, setting): (&str, &str),
    steps: &Steps,
    expected_order: [f64; 2],
    error: impl Fn(Means, f64) -> Result<f64, ClaimError>,
) -> Result<Vec<Convergence>, ClaimError> {
    let with = |means: Means| {
        let errors: Result<Vec<f64>, _> = steps.lengths.iter().map(|h| error(means, *h)).collect();
        Ok(Convergence::new(
            quantity,
            &format!("{setting}, {}", means.name()),
            steps.unit,
            &steps.lengths,
            &errors?,
            expected_order,
        ))
    };
    Means::INTEGRATORS.into_iter().map(with).collect()
}

/// Errors of an impact.
pub(super) fn impact_convergences(
    names: (&str, &str),
    impact: &Impact,
    contact_time: f64,
    expected_order: [f64; 2],
    error: impl Fn(&Rebound) -> f64,
) -> Result<Vec<Convergence>, ClaimError> {
    convergences(names, &PER_CONTACT, expected_order, |means, step| {
        error_of(impact, means, (contact_time, 1.0 / step), &error)
    })
}

/// Root mean square of the error of an impact, over places of the onset within a step and over steps of which between `steps`
/// and one more fit into the contact.
///
/// Onset and end fall within a step at places that matter alike: with one step only, the two could cancel.
pub(super) fn error_of(
    impact: &Impact,
    means: Means,
    (contact_time, steps): (f64, f64),
    error: impl Fn(&Rebound) -> f64,
) -> Result<f64, ClaimError> {
    let mut sum = 0.0;
    for place in 0..PHASES {
        let part = |number: usize| ((number % PHASES) as f64 + 0.5) / PHASES as f64;
        let time_step = contact_time / (steps + part(3 * place));
        sum += error(&impact.simulate(means, time_step, part(place))?).powi(2);
    }
    Ok((sum / PHASES as f64).sqrt())
}

/// Restitution of an impact, the root mean square over onsets and steps: its scatter is far below e.
pub(super) fn measured_restitution(
    impact: &Impact,
    contact_time: f64,
    steps: f64,
) -> Result<f64, ClaimError> {
    error_of(impact, Means::USUAL, (contact_time, steps), |rebound| {
        impact.restitution(rebound.velocity)
    })
}

/// Largest difference that rounding may make between two kernels after an impact, over the speed.
const KERNELS_AGREE: f64 = 1e-9;

/// The fast kernels against the plain one, with both integrators: largest difference of velocities and spins after the
/// impact, over its speed.
pub(super) fn kernels_agree(
    setting: &str,
    impact: &Impact,
    time_step: f64,
) -> Result<Check, ClaimError> {
    let mut largest = 0.0_f64;
    for means in Means::INTEGRATORS {
        let fast = impact.simulate(means, time_step, 0.5)?;
        let plain = impact.simulate(means.plainly(), time_step, 0.5)?;
        for i in 0..2 {
            let apart = (fast.velocity[i] - plain.velocity[i]).length();
            largest = largest.max(apart).max((fast.spin[i] - plain.spin[i]).abs());
        }
    }
    let difference = largest / impact.relative_velocity().length();
    let quantity = "fast kernels less plain kernel, over the speed";
    let check = Check::absolute(quantity, setting, 0.0, difference, KERNELS_AGREE);
    Ok(check.by("the plain kernel"))
}

/// Errors against the time step, one panel for each titled group, with slopes of order 1 and 2 to compare with.
pub(super) fn error_drawing(
    description: &str,
    steps: &Steps,
    groups: &[(&str, &[Convergence])],
) -> Result<Drawing, FigureError> {
    let panels = groups.iter().map(|(title, group)| {
        let panel = ChartPanel::new(steps.label, "relative error")
            .title(title)
            .x_scale(Scale::Logarithmic)
            .y_scale(Scale::Logarithmic);
        error_panel(panel, group)
    });
    let width = if groups.len() > 1 {
        Width::DoubleColumn
    } else {
        Width::SingleColumn
    };
    let figure = ChartFigure::grid(groups.len(), panels).description(description);
    figure.width(width).draw()
}

fn error_panel(mut panel: ChartPanel, convergences: &[Convergence]) -> ChartPanel {
    let (mut top, mut ends) = (0.0_f64, [1.0_f64, 0.0]);
    for (number, convergence) in convergences.iter().enumerate() {
        let Convergence { steps, errors, .. } = convergence;
        top = errors.iter().copied().fold(top, f64::max);
        for step in steps {
            ends = [ends[0].min(*step), ends[1].max(*step)];
        }
        // A setting ends with the integrator.
        let integrator = convergence.setting.rsplit(", ").next().unwrap_or_default();
        let name = format!("{}, {integrator}", convergence.quantity);
        let points = Points::new(&name, steps, errors)
            .series(number / 2)
            .joined();
        panel = panel.with(if number % 2 == 0 {
            points
        } else {
            points.open()
        });
    }
    for (order, pattern) in [(1.0, Pattern::Dotted), (2.0, Pattern::Dashed)] {
        let at = |step: f64| 2.0 * top * libm::pow(step / ends[1], order);
        let line = Line::new(&format!("order {order}"), &ends, &ends.map(at));
        panel = panel.with(line.pattern(pattern).tint(Tint::Grey));
    }
    panel
}
