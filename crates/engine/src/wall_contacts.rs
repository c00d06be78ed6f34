//! The contacts of grains with the wall, one by one: their forces and places.

use core::ops::Range;

use glam::DVec3;
use peristalsis_physics::contact::{Contact, ContactLaw, Frictionless, NormalLaw, TangentialLaw};
use rayon::prelude::*;

use crate::bodies::Bodies;
use crate::contacts::Contacts;
use crate::fast::threads::Threads;
use crate::wall::Wall;

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
    /// Power lost to sliding: f_t times the speed of the slider, without what the tangential spring stores and gives back
    /// \[m d^2/t^3\]. It is the loss of the coming step, from the velocities now.
    pub sliding_power: f64,
}

/// Contacts with an immobile wall that are found before any of them is worked out: many at a time, so that the branches
/// of the search do not hold up the forces, and few enough to stay near the processor.
const AT_A_TIME: usize = 64;

/// Calls `visit` for each contact of a grain with the wall as all stands now, in a fixed order.
pub(crate) fn for_each_contact<N: NormalLaw, T: TangentialLaw>(
    law: &ContactLaw<N, T>,
    bodies: &Bodies,
    wall: &Wall,
    contacts: &Contacts<T::History<f64>>,
    time_step: f64,
    mut visit: impl FnMut(WallContact),
) {
    let mut answer = |grain: usize, acceleration: DVec3, contact: &Contact, history| {
        let next = following(contact, acceleration, time_step);
        visit(WallContact {
            sliding_power: sliding_power(law, &next, history, time_step),
            ..answered(law, bodies, grain, contact, history)
        });
    };
    let history = |grain, sphere| contacts.wall.history(grain, sphere);
    touch_immobile(
        law,
        bodies,
        wall,
        0..bodies.grains,
        history,
        |grain, contact, history| answer(grain, bodies.acceleration[grain], contact, history),
    );
    if wall.mobile_spheres() == 0 {
        return;
    }
    let grains = bodies.grains;
    for i in 0..grains {
        contacts.for_each_acting(
            law,
            bodies,
            wall.length(),
            i,
            grains,
            |j, contact, history| {
                let acceleration = bodies.acceleration[i] - bodies.acceleration[j];
                answer(i, acceleration, contact, *history);
            },
        );
    }
}

/// Grains whose contacts are added up by themselves.
const PIECE: usize = 2048;

/// The same for frictionless grains in a tube that no force moves, added up piece by piece of the grains, by threads where there are any.
/// Pieces do not depend on threads, so that sums do not either.
pub(crate) fn add_up_smooth_contacts<N: NormalLaw, S: Send>(
    normal: N,
    bodies: &Bodies,
    wall: &Wall,
    threads: &Threads,
    begin: impl Fn(usize) -> S + Sync,
    add: impl Fn(&mut S, WallContact) + Sync,
) -> Vec<S> {
    let tangential = Frictionless;
    let law = ContactLaw { normal, tangential };
    let of_piece = |piece: usize| {
        let grains = piece * PIECE..((piece + 1) * PIECE).min(bodies.grains);
        let mut sums = begin(piece);
        touch_immobile(
            &law,
            bodies,
            wall,
            grains,
            |_, _| (),
            |grain, contact, ()| {
                add(&mut sums, answered(&law, bodies, grain, contact, ()));
            },
        );
        sums
    };
    let pieces = 0..bodies.grains.div_ceil(PIECE).max(1);
    threads.install(|| match threads.several() {
        true => {
            let pieces = pieces.into_par_iter().with_max_len(1);
            pieces.map(of_piece).collect()
        }
        false => pieces.map(of_piece).collect(),
    })
}

/// Calls `visit` for each contact of some grains with what of the wall no force moves, as far as cohesion reaches; `history` answers the history of a
/// contact of a grain with a wall sphere.
fn touch_immobile<N: NormalLaw, T: TangentialLaw>(
    law: &ContactLaw<N, T>,
    bodies: &Bodies,
    wall: &Wall,
    grains: Range<usize>,
    history: impl Fn(usize, u32) -> T::History<f64>,
    mut visit: impl FnMut(usize, &Contact, T::History<f64>),
) {
    let mut found = Vec::new();
    let last = grains.end.saturating_sub(1);
    for grain in grains {
        let here = bodies.sphere(grain);
        wall.for_each_contact(&here, law.range(here.diameter), |sphere, contact, _| {
            let history = history(grain, sphere);
            if law.acts(&contact, &history) {
                found.push((grain, here.on_wall(contact), history));
            }
        });
        if found.len() >= AT_A_TIME || grain == last {
            for (grain, contact, history) in found.drain(..) {
                visit(grain, &contact, history);
            }
        }
    }
}

/// The response of the law to a contact of a grain.
fn answered<N: NormalLaw, T: TangentialLaw>(
    law: &ContactLaw<N, T>,
    bodies: &Bodies,
    grain: usize,
    contact: &Contact,
    mut history: T::History<f64>,
) -> WallContact {
    // A step of no length: the history stays where it is.
    let answer = law.force(contact, &mut history, 0.0);
    let tangential_force = answer.tangential.force;
    let arm = contact.arm(bodies.diameter[grain]);
    WallContact {
        grain,
        point: bodies.position[grain] - arm * contact.normal,
        normal_force: answer.force - tangential_force,
        tangential_force,
        sliding_power: 0.0,
    }
}

/// A contact a step later, as its relative velocity and acceleration tell; a wall that is prescribed moves on evenly.
fn following(contact: &Contact, acceleration: DVec3, time_step: f64) -> Contact {
    let relative_velocity = contact.relative_velocity + time_step * acceleration;
    let parted = time_step * contact.normal_velocity();
    Contact {
        overlap: contact.overlap - parted,
        distance: contact.distance + parted,
        relative_velocity,
        ..*contact
    }
}

/// Mean power lost to sliding in the step that leads to `next`; 0 without friction.
///
/// The bound on the spring changes with the normal force meanwhile: -f_t . v_t alone would count what the spring takes up,
/// and gives back later.
fn sliding_power<N: NormalLaw, T: TangentialLaw>(
    law: &ContactLaw<N, T>,
    next: &Contact,
    mut history: T::History<f64>,
    time_step: f64,
) -> f64 {
    // The spring of a contact that ends is forgotten, which is no sliding.
    if !law.acts(next, &history) {
        return 0.0;
    }
    law.force(next, &mut history, time_step).tangential.slid / time_step
}
