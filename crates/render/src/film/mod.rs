//! Films: pictures one after the other, as GIF, animated PNG, or through ffmpeg as MP4 and WebM.

mod apng;
mod ffmpeg;
mod gif;

use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use crate::error::RenderError;
use crate::picture::Picture;

/// A format of films.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilmFormat {
    /// GIF: 255 colours a picture; plays everywhere.
    Gif,
    /// Animated PNG: every colour, larger; plays in browsers.
    Apng,
    /// H.264 in MP4; needs ffmpeg.
    Mp4,
    /// VP9 in WebM; needs ffmpeg.
    Webm,
}

impl FilmFormat {
    /// How names of its files end.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Gif => "gif",
            Self::Apng => "apng",
            Self::Mp4 => "mp4",
            Self::Webm => "webm",
        }
    }

    /// Whether films of this kind can be made here.
    ///
    /// # Errors
    /// [`RenderError::NoFfmpeg`] where ffmpeg is needed and not there.
    pub fn available(self) -> Result<(), RenderError> {
        match self {
            Self::Gif | Self::Apng => Ok(()),
            Self::Mp4 | Self::Webm => ffmpeg::available(),
        }
    }

    /// A film in a file, which is overwritten with the first picture. All pictures must have one size.
    ///
    /// # Errors
    /// [`RenderError::Speed`], [`RenderError::Frames`] where the plan is not possible.
    pub fn create(self, path: &Path, plan: FilmPlan) -> Result<Film, RenderError> {
        plan.check()?;
        Ok(Film {
            format: self,
            path: path.to_owned(),
            plan,
            begun: None,
        })
    }
}

/// Properties of a film that are fixed before its first picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmPlan {
    /// Pictures in all.
    pub frames: u32,
    /// Pictures a second.
    pub frames_per_second: f64,
    /// The colour beside the pictures where a format must pad them.
    pub paper: [u8; 3],
}

impl FilmPlan {
    /// Fastest film: faster ones are not shown as such.
    const FASTEST: f64 = 120.0;
    /// Slowest film.
    const SLOWEST: f64 = 0.1;

    fn check(&self) -> Result<(), RenderError> {
        if self.frames == 0 {
            return Err(RenderError::Frames);
        }
        if !(Self::SLOWEST..=Self::FASTEST).contains(&self.frames_per_second) {
            return Err(RenderError::Speed {
                found: self.frames_per_second,
                slowest: Self::SLOWEST,
                fastest: Self::FASTEST,
            });
        }
        Ok(())
    }
}

/// A film that is being made.
pub struct Film {
    format: FilmFormat,
    path: PathBuf,
    plan: FilmPlan,
    /// Pixels across and down, and what writes them, once the first picture tells its size.
    begun: Option<(Size, Box<dyn Encoder>)>,
}

/// Pixels across and down.
type Size = (u32, u32);

/// A writer of the pictures of a film, all of one size.
trait Encoder {
    fn add(&mut self, picture: &Picture) -> Result<(), RenderError>;

    fn finish(self: Box<Self>) -> Result<(), RenderError>;
}

impl Film {
    /// Adds a picture.
    ///
    /// # Errors
    /// [`RenderError`] where it has another size than the first, cannot be encoded or written, or where ffmpeg is needed
    /// and not there.
    pub fn add(&mut self, picture: &Picture) -> Result<(), RenderError> {
        let size = (picture.width(), picture.height());
        let (expected, encoder) = match &mut self.begun {
            Some(begun) => begun,
            begun => {
                let (path, plan) = (&*self.path, self.plan);
                let file = || {
                    File::create(path)
                        .map(BufWriter::new)
                        .map_err(RenderError::Film)
                };
                let encoder: Box<dyn Encoder> = match self.format {
                    FilmFormat::Gif => Box::new(gif::GifEncoder::new(file()?, plan, size)?),
                    FilmFormat::Apng => Box::new(apng::ApngEncoder::new(file()?, plan, size)?),
                    FilmFormat::Mp4 | FilmFormat::Webm => {
                        Box::new(ffmpeg::Ffmpeg::new(self.format, path, plan, size)?)
                    }
                };
                begun.insert((size, encoder))
            }
        };
        if *expected != size {
            let (expected, found) = (*expected, size);
            return Err(RenderError::OtherSize { expected, found });
        }
        encoder.add(picture)
    }

    /// Ends the film; before, its file is no film.
    ///
    /// # Errors
    /// [`RenderError`] where it has no picture or cannot be written.
    pub fn finish(self) -> Result<(), RenderError> {
        let (_, encoder) = self.begun.ok_or(RenderError::Frames)?;
        encoder.finish()
    }
}

#[cfg(test)]
mod tests;
