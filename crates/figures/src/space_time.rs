//! A field over time and place as a map of colours.

use crate::axis::Axis;
use crate::colour::Colour;
use crate::colour_scale::{ColourScale, Palette};
use crate::drawing::{Drawing, Rectangle};
use crate::error::{FigureError, positive};
use crate::panel::{BOTTOM_MARGIN, Labels, Panel, draw_title, left_margin, title_space};
use crate::series::extent;
use crate::style::{POINTS_PER_MILLIMETRE, Width};

/// A field on a grid of equal cells, for instance the flow rate of each wave of the tube against time.
///
/// Values that are not finite are missing and grey; those beyond the range of values have the colours of its ends. Cells
/// too narrow to be seen are averaged, so that the file stays small however long the run.
#[derive(Clone, Copy, Debug)]
pub struct SpaceTimeFigure<'a> {
    /// Line above the figure, in markup; none if empty.
    pub title: &'a str,
    /// The field, row by row from the lowest, each row from left to right.
    pub values: &'a [f64],
    /// Number of rows.
    pub rows: usize,
    /// Horizontal range that the cells fill, from the left edge of the first column to the right edge of the last.
    pub x_range: (f64, f64),
    /// Vertical range that the cells fill, from the lower edge of the first row to the upper edge of the last.
    pub y_range: (f64, f64),
    /// Label of the horizontal axis, in markup.
    pub x_label: &'a str,
    /// Label of the vertical axis, in markup.
    pub y_label: &'a str,
    /// Label of the colours, in markup.
    pub value_label: &'a str,
    /// Values of the first and the last colour; those of the field unless given, symmetric about 0 where the palette is
    /// diverging.
    pub value_range: Option<(f64, f64)>,
    /// The colours.
    pub palette: Palette,
    /// Height of the frame in millimetres; a fraction of the width unless given.
    pub height: Option<f64>,
    /// Width of the figure.
    pub width: Width,
}

impl Default for SpaceTimeFigure<'_> {
    fn default() -> Self {
        Self {
            title: "",
            values: &[],
            rows: 0,
            x_range: (0.0, 1.0),
            y_range: (0.0, 1.0),
            x_label: "time, *t*/*T*",
            y_label: "number of the wave",
            value_label: "",
            value_range: None,
            palette: Palette::Sequential,
            height: None,
            width: Width::SingleColumn,
        }
    }
}

/// Height of the frame as a fraction of the page's width, in one column and in two.
const FRAME_HEIGHT: [f64; 2] = [0.42, 0.28];
/// Columns drawn in a point of the page at most.
const COLUMNS_PER_POINT: f64 = 2.0;
const MISSING: Colour = Colour::new(190, 190, 190);

impl SpaceTimeFigure<'_> {
    /// Lays the figure out.
    ///
    /// # Errors
    /// If the values are none, or not a whole number of columns, if none is finite, or if a range or the height is not
    /// positive.
    pub fn draw(&self) -> Result<Drawing, FigureError> {
        let columns = self.values.len() / self.rows.max(1);
        if self.values.is_empty() || columns * self.rows != self.values.len() {
            return Err(FigureError::GridSize {
                rows: self.rows,
                columns,
                found: self.values.len(),
            });
        }
        let x = axis("x", self.x_range)?;
        let y = axis("y", self.y_range)?;
        let scale = self.colours()?;

        let width = self.width.points();
        let height = match self.height {
            Some(height) => positive("height of the figure", height)? * POINTS_PER_MILLIMETRE,
            None => width * FRAME_HEIGHT[usize::from(self.width == Width::DoubleColumn)],
        };
        let left = left_margin(&y, height);
        let frame = Rectangle {
            left,
            top: title_space(self.title) + 4.0,
            width: width - left - scale.space(height),
            height,
        };
        let mut drawing = Drawing::new(
            width,
            frame.bottom() + BOTTOM_MARGIN + 3.0,
            &format!("Space-time diagram: {}", self.title),
        );
        draw_title(&mut drawing, self.title, width);
        let most = (frame.width * COLUMNS_PER_POINT) as usize;
        let (shown, field) = averaged(self.values, columns, most.max(1));
        let colours = field.chunks_exact(shown).rev().flatten().map(|&value| {
            if value.is_finite() {
                scale.colour(value)
            } else {
                MISSING
            }
        });
        drawing
            .layer("field", None)
            .cells(frame, shown, colours.collect());
        let labels = Labels {
            x: Some(self.x_label),
            y: self.y_label,
            letter: None,
        };
        Panel { frame, x, y }.draw_frame(&mut drawing, &labels);
        scale.draw_bar(&mut drawing, frame);
        Ok(drawing)
    }

    fn colours(&self) -> Result<ColourScale, FigureError> {
        let (least, largest) = match self.value_range {
            Some(range) => range,
            None => {
                let found = extent(
                    self.values
                        .iter()
                        .copied()
                        .filter(|value| value.is_finite()),
                );
                if found.0 > found.1 {
                    return Err(FigureError::EmptySeries {
                        series: "field",
                        length: self.values.len(),
                    });
                }
                let found = match self.palette {
                    Palette::Sequential | Palette::Cyclic => found,
                    Palette::Diverging => {
                        let reach = found.0.abs().max(found.1.abs());
                        (-reach, reach)
                    }
                };
                // A field of one value still needs two ends.
                Axis::linear(found).range()
            }
        };
        let scale = ColourScale::new(self.value_label, least, largest).palette(self.palette);
        scale.check()?;
        Ok(scale)
    }
}

fn axis(name: &'static str, (least, largest): (f64, f64)) -> Result<Axis, FigureError> {
    if least.is_finite() && largest.is_finite() && least < largest {
        Ok(Axis::linear((least, largest)))
    } else {
        Err(FigureError::AxisRange {
            axis: name,
            least,
            largest,
        })
    }
}

/// The field with at most so many columns, each the mean over the finite values of equally many in a row, and how many
/// there are; the last columns may hold fewer.
fn averaged(values: &[f64], columns: usize, most: usize) -> (usize, Vec<f64>) {
    // Columns must stay equally wide, so that only a divisor of their number would be exact; the mean over the columns
    // that a shown one overlaps most with is right within one of many.
    let shown = columns.min(most);
    let field = values
        .chunks_exact(columns)
        .flat_map(|row| {
            (0..shown).map(|column| {
                let part = &row[column * columns / shown..(column + 1) * columns / shown];
                let finite = part.iter().filter(|value| value.is_finite());
                let count = finite.clone().count();
                finite.sum::<f64>() / count as f64
            })
        })
        .collect();
    (shown, field)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::Shape;

    fn field(drawing: &Drawing) -> (usize, Vec<Colour>) {
        match drawing.shapes("field")[0] {
            Shape::Cells {
                columns, colours, ..
            } => (*columns, colours.clone()),
            other => panic!("a field is of cells, not {other:?}"),
        }
    }

    #[test]
    fn the_first_row_is_the_lowest_and_missing_cells_are_grey() {
        let figure = SpaceTimeFigure {
            values: &[0.0, f64::NAN, 0.5, 1.0],
            rows: 2,
            ..SpaceTimeFigure::default()
        };
        let scale = ColourScale::new("", 0.0, 1.0);
        let (columns, colours) = field(&figure.draw().expect("drawable"));
        assert_eq!(columns, 2);
        assert_eq!(
            colours,
            [
                scale.colour(0.5),
                scale.colour(1.0),
                scale.colour(0.0),
                MISSING
            ]
        );
    }

    #[test]
    fn a_long_field_is_averaged_and_keeps_its_means() {
        let values: Vec<f64> = (0..12_000).map(|index| f64::from(index % 2)).collect();
        let (shown, means) = averaged(&values, 6000, 500);
        assert_eq!((shown, means.len()), (500, 1000));
        assert!(means.iter().all(|mean| (mean - 0.5).abs() < 1e-12));
        assert_eq!(averaged(&[1.0, 2.0], 2, 10), (2, vec![1.0, 2.0]));
    }

    #[test]
    fn diverging_colours_are_white_at_nought() {
        let figure = SpaceTimeFigure {
            values: &[-0.1, 0.0, 0.9],
            rows: 1,
            palette: Palette::Diverging,
            ..SpaceTimeFigure::default()
        };
        let (_, colours) = field(&figure.draw().expect("drawable"));
        assert!(colours[1].red == colours[1].blue && colours[1].red > 240);
    }

    #[test]
    fn a_grid_that_does_not_close_is_refused() {
        let figure = SpaceTimeFigure {
            values: &[1.0, 2.0, 3.0],
            rows: 2,
            ..SpaceTimeFigure::default()
        };
        assert!(matches!(
            figure.draw(),
            Err(FigureError::GridSize {
                rows: 2,
                found: 3,
                ..
            })
        ));
        let empty = SpaceTimeFigure {
            values: &[f64::NAN; 4],
            rows: 2,
            ..SpaceTimeFigure::default()
        };
        assert!(matches!(empty.draw(), Err(FigureError::EmptySeries { .. })));
    }
}
