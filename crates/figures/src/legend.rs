//! The legend of a figure, below the frame or in a free part of it.

use crate::colour::{BLACK, Colour};
use crate::drawing::{Anchor, Drawing, Fill, Stroke};
use crate::geometry::{Path, Point, Rectangle};
use crate::style::LEGEND_SIZE;
use crate::text::Text;

/// Sample of a band, a line and a mark, one upon the other, beside their meaning.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Entry {
    pub(crate) line: Option<Stroke>,
    pub(crate) band: Option<Colour>,
    pub(crate) mark: Option<Mark>,
    pub(crate) meaning: String,
}

/// Sample of a mark.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Mark {
    /// Around the origin.
    pub(crate) outline: Path,
    pub(crate) fill: Colour,
    pub(crate) stroke: Stroke,
    /// Straight lines beside it, relative to its place.
    pub(crate) bars: Vec<[Point; 2]>,
    pub(crate) bar_stroke: Stroke,
}

/// A list of entries on a grid; a long entry takes several columns.
#[derive(Clone, Debug)]
pub(crate) struct Legend {
    cells: Vec<Cell>,
    rows: usize,
    /// Width on the page.
    pub(crate) width: f64,
    /// Width of the samples.
    sample: f64,
}

/// An entry with its row and its distance from the left of the list.
#[derive(Clone, Debug)]
struct Cell {
    entry: Entry,
    text: Text,
    row: usize,
    start: f64,
}

/// Where an entry stands on the grid.
#[derive(Clone, Copy, Debug)]
struct Place {
    row: usize,
    column: usize,
    /// Number of columns that it takes.
    span: usize,
}

/// Space above the first row.
pub(crate) const TOP_SPACE: f64 = 4.0;
const SAMPLE_WIDTH: f64 = 17.0;
/// Width of samples that are marks only.
const MARK_WIDTH: f64 = 7.0;
const SAMPLE_GAP: f64 = 4.0;
const COLUMN_GAP: f64 = 10.0;
const ROW_HEIGHT: f64 = 9.2;
const MOST_COLUMNS: usize = 8;

impl Legend {
    /// Sets the entries in the room across that there is, in as few rows as possible.
    pub(crate) fn new(entries: Vec<Entry>, room: f64) -> Self {
        let text = |it: &str| Text::fitted(it, LEGEND_SIZE, room - SAMPLE_WIDTH - SAMPLE_GAP);
        let is_titled = entries.first().is_some_and(Entry::is_title);
        // Of grids with equally few rows, one that leaves the room below a title free is the most orderly, and then the one
        // with the fewest columns.
        let grid = |widths: &[f64]| {
            let grids = [is_titled, false].into_iter().flat_map(|hangs| {
                (1..=MOST_COLUMNS).map(move |columns| {
                    places(widths, columns, (room + COLUMN_GAP) / columns as f64, hangs)
                })
            });
            grids
                .min_by_key(|places| rows_of(places))
                .unwrap_or_default()
        };
        Self::set(entries, SAMPLE_WIDTH, text, grid)
    }

    /// Sets the entries below each other in some columns, each as wide as its entries.
    pub(crate) fn list(entries: Vec<Entry>, columns: usize) -> Self {
        let is_mark = |entry: &Entry| entry.line.is_none() && entry.band.is_none();
        let are_marks = entries.iter().all(is_mark);
        let sample = if are_marks { MARK_WIDTH } else { SAMPLE_WIDTH };
        let columns = columns.min(MOST_COLUMNS);
        let place = |index: usize| Place {
            row: index / columns,
            column: index % columns,
            span: 1,
        };
        let grid = |widths: &[f64]| (0..widths.len()).map(place).collect();
        Self::set(entries, sample, |it| Text::new(it, LEGEND_SIZE), grid)
    }

    /// Sets the entries on the grid that is chosen for their widths.
    fn set(
        entries: Vec<Entry>,
        sample: f64,
        text: impl Fn(&str) -> Text,
        grid: impl Fn(&[f64]) -> Vec<Place>,
    ) -> Self {
        let texts: Vec<Text> = entries.iter().map(|entry| text(&entry.meaning)).collect();
        let widths: Vec<f64> = texts
            .iter()
            .map(|text| sample + SAMPLE_GAP + text.width)
            .collect();
        let places = grid(&widths);
        let rows = rows_of(&places);
        let starts = column_starts(&places, &widths);
        let cells = entries.into_iter().zip(texts).zip(places);
        let cells = cells.map(|((entry, text), place)| Cell {
            entry,
            text,
            row: place.row,
            start: starts[place.column],
        });
        let cells: Vec<Cell> = cells.collect();
        let ends = cells.iter().map(|cell| cell.end(sample));
        let width = ends.fold(0.0, f64::max);
        Self {
            cells,
            rows,
            width,
            sample,
        }
    }

    /// Height on the page, 0 without entries.
    pub(crate) fn height(&self) -> f64 {
        if self.cells.is_empty() {
            0.0
        } else {
            TOP_SPACE + ROW_HEIGHT * self.rows as f64
        }
    }

    /// Draws the list, centred between two sides, from a height downwards.
    pub(crate) fn draw(&self, drawing: &mut Drawing, left: f64, right: f64, top: f64) {
        let layer = drawing.layer("legend", None);
        for cell in &self.cells {
            let start = (left + right - self.width) / 2.0 + cell.start;
            let middle = top + TOP_SPACE + ROW_HEIGHT * (cell.row as f64 + 0.5);
            if let Some(colour) = cell.entry.band {
                let area = Rectangle::new((start, middle - 2.6), (self.sample, 5.2));
                layer.fill(Path::polygon(area.corners()), colour);
            }
            if let Some(stroke) = cell.entry.line {
                let ends = [start, start + self.sample].map(|x| Point::new(x, middle));
                layer.stroke(Path::line(ends), stroke);
            }
            if let Some(mark) = &cell.entry.mark {
                let place = [Point::new(start + self.sample / 2.0, middle)];
                let bars = Path::segments(mark.bars.iter().copied());
                layer.stroke(bars.at(place), mark.bar_stroke);
                let (fill, stroke) = (Some(Fill::Flat(mark.fill)), Some(mark.stroke));
                layer.path(mark.outline.at(place), fill, stroke);
            }
            let (after, baseline) = (
                start + self.sample + SAMPLE_GAP,
                middle + 0.35 * LEGEND_SIZE,
            );
            layer.text((after, baseline), Anchor::Start, cell.text.clone(), BLACK);
        }
    }
}

impl Entry {
    /// Whether it is the title of those behind it, without a sample.
    fn is_title(&self) -> bool {
        self.line.is_none() && self.band.is_none() && self.mark.is_none()
    }
}

impl Cell {
    /// Distance of the entry's end from the left of the list.
    fn end(&self, sample: f64) -> f64 {
        self.start + sample + SAMPLE_GAP + self.text.width
    }
}

/// Place of each entry on a grid of equal columns, filled like lines of text; where they hang, later lines begin behind the
/// first entry, if that leaves room for every other.
fn places(widths: &[f64], columns: usize, column_width: f64, hangs: bool) -> Vec<Place> {
    let span = |width: &f64| ((width + COLUMN_GAP) / column_width - 1e-9).ceil().max(1.0);
    let spans: Vec<usize> = widths
        .iter()
        .map(|width| columns.min(span(width) as usize))
        .collect();
    let begin = match spans.split_first() {
        Some((first, others)) if hangs && others.iter().all(|it| first + it <= columns) => *first,
        _ => 0,
    };
    let (mut row, mut column) = (0, 0);
    let place = |span| {
        if column + span > columns {
            (row, column) = (row + 1, begin);
        }
        column += span;
        Place {
            row,
            column: column - span,
            span,
        }
    };
    spans.into_iter().map(place).collect()
}

fn rows_of(places: &[Place]) -> usize {
    places.last().map_or(0, |place| place.row + 1)
}

/// Where each column starts when all are drawn together as far as their entries allow.
fn column_starts(places: &[Place], widths: &[f64]) -> [f64; MOST_COLUMNS] {
    let mut starts = [0.0; MOST_COLUMNS];
    for column in 1..MOST_COLUMNS {
        let entries = places.iter().zip(widths);
        let before = entries.filter(|(place, _)| place.column + place.span <= column);
        starts[column] = before.fold(0.0, |start: f64, (place, width)| {
            start.max(starts[place.column] + width + COLUMN_GAP)
        });
    }
    starts
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entries(meanings: &[&str]) -> Vec<Entry> {
        let line = Some(Stroke::solid(BLACK, 1.0));
        meanings
            .iter()
            .map(|meaning| Entry {
                line,
                meaning: (*meaning).to_owned(),
                ..Entry::default()
            })
            .collect()
    }

    #[test]
    fn short_entries_share_a_row_and_long_ones_do_not() {
        assert_eq!(Legend::new(entries(&["a", "b", "c"]), 200.0).rows, 1);
        let long = "a meaning that takes much more than a half of the room";
        assert_eq!(Legend::new(entries(&[long, long]), 220.0).rows, 2);
        let mixed = entries(&["short", "brief", long]);
        assert_eq!(Legend::new(mixed, 220.0).rows, 2);
        assert_eq!(Legend::new(Vec::new(), 200.0).height(), 0.0);
    }

    /// Entries of a second row stood below the title and one column beside those of the first.
    #[test]
    fn nothing_stands_below_a_title() {
        let mut titled = entries(&["strain rate:", "0.03", "0.04", "0.05", "0.06"]);
        titled[0].line = None;
        let legend = Legend::new(titled, 200.0);
        assert_eq!(legend.rows, 2);
        let [_, first, _, below, _] = &legend.cells[..] else {
            panic!("five entries")
        };
        assert_eq!((below.row, below.start), (1, first.start));
    }

    #[test]
    fn no_entry_runs_into_the_next() {
        let room = 300.0;
        let long = "a long late mean 0.9 ± 0.1";
        let meanings = ["samples", "mean over a period", "threshold", long, "x"];
        let legend = Legend::new(entries(&meanings), room);
        for pair in legend.cells.windows(2) {
            assert!(pair[0].end(SAMPLE_WIDTH) <= room && pair[1].end(SAMPLE_WIDTH) <= room);
            if pair[0].row == pair[1].row {
                assert!(pair[0].end(SAMPLE_WIDTH) < pair[1].start);
            }
        }
    }
}
