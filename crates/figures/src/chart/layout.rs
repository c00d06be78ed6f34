//! Where the panels of a chart stand on the page.

use super::ChartFigure;
use super::check::Checked;
use super::paint::ARROW;
use super::panel::{AxisWish, ChartPanel, MARGIN};
use crate::axis::{Axis, Tick};
use crate::drawing::{Drawing, Rectangle};
use crate::error::FigureError;
use crate::panel::{BOTTOM_MARGIN, Labels, Panel, TICK_GAP, Ticks, title_space};
use crate::style::{LABEL_BASELINE, POINTS_PER_MILLIMETRE, RIGHT_MARGIN, TICK_SIZE, Width};
use crate::text::Text;

/// Height of a frame over its width: in a lone panel two columns wide, and otherwise.
const WIDE_ASPECT: f64 = 0.45;
const ASPECT: f64 = 0.72;
/// A frame is no lower than this unless it is asked for.
const LEAST_HEIGHT: f64 = 85.0;
const TOP_MARGIN: f64 = 4.0;
/// Space above a frame for its letter and title.
const HEADER_SPACE: f64 = 9.5;
/// Space between frames that share an axis.
const GAP: f64 = 6.0;
/// Space between the name of a vertical axis and its numbers.
const NAME_GAP: f64 = 4.0;
/// Space between numbers of neighbouring frames.
const NUMBER_GAP: f64 = 5.0;
/// Room for a number on a vertical axis, its gap included.
const NUMBER_ROOM: f64 = 9.0;
/// Points of an axis for each label at most.
const ROOM_ACROSS: f64 = 26.0;
const ROOM_UP: f64 = 13.5;
/// About as many labels as an axis bears without a crowd, however long.
const MOST_ACROSS: usize = 9;
const MOST_UP: usize = 7;
/// First guess of the space at the left of a frame, from which its height follows.
const USUAL_LEFT: f64 = 32.0;

/// The panels on the page.
pub(super) struct Layout {
    pub(super) seats: Vec<Seat>,
}

/// A panel on the page.
pub(super) struct Seat {
    pub(super) panel: Panel,
    ticks: Ticks,
    bears_x: bool,
}

/// The axes of a panel before it has a place.
struct Axes {
    x: Axis,
    y: Axis,
}

impl Layout {
    pub(super) fn of(figure: &ChartFigure) -> Result<Self, FigureError> {
        let page = figure.width.points();
        let columns = figure.columns;
        let count = figure.panels.len();
        let guess = (page - USUAL_LEFT * columns as f64 - RIGHT_MARGIN) / columns as f64;
        let aspect = if columns == 1 && figure.width == Width::DoubleColumn {
            WIDE_ASPECT
        } else {
            ASPECT
        };
        let height = figure
            .panel_height
            .map_or((guess * aspect).max(LEAST_HEIGHT), |height| {
                height * POINTS_PER_MILLIMETRE
            });
        let axes = axes(figure, height)?;
        let spaces = Spaces::of(figure, &axes, height);
        let width = (page - spaces.right - spaces.left.iter().sum::<f64>()) / columns as f64;
        let rows = count.div_ceil(columns);

        let header = if figure.has_headers() {
            HEADER_SPACE
        } else {
            0.0
        };
        let mut seats = Vec::with_capacity(count);
        let mut top = title_space(&figure.title) + TOP_MARGIN + header;
        for row in 0..rows {
            let mut left = 0.0;
            let mut has_names = false;
            for (column, space) in spaces.left.iter().enumerate() {
                let index = row * columns + column;
                left += space;
                if index < count {
                    let frame = Rectangle {
                        left,
                        top,
                        width,
                        height,
                    };
                    has_names |= bears_x(figure, index);
                    let Axes { x, y } = axes[index];
                    let y_ticks = y_ticks(&y, height);
                    let baseline = left - TICK_GAP - widest(&y_ticks) - NAME_GAP;
                    seats.push(Seat {
                        panel: Panel { frame, x, y },
                        ticks: Ticks {
                            x: x_ticks(&x, width),
                            y: y_ticks,
                            y_baseline: bears_y(figure, index).then_some(baseline),
                        },
                        bears_x: bears_x(figure, index),
                    });
                }
                left += width;
            }
            let below = if has_names { BOTTOM_MARGIN + GAP } else { GAP };
            top += height + below + header;
        }
        Ok(Self { seats })
    }

    /// Lower end of the panels with their labels.
    pub(super) fn bottom(&self) -> f64 {
        self.span().bottom() + BOTTOM_MARGIN
    }

    /// The smallest rectangle around all frames.
    pub(super) fn span(&self) -> Rectangle {
        let frames = || self.seats.iter().map(|seat| seat.panel.frame);
        let least =
            |of: fn(&Rectangle) -> f64| frames().map(|frame| of(&frame)).fold(f64::MAX, f64::min);
        let most =
            |of: fn(&Rectangle) -> f64| frames().map(|frame| of(&frame)).fold(f64::MIN, f64::max);
        let (left, top) = (least(|frame| frame.left), least(|frame| frame.top));
        Rectangle {
            left,
            top,
            width: most(Rectangle::right) - left,
            height: most(Rectangle::bottom) - top,
        }
    }
}

/// Free space beside the frames, in points.
struct Spaces {
    /// At the left of each column.
    left: Vec<f64>,
    /// At the right of the last.
    right: f64,
}

impl Spaces {
    fn of(figure: &ChartFigure, axes: &[Axes], height: f64) -> Self {
        let (columns, count) = (figure.columns, axes.len());
        let panels = |column: usize| (column..count).step_by(columns);
        // Name and numbers of the widest vertical axis.
        let names = |column: usize| {
            let outer = if column == 0 { 0.0 } else { GAP };
            panels(column)
                .filter(|&index| bears_y(figure, index))
                .map(|index| {
                    let numbers = widest(&y_ticks(&axes[index].y, height));
                    outer + LABEL_BASELINE + NAME_GAP + numbers + TICK_GAP
                })
                .fold(outer, f64::max)
        };
        let left: Vec<f64> = (0..columns).map(names).collect();
        let right = figure
            .colour_scale
            .as_ref()
            .map_or(RIGHT_MARGIN, |scale| scale.space(height));
        // The numbers at the ends of a horizontal axis reach over it, nearly alike for nearly equal widths.
        let width = (figure.width.points() - right - left.iter().sum::<f64>()) / columns as f64;
        let over = |index: usize| {
            if bears_x(figure, index) {
                overhang(&axes[index].x, width)
            } else {
                (0.0, 0.0)
            }
        };
        let between = |column: usize| {
            panels(column)
                .filter(|_| column > 0)
                .map(|index| over(index - 1).1 + over(index).0 + NUMBER_GAP)
                .fold(0.0, f64::max)
        };
        Self {
            right: panels(columns - 1)
                .map(|index| over(index).1 + 2.0)
                .fold(right, f64::max),
            left: left
                .into_iter()
                .enumerate()
                .map(|(column, space)| space.max(between(column)))
                .collect(),
        }
    }
}

/// Whether a panel has numbers below it.
fn bears_x(figure: &ChartFigure, index: usize) -> bool {
    !figure.shares_x || index + figure.columns >= figure.panels.len()
}

/// Whether a panel has numbers at its left.
fn bears_y(figure: &ChartFigure, index: usize) -> bool {
    !figure.shares_y || index.is_multiple_of(figure.columns)
}

impl Seat {
    /// The frame with its ticks and the names of its axes.
    pub(super) fn draw_frame(&self, drawing: &mut Drawing, chart: &ChartPanel) {
        let labels = Labels {
            x: self.bears_x.then_some(chart.x.label.as_str()),
            y: &chart.y.label,
            letter: None,
        };
        self.panel.draw_ticked_frame(drawing, &labels, &self.ticks);
    }
}

/// The axes of all panels, those that are shared over the data of all that share them.
fn axes(figure: &ChartFigure, height: f64) -> Result<Vec<Axes>, FigureError> {
    let checked: Vec<Checked> = figure
        .panels
        .iter()
        .map(|panel| panel.checked(figure.colour_scale.is_some()))
        .collect::<Result<_, _>>()?;
    if checked.is_empty() {
        return Err(FigureError::EmptyLayer {
            series: "chart".to_owned(),
            length: 0,
        });
    }
    let columns = figure.columns;
    (0..checked.len())
        .map(|index| {
            let in_column = |other: &usize| {
                *other == index || figure.shares_x && other % columns == index % columns
            };
            let in_row = |other: &usize| {
                *other == index || figure.shares_y && other / columns == index / columns
            };
            let column: Vec<usize> = (0..checked.len()).filter(in_column).collect();
            let row: Vec<usize> = (0..checked.len()).filter(in_row).collect();
            let x = shared("x", &column, |other| {
                (&figure.panels[other].x, checked[other].x)
            })?;
            let y = shared("y", &row, |other| {
                (&figure.panels[other].y, checked[other].y)
            })?;
            let has_limits = row.iter().any(|&other| checked[other].has_limits);
            // All that share an axis must have the same free space on it.
            let mut y_free = row.iter().fold((f64::INFINITY, 0.0_f64), |free, &other| {
                let (below, above) = checked[other].y_free;
                (free.0.min(below), free.1.max(above))
            });
            if has_limits {
                y_free.1 = y_free.1.max((ARROW + 3.0) / height).min(0.4);
            }
            Ok(Axes {
                x: x.0.axis("x", x.1, (MARGIN, MARGIN))?,
                y: y.0.axis("y", y.1, y_free)?,
            })
        })
        .collect()
}

/// What the panels that share an axis want of it together, and the data of all.
fn shared<'a>(
    name: &'static str,
    panels: &[usize],
    of: impl Fn(usize) -> (&'a AxisWish, (f64, f64)),
) -> Result<(AxisWish, (f64, f64)), FigureError> {
    let (wish, mut data) = of(panels[0]);
    let mut wish = wish.clone();
    for &panel in &panels[1..] {
        let (other, range) = of(panel);
        if other.scale != wish.scale {
            return Err(FigureError::SharedScale { axis: name });
        }
        data = (data.0.min(range.0), data.1.max(range.1));
        wish.least = match (wish.least, other.least) {
            (Some(one), Some(other)) => Some(one.min(other)),
            (one, other) => one.or(other),
        };
        wish.largest = match (wish.largest, other.largest) {
            (Some(one), Some(other)) => Some(one.max(other)),
            (one, other) => one.or(other),
        };
    }
    Ok((wish, data))
}

fn x_ticks(axis: &Axis, width: f64) -> Vec<Tick> {
    axis.fitting_ticks(
        width,
        ((width / ROOM_ACROSS) as usize).min(MOST_ACROSS),
        |label| Text::new(label, TICK_SIZE).width + NUMBER_GAP,
    )
}

fn y_ticks(axis: &Axis, height: f64) -> Vec<Tick> {
    axis.fitting_ticks(height, ((height / ROOM_UP) as usize).min(MOST_UP), |_| {
        NUMBER_ROOM
    })
}

fn widest(ticks: &[Tick]) -> f64 {
    ticks
        .iter()
        .filter_map(|tick| tick.label.as_ref())
        .fold(0.0, |widest: f64, label| {
            widest.max(Text::new(label, TICK_SIZE).width)
        })
}

/// How far the first and the last number of a horizontal axis reach over its ends.
fn overhang(axis: &Axis, width: f64) -> (f64, f64) {
    let ticks = x_ticks(axis, width);
    let labels = ticks.iter().filter_map(|tick| {
        let half = Text::new(tick.label.as_ref()?, TICK_SIZE).width / 2.0;
        let place = width * axis.fraction(tick.value);
        Some((half - place, half - (width - place)))
    });
    labels.fold((0.0, 0.0), |(before, after): (f64, f64), (left, right)| {
        (before.max(left), after.max(right))
    })
}
