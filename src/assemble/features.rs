//! Substitutions: joining forms, ligatures and alternates, as a feature file.
//!
//! The features follow from the names alone. A form replaces the glyph that has the character; a
//! ligature replaces its parts in the forms that they take inside it; a glyph with a feature's tag as
//! suffix (`a.ss01`) replaces the one without.

use super::{Draft, Note};
use crate::types::Form;
use std::collections::BTreeMap;
use unicode_joining_type::{JoiningType, get_joining_type};
use unicode_normalization::UnicodeNormalization;

/// Features that a glyph asks for by its suffix, besides `ss01`…`ss20` and `cv01`…`cv99`.
const BY_SUFFIX: &[&str] = &[
    "aalt", "c2sc", "calt", "case", "dlig", "hist", "lnum", "onum", "ordn", "pnum", "salt", "sinf",
    "smcp", "subs", "sups", "swsh", "titl", "tnum", "zero",
];

/// The feature text and what could not be made.
pub(super) fn text(drafts: &[Draft]) -> (String, Vec<Note>) {
    let glyphs = Glyphs::of(drafts);
    let mut out = language_systems(drafts);
    for form in Form::ALL {
        let rules = glyphs.forms(form);
        feature(&mut out, form.tag(), "", &rules);
    }
    let (required, standard, mut notes) = glyphs.ligatures();
    feature(&mut out, "rlig", "    lookupflag IgnoreMarks;\n", &required);
    feature(&mut out, "liga", "", &standard);
    let (alternates, unused) = glyphs.alternates();
    notes.extend(unused);
    for (tag, rules) in alternates {
        feature(&mut out, &tag, "", &rules);
    }
    (out, notes)
}

fn feature(out: &mut String, tag: &str, flag: &str, rules: &[String]) {
    if rules.is_empty() {
        return;
    }
    let body: String = rules.iter().map(|r| format!("    sub {r};\n")).collect();
    *out += &format!("\nfeature {tag} {{\n{flag}{body}}} {tag};\n");
}

/// The scripts of the drawn letters, the default first as the syntax asks.
fn language_systems(drafts: &[Draft]) -> String {
    let chars = || drafts.iter().flat_map(|d| d.id.chars.iter().copied());
    let scripts = [
        ("arab", chars().any(is_arabic)),
        (
            "latn",
            chars().any(|c| c.is_alphabetic() && u32::from(c) < 0x250),
        ),
    ];
    let mut out = "languagesystem DFLT dflt;\n".to_owned();
    for (script, _) in scripts.into_iter().filter(|s| s.1) {
        out += &format!("languagesystem {script} dflt;\n");
    }
    out
}

/// Whether a character is of the Arabic script's blocks.
pub(super) fn is_arabic(c: char) -> bool {
    matches!(u32::from(c), 0x0600..=0x06FF | 0x0750..=0x077F | 0x0870..=0x08FF | 0xFB50..=0xFDFF | 0xFE70..=0xFEFF)
}

/// The letters of a Latin ligature that has a character of its own: ﬁ.
fn unfolded(draft: &Draft) -> Option<Vec<char>> {
    let [c @ ('ﬀ'..='ﬄ' | 'ﬆ')] = draft.id.chars[..] else {
        return None;
    };
    Some(std::iter::once(c).nfkc().collect())
}

/// Whether a character changes its form beside its neighbours.
fn joins(c: char) -> bool {
    matches!(
        get_joining_type(c),
        JoiningType::DualJoining | JoiningType::RightJoining | JoiningType::LeftJoining
    )
}

/// The font's glyphs by what they stand for.
struct Glyphs<'a> {
    drafts: &'a [Draft],
    /// Character → the glyph that has it.
    encoded: BTreeMap<char, &'a str>,
    /// Character and form → the glyph of that form.
    formed: BTreeMap<(char, Form), &'a str>,
}

impl<'a> Glyphs<'a> {
    fn of(drafts: &'a [Draft]) -> Self {
        let encoded = |d: &'a Draft| d.codepoints.iter().map(|&c| (c, d.id.name.as_str()));
        let formed = |d: &'a Draft| match (&d.id.chars[..], d.id.form()) {
            ([c], Some(form)) if d.id.alternates().next().is_none() => {
                Some(((*c, form), d.id.name.as_str()))
            }
            _ => None,
        };
        Self {
            drafts,
            encoded: drafts.iter().flat_map(encoded).collect(),
            formed: drafts.iter().filter_map(formed).collect(),
        }
    }

    fn forms(&self, form: Form) -> Vec<String> {
        let rule = |(&(c, f), &to): (&(char, Form), &&str)| {
            let from = self.encoded.get(&c)?;
            (f == form && *from != to).then(|| format!("{from} by {to}"))
        };
        self.formed.iter().filter_map(rule).collect()
    }

    /// Rules of `rlig` (joining scripts) and `liga` (others), and the ligatures whose parts are missing.
    fn ligatures(&self) -> (Vec<String>, Vec<String>, Vec<Note>) {
        let (mut required, mut standard, mut notes) = (Vec::new(), Vec::new(), Vec::new());
        let plain = |d: &&Draft| d.id.alternates().next().is_none();
        let plain = || self.drafts.iter().filter(plain);
        let named = plain()
            .filter(|d| d.id.chars.len() > 1)
            .map(|d| (d, d.id.chars.clone()));
        let encoded = plain().filter_map(|d| Some((d, unfolded(d)?)));
        let encoded = encoded.filter(|(_, chars)| plain().all(|d| d.id.chars != *chars));
        for (draft, chars) in named.chain(encoded) {
            let name = &draft.id.name;
            match self.parts(draft, &chars) {
                Ok(parts) => {
                    let rules = if chars.iter().any(|&c| joins(c)) { &mut required } else { &mut standard };
                    rules.push(format!("{} by {name}", parts.join(" ")));
                }
                // it has a character of its own
                Err(_) if draft.id.chars != chars => {}
                Err(missing) => notes.push(Note {
                    glyph: name.to_string(),
                    message: format!(
                        "the ligature is never used: the font has no glyph for its part {missing} (U+{:04X}); draw it or skip the ligature",
                        u32::from(missing)
                    ),
                }),
            }
        }
        (required, standard, notes)
    }

    /// The glyphs that a ligature replaces, or the character that no glyph has.
    fn parts(&self, ligature: &Draft, chars: &[char]) -> Result<Vec<&'a str>, char> {
        let form = ligature.id.form().unwrap_or(Form::Isol);
        let last = chars.len() - 1;
        let part = |(i, &c): (usize, &char)| {
            let before = i > 0 || form.joins_before();
            let after = i < last || form.joins_after();
            let inside = match (before, after) {
                (true, true) => Form::Medi,
                (true, false) => Form::Fina,
                (false, true) => Form::Init,
                (false, false) => Form::Isol,
            };
            self.formed
                .get(&(c, inside))
                .or_else(|| self.encoded.get(&c))
                .copied()
                .ok_or(c)
        };
        chars.iter().enumerate().map(part).collect()
    }

    /// Feature tag → rules for the glyphs that carry it as a suffix, and those whose plain glyph is missing.
    fn alternates(&self) -> (BTreeMap<String, Vec<String>>, Vec<Note>) {
        let mut out: BTreeMap<String, Vec<String>> = BTreeMap::new();
        let mut notes = Vec::new();
        for draft in self.drafts {
            for tag in draft.id.alternates().filter(|t| is_tag(t)) {
                let suffixes = draft.id.suffixes.iter();
                let rest: Vec<&String> = suffixes.filter(|s| *s != tag).collect();
                let is_plain = |d: &&Draft| {
                    d.id.chars == draft.id.chars && d.id.suffixes.iter().eq(rest.iter().copied())
                };
                let from = self.drafts.iter().find(is_plain);
                let name = draft.id.name.to_string();
                match from {
                    Some(from) => {
                        let rule = format!("{} by {name}", from.id.name);
                        out.entry(tag.to_owned()).or_default().push(rule);
                    }
                    None => notes.push(Note {
                        glyph: name,
                        message: format!("the alternate is never used: the font has no glyph that {tag} could replace by it; draw that"),
                    }),
                }
            }
        }
        (out, notes)
    }
}

fn is_tag(suffix: &str) -> bool {
    let numbered = suffix
        .strip_prefix("ss")
        .or_else(|| suffix.strip_prefix("cv"));
    let number = numbered.and_then(|n| (n.len() == 2).then(|| n.parse::<u8>().ok()).flatten());
    let limit = if suffix.starts_with("ss") { 20 } else { 99 };
    number.is_some_and(|n| (1..=limit).contains(&n)) || BY_SUFFIX.contains(&suffix)
}
