//! What a page must know of a run before its first frame.

use peristalsis_configuration::{Control, ScheduledParameter};
use peristalsis_engine::Wall;
use peristalsis_run::{Configuration, Run, VERSION};
use serde::Serialize;

use crate::course::Course;
use crate::frame::Row;
use crate::within::Within;

/// The tube and the ranges of its sliders.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Welcome {
    #[serde(rename = "type")]
    kind: &'static str,
    version: &'static str,
    title: String,
    control: &'static str,
    grains: usize,
    length: f64,
    wavelength: f64,
    waves: u32,
    radius: f64,
    spheres_per_ring: u32,
    rings_per_wave: u32,
    wall_sphere_diameter: f64,
    heading: f64,
    /// Largest radius that is expected.
    reach: f64,
    /// Time of a period of the drive's own strain rate.
    unit_period: f64,
    ranges: Ranges,
    pub(crate) driven: Driven,
    /// A run that was computed before: its whole course, (time in periods, J/Jmax).
    pub(crate) record: Vec<(f64, f64)>,
    /// What was computed since the viewer began, or the time series of a recording.
    pub(crate) rows: Vec<Row>,
    /// Time in periods to which the run was meant to go.
    end: f64,
    /// The frames of a recording; null where the run is computed.
    pub(crate) recorded: Option<Recorded>,
    /// The study that it was opened from; null where it was opened by itself.
    pub(crate) within: Option<Within>,
}

/// What frames there are.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Recorded {
    /// Time of each in periods.
    pub(crate) clocks: Vec<f64>,
    /// Frames that were begun when the file was cut short.
    pub(crate) lost_frames: u64,
}

/// Least and largest value of each slider; none where there is nothing to change.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Ranges {
    width: Option<(f64, f64)>,
    force_amplitude: Option<(f64, f64)>,
    strain_rate: Option<(f64, f64)>,
    friction: Option<(f64, f64)>,
}

/// What is driven, as it is now.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Driven {
    pub(crate) width: Option<f64>,
    pub(crate) force_amplitude: Option<f64>,
    pub(crate) strain_rate: Option<f64>,
    pub(crate) friction: Option<f64>,
}

impl Driven {
    pub(crate) fn of(run: &Run) -> Self {
        Self {
            width: run.driven(ScheduledParameter::Width),
            force_amplitude: run.driven(ScheduledParameter::ForceAmplitude),
            strain_rate: run.driven(ScheduledParameter::StrainRate),
            friction: run
                .configuration()
                .contact
                .friction
                .map(|it| it.kinetic_friction),
        }
    }
}

impl Ranges {
    fn of(configuration: &Configuration) -> Self {
        let radius = configuration.tube.radius;
        let diameter = configuration.wall.sphere_diameter;
        let (width, force_amplitude) = match configuration.drive.control {
            // From a throat that a grain just does not pass to a straight tube.
            Control::Strain { width } => {
                let least = (1.6 * diameter).min(width).min(2.0 * radius);
                (Some((least, 2.0 * radius)), None)
            }
            Control::Stress {
                force_amplitude, ..
            } => (None, Some((0.0, (2.5 * force_amplitude).max(0.008)))),
        };
        let strain_rate = configuration.drive.strain_rate;
        Self {
            width,
            force_amplitude,
            strain_rate: (strain_rate > 0.0).then_some((0.1 * strain_rate, 4.0 * strain_rate)),
            friction: configuration
                .contact
                .friction
                .map(|it| (0.01, it.kinetic_friction.max(1.0))),
        }
    }
}

impl Welcome {
    /// At the start, with nothing measured.
    pub(crate) fn of(
        configuration: &Configuration,
        wall: &Wall,
        grains: usize,
        title: &str,
    ) -> Self {
        let lattice = wall.lattice();
        let course = Course(configuration);
        let end = configuration.run.steps() as f64 * configuration.run.time_step;
        Self {
            kind: "welcome",
            version: VERSION,
            title: title.to_owned(),
            control: match configuration.drive.control {
                Control::Strain { .. } => "strain",
                Control::Stress { .. } => "stress",
            },
            grains,
            length: lattice.length(),
            wavelength: lattice.wavelength,
            waves: lattice.waves,
            radius: configuration.tube.radius,
            spheres_per_ring: lattice.spheres_per_ring,
            rings_per_wave: lattice.rings_per_wave,
            wall_sphere_diameter: lattice.sphere_diameter,
            heading: wall.heading(),
            reach: 2.0 * configuration.tube.radius,
            unit_period: course.unit_period(),
            ranges: Ranges::of(configuration),
            driven: course.driven(0.0),
            record: Vec::new(),
            rows: Vec::new(),
            end: course.clock(end),
            recorded: None,
            within: None,
        }
    }

    pub(crate) fn to_json(&self) -> String {
        serde_json::to_string(self).expect("a welcome holds numbers and words only")
    }
}
