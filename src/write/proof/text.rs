//! Text set in the font: lines that it can set, a waterfall, and a place to type.

use super::Entry;
use maud::{Markup, html};
use std::collections::BTreeSet;
use unicode_bidi::{BidiClass, bidi_class};

/// Lines that show letters beside each other. Words with letters that the font lacks are left out.
const LINES: &[&str] = &[
    "The quick brown fox jumps over the lazy dog",
    "SPHINX OF BLACK QUARTZ JUDGE MY VOW",
    "Hamburgefonstiv nonihilo minimum 0123456789",
    "بسم الله الرحمن الرحيم لا إله إلا الله",
    "نص حكيم له سر قاطع وذو شأن عظيم مكتوب على ثوب أخضر ومغلف بجلد أزرق",
];

/// Sizes of the waterfall, CSS px.
const SIZES: &[u16] = &[12, 16, 20, 28, 40, 56, 80];

/// The language tag of a text by its first letter: Arabic joins and runs right to left.
pub(super) fn language(text: &str) -> &'static str {
    if is_arabic(text) { "ar" } else { "en" }
}

fn is_arabic(text: &str) -> bool {
    text.chars().any(|c| bidi_class(c) == BidiClass::AL)
}

fn direction(text: &str) -> &'static str {
    if is_arabic(text) { "rtl" } else { "ltr" }
}

/// The lines that the font can set, without the words that it cannot.
fn lines(known: &BTreeSet<char>) -> Vec<String> {
    let whole = |word: &&str| word.chars().all(|c| known.contains(&c));
    let cut = LINES.iter().map(|line| {
        let words: Vec<&str> = line.split(' ').filter(whole).collect();
        words.join(" ")
    });
    cut.filter(|line| !line.is_empty()).collect()
}

/// Every character of the font once, in order of first appearance.
fn every_character(entries: &[Entry]) -> String {
    let mut seen = BTreeSet::new();
    let chars = entries.iter().flat_map(|e| e.text.chars());
    let each: Vec<String> = chars
        .filter(|&c| seen.insert(c))
        .map(String::from)
        .collect();
    each.join(" ")
}

pub(super) fn specimen(entries: &[Entry], known: &BTreeSet<char>) -> Markup {
    let mut lines = lines(known);
    if lines.is_empty() {
        lines.push(every_character(entries));
    }
    let first = lines.first().cloned().unwrap_or_default();
    html! {
        section #specimen {
            @for line in &lines {
                p.set dir=(direction(line)) lang=(language(line)) { (line) }
            }
            p.typed.set id="typed" contenteditable="plaintext-only" spellcheck="false" dir="auto"
                title="Type your own text here" { (first) }
            div #waterfall {
                @for size in SIZES {
                    p dir=(direction(&first)) lang=(language(&first)) {
                        small { (size) } " " span style=(format!("font-size:{size}px")) { (first) }
                    }
                }
            }
        }
    }
}
