//! Which ink the letters are drawn with, where a page has several.

use super::components::Component;
use crate::types::Colours;
use serde::{Deserialize, Serialize};

/// Ink is neutral when the light that it swallows differs among the colours by less than this share: printers'
/// blacks come to 0.05, a blue ballpoint to 0.15 where its strokes cross and 0.5 elsewhere.
const NEUTRAL: f64 = 0.1;
/// Cosine of the angle, on the circle of hues, within which two inks are alike: 60°.
const ALIKE: f64 = 0.5;

/// The ink of the letters.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Ink {
    /// Every ink.
    #[default]
    Any,
    /// Black or grey.
    Black,
    /// Ink of about this hue: red, green and blue as they look.
    Hue([u8; 3]),
}

/// A dark piece belongs to a piece of coloured ink within so many widths of its stroke.
const NEAR: f64 = 1.5;

/// Names of hues.
const NAMED: [(&str, [u8; 3]); 6] = [
    ("red", [200, 30, 30]),
    ("orange", [230, 130, 20]),
    ("green", [30, 140, 50]),
    ("blue", [30, 60, 180]),
    ("violet", [120, 40, 160]),
    ("brown", [120, 70, 30]),
];

impl TryFrom<String> for Ink {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        let named = NAMED.iter().find(|(name, _)| *name == text);
        match (text.as_str(), named) {
            ("any", _) => Ok(Self::Any),
            ("black", _) => Ok(Self::Black),
            (_, Some((_, hue))) => Ok(Self::Hue(*hue)),
            _ => hex(&text).map(Self::Hue).ok_or_else(|| {
                let names: Vec<&str> = NAMED.iter().map(|n| n.0).collect();
                format!("ink must be any, black, {} or #rrggbb", names.join(", "))
            }),
        }
    }
}

fn hex(text: &str) -> Option<[u8; 3]> {
    let digits = text
        .strip_prefix('#')
        .filter(|d| d.len() == 6 && d.is_ascii())?;
    let channel = |i: usize| u8::from_str_radix(digits.get(i..i + 2)?, 16).ok();
    Some([channel(0)?, channel(2)?, channel(4)?])
}

impl From<Ink> for String {
    fn from(ink: Ink) -> Self {
        match ink {
            Ink::Any => "any".to_owned(),
            Ink::Black => "black".to_owned(),
            Ink::Hue([r, g, b]) => format!("#{r:02x}{g:02x}{b:02x}"),
        }
    }
}

impl Ink {
    /// Whether ink that swallows these shares of red, green and blue is of this kind.
    fn is_like(self, swallowed: [f64; 3]) -> bool {
        let most = swallowed.iter().copied().fold(0.0, f64::max);
        let least = swallowed.iter().copied().fold(most, f64::min);
        let neutral = most - least < NEUTRAL * most;
        match self {
            Self::Any => true,
            Self::Black => neutral,
            Self::Hue(look) => {
                let wanted = hue(look.map(|v| 255.0 - f64::from(v)));
                let seen = hue(swallowed);
                let cosine = wanted.0 * seen.0 + wanted.1 * seen.1;
                let lengths = wanted.0.hypot(wanted.1) * seen.0.hypot(seen.1);
                !neutral && cosine > ALIKE * lengths
            }
        }
    }

    /// Parts pieces of this ink from those of others; all are of it on a page without colours.
    pub(super) fn part(
        self,
        all: Vec<Component>,
        colours: Option<&Colours>,
    ) -> (Vec<Component>, Vec<Component>) {
        let Some(colours) = colours.filter(|_| self != Self::Any) else {
            return (all, Vec::new());
        };
        let paper = paper(colours);
        let colour = |c: &Component| swallowed(c, colours, paper);
        let (mut own, other): (Vec<_>, Vec<_>) =
            all.into_iter().partition(|c| self.is_like(colour(c)));
        // where a pen lingers its ink is nearly black
        let (dark, other): (Vec<_>, Vec<_>) = other
            .into_iter()
            .partition(|c| Self::Black.is_like(colour(c)) && own.iter().any(|o| lingers(c, o)));
        own.extend(dark);
        (own, other)
    }
}

/// Whether a dark piece is a part of the letter that another piece begins: far smaller, and hardly farther from it
/// than its stroke is wide.
fn lingers(dark: &Component, pen: &Component) -> bool {
    let (a, b) = (dark.bounds, pen.bounds);
    let dx = (a.x0 - b.x1).max(b.x0 - a.x1).max(0.0);
    let dy = (a.y0 - b.y1).max(b.y0 - a.y1).max(0.0);
    2 * dark.area < pen.area && dx.hypot(dy) < NEAR * pen.stroke()
}

/// A place on the plane of hues.
fn hue([r, g, b]: [f64; 3]) -> (f64, f64) {
    (r - (g + b) / 2.0, (g - b) * 3f64.sqrt() / 2.0)
}

/// What the paper swallows itself: the median block.
fn paper(colours: &Colours) -> [f64; 3] {
    [0, 1, 2].map(|i| {
        let mut all: Vec<u8> = colours.swallowed.iter().map(|v| v[i]).collect();
        let middle = all.len() / 2;
        if all.is_empty() {
            return 0.0;
        }
        f64::from(*all.select_nth_unstable(middle).1)
    })
}

/// What a piece of ink swallows more than its paper, summed over its pixels.
fn swallowed(c: &Component, colours: &Colours, paper: [f64; 3]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for run in &c.runs {
        for x in run.start..run.end {
            let here = colours.at(x, run.y);
            for ((s, v), p) in sum.iter_mut().zip(here).zip(paper) {
                *s += f64::from(v) - p;
            }
        }
    }
    sum.map(|v| v.max(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inks_are_told_by_their_hue() {
        let ink = |name: &str| Ink::try_from(name.to_owned()).unwrap();
        let cases = [
            ("blue", [0.9, 0.82, 0.59], true),
            ("blue", [0.97, 0.95, 0.88], false),
            ("black", [0.97, 0.95, 0.88], true),
            ("black", [0.9, 0.82, 0.59], false),
            ("red", [0.1, 0.8, 0.7], true),
            ("red", [0.9, 0.82, 0.59], false),
            ("#1030c0", [0.9, 0.8, 0.2], true),
            ("any", [0.3, 0.3, 0.3], true),
        ];
        for (name, seen, like) in cases {
            assert_eq!(ink(name).is_like(seen), like, "{name} {seen:?}");
        }
        for bad in ["pink?", "#12345", "#12345é", "#gg0000", ""] {
            assert!(Ink::try_from(bad.to_owned()).is_err(), "{bad}");
        }
    }

    #[test]
    fn written_and_read_again_an_ink_is_the_same() {
        for ink in [Ink::Any, Ink::Black, Ink::Hue([1, 2, 250])] {
            assert_eq!(Ink::try_from(String::from(ink)), Ok(ink));
        }
    }
}
