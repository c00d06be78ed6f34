//! The message with a frame: a head in JSON, then numbers.
//!
//! | bytes | content |
//! |---|---|
//! | 4 | length n of the head, a multiple of 4, little-endian |
//! | n | the head: JSON, filled up with spaces |
//! | 12 N | centres of the grains, x y z |
//! | 12 N | their velocities |
//! | 4 N | their diameters |
//! | 12 N | their angular velocities, where grains turn |
//! | 12 W or 4 R | centres of the wall's spheres, or radii of the rings of one wavelength where the page knows the rest |
//! | 24 C | contacts: grain, partner or -1 for the wall, x y z of the partner (the point where the wall is touched), normal force |
//!
//! Numbers are 32 bits wide, little-endian, in units of d and t, in the frame of the tube. A grain that waits outside an
//! open tube is nowhere: its centre is NaN.

#[cfg(feature = "server")]
use peristalsis_configuration::Ends;
use peristalsis_engine::{Bodies, Touching, Wall};
#[cfg(feature = "server")]
use peristalsis_formats::Frame;
use peristalsis_observe::{GrainContact, Sample, grain_contacts};
use peristalsis_physics::wall::Lattice;
use peristalsis_run::{Run, Warning};
use serde::Serialize;

use crate::timeline::{Driven, Row, Timeline};

/// Mean radii of an open tube from its axis beyond which grains of a recording wait: the engine puts them farther away.
#[cfg(feature = "server")]
const WAITING: f64 = 3.0;

/// The head of a frame.
#[derive(Clone, Debug, Default, Serialize)]
#[cfg_attr(test, derive(ts_rs::TS))]
pub(crate) struct Head {
    /// Number of a recorded frame, counted from 0; null where the run is computed.
    pub(crate) number: Option<usize>,
    /// Whether the run has gone on from here since; such frames come after a welcome, without rows.
    pub(crate) past: bool,
    /// Grows when the run jumps back, which makes frames after that time void.
    pub(crate) epoch: u64,
    pub(crate) playing: bool,
    /// Whether the run diverged, so that no frame follows.
    pub(crate) ended: bool,
    /// Speed asked for in periods per second; null is as fast as possible.
    pub(crate) speed: Option<f64>,
    pub(crate) step: u64,
    pub(crate) time: f64,
    /// Time in periods of the drive's own strain rate.
    pub(crate) clock: f64,
    /// Wavelengths that the wave has run.
    pub(crate) period: f64,
    pub(crate) wave_speed: f64,
    pub(crate) grains: usize,
    pub(crate) wall_spheres: usize,
    pub(crate) rings: usize,
    pub(crate) turning: bool,
    /// Number of contacts; 0 where nobody asked for them.
    pub(crate) contacts: usize,
    pub(crate) driven: Driven,
    /// Where the sliders lead: the driven values, unless a parameter is on its way.
    pub(crate) aims: Driven,
    /// The last rows of the time series; clients know by their numbers which they have.
    pub(crate) rows: Vec<Row>,
    /// The last sample.
    pub(crate) sample: Option<Shown>,
    /// Warnings about the run so far; about the whole run if it is a recording.
    #[cfg_attr(test, ts(type = "Array<{ key: string, message: string }>"))]
    pub(crate) warnings: Vec<Warning>,
}

impl Head {
    /// Of a run at rest as it is, on its first course, without rows and warnings.
    pub(crate) fn of(run: &Run, contacts: &[f64]) -> Self {
        let simulation = run.simulation();
        let wall = simulation.wall();
        let (wall_spheres, rings) = of_wall(wall);
        let driven = Driven::of(run);
        Self {
            step: simulation.step(),
            time: simulation.time(),
            clock: Timeline(run.configuration()).clock(simulation.time()),
            period: wall.cycles(),
            wave_speed: wall.wave_speed(simulation.time()),
            grains: simulation.bodies().grains,
            wall_spheres,
            rings,
            turning: run.configuration().contact.friction.is_some(),
            contacts: contacts.len() / 6,
            driven,
            aims: driven,
            sample: run.recorder().samples().last().map(Into::into),
            ..Self::default()
        }
    }
}

/// Numbers of a sample that are shown.
#[derive(Clone, Copy, Debug, Serialize)]
#[cfg_attr(test, derive(ts_rs::TS))]
pub(crate) struct Shown {
    flow_rate: f64,
    #[cfg_attr(test, ts(as = "Option<f64>"))]
    flow_rate_ratio: f64,
    granular_temperature: f64,
    contacts: f64,
    escaped: f64,
    bottleneck: f64,
    wall_power: f64,
    #[cfg_attr(test, ts(as = "Option<f64>"))]
    energy_residual: f64,
    /// Mass that an open tube discharges a time, 0 of a periodic one; `hold_up` is the mass inside.
    discharge_rate: f64,
    hold_up: f64,
}

impl From<&Sample> for Shown {
    fn from(sample: &Sample) -> Self {
        Self {
            flow_rate: sample.flow_rate,
            flow_rate_ratio: sample.flow_rate_ratio,
            granular_temperature: sample.granular_temperature,
            contacts: sample.contacts,
            escaped: sample.escaped,
            bottleneck: sample.bottleneck,
            wall_power: sample.wall_power,
            energy_residual: sample.energy_residual,
            discharge_rate: sample.discharge_rate,
            hold_up: sample.hold_up,
        }
    }
}

/// The contacts of the grains as they stand, six numbers each.
pub(crate) fn contacts_of(run: &Run) -> Vec<f64> {
    let bodies = run.simulation().bodies();
    let of_contact = |contact: GrainContact| {
        let Touching { first, second, .. } = contact.touching;
        let (partner, end) = if contact.is_with_wall {
            (-1.0, contact.point)
        } else {
            // The periodic image that the grain touches.
            let centre = bodies.position[first] - contact.touching.separation;
            (second as f64, centre)
        };
        let force = contact.touching.normal_force;
        [first as f64, partner, end.x, end.y, end.z, force]
    };
    let contacts = grain_contacts(run.simulation()).into_iter();
    contacts.flat_map(of_contact).collect()
}

/// The frame of a run as it is.
pub(crate) fn of_run(head: &Head, run: &Run, contacts: &[f64]) -> Vec<u8> {
    let Bodies {
        grains,
        position,
        velocity,
        diameter,
        angular_velocity,
        ..
    } = run.simulation().bodies();
    let mobile = &position[*grains..];
    let mut of_grains = flat(&position[..*grains]);
    if let Some(ends) = run.simulation().ends() {
        hide(&mut of_grains, |grain, _| ends.waits(grain));
    }
    let spin = if head.turning {
        &angular_velocity[..*grains]
    } else {
        &[]
    };
    let wall = run.simulation().wall();
    let drawn = wall.drawn(run.simulation().time());
    let wall = drawn.as_ref().unwrap_or(wall);
    let mut of_wall = mobile.to_vec();
    if known_rings(wall).is_none() {
        of_wall.extend(wall.prescribed_spheres().map(|sphere| sphere.position));
    }
    let rings = radii(wall);
    let arrays: [&[f64]; 7] = [
        &of_grains,
        &flat(&velocity[..*grains]),
        &diameter[..*grains],
        &flat(spin),
        &flat(&of_wall),
        &rings,
        contacts,
    ];
    encode(head, arrays)
}

/// The staggered lattice of a wall that moves as prescribed: the page needs its radii only, of other walls all spheres.
pub(crate) fn known_rings(wall: &Wall) -> Option<&Lattice> {
    wall.wave()?;
    wall.lattice().filter(|lattice| lattice.staggered)
}

/// Radii of the rings of a wavelength as a wall stands, where the page knows the rest.
pub(crate) fn radii(wall: &Wall) -> Vec<f64> {
    let (Some(lattice), Some(wave)) = (known_rings(wall), wall.wave()) else {
        return Vec::new();
    };
    let places = (0..lattice.rings_per_wave).map(|ring| lattice.axial_position(ring));
    places.map(|z| wave.radius(z, wall.cycles())).collect()
}

/// How many spheres of a wall, and radii of its rings, a frame holds; of a smooth wall those that are drawn.
pub(crate) fn of_wall(wall: &Wall) -> (usize, usize) {
    let drawn = wall.drawn(0.0);
    match known_rings(drawn.as_ref().unwrap_or(wall)) {
        Some(lattice) => (0, lattice.rings_per_wave as usize),
        None => (wall.mobile_spheres() + wall.prescribed_spheres().count(), 0),
    }
}

#[cfg(feature = "server")]
/// A recorded frame of a run with such a wall, and with such ends.
pub(crate) fn of_recording(head: &Head, frame: &Frame, wall: &Wall, ends: Ends) -> Vec<u8> {
    let grains = frame.grains;
    let spin = frame.rotation.as_ref();
    let per_ring = wall.lattice().map_or(0, |it| it.spheres_per_ring) as usize;
    let rings = match wall.drawn(frame.time) {
        Some(drawn) => radii(&drawn),
        None => (0..head.rings)
            .map(|ring| {
                let [x, y, _] = frame.position[grains + ring * per_ring];
                (x * x + y * y).sqrt()
            })
            .collect(),
    };
    let of_wall = &frame.position[frame.position.len() - head.wall_spheres..];
    let mut of_grains = frame.position[..grains].as_flattened().to_vec();
    if ends == Ends::Open {
        let far = WAITING * wall.mean_radius();
        hide(&mut of_grains, |_, [x, y, _]| x.hypot(*y) > far);
    }
    let arrays: [&[f64]; 7] = [
        &of_grains,
        frame.velocity[..grains].as_flattened(),
        &frame.diameter[..grains],
        spin.map_or(&[], |it| it.angular_velocity.as_flattened()),
        of_wall.as_flattened(),
        &rings,
        &[],
    ];
    encode(head, arrays)
}

/// Takes the place from the grains that wait.
fn hide(centres: &mut [f64], waits: impl Fn(usize, &[f64; 3]) -> bool) {
    let (centres, _) = centres.as_chunks_mut::<3>();
    for (grain, centre) in centres.iter_mut().enumerate() {
        if waits(grain, centre) {
            *centre = [f64::NAN; 3];
        }
    }
}

fn flat<Vector: Copy + Into<[f64; 3]>>(vectors: &[Vector]) -> Vec<f64> {
    vectors.iter().flat_map(|&vector| vector.into()).collect()
}

/// Puts a frame together.
fn encode(head: &Head, arrays: [&[f64]; 7]) -> Vec<u8> {
    let mut json = serde_json::to_vec(head).expect("a head holds numbers and words only");
    json.resize(json.len().next_multiple_of(4), b' ');
    let numbers: usize = arrays.iter().map(|array| array.len()).sum();
    let mut bytes = Vec::with_capacity(4 + json.len() + 4 * numbers);
    bytes.extend((json.len() as u32).to_le_bytes());
    bytes.extend(json);
    for value in arrays.into_iter().flatten() {
        bytes.extend((*value as f32).to_le_bytes());
    }
    bytes
}
