//! A page that looks at a run which somebody else advances.

use peristalsis_run::{Run, Warning};

use crate::frame::{Head, contacts_of, of_run};
use crate::timeline::{Driven, history, rows};
use crate::welcome::Welcome;

/// The side of a page that shows a run which somebody else advances and steers.
#[derive(Debug, Default)]
pub struct Onlooker {
    /// Whether frames hold the contacts of the grains.
    contacts: bool,
    /// Samples that the page has got.
    told: u64,
    /// The warnings of the run as they were after so many periods.
    warned: Option<(u64, Vec<Warning>)>,
}

impl Onlooker {
    /// The first message to the page, in JSON. Friction has no slider, since it does not belong to the drive.
    pub fn welcome(&mut self, run: &Run, title: &str) -> String {
        let (configuration, simulation) = (run.configuration(), run.simulation());
        let grains = simulation.bodies().grains;
        let mut welcome = Welcome::of(configuration, simulation.wall(), grains, title);
        welcome.driven = Driven::of(run);
        welcome.ranges.friction = None;
        welcome.rows = history(rows(run, 0));
        self.told = run.recorder().taken();
        welcome.to_json()
    }

    /// Sends the contacts of the grains with each frame, or leaves them out.
    pub fn show_contacts(&mut self, shown: bool) {
        self.contacts = shown;
    }

    /// The bytes of a message with the present frame, of a run that goes on or rests, at a speed in periods per second.
    pub fn frame(&mut self, run: &Run, playing: bool, speed: Option<f64>) -> Vec<u8> {
        let contacts = match self.contacts {
            true => contacts_of(run),
            false => Vec::new(),
        };
        let periods = run.recorder().periods();
        if self.warned.as_ref().is_none_or(|(at, _)| *at != periods) {
            self.warned = Some((periods, run.warnings()));
        }
        // A kept sample may cover several; the last one may not yet have all of them.
        let first = self.told.div_ceil(run.recorder().intervals()) as usize;
        let head = Head {
            playing,
            speed,
            rows: rows(run, first),
            warnings: self.warned.iter().flat_map(|it| it.1.clone()).collect(),
            ..Head::of(run, &contacts)
        };
        self.told = run.recorder().taken();
        of_run(&head, run, &contacts)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use peristalsis_configuration::{Configuration, ScheduledParameter};

    use super::*;

    fn head(bytes: &[u8]) -> serde_json::Value {
        let length = u32::from_le_bytes(bytes[..4].try_into().unwrap()) as usize;
        serde_json::from_slice(&bytes[4..4 + length]).unwrap()
    }

    #[test]
    fn a_page_is_told_of_a_run_that_somebody_else_advances() {
        let settings = ["tube.waves=2", "drive.width=2.6"].map(str::to_owned);
        let configuration = Configuration::from_preset("frictionless", &settings).unwrap();
        let mut run = Run::new(configuration).unwrap();
        let mut onlooker = Onlooker::default();
        let welcome: serde_json::Value =
            serde_json::from_str(&onlooker.welcome(&run, "mine")).unwrap();
        assert_eq!(
            (&welcome["title"], &welcome["waves"]),
            (&"mine".into(), &2.into())
        );
        assert!(welcome["ranges"]["friction"].is_null());
        run.drive_to(ScheduledParameter::Width, 2.4, 0.0).unwrap();
        run.advance_at_most(1000).unwrap();
        let frame = head(&onlooker.frame(&run, true, Some(1.0)));
        assert_eq!(
            (&frame["playing"], &frame["aims"]["width"]),
            (&true.into(), &2.4.into())
        );
        // Rows are told once.
        let rows = frame["rows"].as_array().unwrap().len();
        assert!(rows > 0 && rows == run.recorder().samples().len());
        let again = head(&onlooker.frame(&run, true, None));
        assert!(again["rows"].as_array().unwrap().is_empty() && again["contacts"] == 0);
        onlooker.show_contacts(true);
        assert_ne!(head(&onlooker.frame(&run, true, None))["contacts"], 0);
    }
}
