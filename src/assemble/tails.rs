//! Tails of Arabic letters: reh and waw reach under the letter that follows, as far as it leaves them room.
//!
//! Beside a letter that never joins the next, room is counted from its ink above the baseline: a tail below it
//! takes none. It stays clear of every letter that can follow, which is looked at row by row.

use super::Draft;
use super::features::is_arabic;
use super::profile::Profile;
use unicode_joining_type::{JoiningType, get_joining_type};

/// Rows above and below that count as level: ink that passes so near is felt as beside. em
const NEAR: f64 = 0.03;

/// Room that every follower leaves, part of the room of two sides.
const CLEAR: f64 = 0.15;

/// The furthest that a tail reaches beyond the advance. em
const FURTHEST: f64 = 0.2;

/// The left end of the advance of each draft in its own x, where it is an Arabic letter that never joins the next:
/// after one that does, in its final and isolated form, a word ends.
/// `side` is the room beside a letter, font units.
pub(super) fn ends(drafts: &[Draft], side: f64, em: f64) -> Vec<Option<f64>> {
    let profile = |d: &Draft| Profile::of(&d.outline, em, 0.0, 0.0);
    let follows = |d: &&Draft| {
        let first = d.id.chars.first().filter(|c| is_arabic(**c));
        d.joint.1.is_none() && !d.is_mark() && first.is_some_and(|c| c.is_alphabetic())
    };
    let never_joins = |d: &Draft| {
        let last = d.id.chars.last();
        last.is_some_and(|c| get_joining_type(*c) == JoiningType::RightJoining)
    };
    let near = super::profile::rows(NEAR);
    let followers: Vec<Vec<Option<f64>>> = drafts
        .iter()
        .filter(follows)
        .filter_map(profile)
        .map(|p| widened(&p.rights(), near))
        .collect();
    let end = |d: &Draft| {
        let profile = profile(d).filter(|_| never_joins(d))?;
        let rows = profile.lefts();
        // the least sum of both sides' distances, were the follower's right extreme at 0
        let least = |follower: &Vec<Option<f64>>| {
            let level = rows.iter().zip(follower);
            level
                .filter_map(|(l, r)| Some((*l)? + (*r)?))
                .reduce(f64::min)
        };
        let met: Vec<f64> = followers.iter().filter_map(least).collect();
        let above = profile.leftmost((0.0, f64::INFINITY))?;
        let clear = met.iter().copied().reduce(f64::min)? + side - 2.0 * CLEAR * side;
        let (least, most) = (
            profile.extremes.0 - side,
            profile.extremes.0 + FURTHEST * em,
        );
        Some((above - side).min(clear).clamp(least, most))
    };
    drafts.iter().map(end).collect()
}

/// Each row's least value among the rows near it.
fn widened(rows: &[Option<f64>], near: usize) -> Vec<Option<f64>> {
    let least = |i: usize| {
        let around = rows.get(i.saturating_sub(near)..(i + near + 1).min(rows.len()))?;
        around.iter().flatten().copied().reduce(f64::min)
    };
    (0..rows.len()).map(least).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assemble::names::identify;
    use crate::types::{Label, Outline};
    use kurbo::{BezPath, Rect, Shape};

    fn draft(label: &str, parts: &[Rect]) -> Draft {
        let contours: Vec<BezPath> = parts.iter().map(|r| r.to_path(0.1)).collect();
        Draft {
            id: identify(&Label(label.to_owned())).unwrap(),
            codepoints: Vec::new(),
            outline: Outline::new(contours).unwrap(),
            plates: Vec::new(),
            given: None,
            joint: (None, None),
            cursive: (None, None),
            advance: 0.0,
            parts: Vec::new(),
        }
    }

    #[test]
    fn a_tail_reaches_under_what_follows_and_stays_clear_of_it() {
        let (head, tail) = (
            Rect::new(100.0, 0.0, 200.0, 200.0),
            Rect::new(0.0, -150.0, 150.0, -100.0),
        );
        let reh = draft("ر", &[head, tail]);
        let alef = draft("ا", &[Rect::new(0.0, 0.0, 80.0, 700.0)]);
        // above the baseline nothing stands further left than 100: the tail takes no room
        assert_eq!(
            ends(&[reh.clone(), alef.clone()], 50.0, 1000.0),
            [Some(50.0), Some(-50.0)]
        );

        // a follower with ink as deep as the tail, at its right edge: the tail stays clear
        let deep = draft("و", &[Rect::new(0.0, -150.0, 80.0, 200.0)]);
        let met = ends(&[reh, alef, deep], 50.0, 1000.0);
        let gap = 50.0 - met[0].unwrap();
        assert!((2.0 * CLEAR * 50.0 - gap).abs() < 1e-9, "{met:?}");
    }

    #[test]
    fn letters_that_join_the_next_keep_the_plain_rule() {
        let beh = draft("ب", &[Rect::new(0.0, -100.0, 300.0, 200.0)]);
        assert_eq!(ends(&[beh], 50.0, 1000.0), [None]);
    }
}
