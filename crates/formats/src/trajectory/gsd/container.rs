//! The container of GSD: named arrays, frame by frame.
//!
//! Layout of version 2.1 (<https://gsd.readthedocs.io/en/stable/file-layer.html>), all numbers little-endian:
//!
//! | part | bytes | content |
//! |---|---|---|
//! | header | 256 | where index and names are, schema, application |
//! | index | 32 an entry | frame, rows, place, columns, name, type of each array, in order of frame and name |
//! | names | 1024 | names of the arrays, each ended by a zero byte |
//! | arrays | | |
//!
//! The index has room for the planned trajectory from the start, so that a trajectory that was cut back and goes on has the
//! same bytes as one in one go. Only one that becomes longer than planned moves its index to its end.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::Path;

use super::super::append::Growing;
use crate::atomic;
use crate::error::FormatError;

pub(super) const MAGIC: u64 = 0x65df_65df_65df_65df;
const FORMAT_VERSION: u32 = (2 << 16) | 1;
const APPLICATION: &str = concat!("peristalsis ", env!("CARGO_PKG_VERSION"));
const SCHEMA: &str = "hoomd";
const SCHEMA_VERSION: u32 = (1 << 16) | 4;
pub(super) const HEADER_BYTES: u64 = 256;
/// Bytes of an index entry.
pub(super) const ENTRY_BYTES: u64 = 32;
/// Names are allocated in units of so many bytes.
pub(super) const NAME_UNIT: u64 = 64;
/// Index entries that are read at once.
const ENTRIES_A_READ: u64 = 4096;
const NAMES_BYTES: u64 = 16 * NAME_UNIT;

/// A number as it stands in a file.
pub(super) trait Number: Copy {
    /// Number of its type.
    const KIND: u8;

    /// The number that the bytes begin with.
    fn at_start(bytes: &[u8]) -> Self;

    fn to_bytes(self) -> impl Iterator<Item = u8>;
}

macro_rules! numbers {
    ($($number:ty: $kind:literal),*) => {
        $(impl Number for $number {
            const KIND: u8 = $kind;

            fn at_start(bytes: &[u8]) -> Self {
                let mut own = [0; size_of::<Self>()];
                own.copy_from_slice(&bytes[..size_of::<Self>()]);
                Self::from_le_bytes(own)
            }

            fn to_bytes(self) -> impl Iterator<Item = u8> {
                self.to_le_bytes().into_iter()
            }
        })*

        /// Bytes of a number of a type; 0 for a type that is never written.
        pub(super) fn kind_bytes(kind: u8) -> u64 {
            match kind {
                $($kind => size_of::<$number>() as u64,)*
                _ => 0,
            }
        }
    };
}

numbers!(u32: 3, u64: 4, i8: 5, i32: 7, f32: 9, f64: 10);

/// A named array of a frame, row by row.
#[derive(Clone, Debug)]
pub(super) struct Chunk {
    name: String,
    kind: u8,
    columns: u32,
    pub(super) bytes: Vec<u8>,
}

impl Chunk {
    pub(super) fn new<T: Number, const N: usize>(
        name: &str,
        rows: impl IntoIterator<Item = [T; N]>,
    ) -> Self {
        Self {
            name: name.to_owned(),
            kind: T::KIND,
            columns: N as u32,
            bytes: rows.into_iter().flatten().flat_map(T::to_bytes).collect(),
        }
    }
}

/// Where an array is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry {
    pub(super) frame: u64,
    pub(super) rows: u64,
    pub(super) location: u64,
    pub(super) columns: u32,
    pub(super) name: u16,
    pub(super) kind: u8,
}

impl Entry {
    fn encode(&self) -> [u8; ENTRY_BYTES as usize] {
        let mut bytes = [0; ENTRY_BYTES as usize];
        bytes[0..8].copy_from_slice(&self.frame.to_le_bytes());
        bytes[8..16].copy_from_slice(&self.rows.to_le_bytes());
        bytes[16..24].copy_from_slice(&self.location.to_le_bytes());
        bytes[24..28].copy_from_slice(&self.columns.to_le_bytes());
        bytes[28..30].copy_from_slice(&self.name.to_le_bytes());
        bytes[30] = self.kind;
        bytes
    }

    fn decode(bytes: &[u8]) -> Self {
        Self {
            frame: u64::at_start(bytes),
            rows: u64::at_start(&bytes[8..]),
            location: u64::at_start(&bytes[16..]),
            columns: u32::at_start(&bytes[24..]),
            name: u16::from_le_bytes([bytes[28], bytes[29]]),
            kind: bytes[30],
        }
    }

    /// Where the array ends in the file; `None` where no number of bytes is so large.
    pub(super) fn end(&self) -> Option<u64> {
        self.rows
            .checked_mul(u64::from(self.columns))
            .and_then(|numbers| numbers.checked_mul(kind_bytes(self.kind).max(1)))
            .and_then(|bytes| bytes.checked_add(self.location))
    }
}

/// A GSD file that is being written.
#[derive(Debug)]
pub(in crate::trajectory) struct Container {
    pub(super) file: Growing,
    /// Where the index begins.
    index_at: u64,
    /// Entries that the index has room for.
    capacity: u64,
    /// Where the names begin.
    names_at: u64,
    /// Entries in it.
    entries: u64,
    names: Vec<String>,
    pub(super) frames: u64,
}

impl Container {
    /// An empty file with room for so many arrays.
    pub(super) fn create(path: &Path, capacity: u64) -> Result<Self, FormatError> {
        let mut file = Growing::create(path)?;
        let capacity = capacity.max(1);
        file.append(&header(capacity))?;
        file.set_end(first_array(capacity))?;
        Ok(Self {
            file,
            index_at: HEADER_BYTES,
            capacity,
            names_at: first_array(capacity) - NAMES_BYTES,
            entries: 0,
            names: Vec::new(),
            frames: 0,
        })
    }

    /// Gives a file that [`Container::create`] made room for so many arrays, as if it had been made so.
    pub(super) fn make_room(path: &Path, capacity: u64) -> Result<(), FormatError> {
        let mut file = Growing::open(path)?;
        let before = capacity_of(&mut file)?;
        let after = capacity.max(1);
        let entries = read_entries(file.file(), path, HEADER_BYTES, before)?;
        if before == after || entries.len() as u64 > after {
            return Ok(());
        }
        let (from, to) = (first_array(before), first_array(after));
        let moved = |entry: &Entry| Entry {
            location: entry.location.wrapping_sub(from).wrapping_add(to),
            ..*entry
        };
        let index: Vec<u8> = entries
            .iter()
            .map(moved)
            .flat_map(|it| it.encode())
            .collect();
        atomic::write_with(path, |new| {
            new.write_all(&header(after))?;
            new.write_all(&index)?;
            new.seek(SeekFrom::Start(to - NAMES_BYTES))?;
            file.file().seek(SeekFrom::Start(from - NAMES_BYTES))?;
            std::io::copy(file.file(), new).map(drop)
        })
    }

    /// A file that [`Container::create`] made, cut back to the frames that `keep` wants, by the first number of the array
    /// `name` in each; frames after the first unwanted one go.
    pub(super) fn resume(
        path: &Path,
        name: &str,
        keep: impl Fn(u64) -> bool,
    ) -> Result<Self, FormatError> {
        let mut file = Growing::open(path)?;
        let damaged = |reason: &str| FormatError::not_a_trajectory(path, reason);
        let capacity = capacity_of(&mut file)?;
        let (first_array, length) = (first_array(capacity), file.end());
        let names = read_names(file.file(), path, first_array - NAMES_BYTES, NAMES_BYTES)?;
        let wanted = names.iter().position(|known| known == name);

        let written = read_entries(file.file(), path, HEADER_BYTES, capacity)?;
        let (mut entries, mut frames, mut end) = (0, 0, first_array);
        let begun: Vec<&[Entry]> = written
            .chunk_by(|one, other| one.frame == other.frame)
            .collect();
        // The end of a frame whose arrays all lie inside the file; a frame that a kill cut short has none.
        let end_of = |frame: &[Entry]| {
            let end = |entry: &Entry| {
                let is_ours = entry.location >= first_array && kind_bytes(entry.kind) > 0;
                entry.end().filter(|&end| is_ours && end <= length)
            };
            let mut ends = frame.iter().map(end);
            ends.try_fold(0, |last, end| Some(end?.max(last)))
        };
        for (number, frame) in begun.iter().enumerate() {
            let marker = frame
                .iter()
                .find(|entry| Some(usize::from(entry.name)) == wanted)
                .filter(|entry| entry.rows > 0 && kind_bytes(entry.kind) == 8);
            let (Some(marker), Some(frame_end)) = (marker, end_of(frame)) else {
                // What was cut short is the end; before whole frames it is damage, and they are not to be thrown away.
                let mut later = begun[number + 1..].iter();
                if later.any(|frame| end_of(frame).is_some()) {
                    return Err(damaged(&format!("frame {number} of it is damaged")));
                }
                break;
            };
            if !keep(u64::at_start(&read(file.file(), path, marker.location, 8)?)) {
                break;
            }
            (entries, frames, end) = (entries + frame.len() as u64, frames + 1, frame_end);
        }
        // First what finds the frames, then what they hold.
        let forgotten = vec![0; (written.len() as u64 - entries) as usize * ENTRY_BYTES as usize];
        file.write_at(HEADER_BYTES + entries * ENTRY_BYTES, &forgotten)?;
        file.set_end(end)?;
        Ok(Self {
            file,
            index_at: HEADER_BYTES,
            capacity,
            names_at: first_array - NAMES_BYTES,
            entries,
            names,
            frames,
        })
    }

    /// Writes the arrays of one frame more: arrays, names, and last the entries by which they are found.
    pub(super) fn append_arrays(&mut self, chunks: &[Chunk]) -> Result<(), FormatError> {
        if self.entries + chunks.len() as u64 > self.capacity {
            self.move_index(chunks.len() as u64)?;
        }
        let mut names = self.names.clone();
        let mut data = Vec::with_capacity(chunks.iter().map(|chunk| chunk.bytes.len()).sum());
        let mut entries = Vec::with_capacity(chunks.len());
        for chunk in chunks {
            let known = names.iter().position(|name| *name == chunk.name);
            let name = known.unwrap_or_else(|| {
                names.push(chunk.name.clone());
                names.len() - 1
            });
            entries.push(Entry {
                frame: self.frames,
                rows: chunk.bytes.len() as u64 / kind_bytes(chunk.kind) / u64::from(chunk.columns),
                location: self.file.end() + data.len() as u64,
                columns: chunk.columns,
                name: name as u16,
                kind: chunk.kind,
            });
            data.extend_from_slice(&chunk.bytes);
        }
        entries.sort_unstable_by_key(|entry| entry.name);
        let before = self.file.end();
        self.file.append(&data)?;
        let named = self.write_names(&names);
        let found = named.and_then(|()| self.write_entries(&entries));
        if let Err(error) = found {
            // Back to the frames before; where that fails too, the failure that came first is what counts.
            let blank = vec![0; entries.len() * ENTRY_BYTES as usize];
            drop(self.file.write_at(self.next_entry(), &blank));
            drop(self.file.set_end(before));
            return Err(error);
        }
        self.names = names;
        self.entries += entries.len() as u64;
        self.frames += 1;
        Ok(())
    }

    fn write_names(&mut self, names: &[String]) -> Result<(), FormatError> {
        if names.len() == self.names.len() {
            return Ok(());
        }
        let text = names.iter().flat_map(|name| name.bytes().chain([0]));
        let text = text.collect::<Vec<_>>();
        // Ours fit; a damaged file's need not.
        if text.len() as u64 >= NAMES_BYTES {
            let reason = "its list of names is damaged";
            return Err(FormatError::not_a_trajectory(self.file.path(), reason));
        }
        self.file.write_at(self.names_at, &text)
    }

    fn write_entries(&mut self, entries: &[Entry]) -> Result<(), FormatError> {
        let bytes = entries.iter().flat_map(Entry::encode).collect::<Vec<_>>();
        self.file.write_at(self.next_entry(), &bytes)
    }

    fn next_entry(&self) -> u64 {
        self.index_at + self.entries * ENTRY_BYTES
    }

    /// Moves the index to the end of the file, twice as long and with room for `more` arrays; the old one counts until the
    /// new one is there.
    fn move_index(&mut self, more: u64) -> Result<(), FormatError> {
        let path = self.file.path().to_owned();
        let bytes = self.entries * ENTRY_BYTES;
        let index = read(self.file.file(), &path, self.index_at, bytes)?;
        let (index_at, capacity) = (self.file.end(), 2 * self.capacity + more);
        self.file.append(&index)?;
        self.file.set_end(index_at + capacity * ENTRY_BYTES)?;
        let place = [index_at.to_le_bytes(), capacity.to_le_bytes()].concat();
        self.file.write_at(8, &place)?;
        (self.index_at, self.capacity) = (index_at, capacity);
        Ok(())
    }
}

/// Where the first array begins in a file with room for so many.
fn first_array(capacity: u64) -> u64 {
    HEADER_BYTES + capacity * ENTRY_BYTES + NAMES_BYTES
}

/// The header of a file with room for so many arrays.
fn header(capacity: u64) -> [u8; HEADER_BYTES as usize] {
    let names_at = first_array(capacity) - NAMES_BYTES;
    let mut header = [0; HEADER_BYTES as usize];
    header[0..8].copy_from_slice(&MAGIC.to_le_bytes());
    header[8..16].copy_from_slice(&HEADER_BYTES.to_le_bytes());
    header[16..24].copy_from_slice(&capacity.to_le_bytes());
    header[24..32].copy_from_slice(&names_at.to_le_bytes());
    header[32..40].copy_from_slice(&(NAMES_BYTES / NAME_UNIT).to_le_bytes());
    header[40..44].copy_from_slice(&SCHEMA_VERSION.to_le_bytes());
    header[44..48].copy_from_slice(&FORMAT_VERSION.to_le_bytes());
    header[48..48 + APPLICATION.len()].copy_from_slice(APPLICATION.as_bytes());
    header[112..112 + SCHEMA.len()].copy_from_slice(SCHEMA.as_bytes());
    header
}

/// How many arrays a file of ours has room for.
fn capacity_of(file: &mut Growing) -> Result<u64, FormatError> {
    let (length, path) = (file.end(), file.path().to_owned());
    let damaged = |reason: &str| FormatError::not_a_trajectory(&path, reason);
    let header = read(file.file(), &path, 0, HEADER_BYTES.min(length))?;
    if header.len() < HEADER_BYTES as usize || u64::at_start(&header) != MAGIC {
        return Err(damaged("it does not begin like a GSD file"));
    }
    let [index_at, capacity, names_at] = [8, 16, 24].map(|at| u64::at_start(&header[at..]));
    let end = capacity
        .checked_mul(ENTRY_BYTES)
        .and_then(|bytes| bytes.checked_add(HEADER_BYTES + NAMES_BYTES));
    let is_ours = index_at == HEADER_BYTES
        && header[48..].starts_with(b"peristalsis ")
        && end.is_some_and(|end| end <= length && names_at == end - NAMES_BYTES);
    match is_ours {
        true => Ok(capacity),
        false => Err(damaged("it is another program's GSD file, or cut short")),
    }
}

/// The names of the arrays.
pub(super) fn read_names(
    file: &mut File,
    path: &Path,
    offset: u64,
    bytes: u64,
) -> Result<Vec<String>, FormatError> {
    let names = read(file, path, offset, bytes)?;
    let names = names.split(|&byte| byte == 0);
    let names = names.take_while(|name| !name.is_empty());
    let names = names.map(|name| String::from_utf8_lossy(name).into_owned());
    Ok(names.collect())
}

/// The entries that have been written; the rest of the index, which may be long, is not looked at.
pub(super) fn read_entries(
    file: &mut File,
    path: &Path,
    index_at: u64,
    capacity: u64,
) -> Result<Vec<Entry>, FormatError> {
    let mut entries = Vec::new();
    while (entries.len() as u64) < capacity {
        let done = entries.len() as u64;
        let at = index_at + done * ENTRY_BYTES;
        let bytes = ENTRIES_A_READ.min(capacity - done) * ENTRY_BYTES;
        let block = read(file, path, at, bytes)?;
        let written = block.chunks_exact(ENTRY_BYTES as usize).map(Entry::decode);
        entries.extend(written.take_while(|entry| entry.location != 0));
        if (entries.len() as u64) < done + ENTRIES_A_READ {
            break;
        }
    }
    Ok(entries)
}

/// So many bytes of a file from a place on.
pub(super) fn read(
    file: &mut File,
    path: &Path,
    offset: u64,
    bytes: u64,
) -> Result<Vec<u8>, FormatError> {
    let mut buffer = vec![0; bytes as usize];
    file.seek(SeekFrom::Start(offset))
        .and_then(|_| file.read_exact(&mut buffer))
        .map_err(FormatError::io("read", path))?;
    Ok(buffer)
}
