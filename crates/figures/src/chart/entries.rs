//! What the layers of a panel mean, as its legend says it.

use super::key::Sample;
use super::layer::{ChartLayer, Kind};
use super::look::marker;
use super::paint::{BAND_OPACITY, BAR_OPACITY, Painter, RADII, WINDOW_OPACITY, arrow, join_stroke};
use crate::geometry::Point;
use crate::legend::{Entry, Mark};

/// How far a lower limit stands below the middle of its row, so that its arrow has room; the arrow is shorter there.
const LIMIT_DROP: f64 = 2.0;
const ARROW_PART: f64 = 0.55;

impl Painter<'_> {
    /// What the layers mean; layers of one name share an entry.
    pub(super) fn entries(&self) -> Vec<Entry> {
        let mut entries: Vec<Entry> = Vec::new();
        let of_layers = self.numbered();
        let all = of_layers.flat_map(|(number, layer)| self.entries_of(number, layer));
        for entry in all.filter(|entry| !entry.meaning.is_empty()) {
            match entries.iter_mut().find(|other| other.takes(&entry)) {
                Some(other) => {
                    other.line = other.line.or(entry.line);
                    other.band = other.band.or(entry.band);
                    other.mark = other.mark.take().or(entry.mark);
                }
                None => entries.push(entry),
            }
        }
        entries
    }

    fn entries_of(&self, number: usize, layer: &ChartLayer) -> Vec<Entry> {
        let colour = self.colour(number, layer.facts().look.unwrap_or_default());
        let named = |meaning: &str| Entry {
            meaning: meaning.to_owned(),
            ..Entry::default()
        };
        let area = |meaning: &str, opacity: f64| Entry {
            band: Some(colour.faint(opacity)),
            ..named(meaning)
        };
        match &layer.0 {
            Kind::Points(points) => {
                let below = Point::new(0.0, LIMIT_DROP);
                let mark = self.mark(number, points, true);
                let shorter = |end: Point| Point::new(end.x, ARROW_PART * end.y).from(below);
                let arrow = arrow(Point::new(0.0, 0.0)).map(|bar| bar.map(shorter));
                let limit = Mark {
                    outline: mark.outline.at([below]),
                    bars: arrow.to_vec(),
                    ..mark
                };
                vec![
                    Entry {
                        mark: Some(self.mark(number, points, points.open)),
                        line: points.joined.then_some(join_stroke(colour)),
                        ..named(&points.name)
                    },
                    Entry {
                        mark: Some(limit),
                        ..named(&points.limit_name)
                    },
                ]
            }
            Kind::Line(line) => vec![Entry {
                line: Some(line.stroke(colour)),
                ..named(&line.name)
            }],
            Kind::Band(band) => vec![area(&band.name, BAND_OPACITY)],
            Kind::Bars(bars) => vec![area(&bars.name, BAR_OPACITY)],
            Kind::Window(window) => vec![area(&window.name, WINDOW_OPACITY * 1.4)],
            Kind::Key(key) => {
                let marked = |open: bool| Entry {
                    mark: Some(Mark::new(marker(0, RADII[0].1), colour, open)),
                    ..named(&key.name)
                };
                vec![match key.sample {
                    Sample::Filled => marked(false),
                    Sample::Open => marked(true),
                    Sample::Area => area(&key.name, WINDOW_OPACITY * 1.4),
                }]
            }
            Kind::Field(_) | Kind::Spheres(_) | Kind::Reference(_) | Kind::Note(_) => Vec::new(),
        }
    }
}

impl Entry {
    /// Whether another entry means the same by another sample.
    fn takes(&self, other: &Self) -> bool {
        self.meaning == other.meaning
            && !(self.line.is_some() && other.line.is_some())
            && !(self.mark.is_some() && other.mark.is_some())
            && !(self.band.is_some() && other.band.is_some())
    }
}
