//! Colours in linear light.

use glam::Vec3;

/// A colour in linear light, red, green and blue in \[0, 1\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Colour(pub(crate) Vec3);

impl Colour {
    /// A colour by its sRGB bytes.
    #[must_use]
    pub fn srgb(red: u8, green: u8, blue: u8) -> Self {
        let channel = |byte: u8| {
            let value = f32::from(byte) / 255.0;
            if value <= 0.040_45 {
                value / 12.92
            } else {
                libm::powf((value + 0.055) / 1.055, 2.4)
            }
        };
        Self(Vec3::new(channel(red), channel(green), channel(blue)))
    }

    /// The bytes of the colour in sRGB (IEC 61966-2-1).
    #[must_use]
    pub fn to_srgb(self) -> [u8; 3] {
        let channel = |value: f32| {
            let value = value.clamp(0.0, 1.0);
            let encoded = if value <= 0.003_130_8 {
                12.92 * value
            } else {
                1.055 * libm::powf(value, 1.0 / 2.4) - 0.055
            };
            libm::roundf(255.0 * encoded) as u8
        };
        self.0.to_array().map(channel)
    }

    fn mix(self, other: Self, part: f32) -> Self {
        Self(self.0.lerp(other.0, part))
    }
}

/// Blue at -1, white at 0, red at 1, with equal steps of lightness on both sides.
///
/// Values beyond are drawn as the ends; what is not a number is grey.
#[must_use]
pub fn diverging(value: f64) -> Colour {
    // Ends and middles of either side in sRGB, of falling lightness.
    const SIDES: [[[u8; 3]; 2]; 2] = [
        [[110, 165, 215], [20, 70, 160]],
        [[240, 140, 105], [165, 15, 30]],
    ];
    if value.is_nan() {
        return Colour::srgb(150, 150, 150);
    }
    let [middle, end] =
        SIDES[usize::from(value > 0.0)].map(|[red, green, blue]| Colour::srgb(red, green, blue));
    let size = value.abs().min(1.0) as f32;
    let white = Colour::srgb(246, 244, 240);
    if size < 0.5 {
        white.mix(middle, 2.0 * size)
    } else {
        middle.mix(end, 2.0 * size - 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_go_there_and_back() {
        for byte in 0..=255 {
            let colour = Colour::srgb(byte, 255 - byte, 7);
            assert_eq!(colour.to_srgb(), [byte, 255 - byte, 7]);
        }
    }

    #[test]
    fn blue_is_against_and_red_along_and_both_darken_outwards() {
        let [blue, white, red] = [-1.0, 0.0, 1.0].map(|value| diverging(value).to_srgb());
        assert!(blue[2] > 2 * blue[0] && red[0] > 4 * red[2] && white.iter().all(|&it| it > 235));
        let lightness = |value: f64| diverging(value).0.dot(Vec3::new(0.2126, 0.7152, 0.0722));
        for side in [-1.0, 1.0] {
            for step in 0..10 {
                let (one, next) = (f64::from(step) * 0.1, f64::from(step + 1) * 0.1);
                assert!(lightness(side * next) < lightness(side * one));
            }
        }
        assert_eq!(diverging(7.0), diverging(1.0));
        assert_eq!(diverging(f64::NAN).to_srgb(), [150; 3]);
    }
}
