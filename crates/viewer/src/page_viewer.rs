//! The viewer without a server: one tube that the page itself computes, in texts and bytes.

use std::collections::VecDeque;

use peristalsis_configuration::Configuration;
use peristalsis_run::Run;
use serde::Deserialize;

use crate::message::{Command, problem};
use crate::tube::Tube;

/// A tube, if a page has asked for one, and the notices that the page has not fetched.
#[derive(Debug, Default)]
pub struct PageViewer {
    tube: Option<Tube>,
    notices: VecDeque<String>,
}

/// The tube that a page asks for.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct TubeRequest {
    preset: String,
    /// Values that go over the preset, such as `drive.width=2.7`.
    #[serde(default)]
    settings: Vec<String>,
}

impl PageViewer {
    /// Begins the tube that a text in JSON asks for, in place of the one before, with its welcome as a notice. After an
    /// error, which becomes a notice too, the tube before goes on. `clock` answers seconds since any instant.
    pub fn open(&mut self, request: &str, clock: fn() -> f64) {
        let notice = match begin(request, clock) {
            Ok(tube) => self.tube.insert(tube).welcome(),
            Err(reason) => problem(&reason),
        };
        self.notices.push_back(notice);
    }

    /// Carries out a command in JSON.
    pub fn command(&mut self, text: &str) {
        match (Command::read(text), &mut self.tube) {
            (Ok(command), Some(tube)) => self.notices.extend(tube.execute(command)),
            (Ok(_), None) => {}
            (Err(reason), _) => self.notices.push_back(problem(&reason)),
        }
        self.collect_notices();
    }

    /// Advances by a frame if there is anything to compute; answers whether there was.
    pub fn advance(&mut self) -> bool {
        let Some(tube) = self.tube.as_mut().filter(|tube| tube.is_going()) else {
            return false;
        };
        tube.advance_by_a_frame();
        self.collect_notices();
        true
    }

    /// The bytes of a frame; `None` without a tube.
    pub fn frame(&self) -> Option<Vec<u8>> {
        self.tube.as_ref().map(|tube| tube.frame(false))
    }

    /// The next notice to the page, in JSON.
    pub fn notice(&mut self) -> Option<String> {
        self.notices.pop_front()
    }

    fn collect_notices(&mut self) {
        if let Some(tube) = &mut self.tube {
            self.notices.extend(tube.notices());
        }
    }
}

fn begin(request: &str, clock: fn() -> f64) -> Result<Tube, String> {
    let request: TubeRequest = serde_json::from_str(request).map_err(|error| error.to_string())?;
    let configuration = Configuration::from_preset(&request.preset, &request.settings)
        .map_err(|error| error.to_string())?;
    let run = Run::new(configuration).map_err(|error| error.to_string())?;
    Ok(Tube::for_page(run, request.preset, clock))
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

    fn notice(viewer: &mut PageViewer) -> serde_json::Value {
        serde_json::from_str(&viewer.notice().unwrap()).unwrap()
    }

    /// The head of a frame.
    fn head(viewer: &PageViewer) -> serde_json::Value {
        let frame = viewer.frame().unwrap();
        let length = u32::from_le_bytes(frame[..4].try_into().unwrap()) as usize;
        serde_json::from_slice(&frame[4..4 + length]).unwrap()
    }

    #[test]
    fn a_tube_is_opened_driven_and_gives_its_state_to_the_page() {
        let mut viewer = PageViewer::default();
        assert!(viewer.frame().is_none() && !viewer.advance());
        viewer.open(SMALL, ticking);
        let welcome = notice(&mut viewer);
        assert_eq!(
            (&welcome["type"], &welcome["waves"]),
            (&"welcome".into(), &2.into())
        );
        assert!(!viewer.advance(), "it goes on by itself");
        viewer.command(r#"{"type":"speed","periods_per_second":null}"#);
        viewer.command(r#"{"type":"play","playing":true}"#);
        while head(&viewer)["clock"].as_f64().unwrap() < 1.0 {
            assert!(viewer.advance());
        }
        let steered = r#"{"type":"steer","parameter":"width","value":2.4}"#;
        viewer.command(steered);
        while head(&viewer)["driven"]["width"] != 2.4 {
            assert!(viewer.advance());
        }
        viewer.command(r#"{"type":"save"}"#);
        let saved = notice(&mut viewer);
        assert_eq!(saved["folder"], serde_json::Value::Null);
        assert!(saved["toml"].as_str().unwrap().contains("[drive]"));
        assert!(saved["state"].as_str().unwrap().len() > 1000);
        assert!(viewer.notice().is_none());
    }

    #[test]
    fn a_request_that_fails_is_told_and_leaves_the_tube() {
        let mut viewer = PageViewer::default();
        viewer.open(SMALL, ticking);
        notice(&mut viewer);
        for request in [
            "",
            r#"{"preset":"sandpit"}"#,
            r#"{"preset":"frictionless","settings":["drive.width=-1"]}"#,
            r#"{"preset":"frictionless","folder":"/"}"#,
        ] {
            viewer.open(request, ticking);
            assert_eq!(notice(&mut viewer)["type"], "problem", "{request}");
        }
        viewer.command("quit");
        assert_eq!(notice(&mut viewer)["type"], "problem");
        assert_eq!(head(&viewer)["step"], 0);
    }
}
