//! Errors as a person reads them, and the exit code that goes with each.

use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};
use peristalsis_configuration::{ConfigurationError, Problem};
use peristalsis_engine::EngineError;
use peristalsis_formats::FormatError;
use peristalsis_reproduce::ClaimError;
use peristalsis_run::{RenderError, RunError};
use peristalsis_study::StudyError;
use peristalsis_viewer::ViewerError;

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
    /// A file cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    Write {
        path: PathBuf,
        source: std::io::Error,
    },
    /// The command line asks for something that does not exist.
    #[error("{message}")]
    Usage { message: String, help: String },
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
    /// A frame of a run's trajectory cannot be written.
    #[error("the run was stopped, since its trajectory cannot be written: {source}")]
    Trajectory { folder: PathBuf, source: RunError },
    /// A study or its store.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// Claims, textbook cases or the report of them.
    #[error(transparent)]
    Claim(ClaimError),
    /// The viewer.
    #[error(transparent)]
    Viewer(#[from] ViewerError),
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

impl From<ClaimError> for Failure {
    fn from(error: ClaimError) -> Self {
        match error {
            // A study says the same whoever asked for it.
            ClaimError::Study(error) => Self::Study(error),
            other => Self::Claim(other),
        }
    }
}

impl Failure {
    /// A command line that asks for something that does not exist, and what to ask for instead.
    pub(crate) fn usage(message: impl Into<String>, help: impl Into<String>) -> Self {
        Self::Usage {
            message: message.into(),
            help: help.into(),
        }
    }

    fn exit_code(&self) -> u8 {
        match self {
            Self::Configuration(_)
            | Self::Read { .. }
            | Self::Usage { .. }
            | Self::DoesNotFit { .. }
            | Self::Viewer(
                ViewerError::Trajectory(_)
                | ViewerError::ForeignTrajectory { .. }
                | ViewerError::NotRows { .. }
                | ViewerError::Claims { .. },
            ) => BAD_INPUT,
            Self::Run(error) => match error {
                RunError::HoldsAnotherRun { .. }
                | RunError::Folder { .. }
                | RunError::NothingToResume { .. }
                | RunError::State { .. }
                | RunError::Trajectory { .. }
                | RunError::Picture { .. }
                | RunError::Render(RenderError::NoFfmpeg { .. } | RenderError::Speed { .. })
                | RunError::Format(FormatError::UnreadableTrajectory { .. })
                | RunError::TooManyGrains { .. }
                | RunError::NoMemory { .. }
                | RunError::Configuration(_)
                | RunError::Engine(
                    EngineError::DoesNotFit { .. } | EngineError::InvalidParameter { .. },
                ) => BAD_INPUT,
                _ => FAILED,
            },
            Self::Study(error) => match error {
                StudyError::Configuration(_)
                | StudyError::Read { .. }
                | StudyError::NoStore { .. }
                | StudyError::OtherStudy { .. }
                | StudyError::NoSuchRun { .. }
                | StudyError::NotRows { .. }
                | StudyError::Trial(_) => BAD_INPUT,
                _ => FAILED,
            },
            Self::Claim(
                ClaimError::NoSuchExperiment { .. }
                | ClaimError::Folder { .. }
                | ClaimError::Read { .. }
                | ClaimError::NoPlace { .. },
            ) => BAD_INPUT,
            Self::Write { .. }
            | Self::Trajectory { .. }
            | Self::Claim(_)
            | Self::Viewer(_)
            | Self::Signals(_)
            | Self::Output(_) => FAILED,
        }
    }

    fn help(&self) -> Option<String> {
        match self {
            Self::Usage { help, .. } => Some(help.clone()),
            Self::Run(RunError::HoldsAnotherRun { .. }) => {
                Some("name another folder with --out, or go on with that run with --resume".to_owned())
            }
            Self::Run(RunError::State { path, source }) => Some(of_state(path, source)),
            Self::Run(RunError::Trajectory { help, .. }) => Some((*help).to_owned()),
            Self::Run(RunError::Picture { help, .. }) => Some(help.clone()),
            Self::Run(RunError::Render(RenderError::NoFfmpeg { .. })) => Some(
                "install ffmpeg or name it in the variable FFMPEG, or take a film that needs none: --format gif, --format apng"
                    .to_owned(),
            ),
            Self::Run(RunError::Format(FormatError::UnreadableTrajectory { .. })) => Some(
                "name a GSD trajectory that this program wrote, or let the frames be computed: --from state, --from start"
                    .to_owned(),
            ),
            Self::Trajectory {
                source: RunError::Format(FormatError::NotATrajectory { .. }),
                ..
            }
            | Self::Run(RunError::Format(FormatError::NotATrajectory { .. })) => Some(
                "put its files back, or go on without: move the folder's trajectory.toml and trajectory files away"
                    .to_owned(),
            ),
            Self::Trajectory { folder, .. } => Some(format!(
                "nothing that was measured is lost: make room, then go on with: peristalsis run --resume {}",
                folder.display()
            )),
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
            Self::Run(RunError::NoMemory { .. }) => Some(
                "take fewer waves (tube.waves) or grains (grains.number), or give the program more memory (`ulimit -v`)"
                    .to_owned(),
            ),
            Self::Run(RunError::NothingToResume { folder, reason })
                if folder.join("config.toml").is_file() && !reason.contains("complete") =>
            {
                Some(format!(
                    "begin it anew in another folder: peristalsis run {} --out DIR",
                    folder.join("config.toml").display()
                ))
            }
            Self::Run(error @ RunError::Engine(EngineError::Diverged { .. })) => {
                error.against_divergence().map(str::to_owned)
            }
            Self::Claim(ClaimError::NoSuchExperiment { kind, known, .. }) => {
                Some(format!("{kind}s: {}", known.join(", ")))
            }
            Self::Claim(ClaimError::NoPlace { block, .. }) => Some(format!(
                "put the lines <!-- validate {block} --> and <!-- /validate --> where the results are to stand"
            )),
            Self::Claim(ClaimError::Folder { .. }) => {
                Some("name another folder with --out".to_owned())
            }
            Self::Viewer(ViewerError::Listen { .. }) => {
                Some("name another port with --port, or leave it out to get a free one".to_owned())
            }
            Self::Claim(ClaimError::Format(_) | ClaimError::Figure(_)) => {
                Some("nothing that was finished is lost: mend the disk and call again".to_owned())
            }
            Self::Study(StudyError::OtherStudy { .. }) => {
                Some("name another folder with --store, or give the study its old `name`".to_owned())
            }
            Self::Study(StudyError::NoStore { .. }) => Some(
                "a store is the folder that `peristalsis study run FILE --store DIR` made".to_owned(),
            ),
            Self::Study(error) if error.is_closed() => Some(
                "nothing that was finished is lost: make the store writable for this user, or work in a copy of it"
                    .to_owned(),
            ),
            Self::Study(
                StudyError::Io { .. }
                | StudyError::Format(_)
                | StudyError::Index { .. }
                | StudyError::Run {
                    source: RunError::Format(_),
                    ..
                },
            ) => {
                Some("nothing that was finished is lost: mend the disk and call again".to_owned())
            }
            _ => None,
        }
    }

    /// Prints the error and answers the exit code.
    pub(crate) fn report(&self) -> ExitCode {
        let renderer = if std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none()
        {
            Renderer::styled()
        } else {
            Renderer::plain()
        };
        match self {
            Self::Configuration(error)
            | Self::Run(RunError::Configuration(error))
            | Self::Study(StudyError::Configuration(error)) => {
                for problem in error.problems() {
                    say(&format!("{}\n", renderer.render(&[of_problem(problem)])));
                }
            }
            other => {
                let (message, help) = (other.to_string(), other.help());
                say(&renderer.render(&[with_help(
                    Group::with_title(Level::ERROR.primary_title(&message)),
                    help.as_deref(),
                )]));
            }
        }
        ExitCode::from(self.exit_code())
    }
}

/// What to do about a state that cannot be gone on with.
fn of_state(path: &Path, source: &RunError) -> String {
    let remedy = match source {
        RunError::Format(
            FormatError::CheckpointVersion { .. }
            | FormatError::CheckpointLayout { .. }
            | FormatError::OtherPhysicsVersion { .. },
        ) => "go on with the program that wrote it",
        RunError::Format(FormatError::OtherPhysics { .. } | FormatError::CheckpointKind { .. }) => {
            "put back the config.toml that it was begun with"
        }
        _ => "put the file back from a copy",
    };
    let configuration = path.with_file_name("config.toml");
    format!(
        "{remedy}, or begin anew in another folder: peristalsis run {} --out DIR",
        configuration.display()
    )
}

/// A problem of a configuration with its places marked in the text.
fn of_problem(problem: &Problem) -> Group<'_> {
    let main = problem.labels.first();
    let place = main.map_or_else(String::new, |label| format!("{label}: "));
    let mut group =
        Group::with_title(Level::ERROR.primary_title(format!("{place}{}", problem.message)));
    if let Some(main) = main {
        // A snippet shows one text; places in others are in the message already.
        let marked = problem
            .labels
            .iter()
            .filter(|label| label.source_name == main.source_name);
        group = group.element(
            Snippet::source(&*main.source_text)
                .path(&*main.source_name)
                .annotations(marked.enumerate().map(|(index, label)| {
                    let kind = if index == 0 {
                        AnnotationKind::Primary
                    } else {
                        AnnotationKind::Context
                    };
                    kind.span(label.span.clone()).label(&label.message)
                })),
        );
    }
    with_help(group, problem.help.as_deref())
}

fn with_help<'a>(group: Group<'a>, help: Option<&'a str>) -> Group<'a> {
    match help {
        Some(help) => group.element(Level::HELP.message(help)),
        None => group,
    }
}

/// Prints a line on standard error; where nobody reads it, it is lost, which no run should end for.
pub(crate) fn say(text: &str) {
    drop(writeln!(std::io::stderr().lock(), "{text}"));
}
