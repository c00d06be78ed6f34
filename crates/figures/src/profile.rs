//! Profiles of the flow in the wave frame.

use crate::axis::{Axis, Scale};
use crate::colour::{AGAINST, ALONG, BLACK, BLUE, Colour, GREY, PURPLE};
use crate::drawing::{Drawing, Fill, Point, Rectangle, Stroke};
use crate::error::FigureError;
use crate::panel::{
    BOTTOM_MARGIN, Labels, Panel, draw_title, guide, left_margin, right_margin, title_space,
};
use crate::series::{Profile, Sample, close_wavelength, extent, wavelength_range};
use crate::style::{RIGHT_MARGIN, Width};

/// Profiles along the wave at rest: panels for the tube, the density, the axial velocity and the granular temperature.
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
    /// Width of the figure.
    pub width: Width,
}

/// Heights of the panels in points, from the tube to the temperature.
const HEIGHTS: [f64; 4] = [48.0, 70.0, 70.0, 70.0];
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

impl Quantity {
    /// The same with its lines carried over the ends of the wavelength.
    fn closed(self) -> Self {
        Self {
            pieces: close_wavelength(self.pieces),
            ..self
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
        let quantities = [wall, density, velocity, temperature];
        let positions = quantities
            .iter()
            .flat_map(|quantity| quantity.pieces.iter().flatten());
        let x = Axis::linear(wavelength_range(positions.map(|sample| sample.x)));
        let [wall, density, velocity, temperature] = quantities.map(Quantity::closed);
        let quantities = [&wall, &density, &velocity, &temperature];

        let width = self.width.points();
        let left = quantities
            .iter()
            .zip(HEIGHTS)
            .fold(0.0, |left: f64, (quantity, height)| {
                left.max(left_margin(&quantity.axis, height))
            });
        let right = right_margin(&x, width - left).max(RIGHT_MARGIN) + LETTER_SPACE;
        let mut top = title_space(self.title) + 4.0;
        let panels = [0, 1, 2, 3].map(|place| {
            let frame = Rectangle {
                left,
                top,
                width: width - left - right,
                height: HEIGHTS[place],
            };
            top = frame.bottom() + GAP;
            Panel {
                frame,
                x,
                y: quantities[place].axis,
            }
        });
        let mut drawing = Drawing::new(
            width,
            panels[3].frame.bottom() + BOTTOM_MARGIN + 3.0,
            &format!("Profiles in the wave frame: {}", self.title),
        );

        draw_title(&mut drawing, self.title, width);
        draw_tube(&mut drawing, &panels[0], &wall.pieces);
        draw_curve(&mut drawing, &panels[1], "density", &density.pieces, BLUE);
        draw_signed(&mut drawing, &panels[2], &velocity.pieces);
        draw_curve(
            &mut drawing,
            &panels[3],
            "temperature",
            &temperature.pieces,
            PURPLE.towards(BLACK, 0.25),
        );
        let names = [
            self.wall_radius.label,
            self.density.label,
            self.axial_velocity.label,
            self.temperature.label,
        ];
        for (place, panel) in panels.iter().enumerate() {
            let x = (place == 3).then_some("position in the wave frame, (*z* − *ct*)/*λ*");
            panel.draw_frame(
                &mut drawing,
                &Labels {
                    x,
                    y: names[place],
                    letter: Some(['a', 'b', 'c', 'd'][place]),
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
