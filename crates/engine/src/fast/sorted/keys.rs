//! The keys that the grains are sorted by.

use core::cmp::Ordering;

use rayon::prelude::*;

use super::rows::{Key, PIECE, Row, Scratch};
use super::state::Sorted;
use crate::bodies::fold;

impl Sorted {
    /// Notes the keys of all grains strip by strip, folding them back into the tube; in each strip those come first that
    /// left the tube at its end, and those last that left it at its beginning: what then remains to be done is little.
    pub(super) fn note_strips(&mut self) {
        let (z, length) = (&mut self.position.z, self.length);
        let (x, y) = (&self.position.x, &self.position.y);
        let strip = |place: usize| self.strips.at(x[place], y[place]);
        let Scratch { keys, counts, .. } = &mut self.scratch;
        counts.clear();
        counts.resize(self.strips.number(), [0; 3]);
        for place in self.rows.iter().flat_map(Row::own) {
            counts[strip(place)][side(z[place], length)] += 1;
        }
        let mut end = 0;
        for count in counts.iter_mut().flatten() {
            (*count, end) = (end, end + *count);
        }
        keys.clear();
        keys.resize(end as usize, (0.0, 0));
        for place in self.rows.iter().flat_map(Row::own) {
            let next = &mut counts[strip(place)][side(z[place], length)];
            let (folded, more) = fold(z[place], length);
            z[place] = folded;
            self.turns[place] += more;
            keys[*next as usize] = (folded, place as u32);
            *next += 1;
        }
        // By now each count stands where the next begins.
    }

    /// Does the same in a narrow tube, several threads at a time.
    pub(super) fn note_row_in_pieces(&mut self) {
        let (row, length) = (self.rows.first().map_or(0..0, Row::own), self.length);
        let (z, turns) = (
            &mut self.position.z[row.clone()],
            &mut self.turns[row.clone()],
        );
        let Scratch {
            keys,
            counts,
            of_pieces,
            ..
        } = &mut self.scratch;
        keys.resize(row.len(), (0.0, 0));
        of_pieces.clear();
        of_pieces.resize(row.len().div_ceil(PIECE), [0; 3]);
        let pieces = z.par_chunks(PIECE);
        pieces.zip(&mut *of_pieces).for_each(|(piece, count)| {
            for &z in piece {
                count[side(z, length)] += 1;
            }
        });
        let sum = |side: usize| of_pieces.iter().map(|count| count[side] as usize).sum();
        let (left_at_end, rest) = keys.split_at_mut(sum(0));
        let (within, left_at_beginning) = rest.split_at_mut(sum(1));
        let mut rest = [left_at_end, within, left_at_beginning];
        let mut room: Vec<[&mut [Key]; 3]> = Vec::with_capacity(of_pieces.len());
        for count in of_pieces.iter() {
            room.push(core::array::from_fn(|side| {
                let (own, others) =
                    core::mem::take(&mut rest[side]).split_at_mut(count[side] as usize);
                rest[side] = others;
                own
            }));
        }
        let pieces = z.par_chunks_mut(PIECE).zip(turns.par_chunks_mut(PIECE));
        let pieces = pieces.zip(room);
        pieces.enumerate().for_each(|(piece, ((z, turns), keys))| {
            let first = (row.start + piece * PIECE) as u32;
            let mut keys = keys.map(|keys| keys.iter_mut());
            for (place, (z, turns)) in (first..).zip(z.iter_mut().zip(turns)) {
                let key = keys[side(*z, length)].next();
                let more;
                (*z, more) = fold(*z, length);
                *turns += more;
                *key.expect("room for as many as were counted") = (*z, place);
            }
        });
        counts.clear();
        counts.push([row.len() as u32; 3]);
    }
}

/// Whether a grain comes from beyond the end of the tube (0), from within (1) or from before its beginning (2).
fn side(z: f64, length: f64) -> usize {
    match z {
        z if z >= length => 0,
        z if z < 0.0 => 2,
        _ => 1,
    }
}

/// The order along the tube, with one zero.
fn by_place(one: &Key, other: &Key) -> Ordering {
    (one.0 + 0.0).total_cmp(&(other.0 + 0.0))
}

/// Sorts the keys of strips, each of which ends where the last of its counts says.
pub(super) fn put_strips_in_order(mut keys: &mut [Key], counts: &[[u32; 3]], parallel: bool) {
    let parallel = parallel && keys.len() > PIECE;
    let mut begin = 0;
    let strips = counts.iter().map(|count| {
        let end = count[2] as usize;
        let (strip, rest) = core::mem::take(&mut keys).split_at_mut(end - begin);
        (keys, begin) = (rest, end);
        strip
    });
    if parallel {
        let strips: Vec<&mut [Key]> = strips.collect();
        let sort = |strip: &mut [Key]| strip.par_sort_by(by_place);
        strips.into_par_iter().for_each(sort);
    } else {
        strips.for_each(put_in_order);
    }
}

/// Sorts keys that are nearly in order. The order is stable, and so the same however it is made.
fn put_in_order(keys: &mut [Key]) {
    let mut steps_left = 64 * keys.len();
    for unsorted in 1..keys.len() {
        let key = keys[unsorted];
        let mut hole = unsorted;
        while hole > 0 && key.0 < keys[hole - 1].0 {
            keys[hole] = keys[hole - 1];
            hole -= 1;
        }
        keys[hole] = key;
        steps_left = steps_left.saturating_sub(unsorted - hole);
        if steps_left == 0 {
            keys.sort_by(by_place);
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers that jump about, and some of which are equal.
    fn keys(number: u32, disorder: f64) -> Vec<Key> {
        let jump = |place: u32| f64::from(place.wrapping_mul(2_654_435_761) % 1000) / 1000.0;
        (0..number)
            .map(|place| (f64::from(place / 2) + disorder * jump(place), place))
            .collect()
    }

    #[test]
    fn strips_are_put_in_the_one_stable_order_whoever_does_it() {
        let number = 3 * PIECE as u32 + 17;
        // Strips of many lengths, none among them; and one that holds all.
        let six = vec![0, 5, 5, PIECE as u32 + 1, 2 * PIECE as u32, number];
        for (ends, disorder) in [six, vec![number]]
            .iter()
            .flat_map(|ends| [0.0, 0.5, 40.0, 1e9].map(|disorder| (ends, disorder)))
        {
            for parallel in [false, true] {
                let mut found = keys(number, disorder);
                let strips: Vec<_> = ends.iter().map(|&end| [0, 0, end]).collect();
                put_strips_in_order(&mut found, &strips, parallel);
                let mut begin = 0;
                for end in ends.iter().map(|&end| end as usize) {
                    let mut expected = keys(number, disorder)[begin..end].to_vec();
                    expected.sort_by(|one, other| one.0.total_cmp(&other.0));
                    assert!(found[begin..end] == expected, "{disorder} {parallel}");
                    begin = end;
                }
            }
        }
    }
}
