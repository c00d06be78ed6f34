//! The identity of a run: a hash of all that determines its products.

use std::fmt;
use std::ops::Not;
use std::str::FromStr;

use peristalsis_configuration::Configuration;
use peristalsis_formats::hexadecimal;
use peristalsis_observe::COLUMNS;
pub use peristalsis_run::PHYSICS_VERSION;
use peristalsis_run::Stopping;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

/// What is kept of each run besides its row of numbers. How often it is sampled is base.observe.samples_per_period.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Record {
    /// Columns of the time series. Default: all.
    #[schemars(extend("minItems" = 1, "items" = {"type": "string", "enum": column_names()}))]
    pub columns: Option<Vec<String>>,
    /// Whether the profile in the wave frame is kept.
    pub profile: bool,
    /// Whether the flow of each wave over each period is kept, waves.parquet: J/Jmax and number of the grains between two
    /// throats, a row for each wave of each period.
    #[serde(skip_serializing_if = "Not::not")]
    #[schemars(extend("default" = false))]
    pub waves: bool,
    /// Whether the spheres as they stand at the end are kept, snapshot.parquet: places along the wave and across it,
    /// diameters, axial velocities, one row per sphere.
    #[serde(skip_serializing_if = "Not::not")]
    #[schemars(extend("default" = false))]
    pub snapshot: bool,
}

impl Default for Record {
    fn default() -> Self {
        Self {
            columns: None,
            profile: true,
            waves: false,
            snapshot: false,
        }
    }
}

/// Names of the columns of a time series.
pub(crate) fn column_names() -> Vec<&'static str> {
    COLUMNS.iter().map(|column| column.quantity.name).collect()
}

/// Identity of a run: the first 128 bits of a SHA-256 of all that determines its products.
///
/// These are the resolved configuration without its seed, [`PHYSICS_VERSION`], the rule by which the run may stop early, the
/// files that are kept of it, and the number of the replicate. The identity does not depend on the study: a point that two studies share is the
/// same run, and a point that is added changes no other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Identity([u8; 16]);

impl Identity {
    /// Identity and seed of each replicate of a point.
    ///
    /// The seed is a hash of the physics of the configuration and the number of the replicate. Neither the run's length nor
    /// its observables count: a longer study of the same point follows the same trajectories.
    pub(crate) fn of(
        configuration: &Configuration,
        stopping: Option<Stopping>,
        record: &Record,
        replicates: u32,
    ) -> Vec<(Self, u64)> {
        let mut configuration = configuration.clone();
        configuration.run.seed = 0;
        let mut run = format!(
            "peristalsis run of a study 1\nphysics {PHYSICS_VERSION}\nconfiguration {}\n",
            hexadecimal(&configuration.run_hash())
        );
        let end = stopping.map_or("to its end".to_owned(), |stopping| {
            format!("settled {}", stopping.settled_periods)
        });
        let columns = record.columns.as_ref();
        let columns = columns.map_or("all columns".to_owned(), |names| {
            format!("columns {}", names.join(" "))
        });
        run.push_str(&format!("{end}\n{columns}\nprofile {}\n", record.profile));
        // An option that is absent is not written.
        if record.waves {
            run.push_str("waves\n");
        }
        if record.snapshot {
            run.push_str("snapshot\n");
        }
        let physics = hexadecimal(&configuration.physics_hash());
        let physics = format!("peristalsis seed 1\nphysics {physics}\n");
        let digest =
            |text: &str, replicate: u32| Sha256::digest(format!("{text}replicate {replicate}\n"));
        (0..replicates)
            .map(|replicate| {
                let identity = Self(leading(&digest(&run, replicate)));
                // TOML has whole numbers of 63 bits.
                let seed = u64::from_le_bytes(leading(&digest(&physics, replicate))) >> 1;
                (identity, seed)
            })
            .collect()
    }
}

fn leading<const N: usize>(digest: &[u8]) -> [u8; N] {
    digest[..N]
        .try_into()
        .expect("a digest of 32 bytes is longer")
}

impl fmt::Display for Identity {
    /// As 32 hexadecimal digits.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&hexadecimal(&self.0))
    }
}

/// A text is not 32 lower-case hexadecimal digits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("not an identity: 32 lower-case hexadecimal digits")]
pub struct NotAnIdentity;

impl FromStr for Identity {
    type Err = NotAnIdentity;

    fn from_str(text: &str) -> Result<Self, NotAnIdentity> {
        let is_digit = |byte: u8| matches!(byte, b'0'..=b'9' | b'a'..=b'f');
        if text.len() != 32 || !text.bytes().all(is_digit) {
            return Err(NotAnIdentity);
        }
        let number = u128::from_str_radix(text, 16).map_err(|_| NotAnIdentity)?;
        Ok(Self(number.to_be_bytes()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identities_read_back_and_nothing_else_does() {
        let identity = Identity([0x0f; 16]);
        assert_eq!(identity.to_string().parse(), Ok(identity));
        for text in [
            "",
            "0f",
            &"0F".repeat(16),
            &"é".repeat(16),
            &"0f".repeat(17),
        ] {
            assert_eq!(text.parse::<Identity>(), Err(NotAnIdentity), "{text}");
        }
    }
}
