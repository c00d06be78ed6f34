//! Columns as they come from a table.

use crate::FigureError;

/// Two columns of equal length; rows that are not finite leave a gap in the line.
#[derive(Clone, Copy, Debug, Default)]
pub struct Series<'a> {
    /// Column of the horizontal axis.
    pub x: &'a [f64],
    /// Column of the vertical axis.
    pub y: &'a [f64],
}

/// A quantity along the tube, with a statistical error where one is known.
#[derive(Clone, Copy, Debug, Default)]
pub struct Profile<'a> {
    /// Position in the wave frame, (z - c t)/lambda.
    pub position: &'a [f64],
    /// The quantity at that position.
    pub value: &'a [f64],
    /// Standard error of the quantity, in its own units.
    pub error: Option<&'a [f64]>,
    /// Label of the axis, in markup.
    pub label: &'a str,
}

/// A point of a line with its error (0 where none is known).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sample {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) error: f64,
}

impl Series<'_> {
    /// The finite points, cut into unbroken pieces wherever a row is not finite.
    pub(crate) fn pieces(&self, name: &'static str) -> Result<Vec<Vec<Sample>>, FigureError> {
        check_lengths(name, self.x, self.y)?;
        let rows = self
            .x
            .iter()
            .zip(self.y)
            .map(|(&x, &y)| Sample { x, y, error: 0.0 });
        cut(name, self.x.len(), rows)
    }
}

impl Profile<'_> {
    /// The finite points, cut into unbroken pieces wherever a row is not finite; an error that is not finite counts as unknown.
    pub(crate) fn pieces(&self, name: &'static str) -> Result<Vec<Vec<Sample>>, FigureError> {
        check_lengths(name, self.position, self.value)?;
        if let Some(error) = self.error {
            check_lengths(name, self.position, error)?;
        }
        let error_of = |row: usize| self.error.map_or(0.0, |error| error[row]);
        let rows = (0..self.position.len()).map(|row| {
            let error = error_of(row);
            let error = if error.is_finite() { error.abs() } else { 0.0 };
            Sample {
                x: self.position[row],
                y: self.value[row],
                error,
            }
        });
        cut(name, self.position.len(), rows)
    }
}

/// Carries lines over the ends of one wavelength: where positions fill 0 to 1, the last point also appears before the
/// first and the first after the last, a wavelength away. Other lines come back unchanged.
pub(crate) fn close_wavelength(mut pieces: Vec<Vec<Sample>>) -> Vec<Vec<Sample>> {
    let count = pieces.iter().map(Vec::len).sum::<usize>();
    let ends = pieces
        .first()
        .and_then(|piece| piece.first())
        .zip(pieces.last().and_then(|piece| piece.last()));
    let Some((&first, &last)) = ends else {
        return pieces;
    };
    let seam = first.x + 1.0 - last.x;
    let within = first.x >= 0.0 && last.x <= 1.0 && first.x < last.x;
    // The seam may be as wide as one missing point makes it, no wider.
    let spacing = (last.x - first.x) / (count.max(2) - 1) as f64;
    if within && seam > 0.0 && seam < 2.5 * spacing {
        if let Some(piece) = pieces.first_mut() {
            piece.insert(
                0,
                Sample {
                    x: last.x - 1.0,
                    ..last
                },
            );
        }
        if let Some(piece) = pieces.last_mut() {
            piece.push(Sample {
                x: first.x + 1.0,
                ..first
            });
        }
    }
    pieces
}

/// Range of positions: one wavelength where they lie within the first.
pub(crate) fn wavelength_range(positions: impl IntoIterator<Item = f64>) -> (f64, f64) {
    let (least, largest) = extent(positions);
    if least >= 0.0 && largest <= 1.0 {
        (0.0, 1.0)
    } else {
        (least, largest)
    }
}

/// Errors unless both columns have the same number of rows.
pub(crate) fn check_lengths(
    series: &'static str,
    first: &[f64],
    other: &[f64],
) -> Result<(), FigureError> {
    if first.len() == other.len() {
        Ok(())
    } else {
        Err(FigureError::ColumnLengths {
            series,
            expected: first.len(),
            found: other.len(),
        })
    }
}

fn cut(
    series: &'static str,
    length: usize,
    rows: impl Iterator<Item = Sample>,
) -> Result<Vec<Vec<Sample>>, FigureError> {
    let mut pieces = Vec::new();
    let mut piece = Vec::new();
    for sample in rows {
        if sample.x.is_finite() && sample.y.is_finite() {
            piece.push(sample);
        } else if !piece.is_empty() {
            pieces.push(std::mem::take(&mut piece));
        }
    }
    if !piece.is_empty() {
        pieces.push(piece);
    }
    if pieces.is_empty() {
        Err(FigureError::EmptySeries { series, length })
    } else {
        Ok(pieces)
    }
}

/// Least and largest of some values; (inf, -inf) for none.
pub(crate) fn extent(values: impl IntoIterator<Item = f64>) -> (f64, f64) {
    values.into_iter().fold(
        (f64::INFINITY, f64::NEG_INFINITY),
        |(least, largest), value| (least.min(value), largest.max(value)),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_that_is_not_finite_cuts_the_line() {
        let series = Series {
            x: &[0.0, 1.0, 2.0, f64::INFINITY, 4.0],
            y: &[1.0, f64::NAN, 3.0, 4.0, 5.0],
        };
        let pieces = series.pieces("flow rate").expect("finite rows remain");
        let ends: Vec<Vec<f64>> = pieces
            .iter()
            .map(|piece| piece.iter().map(|sample| sample.y).collect())
            .collect();
        assert_eq!(ends, [vec![1.0], vec![3.0], vec![5.0]]);
    }

    #[test]
    fn nothing_finite_is_an_error_that_names_the_series() {
        let error = Series {
            x: &[0.0],
            y: &[f64::NAN],
        }
        .pieces("flow rate")
        .expect_err("nothing to draw");
        assert!(error.to_string().contains("flow rate"), "{error}");
        let error = Series {
            x: &[0.0, 1.0],
            y: &[0.0],
        }
        .pieces("flow rate")
        .expect_err("uneven columns");
        assert!(
            matches!(
                error,
                FigureError::ColumnLengths {
                    expected: 2,
                    found: 1,
                    ..
                }
            ),
            "{error}"
        );
    }

    #[test]
    fn bins_that_fill_a_wavelength_are_closed_over_its_ends() {
        let sample = |x, y| Sample { x, y, error: 0.0 };
        let line = vec![
            sample(0.125, 1.0),
            sample(0.375, 2.0),
            sample(0.625, 3.0),
            sample(0.875, 4.0),
        ];
        let closed = close_wavelength(vec![line.clone()]);
        assert_eq!(
            (closed[0][0], closed[0][5]),
            (sample(-0.125, 4.0), sample(1.125, 1.0))
        );
        let half = vec![line[..2].to_vec()];
        assert_eq!(close_wavelength(half.clone()), half);
    }

    #[test]
    fn an_unknown_error_is_no_error() {
        let profile = Profile {
            position: &[0.0, 0.5],
            value: &[1.0, 2.0],
            error: Some(&[f64::NAN, 0.25]),
            label: "",
        };
        let pieces = profile.pieces("density").expect("finite rows");
        assert_eq!(
            pieces[0]
                .iter()
                .map(|sample| sample.error)
                .collect::<Vec<_>>(),
            [0.0, 0.25]
        );
    }
}
