//! The look that all figures share: widths, sizes of type and weights of lines, in points (1 pt = 1/72 inch).

/// Width of a figure on the journal's page.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Width {
    /// One column, 86 mm.
    #[default]
    SingleColumn,
    /// The whole page, 178 mm.
    DoubleColumn,
}

/// Points in a millimetre.
pub(crate) const POINTS_PER_MILLIMETRE: f64 = 72.0 / 25.4;

impl Width {
    /// The width in points.
    pub(crate) fn points(self) -> f64 {
        match self {
            Self::SingleColumn => 86.0 * POINTS_PER_MILLIMETRE,
            Self::DoubleColumn => 178.0 * POINTS_PER_MILLIMETRE,
        }
    }
}

pub(crate) const TITLE_SIZE: f64 = 7.5;
pub(crate) const LABEL_SIZE: f64 = 8.0;
pub(crate) const TICK_SIZE: f64 = 7.0;
pub(crate) const LEGEND_SIZE: f64 = 6.8;

pub(crate) const FRAME_WEIGHT: f64 = 0.55;
pub(crate) const MAJOR_TICK: f64 = 3.0;
pub(crate) const MINOR_TICK: f64 = 1.6;

/// Free space at the right edge of the page.
pub(crate) const RIGHT_MARGIN: f64 = 6.0;
/// Vertical space that a line of title takes.
pub(crate) const TITLE_SPACE: f64 = 11.5;
/// Space below a frame for the labels of its ticks.
pub(crate) const TICK_SPACE: f64 = 10.0;
/// Space below the tick labels for the name of the axis.
pub(crate) const LABEL_SPACE: f64 = 11.5;
/// Distance of the vertical axis label's baseline from the left edge of the page.
pub(crate) const LABEL_BASELINE: f64 = 8.5;
/// Gap between a frame and the labels of its ticks.
pub(crate) const TICK_GAP: f64 = 3.0;
