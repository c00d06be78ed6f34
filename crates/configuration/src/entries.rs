//! The keys of the canonical form, each with its resolved value and what it determines.

use serde::Serialize;

use crate::configuration::{Configuration, Control, NormalLaw};
use crate::units::Elasticity;

/// A value that is written.
pub(crate) enum Value {
    Number(f64),
    Count(u64),
    Boolean(bool),
    Name(String),
}

impl Value {
    pub(crate) fn name(option: impl Serialize) -> Self {
        match serde_json::to_value(option) {
            Ok(serde_json::Value::String(name)) => Self::Name(name),
            // Every option of the vocabulary is an enumeration without fields.
            other => unreachable!("an option is a name, not {other:?}"),
        }
    }

    /// As TOML; numbers with the fewest digits that read back as the same bits.
    pub(crate) fn toml(&self) -> String {
        match self {
            Self::Number(number) => format!("{number:?}"),
            Self::Count(count) => count.to_string(),
            Self::Boolean(boolean) => boolean.to_string(),
            Self::Name(name) => format!("\"{name}\""),
        }
    }

    /// For a hash: numbers by their bits, with one zero.
    pub(crate) fn bits(&self) -> String {
        match self {
            Self::Number(number) => format!("{:016x}", (number + 0.0).to_bits()),
            other => other.toml(),
        }
    }
}

/// Whether a value determines the trajectory of the grains.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    /// It does.
    Physics,
    /// Only how long it is followed, what is measured, and in which units it is told.
    Extent,
}

/// A key, its value and its role.
pub(crate) struct Entry {
    pub(crate) table: &'static str,
    pub(crate) key: &'static str,
    pub(crate) value: Value,
    pub(crate) role: Role,
}

/// Collects entries in the order of the vocabulary.
pub(crate) struct Entries(pub(crate) Vec<Entry>);

impl Entries {
    pub(crate) fn add(&mut self, table: &'static str, key: &'static str, value: Value) {
        self.0.push(Entry {
            table,
            key,
            value,
            role: Role::Physics,
        });
    }

    pub(crate) fn extent(&mut self, table: &'static str, key: &'static str, value: Value) {
        self.0.push(Entry {
            table,
            key,
            value,
            role: Role::Extent,
        });
    }

    pub(crate) fn numbers(&mut self, table: &'static str, numbers: &[(&'static str, f64)]) {
        for (key, number) in numbers {
            self.add(table, key, Value::Number(*number));
        }
    }
}

impl Configuration {
    /// Every key of the canonical form.
    pub(crate) fn entries(&self) -> Entries {
        let mut entries = Entries(Vec::new());
        entries.add("grains", "number", Value::Count(self.grains.number));
        let Self {
            grains,
            tube,
            run,
            observe,
            ..
        } = self;
        entries.numbers(
            "grains",
            &[
                ("diameter_min", grains.diameter_min),
                ("diameter_max", grains.diameter_max),
            ],
        );
        self.contact_entries(&mut entries);
        entries.numbers(
            "tube",
            &[("radius", tube.radius), ("wavelength", tube.wavelength)],
        );
        entries.add("tube", "waves", Value::Count(tube.waves.into()));
        entries.add(
            "tube",
            "spheres_per_ring",
            Value::Count(tube.spheres_per_ring.into()),
        );
        entries.add(
            "tube",
            "rings_per_wave",
            Value::Count(tube.rings_per_wave.into()),
        );
        self.drive_entries(&mut entries);
        entries.add("initial", "state", Value::name(self.initial.state));
        // The state's own velocity is left to the state: written out, it would outlive a change of the wave's speed.
        if self.initial.axial_velocity.to_bits() != self.natural_axial_velocity().to_bits() {
            let velocity = Value::Number(self.initial.axial_velocity);
            entries.add("initial", "axial_velocity", velocity);
        }
        match run.periods {
            Some(periods) => entries.extent("run", "periods", Value::Number(periods)),
            None => entries.extent("run", "duration", Value::Number(run.duration)),
        }
        entries.add("run", "time_step", Value::Number(run.time_step));
        entries.add("run", "integrator", Value::name(run.integrator));
        entries.add("run", "kernel", Value::name(run.kernel));
        entries.add("run", "seed", Value::Count(run.seed));
        entries.add("run", "neighbour_skin", Value::Number(run.neighbour_skin));
        let samples = Value::Count(observe.samples_per_period.into());
        entries.extent("observe", "samples_per_period", samples);
        entries.extent(
            "observe",
            "profile_bins",
            Value::Count(observe.profile_bins.into()),
        );
        entries.extent(
            "observe",
            "late_fraction",
            Value::Number(observe.late_fraction),
        );
        let threshold = Value::Number(observe.transition_threshold);
        entries.extent("observe", "transition_threshold", threshold);
        if let Some(units) = &self.units {
            let (elastic_key, elastic) = match units.elasticity {
                Elasticity::Stiffness { stiffness, .. } => ("stiffness", stiffness),
                Elasticity::YoungModulus { young_modulus, .. } => ("young_modulus", young_modulus),
            };
            for (key, value) in [
                ("grain_diameter", units.grain_diameter),
                ("density", units.density),
                (elastic_key, elastic),
            ] {
                entries.extent("units", key, Value::Number(value));
            }
        }
        entries
    }

    fn contact_entries(&self, entries: &mut Entries) {
        match self.contact.normal {
            NormalLaw::Linear {
                normal_stiffness,
                normal_damping,
            } => {
                entries.add("contact", "law", Value::Name("linear".into()));
                entries.numbers(
                    "contact",
                    &[
                        ("normal_stiffness", normal_stiffness),
                        ("normal_damping", normal_damping),
                    ],
                );
            }
            NormalLaw::Hertz {
                young_modulus,
                poisson_ratio,
                dissipation_time,
                dissipation_form,
            } => {
                entries.add("contact", "law", Value::Name("hertz".into()));
                entries.numbers(
                    "contact",
                    &[
                        ("young_modulus", young_modulus),
                        ("poisson_ratio", poisson_ratio),
                        ("dissipation_time", dissipation_time),
                    ],
                );
                entries.add("contact", "dissipation_form", Value::name(dissipation_form));
            }
        }
        match self.contact.friction {
            Some(friction) => {
                entries.numbers(
                    "contact",
                    &[
                        ("tangential_stiffness", friction.tangential_stiffness),
                        ("tangential_damping", friction.tangential_damping),
                        ("static_friction", friction.static_friction),
                        ("kinetic_friction", friction.kinetic_friction),
                    ],
                );
                entries.add("contact", "sliding", Value::name(friction.sliding));
            }
            // Kinetic friction follows the static one where it is not given; it stands among the derived values.
            None => entries.numbers("contact", &[("static_friction", 0.0)]),
        }
    }

    fn drive_entries(&self, entries: &mut Entries) {
        let drive = &self.drive;
        let control = match drive.control {
            Control::Strain { .. } => "strain",
            Control::Stress { .. } => "stress",
        };
        entries.add("drive", "control", Value::Name(control.into()));
        match drive.control {
            Control::Strain { width } => entries.numbers("drive", &[("width", width)]),
            Control::Stress {
                force_amplitude,
                angle,
                ..
            } => {
                entries.numbers("drive", &[("force_amplitude", force_amplitude)]);
                entries.add("drive", "angle", Value::name(angle));
            }
        }
        entries.numbers("drive", &[("strain_rate", drive.strain_rate)]);
        entries.add("drive", "waveform", Value::name(drive.waveform));
        entries.add("drive", "direction", Value::name(drive.direction));
        // Said only where there is one: configurations from before it could be given keep their hashes.
        if drive.body_force != 0.0 {
            entries.numbers("drive", &[("body_force", drive.body_force)]);
        }
        if drive.schedules.is_empty() {
            entries.add("drive", "schedule", Value::Name("sudden".into()));
        }
        entries.numbers("wall", &[("sphere_diameter", self.wall.sphere_diameter)]);
        let Control::Stress { wall, .. } = drive.control else {
            return;
        };
        entries.numbers(
            "wall",
            &[
                ("sphere_mass", wall.sphere_mass),
                ("spring_stiffness", wall.spring_stiffness),
                ("natural_length", wall.natural_length),
                ("contact_range", wall.contact_range),
                ("drag", wall.drag),
                ("spring_damping", wall.spring_damping),
            ],
        );
        entries.add("wall.keep", "balance", Value::Boolean(wall.keep.balance));
        entries.numbers(
            "wall.keep",
            &[
                ("radial", wall.keep.radial),
                ("azimuthal", wall.keep.azimuthal),
                ("axial", wall.keep.axial),
            ],
        );
        entries.add("wall.keep", "net_force", Value::name(wall.keep.net_force));
    }

    /// Values that follow from the keys.
    pub(crate) fn derived(&self) -> Vec<(&'static str, Value)> {
        let mut derived = vec![
            ("number", Value::Count(self.grains.number)),
            ("volume_fraction", Value::Number(self.volume_fraction())),
            ("number_density", Value::Number(self.number_density())),
            ("length", Value::Number(self.tube.length())),
            ("wall_spheres", Value::Count(self.tube.wall_spheres())),
            ("strain_rate", Value::Number(self.drive.strain_rate)),
            ("wave_speed", Value::Number(self.wave_speed())),
        ];
        if self.contact.friction.is_none() {
            derived.push(("kinetic_friction", Value::Number(0.0)));
        }
        if let (Control::Strain { width }, Some(amplitude)) = (self.drive.control, self.amplitude())
        {
            derived.push(("width", Value::Number(width)));
            derived.push(("amplitude", Value::Number(amplitude)));
        }
        if let (Some(period), Some(periods)) = (self.drive.period(), self.run.periods) {
            derived.push(("period", Value::Number(period)));
            derived.push(("periods", Value::Number(periods)));
        }
        if self.drive.body_force != 0.0 {
            derived.push(("pressure_rise", Value::Number(self.pressure_rise())));
        }
        if let Some(units) = &self.units {
            derived.extend([
                ("unit_mass_kg", Value::Number(units.mass())),
                ("unit_length_m", Value::Number(units.length())),
                ("unit_time_s", Value::Number(units.time())),
                (
                    "wave_frequency_hz",
                    Value::Number(self.drive.strain_rate / units.time()),
                ),
            ]);
        }
        derived.extend([
            ("duration", Value::Number(self.run.duration)),
            ("time_step", Value::Number(self.run.time_step)),
            ("steps", Value::Count(self.run.steps())),
            ("steps_per_sample", Value::Count(self.run.steps_per_sample)),
            ("samples", Value::Count(self.run.samples)),
            ("axial_velocity", Value::Number(self.initial.axial_velocity)),
            (
                "physics_hash",
                Value::Name(hexadecimal(&self.physics_hash())),
            ),
        ]);
        derived
    }
}

fn hexadecimal(bytes: &[u8]) -> String {
    let mut text = String::new();
    for byte in bytes {
        text.push_str(&format!("{byte:02x}"));
    }
    text
}
