//! Films as animated PNG (<https://www.w3.org/TR/png-3/#apng-frame-based-animation>).

use std::fs::File;
use std::io::BufWriter;

use super::{Film, FilmPlan, of_one_size};
use crate::error::RenderError;
use crate::picture::Picture;

/// An animated PNG that is being written.
pub(super) struct ApngFilm {
    /// Until the first picture tells the size.
    file: Option<File>,
    plan: FilmPlan,
    begun: Option<((u32, u32), png::Writer<BufWriter<File>>)>,
}

impl ApngFilm {
    pub(super) fn new(file: File, plan: FilmPlan) -> Self {
        Self {
            file: Some(file),
            plan,
            begun: None,
        }
    }

    fn begin(
        &self,
        file: File,
        (width, height): (u32, u32),
    ) -> Result<png::Writer<BufWriter<File>>, RenderError> {
        let mut encoder = png::Encoder::new(BufWriter::new(file), width, height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        encoder.set_animated(self.plan.frames, 0)?;
        // A delay is a fraction of two whole numbers.
        let per_second = self.plan.frames_per_second;
        encoder.set_frame_delay(100, (100.0 * per_second).round() as u16)?;
        Ok(encoder.write_header()?)
    }
}

impl Film for ApngFilm {
    fn add(&mut self, picture: &Picture) -> Result<(), RenderError> {
        let size = of_one_size(self.begun.as_ref().map(|(size, _)| *size), picture)?;
        if let Some(file) = self.file.take() {
            self.begun = Some((size, self.begin(file, size)?));
        }
        match &mut self.begun {
            Some((_, writer)) => Ok(writer.write_image_data(picture.pixels())?),
            None => Err(RenderError::Frames),
        }
    }

    fn finish(self: Box<Self>) -> Result<(), RenderError> {
        match self.begun {
            Some((_, writer)) => Ok(writer.finish()?),
            None => Err(RenderError::Frames),
        }
    }
}
