//! The cross-section of the tube, divided into strips along it.
//!
//! In a narrow tube there is one. In a wide one the grains of a strip have few others ahead of them, and their partners
//! stand in the same strip or in one of the eight beside it; four of these look for them.

/// Mean number of grains ahead within reach above which strips serve better than one row.
const MOST_AHEAD: f64 = 20.0;

/// Half the width of the square that is divided, in mean radii of the tube; what lies farther out belongs to the strips
/// at its edge.
const HALF_WIDTH: f64 = 1.25;

/// Skin of this kernel in skins of a list of neighbours: sorting anew costs more, and pairs that do not touch cost less.
pub(super) const SKINS: f64 = 2.0;

/// How many strips side by side at most.
const MOST_ACROSS: f64 = 256.0;

/// Square strips, each at least as wide as listed pairs reach.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Strips {
    across: usize,
    half_width: f64,
    per_width: f64,
    /// How far pairs are listed beyond their reach \[d\].
    pub(super) skin: f64,
}

/// Strips ahead of a strip, across the tube.
pub(super) const AHEAD: usize = 4;

impl Strips {
    /// For so many grains of a diameter in a tube of this length and mean radius.
    pub(super) fn new(
        grains: usize,
        length: f64,
        mean_radius: f64,
        diameter: f64,
        skin: f64,
    ) -> Self {
        let half_width = HALF_WIDTH * mean_radius;
        let skin = SKINS * skin;
        let cutoff = diameter + skin;
        let ahead = grains as f64 / length * cutoff;
        let across = if ahead <= MOST_AHEAD {
            1.0
        } else {
            (2.0 * half_width / cutoff).floor().clamp(1.0, MOST_ACROSS)
        };
        Self {
            across: across as usize,
            half_width,
            per_width: across / (2.0 * half_width),
            skin,
        }
    }

    pub(super) fn number(&self) -> usize {
        self.across * self.across
    }

    /// Whether there is more than one.
    pub(super) fn several(&self) -> bool {
        self.across > 1
    }

    /// The strip of a place in the cross-section.
    pub(super) fn at(&self, x: f64, y: f64) -> usize {
        if !self.several() {
            return 0;
        }
        let index = |coordinate: f64| {
            (((coordinate + self.half_width) * self.per_width) as usize).min(self.across - 1)
        };
        index(y) * self.across + index(x)
    }

    /// Those of the strips beside this one that no strip before it looks at; each two neighbours meet once.
    pub(super) fn ahead(&self, strip: usize) -> [Option<usize>; AHEAD] {
        let (x, y) = (strip % self.across, strip / self.across);
        let (right, left, above) = (x + 1 < self.across, x > 0, y + 1 < self.across);
        [
            right.then_some(strip + 1),
            (above && left).then(|| strip + self.across - 1),
            above.then(|| strip + self.across),
            (above && right).then(|| strip + self.across + 1),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_narrow_tube_is_one_strip_and_a_wide_one_many() {
        let narrow = Strips::new(405, 100.0, 1.5, 1.0, 0.3);
        assert!((narrow.number(), narrow.several()) == (1, false));
        assert_eq!(narrow.at(-7.0, f64::NAN), 0);
        let wide = Strips::new(100_000, 500.0, 10.0, 1.0, 0.3);
        assert_eq!(wide.number(), 15 * 15);
    }

    #[test]
    fn neighbours_within_the_cutoff_meet_exactly_once() {
        let cutoff = 1.0 + SKINS * 0.3;
        let strips = Strips::new(100_000, 500.0, 4.0, 1.0, 0.3);
        let meets = |one: usize, other: usize| strips.ahead(one).contains(&Some(other));
        let places: Vec<(f64, f64)> = (-13..=13)
            .flat_map(|i| (-13..=13).map(move |j| (f64::from(i) * 0.5, f64::from(j) * 0.5)))
            .collect();
        for &(x, y) in &places {
            for &(u, v) in &places {
                let (one, other) = (strips.at(x, y), strips.at(u, v));
                let both = u32::from(meets(one, other)) + u32::from(meets(other, one));
                if one == other {
                    assert_eq!(both, 0);
                } else if libm::hypot(x - u, y - v) < cutoff {
                    assert_eq!(both, 1, "({x}, {y}) and ({u}, {v})");
                } else {
                    assert!(both < 2);
                }
            }
        }
    }
}
