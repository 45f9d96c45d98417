//! Pixels, and the PNG file that holds them.

use std::io;

/// Why pixels do not form an [`Image`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ImageError {
    /// A side has no pixels, or too many.
    #[error("the image is {width} × {height} pixels: expected 1 to {} each way", Image::MAX_SIDE)]
    Size {
        /// Pixels across.
        width: usize,
        /// Pixels down.
        height: usize,
    },
    /// The number of bytes does not match the size.
    #[error("the image has {found} bytes: expected {expected}, three per pixel")]
    Bytes {
        /// The bytes given.
        found: usize,
        /// The bytes that the size requires.
        expected: usize,
    },
}

/// An RGB image in sRGB, eight bits per channel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    size: [usize; 2],
    rgb: Vec<u8>,
}

impl Image {
    /// The most pixels of a side.
    pub const MAX_SIDE: usize = 16_384;

    /// An image from its pixels, row by row from the top left.
    ///
    /// # Errors
    /// [`ImageError`] if a side is empty or longer than [`Image::MAX_SIDE`], or `rgb` does not have three bytes per
    /// pixel.
    pub fn new(size: [usize; 2], rgb: Vec<u8>) -> Result<Self, ImageError> {
        let [width, height] = size;
        if !size.iter().all(|side| (1..=Self::MAX_SIDE).contains(side)) {
            return Err(ImageError::Size { width, height });
        }
        let expected = 3 * width * height;
        if rgb.len() != expected {
            let found = rgb.len();
            return Err(ImageError::Bytes { found, expected });
        }
        Ok(Self { size, rgb })
    }

    /// Every pixel black; `size` is clamped to what an image can have.
    pub(crate) fn black(size: [usize; 2]) -> Self {
        let size = size.map(|side| side.clamp(1, Self::MAX_SIDE));
        let rgb = vec![0; 3 * size[0] * size[1]];
        Self { size, rgb }
    }

    /// Pixels across and down.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Red, green and blue of all pixels, row by row from the top left.
    #[must_use]
    pub fn rgb(&self) -> &[u8] {
        &self.rgb
    }

    pub(crate) fn rgb_mut(&mut self) -> &mut [u8] {
        &mut self.rgb
    }

    /// The colour of the pixel in a column (from the left) and a row (from the top), both from 0; `None` outside the
    /// image.
    #[must_use]
    pub fn pixel(&self, column: usize, row: usize) -> Option<[u8; 3]> {
        let [width, height] = self.size;
        if column >= width || row >= height {
            return None;
        }
        self.rgb.as_chunks::<3>().0.get(row * width + column).copied()
    }

    /// Writes the image as a PNG file.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write_png(&self, writer: impl io::Write) -> io::Result<()> {
        let [width, height] = self.size.map(|side| side as u32);
        let mut encoder = png::Encoder::new(writer, width, height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        encoder.set_compression(png::Compression::Fast);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&self.rgb)?;
        Ok(writer.finish()?)
    }

    /// The bytes of the image as a PNG file.
    ///
    /// # Errors
    /// Those of the encoder.
    pub fn png(&self) -> io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        self.write_png(&mut bytes)?;
        Ok(bytes)
    }
}
