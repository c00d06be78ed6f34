//! The presets: complete configurations to start from.

/// A configuration by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Preset {
    /// Name, as `--preset` and `preset = "..."` take it.
    pub name: &'static str,
    /// What it shows, in one sentence.
    pub summary: &'static str,
    /// TOML with comments.
    pub text: &'static str,
}

/// The preset of a name, with the file that is named so.
macro_rules! preset {
    ($name:literal, $summary:literal) => {
        Preset {
            name: $name,
            summary: $summary,
            text: include_str!(concat!("../presets/", $name, ".toml")),
        }
    };
}

/// All presets.
#[rustfmt::skip]
pub const PRESETS: &[Preset] = &[
    preset!("frictionless", "Frictionless grains in a prescribed wall with a coarse lattice: from rest, jams within the run."),
    preset!("frictionless-source", "The same with 12 x 16 wall spheres, whose critical width falls with the strain rate about as fast as in the source."),
    preset!("frictionless-fine", "The same with a fine, nearly smooth lattice of wall spheres."),
    preset!("frictional", "Frictional grains in an elastic wall driven by a travelling force: jammed flow that gives way."),
    preset!("sand-pump", "Sand with its weight in a lying hose that a wave squeezes to half of its bore, in SI units."),
    preset!("soft-robot", "Plastic beads with their weight in a lying tube of four segments that close in turn, in SI units."),
    preset!("silo", "Glass beads that fall through an open tube with a standing bottleneck, in SI units."),
    preset!("oesophagus", "Two boluses of wet grains in a lying elastic tube that a travelling force squeezes, in SI units."),
];

/// The names of all presets.
pub fn preset_names() -> Vec<&'static str> {
    PRESETS.iter().map(|preset| preset.name).collect()
}

/// The preset of a name.
pub fn preset(name: &str) -> Option<&'static Preset> {
    PRESETS.iter().find(|preset| preset.name == name)
}
