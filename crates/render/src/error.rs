//! What can go wrong between spheres and a picture.

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
}
