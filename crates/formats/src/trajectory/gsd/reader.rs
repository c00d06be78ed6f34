//! GSD files read frame by frame, in any order.

use std::collections::HashMap;
use std::fs::File;
use std::path::{Path, PathBuf};

use super::container::{
    ENTRY_BYTES, Entry, HEADER_BYTES, Kind, MAGIC, NAME_UNIT, kind_bytes, read, read_entries,
    u64_at,
};
use super::{
    ANGULAR_VELOCITY, BOX, DIAMETER, GRAIN, IMAGE, LOG, NUMBER, ORIENTATION, POSITION, STEP, TIME,
    TYPE_NUMBERS, TYPES, VELOCITY, WALL,
};
use crate::error::FormatError;
use crate::trajectory::{Frame, Rotation};

/// Major version of the container that is read.
const MAJOR_VERSION: u16 = 2;
/// Most bytes of names: as many names as 16 bits can number.
const MOST_NAME_BYTES: u64 = 65_536 * NAME_UNIT;

/// A trajectory in GSD that [`GsdTrajectory`](super::GsdTrajectory) wrote, or is writing.
///
/// What a kill or a full disk left is read up to the last whole frame; [`GsdReader::lost_frames`] says how many more were
/// begun. Single precision in the file: positions are right to some 1e-6 of the tube's length.
#[derive(Debug)]
pub struct GsdReader {
    file: File,
    path: PathBuf,
    names: Vec<String>,
    /// The arrays of each whole frame by the number of their name.
    frames: Vec<HashMap<u16, Entry>>,
    lost: u64,
}

impl GsdReader {
    /// Opens a file and reads its index.
    ///
    /// # Errors
    /// [`FormatError::Io`]; [`FormatError::UnreadableTrajectory`] where it is no GSD file, one of another schema or version,
    /// or without a whole frame.
    pub fn open(path: &Path) -> Result<Self, FormatError> {
        let mut file = File::open(path).map_err(FormatError::io("open", path))?;
        let length = file
            .metadata()
            .map_err(FormatError::io("read", path))?
            .len();
        let refused = |reason: String| FormatError::UnreadableTrajectory {
            path: path.to_owned(),
            reason,
        };
        let header = read(&mut file, path, 0, HEADER_BYTES.min(length))?;
        if header.len() < 8 || u64_at(&header, 0) != MAGIC {
            return Err(refused("it does not begin like a GSD file".to_owned()));
        }
        let cut_short = || refused(format!("it is cut short after {length} bytes"));
        if header.len() < HEADER_BYTES as usize {
            return Err(cut_short());
        }
        let version = u16::from_le_bytes([header[46], header[47]]);
        if version != MAJOR_VERSION {
            return Err(refused(format!(
                "it is of version {version} of GSD; this program reads version {MAJOR_VERSION}"
            )));
        }
        let schema = &header[112..176];
        if !schema.starts_with(b"hoomd\0") {
            let name = schema.split(|&byte| byte == 0).next().unwrap_or_default();
            return Err(refused(format!(
                "its schema is `{}`, not `hoomd`",
                name.escape_ascii()
            )));
        }
        let (index_at, capacity) = (u64_at(&header, 8), u64_at(&header, 16));
        let (names_at, name_units) = (u64_at(&header, 24), u64_at(&header, 32));
        let holds = |at: u64, number: u64, each: u64| {
            let end = number.checked_mul(each).and_then(|it| it.checked_add(at));
            end.is_some_and(|end| end <= length)
        };
        if !holds(index_at, capacity, ENTRY_BYTES) || !holds(names_at, name_units, NAME_UNIT) {
            return Err(cut_short());
        }
        let name_bytes = (name_units * NAME_UNIT).min(MOST_NAME_BYTES);
        let names = read(&mut file, path, names_at, name_bytes)?
            .split(|&byte| byte == 0)
            .take_while(|name| !name.is_empty())
            .map(|name| String::from_utf8_lossy(name).into_owned())
            .collect();
        let entries = read_entries(&mut file, path, index_at, capacity)?;
        let (frames, lost) = whole_frames(&entries, length);
        if frames.is_empty() {
            return Err(match lost {
                0 => refused("it holds no frame".to_owned()),
                _ => cut_short(),
            });
        }
        Ok(Self {
            file,
            path: path.to_owned(),
            names,
            frames,
            lost,
        })
    }

    /// Whole frames.
    #[must_use]
    pub fn frames(&self) -> usize {
        self.frames.len()
    }

    /// Frames that were begun and are not whole.
    #[must_use]
    pub fn lost_frames(&self) -> u64 {
        self.lost
    }

    /// A logged value of a frame, `time` included, without the rest of the frame; `None` where there is none of that name.
    ///
    /// # Errors
    /// As [`GsdReader::frame`].
    pub fn value(&mut self, frame: usize, name: &str) -> Result<Option<f64>, FormatError> {
        let values: Option<Vec<[f64; 1]>> =
            self.array(frame, &format!("{LOG}{name}"), Kind::F64)?;
        Ok(values.and_then(|values| values.first().map(|[value]| *value)))
    }

    /// A frame, counted from 0.
    ///
    /// # Errors
    /// [`FormatError::Io`]; [`FormatError::UnreadableTrajectory`] where there is no such frame, its arrays do not fit
    /// together, or its particles are not grains and wall.
    pub fn frame(&mut self, frame: usize) -> Result<Frame, FormatError> {
        if frame >= self.frames.len() {
            return Err(self.refused(format!(
                "there is no frame {frame}, counted from 0: it holds {}",
                self.frames.len()
            )));
        }
        let step = self.bytes(frame, STEP, Kind::U64, 1)?;
        let step = step.map_or(0, |bytes| u64_at(&bytes, 0));
        let number = match self.bytes(frame, NUMBER, Kind::U32, 1)? {
            Some(bytes) => u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]) as usize,
            None => 0,
        };
        let sides: Vec<[f64; 1]> = self.array(frame, BOX, Kind::F32)?.unwrap_or_default();
        let [[width], _, [length], ..] = sides[..] else {
            return Err(self.refused(format!("frame {frame} has no box")));
        };
        let grains = self.grains(frame, number)?;
        let mut position: Vec<[f64; 3]> = self.rows(frame, POSITION, number)?;
        let mut turns: Vec<i32> = self.turns(frame, number)?;
        for ([_, _, z], turns) in position.iter_mut().zip(&mut turns) {
            *z += 0.5 * length;
            // Rounding to 32 bits may lift a place next to the end of the tube beyond it.
            if *z >= length {
                (*z, *turns) = (*z - length, turns.saturating_add(1));
            }
        }
        let diameter: Vec<[f64; 1]> = self.rows(frame, DIAMETER, number)?;
        let rotation = match self.array(frame, ORIENTATION, Kind::F32)? {
            None => None,
            Some(orientation) => Some(Rotation {
                orientation: self.fitting(frame, ORIENTATION, orientation, number)?[..grains]
                    .to_vec(),
                angular_velocity: self.rows(frame, ANGULAR_VELOCITY, number)?[..grains].to_vec(),
            }),
        };
        Ok(Frame {
            step,
            time: self.value(frame, TIME)?.unwrap_or(f64::NAN),
            length,
            width,
            grains,
            position,
            turns,
            velocity: self.rows(frame, VELOCITY, number)?,
            diameter: diameter.into_iter().flatten().collect(),
            rotation,
            contacts: Vec::new(),
            values: self.values(frame)?,
        })
    }

    /// Number of grains, which must come before the wall.
    fn grains(&mut self, frame: usize, number: usize) -> Result<usize, FormatError> {
        let types = self.types(frame)?;
        if types != [GRAIN, WALL] {
            return Err(self.refused(format!(
                "its types of particles are {}, not {GRAIN} and {WALL}",
                types.join(", ")
            )));
        }
        let numbers = self.bytes(frame, TYPE_NUMBERS, Kind::U32, 1)?;
        let numbers = numbers.unwrap_or_default();
        let is_wall = |four: &[u8]| four != [0; 4];
        if numbers.len() != 4 * number || !numbers.chunks_exact(4).is_sorted_by_key(is_wall) {
            return Err(self.refused(format!(
                "frame {frame} does not have its grains first and then the wall"
            )));
        }
        Ok(numbers
            .chunks_exact(4)
            .filter(|four| !is_wall(four))
            .count())
    }

    fn types(&mut self, frame: usize) -> Result<Vec<String>, FormatError> {
        let Some(entry) = self.entry(frame, TYPES) else {
            return Ok(vec!["not named".to_owned()]);
        };
        let bytes = self.of_entry(&entry)?;
        let names = bytes.chunks(entry.columns.max(1) as usize).map(|name| {
            let letters = name.split(|&byte| byte == 0).next().unwrap_or_default();
            letters.escape_ascii().to_string()
        });
        Ok(names.collect())
    }

    fn turns(&mut self, frame: usize, number: usize) -> Result<Vec<i32>, FormatError> {
        let Some(bytes) = self.bytes(frame, IMAGE, Kind::I32, 3)? else {
            return Ok(vec![0; number]);
        };
        let turns = bytes
            .chunks_exact(12)
            .map(|row| i32::from_le_bytes([row[8], row[9], row[10], row[11]]))
            .collect();
        self.fitting(frame, IMAGE, turns, number)
    }

    /// What was logged but time and what belongs to the particles.
    fn values(
        &mut self,
        frame: usize,
    ) -> Result<Vec<(std::borrow::Cow<'static, str>, f64)>, FormatError> {
        let logged: Vec<String> = self
            .names
            .iter()
            .filter_map(|name| name.strip_prefix(LOG))
            .filter(|name| *name != TIME && !name.contains('/'))
            .map(str::to_owned)
            .collect();
        let mut values = Vec::with_capacity(logged.len());
        for name in logged {
            if let Some(value) = self.value(frame, &name)? {
                values.push((name.into(), value));
            }
        }
        Ok(values)
    }

    /// An array of reals that has a row a particle.
    fn rows<const N: usize>(
        &mut self,
        frame: usize,
        name: &str,
        number: usize,
    ) -> Result<Vec<[f64; N]>, FormatError> {
        match self.array(frame, name, Kind::F32)? {
            Some(rows) => self.fitting(frame, name, rows, number),
            None => Err(self.refused(format!("frame {frame} has no {name}"))),
        }
    }

    fn fitting<T>(
        &self,
        frame: usize,
        name: &str,
        rows: Vec<T>,
        number: usize,
    ) -> Result<Vec<T>, FormatError> {
        if rows.len() == number {
            return Ok(rows);
        }
        Err(self.refused(format!(
            "frame {frame} has {number} particles, and {} rows of {name}",
            rows.len()
        )))
    }

    /// An array of reals, row by row.
    fn array<const N: usize>(
        &mut self,
        frame: usize,
        name: &str,
        kind: Kind,
    ) -> Result<Option<Vec<[f64; N]>>, FormatError> {
        let Some(bytes) = self.bytes(frame, name, kind, N as u32)? else {
            return Ok(None);
        };
        let mut reals = match kind {
            Kind::F64 => bytes
                .chunks_exact(8)
                .map(|eight| f64::from_bits(u64_at(eight, 0)))
                .collect::<Vec<_>>(),
            _ => bytes
                .chunks_exact(4)
                .map(|four| f64::from(f32::from_le_bytes([four[0], four[1], four[2], four[3]])))
                .collect(),
        }
        .into_iter();
        let rows = reals.len() / N;
        Ok(Some(
            (0..rows)
                .map(|_| std::array::from_fn(|_| reals.next().unwrap_or(f64::NAN)))
                .collect(),
        ))
    }

    /// The bytes of an array, which must be of a type and so many columns; not empty.
    fn bytes(
        &mut self,
        frame: usize,
        name: &str,
        kind: Kind,
        columns: u32,
    ) -> Result<Option<Vec<u8>>, FormatError> {
        let Some(entry) = self.entry(frame, name) else {
            return Ok(None);
        };
        if entry.kind != kind as u8 || entry.columns != columns || entry.rows == 0 {
            return Err(self.refused(format!(
                "{name} of frame {frame} is not of the type that the schema asks for"
            )));
        }
        self.of_entry(&entry).map(Some)
    }

    /// Where an array of a frame is; what a frame lacks is as in the first.
    fn entry(&self, frame: usize, name: &str) -> Option<Entry> {
        let number = self.names.iter().position(|known| known == name)? as u16;
        let own = self.frames.get(frame)?.get(&number);
        own.or_else(|| self.frames[0].get(&number)).copied()
    }

    fn of_entry(&mut self, entry: &Entry) -> Result<Vec<u8>, FormatError> {
        // No overflow: the frame is whole, so this is within the file.
        let bytes = entry.rows * u64::from(entry.columns) * kind_bytes(entry.kind);
        read(&mut self.file, &self.path, entry.location, bytes)
    }

    fn refused(&self, reason: String) -> FormatError {
        FormatError::UnreadableTrajectory {
            path: self.path.clone(),
            reason,
        }
    }
}

/// The frames whose arrays are all in the file, and the number of those begun after them.
fn whole_frames(entries: &[Entry], length: u64) -> (Vec<HashMap<u16, Entry>>, u64) {
    let within = |entry: &Entry| entry.end().is_some_and(|end| end <= length);
    let groups: Vec<&[Entry]> = entries
        .chunk_by(|one, other| one.frame == other.frame)
        .collect();
    let is_whole = |&(number, frame): &(usize, &&[Entry])| {
        // Where entries stop in the middle of a frame it has fewer than the one before; the first has more than all.
        let entries_before = match number {
            0 | 1 => 0,
            _ => groups[number - 1].len(),
        };
        frame.iter().all(within) && frame.len() >= entries_before
    };
    let whole: Vec<HashMap<u16, Entry>> = groups
        .iter()
        .enumerate()
        .take_while(is_whole)
        .map(|(_, frame)| frame.iter().map(|entry| (entry.name, *entry)).collect())
        .collect();
    let lost = (groups.len() - whole.len()) as u64;
    (whole, lost)
}
