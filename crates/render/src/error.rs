//! Errors between spheres and a picture.

/// Errors of a picture.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// No pixels, or more than can be held.
    #[error("a picture of {width} x {height} pixels cannot be made: at most {most} pixels")]
    Size {
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
        /// Most pixels in all.
        most: u64,
    },
    /// The picture cannot be encoded.
    #[error("the picture cannot be encoded: {0}")]
    Encoding(#[from] png::EncodingError),
    /// A film without pictures.
    #[error("a film has one picture at least")]
    Frames,
    /// A film too slow or too fast.
    #[error("a film of {found} pictures a second is not possible; take {slowest} to {fastest}")]
    Speed {
        /// Pictures a second.
        found: f64,
        /// Fewest.
        slowest: f64,
        /// Most.
        fastest: f64,
    },
    /// Pictures of a film differ in size.
    #[error(
        "a picture of {} x {} pixels cannot follow one of {} x {} in a film",
        found.0, found.1, expected.0, expected.1
    )]
    OtherSize {
        /// Pixels across and down of the first picture.
        expected: (u32, u32),
        /// Pixels across and down of this one.
        found: (u32, u32),
    },
    /// A GIF cannot be encoded.
    #[error("the film cannot be encoded: {0}")]
    Gif(#[from] gif::EncodingError),
    /// A film cannot be written.
    #[error("the film cannot be written: {0}")]
    Film(#[source] std::io::Error),
    /// There is no ffmpeg.
    #[error("films in MP4 and WebM need ffmpeg, and `{program}` cannot be started: {source}")]
    NoFfmpeg {
        /// What was to be started.
        program: String,
        /// Why it was not.
        source: std::io::Error,
    },
    /// ffmpeg failed.
    #[error("ffmpeg could not make the film: {words}")]
    Ffmpeg {
        /// What it said.
        words: String,
    },
}
