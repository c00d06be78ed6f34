//! Newtonian peristalsis: the reference against which the transport of grains is drawn.
//!
//! A viscous fluid in a round tube whose wall radius carries a travelling sine wave, in the limit of a long wave
//! (a << lambda) and of no inertia. Source: Shapiro, Jaffrin & Weinberg, J. Fluid Mech. 37, 799 (1969), the
//! axisymmetric case. With G = dP/dx the momentum balance is Poiseuille's at every section,
//!
//! u(r, x) = -2 G (h^2 - r^2),   h(x) = 1 + phi sin(2 pi x),
//!
//! and the flow rate of the wave frame, q, is the same at every section: G = -(q + h^2)/h^4.
//!
//! Units. Radial lengths: mean radius a. Axial lengths: wavelength lambda, so that `position` x = (z - c t)/lambda counts
//! wavelengths along the wave; the belly is at x = 1/4, the throat at x = 3/4. Velocities: wave speed c (radial ones
//! c a/lambda). Times: period lambda/c. Flow rates: pi a^2 c. Pressures: 8 mu c lambda/a^2. Stream functions: c a^2.
//!
//! Signs. z, axial velocities and flow rates are positive along the wave. The pressure rise is positive where the
//! pressure grows along the wave, which is what the wave has to pump against.

mod field;
mod quadrature;
mod reflux;
mod trapping;

pub use reflux::RefluxLayer;
pub use trapping::{Trapping, trapping_threshold};

use std::f64::consts::{PI, TAU};

/// Peristaltic flow of a Newtonian fluid at one amplitude of the wave and one pressure rise.
///
/// Q = 1 + phi^2/2 + q,   q = -[(1 - phi^2)^2 + P (1 - phi^2)^(7/2)]/(1 + 3 phi^2/2)
///
/// phi = b/a amplitude ratio, P = a^2 Dp/(8 mu c lambda) pressure rise over one wavelength, Q time-mean flow rate and
/// q flow rate in the wave frame, both in pi a^2 c. Range: 0 <= phi <= 1, every finite P. At phi = 1 the throat is
/// closed and Q = 3/2 = 1 + phi^2/2 whatever the pressure.
/// Source: Shapiro, Jaffrin & Weinberg, J. Fluid Mech. 37, 799 (1969).
///
/// ```
/// use peristalsis_physics::newtonian::NewtonianPeristalsis;
/// let flow = NewtonianPeristalsis::free_pumping(0.5).expect("an amplitude ratio from 0 to 1");
/// // phi^2 (16 - phi^2)/(2 (2 + 3 phi^2)) = 0.25 * 15.75/5.5
/// assert!((flow.flow_rate() - 3.9375 / 5.5).abs() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NewtonianPeristalsis {
    amplitude_ratio: f64,
    pressure: f64,
}

impl NewtonianPeristalsis {
    /// Flow at amplitude ratio phi = b/a and pressure rise P; `None` unless 0 <= phi <= 1 and P is finite.
    pub fn new(amplitude_ratio: f64, pressure: f64) -> Option<Self> {
        let valid = (0.0..=1.0).contains(&amplitude_ratio) && pressure.is_finite();
        valid.then_some(Self {
            amplitude_ratio,
            pressure,
        })
    }

    /// Flow against no pressure, P = 0, at amplitude ratio phi; `None` unless 0 <= phi <= 1.
    pub fn free_pumping(amplitude_ratio: f64) -> Option<Self> {
        Self::new(amplitude_ratio, 0.0)
    }

    /// Flow in a tube of mean radius a whose bottleneck has width w: phi = b/a = 1 - w/(2a).
    ///
    /// `width` and `radius` in one unit of length. The same formula gives the clear bore between spheres of diameter d
    /// with width w - d and radius a - d/2. `None` unless 0 <= w <= 2a, and a and P are finite.
    pub fn from_width(width: f64, radius: f64, pressure: f64) -> Option<Self> {
        if !radius.is_finite() {
            return None;
        }
        Self::new(1.0 - width / (2.0 * radius), pressure)
    }

    /// Flow that moves the time-mean flow rate Q: the pump characteristic read the other way.
    ///
    /// P = -[(q (1 + 3 phi^2/2))/(1 - phi^2)^(7/2) + (1 - phi^2)^(-3/2)],   q = Q - 1 - phi^2/2
    ///
    /// `None` unless 0 <= phi < 1 (a closed throat moves one flow rate only) and Q is finite.
    pub fn from_flow_rate(amplitude_ratio: f64, flow_rate: f64) -> Option<Self> {
        let geometry = Self::free_pumping(amplitude_ratio)?;
        let wave_flow_rate = flow_rate - geometry.mean_area();
        let pressure =
            -wave_flow_rate * geometry.mean_inverse_fourth() - geometry.mean_inverse_square();
        Self::new(amplitude_ratio, pressure)
    }

    /// Amplitude ratio phi = b/a.
    pub fn amplitude_ratio(&self) -> f64 {
        self.amplitude_ratio
    }

    /// Pressure rise over one wavelength, P = a^2 Dp/(8 mu c lambda).
    pub fn pressure(&self) -> f64 {
        self.pressure
    }

    /// Time-mean flow rate in the laboratory, Q/(pi a^2 c), positive along the wave.
    pub fn flow_rate(&self) -> f64 {
        self.mean_area() + self.wave_frame_flow_rate()
    }

    /// Flow rate divided by the flow rate if the wave carried all the fluid along: Q/(1 + phi^2/2), the J/Jmax of a fluid.
    pub fn flow_rate_ratio(&self) -> f64 {
        self.flow_rate() / self.mean_area()
    }

    /// Flow rate through every section in the wave frame, q/(pi a^2 c); negative where the fluid lags the wave.
    pub fn wave_frame_flow_rate(&self) -> f64 {
        let open = 1.0 - self.amplitude_ratio * self.amplitude_ratio;
        -(open * open + self.pressure * open * open * open * open.sqrt()) / self.fourth_moment()
    }

    /// Largest pumping flow rate, that at P = 0: phi^2 (16 - phi^2)/(2 (2 + 3 phi^2)).
    pub fn free_pumping_flow_rate(&self) -> f64 {
        let square = self.amplitude_ratio * self.amplitude_ratio;
        square * (16.0 - square) / (2.0 * (2.0 + 3.0 * square))
    }

    /// Largest pumping pressure P0, that at which Q = 0: phi^2 (16 - phi^2)/(4 (1 - phi^2)^(7/2)).
    ///
    /// Infinite at phi = 1, where the closed throat holds any pressure.
    pub fn zero_flow_pressure(&self) -> f64 {
        let square = self.amplitude_ratio * self.amplitude_ratio;
        let open = 1.0 - square;
        square * (16.0 - square) / (4.0 * open * open * open * open.sqrt())
    }

    /// Radius of the wall, h(x) = 1 + phi sin(2 pi x), in a.
    pub fn wall_radius(&self, position: f64) -> f64 {
        1.0 + self.amplitude_ratio * libm::sin(TAU * position)
    }

    /// Pressure gradient dP/dx = -(q + h^2)/h^4 at `position`, in 8 mu c/a^2.
    ///
    /// Undefined (not a number, or infinite) in the closed throat at phi = 1.
    pub fn pressure_gradient(&self, position: f64) -> f64 {
        let area = self.wall_radius(position) * self.wall_radius(position);
        -(self.wave_frame_flow_rate() + area) / (area * area)
    }

    /// Pressure at `position` less that at position 0, in 8 mu c lambda/a^2; it rises by P at every wavelength.
    ///
    /// The integrals of h^-2 and h^-4 are taken in closed form with Sommerfeld's substitution: from the belly at angle
    /// theta = 0, 1 + phi cos(theta) = (1 - phi^2)/(1 - phi cos(gamma)), which turns them into
    /// (1 - phi^2)^(1/2 - n) int (1 - phi cos(gamma))^(n - 1) dgamma. Range: phi < 1.
    pub fn pressure_along_wave(&self, position: f64) -> f64 {
        self.pressure_from_belly(TAU * position - 0.5 * PI) - self.pressure_from_belly(-0.5 * PI)
    }

    /// Pumping efficiency: useful power Q Dp over the power of the wall.
    ///
    /// E = Q P/[P (1 + phi^2/2) + 1 + q (1 - phi^2)^(-3/2)]
    ///
    /// The denominator is the mean of the wall's work against the pressure, int p d(h^2)/dx dx, in units of
    /// 8 pi mu c^2 lambda per wavelength; the rest of the power, <(1 + q/h^2)^2>, is dissipated. `None` where the wave does
    /// not pump: unless P > 0 and Q > 0.
    pub fn efficiency(&self) -> Option<f64> {
        let pumps = self.pressure > 0.0 && self.flow_rate() > 0.0;
        pumps.then(|| self.flow_rate() * self.pressure / self.wall_power())
    }

    /// Mean power of the wall on the fluid of one wavelength, in 8 pi mu c^2 lambda.
    ///
    /// W = P (1 + phi^2/2) + 1 + q (1 - phi^2)^(-3/2); negative where an imposed flow drives the wall. The last term is 0 at
    /// phi = 1.
    pub fn wall_power(&self) -> f64 {
        let lost = match self.amplitude_ratio < 1.0 {
            true => self.wave_frame_flow_rate() * self.mean_inverse_square(),
            false => 0.0,
        };
        self.pressure * self.mean_area() + 1.0 + lost
    }

    /// <h^2> = 1 + phi^2/2, the mean section of the tube.
    fn mean_area(&self) -> f64 {
        1.0 + 0.5 * self.amplitude_ratio * self.amplitude_ratio
    }

    /// 1 + 3 phi^2/2 = <h^-4> (1 - phi^2)^(7/2), finite up to phi = 1.
    fn fourth_moment(&self) -> f64 {
        1.0 + 1.5 * self.amplitude_ratio * self.amplitude_ratio
    }

    /// <h^-2> = (1 - phi^2)^(-3/2).
    fn mean_inverse_square(&self) -> f64 {
        let open = 1.0 - self.amplitude_ratio * self.amplitude_ratio;
        1.0 / (open * open.sqrt())
    }

    /// <h^-4> = (1 + 3 phi^2/2) (1 - phi^2)^(-7/2).
    fn mean_inverse_fourth(&self) -> f64 {
        let open = 1.0 - self.amplitude_ratio * self.amplitude_ratio;
        self.fourth_moment() / (open * open * open * open.sqrt())
    }

    /// Pressure at angle theta from the belly less that in the belly.
    fn pressure_from_belly(&self, angle: f64) -> f64 {
        let ratio = self.amplitude_ratio;
        let open = 1.0 - ratio * ratio;
        let root = open.sqrt();
        let shift = ratio / (1.0 + root);
        let sommerfeld =
            angle - 2.0 * libm::atan2(shift * libm::sin(angle), 1.0 + shift * libm::cos(angle));
        let (sine, cosine) = (libm::sin(sommerfeld), libm::cos(sommerfeld));
        let inverse_square = (sommerfeld - ratio * sine) / (open * root);
        let inverse_fourth = (sommerfeld - 3.0 * ratio * sine
            + 1.5 * ratio * ratio * (sommerfeld + sine * cosine)
            - ratio * ratio * ratio * sine * (1.0 - sine * sine / 3.0))
            / (open * open * open * root);
        -(self.wave_frame_flow_rate() * inverse_fourth + inverse_square) / TAU
    }
}

#[cfg(test)]
mod tests {
    use super::NewtonianPeristalsis;
    use proptest::prelude::*;

    const CASES: [(f64, f64); 8] = [
        (0.0, 0.0),
        (0.0, 0.4),
        (0.1, -0.8),
        (0.3, 0.0),
        (0.45, 0.7),
        (0.6, -2.0),
        (0.6, 3.0),
        (0.8, 20.0),
    ];

    pub(super) fn flow(amplitude_ratio: f64, pressure: f64) -> NewtonianPeristalsis {
        NewtonianPeristalsis::new(amplitude_ratio, pressure).unwrap()
    }

    /// Axial velocity in the wave frame, u - c, in c: negative where the fluid lags the wave, -1 at the wall.
    pub(super) fn wave_frame_velocity(
        flow: &NewtonianPeristalsis,
        radius: f64,
        position: f64,
    ) -> f64 {
        flow.axial_velocity(radius, position) - 1.0
    }

    /// Mean of a function of the position over one wavelength, by the midpoint rule (exponentially exact for a period).
    fn wave_mean(function: impl Fn(f64) -> f64) -> f64 {
        let samples = 4000;
        let sum: f64 = (0..samples)
            .map(|k| function((f64::from(k) + 0.5) / f64::from(samples)))
            .sum();
        sum / f64::from(samples)
    }

    /// int_0^1 f(s) ds by Simpson's rule, exact here because f is a polynomial of degree one in s = (r/h)^2.
    fn section_mean(function: impl Fn(f64) -> f64) -> f64 {
        (function(0.0) + 4.0 * function(0.5) + function(1.0)) / 6.0
    }

    #[test]
    fn mean_flow_rate_is_the_integral_of_the_velocity_field() {
        for (amplitude_ratio, pressure) in CASES {
            let flow = flow(amplitude_ratio, pressure);
            let integral = wave_mean(|position| {
                let wall = flow.wall_radius(position);
                wall * wall * section_mean(|s| flow.axial_velocity(wall * s.sqrt(), position))
            });
            assert!(
                (flow.flow_rate() - integral).abs() < 1e-12,
                "{flow:?} {integral}"
            );
        }
    }

    #[test]
    fn the_flow_through_a_section_is_the_integral_of_its_velocity() {
        let flow = flow(0.6, 3.0);
        for position in [0.0, 0.25, 0.4, 0.75] {
            let wall = flow.wall_radius(position);
            let integral =
                wall * wall * section_mean(|s| flow.axial_velocity(wall * s.sqrt(), position));
            let expected = flow.wave_frame_flow_rate() + wall * wall;
            assert!((integral - expected).abs() < 1e-13);
        }
    }

    #[test]
    fn the_pressure_gradient_integrates_to_the_pressure_rise() {
        for (amplitude_ratio, pressure) in CASES {
            let flow = flow(amplitude_ratio, pressure);
            let integral = wave_mean(|position| flow.pressure_gradient(position));
            assert!(
                (integral - pressure).abs() < 1e-10,
                "{flow:?} gives {integral}"
            );
        }
    }

    #[test]
    fn pressure_along_the_wave_is_the_running_integral_of_its_gradient() {
        for (amplitude_ratio, pressure) in CASES {
            let flow = flow(amplitude_ratio, pressure);
            for end in [0.1_f64, 0.25, 0.6, 0.75, 1.0, 1.3, -0.4] {
                let cells = 4000;
                let step = end / f64::from(2 * cells);
                let simpson: f64 = (0..cells)
                    .map(|k| {
                        let start = f64::from(2 * k) * step;
                        flow.pressure_gradient(start)
                            + 4.0 * flow.pressure_gradient(start + step)
                            + flow.pressure_gradient(start + 2.0 * step)
                    })
                    .sum();
                let expected = simpson * step / 3.0;
                let found = flow.pressure_along_wave(end);
                assert!(
                    (found - expected).abs() < 1e-8,
                    "{flow:?} at {end}: {found}, {expected}"
                );
            }
        }
    }

    #[test]
    fn free_pumping_and_zero_flow_are_the_ends_of_the_pump_characteristic() {
        for amplitude_ratio in [0.05, 0.2, 0.5, 0.9] {
            let free = flow(amplitude_ratio, 0.0);
            assert!((free.flow_rate() - free.free_pumping_flow_rate()).abs() < 1e-14);
            let shut = flow(amplitude_ratio, free.zero_flow_pressure());
            assert!(shut.flow_rate().abs() < 1e-13);
            // Q/Q0 = 1 - P/P0 between them and beyond.
            for fraction in [0.25, 0.5, 1.5] {
                let loaded = flow(amplitude_ratio, fraction * free.zero_flow_pressure());
                let expected = free.free_pumping_flow_rate() * (1.0 - fraction);
                assert!((loaded.flow_rate() - expected).abs() < 1e-13);
            }
        }
    }

    #[test]
    fn a_closed_throat_carries_the_fluid_with_the_wave() {
        let closed = flow(1.0, 3.0);
        assert_eq!(closed.flow_rate(), 1.5);
        assert_eq!(closed.flow_rate_ratio(), 1.0);
        assert!(closed.zero_flow_pressure().is_infinite());
        assert_eq!(NewtonianPeristalsis::from_flow_rate(1.0, 1.5), None);
        // The limit of nearly closed ones: Q P/(1 + 3 P/2).
        let efficiency = |ratio: f64| flow(ratio, 3.0).efficiency().unwrap();
        assert!((efficiency(1.0) - 4.5 / 5.5).abs() < 1e-15);
        assert!((efficiency(1.0 - 1e-14) - efficiency(1.0)).abs() < 1e-6);
    }

    #[test]
    fn invalid_arguments_are_refused_and_widths_become_amplitudes() {
        assert_eq!(NewtonianPeristalsis::new(-0.01, 0.0), None);
        assert_eq!(NewtonianPeristalsis::new(1.01, 0.0), None);
        assert_eq!(NewtonianPeristalsis::new(f64::NAN, 0.0), None);
        assert_eq!(NewtonianPeristalsis::new(0.5, f64::INFINITY), None);
        assert_eq!(NewtonianPeristalsis::from_width(3.1, 1.5, 0.0), None);
        assert_eq!(NewtonianPeristalsis::from_width(1.0, 0.0, 0.0), None);
        let flow = NewtonianPeristalsis::from_width(2.4, 1.5, 0.0).unwrap();
        assert!((flow.amplitude_ratio() - 0.2).abs() < 1e-15);
        // At phi = 0.2: Q = 0.04 * 15.96/(2 * 2.12), over 1.02.
        assert!((flow.flow_rate_ratio() - 0.04 * 15.96 / 4.24 / 1.02).abs() < 1e-15);
    }

    #[test]
    fn wall_power_is_useful_power_and_viscous_dissipation() {
        for (amplitude_ratio, pressure) in CASES {
            let flow = flow(amplitude_ratio, pressure);
            // mu (du/dr)^2 over the section, in 8 pi mu c^2: (1/8) int (du/dr)^2 d(r^2), with du/dr = 4 G r.
            let dissipation = wave_mean(|position| {
                let wall = flow.wall_radius(position);
                let shear = |s: f64| {
                    let radius = wall * s.sqrt();
                    let step = 1e-4;
                    let difference = flow.axial_velocity(radius + step, position)
                        - flow.axial_velocity(radius - step, position);
                    difference / (2.0 * step)
                };
                wall * wall * section_mean(|s| shear(s) * shear(s)) / 8.0
            });
            let useful = flow.flow_rate() * pressure;
            assert!((flow.wall_power() - useful - dissipation).abs() < 1e-8 * (1.0 + dissipation));
        }
    }

    #[test]
    fn efficiency_vanishes_at_both_ends_of_the_pumping_range_and_only_there() {
        let limit = flow(0.6, 0.0).zero_flow_pressure();
        assert_eq!(flow(0.6, 0.0).efficiency(), None);
        assert_eq!(flow(0.6, 1.01 * limit).efficiency(), None);
        assert!(flow(0.6, 1e-6 * limit).efficiency().unwrap() < 1e-4);
        assert!(flow(0.6, (1.0 - 1e-6) * limit).efficiency().unwrap() < 1e-4);
        let middle = flow(0.6, 0.5 * limit).efficiency().unwrap();
        assert!(middle > 0.1 && middle < 1.0, "{middle}");
    }

    proptest! {
        #[test]
        fn flow_rate_and_pressure_invert_each_other(ratio in 0.0..0.95_f64, pressure in -5.0..50.0_f64) {
            let forward = flow(ratio, pressure);
            let back = NewtonianPeristalsis::from_flow_rate(ratio, forward.flow_rate()).unwrap();
            let scale = forward.mean_inverse_fourth() + pressure.abs();
            prop_assert!((back.pressure() - pressure).abs() < 1e-13 * scale);
        }
    }
}
