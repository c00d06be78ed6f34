//! The texts that a configuration is read from, and places in them.

use std::ops::Range;
use std::sync::Arc;

/// What to read: a file, a preset, overrides; each may be missing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sources<'a> {
    /// The configuration file.
    pub file: Option<SourceFile<'a>>,
    /// The preset named on the command line.
    pub preset: Option<&'a str>,
    /// `key=value` texts in the order given; the last one of a key holds.
    pub overrides: &'a [String],
}

/// A file's name, for messages, and its text.
#[derive(Clone, Copy, Debug)]
pub struct SourceFile<'a> {
    /// Name as the user wrote it.
    pub name: &'a str,
    /// TOML.
    pub text: &'a str,
}

/// One text with the name that messages call it by.
#[derive(Debug)]
pub(crate) struct Source {
    pub(crate) name: Arc<str>,
    pub(crate) text: Arc<str>,
    pub(crate) kind: SourceKind,
}

/// Where a text came from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum SourceKind {
    Preset,
    File,
    Override,
}

impl Source {
    pub(crate) fn new(kind: SourceKind, name: impl Into<Arc<str>>, text: &str) -> Arc<Self> {
        Arc::new(Self {
            name: name.into(),
            text: text.into(),
            kind,
        })
    }

    /// The name in messages: an override's is its own text.
    pub(crate) fn override_name(text: &str) -> String {
        format!("--set {text}")
    }
}

/// A place in a source.
#[derive(Clone, Debug)]
pub struct Origin {
    pub(crate) source: Arc<Source>,
    pub(crate) span: Range<usize>,
}

impl Origin {
    pub(crate) fn new(source: &Arc<Source>, span: Range<usize>) -> Self {
        let source = Arc::clone(source);
        Self { source, span }
    }

    /// The bytes of the source's text that it covers.
    pub fn span(&self) -> Range<usize> {
        self.span.clone()
    }

    /// Whether both are the same place of the same text.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.source, &other.source) && self.span == other.span
    }

    /// The text at this place.
    pub fn text(&self) -> &str {
        self.source.text.get(self.span.clone()).unwrap_or("")
    }
}

/// Line and column of a byte, both from 1, columns in characters.
pub(crate) fn line_and_column(text: &str, byte: usize) -> (usize, usize) {
    let before = &text[..text.floor_char_boundary(byte)];
    let line = before.matches('\n').count() + 1;
    let start = before.rfind('\n').map_or(0, |newline| newline + 1);
    (line, before[start..].chars().count() + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_and_columns_count_from_one_in_characters() {
        let text = "a = 1\n# \u{e9}\u{e9}\nb = 2\n";
        assert_eq!(line_and_column(text, 0), (1, 1));
        assert_eq!(line_and_column(text, text.find('b').unwrap()), (3, 1));
        assert_eq!(line_and_column("\u{e9}x", 2), (1, 2));
        assert_eq!(line_and_column("\u{e9}x", 1), (1, 1));
        assert_eq!(line_and_column("a\n", 99), (2, 1));
    }
}
