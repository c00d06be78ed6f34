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

/// All presets.
pub const PRESETS: &[Preset] = &[
    Preset {
        name: "frictionless",
        summary: "Frictionless grains in a prescribed wall with a coarse lattice: from rest, jams within the run.",
        text: include_str!("../presets/frictionless.toml"),
    },
    Preset {
        name: "frictionless-source",
        summary: "The same with the lattice on which most claims of the source hold.",
        text: include_str!("../presets/frictionless-source.toml"),
    },
    Preset {
        name: "frictionless-fine",
        summary: "The same with a fine, nearly smooth lattice of wall spheres.",
        text: include_str!("../presets/frictionless-fine.toml"),
    },
    Preset {
        name: "frictional",
        summary: "Frictional grains in an elastic wall driven by a travelling force: jammed flow that gives way.",
        text: include_str!("../presets/frictional.toml"),
    },
    Preset {
        name: "sand-pump",
        summary: "Sand with its weight in a lying hose that a wave squeezes to half of its bore, in SI units.",
        text: include_str!("../presets/sand-pump.toml"),
    },
    Preset {
        name: "soft-robot",
        summary: "Plastic beads with their weight in a lying tube of four segments that close in turn, in SI units.",
        text: include_str!("../presets/soft-robot.toml"),
    },
    Preset {
        name: "silo",
        summary: "Glass beads that fall through an open tube with a standing bottleneck, in SI units.",
        text: include_str!("../presets/silo.toml"),
    },
    Preset {
        name: "oesophagus",
        summary: "A bolus of wet grains in a lying elastic tube that a travelling force squeezes, in SI units.",
        text: include_str!("../presets/oesophagus.toml"),
    },
];

/// The preset of a name.
pub fn preset(name: &str) -> Option<&'static Preset> {
    PRESETS.iter().find(|preset| preset.name == name)
}
