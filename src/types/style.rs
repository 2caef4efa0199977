//! What names of styles say, in English and in Arabic script: weights, and names for PostScript.

use unicode_normalization::UnicodeNormalization;

/// Weight classes and what they are called, in English first.
const WEIGHTS: [(u16, &[&str]); 10] = [
    (100, &["Thin", "Hairline", "رفيع", "نازک"]),
    (200, &["ExtraLight", "UltraLight"]),
    (300, &["Light", "خفيف", "سبک"]),
    (400, &["Regular", "Normal", "عادي", "عادی", "معمولی"]),
    (500, &["Medium", "متوسط"]),
    (600, &["SemiBold", "DemiBold"]),
    (700, &["Bold", "عريض", "عریض", "غامق", "ضخیم"]),
    (800, &["ExtraBold", "UltraBold"]),
    (900, &["Black", "Heavy", "أسود", "سیاه"]),
    (950, &["ExtraBlack", "UltraBlack"]),
];

/// What slanted styles are called.
const ITALIC: [&str; 4] = ["Italic", "Oblique", "مائل", "مایل"];

/// The weight class that a style's name says: 700 for `Bold`, `Semi-Bold Italic` says 600.
pub(crate) fn weight(style: &str) -> Option<u16> {
    let words: Vec<&str> = style
        .split(|c: char| c.is_whitespace() || c == '-')
        .collect();
    let pairs = words.windows(2).map(|pair| pair.concat());
    let singles = words.iter().map(|word| (*word).to_owned());
    pairs
        .chain(singles)
        .find_map(|word| known(&word))
        .map(|w| w.0)
}

/// The weight that a word names, alone or with a slant written to it: `BoldItalic`.
fn known(word: &str) -> Option<(u16, &'static str)> {
    let word = word.to_lowercase();
    let slant = ["italic", "oblique"].map(|slant| word.strip_suffix(slant));
    let upright = slant.into_iter().flatten().next().unwrap_or(&word);
    let is = |names: &[&str]| names.iter().any(|name| name.to_lowercase() == upright);
    let found = WEIGHTS.into_iter().find(|(_, names)| is(names));
    found.map(|(weight, names)| (weight, names[0]))
}

/// A family's or a style's name as part of a PostScript name: printable ASCII without brackets, slashes, percent,
/// hyphen and space. Known words of another script are those in English, others are spelled by their characters.
pub(crate) fn postscript(name: &str) -> String {
    let latin: String = name.nfd().filter(|c| is_legal(*c) && *c != '-').collect();
    if !latin.is_empty() {
        return latin;
    }
    let spelled = |word: &str| -> String {
        let letters = word.chars().filter(|c| c.is_alphanumeric());
        letters.map(|c| format!("u{:04X}", u32::from(c))).collect()
    };
    let word = |word: &str| match known(word) {
        Some((_, english)) => english.to_owned(),
        None if ITALIC.contains(&word) => ITALIC[0].to_owned(),
        None => spelled(word),
    };
    name.split_whitespace().map(word).collect()
}

/// Whether a text can be a PostScript name as a whole.
pub(crate) fn is_postscript(name: &str) -> bool {
    (1..=LONGEST).contains(&name.len()) && name.chars().all(is_legal)
}

/// Characters of a PostScript name, at most.
pub(crate) const LONGEST: usize = 63;

fn is_legal(c: char) -> bool {
    c.is_ascii_graphic() && !"[](){}<>/%".contains(c)
}
