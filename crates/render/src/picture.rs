//! A finished picture.

/// Pixels, row by row from the top, three bytes of sRGB each.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    width: u32,
    height: u32,
    pixels: Vec<u8>,
}

impl Picture {
    /// A picture of these bytes.
    ///
    /// # Panics
    /// Where their number is not three a pixel.
    pub fn new(width: u32, height: u32, pixels: Vec<u8>) -> Self {
        assert!(
            pixels.len() as u64 == 3 * u64::from(width) * u64::from(height),
            "a picture has three bytes a pixel"
        );
        Self {
            width,
            height,
            pixels,
        }
    }

    /// Pixels across.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Pixels down.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// All bytes, row by row from the top.
    pub fn pixels(&self) -> &[u8] {
        &self.pixels
    }

    /// The sRGB bytes of a pixel; columns from the left, rows from the top.
    ///
    /// # Panics
    /// Where there is no such pixel.
    pub fn pixel(&self, column: u32, row: u32) -> [u8; 3] {
        assert!(
            column < self.width && row < self.height,
            "the pixel is within the picture"
        );
        let first = 3 * (row as usize * self.width as usize + column as usize);
        [0, 1, 2].map(|channel| self.pixels[first + channel])
    }
}
