//! Rows of a list of pairs: of each sphere its partners, in order.

use core::ops::Range;

use super::cells::Piece;
use crate::fast::lanes::LANES;
use crate::fast::machine::{Instructions, Machine, Work};
use crate::fast::threads::Threads;

/// Rows of partners.
#[derive(Clone, Debug, Default)]
pub(super) struct Rows {
    /// Row i is `start[i]..start[i + 1]` of the partners.
    pub(super) start: Vec<u32>,
    pub(super) partner: Vec<u32>,
}

/// Room to collect rows in.
#[derive(Clone, Debug, Default)]
pub(super) struct Collecting {
    /// Of each sphere in which piece its partners were found, and where they begin there.
    whence: Vec<(u32, u32)>,
    /// Rows for threads to share.
    stretches: Vec<Range<usize>>,
}

impl Rows {
    #[inline(always)]
    pub(super) fn range(&self, row: usize) -> Range<usize> {
        self.start[row] as usize..self.start[row + 1] as usize
    }

    /// Place of a partner of row `row`, if it is listed.
    pub(super) fn place(&self, row: usize, partner: u32) -> Option<usize> {
        let range = self.range(row);
        let place = self.partner[range.clone()].binary_search(&partner).ok()?;
        Some(range.start + place)
    }

    /// Takes the rows of so many spheres from what was found.
    pub(super) fn collect(
        &mut self,
        spheres: usize,
        found: [&[Piece]; 2],
        room: &mut Collecting,
        threads: &Threads,
    ) {
        let Self { start, partner } = self;
        let Collecting { whence, stretches } = room;
        start.clear();
        start.resize(spheres + 1, 0);
        whence.clear();
        whence.resize(spheres, (0, 0));
        for (part, piece) in (0..).zip(found.into_iter().flatten()) {
            let mut begin = 0;
            for &(sphere, end) in &piece.found.ends {
                whence[sphere as usize] = (part, begin);
                start[sphere as usize + 1] = end - begin;
                begin = end;
            }
        }
        let mut end = 0;
        for start in start.iter_mut() {
            end += *start;
            *start = end;
        }
        if partner.capacity() < end as usize {
            // Room for later lists, so that they seldom ask for more.
            partner.reserve(2 * end as usize - partner.len());
        }
        partner.resize(end as usize, 0);
        let number = threads.stretches(spheres);
        let begin = |stretch: usize| stretch * spheres / number;
        stretches.clear();
        stretches.extend((0..number).map(|stretch| begin(stretch)..begin(stretch + 1)));
        let (start, whence) = (&start[..], &whence[..]);
        let length = |rows: &Range<usize>| (start[rows.end] - start[rows.start]) as usize;
        threads.each(
            stretches,
            &mut partner[..],
            &length,
            &|rows: &mut Range<usize>, partner| {
                Instructions::widest().run(InOrder {
                    rows: rows.clone(),
                    start,
                    whence,
                    found,
                    partner,
                });
            },
        );
    }

    /// Puts more pairs (i, j) into the rows; their order is that of the rows.
    pub(super) fn insert(&mut self, more: &[(u32, u32)]) {
        let (mut start, mut partner) = (vec![0], Vec::new());
        let mut more = more.iter().peekable();
        for row in 0..self.start.len() - 1 {
            let begin = partner.len();
            partner.extend(&self.partner[self.range(row)]);
            while let Some(&(_, j)) = more.next_if(|&&(i, _)| i as usize == row) {
                partner.push(j);
            }
            partner[begin..].sort_unstable();
            start.push(partner.len() as u32);
        }
        (self.start, self.partner) = (start, partner);
    }
}

/// Longest row that is put in order by comparing each partner with each.
const LONGEST: usize = 64;

/// Fills rows with the partners found, and puts them in order.
struct InOrder<'a> {
    rows: Range<usize>,
    /// As in [`Rows`].
    start: &'a [u32],
    /// As in [`Collecting`].
    whence: &'a [(u32, u32)],
    found: [&'a [Piece]; 2],
    /// The partners of these rows.
    partner: &'a mut [u32],
}

impl Work for InOrder<'_> {
    type Answer = ();

    #[inline(always)]
    fn run<M: Machine>(self) {
        let Self {
            rows,
            start,
            whence,
            found: [first, second],
            mut partner,
        } = self;
        for row in rows {
            let (part, begin) = whence[row];
            let (part, begin) = (part as usize, begin as usize);
            let piece = first
                .get(part)
                .unwrap_or_else(|| &second[part - first.len()]);
            let length = (start[row + 1] - start[row]) as usize;
            let (own, rest) = partner.split_at_mut(length);
            partner = rest;
            put_in_order(&piece.found.partner[begin..begin + length], own);
        }
    }
}

/// Writes numbers, no two the same, down in order, each behind as many as are less.
#[inline(always)]
fn put_in_order(numbers: &[u32], ordered: &mut [u32]) {
    if numbers.len() > LONGEST {
        ordered.copy_from_slice(numbers);
        ordered.sort_unstable();
        return;
    }
    for eight in numbers.chunks(LANES) {
        let mut own = [0; LANES];
        own[..eight.len()].copy_from_slice(eight);
        let mut less = [0_u32; LANES];
        for number in numbers {
            less = core::array::from_fn(|lane| less[lane] + u32::from(*number < own[lane]));
        }
        for (number, less) in eight.iter().zip(less) {
            ordered[less as usize] = *number;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_of_any_length_are_put_in_order() {
        for length in 0..=LONGEST + 1 {
            // No two are the same, for 37 and 101 have no factor in common.
            let numbers: Vec<u32> = (0..length as u32).map(|k| k * 37 % 101).collect();
            let mut ordered = vec![u32::MAX; length];
            put_in_order(&numbers, &mut ordered);
            let mut expected = numbers;
            expected.sort_unstable();
            assert_eq!(ordered, expected);
        }
    }
}
