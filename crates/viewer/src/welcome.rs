//! The first message to the page of a run.

use peristalsis_configuration::{Control, Ends, PRESETS, WaveformName};
use peristalsis_engine::Wall;
use peristalsis_observe::MOST_ROWS;
use peristalsis_physics::newtonian::NewtonianPeristalsis;
use peristalsis_run::{Configuration, VERSION};
use serde::Serialize;

use crate::timeline::{Driven, Row, Sliders, Timeline};
use crate::within::Within;

/// The tube and the ranges of its sliders.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(ts_rs::TS))]
pub(crate) struct Welcome {
    #[serde(rename = "type")]
    #[cfg_attr(test, ts(type = "\"welcome\""))]
    kind: &'static str,
    version: &'static str,
    title: String,
    #[cfg_attr(test, ts(type = "\"strain\" | \"stress\""))]
    control: &'static str,
    grains: usize,
    length: f64,
    /// Whether grains leave the tube at its ends; otherwise it is periodic.
    open: bool,
    wavelength: f64,
    waves: u32,
    radius: f64,
    spheres_per_ring: u32,
    rings_per_wave: u32,
    wall_sphere_diameter: f64,
    heading: f64,
    /// Largest expected radius.
    reach: f64,
    /// Duration of a period at the strain rate of the drive, the unit of every clock; null where the wave stands, and clocks
    /// tell t.
    unit_period: Option<f64>,
    pub(crate) ranges: Ranges,
    /// J/Jmax of a Newtonian fluid against no pressure by the width \[d\]; empty where the force is prescribed, and where the
    /// wave is no sine that moves.
    newtonian: Vec<(f64, f64)>,
    pub(crate) driven: Driven,
    /// The preset that differs in nothing but what sliders and the length of the tube may change: published branches are of
    /// some presets.
    published: Option<&'static str>,
    /// The whole time series of a run that was computed before: (time in periods, J/Jmax).
    #[cfg_attr(test, ts(as = "Vec<(f64, Option<f64>)>"))]
    pub(crate) record: Vec<(f64, f64)>,
    /// The time series since the viewer began, or of a recording.
    pub(crate) rows: Vec<Row>,
    /// Time in periods of the state that the viewer began with.
    pub(crate) begin: f64,
    /// Duration of the run in periods.
    end: f64,
    /// Samples after which a watched run stops.
    most_samples: usize,
    /// The frames of a recording; null where the run is computed.
    pub(crate) recorded: Option<Recorded>,
    /// The study that it was opened from; null where it was opened by itself.
    pub(crate) within: Option<Within>,
}

/// The frames of a recording.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(ts_rs::TS))]
pub(crate) struct Recorded {
    /// Time of each in periods.
    pub(crate) clocks: Vec<f64>,
    /// Number of frames lost where the file was cut short.
    pub(crate) lost_frames: u64,
}

/// Least and largest values.
pub(crate) type Ranges = Sliders<(f64, f64)>;

impl Ranges {
    fn of(configuration: &Configuration) -> Self {
        let drive = &configuration.drive;
        let own = Driven::by(configuration, |parameter| drive.own(parameter));
        let widest = 2.0 * configuration.tube.radius;
        let diameter = configuration.wall.sphere_diameter;
        // From a throat that a grain just does not pass to a straight tube.
        let narrowest = |width: f64| (1.6 * diameter).min(width).min(widest);
        let moving = own.strain_rate.filter(|rate| *rate > 0.0);
        let strongest = |force: f64| (0.0, (2.5 * force).max(0.008));
        // A wave that stands has no periods in which it could be led.
        let moves = |_: &f64| drive.period().is_some();
        let (width, force_amplitude) = (own.width.filter(moves), own.force_amplitude.filter(moves));
        Self {
            width: width.map(|width| (narrowest(width), widest)),
            force_amplitude: force_amplitude.map(strongest),
            strain_rate: moving.map(|rate| (round(0.1 * rate), round(4.0 * rate))),
            friction: own.friction.map(|kinetic| (0.01, kinetic.max(1.0))),
        }
    }
}

/// A number to ten digits, without the noise of its last bits.
fn round(number: f64) -> f64 {
    (1e10 * number).round() / 1e10
}

/// Flow of a Newtonian fluid in the tube to the centres of its wall spheres, at widths over the range of the slider.
fn newtonian(ranges: &Ranges, configuration: &Configuration) -> Vec<(f64, f64)> {
    let (drive, radius) = (&configuration.drive, configuration.tube.radius);
    let is_known = drive.waveform == WaveformName::Sine && drive.period().is_some();
    let Some((from, to)) = ranges.width.filter(|_| is_known) else {
        return Vec::new();
    };
    let widths = (0..=40).map(|place| from + f64::from(place) / 40.0 * (to - from));
    let flow = |width: f64| NewtonianPeristalsis::from_width(width, radius, 0.0);
    widths
        .filter_map(|width| Some((width, flow(width)?.flow_rate_ratio())))
        .collect()
}

/// The preset of this kind of tube and grains.
fn published(configuration: &Configuration) -> Option<&'static str> {
    let mut names = PRESETS.iter().map(|preset| preset.name);
    names.find(|name| {
        let preset = Configuration::from_preset(name, &[""; 0]).expect("presets are valid");
        in_place_of(&preset, configuration) == preset
    })
}

/// A configuration with its course, its length and what sliders change as in a preset.
fn in_place_of(preset: &Configuration, configuration: &Configuration) -> Configuration {
    let mut like = configuration.clone();
    let waves = f64::from(like.tube.waves) / f64::from(preset.tube.waves);
    // As many grains a wave, but that both numbers are rounded.
    let apart = like.grains.number as f64 - waves * preset.grains.number as f64;
    if apart.abs() <= 0.5 * (1.0 + waves) {
        like.grains.number = preset.grains.number;
    }
    like.tube.waves = preset.tube.waves;
    let (parameter, amplitude) = preset.drive.control.amplitude();
    like.drive.set_amplitude(parameter, amplitude);
    like.drive.schedules.clear();
    like.drive.strain_rate = preset.drive.strain_rate;
    like.drive.direction = preset.drive.direction;
    if let (Some(friction), Some(usual)) = (&mut like.contact.friction, &preset.contact.friction) {
        // A slider keeps their ratio.
        let own = friction.kinetic_friction * usual.static_friction;
        if (own - friction.static_friction * usual.kinetic_friction).abs() < 1e-9 {
            friction.static_friction = usual.static_friction;
            friction.kinetic_friction = usual.kinetic_friction;
        }
    }
    (like.initial, like.run, like.observe) = (preset.initial, preset.run, preset.observe);
    like
}

impl Welcome {
    /// The welcome at the start, without samples.
    pub(crate) fn of(
        configuration: &Configuration,
        wall: &Wall,
        grains: usize,
        title: &str,
    ) -> Self {
        let drawn = wall.drawn(0.0);
        let wall = drawn.as_ref().unwrap_or(wall);
        let lattice = wall.lattice();
        let ranges = Ranges::of(configuration);
        let timeline = Timeline(configuration);
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
            length: wall.length(),
            open: configuration.tube.ends == Ends::Open,
            wavelength: wall.wavelength(),
            waves: wall.waves(),
            radius: configuration.tube.radius,
            spheres_per_ring: lattice.map_or(0, |lattice| lattice.spheres_per_ring),
            rings_per_wave: lattice.map_or(configuration.tube.rings_per_wave, |lattice| {
                lattice.rings_per_wave
            }),
            wall_sphere_diameter: wall.sphere_diameter(),
            heading: wall.heading(),
            reach: 2.0 * configuration.tube.radius,
            unit_period: configuration.drive.period(),
            newtonian: newtonian(&ranges, configuration),
            ranges,
            driven: timeline.driven(0.0),
            published: published(configuration),
            record: Vec::new(),
            rows: Vec::new(),
            begin: 0.0,
            end: timeline.clock(end),
            most_samples: MOST_ROWS,
            recorded: None,
            within: None,
        }
    }

    pub(crate) fn to_json(&self) -> String {
        serde_json::to_string(self).expect("a welcome holds numbers and words only")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_branches_are_of_the_same_kind() {
        let kind = |preset: &str, settings: &[&str]| {
            published(&Configuration::from_preset(preset, settings).unwrap())
        };
        for name in ["frictionless", "frictionless-source", "frictionless-fine"] {
            let driven = [
                "tube.waves=3",
                "drive.width=2.5",
                "initial.state=jammed",
                "run.seed=4",
            ];
            assert_eq!(kind(name, &driven), Some(name));
        }
        let driven = ["drive.force_amplitude=0.002", "contact.static_friction=0.2"];
        let driven = [
            &driven[..],
            &["contact.kinetic_friction=0.16", "tube.waves=2"],
        ]
        .concat();
        assert_eq!(kind("frictional", &driven), Some("frictional"));
        for other in [
            "contact.normal_damping=0.3",
            "grains.volume_fraction=0.6",
            "grains.number=0",
            "tube.arrangement=\"random\"",
            "contact.normal_stiffness=8",
            "drive.waveform=\"bolus\"",
            "drive.body_force=-0.003",
        ] {
            assert_eq!(kind("frictionless", &[other]), None, "{other}");
        }
        for other in [
            "grains.number_density=0.3",
            "contact.static_friction=1",
            "wall.spring_stiffness=0.05",
            "tube.radius=4",
        ] {
            assert_eq!(kind("frictional", &[other]), None, "{other}");
        }
    }

    #[test]
    fn a_newtonian_fluid_is_known_in_a_sine_that_moves() {
        let points = |settings: &[&str]| {
            let configuration = Configuration::from_preset("frictionless", settings).unwrap();
            newtonian(&Ranges::of(&configuration), &configuration).len()
        };
        assert_eq!(points(&[]), 41);
        assert_eq!(points(&["drive.waveform=\"roller\""]), 0);
        assert_eq!(points(&["drive.strain_rate=0", "run.duration=10"]), 0);
    }
}
