//! Which spheres touch, and with which force: read off a simulation, for pictures and files.

use glam::DVec3;
use peristalsis_physics::contact::{Contact, ContactLaw, NormalLaw, TangentialLaw};

use crate::bodies::Bodies;
use crate::contacts::Contacts;
use crate::fast::threads::Threads;
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
    /// xi; below 0 where the spheres cohere across a gap \[d\].
    pub overlap: f64,
    /// Force on the first sphere \[m d/t^2\].
    pub force: DVec3,
    /// f_n, its part along the line of centres; positive repels \[m d/t^2\].
    pub normal_force: f64,
    /// |f_t|, its part in the plane of contact \[m d/t^2\].
    pub tangential_force: f64,
    /// Whether the contact slides: friction is at its bound. That of a contact without a normal force is 0, and it slides.
    pub sliding: bool,
    /// Couple on the first sphere by rolling resistance; the second feels the opposite \[m d^2/t^2\].
    pub couple: DVec3,
}

/// Calls `visit` for all contacts at the present positions and velocities, in order of the first sphere; those of a grain
/// with other moving spheres come before those with a prescribed wall.
///
/// No history moves on.
pub(crate) fn for_each_touching<N: NormalLaw, T: TangentialLaw>(
    law: &ContactLaw<N, T>,
    bodies: &Bodies,
    wall: &Wall,
    contacts: &Contacts<T::History<f64>>,
    visit: &mut dyn FnMut(Touching),
) {
    let mut listed_anew = None;
    if !contacts.are_listed(bodies, wall) {
        let contacts = listed_anew.insert(contacts.clone());
        contacts.rebuild(bodies, wall, [0.0; 2], &Threads::default());
    }
    let contacts = listed_anew.as_ref().unwrap_or(contacts);
    for first in 0..bodies.number() {
        let here = bodies.sphere(first);
        let length = wall.length();
        contacts.for_each_acting(law, bodies, length, first, 0, |second, contact, history| {
            // Wall against wall has no friction.
            let touching = match first < bodies.grains {
                true => answered(law, contact, *history, first, second),
                false => answered(&law.frictionless(), contact, (), first, second),
            };
            touching.into_iter().for_each(&mut *visit);
        });
        if first >= bodies.grains {
            continue;
        }
        wall.for_each_contact(&here, law.range(here.diameter), |sphere, contact, _| {
            let history = contacts.wall.history(first, sphere);
            let second = bodies.grains + sphere as usize;
            let touching = answered(law, &here.on_wall(contact), history, first, second);
            touching.into_iter().for_each(&mut *visit);
        });
    }
}

/// The response of the law to two spheres; `None` where it does not act.
fn answered<N: NormalLaw, T: TangentialLaw>(
    law: &ContactLaw<N, T>,
    contact: &Contact,
    mut history: T::History<f64>,
    first: usize,
    second: usize,
) -> Option<Touching> {
    if !law.acts(contact, &history) {
        return None;
    }
    let slid = law.tangential.slid(&history);
    let answer = law.force(contact, &mut history, 0.0);
    // Asked again, a contact that slid may just hold: at the bound rounding decides. Only of one that does not press the
    // history knows nothing.
    let is_free = answer.tangential.force == DVec3::ZERO && answer.tangential.sliding;
    Some(Touching {
        first,
        second,
        separation: contact.normal * contact.distance,
        overlap: contact.overlap,
        force: answer.force,
        normal_force: answer.force.dot(contact.normal),
        tangential_force: answer.tangential.force.length(),
        sliding: slid || is_free,
        couple: answer.rolling.couple,
    })
}
