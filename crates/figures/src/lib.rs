//! Tables in, figures out: the journal figures of runs and of ensembles, as SVG and PNG from one and the same drawing.
//!
//! A figure is a small struct of columns and labels. `draw` checks them and lays the figure out once, as a
//! [`Drawing`] in points on a page of one or two journal columns; [`Drawing::svg`] and [`Drawing::png`] write that
//! one drawing. Text is drawn as outlines of an embedded font in both, so that a figure looks the same on every
//! machine, and the same input gives the same bytes.
//!
//! Most figures are a [`chart`]; [`SnapshotFigure`] shows the tube from the side, and [`PictureFigure`] frames a picture of
//! pixels with scale, colours and notes. [`Quantity`] names the axes.
//!
//! An SVG can stand in a web page among others: [`Drawing::svg_with_prefix`] keeps their names apart. Its letters are drawn once and
//! referred to, lengths have two decimals, curves are thinned to what can be seen and fields are embedded as pictures:
//! a chart takes some 40 kB, each thousand points 60 kB more, or 140 kB with error bars.
//!
//! Labels are written in a small markup: `*x*` is italic, `_{...}` and `^{...}` (or one character without braces) set
//! subscripts and superscripts, a combining dot (U+0307) after a letter sets a dot above it, and a backslash takes
//! the next character literally. Example: `*J*/*J*_{max}`.
//!
//! The sign convention of every figure: flow rates and velocities are positive along the wave.
//!
//! ```
//! use peristalsis_figures::chart::{ChartFigure, ChartPanel, Line};
//!
//! let panel = ChartPanel::new("time, *t*/*T*", "flow rate, *J*/*J*_{max}");
//! let figure = ChartFigure::new(panel.with(Line::new("", &[0.0, 1.0, 2.0], &[0.0, 0.4, 0.9])));
//! let drawing = figure.draw()?;
//! assert!(drawing.svg().starts_with("<svg"));
//! assert_eq!(drawing.width_millimetres().round(), 86.0);
//! # Ok::<(), peristalsis_figures::FigureError>(())
//! ```

#![forbid(unsafe_code)]

mod axis;
pub mod chart;
mod colour;
mod colour_scale;
mod drawing;
mod error;
mod geometry;
mod legend;
mod notation;
mod picture;
mod quantity;
mod snapshot;
mod style;
mod text;

pub use axis::Scale;
pub use colour_scale::{ColourScale, Palette};
pub use drawing::{Drawing, Raster};
pub use error::FigureError;
pub use picture::{Paper, PictureFigure, PlaceMark, ScaleBar};
pub use quantity::{Quantity, Units};
pub use snapshot::{Snapshot, SnapshotFigure, SnapshotGrain, SnapshotSphere, SnapshotWall};
pub use style::Width;
pub use text::{Letter, Level, letters};
