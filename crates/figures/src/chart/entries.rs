//! What the layers of a panel mean, as its legend says it.

use super::layer::ChartLayer;
use super::paint::{BAND_OPACITY, BAR_OPACITY, Painter, WINDOW_OPACITY, arrow};
use crate::drawing::{Point, Stroke};
use crate::legend::{Entry, Mark};

impl Painter<'_> {
    /// What the layers mean; layers of one name share an entry.
    pub(super) fn entries(&self) -> Vec<Entry> {
        let mut entries: Vec<Entry> = Vec::new();
        for (number, layer) in self.numbered() {
            for entry in self.entries_of(number, layer) {
                let fits = |other: &&mut Entry| {
                    other.meaning == entry.meaning
                        && !(other.line.is_some() && entry.line.is_some())
                        && !(other.mark.is_some() && entry.mark.is_some())
                        && !(other.band.is_some() && entry.band.is_some())
                };
                match entries.iter_mut().find(fits) {
                    _ if entry.meaning.is_empty() => {}
                    Some(other) => {
                        other.line = other.line.or(entry.line);
                        other.band = other.band.or(entry.band);
                        other.mark = other.mark.take().or(entry.mark);
                    }
                    None => entries.push(entry),
                }
            }
        }
        entries
    }

    fn entries_of(&self, number: usize, layer: &ChartLayer) -> Vec<Entry> {
        let named = |meaning: &str| Entry {
            meaning: meaning.to_owned(),
            ..Entry::default()
        };
        match layer {
            ChartLayer::Points(points) => {
                let origin = Point { x: 0.0, y: 0.0 };
                let limit = Mark {
                    bars: arrow(origin)
                        .map(|bar| {
                            bar.map(|end| Point {
                                y: 0.55 * end.y + 2.0,
                                ..end
                            })
                        })
                        .to_vec(),
                    ..self.mark(number, points, true)
                };
                let limit = Mark {
                    outline: limit.outline.lowered(2.0),
                    ..limit
                };
                let colour = self.colour(number, points.look).faint(0.55);
                vec![
                    Entry {
                        mark: Some(self.mark(number, points, points.open)),
                        line: points.joined.then_some(Stroke::solid(colour, 0.6)),
                        ..named(&points.name)
                    },
                    Entry {
                        mark: Some(limit),
                        ..named(&points.limit_name)
                    },
                ]
            }
            ChartLayer::Line(line) => vec![Entry {
                line: Some(self.line_stroke(number, line)),
                ..named(&line.name)
            }],
            ChartLayer::Band(band) => vec![Entry {
                band: Some(self.colour(number, band.look).faint(BAND_OPACITY)),
                ..named(&band.name)
            }],
            ChartLayer::Bars(bars) => {
                let colour = self.colour(number, bars.look);
                vec![Entry {
                    band: (!bars.outlined).then_some(colour.faint(BAR_OPACITY)),
                    line: bars
                        .outlined
                        .then_some(Stroke::solid(colour, self.outline_weight(bars))),
                    ..named(&bars.name)
                }]
            }
            ChartLayer::Window(window) => vec![Entry {
                band: Some(self.tint(window.tint).faint(WINDOW_OPACITY * 1.4)),
                ..named(&window.name)
            }],
            ChartLayer::Reference(_) | ChartLayer::Note(_) => Vec::new(),
        }
    }
}
