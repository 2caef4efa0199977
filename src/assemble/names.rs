//! What a cell's label says: a legal glyph name and the characters behind it.
//!
//! A label is one of: a character (`ب`), several characters that one glyph draws (`لا`), a name of
//! the Adobe Glyph List (`eacute`, `f_i`), a hexadecimal name (`uni0628`, `uni06440627`, `u1F600`),
//! or a friendly name as Glyphs writes it (`beh-ar`, `lam_alef-ar`). All take suffixes (`.init`, `.ss01`). The font
//! keeps a name as it was given; the characters follow from it. Arabic presentation forms (`ﺑ`, `uniFE91`) are the
//! letter in that joining form.

pub use crate::types::characters::name_of;

use super::nearest;
use crate::types::characters::{self, Spelled};
use crate::types::{Form, Label, Name};
use thiserror::Error;

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
        Form::of(&self.suffixes)
    }

    /// The suffixes that name no joining form: which alternate it is.
    pub fn alternates(&self) -> impl Iterator<Item = &str> {
        let suffixes = self.suffixes.iter().map(String::as_str);
        suffixes.filter(|s| Form::said(s).is_none())
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
        return identity(text, Spelled::default());
    }
    let (base, rest) = text.split_at(text.find('.').unwrap_or(text.len()));
    let is_text = [text, base]
        .into_iter()
        .any(|t| characters::literal(t).is_some());
    match characters::spelled(text) {
        Some(said) if is_text => {
            let name = [vec![name_of(&said.chars)], said.suffixes.clone()].concat();
            identity(&name.join("."), said)
        }
        Some(said) => identity(text, said),
        None => Err(LabelError::Unknown {
            label: text.to_owned(),
            nearest: nearest::name(base).map(|n| n + rest),
        }),
    }
}

fn identity(name: &str, said: Spelled) -> Result<Identity, LabelError> {
    let name = Name::new(name).map_err(|e| LabelError::Illegal(e.0))?;
    Ok(Identity {
        name,
        chars: said.chars,
        suffixes: said.suffixes,
    })
}

/// The name of these characters in a form, which the isolated one is without a suffix.
pub(crate) fn name_in(chars: &[char], form: Form) -> String {
    match form {
        Form::Isol => name_of(chars),
        form => format!("{}.{}", name_of(chars), form.tag()),
    }
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
            ("ب.init", "uni0628.init", "ب", Some(Form::Init)),
            ("é.ss01", "eacute.ss01", "é", None),
            ("1.ss01", "one.ss01", "1", None),
            (".", "period", ".", None),
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
