//! Anchors from shapes: where signs above and below letters attach.
//!
//! A mark attaches by the middle of its edge towards the letter (`_top`, `_bottom`) and carries a place
//! for the next (`top`, `bottom`). A letter carries `top` and `bottom` over and under the middle of its
//! ink, as high and low as the ink there and a gap more; a ligature carries one of each for each part,
//! in reading order (`top_1`, `top_2`). Which marks go where is their canonical combining class.

use super::Draft;
use super::features::is_arabic;
use crate::types::Anchor;
use kurbo::{ParamCurve, Point, Rect};
use unicode_normalization::char::canonical_combining_class;

/// White between letter and mark, and between mark and mark, em.
const GAP: f64 = 0.04;

/// Half the width of the column over which a letter's height is taken, em: what a mark covers.
const COLUMN: f64 = 0.1;

/// Samples on a segment when a column's height is taken.
const SAMPLES: u32 = 16;

/// What carries marks though it is no letter: tatweel, and the dotted circle that shows a mark alone.
const CARRIERS: [char; 2] = ['\u{640}', '\u{25CC}'];

/// Where a mark goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Place {
    Top,
    Bottom,
}

/// Where the standard puts a combining character; none for those inside or around a letter.
pub(super) fn place(mark: char) -> Option<Place> {
    match canonical_combining_class(mark) {
        27 | 28 | 30 | 31 | 33..=36 | 230 | 232 | 234 => Some(Place::Top),
        29 | 32 | 202 | 220 | 222 | 233 => Some(Place::Bottom),
        _ => None,
    }
}

/// The anchors of every draft, in order: for marks where the font has any, and for letters that join cursively.
pub(super) fn anchors(drafts: &[Draft], em: f64) -> Vec<Vec<Anchor>> {
    let has_marks = drafts.iter().any(Draft::is_mark);
    let of = |d: &Draft| {
        let marks = if has_marks {
            of_draft(d, em)
        } else {
            Vec::new()
        };
        marks.into_iter().chain(cursive(d)).collect()
    };
    drafts.iter().map(of).collect()
}

/// Where a stroke leaves to the next letter, at the left end of the advance, and where the one before comes in.
fn cursive(draft: &Draft) -> impl Iterator<Item = Anchor> {
    let (left, right) = draft.cursive;
    let exit = left.map(|y| anchor("exit".to_owned(), 0.0, y));
    let entry = right.map(|y| anchor("entry".to_owned(), draft.advance, y));
    exit.into_iter().chain(entry)
}

pub(super) fn of_draft(draft: &Draft, em: f64) -> Vec<Anchor> {
    let Some(ink) = draft.outline.bounds() else {
        return Vec::new();
    };
    let carries = |c: &char| c.is_alphabetic() || CARRIERS.contains(c);
    if draft.is_mark() {
        let place = draft.id.chars.first().and_then(|&c| place(c));
        return place.map_or_else(Vec::new, |p| of_mark(p, ink, em));
    }
    match &draft.id.chars[..] {
        [c] if carries(c) => of_letter(draft, (ink.x0, ink.x1), em, ""),
        chars if chars.len() > 1 && chars.iter().all(carries) => of_ligature(draft, ink, em),
        _ => Vec::new(),
    }
}

fn anchor(name: String, x: f64, y: f64) -> Anchor {
    Anchor {
        name,
        at: Point::new(x, y).round(),
    }
}

pub(super) fn of_mark(place: Place, ink: Rect, em: f64) -> Vec<Anchor> {
    let x = ink.center().x;
    let (name, near, far) = match place {
        Place::Top => ("top", ink.y0, ink.y1 + GAP * em),
        Place::Bottom => ("bottom", ink.y1, ink.y0 - GAP * em),
    };
    vec![
        anchor(format!("_{name}"), x, near),
        anchor(name.to_owned(), x, far),
    ]
}

/// Top and bottom anchor over the middle of a stretch of the letter.
fn of_letter(draft: &Draft, stretch: (f64, f64), em: f64, suffix: &str) -> Vec<Anchor> {
    let x = 0.5 * (stretch.0 + stretch.1);
    let Some((low, high)) = heights(draft, x, COLUMN * em) else {
        return Vec::new();
    };
    vec![
        anchor(format!("top{suffix}"), x, high + GAP * em),
        anchor(format!("bottom{suffix}"), x, low.min(0.0) - GAP * em),
    ]
}

/// An anchor of each kind for each part: the parts share the width, from the side where reading begins.
fn of_ligature(draft: &Draft, ink: Rect, em: f64) -> Vec<Anchor> {
    let chars = &draft.id.chars;
    let leftward = chars.iter().any(|&c| is_arabic(c));
    let share = ink.width() / chars.len() as f64;
    let mut out = Vec::new();
    let mut from = 0.0;
    for (part, _) in (1..).zip(chars) {
        let left = if leftward {
            ink.x1 - from - share
        } else {
            ink.x0 + from
        };
        out.extend(of_letter(
            draft,
            (left, left + share),
            em,
            &format!("_{part}"),
        ));
        from += share;
    }
    out
}

/// Lowest and highest ink in a column; of the whole letter where the column has none.
fn heights(draft: &Draft, x: f64, half: f64) -> Option<(f64, f64)> {
    let ys = |near: &dyn Fn(Point) -> bool| {
        let segments = draft.outline.contours().iter().flat_map(|c| c.segments());
        let points = segments
            .flat_map(|s| (0..SAMPLES).map(move |k| s.eval(f64::from(k) / f64::from(SAMPLES))));
        let ys: Vec<f64> = points.filter(|p| near(*p)).map(|p| p.y).collect();
        Some((
            ys.iter().copied().reduce(f64::min)?,
            ys.iter().copied().reduce(f64::max)?,
        ))
    };
    ys(&|p| (p.x - x).abs() <= half).or_else(|| ys(&|_| true))
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::Shape;

    #[test]
    fn a_dotted_circle_carries_marks() {
        let circle = Rect::new(0.0, 100.0, 400.0, 500.0).to_path(0.1);
        for (label, carries) in [("uni25CC", true), ("uni0640", true), ("plus", false)] {
            let anchors = of_draft(&Draft::drawn(label, vec![circle.clone()]), 1000.0);
            let names: Vec<&str> = anchors.iter().map(|a| a.name.as_str()).collect();
            assert_eq!(
                names,
                if carries { &["top", "bottom"][..] } else { &[] },
                "{label}"
            );
        }
    }

    #[test]
    fn marks_know_their_side() {
        for (mark, side) in [
            ('\u{64e}', Some(Place::Top)),
            ('\u{650}', Some(Place::Bottom)),
            ('\u{651}', Some(Place::Top)),
            ('\u{301}', Some(Place::Top)),
            ('\u{323}', Some(Place::Bottom)),
            ('\u{327}', Some(Place::Bottom)),
            ('\u{338}', None),
        ] {
            assert_eq!(place(mark), side, "U+{:04X}", u32::from(mark));
        }
    }
}
