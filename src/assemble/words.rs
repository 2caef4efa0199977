//! Room learned from written words: what letters alone do not tell, how loosely a hand sets them.
//!
//! A written word falls into pieces: single letters, and in Arabic runs of joined ones. Between the bodies of two
//! neighbours, dots and accents left aside, lies a gap; the same gap follows from the room that the letters have so
//! far. What the gaps of a script differ by in the median goes half to each side of every letter, and what is
//! left of a gap to the two sides that make it, the more the oftener a side was written: the least squares of
//!
//! ```text
//! Σ (gap − own gap − usual − left(a) − right(b))² + λ Σ left² + λ Σ right²
//! ```
//!
//! A gap that is off by more than three times the median of all is left to itself: a slip, or a pair that was kerned.

use super::features::is_arabic;
use super::{Draft, Note, Side, compose};
use crate::numeric::median::median;
use crate::types::{Form, Outline};
use kurbo::{Rect, Shape, Vec2};
use nalgebra::{DMatrix, DVector};
use schemars::JsonSchema;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use unicode_joining_type::{JoiningType, get_joining_type};

/// Gaps of a script from which its room is learned.
const FEWEST: usize = 5;

/// λ: a side's own room is believed by half where it was written once.
const SHRINK: f64 = 1.0;

/// Gaps further from the usual than so many times the median distance do not count.
const SLIPS: f64 = 3.0;

/// An Arabic gap tells of room where it is no narrower than that part of two letters' own: tails and tops reach into
/// the others, and there hands and fonts kern.
const OPEN: f64 = 0.75;

/// By how much a written piece may be wider or narrower than its letters, part of its width, and em.
const WIDTH: (f64, f64) = (0.3, 0.05);

/// A word that someone wrote, in font units; where it stands does not matter.
#[derive(Debug, Clone, PartialEq)]
pub struct Word {
    /// What it says.
    pub text: String,
    /// Its contours.
    pub outline: Outline,
}

/// White between two neighbours in a written word, font units.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Gap {
    /// The word.
    pub word: String,
    /// The two letters' glyphs in reading order.
    pub between: [String; 2],
    /// As it was written, from body to body.
    pub written: f64,
    /// As the font sets it, kerning aside.
    pub set: f64,
}

/// Which way a letter's script is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Script {
    Rightward,
    Leftward,
}

impl Script {
    fn of(c: char) -> Self {
        if is_arabic(c) {
            Self::Leftward
        } else {
            Self::Rightward
        }
    }
}

/// A side of a draft, by its position.
type Edge = (usize, Side);

/// A gap and the sides that make it.
struct Measured {
    gap: Gap,
    sides: [Edge; 2],
    script: Script,
}

impl Measured {
    fn off(&self) -> f64 {
        self.gap.written - self.gap.set
    }
}

/// Gives every side that joins nothing the room that the words show, and measures their gaps again.
pub(super) fn learn(
    drafts: &mut [Draft],
    words: &[Word],
    side: f64,
    em: f64,
) -> (Vec<Gap>, Vec<Note>) {
    let mut notes = Vec::new();
    let mut measured = Vec::new();
    for word in words {
        match gaps(drafts, word, em) {
            Ok(found) => measured.extend(found),
            Err(message) => notes.push(Note {
                glyph: word.text.clone(),
                message,
            }),
        }
    }
    for script in [Script::Rightward, Script::Leftward] {
        let own: Vec<&Measured> = measured.iter().filter(|m| m.script == script).collect();
        if own.is_empty() {
            continue;
        }
        if own.len() < FEWEST {
            notes.push(Note {
                glyph: own.first().map_or_else(String::new, |m| m.gap.word.clone()),
                message: format!(
                    "the words have {} gaps of this script, too few to learn its room from: write {FEWEST} or more",
                    own.len()
                ),
            });
            continue;
        }
        let (usual, sides) = room(&own, side);
        for (i, draft) in drafts.iter_mut().enumerate() {
            let own = draft.id.chars.first().map(|c| Script::of(*c));
            if draft.is_mark() || own != Some(script) {
                continue;
            }
            let add = |side| 0.5 * usual + sides.get(&(i, side)).copied().unwrap_or(0.0);
            let [left, right] = [Side::Left, Side::Right]
                .map(|side| if is_free(draft, side) { add(side) } else { 0.0 });
            draft.shift(left);
            draft.advance = (draft.advance + left + right).max(0.0).round();
        }
    }
    let again = words.iter().filter_map(|word| gaps(drafts, word, em).ok());
    (again.flatten().map(|m| m.gap).collect(), notes)
}

/// Whether nobody has said where that end of the advance is.
fn is_free(draft: &Draft, side: Side) -> bool {
    let joint = match side {
        Side::Left => draft.joint.0,
        Side::Right => draft.joint.1,
    };
    joint.is_none() && draft.given.is_none()
}

/// What gaps want in the median, and what single sides want beyond half of it; from open gaps where they are enough.
/// `side` is the room of an Arabic letter without tail or top.
fn room(gaps: &[&Measured], side: f64) -> (f64, BTreeMap<Edge, f64>) {
    let is_open = |g: &Measured| g.script == Script::Rightward || g.gap.set >= OPEN * 2.0 * side;
    let open = gaps.iter().filter(|g| is_open(g)).count();
    let told = gaps.iter().filter(|g| open < FEWEST || is_open(g));
    let usual = median(told.clone().map(|g| g.off())).unwrap_or(0.0);
    let beyond = |g: &Measured| g.off() - usual;
    let most = SLIPS * median(told.clone().map(|g| beyond(g).abs())).unwrap_or(0.0);
    let close = told
        .map(|g| (&g.sides, beyond(g)))
        .filter(|g| g.1.abs() <= most);
    let close: Vec<(&[Edge; 2], f64)> = close.collect();
    let edges: BTreeSet<Edge> = close.iter().flat_map(|g| *g.0).collect();
    let places: BTreeMap<Edge, usize> = edges.iter().copied().zip(0..).collect();
    let mut normal = DMatrix::identity(places.len(), places.len()) * SHRINK;
    let mut right = DVector::zeros(places.len());
    for (sides, off) in close {
        let own = || sides.iter().filter_map(|s| places.get(s).copied());
        for i in own() {
            right[i] += off;
            own().for_each(|j| normal[(i, j)] += 1.0);
        }
    }
    let solved = normal.cholesky().map(|c| c.solve(&right));
    let own = solved
        .iter()
        .flat_map(|x| edges.iter().copied().zip(x.iter().copied()));
    (usual, own.collect())
}

/// The gaps of a written word beside those that its letters have.
///
/// # Errors
/// Its letters are not in the font, or it does not fall into their pieces.
fn gaps(drafts: &[Draft], word: &Word, em: f64) -> Result<Vec<Measured>, String> {
    let script = word
        .text
        .chars()
        .next()
        .map_or(Script::Rightward, Script::of);
    let pieces = pieces(drafts, &word.text)?;
    let mut written: Vec<Rect> = bodies(&word.outline);
    if written.len() < pieces.len() {
        return Err(format!(
            "the word was written in {} pieces where its letters make {}: what does not join must stand apart",
            written.len(),
            pieces.len()
        ));
    }
    written.truncate(pieces.len());
    written.sort_by(|a, b| a.center().x.total_cmp(&b.center().x));
    if script == Script::Leftward {
        written.reverse();
    }
    let mut pen = 0.0;
    let mut set = Vec::new();
    for piece in &pieces {
        set.push(ink(drafts, piece, script, &mut pen).ok_or("a letter of the word has no ink")?);
    }
    let fits = |(drawn, own): (&Rect, &Rect)| {
        (drawn.width() - own.width()).abs() <= WIDTH.0 * own.width() + WIDTH.1 * em
    };
    if !written.iter().zip(&set).all(fits) {
        return Err(
            "the word does not look like its letters: its pieces are of other widths".to_owned(),
        );
    }
    let sides = match script {
        Script::Rightward => [Side::Right, Side::Left],
        Script::Leftward => [Side::Left, Side::Right],
    };
    let white = |a: &Rect, b: &Rect| match script {
        Script::Rightward => b.x0 - a.x1,
        Script::Leftward => a.x0 - b.x1,
    };
    let mut out = Vec::new();
    for (i, pair) in pieces.windows(2).enumerate() {
        let [Some(&a), Some(&b)] = [pair[0].last(), pair[1].first()] else {
            continue;
        };
        let (Some([wa, wb]), Some([sa, sb])) = (written.get(i..i + 2), set.get(i..i + 2)) else {
            continue;
        };
        let name = |d: usize| {
            drafts
                .get(d)
                .map_or_else(String::new, |d| d.id.name.to_string())
        };
        out.push(Measured {
            gap: Gap {
                word: word.text.clone(),
                between: [name(a), name(b)],
                written: white(wa, wb),
                set: white(sa, sb),
            },
            sides: [(a, sides[0]), (b, sides[1])],
            script,
        });
    }
    let free = |m: &Measured| {
        m.sides
            .iter()
            .all(|&(d, s)| drafts.get(d).is_some_and(|d| is_free(d, s)))
    };
    out.retain(free);
    Ok(out)
}

/// Boxes of the pieces of ink, the largest areas first: letters before their dots.
fn bodies(outline: &Outline) -> Vec<Rect> {
    let contours = outline.contours().iter();
    let mut found: Vec<(f64, Rect)> = contours
        .map(|c| (c.area(), c.bounding_box()))
        .filter(|c| c.0 > 0.0)
        .collect();
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    found.into_iter().map(|(_, b)| b).collect()
}

/// The drafts of a word's letters, those that join together.
fn pieces(drafts: &[Draft], text: &str) -> Result<Vec<Vec<usize>>, String> {
    let letters: Vec<char> = text
        .chars()
        .filter(|c| get_joining_type(*c) != JoiningType::Transparent)
        .collect();
    use JoiningType::{DualJoining, RightJoining};
    let kind = |i: usize| letters.get(i).map(|c| get_joining_type(*c));
    let after = |i: usize| kind(i) == Some(DualJoining);
    let before = |i: usize| matches!(kind(i), Some(DualJoining | RightJoining));
    // whether the letter at i joins the one before it
    let joined = |i: usize| i > 0 && after(i - 1) && before(i);
    let mut out: Vec<Vec<usize>> = Vec::new();
    let mut i = 0;
    while i < letters.len() {
        // lam and alef are one glyph where it was drawn
        let most = if joined(i + 1) { 2 } else { 1 };
        let drawn = (1..=most).rev().find_map(|n| {
            let chars = letters.get(i..i + n)?;
            let joins = (joined(i), joined(i + n));
            let form = Form::ALL
                .into_iter()
                .find(|f| (f.joins_before(), f.joins_after()) == joins)?;
            Some((n, find(drafts, chars, form)?))
        });
        let Some((n, draft)) = drawn else {
            let letter: String = letters.get(i..=i).unwrap_or_default().iter().collect();
            return Err(format!(
                "the font has no {letter} in the form that the word needs"
            ));
        };
        match out.last_mut().filter(|_| joined(i)) {
            Some(piece) => piece.push(draft),
            None => out.push(vec![draft]),
        }
        i += n;
    }
    Ok(out)
}

/// The drawing of a letter in a form; that of its body where it is composed.
fn find(drafts: &[Draft], chars: &[char], form: Form) -> Option<usize> {
    let body = || match chars {
        [letter] => {
            let mut bodies = compose::bodies(*letter, form).into_iter();
            bodies.find_map(|b| super::find(drafts, &[b], form))
        }
        _ => None,
    };
    super::find(drafts, chars, form).or_else(body)
}

/// The box of a piece's bodies as the font sets it from `pen`, which is moved on.
fn ink(drafts: &[Draft], piece: &[usize], script: Script, pen: &mut f64) -> Option<Rect> {
    let mut whole: Option<Rect> = None;
    for draft in piece.iter().filter_map(|&d| drafts.get(d)) {
        let (origin, next) = match script {
            Script::Rightward => (*pen, *pen + draft.advance),
            Script::Leftward => (*pen - draft.advance, *pen - draft.advance),
        };
        *pen = next;
        let body = *bodies(&draft.outline).first()? + Vec2::new(origin, 0.0);
        whole = Some(whole.map_or(body, |w| w.union(body)));
    }
    whole
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::{Affine, BezPath};
    use proptest::prelude::*;

    const LETTERS: [&str; 8] = ["n", "o", "i", "d", "ا", "د", "ر", "ن"];

    /// Bodies of various widths, a dot for those that have one, and room beside them.
    fn draft(label: &str, width: f64, room: (f64, f64)) -> Draft {
        let mut contours: Vec<BezPath> = vec![Rect::new(0.0, 0.0, width, 400.0).to_path(0.1)];
        if ["i", "ن"].contains(&label) {
            contours.push(Rect::new(-20.0, 450.0, 30.0, 500.0).to_path(0.1));
        }
        let mut draft = Draft::drawn(label, contours);
        draft.advance = room.0 + width + room.1;
        draft.shift(room.0);
        draft
    }

    /// The word as these drafts set it.
    fn written(drafts: &[Draft], text: &str) -> Word {
        let letters: Vec<char> = text.chars().collect();
        let arabic = is_arabic(letters[0]);
        let mut contours = Vec::new();
        let mut pen = 70.0;
        for i in 0..letters.len() {
            let draft = &drafts[find(drafts, &letters[i..=i], Form::Isol).unwrap()];
            let origin = if arabic { pen - draft.advance } else { pen };
            let place = Affine::translate((origin, 0.0));
            contours.extend(draft.outline.transformed(place).contours().to_vec());
            pen = if arabic {
                origin
            } else {
                origin + draft.advance
            };
        }
        Word {
            text: text.to_owned(),
            outline: Outline::new(contours).unwrap(),
        }
    }

    fn font(rooms: &[(f64, f64)]) -> Vec<Draft> {
        let widths = [220.0, 260.0, 80.0, 240.0, 90.0, 180.0, 200.0, 300.0];
        let all = LETTERS.iter().zip(widths).zip(rooms);
        all.map(|((label, width), room)| draft(label, width, *room))
            .collect()
    }

    const WORDS: [&str; 10] = [
        "nono",
        "did",
        "noon",
        "oid",
        "indo",
        "ادر",
        "دار",
        "ران",
        "ارد",
        "داران",
    ];

    proptest! {
        #[test]
        fn a_looser_hand_sets_a_looser_font(
            rooms in prop::collection::vec((30.0..60.0f64, 30.0..60.0f64), 8),
            looser in -20.0..60.0f64,
        ) {
            let hand: Vec<(f64, f64)> = rooms.iter().map(|r| (r.0 + looser, r.1 + looser)).collect();
            let words: Vec<Word> = WORDS.iter().map(|w| written(&font(&hand), w)).collect();
            let mut drafts = font(&rooms);
            let (gaps, notes) = learn(&mut drafts, &words, 45.0, 1000.0);
            prop_assert!(notes.is_empty(), "{notes:?}");
            prop_assert_eq!(gaps.len(), 25);
            for (draft, (left, right)) in drafts.iter().zip(&hand) {
                let ink = draft.outline.contours()[0].bounding_box();
                prop_assert!((ink.x0 - left).abs() < 1e-6);
                prop_assert!((draft.advance - ink.x1 - right).abs() < 0.51);
            }
            for gap in gaps {
                prop_assert!((gap.written - gap.set).abs() < 1.1, "{gap:?}");
            }
        }

        #[test]
        fn what_was_written_is_nearer_afterwards(
            rooms in prop::collection::vec((0.0..90.0f64, 0.0..90.0f64), 8),
        ) {
            let words: Vec<Word> = WORDS.iter().map(|w| written(&font(&rooms), w)).collect();
            let mut drafts = font(&[(45.0, 45.0); 8]);
            let off = |gaps: &[Gap]| gaps.iter().map(|g| (g.written - g.set).abs()).sum::<f64>();
            let before: Vec<Gap> = words.iter().flat_map(|w| gaps(&drafts, w, 1000.0).unwrap()).map(|m| m.gap).collect();
            let (after, _) = learn(&mut drafts, &words, 45.0, 1000.0);
            // a unit a gap for rounding
            prop_assert!(off(&after) <= off(&before) + 25.0, "{} {}", off(&after), off(&before));
        }
    }

    #[test]
    fn gaps_under_tails_tell_nothing_of_sides() {
        let mut rooms = [(45.0, 45.0); 8];
        rooms[6].0 = -30.0;
        let mut hand = rooms;
        // uneven open gaps, and what follows reh nearer to it than those would have it
        for (i, (left, right)) in [
            (4, (4.0, 0.0)),
            (5, (-4.0, -3.0)),
            (6, (4.0, 3.0)),
            (7, (0.0, 5.0)),
        ] {
            hand[i].0 += left;
            hand[i].1 += right;
        }
        let words: Vec<Word> = WORDS.iter().map(|w| written(&font(&hand), w)).collect();
        let mut drafts = font(&rooms);
        learn(&mut drafts, &words, 45.0, 1000.0);
        // half of what open gaps want in the median, 7
        let left = drafts[6].outline.contours()[0].bounding_box().x0;
        assert!((left - (3.5 - 30.0)).abs() < 1e-6, "{left}");
    }

    #[test]
    fn sides_that_join_or_are_given_stay() {
        let hand = font(&[(80.0, 80.0); 8]);
        let words: Vec<Word> = WORDS.iter().map(|w| written(&hand, w)).collect();
        let mut drafts = font(&[(50.0, 50.0); 8]);
        drafts[0].given = Some((-50.0, 270.0));
        drafts[4].joint.1 = Some(140.0);
        let before: Vec<f64> = drafts.iter().map(|d| d.advance).collect();
        learn(&mut drafts, &words, 45.0, 1000.0);
        let wider: Vec<f64> = drafts
            .iter()
            .zip(before)
            .map(|(d, b)| d.advance - b)
            .collect();
        assert_eq!(wider, [0.0, 60.0, 60.0, 60.0, 30.0, 60.0, 60.0, 60.0]);
    }

    #[test]
    fn what_cannot_be_read_is_said() {
        let drafts = font(&[(50.0, 50.0); 8]);
        let told = |words: &[Word]| {
            let (gaps, notes) = learn(&mut drafts.clone(), words, 45.0, 1000.0);
            // two gaps of a readable word are shown, and nothing is learned from them
            assert!(gaps.iter().all(|g| (g.written - g.set).abs() < 1e-9));
            assert_eq!(notes.len(), 1, "{notes:?}");
            notes[0].message.clone()
        };
        let mut word = written(&drafts, "non");
        assert!(told(&[word.clone()]).contains("too few"));
        word.text = "dino".to_owned();
        assert!(told(&[word.clone()]).contains("in 3 pieces where its letters make 4"));
        word.text = "iii".to_owned();
        assert!(told(&[word.clone()]).contains("other widths"));
        word.text = "nox".to_owned();
        assert!(told(&[word]).contains("has no x"));
    }

    #[test]
    fn letters_that_join_are_one_piece() {
        let labels = [
            "ب",
            "uni0628.init",
            "uni0628.medi",
            "uni0628.fina",
            "ا",
            "uni0627.fina",
        ];
        let drafts: Vec<Draft> = labels
            .iter()
            .map(|l| draft(l, 100.0, (50.0, 50.0)))
            .collect();
        assert_eq!(pieces(&drafts, "بباب"), Ok(vec![vec![1, 2, 5], vec![0]]));
        // of a letter that is composed, its body
        assert_eq!(pieces(&drafts, "أب"), Ok(vec![vec![4], vec![0]]));
    }
}
