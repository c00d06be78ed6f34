//! The memory that a run takes.

use peristalsis_configuration::{Configuration, Control};
use peristalsis_observe::{MOST_ROWS, Sample, WaveFlow};
use peristalsis_physics::wall::Arrangement;

use crate::RunError;

/// Bytes of the program itself while it draws its figures, at most: 48 to 65 million are measured.
const BYTES_OF_PROGRAM: f64 = 7e7;
/// Bytes of a frictionless grain in a prescribed tube, at most: some 450 are measured (BENCHMARKS.md), 960 of a wide dense one.
const BYTES_OF_GRAIN: f64 = 1200.0;
/// Bytes of a sphere with friction or in an elastic tube, where contacts are remembered, at most: 1,200 to 2,100 are measured.
const BYTES_WITH_CONTACTS: f64 = 3000.0;

/// Bytes of a sphere of a prescribed wall, at most, where each has a place of its own: some 90 are measured.
const BYTES_OF_PLACE: f64 = 120.0;

/// Grains, and spheres of an elastic wall.
pub(crate) fn moving_spheres(configuration: &Configuration) -> u64 {
    let of_wall = match configuration.drive.control {
        Control::Strain { .. } => 0,
        Control::Stress { .. } => configuration.tube.wall_spheres(),
    };
    configuration.grains.number.saturating_add(of_wall)
}

/// Bytes that a run takes at most, about: as measured of runs with many spheres and of runs with many samples.
pub(crate) fn memory(configuration: &Configuration) -> f64 {
    let waves = f64::from(configuration.tube.waves);
    let periods = configuration.run.duration * configuration.drive.strain_rate;
    // A series holds two entries at least, and each wave has sums of its own; all are there twice while they are written.
    let rows_of_waves = (waves * periods).min((2.0 * waves).max(MOST_ROWS as f64)) + waves;
    let samples = configuration.run.samples as f64;
    let of_sphere = if configuration.remembers_contacts() {
        BYTES_WITH_CONTACTS
    } else {
        BYTES_OF_GRAIN
    };
    let tube = &configuration.tube;
    let has_places = tube.arrangement.is_drawn() || tube.arrangement == Arrangement::File;
    let places = if has_places { tube.wall_spheres() } else { 0 };
    BYTES_OF_PROGRAM
        + BYTES_OF_PLACE * places as f64
        + of_sphere * moving_spheres(configuration) as f64
        + (size_of::<Sample>() as f64) * samples.min(MOST_ROWS as f64)
        + (2 * size_of::<WaveFlow>()) as f64 * rows_of_waves
}

/// Asks for the memory of the whole run at once, and gives it back: what the system will not give in one piece would end
/// the program later, in the middle of its work.
pub(crate) fn check_memory(configuration: &Configuration) -> Result<(), RunError> {
    let spheres = moving_spheres(configuration);
    let bytes = memory(configuration) as u64;
    let mut room: Vec<u8> = Vec::new();
    let given = room.try_reserve_exact(usize::try_from(bytes).unwrap_or(usize::MAX));
    given.map_err(|_| RunError::NoMemory { spheres, bytes })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A numerical auditor: two million spheres at random places took 223 MB, where 40 were told.
    #[test]
    fn spheres_of_the_wall_count_where_each_has_a_place() {
        let bytes = |arrangement: &str| {
            let settings = [
                arrangement,
                "tube.waves=2",
                "tube.spheres_per_ring=1000",
                "tube.rings_per_wave=1000",
            ];
            memory(&Configuration::from_preset("frictionless", &settings).unwrap())
        };
        let [rings, random] =
            ["staggered", "random"].map(|it| bytes(&format!("tube.arrangement={it}")));
        assert!(
            rings < 8e7 && random > 2.5e8 && random < 3.3e8,
            "{rings} {random}"
        );
    }
}
