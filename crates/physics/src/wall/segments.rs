//! Rings of finite length that squeeze the tube in turn: the drive of segmented devices.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Most segments in a wavelength.
pub(crate) const MOST_SEGMENTS: usize = 32;

/// The segments of a wavelength and their cycle, as a user gives them.
///
/// A wavelength is n segments of one length, counted from 1 along the wave. Each closes once a period, from the straight
/// tube of radius a to a - b: it narrows within `rise`, stays closed for `duty`, opens within `fall` and is straight for the
/// rest, each a part of the period. They close at even intervals, in the `order` given. The radius between the middles of
/// neighbours goes over smoothly within `edge` of a segment's length, about their border.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct SegmentDrive {
    /// Number n of segments in a wavelength; waveform = "segments".
    #[schemars(extend("x-unit" = "1", "minimum" = 2, "maximum" = MOST_SEGMENTS))]
    pub segments: u32,
    /// The segments in the order in which they close, counted from 1 along the wave, each once; waveform = "segments".
    /// Default: one after the other along the wave.
    #[schemars(extend("x-unit" = "1", "items" = {"type": "integer", "minimum": 1, "maximum": MOST_SEGMENTS}, "default" = null))]
    pub order: Vec<u32>,
    /// Part of the period for which a segment is closed; duty + rise + fall is at most 1; waveform = "segments".
    #[schemars(extend("x-unit" = "periods", "minimum" = 0, "maximum" = 1))]
    pub duty: f64,
    /// Part of the period in which a segment closes; waveform = "segments".
    #[schemars(extend("x-unit" = "periods", "minimum" = 1e-3, "maximum" = 1))]
    pub rise: f64,
    /// Part of the period in which a segment opens; waveform = "segments".
    #[schemars(extend("x-unit" = "periods", "minimum" = 1e-3, "maximum" = 1))]
    pub fall: f64,
    /// Length over which one segment goes over into the next, in lengths of a segment; waveform = "segments".
    #[schemars(extend("x-unit" = "1", "minimum" = 1e-3, "maximum" = 1))]
    pub edge: f64,
}

impl Default for SegmentDrive {
    fn default() -> Self {
        Self {
            segments: 4,
            order: Vec::new(),
            duty: 0.25,
            rise: 0.2,
            fall: 0.2,
            edge: 0.5,
        }
    }
}

impl SegmentDrive {
    /// Part of the period in which a segment is not open.
    pub fn cycle(&self) -> f64 {
        self.duty + self.rise + self.fall
    }
}

/// A [`SegmentDrive`], ready to give the radius.
///
/// R = a + b G, G = -sum_p w_p(y) h(tau - tau_p), y the place along the wave and tau the time in wavelengths and periods;
/// h goes from 0 to 1 and back, w_p(y) from 1 in segment p to 0, both by 3 x^2 - 2 x^3; tau_p = (k_p + 1/2)/n + 3/4, k_p the
/// turn of segment p, from 0: closed segments run ahead as the throats of a wave do.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Segments {
    number: u8,
    turns: [u8; MOST_SEGMENTS],
    duty: f64,
    rise: f64,
    fall: f64,
    edge: f64,
}

/// G and its derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Squeeze {
    /// G, from -1 (closed) to 0 (straight).
    pub value: f64,
    /// dG/dtau \[1/period\]
    pub in_time: f64,
    /// dG/dy \[1/wavelength\]
    pub along: f64,
}

impl Segments {
    /// `None` for numbers that [`SegmentDrive`] does not allow, or an order that does not name each segment once.
    pub fn new(drive: &SegmentDrive) -> Option<Self> {
        let number = drive.segments as usize;
        let in_range = |value: f64| (1e-3..=1.0).contains(&value);
        let ways = [drive.rise, drive.fall, drive.edge];
        // NaN is in no range.
        let is_cycle =
            ways.into_iter().all(in_range) && drive.duty >= 0.0 && drive.cycle() <= LONGEST_CYCLE;
        if !(2..=MOST_SEGMENTS).contains(&number) || !is_cycle {
            return None;
        }
        let mut turns = [u8::MAX; MOST_SEGMENTS];
        if drive.order.is_empty() {
            (0..number).for_each(|segment| turns[segment] = segment as u8);
        } else if drive.order.len() != number {
            return None;
        }
        for (turn, &segment) in drive.order.iter().enumerate() {
            let place = turns[..number].get_mut((segment as usize).checked_sub(1)?)?;
            if *place != u8::MAX {
                return None;
            }
            *place = turn as u8;
        }
        turns[number..].fill(0);
        Some(Self {
            number: number as u8,
            turns,
            duty: drive.duty,
            rise: drive.rise,
            fall: drive.fall,
            edge: drive.edge,
        })
    }

    /// The squeeze at `place` y along the wave, in wavelengths, and time tau, in periods.
    pub fn squeeze(&self, place: f64, time: f64) -> Squeeze {
        let number = f64::from(self.number);
        let place = number * (place - place.floor());
        // The border next to it: that of segments `behind` and `ahead`.
        let border = (place + 0.5).floor();
        let ahead = border as usize % usize::from(self.number);
        let behind = (ahead + usize::from(self.number) - 1) % usize::from(self.number);
        let (part, steepness) = step((place - border) / self.edge + 0.5);
        let [(from, from_rate), (to, to_rate)] =
            [behind, ahead].map(|segment| self.closing(segment, time));
        Squeeze {
            value: -(from + part * (to - from)),
            in_time: -(from_rate + part * (to_rate - from_rate)),
            along: -steepness * (to - from) * number / self.edge,
        }
    }

    /// h and dh/dtau of a segment.
    fn closing(&self, segment: usize, time: f64) -> (f64, f64) {
        let turn = f64::from(self.turns[segment]);
        let middle = (turn + 0.5) / f64::from(self.number) + 0.75;
        // Since it began to close.
        let since = time - middle + 0.5 * self.duty + self.rise;
        let since = since - since.floor();
        let until = self.rise + self.duty + self.fall - since;
        if since < self.rise {
            let (value, slope) = step(since / self.rise);
            (value, slope / self.rise)
        } else {
            let (value, slope) = step(until / self.fall);
            (value, -slope / self.fall)
        }
    }

    /// How far the segment that is closed most is closed, from 0 to 1.
    pub fn depth(&self, time: f64) -> f64 {
        let segments = 0..usize::from(self.number);
        segments
            .map(|segment| self.closing(segment, time).0)
            .fold(0.0, f64::max)
    }

    /// Length over which one segment goes over into the next \[lambda\].
    pub fn border(&self) -> f64 {
        self.edge / f64::from(self.number)
    }

    /// Largest size of dG/dy \[1/wavelength\].
    pub fn steepest(&self) -> f64 {
        1.5 / self.border()
    }

    /// Mean of G over a wavelength and a period.
    pub fn mean(&self) -> f64 {
        -(self.duty + 0.5 * (self.rise + self.fall))
    }
}

/// Largest duty + rise + fall, with room for rounding.
pub const LONGEST_CYCLE: f64 = 1.0 + 1e-12;

/// 3 x^2 - 2 x^3 and its derivative, 0 below 0 and 1 above 1.
fn step(x: f64) -> (f64, f64) {
    let x = x.clamp(0.0, 1.0);
    (x * x * (3.0 - 2.0 * x), 6.0 * x * (1.0 - x))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drives() -> Vec<Segments> {
        let with = |drive: SegmentDrive| Segments::new(&drive).unwrap();
        vec![
            with(SegmentDrive::default()),
            with(SegmentDrive {
                segments: 2,
                duty: 0.0,
                rise: 0.5,
                fall: 0.5,
                edge: 1.0,
                ..SegmentDrive::default()
            }),
            with(SegmentDrive {
                segments: 5,
                order: vec![1, 3, 5, 2, 4],
                duty: 0.6,
                rise: 0.05,
                fall: 0.3,
                edge: 0.1,
            }),
        ]
    }

    /// By hand: four segments, each closed from 1/8 before its turn to 1/8 after.
    #[test]
    fn each_segment_closes_in_its_turn() {
        let segments = drives()[0];
        for segment in 0..4 {
            let middle = (f64::from(segment) + 0.5) / 4.0;
            for (since, value) in [
                (-0.315, -0.00725),
                (-0.225, -0.5),
                (-0.1, -1.0),
                (0.0, -1.0),
                (0.225, -0.5),
                (0.4, 0.0),
            ] {
                // The throat of a wave is at y = tau + 1/4.
                let found = segments.squeeze(middle, middle - 0.25 + since);
                assert!(
                    (found.value - value).abs() < 1e-12,
                    "{segment} {since}: {found:?}"
                );
            }
        }
        let turned = drives()[2];
        // The third segment closes second: at 0.3 + 3/4.
        assert_eq!(turned.squeeze(0.5, 1.05).value, -1.0);
        assert_eq!(
            turned.squeeze(0.3, 1.05).value,
            turned.squeeze(0.3, 2.05).value
        );
    }

    /// Volume: the section pi (a + b G)^2 lacks nothing of continuity, and its mean G is the one stated.
    #[test]
    fn the_radius_is_continuous_and_its_rates_are_the_derivatives() {
        let h = 1e-6;
        for segments in drives() {
            let (mut sum, steps) = (0.0, 400);
            for i in 0..steps {
                for j in 0..steps {
                    let (place, time) =
                        ((f64::from(i) + 0.5) / 400.0, (f64::from(j) + 0.5) / 400.0);
                    let found = segments.squeeze(place, time);
                    assert!((-1.0..=0.0).contains(&found.value));
                    sum += found.value;
                    if i % 7 != 0 || j % 5 != 0 {
                        continue;
                    }
                    let value = |place: f64, time: f64| segments.squeeze(place, time).value;
                    let in_time = (value(place, time + h) - value(place, time - h)) / (2.0 * h);
                    let along = (value(place + h, time) - value(place - h, time)) / (2.0 * h);
                    assert!(found.value >= -segments.depth(time) - 1e-15);
                    assert!(
                        (found.in_time - in_time).abs() < 1e-3,
                        "{found:?} {in_time}"
                    );
                    assert!((found.along - along).abs() < 1e-2, "{found:?} {along}");
                }
            }
            assert!((sum / f64::from(steps * steps) - segments.mean()).abs() < 1e-4);
            // No jump anywhere, the seam and the start of the period with it.
            for step in 0..=100_000_u32 {
                let at = f64::from(step) / 1e5;
                let next = at + 1e-5;
                for fixed in [0.03, 0.499, 0.77] {
                    let moved =
                        segments.squeeze(next, fixed).value - segments.squeeze(at, fixed).value;
                    let later =
                        segments.squeeze(fixed, next).value - segments.squeeze(fixed, at).value;
                    assert!(
                        moved.abs() < 2e-3 && later.abs() < 1e-3,
                        "{at}: {moved} {later}"
                    );
                }
            }
        }
    }

    #[test]
    fn what_is_no_cycle_is_refused() {
        let base = SegmentDrive::default;
        for wrong in [
            SegmentDrive {
                segments: 1,
                ..base()
            },
            SegmentDrive {
                segments: 33,
                ..base()
            },
            SegmentDrive {
                duty: 0.7,
                ..base()
            },
            SegmentDrive {
                rise: 0.0,
                ..base()
            },
            SegmentDrive {
                edge: f64::NAN,
                ..base()
            },
            SegmentDrive {
                order: vec![1, 2, 3],
                ..base()
            },
            SegmentDrive {
                order: vec![1, 2, 3, 3],
                ..base()
            },
            SegmentDrive {
                order: vec![0, 1, 2, 3],
                ..base()
            },
            SegmentDrive {
                order: vec![1, 2, 3, 5],
                ..base()
            },
        ] {
            assert_eq!(Segments::new(&wrong), None, "{wrong:?}");
        }
    }
}
