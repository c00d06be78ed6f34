//! Errors as a person reads them, and the exit code that goes with each.

use std::io::{ErrorKind, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};
use peristalsis_configuration::{ConfigurationError, Problem};
use peristalsis_engine::EngineError;
use peristalsis_formats::{FormatError, shell_word};
use peristalsis_reproduce::ReproduceError;
use peristalsis_run::{RenderError, RunError, RunFolder, files};
use peristalsis_study::{SEAL, StudyError};
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
    /// A configuration that cannot begin, such as one of more grains than the tube holds.
    #[error("{place}: {error}")]
    CannotBegin {
        /// Where the key is given, as `file:line: text` or the override.
        place: String,
        error: RunError,
    },
    /// The run or its record.
    #[error(transparent)]
    Run(#[from] RunError),
    /// A frame of a run's trajectory cannot be written.
    #[error("the run was stopped, since its trajectory cannot be written: {source}")]
    Trajectory {
        folder: PathBuf,
        source: RunError,
        /// Whether all else could be written.
        is_saved: bool,
    },
    /// What a run has found cannot be written.
    #[error("{source}")]
    Results { folder: RunFolder, source: RunError },
    /// A study or its store.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// Claims, textbook cases or the report of them.
    #[error(transparent)]
    Claim(ReproduceError),
    /// Published rows that differ from their runs computed again.
    #[error("{message}")]
    OtherRows { message: String },
    /// The viewer.
    #[error(transparent)]
    Viewer(ViewerError),
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
/// Exit code for a published row that differs from its run computed again.
const OTHER_ROWS: u8 = 3;

impl From<ReproduceError> for Failure {
    fn from(error: ReproduceError) -> Self {
        match error {
            // A study says the same whoever asked for it.
            ReproduceError::Study(error) => Self::Study(error),
            other => Self::Claim(other),
        }
    }
}

impl From<ViewerError> for Failure {
    fn from(error: ViewerError) -> Self {
        match error {
            ViewerError::Study(error) => Self::Study(error),
            other => Self::Viewer(other),
        }
    }
}

impl Failure {
    /// A file that cannot be read.
    pub(crate) fn read(path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::Read { path, source }
    }

    /// A file that cannot be written.
    pub(crate) fn write(path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::Write { path, source }
    }

    /// A command line that asks for something that does not exist, and what to ask for instead.
    pub(crate) fn usage(message: impl Into<String>, help: impl Into<String>) -> Self {
        Self::Usage {
            message: message.into(),
            help: help.into(),
        }
    }

    /// The exit code, and what to do.
    fn advice(&self) -> Advice {
        match self {
            Self::Configuration(_) => (BAD_INPUT, None),
            Self::Read { .. } => wrong(
                "FILE is a text file in TOML, UTF-8; `peristalsis presets frictionless` prints one",
            ),
            Self::Usage { help, .. } => wrong(help),
            Self::CannotBegin { error, .. } => of_run(error),
            Self::Run(error) => of_run(error),
            Self::Trajectory {
                source: RunError::Format(FormatError::NotATrajectory { .. }),
                ..
            } => failed(FOREIGN_FRAMES),
            Self::Trajectory { folder, is_saved, .. } => failed(format!(
                "{}: make room, then go on with: peristalsis run --resume {}",
                match is_saved {
                    true => "nothing that was measured is lost",
                    false => "what could not be saved either is computed again",
                },
                shell_word(folder)
            )),
            Self::Results { folder, source: RunError::Format(error) } if !is_closed(error) => {
                failed(unwritten(folder))
            }
            Self::Results { source, .. } => of_run(source),
            Self::Study(error) => of_study(error),
            Self::Claim(error) => of_claim(error),
            Self::OtherRows { .. } => (
                OTHER_ROWS,
                Some(
                    "either the tables were changed, or this program computes something else than the one that made them; \
                     the report says which rows these are"
                        .to_owned(),
                ),
            ),
            Self::Viewer(ViewerError::Listen { .. }) => {
                failed("name another port with --port, or leave it out to get a free one")
            }
            Self::Viewer(
                ViewerError::Trajectory(_)
                | ViewerError::ForeignTrajectory { .. }
                | ViewerError::NotRows { .. }
                | ViewerError::Claims { .. },
            ) => (BAD_INPUT, None),
            Self::Write { .. } | Self::Viewer(_) | Self::Signals(_) | Self::Output(_) => {
                (FAILED, None)
            }
        }
    }

    /// Prints the error and answers the exit code.
    pub(crate) fn report(&self) -> ExitCode {
        let is_styled = std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none();
        let renderer = match is_styled {
            true => Renderer::styled(),
            false => Renderer::plain(),
        };
        let (code, help) = self.advice();
        match self {
            Self::Configuration(error)
            | Self::Run(RunError::Configuration(error))
            | Self::Study(StudyError::Configuration(error)) => {
                let (problems, more) = error.shown();
                for problem in problems {
                    say(&format!("{}\n", renderer.render(&[of_problem(problem)])));
                }
                more.iter().for_each(|more| say(more));
            }
            other => {
                let message = other.to_string();
                let group = Group::with_title(Level::ERROR.primary_title(&message));
                say(&renderer.render(&[with_help(group, help.as_deref())]));
            }
        }
        ExitCode::from(code)
    }
}

/// An exit code, and what to do.
type Advice = (u8, Option<String>);

fn wrong(help: impl Into<String>) -> Advice {
    (BAD_INPUT, Some(help.into()))
}

fn failed(help: impl Into<String>) -> Advice {
    (FAILED, Some(help.into()))
}

const FEWER_GRAINS: &str = "take fewer grains (grains.number, grains.volume_fraction, grains.number_density) or a wider \
                            tube (drive.width, tube.radius)";
const FOREIGN_FRAMES: &str = "put its files back, or go on without: move the folder's trajectory.toml and trajectory files away";
const MEND: &str = "nothing that was finished is lost: mend the disk and call again";

/// Whether the place cannot be written to by this user.
fn is_closed(error: &FormatError) -> bool {
    matches!(error, FormatError::Io { source, .. } if peristalsis_formats::is_closed(source))
}

/// Whether there is no room for what is to be written.
fn is_full(kind: ErrorKind) -> bool {
    matches!(
        kind,
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded | ErrorKind::FileTooLarge
    )
}

/// What to do about results that could not all be written.
fn unwritten(folder: &RunFolder) -> String {
    let path = shell_word(folder.path());
    if !folder.path().exists() {
        return "its folder is gone, and what was in it: begin anew".to_owned();
    }
    let state = folder.state();
    match state.is_ok_and(|run| folder.has_final_results_of(&run)) {
        true => format!(
            "the tables are there: make room, then draw the figures with: peristalsis figures {path}"
        ),
        false => format!(
            "make room, then go on from the last saved state with: peristalsis run --resume {path}"
        ),
    }
}

fn of_run(error: &RunError) -> Advice {
    match error {
        RunError::HoldsAnotherRun { .. } => {
            wrong("name another folder with --out, or go on with that run with --resume")
        }
        RunError::AtWork { .. } => wrong(
            "wait until it ends or stop it; `peristalsis run DIR/config.toml --out OTHER` begins anew in another folder",
        ),
        RunError::State { path, source } => wrong(of_state(path, source)),
        RunError::Trajectory { help, .. } => wrong(*help),
        RunError::Picture { help, .. } => wrong(help),
        RunError::Render(RenderError::NoFfmpeg { .. }) => wrong(
            "install ffmpeg or name it in the variable FFMPEG, or take a film that needs none: --format gif, --format apng",
        ),
        RunError::Format(FormatError::UnreadableTrajectory { .. }) => wrong(
            "name a GSD trajectory that this program wrote, or let the frames be computed: --from state, --from start",
        ),
        RunError::Format(FormatError::NotATrajectory { .. }) => wrong(FOREIGN_FRAMES),
        RunError::Format(error) if is_closed(error) => wrong(
            "make the folder writable for this user, or name another with --out (a run begins there anew: peristalsis run \
             DIR/config.toml --out OTHER)",
        ),
        RunError::TooShort { .. } => wrong(
            "ask for at least as much with --periods or --duration, or begin anew in another folder: peristalsis run \
             DIR/config.toml --set run.periods=N --out OTHER",
        ),
        RunError::Complete { folder } if folder.is_file() => wrong(format!(
            "let it go on: peristalsis run --resume {} --periods N (or --duration T), N beyond its end",
            shell_word(folder)
        )),
        RunError::Complete { folder } => wrong(format!(
            "let it go on: peristalsis run --resume {0} --periods N (or --duration T), N beyond its end; draw its figures \
             again: peristalsis figures {0}",
            shell_word(folder)
        )),
        RunError::TooManyGrains { .. } | RunError::Engine(EngineError::DoesNotFit { .. }) => {
            wrong(FEWER_GRAINS)
        }
        RunError::Engine(EngineError::NotSettled { .. }) => failed(
            "close the throat (drive.width), lower what pushes the grains along the tube (drive.body_force, the \
             back_pressure of a design, body.gravity), or begin with initial.state = \"rest\". With [units] see whether \
             `check` with that start says the gravity that you mean (units.acceleration gives it in m/s^2), and take a larger \
             stiffness where weight crushes the grains",
        ),
        RunError::NoMemory { .. } => wrong(
            "take fewer waves (tube.waves) or grains (grains.number), or give the program more memory (`ulimit -v`)",
        ),
        RunError::NoRun { folder, .. } | RunError::NothingToResume { folder, .. }
            if folder.join(files::CONFIGURATION).is_file() =>
        {
            let keeps_none = match folder.join(SEAL).is_file() {
                true => "a store keeps no state of a finished run; ",
                false => "",
            };
            wrong(format!(
                "{keeps_none}begin it anew in another folder: peristalsis run {} --out DIR",
                shell_word(&folder.join(files::CONFIGURATION))
            ))
        }
        RunError::NoRun { .. } | RunError::NothingToResume { .. } => wrong(
            "name the folder of a run, or its state.checkpoint; `peristalsis runs DIR` lists those below a folder",
        ),
        RunError::Folder { .. }
        | RunError::Render(RenderError::Speed { .. })
        | RunError::Configuration(_)
        | RunError::NotPlaced
        | RunError::Engine(EngineError::InvalidParameter { .. }) => (BAD_INPUT, None),
        RunError::Format(FormatError::Io { source, .. }) if is_full(source.kind()) => failed(
            "make room on the disk, and call again; a run without a saved state begins anew in another folder (--out)",
        ),
        _ => (FAILED, error.against_divergence().map(str::to_owned)),
    }
}

fn of_study(error: &StudyError) -> Advice {
    match error {
        StudyError::OtherStudy { .. } => {
            wrong("name another folder with --store, or give the study its old `name`")
        }
        StudyError::NoStore { .. } => {
            wrong("a store is the folder that `peristalsis study run FILE --store DIR` made")
        }
        StudyError::Configuration(_)
        | StudyError::Read { .. }
        | StudyError::NoSuchRun { .. }
        | StudyError::NotRows { .. } => (BAD_INPUT, None),
        StudyError::Trial { source, .. } => (BAD_INPUT, of_run(source).1),
        error if error.is_closed() => failed(
            "nothing that was finished is lost: make the store writable for this user, or the folder that is named; or take \
             another folder, such as a copy of the store",
        ),
        StudyError::Format(FormatError::Io { source, .. })
            if matches!(
                source.kind(),
                ErrorKind::NotADirectory | ErrorKind::AlreadyExists
            ) =>
        {
            wrong("a file has the name of a folder: name another")
        }
        StudyError::Format(FormatError::Io { source, .. })
            if source.kind() == ErrorKind::InvalidFilename =>
        {
            wrong("take a folder with a shorter path")
        }
        StudyError::Format(_)
        | StudyError::Index { .. }
        | StudyError::Run {
            source: RunError::Format(_),
            ..
        } => failed(MEND),
        _ => (FAILED, None),
    }
}

fn of_claim(error: &ReproduceError) -> Advice {
    match error {
        ReproduceError::NoSuchExperiment { kind, known, .. } => {
            wrong(format!("{kind}s: {}", known.join(", ")))
        }
        ReproduceError::NoPlace { block, .. } => wrong(format!(
            "put the lines <!-- validate {block} --> and <!-- /validate --> where the results are to stand"
        )),
        ReproduceError::Folder { .. } => wrong("name another folder with --out"),
        ReproduceError::Read { .. } => (BAD_INPUT, None),
        ReproduceError::Format(_) | ReproduceError::Figure(_) => failed(MEND),
        _ => (FAILED, None),
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
    let configuration = path.with_file_name(files::CONFIGURATION);
    if !configuration.is_file() {
        return remedy.to_owned();
    }
    let again = format!("peristalsis run {} --out DIR", shell_word(&configuration));
    format!("{remedy}, or begin anew in another folder: {again}")
}

/// A problem of a configuration with its places marked in the text.
fn of_problem(problem: &Problem) -> Group<'_> {
    // The snippet names the place.
    let mut group = Group::with_title(Level::ERROR.primary_title(&problem.message));
    if let Some(main) = problem.labels.first() {
        // A snippet shows one text; places in others are in the message already.
        let labels = problem.labels.iter();
        let marked = labels.filter(|label| label.source_name == main.source_name);
        group = group.element(
            Snippet::source(&*main.source_text)
                .path(&*main.source_name)
                .annotations(marked.enumerate().map(|(index, label)| {
                    let kind = match index {
                        0 => AnnotationKind::Primary,
                        _ => AnnotationKind::Context,
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
