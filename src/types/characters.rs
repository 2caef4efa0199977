//! The characters that a glyph's name or a label stands for.

use super::Form;
use glyphs_reader::glyphdata::GlyphData;
use read_fonts::ps::agl;
use std::ops::RangeInclusive;
use unicode_normalization::UnicodeNormalization;

/// Blocks of single letters' joining forms in Unicode, and of lam with alef: those of one letter stand in the order
/// isolated, final, initial, medial.
const PRESENTED: [RangeInclusive<char>; 3] = [
    '\u{FE80}'..='\u{FEFC}',
    '\u{FB50}'..='\u{FBE9}',
    '\u{FBFC}'..='\u{FBFF}',
];

/// What a label says.
#[derive(Debug, Clone, Default)]
pub(crate) struct Spelled {
    /// What its glyph draws: one character, or the parts of a ligature in reading order.
    pub(crate) chars: Vec<char>,
    /// The dotted parts after the first, and a presentation form's own: `["init", "ss01"]`.
    pub(crate) suffixes: Vec<String>,
}

impl Spelled {
    /// The joining form that a suffix names.
    pub(crate) fn form(&self) -> Option<Form> {
        Form::of(&self.suffixes)
    }
}

/// A label's text without spaces around it: text or a name, with suffixes or without. `None` when no list knows it.
pub(crate) fn spelled(label: &str) -> Option<Spelled> {
    if let Some(chars) = literal(label) {
        return Some(joined(chars, Vec::new()));
    }
    let mut parts = label.split('.');
    let base = parts.next().unwrap_or_default();
    let suffixes: Vec<String> = parts.map(str::to_owned).collect();
    let chars = literal(base).or_else(|| of(base))?;
    let is_whole = suffixes.iter().all(|s| !s.is_empty());
    is_whole.then(|| joined(chars, suffixes))
}

/// Text that is no name as its characters: one, or several none of which a name could hold.
pub(crate) fn literal(text: &str) -> Option<Vec<char>> {
    let chars: Vec<char> = text.chars().collect();
    let is_text = chars.len() == 1 || !chars.is_empty() && chars.iter().all(|c| !c.is_ascii());
    is_text.then_some(chars)
}

/// A presentation form as its letters and the suffix of its joining form; all else as it is.
fn joined(chars: Vec<char>, mut suffixes: Vec<String>) -> Spelled {
    let letters = |c: char| -> Vec<char> { std::iter::once(c).nfkc().collect() };
    let presented = match chars[..] {
        [c] if PRESENTED.iter().any(|range| range.contains(&c)) => Some((c, letters(c))),
        _ => None,
    };
    let Some((c, own)) = presented.filter(|p| p.1 != chars) else {
        return Spelled { chars, suffixes };
    };
    let alike = PRESENTED.into_iter().flatten();
    let mut forms = alike.filter(|&f| letters(f) == own).zip(Form::ALL);
    let form = forms.find(|(f, _)| *f == c).map(|f| f.1);
    let tag = form.filter(|f| *f != Form::Isol).map(Form::tag);
    suffixes.extend(tag.map(str::to_owned));
    Spelled {
        chars: own,
        suffixes,
    }
}

/// A name for these characters: the glyph list's for one that has a plain name there, else `uniXXXX`.
#[must_use]
pub fn name_of(chars: &[char]) -> String {
    match chars {
        [c] => agl_name(*c).unwrap_or_else(|| hexadecimal(chars)),
        _ => hexadecimal(chars),
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

/// The characters of a name without suffix; `None` when no list knows it.
pub(crate) fn of(base: &str) -> Option<Vec<char>> {
    listed(base).or_else(|| friendly(base))
}

/// Those of the Adobe Glyph List and of hexadecimal names, `f_i` and `uni0628`.
fn listed(base: &str) -> Option<Vec<char>> {
    let parts = base
        .split('_')
        .map(|part| agl::name_to_chars(part).collect());
    let parts: Vec<Vec<char>> = parts.collect();
    parts.iter().all(|p| !p.is_empty()).then(|| parts.concat())
}

/// The characters of a name as Glyphs writes it, `lam_alef-ar`.
fn friendly(base: &str) -> Option<Vec<char>> {
    let data = GlyphData::default();
    let known = data.query(base, None)?;
    if let Some(c) = known.codepoint.and_then(char::from_u32) {
        return Some(vec![c]);
    }
    let production = known.production_name?.to_string();
    listed(production.split('.').next().unwrap_or_default())
}
