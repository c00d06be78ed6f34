//! How grains have turned.

use glam::{DQuat, DVec3};
use peristalsis_engine::Simulation;

/// Orientations of the grains since they were first looked at, from their angular velocities.
///
/// dq/dt = omega q/2, by the exponential of the mean of omega before and after some steps: order 2 in their length. No
/// force depends on it, so the engine need not know.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Orientations {
    /// Unit quaternions (w, x, y, z) that turn a grain's frame into the laboratory's.
    turned: Vec<[f64; 4]>,
    /// Angular velocities at the last look \[1/t\].
    angular_velocity: Vec<DVec3>,
    /// Time of the last look \[t\].
    time: f64,
}

impl Orientations {
    /// Begins with every grain's frame along the laboratory's.
    pub fn new(simulation: &Simulation) -> Self {
        let bodies = simulation.bodies();
        Self {
            turned: vec![[1.0, 0.0, 0.0, 0.0]; bodies.grains],
            angular_velocity: bodies.angular_velocity[..bodies.grains].to_vec(),
            time: simulation.time(),
        }
    }

    /// Whether there is one for each of `grains` grains.
    pub fn fit(&self, grains: usize) -> bool {
        [self.turned.len(), self.angular_velocity.len()] == [grains; 2]
    }

    /// Brings the orientations to the simulation's time.
    pub fn follow(&mut self, simulation: &Simulation) {
        let half_interval = 0.5 * (simulation.time() - self.time);
        let now = &simulation.bodies().angular_velocity;
        let grains = self.turned.iter_mut().zip(&mut self.angular_velocity);
        for ((turned, before), now) in grains.zip(now) {
            let turn = turn_by(half_interval * (*before + *now));
            let [w, x, y, z] = *turned;
            let q = (turn * DQuat::from_xyzw(x, y, z, w)).normalize();
            *turned = [q.w, q.x, q.y, q.z];
            *before = *now;
        }
        self.time = simulation.time();
    }

    /// Unit quaternions (w, x, y, z) that turn a grain's frame into the laboratory's, grain by grain.
    pub fn quaternions(&self) -> &[[f64; 4]] {
        &self.turned
    }
}

/// The rotation about `turn` by |`turn`|.
fn turn_by(turn: DVec3) -> DQuat {
    let angle = turn.length();
    let (sin, cos) = libm::sincos(0.5 * angle);
    // sin(x/2)/x tends to 1/2.
    let axis = turn * if angle > 0.0 { sin / angle } else { 0.5 };
    DQuat::from_xyzw(axis.x, axis.y, axis.z, cos)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quarter_turn_by_hand() {
        let quarter = turn_by(DVec3::Z * core::f64::consts::FRAC_PI_2);
        assert!((quarter * DVec3::X - DVec3::Y).length() < 1e-15);
        assert_eq!(turn_by(DVec3::ZERO), DQuat::IDENTITY);
        let tiny = turn_by(DVec3::X * 1e-200);
        assert!(tiny.is_finite() && (tiny.x - 0.5e-200).abs() < 1e-214);
    }
}
