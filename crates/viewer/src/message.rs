//! Commands from pages, and notices to them: JSON.

use serde::{Deserialize, Serialize};

/// A command of a client.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[cfg_attr(test, derive(ts_rs::TS))]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
pub(crate) enum Command {
    /// Lets the run go on, or stops it.
    Play {
        /// Whether to go on.
        playing: bool,
    },
    /// Sets the speed.
    Speed {
        /// Periods of the wave a second, at most; as fast as possible where it is missing.
        periods_per_second: Option<f64>,
    },
    /// Goes on by one frame.
    Step {},
    /// Leads a parameter to a value.
    Steer {
        /// Which.
        parameter: Steered,
        /// The value, in the unit of its key.
        value: f64,
    },
    /// Computes the run again up to this time, steered as it was.
    Seek {
        /// Time in periods of the drive's own strain rate.
        period: f64,
    },
    /// Saves the state, from which the command line can go on.
    Save {},
    /// Asks how the run was steered.
    Course {},
    /// Begins anew, and goes on to a step steered like this.
    Follow {
        /// In the order of time.
        turns: Vec<Turn>,
        /// Where to stop.
        step: u64,
    },
    /// Sends the contacts of the grains with each frame, or leaves them out.
    Contacts {
        /// Whether to send them.
        shown: bool,
    },
    /// Asks for a frame of a recording.
    Frame {
        /// Which, counted from 0.
        number: usize,
    },
}

/// A parameter that can be changed while a run goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[cfg_attr(test, derive(ts_rs::TS))]
#[serde(rename_all = "snake_case")]
pub(crate) enum Steered {
    /// w, strain control.
    Width,
    /// f^P, stress control.
    ForceAmplitude,
    /// c/lambda.
    StrainRate,
    /// mu_k; mu_s keeps its proportion to it.
    Friction,
}

impl Steered {
    pub(crate) const ALL: [Self; 4] = [
        Self::Width,
        Self::ForceAmplitude,
        Self::StrainRate,
        Self::Friction,
    ];
}

/// A parameter that was led to a value at a step.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(from = "(u64, Steered, f64)", into = "(u64, Steered, f64)")]
#[cfg_attr(test, derive(ts_rs::TS), ts(type = "[number, Steered, number]"))]
pub(crate) struct Turn {
    pub(crate) step: u64,
    pub(crate) parameter: Steered,
    pub(crate) value: f64,
}

impl From<(u64, Steered, f64)> for Turn {
    fn from((step, parameter, value): (u64, Steered, f64)) -> Self {
        Self {
            step,
            parameter,
            value,
        }
    }
}

impl From<Turn> for (u64, Steered, f64) {
    fn from(turn: Turn) -> Self {
        (turn.step, turn.parameter, turn.value)
    }
}

/// A message to clients other than a frame.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(ts_rs::TS))]
#[serde(tag = "type", rename_all = "snake_case")]
pub(crate) enum Notice {
    /// The state was saved.
    Saved {
        /// The folder; none where the page keeps the state.
        folder: Option<String>,
        /// What goes on from there.
        command: String,
        /// The configuration.
        toml: String,
        /// Whether it makes the same run from the start: a change of friction does not stand in it.
        repeats: bool,
        /// The checkpoint in base64, where the page is to keep it.
        state: Option<String>,
        /// Time in periods.
        period: f64,
    },
    /// How the run was steered.
    Course {
        /// In the order of time.
        turns: Vec<Turn>,
        /// The present step.
        step: u64,
    },
    /// A frame of a recording that cannot be read.
    #[cfg(feature = "server")]
    Missing {
        /// Which, counted from 0.
        number: usize,
        /// Why, in words.
        message: String,
    },
    /// A command failed; the run is as before.
    Problem {
        /// What, in words.
        message: String,
    },
}

impl Notice {
    pub(crate) fn to_json(&self) -> String {
        serde_json::to_string(self).expect("a notice holds words only")
    }
}

/// The notice of a command that failed, in JSON.
pub(crate) fn problem(message: &str) -> String {
    let message = message.to_owned();
    Notice::Problem { message }.to_json()
}

impl Command {
    /// Reads a command.
    ///
    /// # Errors
    /// The error, in words.
    pub(crate) fn read(text: &str) -> Result<Self, String> {
        let command: Self = serde_json::from_str(text).map_err(|error| error.to_string())?;
        let number = match &command {
            Self::Speed { periods_per_second } => periods_per_second.unwrap_or(1.0),
            Self::Steer { value, .. } => *value,
            Self::Seek { period } => *period,
            Self::Follow { turns, .. } if turns.is_sorted_by_key(|turn| turn.step) => turns
                .iter()
                .fold(0.0, |least: f64, turn| least.min(turn.value)),
            Self::Follow { .. } => return Err("turns are not in the order of time".to_owned()),
            Self::Play { .. } | Self::Step {} | Self::Save {} | Self::Course {} => 0.0,
            Self::Contacts { .. } | Self::Frame { .. } => 0.0,
        };
        if number.is_finite() && number >= 0.0 {
            Ok(command)
        } else {
            Err(format!("{number} is not a number from 0 on"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_are_read() {
        let read = |text| Command::read(text).unwrap();
        assert_eq!(
            read(r#"{"type":"play","playing":true}"#),
            Command::Play { playing: true }
        );
        assert_eq!(
            read(r#"{"type":"speed","periods_per_second":null}"#),
            Command::Speed {
                periods_per_second: None
            }
        );
        assert_eq!(
            read(r#"{"type":"steer","parameter":"width","value":2.7}"#),
            Command::Steer {
                parameter: Steered::Width,
                value: 2.7
            }
        );
        assert_eq!(read(r#"{"type":"save"}"#), Command::Save {});
        assert_eq!(
            read(r#"{"type":"frame","number":7}"#),
            Command::Frame { number: 7 }
        );
    }

    #[test]
    fn what_is_no_command_is_refused() {
        for text in [
            "",
            "{}",
            "[]",
            "null",
            r#"{"type":"quit"}"#,
            r#"{"type":"save","folder":"/etc"}"#,
            r#"{"type":"seek","period":-1}"#,
            r#"{"type":"seek","period":1e999}"#,
            r#"{"type":"speed","periods_per_second":-2}"#,
            r#"{"type":"steer","parameter":"seed","value":1}"#,
            r#"{"type":"play","playing":"yes"}"#,
            r#"{"type":"follow","turns":[[9,"width",2.5],[3,"width",2.6]],"step":12}"#,
            r#"{"type":"follow","turns":[[9,"width",-2.5]],"step":12}"#,
            r#"{"type":"frame"}"#,
            r#"{"type":"frame","number":-1}"#,
            r#"{"type":"frame","number":1.5}"#,
            r#"{"type":"frame","number":"../state.checkpoint"}"#,
            r#"{"type":"frame","number":18446744073709551616}"#,
        ] {
            assert!(Command::read(text).is_err(), "{text}");
        }
    }
}
