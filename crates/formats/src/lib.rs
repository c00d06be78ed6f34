//! Bytes in, bytes out: the files that this project writes, and nothing about the physics in them.
//!
//! | module | what it holds |
//! |---|---|
//! | [`table`] | [`Table`]: named columns with unit and description, the one shape of every tabular result |
//! | [`parquet`] | a [`Table`] as Parquet: exact, with units, descriptions and metadata |
//! | [`csv`] | a [`Table`] as CSV: values only, for eyes and spreadsheets |
//! | [`checkpoint`] | any serializable state behind a header that detects every corrupted byte |
//! | [`trajectory`] | spheres frame by frame, as GSD, VTP and LAMMPS text |
//! | [`atomic`] | a file is written whole or not at all |
//!
//! The file modules share their verbs: `encode` and `decode` work on bytes, `write` and `read` on a path. There is no `read`
//! of a checkpoint: whoever decodes one first asks its bytes for the physics (`physics_hash`).

#![forbid(unsafe_code)]

#[cfg(test)]
#[macro_use]
mod tests;

pub mod atomic;
pub mod checkpoint;
pub mod csv;
mod error;
pub mod parquet;
pub mod table;
pub mod trajectory;
mod value_kind;

pub use checkpoint::CheckpointIdentity;
pub use error::{FormatError, is_closed};
pub use table::{Column, Table, TableBuilder, Values};
pub use trajectory::{Frame, TrajectoryFile, TrajectoryFormat};
pub use value_kind::ValueKind;

/// Bytes as lower-case hexadecimal digits.
pub fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// A path as one word of a POSIX shell.
///
/// ```
/// use peristalsis_formats::shell_word;
///
/// assert_eq!(shell_word("/home/me/a.toml".as_ref()), "/home/me/a.toml");
/// assert_eq!(shell_word("it's $HOME".as_ref()), r"'it'\''s $HOME'");
/// ```
pub fn shell_word(path: &std::path::Path) -> String {
    let text = path.display().to_string();
    let plain = |letter: char| {
        letter.is_ascii_alphanumeric()
            || "/._-+=:@%".contains(letter)
            || cfg!(windows) && letter == '\\'
    };
    if !text.is_empty() && text.chars().all(plain) {
        text
    } else {
        format!("'{}'", text.replace('\'', r"'\''"))
    }
}

/// Reads the table in a file, as Parquet where its name ends so and as CSV elsewhere.
///
/// # Errors
/// [`FormatError`] where there is no such table.
pub fn read_table(path: &std::path::Path) -> Result<Table, FormatError> {
    match path.extension().and_then(|ending| ending.to_str()) {
        Some("parquet") => parquet::read(path),
        _ => csv::read(path),
    }
}
