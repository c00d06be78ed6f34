//! The dimensionless groups of a tube with its grains.

use peristalsis_configuration::{
    Arrangement, Configuration, Control, Ends, InitialState, WaveformName,
};
use peristalsis_run::{overlap_at_wave_speed, restitution_at_wave_speed};

/// A dimensionless group: what it is, and how far apart two of its values are.
pub struct Group {
    /// Its name in tables.
    pub name: &'static str,
    /// What it is, in words.
    pub meaning: &'static str,
    /// Distance of two values that counts as 1, that of their logarithms where `by_ratio`.
    scale: f64,
    /// Whether ratios count, and values below this least one as it.
    by_ratio: Option<f64>,
    /// Whether tubes that have none of it are another kind, which tells nothing of those that have some.
    is_kind: bool,
    value: fn(&Tube<'_>) -> f64,
}

/// A tube in what its groups are made of. d is the mean diameter of the grains.
struct Tube<'a> {
    configuration: &'a Configuration,
    /// Clear bore, clear throat and d.
    bore: f64,
    throat: f64,
    diameter: f64,
}

impl Tube<'_> {
    /// An acceleration times the bore over c^2: the energy to cross the bore against it, over that of the wave's speed.
    fn against_the_wave(&self, acceleration: f64) -> f64 {
        let speed = self.configuration.wave_speed();
        acceleration * self.bore / (speed * speed)
    }
}

/// So many groups.
pub const GROUPS: usize = 11;

/// All groups, in the order of the published points.
pub const ALL: [Group; GROUPS] = [
    Group {
        name: "bore_over_grain",
        meaning: "clear bore over grain diameter",
        scale: 0.7,
        by_ratio: Some(0.1),
        is_kind: false,
        value: |tube| tube.bore / tube.diameter,
    },
    Group {
        name: "occlusion",
        meaning: "occlusion, 1 - (clear throat)/(clear bore)",
        scale: 0.04,
        by_ratio: None,
        is_kind: false,
        value: |tube| 1.0 - tube.throat / tube.bore,
    },
    Group {
        name: "wavelength_over_bore",
        meaning: "wavelength over clear bore",
        scale: 0.7,
        by_ratio: Some(0.01),
        is_kind: false,
        value: |tube| tube.configuration.tube.wavelength / tube.bore,
    },
    Group {
        name: "fill",
        meaning: "volume of the grains over that of the bore",
        scale: 0.15,
        by_ratio: None,
        is_kind: false,
        value: |tube| {
            let outer = 2.0 * tube.configuration.tube.radius / tube.bore;
            tube.configuration.volume_fraction() * outer * outer
        },
    },
    Group {
        name: "spread",
        meaning: "spread of the diameters, to either side of the mean",
        scale: 0.2,
        by_ratio: None,
        is_kind: false,
        value: |tube| {
            let grains = &tube.configuration.grains;
            0.5 * (grains.diameter_max - grains.diameter_min) / tube.diameter
        },
    },
    Group {
        name: "friction",
        meaning: "friction, static",
        scale: 0.1,
        by_ratio: None,
        is_kind: true,
        value: |tube| {
            let friction = tube.configuration.contact.friction;
            friction.map_or(0.0, |law| law.static_friction)
        },
    },
    Group {
        name: "lost",
        meaning: "1 - restitution, of two grains that meet at the wave's speed",
        scale: 1.0,
        by_ratio: Some(0.005),
        is_kind: false,
        value: |tube| 1.0 - restitution_at_wave_speed(tube.configuration),
    },
    Group {
        name: "softness",
        meaning: "overlap of two grains that meet at the wave's speed, over the diameter",
        scale: 0.7,
        by_ratio: Some(0.03),
        is_kind: false,
        value: |tube| overlap_at_wave_speed(tube.configuration),
    },
    Group {
        name: "wall_spacing",
        meaning: "spacing of the wall's spheres over grain diameter (a real wall: 0)",
        scale: 0.5,
        by_ratio: Some(0.2),
        is_kind: false,
        value: |tube| {
            let lattice = &tube.configuration.tube;
            let around = core::f64::consts::TAU * lattice.radius * lattice.length();
            match lattice.wall_spheres() {
                // A smooth wall is one without spheres.
                0 => 0.0,
                spheres => (around / spheres as f64).sqrt() / tube.diameter,
            }
        },
    },
    Group {
        name: "weight_across",
        meaning: "gravity across the tube, g (bore)/c^2",
        scale: 0.05,
        by_ratio: None,
        is_kind: false,
        value: |tube| {
            let [x, y, _] = tube.configuration.body.gravity;
            tube.against_the_wave(x.hypot(y))
        },
    },
    Group {
        name: "load",
        meaning: "weight and back pressure against the wave, as an acceleration g (bore)/c^2",
        scale: 0.02,
        by_ratio: None,
        is_kind: true,
        value: |tube| 0.0 - tube.against_the_wave(tube.configuration.axial_body_force()),
    },
];

/// What a tube has that no group tells of and no published point has, as key and words.
pub(super) fn unlike(configuration: &Configuration) -> Vec<&'static str> {
    let Configuration {
        contact,
        drive,
        initial,
        tube,
        ..
    } = configuration;
    let is_moved = initial.axial_velocity != 0.0 && initial.state != InitialState::Jammed;
    let is_other_wall = !matches!(
        tube.arrangement,
        Arrangement::Staggered | Arrangement::Smooth
    );
    let unlike = [
        (
            is_other_wall,
            "tube.arrangement: rings of published tubes like it are staggered, and stand for smooth walls too",
        ),
        (
            drive.waveform != WaveformName::Sine,
            "drive.waveform: published tubes like it have a sine wave",
        ),
        (
            !drive.schedules.is_empty(),
            "drive.schedule: published tubes like it have a constant drive",
        ),
        (
            tube.ends == Ends::Open,
            "tube.ends: published tubes like it are periodic",
        ),
        (
            contact.cohesion.is_some(),
            "contact.cohesion_force or surface_energy: grains of published tubes like it only repel",
        ),
        (
            contact.rolling.is_some(),
            "contact.rolling_friction: grains of published tubes like it roll freely",
        ),
        (
            initial.temperature != 0.0,
            "initial.temperature: grains of published tubes like it begin at rest",
        ),
        (
            is_moved,
            "initial.axial_velocity: grains of published tubes like it begin at rest, or jammed with the wave",
        ),
    ];
    unlike
        .into_iter()
        .filter(|it| it.0)
        .map(|it| it.1)
        .collect()
}

impl Group {
    /// How far apart two values are: infinitely where they are of two kinds of tube.
    pub(super) fn distance(&self, one: f64, other: f64) -> f64 {
        if self.is_kind && (one == 0.0) != (other == 0.0) {
            return f64::INFINITY;
        }
        let apart = match self.by_ratio {
            Some(least) => (one.max(least) / other.max(least)).ln(),
            None => one - other,
        };
        apart.abs() / self.scale
    }
}

/// The groups of a configuration under a prescribed wall whose wave moves; `None` of another.
pub fn groups(configuration: &Configuration) -> Option<[f64; GROUPS]> {
    let Control::Strain { width } = configuration.drive.control else {
        return None;
    };
    let sphere = configuration.wall.sphere_diameter;
    let grains = &configuration.grains;
    let tube = Tube {
        configuration,
        bore: 2.0 * configuration.tube.radius - sphere,
        throat: width - sphere,
        diameter: grains.distribution().mean(1),
    };
    let moves = configuration.drive.strain_rate > 0.0 && tube.bore > 0.0;
    moves.then(|| ALL.map(|group| (group.value)(&tube)))
}
