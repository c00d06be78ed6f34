//! Notes and labels of reference lines.

use super::layer::{ChartLayer, Corner, Note, Place, Reference};
use super::paint::Painter;
use super::placement::{INSET, Obstacles};
use crate::drawing::{Anchor, Drawing, Rectangle};
use crate::style::LEGEND_SIZE;
use crate::text::{DIGIT_HEIGHT, Text};

/// Distance of a label from its reference line.
const LABEL_GAP: f64 = 2.0;
/// Places tried for the label of a reference line from end to end.
const LABEL_TRIALS: usize = 16;

impl Painter<'_> {
    /// Notes where they were put, then labels of reference lines where they cover least.
    pub(super) fn draw_texts(&self, drawing: &mut Drawing, obstacles: &mut Obstacles) {
        for (_, layer) in self.numbered() {
            if let ChartLayer::Note(note) = layer {
                self.draw_note(drawing, obstacles, note);
            }
        }
        for (_, layer) in self.numbered() {
            if let ChartLayer::Reference(reference) = layer {
                self.draw_reference_label(drawing, obstacles, reference);
            }
        }
    }

    fn draw_reference_label(
        &self,
        drawing: &mut Drawing,
        obstacles: &mut Obstacles,
        reference: &Reference,
    ) {
        if reference.label.is_empty() {
            return;
        }
        let frame = self.panel.frame;
        let [start, _] = self.reference_line(reference);
        let length = if reference.vertical {
            frame.height
        } else {
            frame.width
        };
        let text = Text::fitted(&reference.label, LEGEND_SIZE, length - 2.0 * INSET);
        let (long, thick) = (text.width, LEGEND_SIZE);
        let gap = LABEL_GAP + 1.0;
        let places = (0..=LABEL_TRIALS).flat_map(|trial| {
            let share = 1.0 - trial as f64 / LABEL_TRIALS as f64;
            let along = INSET + share * (length - 2.0 * INSET - long);
            [true, false].map(|before| {
                if reference.vertical {
                    Rectangle {
                        left: start.x + if before { -gap - thick } else { gap },
                        top: frame.bottom() - along - long,
                        width: thick,
                        height: long,
                    }
                } else {
                    Rectangle {
                        left: frame.left + along,
                        top: start.y + if before { -gap - thick } else { gap },
                        width: long,
                        height: thick,
                    }
                }
            })
        });
        let inside = places.filter(|place| {
            place.left > frame.left
                && place.right() < frame.right()
                && place.top > frame.top
                && place.bottom() < frame.bottom()
        });
        // Only a frame smaller than its type leaves no place.
        let Some((place, _)) = obstacles.freest(inside) else {
            return;
        };
        obstacles.area(place);
        let colour = self.tint(reference.tint);
        let layer = drawing.layer("reference labels", None);
        if reference.vertical {
            let baseline = place.left + 0.86 * LEGEND_SIZE;
            layer.upward_text((baseline, place.bottom()), Anchor::Start, text, colour);
        } else {
            let baseline = place.top + 0.86 * LEGEND_SIZE;
            layer.text((place.left, baseline), Anchor::Start, text, colour);
        }
    }

    fn draw_note(&self, drawing: &mut Drawing, obstacles: &mut Obstacles, note: &Note) {
        let frame = self.panel.frame;
        let text = Text::fitted(&note.text, LEGEND_SIZE, frame.width - 2.0 * INSET);
        let (left, right) = (frame.left + INSET, frame.right() - INSET - text.width);
        let (top, bottom) = (frame.top + INSET, frame.bottom() - INSET - LEGEND_SIZE);
        let (x, y) = match note.place {
            Place::At(x, y) => {
                let place = self.panel.place(x, y);
                (
                    place.x.min(right).max(left),
                    (place.y - LEGEND_SIZE / 2.0).min(bottom).max(top),
                )
            }
            Place::In(Corner::TopLeft) => (left, top),
            Place::In(Corner::TopRight) => (right, top),
            Place::In(Corner::BottomLeft) => (left, bottom),
            Place::In(Corner::BottomRight) => (right, bottom),
        };
        obstacles.area(Rectangle {
            left: x,
            top: y,
            width: text.width,
            height: LEGEND_SIZE,
        });
        let baseline = y + (LEGEND_SIZE + DIGIT_HEIGHT * LEGEND_SIZE) / 2.0;
        let colour = self.tint(note.tint);
        drawing
            .layer("notes", None)
            .text((x, baseline), Anchor::Start, text, colour);
    }
}
