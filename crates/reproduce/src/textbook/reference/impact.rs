//! The equations of motion of an impact, integrated to twelve digits.

use glam::DVec3;
use peristalsis_physics::contact::{DissipationForm, Normal};

use super::{hertz, ode};
use crate::textbook::experiment::impact::Impact;

/// Velocities and spins after an impact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Outcome {
    pub(crate) velocity: [DVec3; 2],
    pub(crate) spin: [f64; 2],
}

/// xi, dxi/dt, the angle of the line of centres, its rate, the two spins and the tangential displacement u.
type State = [f64; 7];

/// The contact law, written again from its definition.
#[derive(Clone, Copy)]
struct Law {
    /// f_n = stiffness xi^p - damping xi^q v_n: p and q are 1 and 0, or 3/2 and 1/2.
    is_hertz: bool,
    stiffness: f64,
    damping: f64,
    tangential_stiffness: f64,
    tangential_damping: f64,
    friction: f64,
}

impl Law {
    fn of(impact: &Impact) -> Self {
        let (is_hertz, stiffness, damping) = if let Normal::Hertz(law) = impact.contact.normal {
            let kappa = hertz::stiffness(&law, impact.reduced_radius());
            let factor = match law.dissipation_form {
                DissipationForm::Printed => 1.0,
                DissipationForm::Viscoelastic => 1.5,
            };
            (true, kappa, kappa * factor * law.dissipation_time)
        } else if let Normal::Linear(law) = impact.contact.normal {
            (false, law.normal_stiffness, law.normal_damping)
        } else {
            unreachable!("the cases have impacts of these two laws")
        };
        let friction = impact.contact.friction;
        Self {
            is_hertz,
            stiffness,
            damping,
            tangential_stiffness: friction.map_or(0.0, |law| law.tangential_stiffness),
            tangential_damping: friction.map_or(0.0, |law| law.tangential_damping),
            friction: friction.map_or(0.0, |law| law.kinetic_friction),
        }
    }

    /// f_n at an overlap and its rate (-v_n).
    fn normal_force(&self, overlap: f64, rate: f64) -> f64 {
        if self.is_hertz {
            let root = overlap.max(0.0).sqrt();
            root * (self.stiffness * overlap + self.damping * rate)
        } else {
            self.stiffness * overlap + self.damping * rate
        }
    }

    /// mu f_n, the largest force of friction.
    fn friction_limit(&self, y: &State) -> f64 {
        self.friction * self.normal_force(y[0], y[1]).max(0.0)
    }

    /// Rises through 0 in parting: where the force of the Hertz law over sqrt(xi) falls through 0, or the overlap under the
    /// linear law.
    fn end(&self, y: &State) -> f64 {
        if y[1] >= 0.0 {
            -1.0
        } else if self.is_hertz {
            -(self.stiffness * y[0] + self.damping * y[1])
        } else {
            -y[0]
        }
    }

    /// d f_n/dt, with the second derivative of the overlap.
    fn normal_force_rate(&self, overlap: f64, rate: f64, acceleration: f64) -> f64 {
        if self.is_hertz {
            let root = overlap.max(f64::MIN_POSITIVE).sqrt();
            1.5 * self.stiffness * root * rate
                + self.damping * (0.5 * rate * rate / root + root * acceleration)
        } else {
            self.stiffness * rate + self.damping * acceleration
        }
    }
}

/// Tolerance of the integration over the scale of each component.
const RELATIVE_TOLERANCE: f64 = 1e-13;

/// The force of the contact in its plane.
#[derive(Clone, Copy, PartialEq)]
enum Mode {
    Sticks,
    /// Slides with a force against a displacement of this sign.
    Slides(f64),
}

/// The motion of two spheres in contact, in the polar coordinates of their separation.
struct Motion {
    law: Law,
    reach: f64,
    diameter: [f64; 2],
    reduced_mass: f64,
    /// 1/I of each.
    mobility: [f64; 2],
}

impl Motion {
    fn of(impact: &Impact) -> Self {
        let spheres = [impact.sphere, impact.other()];
        Self {
            law: Law::of(impact),
            reach: impact.reach(),
            diameter: spheres.map(|sphere| sphere.diameter),
            reduced_mass: impact.reduced_mass(),
            mobility: spheres.map(|sphere| 1.0 / sphere.inertia()),
        }
    }

    /// The state where the contact ends, from the relative velocity and the spins before it.
    fn integrate(&self, relative: DVec3, spins: [f64; 2]) -> State {
        let (approach, turning) = (-relative.x, relative.y / self.reach);
        let mut y: State = [0.0, approach, 0.0, turning, spins[0], spins[1], 0.0];
        let speed = approach + self.slip_velocity(&y).abs() + relative.y.abs();
        let time = natural_time(&self.law, self.reduced_mass, approach);
        let small_speed = RELATIVE_TOLERANCE * speed;
        let tolerance = [
            RELATIVE_TOLERANCE * approach * time,
            small_speed,
            small_speed / self.reach,
            small_speed / self.reach,
            small_speed / self.diameter[0],
            small_speed / self.diameter[0],
            small_speed * time,
        ];
        let first_step = 1e-6 * time;
        let mut mode = first_mode(self, &y, first_step);
        loop {
            let (_, state, which) = ode::until(
                |y| self.slope(y, mode),
                y,
                &[&|y| self.law.end(y), &|y| self.switch(y, mode)],
                &tolerance,
                [first_step, 1e4 * time],
            );
            y = state;
            if which != 1 {
                return y;
            }
            mode = match mode {
                Mode::Sticks => Mode::Slides(self.pull(&y).signum()),
                Mode::Slides(sign) => {
                    y[6] = sign * self.law.friction_limit(&y) / self.law.tangential_stiffness;
                    Mode::Sticks
                }
            };
        }
    }

    /// Rises through 0 where a contact that sticks begins to slide, or the other way round.
    fn switch(&self, y: &State, mode: Mode) -> f64 {
        let law = &self.law;
        match mode {
            Mode::Sticks if law.friction > 0.0 => self.pull(y).abs() - law.friction_limit(y),
            // With a dashpot a contact that slides is taken to slide to its end.
            Mode::Slides(sign)
                if law.tangential_damping == 0.0 && law.normal_force(y[0], y[1]) > 0.0 =>
            {
                // The bound on u grows faster than the contact slips.
                let acceleration = self.slope(y, mode)[1];
                let bound = law.friction / law.tangential_stiffness
                    * law.normal_force_rate(y[0], y[1], acceleration);
                bound - sign * self.slip_velocity(y)
            }
            _ => -1.0,
        }
    }

    fn slip_velocity(&self, y: &State) -> f64 {
        let [overlap, _, _, turning, one, other, _] = *y;
        let arm = |i: usize| 0.5 * (self.diameter[i] - overlap);
        (self.reach - overlap) * turning - arm(0) * one - arm(1) * other
    }

    /// k_t u + eta_t v_t: what spring and dashpot pull with while the contact sticks.
    fn pull(&self, y: &State) -> f64 {
        self.law.tangential_stiffness * y[6] + self.law.tangential_damping * self.slip_velocity(y)
    }

    fn tangential_force(&self, y: &State, mode: Mode) -> f64 {
        match mode {
            Mode::Sticks => -self.pull(y),
            Mode::Slides(sign) => -sign * self.law.friction_limit(y),
        }
    }

    fn slope(&self, y: &State, mode: Mode) -> State {
        let [overlap, rate, _, turning, ..] = *y;
        let distance = self.reach - overlap;
        let (normal, tangential) = (
            self.law.normal_force(overlap, rate),
            self.tangential_force(y, mode),
        );
        let arm = |i: usize| 0.5 * (self.diameter[i] - overlap);
        [
            rate,
            // r'' = r theta'^2 + f_n/m, r = reach - xi
            -(distance * turning * turning + normal / self.reduced_mass),
            turning,
            (2.0 * rate * turning + tangential / self.reduced_mass) / distance,
            -arm(0) * tangential * self.mobility[0],
            -arm(1) * tangential * self.mobility[1],
            match mode {
                Mode::Sticks => self.slip_velocity(y),
                Mode::Slides(_) => 0.0,
            },
        ]
    }
}

/// Outcome of an impact whose tangential law has one coefficient of friction, or which has no friction.
///
/// Polar coordinates of the separation. While a contact sticks u follows the slip, and the force is k_t u + eta_t v_t; where
/// it slides, the force is mu f_n. Without a dashpot it may stick again, with k_t |u| = mu f_n; with one it slides to its end.
/// The impact ends where the force of the Hertz law vanishes, or the overlap under the linear law.
pub(crate) fn outcome(impact: &Impact) -> Outcome {
    let motion = Motion::of(impact);
    let relative = impact.relative_velocity();
    let after = motion.integrate(relative, [impact.sphere.spin, impact.other().spin]);
    let distance = motion.reach - after[0];
    let (sin, cos) = libm::sincos(after[2]);
    let (radial, lateral) = (-after[1], distance * after[3]);
    let relative_after = DVec3::new(
        radial * cos - lateral * sin,
        radial * sin + lateral * cos,
        0.0,
    );
    let change = relative_after - relative;
    let (share, other) = (impact.share(), impact.other());
    Outcome {
        velocity: [
            impact.sphere.velocity + share * change,
            other.velocity - (1.0 - share) * change,
        ],
        spin: [after[4], after[5]],
    }
}

/// Whether the contact slides at once: a moment after touching the spring would pull more than friction holds.
fn first_mode(motion: &Motion, y: &State, moment: f64) -> Mode {
    let slip = motion.slip_velocity(y);
    let law = &motion.law;
    let pull = (law.tangential_stiffness * moment + law.tangential_damping) * slip.abs();
    if law.friction > 0.0 && pull > law.friction * law.normal_force(y[1] * moment, y[1]) {
        Mode::Slides(slip.signum())
    } else {
        Mode::Sticks
    }
}

/// A time of the order of an impact's duration.
fn natural_time(law: &Law, reduced_mass: f64, speed: f64) -> f64 {
    if law.is_hertz {
        libm::pow(reduced_mass / law.stiffness, 0.4) * libm::pow(speed, -0.2)
    } else {
        (reduced_mass / law.stiffness).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use peristalsis_physics::contact::{ContactModel, CundallStrack, LinearSpringDashpot, Sliding};

    use super::*;

    const SPRING: LinearSpringDashpot = LinearSpringDashpot {
        normal_stiffness: 1.0,
        normal_damping: 0.2,
    };

    fn impact(friction: Option<CundallStrack>, velocity: DVec3) -> Impact {
        let normal = Normal::Linear(SPRING);
        Impact::between(ContactModel::new(normal, friction), velocity, DVec3::ZERO)
    }

    #[test]
    fn a_head_on_impact_has_the_closed_form() {
        let found = outcome(&impact(None, DVec3::new(-0.1, 0.0, 0.0)));
        let restitution = (found.velocity[0].x - found.velocity[1].x) / 0.1;
        assert!((restitution - SPRING.restitution(0.5)).abs() < 1e-10);
        assert!((found.velocity[0].x + found.velocity[1].x + 0.1).abs() < 1e-13);
    }

    /// Friction on both spheres alike: spins are equal, and what they take is what the orbit loses.
    #[test]
    fn angular_momentum_is_kept() {
        let law = CundallStrack {
            tangential_stiffness: 0.7,
            tangential_damping: 0.0,
            static_friction: 0.3,
            kinetic_friction: 0.3,
            sliding: Sliding::Spring,
        };
        let velocity = DVec3::new(-0.01, 0.008, 0.0);
        let found = outcome(&impact(Some(law), velocity));
        assert!((found.spin[0] - found.spin[1]).abs() < 1e-13 && found.spin[0].abs() > 1e-3);
        // The centres part at the same distance at which they met.
        let lateral = found.velocity[0] - found.velocity[1];
        let orbit = |v: DVec3| 0.5 * v.y;
        let spins = 0.1 * (found.spin[0] + found.spin[1]);
        // The line of centres has turned a little: what remains is of that order.
        assert!((orbit(lateral) + spins - orbit(velocity)).abs() < 1e-3);
    }
}
