//! A simulation as it is, looked at once for all observables.

use peristalsis_engine::{Bodies, Ends, Simulation};

use crate::shape::TubeShape;

/// A simulation between two steps, with the tube's shape and who is inside it.
#[derive(Clone, Debug)]
pub struct View<'a> {
    pub(crate) simulation: &'a Simulation,
    pub(crate) shape: TubeShape,
    /// Of each grain whether it is inside the tube, between its ends.
    pub(crate) inside: Vec<bool>,
}

impl<'a> View<'a> {
    /// The simulation now.
    pub fn of(simulation: &'a Simulation) -> Self {
        let shape = TubeShape::of(simulation);
        let bodies = simulation.bodies();
        let inside = |grain| !has_escaped(bodies, grain, &shape) && simulation.is_present(grain);
        let inside = (0..bodies.grains).map(inside);
        Self {
            simulation,
            inside: inside.collect(),
            shape,
        }
    }

    /// Grains outside the tube: their centre is farther from the axis than R + d/2. Those that wait at the inlet do not count.
    pub fn escaped(&self) -> usize {
        let outside = self.inside.iter().filter(|&&inside| !inside).count();
        outside - self.simulation.ends().map_or(0, Ends::waiting)
    }

    /// Largest distance from the axis that a grain of its size can have where it is, R - (d_w + d)/2 \[d\].
    fn room(&self, grain: usize) -> f64 {
        let bodies = self.simulation.bodies();
        let thickness = self.simulation.wall().sphere_diameter() + bodies.diameter[grain];
        self.shape.radius(bodies.position[grain].z) - 0.5 * thickness
    }

    /// r/(R - (d_w + d)/2): 0 on the axis, 1 where a grain touches a smooth wall, above 1 where it is pressed into it or
    /// stands in a gap between its spheres.
    pub(crate) fn radial_place(&self, grain: usize) -> f64 {
        let position = self.simulation.bodies().position[grain];
        self.over_room(position.x.hypot(position.y), grain)
    }

    /// A distance from the axis, or a height above it, over the room that a grain has where it is; infinite without room.
    pub(crate) fn over_room(&self, distance: f64, grain: usize) -> f64 {
        let room = self.room(grain);
        if room > 0.0 {
            distance / room
        } else {
            f64::INFINITY.copysign(distance)
        }
    }

    /// J from the velocities of the grains inside the tube, along the wave \[1/t\].
    pub fn instantaneous_flow_rate(&self) -> f64 {
        let (bodies, wall) = (self.simulation.bodies(), self.simulation.wall());
        let grains = bodies.velocity.iter().zip(&self.inside);
        let flux: f64 = grains
            .filter(|&(_, &inside)| inside)
            .map(|(velocity, _)| velocity.z)
            .sum();
        wall.heading() * flux / self.simulation.length()
    }
}

/// Whether a grain's centre lies outside R + d/2, R the wall's radius at its z and d its diameter.
#[inline]
fn has_escaped(bodies: &Bodies, grain: usize, shape: &TubeShape) -> bool {
    let position = bodies.position[grain];
    let from_axis_squared = position.x * position.x + position.y * position.y;
    let beyond = |limit: f64| from_axis_squared > limit * limit;
    let half = 0.5 * bodies.diameter[grain];
    // Nearly all grains are within the throat's radius, and need no look at the wall where they are.
    beyond(shape.least_radius() + half) && beyond(shape.radius(position.z) + half)
}

/// The greatest whole number that is not above x, for |x| < 2^63. It truncates, since rounding is a call of the library on
/// processors without an instruction for it.
#[inline]
pub(crate) fn floor(x: f64) -> f64 {
    let whole = x as i64 as f64;
    whole - f64::from(u8::from(whole > x))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn truncation_rounds_down_as_the_library_does() {
        for x in [
            0.0, 0.25, 1.0, -0.25, -1.0, -1.75, 1e-300, -1e-300, 2.5e15, -2.5e15, 4e18,
        ] {
            assert_eq!(floor(x), x.floor(), "{x}");
        }
    }
}
