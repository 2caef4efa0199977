//! A glyph: a name, a shape, an advance.

use super::Outline;
use kurbo::{Affine, Point};
use std::fmt;
use thiserror::Error;

/// Why a text is no glyph name.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(
    "“{0}” is no glyph name: 1 to 63 of A–Z a–z 0–9 . _ -, not beginning with a digit or a dash"
)]
pub struct NameError(pub String);

/// A legal glyph name: what a feature file may write.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Name(String);

impl Name {
    /// Checks a name.
    ///
    /// # Errors
    /// It is empty, longer than 63 characters, has a character outside `A–Z a–z 0–9 . _ -`, or begins
    /// with a digit or a dash.
    pub fn new(name: impl Into<String>) -> Result<Self, NameError> {
        let name = name.into();
        let legal = |b: u8| b.is_ascii_alphanumeric() || matches!(b, b'.' | b'_' | b'-');
        let first = name
            .bytes()
            .next()
            .is_some_and(|b| !b.is_ascii_digit() && b != b'-');
        if first && name.len() <= 63 && name.bytes().all(legal) {
            Ok(Self(name))
        } else {
            Err(NameError(name))
        }
    }

    /// The name of every font's first glyph, `.notdef`.
    #[must_use]
    pub fn notdef() -> Self {
        Self(".notdef".to_owned())
    }

    /// The name.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl fmt::Display for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// A name as the classes and lookups of a feature file can have it, and one that is free.
pub(crate) fn label(name: &str, is_free: impl Fn(&str) -> bool) -> String {
    let fits = |c: &char| c.is_ascii_alphanumeric() || matches!(c, '.' | '_' | '-');
    let plain = name.chars().map(|c| Some(c).filter(fits).unwrap_or('_'));
    let plain: String = plain.collect();
    if is_free(&plain) {
        return plain;
    }
    let mut more = (1..).map(|k| format!("{plain}.{k}"));
    more.find(|n| is_free(n)).unwrap_or_default()
}

/// A named point for attaching marks (`top`, `_top`, `entry`, `exit`), font units.
#[derive(Debug, Clone, PartialEq)]
pub struct Anchor {
    /// Its name; a leading `_` is the mark's side.
    pub name: String,
    /// Where, font units.
    pub at: Point,
}

/// Another glyph's shape, placed.
#[derive(Debug, Clone, PartialEq)]
pub struct Component {
    /// The glyph whose shape it is.
    pub base: Name,
    /// From that glyph's space to this one's, font units.
    pub place: Affine,
}

/// A part of a glyph that has one colour.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Layer {
    /// The glyph whose shape it is.
    pub glyph: Name,
    /// Its place in the font's palette, from 0; the text's colour where it has none.
    pub colour: Option<usize>,
}

/// One glyph of a font, font units.
#[derive(Debug, Clone, PartialEq)]
pub struct Glyph {
    /// Unique in the font.
    pub name: Name,
    /// Characters it stands for; none for alternates and ligatures.
    pub codepoints: Vec<char>,
    /// Advance width, at least 0.
    pub advance: f64,
    /// Its own contours.
    pub outline: Outline,
    /// Contours of other glyphs.
    pub components: Vec<Component>,
    /// Attachment points.
    pub anchors: Vec<Anchor>,
    /// What programs that know colours draw in its place, the lowest first; empty for a glyph of the text's colour.
    pub layers: Vec<Layer>,
}

impl Glyph {
    /// An empty glyph.
    #[must_use]
    pub const fn new(name: Name, codepoints: Vec<char>, advance: f64) -> Self {
        let outline = Outline::EMPTY;
        Self {
            name,
            codepoints,
            advance,
            outline,
            components: Vec::new(),
            anchors: Vec::new(),
            layers: Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names() {
        for good in [
            ".notdef",
            "a",
            "beh-ar.init",
            "uni06440627.fina",
            "_part.dot",
        ] {
            assert!(Name::new(good).is_ok(), "{good}");
        }
        let long = "a".repeat(64);
        for bad in ["", "0a", "-a", "a b", "é", long.as_str(), "a/b"] {
            assert!(Name::new(bad).is_err(), "{bad}");
        }
    }
}
