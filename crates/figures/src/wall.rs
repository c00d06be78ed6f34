//! The radius of the wall against the phase of the wave.

use crate::axis::{Axis, Scale};
use crate::colour::{BLUE, GREY, SKY};
use crate::drawing::{Dash, Drawing, Rectangle, Stroke};
use crate::error::{FigureError, finite};
use crate::legend::{Entry, Legend};
use crate::panel::{
    BOTTOM_MARGIN, Labels, Panel, draw_title, left_margin, right_margin, title_space,
};
use crate::series::{
    Profile, Sample, Series, check_lengths, close_wavelength, extent, wavelength_range,
};
use crate::style::Width;

/// Radius of the wall against the phase in the wave frame: its mean, and the band between its least and its largest value.
#[derive(Clone, Copy, Debug, Default)]
pub struct WallFigure<'a> {
    /// Line above the figure, in markup; none if empty.
    pub title: &'a str,
    /// Phase in the wave frame, (z - c t)/lambda.
    pub phase: &'a [f64],
    /// Mean radius at that phase.
    pub mean: &'a [f64],
    /// Least radius at that phase.
    pub least: &'a [f64],
    /// Largest radius at that phase.
    pub largest: &'a [f64],
    /// Radius of the tube at rest.
    pub reference: Option<f64>,
    /// Unit of length, in markup, for instance `*d*`.
    pub length_unit: &'a str,
    /// Width of the figure.
    pub width: Width,
}

const FRAME_HEIGHT: [f64; 2] = [0.46, 0.3];
const MEAN: Stroke = Stroke::solid(BLUE, 1.1);
const REFERENCE: Stroke = Stroke::solid(GREY, 0.8).dashed(Dash::Dashed);

impl WallFigure<'_> {
    /// Lays the figure out.
    ///
    /// # Errors
    /// If the columns are uneven or without a finite row, or if the reference is not finite.
    pub fn draw(&self) -> Result<Drawing, FigureError> {
        let pieces = |name, y| Series { x: self.phase, y }.pieces(name);
        let mean = pieces("mean radius of the wall", self.mean)?;
        check_lengths("least radius of the wall", self.phase, self.least)?;
        check_lengths("largest radius of the wall", self.phase, self.largest)?;
        if let Some(reference) = self.reference {
            finite("radius of the reference tube", reference)?;
        }
        let bands = self.bands()?;
        let bounds = bands
            .iter()
            .flatten()
            .flat_map(|sample| [sample.y - sample.error, sample.y + sample.error]);
        let radii = extent(
            mean.iter()
                .flatten()
                .map(|sample| sample.y)
                .chain(bounds)
                .chain(self.reference),
        );
        let phases = wavelength_range(mean.iter().flatten().map(|sample| sample.x));
        let (mean, bands) = (close_wavelength(mean), close_wavelength(bands));

        let width = self.width.points();
        let x = Axis::linear(phases);
        let y = Axis::with_margin(Scale::Linear, radii, 0.06);
        let height = width * FRAME_HEIGHT[usize::from(self.width == Width::DoubleColumn)];
        let left = left_margin(&y, height);
        let frame = Rectangle {
            left,
            top: title_space(self.title) + 4.0,
            width: width - left - right_margin(&x, width - left),
            height,
        };
        let legend = Legend::new(self.entries(), width - 8.0);
        let mut drawing = Drawing::new(
            width,
            frame.bottom() + BOTTOM_MARGIN + legend.height() + 3.0,
            &format!("Wall radius against phase: {}", self.title),
        );
        let panel = Panel { frame, x, y };

        draw_title(&mut drawing, self.title, width);
        let layer = drawing.layer("range", Some(frame));
        for band in &bands {
            layer.polygon(panel.band(band), SKY.faint(0.4));
        }
        if let Some(reference) = self.reference {
            panel.level(&mut drawing, "reference", reference, REFERENCE);
        }
        let layer = drawing.layer("mean", Some(frame));
        for piece in &mean {
            layer.line(panel.line(piece), MEAN);
        }
        let label = if self.length_unit.is_empty() {
            "wall radius, *R*".to_owned()
        } else {
            format!("wall radius, *R*/{}", self.length_unit)
        };
        panel.draw_frame(
            &mut drawing,
            &Labels {
                x: Some("phase, (*z* − *ct*)/*λ*"),
                y: &label,
                letter: None,
            },
        );
        legend.draw(
            &mut drawing,
            4.0,
            width - 4.0,
            frame.bottom() + BOTTOM_MARGIN,
        );
        Ok(drawing)
    }

    /// The range as its middle with half its width for an error, in unbroken pieces.
    fn bands(&self) -> Result<Vec<Vec<Sample>>, FigureError> {
        let rows = || self.least.iter().zip(self.largest);
        let middle: Vec<f64> = rows().map(|(low, high)| (low + high) / 2.0).collect();
        let half: Vec<f64> = rows().map(|(low, high)| (high - low) / 2.0).collect();
        let range = Profile {
            position: self.phase,
            value: &middle,
            error: Some(&half),
            label: "",
        };
        range.pieces("range of the wall radius")
    }

    fn entries(&self) -> Vec<Entry> {
        let mut entries = vec![
            Entry {
                line: Some(MEAN),
                meaning: "mean".to_owned(),
                ..Entry::default()
            },
            Entry {
                line: None,
                band: Some(SKY.faint(0.4)),
                meaning: "least to largest".to_owned(),
                ..Entry::default()
            },
        ];
        if self.reference.is_some() {
            entries.push(Entry {
                line: Some(REFERENCE),
                meaning: "tube at rest".to_owned(),
                ..Entry::default()
            });
        }
        entries
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::Shape;

    #[test]
    fn the_band_holds_the_mean() {
        let phase: Vec<f64> = (0..20).map(|step| f64::from(step) / 10.0).collect();
        let mean: Vec<f64> = phase.iter().map(|phase| 3.5 + phase).collect();
        let least: Vec<f64> = mean.iter().map(|radius| radius - 0.2).collect();
        let largest: Vec<f64> = mean.iter().map(|radius| radius + 0.3).collect();
        let figure = WallFigure {
            phase: &phase,
            mean: &mean,
            least: &least,
            largest: &largest,
            ..WallFigure::default()
        };
        let drawing = figure.draw().expect("drawable");
        let Shape::Line { points: line, .. } = drawing.shapes("mean")[0] else {
            panic!("a line")
        };
        let Shape::Polygon { points: band, .. } = drawing.shapes("range")[0] else {
            panic!("a polygon")
        };
        assert_eq!((line.len(), band.len()), (20, 40));
        for (index, point) in line.iter().enumerate() {
            let (upper, lower) = (band[index], band[39 - index]);
            assert!(upper.y < point.y && point.y < lower.y, "{index}");
            assert!((upper.x - point.x).abs() < 1e-9 && (lower.x - point.x).abs() < 1e-9);
        }
    }

    #[test]
    fn uneven_columns_are_refused() {
        let figure = WallFigure {
            phase: &[0.0, 1.0],
            mean: &[1.0, 1.0],
            least: &[1.0],
            largest: &[1.0, 1.0],
            ..WallFigure::default()
        };
        assert!(matches!(
            figure.draw(),
            Err(FigureError::ColumnLengths { found: 1, .. })
        ));
    }
}
