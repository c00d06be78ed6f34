//! Errors of a configuration: message, key, allowed values, and the place in the text.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use crate::source::{Origin, Source, SourceFile, SourceKind, line_and_column};

/// Problems that are shown at most: more than these have one cause as a rule.
const MOST_SHOWN: usize = 20;

/// Everything that was found wrong with a configuration, in the order of the texts.
///
/// `Display` is complete in itself: one paragraph a problem, with source, line, column, message and help.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}", paragraphs(self))]
pub struct ConfigurationError {
    problems: Vec<Problem>,
}

impl ConfigurationError {
    /// `Ok` without problems, else all of them in their order.
    ///
    /// # Errors
    /// The problems.
    pub fn all(problems: Vec<Problem>) -> Result<(), Self> {
        if problems.is_empty() {
            return Ok(());
        }
        Err(Self { problems })
    }

    /// The problems, at least one.
    pub fn problems(&self) -> &[Problem] {
        &self.problems
    }

    /// The problems to show, of many only the first, and words for how many more there are.
    pub fn shown(&self) -> (&[Problem], Option<String>) {
        let shown = &self.problems[..self.problems.len().min(MOST_SHOWN)];
        let more = self.problems.len() - shown.len();
        (
            shown,
            (more > 0).then(|| format!("and {more} more problems")),
        )
    }
}

impl From<Problem> for ConfigurationError {
    fn from(problem: Problem) -> Self {
        let problems = vec![problem];
        Self { problems }
    }
}

fn paragraphs(error: &ConfigurationError) -> String {
    let (problems, more) = error.shown();
    let paragraphs = problems.iter().map(ToString::to_string).chain(more);
    paragraphs.collect::<Vec<_>>().join("\n")
}

/// The kind of a [`Problem`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProblemKind {
    /// A text is not TOML, or an override is not `key=value`.
    Syntax,
    /// A key that does not exist.
    UnknownKey,
    /// A value of the wrong type, or a name that is not one of those allowed.
    WrongType,
    /// A value outside the range of its key.
    OutOfRange,
    /// Keys that exclude one another.
    Conflict,
    /// A key that is needed and not given.
    Missing,
    /// Values that are possible alone but not together.
    Inconsistent,
    /// A preset that does not exist, or two that are named.
    Preset,
}

/// One thing wrong with a configuration.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}", paragraph(self))]
pub struct Problem {
    /// Kind of the problem.
    pub kind: ProblemKind,
    /// The fault, in one sentence.
    pub message: String,
    /// Full name of the key, such as `drive.width`; of several the first.
    pub key: Option<String>,
    /// The allowed values, or the way to mend the fault.
    pub help: Option<String>,
    /// Where it was written, the main place first; empty if nowhere (a missing key).
    pub labels: Vec<Label>,
    /// Its place in the order of the texts; problems without one come last.
    order: (SourceKind, usize),
}

/// A place in a text that a problem has to do with.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// Name of the file, `preset NAME`, or `--set KEY=VALUE`.
    pub source_name: Arc<str>,
    /// The whole text of the source.
    pub source_text: Arc<str>,
    /// Bytes of `source_text`; always within it and on character boundaries.
    pub span: Range<usize>,
    /// The label of this place.
    pub message: String,
}

impl Label {
    /// Line and column of the place, both from 1.
    pub fn line_and_column(&self) -> (usize, usize) {
        line_and_column(&self.source_text, self.span.start)
    }
}

impl fmt::Display for Label {
    /// `name:line:column`, or the name alone for an override, which is its own text.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if *self.source_name == Source::override_name(&self.source_text) {
            return formatter.write_str(&self.source_name);
        }
        let (line, column) = self.line_and_column();
        write!(formatter, "{}:{line}:{column}", self.source_name)
    }
}

fn paragraph(problem: &Problem) -> String {
    let mut text = match problem.labels.first() {
        Some(label) => format!("{label}: {}", problem.message),
        None => problem.message.clone(),
    };
    for label in problem.labels.iter().skip(1) {
        text.push_str(&format!("\n  {label}: {}", label.message));
    }
    if let Some(help) = &problem.help {
        text.push_str(&format!("\n  help: {help}"));
    }
    text
}

impl Problem {
    /// A problem without key, help or place so far.
    pub fn new(kind: ProblemKind, message: impl Into<String>) -> Self {
        Self {
            kind,
            message: message.into(),
            key: None,
            help: None,
            labels: Vec::new(),
            order: (SourceKind::Override, usize::MAX),
        }
    }

    /// Names the key.
    pub fn key(mut self, key: impl Into<String>) -> Self {
        self.key = Some(key.into());
        self
    }

    /// Says what is allowed, or how to mend it.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Adds a place and what to say of it.
    pub fn at(mut self, origin: &Origin, message: impl Into<String>) -> Self {
        if self.labels.is_empty() {
            self.order = (origin.source.kind, origin.span.start);
        }
        let Origin { source, span } = origin;
        let [start, end] = [span.start, span.end].map(|byte| source.text.floor_char_boundary(byte));
        self.labels.push(Label {
            source_name: Arc::clone(&source.name),
            source_text: Arc::clone(&source.text),
            span: start..end.max(start),
            message: message.into(),
        });
        self
    }
}

/// Problems found so far.
#[derive(Debug, Default)]
pub struct Problems {
    found: Vec<Problem>,
}

impl Problems {
    /// Adds a problem.
    pub fn push(&mut self, problem: Problem) {
        self.found.push(problem);
    }

    /// Problems found so far.
    pub(crate) fn number(&self) -> usize {
        self.found.len()
    }

    /// Gives problems that have no place, such as a missing key, the beginning of a file.
    pub fn place_in(&mut self, file: SourceFile<'_>) {
        let source = Source::new(SourceKind::File, file.name, file.text);
        let start = Origin::new(&source, 0..0);
        for problem in &mut self.found {
            if problem.labels.is_empty() {
                *problem = problem.clone().at(&start, "in this file");
            }
        }
    }

    /// `Ok` without problems, else all of them as one error.
    ///
    /// # Errors
    /// All problems, in the order of the texts.
    pub fn check(&mut self) -> Result<(), ConfigurationError> {
        self.found.sort_by_key(|problem| problem.order);
        ConfigurationError::all(std::mem::take(&mut self.found))
    }
}
