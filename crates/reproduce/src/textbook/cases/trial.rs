//! Impacts as the cases measure them: by the engine in parts of the contact time, and by the equation of motion.

use glam::DVec3;

use super::errors::{Steps, convergences};
use super::material::Material;
use crate::error::Result;
use crate::textbook::experiment::Means;
use crate::textbook::experiment::impact::{Impact, Rebound};
use crate::textbook::reference::hertz::contact_time;
use crate::textbook::reference::impact::outcome;
use crate::textbook::reference::ode::bisected;
use crate::{Check, Convergence};

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
/// Largest difference that rounding may make between two kernels after an impact, over the speed.
const KERNELS_AGREE: f64 = 1e-9;

/// An impact with the duration of its undamped contact.
#[derive(Clone, Copy)]
pub(super) struct Trial {
    pub(super) impact: Impact,
    pub(super) contact_time: f64,
}

impl Trial {
    pub(super) fn of(impact: Impact) -> Self {
        let contact_time = contact_time(&impact);
        Self {
            impact,
            contact_time,
        }
    }

    /// The same with friction of the spheres' material.
    pub(super) fn with_friction(mut self, material: &Material, coefficient: f64) -> Self {
        let friction =
            material.friction(coefficient, self.impact.reduced_mass(), self.contact_time);
        self.impact.contact.friction = Some(friction);
        self
    }

    /// The motion after the impact at the finest step.
    pub(super) fn rebound(&self, means: Means) -> Result<Rebound> {
        self.impact.simulate(means, self.contact_time / FINE, 0.5)
    }

    /// Root mean square of the error of an impact, over places of the onset within a step and over steps of which between
    /// `steps` and one more fit into the contact.
    ///
    /// Onset and end fall within a step at places that matter alike: with one step only, the two could cancel.
    fn error(&self, means: Means, steps: f64, error: impl Fn(&Rebound) -> f64) -> Result<f64> {
        let mut sum = 0.0;
        for place in 0..PHASES {
            let part = |number: usize| ((number % PHASES) as f64 + 0.5) / PHASES as f64;
            let time_step = self.contact_time / (steps + part(3 * place));
            sum += error(&self.impact.simulate(means, time_step, part(place))?).powi(2);
        }
        Ok((sum / PHASES as f64).sqrt())
    }

    /// Restitution by the engine, the root mean square over onsets and steps: its scatter is far below e.
    pub(super) fn restitution(&self, steps: f64) -> Result<f64> {
        self.error(Means::USUAL, steps, |rebound| {
            self.impact.restitution(rebound.velocity)
        })
    }

    /// Errors against the time step with both integrators.
    pub(super) fn convergences(
        &self,
        names: (&str, &str),
        expected_order: [f64; 2],
        error: impl Fn(&Rebound) -> f64,
    ) -> Result<Vec<Convergence>> {
        convergences(names, &PER_CONTACT, expected_order, |means, step| {
            self.error(means, 1.0 / step, &error)
        })
    }

    /// The fast kernels against the reference kernel, with both integrators: largest difference of velocities and spins after the
    /// impact, over its speed.
    pub(super) fn kernels_agree(&self, setting: &str) -> Result<Check> {
        let mut largest = 0.0_f64;
        for means in Means::INTEGRATORS {
            let (fast, reference) = (self.rebound(means)?, self.rebound(means.by_reference())?);
            for i in 0..2 {
                let apart = (fast.velocity[i] - reference.velocity[i]).length();
                largest = largest
                    .max(apart)
                    .max((fast.spin[i] - reference.spin[i]).abs());
            }
        }
        let difference = largest / self.impact.relative_velocity().length();
        let quantity = "fast kernels less reference kernel, over the speed";
        let check = Check::absolute(quantity, setting, 0.0, difference, KERNELS_AGREE);
        Ok(check.by("the reference kernel"))
    }
}

/// e by the equation of motion.
pub(super) fn expected_restitution(impact: &Impact) -> f64 {
    impact.restitution(outcome(impact).velocity)
}

/// The dissipation time with which an impact, made by `impact`, has this restitution: bisection of the reference.
pub(super) fn dissipation_time(restitution: f64, impact: impl Fn(f64) -> Impact) -> f64 {
    if restitution >= 1.0 {
        return 0.0;
    }
    let ends = [0.0, 50.0 * contact_time(&impact(0.0))];
    let is_below = |time: f64| expected_restitution(&impact(time)) > restitution;
    let [low, high] = bisected(ends, 50, is_below);
    0.5 * (low + high)
}

/// Impacts with friction that differ in one number x.
pub(super) trait Sweep<const N: usize> {
    fn trial(&self, x: f64) -> Trial;

    /// The quantities of the sphere with this velocity and spin after the impact.
    fn read(&self, x: f64, velocity: DVec3, spin: f64) -> [f64; N];

    /// By the engine.
    fn simulated(&self, x: f64) -> Result<[f64; N]> {
        let found = self.trial(x).rebound(Means::USUAL)?;
        Ok(self.read(x, found.velocity[0], found.spin[0]))
    }

    /// By the equation of motion.
    fn integrated(&self, x: f64) -> [f64; N] {
        let found = outcome(&self.trial(x).impact);
        self.read(x, found.velocity[0], found.spin[0])
    }
}
