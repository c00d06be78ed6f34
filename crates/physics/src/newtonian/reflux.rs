//! Reflux: fluid near the wall that moves back, on average, while the wave pumps forward.
//!
//! A particle of the wall layer stays on its streamline and falls back by one wavelength relative to the wave in the
//! time T(Psi) = <1/|u - c|> lambda/c, the mean over the wave. In the laboratory it has then moved by c T - lambda. With
//! the height of the streamline above the wall's, epsilon = Psi - q/2, the stream function gives
//! |u - c| = sqrt(1 + 8 epsilon dP/dx), hence
//!
//! T(epsilon) = < (1 + 8 epsilon dP/dx)^(-1/2) > = 1 - 4 epsilon P + O(epsilon^2),   mean velocity U = 1 - 1/T.
//!
//! Near the wall U = -4 epsilon P. The function (1 + y)^(-1/2) is convex, so that T >= (1 + 8 epsilon P)^(-1/2) at every
//! depth (Jensen): in a round tube there is reflux if and only if P > 0: at every flow rate below the flow rate of free
//! pumping. Derived here from the stream function of Shapiro, Jaffrin & Weinberg, J. Fluid Mech. 37, 799 (1969).

use super::NewtonianPeristalsis;
use super::quadrature::{integrate, sign_change};
use super::trapping::Trapping;
use std::f64::consts::PI;

/// The fluid that moves back on average: the layer between the wall and one streamline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RefluxLayer {
    /// Psi of its inner edge, whose particles stay where they are on average, in c a^2; 0 if all fluid moves back.
    pub stream_function: f64,
    /// Volume of the layer over the volume of the tube, 0 ... 1; 1 if all fluid moves back.
    pub volume_fraction: f64,
    /// Time-mean flow rate of the layer in the laboratory, in pi a^2 c; negative.
    pub flow_rate: f64,
}

impl NewtonianPeristalsis {
    /// The layer that moves back, or `None` where no fluid does: P <= 0, or a closed throat.
    ///
    /// Its inner edge is the zero of U (accuracy about 1e-12), and its flow rate is Q - max Q_Psi, Q_Psi being the mean
    /// flow rate between the axis and a streamline. Where even the fluid on the axis moves back, the layer is the whole
    /// tube.
    pub fn reflux(&self) -> Option<RefluxLayer> {
        let depth = self.wall_layer_height();
        if self.pressure <= 0.0 || self.amplitude_ratio == 1.0 || depth <= 0.0 {
            return None;
        }
        // A stagnation point holds the particles near it for ever: T diverges and U ends positive.
        let everywhere = self.kind_of_trapping().is_none() && self.transit_excess(depth) <= 0.0;
        let layer = if everywhere {
            RefluxLayer {
                stream_function: 0.0,
                volume_fraction: 1.0,
                flow_rate: self.flow_rate(),
            }
        } else {
            let height = sign_change(0.0, depth, |height| self.transit_excess(height));
            let volume =
                self.wall_layer_mean(|area, root| 4.0 * height * area / (area + root), height);
            RefluxLayer {
                stream_function: 0.5 * self.wave_frame_flow_rate() + height,
                volume_fraction: volume / self.mean_area(),
                flow_rate: self.wall_layer_mean(
                    |area, root| 2.0 * height * (area - root) / (area + root),
                    height,
                ),
            }
        };
        Some(layer)
    }

    /// Height in Psi, above the wall, of the streamlines that fall behind the wave.
    fn wall_layer_height(&self) -> f64 {
        let to_axis = -0.5 * self.wave_frame_flow_rate();
        match self.kind_of_trapping() {
            Some(Trapping::Ring) => to_axis + self.largest_stream_function_in_throat(),
            None | Some(Trapping::Bolus) => to_axis,
        }
    }

    /// (T - 1)/epsilon at the height epsilon of a streamline, written so that nothing cancels near the wall.
    fn transit_excess(&self, height: f64) -> f64 {
        let wave_flow_rate = self.wave_frame_flow_rate();
        self.wall_layer_mean(
            |area, root| 8.0 * (wave_flow_rate + area) / (root * (area + root)),
            height,
        )
    }

    /// Mean over the wave of a function of h^2 and of sqrt(h^4 - 8 (q + h^2) epsilon) = h^2 |u - c|.
    ///
    /// The streamline lies at r^2 = h^2 - 4 epsilon h^2/(h^2 + root).
    fn wall_layer_mean(&self, function: impl Fn(f64, f64) -> f64, height: f64) -> f64 {
        let wave_flow_rate = self.wave_frame_flow_rate();
        integrate(0.0, PI, |angle| {
            let wall = 1.0 + self.amplitude_ratio * libm::cos(angle);
            let area = wall * wall;
            let root = (area * area - 8.0 * (wave_flow_rate + area) * height)
                .max(f64::MIN_POSITIVE)
                .sqrt();
            function(area, root)
        }) / PI
    }
}

#[cfg(test)]
mod tests {
    use super::super::field::pathline;
    use super::super::tests::flow;
    use super::*;
    use proptest::prelude::*;

    /// U = 1 - 1/T on a streamline of the wall layer, in c: the mean velocity of its particles in the laboratory.
    fn mean_axial_velocity(flow: &NewtonianPeristalsis, stream_function: f64) -> f64 {
        let height = stream_function - 0.5 * flow.wave_frame_flow_rate();
        assert!(height < flow.wall_layer_height(), "beyond the wall layer");
        let excess = height * flow.transit_excess(height);
        excess / (1.0 + excess)
    }

    /// Mean velocity of a particle that passes the throat at this fraction of its radius, from its integrated path.
    fn integrated(flow: &NewtonianPeristalsis, fraction: f64) -> (f64, f64) {
        let radius = fraction * flow.wall_radius(0.75);
        let transit = pathline::transit_time(flow, radius);
        (
            flow.stream_function(radius, 0.75),
            (transit - 1.0) / transit,
        )
    }

    #[test]
    fn mean_velocity_is_that_of_integrated_particle_paths() {
        for (ratio, pressure) in [(0.2, 0.05), (0.4, 0.0), (0.4, 1.2), (0.6, 4.0), (0.3, -1.5)] {
            let flow = flow(ratio, pressure);
            for fraction in [0.9, 0.97] {
                let (stream_function, expected) = integrated(&flow, fraction);
                let found = mean_axial_velocity(&flow, stream_function);
                assert!(
                    (found - expected).abs() < 1e-6,
                    "{flow:?} at {fraction}: {found}, {expected}"
                );
            }
        }
    }

    #[test]
    fn particles_near_the_wall_move_back_exactly_against_a_pressure() {
        for (ratio, limit) in [(0.2, 0.2), (0.5, 3.0)] {
            for share in [0.1, 0.5, 0.9] {
                assert!(integrated(&flow(ratio, share * limit), 0.99).1 < 0.0);
                assert!(integrated(&flow(ratio, -share * limit), 0.99).1 > 0.0);
            }
            assert!(integrated(&flow(ratio, 0.0), 0.9).1 > 0.0);
        }
    }

    #[test]
    fn the_edge_of_the_layer_stays_where_it_is_and_its_sides_part() {
        for (ratio, pressure) in [(0.2, 0.1), (0.5, 1.0), (0.6, 5.0)] {
            let flow = flow(ratio, pressure);
            let layer = flow.reflux().unwrap();
            // Fraction of the throat's radius at which the edge passes, by bisection on the stream function.
            let throat = flow.wall_radius(0.75);
            let edge = sign_change(0.0, 1.0, |fraction| {
                layer.stream_function - flow.stream_function(fraction * throat, 0.75)
            });
            assert!(integrated(&flow, edge).1.abs() < 1e-6);
            assert!(integrated(&flow, 0.97 * edge).1 > 0.0);
            assert!(integrated(&flow, 1.0 - 0.5 * (1.0 - edge)).1 < 0.0);
        }
    }

    #[test]
    fn volume_and_flow_rate_of_the_layer_by_integration_of_its_velocity() {
        let flow = flow(0.5, 1.0);
        let layer = flow.reflux().unwrap();
        let (positions, cells) = (400, 400);
        let (mut volume, mut transported) = (0.0, 0.0);
        for i in 0..positions {
            let position = (f64::from(i) + 0.5) / f64::from(positions);
            let wall = flow.wall_radius(position);
            let edge = sign_change(0.0, wall, |radius| {
                layer.stream_function - flow.stream_function(radius, position)
            });
            let inner = edge * edge;
            let cell = (wall * wall - inner) / f64::from(cells);
            for k in 0..cells {
                let square: f64 = inner + (f64::from(k) + 0.5) * cell;
                volume += cell;
                transported += cell * flow.axial_velocity(square.sqrt(), position);
            }
        }
        let total = f64::from(positions) * flow.mean_area();
        assert!((layer.volume_fraction - volume / total).abs() < 1e-9);
        assert!((layer.flow_rate - transported / f64::from(positions)).abs() < 1e-6);
        assert!(layer.flow_rate < 0.0);
    }

    #[test]
    fn without_a_wave_a_pressure_drives_everything_back() {
        let flow = flow(0.0, 0.3);
        let layer = flow.reflux().unwrap();
        assert_eq!((layer.stream_function, layer.volume_fraction), (0.0, 1.0));
        assert!((layer.flow_rate + 0.3).abs() < 1e-15);
        // Poiseuille: u = -2 P (1 - r^2), here at r^2 = 1/2.
        let halfway = flow.stream_function(0.5_f64.sqrt(), 0.0);
        assert!((mean_axial_velocity(&flow, halfway) + 0.3).abs() < 1e-13);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn reflux_is_where_the_wave_pumps_against_a_pressure(
            ratio in 0.0..0.9_f64,
            pressure in -3.0..3.0_f64,
        ) {
            let flow = flow(ratio, pressure);
            prop_assert_eq!(flow.reflux().is_some(), pressure > 0.0);
            if let Some(layer) = flow.reflux() {
                prop_assert!(layer.flow_rate < 0.0);
                prop_assert!(layer.volume_fraction > 0.0 && layer.volume_fraction <= 1.0);
                prop_assert!(layer.stream_function > 0.5 * flow.wave_frame_flow_rate());
            }
        }

        #[test]
        fn slope_of_the_mean_velocity_at_the_wall_is_the_pressure(
            ratio in 0.0..0.6_f64,
            pressure in -1.0..3.0_f64,
        ) {
            let flow = flow(ratio, pressure);
            let height = 1e-7;
            let wall = 0.5 * flow.wave_frame_flow_rate();
            let slope = mean_axial_velocity(&flow, wall + height) / height;
            prop_assert!((slope + 4.0 * pressure).abs() < 1e-3);
        }
    }
}
