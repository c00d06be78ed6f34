//! Entries of the legend for what several layers have in common.

use super::look::{Look, Tint};

/// An entry of the legend for what several layers have in common, such as open markers.
#[derive(Clone, Debug, Default, PartialEq)]
#[must_use]
pub struct Key {
    pub(super) name: String,
    pub(super) look: Look,
    pub(super) sample: Sample,
}

/// What a key shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Sample {
    #[default]
    Filled,
    Open,
    Area,
}

impl Key {
    /// A filled marker; the name is in markup.
    pub fn filled(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            look: Look::of(Tint::Black),
            sample: Sample::Filled,
        }
    }

    /// A marker with a white inside.
    pub fn open(name: &str) -> Self {
        Self {
            sample: Sample::Open,
            ..Self::filled(name)
        }
    }

    /// A shaded area.
    pub fn area(name: &str) -> Self {
        Self {
            sample: Sample::Area,
            look: Look::of(Tint::Grey),
            ..Self::filled(name)
        }
    }
}
