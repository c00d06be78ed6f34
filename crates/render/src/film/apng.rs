//! Films as animated PNG (<https://www.w3.org/TR/png-3/#apng-frame-based-animation>).

use std::fs::File;
use std::io::BufWriter;

use super::{Encoder, FilmPlan, Size};
use crate::error::RenderError;
use crate::picture::Picture;

/// An animated PNG that is being written.
pub(super) struct ApngEncoder(png::Writer<BufWriter<File>>);

impl ApngEncoder {
    pub(super) fn new(
        file: BufWriter<File>,
        plan: FilmPlan,
        (width, height): Size,
    ) -> Result<Self, RenderError> {
        let mut encoder = png::Encoder::new(file, width, height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        encoder.set_animated(plan.frames, 0)?;
        // A delay is a fraction of two whole numbers.
        encoder.set_frame_delay(100, (100.0 * plan.frames_per_second).round() as u16)?;
        Ok(Self(encoder.write_header()?))
    }
}

impl Encoder for ApngEncoder {
    fn add(&mut self, picture: &Picture) -> Result<(), RenderError> {
        Ok(self.0.write_image_data(picture.pixels())?)
    }

    fn finish(self: Box<Self>) -> Result<(), RenderError> {
        Ok(self.0.finish()?)
    }
}
