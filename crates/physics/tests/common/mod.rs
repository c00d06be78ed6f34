//! What the tests of contact mechanics share: the table of all contact laws and an experiment with two spheres.

// Each test program uses its own part.
#![allow(dead_code)]

use glam::DVec3;
use peristalsis_physics::contact::{
    Cohesion, Contact, ContactForce, ContactLaw, ContactModel, CundallStrack, DissipationForm,
    Frictionless, General, GeneralHistory, LinearSpringDashpot, Normal, PullOff, RollingResistance,
    Sliding, TangentialLaw, ViscoelasticHertz,
};

/// The normal law of the frictionless preset.
pub(crate) const LINEAR: LinearSpringDashpot = LinearSpringDashpot {
    normal_stiffness: 1.0,
    normal_damping: 5.48e-3,
};

/// The normal law of the frictional preset, in either form.
pub(crate) const fn hertz(dissipation_form: DissipationForm) -> ViscoelasticHertz {
    ViscoelasticHertz {
        young_modulus: 1.0,
        poisson_ratio: 0.5,
        dissipation_time: 0.1,
        dissipation_form,
    }
}

/// The tangential law of the frictional preset, with any form of sliding.
pub(crate) const fn friction(sliding: Sliding) -> CundallStrack {
    CundallStrack {
        tangential_stiffness: 1.0,
        tangential_damping: 0.1,
        static_friction: 0.5,
        kinetic_friction: 0.4,
        sliding,
    }
}

/// All forms of sliding.
pub(crate) const SLIDINGS: [Sliding; 3] = [Sliding::Spring, Sliding::Balance, Sliding::Literal];

/// All normal laws, by name.
pub(crate) fn normals() -> [(&'static str, Normal); 3] {
    [
        ("linear", Normal::Linear(LINEAR)),
        (
            "hertz, printed",
            Normal::Hertz(hertz(DissipationForm::Printed)),
        ),
        (
            "hertz, viscoelastic",
            Normal::Hertz(hertz(DissipationForm::Viscoelastic)),
        ),
    ]
}

/// A normal law without friction.
pub(crate) const fn smooth(normal: Normal) -> ContactModel {
    ContactModel::new(normal, None)
}

pub(crate) const ROLLING: RollingResistance = RollingResistance {
    rolling_friction: 0.1,
    rolling_stiffness: 0.8,
    rolling_damping: 0.05,
};

/// A pull that is constant in contact and reaches beyond it.
pub(crate) const PULL: Cohesion = Cohesion {
    cohesion_force: 2e-3,
    cohesion_range: 0.02,
    surface_energy: 0.0,
    pull_off: PullOff::Displacement,
};

pub(crate) const JKR: Cohesion = Cohesion {
    cohesion_force: 0.0,
    cohesion_range: 0.0,
    surface_energy: 1e-3,
    pull_off: PullOff::Displacement,
};

/// The same, which breaks at the pull-off force.
pub(crate) const JKR_FORCE: Cohesion = Cohesion {
    pull_off: PullOff::Force,
    ..JKR
};

/// Laws with rolling resistance, cohesion, and both.
fn general() -> Vec<(String, ContactModel)> {
    let mut rows = Vec::new();
    for (_, normal) in normals() {
        for cohesion in [None, Some(PULL), Some(JKR), Some(JKR_FORCE)] {
            let is_hertz = matches!(normal, Normal::Hertz(_));
            for rolling in [None, Some(ROLLING)] {
                let model = ContactModel {
                    cohesion,
                    rolling,
                    ..ContactModel::new(normal, rolling.map(|_| friction(Sliding::Spring)))
                };
                if model.is_general() && (is_hertz || !cohesion.is_some_and(|it| it.is_jkr())) {
                    rows.push((format!("{model:?}"), model));
                }
            }
        }
    }
    rows
}

/// Every contact law there is, by name: each normal law without friction and with each form of sliding; and the general ones.
pub(crate) fn table() -> Vec<(String, ContactModel)> {
    let mut rows = Vec::new();
    for (name, normal) in normals() {
        rows.push((format!("{name}, frictionless"), smooth(normal)));
        for sliding in SLIDINGS {
            let friction = Some(friction(sliding));
            rows.push((
                format!("{name}, {sliding:?}"),
                ContactModel::new(normal, friction),
            ));
        }
    }
    rows.extend(general());
    rows
}

/// What a law of the table answers.
pub(crate) fn answer(
    model: &ContactModel,
    contact: &Contact,
    history: &mut GeneralHistory,
    time_step: f64,
) -> ContactForce {
    let normal = model.normal;
    match (General::of(model), model.friction) {
        (Some(tangential), _) => {
            ContactLaw { normal, tangential }.force(contact, history, time_step)
        }
        (None, None) => ContactLaw {
            normal,
            tangential: Frictionless,
        }
        .force(contact, &mut (), time_step),
        (None, Some(tangential)) => {
            ContactLaw { normal, tangential }.force(contact, &mut history.friction, time_step)
        }
    }
}

/// Whether a contact with this history acts.
pub(crate) fn acts(model: &ContactModel, contact: &Contact, history: &GeneralHistory) -> bool {
    let normal = model.normal;
    match General::of(model) {
        Some(tangential) => ContactLaw { normal, tangential }.acts(contact, history),
        None => contact.touches(),
    }
}

/// Two free spheres in each other's way, moved by velocity Verlet with predicted velocities.
#[derive(Clone, Debug)]
pub(crate) struct Collision {
    pub(crate) model: ContactModel,
    pub(crate) diameter: [f64; 2],
    pub(crate) mass: [f64; 2],
    pub(crate) position: [DVec3; 2],
    pub(crate) velocity: [DVec3; 2],
    pub(crate) angular_velocity: [DVec3; 2],
    pub(crate) history: GeneralHistory,
    /// What the law answered last.
    pub(crate) last: ContactForce,
    /// Energy lost so far along the normal, by the trapezoidal rule, and in the plane of contact, by rolling, by breaking.
    pub(crate) lost: [f64; 2],
}

impl Collision {
    /// Two spheres of diameter 1 and mass 1 that are about to touch: the second at the origin and at rest; the first
    /// arrives with speed `speed` along +x, its centre off the axis by sin(`angle`).
    pub(crate) fn oblique(model: ContactModel, speed: f64, angle: f64) -> Self {
        Self {
            model,
            diameter: [1.0; 2],
            mass: [1.0; 2],
            position: [DVec3::new(-angle.cos(), angle.sin(), 0.0), DVec3::ZERO],
            velocity: [DVec3::new(speed, 0.0, 0.0), DVec3::ZERO],
            angular_velocity: [DVec3::ZERO; 2],
            history: GeneralHistory::default(),
            last: ContactForce::default(),
            lost: [0.0; 2],
        }
    }

    fn inertia(&self, sphere: usize) -> f64 {
        self.mass[sphere] * self.diameter[sphere] * self.diameter[sphere] / 10.0
    }

    pub(crate) fn overlap(&self) -> f64 {
        0.5 * (self.diameter[0] + self.diameter[1]) - self.position[0].distance(self.position[1])
    }

    /// Whether the contact acts.
    pub(crate) fn touches(&self) -> bool {
        acts(&self.model, &self.contact(), &self.history)
    }

    /// The contact as the law sees it.
    pub(crate) fn contact(&self) -> Contact {
        let [first, second] = self.diameter;
        let contact = Contact::new(
            (first, second),
            self.position[0] - self.position[1],
            self.velocity[0] - self.velocity[1],
        );
        contact.rotating(
            contact.arm(first) * self.angular_velocity[0]
                + contact.arm(second) * self.angular_velocity[1],
            self.angular_velocity[0] - self.angular_velocity[1],
        )
    }

    /// Kinetic energy of translation and rotation.
    pub(crate) fn kinetic_energy(&self) -> f64 {
        (0..2)
            .map(|i| {
                0.5 * self.mass[i] * self.velocity[i].length_squared()
                    + 0.5 * self.inertia(i) * self.angular_velocity[i].length_squared()
            })
            .sum()
    }

    /// Asks the law, with a step of `time_step` behind it; nothing where the spheres do not touch.
    pub(crate) fn evaluate(&mut self, time_step: f64) {
        if self.touches() {
            let contact = self.contact();
            self.last = answer(&self.model, &contact, &mut self.history, time_step);
        } else {
            if let Some(law) = General::of(&self.model) {
                self.lost[1] += law.stored_energy(&self.history) + law.bond(&self.history);
            }
            self.history = GeneralHistory::default();
            self.last = ContactForce::default();
        }
    }

    fn accelerations(&self) -> ([DVec3; 2], [DVec3; 2]) {
        let overlap = self.overlap();
        let arm = |sphere: usize| 0.5 * (self.diameter[sphere] - overlap);
        let force = self.last.force;
        let turn = |sphere: usize| self.last.torque_per_arm * (arm(sphere) / self.inertia(sphere));
        (
            [force / self.mass[0], -force / self.mass[1]],
            [
                turn(0) + self.last.rolling.couple / self.inertia(0),
                turn(1) - self.last.rolling.couple / self.inertia(1),
            ],
        )
    }

    /// One step; the law must have been asked before the first.
    pub(crate) fn step(&mut self, time_step: f64) {
        let (linear, angular) = self.accelerations();
        let before = self.last.normal_dissipation;
        for i in 0..2 {
            self.position[i] += time_step * (self.velocity[i] + 0.5 * time_step * linear[i]);
            self.velocity[i] += time_step * linear[i];
            self.angular_velocity[i] += time_step * angular[i];
        }
        self.evaluate(time_step);
        let (linear_after, angular_after) = self.accelerations();
        for i in 0..2 {
            self.velocity[i] += 0.5 * time_step * (linear_after[i] - linear[i]);
            self.angular_velocity[i] += 0.5 * time_step * (angular_after[i] - angular[i]);
        }
        self.lost[0] += 0.5 * time_step * (before + self.last.normal_dissipation);
        self.lost[1] += self.last.tangential.damped + self.last.tangential.slid;
        self.lost[1] += self.last.rolling.lost;
    }

    /// Steps until the spheres have met and parted.
    pub(crate) fn run(&mut self, time_step: f64) {
        self.evaluate(time_step);
        let mut met = false;
        for _ in 0..10_000_000 {
            self.step(time_step);
            let touching = self.touches();
            if met && !touching {
                return;
            }
            met |= touching;
            let parting = self.contact().normal_velocity() > 0.0;
            if !met && parting {
                return;
            }
        }
        panic!("the spheres do not part: {self:?}");
    }
}
