//! One tube and what a page says to it.

use peristalsis_configuration::{Configuration, Sources};
use peristalsis_run::Run;
use peristalsis_viewer::Tube;
use peristalsis_viewer::message::{Command, problem};
use serde::Deserialize;

/// A tube, if one has been asked for.
#[derive(Debug, Default)]
pub struct Cabin {
    tube: Option<Tube>,
    /// What is to be told, in the order in which it happened.
    told: Vec<String>,
}

/// What tube a page asks for.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Wanted {
    preset: String,
    /// Values that go over the preset, such as `drive.width=2.7`.
    #[serde(default)]
    settings: Vec<String>,
}

impl Cabin {
    /// Begins the tube that a text in JSON asks for, in place of the one before. Its welcome, or what is wrong, is told;
    /// what is wrong leaves the tube that there is.
    pub fn open(&mut self, wanted: &str, clock: fn() -> f64) {
        match begin(wanted, clock) {
            Ok(tube) => {
                self.told.push(tube.welcome());
                self.tube = Some(tube);
            }
            Err(reason) => self.told.push(problem(&reason)),
        }
    }

    /// Does what a command in JSON says.
    pub fn command(&mut self, text: &str) {
        match (Command::read(text), &mut self.tube) {
            (Ok(command), Some(tube)) => tube.take(command),
            (Ok(_), None) => {}
            (Err(reason), _) => self.told.push(problem(&reason)),
        }
        self.listen();
    }

    /// Advances by a frame where there is anything to compute; whether there was.
    pub fn advance(&mut self) -> bool {
        let Some(tube) = self.tube.as_mut().filter(|tube| tube.is_going()) else {
            return false;
        };
        tube.advance_by_a_frame();
        self.listen();
        true
    }

    /// What it looks like, as bytes; `None` where there is no tube.
    #[must_use]
    pub fn frame(&self) -> Option<Vec<u8>> {
        self.tube.as_ref().map(Tube::frame)
    }

    /// The next thing to be told, in JSON.
    pub fn told(&mut self) -> Option<String> {
        (!self.told.is_empty()).then(|| self.told.remove(0))
    }

    fn listen(&mut self) {
        if let Some(tube) = &mut self.tube {
            self.told.extend(tube.notices());
        }
    }
}

fn begin(wanted: &str, clock: fn() -> f64) -> Result<Tube, String> {
    let wanted: Wanted = serde_json::from_str(wanted).map_err(|error| error.to_string())?;
    let configuration = Configuration::from_sources(&Sources {
        file: None,
        preset: Some(&wanted.preset),
        overrides: &wanted.settings,
    })
    .map_err(|error| error.to_string())?;
    let run = Run::new(configuration).map_err(|error| error.to_string())?;
    Ok(Tube::for_page(run, wanted.preset, clock))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    const SMALL: &str =
        r#"{"preset":"frictionless","settings":["tube.waves=2","drive.width=2.6"]}"#;

    /// A clock by which every look takes a millisecond.
    fn ticking() -> f64 {
        use std::sync::atomic::{AtomicU64, Ordering};
        static LOOKS: AtomicU64 = AtomicU64::new(0);
        1e-3 * LOOKS.fetch_add(1, Ordering::Relaxed) as f64
    }

    fn told(cabin: &mut Cabin) -> serde_json::Value {
        serde_json::from_str(&cabin.told().unwrap()).unwrap()
    }

    /// The head of a frame.
    fn head(cabin: &Cabin) -> serde_json::Value {
        let frame = cabin.frame().unwrap();
        let length = u32::from_le_bytes(frame[..4].try_into().unwrap()) as usize;
        serde_json::from_slice(&frame[4..4 + length]).unwrap()
    }

    #[test]
    fn a_tube_is_opened_driven_and_gives_its_state_to_the_page() {
        let mut cabin = Cabin::default();
        assert!(cabin.frame().is_none() && !cabin.advance());
        cabin.open(SMALL, ticking);
        let welcome = told(&mut cabin);
        assert_eq!(
            (&welcome["type"], &welcome["waves"]),
            (&"welcome".into(), &2.into())
        );
        assert!(!cabin.advance(), "it goes on by itself");
        cabin.command(r#"{"type":"speed","periods_per_second":null}"#);
        cabin.command(r#"{"type":"play","playing":true}"#);
        while head(&cabin)["clock"].as_f64().unwrap() < 1.0 {
            assert!(cabin.advance());
        }
        let steered = r#"{"type":"steer","parameter":"width","value":2.4}"#;
        cabin.command(steered);
        while head(&cabin)["driven"]["width"] != 2.4 {
            assert!(cabin.advance());
        }
        cabin.command(r#"{"type":"save"}"#);
        let saved = told(&mut cabin);
        assert_eq!(saved["folder"], serde_json::Value::Null);
        assert!(saved["toml"].as_str().unwrap().contains("[drive]"));
        assert!(saved["state"].as_str().unwrap().len() > 1000);
        assert!(cabin.told().is_none());
    }

    #[test]
    fn what_cannot_be_is_told_and_leaves_the_tube() {
        let mut cabin = Cabin::default();
        cabin.open(SMALL, ticking);
        told(&mut cabin);
        for wanted in [
            "",
            r#"{"preset":"sandpit"}"#,
            r#"{"preset":"frictionless","settings":["drive.width=-1"]}"#,
            r#"{"preset":"frictionless","folder":"/"}"#,
        ] {
            cabin.open(wanted, ticking);
            assert_eq!(told(&mut cabin)["type"], "problem", "{wanted}");
        }
        cabin.command("quit");
        assert_eq!(told(&mut cabin)["type"], "problem");
        assert_eq!(head(&cabin)["step"], 0);
    }
}
