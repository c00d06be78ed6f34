//! How things are drawn, in pictures and on the viewer's page alike.

use peristalsis_figures::{ColourScale, Palette};

/// Colour of the wall in sRGB.
pub const STONE: [u8; 3] = [207, 202, 193];
/// Part of their size at which grains are drawn among the forces between them.
pub const SHRUNK: f64 = 0.32;
/// Radius of the rod that stands for the weakest force, and what the strongest adds to it \[d\].
pub const ROD: [f64; 2] = [0.02, 0.11];
/// Part of the contacts whose force lies within the colours.
pub const FORCES_COVERED: f64 = 0.97;
/// Part of the grains whose speed or pressure lies within the colours.
pub const GRAINS_COVERED: f64 = 0.98;
/// Contacts that most grains have fewer than, where the colours end.
pub const MOST_CONTACTS: f64 = 12.0;

/// The palettes of pictures by name: colours in equal steps, in sRGB.
pub fn palettes() -> [(&'static str, Vec<[u8; 3]>); 4] {
    let colours = |palette, number: u32| {
        let scale = ColourScale::new("", 0.0, f64::from(number - 1)).palette(palette);
        (0..number).map(|k| scale.srgb(k.into())).collect()
    };
    [
        ("DIVERGING", colours(Palette::Diverging, 9)),
        ("SEQUENTIAL", colours(Palette::Sequential, 11)),
        ("CYCLIC", colours(Palette::Cyclic, 9)),
        ("FORCE", colours(Palette::Force, 5)),
    ]
}
