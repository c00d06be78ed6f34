//! The options of `peristalsis render`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use peristalsis_run::{Eye, Field, Look, Paper, Span, WallLook, Window, Writing};

use crate::choice::{EYES, FIELDS, FORMATS, Format, PAPERS, VIEWS, View, WALLS, one_of};

/// Where instants are taken from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Origin {
    /// frames that were written in GSD
    Trajectory,
    /// the saved state, and the run from there on
    State,
    /// the run computed anew
    Start,
}

#[derive(Debug, Args)]
#[command(
    after_help = "A film shows a trajectory where there is one, or else the run computed anew; --from says otherwise. An \
                  interrupted film leaves no file."
)]
pub(crate) struct RenderArguments {
    /// Folder of a run, finished or stopped; only the picture is added to it.
    #[arg(value_name = "DIR")]
    pub(crate) folder: PathBuf,
    /// From where the tube is looked at.
    #[arg(long, value_name = "VIEW", value_parser = one_of(VIEWS), default_value = "side")]
    pub(crate) view: View,
    /// What the grains are coloured by; the default is axial-velocity.
    #[arg(long, value_name = "FIELD", value_parser = one_of(FIELDS), alias = "color")]
    pub(crate) colour: Option<Field>,
    /// Values of the first and the last colour; the default suits the field.
    #[arg(long, value_name = "FROM:TO", value_parser = range, allow_hyphen_values = true)]
    pub(crate) range: Option<(f64, f64)>,
    /// How the wall looks from the side; the default is cut.
    #[arg(long, value_name = "LOOK", value_parser = one_of(WALLS))]
    pub(crate) wall: Option<WallLook>,
    /// What stands still in a film from the side; the default is the tube.
    #[arg(long, value_name = "WHAT", value_parser = one_of(EYES))]
    pub(crate) eye: Option<Eye>,
    /// Place z of a section, in d; the default is the middle of the tube.
    #[arg(
        long,
        value_name = "Z",
        conflicts_with = "position",
        allow_negative_numbers = true
    )]
    pub(crate) place: Option<f64>,
    /// Place of a section as a position in the wave frame, (z - c t)/lambda: it moves with the wave.
    #[arg(long, value_name = "POSITION", allow_negative_numbers = true)]
    pub(crate) position: Option<f64>,
    /// Draw the contacts as lines, thick where the normal force is large, between smaller grains; not from a trajectory,
    /// which holds no forces.
    #[arg(long)]
    pub(crate) contacts: bool,
    /// Wavelengths that a side view shows at most; the default is 2.
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub(crate) waves: Option<f64>,
    /// Width in pixels, 16 to 16384; the default is 2400 for a picture, 960 for a film, and half of these for a section.
    #[arg(long, value_name = "PIXELS")]
    pub(crate) width: Option<u32>,
    /// The page; the default is light.
    #[arg(long, value_name = "PAPER", value_parser = one_of(PAPERS))]
    pub(crate) paper: Option<Paper>,
    /// No time, scale, marks or colours around the picture.
    #[arg(long)]
    pub(crate) bare: bool,
    /// Make a film, as GIF unless --format or the ending of --out says otherwise.
    #[arg(long)]
    pub(crate) film: bool,
    /// Format; the default follows from the ending of --out.
    #[arg(long, value_name = "FORMAT", value_parser = one_of(FORMATS))]
    pub(crate) format: Option<Format>,
    /// Where the frames come from.
    #[arg(long, value_name = "ORIGIN", value_enum)]
    pub(crate) from: Option<Origin>,
    /// GSD trajectory of this run; the default is DIR/trajectory.gsd.
    #[arg(long, value_name = "FILE")]
    pub(crate) trajectory: Option<PathBuf>,
    /// Instant of a picture, in periods of the run or, as in 40t, in time; the default is the last one.
    #[arg(long, value_name = "SPAN", allow_hyphen_values = true)]
    pub(crate) at: Option<Span>,
    /// Part of the run that a film shows, in periods or time: 20:25, 100:, :5t; the default is all.
    #[arg(long, value_name = "FROM:TO", allow_hyphen_values = true)]
    pub(crate) window: Option<Window>,
    /// How long a film goes on from the saved state, in periods or time; the default is two periods.
    #[arg(
        long,
        value_name = "SPAN",
        conflicts_with = "window",
        allow_hyphen_values = true
    )]
    pub(crate) duration: Option<Span>,
    /// Time between two frames of a film; the default is every frame of a trajectory, or else a twentieth of a period.
    #[arg(long, value_name = "SPAN", allow_hyphen_values = true)]
    pub(crate) every: Option<Span>,
    /// Frames per second of a film; the default is 20.
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub(crate) fps: Option<f64>,
    /// File for the picture or film; an older one is replaced. The default is DIR/tube-VIEW with the format's ending.
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
    /// Print what was made as JSON.
    #[arg(long)]
    pub(crate) json: bool,
    /// No progress on standard error.
    #[arg(long, short)]
    pub(crate) quiet: bool,
}

impl RenderArguments {
    /// How the tube is drawn; a section is at `middle` unless the arguments place it.
    pub(crate) fn look(&self, is_film: bool, middle: f64) -> Look {
        let plain = Look::default();
        let usual = self.view.usual_width(is_film);
        Look {
            aspect: self.view.aspect(self.place, self.position, middle),
            field: self.colour.unwrap_or(plain.field),
            range: self.range,
            wall: self.wall.unwrap_or(plain.wall),
            eye: self.eye.unwrap_or(plain.eye),
            waves: self.waves.unwrap_or(plain.waves),
            width: self.width.unwrap_or(usual),
            paper: self.paper.unwrap_or(plain.paper),
            writing: match self.bare {
                true => Writing::None,
                false => Writing::Full,
            },
            contacts: self.contacts,
        }
    }
}

/// Frames per second of a film, unless said otherwise.
pub(super) const FRAMES_PER_SECOND: f64 = 20.0;

fn range(text: &str) -> Result<(f64, f64), String> {
    let number = |text: &str| text.trim().parse::<f64>().ok().filter(|it| it.is_finite());
    text.split_once(':')
        .and_then(|(from, to)| Some((number(from)?, number(to)?)))
        .filter(|(from, to)| from < to)
        .ok_or_else(|| "two numbers FROM:TO with FROM less than TO, such as -0.5:0.5".to_owned())
}
