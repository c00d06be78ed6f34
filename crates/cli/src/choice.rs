//! Options of which each value has a name: tables of the values that the crates below know.

use clap::builder::{PossibleValue, PossibleValuesParser, StringValueParser, TypedValueParser};
use peristalsis_run::Field::{
    AngularVelocity, AxialDisplacement, AxialVelocity, Coordination, Diameter, Position, Pressure,
    Speed,
};
use peristalsis_run::FilmFormat::{Apng, Gif, Mp4, Webm};
use peristalsis_run::TrajectoryFormat::{Gsd, Lammps, Vtp};
use peristalsis_run::{Aspect, Eye, Field, FilmFormat, Paper, Place, TrajectoryFormat, WallLook};

/// A value of an option: its name, the value itself, and its meaning in a few words.
pub type Choice<T> = (&'static str, T, &'static str);

/// From where a tube is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum View {
    /// From the side.
    Side,
    /// Cut across, along the axis.
    Section,
    /// No picture of the tube: the flow rate of each wave against time.
    SpaceTime,
}

/// From where a tube is looked at.
pub const VIEWS: &[Choice<View>] = &[
    ("side", View::Side, "from the side"),
    ("section", View::Section, "cut across, along the axis"),
    (
        "space-time",
        View::SpaceTime,
        "flow rate of each wave against time",
    ),
];

impl View {
    /// How the tube is drawn; a section is at `middle` unless it has a place or a position.
    pub fn aspect(self, place: Option<f64>, position: Option<f64>, middle: f64) -> Aspect {
        match (self, position) {
            (Self::Section, Some(position)) => Aspect::Section(Place::Position(position)),
            (Self::Section, None) => Aspect::Section(Place::At(place.unwrap_or(middle))),
            _ => Aspect::Side,
        }
    }

    /// Pixels across of a picture, or of a film.
    pub fn usual_width(self, is_film: bool) -> u32 {
        let of_side = if is_film { 960 } else { 2400 };
        if self == Self::Section {
            of_side / 2
        } else {
            of_side
        }
    }
}

/// What is made of a view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Format {
    Png,
    Svg,
    Film(FilmFormat),
}

impl Format {
    /// The format of the files that end so.
    pub(crate) fn by_ending(ending: &str) -> Option<Self> {
        value_of(FORMATS, &ending.to_ascii_lowercase())
    }

    pub(crate) fn film(self) -> Option<FilmFormat> {
        match self {
            Self::Film(film) => Some(film),
            Self::Png | Self::Svg => None,
        }
    }

    pub(crate) fn extension(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Svg => "svg",
            Self::Film(film) => film.extension(),
        }
    }
}

pub(crate) const FORMATS: &[Choice<Format>] = &[
    ("png", Format::Png, "picture"),
    ("svg", Format::Svg, "picture with its writing as vectors"),
    ("gif", Format::Film(Gif), "film that plays everywhere"),
    ("apng", Format::Film(Apng), ANIMATED),
    ("mp4", Format::Film(Mp4), "film; needs ffmpeg"),
    ("webm", Format::Film(Webm), "film; needs ffmpeg"),
];
const ANIMATED: &str = "film as animated PNG, in every colour";

/// What the grains are coloured by.
pub const FIELDS: &[Choice<Field>] = &[
    ("axial-velocity", AxialVelocity, BY_VELOCITY),
    ("speed", Speed, "|v|/c"),
    ("diameter", Diameter, "d_i"),
    ("axial-displacement", AxialDisplacement, BY_DISPLACEMENT),
    ("angular-velocity", AngularVelocity, BY_ROTATION),
    ("position", Position, "(z - c t)/lambda"),
    ("coordination", Coordination, "spheres that a grain touches"),
    ("pressure", Pressure, BY_PRESSURE),
];
const BY_VELOCITY: &str = "v_z/c: blue against the wave, white at rest, red along it";
const BY_DISPLACEMENT: &str = "displacement along the wave since the first frame, in wavelengths";
const BY_ROTATION: &str = "speed of the surface by rotation, in c";
const BY_PRESSURE: &str = "mean normal stress by the forces of contacts; not from a trajectory";

/// How the wall looks from the side.
pub const WALLS: &[Choice<WallLook>] = &[
    ("cut", WallLook::Cut, "cut open"),
    ("glass", WallLook::Glass, "its front of glass"),
    ("none", WallLook::Hidden, "not drawn"),
];

/// What stands still.
pub(crate) const EYES: &[Choice<Eye>] = &[
    ("tube", Eye::Laboratory, "the tube"),
    ("wave", Eye::Wave, "the wave"),
];

/// The page.
pub const PAPERS: &[Choice<Paper>] = &[
    ("light", Paper::Light, "white"),
    ("dark", Paper::Dark, "nearly black"),
];

/// Formats of trajectories; the help of their options names them.
pub(crate) const TRAJECTORIES: &[Choice<TrajectoryFormat>] = &[
    ("gsd", Gsd, GENERAL),
    ("vtp", Vtp, "VTK polydata with contacts: ParaView, PyVista"),
    ("lammps", Lammps, "LAMMPS dump text: OVITO, VMD"),
];
const GENERAL: &str = "General Simulation Data: OVITO, freud, Python's gsd";

/// The names of all choices, as a list in a text.
pub(crate) fn names<T>(choices: &[Choice<T>]) -> String {
    let names: Vec<&str> = choices.iter().map(|(name, ..)| *name).collect();
    names.join(", ")
}

/// The value of a name, if it is one.
pub fn value_of<T: Copy>(choices: &[Choice<T>], name: &str) -> Option<T> {
    let known = choices.iter().find(|(known, ..)| *known == name);
    known.map(|(_, value, _)| *value)
}

/// The parser of an option that takes one of these values by its name.
pub(crate) fn one_of<T: Copy + Send + Sync + 'static>(
    choices: &'static [Choice<T>],
) -> impl TypedValueParser<Value = T> {
    let names = choices.iter();
    let names = names.map(|(name, _, meaning)| PossibleValue::new(*name).help(*meaning));
    PossibleValuesParser::new(names)
        .map(|name| value_of(choices, &name).expect("only known names are parsed"))
}

/// Any text. Shells offer these names; whoever looks the name up refuses an unknown one.
#[derive(Clone)]
pub(crate) struct Offered(pub(crate) Vec<&'static str>);

impl TypedValueParser for Offered {
    type Value = String;

    fn parse_ref(
        &self,
        command: &clap::Command,
        argument: Option<&clap::Arg>,
        value: &std::ffi::OsStr,
    ) -> Result<String, clap::Error> {
        StringValueParser::new().parse_ref(command, argument, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(self.0.iter().copied().map(PossibleValue::new)))
    }
}
