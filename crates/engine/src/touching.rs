//! Which spheres touch, and with which force: read off a simulation, for pictures and files.

use glam::DVec3;
use peristalsis_physics::contact::{Contact, ContactLaw, Frictionless, NormalLaw};

use crate::bodies::Bodies;
use crate::fast::listed::Remember;
use crate::forces::Contacts;
use crate::neighbours::periodic;
use crate::wall::Wall;

/// Two spheres that touch.
///
/// Grains come first, then the spheres of the wall, prescribed or elastic: wall sphere k has the number N + k.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touching {
    /// Number of the first sphere, a grain unless both belong to the wall.
    pub first: usize,
    /// Number of the second.
    pub second: usize,
    /// r_first - r_second, to the nearest image along the tube \[d\].
    pub separation: DVec3,
    /// xi \[d\].
    pub overlap: f64,
    /// Force on the first sphere \[m d/t^2\].
    pub force: DVec3,
    /// f_n, its part along the line of centres; positive repels \[m d/t^2\].
    pub normal_force: f64,
    /// |f_t|, its part in the plane of contact \[m d/t^2\].
    pub tangential_force: f64,
    /// Whether the contact slides.
    pub sliding: bool,
}

/// All contacts at the present positions and velocities, in order of the first sphere; those of a grain with other moving
/// spheres before those with a prescribed wall.
///
/// `contacts` holds what frictional contacts remember; no history moves on, but those of the wall are taken out.
pub(crate) fn touching<N: NormalLaw, T: Remember>(
    law: &ContactLaw<N, T>,
    bodies: &Bodies,
    wall: &Wall,
    contacts: &mut Contacts<T::History<f64>>,
) -> Vec<Touching> {
    contacts.rebuild(bodies, wall, 0.0);
    let length = wall.lattice().length();
    let smooth = ContactLaw {
        normal: law.normal,
        tangential: Frictionless,
    };
    let mut found = Vec::new();
    for first in 0..bodies.number() {
        let (partners, histories) = contacts.pairs.row(first);
        for (&partner, history) in partners.iter().zip(histories) {
            let second = partner as usize;
            let Some(contact) = meeting(
                Sphere::moving(bodies, first),
                Sphere::moving(bodies, second),
                periodic(bodies.position[first] - bodies.position[second], length),
            ) else {
                continue;
            };
            // Wall against wall has no friction.
            found.push(if first >= bodies.grains {
                answered(&smooth, &contact, (), first, second)
            } else {
                answered(law, &contact, *history, first, second)
            });
        }
        let Wall::Prescribed(prescribed) = wall else {
            continue;
        };
        let grain = Sphere::moving(bodies, first);
        prescribed.for_each_touching(
            bodies.position[first],
            grain.diameter,
            |sphere, separation, velocity| {
                let fixed = Sphere {
                    velocity,
                    angular_velocity: DVec3::ZERO,
                    diameter: prescribed.lattice().sphere_diameter,
                };
                if let Some(contact) = meeting(grain, fixed, separation) {
                    let history = contacts.wall.take(first, sphere);
                    let second = bodies.grains + sphere as usize;
                    found.push(answered(law, &contact, history, first, second));
                }
            },
        );
    }
    found
}

/// What a contact asks of a sphere besides its place.
#[derive(Clone, Copy)]
struct Sphere {
    velocity: DVec3,
    angular_velocity: DVec3,
    diameter: f64,
}

impl Sphere {
    fn moving(bodies: &Bodies, index: usize) -> Self {
        Self {
            velocity: bodies.velocity[index],
            angular_velocity: bodies.angular_velocity[index],
            diameter: bodies.diameter[index],
        }
    }
}

/// The contact of two spheres; `None` where they do not overlap.
fn meeting(one: Sphere, other: Sphere, separation: DVec3) -> Option<Contact> {
    let distance = separation.length();
    let overlap = 0.5 * (one.diameter + other.diameter) - distance;
    // Coincident centres have no normal.
    (overlap > 0.0 && distance > 0.0).then(|| Contact {
        overlap,
        distance,
        normal: separation * (1.0 / distance),
        relative_velocity: one.velocity - other.velocity,
        reduced_radius: one.diameter * other.diameter / (2.0 * (one.diameter + other.diameter)),
        spin: 0.5 * (one.diameter - overlap) * one.angular_velocity
            + 0.5 * (other.diameter - overlap) * other.angular_velocity,
    })
}

fn answered<N: NormalLaw, T: Remember>(
    law: &ContactLaw<N, T>,
    contact: &Contact,
    mut history: T::History<f64>,
    first: usize,
    second: usize,
) -> Touching {
    let answer = law.force(contact, &mut history, 0.0);
    let normal_force = answer.force.dot(contact.normal);
    Touching {
        first,
        second,
        separation: contact.normal * contact.distance,
        overlap: contact.overlap,
        force: answer.force,
        normal_force,
        tangential_force: answer.tangential.force.length(),
        sliding: answer.tangential.sliding,
    }
}
