//! The layers of a panel as shapes on the page, and what they keep others from covering.

use super::curve::{pieces, steps, thinned};
use super::frame::Frame;
use super::layer::{
    Band, Bars, ChartLayer, Field, Kind, Line, Points, Reference, Spheres, Window, error_ends,
};
use super::look::{Look, Tint, marker};
use super::panel::ChartPanel;
use super::placement::Obstacles;
use crate::colour::{BLACK, Colour, GREY, WHITE};
use crate::colour_scale::ColourScale;
use crate::drawing::{Drawing, Fill, Image, Layer, Pattern, Stroke};
use crate::geometry::{Path, Point, Rectangle};
use crate::legend::Mark;

/// Radius of a mark in points, by the number of points of a series up to which it is used.
pub(super) const RADII: [(usize, f64); 3] = [(150, 1.9), (1500, 1.3), (usize::MAX, 0.8)];
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
/// Colour of cells without a value.
pub(super) const MISSING: Colour = Colour::new(190, 190, 190);
/// Fill and edge of a sphere without a value, and edge of one with a value.
const FAINT_SPHERE: Colour = GREY.faint(0.16);
const FAINT_EDGE: Stroke = Stroke::solid(GREY.faint(0.55), 0.3);
const SPHERE_EDGE: Stroke = Stroke::solid(BLACK.faint(0.65), 0.25);

/// Draws the layers of one panel.
pub(super) struct Painter<'a> {
    pub(super) frame: Frame,
    pub(super) chart: &'a ChartPanel,
    pub(super) scale: Option<&'a ColourScale>,
    /// Values that colour points anywhere in the figure, ascending: each has one marker everywhere.
    pub(super) values: &'a [f64],
    pub(super) drawing: &'a mut Drawing,
    /// What must not be covered.
    pub(super) obstacles: Obstacles,
}

impl<'a> Painter<'a> {
    /// The layers, each with its number among those that have no series of their own.
    pub(super) fn numbered(&self) -> impl Iterator<Item = (usize, &'a ChartLayer)> + use<'a> {
        self.chart.layers.iter().scan(0, |next, layer| {
            let number = *next;
            let has_series = layer.facts().look.is_some_and(|look| look.series.is_some());
            *next += usize::from(layer.is_series() && !has_series);
            Some((number, layer))
        })
    }

    pub(super) fn colour(&self, number: usize, look: Look) -> Colour {
        look.colour(number, self.scale)
    }

    /// A new layer of the page that nothing leaves the frame on.
    fn layer(&mut self, name: &'static str) -> &mut Layer {
        self.drawing.layer(name, Some(self.frame.area))
    }

    /// Everything but frame and texts.
    pub(super) fn draw_layers(&mut self) {
        let mut layers: Vec<(usize, &ChartLayer)> = self.numbered().collect();
        layers.sort_by_key(|(_, layer)| layer.facts().depth);
        for (number, layer) in layers {
            let colour = self.colour(number, layer.facts().look.unwrap_or_default());
            match &layer.0 {
                Kind::Field(field) => self.draw_field(field),
                Kind::Window(window) => self.draw_window(window, colour),
                Kind::Band(band) => self.draw_band(band, colour),
                Kind::Bars(bars) => self.draw_bars(bars, colour),
                Kind::Spheres(spheres) => self.draw_spheres(spheres),
                Kind::Reference(reference) => self.draw_reference(reference, colour),
                Kind::Line(line) => self.draw_line(line, colour),
                Kind::Points(points) => {
                    self.draw_points(points, colour);
                    self.draw_marks(points, number);
                }
                Kind::Key(_) | Kind::Note(_) => {}
            }
        }
    }

    fn draw_field(&mut self, field: &Field) {
        let Some(scale) = self.scale else { return };
        let (columns, values) = field.shown(&self.frame);
        let colour = |value: f64| {
            if value.is_finite() {
                scale.colour(value)
            } else {
                MISSING
            }
        };
        let [start, end] =
            [(field.x.0, field.y.1), (field.x.1, field.y.0)].map(|(x, y)| self.frame.place(x, y));
        let area = Rectangle::between((start.x, end.x), (start.y, end.y));
        self.obstacles.area(area);
        let image = Image::of_cells(area, columns, values.into_iter().map(colour));
        self.layer("field").image(image);
    }

    fn draw_window(&mut self, window: &Window, colour: Colour) {
        let [from, to] = [window.from, window.to].map(|x| self.frame.across(x));
        let area = Rectangle {
            left: from.min(to),
            width: (to - from).abs(),
            ..self.frame.area
        };
        let (path, fill) = (Path::polygon(area.corners()), colour.faint(WINDOW_OPACITY));
        self.layer("windows").fill(path, fill);
    }

    fn draw_band(&mut self, band: &Band, colour: Colour) {
        let layer = self.drawing.layer("bands", Some(self.frame.area));
        let bounds = band.pairs();
        let [uppers, lowers] = bounds.map(|bound| pieces(&self.frame, &band.x, &bound));
        for (upper, lower) in uppers.into_iter().zip(lowers) {
            for (above, below) in upper.iter().zip(&lower) {
                self.obstacles.line(&[*above, *below]);
            }
            let [upper, lower] = [upper, lower].map(|curve| thinned(&self.frame, curve));
            self.obstacles.line(&upper);
            self.obstacles.line(&lower);
            let path = Path::polygon(upper.into_iter().chain(lower.into_iter().rev()));
            layer.fill(path, colour.faint(BAND_OPACITY));
        }
    }

    fn draw_bars(&mut self, bars: &Bars, colour: Colour) {
        let frame = self.frame;
        let foot = frame.up(0.0).min(frame.area.bottom());
        let end = |edge: f64| Point::new(frame.across(edge), foot);
        let mut outline: Vec<Point> = bars.edges.first().copied().map(end).into_iter().collect();
        for (edges, &height) in bars.edges.windows(2).zip(&bars.heights) {
            let top = if height.is_finite() {
                frame.up(height)
            } else {
                foot
            };
            let [left, right] = [edges[0], edges[1]].map(|edge| frame.across(edge));
            let area = Rectangle::between((left, right), (top.min(foot), top.max(foot)));
            if area.height > 0.0 {
                self.obstacles.area(area);
            }
            outline.extend([left, right].map(|x| Point::new(x, top)));
        }
        outline.extend(bars.edges.last().copied().map(end));
        let fill = Some(Fill::Flat(colour.faint(BAR_OPACITY)));
        let stroke = Some(Stroke::solid(colour, BAR_WEIGHT));
        self.layer("bars").path(Path::line(outline), fill, stroke);
    }

    fn draw_spheres(&mut self, spheres: &Spheres) {
        let layer = self.drawing.layer("spheres", Some(self.frame.area));
        let (from, to) = self.frame.x.range();
        let scale = self.frame.area.width / (to - from);
        let places = spheres.x.iter().zip(&spheres.y).zip(&spheres.diameter);
        for (index, ((&x, &y), diameter)) in places.enumerate() {
            let centre = self.frame.place(x, y);
            let value = spheres.values.get(index).zip(self.scale);
            let (fill, edge) = match value {
                Some((value, scale)) => (Fill::Sphere(scale.colour(*value)), SPHERE_EDGE),
                None => (Fill::Flat(FAINT_SPHERE), FAINT_EDGE),
            };
            self.obstacles.line(&[centre]);
            let path = Path::circle(centre, scale * diameter / 2.0);
            layer.path(path, Some(fill), Some(edge));
        }
    }

    /// The line of a reference from side to side.
    pub(super) fn reference_line(&self, reference: &Reference) -> [Point; 2] {
        let area = self.frame.area;
        if reference.vertical {
            let x = self.frame.across(reference.value);
            [area.bottom(), area.top].map(|y| Point::new(x, y))
        } else {
            let y = self.frame.up(reference.value);
            [area.left, area.right()].map(|x| Point::new(x, y))
        }
    }

    fn draw_reference(&mut self, reference: &Reference, colour: Colour) {
        let line = self.reference_line(reference);
        self.obstacles.line(&line);
        let is_guide = reference.look.tint == Some(Tint::Grey);
        let (guide, usual) = (GUIDE_WEIGHT, REFERENCE_WEIGHT);
        let stroke = Stroke {
            colour,
            weight: if is_guide { guide } else { usual },
            pattern: reference.pattern,
        };
        self.layer("references").stroke(Path::line(line), stroke);
    }

    fn draw_line(&mut self, line: &Line, colour: Colour) {
        let layer = self.drawing.layer("lines", Some(self.frame.area));
        for piece in pieces(&self.frame, &line.x, &line.y) {
            let piece = if line.stepped { steps(&piece) } else { piece };
            let piece = thinned(&self.frame, piece);
            self.obstacles.line(&piece);
            match piece.as_slice() {
                // A lone point has no line, but it must be seen.
                [lone] => layer.fill(Path::circle(*lone, 0.7 * line.weight), colour),
                _ => layer.stroke(Path::line(piece), line.stroke(colour)),
            }
        }
    }

    /// The line that joins points, and their error bars.
    fn draw_points(&mut self, points: &Points, colour: Colour) {
        let frame = self.frame;
        let place = |row: usize| frame.place(points.x[row], points.y[row]);
        if points.joined {
            let rows: Vec<usize> = points.rows().collect();
            let (x, stroke) = (&points.x, join_stroke(colour));
            for piece in rows.chunk_by(|&one, &next| !points.jumps_between(x[one], x[next])) {
                let line: Vec<Point> = piece.iter().copied().map(place).collect();
                self.obstacles.line(&line);
                self.layer("joins").stroke(Path::line(line), stroke);
            }
            let pairs = rows.windows(2);
            for pair in pairs.filter(|pair| points.jumps_between(x[pair[0]], x[pair[1]])) {
                let line = [place(pair[0]), place(pair[1])];
                self.obstacles.line(&line);
                let pattern = Pattern::Dotted;
                let hint = Stroke { pattern, ..stroke };
                self.layer("joins").stroke(Path::line(line), hint);
            }
        }
        let mut bars = Vec::new();
        for row in points.rows() {
            bars.extend(error_bars(&frame, points, row));
            if points.is_limit(row) {
                bars.extend(arrow(place(row)));
            }
        }
        bars.iter().for_each(|bar| self.obstacles.line(bar));
        let pen = Stroke::solid(colour, BAR_WEIGHT);
        self.layer("error bars").stroke(Path::segments(bars), pen);
    }

    /// The marks of points.
    fn draw_marks(&mut self, points: &Points, number: usize) {
        let frame = self.frame;
        let place = |row: usize| frame.place(points.x[row], points.y[row]);
        let [filled, open] = [points.open, true].map(|open| self.mark(number, points, open));
        // A mark on the frame is whole; one beyond it would stand on the labels.
        let shown = points.rows().filter(|&row| frame.area.holds(place(row)));
        let (limits, measured): (Vec<usize>, Vec<usize>) =
            shown.partition(|&row| points.is_limit(row));
        let layer = self.drawing.layer("points", None);
        for (rows, mark) in [(measured, filled), (limits, open)] {
            let places: Vec<Point> = rows.into_iter().map(place).collect();
            for place in &places {
                self.obstacles.line(&[*place]);
            }
            let (fill, stroke) = (Some(Fill::Flat(mark.fill)), Some(mark.stroke));
            layer.path(mark.outline.at(places), fill, stroke);
        }
    }

    pub(super) fn mark(&self, number: usize, points: &Points, open: bool) -> Mark {
        let colour = self.colour(number, points.look);
        let radius = RADII
            .iter()
            .find(|(most, _)| points.x.len() <= *most)
            .map_or(RADII[0].1, |(_, radius)| *radius);
        let rank = || {
            let value = points.look.value()?;
            self.values.iter().position(|it| *it == value)
        };
        let shape = points.look.series.or_else(rank).unwrap_or(number);
        Mark::new(marker(shape, radius), colour, open)
    }
}

impl Mark {
    /// A mark of an outline in a colour.
    pub(super) fn new(outline: Path, colour: Colour, open: bool) -> Self {
        // An open mark lets see what lies below it; a white edge keeps marks apart that lie over each other.
        let (fill, stroke) = if open {
            (WHITE.faint(0.2), Stroke::solid(colour, 0.75))
        } else {
            (colour, Stroke::solid(WHITE, 0.3))
        };
        Self {
            outline,
            fill,
            stroke,
            bars: Vec::new(),
            bar_stroke: Stroke::solid(colour, BAR_WEIGHT),
        }
    }
}

impl Line {
    pub(super) fn stroke(&self, colour: Colour) -> Stroke {
        Stroke {
            colour,
            weight: self.weight,
            pattern: self.pattern,
        }
    }
}

/// Bars with caps of the errors of a row.
fn error_bars(frame: &Frame, points: &Points, row: usize) -> Vec<[Point; 2]> {
    let (x, y) = (points.x[row], points.y[row]);
    let centre = frame.place(x, y);
    // An end that has no place on a logarithmic axis lies at the frame, where the window cuts its cap.
    let up = error_ends(&points.y_errors, row, y).map(|end| frame.up(end));
    let across = error_ends(&points.x_errors, row, x).map(|end| frame.across(end));
    let mut bars = Vec::new();
    if up[0] != up[1] {
        bars.push(up.map(|end| Point::new(centre.x, end)));
        bars.extend(up.map(|end| [-CAP, CAP].map(|side| Point::new(centre.x + side, end))));
    }
    if across[0] != across[1] {
        bars.push(across.map(|end| Point::new(end, centre.y)));
        bars.extend(across.map(|end| [-CAP, CAP].map(|side| Point::new(end, centre.y + side))));
    }
    bars
}

/// The line from point to point.
pub(super) fn join_stroke(colour: Colour) -> Stroke {
    Stroke::solid(colour.faint(0.55), 0.6)
}

/// An arrow upwards from a place.
pub(super) fn arrow(from: Point) -> [[Point; 2]; 3] {
    let tip = Point::new(from.x, from.y - ARROW);
    let barb = |side: f64| Point::new(side * ARROW_HEAD, 1.3 * ARROW_HEAD).from(tip);
    [[from, tip], [barb(-1.0), tip], [barb(1.0), tip]]
}
