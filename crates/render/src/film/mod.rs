//! Films: pictures one after the other, as GIF, animated PNG, or through ffmpeg as MP4 and WebM.

mod apng;
mod ffmpeg;
mod gif;

use std::fs::File;
use std::path::Path;

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
    /// Every format.
    pub const ALL: [Self; 4] = [Self::Gif, Self::Apng, Self::Mp4, Self::Webm];

    /// How names of its files end.
    #[must_use]
    pub fn extension(self) -> &'static str {
        match self {
            Self::Gif => "gif",
            Self::Apng => "apng",
            Self::Mp4 => "mp4",
            Self::Webm => "webm",
        }
    }

    /// The format that the name of a file asks for.
    #[must_use]
    pub fn of_path(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        Self::ALL
            .into_iter()
            .find(|format| format.extension() == extension)
    }

    /// Begins a film in a file, which is overwritten. All pictures must have one size.
    ///
    /// # Errors
    /// [`RenderError::NoFfmpeg`] where ffmpeg is needed and not there; [`RenderError::Speed`], [`RenderError::Frames`].
    pub fn create(self, path: &Path, plan: FilmPlan) -> Result<Box<dyn Film>, RenderError> {
        plan.check()?;
        let file = || File::create(path).map_err(RenderError::Film);
        Ok(match self {
            Self::Gif => Box::new(gif::GifFilm::new(file()?, plan)),
            Self::Apng => Box::new(apng::ApngFilm::new(file()?, plan)),
            Self::Mp4 | Self::Webm => Box::new(ffmpeg::FfmpegFilm::new(self, path, plan)),
        })
    }
}

/// What is known of a film before its first picture.
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
pub trait Film {
    /// Adds a picture.
    ///
    /// # Errors
    /// [`RenderError`] where it has another size than the first, or cannot be encoded or written.
    fn add(&mut self, picture: &Picture) -> Result<(), RenderError>;

    /// Ends the film; before, its file is no film.
    ///
    /// # Errors
    /// [`RenderError`] where it cannot be written.
    fn finish(self: Box<Self>) -> Result<(), RenderError>;
}

/// Passes the size of a picture on where it is that of the film.
fn of_one_size(first: Option<(u32, u32)>, picture: &Picture) -> Result<(u32, u32), RenderError> {
    let size = (picture.width(), picture.height());
    match first {
        Some(expected) if expected != size => Err(RenderError::OtherSize {
            expected,
            found: size,
        }),
        _ => Ok(size),
    }
}

#[cfg(test)]
mod tests;
