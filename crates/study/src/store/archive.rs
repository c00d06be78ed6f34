//! One file with the finished runs of a store, and the way back.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Component, Path};

use peristalsis_formats::atomic;

use super::{GONE, RUNS, State, Store, Verdict, done};
use crate::error::{Result, StudyError};
use crate::identity::Identity;
use crate::store::entry::Entry;
use crate::store::run_files::RunFiles;

/// Content of an archive or of a table of rows.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Packed {
    /// Runs in it.
    pub runs: usize,
    /// Runs that were taken over. An import takes runs that were not finished here; those of an archive where their hashes
    /// check.
    pub taken: usize,
    /// Runs that were left out of an archive, or not taken from it, since they are not finished or their files differ from
    /// their seal, with the reason.
    pub refused: Vec<(Identity, String)>,
    /// Runs of a table whose row differs from that of the run that is finished here.
    pub different: usize,
    /// Finished runs that an archive does not hold, for their rows were imported and they have no files here.
    pub without_files: usize,
}

impl Store {
    /// Writes every run that was finished here, with all its files, to one tar archive; the same runs give the same bytes.
    ///
    /// # Errors
    /// Errors of reading and writing.
    pub fn pack(&self, archive: &Path) -> Result<Packed> {
        let mut entries = self.index()?.entries()?;
        entries.retain(|_, entry| entry.state == State::Done);
        let finished = entries.len();
        entries.retain(|_, entry| entry.is_computed());
        let mut packed = Packed {
            without_files: finished - entries.len(),
            ..Packed::default()
        };
        let identities: BTreeSet<Identity> = entries.into_keys().collect();
        if let Some(folder) = archive.parent() {
            fs::create_dir_all(folder).map_err(StudyError::io("make", folder))?;
        }
        atomic::write_with(archive, |file| {
            let mut builder = tar::Builder::new(io::BufWriter::new(file));
            for identity in &identities {
                let files = self.run_files(*identity);
                if let Some(reason) = unfinished(files.verdict(None)) {
                    packed.refused.push((*identity, reason));
                    continue;
                }
                append(&mut builder, *identity, &files)?;
                packed.runs += 1;
            }
            builder.into_inner()?.flush()
        })?;
        Ok(packed)
    }

    /// Takes finished runs with all their files from an archive of [`Store::pack`]; every hash is checked first. A run that
    /// is finished here stays as it is.
    ///
    /// # Errors
    /// [`StudyError::NotRows`] where it is no such archive, errors of reading and writing.
    pub fn import_archive(&self, path: &Path) -> Result<Packed> {
        let refused = |reason: String| StudyError::not_rows(path)(reason);
        let file = File::open(path).map_err(StudyError::read(path))?;
        let scratch = tempfile::Builder::new()
            .prefix(".import-")
            .tempdir_in(self.path())
            .map_err(StudyError::io("make a folder in", self.path()))?;
        if file.metadata().is_ok_and(|it| it.len() == 0) {
            return Err(refused("it is empty".to_owned()));
        }
        let mut archive = tar::Archive::new(io::BufReader::new(file));
        let mut identities = BTreeSet::new();
        let broken = |_: io::Error| refused("it is no tar archive, or damaged".to_owned());
        for entry in archive.entries().map_err(broken)? {
            let mut entry = entry.map_err(broken)?;
            let name = entry.path().map_err(broken)?.into_owned();
            let Some((identity, file)) = member(&name) else {
                return Err(refused(format!("it has a member {}", name.display())));
            };
            let folder = scratch.path().join(identity.to_string());
            fs::create_dir_all(&folder).map_err(StudyError::io("make", &folder))?;
            let target = folder.join(file);
            let mut written = File::create(&target).map_err(StudyError::io("write", &target))?;
            io::copy(&mut entry, &mut written)
                .and_then(|_| written.sync_all())
                .map_err(StudyError::io("write", &target))?;
            identities.insert(identity);
        }
        self.take(scratch.path(), &identities)
    }

    fn take(&self, scratch: &Path, identities: &BTreeSet<Identity>) -> Result<Packed> {
        let mut index = self.index()?;
        let known = index.entries()?;
        let leases = index.leases(super::LEASE_TIMEOUT)?;
        let mut packed = Packed {
            runs: identities.len(),
            ..Packed::default()
        };
        for identity in identities {
            let finished = known.get(identity).is_some_and(Entry::is_computed);
            if finished || leases.contains_key(identity) {
                continue;
            }
            let unpacked = RunFiles::new(scratch, *identity);
            if let Some(reason) = unfinished(unpacked.verdict(None)) {
                packed.refused.push((*identity, reason));
                continue;
            }
            let target = self.run_folder(*identity);
            if target.exists() {
                self.quarantine_run(*identity, "replaced by a finished run from an archive")?;
            }
            fs::rename(unpacked.path(), &target)
                .map_err(StudyError::io("move into place", &target))?;
            atomic::synchronize(&self.file(RUNS))?;
            if let Verdict::Done { row, stamp } = self.run_files(*identity).verdict(None) {
                index.note([(*identity, &done(&row, stamp))])?;
                packed.taken += 1;
            }
        }
        Ok(packed)
    }
}

/// Why the files of a run are not those of a finished one; `None` where they are.
fn unfinished(verdict: Verdict) -> Option<String> {
    match verdict {
        Verdict::Done { .. } => None,
        Verdict::Damaged(reason) => Some(reason),
        Verdict::Nothing | Verdict::Checkpointed => Some(GONE.to_owned()),
        Verdict::Failed(reason) => Some(format!("it failed: {reason}")),
    }
}

/// Adds the files of a run, with nothing of when and by whom they were written.
fn append(
    builder: &mut tar::Builder<impl Write>,
    identity: Identity,
    files: &RunFiles,
) -> io::Result<()> {
    for name in files.sealed_names().map_err(io::Error::other)? {
        let bytes = fs::read(files.path().join(&name))?;
        let mut header = tar::Header::new_gnu();
        header.set_size(bytes.len() as u64);
        header.set_mode(0o644);
        header.set_mtime(0);
        builder.append_data(&mut header, format!("{RUNS}/{identity}/{name}"), &*bytes)?;
    }
    Ok(())
}

/// Identity and file name of a member `runs/<identity>/<name>`; `None` for any other.
fn member(path: &Path) -> Option<(Identity, String)> {
    let parts: Option<Vec<&str>> = path
        .components()
        .map(|part| match part {
            Component::Normal(name) => name.to_str(),
            _ => None,
        })
        .collect();
    match *parts? {
        [RUNS, identity, name] => Some((identity.parse().ok()?, name.to_owned())),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn members_outside_of_a_run_are_none() {
        let identity = "0123456789abcdef".repeat(2);
        let good = format!("runs/{identity}/row.csv");
        assert_eq!(member(Path::new(&good)).unwrap().1, "row.csv");
        for bad in [
            format!("runs/{identity}/../../x"),
            format!("/runs/{identity}/x"),
            format!("runs/{identity}"),
            format!("other/{identity}/x"),
            "runs/zz/x".to_owned(),
        ] {
            assert!(member(Path::new(&bad)).is_none(), "{bad}");
        }
    }
}
