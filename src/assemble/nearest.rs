//! The known glyph name that differs least from an unknown one.

use crate::types::characters;
use read_fonts::ps::agl;
use std::sync::LazyLock;

/// The letters that a changed name may take.
const ALPHABET: &str = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-";

/// The Adobe Glyph List names few characters beyond: East Asian ones and dingbats.
const LAST_NAMED: u32 = 0x2300;

/// No list has a longer name, its script's suffix included.
const LONGEST: usize = 40;

/// The names of the Adobe Glyph List: finding them takes longer than a search among them.
static LISTED: LazyLock<Vec<String>> = LazyLock::new(|| {
    let names = (0x20..LAST_NAMED).filter_map(|code| {
        let mut buffer = [0; agl::MAX_NAME_LEN + 1];
        agl::char_to_name(code, &mut buffer).map(str::to_owned)
    });
    names.collect()
});

/// The nearest known name: one edit or a script's suffix away among all names, or up to a third of
/// its letters away among those of the Adobe Glyph List.
pub(super) fn name(base: &str) -> Option<String> {
    // names are ASCII: what is not has none near it
    if base.len() > LONGEST || !base.is_ascii() {
        return None;
    }
    let known = |n: &String| characters::of(n).is_some();
    let mut close = with_script(base).chain(edits(base)).filter(known);
    close.next().or_else(|| listed(base))
}

/// The name with the suffixes that friendly names carry.
fn with_script(base: &str) -> impl Iterator<Item = String> {
    ["-ar", "-farsi", "-hb", "-cy"]
        .into_iter()
        .map(move |script| format!("{base}{script}"))
}

/// All names that are one letter too many, too few, wrong or swapped away.
fn edits(base: &str) -> impl Iterator<Item = String> {
    let letters: Vec<char> = base.chars().collect();
    let n = letters.len();
    let splice = move |at: usize, cut: usize, put: &[char]| -> String {
        let (head, tail) = letters.split_at(at.min(letters.len()));
        let rest = tail.get(cut..).unwrap_or_default();
        head.iter().chain(put).chain(rest).collect()
    };
    let swapped: Vec<String> = base
        .char_indices()
        .zip(base.char_indices().skip(1))
        .map(|((i, a), (j, b))| format!("{}{b}{a}{}", &base[..i], &base[j + b.len_utf8()..]))
        .collect();
    let dropped: Vec<String> = (0..n).map(|i| splice(i, 1, &[])).collect();
    let changed = (0..=n).flat_map(move |i| {
        let splice = splice.clone();
        ALPHABET
            .chars()
            .flat_map(move |c| [splice(i, 1, &[c]), splice(i, 0, &[c])])
    });
    dropped.into_iter().chain(swapped).chain(changed)
}

/// The nearest name of the Adobe Glyph List within a third of the letters.
fn listed(base: &str) -> Option<String> {
    let allowed = base.chars().count() / 3;
    let as_long = LISTED.iter();
    let as_long = as_long.filter(|n| n.len().abs_diff(base.len()) <= allowed);
    let near = as_long.map(|n| (strsim::levenshtein(base, n), n));
    let near = near.filter(|(d, _)| *d <= allowed).min();
    near.map(|(_, n)| n.clone())
}

/// The known suffixes that differ least from an unknown one, by one letter at most, as a message names them.
pub(super) fn suffix(unknown: &str, known: impl Iterator<Item = &'static str>) -> Option<String> {
    let lower = unknown.to_lowercase();
    let near = known.filter(|k| strsim::levenshtein(k, &lower) <= 1);
    near.map(|k| format!("“.{k}”"))
        .reduce(|all, k| format!("{all} or {k}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_name_is_near_to_a_long_one() {
        assert_eq!(name(&"x".repeat(1_000_000)), None);
        assert_eq!(name("alef\u{FFFD}"), None, "names are ASCII");
    }

    #[test]
    fn near_names() {
        assert_eq!(name("semicoln").as_deref(), Some("semicolon"));
        assert_eq!(name("alf-ar").as_deref(), Some("alef-ar"));
        assert_eq!(name("zzzzzzzz"), None);
    }
}
