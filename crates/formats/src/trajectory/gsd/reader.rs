//! GSD files read frame by frame, in any order.

use std::borrow::Cow;
use std::collections::HashMap;
use std::fs::File;
use std::path::{Path, PathBuf};

use super::container::{
    ENTRY_BYTES, Entry, HEADER_BYTES, MAGIC, NAME_UNIT, Number, kind_bytes, read, read_entries,
    read_names,
};
use super::{
    ANGULAR_VELOCITY, BOX, DIAMETER, GRAIN, IMAGE, LOG, MASS, NUMBER, ORIENTATION, POSITION, STEP,
    TIME, TYPE_NUMBERS, TYPES, VELOCITY, WALL,
};
use crate::error::FormatError;
use crate::trajectory::{Frame, Rotation};

/// Major version of the container that is read.
const MAJOR_VERSION: u16 = 2;
/// Most bytes of names: as many names as 16 bits can number.
const MOST_NAME_BYTES: u64 = 65_536 * NAME_UNIT;

/// A trajectory in GSD that this program wrote, or is writing.
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
        let about = file.metadata().map_err(FormatError::io("read", path))?;
        let length = about.len();
        let refused = |reason: String| unreadable(path, reason);
        let header = read(&mut file, path, 0, HEADER_BYTES.min(length))?;
        if header.len() < 8 || u64::at_start(&header) != MAGIC {
            return Err(refused("it does not begin like a GSD file".to_owned()));
        }
        let cut_short = || refused(format!("it is cut short after {length} bytes"));
        if header.len() < HEADER_BYTES as usize {
            return Err(cut_short());
        }
        let version = u16::from_le_bytes([header[46], header[47]]);
        if version != MAJOR_VERSION {
            let ours = format!("this program reads version {MAJOR_VERSION}");
            return Err(refused(format!(
                "it is of version {version} of GSD; {ours}"
            )));
        }
        let schema = &header[112..176];
        if !schema.starts_with(b"hoomd\0") {
            let name = before_zero(schema);
            return Err(refused(format!("its schema is `{name}`, not `hoomd`")));
        }
        let [index_at, capacity, names_at, name_units] =
            [8, 16, 24, 32].map(|at| u64::at_start(&header[at..]));
        let holds = |at: u64, number: u64, each: u64| {
            let end = number.checked_mul(each).and_then(|it| it.checked_add(at));
            end.is_some_and(|end| end <= length)
        };
        if !holds(index_at, capacity, ENTRY_BYTES) || !holds(names_at, name_units, NAME_UNIT) {
            return Err(cut_short());
        }
        let name_bytes = (name_units * NAME_UNIT).min(MOST_NAME_BYTES);
        let names = read_names(&mut file, path, names_at, name_bytes)?;
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
    pub fn frames(&self) -> usize {
        self.frames.len()
    }

    /// Frames that were begun and are not whole.
    pub fn lost_frames(&self) -> u64 {
        self.lost
    }

    /// A logged value of a frame, or its `time`, without the rest of the frame; `None` where the frame has no such value.
    ///
    /// # Errors
    /// As [`GsdReader::frame`].
    pub fn value(&mut self, frame: usize, name: &str) -> Result<Option<f64>, FormatError> {
        self.number(frame, &format!("{LOG}{name}"))
    }

    /// A frame, counted from 0.
    ///
    /// # Errors
    /// [`FormatError::Io`]; [`FormatError::UnreadableTrajectory`] where there is no such frame, its arrays do not fit
    /// together, or its particles are not grains and wall.
    pub fn frame(&mut self, frame: usize) -> Result<Frame, FormatError> {
        let held = self.frames();
        if frame >= held {
            let reason = format!("there is no frame {frame}, counted from 0: it holds {held}");
            return Err(self.refused(reason));
        }
        let step = self.number(frame, STEP)?.unwrap_or(0);
        let number = self.number::<u32>(frame, NUMBER)?.unwrap_or(0) as usize;
        let sides: Vec<[f32; 1]> = self.array(frame, BOX)?.unwrap_or_default();
        let [[width], _, [length], ..] = sides[..] else {
            return Err(self.refused(format!("frame {frame} has no box")));
        };
        let (width, length) = (f64::from(width), f64::from(length));
        let grains = self.grains(frame, number)?;
        let mut position: Vec<[f64; 3]> = self.reals(frame, POSITION, number)?;
        let turns: Option<Vec<[i32; 3]>> = self.rows(frame, IMAGE, number)?;
        let mut turns = match turns {
            Some(turns) => turns.into_iter().map(|[_, _, turns]| turns).collect(),
            None => vec![0; number],
        };
        for ([_, _, z], turns) in position.iter_mut().zip(&mut turns) {
            *z += 0.5 * length;
            // Rounding to 32 bits may lift a place next to the end of the tube beyond it.
            if *z >= length {
                (*z, *turns) = (*z - length, turns.saturating_add(1));
            }
        }
        let diameter: Vec<[f64; 1]> = self.reals(frame, DIAMETER, number)?;
        // Files of earlier versions have none, which means 1.
        let mass: Vec<[f64; 1]> = match self.entry(frame, MASS) {
            Some(_) => self.reals(frame, MASS, number)?,
            None => vec![[1.0]; number],
        };
        let rotation = match self.entry(frame, ORIENTATION) {
            None => None,
            Some(_) => Some(Rotation {
                orientation: self.reals(frame, ORIENTATION, number)?[..grains].to_vec(),
                angular_velocity: self.reals(frame, ANGULAR_VELOCITY, number)?[..grains].to_vec(),
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
            velocity: self.reals(frame, VELOCITY, number)?,
            diameter: diameter.into_iter().flatten().collect(),
            mass: mass.into_iter().flatten().collect(),
            rotation,
            contacts: Vec::new(),
            values: self.values(frame)?,
        })
    }

    /// Number of grains, which must come before the wall.
    fn grains(&mut self, frame: usize, number: usize) -> Result<usize, FormatError> {
        let types = self.types(frame)?;
        if types != [GRAIN, WALL] {
            let types = types.join(", ");
            let reason = format!("its types of particles are {types}, not {GRAIN} and {WALL}");
            return Err(self.refused(reason));
        }
        let numbers: Option<Vec<[u32; 1]>> = self.array(frame, TYPE_NUMBERS)?;
        let numbers = numbers.unwrap_or_default();
        let is_wall = |number: &[u32; 1]| *number != [0];
        if numbers.len() != number || !numbers.is_sorted_by_key(is_wall) {
            let reason = format!("frame {frame} does not have its grains first and then the wall");
            return Err(self.refused(reason));
        }
        Ok(numbers.partition_point(|number| !is_wall(number)))
    }

    fn types(&mut self, frame: usize) -> Result<Vec<String>, FormatError> {
        let Some(entry) = self.entry(frame, TYPES) else {
            return Ok(vec!["not named".to_owned()]);
        };
        let bytes = self.of_entry(&entry)?;
        let names = bytes.chunks(entry.columns.max(1) as usize);
        Ok(names.map(before_zero).collect())
    }

    /// The logged values, except for time and the values of particles.
    fn values(&mut self, frame: usize) -> Result<Vec<(Cow<'static, str>, f64)>, FormatError> {
        let names = self.names.iter().filter_map(|name| name.strip_prefix(LOG));
        let logged = names.filter(|name| *name != TIME && !name.contains('/'));
        let logged: Vec<String> = logged.map(str::to_owned).collect();
        let mut values = Vec::with_capacity(logged.len());
        for name in logged {
            if let Some(value) = self.value(frame, &name)? {
                values.push((name.into(), value));
            }
        }
        Ok(values)
    }

    /// An array of reals that has a row a particle.
    fn reals<const N: usize>(
        &mut self,
        frame: usize,
        name: &str,
        number: usize,
    ) -> Result<Vec<[f64; N]>, FormatError> {
        match self.rows(frame, name, number)? {
            Some(rows) => Ok(rows.into_iter().map(|row| row.map(f32::into)).collect()),
            None => Err(self.refused(format!("frame {frame} has no {name}"))),
        }
    }

    /// An array, if there is one, that must have a row a particle.
    fn rows<T: Number, const N: usize>(
        &mut self,
        frame: usize,
        name: &str,
        number: usize,
    ) -> Result<Option<Vec<[T; N]>>, FormatError> {
        match self.array(frame, name)? {
            Some(rows) if rows.len() != number => Err(self.refused(format!(
                "frame {frame} has {number} particles, and {} rows of {name}",
                rows.len()
            ))),
            rows => Ok(rows),
        }
    }

    /// The first number of an array, if there is one.
    fn number<T: Number>(&mut self, frame: usize, name: &str) -> Result<Option<T>, FormatError> {
        let numbers: Option<Vec<[T; 1]>> = self.array(frame, name)?;
        Ok(numbers.map(|numbers| numbers[0][0]))
    }

    /// An array row by row, if there is one; it must be of the type and so many columns, and not empty.
    fn array<T: Number, const N: usize>(
        &mut self,
        frame: usize,
        name: &str,
    ) -> Result<Option<Vec<[T; N]>>, FormatError> {
        let Some(entry) = self.entry(frame, name) else {
            return Ok(None);
        };
        if entry.kind != T::KIND || entry.columns != N as u32 || entry.rows == 0 {
            return Err(self.refused(format!(
                "{name} of frame {frame} is not of the type that the schema asks for"
            )));
        }
        let bytes = self.of_entry(&entry)?;
        let rows = bytes.chunks_exact(N * size_of::<T>());
        let number = |row: &[u8], column| T::at_start(&row[column * size_of::<T>()..]);
        let rows = rows.map(|row| std::array::from_fn(|column| number(row, column)));
        Ok(Some(rows.collect()))
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
        unreadable(&self.path, reason)
    }
}

fn unreadable(path: &Path, reason: String) -> FormatError {
    let path = path.to_owned();
    FormatError::UnreadableTrajectory { path, reason }
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
    let by_name = |frame: &&[Entry]| frame.iter().map(|entry| (entry.name, *entry)).collect();
    let whole = groups.iter().enumerate().take_while(is_whole);
    let whole: Vec<HashMap<u16, Entry>> = whole.map(|(_, frame)| by_name(frame)).collect();
    let lost = (groups.len() - whole.len()) as u64;
    (whole, lost)
}

/// Text up to its first zero byte.
fn before_zero(text: &[u8]) -> String {
    let letters = text.split(|&byte| byte == 0).next().unwrap_or_default();
    letters.escape_ascii().to_string()
}
