//! Pictures for people to look at, small enough to be kept by the thousand.

use super::Gray;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder, ImageFormat};
use serde::{Deserialize, Serialize};

/// A picture in 256 levels as a PNG file: dark ink on white.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Png {
    /// Columns, px.
    pub width: usize,
    /// Rows, px.
    pub height: usize,
    /// The file.
    pub bytes: Vec<u8>,
}

impl Png {
    /// The picture of `gray`; a file without content where it has no pixels, or more in a row than the format counts.
    #[must_use]
    pub fn of(gray: &Gray) -> Self {
        let (width, height) = (gray.width(), gray.height());
        let mut bytes = Vec::new();
        if let (Ok(w), Ok(h)) = (u32::try_from(width), u32::try_from(height)) {
            let paper: Vec<u8> = gray.levels().iter().map(|ink| 255 - ink).collect();
            let png = &mut bytes;
            let encoder = PngEncoder::new_with_quality(png, CompressionType::Fast, FilterType::Sub);
            if encoder
                .write_image(&paper, w, h, ExtendedColorType::L8)
                .is_err()
            {
                bytes.clear();
            }
        }
        Self {
            width,
            height,
            bytes,
        }
    }

    /// Ink in 255ths; paper alone where the file is none of that size.
    #[must_use]
    pub fn gray(&self) -> Gray {
        self.decoded()
            .unwrap_or_else(|| Gray::from_fn(self.width, self.height, |_, _| 0.0))
    }

    fn decoded(&self) -> Option<Gray> {
        let picture = image::load_from_memory_with_format(&self.bytes, ImageFormat::Png).ok()?;
        let ink: Vec<u8> = picture.into_luma8().iter().map(|v| 255 - v).collect();
        Gray::from_levels(self.width, self.height, &ink).ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_come_back_as_they_were() {
        let gray = Gray::from_fn(37, 11, |x, y| (x * 7 + y * 31) as f32 % 256.0 / 255.0);
        let png = Png::of(&gray);
        assert_eq!(png.gray().levels(), gray.levels());
        assert_eq!((png.width, png.height), (37, 11));
    }

    #[test]
    fn no_picture_is_paper() {
        let empty = Png::of(&Gray::from_fn(0, 0, |_, _| 1.0));
        assert_eq!(empty.gray().samples().len(), 0);
        let spoilt = Png {
            width: 2,
            height: 3,
            bytes: vec![1, 2, 3],
        };
        assert_eq!(spoilt.gray().levels(), [0; 6]);
    }
}
