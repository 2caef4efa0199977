//! Which ink the letters are drawn with, where a page has several.

use super::components::{Component, gap};
use crate::numeric::median::middle;
use crate::types::Colours;
use serde::{Deserialize, Serialize};
use std::fmt;

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

/// Cosine from which two hues are too alike to be told apart: 20°.
const ONE_HUE: f64 = 0.94;

/// The inks of the letters: one, or a list of those that become layers of a colour font, the lowest layer first.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "Listed", into = "Listed")]
pub struct Inks {
    all: Vec<Ink>,
    use_of: Use,
}

/// What the inks are told apart for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Use {
    /// Letters and what is none.
    Letters,
    /// Layers of letters.
    Layers,
}

/// How a project file writes inks.
#[derive(Serialize, Deserialize)]
#[serde(
    untagged,
    expecting = "must be an ink, or a list of inks that become layers of a colour font"
)]
enum Listed {
    One(String),
    Several(Vec<String>),
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
            _ => hex(&text).map(Self::looking).ok_or_else(|| {
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

impl Default for Inks {
    fn default() -> Self {
        Ink::Any.into()
    }
}

impl From<Ink> for Inks {
    fn from(ink: Ink) -> Self {
        Self {
            all: vec![ink],
            use_of: Use::Letters,
        }
    }
}

impl TryFrom<Listed> for Inks {
    type Error = String;

    fn try_from(listed: Listed) -> Result<Self, String> {
        let names = match listed {
            Listed::One(name) => return Ok(Ink::try_from(name)?.into()),
            Listed::Several(names) => names,
        };
        let inks = names.iter().map(|name| Ink::try_from(name.clone()));
        let all: Vec<Ink> = inks.collect::<Result<_, _>>()?;
        if all.is_empty() || all.contains(&Ink::Any) {
            return Err(
                "a list of inks names each of them, such as [\"black\", \"red\"]".to_owned(),
            );
        }
        for (i, ink) in all.iter().enumerate() {
            if let Some(twin) = all[..i].iter().position(|other| other.is_one_with(*ink)) {
                return Err(format!(
                    "the inks {} and {} are too alike to be told apart",
                    names[twin], names[i]
                ));
            }
        }
        let use_of = Use::Layers;
        Ok(Self { all, use_of })
    }
}

impl From<Inks> for Listed {
    fn from(inks: Inks) -> Self {
        let mut names: Vec<String> = inks.all.into_iter().map(String::from).collect();
        match inks.use_of {
            Use::Letters => Self::One(names.swap_remove(0)),
            Use::Layers => Self::Several(names),
        }
    }
}

impl fmt::Display for Inks {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<String> = self.all.iter().map(|&ink| ink.into()).collect();
        f.write_str(&names.join(", "))
    }
}

impl Inks {
    /// The inks that become layers, the lowest first; none where letters have no layers.
    #[must_use]
    pub fn layers(&self) -> &[Ink] {
        match self.use_of {
            Use::Letters => &[],
            Use::Layers => &self.all,
        }
    }

    /// Whether they tell anything apart.
    pub(super) fn choose(&self) -> bool {
        self.all != [Ink::Any]
    }

    /// Which of them ink is that swallows these shares of red, green and blue.
    pub(super) fn nearest(&self, swallowed: [f64; 3]) -> Option<usize> {
        let like = self.all.iter().enumerate();
        let like = like.filter(|(_, ink)| ink.is_like(swallowed));
        let nearest = like.max_by(|a, b| {
            let cosine = |ink: &Ink| ink.cosine(swallowed);
            cosine(a.1).total_cmp(&cosine(b.1))
        });
        nearest.map(|(i, _)| i)
    }

    /// Parts pieces of these inks from those of others; all are of them on a page without colours.
    pub(super) fn part(
        &self,
        all: Vec<Component>,
        colours: Option<&Colours>,
    ) -> (Vec<Component>, Vec<Component>) {
        let Some(colours) = colours.filter(|_| self.choose()) else {
            return (all, Vec::new());
        };
        let paper = paper(colours);
        let is_own = |c: &Component| {
            self.nearest(swallowed(c, colours, paper)).is_some()
                || (self.use_of == Use::Layers && self.cover(c, colours, paper))
        };
        let (mut own, other): (Vec<_>, Vec<_>) = all.into_iter().partition(is_own);
        // where a pen lingers its ink is nearly black
        let (dark, other): (Vec<_>, Vec<_>) = other.into_iter().partition(|c| {
            Ink::Black.is_like(swallowed(c, colours, paper)) && own.iter().any(|o| lingers(c, o))
        });
        own.extend(dark);
        (own, other)
    }

    /// Whether most pixels of a piece are of one of these inks: two hues beside each other can have a third in the
    /// mean.
    fn cover(&self, c: &Component, colours: &Colours, paper: [f64; 3]) -> bool {
        let own = c
            .pixels()
            .filter(|&(x, y)| self.nearest(more(colours.at(x, y), paper)).is_some());
        2 * own.count() > c.area
    }
}

impl Ink {
    /// The ink that looks like this on white paper; what has no hue there has none on a page.
    fn looking(look: [u8; 3]) -> Self {
        if Self::Black.is_like(look.map(|v| 255.0 - f64::from(v))) {
            Self::Black
        } else {
            Self::Hue(look)
        }
    }

    /// Cosine of the angle to ink that swallows these shares on the circle of hues; 1 for inks without a hue.
    fn cosine(self, swallowed: [f64; 3]) -> f64 {
        let Self::Hue(look) = self else { return 1.0 };
        let wanted = hue(look.map(|v| 255.0 - f64::from(v)));
        let seen = hue(swallowed);
        let lengths = wanted.0.hypot(wanted.1) * seen.0.hypot(seen.1);
        (wanted.0 * seen.0 + wanted.1 * seen.1) / lengths.max(f64::MIN_POSITIVE)
    }

    /// Whether nothing on a page could tell it from another.
    fn is_one_with(self, other: Self) -> bool {
        match (self, other) {
            (Self::Hue(_), Self::Hue(look)) => {
                self.cosine(look.map(|v| 255.0 - f64::from(v))) > ONE_HUE
            }
            _ => self == other,
        }
    }

    /// Whether ink that swallows these shares of red, green and blue is of this kind.
    fn is_like(self, swallowed: [f64; 3]) -> bool {
        let most = swallowed.iter().copied().fold(0.0, f64::max);
        let least = swallowed.iter().copied().fold(most, f64::min);
        let neutral = most - least < NEUTRAL * most;
        match self {
            Self::Any => true,
            Self::Black => neutral,
            Self::Hue(_) => !neutral && self.cosine(swallowed) > ALIKE,
        }
    }
}

/// Whether a dark piece is a part of the letter that another piece begins: far smaller, and hardly farther from it
/// than its stroke is wide.
fn lingers(dark: &Component, pen: &Component) -> bool {
    2 * dark.area < pen.area && gap(dark.bounds, pen.bounds) < NEAR * pen.stroke()
}

/// A place on the plane of hues.
fn hue([r, g, b]: [f64; 3]) -> (f64, f64) {
    (r - (g + b) / 2.0, (g - b) * 3f64.sqrt() / 2.0)
}

/// What the paper swallows itself: the median block.
pub(super) fn paper(colours: &Colours) -> [f64; 3] {
    [0, 1, 2].map(|i| {
        let all = colours.swallowed.iter().map(|v| v[i]);
        middle(all, u8::cmp).map_or(0.0, f64::from)
    })
}

/// What a piece of ink swallows more than its paper, summed over its pixels.
pub(super) fn swallowed(c: &Component, colours: &Colours, paper: [f64; 3]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for (x, y) in c.pixels() {
        let here = colours.at(x, y);
        for ((s, v), p) in sum.iter_mut().zip(here).zip(paper) {
            *s += f64::from(v) - p;
        }
    }
    sum.map(|v| v.max(0.0))
}

/// What a place swallows more than its paper.
pub(super) fn more(here: [u8; 3], paper: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| (f64::from(here[i]) - paper[i]).max(0.0))
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
            ("#000000", [0.97, 0.95, 0.88], true),
            ("#1e1e22", [0.97, 0.95, 0.93], true),
            ("#1e1e22", [0.9, 0.8, 0.2], false),
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
        for json in [
            "\"any\"",
            "\"black\"",
            "[\"black\",\"#c81e1e\"]",
            "[\"#c81e1e\"]",
        ] {
            let inks: Inks = serde_json::from_str(json).unwrap();
            assert_eq!(serde_json::to_string(&inks).unwrap(), json);
            let layers = if json.starts_with('[') {
                inks.all.len()
            } else {
                0
            };
            assert_eq!(inks.layers().len(), layers, "{json}");
        }
    }

    #[test]
    fn inks_of_a_list_are_told_apart() {
        let wrong = |json: &str| serde_json::from_str::<Inks>(json).unwrap_err().to_string();
        for pair in [["orange", "brown"], ["black", "#202020"]] {
            let problem = wrong(&serde_json::to_string(&pair).unwrap());
            let alike = format!("{} and {} are too alike", pair[0], pair[1]);
            assert!(problem.contains(&alike), "{problem}");
        }
        for json in ["[]", "[\"black\", \"any\"]"] {
            assert!(wrong(json).contains("names each of them"), "{json}");
        }
        assert!(wrong("3").contains("a list of inks"));
        let inks: Inks = serde_json::from_str("[\"black\", \"red\", \"orange\"]").unwrap();
        let cases = [
            ([0.97, 0.95, 0.93], Some(0)),
            ([0.2, 0.85, 0.85], Some(1)),
            ([0.1, 0.5, 0.9], Some(2)),
            ([0.9, 0.8, 0.3], None),
        ];
        for (seen, ink) in cases {
            assert_eq!(inks.nearest(seen), ink, "{seen:?}");
        }
    }
}
