//! A trajectory that is played, with the configuration and samples of its run.

use std::path::{Path, PathBuf};

use peristalsis_configuration::Configuration;
use peristalsis_engine::Wall;
use peristalsis_formats::trajectory::Frame;
use peristalsis_formats::trajectory::gsd::GsdReader;
use peristalsis_observe::Sample;
use peristalsis_run::{Warning, walls, warnings};

use super::error::ViewerError;
use crate::frame::{Head, of_recording, of_wall};
use crate::timeline::{Row, Timeline, average, history};
use crate::welcome::{Recorded, Welcome};

/// Relative difference of the tube's length that rounding to 32 bits may cause.
const TOLERANCE: f64 = 1e-3;
/// Difference in periods that rounding may cause between a sample and the frame of the same step.
const SLACK: f64 = 1e-9;

/// A trajectory in GSD, with the configuration of its run and, if known, the time series.
#[derive(Debug)]
pub struct Recording {
    path: PathBuf,
    reader: GsdReader,
    configuration: Configuration,
    wall: Wall,
    samples: Vec<Sample>,
    rows: Vec<Row>,
    /// Time of each frame.
    times: Vec<f64>,
    grains: usize,
    warnings: Vec<Warning>,
}

impl Recording {
    /// Opens a trajectory of the run with this configuration. Without samples, J/Jmax is taken from the trajectory.
    ///
    /// # Errors
    /// [`ViewerError::Trajectory`] where it cannot be read; [`ViewerError::ForeignTrajectory`] where it is of another run.
    pub fn open(
        path: &Path,
        configuration: Configuration,
        samples: Vec<Sample>,
    ) -> Result<Self, ViewerError> {
        let mut reader = GsdReader::open(path)?;
        let first = reader.frame(0)?;
        let wall = walls(&configuration);
        let mut recording = Self {
            path: path.to_owned(),
            times: Vec::new(),
            grains: first.grains,
            rows: Vec::new(),
            warnings: warnings(&configuration),
            reader,
            configuration,
            wall,
            samples,
        };
        recording.check(&first)?;
        recording.read_times()?;
        recording.rows = recording.read_rows()?;
        Ok(recording)
    }

    /// The same with the warnings of the whole run, where its state is known; without them, those of its configuration.
    pub fn with_warnings(mut self, warnings: Vec<Warning>) -> Self {
        self.warnings = warnings;
        self
    }

    /// Number of frames.
    pub fn frames(&self) -> usize {
        self.times.len()
    }

    /// Number of frames lost where the file was cut short.
    pub fn lost_frames(&self) -> u64 {
        self.reader.lost_frames()
    }

    /// The first message to a page.
    pub(crate) fn welcome(&self, title: &str) -> Welcome {
        let timeline = Timeline(&self.configuration);
        let clocks = self.times.iter().map(|&time| timeline.clock(time));
        let mut welcome = Welcome::of(&self.configuration, &self.wall, self.grains, title);
        welcome.rows = history(self.rows.clone());
        welcome.recorded = Some(Recorded {
            clocks: clocks.collect(),
            lost_frames: self.lost_frames(),
        });
        welcome
    }

    /// The bytes of a message with a frame, counted from 0.
    ///
    /// # Errors
    /// [`ViewerError::Trajectory`] where there is no such frame or it cannot be read; [`ViewerError::ForeignTrajectory`]
    /// where it does not fit to the run.
    pub(crate) fn frame(&mut self, number: usize) -> Result<Vec<u8>, ViewerError> {
        let frame = self.reader.frame(number)?;
        self.check(&frame)?;
        let timeline = Timeline(&self.configuration);
        let clock = timeline.clock(frame.time);
        let (wall_spheres, rings) = of_wall(&self.wall);
        let slack = SLACK * timeline.unit_period();
        let run = &self.configuration.run;
        // In a very long run a kept sample covers several.
        let interval = match &*self.samples {
            [first, second, ..] => second.time - first.time,
            _ => run.steps_per_sample as f64 * run.time_step,
        } + slack;
        let is_taken = |sample: &Sample| sample.time <= frame.time + slack;
        let taken = self.samples.partition_point(is_taken);
        // What went on from a saved state has frames long after the last sample. Frames before the first one have none.
        let is_near = |sample: &&Sample| (frame.time - sample.time).abs() <= interval;
        let sample = self.samples[..taken].last().filter(is_near);
        let head = Head {
            number: Some(number),
            step: frame.step,
            time: frame.time,
            clock,
            period: frame.value("period").unwrap_or(clock),
            wave_speed: self.wall.wave_speed(frame.time),
            grains: frame.grains,
            wall_spheres,
            rings,
            turning: frame.rotation.is_some(),
            driven: timeline.driven(clock),
            aims: timeline.driven(clock),
            sample: sample.map(Into::into),
            warnings: self.warnings.clone(),
            ..Head::default()
        };
        let ends = self.configuration.tube.ends;
        Ok(of_recording(&head, &frame, &self.wall, ends))
    }

    /// Whether a frame is of this run.
    fn check(&self, frame: &Frame) -> Result<(), ViewerError> {
        let spheres = self.configuration.tube.wall_spheres() as usize;
        let (length, wall) = (self.wall.length(), frame.spheres() - frame.grains);
        let is_as_long = (frame.length - length).abs() <= TOLERANCE * length;
        if !is_as_long || wall != spheres || frame.grains != self.grains {
            return Err(self.foreign(format!(
                "its tube of {} d with {} grains and {wall} wall spheres is not that of the configuration, \
                 {length} d with {} grains and {spheres} wall spheres",
                frame.length,
                frame.grains,
                self.grains,
            )));
        }
        Ok(())
    }

    fn read_times(&mut self) -> Result<(), ViewerError> {
        for number in 0..self.reader.frames() {
            let time = self.reader.value(number, "time")?.unwrap_or(f64::NAN);
            let last = self.times.last().copied().unwrap_or(0.0);
            if !time.is_finite() || time < last {
                return Err(self.foreign(format!(
                    "frame {number} has the time {time} after {last}; times must not go back"
                )));
            }
            self.times.push(time);
        }
        Ok(())
    }

    /// Rows of the samples, then of later frames.
    fn read_rows(&mut self) -> Result<Vec<Row>, ViewerError> {
        let timeline = Timeline(&self.configuration);
        let samples = self.samples.iter().enumerate();
        let mut rows: Vec<Row> = samples
            .map(|(number, sample)| timeline.row_of(number, sample))
            .collect();
        let sampled = self.samples.last().map_or(-1.0, |sample| sample.time);
        for (frame, &time) in self.times.iter().enumerate() {
            if time > sampled + SLACK * timeline.unit_period() {
                let ratio = self.reader.value(frame, "flow_rate_ratio")?;
                rows.push(Row {
                    flow_rate_ratio: ratio.unwrap_or(f64::NAN),
                    ..timeline.row(rows.len(), time)
                });
            }
        }
        average(&mut rows);
        Ok(rows)
    }

    fn foreign(&self, reason: String) -> ViewerError {
        ViewerError::ForeignTrajectory {
            path: self.path.clone(),
            reason,
        }
    }
}
