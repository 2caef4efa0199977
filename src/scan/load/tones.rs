//! How a picture's numbers tell light.

use rayon::prelude::*;
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

    /// Shares of light that are missing of white, 0 to 1, by the light in place of the picture's numbers.
    pub(super) fn straighten(self, ink: &mut [f32]) {
        if self == Self::Srgb {
            ink.par_iter_mut().for_each(|v| *v = 1.0 - light(1.0 - *v));
        }
    }
}

/// The light that a number of sRGB stands for, both 0 to 1.
fn light(number: f32) -> f32 {
    if number <= 0.040_45 {
        number / 12.92
    } else {
        ((number + 0.055) / 1.055).powf(2.4)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_srgb_are_light_as_the_standard_says() {
        for (number, wanted) in [
            (0.0, 0.0),
            (0.040_45, 0.003_130_8),
            (0.5, 0.214_04),
            (0.735_36, 0.5),
            (1.0, 1.0),
        ] {
            let mut ink = [1.0 - number];
            Tones::Linear.straighten(&mut ink);
            assert!((ink[0] + number - 1.0).abs() < 1e-7, "linear ones stay");
            Tones::Srgb.straighten(&mut ink);
            assert!(
                (1.0 - ink[0] - wanted).abs() < 1e-4,
                "{number}: {}",
                1.0 - ink[0]
            );
        }
    }
}
