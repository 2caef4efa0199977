//! How a picture's numbers tell light.

use super::{ColourDetail, LUMA};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// How a picture's numbers tell how much light came from a place.
///
/// Where an edge runs through a pixel, lens and sensor add up the light of both its sides. Edges lie where half of
/// the light is there, so that numbers which are no measure of it put them elsewhere: sRGB's half is a fifth of the
/// light.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Tones {
    /// In proportion to the light.
    #[default]
    Linear,
    /// As IEC 61966-2-1 has it: what cameras write, and scanners unless they are told otherwise.
    Srgb,
    /// As the file itself says: by its ICC profile, by `cICP`, `sRGB` or `gAMA` of a PNG, by the colour space of Exif
    /// where that is sRGB, or by the colour space of a scan in a PDF.
    Profile,
}

impl Tones {
    /// How they are named on the command line and in project files.
    pub const ALL: [(&str, Self); 3] = [
        ("linear", Self::Linear),
        ("srgb", Self::Srgb),
        ("profile", Self::Profile),
    ];

    /// The light that numbers stand for, where that is known without the file.
    pub(super) fn light(self) -> Option<Light> {
        match self {
            Self::Linear => Some(Light::alike(table(|number| number))),
            Self::Srgb => Some(Light::alike(table(srgb))),
            Self::Profile => None,
        }
    }
}

/// The light of a number of sRGB, both 0 to 1.
pub(super) fn srgb(number: f32) -> f32 {
    if number <= 0.040_45 {
        number / 12.92
    } else {
        libm::powf((number + 0.055) / 1.055, 2.4)
    }
}

/// A channel's sample.
pub(super) trait Sample: Copy + Sync {
    /// As one of 16 bit.
    fn level(self) -> u16;

    /// 0 to 1.
    fn unit(self) -> f32 {
        f32::from(self.level()) / f32::from(u16::MAX)
    }
}

impl Sample for u8 {
    fn level(self) -> u16 {
        u16::from(self) * 257
    }
}

impl Sample for u16 {
    fn level(self) -> u16 {
        self
    }
}

/// The light of each number of 16 bit.
pub(super) type Table = Arc<[f32]>;

/// The light of every number, from a curve whose numbers are 0 to 1.
pub(super) fn table(curve: impl Fn(f32) -> f32) -> Table {
    (0..=u16::MAX).map(|level| curve(level.unit())).collect()
}

/// The light that a picture's numbers stand for, 0 to 1.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Light {
    /// of a picture without colours
    grey: Table,
    /// of red, green and blue
    colours: [Table; 3],
    /// what each of them adds to luminance, of 1
    weights: [f32; 3],
}

impl Light {
    /// One curve for all channels; their light adds up to luma.
    pub(super) fn alike(table: Table) -> Self {
        Self {
            grey: table.clone(),
            colours: [table.clone(), table.clone(), table],
            weights: LUMA,
        }
    }

    /// A curve for each of red, green and blue. Grey is as much of each.
    pub(super) fn apart(colours: [Table; 3], weights: [f32; 3]) -> Self {
        let [red, green, blue] = &colours;
        let channels = red.iter().zip(green.iter()).zip(blue.iter());
        let grey = channels.map(|((r, g), b)| weights[0] * r + weights[1] * g + weights[2] * b);
        Self {
            grey: grey.collect(),
            colours,
            weights,
        }
    }

    /// Of a picture without colours.
    pub(super) fn grey(&self, sample: impl Sample) -> f32 {
        self.grey[usize::from(sample.level())]
    }

    /// What counts of red, green and blue: luminance, or the darkest of them.
    pub(super) fn colour<S: Sample>(&self, pixel: &[S], detail: ColourDetail) -> f32 {
        let tables = pixel.iter().zip(&self.colours);
        let light = tables.map(|(s, table)| table[usize::from(s.level())]);
        match detail {
            ColourDetail::Blocks => light.zip(self.weights).map(|(v, w)| v * w).sum(),
            ColourDetail::Pixels => light.fold(1.0, f32::min),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_srgb_are_light_as_the_standard_says() {
        let points = [
            (0.0, 0.0),
            (0.040_45, 0.003_130_8),
            (0.5, 0.214_04),
            (0.735_36, 0.5),
            (1.0, 1.0),
        ];
        for (number, wanted) in points {
            let light = srgb(number);
            assert!((light - wanted).abs() < 1e-4, "{number}: {light}");
        }
    }

    #[test]
    fn numbers_that_are_light_are_read_to_the_bit() {
        let light = Light::alike(table(|v| v));
        for v in 0..=u8::MAX {
            assert_eq!(light.grey(v).to_bits(), (f32::from(v) / 255.0).to_bits());
        }
        for v in 0..=u16::MAX {
            assert_eq!(light.grey(v).to_bits(), (f32::from(v) / 65535.0).to_bits());
        }
    }
}
