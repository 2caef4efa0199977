//! How a picture's numbers tell light.

use serde::{Deserialize, Serialize};

/// How a picture's numbers tell how much light came from a place.
///
/// Where an edge runs through a pixel, lens and sensor add up the light of both its sides. Edges lie where half of the light is
/// there, so that numbers which are no measure of it put them elsewhere: sRGB's half is a fifth of the light.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Tones {
    /// In proportion to the light.
    #[default]
    Linear,
    /// As IEC 61966-2-1 has it: what cameras write, and scanners unless they are told otherwise.
    Srgb,
}

impl Tones {
    /// How they are named on the command line and in project files.
    pub const ALL: [(&str, Self); 2] = [("linear", Self::Linear), ("srgb", Self::Srgb)];

    /// The light that a number stands for, both 0 to 1.
    pub(super) fn light(self, number: f32) -> f32 {
        match self {
            Self::Linear => number,
            Self::Srgb if number <= 0.040_45 => number / 12.92,
            Self::Srgb => ((number + 0.055) / 1.055).powf(2.4),
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
            assert!((Tones::Linear.light(number) - number).abs() < 1e-9);
            let light = Tones::Srgb.light(number);
            assert!((light - wanted).abs() < 1e-4, "{number}: {light}");
        }
    }
}
