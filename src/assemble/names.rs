//! What a cell's label says: a legal glyph name and the characters behind it.
//!
//! A label is one of: a character (`ب`), several characters that one glyph draws (`لا`), a name of
//! the Adobe Glyph List (`eacute`, `f_i`), a hexadecimal name (`uni0628`, `uni06440627`, `u1F600`),
//! or a friendly name as Glyphs writes it (`beh-ar`, `lam_alef-ar`). Names take suffixes (`.init`,
//! `.ss01`). The font keeps a name as it was given; the characters follow from it. Arabic presentation forms (`ﺑ`,
//! `uniFE91`) are the letter in that joining form.

use super::nearest;
use crate::types::{Label, Name, characters};
use read_fonts::ps::agl;
use std::ops::RangeInclusive;
use thiserror::Error;
use unicode_normalization::UnicodeNormalization;

/// Why a label names no glyph.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum LabelError {
    /// Nothing to name a glyph by.
    #[error("an empty label names no glyph; write “_” to skip a cell")]
    Empty,
    /// A name that no list has.
    #[error("“{label}” is no known glyph name{}", nearest.as_ref().map_or(String::new(), |n| format!("; did you mean “{n}”?")))]
    Unknown {
        /// the label as given
        label: String,
        /// a name that differs little
        nearest: Option<String>,
    },
    /// A known name with a character that font files cannot hold.
    #[error("“{0}” cannot be a glyph name: 63 characters of A–Z a–z 0–9 . _ - at most")]
    Illegal(String),
}

/// The shape that a letter takes beside its neighbours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Form {
    /// Joined on neither side.
    Isol,
    /// Joined to the letter before it.
    Fina,
    /// Joined to the letter after it.
    Init,
    /// Joined on both sides.
    Medi,
}

impl Form {
    /// All four, in the order in which one of them stands in for a missing isolated form.
    pub const ALL: [Self; 4] = [Self::Isol, Self::Fina, Self::Init, Self::Medi];

    /// The OpenType feature and the suffix of that form.
    #[must_use]
    pub const fn tag(self) -> &'static str {
        match self {
            Self::Isol => "isol",
            Self::Fina => "fina",
            Self::Init => "init",
            Self::Medi => "medi",
        }
    }

    /// Whether this form joins the letter before it, to its right in Arabic.
    #[must_use]
    pub const fn joins_before(self) -> bool {
        matches!(self, Self::Fina | Self::Medi)
    }

    /// Whether this form joins the letter after it, to its left in Arabic.
    #[must_use]
    pub const fn joins_after(self) -> bool {
        matches!(self, Self::Init | Self::Medi)
    }
}

/// A label understood.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Identity {
    /// The glyph's name in the font.
    pub name: Name,
    /// What the glyph draws: one character, or the parts of a ligature in reading order. Never empty,
    /// except for `.notdef`.
    pub chars: Vec<char>,
    /// The dotted parts of the name after the first: `["init", "ss01"]`.
    pub suffixes: Vec<String>,
}

impl Identity {
    /// The joining form that a suffix names.
    #[must_use]
    pub fn form(&self) -> Option<Form> {
        let is = |f: &Form| self.suffixes.iter().any(|s| s == f.tag());
        Form::ALL.into_iter().find(is)
    }

    /// The suffixes that name no joining form: which alternate it is.
    pub fn alternates(&self) -> impl Iterator<Item = &str> {
        let is_form = |s: &str| Form::ALL.iter().any(|f| f.tag() == s);
        self.suffixes
            .iter()
            .map(String::as_str)
            .filter(move |s| !is_form(s))
    }
}

/// Reads a label.
///
/// # Errors
/// The label is empty, in no list of names, or no legal glyph name.
pub fn identify(label: &Label) -> Result<Identity, LabelError> {
    let text = label.0.trim();
    if text.is_empty() {
        return Err(LabelError::Empty);
    }
    if text == ".notdef" {
        return identity(text, Vec::new(), Vec::new());
    }
    if let Some(chars) = literal(text) {
        let (chars, suffixes) = joined(chars, Vec::new());
        let name = [vec![name_of(&chars)], suffixes.clone()].concat().join(".");
        return identity(&name, chars, suffixes);
    }
    let mut parts = text.split('.');
    let base = parts.next().unwrap_or_default();
    let suffixes: Vec<String> = parts.map(str::to_owned).collect();
    match characters::of(base) {
        Some(chars) if suffixes.iter().all(|s| !s.is_empty()) => {
            let (chars, suffixes) = joined(chars, suffixes);
            identity(text, chars, suffixes)
        }
        _ => Err(LabelError::Unknown {
            label: text.to_owned(),
            nearest: nearest::name(base).map(|n| [vec![n], suffixes].concat().join(".")),
        }),
    }
}

/// Blocks of single letters' joining forms in Unicode, and of lam with alef: those of one letter stand in the order
/// isolated, final, initial, medial.
const PRESENTED: [RangeInclusive<char>; 3] = [
    '\u{FE80}'..='\u{FEFC}',
    '\u{FB50}'..='\u{FBE9}',
    '\u{FBFC}'..='\u{FBFF}',
];

/// A presentation form as its letters and the suffix of its joining form; all else as it is.
fn joined(chars: Vec<char>, mut suffixes: Vec<String>) -> (Vec<char>, Vec<String>) {
    let [c] = chars[..] else {
        return (chars, suffixes);
    };
    let letters = |c: char| -> Vec<char> { std::iter::once(c).nfkc().collect() };
    let own = letters(c);
    if own == chars || !PRESENTED.iter().any(|range| range.contains(&c)) {
        return (chars, suffixes);
    }
    let alike = PRESENTED
        .into_iter()
        .flatten()
        .filter(|&f| letters(f) == own);
    let form = alike.zip(Form::ALL).find(|(f, _)| *f == c);
    suffixes.extend(
        form.filter(|f| f.1 != Form::Isol)
            .map(|f| f.1.tag().to_owned()),
    );
    (own, suffixes)
}

fn identity(name: &str, chars: Vec<char>, suffixes: Vec<String>) -> Result<Identity, LabelError> {
    let name = Name::new(name).map_err(|e| LabelError::Illegal(e.0))?;
    Ok(Identity {
        name,
        chars,
        suffixes,
    })
}

/// The label itself where it is text and no name: one character, or several none of which a name could hold.
fn literal(text: &str) -> Option<Vec<char>> {
    let chars: Vec<char> = text.chars().collect();
    (chars.len() == 1 || chars.iter().all(|c| !c.is_ascii())).then_some(chars)
}

/// A name for these characters: the glyph list's for one that has a plain name there, else `uniXXXX`.
#[must_use]
pub fn name_of(chars: &[char]) -> String {
    match chars {
        [c] => agl_name(*c).unwrap_or_else(|| hexadecimal(chars)),
        _ => hexadecimal(chars),
    }
}

/// The name of these characters in a form, which the isolated one is without a suffix.
#[must_use]
pub fn name_in(chars: &[char], form: Form) -> String {
    match form {
        Form::Isol => name_of(chars),
        form => format!("{}.{}", name_of(chars), form.tag()),
    }
}

fn hexadecimal(chars: &[char]) -> String {
    let digits = chars.iter().map(|&c| format!("{:04X}", u32::from(c)));
    if chars.iter().all(|&c| u32::from(c) <= 0xFFFF) {
        format!("uni{}", digits.collect::<String>())
    } else {
        let parts: Vec<String> = digits.map(|d| format!("u{d}")).collect();
        parts.join("_")
    }
}

/// The shortest of a character's names in the Adobe Glyph List. Its `afii…` and `SF…` numbers, and
/// the names it gives letters beyond Greek, say less than the code does.
fn agl_name(c: char) -> Option<String> {
    /// After the Greek block the list's names were never in common use, up to general punctuation.
    const RARE: std::ops::Range<u32> = 0x0400..0x1E00;
    if RARE.contains(&u32::from(c)) {
        return None;
    }
    let names = (0..).map_while(|n| {
        let mut buffer = [0; agl::MAX_NAME_LEN + 1];
        agl::char_to_nth_name(c, n, &mut buffer).map(str::to_owned)
    });
    names
        .filter(|n| !n.starts_with("afii") && !n.starts_with("SF"))
        .min_by_key(|n| (n.len(), n.clone()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(label: &str) -> (String, String, Option<Form>) {
        let id = identify(&Label(label.to_owned())).unwrap();
        (id.name.to_string(), id.chars.iter().collect(), id.form())
    }

    #[test]
    fn every_way_to_name_a_glyph() {
        let table = [
            ("A", "A", "A", None),
            ("7", "seven", "7", None),
            ("é", "eacute", "é", None),
            ("ب", "uni0628", "ب", None),
            ("لا", "uni06440627", "لا", None),
            ("eacute", "eacute", "é", None),
            ("f_f_i", "f_f_i", "ffi", None),
            ("fi", "fi", "ﬁ", None),
            ("uni0628.init", "uni0628.init", "ب", Some(Form::Init)),
            ("beh-ar", "beh-ar", "ب", None),
            ("beh-ar.medi", "beh-ar.medi", "ب", Some(Form::Medi)),
            (
                "lam_alef-ar.fina",
                "lam_alef-ar.fina",
                "لا",
                Some(Form::Fina),
            ),
            (
                "uni06440627.fina",
                "uni06440627.fina",
                "لا",
                Some(Form::Fina),
            ),
            ("fatha-ar", "fatha-ar", "\u{64e}", None),
            ("u1F600", "u1F600", "\u{1f600}", None),
            ("space", "space", " ", None),
            ("/", "slash", "/", None),
            ("keheh-ar", "keheh-ar", "ک", None),
            ("kashida-ar", "kashida-ar", "ـ", None),
            ("ﺏ", "uni0628", "ب", None),
            ("ﺑ", "uni0628.init", "ب", Some(Form::Init)),
            ("ﺄ", "uni0623.fina", "أ", Some(Form::Fina)),
            ("ﯩ", "uni0649.medi", "ى", Some(Form::Medi)),
            ("ﯿ", "uni06CC.medi", "ی", Some(Form::Medi)),
            ("ﻼ", "uni06440627.fina", "لا", Some(Form::Fina)),
            ("uniFE92", "uniFE92", "ب", Some(Form::Medi)),
            ("\u{FBB3}", "uniFBB3", "\u{FBB3}", None),
        ];
        for (label, name, chars, form) in table {
            assert_eq!(
                read(label),
                (name.to_owned(), chars.to_owned(), form),
                "{label}"
            );
        }
    }

    #[test]
    fn every_character_gets_a_name_that_leads_back() {
        for c in (0x21..0x500)
            .chain(0x2000..0x2100)
            .filter_map(char::from_u32)
        {
            let name = name_of(&[c]);
            assert_eq!(
                characters::of(&name),
                Some(vec![c]),
                "U+{:04X} {name}",
                u32::from(c)
            );
        }
    }

    #[test]
    fn suffixes_are_kept_apart() {
        let id = identify(&Label("beh-ar.init.ss01".to_owned())).unwrap();
        assert_eq!(id.form(), Some(Form::Init));
        assert_eq!(id.alternates().collect::<Vec<_>>(), ["ss01"]);
    }

    #[test]
    fn a_wrong_name_points_at_the_right_one() {
        for (wrong, right) in [
            ("behh-ar.init", "beh-ar.init"),
            ("eacut", "eacute"),
            ("beh.init", "beh-ar.init"),
            ("ampersnd", "ampersand"),
        ] {
            let error = identify(&Label(wrong.to_owned())).unwrap_err();
            assert_eq!(
                error.to_string(),
                format!("“{wrong}” is no known glyph name; did you mean “{right}”?")
            );
        }
        let error = identify(&Label("qqqqqqqqqqqq".to_owned())).unwrap_err();
        assert_eq!(error.to_string(), "“qqqqqqqqqqqq” is no known glyph name");
        assert_eq!(identify(&Label(" ".to_owned())), Err(LabelError::Empty));
    }
}
