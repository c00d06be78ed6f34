//! The layers of a panel as shapes on the page, and what they keep others from covering.

use super::layer::{Band, Bars, ChartLayer, Line, Reference};
use super::look::{Look, Tint};
use super::panel::ChartPanel;
use super::path::{Row, pieces, steps, thinned};
use super::placement::Obstacles;
use super::points::Points;
use crate::colour::Colour;
use crate::colour_scale::ColourScale;
use crate::drawing::{Drawing, Outline, Point, Rectangle, Stroke};
use crate::legend::Mark;
use crate::panel::Panel;

/// Radius of a mark in points, by the number of points of a series up to which it is used.
const RADII: [(usize, f64); 3] = [(150, 1.9), (1500, 1.3), (usize::MAX, 0.8)];
const BAR_WEIGHT: f64 = 0.6;
/// Half the width of the cap of an error bar.
const CAP: f64 = 1.5;
/// Length of the arrow of a lower limit.
pub(super) const ARROW: f64 = 11.0;
const ARROW_HEAD: f64 = 2.0;
pub(super) const BAND_OPACITY: f64 = 0.22;
pub(super) const BAR_OPACITY: f64 = 0.38;
pub(super) const WINDOW_OPACITY: f64 = 0.16;
const REFERENCE_WEIGHT: f64 = 0.7;
const GUIDE_WEIGHT: f64 = 0.45;
/// Draws the layers of one panel.
pub(super) struct Painter<'a> {
    pub(super) panel: Panel,
    pub(super) chart: &'a ChartPanel,
    pub(super) scale: Option<&'a ColourScale>,
}

/// A layer with its number among those that have no series of their own.
type Numbered<'a> = (usize, &'a ChartLayer);

impl Painter<'_> {
    pub(super) fn numbered(&self) -> impl Iterator<Item = Numbered<'_>> {
        self.chart.layers.iter().scan(0, |next, layer| {
            let number = *next;
            if look(layer).is_some_and(|look| look.series.is_none()) {
                *next += 1;
            }
            Some((number, layer))
        })
    }

    pub(super) fn colour(&self, number: usize, look: Look) -> Colour {
        look.colour(number, self.scale)
    }

    pub(super) fn tint(&self, tint: Tint) -> Colour {
        let tint = Some(tint);
        self.colour(0, Look { series: None, tint })
    }

    /// Everything but frame and texts; returns what must not be covered.
    pub(super) fn draw_layers(&self, drawing: &mut Drawing) -> Obstacles {
        let mut obstacles = Obstacles::default();
        self.draw_windows(drawing);
        for (number, layer) in self.numbered() {
            if let ChartLayer::Band(band) = layer {
                self.draw_band(drawing, &mut obstacles, number, band);
            }
        }
        for (number, layer) in self.numbered() {
            if let ChartLayer::Bars(bars) = layer {
                self.draw_bars(drawing, &mut obstacles, number, bars);
            }
        }
        for (_, layer) in self.numbered() {
            if let ChartLayer::Reference(reference) = layer {
                self.draw_reference(drawing, &mut obstacles, reference);
            }
        }
        for (number, layer) in self.numbered() {
            if let ChartLayer::Line(line) = layer {
                self.draw_line(drawing, &mut obstacles, number, line);
            }
        }
        for (number, layer) in self.numbered() {
            if let ChartLayer::Points(points) = layer {
                self.draw_points(drawing, &mut obstacles, number, points);
            }
        }
        obstacles
    }

    fn draw_windows(&self, drawing: &mut Drawing) {
        let frame = self.panel.frame;
        for (_, layer) in self.numbered() {
            if let ChartLayer::Window(window) = layer {
                let [from, to] = [window.from, window.to].map(|x| self.panel.across(x));
                let area = Rectangle {
                    left: from.min(to),
                    width: (to - from).abs(),
                    ..frame
                };
                let colour = self.tint(window.tint).faint(WINDOW_OPACITY);
                drawing
                    .layer("windows", Some(frame))
                    .rectangle(area, colour);
            }
        }
    }

    fn draw_band(
        &self,
        drawing: &mut Drawing,
        obstacles: &mut Obstacles,
        number: usize,
        band: &Band,
    ) {
        let colour = self.colour(number, band.look).faint(BAND_OPACITY);
        let layer = drawing.layer("bands", Some(self.panel.frame));
        let rows = |bound: &[f64], other: &[f64]| -> Vec<Row> {
            (0..band.x.len())
                .map(|row| {
                    // A row without its partner is in neither curve.
                    let y = if other[row].is_finite() {
                        bound[row]
                    } else {
                        f64::NAN
                    };
                    (band.x[row], y)
                })
                .collect()
        };
        let curves = [
            pieces(&self.panel, &rows(&band.upper, &band.lower)),
            pieces(&self.panel, &rows(&band.lower, &band.upper)),
        ];
        let [uppers, lowers] = curves;
        for (upper, lower) in uppers.into_iter().zip(lowers) {
            for (above, below) in upper.iter().zip(&lower) {
                obstacles.line(&[*above, *below]);
            }
            let [upper, lower] = [upper, lower].map(|curve| {
                let curve = if band.stepped { steps(&curve) } else { curve };
                thinned(&self.panel, curve)
            });
            obstacles.line(&upper);
            obstacles.line(&lower);
            layer.polygon(upper.into_iter().chain(lower.into_iter().rev()), colour);
        }
    }

    fn draw_bars(
        &self,
        drawing: &mut Drawing,
        obstacles: &mut Obstacles,
        number: usize,
        bars: &Bars,
    ) {
        let colour = self.colour(number, bars.look);
        let foot = self.panel.up(0.0).min(self.panel.frame.bottom());
        let layer = drawing.layer("bars", Some(self.panel.frame));
        let mut outline = Vec::new();
        for (edges, &height) in bars.edges.windows(2).zip(&bars.heights) {
            let top = if height.is_finite() {
                self.panel.up(height)
            } else {
                foot
            };
            let [left, right] = [edges[0], edges[1]].map(|edge| self.panel.across(edge));
            let area = Rectangle {
                left,
                top: top.min(foot),
                width: right - left,
                height: (foot - top).abs(),
            };
            if area.height > 0.0 {
                obstacles.area(area);
            }
            outline.extend([(left, top), (right, top)].map(|(x, y)| Point { x, y }));
        }
        if let (Some(&first), Some(&last)) = (outline.first(), outline.last()) {
            outline.insert(0, Point { y: foot, ..first });
            outline.push(Point { y: foot, ..last });
        }
        if !bars.outlined {
            layer.polygon(outline.iter().copied(), colour.faint(BAR_OPACITY));
        }
        layer.line(outline, Stroke::solid(colour, self.outline_weight(bars)));
    }

    pub(super) fn outline_weight(&self, bars: &Bars) -> f64 {
        if bars.outlined { 1.0 } else { 0.6 }
    }

    fn reference_stroke(&self, reference: &Reference) -> Stroke {
        let weight = if reference.tint == Tint::Grey {
            GUIDE_WEIGHT
        } else {
            REFERENCE_WEIGHT
        };
        Stroke::solid(self.tint(reference.tint), weight).dashed(reference.pattern.dash())
    }

    /// The line of a reference from side to side.
    pub(super) fn reference_line(&self, reference: &Reference) -> [Point; 2] {
        let frame = self.panel.frame;
        if reference.vertical {
            let x = self.panel.across(reference.value);
            [frame.bottom(), frame.top].map(|y| Point { x, y })
        } else {
            let y = self.panel.up(reference.value);
            [frame.left, frame.right()].map(|x| Point { x, y })
        }
    }

    fn draw_reference(
        &self,
        drawing: &mut Drawing,
        obstacles: &mut Obstacles,
        reference: &Reference,
    ) {
        let line = self.reference_line(reference);
        obstacles.line(&line);
        drawing
            .layer("references", Some(self.panel.frame))
            .segments(vec![line], self.reference_stroke(reference));
    }

    fn draw_line(
        &self,
        drawing: &mut Drawing,
        obstacles: &mut Obstacles,
        number: usize,
        line: &Line,
    ) {
        let stroke = self.line_stroke(number, line);
        let rows: Vec<Row> = line.x.iter().copied().zip(line.y.iter().copied()).collect();
        let layer = drawing.layer("lines", Some(self.panel.frame));
        for piece in pieces(&self.panel, &rows) {
            let piece = if line.stepped { steps(&piece) } else { piece };
            let piece = thinned(&self.panel, piece);
            obstacles.line(&piece);
            match piece.as_slice() {
                // A lone point has no line, but it must be seen.
                [lone] => layer.marks(
                    Outline::Circle {
                        radius: 0.7 * stroke.weight,
                    },
                    vec![*lone],
                    stroke.colour,
                    Stroke::solid(stroke.colour, 0.1),
                ),
                _ => layer.line(piece, stroke),
            }
        }
    }

    pub(super) fn line_stroke(&self, number: usize, line: &Line) -> Stroke {
        Stroke::solid(self.colour(number, line.look), line.weight).dashed(line.pattern.dash())
    }

    fn draw_points(
        &self,
        drawing: &mut Drawing,
        obstacles: &mut Obstacles,
        number: usize,
        points: &Points,
    ) {
        let colour = self.colour(number, points.look);
        let frame = self.panel.frame;
        let rows: Vec<usize> = (0..points.x.len())
            .filter(|&row| points.x[row].is_finite() && points.y[row].is_finite())
            .collect();
        let place = |row: usize| self.panel.place(points.x[row], points.y[row]);
        if points.joined {
            let line: Vec<Point> = rows.iter().map(|&row| place(row)).collect();
            obstacles.line(&line);
            drawing
                .layer("joins", Some(frame))
                .line(line, Stroke::solid(colour.faint(0.55), 0.6));
        }
        let mut bars = Vec::new();
        for &row in &rows {
            bars.extend(self.error_bars(points, row));
            if is_limit(points, row) {
                bars.extend(arrow(place(row)));
            }
        }
        for bar in &bars {
            obstacles.line(bar);
        }
        drawing
            .layer("error bars", Some(frame))
            .segments(bars, Stroke::solid(colour, BAR_WEIGHT));
        // A mark on the frame is whole; one beyond it would stand on the labels.
        let shown: Vec<usize> = rows
            .into_iter()
            .filter(|&row| within(frame, place(row)))
            .collect();
        for row in &shown {
            obstacles.line(&[place(*row)]);
        }
        let (limits, measured): (Vec<usize>, Vec<usize>) =
            shown.into_iter().partition(|&row| is_limit(points, row));
        let layer = drawing.layer("points", None);
        for (rows, open) in [(measured, points.open), (limits, true)] {
            if !rows.is_empty() {
                let mark = self.mark(number, points, open);
                let places = rows.into_iter().map(place).collect();
                layer.marks(mark.outline, places, mark.fill, mark.stroke);
            }
        }
    }

    /// Bars with caps of the errors of a row.
    fn error_bars(&self, points: &Points, row: usize) -> Vec<[Point; 2]> {
        let (x, y) = (points.x[row], points.y[row]);
        let centre = self.panel.place(x, y);
        let mut bars = Vec::new();
        let point = |x: f64, y: f64| Point { x, y };
        if let Some(errors) = &points.y_errors {
            let (low, high) = errors.ends(row, y);
            // An end that has no place on a logarithmic axis lies at the frame, where the window cuts its cap.
            let [bottom, top] = [low, high].map(|end| self.panel.up(end));
            if high > low {
                bars.push([point(centre.x, bottom), point(centre.x, top)]);
                for (end, is_there) in [(bottom, low < y), (top, high > y)] {
                    if is_there {
                        bars.push([point(centre.x - CAP, end), point(centre.x + CAP, end)]);
                    }
                }
            }
        }
        if let Some(errors) = &points.x_errors {
            let (low, high) = errors.ends(row, x);
            let [left, right] = [low, high].map(|end| self.panel.across(end));
            if high > low {
                bars.push([point(left, centre.y), point(right, centre.y)]);
                for (end, is_there) in [(left, low < x), (right, high > x)] {
                    if is_there {
                        bars.push([point(end, centre.y - CAP), point(end, centre.y + CAP)]);
                    }
                }
            }
        }
        bars
    }

    pub(super) fn mark(&self, number: usize, points: &Points, open: bool) -> Mark {
        let colour = self.colour(number, points.look);
        let radius = RADII
            .iter()
            .find(|(most, _)| points.x.len() <= *most)
            .map_or(RADII[0].1, |(_, radius)| *radius);
        let marker = points.marker.unwrap_or_else(|| points.look.marker(number));
        let white = crate::colour::WHITE;
        Mark {
            outline: marker.outline(radius),
            // An open mark lets see what lies below it.
            fill: if open { white.faint(0.2) } else { colour },
            // A white edge keeps marks apart that lie over each other.
            stroke: if open {
                Stroke::solid(colour, 0.75)
            } else {
                Stroke::solid(white, 0.3)
            },
            bars: Vec::new(),
            bar_stroke: Stroke::solid(colour, BAR_WEIGHT),
        }
    }
}

fn look(layer: &ChartLayer) -> Option<Look> {
    match layer {
        ChartLayer::Points(points) => Some(points.look),
        ChartLayer::Line(line) => Some(line.look),
        ChartLayer::Band(band) => Some(band.look),
        ChartLayer::Bars(bars) => Some(bars.look),
        ChartLayer::Reference(_) | ChartLayer::Window(_) | ChartLayer::Note(_) => None,
    }
}

fn is_limit(points: &Points, row: usize) -> bool {
    points.lower_limits.get(row).copied().unwrap_or(false)
}

/// An arrow upwards from a place.
pub(super) fn arrow(from: Point) -> [[Point; 2]; 3] {
    let tip = Point {
        y: from.y - ARROW,
        ..from
    };
    let barb = |side: f64| Point {
        x: tip.x + side * ARROW_HEAD,
        y: tip.y + 1.3 * ARROW_HEAD,
    };
    [[from, tip], [barb(-1.0), tip], [barb(1.0), tip]]
}

fn within(frame: Rectangle, place: Point) -> bool {
    const SLACK: f64 = 1e-6;
    (frame.left - SLACK..=frame.right() + SLACK).contains(&place.x)
        && (frame.top - SLACK..=frame.bottom() + SLACK).contains(&place.y)
}
