//! Pictures: grey ink coverage and bits.

use kurbo::Affine;
use thiserror::Error;

/// Why a picture could not be made.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum RasterError {
    /// The number of samples is not width × height.
    #[error("a picture of {width}×{height} px needs {} samples, not {samples}", width * height)]
    Size {
        /// px
        width: usize,
        /// px
        height: usize,
        /// samples given
        samples: usize,
    },
    /// A sample is NaN, infinite or far outside 0…1.
    #[error("sample {index} of the picture is {value}, not ink between 0 and 1")]
    Value {
        /// index of the sample, row-major
        index: usize,
        /// its value
        value: f32,
    },
}

/// Ink coverage: 0 is paper and 1 is ink. Rows from the top; the centre of pixel (0, 0) is at (½, ½).
///
/// A scanner's noise swings about both levels, so samples may pass 0 and 1 by up to [`Gray::OVERSHOOT`]:
/// cutting the noise off there would shift every level estimated from them.
///
/// A letter of a page that lies askew stays on the pixels that the scanner made, and the picture says how it stands
/// upright ([`Gray::upright`]): pixels between pixels would have to be made up.
#[derive(Debug, Clone, PartialEq)]
pub struct Gray {
    width: usize,
    height: usize,
    samples: Vec<f32>,
    scatter_px: f64,
    upright: Affine,
}

impl Gray {
    /// How far a sample may lie outside 0…1.
    pub const OVERSHOOT: f32 = 0.5;

    /// A picture of `width` × `height` px from row-major coverage.
    ///
    /// # Errors
    /// The number of samples is wrong, or one is not finite or outside 0…1 by more than
    /// [`Gray::OVERSHOOT`].
    pub fn new(width: usize, height: usize, samples: Vec<f32>) -> Result<Self, RasterError> {
        if width.checked_mul(height) != Some(samples.len()) {
            return Err(RasterError::Size {
                width,
                height,
                samples: samples.len(),
            });
        }
        let range = -Self::OVERSHOOT..=1.0 + Self::OVERSHOOT;
        if let Some((index, &value)) = samples
            .iter()
            .enumerate()
            .find(|(_, v)| !range.contains(*v))
        {
            return Err(RasterError::Value { index, value });
        }
        Ok(Self {
            width,
            height,
            samples,
            scatter_px: 0.0,
            upright: Affine::IDENTITY,
        })
    }

    /// Samples a function of the pixel's column and row, cut to the legal range; NaN becomes paper.
    #[must_use]
    pub fn from_fn(width: usize, height: usize, mut ink: impl FnMut(usize, usize) -> f32) -> Self {
        let mut samples = Vec::with_capacity(width * height);
        for y in 0..height {
            samples.extend((0..width).map(|x| Self::cut(ink(x, y))));
        }
        Self {
            width,
            height,
            samples,
            scatter_px: 0.0,
            upright: Affine::IDENTITY,
        }
    }

    /// The picture with other samples, row-major, cut to the legal range; NaN, and what is missing, becomes paper.
    #[must_use]
    pub fn with_samples(&self, mut samples: Vec<f32>) -> Self {
        samples.resize(self.samples.len(), 0.0);
        samples.iter_mut().for_each(|v| *v = Self::cut(*v));
        Self { samples, ..*self }
    }

    /// The same picture, of edges that are off by a standard deviation of `scatter_px`, which its samples do not
    /// show.
    #[must_use]
    pub const fn with_scatter(mut self, scatter_px: f64) -> Self {
        self.scatter_px = scatter_px;
        self
    }

    /// How far off its edges are beyond what its samples show, a standard deviation, px: 0 of a grey picture, not of
    /// one that had two levels.
    #[must_use]
    pub const fn scatter_px(&self) -> f64 {
        self.scatter_px
    }

    /// The same picture, whose drawing stands upright where `map` takes it: from px of the picture to px of the
    /// drawing, both y up, the origin at the picture's bottom left. A turn and a shift, and lengths that hardly differ.
    #[must_use]
    pub const fn with_upright(mut self, map: Affine) -> Self {
        self.upright = map;
        self
    }

    /// Where its drawing stands upright: from px of the picture to px of the drawing, both y up, the origin at the
    /// picture's bottom left.
    #[must_use]
    pub const fn upright(&self) -> Affine {
        self.upright
    }

    /// From px of the upright drawing to px of the picture: the map back.
    #[must_use]
    pub fn to_pixels(&self) -> Affine {
        self.upright.inverse()
    }

    fn cut(v: f32) -> f32 {
        let v = if v.is_nan() { 0.0 } else { v };
        v.clamp(-Self::OVERSHOOT, 1.0 + Self::OVERSHOOT)
    }

    /// A picture of `width` × `height` px from row-major coverage in 255ths.
    ///
    /// # Errors
    /// The number of samples is wrong.
    pub fn from_levels(width: usize, height: usize, levels: &[u8]) -> Result<Self, RasterError> {
        let samples = levels.iter().map(|&v| f32::from(v) / 255.0);
        Self::new(width, height, samples.collect())
    }

    /// All samples in 255ths, row-major: 0 is paper and 255 is ink.
    #[must_use]
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "0…255 by the clamp"
    )]
    pub fn levels(&self) -> Vec<u8> {
        let level = |v: &f32| (255.0 * v.clamp(0.0, 1.0)).round() as u8;
        self.samples.iter().map(level).collect()
    }

    /// Columns, px.
    #[must_use]
    pub const fn width(&self) -> usize {
        self.width
    }

    /// Rows, px.
    #[must_use]
    pub const fn height(&self) -> usize {
        self.height
    }

    /// All samples, row-major.
    #[must_use]
    pub fn samples(&self) -> &[f32] {
        &self.samples
    }

    /// All samples, row-major, for a new picture to take over.
    #[must_use]
    pub fn into_samples(self) -> Vec<f32> {
        self.samples
    }

    /// The coverage of the pixel in column `x` of row `y`; paper outside the picture.
    #[must_use]
    pub fn at(&self, x: usize, y: usize) -> f32 {
        if x < self.width && y < self.height {
            self.samples[y * self.width + x]
        } else {
            0.0
        }
    }

    /// One row of samples; empty outside the picture.
    #[must_use]
    pub fn row(&self, y: usize) -> &[f32] {
        self.samples
            .get(y * self.width..(y + 1) * self.width)
            .unwrap_or(&[])
    }
}

/// Ink (true) or paper, rows from the top.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Bitmap {
    width: usize,
    height: usize,
    bits: Vec<bool>,
}

impl Bitmap {
    /// The pixels whose coverage is at least `level`.
    #[must_use]
    pub fn threshold(gray: &Gray, level: f32) -> Self {
        let bits = gray.samples().iter().map(|&v| v >= level).collect();
        Self {
            width: gray.width(),
            height: gray.height(),
            bits,
        }
    }

    /// The picture with other bits, row-major; what is missing becomes paper.
    #[must_use]
    pub fn with_bits(&self, bits: impl IntoIterator<Item = bool>) -> Self {
        let mut bits: Vec<bool> = bits.into_iter().collect();
        bits.resize(self.bits.len(), false);
        Self { bits, ..*self }
    }

    /// Columns, px.
    #[must_use]
    pub const fn width(&self) -> usize {
        self.width
    }

    /// Rows, px.
    #[must_use]
    pub const fn height(&self) -> usize {
        self.height
    }

    /// All bits, row-major.
    #[must_use]
    pub fn bits(&self) -> &[bool] {
        &self.bits
    }

    /// Whether the pixel in column `x` of row `y` is ink; paper outside the picture.
    #[must_use]
    pub fn at(&self, x: usize, y: usize) -> bool {
        x < self.width && y < self.height && self.bits[y * self.width + x]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_keeps_its_shape_rule() {
        assert!(Gray::new(2, 2, vec![0.0; 4]).is_ok());
        assert!(matches!(
            Gray::new(2, 2, vec![0.0; 3]),
            Err(RasterError::Size { .. })
        ));
        assert!(matches!(
            Gray::new(usize::MAX, 2, vec![]),
            Err(RasterError::Size { .. })
        ));
        assert!(matches!(
            Gray::new(1, 1, vec![f32::NAN]),
            Err(RasterError::Value { .. })
        ));
        let ink = Bitmap::threshold(&Gray::from_fn(3, 1, |_, _| 0.0), 0.5).with_bits([true; 2]);
        assert_eq!(ink.bits(), [true, true, false]);
    }

    #[test]
    fn outside_is_paper() {
        let g = Gray::from_fn(2, 1, |x, _| x as f32);
        assert!(g.at(1, 0) > 0.5 && g.at(2, 0) < 0.5 && g.at(0, 1) < 0.5);
        let b = Bitmap::threshold(&g, 0.5);
        assert!(b.at(1, 0) && !b.at(0, 0) && !b.at(5, 5));
    }
}
