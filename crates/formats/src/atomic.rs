//! Atomic writing: after a crash, a kill or a full disk, a file is the old one or the new one, never a part of one.

use std::fs::File;
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use crate::error::FormatError;

/// Ending of the temporary files. One is left behind only if the process is killed while it writes; it may be deleted, as
/// [`sweep`] does.
pub const PARTIAL_SUFFIX: &str = ".partial";

/// Writes these bytes as the whole content of a file, or leaves everything as it was.
///
/// The bytes go to a temporary file in the same folder, which is synchronized with the disk and then renamed; the folder
/// is synchronized last. The file gets the permissions of any newly created one; a symbolic link at `path` is replaced,
/// not followed.
///
/// # Errors
/// [`FormatError::Io`] with the path and the cause. If the cause is the last step, the synchronization of the folder,
/// the file is there in full but could be lost in a power cut; after any other error nothing has changed.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), FormatError> {
    write_with(path, |file| file.write_all(bytes))
}

/// Like [`write`](fn@write), but only where there is no file of that name: of several programs that write it at once, one
/// does.
///
/// # Errors
/// As [`write`](fn@write); [`FormatError::Io`] with [`ErrorKind::AlreadyExists`] where there is one.
pub fn write_new(path: &Path, bytes: &[u8]) -> Result<(), FormatError> {
    let pending = Pending::with(path, |file| file.write_all(bytes))?;
    let file = pending.partial.as_file();
    file.sync_all()
        .map_err(FormatError::io("synchronize", path))?;
    let named = pending.partial.persist_noclobber(path);
    named.map_err(|refused| FormatError::io("create", path)(refused.error))?;
    folder_of(path)
        .and_then(synchronize_folder)
        .map_err(FormatError::io("synchronize the folder of", path))
}

/// Like [`write`](fn@write), for a content that is produced piece by piece.
///
/// # Errors
/// As [`write`](fn@write), and whatever `produce` returns.
pub fn write_with(
    path: &Path,
    produce: impl FnOnce(&mut File) -> io::Result<()>,
) -> Result<(), FormatError> {
    Pending::with(path, produce)?.commit()
}

/// A file that is being made under a temporary name, by this program or by another that is given that name.
///
/// Dropped without [`Pending::commit`] it leaves nothing behind.
#[derive(Debug)]
pub struct Pending {
    partial: NamedTempFile,
    path: PathBuf,
}

impl Pending {
    /// An empty file beside `path`.
    ///
    /// # Errors
    /// [`FormatError::Io`] where it cannot be made.
    pub fn create(path: &Path) -> Result<Self, FormatError> {
        let folder = folder_of(path).map_err(FormatError::io("write", path))?;
        let partial = create_partial(folder);
        let partial = partial.map_err(FormatError::io("create a file beside", path))?;
        Ok(Self {
            partial,
            path: path.to_owned(),
        })
    }

    /// A file beside `path` with its content.
    fn with(
        path: &Path,
        produce: impl FnOnce(&mut File) -> io::Result<()>,
    ) -> Result<Self, FormatError> {
        let mut pending = Self::create(path)?;
        produce(pending.partial.as_file_mut()).map_err(FormatError::io("write", path))?;
        Ok(pending)
    }

    /// Where it is meanwhile.
    pub fn partial_path(&self) -> &Path {
        self.partial.path()
    }

    /// Gives the file its name, over an older one, once all of it is on the disk.
    ///
    /// # Errors
    /// As [`write`](fn@write).
    pub fn commit(self) -> Result<(), FormatError> {
        let file = self.partial.as_file();
        file.sync_all()
            .map_err(FormatError::io("synchronize", &self.path))?;
        let path = self.rename()?;
        folder_of(&path)
            .and_then(synchronize_folder)
            .map_err(FormatError::io("synchronize the folder of", &path))
    }

    fn rename(self) -> Result<PathBuf, FormatError> {
        match self.partial.persist(&self.path) {
            Ok(_) => Ok(self.path),
            Err(refused) => Err(FormatError::io("replace", &self.path)(refused.error)),
        }
    }
}

/// Like [`write`](fn@write), but without waiting for the disk: whole or not at all after a kill or a full disk, though
/// perhaps not after a power cut. For files that come many a second.
///
/// # Errors
/// As [`write`](fn@write).
pub fn replace(path: &Path, bytes: &[u8]) -> Result<(), FormatError> {
    Pending::with(path, |file| file.write_all(bytes))?
        .rename()
        .map(drop)
}

/// Makes the names in a folder durable: of a folder just made in it, or of a file just moved there.
///
/// # Errors
/// [`FormatError::Io`] where the folder cannot be opened or synchronized.
pub fn synchronize(folder: &Path) -> Result<(), FormatError> {
    synchronize_folder(folder).map_err(FormatError::io("synchronize", folder))
}

/// Deletes the temporary files that killed programs have left in a folder where no other program writes now; what cannot be
/// deleted stays.
pub fn sweep(folder: &Path) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        if name.starts_with('.') && name.ends_with(PARTIAL_SUFFIX) {
            drop(std::fs::remove_file(entry.path()));
        }
    }
}

fn folder_of(path: &Path) -> io::Result<&Path> {
    match (path.file_name(), path.parent()) {
        (Some(_), Some(folder)) if folder.as_os_str().is_empty() => Ok(Path::new(".")),
        (Some(_), Some(folder)) => Ok(folder),
        _ => Err(io::Error::new(
            ErrorKind::InvalidInput,
            "the path names no file",
        )),
    }
}

fn create_partial(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".").suffix(PARTIAL_SUFFIX);
    // Temporary files are private by default; a result is not. The umask still applies.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}

#[cfg(unix)]
fn synchronize_folder(folder: &Path) -> io::Result<()> {
    match File::open(folder)?.sync_all() {
        // Some network and user-space file systems cannot synchronize a folder; there the rename is all one can do.
        Err(error)
            if matches!(
                error.kind(),
                ErrorKind::InvalidInput | ErrorKind::Unsupported
            ) =>
        {
            Ok(())
        }
        outcome => outcome,
    }
}

#[cfg(not(unix))]
fn synchronize_folder(_folder: &Path) -> io::Result<()> {
    // A folder cannot be opened as a file here; the file system orders renames by its own journal.
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn kind_of(outcome: Result<(), FormatError>, expected_path: &Path) -> ErrorKind {
        match outcome {
            Err(FormatError::Io { path, source, .. }) => {
                assert_eq!(path, expected_path);
                source.kind()
            }
            other => panic!("expected an input/output error, got {other:?}"),
        }
    }

    fn entries(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> = fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn a_file_is_created_and_replaced_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("table.csv");
        write(&path, b"first and longer").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"first and longer");
        write(&path, b"second").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"second");
        assert_eq!(entries(folder.path()), ["table.csv"]);
    }

    #[test]
    fn a_failure_half_way_keeps_the_old_content_and_leaves_nothing_behind() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("table.csv");
        write(&path, b"old").unwrap();
        let outcome = write_with(&path, |file| {
            file.write_all(b"half of the n")?;
            // While the new content is being written, the old one must still be the one under the final name.
            assert_eq!(fs::read(&path).unwrap(), b"old");
            assert_eq!(entries(folder.path()).len(), 2);
            Err(ErrorKind::StorageFull.into())
        });
        assert_eq!(kind_of(outcome, &path), ErrorKind::StorageFull);
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(entries(folder.path()), ["table.csv"]);
    }

    #[test]
    fn a_pending_file_has_its_name_only_when_it_is_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("film.gif");
        let pending = Pending::create(&path).unwrap();
        // As another program would: under the name that it is told.
        fs::write(pending.partial_path(), b"half").unwrap();
        drop(pending);
        assert!(entries(folder.path()).is_empty());
        let pending = Pending::create(&path).unwrap();
        fs::write(pending.partial_path(), b"whole").unwrap();
        assert!(!path.exists());
        pending.commit().unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"whole");
        assert_eq!(entries(folder.path()), ["film.gif"]);
    }

    #[test]
    fn causes_are_told_apart() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        write(&file, b"x").unwrap();
        let below_a_file = file.join("below");
        assert_eq!(
            kind_of(write(&below_a_file, b"y"), &below_a_file),
            ErrorKind::NotADirectory
        );
        let in_no_folder = folder.path().join("none").join("file");
        assert_eq!(
            kind_of(write(&in_no_folder, b"y"), &in_no_folder),
            ErrorKind::NotFound
        );
        let no_name = folder.path().join("..");
        assert_eq!(
            kind_of(write(&no_name, b"y"), &no_name),
            ErrorKind::InvalidInput
        );
        let occupied = folder.path().join("folder");
        fs::create_dir(&occupied).unwrap();
        assert_eq!(
            kind_of(write(&occupied, b"y"), &occupied),
            ErrorKind::IsADirectory
        );
        assert_eq!(entries(folder.path()), ["file", "folder"]);
    }

    #[cfg(unix)]
    #[test]
    fn a_folder_without_write_permission_is_reported_as_such() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o555)).unwrap();
        // The superuser may write anywhere: then there is no refusal to be reported.
        if File::create(folder.path().join("probe")).is_err() {
            let path = folder.path().join("file");
            assert_eq!(
                kind_of(write(&path, b"x"), &path),
                ErrorKind::PermissionDenied
            );
        }
        fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o755)).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn permissions_are_those_of_a_plainly_created_file() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let mode = |name: &str| {
            fs::metadata(folder.path().join(name))
                .unwrap()
                .permissions()
                .mode()
        };
        File::create(folder.path().join("plain")).unwrap();
        write(&folder.path().join("atomic"), b"x").unwrap();
        assert_eq!(mode("atomic"), mode("plain"));
    }
}
