//! Charts of ensembles: panels with points, curves, bands, histograms, fields and reference lines, on linear or logarithmic axes.
//!
//! A [`ChartFigure`] is one [`ChartPanel`] or a grid of them; a panel is two axes and a list of layers. Layers own their
//! columns. Rows that are not finite leave gaps; a value that is not positive on a logarithmic axis is an error that
//! names its series, except the far end of an error bar or of a band, which then reaches to the frame.
//!
//! ```
//! use peristalsis_figures::chart::{ChartFigure, ChartPanel, Line, Points};
//! use peristalsis_figures::{Quantity, Scale, Units};
//!
//! let width = [2.5, 2.6, 2.7, 2.8];
//! let time = [70.0, 180.0, 690.0, 2000.0];
//! let panel = ChartPanel::new(
//!     &Quantity::Width.label(Units::Linear),
//!     &Quantity::TransitionPeriod.label(Units::Linear),
//! )
//! .y_scale(Scale::Logarithmic)
//! .with(
//!     Points::new("*ε\u{307}* = 0.1", &width, &time)
//!         .y_errors(&[5.0, 20.0, 60.0, 0.0])
//!         .lower_limits(&[false, false, false, true]),
//! )
//! .with(Line::new("fit", &[2.5, 2.7], &[65.0, 700.0]).series(0));
//! let drawing = ChartFigure::new(panel).draw()?;
//! assert!(drawing.svg().contains("aria-label=\"fit\""));
//! # Ok::<(), peristalsis_figures::FigureError>(())
//! ```

mod check;
mod curve;
mod entries;
mod frame;
mod key;
mod layer;
mod layout;
mod look;
mod paint;
mod panel;
mod placement;
#[cfg(test)]
mod tests;
mod texts;

pub use key::Key;
pub(crate) use layer::Spheres;
pub use layer::{Band, Bars, ChartLayer, Corner, Field, Line, Note, Points, Reference, Window};
pub use look::Tint;
pub use panel::ChartPanel;

pub use crate::drawing::Pattern;

use crate::colour::BLACK;
use crate::colour_scale::{ColourScale, REACH_ON_WHITE};
use crate::drawing::{Anchor, Drawing};
use crate::error::{FigureError, positive};
use crate::geometry::Rectangle;
use crate::legend::{Entry, Legend, Mark, TOP_SPACE};
use crate::style::{LABEL_SIZE, RIGHT_MARGIN, TITLE_SIZE, TITLE_SPACE, Width};
use crate::text::{Text, plain};
use layout::{Layout, Seat};
use look::marker;
use paint::{Painter, RADII};
use placement::Obstacles;

/// A figure of one or several panels.
#[derive(Clone, Debug, Default, PartialEq)]
#[must_use]
pub struct ChartFigure {
    title: String,
    description: String,
    panels: Vec<ChartPanel>,
    columns: usize,
    width: Width,
    panel_height: Option<f64>,
    equal_scales: bool,
    shares_x: bool,
    shares_y: bool,
    alike_y: bool,
    legend: LegendPlace,
    colour_scale: Option<ColourScale>,
}

/// Where the meanings of the layers are written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LegendPlace {
    /// In each panel where it covers no data, below the figure where there is no such place.
    #[default]
    Inside,
    /// Below the figure, once for all panels.
    Below,
}

/// What stands between the parts of a title: a line may end there.
pub const TITLE_SEPARATOR: &str = ",  ";
/// Baseline of the first line of a title.
const TITLE_BASELINE: f64 = 9.0;
/// Most values that the legend tells one by one.
const MOST_VALUES: usize = 12;
/// Space above a frame for its letter and title.
const HEADER_SPACE: f64 = 9.5;
/// Free space at the sides of what stands below the panels.
const SIDE: f64 = 4.0;

impl ChartFigure {
    /// A figure of one panel, one column of a journal wide.
    pub fn new(panel: ChartPanel) -> Self {
        Self::grid(1, [panel])
    }

    /// A figure of several panels in rows of so many columns, with letters (a), (b), ...
    pub fn grid(columns: usize, panels: impl IntoIterator<Item = ChartPanel>) -> Self {
        let panels: Vec<ChartPanel> = panels.into_iter().collect();
        Self {
            columns: columns.clamp(1, panels.len().max(1)),
            panels,
            ..Self::default()
        }
    }

    /// Words above the figure, in markup: a line, or several where they are longer than the page is wide and have a
    /// [`TITLE_SEPARATOR`].
    pub fn title(mut self, title: &str) -> Self {
        title.clone_into(&mut self.title);
        self
    }

    /// Description of the chart, for those who do not see it.
    pub fn description(mut self, description: &str) -> Self {
        description.clone_into(&mut self.description);
        self
    }

    /// Width on the journal's page.
    pub fn width(mut self, width: Width) -> Self {
        self.width = width;
        self
    }

    /// Height of the frame of each panel in millimetres; without it, a fraction of its width.
    pub fn panel_height(mut self, millimetres: f64) -> Self {
        self.panel_height = Some(millimetres);
        self
    }

    /// Panels of places: one length on both axes of the first panel, whose height all have, no letters, and the bar of
    /// colours below.
    pub(crate) fn equal_scales(mut self) -> Self {
        self.equal_scales = true;
        self
    }

    /// Panels in a column have one horizontal axis, with numbers below the lowest.
    pub fn share_x(mut self) -> Self {
        self.shares_x = true;
        self
    }

    /// Panels in a row have one vertical axis, with numbers at the left of the first.
    pub fn share_y(mut self) -> Self {
        self.shares_y = true;
        self
    }

    /// Panels in a column have vertical axes of one range, all panels where those in a row share theirs.
    pub fn alike_y(mut self) -> Self {
        self.alike_y = true;
        self
    }

    /// Where the legend stands.
    pub fn legend(mut self, legend: LegendPlace) -> Self {
        self.legend = legend;
        self
    }

    /// What the colours of fields and of [`Tint::Value`] mean: the legend says it where they are those of a few values of
    /// points, each of which has a marker of its own throughout the figure, and a bar at the right of the panels elsewhere.
    pub fn colour_scale(mut self, scale: ColourScale) -> Self {
        self.colour_scale = Some(scale);
        self
    }

    /// Lays the figure out.
    ///
    /// # Errors
    /// If there is no panel, if a series is empty or has columns of unequal length, if a value is not positive on a
    /// logarithmic axis, if a range cannot be an axis, if panels share an axis on different scales, or if a layer is
    /// coloured by its value without a scale of colours.
    pub fn draw(&self) -> Result<Drawing, FigureError> {
        if let Some(height) = self.panel_height {
            positive("height of a panel", height)?;
        }
        if let Some(scale) = &self.colour_scale {
            scale.check()?;
        }
        let width = self.width.points();
        let title = title_lines(&self.title, width - 2.0 * RIGHT_MARGIN);
        let layout = Layout::of(self, TITLE_SPACE * title.len() as f64)?;
        // The height of the page is known when the legends have their places.
        let mut drawing = Drawing::new(width, layout.bottom, &self.summary());
        for (line, text) in title.into_iter().enumerate() {
            let baseline = TITLE_BASELINE + TITLE_SPACE * line as f64;
            let layer = drawing.layer("title", None);
            layer.text((width / 2.0, baseline), Anchor::Middle, text, BLACK);
        }
        let scale = self.shown_scale();
        let of_panels = self.draw_panels(&mut drawing, &layout, scale.as_ref());
        let mut below = Vec::new();
        let mut bottom = layout.bottom;
        if let Some(scale) = &scale {
            if self.equal_scales {
                bottom += scale.draw_bar_below(&mut drawing, layout.span(), bottom);
            } else if self.tells_values() {
                below = self.entries_of_values(scale);
            } else {
                scale.draw_bar_beside(&mut drawing, layout.span());
            }
        }
        below.extend(of_panels);
        let legend = Legend::new(below, width - 2.0 * SIDE);
        legend.draw(&mut drawing, SIDE, width - SIDE, bottom);
        drawing.height = bottom + legend.height() + 3.0;
        drawing.description = plain(&self.description);
        Ok(drawing)
    }

    /// Draws the panels; returns the entries of the legend below the figure.
    fn draw_panels(
        &self,
        drawing: &mut Drawing,
        layout: &Layout,
        scale: Option<&ColourScale>,
    ) -> Vec<Entry> {
        // Panels often hold the same series: each is explained once.
        let values = self.values_of_points();
        let mut explained: Vec<Entry> = Vec::new();
        let mut below: Vec<Entry> = Vec::new();
        for (number, (seat, chart)) in layout.seats.iter().zip(&self.panels).enumerate() {
            let mut painter = Painter {
                frame: seat.frame,
                chart,
                scale,
                values: &values,
                drawing: &mut *drawing,
                obstacles: Obstacles::default(),
            };
            painter.draw_layers();
            let names = [&*chart.x.label, &*chart.y.label];
            seat.frame.draw(painter.drawing, &seat.around, names);
            self.draw_header(painter.drawing, seat, number);
            painter.draw_texts();
            let mut entries = painter.entries();
            let obstacles = painter.obstacles;
            entries.retain(|entry| !explained.contains(entry));
            explained.extend(entries.iter().cloned());
            let placed = match self.legend {
                LegendPlace::Inside => draw_inside(drawing, seat, &obstacles, &entries),
                LegendPlace::Below => false,
            };
            if !placed {
                below.extend(entries);
            }
        }
        below
    }

    /// The values that colour points, ascending.
    fn values_of_points(&self) -> Vec<f64> {
        let layers = self.panels.iter().flat_map(|panel| &panel.layers);
        let mut values: Vec<f64> = layers.filter_map(ChartLayer::value_of_points).collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        values
    }

    /// Whether the legend says what the colours mean: they are those of few values, all of them of points.
    fn tells_values(&self) -> bool {
        let values = self.values_of_points();
        let layers = || self.panels.iter().flat_map(|panel| &panel.layers);
        let mut coloured = layers().filter_map(ChartLayer::value_of_colour);
        !self.equal_scales
            && (1..=MOST_VALUES).contains(&values.len())
            && coloured.all(|value| values.contains(&value))
            && !layers().any(ChartLayer::is_coloured_area)
    }

    /// What the scale of colours is of, and the colour and the marker of each value.
    fn entries_of_values(&self, scale: &ColourScale) -> Vec<Entry> {
        let of_value = |(number, value): (usize, f64)| Entry {
            mark: Some(Mark::new(
                marker(number, RADII[0].1),
                scale.colour(value),
                false,
            )),
            meaning: value.to_string().replace('-', "−"),
            ..Entry::default()
        };
        let name = Entry {
            meaning: format!("{}:", scale.label),
            ..Entry::default()
        };
        let values = self.values_of_points().into_iter().enumerate();
        [name].into_iter().chain(values.map(of_value)).collect()
    }

    /// The scale of colours, without those that would be lost on white where it colours lines and points.
    fn shown_scale(&self) -> Option<ColourScale> {
        let mut layers = self.panels.iter().flat_map(|panel| &panel.layers);
        let mut scale = self.colour_scale.clone()?;
        if !layers.any(ChartLayer::is_coloured_area) {
            scale.reach = REACH_ON_WHITE;
        }
        Some(scale)
    }

    /// Title, or what stands against what, for the document.
    fn summary(&self) -> String {
        match self.panels.first() {
            Some(panel) if self.title.is_empty() => {
                format!("{} against {}", panel.y.label, panel.x.label)
            }
            _ => self.title.clone(),
        }
    }

    /// Letter and title of a panel.
    fn header(&self, number: usize) -> String {
        let title = &self.panels[number].title;
        let has_letter = self.panels.len() > 1 && !self.equal_scales;
        match (has_letter, title.is_empty()) {
            (false, _) => title.clone(),
            (true, true) => format!("({})", letter(number)),
            (true, false) => format!("({})  {title}", letter(number)),
        }
    }

    /// Draws letter and title of a panel above its frame, where they can cover nothing.
    fn draw_header(&self, drawing: &mut Drawing, seat: &Seat, number: usize) {
        let header = self.header(number);
        if header.is_empty() {
            return;
        }
        let area = seat.frame.area;
        let text = Text::fitted(&header, LABEL_SIZE, area.width);
        let layer = drawing.layer("headers", None);
        layer.text((area.left, area.top - 3.0), Anchor::Start, text, BLACK);
    }
}

/// A title in as few lines as have room, each of whole parts; one part that has none is set smaller.
fn title_lines(title: &str, room: f64) -> Vec<Text> {
    let mut lines: Vec<String> = Vec::new();
    for part in title.split(TITLE_SEPARATOR).filter(|part| !part.is_empty()) {
        let longer = lines.last().map(|line| [line, part].join(TITLE_SEPARATOR));
        match longer.filter(|longer| Text::new(longer, TITLE_SIZE).width <= room) {
            Some(longer) => *lines.last_mut().expect("a line") = longer,
            None => lines.push(part.to_owned()),
        }
    }
    let lines = lines.iter();
    lines
        .map(|line| Text::fitted(line, TITLE_SIZE, room))
        .collect()
}

/// Letters of panels: a to z, then aa, ab, ...
fn letter(number: usize) -> String {
    let last = char::from(b'a' + (number % 26) as u8);
    if number < 26 {
        last.to_string()
    } else {
        format!("{}{last}", letter(number / 26 - 1))
    }
}

/// Draws a legend in a panel where it covers nothing; false where there is no such place.
fn draw_inside(
    drawing: &mut Drawing,
    seat: &Seat,
    obstacles: &Obstacles,
    entries: &[Entry],
) -> bool {
    if entries.is_empty() {
        return true;
    }
    // One column is read most easily; two or more are flat.
    for columns in 1..=entries.len().min(3) {
        let legend = Legend::list(entries.to_vec(), columns);
        let (width, height) = (legend.width, legend.height() - TOP_SPACE);
        let place = obstacles.free_place(seat.frame.area, width, height);
        if let Some(Rectangle { left, top, .. }) = place {
            legend.draw(drawing, left, left + width, top - TOP_SPACE);
            return true;
        }
    }
    false
}
