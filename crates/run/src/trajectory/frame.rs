//! A frame of a run.

use std::borrow::Cow;

use peristalsis_engine::{Simulation, Wall};
use peristalsis_formats::trajectory::{Frame, FrameContact, Rotation};
use peristalsis_observe::View;

use crate::run::Run;

/// The orientation that grains begin with.
const UNTURNED: [f64; 4] = [1.0, 0.0, 0.0, 0.0];

/// The spheres of a run as they are, with contacts where they are wanted.
pub(super) fn frame(run: &Run, with_contacts: bool) -> Frame {
    let simulation = run.simulation();
    let (bodies, wall) = (simulation.bodies(), simulation.wall());
    let mut frame = Frame {
        step: simulation.step(),
        time: simulation.time(),
        length: wall.length(),
        width: 0.0,
        grains: bodies.grains,
        position: bodies.position.iter().map(|p| p.to_array()).collect(),
        turns: bodies.turns.clone(),
        velocity: bodies.velocity.iter().map(|v| v.to_array()).collect(),
        diameter: bodies.diameter.clone(),
        mass: bodies.mass.clone(),
        rotation: rotation(run),
        contacts: Vec::new(),
        values: values(run),
    };
    for sphere in wall.prescribed_spheres() {
        frame.position.push(sphere.position.to_array());
        frame.velocity.push(sphere.velocity.to_array());
        frame.turns.push(0);
        frame.diameter.push(sphere.diameter);
        frame.mass.push(0.0);
    }
    frame.width = width(&frame, wall);
    if with_contacts {
        frame.contacts = contacts(simulation);
    }
    frame
}

/// How the grains turn, where there is friction to turn them. Where a run does not follow that, this frame is the first.
fn rotation(run: &Run) -> Option<Rotation> {
    run.configuration().contact.friction.as_ref()?;
    let bodies = run.simulation().bodies();
    let turning = &bodies.angular_velocity[..bodies.grains];
    Some(Rotation {
        angular_velocity: turning.iter().map(|omega| omega.to_array()).collect(),
        orientation: match run.orientations() {
            Some(orientations) => orientations.quaternions().to_vec(),
            None => vec![UNTURNED; bodies.grains],
        },
    })
}

/// Side of a box about the axis that holds every sphere, with a wall sphere's diameter to spare: the same throughout a
/// run, unless a grain flies far away.
fn width(frame: &Frame, wall: &Wall) -> f64 {
    let spare = wall.sphere_diameter();
    let spheres = frame.position.iter().zip(&frame.diameter);
    let reach = spheres
        .map(|(&[x, y, _], diameter)| x.abs().max(y.abs()) + 0.5 * diameter)
        .fold(wall.usual_radius() + 0.5 * spare, f64::max);
    2.0 * (reach + spare)
}

/// What is logged beside the spheres, named like the columns of the time series; rates over an interval are those of the
/// last sample.
fn values(run: &Run) -> Vec<(Cow<'static, str>, f64)> {
    let simulation = run.simulation();
    let sample = run.recorder().samples().last();
    let instantaneous = View::of(simulation).instantaneous_flow_rate();
    let values = [
        ("period", simulation.wall().cycles()),
        ("heading", simulation.wall().heading()),
        ("flow_rate", sample.map_or(f64::NAN, |it| it.flow_rate)),
        (
            "flow_rate_ratio",
            sample.map_or(f64::NAN, |it| it.flow_rate_ratio),
        ),
        ("flow_rate_instantaneous", instantaneous),
    ];
    values.map(|(name, value)| (name.into(), value)).to_vec()
}

fn contacts(simulation: &Simulation) -> Vec<FrameContact> {
    let touching = simulation.touching().into_iter();
    touching
        .map(|touch| FrameContact {
            spheres: [touch.first, touch.second],
            separation: touch.separation.to_array(),
            overlap: touch.overlap,
            normal_force: touch.normal_force,
            tangential_force: touch.tangential_force,
            sliding: touch.sliding,
        })
        .collect()
}
