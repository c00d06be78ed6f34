//! The contacts of grains with the wall, one by one: their forces and places.

use core::ops::Range;

use glam::DVec3;
use peristalsis_physics::contact::{Contact, ContactLaw, Frictionless, NormalLaw, TangentialLaw};
use rayon::ThreadPool;
use rayon::prelude::*;

use crate::bodies::{Bodies, Sphere};
use crate::contacts::Contacts;
use crate::neighbours::periodic;
use crate::wall::{PrescribedWall, Wall};

/// A contact of a grain with a sphere of the wall; forces are those on the grain \[m d/t^2\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallContact {
    /// Number of the grain.
    pub grain: usize,
    /// Where they touch, on the line of centres; z may lie a little outside \[0, L) \[d\].
    pub point: DVec3,
    /// f_n n, elastic and damping, n from the wall sphere to the grain.
    pub normal_force: DVec3,
    /// f_t, friction.
    pub tangential_force: DVec3,
}

/// Contacts with a prescribed wall that are found before any of them is worked out: many at a time, so that the branches
/// of the search do not hold up the forces, and few enough to stay near the processor.
const AT_A_TIME: usize = 64;

/// Calls `visit` for each contact of a grain with the wall as all stands now, in a fixed order.
pub(crate) fn for_each_contact<N: NormalLaw, T: TangentialLaw>(
    law: &ContactLaw<N, T>,
    bodies: &Bodies,
    wall: &Wall,
    contacts: &Contacts<T::History<f64>>,
    mut visit: impl FnMut(WallContact),
) {
    match wall {
        Wall::Prescribed(wall) => {
            let history = |grain, sphere| contacts.wall.history(grain, sphere);
            touch_prescribed(law, bodies, wall, 0..bodies.grains, history, visit);
        }
        Wall::Elastic(wall) => {
            let length = wall.lattice().length();
            for (i, j, history) in contacts.pairs.iter() {
                let (i, j) = (i as usize, j as usize);
                if i < bodies.grains && j >= bodies.grains {
                    let side = WallSide {
                        separation: periodic(bodies.position[i] - bodies.position[j], length),
                        velocity: bodies.velocity[j],
                        diameter: bodies.diameter[j],
                    };
                    let mut history = *history;
                    if let Some(contact) = contact_of(law, bodies, i, &side, &mut history) {
                        visit(contact);
                    }
                }
            }
        }
    }
}

/// Grains whose contacts are added up by themselves.
const PIECE: usize = 2048;

/// The same for smooth grains in a prescribed tube, added up piece by piece of the grains, by threads where there are any.
/// Pieces do not depend on threads, so that sums do not either.
pub(crate) fn add_up_smooth_contacts<N: NormalLaw, S: Send>(
    normal: N,
    bodies: &Bodies,
    wall: &PrescribedWall,
    pool: Option<&ThreadPool>,
    begin: impl Fn(usize) -> S + Sync,
    add: impl Fn(&mut S, WallContact) + Sync,
) -> Vec<S> {
    let tangential = Frictionless;
    let law = ContactLaw { normal, tangential };
    let of_piece = |piece: usize| {
        let grains = piece * PIECE..((piece + 1) * PIECE).min(bodies.grains);
        let mut sums = begin(piece);
        let visit = |contact| add(&mut sums, contact);
        touch_prescribed(&law, bodies, wall, grains, |_, _| (), visit);
        sums
    };
    let pieces = 0..bodies.grains.div_ceil(PIECE).max(1);
    match pool {
        Some(pool) => pool.install(|| {
            let pieces = pieces.into_par_iter().with_max_len(1);
            pieces.map(of_piece).collect()
        }),
        None => pieces.map(of_piece).collect(),
    }
}

/// Calls `visit` for each contact of some grains with a prescribed wall; `history` answers the history of a contact of
/// a grain with a wall sphere.
fn touch_prescribed<N: NormalLaw, T: TangentialLaw>(
    law: &ContactLaw<N, T>,
    bodies: &Bodies,
    wall: &PrescribedWall,
    grains: Range<usize>,
    history: impl Fn(usize, u32) -> T::History<f64>,
    mut visit: impl FnMut(WallContact),
) {
    let diameter = wall.lattice().sphere_diameter;
    let mut found = Vec::new();
    let last = grains.end.saturating_sub(1);
    for grain in grains {
        let (centre, of_grain) = (bodies.position[grain], bodies.diameter[grain]);
        wall.for_each_touching(centre, of_grain, |sphere, separation, velocity| {
            let side = WallSide {
                separation,
                velocity,
                diameter,
            };
            found.push((grain, side, history(grain, sphere)));
        });
        if found.len() >= AT_A_TIME || grain == last {
            for (grain, side, mut history) in found.drain(..) {
                if let Some(contact) = contact_of(law, bodies, grain, &side, &mut history) {
                    visit(contact);
                }
            }
        }
    }
}

/// A sphere of the wall as a grain sees it.
struct WallSide {
    /// From it to the grain.
    separation: DVec3,
    velocity: DVec3,
    diameter: f64,
}

/// The contact of a grain with a sphere of the wall; `None` where they do not touch.
fn contact_of<N: NormalLaw, T: TangentialLaw>(
    law: &ContactLaw<N, T>,
    bodies: &Bodies,
    grain: usize,
    wall: &WallSide,
    history: &mut T::History<f64>,
) -> Option<WallContact> {
    let Sphere {
        position,
        velocity,
        angular_velocity,
        diameter,
    } = bodies.sphere(grain);
    let diameters = (diameter, wall.diameter);
    let mut contact = Contact::new(diameters, wall.separation, velocity - wall.velocity);
    if !contact.touches() {
        return None;
    }
    let arm = contact.arm(diameter);
    if T::ROTATES {
        contact.rotation = arm * angular_velocity;
    }
    // A step of no length: the history stays where it is.
    let answer = law.force(&contact, history, 0.0);
    let tangential_force = answer.tangential.force;
    Some(WallContact {
        grain,
        point: position - arm * contact.normal,
        normal_force: answer.force - tangential_force,
        tangential_force,
    })
}
