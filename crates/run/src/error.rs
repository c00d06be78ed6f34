//! Errors of a run.

use std::path::{Path, PathBuf};

use peristalsis_analysis::number;
use peristalsis_engine::EngineError;

/// Errors of a run and its record.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RunError {
    /// The engine refuses, or the run diverged.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// Too many grains: packing them is not tried.
    #[error(
        "{grains} grains do not fit: their volume fraction would be {volume_fraction:.3}, and above {limit} packing is \
         not tried"
    )]
    TooManyGrains {
        /// Number of grains.
        grains: u64,
        /// rho = N d^3/(6 a^2 L), d^3 averaged over the diameters.
        volume_fraction: f64,
        /// Largest volume fraction that is tried.
        limit: f64,
    },
    /// Too many spheres for the memory.
    #[error("a run of {spheres} moving spheres takes up to some {} of memory, which the system does not give", number::bytes(*bytes as f64))]
    NoMemory {
        /// Grains, and spheres of an elastic wall.
        spheres: u64,
        /// Memory that the run takes at most, about.
        bytes: u64,
    },
    /// The configuration of a record cannot be read.
    #[error(transparent)]
    Configuration(#[from] peristalsis_configuration::ConfigurationError),
    /// The folder holds another run.
    #[error("{} holds another run, or files that one would write over ({found}): nothing was changed", folder.display())]
    HoldsAnotherRun {
        /// The folder.
        folder: PathBuf,
        /// The file that shows it.
        found: String,
    },
    /// Another program works on the run.
    #[error("{} is being worked on by another program", folder.display())]
    AtWork {
        /// Its folder.
        folder: PathBuf,
    },
    /// The folder cannot be made or written to.
    #[error("cannot write to {}: {source}", folder.display())]
    Folder {
        /// The folder.
        folder: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A trajectory that cannot be written as asked.
    #[error("cannot take these frames: {reason}")]
    Trajectory {
        /// Why.
        reason: String,
        /// What to ask for instead.
        help: &'static str,
    },
    /// Grains cannot stand where they were put.
    #[error("the grains cannot be placed so: {reason}")]
    Placement {
        /// Why.
        reason: String,
    },
    /// A configuration with `initial.state = "placed"`: it does not say where the grains stand.
    #[error(
        "initial.state is \"placed\": a caller of the library has put the grains somewhere, which a configuration does not \
         say; go on from a checkpoint of that run, or take \"rest\" or \"jammed\""
    )]
    NotPlaced,
    /// The drive cannot follow the course that was asked for.
    #[error("cannot drive the run so: {reason}")]
    Steering {
        /// Why.
        reason: String,
    },
    /// A picture or film that cannot be made as asked.
    #[error("no such picture: {reason}")]
    Picture {
        /// Why.
        reason: String,
        /// What to ask for instead.
        help: String,
    },
    /// A folder lacks a part of a run.
    #[error("{} holds no run that is whole: {reason}", folder.display())]
    NoRun {
        /// The folder.
        folder: PathBuf,
        /// The missing part.
        reason: String,
    },
    /// A run cannot go on.
    #[error("{} holds no run that can be continued: {reason}", folder.display())]
    NothingToResume {
        /// The folder.
        folder: PathBuf,
        /// Why not.
        reason: String,
    },
    /// A run has gone as far as it was to go.
    #[error("{} holds no run that can be continued: it is complete", folder.display())]
    Complete {
        /// The folder.
        folder: PathBuf,
    },
    /// A run has gone further than it is asked to go.
    #[error("the run has done {} {unit} already, and the length asked for, in whole samples, is {}", (1e6 * done).round() / 1e6, (1e6 * asked).round() / 1e6)]
    TooShort {
        /// How much is done.
        done: f64,
        /// How much is asked for.
        asked: f64,
        /// Periods, or units of time where the wave stands still.
        unit: &'static str,
    },
    /// The saved state of a run cannot be gone on with.
    #[error("{} cannot be continued: {source}", path.display())]
    State {
        /// The file.
        path: PathBuf,
        /// Why.
        source: Box<RunError>,
    },
    /// A file cannot be written or read.
    #[error(transparent)]
    Format(#[from] peristalsis_formats::FormatError),
    /// A picture cannot be made.
    #[error(transparent)]
    Render(#[from] peristalsis_render::RenderError),
    /// A figure cannot be drawn.
    #[error("cannot draw {figure}: {source}")]
    Figure {
        /// Name of the figure.
        figure: &'static str,
        /// Why.
        source: peristalsis_figures::FigureError,
    },
}

impl RunError {
    /// The error of a figure of this name.
    pub fn of_figure(
        figure: &'static str,
    ) -> impl FnOnce(peristalsis_figures::FigureError) -> Self {
        move |source| Self::Figure { figure, source }
    }

    /// [`RunError::HoldsAnotherRun`] where a folder has a file of one of these names.
    pub(crate) fn if_one_is_in(folder: &Path, names: &[&str]) -> Result<(), Self> {
        let is_there = |name: &&&str| folder.join(name).symlink_metadata().is_ok();
        names.iter().find(is_there).map_or(Ok(()), |found| {
            Err(Self::HoldsAnotherRun {
                folder: folder.to_owned(),
                found: (*found).to_owned(),
            })
        })
    }

    /// Whether it was asked to stop, by the question that [`Run::new_unless`](crate::Run::new_unless) takes.
    pub fn is_stop(&self) -> bool {
        matches!(self, Self::Engine(EngineError::Stopped))
    }

    /// Advice for a run that diverged; `None` for other errors.
    pub fn against_divergence(&self) -> Option<&'static str> {
        match self {
            Self::Engine(EngineError::Diverged { grain, grains, .. }) if grain >= grains => Some(
                "take a shorter run.time_step, heavier spheres of the wall (wall.sphere_mass), or less of what acts on them: \
                 wall.keep.axial and the other tethers, wall.drag, wall.spring_damping, wall.spring_stiffness, \
                 drive.force_amplitude",
            ),
            Self::Engine(EngineError::Diverged { outside: true, .. }) => Some(
                "it slipped through the wall and fell or flew on: take more wall spheres (tube.spheres_per_ring, \
                 tube.rings_per_wave), stiffer contacts, fewer or larger grains, or a shorter run.time_step",
            ),
            Self::Engine(EngineError::Diverged { .. }) => {
                Some("take a shorter run.time_step, or softer or fewer grains")
            }
            _ => None,
        }
    }
}
