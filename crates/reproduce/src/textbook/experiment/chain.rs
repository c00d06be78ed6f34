//! A chain of grains along the axis of a periodic tube, pressed together.

use core::f64::consts::{PI, TAU};

use glam::DVec3;
use peristalsis_engine::{Bodies, Simulation};
use peristalsis_physics::contact::Normal;

use super::{Means, far_away, frictionless};
use crate::error::Result;
use crate::textbook::reference::ode::bisected;

/// A ring of grains of diameter and mass 1, closed by the period of the tube; each overlaps both neighbours.
///
/// The grains stand exactly on the axis, so that no force has a part across it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Chain {
    pub(crate) normal: Normal,
    pub(crate) grains: usize,
    /// xi_0, the overlap at rest \[d\].
    pub(crate) overlap: f64,
    /// Amplitude of the wave over xi_0.
    pub(crate) amplitude: f64,
}

impl Chain {
    /// Distance of neighbours at rest \[d\].
    pub(crate) fn spacing(&self) -> f64 {
        1.0 - self.overlap
    }

    /// Wavenumber of the standing wave with `mode` waves around the ring \[1/d\].
    pub(crate) fn wavenumber(&self, mode: usize) -> f64 {
        TAU * mode as f64 / (self.grains as f64 * self.spacing())
    }

    /// Frequency of a standing wave \[1/t\], from the times at which its amplitude passes 0 in so many half periods.
    ///
    /// # Errors
    /// Errors of the engine.
    pub(crate) fn frequency(
        &self,
        mode: usize,
        half_periods: usize,
        means: Means,
        time_step: f64,
    ) -> Result<f64> {
        let spacing = self.spacing();
        let shape: Vec<f64> = (0..self.grains)
            .map(|j| libm::cos(TAU * (mode * j % self.grains) as f64 / self.grains as f64))
            .collect();
        let rest = |j: usize| (j as f64 + 0.5) * spacing;
        let places = shape.iter().enumerate().map(|(j, shape)| {
            DVec3::new(0.0, 0.0, rest(j) + self.amplitude * self.overlap * shape)
        });
        let bodies = Bodies::grains_at_rest(places.collect(), vec![1.0; self.grains]);
        let length = self.grains as f64 * spacing;
        let parameters = means.parameters(frictionless(self.normal), time_step, 0.3);
        let mut simulation = Simulation::new(bodies, far_away(20.0, length), parameters);
        // Amplitude of the mode and its rate.
        let amplitude = |simulation: &Simulation| {
            let bodies = simulation.bodies();
            let (mut amplitude, mut rate) = (0.0, 0.0);
            for (j, shape) in shape.iter().enumerate() {
                amplitude += shape * (bodies.unfolded(j, length) - rest(j));
                rate += shape * bodies.velocity[j].z;
            }
            (amplitude, rate)
        };
        let mut crossings = Vec::new();
        let mut before = amplitude(&simulation);
        while crossings.len() <= half_periods {
            let start = simulation.time();
            simulation.advance(1)?;
            let after = amplitude(&simulation);
            if before.0 * after.0 <= 0.0 && before.0 != 0.0 {
                crossings.push(start + time_step * root_of_cubic(before, after, time_step));
            }
            before = after;
        }
        let (first, last) = (crossings[0], crossings[half_periods]);
        Ok(PI * half_periods as f64 / (last - first))
    }
}

/// Where in a step the cubic through values and rates at its ends passes 0, as a fraction.
fn root_of_cubic(from: (f64, f64), to: (f64, f64), time_step: f64) -> f64 {
    let (p0, m0, p1, m1) = (from.0, time_step * from.1, to.0, time_step * to.1);
    let cubic = 2.0 * (p0 - p1) + m0 + m1;
    let square = 3.0 * (p1 - p0) - 2.0 * m0 - m1;
    let value = |s: f64| ((cubic * s + square) * s + m0) * s + p0;
    let [low, high] = bisected([0.0, 1.0], 60, |s| value(s) * p0 > 0.0);
    0.5 * (low + high)
}
