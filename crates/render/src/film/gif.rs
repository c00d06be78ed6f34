//! Films as GIF.

use std::fs::File;
use std::io::BufWriter;

use color_quant::NeuQuant;

use super::{Encoder, FilmPlan, Size};
use crate::error::RenderError;
use crate::picture::Picture;

/// Colours of a picture; one more stands for what stays as it was.
const COLOURS: usize = 255;
const UNCHANGED: u8 = 255;
/// Colours of few pixels among them, and every how many pixels these are looked for.
const OUTLIERS: usize = 32;
const OUTLIERS_SAMPLED: usize = 7;
/// Every so many pixels the search for a picture's colours looks at one.
const SAMPLED: i32 = 8;
/// Largest difference, over red, green and blue together, at which a pixel counts as unchanged.
const TOLERANCE: i32 = 14;
/// Bits of each channel that colours are told apart by while they are looked up.
const LOOKUP_BITS: u32 = 5;

/// A GIF that is being written.
pub(super) struct GifEncoder {
    plan: FilmPlan,
    encoder: gif::Encoder<BufWriter<File>>,
    /// What is on the screen, red, green and blue.
    screen: Vec<u8>,
    frames: u32,
}

impl GifEncoder {
    pub(super) fn new(
        file: BufWriter<File>,
        plan: FilmPlan,
        (width, height): Size,
    ) -> Result<Self, RenderError> {
        let [Ok(across), Ok(down)] = [width, height].map(u16::try_from) else {
            return Err(RenderError::Size {
                width,
                height,
                most: u64::from(u16::MAX).pow(2),
            });
        };
        let mut encoder = gif::Encoder::new(file, across, down, &[])?;
        encoder.set_repeat(gif::Repeat::Infinite)?;
        Ok(Self {
            plan,
            encoder,
            screen: Vec::new(),
            frames: 0,
        })
    }

    /// Hundredths of a second that a frame stays, so that the film as a whole keeps its time.
    fn delay(&self) -> u16 {
        let at = |frame: u32| (100.0 * f64::from(frame) / self.plan.frames_per_second).round();
        (at(self.frames + 1) - at(self.frames)) as u16
    }

    /// The part of a picture that differs from the frame before, with its own palette.
    fn frame(&mut self, picture: &Picture) -> gif::Frame<'static> {
        let width = picture.width() as usize;
        let pixels = picture.pixels();
        let palette = Palette::of(pixels);
        let is_first = self.screen.is_empty();
        if is_first {
            self.screen = vec![0; pixels.len()];
        }
        let mut indices = vec![UNCHANGED; pixels.len() / 3];
        let (mut low, mut high) = ((usize::MAX, usize::MAX), (0, 0));
        let mut lookup = vec![UNCHANGED; 1 << (3 * LOOKUP_BITS)];
        let places = pixels.chunks_exact(3).zip(self.screen.chunks_exact_mut(3));
        for (place, (pixel, screen)) in places.enumerate() {
            let apart = pixel.iter().zip(&*screen);
            let apart = apart.map(|(one, other)| i32::from(one.abs_diff(*other)));
            if apart.sum::<i32>() <= TOLERANCE && !is_first {
                continue;
            }
            let index = palette.nearest(pixel, &mut lookup);
            screen.copy_from_slice(palette.colour(index));
            indices[place] = index;
            let (x, y) = (place % width, place / width);
            low = (low.0.min(x), low.1.min(y));
            high = (high.0.max(x), high.1.max(y));
        }
        if low.0 > high.0 {
            // Nothing has changed: a frame has one pixel at least.
            low = (0, 0);
        }
        let across = high.0 + 1 - low.0;
        let part = (low.1..=high.1)
            .flat_map(|row| &indices[row * width + low.0..row * width + low.0 + across]);
        gif::Frame {
            left: low.0 as u16,
            top: low.1 as u16,
            width: across as u16,
            height: (high.1 + 1 - low.1) as u16,
            transparent: (!is_first).then_some(UNCHANGED),
            dispose: gif::DisposalMethod::Keep,
            buffer: part.copied().collect::<Vec<u8>>().into(),
            palette: Some(palette.colours),
            ..gif::Frame::default()
        }
    }
}

impl Encoder for GifEncoder {
    fn add(&mut self, picture: &Picture) -> Result<(), RenderError> {
        let mut frame = self.frame(picture);
        frame.delay = self.delay();
        self.encoder.write_frame(&frame)?;
        self.frames += 1;
        Ok(())
    }

    fn finish(self: Box<Self>) -> Result<(), RenderError> {
        // The trailer is written as the encoder gives its file back.
        let out = self.encoder.into_inner()?;
        let file = out.into_inner().map_err(|error| error.into_error());
        file.map(drop).map_err(RenderError::Film)
    }
}

/// The colours of one picture.
struct Palette {
    /// Red, green and blue, with a last one that is not used.
    colours: Vec<u8>,
}

impl Palette {
    fn of(pixels: &[u8]) -> Self {
        let opaque = pixels.chunks_exact(3);
        let opaque = opaque.flat_map(|pixel| [pixel[0], pixel[1], pixel[2], 255]);
        let opaque: Vec<u8> = opaque.collect();
        // Fewer pixels than it learns from would leave the search without any.
        let sampled = SAMPLED.min((opaque.len() / (4 * COLOURS)).max(1) as i32);
        let mut colours = NeuQuant::new(sampled, COLOURS - OUTLIERS, &opaque).color_map_rgb();
        // Paper, the commonest colour, as it is: the search finds it within rounding only.
        if let Some(corner) = pixels.first_chunk::<3>() {
            let place = nearest(&colours, corner);
            colours[3 * place..3 * place + 3].copy_from_slice(corner);
        }
        add_outliers(&mut colours, pixels);
        colours.resize(3 * (COLOURS + 1), 0);
        Self { colours }
    }

    fn colour(&self, index: u8) -> &[u8] {
        &self.colours[3 * usize::from(index)..3 * usize::from(index) + 3]
    }

    /// The colour nearest to a pixel; `known` keeps what was found for pixels like it.
    fn nearest(&self, pixel: &[u8], known: &mut [u8]) -> u8 {
        let part = |channel: usize| usize::from(pixel[channel]) >> (8 - LOOKUP_BITS);
        let place = (part(0) << (2 * LOOKUP_BITS)) | (part(1) << LOOKUP_BITS) | part(2);
        // White paper and what is nearly white must stay apart.
        let is_bright = pixel.iter().all(|&channel| channel > 247);
        if known[place] != UNCHANGED && !is_bright {
            return known[place];
        }
        let found = nearest(&self.colours[..3 * COLOURS], pixel) as u8;
        known[place] = found;
        found
    }
}

/// Adds the colours that the palette is furthest from: few pixels have them, such as those of a bar of colours, and the
/// search by frequency does not find them.
fn add_outliers(colours: &mut Vec<u8>, pixels: &[u8]) {
    let sampled = pixels.chunks_exact(3).step_by(OUTLIERS_SAMPLED);
    let away = |pixel| apart(pixel, &colours[3 * nearest(colours, pixel)..]);
    let mut left: Vec<(&[u8], i32)> = sampled.map(|pixel| (pixel, away(pixel))).collect();
    for _ in 0..OUTLIERS {
        let furthest = left.iter().max_by_key(|(_, away)| *away);
        let Some(found) = furthest.map(|(pixel, _)| pixel.to_vec()) else {
            return;
        };
        for (pixel, away) in &mut left {
            *away = (*away).min(apart(pixel, &found));
        }
        colours.extend(found);
    }
}

/// Square of the distance of two colours, by their first three channels.
fn apart(one: &[u8], other: &[u8]) -> i32 {
    let channels = one.iter().zip(other).take(3);
    let apart = channels.map(|(one, other)| i32::from(one.abs_diff(*other)));
    apart.map(|apart| apart.pow(2)).sum()
}

fn nearest(colours: &[u8], pixel: &[u8]) -> usize {
    let colours = colours.chunks_exact(3).enumerate();
    let found = colours.min_by_key(|(_, colour)| apart(colour, pixel));
    found.map_or(0, |(index, _)| index)
}
