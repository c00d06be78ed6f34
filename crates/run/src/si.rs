//! A configuration in SI, where it says its units.

use peristalsis_configuration::{Configuration, Units};
use peristalsis_physics::ends::gap;

/// A configuration in SI, before it runs.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct SiEstimate {
    /// Mass of a grain of diameter 1 \[kg\].
    pub unit_mass_kg: f64,
    /// Diameter of a grain of diameter 1 \[m\].
    pub unit_length_m: f64,
    /// Unit of time \[s\].
    pub unit_time_s: f64,
    /// Unit of pressure \[Pa\].
    pub unit_pressure_pa: f64,
    /// Unit of power \[W\].
    pub unit_power_w: f64,
    /// c/lambda of `drive.strain_rate` \[Hz\].
    pub wave_frequency_hz: f64,
    /// c \[m/s\].
    pub wave_speed_m_per_s: f64,
    /// c/lambda of the fastest wave that `drive.schedule` comes to \[Hz\].
    pub fastest_wave_frequency_hz: f64,
    /// Length of the run \[s\].
    pub duration_s: f64,
    /// Step taken \[s\].
    pub time_step_s: f64,
    /// Mass flow if all grains travel with the fastest wave, Jmax m \[kg/s\].
    pub largest_mass_flow_rate_kg_per_s: f64,
    /// Gravity [x, y, z] \[m/s^2\].
    pub gravity_m_per_s2: [f64; 3],
    /// Body force along the wave, with gravity's part along it \[m/s^2\].
    pub body_force_m_per_s2: f64,
    /// Pressure rise over a wavelength that this body force stands for \[Pa\].
    pub pressure_rise_pa: f64,
    /// Overlap over diameter of two grains that meet at the speed of the fastest wave.
    pub overlap_at_wave_speed: f64,
}

impl SiEstimate {
    pub(crate) fn of(configuration: &Configuration, units: &Units) -> Self {
        let time = units.time();
        let acceleration = units.velocity() / time;
        let hardest = configuration.at_its_hardest();
        let grains = configuration.grains.number as f64;
        // The length that J refers to: of an open tube that between its ends.
        let gap = configuration
            .inlet
            .map_or(0.0, |_| gap(configuration.grains.diameter_max));
        let length = configuration.tube.length() - gap;
        let most = grains * hardest.wave_speed() / length;
        Self {
            unit_mass_kg: units.mass(),
            unit_length_m: units.length(),
            unit_time_s: time,
            unit_pressure_pa: units.pressure(),
            unit_power_w: units.power(),
            wave_frequency_hz: configuration.drive.strain_rate / time,
            wave_speed_m_per_s: configuration.wave_speed() * units.velocity(),
            fastest_wave_frequency_hz: hardest.drive.strain_rate / time,
            duration_s: configuration.run.duration * time,
            time_step_s: configuration.run.time_step * time,
            largest_mass_flow_rate_kg_per_s: most
                * configuration.mean_grain_mass()
                * units.mass_flow(),
            gravity_m_per_s2: configuration.body.gravity.map(|it| it * acceleration),
            body_force_m_per_s2: configuration.axial_body_force() * acceleration,
            pressure_rise_pa: configuration.pressure_rise() * units.pressure(),
            overlap_at_wave_speed: crate::warnings::overlap_at_wave_speed(&hardest),
        }
    }
}
