//! Frames as the text that LAMMPS dumps: lengths in d, times in t.
//!
//! A frame begins with its step; the time, which is the step times `run.time_step`, and the units are not said, for some
//! readers (MDAnalysis) take no frame that says more.
//!
//! Types are 1 for grains and 2 for the wall. Numbers are the shortest that read back to the same 64 bits. See
//! <https://docs.lammps.org/dump.html>.

use std::fmt::Write as _;
use std::io::{self, BufRead, BufReader, ErrorKind, Seek, SeekFrom};
use std::path::Path;

use super::append::Growing;
use super::{Frame, TrajectoryFile};
use crate::error::FormatError;

/// Name of the file in a run's folder.
pub(super) const FILE: &str = "trajectory.lammpstrj";

const BEGINNING: &str = "ITEM: TIMESTEP\n";

/// A trajectory as LAMMPS text that is being written.
#[derive(Debug)]
pub(super) struct LammpsTrajectory {
    file: Growing,
    frames: u64,
}

impl LammpsTrajectory {
    /// An empty trajectory.
    pub(super) fn create(path: &Path) -> Result<Self, FormatError> {
        Ok(Self {
            file: Growing::create(path)?,
            frames: 0,
        })
    }

    /// A trajectory to go on with, without its frames after `step`.
    pub(super) fn resume(path: &Path, step: u64) -> Result<Self, FormatError> {
        let mut file = Growing::open(path)?;
        let failed = |source| FormatError::io("read", path)(source);
        let inner = file.file();
        inner.seek(SeekFrom::Start(0)).map_err(failed)?;
        let mut reader = BufReader::new(inner);
        let (mut frames, mut end) = (0, 0);
        loop {
            match next_frame(&mut reader) {
                Ok((found, bytes)) if found <= step => (frames, end) = (frames + 1, end + bytes),
                Err(error) if error.kind() != ErrorKind::InvalidData => return Err(failed(error)),
                _ => break,
            }
        }
        drop(reader);
        if frames == 0 && file.end() > 0 && !begins_as_ours(&mut file).map_err(failed)? {
            let reason = "it does not begin like a LAMMPS dump";
            return Err(FormatError::not_a_trajectory(path, reason));
        }
        file.set_end(end)?;
        Ok(Self { file, frames })
    }
}

impl TrajectoryFile for LammpsTrajectory {
    fn append(&mut self, frame: &Frame) -> Result<(), FormatError> {
        let text = encode(frame);
        self.file.append(text.as_bytes())?;
        self.frames += 1;
        Ok(())
    }

    fn synchronize(&mut self) -> Result<(), FormatError> {
        self.file.synchronize()
    }

    fn frames(&self) -> u64 {
        self.frames
    }

    fn bytes(&self) -> u64 {
        self.file.end()
    }
}

/// One frame.
pub(super) fn encode(frame: &Frame) -> String {
    let mut text = String::with_capacity(160 * frame.spheres() + 300);
    let mut line = |values: std::fmt::Arguments<'_>| {
        text.write_fmt(values)
            .expect("writing to a String cannot fail");
    };
    let half = 0.5 * frame.width;
    line(format_args!(
        "{BEGINNING}{}\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS ff ff pp\n",
        frame.step,
        frame.spheres()
    ));
    line(format_args!(
        "{:?} {half:?}\n{:?} {half:?}\n0.0 {:?}\nITEM: ATOMS id type diameter x y z vx vy vz",
        -half, -half, frame.length
    ));
    if frame.rotation.is_some() {
        line(format_args!(" omegax omegay omegaz"));
    }
    line(format_args!("\n"));
    for sphere in 0..frame.spheres() {
        let [x, y, z] = frame.position[sphere];
        let [vx, vy, vz] = frame.velocity[sphere];
        line(format_args!(
            "{} {} {:?} {x:?} {y:?} {z:?} {vx:?} {vy:?} {vz:?}",
            sphere + 1,
            1 + u8::from(sphere >= frame.grains),
            frame.diameter[sphere],
        ));
        if let Some(rotation) = &frame.rotation {
            let still = [0.0; 3];
            let [x, y, z] = rotation.angular_velocity.get(sphere).unwrap_or(&still);
            line(format_args!(" {x:?} {y:?} {z:?}"));
        }
        line(format_args!("\n"));
    }
    text
}

/// Step and bytes of the next frame. A frame that is not whole is an error of kind `InvalidData`.
fn next_frame(reader: &mut impl BufRead) -> io::Result<(u64, u64)> {
    let mut lines = Lines {
        reader,
        line: String::new(),
        bytes: 0,
    };
    lines.expect(BEGINNING.trim_end())?;
    let step = lines.number()?;
    lines.expect("ITEM: NUMBER OF ATOMS")?;
    let spheres = lines.number()?;
    // Box and names of the columns, then the spheres.
    for _ in 0..spheres.saturating_add(5) {
        lines.advance()?;
    }
    Ok((step, lines.bytes))
}

/// Whether a file begins like one of ours, as far as it goes.
fn begins_as_ours(file: &mut Growing) -> io::Result<bool> {
    let inner = file.file();
    inner.seek(SeekFrom::Start(0))?;
    let mut first = String::new();
    BufReader::new(inner).read_line(&mut first)?;
    Ok(BEGINNING.starts_with(first.as_str()))
}

/// Whole lines of a file.
struct Lines<'a, R> {
    reader: &'a mut R,
    line: String,
    bytes: u64,
}

impl<R: BufRead> Lines<'_, R> {
    /// Goes on to the next one; a page that was lost in a power cut is no text and so no line.
    fn advance(&mut self) -> io::Result<&str> {
        self.line.clear();
        self.bytes += self.reader.read_line(&mut self.line)? as u64;
        match self.line.ends_with('\n') {
            true => Ok(self.line.trim_end()),
            false => Err(ErrorKind::InvalidData.into()),
        }
    }

    fn expect(&mut self, text: &str) -> io::Result<()> {
        match self.advance()? == text {
            true => Ok(()),
            false => Err(ErrorKind::InvalidData.into()),
        }
    }

    fn number(&mut self) -> io::Result<u64> {
        self.advance()?
            .parse()
            .map_err(|_| ErrorKind::InvalidData.into())
    }
}
