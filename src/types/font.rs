//! A font before it is written.

use super::{Glyph, Name, Outline, style};
use kurbo::{Affine, BezPath};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use thiserror::Error;

/// Components within components, at most: more than any font nests, and it ends a reference in a circle.
const MAX_COMPONENT_DEPTH: usize = 8;

/// Why glyphs are no font.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum FontError {
    /// The first glyph is not `.notdef`.
    #[error("the first glyph must be .notdef")]
    NoNotdef,
    /// Two glyphs have one name.
    #[error("two glyphs are named {0}")]
    TwiceName(String),
    /// Two glyphs have one character.
    #[error("the character U+{:04X} belongs to both {first} and {second}", u32::from(*.char))]
    TwiceChar {
        /// the character
        char: char,
        /// the glyph that has it
        first: String,
        /// the other
        second: String,
    },
    /// More than the format can count.
    #[error("{0} glyphs; a font holds 65535 at most")]
    TooMany(usize),
}

/// What the font says about itself.
#[derive(Debug, Clone, PartialEq)]
pub struct Info {
    /// Family name.
    pub family: String,
    /// Style name, such as `Regular`.
    pub style: String,
    /// PostScript name, where it does not follow from family and style.
    pub postscript: Option<String>,
    /// Major and minor version.
    pub version: (u16, u16),
    /// Units an em, 16…16384.
    pub units_per_em: u16,
    /// Weight class, 1…1000.
    pub weight: u16,
    /// Angle of the stems, degrees counter-clockwise from upright: negative for an italic.
    pub italic_angle: f64,
    /// Seconds since 1970-01-01T00:00:00Z that the font gives as its date.
    pub created: i64,
    /// Copyright notice.
    pub copyright: Option<String>,
    /// Designer.
    pub designer: Option<String>,
    /// Manufacturer.
    pub manufacturer: Option<String>,
    /// Licence text.
    pub license: Option<String>,
    /// Where the licence stands in full.
    pub license_url: Option<String>,
    /// Vendor's web address.
    pub vendor_url: Option<String>,
    /// Four letters registered for the vendor.
    pub vendor_id: [u8; 4],
    /// Heights.
    pub metrics: Metrics,
}

impl Default for Info {
    fn default() -> Self {
        Self {
            family: "Untitled".to_owned(),
            style: "Regular".to_owned(),
            postscript: None,
            version: (1, 0),
            units_per_em: 1000,
            weight: 400,
            italic_angle: 0.0,
            created: 0,
            copyright: None,
            designer: None,
            manufacturer: None,
            license: None,
            license_url: None,
            vendor_url: None,
            vendor_id: *b"NONE",
            metrics: Metrics::default(),
        }
    }
}

/// How a style is split between the old family menu and the typographic one.
pub(crate) struct LinkedStyle {
    pub(crate) family: String,
    pub(crate) linked: &'static str,
    pub(crate) is_bold: bool,
    pub(crate) is_italic: bool,
}

impl Info {
    /// The style as four-style menus show it: others become families of their own.
    pub(crate) fn linked_style(&self) -> LinkedStyle {
        let words: Vec<&str> = self.style.split_whitespace().collect();
        let is = |word: &str, names: &[&str]| names.iter().any(|n| n.eq_ignore_ascii_case(word));
        let (is_italic, upright) = match words.split_last() {
            Some((last, rest)) if is(last, &["Italic", "Oblique"]) => (true, rest),
            _ => (false, words.as_slice()),
        };
        let is_bold = matches!(upright, [word] if is(word, &["Bold"]));
        let is_plain = match upright {
            [] => true,
            [word] => is(word, &["Regular", "Bold"]),
            _ => false,
        };
        LinkedStyle {
            family: if is_plain {
                self.family.clone()
            } else {
                format!("{} {}", self.family, upright.join(" "))
            },
            linked: match (is_bold, is_italic) {
                (false, false) => "Regular",
                (false, true) => "Italic",
                (true, false) => "Bold",
                (true, true) => "Bold Italic",
            },
            is_bold,
            is_italic,
        }
    }

    /// Height of the underline's upper edge and the line's thickness, font units: what most text fonts have.
    pub(crate) fn underline(&self) -> (f64, f64) {
        const SHARES: (f64, f64) = (-0.1, 0.05);
        let em = f64::from(self.units_per_em);
        (SHARES.0 * em, SHARES.1 * em)
    }

    /// The same of the line that strikes text out. Small letters tell its height, or capitals; where none is drawn it
    /// has the place that it has in most Arabic fonts.
    pub(crate) fn strikeout(&self) -> (f64, f64) {
        const SHARES: (f64, f64) = (0.26, 0.05);
        let em = f64::from(self.units_per_em);
        let letters = self.metrics.x_height.max(0.7 * self.metrics.cap_height);
        let height = if letters > 0.0 {
            0.6 * letters
        } else {
            SHARES.0 * em
        };
        (height, SHARES.1 * em)
    }

    /// The PostScript name: the font's own, or one that follows from family and style; of 63 characters at most.
    pub(crate) fn postscript_name(&self) -> String {
        self.postscript.clone().unwrap_or_else(|| {
            let or = |text: &str, none: &str| {
                let name = style::postscript(text);
                if name.is_empty() {
                    none.to_owned()
                } else {
                    name
                }
            };
            let whole = format!(
                "{}-{}",
                or(&self.family, "Font"),
                or(&self.style, "Regular")
            );
            whole.chars().take(style::LONGEST).collect()
        })
    }

    /// The same with a PostScript name of its own, where that is legal and does not follow from the others.
    pub(crate) fn with_postscript(mut self, name: Option<String>) -> Self {
        self.postscript = None;
        let usual = self.postscript_name();
        self.postscript = name.filter(|n| style::is_postscript(n) && *n != usual);
        self
    }
}

/// Vertical measures, font units.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Metrics {
    /// Above the baseline; also the window's upper bound at least.
    pub ascender: f64,
    /// Below the baseline: at most 0.
    pub descender: f64,
    /// Between two lines beyond ascender and descender.
    pub line_gap: f64,
    /// Height of x, or 0 where the font has none.
    pub x_height: f64,
    /// Height of H, or 0 where the font has none.
    pub cap_height: f64,
}

/// Pair kerning by groups.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Kerning {
    /// Group name without prefix → its glyphs as first of a pair.
    pub first: BTreeMap<String, Vec<Name>>,
    /// Group name without prefix → its glyphs as second of a pair.
    pub second: BTreeMap<String, Vec<Name>>,
    /// (first, second) → advance change, font units. Each side is a glyph name, or `@` and a group name.
    pub pairs: BTreeMap<(String, String), f64>,
}

/// Glyphs in glyph-id order with everything a writer needs.
#[derive(Debug, Clone, PartialEq)]
pub struct Font {
    /// Names, version, heights.
    pub info: Info,
    glyphs: Vec<Glyph>,
    /// Pair kerning.
    pub kerning: Kerning,
    /// Colours of the glyphs' layers: red, green and blue.
    pub palette: Vec<[u8; 3]>,
    /// OpenType features in feature-file syntax, except kerning and mark attachment: those follow
    /// from [`Self::kerning`] and the glyphs' anchors when a font is written.
    pub features: String,
    /// Tag → binary tables that came with a font file and go into the next one as they are.
    /// They win over what would be built, but for what follows from outlines in `head`, `hhea` and
    /// `post`: glyph ids and characters must not have changed.
    pub carried: BTreeMap<[u8; 4], Vec<u8>>,
}

impl Font {
    /// A font of these glyphs, the first of which is `.notdef`.
    ///
    /// # Errors
    /// `.notdef` is not first, a name or a character stands twice, or there are more than 65535.
    pub fn new(info: Info, glyphs: Vec<Glyph>) -> Result<Self, FontError> {
        if glyphs.first().is_none_or(|g| g.name.as_str() != ".notdef") {
            return Err(FontError::NoNotdef);
        }
        if glyphs.len() > usize::from(u16::MAX) {
            return Err(FontError::TooMany(glyphs.len()));
        }
        let mut names = BTreeSet::new();
        let mut chars: BTreeMap<char, &Name> = BTreeMap::new();
        for g in &glyphs {
            if !names.insert(&g.name) {
                return Err(FontError::TwiceName(g.name.to_string()));
            }
            for &c in &g.codepoints {
                if let Some(other) = chars.insert(c, &g.name) {
                    let (first, second) = (other.to_string(), g.name.to_string());
                    return Err(FontError::TwiceChar {
                        char: c,
                        first,
                        second,
                    });
                }
            }
        }
        Ok(Self {
            info,
            glyphs,
            kerning: Kerning::default(),
            palette: Vec::new(),
            features: String::new(),
            carried: BTreeMap::new(),
        })
    }

    /// The glyphs in glyph-id order.
    #[must_use]
    pub fn glyphs(&self) -> &[Glyph] {
        &self.glyphs
    }

    /// The same font with every outline replaced by `change`'s answer.
    ///
    /// # Errors
    /// All errors of `change`, in the glyphs' order.
    pub fn try_map_outlines<E: Send>(
        &self,
        change: impl Fn(&Glyph) -> Result<Outline, E> + Sync,
    ) -> Result<Self, Vec<E>> {
        let outlines: Vec<Result<Outline, E>> = self.glyphs.par_iter().map(&change).collect();
        let (mut font, mut errors) = (self.clone(), Vec::new());
        for (glyph, outline) in font.glyphs.iter_mut().zip(outlines) {
            match outline {
                Ok(outline) => glyph.outline = outline,
                Err(why) => errors.push(why),
            }
        }
        if errors.is_empty() {
            Ok(font)
        } else {
            Err(errors)
        }
    }

    /// The same font with every glyph changed; names, characters and order stay.
    #[must_use]
    pub(crate) fn map_glyphs(&self, change: impl Fn(&Glyph) -> Glyph) -> Self {
        let glyphs = self.glyphs.iter().map(change).collect();
        Self {
            glyphs,
            ..self.clone()
        }
    }

    /// A glyph's whole shape: its own contours and those of its components, placed. Components that
    /// name no glyph are left out, and so is what lies deeper than a reference can sensibly go.
    #[must_use]
    pub fn shape(&self, glyph: &Glyph) -> Outline {
        let mut paths = Vec::new();
        self.collect(glyph, Affine::IDENTITY, MAX_COMPONENT_DEPTH, &mut paths);
        Outline::default().map_contours(|_| paths)
    }

    fn collect(&self, glyph: &Glyph, place: Affine, depth: usize, out: &mut Vec<BezPath>) {
        out.extend(glyph.outline.contours().iter().map(|c| place * c));
        if depth == 0 {
            return;
        }
        for part in &glyph.components {
            if let Some(base) = self.glyph(part.base.as_str()) {
                self.collect(base, place * part.place, depth - 1, out);
            }
        }
    }

    /// The glyph of that name.
    #[must_use]
    pub fn glyph(&self, name: &str) -> Option<&Glyph> {
        self.glyphs.iter().find(|g| g.name.as_str() == name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_struck_out_through_its_letters() {
        for (x_height, cap_height, height) in [
            (500.0, 700.0, 300.0),
            (0.0, 700.0, 294.0),
            (0.0, 0.0, 260.0),
        ] {
            let mut info = Info::default();
            (info.metrics.x_height, info.metrics.cap_height) = (x_height, cap_height);
            assert!(
                (info.strikeout().0 - height).abs() < 1e-6,
                "{:?}",
                info.strikeout()
            );
        }
    }

    #[test]
    fn postscript_names_are_legal() {
        let info = |family: &str, style: &str| Info {
            family: family.to_owned(),
            style: style.to_owned(),
            ..Info::default()
        };
        let name = info("Khatt Latin", "Bold Italic").postscript_name();
        assert_eq!(name, "KhattLatin-BoldItalic");
        let name = info("خط", "").postscript_name();
        assert_eq!(name, "u062Eu0637-Regular");
        let names = ["عادي", "عريض", "عريض مائل", "Fétt"].map(|s| info("F", s).postscript_name());
        assert_eq!(names, ["F-Regular", "F-Bold", "F-BoldItalic", "F-Fett"]);
        assert_ne!(
            info("F", "مزخرف").postscript_name(),
            info("F", "قديم").postscript_name()
        );
        assert_eq!(info(&"x".repeat(90), "R").postscript_name().len(), 63);
    }

    #[test]
    fn every_family_of_four_styles_has_its_italic() {
        for (name, family, linked) in [
            ("Medium", "A Medium", "Regular"),
            ("SemiBold Italic", "A SemiBold", "Italic"),
            ("bold italic", "A", "Bold Italic"),
            ("Oblique", "A", "Italic"),
            ("Bold Condensed", "A Bold Condensed", "Regular"),
            ("", "A", "Regular"),
        ] {
            let info = Info {
                family: "A".to_owned(),
                style: name.to_owned(),
                ..Info::default()
            };
            let style = info.linked_style();
            assert_eq!(
                (style.family.as_str(), style.linked),
                (family, linked),
                "{name}"
            );
            assert_eq!(style.is_italic, linked.contains("Italic"), "{name}");
        }
    }
}
