//! A page that looks at a run which somebody else advances.

use peristalsis_run::{Run, RunError, Warning};

use crate::frame::{Head, contacts_of, of_run};
use crate::message::{Command, Steered};
use crate::steering::Steering;
use crate::timeline::{Driven, rows, thin};
use crate::welcome::Welcome;

/// What a page has been told of a run that somebody else advances, and where its sliders lead that run.
#[derive(Debug, Default)]
pub struct Onlooker {
    steering: Steering,
    /// Whether frames hold the contacts of the grains.
    contacts: bool,
    /// Rows of the time series that the page has got.
    told: usize,
    /// The warnings of the run as they were after so many periods.
    warned: Option<(u64, Vec<Warning>)>,
}

impl Onlooker {
    /// The first message to the page, in JSON. Friction has no slider: it is none of the drive.
    pub fn welcome(&mut self, run: &Run, title: &str) -> String {
        let (configuration, simulation) = (run.configuration(), run.simulation());
        let grains = simulation.bodies().grains;
        let mut welcome = Welcome::of(configuration, simulation.wall(), grains, title);
        welcome.driven = Driven::of(run);
        welcome.ranges.friction = None;
        welcome.rows = thin(rows(run, 0));
        self.told = run.recorder().samples().len();
        welcome.to_json()
    }

    /// Carries out a command of the page in JSON: a slider that was moved, or contacts that are to be sent. What else a
    /// page can ask for is up to whoever advances the run.
    ///
    /// # Errors
    /// A text that is no command, in words; or a value that the run cannot be led to.
    pub fn command(&mut self, run: &mut Run, text: &str) -> Result<(), String> {
        match Command::read(text)? {
            Command::Steer { parameter, value } if parameter != Steered::Friction => {
                self.steering.want(parameter, value);
                self.follow(run).map_err(|error| error.to_string())?;
            }
            Command::Contacts { shown } => self.contacts = shown,
            _ => {}
        }
        Ok(())
    }

    /// Leads the run to where sliders were moved while it was on its way elsewhere.
    ///
    /// # Errors
    /// A value that it cannot be led to.
    pub fn follow(&mut self, run: &mut Run) -> Result<(), RunError> {
        while let Some((parameter, value)) = self.steering.next(run) {
            self.steering.lead(run, parameter, value)?;
        }
        Ok(())
    }

    /// The bytes of a message with the present frame, of a run that goes on or rests, at a speed in periods a second.
    pub fn frame(&mut self, run: &Run, playing: bool, speed: Option<f64>) -> Vec<u8> {
        let contacts = match self.contacts {
            true => contacts_of(run),
            false => Vec::new(),
        };
        let periods = run.recorder().periods();
        if self.warned.as_ref().is_none_or(|(at, _)| *at != periods) {
            self.warned = Some((periods, run.warnings()));
        }
        let head = Head {
            playing,
            speed,
            aims: self.steering.aims(run),
            rows: rows(run, self.told).collect(),
            warnings: self.warned.iter().flat_map(|it| it.1.clone()).collect(),
            ..Head::of(run, &contacts)
        };
        self.told = run.recorder().samples().len();
        of_run(&head, run, &contacts)
    }

    /// Where the sliders of the drive lead: width, force amplitude and strain rate, as far as the run has them.
    pub fn aims(&self, run: &Run) -> [Option<f64>; 3] {
        let aims = self.steering.aims(run);
        [aims.width, aims.force_amplitude, aims.strain_rate]
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use peristalsis_configuration::Configuration;

    use super::*;

    fn head(bytes: &[u8]) -> serde_json::Value {
        let length = u32::from_le_bytes(bytes[..4].try_into().unwrap()) as usize;
        serde_json::from_slice(&bytes[4..4 + length]).unwrap()
    }

    #[test]
    fn a_slider_leads_a_run_that_somebody_else_advances() {
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
        let to = |width: f64| format!(r#"{{"type":"steer","parameter":"width","value":{width}}}"#);
        onlooker.command(&mut run, &to(2.5)).unwrap();
        // Moved again while the wall is on its way: the slider stays where it is, the run comes there later.
        run.advance_at_most(10).unwrap();
        onlooker.command(&mut run, &to(2.4)).unwrap();
        assert_eq!(onlooker.aims(&run), [Some(2.4), None, run_rate(&run)]);
        let frame = head(&onlooker.frame(&run, true, Some(1.0)));
        assert_eq!(
            (&frame["playing"], &frame["aims"]["width"]),
            (&true.into(), &2.4.into())
        );
        while run.driven(peristalsis_configuration::ScheduledParameter::Width) != Some(2.4) {
            run.advance_at_most(1000).unwrap();
            onlooker.follow(&mut run).unwrap();
        }
        // Rows are told once.
        let rows = head(&onlooker.frame(&run, true, None))["rows"]
            .as_array()
            .unwrap()
            .len();
        assert_eq!(rows, run.recorder().samples().len());
        let again = head(&onlooker.frame(&run, true, None));
        assert!(again["rows"].as_array().unwrap().is_empty());
        for text in ["quit", &to(-1.0)] {
            assert!(onlooker.command(&mut run, text).is_err(), "{text}");
        }
    }

    fn run_rate(run: &Run) -> Option<f64> {
        run.driven(peristalsis_configuration::ScheduledParameter::StrainRate)
    }
}
