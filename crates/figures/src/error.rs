//! Errors in the columns of a figure.

/// Why a figure could not be drawn.
#[derive(Debug, thiserror::Error)]
pub enum FigureError {
    /// A single value that a figure needs is infinite or not a number.
    #[error("the {quantity} is {value}, not a finite number")]
    NonFinite {
        /// Name of the quantity.
        quantity: &'static str,
        /// Its value.
        value: f64,
    },
    /// A length or range that must be positive is not.
    #[error("the {quantity} is {value}; it must be positive")]
    NotPositive {
        /// Name of the quantity.
        quantity: &'static str,
        /// Its value.
        value: f64,
    },
    /// A sphere of a snapshot has a coordinate, diameter or velocity that is not a finite number.
    #[error("sphere {index} of the {group} has a value that is not a finite number")]
    NonFiniteSphere {
        /// Grains or wall.
        group: &'static str,
        /// Row of the sphere.
        index: usize,
    },
    /// A series holds no point that can be drawn.
    #[error("the series `{series}` has no finite point to draw ({length} rows)")]
    EmptySeries {
        /// Name of the series, without markup.
        series: String,
        /// Number of rows that were given.
        length: usize,
    },
    /// Columns of one series differ in length.
    #[error("the series `{series}` has {found} rows of its {column}; there must be {expected}")]
    ColumnLengths {
        /// Name of the series, without markup.
        series: String,
        /// The column that differs.
        column: &'static str,
        /// Rows that it must have.
        expected: usize,
        /// Rows that it has.
        found: usize,
    },
    /// A value has no place on a logarithmic axis.
    #[error(
        "row {row} of the series `{series}` is {value} on the logarithmic {axis} axis; it must be positive"
    )]
    NotPositiveOnLogarithm {
        /// Name of the series, without markup.
        series: String,
        /// Row of the value.
        row: usize,
        /// x or y.
        axis: &'static str,
        /// The value.
        value: f64,
    },
    /// A range that was asked for cannot be an axis.
    #[error(
        "the range of the {axis} axis is {least} to {largest}; it must be finite and increasing, and positive on a logarithmic axis"
    )]
    AxisRange {
        /// x, y or colour.
        axis: &'static str,
        /// Its least value.
        least: f64,
        /// Its largest value.
        largest: f64,
    },
    /// Panels that share an axis have it on different scales.
    #[error("the panels that share their {axis} axis have it on different scales")]
    SharedScale {
        /// x or y.
        axis: &'static str,
    },
    /// A series is to be coloured by its value on a chart that has no scale of colours.
    #[error(
        "the series `{series}` is coloured by its value, but the chart has no scale of colours"
    )]
    NoColourScale {
        /// Name of the series, without markup.
        series: String,
    },
    /// The number of values of a grid is not its rows times its columns.
    #[error("the grid of {rows} rows and {columns} columns has {found} values")]
    GridSize {
        /// Rows.
        rows: usize,
        /// Columns.
        columns: usize,
        /// Values that were given.
        found: usize,
    },
    /// A picture of this many pixels cannot be held in memory.
    #[error("a picture of {width} x {height} pixels cannot be allocated")]
    PictureTooLarge {
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
    },
    /// The PNG encoder failed.
    #[error("the picture could not be encoded as PNG")]
    Encoding(#[from] png::EncodingError),
}

/// Passes a finite value on, and names it otherwise.
pub(crate) fn finite(quantity: &'static str, value: f64) -> Result<f64, FigureError> {
    let found = value.is_finite().then_some(value);
    found.ok_or(FigureError::NonFinite { quantity, value })
}

/// Passes a finite positive value on, and names it otherwise.
pub(crate) fn positive(quantity: &'static str, value: f64) -> Result<f64, FigureError> {
    let found = (finite(quantity, value)? > 0.0).then_some(value);
    found.ok_or(FigureError::NotPositive { quantity, value })
}
