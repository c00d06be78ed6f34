//! Grains in a part of the tube, seen from the side.

use crate::axis::extent;
use crate::chart::{Band, ChartFigure, ChartPanel, Line, Reference, Spheres, Tint};
use crate::colour_scale::{ColourScale, Palette};
use crate::drawing::Drawing;
use crate::error::{FigureError, finite, positive};
use crate::notation::decimal;
use crate::style::Width;

/// A sphere as the side view needs it, lengths in one unit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SnapshotSphere {
    /// Coordinate along the tube, drawn to the right.
    pub along: f64,
    /// Coordinate across the tube from its axis, drawn upwards.
    pub across: f64,
    /// Coordinate towards the viewer, from the plane through the axis.
    pub depth: f64,
    /// Diameter.
    pub diameter: f64,
}

/// A grain with its velocity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SnapshotGrain {
    /// Place and size.
    pub sphere: SnapshotSphere,
    /// Axial velocity over the wave speed, positive along the wave.
    pub axial_velocity: f64,
}

/// How the wall is drawn.
#[derive(Clone, Copy, Debug)]
pub enum SnapshotWall<'a> {
    /// The wall spheres within three quarters of a diameter of the plane through the tube's axis, as faint discs.
    Spheres(&'a [SnapshotSphere]),
    /// The radius of the wall at places along the tube as two curves, and its spheres inside of it as a band.
    Outline {
        /// Places along the tube.
        along: &'a [f64],
        /// Radius at each, to the centres of the wall spheres.
        radius: &'a [f64],
        /// Half a wall sphere: how far the wall reaches inside of its radius.
        thickness: f64,
    },
}

/// Side view of a part of a tube: grains coloured by their axial velocity over the wave speed, blue against the
/// wave, white at rest and red along it.
#[derive(Clone, Copy, Debug)]
pub struct Snapshot<'a> {
    /// Line above the snapshot, in markup; none if empty.
    pub label: &'a str,
    /// The grains; those outside of the part are not drawn.
    pub grains: &'a [SnapshotGrain],
    /// The wall.
    pub wall: SnapshotWall<'a>,
    /// Length of the part from the tube's beginning.
    pub length: f64,
    /// Length of the tube.
    pub tube: f64,
    /// Place of the outlet of an open tube. A periodic tube has none, and spheres also show where their images lie in the part.
    pub outlet: Option<f64>,
    /// Wavelength, so that a part can say how many of the tube's waves it shows.
    pub wavelength: f64,
}

/// Snapshots above each other, for instance unjammed flow above jammed, with one scale of length and one of velocity; a
/// long part is broken into rows that read like lines of text.
#[derive(Clone, Copy, Debug)]
pub struct SnapshotFigure<'a> {
    /// Line above the figure, in markup; none if empty.
    pub title: &'a str,
    /// The snapshots from top to bottom.
    pub snapshots: &'a [Snapshot<'a>],
    /// Name of the axis along the tube, in markup.
    pub axis: &'a str,
    /// Name of the axial velocities with their unit, in markup.
    pub velocity: &'a str,
    /// Width of the figure.
    pub width: Width,
}

/// A mean grain is drawn no smaller than this across, in points, as long as the page allows.
const LEAST_GRAIN: f64 = 7.5;
/// Height of a picture over its width, at most: of grains that are too small for it rows are longer.
const MOST_HEIGHT: f64 = 5.0;
/// A row is never shorter than this many grain diameters.
const SHORTEST_ROW: f64 = 10.0;
/// About the space beside a row, in points.
const BESIDE: f64 = 40.0;
/// Free space above and below the outermost sphere, as a fraction of the half height of a row.
const MARGIN: f64 = 0.06;
/// Least half height of a row as a part of its length: two numbers stand beside it.
const LEAST_REACH: f64 = 0.02;
/// Greatest distance of a drawn wall sphere from the plane of the cut, in diameters: half a diameter would leave gaps
/// where the wall is stretched.
const SLICE: f64 = 0.75;
/// Axial velocity, over the wave speed, of the deepest colours.
const DEEPEST: f64 = 1.0;

impl SnapshotFigure<'_> {
    /// Lays the figure out.
    ///
    /// # Errors
    /// If there is no snapshot, if a length or a diameter is not positive, if a coordinate or velocity is not finite, or if
    /// a snapshot has neither a grain nor a wall.
    pub fn draw(&self) -> Result<Drawing, FigureError> {
        let (series, length) = ("snapshots".to_owned(), 0);
        let empty = FigureError::EmptySeries { series, length };
        let parts = self.snapshots.iter().map(Part::of);
        let parts: Vec<Part<'_>> = parts.collect::<Result<_, _>>()?;
        let (_, reach) = extent(parts.iter().map(Part::reach));
        if parts.is_empty() || reach <= 0.0 {
            return Err(empty);
        }
        let (diameter, _) = extent(parts.iter().map(Part::diameter));
        let (_, longest) = extent(parts.iter().map(|part| part.snapshot.length));
        let row = row_length(longest, self.width.points() - BESIDE, diameter, reach);
        let reach = reach.max(LEAST_REACH * row);
        let extents: Vec<String> = self.snapshots.iter().map(Snapshot::extent).collect();
        let is_one_extent = extents.windows(2).all(|pair| pair[0] == pair[1]);
        let mut panels = Vec::new();
        for (index, part) in parts.iter().enumerate() {
            let own_extent = if is_one_extent { "" } else { &extents[index] };
            let header = with_extent(part.snapshot.label, own_extent);
            let rows = (part.snapshot.length / row - 1e-9).ceil().max(1.0) as usize;
            for number in 0..rows {
                let is_last = index + 1 == parts.len() && number + 1 == rows;
                let common_extent = if is_one_extent { &*extents[0] } else { "" };
                let name = is_last.then(|| with_extent(self.axis, common_extent));
                let title = if number == 0 { &*header } else { "" };
                let from = row * number as f64;
                let panel = ChartPanel::new(&name.unwrap_or_default(), "*y*/*d*")
                    .title(title)
                    .x_range(from..=from + row)
                    .y_range(-reach * (1.0 + MARGIN)..=reach * (1.0 + MARGIN));
                panels.push(part.add_to(panel, (from, from + row)));
            }
        }
        let grains = self.snapshots.iter().flat_map(|snapshot| snapshot.grains);
        let (least, largest) = extent(grains.map(|grain| grain.axial_velocity));
        let scale = ColourScale::new(self.velocity, -DEEPEST, DEEPEST)
            .palette(Palette::Diverging)
            .found(least, largest);
        ChartFigure::grid(1, panels)
            .title(self.title)
            .description("The tube from the side, its grains coloured by their axial velocity.")
            .width(self.width)
            .equal_scales()
            .colour_scale(scale)
            .draw()
    }
}

impl Snapshot<'_> {
    /// How much of the tube is shown, in markup; nothing where it is all of it.
    fn extent(&self) -> String {
        if self.length >= self.tube * (1.0 - 1e-9) {
            return String::new();
        }
        let number = |length: f64| {
            let number = decimal(length / self.wavelength, 1);
            number.strip_suffix(".0").unwrap_or(&number).to_owned()
        };
        if self.length < 0.1 * self.wavelength {
            let [shown, all] = [self.length, self.tube].map(|length| decimal(length, 0));
            return format!("{shown} of {all} *d* shown");
        }
        let [shown, all] = [self.length, self.tube].map(number);
        format!("{shown} of {all} waves shown")
    }
}

fn with_extent(name: &str, extent: &str) -> String {
    match extent {
        "" => name.to_owned(),
        extent => format!("{name}  ({extent})"),
    }
}

/// A snapshot, checked and in the order of drawing.
struct Part<'a> {
    snapshot: &'a Snapshot<'a>,
    /// From the furthest to the nearest.
    grains: Vec<SnapshotGrain>,
    /// Those of the wall in the cut.
    spheres: Vec<SnapshotSphere>,
}

impl<'a> Part<'a> {
    fn of(snapshot: &'a Snapshot<'a>) -> Result<Self, FigureError> {
        positive("length of the snapshot", snapshot.length)?;
        positive("length of the tube", snapshot.tube)?;
        positive("wavelength", snapshot.wavelength)?;
        let mut grains = snapshot.grains.to_vec();
        for (index, grain) in grains.iter().enumerate() {
            check_sphere("grains", index, &grain.sphere)?;
            finite("axial velocity of a grain", grain.axial_velocity)?;
        }
        if let Some(outlet) = snapshot.outlet {
            finite("place of the outlet", outlet)?;
        }
        grains.sort_by(|one, other| one.sphere.depth.total_cmp(&other.sphere.depth));
        let mut spheres = match snapshot.wall {
            SnapshotWall::Spheres(spheres) => spheres.to_vec(),
            SnapshotWall::Outline { .. } => Vec::new(),
        };
        for (index, sphere) in spheres.iter().enumerate() {
            check_sphere("wall", index, sphere)?;
        }
        spheres.retain(|sphere| sphere.depth.abs() < SLICE * sphere.diameter);
        Ok(Self {
            snapshot,
            grains,
            spheres,
        })
    }

    fn all(&self) -> impl Iterator<Item = &SnapshotSphere> {
        let grains = self.grains.iter().map(|grain| &grain.sphere);
        self.spheres.iter().chain(grains)
    }

    /// Height of the outermost thing that is drawn.
    fn reach(&self) -> f64 {
        let outline = match self.snapshot.wall {
            SnapshotWall::Outline { radius, .. } => radius,
            SnapshotWall::Spheres(_) => &[],
        };
        let heights = self.all().map(|it| it.across.abs() + it.diameter / 2.0);
        extent(heights.chain(outline.iter().copied())).1
    }

    /// Mean diameter of the grains; without grains, of the wall spheres; without either, 1.
    fn diameter(&self) -> f64 {
        let mut diameters: Vec<f64> = self.all().map(|sphere| sphere.diameter).collect();
        if !self.grains.is_empty() {
            diameters.drain(..self.spheres.len());
        }
        match diameters.len() {
            0 => 1.0,
            count => diameters.iter().sum::<f64>() / count as f64,
        }
    }

    /// Adds what shows between two places along the tube.
    fn add_to(&self, panel: ChartPanel, (from, to): (f64, f64)) -> ChartPanel {
        let to = to.min(self.snapshot.length);
        let shifts = match self.snapshot.outlet {
            None => &[0.0, -self.snapshot.tube, self.snapshot.tube][..],
            Some(_) => &[0.0],
        };
        // Places of a sphere and of its periodic images.
        let places = |sphere: &SnapshotSphere| {
            let (along, radius) = (sphere.along, sphere.diameter / 2.0);
            let places = shifts.iter().map(move |shift| along + shift);
            places.filter(move |along| along + radius > from && along - radius < to)
        };
        let (mut wall, mut grains) = (Spheres::default(), Spheres::default());
        for sphere in &self.spheres {
            places(sphere).for_each(|along| wall.push(along, sphere.across, sphere.diameter));
        }
        for grain in &self.grains {
            for along in places(&grain.sphere) {
                grains.push(along, grain.sphere.across, grain.sphere.diameter);
                grains.values.push(grain.axial_velocity);
            }
        }
        let mut panel = panel;
        if let SnapshotWall::Outline {
            along,
            radius,
            thickness,
        } = self.snapshot.wall
        {
            for side in [1.0, -1.0] {
                let at = |inside: f64| -> Vec<f64> {
                    let edge = radius.iter().map(|radius| (radius - inside).max(0.0));
                    edge.map(|radius| side * radius).collect()
                };
                let (centres, surface) = (at(0.0), at(thickness));
                panel = panel
                    .with(Band::new("", along, &surface, &centres).tint(Tint::Grey))
                    .with(Line::new("", along, &centres).tint(Tint::Grey));
            }
        }
        let outlet = self.snapshot.outlet.filter(|it| from < *it && *it <= to);
        let outlet = outlet.map(|place| Reference::vertical(place).label("outlet"));
        panel.with(wall).with(grains).with_all(outlet)
    }
}

fn check_sphere(
    group: &'static str,
    index: usize,
    sphere: &SnapshotSphere,
) -> Result<(), FigureError> {
    let values = [sphere.along, sphere.across, sphere.depth, sphere.diameter];
    if values.iter().any(|value| !value.is_finite()) {
        return Err(FigureError::NonFiniteSphere { group, index });
    }
    positive("diameter of a sphere", sphere.diameter).map(|_| ())
}

/// Length of a row: all rows equal, as few as show the grains large enough, in a picture that is not too high.
fn row_length(length: f64, room: f64, diameter: f64, reach: f64) -> f64 {
    let longest = (room / LEAST_GRAIN).max(SHORTEST_ROW) * diameter;
    // So many rows of 2 reach by length/rows are so many widths high.
    let most = (MOST_HEIGHT * length / (2.0 * reach)).sqrt().floor();
    let rows = (length / longest - 1e-9).ceil().min(most);
    length / rows.max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour::diverging;
    use crate::drawing::{Fill, Shape};
    use crate::geometry::{Point, Step};

    const NO_WALL: SnapshotWall<'_> = SnapshotWall::Spheres(&[]);

    fn grain(along: f64, depth: f64, axial_velocity: f64) -> SnapshotGrain {
        SnapshotGrain {
            sphere: SnapshotSphere {
                along,
                across: 0.0,
                depth,
                diameter: 1.0,
            },
            axial_velocity,
        }
    }

    /// A tube of eight diameters and one wave.
    fn snapshot<'a>(grains: &'a [SnapshotGrain], wall: SnapshotWall<'a>) -> Snapshot<'a> {
        Snapshot {
            label: "",
            grains,
            wall,
            length: 8.0,
            tube: 8.0,
            outlet: None,
            wavelength: 8.0,
        }
    }

    fn draw(snapshots: &[Snapshot<'_>]) -> Result<Drawing, FigureError> {
        SnapshotFigure {
            title: "",
            snapshots,
            axis: "*z*/*d*",
            velocity: "*v_z*/*c*",
            width: Width::SingleColumn,
        }
        .draw()
    }

    /// Centre, radius and fill of every sphere.
    fn spheres(snapshots: &[Snapshot<'_>]) -> Vec<(Point, f64, Fill)> {
        let drawing = draw(snapshots).expect("drawable");
        let sphere = |shape| match shape {
            &Shape::Path {
                ref path,
                fill: Some(fill),
                ..
            } => match path.steps[0] {
                Step::Circle(centre, radius) => Some((centre, radius, fill)),
                _ => None,
            },
            _ => None,
        };
        let shapes = drawing.shapes("spheres").into_iter();
        shapes.filter_map(sphere).collect()
    }

    #[test]
    fn near_grains_are_drawn_last_and_both_axes_have_one_scale() {
        let mut grains = [grain(2.0, 0.5, 1.0), grain(4.0, -0.5, -1.0)];
        grains[1].sphere.across = 1.0;
        let [(far, radius, far_fill), (near, _, near_fill)] =
            spheres(&[snapshot(&grains, NO_WALL)])[..]
        else {
            panic!("two grains")
        };
        assert!(near.x < far.x, "the far grain stands further along");
        assert!(((far.x - near.x) / radius - 4.0).abs() < 1e-9);
        assert!(((near.y - far.y) / radius - 2.0).abs() < 1e-9);
        assert_eq!(
            (far_fill, near_fill),
            (Fill::Sphere(diverging(-1.0)), Fill::Sphere(diverging(1.0)))
        );
    }

    #[test]
    fn a_grain_at_the_seam_shows_at_both_ends_of_a_periodic_tube() {
        let grains = [grain(0.1, 0.0, 0.0)];
        let periodic = snapshot(&grains, NO_WALL);
        assert_eq!(spheres(&[periodic]).len(), 2);
        let outlet = Some(0.75 * periodic.tube);
        let open = Snapshot { outlet, ..periodic };
        assert_eq!(spheres(&[open]).len(), 1);
        let names_the_outlet = |one| {
            draw(&[one])
                .unwrap()
                .svg()
                .contains("aria-label=\"outlet\"")
        };
        assert!(names_the_outlet(open) && !names_the_outlet(periodic));
        let nowhere = Snapshot {
            outlet: Some(f64::NAN),
            ..periodic
        };
        assert!(draw(&[nowhere]).is_err());
    }

    #[test]
    fn stacked_snapshots_have_one_scale_of_length() {
        let grains = [grain(3.0, 0.0, 0.5)];
        let short = snapshot(&grains, NO_WALL);
        let long = Snapshot {
            length: 16.0,
            tube: 32.0,
            ..short
        };
        let [(_, one, _), (_, other, _)] = spheres(&[short, long])[..] else {
            panic!("a grain each")
        };
        assert_eq!(one, other);
    }

    #[test]
    fn only_wall_spheres_in_the_cut_are_drawn() {
        let sphere = |depth| SnapshotSphere {
            along: 1.0,
            across: 1.5,
            depth,
            diameter: 1.0,
        };
        let wall = [sphere(0.0), sphere(0.7), sphere(-0.8)];
        let wall = SnapshotWall::Spheres(&wall);
        assert_eq!(spheres(&[snapshot(&[], wall)]).len(), 2);
    }

    #[test]
    fn a_long_tube_is_broken_into_equal_rows() {
        assert!((row_length(100.0, 480.0, 1.0, 2.0) - 50.0).abs() < 1e-9);
        assert!((row_length(20.0, 480.0, 1.0, 2.0) - 20.0).abs() < 1e-9);
        // Of grains that are too small for it the picture is five widths high.
        assert!((row_length(40.0, 480.0, 0.01, 4.0) - 8.0).abs() < 1e-9);
    }

    #[test]
    fn a_part_of_the_tube_says_how_much_it_is() {
        let grains = [grain(1.0, 0.0, 2.0)];
        let part = Snapshot {
            tube: 40.0,
            label: "fast",
            ..snapshot(&grains, NO_WALL)
        };
        let names = |snapshots: &[Snapshot<'_>]| draw(snapshots).expect("drawable").svg();
        assert!(names(&[part]).contains("z/d  (1 of 5 waves shown)"));
        let mut whole = part;
        whole.tube = 8.0;
        let both = names(&[part, whole]);
        assert!(both.contains("fast  (1 of 5 waves shown)") && both.contains("\"z/d\""));
        assert!(both.contains("≥ 1") && !both.contains("≤"), "v/c is 2");
    }

    #[test]
    fn what_has_no_place_or_shows_nothing_is_refused() {
        let grains = [grain(0.0, 0.0, 0.0), grain(f64::NAN, 0.0, 0.0)];
        let refused = |snapshots: &[Snapshot<'_>]| draw(snapshots).expect_err("nothing to draw");
        let error = refused(&[snapshot(&grains, NO_WALL)]);
        assert!(matches!(
            error,
            FigureError::NonFiniteSphere { index: 1, .. }
        ));
        for nothing in [&[][..], &[snapshot(&[], NO_WALL)]] {
            assert!(matches!(refused(nothing), FigureError::EmptySeries { .. }));
        }
        let mut no_length = snapshot(&grains[..1], NO_WALL);
        no_length.length = 0.0;
        let error = refused(&[no_length]);
        assert!(matches!(error, FigureError::NotPositive { .. }));
    }
}
