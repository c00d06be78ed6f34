//! Profiles of the flow in the wave frame.

use crate::axis::{Axis, Scale};
use crate::colour::{AGAINST, ALONG, BLACK, BLUE, Colour, GREEN, GREY, ORANGE, PURPLE};
use crate::drawing::{Drawing, Fill, Point, Rectangle, Stroke};
use crate::error::FigureError;
use crate::panel::{
    BOTTOM_MARGIN, Labels, Panel, draw_title, guide, left_margin, right_margin, title_space,
};
use crate::series::{Profile, Sample, close_wavelength, extent, wavelength_range};
use crate::style::{RIGHT_MARGIN, Width};

/// Profiles along the wave at rest: panels for the tube, the density, the axial velocity and the granular temperature, and for
/// pressure and shear on the wall where they are given.
///
/// The axial velocity is positive and red along the wave, negative and blue against it. Errors are drawn as bars on up
/// to 40 points and as a band on more.
#[derive(Clone, Copy, Debug, Default)]
pub struct ProfileFigure<'a> {
    /// Line above the figure, in markup; none if empty.
    pub title: &'a str,
    /// Radius of the wall; drawn as the outline of the tube. Label for instance `*r*/*d*`.
    pub wall_radius: Profile<'a>,
    /// Density of the grains.
    pub density: Profile<'a>,
    /// Axial velocity over the wave speed, positive along the wave. Label for instance `*v_z*/*c*`.
    pub axial_velocity: Profile<'a>,
    /// Granular temperature.
    pub temperature: Profile<'a>,
    /// Scale of the granular temperature.
    pub temperature_scale: Scale,
    /// Pressure on the wall.
    pub wall_pressure: Option<Profile<'a>>,
    /// Shear on the wall, positive along the wave.
    pub wall_shear: Option<Profile<'a>>,
    /// Width of the figure.
    pub width: Width,
}

/// Heights of the panels in points: that of the tube, those of the flow, those of the wall.
const TUBE_HEIGHT: f64 = 48.0;
const FLOW_HEIGHT: f64 = 70.0;
const WALL_HEIGHT: f64 = 55.0;
const GAP: f64 = 5.0;
/// Room for the letters of the panels at the right of their frames.
const LETTER_SPACE: f64 = 15.0;
const MARGIN: f64 = 0.07;
/// Points up to which every error has its own bar: 40, and one carried over at either end.
const MOST_BARS: usize = 42;
const OUTSIDE: Colour = Colour::new(222, 222, 222);
const CURVE_WEIGHT: f64 = 1.0;

/// Pieces of one profile with the axis that they need.
struct Quantity {
    pieces: Vec<Vec<Sample>>,
    axis: Axis,
}

/// How a profile is drawn.
#[derive(Clone, Copy)]
enum Kind {
    Tube,
    Signed,
    /// With the name of its layer.
    Curve(&'static str, Colour),
}

/// One panel.
struct Row<'a> {
    label: &'a str,
    height: f64,
    kind: Kind,
    quantity: Quantity,
}

impl<'a> Row<'a> {
    fn new(label: &'a str, height: f64, kind: Kind, quantity: Quantity) -> Self {
        Self {
            label,
            height,
            kind,
            quantity,
        }
    }
}

impl ProfileFigure<'_> {
    /// Lays the figure out.
    ///
    /// # Errors
    /// If a profile has no finite row or uneven columns, or if a logarithmic temperature has no positive value.
    pub fn draw(&self) -> Result<Drawing, FigureError> {
        let wall = self.wall_radius.pieces("wall radius")?;
        let widest = extent(wall.iter().flatten().map(|sample| sample.y.abs())).1;
        let wall = Quantity {
            pieces: wall,
            axis: Axis::linear((-1.12 * widest, 1.12 * widest)),
        };
        let density = linear(self.density.pieces("density")?);
        let velocity = linear(self.axial_velocity.pieces("axial velocity")?);
        let temperature = match self.temperature_scale {
            Scale::Linear => linear(self.temperature.pieces("granular temperature")?),
            Scale::Logarithmic => logarithmic(
                "granular temperature",
                self.temperature.pieces("granular temperature")?,
            )?,
        };
        let temperature_colour = PURPLE.towards(BLACK, 0.25);
        let mut rows = vec![
            Row::new(self.wall_radius.label, TUBE_HEIGHT, Kind::Tube, wall),
            Row::new(
                self.density.label,
                FLOW_HEIGHT,
                Kind::Curve("density", BLUE),
                density,
            ),
            Row::new(
                self.axial_velocity.label,
                FLOW_HEIGHT,
                Kind::Signed,
                velocity,
            ),
            Row::new(
                self.temperature.label,
                FLOW_HEIGHT,
                Kind::Curve("temperature", temperature_colour),
                temperature,
            ),
        ];
        for (profile, name, colour) in [
            (&self.wall_pressure, "wall pressure", ORANGE),
            (&self.wall_shear, "wall shear", GREEN),
        ] {
            if let Some(profile) = profile {
                let quantity = linear(profile.pieces(name)?);
                let kind = Kind::Curve(name, colour.towards(BLACK, 0.25));
                rows.push(Row::new(profile.label, WALL_HEIGHT, kind, quantity));
            }
        }
        let positions = rows
            .iter()
            .flat_map(|row| row.quantity.pieces.iter().flatten());
        let x = Axis::linear(wavelength_range(positions.map(|sample| sample.x)));
        for row in &mut rows {
            row.quantity.pieces = close_wavelength(std::mem::take(&mut row.quantity.pieces));
        }

        let width = self.width.points();
        let left = rows.iter().fold(0.0, |left: f64, row| {
            left.max(left_margin(&row.quantity.axis, row.height))
        });
        let right = right_margin(&x, width - left).max(RIGHT_MARGIN) + LETTER_SPACE;
        let mut top = title_space(self.title) + 4.0;
        let panels: Vec<Panel> = rows
            .iter()
            .map(|row| {
                let frame = Rectangle {
                    left,
                    top,
                    width: width - left - right,
                    height: row.height,
                };
                top = frame.bottom() + GAP;
                Panel {
                    frame,
                    x,
                    y: row.quantity.axis,
                }
            })
            .collect();
        let mut drawing = Drawing::new(
            width,
            top - GAP + BOTTOM_MARGIN + 3.0,
            &format!("Profiles in the wave frame: {}", self.title),
        );

        draw_title(&mut drawing, self.title, width);
        for (row, panel) in rows.iter().zip(&panels) {
            let pieces = &row.quantity.pieces;
            match row.kind {
                Kind::Tube => draw_tube(&mut drawing, panel, pieces),
                Kind::Signed => draw_signed(&mut drawing, panel, pieces),
                Kind::Curve(name, colour) => {
                    if panel.y.range().0 < 0.0 {
                        panel.level(&mut drawing, name, 0.0, guide());
                    }
                    draw_curve(&mut drawing, panel, name, pieces, colour);
                }
            }
        }
        for (place, (row, panel)) in rows.iter().zip(&panels).enumerate() {
            let is_last = place + 1 == rows.len();
            panel.draw_frame(
                &mut drawing,
                &Labels {
                    x: is_last.then_some("position in the wave frame, (*z* − *ct*)/*λ*"),
                    y: row.label,
                    letter: Some(['a', 'b', 'c', 'd', 'e', 'f'][place]),
                },
            );
        }
        Ok(drawing)
    }
}

/// A linear axis over values with their errors and nought.
fn linear(pieces: Vec<Vec<Sample>>) -> Quantity {
    let reach = pieces
        .iter()
        .flatten()
        .flat_map(|sample| [sample.y - sample.error, sample.y + sample.error])
        .chain([0.0]);
    let (least, largest) = extent(reach);
    let free = MARGIN * (largest - least);
    // A quantity that is never negative starts at nought exactly.
    let axis = Axis::linear((
        if least < 0.0 { least - free } else { 0.0 },
        if largest > 0.0 { largest + free } else { 0.0 },
    ));
    Quantity { pieces, axis }
}

/// A logarithmic axis over the positive values; the others are left out and cut the line.
fn logarithmic(name: &'static str, pieces: Vec<Vec<Sample>>) -> Result<Quantity, FigureError> {
    let length = pieces.iter().map(Vec::len).sum();
    let pieces: Vec<Vec<Sample>> = pieces
        .iter()
        .flat_map(|piece| piece.split(|sample| sample.y <= 0.0))
        .filter(|piece| !piece.is_empty())
        .map(<[Sample]>::to_vec)
        .collect();
    if pieces.is_empty() {
        return Err(FigureError::EmptySeries {
            series: name,
            length,
        });
    }
    let range = extent(
        pieces
            .iter()
            .flatten()
            .flat_map(|sample| [sample.y, sample.y + sample.error]),
    );
    Ok(Quantity {
        pieces,
        axis: Axis::with_margin(Scale::Logarithmic, range, MARGIN),
    })
}

/// The tube in section: its bore white between two lines of wall, all outside of it grey.
fn draw_tube(drawing: &mut Drawing, panel: &Panel, wall: &[Vec<Sample>]) {
    let frame = panel.frame;
    let layer = drawing.layer("tube", Some(frame));
    for piece in wall {
        let mirrored: Vec<Sample> = piece
            .iter()
            .map(|sample| Sample {
                y: -sample.y,
                ..*sample
            })
            .collect();
        for (line, edge) in [(piece, frame.top), (&mirrored, frame.bottom())] {
            let ends = [line[line.len() - 1], line[0]].map(|end| Point {
                x: panel.across(end.x),
                y: edge,
            });
            layer.polygon(panel.line(line).chain(ends), OUTSIDE);
            layer.line(panel.line(line), Stroke::solid(BLACK, CURVE_WEIGHT));
        }
    }
    panel.level(drawing, "axis of the tube", 0.0, guide());
}

fn draw_curve(
    drawing: &mut Drawing,
    panel: &Panel,
    name: &'static str,
    pieces: &[Vec<Sample>],
    colour: Colour,
) {
    let marked = pieces.iter().map(Vec::len).sum::<usize>() <= MOST_BARS;
    let layer = drawing.layer(name, Some(panel.frame));
    for piece in pieces {
        let erroneous = piece.iter().any(|sample| sample.error > 0.0);
        if erroneous && !marked {
            layer.polygon(panel.band(piece), colour.faint(0.25));
        }
        layer.line(panel.line(piece), Stroke::solid(colour, CURVE_WEIGHT));
        if marked {
            for sample in piece {
                draw_mark(layer, panel, sample, colour);
            }
        }
    }
}

/// A signed curve: red above nought, blue below, the area to nought faint in the same colour.
fn draw_signed(drawing: &mut Drawing, panel: &Panel, pieces: &[Vec<Sample>]) {
    panel.level(
        drawing,
        "rest",
        0.0,
        Stroke {
            colour: GREY,
            ..guide()
        },
    );
    let marked = pieces.iter().map(Vec::len).sum::<usize>() <= MOST_BARS;
    let layer = drawing.layer("axial velocity", Some(panel.frame));
    for piece in pieces {
        for (positive, part) in parts_by_sign(piece) {
            let colour = if positive { ALONG } else { AGAINST };
            let feet = [part[part.len() - 1], part[0]].map(|end| panel.place(end.x, 0.0));
            layer.polygon(panel.line(&part).chain(feet), colour.faint(0.16));
            if !marked && part.iter().any(|sample| sample.error > 0.0) {
                layer.polygon(panel.band(&part), colour.faint(0.25));
            }
            layer.line(panel.line(&part), Stroke::solid(colour, CURVE_WEIGHT));
        }
        if marked {
            for sample in piece {
                draw_mark(
                    layer,
                    panel,
                    sample,
                    if sample.y >= 0.0 { ALONG } else { AGAINST },
                );
            }
        }
    }
}

/// A point with its error bar.
fn draw_mark(layer: &mut crate::drawing::Layer, panel: &Panel, sample: &Sample, colour: Colour) {
    let centre = panel.place(sample.x, sample.y);
    if sample.error > 0.0 {
        let bar = Stroke::solid(colour, 0.6);
        let (top, bottom) = (
            panel.up(sample.y + sample.error),
            panel.up(sample.y - sample.error),
        );
        layer.segment((centre.x, top), (centre.x, bottom), bar);
        for end in [top, bottom] {
            layer.segment((centre.x - 1.2, end), (centre.x + 1.2, end), bar);
        }
    }
    layer.circle(centre, 1.3, Fill::Flat(colour), None);
}

/// Cuts a line where it crosses nought, with the crossing at the end of one part and the start of the next; true for
/// the parts that are not negative.
fn parts_by_sign(line: &[Sample]) -> Vec<(bool, Vec<Sample>)> {
    let mut parts: Vec<(bool, Vec<Sample>)> = Vec::new();
    for sample in line {
        let positive = sample.y >= 0.0;
        match parts.last_mut() {
            Some((sign, part)) if *sign == positive => part.push(*sample),
            Some((_, part)) => {
                let before = part[part.len() - 1];
                let fraction = before.y / (before.y - sample.y);
                let between = |from: f64, to: f64| from + fraction * (to - from);
                let crossing = Sample {
                    x: between(before.x, sample.x),
                    y: 0.0,
                    error: between(before.error, sample.error),
                };
                part.push(crossing);
                parts.push((positive, vec![crossing, *sample]));
            }
            None => parts.push((positive, vec![*sample])),
        }
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::Shape;

    fn sample(x: f64, y: f64) -> Sample {
        Sample { x, y, error: 0.0 }
    }

    #[test]
    fn a_line_is_cut_where_it_crosses_nought() {
        let parts = parts_by_sign(&[
            sample(0.0, 1.0),
            sample(1.0, 3.0),
            sample(2.0, -1.0),
            sample(3.0, -2.0),
        ]);
        assert_eq!(parts.len(), 2);
        assert!(parts[0].0 && !parts[1].0);
        assert_eq!(parts[0].1[2], sample(1.75, 0.0));
        assert_eq!(parts[1].1[0], sample(1.75, 0.0));
    }

    #[test]
    fn motion_along_the_wave_is_red_and_against_it_blue() {
        let position = [0.2, 0.3, 0.5, 0.6];
        let profile = |value| Profile {
            position: &position,
            value,
            error: None,
            label: "",
        };
        let figure = ProfileFigure {
            wall_radius: profile(&[1.0, 2.0, 2.0, 1.0]),
            density: profile(&[0.1, 0.2, 0.2, 0.1]),
            axial_velocity: profile(&[0.8, 0.5, -0.2, -0.3]),
            temperature: profile(&[0.1, 0.2, 0.2, 0.1]),
            ..ProfileFigure::default()
        };
        let drawing = figure.draw().expect("drawable");
        let lines: Vec<(Colour, f64)> = drawing
            .shapes("axial velocity")
            .iter()
            .filter_map(|shape| match shape {
                Shape::Line { points, stroke } => {
                    Some((stroke.colour, points[0].y - points[points.len() - 1].y))
                }
                _ => None,
            })
            .collect();
        assert_eq!(
            lines.iter().map(|(colour, _)| *colour).collect::<Vec<_>>(),
            [ALONG, AGAINST]
        );
        assert!(
            lines.iter().all(|(_, rise)| *rise < 0.0),
            "both fall: {lines:?}"
        );
    }

    #[test]
    fn the_wall_has_panels_where_it_is_given() {
        let position = [0.2, 0.5, 0.8];
        let profile = |value| Profile {
            position: &position,
            value,
            error: None,
            label: "",
        };
        let plain = ProfileFigure {
            wall_radius: profile(&[1.0, 2.0, 1.0]),
            density: profile(&[0.1, 0.2, 0.1]),
            axial_velocity: profile(&[0.8, 0.5, -0.2]),
            temperature: profile(&[0.1, 0.2, 0.1]),
            ..ProfileFigure::default()
        };
        let drawing = plain.draw().expect("drawable");
        assert!(drawing.shapes("wall pressure").is_empty());
        let with_wall = ProfileFigure {
            wall_pressure: Some(profile(&[0.0, 0.3, 0.1])),
            wall_shear: Some(profile(&[-0.1, 0.2, 0.0])),
            ..plain
        };
        let drawing = with_wall.draw().expect("drawable");
        let lines = |layer| {
            let shapes = drawing.shapes(layer).into_iter();
            shapes
                .filter(|shape| matches!(shape, Shape::Line { .. }))
                .count()
        };
        assert_eq!((lines("density"), lines("wall pressure")), (1, 1));
        assert!(lines("wall shear") >= 1);
    }

    #[test]
    fn a_logarithmic_axis_leaves_out_what_has_no_logarithm() {
        let quantity = logarithmic(
            "temperature",
            vec![vec![sample(0.0, 1e-3), sample(0.5, 0.0), sample(1.0, 1e-1)]],
        )
        .expect("two positive");
        assert_eq!(
            quantity.pieces,
            [vec![sample(0.0, 1e-3)], vec![sample(1.0, 1e-1)]]
        );
        let error = logarithmic("temperature", vec![vec![sample(0.0, 0.0)]]);
        assert!(matches!(error, Err(FigureError::EmptySeries { .. })));
    }
}
