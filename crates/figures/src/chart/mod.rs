//! Charts of ensembles: panels with points, curves, bands, histograms and reference lines, on linear or logarithmic axes.
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
//!     &Quantity::TransitionTime.label(Units::Linear),
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
mod entries;
mod layer;
mod layout;
mod look;
mod paint;
mod panel;
mod path;
mod placement;
mod points;
#[cfg(test)]
mod tests;
mod texts;

pub use layer::{Band, Bars, ChartLayer, Corner, Line, Note, Reference, Window};
pub use look::{Marker, Pattern, Tint};
pub use panel::ChartPanel;
pub use points::Points;

use crate::colour_scale::ColourScale;
use crate::drawing::{Anchor, Drawing, Rectangle};
use crate::error::{FigureError, positive};
use crate::legend::{Entry, Legend, TOP_SPACE};
use crate::panel::draw_title;
use crate::style::{LABEL_SIZE, Width};
use crate::text::Text;
use layout::{Layout, Seat};
use paint::Painter;
use placement::Obstacles;

/// A figure of one or several panels.
#[derive(Clone, Debug, PartialEq)]
pub struct ChartFigure {
    title: String,
    description: String,
    panels: Vec<ChartPanel>,
    columns: usize,
    width: Width,
    panel_height: Option<f64>,
    shares_x: bool,
    shares_y: bool,
    letters: bool,
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
    /// Nowhere.
    Hidden,
}

impl ChartFigure {
    /// A figure of one panel, one column of a journal wide.
    pub fn new(panel: ChartPanel) -> Self {
        Self::grid(1, [panel])
    }

    /// A figure of several panels in rows of so many columns, with letters (a), (b), ...
    pub fn grid(columns: usize, panels: impl IntoIterator<Item = ChartPanel>) -> Self {
        let panels: Vec<ChartPanel> = panels.into_iter().collect();
        Self {
            title: String::new(),
            description: String::new(),
            columns: columns.clamp(1, panels.len().max(1)),
            letters: panels.len() > 1,
            panels,
            width: Width::SingleColumn,
            panel_height: None,
            shares_x: false,
            shares_y: false,
            legend: LegendPlace::Inside,
            colour_scale: None,
        }
    }

    /// A line above the figure, in markup.
    #[must_use]
    pub fn title(self, title: &str) -> Self {
        Self {
            title: title.to_owned(),
            ..self
        }
    }

    /// What can be seen, in words for those who do not see it.
    #[must_use]
    pub fn description(self, description: &str) -> Self {
        Self {
            description: description.to_owned(),
            ..self
        }
    }

    /// Width on the journal's page.
    #[must_use]
    pub fn width(self, width: Width) -> Self {
        Self { width, ..self }
    }

    /// Height of the frame of each panel in millimetres; without it, a fraction of its width.
    #[must_use]
    pub fn panel_height(self, millimetres: f64) -> Self {
        Self {
            panel_height: Some(millimetres),
            ..self
        }
    }

    /// Panels in a column have one horizontal axis, with numbers below the lowest.
    #[must_use]
    pub fn share_x(self) -> Self {
        Self {
            shares_x: true,
            ..self
        }
    }

    /// Panels in a row have one vertical axis, with numbers at the left of the first.
    #[must_use]
    pub fn share_y(self) -> Self {
        Self {
            shares_y: true,
            ..self
        }
    }

    /// Several panels without letters.
    #[must_use]
    pub fn without_letters(self) -> Self {
        Self {
            letters: false,
            ..self
        }
    }

    /// Where the legend stands.
    #[must_use]
    pub fn legend(self, legend: LegendPlace) -> Self {
        Self { legend, ..self }
    }

    /// What the colours [`Tint::Value`] mean, drawn as a bar at the right of the panels.
    #[must_use]
    pub fn colour_scale(self, scale: ColourScale) -> Self {
        Self {
            colour_scale: Some(scale.on_white()),
            ..self
        }
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
        let layout = Layout::of(self)?;
        let width = self.width.points();
        let bottom = layout.bottom();
        // The height of the page is known when the legends have their places.
        let mut drawing = Drawing::new(width, bottom, &self.summary());
        draw_title(&mut drawing, &self.title, width);
        // Panels often hold the same series: each is explained once.
        let mut explained: Vec<Entry> = Vec::new();
        let mut below: Vec<Entry> = Vec::new();
        for (number, (seat, chart)) in layout.seats.iter().zip(&self.panels).enumerate() {
            let painter = Painter {
                panel: seat.panel,
                chart,
                scale: self.colour_scale.as_ref(),
            };
            let mut obstacles = painter.draw_layers(&mut drawing);
            seat.draw_frame(&mut drawing, chart);
            self.draw_header(&mut drawing, seat, chart, number);
            painter.draw_texts(&mut drawing, &mut obstacles);
            let mut entries = painter.entries();
            entries.retain(|entry| !explained.contains(entry));
            explained.extend(entries.iter().cloned());
            let placed = match self.legend {
                LegendPlace::Inside => draw_inside(&mut drawing, seat, &obstacles, &entries),
                LegendPlace::Below => false,
                LegendPlace::Hidden => true,
            };
            if !placed {
                below.extend(entries);
            }
        }
        if let Some(scale) = &self.colour_scale {
            scale.draw_bar(&mut drawing, layout.span());
        }
        let legend = Legend::new(below, width - 8.0);
        legend.draw(&mut drawing, 4.0, width - 4.0, bottom);
        drawing.extend_to(bottom + legend.height() + 3.0);
        if self.description.is_empty() {
            Ok(drawing)
        } else {
            Ok(drawing.with_description(&self.description))
        }
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

    /// Whether a line stands above each frame.
    fn has_headers(&self) -> bool {
        self.letters || self.panels.iter().any(|panel| !panel.title.is_empty())
    }

    /// Letter and title of a panel, above its frame where they can cover nothing.
    fn draw_header(&self, drawing: &mut Drawing, seat: &Seat, chart: &ChartPanel, number: usize) {
        let letter = if self.letters {
            format!("({})", letter(number))
        } else {
            String::new()
        };
        let gap = if self.letters && !chart.title.is_empty() {
            "  "
        } else {
            ""
        };
        let header = format!("{letter}{gap}{}", chart.title);
        if header.is_empty() {
            return;
        }
        let frame = seat.panel.frame;
        let text = Text::fitted(&header, LABEL_SIZE, frame.width);
        drawing.layer("headers", None).text(
            (frame.left, frame.top - 3.0),
            Anchor::Start,
            text,
            crate::colour::BLACK,
        );
    }
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
        let height = legend.height() - TOP_SPACE;
        if let Some(Rectangle { left, top, .. }) =
            obstacles.free_place(seat.panel.frame, legend.width(), height)
        {
            legend.draw(drawing, left, left + legend.width(), top - TOP_SPACE);
            return true;
        }
    }
    false
}
