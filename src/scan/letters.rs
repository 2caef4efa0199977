//! What a label tells about where its letter stands and how high it is.

use crate::types::characters::spelled;
use crate::types::{Form, Label};
use std::ops::RangeInclusive;
use unicode_normalization::UnicodeNormalization;
use unicode_normalization::char::canonical_combining_class;

/// Letters with a flat foot on the baseline, and the figures that never hang.
const FLAT: &str = "12ABDEFHIKLMNPRTXYZfhiklmnrxzΑΒΓΔΕΗΙΚΛΜΝΠΡΤΧАБВГЕЖИКЛМНПРТХЧШгикмнптхчш";
/// Letters, figures and signs whose foot is a bow, a dot or a point that dips below the baseline a little.
const ROUND: &str = "068&!?CGOSUVWabcdeostuvwΘΟΩОСЭЮасеов";
/// Capitals with a flat head.
const CAP_HEADS: &str = "BDEFHIKLMNPRTXYZΒΓΕΖΗΙΚΜΝΠΡΤΥΧБВГЕЖИКМНПРТХЧШ";
/// Capitals with a bow above.
const CAP_BOWS: &str = "COSGQΘΟΩОСЭ";
/// Small letters with a flat head at x-height.
const X_HEADS: &str = "xzvwuгикмнптхчш";
/// Small letters with a bow at x-height.
const X_BOWS: &str = "acemnorsасео";
/// Arabic letters whose body stands on the line when nothing follows.
const ARABIC_STANDING: &str = "اأإآٱدذڈهةطظ";
/// Arabic letters that end in a bowl which dips below the line when nothing follows.
const ARABIC_BOWLS: &str = "بتثپٹفكکگ";
/// Arabic letters that do not stand on the line though something follows.
const ARABIC_HANGING: &str = "جحخچم";

/// Letters that a pen draws in one piece.
const ONE_PIECE: &str = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghklmnopqrstuvwxyz0123456789\
    &ÆØŒÞĐĦŁŦßæðøœþđħıłŧ\
    ΑΒΓΔΕΗΙΚΛΜΝΟΠΡΤΥΦΧΨΩАБВГДЕЖЗИКЛМНОПРСТУФХЦЧШЭЮЯабвгдежзиклмнопрстуфхцчшэюя\
    ءاحدرسصطعلمهوىٮٯڡںھہے";
/// Letters with a dot above, dots, or another small sign.
const DOT_ABOVE: &str = "ijةتثخذزشضظغفقنٹٺٿڈڌڎڏڐڑڒڗژڙڞڟڠڤڦڧڨڬڭڴڱڵڷڻڽۆۇۈۉۋ";
/// Letters and signs with a dot below or dots.
const DOT_BELOW: &str = "!?؟بجيپچٻڀڃڄڇڍڊڔڕڝڢڣڥڮڳڸې";

/// Letters with dots below where something follows, and none where nothing does.
const DOTS_BEFORE: &str = "ی";

/// Letters with signs above and below.
const SIGNS: &str = "ڜێ";

/// Letters with one dot, two and three, and no other sign.
const DOTS: [&str; 3] = ["ij!?؟بجخذزضظغفن", "تةقيی", "ثشپچژڤ"];

/// Lam-alef, the ligature without a sign.
const LAM_ALEF: [char; 2] = ['ل', 'ا'];

/// Letters that differ by their signs alone, and so stand alike.
const BODIES: [&str; 17] = [
    "اأإآٱ",
    "بتثپٹ",
    "جحخچ",
    "دذڈ",
    "رزژڑ",
    "سش",
    "صض",
    "طظ",
    "عغ",
    "فڤ",
    "ق",
    "كکگ",
    "ل",
    "م",
    "هة",
    "وؤۆۇۈۋ",
    "يىئی",
];

/// Letters that have a sign within their box where nothing follows, in some styles.
const SIGN_WITHIN: &str = "كک";

/// Letters that hang below the baseline.
const TAILED: &str = "gjpqyрф";
/// Letters with most of their ink on the left, the right, above and below the middle. The bows of B, D and R weigh
/// more than their stems in slanted styles.
const LEFT: &str = "EFKLPbhkpГЕБКРЬ";
const RIGHT: &str = "Jdq";
const TOP: &str = "FPTVYpqy79ТРГУр";
const BOTTOM: &str = "ALbdh6ЬЛД";

/// The pieces that a letter is drawn in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Pieces {
    /// One.
    One,
    /// A body and dots above it.
    DotAbove,
    /// A body and dots below it.
    DotBelow,
    /// A letter and a mark, or several.
    Marked,
    /// A body, and a sign within its box.
    Within,
    /// The same, but most styles have no sign.
    Bare,
    /// Nobody knows.
    Unknown,
}

/// On which side of its body a letter has its dots or its mark.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    /// Above it alone.
    Above,
    /// Below it alone.
    Below,
}

/// What letters are told apart by when they are measured together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// Arabic: dots and marks stand off the body and may lie below it.
    Arabic,
    /// A small letter.
    Small,
    /// A capital.
    Capital,
    /// A figure.
    Figure,
    /// All else.
    Other,
}

/// How a letter meets the baseline.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Foot {
    /// Ends on it.
    Flat,
    /// Passes it by an overshoot.
    Round,
    /// Hangs far below it.
    Tail,
    /// Ends somewhere else.
    None,
}

/// A height that is the same for many letters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Head {
    Cap,
    CapBow,
    X,
    XBow,
    Alef,
    None,
}

/// What is known about a letter from its label.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Shape {
    pub(super) foot: Foot,
    pub(super) head: Head,
    pub(super) kind: Kind,
    pub(super) pieces: Pieces,
    /// Where its dots or its mark are, if all are on one side.
    pub(super) side: Option<Side>,
    /// How many dots it has, where it has no other sign.
    pub(super) dots: usize,
    /// It has dots or a sign below.
    pub(super) below: bool,
    /// The same number for Arabic letters in the same form that differ by their signs alone.
    pub(super) body: Option<usize>,
    /// Whether a stroke joins it to a letter on its left, and on its right.
    pub(super) joined: [bool; 2],
    /// It is as large as most letters are.
    pub(super) full: bool,
    /// Where most of its ink is: 1 to the right and 1 down, −1 the other way, 0 where hands differ.
    pub(super) heavy: [i8; 2],
}

impl Shape {
    pub(super) fn of(label: &Label) -> Self {
        let said = spelled(label.0.trim()).unwrap_or_default();
        let form = said.form().unwrap_or(Form::Isol);
        let letter = Some(&said.chars).filter(|c| c.len() == 1).map(|c| c[0]);
        let ligature = said.chars == LAM_ALEF;
        let base = letter.and_then(|c| c.nfd().next());
        let any = |c: Option<char>, set: &str| c.is_some_and(|c| set.contains(c));
        let plain = base == letter;
        let pieces = match () {
            () if letter.is_some() && !plain || any(base, SIGNS) => Pieces::Marked,
            () if any(base, SIGN_WITHIN) && form.joins_after() => Pieces::Bare,
            () if any(base, DOTS_BEFORE) && form.joins_after() => Pieces::DotBelow,
            () if any(base, SIGN_WITHIN) => Pieces::Within,
            () if ligature || any(base, ONE_PIECE) || any(base, DOTS_BEFORE) => Pieces::One,
            () if any(base, DOT_ABOVE) => Pieces::DotAbove,
            () if any(base, DOT_BELOW) => Pieces::DotBelow,
            () => Pieces::Unknown,
        };
        let dotted = plain && pieces != Pieces::One;
        let dots = (1..).zip(DOTS).find(|(_, set)| dotted && any(base, set));
        let dots = dots.map_or(0, |d| d.0);
        let signs = match pieces {
            Pieces::DotAbove => Some(Side::Above),
            Pieces::DotBelow => Some(Side::Below),
            Pieces::Marked => letter.and_then(side_of_marks),
            _ => None,
        };
        let below = signs == Some(Side::Below) || any(base, SIGNS);
        let full = letter.is_some_and(super::is_full);
        let side = |less: &str, more: &str| {
            i8::from(plain && any(base, more)) - i8::from(plain && any(base, less))
        };
        let heavy = [side(LEFT, RIGHT), side(TOP, BOTTOM)];
        let arabic = letter.is_some_and(|c| ('\u{600}'..'\u{700}').contains(&c));
        let sides = [form.joins_after(), form.joins_before()];
        let joined = sides.map(|side| (arabic || ligature) && side);
        let body = BODIES.iter().position(|set| arabic && any(letter, set));
        let place = Form::ALL.iter().position(|f| *f == form);
        let foot = match () {
            () if arabic && joined[0] && any(letter, ARABIC_HANGING) => Foot::None,
            () if arabic && (joined[0] || any(letter, ARABIC_STANDING)) => Foot::Flat,
            () if arabic && any(letter, ARABIC_BOWLS) => Foot::Round,
            () if arabic => Foot::None,
            () if any(base, FLAT) => Foot::Flat,
            () if any(base, ROUND) => Foot::Round,
            () if plain && any(base, TAILED) => Foot::Tail,
            () => Foot::None,
        };
        let heads = [
            ("ا", Head::Alef),
            (CAP_HEADS, Head::Cap),
            (CAP_BOWS, Head::CapBow),
            (X_HEADS, Head::X),
            (X_BOWS, Head::XBow),
        ];
        let head = heads.iter().find(|(set, _)| plain && any(base, set));
        Self {
            below,
            body: body.zip(place).map(|(b, f)| b * Form::ALL.len() + f),
            foot,
            head: head.map_or(Head::None, |h| h.1),
            kind: match letter {
                Some(_) if arabic => Kind::Arabic,
                Some(c) if c.is_lowercase() => Kind::Small,
                Some(c) if c.is_uppercase() => Kind::Capital,
                Some(c) if c.is_ascii_digit() => Kind::Figure,
                _ => Kind::Other,
            },
            pieces,
            side: signs,
            dots,
            joined,
            full,
            heavy,
        }
    }
}

impl Shape {
    /// How many pieces its letter has, as far as its name tells.
    pub(super) fn parts(&self) -> usize {
        match self.pieces {
            Pieces::One | Pieces::Bare | Pieces::Unknown => 1,
            _ => 1 + self.dots.max(1),
        }
    }

    /// In how many pieces its letter is drawn, from dots that run together to dots apart; `None` where its name does
    /// not tell.
    fn drawn(&self) -> Option<RangeInclusive<usize>> {
        match self.pieces {
            Pieces::One => Some(1..=1),
            Pieces::DotAbove | Pieces::DotBelow if self.dots > 0 => Some(2..=1 + self.dots),
            _ => None,
        }
    }

    /// The same number for Arabic letters that differ by their signs and forms alone.
    pub(super) fn skeleton(&self) -> Option<usize> {
        self.body.map(|b| b / Form::ALL.len())
    }
}

/// In how many pieces the letter of a label is drawn; `None` where the label does not tell.
pub(crate) fn pieces(label: &Label) -> Option<RangeInclusive<usize>> {
    Shape::of(label).drawn()
}

/// On which side the marks of a letter lie, as Unicode parts them from it; `None` where there are none, or on both, or
/// where the letter keeps a dot on the other side.
fn side_of_marks(letter: char) -> Option<Side> {
    let keeps_dot = letter.nfd().next().is_some_and(|c| DOT_ABOVE.contains(c));
    let side = |mark| match canonical_combining_class(mark) {
        202 | 220 if !keeps_dot => Some(Side::Below),
        230 => Some(Side::Above),
        _ => None,
    };
    let sides: Vec<Option<Side>> = letter.nfd().skip(1).map(side).collect();
    let first = *sides.first()?;
    first.filter(|_| sides.iter().all(|s| *s == first))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_tell_on_which_side_dots_and_marks_are() {
        let of = |s: &str| Shape::of(&Label(s.to_owned())).side;
        for label in ["i", "uni0646.fina", "أ", "ئ.init", "é", "ǘ", "ĵ"] {
            assert_eq!(of(label), Some(Side::Above), "{label}");
        }
        for label in ["ب", "jeem-ar.medi", "إ", "ç", "ạ", "question"] {
            assert_eq!(of(label), Some(Side::Below), "{label}");
        }
        for label in ["ị", "ậ", "ڜ", "ك", "l", "uni06440627", "x.alt"] {
            assert_eq!(of(label), None, "{label}");
        }
    }

    #[test]
    fn labels_tell_in_how_many_pieces_letters_are() {
        let of = |s: &str| pieces(&Label(s.to_owned()));
        assert_eq!(of("l"), Some(1..=1));
        assert_eq!(of("uni06CC.fina"), Some(1..=1));
        assert_eq!(of("uni06CC.medi"), Some(2..=3));
        assert_eq!(of("ش.init"), Some(2..=4));
        for label in ["é", "ك", "section", "ٹ"] {
            assert_eq!(of(label), None, "{label}");
        }
    }

    #[test]
    fn labels_tell_how_letters_stand() {
        let of = |s: &str| Shape::of(&Label(s.to_owned()));
        for (label, foot, head) in [
            ("H", Foot::Flat, Head::Cap),
            ("É", Foot::Flat, Head::None),
            ("one", Foot::Flat, Head::None),
            ("three", Foot::None, Head::None),
            ("g", Foot::Tail, Head::None),
            ("x", Foot::Flat, Head::X),
            ("uni0041", Foot::Flat, Head::None),
            ("beh-ar.init", Foot::Flat, Head::None),
            ("uni062C.medi", Foot::None, Head::None),
            ("uni0628.fina", Foot::Round, Head::None),
            ("Н", Foot::Flat, Head::Cap),
            ("alef-ar", Foot::Flat, Head::Alef),
            ("ب.fina", Foot::Round, Head::None),
            ("beh-ar.init.ss01", Foot::Flat, Head::None),
            ("ﺝ", Foot::None, Head::None),
            ("uniFE91", Foot::Flat, Head::None),
            (".notdef", Foot::None, Head::None),
        ] {
            let shape = of(label);
            assert_eq!(shape.foot, foot, "{label}");
            if label != "uni0041" {
                assert_eq!(shape.head, head, "{label}");
            }
        }
        assert_eq!(of("E").heavy, [-1, 0]);
        assert_eq!(of("D").heavy, [0, 0], "its bow weighs as much as its stem");
        let dots = ["uni0646.fina", "uni062A", "ñ"].map(|s| of(s).dots);
        assert_eq!(dots, [1, 2, 0]);
        assert_eq!(of("uni06440627.fina").pieces, Pieces::One);
        let joined = [
            "beh-ar.init",
            "uni0628.medi",
            "uni06440627.fina",
            "a.fina",
            "uniFE92",
            "beh-ar.init.ss01",
            "ﻼ",
        ];
        let sides = joined.map(|s| of(s).joined);
        assert_eq!(
            sides,
            [
                [true, false],
                [true, true],
                [false, true],
                [false, false],
                [true, true],
                [true, false],
                [false, true],
            ]
        );
    }
}
