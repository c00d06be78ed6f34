//! A file that grows at its end, and is cut back where writing fails.

use std::fs::{File, OpenOptions};
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use crate::error::FormatError;

/// An open file; its first `end` bytes count.
#[derive(Debug)]
pub(super) struct Growing {
    file: File,
    path: PathBuf,
    end: u64,
}

impl Growing {
    /// A new empty file, over an older one.
    pub(super) fn create(path: &Path) -> Result<Self, FormatError> {
        let mut options = File::options();
        Self::with(options.create(true).truncate(true), "create", path)
    }

    /// A file that there is, as long as it is.
    pub(super) fn open(path: &Path) -> Result<Self, FormatError> {
        Self::with(&mut File::options(), "open", path)
    }

    fn with(
        options: &mut OpenOptions,
        operation: &'static str,
        path: &Path,
    ) -> Result<Self, FormatError> {
        let file = options.read(true).write(true).open(path);
        let file = file.map_err(FormatError::io(operation, path))?;
        let about = file.metadata().map_err(FormatError::io("read", path))?;
        Ok(Self {
            file,
            path: path.to_owned(),
            end: about.len(),
        })
    }

    pub(super) fn file(&mut self) -> &mut File {
        &mut self.file
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    pub(super) fn end(&self) -> u64 {
        self.end
    }

    /// Writes at the end; what was written of it goes again where that fails.
    pub(super) fn append(&mut self, bytes: &[u8]) -> Result<(), FormatError> {
        self.write_at(self.end, bytes).inspect_err(|_| {
            // The caller hears of the failure that matters; what may be left lies beyond the end.
            drop(self.file.set_len(self.end));
        })?;
        self.end += bytes.len() as u64;
        Ok(())
    }

    /// Overwrites the bytes at `offset`; the end stays.
    pub(super) fn write_at(&mut self, offset: u64, bytes: &[u8]) -> Result<(), FormatError> {
        self.file
            .seek(SeekFrom::Start(offset))
            .and_then(|_| self.file.write_all(bytes))
            .map_err(FormatError::io("write", &self.path))
    }

    /// Makes the file so long, of zeros where it grows.
    pub(super) fn set_end(&mut self, end: u64) -> Result<(), FormatError> {
        let set = self.file.set_len(end);
        set.map_err(FormatError::io("write", &self.path))?;
        self.end = end;
        Ok(())
    }

    pub(super) fn synchronize(&mut self) -> Result<(), FormatError> {
        let synchronized = self.file.sync_all();
        synchronized.map_err(FormatError::io("synchronize", &self.path))
    }
}
