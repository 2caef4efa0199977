//! What letters are made of: the skeleton (rasm) of an Arabic letter and its dots, the letter and the marks of
//! Unicode's canonical decompositions.
//!
//! Dots go by the characters that Unicode has for them in primers, U+FBB2…U+FBC1.

use crate::assemble::marks::Place;
use crate::types::Form;
use unicode_joining_type::{JoiningType, get_joining_type};
use unicode_normalization::char::{decompose_canonical, is_combining_mark};

/// What a letter is made of in one of its forms.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Recipe {
    /// Letters whose form of that kind serves as the body, best first.
    pub(super) bodies: Vec<char>,
    /// Dots, or combining marks from the letter outwards.
    pub(super) signs: Vec<char>,
}

/// Letter; bodies of its isolated and final form, and of the others, best first; its dots or mark.
const ARABIC: &[(char, &str, &str, &str)] = &[
    ('ب', "ٮ", "ٮںى", "\u{fbb3}"),
    ('ت', "ٮ", "ٮںى", "\u{fbb4}"),
    ('ث', "ٮ", "ٮںى", "\u{fbb6}"),
    ('پ', "ٮ", "ٮںى", "\u{fbb9}"),
    ('ٹ', "ٮ", "ٮںى", "\u{fbc0}"),
    ('ج', "ح", "ح", "\u{fbb3}"),
    ('خ', "ح", "ح", "\u{fbb2}"),
    ('چ', "ح", "ح", "\u{fbb9}"),
    ('ذ', "د", "", "\u{fbb2}"),
    ('ڈ', "د", "", "\u{fbc0}"),
    ('ز', "ر", "", "\u{fbb2}"),
    ('ژ', "ر", "", "\u{fbb6}"),
    ('ڑ', "ر", "", "\u{fbc0}"),
    ('ش', "س", "س", "\u{fbb6}"),
    ('ض', "ص", "ص", "\u{fbb2}"),
    ('ظ', "ط", "ط", "\u{fbb2}"),
    ('غ', "ع", "ع", "\u{fbb2}"),
    ('ف', "ڡ", "ڡٯ", "\u{fbb2}"),
    ('ڤ', "ڡ", "ڡٯ", "\u{fbb6}"),
    ('ق', "ٯ", "ڡٯ", "\u{fbb4}"),
    ('ك', "", "ک", ""),
    ('ک', "", "ك", ""),
    ('ن', "ں", "ٮںى", "\u{fbb2}"),
    ('ة', "ه", "", "\u{fbb4}"),
    ('ى', "ی", "", ""),
    ('ي', "ىی", "ٮںى", "\u{fbb5}"),
    ('ی', "ى", "ٮںى", "\u{fbb5}"),
    ('ئ', "ىی", "ٮںى", "\u{654}"),
    ('ۃ', "ہ", "", "\u{fbb4}"),
];

/// Farsi yeh has its dots inside words only.
const DOTLESS_ENDS: char = 'ی';

/// The sign that stands for a háček at the right of a tall letter: a comma above right.
pub(super) const BESIDE: char = '\u{315}';

/// Letters whose háček or cedilla is drawn as an apostrophe or a comma, and the sign that they look to have: their
/// decompositions do not say it.
const OTHERWISE: [(&str, char); 3] = [("ďťľĽ", BESIDE), ("ģ", '\u{312}'), ("ĢķĶļĻņŅŗŖ", '\u{326}')];

/// Accents and the signs of their own that show them, best first, where no decomposition says so.
pub(super) const SHOWN: [(char, char); 7] = [
    ('\u{300}', '`'),
    ('\u{302}', 'ˆ'),
    ('\u{30c}', 'ˇ'),
    (BESIDE, '’'),
    (BESIDE, ','),
    ('\u{312}', '‘'),
    ('\u{326}', ','),
];

/// The letters that each alphabet needs.
const ALPHABETS: [(&str, &str); 3] = [
    ("arabic", "ءآأؤإئابةتثجحخدذرزسشصضطظعغفقكلمنهوىي"),
    ("persian", "ءآأؤئابپتثجچحخدذرزژسشصضطظعغفقکگلمنهوی"),
    ("urdu", "ءآأؤئابپتٹثجچحخدڈذرڑزژسشصضطظعغفقکگلمنںوہھیےۂۃۓ"),
];

/// The alphabet that has far more letters than one language needs.
pub(super) const LATIN: &str = "latin";

/// Blocks whose letters are composed for it: Latin-1 to Extended-B, Extended Additional.
const LATIN_BLOCKS: [std::ops::RangeInclusive<u32>; 2] = [0xC0..=0x24F, 0x1E00..=0x1EFF];

/// The letters of an alphabet; none for a word that is no alphabet.
pub(super) fn alphabet(word: &str) -> Option<Vec<char>> {
    if word == LATIN {
        let all = LATIN_BLOCKS.into_iter().flatten();
        let composed = all.filter_map(char::from_u32);
        let composed = composed.filter(|c| decomposition(*c).is_some());
        let plain = ('A'..='Z').chain('a'..='z');
        return Some(plain.chain(composed).collect());
    }
    let (_, letters) = ALPHABETS.iter().find(|(name, _)| *name == word)?;
    Some(letters.chars().collect())
}

/// What a letter is made of in that form; none where nothing says so.
pub(super) fn recipe(letter: char, form: Form) -> Option<Recipe> {
    let Some((_, ends, middles, signs)) = ARABIC.iter().find(|row| row.0 == letter) else {
        return decomposition(letter);
    };
    let is_end = !form.joins_after();
    let dotless = is_end && letter == DOTLESS_ENDS;
    let bodies = if is_end { ends } else { middles };
    (!bodies.is_empty()).then(|| Recipe {
        bodies: bodies.chars().collect(),
        signs: signs.chars().filter(|_| !dotless).collect(),
    })
}

/// Letter and marks of a character by its full canonical decomposition.
fn decomposition(letter: char) -> Option<Recipe> {
    let mut parts = Vec::new();
    decompose_canonical(letter, |c| parts.push(c));
    let (body, signs) = parts.split_first()?;
    let marked = !signs.is_empty() && signs.iter().all(|&c| is_combining_mark(c));
    let looks = OTHERWISE.iter().find(|(all, _)| all.contains(letter));
    marked.then(|| Recipe {
        bodies: vec![*body],
        signs: looks.map_or_else(|| signs.to_vec(), |(_, sign)| vec![*sign]),
    })
}

/// The forms that a letter takes.
pub(super) fn forms(letter: char) -> &'static [Form] {
    match get_joining_type(letter) {
        JoiningType::DualJoining => &Form::ALL,
        JoiningType::RightJoining => &[Form::Isol, Form::Fina],
        _ => &[Form::Isol],
    }
}

/// Dots as Unicode has them for primers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Dots {
    /// Drawn ones that serve, best first.
    pub(super) drawn: &'static [char],
    /// Where single dots stand if none of these is drawn: places from the middle of the lowest row, in dots.
    pub(super) places: &'static [(f64, f64)],
    /// Whether they stand over or under the letter.
    pub(super) side: Place,
}

/// Height of a row of dots over the next, in dots: as far apart as two in a row.
const ROW: f64 = 0.87;

/// The dots of a symbol; none for other characters.
pub(super) const fn dots(symbol: char) -> Option<Dots> {
    const TWO: &[(f64, f64)] = &[(-0.5, 0.0), (0.5, 0.0)];
    const UP: &[(f64, f64)] = &[(-0.5, 0.0), (0.5, 0.0), (0.0, ROW)];
    const DOWN: &[(f64, f64)] = &[(0.0, 0.0), (-0.5, ROW), (0.5, ROW)];
    let (drawn, places): (&[char], &[(f64, f64)]) = match symbol {
        '\u{fbb2}' => (&['\u{fbb2}', '\u{fbb3}'], &[]),
        '\u{fbb3}' => (&['\u{fbb3}', '\u{fbb2}'], &[]),
        '\u{fbb4}' => (&['\u{fbb4}', '\u{fbb5}'], TWO),
        '\u{fbb5}' => (&['\u{fbb5}', '\u{fbb4}'], TWO),
        '\u{fbb6}' => (&['\u{fbb6}', '\u{fbb7}'], UP),
        '\u{fbb9}' => (&['\u{fbb9}', '\u{fbb8}', '\u{fbb7}'], DOWN),
        '\u{fbc0}' => (&['\u{fbc0}', '\u{fbc1}'], &[]),
        _ => return None,
    };
    let side = match symbol {
        '\u{fbb3}' | '\u{fbb5}' | '\u{fbb9}' => Place::Bottom,
        _ => Place::Top,
    };
    Some(Dots {
        drawn,
        places,
        side,
    })
}

/// The single dots, of which groups are made.
pub(super) const SINGLE: [char; 2] = ['\u{fbb2}', '\u{fbb3}'];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_sign_is_known_and_every_letter_has_other_letters_as_bodies() {
        assert_eq!(ARABIC.len(), 29);
        for &(letter, ends, middles, signs) in ARABIC {
            let known = |c: char| dots(c).is_some() || is_combining_mark(c);
            assert!(signs.chars().all(known), "{letter}");
            assert!(!format!("{ends}{middles}").contains(letter), "{letter}");
            let joins = forms(letter).len() == 4;
            assert_eq!(joins, !middles.is_empty() || letter == 'ى', "{letter}");
        }
    }

    #[test]
    fn decompositions_are_those_of_unicode() {
        let made = |c: char, form| recipe(c, form).map(|r| (r.bodies, r.signs));
        let table = [
            ('é', "e", "\u{301}"),
            ('ấ', "a", "\u{302}\u{301}"),
            ('ش', "س", "\u{fbb6}"),
            ('أ', "ا", "\u{654}"),
            ('ی', "ى", ""),
            ('ď', "d", "\u{315}"),
            ('ģ', "g", "\u{312}"),
            ('ķ', "k", "\u{326}"),
        ];
        for (c, bodies, signs) in table {
            let want = (bodies.chars().collect(), signs.chars().collect());
            assert_eq!(made(c, Form::Isol), Some(want), "{c}");
        }
        for c in ['e', 'س', 'گ', '!'] {
            assert_eq!(made(c, Form::Isol), None, "{c}");
        }
        let medial = recipe('ی', Form::Medi).map(|r| r.signs);
        assert_eq!(medial, Some(vec!['\u{fbb5}']));
    }

    #[test]
    fn alphabets() {
        for (name, letters) in [("arabic", 36), ("persian", 37), ("urdu", 46)] {
            assert_eq!(alphabet(name).map(|a| a.len()), Some(letters), "{name}");
        }
        assert!(alphabet("latin").is_some_and(|a| a.contains(&'é') && a.contains(&'ệ')));
        assert_eq!(alphabet("klingon"), None);
    }
}
