//! Thousands of points on a few hundred columns of a page, without losing an extreme.

use crate::series::Sample;

/// Thins a line to what can be seen: of all consecutive points in one of `columns` equal steps of x, only the first,
/// the last, the least and the largest remain, in their order.
///
/// A line of no more points than four a column comes back unchanged.
pub(crate) fn envelope(line: &[Sample], range: (f64, f64), columns: usize) -> Vec<Sample> {
    if line.len() <= 4 * columns {
        return line.to_vec();
    }
    let width = (range.1 - range.0) / columns as f64;
    let column = |sample: &Sample| ((sample.x - range.0) / width).floor();
    let mut thinned = Vec::with_capacity(4 * columns);
    for group in line.chunk_by(|one, next| column(one) == column(next)) {
        let mut kept = [
            0,
            index_of(group, |one, other| one < other),
            index_of(group, |one, other| one > other),
            group.len() - 1,
        ];
        kept.sort_unstable();
        for (place, &index) in kept.iter().enumerate() {
            if place == 0 || kept[place - 1] != index {
                thinned.push(group[index]);
            }
        }
    }
    thinned
}

/// Index of the first point of a non-empty group that beats all others.
fn index_of(group: &[Sample], beats: impl Fn(f64, f64) -> bool) -> usize {
    (1..group.len()).fold(0, |best, index| {
        if beats(group[index].y, group[best].y) {
            index
        } else {
            best
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave(count: usize) -> Vec<Sample> {
        (0..count)
            .map(|index| {
                let x = index as f64 / count as f64;
                Sample {
                    x,
                    y: libm::sin(900.0 * x),
                    error: 0.0,
                }
            })
            .collect()
    }

    #[test]
    fn a_single_spike_survives() {
        let mut line = wave(100_000);
        line[54_321].y = 17.0;
        line[12_345].y = -23.0;
        let thin = envelope(&line, (0.0, 1.0), 200);
        assert!(thin.len() <= 800, "{}", thin.len());
        assert!(thin.contains(&line[54_321]));
        assert!(thin.contains(&line[12_345]));
        assert_eq!(
            (thin[0], thin[thin.len() - 1]),
            (line[0], line[line.len() - 1])
        );
    }

    #[test]
    fn order_is_kept_and_every_column_keeps_its_extent() {
        let line = wave(50_000);
        let thin = envelope(&line, (0.0, 1.0), 100);
        assert!(thin.windows(2).all(|pair| pair[0].x < pair[1].x));
        for column in 0..100 {
            let extent = |points: &[Sample]| {
                crate::series::extent(
                    points
                        .iter()
                        .filter(|point| (point.x * 100.0).floor() == f64::from(column))
                        .map(|point| point.y),
                )
            };
            assert_eq!(extent(&line), extent(&thin), "column {column}");
        }
    }

    #[test]
    fn a_short_line_is_left_alone() {
        let line = wave(300);
        assert_eq!(envelope(&line, (0.0, 1.0), 100), line);
    }
}
