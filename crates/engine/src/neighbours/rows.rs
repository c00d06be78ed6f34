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

/// Partners of some spheres, in no order.
#[derive(Clone, Debug, Default)]
pub(super) struct Found {
    pub(super) partner: Vec<u32>,
    /// Each of the spheres, and where its partners end.
    pub(super) ends: Vec<(u32, u32)>,
}

/// Room to collect rows in.
#[derive(Clone, Debug, Default)]
pub(super) struct Collecting {
    /// Of each sphere in which piece its partners were found, and where they begin there.
    whence: Vec<(u32, u32)>,
    /// Rows for threads to share.
    stretches: Vec<Range<usize>>,
}

impl Found {
    /// Keeps the pairs i < j that `admits` admits.
    pub(super) fn retain(&mut self, admits: impl Fn(usize, usize) -> bool) {
        let (mut begin, mut kept) = (0, 0);
        for (i, end) in &mut self.ends {
            for at in begin..*end as usize {
                let j = self.partner[at];
                self.partner[kept] = j;
                kept += usize::from(admits(*i as usize, j as usize));
            }
            begin = *end as usize;
            *end = kept as u32;
        }
        self.partner.truncate(kept);
    }
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
        let number = threads.stretches();
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

/// Longest row that is sorted beside others.
const LONGEST: usize = 32;

/// Fills rows with the partners found, and sorts them, eight rows side by side.
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
            found,
            mut partner,
        } = self;
        let found_of = |row: usize| {
            let (part, begin) = whence[row];
            let (part, begin) = (part as usize, begin as usize);
            let length = (start[row + 1] - start[row]) as usize;
            let [first, second] = found;
            let piece = first
                .get(part)
                .unwrap_or_else(|| &second[part - first.len()]);
            &piece.found.partner[begin..begin + length]
        };
        let mut columns = [[u32::MAX; LANES]; LONGEST];
        for first in rows.clone().step_by(LANES) {
            let eight = first..rows.end.min(first + LANES);
            let longest = eight.clone().map(|row| found_of(row).len()).max();
            let columns = columns.get_mut(..longest.unwrap_or_default());
            if let Some(columns) = columns {
                columns.fill([u32::MAX; LANES]);
                for (lane, row) in eight.clone().enumerate() {
                    for (column, partner) in columns.iter_mut().zip(found_of(row)) {
                        column[lane] = *partner;
                    }
                }
                sort(columns);
                for (lane, row) in eight.enumerate() {
                    let (own, rest) = partner.split_at_mut(found_of(row).len());
                    partner = rest;
                    for (partner, column) in own.iter_mut().zip(&*columns) {
                        *partner = column[lane];
                    }
                }
            } else {
                for row in eight {
                    let (own, rest) = partner.split_at_mut(found_of(row).len());
                    partner = rest;
                    own.copy_from_slice(found_of(row));
                    own.sort_unstable();
                }
            }
        }
    }
}

/// Sorts along the columns, in each lane by itself, by odd-even transposition.
#[inline(always)]
fn sort(columns: &mut [[u32; LANES]]) {
    for round in 0..columns.len() {
        for pair in columns[round % 2..].as_chunks_mut().0 {
            let [one, two]: [[u32; LANES]; 2] = *pair;
            *pair = [
                core::array::from_fn(|lane| one[lane].min(two[lane])),
                core::array::from_fn(|lane| one[lane].max(two[lane])),
            ];
        }
    }
}
