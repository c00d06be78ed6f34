//! Colours that stay apart for colour-blind readers: the Okabe-Ito palette, a sequential map for amounts and a
//! diverging one for signed values.

/// A colour with opacity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Colour {
    pub(crate) red: u8,
    pub(crate) green: u8,
    pub(crate) blue: u8,
    /// 0 (clear) to 1 (solid)
    pub(crate) opacity: f64,
}

pub(crate) const BLACK: Colour = Colour::new(0, 0, 0);
pub(crate) const WHITE: Colour = Colour::new(255, 255, 255);
pub(crate) const GREY: Colour = Colour::new(128, 128, 128);

/// Blue for -1 through white at 0 to red at 1, in equal steps of the argument (after ColorBrewer's RdBu).
const DIVERGING: [u32; 9] = [
    0x0c4282, 0x2870b2, 0x62a4cf, 0xacd2e5, 0xfafafa, 0xfbcdb4, 0xec8e70, 0xcc4042, 0x860824,
];

/// Dark violet through green to yellow, lighter all the way, in equal steps of the argument (viridis, van der Walt and
/// Smith 2015, dedicated to the public domain).
const SEQUENTIAL: [u32; 11] = [
    0x440154, 0x482475, 0x414487, 0x355f8d, 0x2a788e, 0x21918c, 0x22a884, 0x44bf70, 0x7ad151,
    0xbddf26, 0xfde725,
];

/// Light, blue, dark, red and light again in equal steps of the argument, as light at 1 as at 0 (after twilight, Bechtold
/// 2018, dedicated to the public domain).
const CYCLIC: [u32; 9] = [
    0xe2d9e2, 0x9abac9, 0x6177ba, 0x5d3c9c, 0x2f1436, 0x76224f, 0xb25652, 0xcfa68f, 0xe2d9e2,
];

/// Dark violet through red to light yellow: told apart from [`SEQUENTIAL`] where both are in one picture, as in the viewer.
const FORCE: [u32; 5] = [0x463c6e, 0x963278, 0xe1503c, 0xffaa32, 0xfffabe];

/// Steps of the diverging map on either side of 0: few enough that the spheres of a snapshot share their shadings.
const DIVERGING_STEPS: f64 = 24.0;

impl Colour {
    pub(crate) const fn new(red: u8, green: u8, blue: u8) -> Self {
        Self {
            red,
            green,
            blue,
            opacity: 1.0,
        }
    }

    /// From six hexadecimal digits.
    pub(crate) const fn hex(digits: u32) -> Self {
        let [_, red, green, blue] = digits.to_be_bytes();
        Self::new(red, green, blue)
    }

    pub(crate) const fn faint(self, opacity: f64) -> Self {
        Self { opacity, ..self }
    }

    /// This colour moved towards another: 0 leaves it, 1 gives the other.
    pub(crate) fn towards(self, other: Self, fraction: f64) -> Self {
        let channel = |from: u8, to: u8| {
            let value = f64::from(from) + (f64::from(to) - f64::from(from)) * fraction;
            // In 0..=255 because both ends are and the fraction is in 0..=1.
            value.round() as u8
        };
        Self {
            red: channel(self.red, other.red),
            green: channel(self.green, other.green),
            blue: channel(self.blue, other.blue),
            opacity: self.opacity,
        }
    }

    /// Red, green and blue, without the opacity.
    pub(crate) fn srgb(self) -> [u8; 3] {
        [self.red, self.green, self.blue]
    }

    /// Six hexadecimal digits, without the opacity.
    pub(crate) fn hexadecimal(self) -> String {
        format!("{:02x}{:02x}{:02x}", self.red, self.green, self.blue)
    }
}

/// Colour of a signed value scaled to -1..1: blue below 0, white at 0, red above; values beyond are clamped.
pub(crate) fn diverging(value: f64) -> Colour {
    let stepped = (value.clamp(-1.0, 1.0) * DIVERGING_STEPS).round() / DIVERGING_STEPS;
    between(&DIVERGING, (stepped + 1.0) / 2.0)
}

/// Colour of an amount scaled to 0..1: darkest at 0, lightest at 1; values beyond are clamped.
pub(crate) fn sequential(value: f64) -> Colour {
    between(&SEQUENTIAL, value)
}

/// Colour of a phase, 0..1, of which 0 and 1 are the same; values beyond are clamped.
pub(crate) fn cyclic(value: f64) -> Colour {
    between(&CYCLIC, value)
}

/// Colour of a force scaled to 0..1: darkest at 0, lightest at 1; values beyond are clamped.
pub(crate) fn force(value: f64) -> Colour {
    between(&FORCE, value)
}

/// Colour at a fraction of the way through colours in equal steps.
fn between(colours: &[u32], fraction: f64) -> Colour {
    let position = fraction.clamp(0.0, 1.0) * (colours.len() - 1) as f64;
    let below = (position.floor() as usize).min(colours.len() - 2);
    let [from, to] = [below, below + 1].map(|index| Colour::hex(colours[index]));
    from.towards(to, position - below as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_diverging_map_is_blue_white_red() {
        let (against, rest, along) = (diverging(-1.0), diverging(0.0), diverging(1.0));
        assert!(against.blue > 2 * against.red.max(1), "{against:?}");
        assert!(along.red > 2 * along.blue, "{along:?}");
        assert!(rest.red == rest.blue && rest.red > 245, "{rest:?}");
        assert_eq!(diverging(7.0), along);
        assert_eq!(diverging(-7.0), against);
    }

    #[test]
    fn the_sequential_map_grows_lighter_all_the_way() {
        let lightness = |step: i32| {
            let colour = sequential(f64::from(step) / 40.0);
            0.30 * f64::from(colour.red)
                + 0.59 * f64::from(colour.green)
                + 0.11 * f64::from(colour.blue)
        };
        assert!((0..40).all(|step| lightness(step) < lightness(step + 1)));
        assert_eq!(
            (sequential(-1.0), sequential(2.0)),
            (Colour::hex(SEQUENTIAL[0]), Colour::hex(SEQUENTIAL[10]))
        );
    }

    #[test]
    fn the_red_half_darkens_steadily() {
        let mut last = u8::MAX;
        for step in 0..=24 {
            let green = diverging(f64::from(step) / 24.0).green;
            assert!(green < last, "step {step}");
            last = green;
        }
    }
}
