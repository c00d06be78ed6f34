//! Errors as a person reads them, and the exit code that goes with each.

use std::fmt::{self, Display};
use std::path::PathBuf;
use std::process::ExitCode;

use miette::{Diagnostic, LabeledSpan, NamedSource, SourceCode};
use peristalsis_configuration::{ConfigurationError, Problem};
use peristalsis_engine::EngineError;
use peristalsis_run::RunError;

use crate::commands::say;

/// Why a command ended without what was asked for.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Failure {
    /// The configuration is not one that can run.
    #[error(transparent)]
    Configuration(#[from] ConfigurationError),
    /// A file cannot be read.
    #[error("cannot read {}: {source}", path.display())]
    Read {
        path: PathBuf,
        source: std::io::Error,
    },
    /// The command line asks for something that does not exist.
    #[error("{message}")]
    Usage {
        message: String,
        help: Option<String>,
    },
    /// More grains than the tube holds.
    #[error("{place}: {error}")]
    DoesNotFit {
        /// Where their number is given, as `file:line: text` or the override.
        place: String,
        error: RunError,
    },
    /// The run or its record.
    #[error(transparent)]
    Run(#[from] RunError),
    /// Signals cannot be watched.
    #[error("cannot watch for signals: {0}")]
    Signals(std::io::Error),
    /// Standard output cannot be written to.
    #[error("cannot write to standard output: {0}")]
    Output(std::io::Error),
}

/// Exit code for input that cannot be run.
const BAD_INPUT: u8 = 2;
/// Exit code for work that failed.
const FAILED: u8 = 1;

impl Failure {
    fn exit_code(&self) -> u8 {
        match self {
            Self::Configuration(_)
            | Self::Read { .. }
            | Self::Usage { .. }
            | Self::DoesNotFit { .. } => BAD_INPUT,
            Self::Run(error) => match error {
                RunError::HoldsAnotherRun { .. }
                | RunError::Folder { .. }
                | RunError::NothingToResume { .. }
                | RunError::TooManyGrains { .. }
                | RunError::Configuration(_)
                | RunError::Engine(
                    EngineError::DoesNotFit { .. } | EngineError::InvalidParameter { .. },
                ) => BAD_INPUT,
                _ => FAILED,
            },
            Self::Signals(_) | Self::Output(_) => FAILED,
        }
    }

    fn help(&self) -> Option<String> {
        match self {
            Self::Usage { help, .. } => help.clone(),
            Self::Run(RunError::HoldsAnotherRun { .. }) => {
                Some("name another folder with --out, or go on with that run with --resume".to_owned())
            }
            Self::Read { .. } => Some(
                "FILE is a text file in TOML, UTF-8; `peristalsis presets frictionless` prints one"
                    .to_owned(),
            ),
            Self::DoesNotFit { .. }
            | Self::Run(
                RunError::TooManyGrains { .. } | RunError::Engine(EngineError::DoesNotFit { .. }),
            ) => Some(
                "take fewer grains (grains.number, grains.volume_fraction, grains.number_density) or a wider tube \
                 (drive.width, tube.radius)"
                    .to_owned(),
            ),
            Self::Run(RunError::Engine(EngineError::Diverged { .. })) => {
                Some("take a shorter run.time_step, or softer or fewer grains".to_owned())
            }
            _ => None,
        }
    }

    /// Prints the error and answers the exit code.
    pub(crate) fn report(&self) -> ExitCode {
        let problems = match self {
            Self::Configuration(error) | Self::Run(RunError::Configuration(error)) => {
                error.problems().iter().map(Report::of_problem).collect()
            }
            other => vec![Report {
                message: other.to_string(),
                help: other.help(),
                source: None,
                labels: Vec::new(),
            }],
        };
        for problem in problems {
            say(&format!("Error: {:?}", miette::Report::new(problem)));
        }
        ExitCode::from(self.exit_code())
    }
}

/// An error with places in a text.
#[derive(Debug)]
struct Report {
    message: String,
    help: Option<String>,
    source: Option<NamedSource<String>>,
    labels: Vec<LabeledSpan>,
}

impl Report {
    fn of_problem(problem: &Problem) -> Self {
        let main = problem.labels.first();
        let place = main.map_or_else(String::new, |label| format!("{label}: "));
        Self {
            message: format!("{place}{}", problem.message),
            help: problem.help.clone(),
            source: main
                .map(|label| NamedSource::new(&label.source_name, label.source_text.to_string())),
            // A snippet shows one text; places in others are in the message already.
            labels: problem
                .labels
                .iter()
                .filter(|label| main.is_some_and(|main| main.source_name == label.source_name))
                .map(|label| LabeledSpan::at(label.span.clone(), label.message.clone()))
                .collect(),
        }
    }
}

impl Display for Report {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.message)
    }
}

impl std::error::Error for Report {}

impl Diagnostic for Report {
    fn help<'a>(&'a self) -> Option<Box<dyn Display + 'a>> {
        self.help
            .as_ref()
            .map(|help| Box::new(help) as Box<dyn Display>)
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.source.as_ref().map(|source| source as &dyn SourceCode)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        Some(Box::new(self.labels.iter().cloned()))
    }
}
