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

/// Okabe and Ito's blue.
pub(crate) const BLUE: Colour = Colour::new(0, 114, 178);
/// Okabe and Ito's sky blue.
pub(crate) const SKY: Colour = Colour::new(86, 180, 233);
/// Okabe and Ito's vermillion.
pub(crate) const VERMILLION: Colour = Colour::new(213, 94, 0);
/// Okabe and Ito's orange.
pub(crate) const ORANGE: Colour = Colour::new(230, 159, 0);
/// Okabe and Ito's bluish green.
pub(crate) const GREEN: Colour = Colour::new(0, 158, 115);
/// Okabe and Ito's reddish purple.
pub(crate) const PURPLE: Colour = Colour::new(204, 121, 167);

/// Motion along the wave.
pub(crate) const ALONG: Colour = Colour::new(178, 24, 43);
/// Motion against the wave.
pub(crate) const AGAINST: Colour = Colour::new(33, 102, 172);

/// Blue for -1 through white at 0 to red at 1, in equal steps of the argument (after ColorBrewer's RdBu).
const DIVERGING: [Colour; 9] = [
    Colour::new(12, 66, 130),
    Colour::new(40, 112, 178),
    Colour::new(98, 164, 207),
    Colour::new(172, 210, 229),
    Colour::new(250, 250, 250),
    Colour::new(251, 205, 180),
    Colour::new(236, 142, 112),
    Colour::new(204, 64, 66),
    Colour::new(134, 8, 36),
];

/// Dark violet through green to yellow, lighter all the way, in equal steps of the argument (viridis, van der Walt and
/// Smith 2015, dedicated to the public domain).
const SEQUENTIAL: [Colour; 11] = [
    Colour::new(68, 1, 84),
    Colour::new(72, 36, 117),
    Colour::new(65, 68, 135),
    Colour::new(53, 95, 141),
    Colour::new(42, 120, 142),
    Colour::new(33, 145, 140),
    Colour::new(34, 168, 132),
    Colour::new(68, 191, 112),
    Colour::new(122, 209, 81),
    Colour::new(189, 223, 38),
    Colour::new(253, 231, 37),
];

/// Light, blue, dark, red and light again in equal steps of the argument, as light at 1 as at 0 (after twilight, Bechtold
/// 2018, dedicated to the public domain).
const CYCLIC: [Colour; 9] = [
    Colour::new(226, 217, 226),
    Colour::new(154, 186, 201),
    Colour::new(97, 119, 186),
    Colour::new(93, 60, 156),
    Colour::new(47, 20, 54),
    Colour::new(118, 34, 79),
    Colour::new(178, 86, 82),
    Colour::new(207, 166, 143),
    Colour::new(226, 217, 226),
];

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

/// Colour at a fraction of the way through colours in equal steps.
fn between(colours: &[Colour], fraction: f64) -> Colour {
    let position = fraction.clamp(0.0, 1.0) * (colours.len() - 1) as f64;
    let below = (position.floor() as usize).min(colours.len() - 2);
    colours[below].towards(colours[below + 1], position - below as f64)
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
            (SEQUENTIAL[0], SEQUENTIAL[10])
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
