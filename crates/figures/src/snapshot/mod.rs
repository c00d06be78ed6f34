//! Grains in a part of the tube, seen from the side.

mod stack;
mod view;

pub use stack::SnapshotStack;
use stack::{Prepared, draw_stack};

use crate::axis::decimal;
use crate::drawing::Drawing;
use crate::error::{FigureError, finite, positive};
use crate::series::{Sample, Series, extent};
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
#[derive(Clone, Copy, Debug, Default)]
pub enum SnapshotWall<'a> {
    /// Not at all.
    #[default]
    Hidden,
    /// The wall spheres within three quarters of a diameter of the plane through the tube's axis, as faint discs.
    Spheres(&'a [SnapshotSphere]),
    /// The radius of the wall (y) along the tube (x), as two curves.
    Outline(Series<'a>),
}

/// Side view of a part of the tube: grains coloured by their axial velocity, blue against the wave, white at rest and
/// red along it; a long part is broken into rows that read like lines of text.
#[derive(Clone, Copy, Debug)]
pub struct SnapshotFigure<'a> {
    /// Line above the figure, in markup; none if empty.
    pub title: &'a str,
    /// The grains; those outside of the part are not drawn.
    pub grains: &'a [SnapshotGrain],
    /// The wall.
    pub wall: SnapshotWall<'a>,
    /// Where the part begins along the tube.
    pub start: f64,
    /// Length of the part.
    pub length: f64,
    /// Length of a periodic tube: spheres also show where their images lie in the part.
    pub period: Option<f64>,
    /// Wavelength, so that a part of a periodic tube can say how many of its waves it shows.
    pub wavelength: Option<f64>,
    /// Axial velocity, over the wave speed, of the deepest colours.
    pub velocity_limit: f64,
    /// Unit of length, in markup, for instance `*d*`.
    pub length_unit: &'a str,
    /// Width of the figure.
    pub width: Width,
}

impl Default for SnapshotFigure<'_> {
    fn default() -> Self {
        Self {
            title: "",
            grains: &[],
            wall: SnapshotWall::Hidden,
            start: 0.0,
            length: 0.0,
            period: None,
            wavelength: None,
            velocity_limit: 1.0,
            length_unit: "*d*",
            width: Width::DoubleColumn,
        }
    }
}

/// A mean grain is drawn no smaller than this across, in points, as long as the page allows.
const LEAST_GRAIN: f64 = 7.5;
/// A row is never shorter than this many grain diameters.
const SHORTEST_ROW: f64 = 10.0;
/// Free space above and below the outermost sphere, as a fraction of the half height of a row.
const MARGIN: f64 = 0.06;
/// Greatest distance of a drawn wall sphere from the plane of the cut, in diameters: half a diameter would leave gaps
/// where the wall is stretched.
const SLICE: f64 = 0.75;

impl SnapshotFigure<'_> {
    /// Lays the figure out.
    ///
    /// # Errors
    /// If the length, the period, the wavelength, the velocity limit or a diameter is not positive, if a coordinate or velocity is not
    /// finite, or if neither a grain nor a wall is given.
    pub fn draw(&self) -> Result<Drawing, FigureError> {
        draw_stack(self.title, self.width, &[("", *self)])
    }

    /// What is drawn of it, checked and in order.
    fn prepared(&self) -> Result<Prepared, FigureError> {
        let grains = self.ordered_grains()?;
        let spheres = self.cut_spheres()?;
        let outline = match self.wall {
            SnapshotWall::Outline(series) => series.pieces("wall outline")?,
            SnapshotWall::Hidden | SnapshotWall::Spheres(_) => Vec::new(),
        };
        let period = self
            .period
            .map(|period| positive("period of the tube", period))
            .transpose()?;
        Ok(Prepared {
            start: finite("start of the snapshot", self.start)?,
            length: positive("length of the snapshot", self.length)?,
            limit: positive("velocity limit", self.velocity_limit)?,
            shifts: period.map_or(vec![0.0], |period| vec![0.0, -period, period]),
            reach: self.reach(&grains, &spheres, &outline)?,
            diameter: mean_diameter(&grains, &spheres),
            extent: self.shown_extent()?,
            grains,
            spheres,
            outline,
        })
    }

    /// How much of the tube is shown, in markup; nothing where it is all of it.
    fn shown_extent(&self) -> Result<String, FigureError> {
        let Some(period) = self.period else {
            return Ok(String::new());
        };
        if self.length >= period * (1.0 - 1e-9) {
            return Ok(String::new());
        }
        let number = |value: f64| {
            let number = decimal(value, 1);
            number.strip_suffix(".0").unwrap_or(&number).to_owned()
        };
        let (unit, name) = match self.wavelength {
            Some(wavelength) => (positive("wavelength", wavelength)?, "waves"),
            None => (1.0, self.length_unit),
        };
        Ok(format!(
            "{} of {} {name} shown",
            number(self.length / unit),
            number(period / unit)
        ))
    }

    /// Checked grains, from the furthest to the nearest.
    fn ordered_grains(&self) -> Result<Vec<SnapshotGrain>, FigureError> {
        for (index, grain) in self.grains.iter().enumerate() {
            check_sphere("grains", index, &grain.sphere)?;
            if !grain.axial_velocity.is_finite() {
                return Err(FigureError::NonFiniteSphere {
                    group: "grains",
                    index,
                });
            }
        }
        let mut grains = self.grains.to_vec();
        grains.sort_by(|one, other| one.sphere.depth.total_cmp(&other.sphere.depth));
        Ok(grains)
    }

    /// Checked wall spheres close to the plane of the cut.
    fn cut_spheres(&self) -> Result<Vec<SnapshotSphere>, FigureError> {
        let SnapshotWall::Spheres(spheres) = self.wall else {
            return Ok(Vec::new());
        };
        for (index, sphere) in spheres.iter().enumerate() {
            check_sphere("wall", index, sphere)?;
        }
        Ok(spheres
            .iter()
            .filter(|sphere| sphere.depth.abs() < SLICE * sphere.diameter)
            .copied()
            .collect())
    }

    /// Half height of a row: everything that may be drawn, with a margin.
    fn reach(
        &self,
        grains: &[SnapshotGrain],
        spheres: &[SnapshotSphere],
        outline: &[Vec<Sample>],
    ) -> Result<f64, FigureError> {
        let spheres = spheres
            .iter()
            .chain(grains.iter().map(|grain| &grain.sphere));
        let heights = spheres.map(|sphere| sphere.across.abs() + sphere.diameter / 2.0);
        let heights = heights.chain(outline.iter().flatten().map(|sample| sample.y.abs()));
        let (_, reach) = extent(heights);
        if reach > 0.0 {
            Ok(reach * (1.0 + MARGIN))
        } else {
            Err(FigureError::EmptySeries {
                series: "snapshot",
                length: self.grains.len(),
            })
        }
    }
}

fn check_sphere(
    group: &'static str,
    index: usize,
    sphere: &SnapshotSphere,
) -> Result<(), FigureError> {
    if [sphere.along, sphere.across, sphere.depth, sphere.diameter]
        .iter()
        .any(|value| !value.is_finite())
    {
        return Err(FigureError::NonFiniteSphere { group, index });
    }
    positive("diameter of a sphere", sphere.diameter).map(|_| ())
}

/// Mean diameter of the grains, of the wall spheres where there are none, or 1.
fn mean_diameter(grains: &[SnapshotGrain], spheres: &[SnapshotSphere]) -> f64 {
    let mean = |sum: f64, count: usize| sum / count as f64;
    if !grains.is_empty() {
        mean(
            grains.iter().map(|grain| grain.sphere.diameter).sum(),
            grains.len(),
        )
    } else if !spheres.is_empty() {
        mean(
            spheres.iter().map(|sphere| sphere.diameter).sum(),
            spheres.len(),
        )
    } else {
        1.0
    }
}

/// Length of a row: all rows equal, as few as show the grains large enough.
fn row_length(length: f64, room: f64, diameter: f64) -> f64 {
    let longest = (room / LEAST_GRAIN).max(SHORTEST_ROW) * diameter;
    length / (length / longest - 1e-9).ceil().max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour::diverging;
    use crate::drawing::{Fill, Point, Shape};

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

    fn circles(drawing: &Drawing, name: &str) -> Vec<(Point, f64, Fill)> {
        let shapes = drawing.shapes(name).into_iter();
        shapes
            .filter_map(|shape| match shape {
                Shape::Circle {
                    centre,
                    radius,
                    fill,
                    ..
                } => Some((*centre, *radius, *fill)),
                _ => None,
            })
            .collect()
    }

    #[test]
    fn near_grains_are_drawn_last_and_both_axes_have_one_scale() {
        let grains = [grain(2.0, 0.5, 1.0), grain(4.0, -0.5, -1.0)];
        let drawing = SnapshotFigure {
            grains: &grains,
            length: 8.0,
            ..SnapshotFigure::default()
        }
        .draw()
        .expect("drawable");
        let [(far, radius, far_fill), (near, _, near_fill)] = circles(&drawing, "grains")[..]
        else {
            panic!("two grains")
        };
        assert!(near.x < far.x, "the far grain stands further along");
        assert!(
            ((far.x - near.x) / radius - 4.0).abs() < 1e-9,
            "two diameters apart"
        );
        assert_eq!(
            (far_fill, near_fill),
            (Fill::Sphere(diverging(-1.0)), Fill::Sphere(diverging(1.0)))
        );
    }

    #[test]
    fn a_grain_at_the_seam_shows_at_both_ends() {
        let grains = [grain(0.1, 0.0, 0.0)];
        let figure = SnapshotFigure {
            grains: &grains,
            length: 8.0,
            period: Some(8.0),
            ..SnapshotFigure::default()
        };
        assert_eq!(
            circles(&figure.draw().expect("drawable"), "grains").len(),
            2
        );
        let open = SnapshotFigure {
            period: None,
            ..figure
        };
        assert_eq!(circles(&open.draw().expect("drawable"), "grains").len(), 1);
    }

    #[test]
    fn only_wall_spheres_in_the_cut_are_drawn() {
        let sphere = |depth| SnapshotSphere {
            along: 1.0,
            across: 1.5,
            depth,
            diameter: 1.0,
        };
        let spheres = [sphere(0.0), sphere(0.7), sphere(-0.8)];
        let figure = SnapshotFigure {
            wall: SnapshotWall::Spheres(&spheres),
            length: 4.0,
            ..SnapshotFigure::default()
        };
        assert_eq!(circles(&figure.draw().expect("drawable"), "wall").len(), 2);
    }

    #[test]
    fn a_long_tube_is_broken_into_equal_rows() {
        assert!((row_length(100.0, 480.0, 1.0) - 50.0).abs() < 1e-9);
        assert!((row_length(20.0, 480.0, 1.0) - 20.0).abs() < 1e-9);
    }

    #[test]
    fn a_grain_without_a_place_is_named() {
        let grains = [grain(0.0, 0.0, 0.0), grain(f64::NAN, 0.0, 0.0)];
        let error = SnapshotFigure {
            grains: &grains,
            length: 8.0,
            ..SnapshotFigure::default()
        }
        .draw()
        .expect_err("no place");
        assert!(
            matches!(error, FigureError::NonFiniteSphere { index: 1, .. }),
            "{error}"
        );
        let error = SnapshotFigure {
            length: 8.0,
            ..SnapshotFigure::default()
        }
        .draw()
        .expect_err("nothing to draw");
        assert!(matches!(error, FigureError::EmptySeries { .. }), "{error}");
    }
}
