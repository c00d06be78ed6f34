//! Velocities and stream function of Newtonian peristalsis.

use super::NewtonianPeristalsis;
use std::f64::consts::TAU;

impl NewtonianPeristalsis {
    /// Axial velocity in the laboratory, u = 2 (q + h^2)/h^4 (h^2 - r^2), in c, positive along the wave.
    ///
    /// `radius` r in a, 0 <= r <= h(x); `position` x in wavelengths. Zero at the wall, which moves only radially.
    /// Undefined in the closed throat at phi = 1.
    pub fn axial_velocity(&self, radius: f64, position: f64) -> f64 {
        let wall = self.wall_radius(position);
        -2.0 * self.pressure_gradient(position) * (wall * wall - radius * radius)
    }

    /// Radial velocity, the same in both frames, in c a/lambda, positive outward.
    ///
    /// v = -(1/r) dPsi/dx = -(h^2)' (r/h^2) [1 - s/2 - (1 + q/h^2)(1 - s)],   s = (r/h)^2
    ///
    /// At the wall it is the wall's own velocity, dh/dt = -h'. Arguments as in
    /// [`axial_velocity`](Self::axial_velocity).
    pub fn radial_velocity(&self, radius: f64, position: f64) -> f64 {
        let wall = self.wall_radius(position);
        let area = wall * wall;
        let area_slope = 2.0 * wall * self.amplitude_ratio * TAU * libm::cos(TAU * position);
        let section = radius * radius / area;
        let lead = 1.0 + self.wave_frame_flow_rate() / area;
        -area_slope * (radius / area) * (1.0 - 0.5 * section - lead * (1.0 - section))
    }

    /// Stokes' stream function in the wave frame, in c a^2.
    ///
    /// Psi = (q + h^2)(s - s^2/2) - h^2 s/2,   s = (r/h)^2,   u - c = (1/r) dPsi/dr
    ///
    /// Zero on the axis, q/2 at the wall; constant along the paths of the fluid, because the flow is steady in this
    /// frame. Arguments as in [`axial_velocity`](Self::axial_velocity).
    pub fn stream_function(&self, radius: f64, position: f64) -> f64 {
        let wall = self.wall_radius(position);
        let area = wall * wall;
        let section = radius * radius / area;
        (self.wave_frame_flow_rate() + area) * (section - 0.5 * section * section)
            - 0.5 * area * section
    }
}

#[cfg(test)]
pub(super) mod pathline {
    //! Paths of fluid particles, integrated from the velocities alone.

    use super::NewtonianPeristalsis;
    use crate::newtonian::tests::wave_frame_velocity;

    fn velocity(flow: &NewtonianPeristalsis, [position, radius]: [f64; 2]) -> [f64; 2] {
        [
            wave_frame_velocity(flow, radius, position),
            flow.radial_velocity(radius, position),
        ]
    }

    /// One Runge-Kutta step (order 4) of a particle at [position, radius] in the wave frame.
    pub(in super::super) fn advance(
        flow: &NewtonianPeristalsis,
        start: [f64; 2],
        step: f64,
    ) -> [f64; 2] {
        let at = |slope: [f64; 2], length: f64| {
            [start[0] + length * slope[0], start[1] + length * slope[1]]
        };
        let first = velocity(flow, start);
        let second = velocity(flow, at(first, 0.5 * step));
        let third = velocity(flow, at(second, 0.5 * step));
        let fourth = velocity(flow, at(third, step));
        let mean = |k: usize| (first[k] + 2.0 * second[k] + 2.0 * third[k] + fourth[k]) / 6.0;
        [start[0] + step * mean(0), start[1] + step * mean(1)]
    }

    /// Time [lambda/c] in which a particle that starts in the throat falls back by one wavelength.
    pub(in super::super) fn transit_time(flow: &NewtonianPeristalsis, radius: f64) -> f64 {
        let step = 2e-5;
        let mut position = [0.75, radius];
        let mut time = 0.0;
        loop {
            let next = advance(flow, position, step);
            if next[0] <= -0.25 {
                return time + step * (position[0] + 0.25) / (position[0] - next[0]);
            }
            position = next;
            time += step;
            assert!(time < 50.0, "the particle does not fall back");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::pathline;
    use crate::newtonian::tests::{flow, wave_frame_velocity};
    use proptest::prelude::*;
    use std::f64::consts::TAU;

    proptest! {
        #[test]
        fn the_field_is_that_of_its_stream_function(
            ratio in 0.0..0.8_f64,
            pressure in -3.0..3.0_f64,
            position in 0.0..1.0_f64,
            fraction in 0.05..0.95_f64,
        ) {
            let flow = flow(ratio, pressure);
            let radius = fraction * flow.wall_radius(position);
            let step = 1e-5;
            let along_radius = (flow.stream_function(radius + step, position)
                - flow.stream_function(radius - step, position)) / (2.0 * step);
            let along_axis = (flow.stream_function(radius, position + step)
                - flow.stream_function(radius, position - step)) / (2.0 * step);
            let axial = wave_frame_velocity(&flow, radius, position);
            let radial = flow.radial_velocity(radius, position);
            let scale = 1.0 + axial.abs() + radial.abs();
            prop_assert!((along_radius / radius - axial).abs() < 1e-5 * scale);
            prop_assert!((-along_axis / radius - radial).abs() < 1e-5 * scale);
        }

        #[test]
        fn the_wall_moves_only_radially_and_takes_the_fluid_along(
            ratio in 0.0..0.9_f64,
            pressure in -3.0..3.0_f64,
            position in 0.0..1.0_f64,
        ) {
            let flow = flow(ratio, pressure);
            let wall = flow.wall_radius(position);
            prop_assert!(flow.axial_velocity(wall, position).abs() < 1e-12);
            let wall_velocity = -ratio * TAU * libm::cos(TAU * position);
            prop_assert!((flow.radial_velocity(wall, position) - wall_velocity).abs() < 1e-12);
            let difference = flow.stream_function(wall, position) - 0.5 * flow.wave_frame_flow_rate();
            prop_assert!(difference.abs() < 1e-13);
            prop_assert_eq!(flow.stream_function(0.0, position), 0.0);
            prop_assert_eq!(flow.radial_velocity(0.0, position), 0.0);
        }
    }

    #[test]
    fn the_stream_function_is_constant_along_the_path_of_a_particle() {
        let flow = flow(0.5, 0.6);
        let mut position = [0.1, 1.1];
        let start = flow.stream_function(position[1], position[0]);
        for _ in 0..2000 {
            position = pathline::advance(&flow, position, 1e-3);
            assert!((flow.stream_function(position[1], position[0]) - start).abs() < 1e-8);
        }
        assert!(
            (position[0] - 0.1).abs() > 0.5,
            "the particle must have moved"
        );
    }

    #[test]
    fn poiseuille_flow_without_a_wave() {
        // phi = 0, P = -1: u = 2 (1 - r^2), mean flow rate 1.
        let flow = flow(0.0, -1.0);
        assert!((flow.flow_rate() - 1.0).abs() < 1e-15);
        assert!((flow.axial_velocity(0.5, 0.3) - 1.5).abs() < 1e-15);
    }
}
