//! One row of a snapshot.

use super::{SnapshotGrain, SnapshotSphere};
use crate::colour::{BLACK, Colour, GREY, diverging};
use crate::drawing::{Drawing, Fill, Point, Stroke};
use crate::panel::{Labels, Panel};
use crate::series::Sample;

const WALL_FILL: Colour = GREY.faint(0.16);
const WALL_EDGE: Stroke = Stroke::solid(GREY.faint(0.55), 0.3);
const GRAIN_EDGE: Stroke = Stroke::solid(BLACK.faint(0.65), 0.25);

/// A row of the figure: equal scales along and across.
pub(super) struct View {
    pub(super) panel: Panel,
    /// Points in a unit of length.
    pub(super) scale: f64,
}

impl View {
    /// Places of a sphere and of its periodic images, where they show in this row.
    fn places<'a>(
        &'a self,
        sphere: &'a SnapshotSphere,
        shifts: &'a [f64],
    ) -> impl Iterator<Item = Point> + 'a {
        let (from, to) = self.panel.x.range();
        let radius = sphere.diameter / 2.0;
        let along = shifts.iter().map(move |shift| sphere.along + shift);
        along
            .filter(move |along| along + radius > from && along - radius < to)
            .map(|along| self.panel.place(along, sphere.across))
    }

    pub(super) fn draw_wall(
        &self,
        drawing: &mut Drawing,
        spheres: &[SnapshotSphere],
        outline: &[Vec<Sample>],
        shifts: &[f64],
    ) {
        let layer = drawing.layer("wall", Some(self.panel.frame));
        for sphere in spheres {
            for place in self.places(sphere, shifts) {
                layer.circle(
                    place,
                    self.scale * sphere.diameter / 2.0,
                    Fill::Flat(WALL_FILL),
                    Some(WALL_EDGE),
                );
            }
        }
        for piece in outline {
            for side in [1.0, -1.0] {
                for &shift in shifts {
                    let line = piece
                        .iter()
                        .map(|sample| self.panel.place(sample.x + shift, side * sample.y));
                    layer.line(line, Stroke::solid(GREY, 1.0));
                }
            }
        }
    }

    pub(super) fn draw_grains(
        &self,
        drawing: &mut Drawing,
        grains: &[SnapshotGrain],
        shifts: &[f64],
        limit: f64,
    ) {
        let layer = drawing.layer("grains", Some(self.panel.frame));
        for grain in grains {
            for place in self.places(&grain.sphere, shifts) {
                let fill = Fill::Sphere(diverging(grain.axial_velocity / limit));
                layer.circle(
                    place,
                    self.scale * grain.sphere.diameter / 2.0,
                    fill,
                    Some(GRAIN_EDGE),
                );
            }
        }
    }

    pub(super) fn draw_frame(&self, drawing: &mut Drawing, unit: &str) {
        let label = if unit.is_empty() {
            "*x*".to_owned()
        } else {
            format!("*x*/{unit}")
        };
        self.panel.draw_frame(
            drawing,
            &Labels {
                x: Some(""),
                y: &label,
                letter: None,
            },
        );
    }
}
