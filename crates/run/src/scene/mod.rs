//! The tube as it looks: pictures of single instants, with their scales and captions.

mod caption;
pub mod drawn;
mod field;
mod spheres;

use glam::DVec3;
use peristalsis_configuration::{Configuration, Elasticity};
use peristalsis_engine::Wall;
use peristalsis_figures::{ColourScale, Drawing, Paper, PictureFigure, Units, Width};
use peristalsis_formats::Frame;
use peristalsis_physics::contact::NormalLaw;
use peristalsis_render::{Colour, Picture, Scene, View, render};

use crate::error::RunError;
use crate::run::Run;

use self::caption::Caption;
pub(crate) use self::caption::instant;
use self::field::Coloured;
pub use self::field::Field;
use self::spheres::force_scale;

/// From where a tube is looked at; the wave always runs to the right, or towards the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Aspect {
    /// From the side.
    Side,
    /// Along the axis: a slice of the tube at a place.
    Section(Place),
}

/// Where a tube is cut across.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    /// At z \[d\].
    At(f64),
    /// At a position in the wave frame, (z - c t)/lambda with z along the wave, so that the cut moves with it.
    Position(f64),
}

/// How the wall looks from the side.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WallLook {
    /// Cut open: the half before the axis is taken away.
    #[default]
    Cut,
    /// Seen through: the half before the axis is of glass.
    Glass,
    /// Not drawn.
    Hidden,
}

/// What stands still in a picture of several instants.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Eye {
    /// The tube.
    #[default]
    Laboratory,
    /// The wave: the eye moves with it.
    Wave,
}

/// What is written around a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Writing {
    /// Time, flow rate, belly and throat, scale and colours.
    #[default]
    Full,
    /// Nothing: the bare picture.
    None,
}

/// How a tube is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// From where.
    pub aspect: Aspect,
    /// What colours the grains.
    pub field: Field,
    /// Values of the first and the last colour; unless given, values that suit the field.
    pub range: Option<(f64, f64)>,
    /// How the wall looks.
    pub wall: WallLook,
    /// What stands still.
    pub eye: Eye,
    /// Wavelengths that a side view shows at most.
    pub waves: f64,
    /// Pixels across.
    pub width: u32,
    /// The page.
    pub paper: Paper,
    /// What is written on it.
    pub writing: Writing,
    /// Whether the contacts are drawn, as thick as their normal force, between grains that are drawn smaller.
    pub contacts: bool,
}

impl Default for Look {
    fn default() -> Self {
        Self {
            aspect: Aspect::Side,
            field: Field::AxialVelocity,
            range: None,
            wall: WallLook::Cut,
            eye: Eye::Laboratory,
            waves: 2.0,
            width: 2400,
            paper: Paper::Light,
            writing: Writing::Full,
            contacts: false,
        }
    }
}

impl Look {
    /// Whether frames have to hold the contacts.
    pub fn needs_contacts(&self) -> bool {
        self.contacts || self.field == Field::Pressure
    }

    /// Whether values count from the first frame, so that a picture needs one before its own.
    pub fn counts_from_first(&self) -> bool {
        self.field == Field::AxialDisplacement
    }

    /// Refuses what shows nothing of a tube of a length \[d\].
    fn check(&self, length: f64) -> Result<(), RunError> {
        if !WIDTHS.contains(&self.width) {
            let reason = format!("a width of {} pixels is beyond reach", self.width);
            return Err(refused(&reason, "take 16 to 16384 pixels"));
        }
        if !(self.waves > 0.0 && self.waves.is_finite()) {
            let reason = format!("a view of {} waves shows nothing", self.waves);
            return Err(refused(&reason, "take a positive number of waves"));
        }
        if let Some((least, largest)) = self.range
            && !(least.is_finite() && largest.is_finite() && least < largest)
        {
            let reason = format!("the colours cannot go from {least} to {largest}");
            return Err(refused(&reason, "take FROM:TO with FROM less than TO"));
        }
        if let Aspect::Section(Place::At(z)) = self.aspect
            && !(0.0..length).contains(&z)
        {
            let reason = format!("there is no place z = {z} in this tube");
            return Err(refused(&reason, &format!("take 0 to {length} d")));
        }
        if let Aspect::Section(Place::Position(position)) = self.aspect
            && !position.is_finite()
        {
            let reason = format!("there is no position {position} in the wave");
            return Err(refused(
                &reason,
                "take a number of wavelengths, such as 0.25",
            ));
        }
        Ok(())
    }
}

/// A picture that cannot be, and what to ask for instead.
pub(crate) fn refused(reason: &str, help: &str) -> RunError {
    RunError::Picture {
        reason: reason.to_owned(),
        help: help.to_owned(),
    }
}

/// The units that follow from the law of contact.
pub(crate) fn units(configuration: &Configuration) -> Units {
    match configuration.contact.normal.elasticity() {
        Elasticity::Stiffness(_) => Units::Linear,
        Elasticity::YoungModulus(_) => Units::Hertz,
    }
}

/// White round the tube \[d\].
const MARGIN: f64 = 0.6;
/// Thickness of a section, in diameters of wall spheres.
const SECTION: f64 = 2.5;
/// How far an elastic wall is expected to open, in radii of the tube at rest.
const OPEN_RADII: f64 = 1.3;
/// Fewest and most pixels across.
const WIDTHS: std::ops::RangeInclusive<u32> = 16..=16_384;
/// Most pixels down: what narrow views of wide tubes come to.
const MOST_DOWN: f64 = 16_384.0;

/// Draws the tube of one run, instant by instant, always from the same place, on the same scale and in the same colours.
#[derive(Clone, Debug)]
pub struct PictureScene {
    look: Look,
    wall: Wall,
    units: Units,
    /// Period of the drive \[t\]; `None` where the wave stands still.
    period: Option<f64>,
    /// Direction of gravity across the tube; `None` without any there.
    down: Option<DVec3>,
    /// Gravity's part along the wave \[d/t^2\].
    along: f64,
    /// Distance from the axis that is shown \[d\].
    radius: f64,
    /// Length of the tube that is shown \[d\].
    shown: f64,
    coloured: Coloured,
    scale: ColourScale,
    /// Of the normal forces, where contacts are drawn.
    forces: Option<ColourScale>,
}

impl PictureScene {
    /// Prepares to draw a run. From `samples`, one instant at least, follow the room and the range of colours that all
    /// pictures share; displacements count from the first.
    ///
    /// # Errors
    /// [`RunError::Picture`] where the look is not possible for this run.
    pub fn new(run: &Run, look: Look, samples: &[Frame]) -> Result<Self, RunError> {
        let [first, ..] = samples else {
            return Err(refused("there is nothing to draw", "take a longer window"));
        };
        let wall = run.simulation().wall().clone();
        look.check(wall.length())?;
        let shown = wall.length().min(look.waves * wall.wavelength());
        let coloured = Coloured::new(look.field, run, samples)?;
        let scale = coloured.scale(look.range);
        let units = units(run.configuration());
        let forces = look.contacts.then(|| force_scale(samples, units));
        let scene = Self {
            look,
            units,
            period: run.configuration().drive.period(),
            down: down(run.configuration()),
            along: run.configuration().heading() * run.configuration().body.gravity[2],
            forces,
            radius: shown_radius(&wall, first, samples),
            wall,
            shown,
            coloured,
            scale,
        };
        let (_, down) = scene.size();
        if down > MOST_DOWN {
            let reason = format!("the picture would be {down:.0} pixels high");
            let help = "take fewer pixels across, or show more waves";
            return Err(refused(&reason, help));
        }
        Ok(scene)
    }

    /// Pixels a unit of length, and pixels down.
    fn size(&self) -> (f64, f64) {
        let width = f64::from(self.look.width);
        let across = 2.0 * (self.radius + MARGIN);
        match self.look.aspect {
            Aspect::Side => {
                let scale = width / (self.shown + 2.0 * MARGIN);
                (scale, (across * scale).round().max(1.0))
            }
            Aspect::Section(_) => (width / across, width),
        }
    }

    /// The picture of an instant, with the texts around it.
    ///
    /// # Errors
    /// [`RunError::Render`], [`RunError::Figure`] where it is too large for memory; [`RunError::Picture`] where the frame
    /// is not one of this run.
    pub fn draw(&self, frame: &Frame) -> Result<Drawing, RunError> {
        let picture = self.picture(frame)?;
        let caption = Caption::of(self, frame);
        let full = self.look.writing == Writing::Full;
        let scales: Vec<&ColourScale> = [&self.scale].into_iter().chain(&self.forces).collect();
        PictureFigure {
            title: &caption.title,
            pixels: picture.pixels(),
            columns: picture.width(),
            notes: if full { &caption.notes } else { &[] },
            marks: caption.marks.as_deref().filter(|_| full),
            scale_bar: full.then_some(&caption.scale_bar),
            colours: if full { &scales } else { &[] },
            paper: self.look.paper,
            width: match self.look.aspect {
                Aspect::Side => Width::DoubleColumn,
                Aspect::Section(_) => Width::SingleColumn,
            },
        }
        .draw()
        .map_err(RunError::of_figure("the picture"))
    }

    /// The bare picture of an instant.
    ///
    /// # Errors
    /// As [`PictureScene::draw`].
    pub fn picture(&self, frame: &Frame) -> Result<Picture, RunError> {
        let length = self.wall.length();
        if (frame.length - length).abs() > 1e-3 * length {
            let found = frame.length;
            let reason =
                format!("the frame is of a tube {found} d long, and that of the run is {length} d");
            return Err(refused(&reason, "name the trajectory of this run"));
        }
        let values = self.coloured.values(frame, &self.wall)?;
        let [red, green, blue] = self.look.paper.srgb();
        let scene = Scene {
            spheres: self.spheres(frame, &values),
            background: Colour::srgb(red, green, blue),
        };
        Ok(render(&scene, &self.view())?)
    }

    /// The view of what [`PictureScene::spheres`] places.
    fn view(&self) -> View {
        let (scale, height) = self.size();
        let along = self.wall.heading() * DVec3::Z;
        // As in a snapshot, where no gravity says what is up.
        let up = self.down.map_or(DVec3::Y, |down| -down);
        let (middle, right) = match self.look.aspect {
            Aspect::Side => (0.5 * self.shown, along),
            Aspect::Section(_) => (0.5 * self.wall.length(), up.cross(along)),
        };
        View {
            middle: DVec3::new(0.0, 0.0, middle),
            right,
            up,
            width: self.look.width,
            height: height as u32,
            scale,
        }
    }
}

/// Direction of gravity across the tube; `None` without any there.
fn down(configuration: &Configuration) -> Option<DVec3> {
    let [x, y, _] = configuration.body.gravity;
    DVec3::new(x, y, 0.0).try_normalize()
}

/// Distance from the axis that a picture shows: to the outer side of the widest wall.
fn shown_radius(wall: &Wall, first: &Frame, samples: &[Frame]) -> f64 {
    let half = 0.5 * wall.sphere_diameter();
    if wall.wave().is_some() {
        return wall.usual_radius() + half;
    }
    let spheres = samples
        .iter()
        .flat_map(|frame| frame.position.iter().skip(first.grains));
    let widest = spheres.map(|[x, y, _]| x.hypot(*y)).fold(0.0, f64::max);
    half + widest.max(OPEN_RADII * wall.mean_radius())
}
