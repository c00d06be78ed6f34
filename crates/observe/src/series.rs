//! A series that a run of any length can keep.

use serde::{Deserialize, Serialize};

/// Rows that a series of entries of some rows has at most: those of 13,000 periods of 20 samples. Beyond, neighbours become
/// one.
pub const MOST_ROWS: usize = 1 << 18;

/// An entry of a series that can replace several neighbouring entries.
pub trait Join {
    /// Takes in what came next: `own` entries are here, `others` in `next`.
    fn join(&mut self, own: u64, next: &Self, others: u64);
}

/// Mean of two numbers that stand for so many entries each.
pub(crate) fn joined(one: f64, own: u64, next: f64, others: u64) -> f64 {
    (one * own as f64 + next * others as f64) / (own + others) as f64
}

impl Join for f64 {
    fn join(&mut self, own: u64, next: &Self, others: u64) {
        *self = joined(*self, own, *next, others);
    }
}

/// Entries of equally many rows, one after another.
///
/// While there is room each entry has rows of its own. Then every two neighbours become one, and so do later ones, as if
/// the run were looked at half as often. The series is never longer than [`MOST_ROWS`], or two entries where these are more.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Series<T> {
    rows: Vec<T>,
    /// Rows of an entry.
    width: usize,
    /// Entries that share their rows.
    each: u64,
    /// Entries that are in the last rows.
    in_last: u64,
}

impl<T: Join> Series<T> {
    /// An empty series, whose entries have `width` rows.
    pub fn new(width: usize) -> Self {
        Self {
            rows: Vec::new(),
            width: width.max(1),
            each: 1,
            in_last: 1,
        }
    }

    /// Takes the whole out.
    pub fn take(&mut self) -> Self {
        let empty = Self::new(self.width);
        std::mem::replace(self, empty)
    }

    /// Adds an entry.
    pub fn push(&mut self, entry: impl IntoIterator<Item = T>) {
        if self.in_last == self.each {
            if self.rows.len() / self.width >= self.most_entries() {
                self.halve();
            }
            self.rows.extend(entry);
            self.in_last = 1;
            return;
        }
        let first = self.rows.len() - self.width;
        for (row, next) in self.rows[first..].iter_mut().zip(entry) {
            row.join(self.in_last, &next, 1);
        }
        self.in_last += 1;
    }

    /// An even number, for every two become one.
    fn most_entries(&self) -> usize {
        (MOST_ROWS / self.width / 2 * 2).max(2)
    }

    /// Makes one of every two neighbours.
    fn halve(&mut self) {
        let (width, each) = (self.width, self.each);
        let entries = self.rows.len() / width;
        let mut rows = std::mem::take(&mut self.rows).into_iter();
        let mut halved: Vec<T> = Vec::with_capacity(self.most_entries() * width);
        for _ in 0..entries / 2 {
            let first = halved.len();
            halved.extend(rows.by_ref().take(width));
            for (row, next) in halved[first..].iter_mut().zip(rows.by_ref()) {
                row.join(each, &next, each);
            }
        }
        (self.rows, self.each) = (halved, 2 * each);
    }

    /// Forgets all but the first `count` entries. Rows that stand for earlier and later ones stay as they are.
    pub fn truncate(&mut self, count: u64) {
        if count >= self.count() {
            return;
        }
        let kept = count.div_ceil(self.each);
        self.rows.truncate(kept as usize * self.width);
        self.in_last = self.each - (kept * self.each - count);
    }

    /// The rows so far.
    pub fn rows(&self) -> &[T] {
        &self.rows
    }

    /// Entries so far.
    pub fn count(&self) -> u64 {
        match (self.rows.len() / self.width) as u64 {
            0 => 0,
            entries => (entries - 1) * self.each + self.in_last,
        }
    }

    /// Entries that share their rows: 1, or a power of 2 in a long series.
    pub fn each(&self) -> u64 {
        self.each
    }

    /// Whether it is a series of entries of `width` rows.
    pub fn fits(&self, width: usize) -> bool {
        self.width == width.max(1)
            && self.rows.len() / self.width <= self.most_entries()
            && self.rows.len().is_multiple_of(self.width)
            && self.each.is_power_of_two()
            && (1..=self.each).contains(&self.in_last)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_series_is_that_of_a_run_looked_at_less_often() {
        let mut series = Series::new(2);
        let number = 5 * (MOST_ROWS / 2) as u64 / 2 + 3;
        for entry in 0..number {
            series.push([entry as f64, -(entry as f64)]);
            assert_eq!(series.count(), entry + 1);
        }
        assert!(series.fits(2) && !series.fits(3));
        assert_eq!(series.each(), 4);
        // Means of four, the last of the three that are left.
        assert_eq!(series.rows()[..4], [1.5, -1.5, 5.5, -5.5]);
        let last = number as f64 - 2.0;
        assert_eq!(series.rows()[series.rows().len() - 2..], [last, -last]);
        let capacity = series.rows.capacity();
        assert!(capacity <= 2 * MOST_ROWS, "{capacity}");

        series.truncate(11);
        assert_eq!((series.count(), series.rows().len()), (11, 6));
        series.truncate(8);
        assert_eq!((series.count(), series.rows().len()), (8, 4));
        series.push([1.0, 2.0]);
        assert_eq!(series.rows()[4..], [1.0, 2.0]);
        let all = series.take();
        assert_eq!((all.count(), series.count()), (9, 0));
    }

    #[test]
    fn entries_of_very_many_rows_are_kept_by_twos() {
        for width in [MOST_ROWS / 2 + 1, MOST_ROWS + 1] {
            let mut series = Series::new(width);
            for entry in 0..5_u32 {
                series.push(vec![f64::from(entry); width]);
                assert_eq!(series.count(), u64::from(entry) + 1);
                assert!(series.fits(width));
            }
            assert_eq!(series.each(), 4);
            assert_eq!([series.rows()[0], series.rows()[width]], [1.5, 4.0]);
        }
    }
}
