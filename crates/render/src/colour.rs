//! Colours in linear light.

use std::sync::LazyLock;

use glam::Vec3;

/// A colour in linear light, red, green and blue in \[0, 1\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Colour(pub(crate) Vec3);

impl Colour {
    /// A colour by its sRGB bytes.
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
    pub fn to_srgb(self) -> [u8; 3] {
        // A NaN becomes 0 by the conversion to a whole number.
        let place = |value: f32| (value.clamp(0.0, 1.0) * (STEPS - 1) as f32 + 0.5) as usize;
        self.0.to_array().map(|value| ENCODED[place(value)])
    }
}

/// Steps of linear light that are told apart: more than bytes of sRGB where these are densest.
const STEPS: usize = 1 << 14;

/// The byte of each step.
static ENCODED: LazyLock<Vec<u8>> = LazyLock::new(|| {
    let byte = |step: usize| {
        let value = step as f32 / (STEPS - 1) as f32;
        let encoded = if value <= 0.003_130_8 {
            12.92 * value
        } else {
            1.055 * libm::powf(value, 1.0 / 2.4) - 0.055
        };
        libm::roundf(255.0 * encoded) as u8
    };
    (0..STEPS).map(byte).collect()
});

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
}
