//! Choices by name: every enumeration of the vocabulary, spelt in TOML as in the record of a run.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Normal contact law.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(crate) enum NormalLawName {
    /// Linear spring and dashpot.
    Linear,
    /// Hertz spring with viscoelastic damping.
    Hertz,
}

/// Factor of the viscoelastic damping of the Hertz law.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DissipationForm {
    /// As the talk prints it: xi^(3/2) - A sqrt(xi) v_n.
    Printed,
    /// The standard viscoelastic sphere: 3/2 in front of A.
    Viscoelastic,
}

/// What becomes of the tangential displacement u while a contact slides.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Sliding {
    /// |u| is cut to mu_k f_n/k_t; the dissipation is never negative.
    Spring,
    /// u = -(f_t + eta_t v_t)/k_t: the common choice, which can create spring energy at onset.
    Balance,
    /// u grows on while the contact slides.
    Literal,
}

/// What of the wall is prescribed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(crate) enum ControlName {
    /// The radius of the wall, R(z, t).
    Strain,
    /// The radial force on each sphere of an elastic wall.
    Stress,
}

/// Shape of the wave; the throat is at phase 3/4 and as deep, a - b, in all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Waveform {
    /// sin(2 pi phase): throats and bellies alike.
    Sine,
    /// One smooth squeeze, cos^2, over half of each wavelength; elsewhere the tube is straight, of radius a.
    Bolus,
    /// A round roller pressed into the tube over half of each wavelength; elsewhere the tube is straight, of radius a.
    Roller,
}

/// Which way the wave runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WaveDirection {
    /// As the source writes it: towards -z under strain control, towards +z under stress control.
    Forward,
    /// Turned round.
    Backward,
}

/// The angle that fixes the direction of the driving force on a wall sphere.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DriveAngle {
    /// That of the sphere's place in the lattice.
    Reference,
    /// That of the sphere as it stands.
    Current,
}

/// What is done with the mean force on the elastic wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum NetForce {
    /// Nothing.
    Free,
    /// The mean over the whole wall is taken off each sphere, every step.
    Removed,
    /// The mean over each ring is taken off each sphere of the ring, every step.
    RemovedPerRing,
}

/// How the grains stand at t = 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum InitialState {
    /// Spread over the tube, at rest: J = 0.
    Rest,
    /// Gathered in the bellies and moving with the wave: J = Jmax.
    Jammed,
}

/// How the equations of motion are stepped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Integrator {
    /// Velocity Verlet.
    Verlet,
    /// Two-step Adams-Bashforth, the source's choice for the frictional model.
    AdamsBashforth,
}

/// Which kernel computes the forces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Kernel {
    /// The fastest for the case at hand; the same bits on every machine.
    Fast,
    /// The plain one that the fast ones are tested against; equal up to rounding.
    Reference,
}

/// Schedule of the drive by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(crate) enum ScheduleName {
    /// The drive has its values from t = 0 on.
    Sudden,
    /// The amplitude grows linearly from nothing to its value within drive.ramp_periods.
    Ramp,
}

/// Course of a scheduled parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(crate) enum ScheduleFormName {
    /// Linear in time between start and end, constant before and after.
    Ramp,
    /// Constant between the times given.
    Steps,
    /// Linear in time from each value to the next, constant before the first and after the last.
    Course,
}

/// A parameter of the drive that may follow a schedule.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(crate) enum ScheduledParameterName {
    /// drive.width (strain control).
    Width,
    /// drive.amplitude (strain control).
    Amplitude,
    /// drive.force_amplitude (stress control).
    ForceAmplitude,
    /// drive.strain_rate.
    StrainRate,
    /// drive.wave_speed.
    WaveSpeed,
}
