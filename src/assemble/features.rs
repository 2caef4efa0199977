//! Substitutions: joining forms, ligatures and alternates, as a feature file.
//!
//! The features follow from the names alone. A form replaces the glyph that has the character; a
//! ligature replaces its letters in the forms that text gives them; a glyph with a feature's tag as
//! suffix (`a.ss01`) replaces the one without.

use super::{Draft, Note, names, nearest};
use crate::types::Form;
use std::collections::{BTreeMap, BTreeSet};
use std::iter::once;
use unicode_joining_type::{JoiningType, get_joining_type};
use unicode_normalization::UnicodeNormalization;
use unicode_normalization::char::{canonical_combining_class, decompose_canonical};

/// Features that a glyph asks for by its suffix, besides `ss01`…`ss20` and `cv01`…`cv99`.
const BY_SUFFIX: &[&str] = &[
    "aalt", "c2pc", "c2sc", "calt", "case", "dlig", "dnom", "hist", "lnum", "numr", "onum", "ordn",
    "ornm", "pcap", "pnum", "salt", "sinf", "smcp", "subs", "sups", "swsh", "titl", "tnum", "unic",
    "zero",
];

/// Features that ligatures alone ask for.
const OF_LIGATURES: &[&str] = &["clig", "hlig", "liga", "rlig"];

/// Features that go before all others: what joins, then capitals of all kinds, whose letters no ligature may have
/// taken, then ligatures.
const FIRST: &[&str] = &[
    "rlig", "c2pc", "c2sc", "case", "pcap", "smcp", "unic", "liga",
];

/// Letters of which the standard says that they join on both sides, and that most languages have at the ends of words
/// alone.
const ENDING: &str = "ىںٯ";

/// The feature text and what could not be made.
pub(super) fn text(drafts: &[Draft]) -> (String, Vec<Note>) {
    let glyphs = Glyphs::of(drafts);
    let mut out = language_systems(drafts);
    out += &glyphs.soft_dots();
    for form in Form::ALL {
        let single = glyphs.forms(form);
        let rules = Rules {
            single,
            ..Rules::default()
        };
        feature(&mut out, form.tag(), &rules);
    }
    let mut features = BTreeMap::new();
    let mut notes = glyphs.incomplete();
    notes.extend(glyphs.ligatures(&mut features));
    notes.extend(glyphs.alternates(&mut features));
    for &tag in FIRST {
        if let Some(rules) = features.remove(tag) {
            feature(&mut out, tag, &rules);
        }
    }
    for (tag, rules) in features {
        feature(&mut out, &tag, &rules);
    }
    (out, notes)
}

/// Substitutions of a feature, ligatures first: what they take are glyphs without its suffix.
#[derive(Default)]
struct Rules {
    /// Ligatures of letters that join, whose marks stand between them.
    joining: Vec<String>,
    ligatures: Vec<String>,
    single: Vec<String>,
}

/// Features by their tags.
type Features = BTreeMap<String, Rules>;

fn feature(out: &mut String, tag: &str, rules: &Rules) {
    let text =
        |rules: &[String]| -> String { rules.iter().map(|r| format!("    sub {r};\n")).collect() };
    let mut body = text(&rules.ligatures) + &text(&rules.single);
    if !rules.joining.is_empty() {
        let all = if body.is_empty() {
            ""
        } else {
            "    lookupflag 0;\n"
        };
        body = format!(
            "    lookupflag IgnoreMarks;\n{}{all}{body}",
            text(&rules.joining)
        );
    }
    if !body.is_empty() {
        *out += &format!("\nfeature {tag} {{\n{body}}} {tag};\n");
    }
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

/// The letters of a ligature: its name's parts, or those of the one character that it has: ﬁ, ﷲ.
fn letters(draft: &Draft) -> Option<Vec<char>> {
    match draft.id.chars[..] {
        [c @ ('ﬀ'..='ﬄ' | 'ﬆ' | '\u{FDF0}'..='\u{FDF9}' | '\u{FDFC}')] => {
            Some(once(c).nfkc().collect())
        }
        [_, _, ..] => Some(draft.id.chars.clone()),
        _ => None,
    }
}

/// Whether a character joins the one after it.
fn joins_next(c: char) -> bool {
    use JoiningType as J;
    matches!(
        get_joining_type(c),
        J::DualJoining | J::LeftJoining | J::JoinCausing
    )
}

/// Whether a character joins the one before it.
fn joins_last(c: char) -> bool {
    use JoiningType as J;
    matches!(
        get_joining_type(c),
        J::DualJoining | J::RightJoining | J::JoinCausing
    )
}

/// The form that each letter of a ligature has where the ligature as a whole has a form; the letter at an end that
/// cannot join as the form says.
fn forms(chars: &[char], whole: Form) -> Result<Vec<Form>, char> {
    let is_mark = |c: char| get_joining_type(c) == JoiningType::Transparent;
    let letters: Vec<char> = chars.iter().copied().filter(|c| !is_mark(*c)).collect();
    let first = letters
        .first()
        .filter(|c| whole.joins_before() && !joins_last(**c));
    let last = letters
        .last()
        .filter(|c| whole.joins_after() && !joins_next(**c));
    if let Some(&end) = first.or(last) {
        return Err(end);
    }
    let between = letters
        .windows(2)
        .map(|pair| joins_next(pair[0]) && joins_last(pair[1]));
    let joints = once(whole.joins_before())
        .chain(between)
        .chain([whole.joins_after()]);
    let joints: Vec<bool> = joints.collect();
    let mut forms = joints.windows(2).map(|sides| match sides {
        [true, true] => Form::Medi,
        [true, _] => Form::Fina,
        [_, true] => Form::Init,
        _ => Form::Isol,
    });
    let form = |&c: &char| if is_mark(c) { None } else { forms.next() };
    Ok(chars
        .iter()
        .map(form)
        .map(Option::unwrap_or_default)
        .collect())
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

    /// i, j and į without their dots under a mark above, as the standard asks; marks below may stand between.
    fn soft_dots(&self) -> String {
        let is_above = |c: char| canonical_combining_class(c) == 230 && !is_arabic(c);
        let above = self.encoded.iter().filter(|e| is_above(*e.0));
        let above: Vec<&str> = above.map(|e| *e.1).collect();
        let above = format!("[{}]", above.join(" "));
        let dotless = |(&c, from): (&char, &&'a str)| {
            let mut parts = Vec::new();
            decompose_canonical(c, |part| parts.push(part));
            let (first, signs) = parts.split_first()?;
            let bare = match first {
                'i' => 'ı',
                'j' => 'ȷ',
                _ => return None,
            };
            if signs.iter().any(|c| is_above(*c)) {
                return None;
            }
            let to = once(&bare).chain(signs);
            let to = to.map(|c| self.encoded.get(c).copied());
            Some((*from, to.collect::<Option<Vec<&str>>>()?))
        };
        let rules: Vec<(&str, Vec<&str>)> = self.encoded.iter().filter_map(dotless).collect();
        if above == "[]" || rules.is_empty() {
            return String::new();
        }
        let (mut parted, mut body) = (String::new(), String::new());
        for (from, to) in rules {
            if let [to] = to[..] {
                body += &format!("    sub {from}' {above} by {to};\n");
            } else {
                parted += &format!("    sub {from} by {};\n", to.join(" "));
                body += &format!("    sub {from}' lookup parted {above};\n");
            }
        }
        if !parted.is_empty() {
            parted = format!("\nlookup parted {{\n{parted}}} parted;\n");
        }
        format!(
            "{parted}\nfeature ccmp {{\n    lookupflag UseMarkFilteringSet {above};\n{body}}} ccmp;\n"
        )
    }

    /// Letters of which some joining forms are there and others are not.
    fn incomplete(&self) -> Vec<Note> {
        let note = |c: char| {
            if get_joining_type(c) != JoiningType::DualJoining {
                return None;
            }
            let all = [Form::Init, Form::Medi, Form::Fina].into_iter();
            let (has, lacks): (Vec<Form>, Vec<Form>) =
                all.partition(|&f| self.formed.contains_key(&(c, f)));
            let is_ending = has == [Form::Fina] && ENDING.contains(c);
            let list = |forms: &[Form]| {
                let tags: Vec<String> = forms.iter().map(|f| format!(".{}", f.tag())).collect();
                tags.join(" and ")
            };
            (!has.is_empty() && !lacks.is_empty() && !is_ending).then(|| Note {
                glyph: names::name_of(&[c]),
                message: format!(
                    "it has {} but no {}: there it stands unjoined within words; draw what is missing",
                    list(&has),
                    list(&lacks)
                ),
            })
        };
        let letters: BTreeSet<char> = self.formed.keys().map(|k| k.0).collect();
        letters.into_iter().filter_map(note).collect()
    }

    /// Adds the ligatures without suffix: `rlig` (joining scripts) and `liga` (others). Tells those that nothing
    /// makes.
    fn ligatures(&self, features: &mut Features) -> Vec<Note> {
        let plain = || {
            self.drafts
                .iter()
                .filter(|d| d.id.alternates().next().is_none())
        };
        let mut notes = Vec::new();
        for draft in plain() {
            let Some(letters) = letters(draft) else {
                continue;
            };
            let is_encoded = draft.id.chars != letters;
            if is_encoded && plain().any(|d| d.id.chars == letters) {
                continue;
            }
            let tag = if is_joining(&letters) { "rlig" } else { "liga" };
            match self.ligature(draft, &letters, features.entry(tag.to_owned()).or_default()) {
                // it has a character of its own
                Err(_) if is_encoded => {}
                made => notes.extend(made.err()),
            }
        }
        notes
    }

    /// Adds the rule that makes a ligature of its letters.
    fn ligature(&self, draft: &Draft, letters: &[char], rules: &mut Rules) -> Result<(), Note> {
        let never = |why: String| Note {
            glyph: draft.id.name.to_string(),
            message: format!("the ligature is never used: {why}"),
        };
        let form = draft.id.form().unwrap_or_default();
        let forms = forms(letters, form).map_err(|end| {
            never(format!(
                "{end} does not join as .{} says; correct the suffix",
                form.tag()
            ))
        })?;
        let part = |(&c, form): (&char, Form)| {
            let found = self.formed.get(&(c, form)).or_else(|| self.encoded.get(&c));
            found.copied().ok_or(c)
        };
        let parts: Result<Vec<&str>, char> = letters.iter().zip(forms).map(part).collect();
        let parts = parts.map_err(|missing| {
            never(format!(
                "the font has no glyph for its part {missing} (U+{:04X}); draw it or skip the ligature",
                u32::from(missing)
            ))
        })?;
        let rules = if is_joining(letters) {
            &mut rules.joining
        } else {
            &mut rules.ligatures
        };
        rules.push(format!("{} by {}", parts.join(" "), draft.id.name));
        Ok(())
    }

    /// Adds the glyphs that carry a feature's tag as a suffix. Tells those that no feature uses.
    fn alternates(&self, features: &mut Features) -> Vec<Note> {
        let mut notes = Vec::new();
        for draft in self.drafts {
            let suffixes: Vec<&str> = draft.id.alternates().collect();
            let mut is_used = suffixes.is_empty();
            for tag in suffixes.iter().filter(|s| is_tag(s)) {
                if let Some(from) = self.without(draft, tag) {
                    let rule = format!("{} by {}", from.id.name, draft.id.name);
                    features
                        .entry((*tag).to_owned())
                        .or_default()
                        .single
                        .push(rule);
                    is_used = true;
                }
            }
            if is_used {
                continue;
            }
            let made = match (&suffixes[..], letters(draft)) {
                ([tag], Some(letters)) if self.makes(draft, tag) => self.ligature(
                    draft,
                    &letters,
                    features.entry((*tag).to_owned()).or_default(),
                ),
                _ => Err(unused(draft)),
            };
            notes.extend(made.err());
        }
        notes
    }

    /// The glyph that has the same name but for one suffix.
    fn without(&self, draft: &Draft, suffix: &str) -> Option<&'a Draft> {
        let rest = || draft.id.suffixes.iter().filter(|s| *s != suffix);
        let mut all = self.drafts.iter();
        all.find(|d| d.id.chars == draft.id.chars && d.id.suffixes.iter().eq(rest()))
    }

    /// Whether a feature makes a ligature that has no glyph without that suffix.
    fn makes(&self, draft: &Draft, suffix: &str) -> bool {
        (is_tag(suffix) || OF_LIGATURES.contains(&suffix)) && self.without(draft, suffix).is_none()
    }
}

/// Why no feature uses an alternate.
fn unused(draft: &Draft) -> Note {
    let message = if let Some(unknown) = draft.id.alternates().find(|s| !is_tag(s)) {
        let forms = Form::ALL.iter().map(|f| f.tag());
        let meant = nearest::suffix(unknown, forms.chain(BY_SUFFIX.iter().copied()));
        let meant = meant.map_or(String::new(), |near| format!("; did you mean {near}?"));
        format!(
            "khatt makes no feature of it: “.{unknown}” is no joining form and no feature that replaces single glyphs{meant}"
        )
    } else {
        let tag = draft.id.alternates().next().unwrap_or_default();
        format!(
            "the alternate is never used: the font has no glyph that {tag} could replace by it; draw that"
        )
    };
    Note {
        glyph: draft.id.name.to_string(),
        message,
    }
}

/// Whether any of these characters changes its form beside its neighbours.
fn is_joining(chars: &[char]) -> bool {
    use JoiningType as J;
    let joins = |c: &char| {
        matches!(
            get_joining_type(*c),
            J::DualJoining | J::RightJoining | J::LeftJoining
        )
    };
    chars.iter().any(joins)
}

fn is_tag(suffix: &str) -> bool {
    let numbered = suffix
        .strip_prefix("ss")
        .or_else(|| suffix.strip_prefix("cv"));
    let number = numbered.and_then(|n| (n.len() == 2).then(|| n.parse::<u8>().ok()).flatten());
    let limit = if suffix.starts_with("ss") { 20 } else { 99 };
    number.is_some_and(|n| (1..=limit).contains(&n)) || BY_SUFFIX.contains(&suffix)
}
