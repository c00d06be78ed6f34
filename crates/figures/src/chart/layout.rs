//! Where the panels of a chart stand on the page.

use super::check::Checked;
use super::frame::{Frame, Surround};
use super::panel::AxisWish;
use super::{ChartFigure, ChartPanel, HEADER_SPACE};
use crate::axis::{Axis, Tick, extent, widest};
use crate::error::FigureError;
use crate::geometry::Rectangle;
use crate::style::{
    LABEL_BASELINE, LABEL_SPACE, MAJOR_TICK, POINTS_PER_MILLIMETRE, RIGHT_MARGIN, TICK_GAP,
    TICK_SIZE, TICK_SPACE, Width,
};
use crate::text::Text;

/// Height of a frame over its width: in a lone panel two columns wide, and otherwise.
const WIDE_ASPECT: f64 = 0.45;
const ASPECT: f64 = 0.72;
/// A frame is no lower than this unless it is asked for.
const LEAST_HEIGHT: f64 = 85.0;
const TOP_MARGIN: f64 = 4.0;
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
    /// Lower end of the panels with their labels.
    pub(super) bottom: f64,
}

/// A panel on the page.
pub(super) struct Seat {
    pub(super) frame: Frame,
    pub(super) around: Surround,
}

/// The axes of a panel before it has a place.
struct Axes {
    x: Axis,
    y: Axis,
}

impl Layout {
    /// Places the panels below a title that takes some space.
    pub(super) fn of(figure: &ChartFigure, title_space: f64) -> Result<Self, FigureError> {
        let columns = figure.columns;
        let mut height = usual_height(figure);
        let axes = axes(figure, height)?;
        let mut spaces = Spaces::of(figure, &axes, height);
        if figure.equal_scales {
            let length = |axis: &Axis| axis.range().1 - axis.range().0;
            let aspect = length(&axes[0].y) / length(&axes[0].x);
            // The numbers on the vertical axis need room that the height, and so they, depend on.
            spaces = Spaces::of(figure, &axes, aspect * spaces.width);
            height = aspect * spaces.width;
        }
        // Names of axes below each other stand in one line.
        let numbers = |column: usize| {
            let panels = axes.iter().skip(column).step_by(columns);
            let widths = panels.map(|axes| widest(&y_ticks(&axes.y, height)));
            widths.fold(0.0, f64::max)
        };
        let mut seats = Vec::with_capacity(axes.len());
        let mut bottom = title_space;
        for (row, panels) in axes.chunks(columns).enumerate() {
            let first = row * columns;
            let indices = first..first + panels.len();
            let has_header = indices.clone().any(|it| !figure.header(it).is_empty());
            let header = if has_header { HEADER_SPACE } else { 0.0 };
            let gap = if row == 0 { TOP_MARGIN } else { GAP };
            let top = bottom + gap + header;
            let mut left = 0.0;
            for (axes, (index, space)) in panels.iter().zip(indices.clone().zip(&spaces.left)) {
                left += space;
                let baseline = left - TICK_GAP - numbers(index % columns) - NAME_GAP;
                seats.push(Seat {
                    frame: Frame {
                        area: Rectangle::new((left, top), (spaces.width, height)),
                        x: axes.x,
                        y: axes.y,
                    },
                    around: Surround {
                        x_ticks: x_ticks(&figure.panels[index], &axes.x, spaces.width),
                        y_ticks: y_ticks(&axes.y, height),
                        has_x_numbers: bears_x(figure, index),
                        y_baseline: bears_y(figure, index).then_some(baseline),
                    },
                });
                left += spaces.width;
            }
            let below = indices.map(|index| space_below(figure, index));
            bottom = top + height + below.fold(0.0, f64::max);
        }
        Ok(Self { seats, bottom })
    }

    /// The smallest rectangle around all frames.
    pub(super) fn span(&self) -> Rectangle {
        let areas = || self.seats.iter().map(|seat| seat.frame.area);
        let across = extent(areas().flat_map(|area| [area.left, area.right()]));
        let down = extent(areas().flat_map(|area| [area.top, area.bottom()]));
        Rectangle::between(across, down)
    }
}

/// Range of an axis along which nothing is drawn, linear or logarithmic.
const NO_DATA: (f64, f64) = (0.1, 1.0);

/// Height of the frames in points, unless their scales decide it.
fn usual_height(figure: &ChartFigure) -> f64 {
    if let Some(height) = figure.panel_height {
        return height * POINTS_PER_MILLIMETRE;
    }
    let columns = figure.columns as f64;
    let width = (figure.width.points() - USUAL_LEFT * columns - RIGHT_MARGIN) / columns;
    let is_wide = figure.columns == 1 && figure.width == Width::DoubleColumn;
    let aspect = if is_wide { WIDE_ASPECT } else { ASPECT };
    (width * aspect).max(LEAST_HEIGHT)
}

/// Free space beside the frames, and what it leaves them, in points.
struct Spaces {
    /// At the left of each column.
    left: Vec<f64>,
    /// Of each frame.
    width: f64,
}

impl Spaces {
    fn of(figure: &ChartFigure, axes: &[Axes], height: f64) -> Self {
        let columns = figure.columns;
        let panels = |column: usize| (column..axes.len()).step_by(columns);
        let width_beside = |left: &[f64], right: f64| {
            (figure.width.points() - right - left.iter().sum::<f64>()) / columns as f64
        };
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
        let mut left: Vec<f64> = (0..columns).map(names).collect();
        let right = match &figure.colour_scale {
            Some(scale) if !figure.equal_scales && !figure.tells_values() => scale.space(height),
            _ => RIGHT_MARGIN,
        };
        // The numbers at the ends of a horizontal axis reach over it, nearly alike for nearly equal widths.
        let width = width_beside(&left, right);
        let over = |index: usize| {
            let panel = &figure.panels[index];
            let ends = bears_x(figure, index).then(|| overhang(panel, &axes[index].x, width));
            ends.unwrap_or_default()
        };
        for (column, space) in left.iter_mut().enumerate().skip(1) {
            let between = |index: usize| over(index - 1).1 + over(index).0 + NUMBER_GAP;
            *space = panels(column).map(between).fold(*space, f64::max);
        }
        let last = panels(columns - 1).map(|index| over(index).1 + 2.0);
        let width = width_beside(&left, last.fold(right, f64::max));
        Self { left, width }
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

/// Space below a panel for numbers and name of its horizontal axis.
fn space_below(figure: &ChartFigure, index: usize) -> f64 {
    match &*figure.panels[index].x.label {
        _ if !bears_x(figure, index) => 0.0,
        "" => TICK_SPACE,
        _ => TICK_SPACE + LABEL_SPACE,
    }
}

/// The axes of all panels, those that are shared over the data of all that share them.
fn axes(figure: &ChartFigure, height: f64) -> Result<Vec<Axes>, FigureError> {
    let is_coloured = figure.colour_scale.is_some();
    let panels = figure.panels.iter();
    let checked: Vec<Checked> = panels
        .map(|panel| Checked::new(panel, height, is_coloured))
        .collect::<Result<_, _>>()?;
    if checked.is_empty() {
        return Err(FigureError::EmptySeries {
            series: "chart".to_owned(),
            length: 0,
        });
    }
    let columns = figure.columns;
    (0..checked.len())
        .map(|index| {
            let those = |has: &dyn Fn(usize) -> bool| -> Vec<usize> {
                (0..checked.len()).filter(|&it| has(it)).collect()
            };
            let is_below = |it: usize| it % columns == index % columns;
            let is_beside = |it: usize| it / columns == index / columns;
            let column = those(&|it| it == index || figure.shares_x && is_below(it));
            let row = those(&|it| match (figure.shares_y, figure.alike_y) {
                (true, true) => true,
                (true, false) => is_beside(it),
                (false, true) => is_below(it),
                (false, false) => it == index,
            });
            let x = shared("x", &column, |it| (&figure.panels[it].x, checked[it].x))?;
            let y = shared("y", &row, |it| (&figure.panels[it].y, checked[it].y))?;
            // All that share an axis must have the same free space on it.
            let (below, _) = extent(row.iter().map(|&it| checked[it].y_free.0));
            let (_, above) = extent(row.iter().map(|&it| checked[it].y_free.1));
            let (_, x_free) = extent(column.iter().map(|&it| checked[it].x_free));
            Ok(Axes {
                x: x.0.axis("x", x.1, (x_free, x_free))?,
                y: y.0.axis("y", y.1, (below, above))?,
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
        let [least, largest] = [[wish.least, other.least], [wish.largest, other.largest]];
        wish.least = least.into_iter().flatten().reduce(f64::min);
        wish.largest = largest.into_iter().flatten().reduce(f64::max);
    }
    // Where nothing is drawn any range serves.
    let is_empty = data.0 > data.1;
    Ok((wish, if is_empty { NO_DATA } else { data }))
}

fn x_ticks(panel: &ChartPanel, axis: &Axis, width: f64) -> Vec<Tick> {
    if !panel.x_names.is_empty() {
        let named = panel.x_names.iter().enumerate();
        let named = named.map(|(number, name)| Tick {
            value: number as f64 + 1.0,
            length: MAJOR_TICK,
            label: Some(name.clone()),
        });
        return named.collect();
    }
    let most = ((width / ROOM_ACROSS) as usize).min(MOST_ACROSS);
    axis.fitting_ticks(width, most, |label| {
        Text::new(label, TICK_SIZE).width + NUMBER_GAP
    })
}

fn y_ticks(axis: &Axis, height: f64) -> Vec<Tick> {
    let most = ((height / ROOM_UP) as usize).min(MOST_UP);
    axis.fitting_ticks(height, most, |_| NUMBER_ROOM)
}

/// How far the first and the last number of a horizontal axis reach over its ends.
fn overhang(panel: &ChartPanel, axis: &Axis, width: f64) -> (f64, f64) {
    let ticks = x_ticks(panel, axis, width);
    let labels = ticks.iter().filter_map(|tick| {
        let half = Text::new(tick.label.as_ref()?, TICK_SIZE).width / 2.0;
        let place = width * axis.fraction(tick.value);
        Some((half - place, half - (width - place)))
    });
    labels.fold((0.0, 0.0), |(before, after): (f64, f64), (left, right)| {
        (before.max(left), after.max(right))
    })
}
