//! Films as GIF.

use std::fs::File;
use std::io::BufWriter;

use color_quant::NeuQuant;

use super::{Film, FilmPlan, of_one_size};
use crate::error::RenderError;
use crate::picture::Picture;

/// Colours of a picture; one more stands for what stays as it was.
const COLOURS: usize = 255;
const UNCHANGED: u8 = 255;
/// Every so many pixels the search for a picture's colours looks at one.
const SAMPLED: i32 = 8;
/// Difference of red, green and blue in all up to which a pixel counts as what it was.
const TOLERANCE: i32 = 9;
/// Longest side of a GIF.
const LONGEST: u32 = u16::MAX as u32;
/// Bits of each channel that colours are told apart by while they are looked up.
const LOOKUP_BITS: u32 = 5;

/// A GIF that is being written.
pub(super) struct GifFilm {
    file: Option<File>,
    plan: FilmPlan,
    begun: Option<Begun>,
    frames: u32,
}

struct Begun {
    size: (u32, u32),
    encoder: gif::Encoder<BufWriter<File>>,
    /// What is on the screen, red, green and blue.
    screen: Vec<u8>,
}

impl GifFilm {
    pub(super) fn new(file: File, plan: FilmPlan) -> Self {
        Self {
            file: Some(file),
            plan,
            begun: None,
            frames: 0,
        }
    }

    /// Hundredths of a second that a frame stays, so that the film as a whole keeps its time.
    fn delay(&self) -> u16 {
        let at = |frame: u32| (100.0 * f64::from(frame) / self.plan.frames_per_second).round();
        (at(self.frames + 1) - at(self.frames)) as u16
    }
}

impl Film for GifFilm {
    fn add(&mut self, picture: &Picture) -> Result<(), RenderError> {
        let size = of_one_size(self.begun.as_ref().map(|begun| begun.size), picture)?;
        if let Some(file) = self.file.take() {
            if size.0.max(size.1) > LONGEST {
                return Err(RenderError::Size {
                    width: size.0,
                    height: size.1,
                    most: u64::from(LONGEST).pow(2),
                });
            }
            let out = BufWriter::new(file);
            let mut encoder = gif::Encoder::new(out, size.0 as u16, size.1 as u16, &[])?;
            encoder.set_repeat(gif::Repeat::Infinite)?;
            self.begun = Some(Begun {
                size,
                encoder,
                screen: Vec::new(),
            });
        }
        let delay = self.delay();
        let Some(begun) = &mut self.begun else {
            return Err(RenderError::Frames);
        };
        let mut frame = begun.frame(picture);
        frame.delay = delay;
        begun.encoder.write_frame(&frame)?;
        self.frames += 1;
        Ok(())
    }

    fn finish(self: Box<Self>) -> Result<(), RenderError> {
        let Some(begun) = self.begun else {
            return Err(RenderError::Frames);
        };
        // The trailer is written as the encoder gives its file back.
        let out = begun.encoder.into_inner()?;
        out.into_inner()
            .map_err(|error| RenderError::Film(error.into_error()))?;
        Ok(())
    }
}

impl Begun {
    /// The part of a picture that differs from what is on the screen, in colours of its own.
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
            let apart: i32 = apart
                .map(|(one, other)| (i32::from(*one) - i32::from(*other)).abs())
                .sum();
            if apart <= TOLERANCE && !is_first {
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

/// The colours of one picture.
struct Palette {
    /// Red, green and blue, with a last one that is not used.
    colours: Vec<u8>,
}

impl Palette {
    fn of(pixels: &[u8]) -> Self {
        let opaque: Vec<u8> = pixels
            .chunks_exact(3)
            .flat_map(|pixel| [pixel[0], pixel[1], pixel[2], 255])
            .collect();
        // Fewer pixels than it learns from would leave the search without any.
        let sampled = SAMPLED.min((opaque.len() / (4 * COLOURS)).max(1) as i32);
        let mut colours = NeuQuant::new(sampled, COLOURS, &opaque).color_map_rgb();
        // Paper, the commonest colour, as it is: the search finds it within rounding only.
        if let Some(corner) = pixels.first_chunk::<3>() {
            let place = nearest(&colours, corner);
            colours[3 * place..3 * place + 3].copy_from_slice(corner);
        }
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

fn nearest(colours: &[u8], pixel: &[u8]) -> usize {
    let apart = |colour: &[u8]| -> i32 {
        let channels = colour.iter().zip(pixel);
        channels
            .map(|(one, other)| (i32::from(*one) - i32::from(*other)).pow(2))
            .sum()
    };
    let found = colours
        .chunks_exact(3)
        .enumerate()
        .min_by_key(|(_, colour)| apart(colour));
    found.map_or(0, |(index, _)| index)
}
