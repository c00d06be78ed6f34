//! Initial states: grains at rest in the tube, settled in it, or gathered in its bellies and moving with the wave.

mod insertion;
mod packing;
mod relaxation;
mod settling;

use glam::DVec3;
use peristalsis_physics::contact::Normal;
use peristalsis_physics::with_normal_law;
use rand_chacha::ChaCha8Rng;
use rand_core::SeedableRng;

pub use peristalsis_physics::method::InitialState;

pub use self::packing::{LARGEST_MEAN_OVERLAP, Packing, PackingReport};
pub use self::settling::{AT_REST, settle};

use crate::bodies::Bodies;
use crate::error::EngineError;
use crate::random::{standard_normal, uniform};
use crate::wall::Wall;

/// Purposes of random numbers: each has its own stream, so that one never shifts another.
enum Stream {
    Diameters = 1,
    Positions = 2,
    Velocities = 4,
}

/// Random numbers of a purpose.
fn random(seed: u64, stream: Stream) -> ChaCha8Rng {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(stream as u64);
    random
}

/// Diameters of the first `number` grains, beginning with those of the packing \[d\].
pub fn diameters(packing: &Packing, number: usize) -> Vec<f64> {
    let mut random = random(packing.seed, Stream::Diameters);
    (0..number)
        .map(|_| packing.sizes.diameter(uniform(&mut random)))
        .collect()
}

/// Packs grains into the tube as it stands at t = 0; an elastic wall stands in its reference tube, and its spheres are
/// appended to the grains.
///
/// Random sequential insertion without overlap; where it stalls, the rest is put at random places and all grains grow to
/// their size while the elastic energy is minimised. Velocities are set afterwards. The grains are numbered along the
/// tube. The same seed gives the same state.
///
/// # Errors
/// [`EngineError::DoesNotFit`] where the mean overlap stays above [`LARGEST_MEAN_OVERLAP`] largest diameters, or where
/// more than one grain in a hundred is pressed out through the wall.
pub fn pack(
    packing: &Packing,
    wall: &Wall,
    normal: Normal,
) -> Result<(Bodies, PackingReport), EngineError> {
    pack_unless(packing, wall, normal, &|| false)
}

/// As [`pack`], but `stop` is asked often whether to stop.
///
/// # Errors
/// As [`pack`]; [`EngineError::Stopped`] where it was asked to stop.
pub fn pack_unless(
    packing: &Packing,
    wall: &Wall,
    normal: Normal,
    stop: &dyn Fn() -> bool,
) -> Result<(Bodies, PackingReport), EngineError> {
    let diameter = diameters(packing, packing.number);
    let region = insertion::Region::new(packing, wall);
    let mut positions = random(packing.seed, Stream::Positions);
    let (position, inserted) = insertion::insert(&diameter, &region, &mut positions, stop)?;

    // Numbered along the tube: grains that meet then lie close in memory as well.
    let mut grains: Vec<(DVec3, f64)> = position.into_iter().zip(diameter).collect();
    grains.sort_by(|a, b| a.0.z.total_cmp(&b.0.z));
    let (position, diameter) = grains.into_iter().unzip();
    let mut bodies = Bodies::grains_at_rest(position, diameter);
    wall.append_spheres(&mut bodies);
    let mut report = PackingReport::default();
    if inserted < packing.number {
        report = with_normal_law!(normal, law => relaxation::grow(&law, &mut bodies, wall, stop)?);
    }
    report.inserted = inserted;
    let mut velocities = random(packing.seed, Stream::Velocities);
    let grains = bodies.velocity.iter_mut().zip(&bodies.mass);
    for (velocity, mass) in grains.take(packing.number) {
        *velocity = DVec3::new(0.0, 0.0, packing.axial_velocity);
        if packing.temperature > 0.0 {
            let deviation = (packing.temperature / mass).sqrt();
            *velocity +=
                deviation * DVec3::from([(); 3].map(|()| standard_normal(&mut velocities)));
        }
    }
    Ok((bodies, report))
}
