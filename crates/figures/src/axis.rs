//! An axis: which values it spans, where a value lies on it, and which ticks it bears.

use crate::colour::Colour;
use crate::drawing::{Anchor, Layer};
use crate::notation::{Notation, decimal, power_label};
use crate::style::{MAJOR_TICK, MINOR_TICK, TICK_GAP, TICK_SIZE};
use crate::text::{DIGIT_HEIGHT, Text};

/// How values are spread along an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scale {
    /// Equal steps for equal differences.
    #[default]
    Linear,
    /// Linear, for counts: ticks stand at whole numbers only.
    Counting,
    /// Equal steps for equal ratios; only positive values have a place.
    Logarithmic,
}

/// A span of values with a scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Axis {
    scale: Scale,
    least: f64,
    largest: f64,
}

/// A tick with its length and, on major ticks, its label in markup.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Tick {
    pub(crate) value: f64,
    pub(crate) length: f64,
    pub(crate) label: Option<String>,
}

/// Where the number of a tick stands beside the end of the tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    Below,
    Left,
    Right,
}

impl Layer {
    /// Writes the number of a tick, if it has one.
    pub(crate) fn number(&mut self, (x, y): (f64, f64), side: Side, tick: &Tick, ink: Colour) {
        let Some(label) = &tick.label else { return };
        let height = DIGIT_HEIGHT * TICK_SIZE;
        let (place, anchor) = match side {
            Side::Below => ((x, y + TICK_GAP + height), Anchor::Middle),
            Side::Left => ((x - TICK_GAP, y + height / 2.0), Anchor::End),
            Side::Right => ((x + TICK_GAP, y + height / 2.0), Anchor::Start),
        };
        self.text(place, anchor, Text::new(label, TICK_SIZE), ink);
    }
}

/// Decades below which a logarithmic axis labels 2 and 5 too.
const FEW_DECADES: f64 = 1.6;

/// Multiples of powers of ten that a logarithmic axis labels, from the fewest to the most.
const LABELLED: [&[u8]; 3] = [&[1], &[1, 2, 5], &[1, 2, 3, 5, 7]];

/// Largest part of an axis that may lie before its first or after its last label.
const MOST_BARE: f64 = 0.35;

/// Labels below which those of a logarithmic axis stand at powers of ten only.
const MOST_FOR_POWERS: usize = 4;

/// Values between which a short logarithmic axis is labelled with plain numbers.
const PLAIN: (f64, f64) = (5e-4, 2e4);

/// Labels that an axis needs to tell its scale.
const LEAST_LABELS: usize = 2;

/// Slack for comparisons of numbers that rounding may have moved.
const ROUNDING: f64 = 1e-9;

impl Axis {
    /// An axis of a scale from the least to the largest value; both positive where it is logarithmic.
    pub(crate) fn new(scale: Scale, (least, largest): (f64, f64)) -> Self {
        Self {
            scale,
            least,
            largest,
        }
    }

    /// Least and largest value.
    pub(crate) fn range(&self) -> (f64, f64) {
        (self.least, self.largest)
    }

    /// Place of a value, 0 at the least and 1 at the largest; values without a place go to the nearer end.
    pub(crate) fn fraction(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Linear | Scale::Counting => (value - self.least) / (self.largest - self.least),
            Scale::Logarithmic if value > 0.0 => {
                libm::log10(value / self.least) / libm::log10(self.largest / self.least)
            }
            Scale::Logarithmic => 0.0,
        }
    }

    /// Ways to bear ticks at round numbers with at most about `most` labels, the best first.
    fn candidates(&self, most: usize) -> Vec<Vec<Tick>> {
        let most = most.max(LEAST_LABELS);
        let linear = [self.linear_ticks(most)];
        match self.scale {
            Scale::Linear | Scale::Counting => linear.into(),
            Scale::Logarithmic => {
                let mut all = self.logarithmic_ticks(most);
                all.extend(linear);
                all
            }
        }
    }

    /// Ticks at round numbers with as many labels as stand apart on an axis of some length, and no more than the most.
    ///
    /// `extent` is the room that a label takes along the axis, its gap to the next included. Two labels stand on every
    /// axis, even where they come close: one alone would not tell a scale. Nor do labels at one end only: where they leave
    /// much of the axis bare, the ticks that leave the least bare stand there.
    pub(crate) fn fitting_ticks(
        &self,
        length: f64,
        most: usize,
        extent: impl Fn(&str) -> f64,
    ) -> Vec<Tick> {
        let stand_apart = |ticks: &[Tick]| {
            let labelled = ticks.iter().filter_map(|tick| {
                let label = tick.label.as_ref()?;
                Some((length * self.fraction(tick.value), extent(label)))
            });
            let labelled: Vec<(f64, f64)> = labelled.collect();
            let are_apart =
                |one: (f64, f64), next: (f64, f64)| next.0 - one.0 >= (one.1 + next.1) / 2.0;
            labelled.windows(2).all(|pair| are_apart(pair[0], pair[1]))
        };
        let all = (LEAST_LABELS..=most.max(LEAST_LABELS)).rev();
        let all = all.flat_map(|most| self.candidates(most));
        let mut least_bare: Option<(f64, Vec<Tick>)> = None;
        for ticks in all.filter(|ticks| labels_of(ticks) >= LEAST_LABELS && stand_apart(ticks)) {
            let bare = self.bare(&ticks);
            if bare <= MOST_BARE {
                return ticks;
            }
            if least_bare.as_ref().is_none_or(|(least, _)| bare < *least) {
                least_bare = Some((bare, ticks));
            }
        }
        let otherwise = || with_outer_labels(self.linear_ticks(LEAST_LABELS));
        least_bare.map_or_else(otherwise, |(_, ticks)| ticks)
    }

    /// Ticks at the ends of the axis that are further than a label from the labels of some ticks.
    pub(crate) fn end_ticks(
        &self,
        length: f64,
        ticks: &[Tick],
        extent: impl Fn(&str) -> f64,
    ) -> Vec<Tick> {
        let tick = |value: f64| {
            let label = self.label_of_end(value);
            let room = extent(&label) / length;
            let is_near = |other: &Tick| {
                other.label.is_some()
                    && (self.fraction(other.value) - self.fraction(value)).abs() < room
            };
            (!ticks.iter().any(is_near)).then_some(Tick {
                value,
                length: MAJOR_TICK,
                label: Some(label),
            })
        };
        [self.least, self.largest]
            .into_iter()
            .filter_map(tick)
            .collect()
    }

    /// An end with as many digits as tell it from values a hundredth of the axis away.
    pub(crate) fn label_of_end(&self, value: f64) -> String {
        let magnitude = value.abs();
        let slack = match self.scale {
            Scale::Linear | Scale::Counting => (self.largest - self.least) / 100.0,
            Scale::Logarithmic => magnitude / 100.0,
        };
        let step = |exponent: f64| libm::pow(10.0, exponent);
        let mut exponent = libm::floor(libm::log10(magnitude.max(slack)));
        while (libm::round(value / step(exponent)) * step(exponent) - value).abs() > slack {
            exponent -= 1.0;
        }
        Notation::new(magnitude.max(slack), exponent).label(value)
    }

    /// The longer of the parts of the axis before the first and after the last label.
    fn bare(&self, ticks: &[Tick]) -> f64 {
        let labelled = ticks.iter().filter(|tick| tick.label.is_some());
        let (first, last) = extent(labelled.map(|tick| self.fraction(tick.value)));
        first.max(1.0 - last)
    }

    fn linear_ticks(&self, most: usize) -> Vec<Tick> {
        // A short axis may hold fewer round numbers than it has room for; closer ones tell its scale.
        (most..=4 * most)
            .map(|most| self.round_ticks(most))
            .find(|ticks| labels_of(ticks) >= LEAST_LABELS)
            .unwrap_or_else(|| self.round_ticks(most))
    }

    fn round_ticks(&self, most: usize) -> Vec<Tick> {
        let is_counting = self.scale == Scale::Counting;
        let mut wanted = (self.largest - self.least) / most as f64;
        if is_counting {
            wanted = wanted.max(1.0);
        }
        let (mut factor, mut exponent) = (1.0, libm::floor(libm::log10(wanted)));
        let reduced = wanted / libm::pow(10.0, exponent);
        if reduced > 5.0 + ROUNDING {
            exponent += 1.0;
        } else if reduced > 2.0 + ROUNDING {
            factor = 5.0;
        } else if reduced > 1.0 + ROUNDING {
            factor = 2.0;
        }
        let step = factor * libm::pow(10.0, exponent);
        let parts = match factor {
            // Nothing lies between two neighbouring whole numbers.
            _ if is_counting && step < 10.0 => step,
            2.0 => 4.0,
            _ => 5.0,
        };
        let fine = step / parts;
        let notation = Notation::new(self.least.abs().max(self.largest.abs()), exponent);
        // A tick that rounding pushes over the end still belongs to the axis.
        let first = (self.least / fine - 1e-6).ceil();
        let last = (self.largest / fine + 1e-6).floor();
        (0..=(last - first).max(0.0) as usize)
            .map(|index| {
                let multiple = first + index as f64;
                let value = multiple * fine;
                let major = multiple % parts == 0.0;
                Tick {
                    value,
                    length: if major { MAJOR_TICK } else { MINOR_TICK },
                    label: major.then(|| notation.label(value)),
                }
            })
            .collect()
    }

    fn logarithmic_ticks(&self, most: usize) -> Vec<Vec<Tick>> {
        let ticks = |multiples: &&[u8]| self.power_ticks(most, multiples);
        let mut all: Vec<Vec<Tick>> = LABELLED.iter().map(ticks).collect();
        let decades = libm::log10(self.largest / self.least);
        if decades < FEW_DECADES && most >= MOST_FOR_POWERS {
            all.rotate_left(1);
        }
        all
    }

    /// Ticks at the multiples of powers of ten, with labels at some multiples.
    fn power_ticks(&self, most: usize, labelled: &[u8]) -> Vec<Tick> {
        let decades = libm::log10(self.largest / self.least);
        let stride = (decades / most as f64).ceil().max(1.0);
        let plain = (decades < FEW_DECADES || labelled.len() > 1)
            && self.least >= PLAIN.0
            && self.largest <= PLAIN.1;
        let first = libm::floor(libm::log10(self.least));
        let last = libm::ceil(libm::log10(self.largest));
        let mut ticks = Vec::new();
        for index in 0..=(last - first).max(0.0) as usize {
            let exponent = first + index as f64;
            for multiple in 1..10_u8 {
                let value = f64::from(multiple) * libm::pow(10.0, exponent);
                if value < self.least * (1.0 - 1e-9) || value > self.largest * (1.0 + 1e-9) {
                    continue;
                }
                let labelled = labelled.contains(&multiple)
                    && (multiple > 1 || exponent.rem_euclid(stride) == 0.0);
                let label = || {
                    if plain {
                        decimal(value, (-exponent).max(0.0) as usize)
                    } else {
                        power_label(multiple, exponent)
                    }
                };
                ticks.push(Tick {
                    value,
                    length: if multiple == 1 {
                        MAJOR_TICK
                    } else {
                        MINOR_TICK
                    },
                    label: labelled.then(label),
                });
            }
        }
        ticks
    }
}

/// Ticks of which the first and the last label are left.
fn with_outer_labels(mut ticks: Vec<Tick>) -> Vec<Tick> {
    let is_labelled = |tick: &Tick| tick.label.is_some();
    let first = ticks.iter().position(is_labelled);
    let last = ticks.iter().rposition(is_labelled);
    for (index, tick) in ticks.iter_mut().enumerate() {
        if ![first, last].contains(&Some(index)) {
            tick.label = None;
        }
    }
    ticks
}

fn labels_of(ticks: &[Tick]) -> usize {
    ticks.iter().filter(|tick| tick.label.is_some()).count()
}

/// Length of the longest label.
pub(crate) fn widest(ticks: &[Tick]) -> f64 {
    let labels = ticks.iter().filter_map(|tick| tick.label.as_ref());
    let widths = labels.map(|label| Text::new(label, TICK_SIZE).width);
    widths.fold(0.0, f64::max)
}

/// Least and largest of some values; (inf, -inf) for none.
pub(crate) fn extent(values: impl IntoIterator<Item = f64>) -> (f64, f64) {
    let (mut least, mut largest) = (f64::INFINITY, f64::NEG_INFINITY);
    for value in values {
        (least, largest) = (least.min(value), largest.max(value));
    }
    (least, largest)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis, most: usize) -> Vec<String> {
        let ticks = axis.fitting_ticks(1000.0, most, |_| 20.0).into_iter();
        ticks.filter_map(|tick| tick.label).collect()
    }

    #[test]
    fn linear_labels_are_round_numbers() {
        for (range, most, expected) in [
            ((0.0, 1.0), 5, "0.0 0.2 0.4 0.6 0.8 1.0"),
            ((-0.12, 0.31), 5, "\u{2212}0.1 0.0 0.1 0.2 0.3"),
            ((0.0, 5000.0), 5, "0 1000 2000 3000 4000 5000"),
        ] {
            let found = labels(&Axis::new(Scale::Linear, range), most);
            assert_eq!(found.join(" "), expected);
        }
        let small = Axis::new(Scale::Linear, (0.0, 4.0e-5));
        assert_eq!(labels(&small, 4)[1], "1×10^{\u{2212}5}");
    }

    #[test]
    fn logarithmic_labels_are_powers_of_ten() {
        let axis = Axis::new(Scale::Logarithmic, (0.9e-3, 1.1e2));
        let expected = "10^{\u{2212}3} 10^{\u{2212}2} 10^{\u{2212}1} 1 10^{1} 10^{2}";
        assert_eq!(labels(&axis, 6).join(" "), expected);
        let short = Axis::new(Scale::Logarithmic, (1.0, 6.0));
        assert_eq!(labels(&short, 6), ["1", "2", "5"]);
        // One power of ten alone would not tell a scale.
        let one = Axis::new(Scale::Logarithmic, (18.0, 640.0));
        assert_eq!(labels(&one, 3), ["20", "50", "100", "200", "500"]);
    }

    /// `length` (b) and `collapse` (d) lacked labels at the low end.
    #[test]
    fn labels_reach_both_ends_of_an_axis() {
        for (range, expected) in [
            ((14.7, 680.0), "20 50 100 200 500"),
            ((1.1, 45.0), "2 5 10 20"),
            ((2.1, 9.0), "3 5 7"),
        ] {
            let axis = Axis::new(Scale::Logarithmic, range);
            let found = labels(&axis, 6).join(" ");
            assert!(found.starts_with(expected), "{range:?}: {found}");
            let bare = axis.bare(&axis.fitting_ticks(300.0, 6, |_| 20.0));
            assert!(bare <= MOST_BARE, "{range:?}: {bare}");
        }
    }

    /// Fractional ticks on the number of a wave.
    #[test]
    fn what_is_counted_has_ticks_at_whole_numbers() {
        for waves in [1, 2, 3, 5, 20, 137] {
            let axis = Axis::new(Scale::Counting, (-0.5, f64::from(waves) - 0.5));
            let ticks = axis.fitting_ticks(120.0, 7, |_| 9.0);
            let whole = ticks.iter().all(|tick| tick.value.fract() == 0.0);
            assert!(whole && ticks[0].value == 0.0, "{waves}: {ticks:?}");
            let whole = |tick: &Tick| tick.label.as_ref().is_none_or(|it| !it.contains('.'));
            assert!(ticks.iter().all(whole), "{waves}: {ticks:?}");
        }
    }

    #[test]
    fn an_axis_with_room_for_two_labels_has_two() {
        let ranges = [
            (-0.12, 0.31),
            (-0.4, 0.9),
            (0.13, 0.19),
            (-3.0, 7.0),
            (2.51, 2.93),
        ];
        for range in ranges {
            for most in 0..4 {
                let found = labels(&Axis::new(Scale::Linear, range), most);
                assert!((2..=5).contains(&found.len()), "{range:?}: {found:?}");
            }
        }
        let axis = Axis::new(Scale::Logarithmic, (3.2, 4.4));
        assert!(labels(&axis, 3).len() >= 2, "{:?}", labels(&axis, 3));
    }

    #[test]
    fn labels_that_fit_stand_apart() {
        let axis = Axis::new(Scale::Linear, (0.0, 1.0));
        for length in [32.0, 50.0, 120.0, 400.0] {
            let ticks = axis.fitting_ticks(length, 8, |_| 15.0);
            let labelled = ticks.iter().filter(|tick| tick.label.is_some());
            let places = labelled.map(|tick| length * axis.fraction(tick.value));
            let places: Vec<f64> = places.collect();
            let are_apart = places.windows(2).all(|pair| pair[1] - pair[0] >= 15.0);
            assert!(are_apart, "{length}: {places:?}");
        }
    }

    #[test]
    fn an_axis_too_short_for_its_labels_keeps_the_outer_ones() {
        let axis = Axis::new(Scale::Linear, (-0.43, 0.43));
        let ticks = axis.fitting_ticks(12.0, 0, |_| 9.0).into_iter();
        let found: Vec<String> = ticks.filter_map(|tick| tick.label).collect();
        assert_eq!(found, ["\u{2212}0.4", "0.4"]);
    }

    #[test]
    fn a_short_logarithmic_axis_has_plain_numbers() {
        let axis = Axis::new(Scale::Logarithmic, (0.02, 0.2));
        assert_eq!(labels(&axis, 6), ["0.02", "0.05", "0.1", "0.2"]);
    }

    #[test]
    fn places_are_monotone_and_reach_from_end_to_end() {
        for scale in [Scale::Linear, Scale::Logarithmic] {
            let axis = Axis::new(scale, (0.018, 33.0));
            let (least, largest) = axis.range();
            assert!(axis.fraction(least).abs() < 1e-12);
            assert!((axis.fraction(largest) - 1.0).abs() < 1e-12);
            let places = (1..1000).map(|step| axis.fraction(f64::from(step) * 0.033));
            let places: Vec<f64> = places.collect();
            assert!(places.windows(2).all(|pair| pair[0] < pair[1]));
        }
    }
}
