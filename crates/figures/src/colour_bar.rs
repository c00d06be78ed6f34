//! The diverging colours with the velocities that they mean.

use crate::axis::three_digits;
use crate::colour::{BLACK, diverging};
use crate::drawing::{Anchor, Drawing, Rectangle, Stroke};
use crate::style::{FRAME_WEIGHT, TICK_SIZE};
use crate::text::{DIGIT_HEIGHT, Text};

/// Height of the bar alone, in points.
pub(crate) const BAR_HEIGHT: f64 = 6.0;
const BAR_WIDTH: f64 = 90.0;
const BAR_STEPS: usize = 49;

/// The colours with their velocities; the ends say so where grains go faster.
pub(crate) fn draw_colour_bar(
    drawing: &mut Drawing,
    middle: f64,
    top: f64,
    limit: f64,
    (slowest, fastest): (f64, f64),
) {
    let area = Rectangle {
        left: middle - BAR_WIDTH / 2.0,
        top,
        width: BAR_WIDTH,
        height: BAR_HEIGHT,
    };
    let layer = drawing.layer("colour bar", None);
    let step = area.width / BAR_STEPS as f64;
    for index in 0..BAR_STEPS {
        let value = 2.0 * index as f64 / (BAR_STEPS - 1) as f64 - 1.0;
        // Each step reaches under the next, so that no seam shows.
        let overlap = if index + 1 < BAR_STEPS { 0.4 } else { 0.0 };
        let part = Rectangle {
            left: area.left + step * index as f64,
            width: step + overlap,
            ..area
        };
        layer.rectangle(part, diverging(value));
    }
    layer.outline(area, Stroke::solid(BLACK, FRAME_WEIGHT));
    let number = three_digits(limit);
    let number = if number.contains('.') {
        number
            .trim_end_matches('0')
            .trim_end_matches('.')
            .to_owned()
    } else {
        number
    };
    let ends = [
        (
            area.left,
            format!(
                "{}\u{2212}{number}",
                if slowest < -limit { "≤ " } else { "" }
            ),
        ),
        (middle, "0".to_owned()),
        (
            area.right(),
            format!("{}{number}", if fastest > limit { "≥ " } else { "" }),
        ),
    ];
    let baseline = area.bottom() + 2.0 + DIGIT_HEIGHT * TICK_SIZE;
    for (place, label) in ends {
        layer.text(
            (place, baseline),
            Anchor::Middle,
            Text::new(&label, TICK_SIZE),
            BLACK,
        );
    }
    let side = area.bottom() - 0.3;
    layer.text(
        (area.left - 5.0, side),
        Anchor::End,
        Text::new("against the wave", TICK_SIZE),
        BLACK,
    );
    layer.text(
        (area.right() + 5.0, side),
        Anchor::Start,
        Text::new("along the wave, *v_z*/*c*", TICK_SIZE),
        BLACK,
    );
}
