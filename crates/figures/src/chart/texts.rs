//! Notes and labels of reference lines.

use super::layer::{ChartLayer, Corner, Kind, Note, Reference};
use super::paint::Painter;
use super::placement::INSET;
use crate::drawing::Anchor;
use crate::geometry::Rectangle;
use crate::style::LEGEND_SIZE;
use crate::text::{DIGIT_HEIGHT, Text};

/// Distance of a label from its reference line.
const LABEL_GAP: f64 = 3.0;
/// Places tried for the label of a reference line from end to end.
const LABEL_TRIALS: usize = 16;
/// Height of a line of type above its baseline, as a part of its box.
const ABOVE_BASELINE: f64 = 0.86;

impl Painter<'_> {
    /// Notes where they were put, then labels of reference lines where they cover least.
    pub(super) fn draw_texts(&mut self) {
        let chart = self.chart;
        for layer in &chart.layers {
            if let ChartLayer(Kind::Note(note)) = layer {
                self.draw_note(note);
            }
        }
        for layer in &chart.layers {
            if let ChartLayer(Kind::Reference(reference)) = layer
                && !reference.label.is_empty()
            {
                self.draw_reference_label(reference);
            }
        }
    }

    fn draw_reference_label(&mut self, reference: &Reference) {
        let frame = self.frame.area;
        let [start, _] = self.reference_line(reference);
        let is_vertical = reference.vertical;
        let length = if is_vertical {
            frame.height
        } else {
            frame.width
        };
        let text = Text::fitted(&reference.label, LEGEND_SIZE, length - 2.0 * INSET);
        let (long, thick) = (text.width, LEGEND_SIZE);
        let shares = || (0..=LABEL_TRIALS).map(|trial| 1.0 - trial as f64 / LABEL_TRIALS as f64);
        let along_line = shares().flat_map(|share| {
            let along = INSET + share * (length - 2.0 * INSET - long);
            [-LABEL_GAP - thick, LABEL_GAP].map(|beside| {
                if is_vertical {
                    let top = frame.bottom() - along - long;
                    Rectangle::new((start.x + beside, top), (thick, long))
                } else {
                    Rectangle::new((frame.left + along, start.y + beside), (long, thick))
                }
            })
        });
        // A label along a vertical line crosses many others: it may stand upright beside its line.
        let upright = shares().filter(|_| is_vertical).flat_map(|share| {
            let room = frame.height - 2.0 * INSET - thick;
            let top = frame.bottom() - INSET - share * room - thick;
            [LABEL_GAP, -LABEL_GAP - long]
                .map(|beside| Rectangle::new((start.x + beside, top), (long, thick)))
        });
        let places = along_line.chain(upright);
        let is_inside = |place: &Rectangle| place.corners().iter().all(|it| frame.holds(*it));
        // Only a frame smaller than its type leaves no place.
        let Some((place, _)) = self.obstacles.freest(places.filter(is_inside)) else {
            return;
        };
        self.obstacles.area(place);
        let colour = self.colour(0, reference.look);
        let layer = self.drawing.layer("reference labels", None);
        if place.height > place.width {
            let baseline = place.left + ABOVE_BASELINE * LEGEND_SIZE;
            let foot = (baseline, place.bottom());
            layer.text_upward(foot, Anchor::Start, text, colour);
        } else {
            let baseline = place.top + ABOVE_BASELINE * LEGEND_SIZE;
            layer.text((place.left, baseline), Anchor::Start, text, colour);
        }
    }

    fn draw_note(&mut self, note: &Note) {
        let frame = self.frame.area;
        let text = Text::fitted(&note.text, LEGEND_SIZE, frame.width - 2.0 * INSET);
        let left = frame.left + INSET;
        let top = match note.corner {
            Corner::TopLeft => frame.top + INSET,
            Corner::BottomLeft => frame.bottom() - INSET - LEGEND_SIZE,
        };
        let area = Rectangle::new((left, top), (text.width, LEGEND_SIZE));
        self.obstacles.area(area);
        let baseline = top + (LEGEND_SIZE + DIGIT_HEIGHT * LEGEND_SIZE) / 2.0;
        let colour = self.colour(0, note.look);
        let layer = self.drawing.layer("notes", None);
        layer.text((left, baseline), Anchor::Start, text, colour);
    }
}
