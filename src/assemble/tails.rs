//! Tails and tops of Arabic letters: reh and waw reach under the letter that follows, madda over both neighbours.
//!
//! Beside a letter that never joins the next, room is counted from its ink above the baseline: a tail below it takes
//! none. Of what reaches beyond a letter's body above it, such as madda, dots over a narrow tooth and kaf's arm, half
//! takes none. Tails and tops stay clear of every letter that can follow, which is looked at row by row.

use super::Draft;
use super::profile::Profile;

/// Rows above and below that count as level: ink that passes so near is felt as beside. em
const NEAR: f64 = 0.03;

/// Height of a letter's body, part of alef's: ink above reaches over its neighbours. Over six families the room on
/// the right is off by 10.8 thousandths of the em in place of 11.3 (mean of medians; 19.1 for 21.1, mean of means),
/// beside letters that never join the next by 21.0 in place of 24.6; 0.5 and 0.7 do as well.
const BODY: f64 = 0.6;

/// Room that every follower leaves, part of the room of two sides.
const CLEAR: f64 = 0.15;

/// The furthest that a tail reaches beyond the advance. em
const FURTHEST: f64 = 0.2;

/// Where the advance of a letter ends in its own x; none where the plain rule says it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Ends {
    /// Of an Arabic letter that never joins the next: after one that does, in its final and isolated form, a word
    /// ends.
    pub(super) left: Option<f64>,
    /// Of one that does not join the one before.
    pub(super) right: Option<f64>,
}

/// The ends of each draft. `side` is the room beside a letter, `alef` the height of alef where there is one, font
/// units.
pub(super) fn ends(drafts: &[Draft], side: f64, alef: Option<f64>, em: f64) -> Vec<Ends> {
    let body = alef.map_or(f64::INFINITY, |height| BODY * height);
    let profile = |d: &Draft| Profile::of(&d.outline, em, 0.0, 0.0);
    let follows = |d: &&Draft| d.joint.1.is_none() && d.is_arabic_letter();
    let near = super::profile::rows(NEAR);
    let right = |p: &Profile| {
        let edge = p.extremes.1;
        let top = edge - p.rightmost((f64::NEG_INFINITY, body)).unwrap_or(edge);
        edge + side - (0.5 * top).min(side)
    };
    let beside = |p: Profile| {
        let room = right(&p) - p.extremes.1;
        let rows = p.rights().into_iter().map(|r| r.map(|r| r + room));
        widened(&rows.collect::<Vec<_>>(), near)
    };
    let followers: Vec<Vec<Option<f64>>> = drafts
        .iter()
        .filter(follows)
        .filter_map(profile)
        .map(beside)
        .collect();
    let left = |d: &Draft| {
        let profile = profile(d).filter(|_| d.never_joins())?;
        let rows = profile.lefts();
        // the least sum of both sides' distances, were the follower's advance to end at 0
        let least = |follower: &Vec<Option<f64>>| {
            let level = rows.iter().zip(follower);
            level
                .filter_map(|(l, r)| Some((*l)? + (*r)?))
                .reduce(f64::min)
        };
        let met: Vec<f64> = followers.iter().filter_map(least).collect();
        let above = profile.leftmost((0.0, f64::INFINITY))?;
        let above = above.midpoint(profile.leftmost((0.0, body)).unwrap_or(above));
        let clear = met.iter().copied().reduce(f64::min)? - 2.0 * CLEAR * side;
        let (least, most) = (
            profile.extremes.0 - side,
            profile.extremes.0 + FURTHEST * em,
        );
        Some((above - side).min(clear).clamp(least, most))
    };
    let both = |d: &Draft| Ends {
        left: left(d),
        right: Some(d).filter(follows).and_then(profile).map(|p| right(&p)),
    };
    drafts.iter().map(both).collect()
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
    use kurbo::{Rect, Shape};

    fn draft(label: &str, parts: &[Rect]) -> Draft {
        let contours = parts.iter().map(|r| r.to_path(0.1));
        Draft::drawn(label, contours.collect())
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
        let lefts = |drafts: &[Draft]| -> Vec<Option<f64>> {
            let ends = ends(drafts, 50.0, None, 1000.0);
            ends.into_iter().map(|e| e.left).collect()
        };
        assert_eq!(
            lefts(&[reh.clone(), alef.clone()]),
            [Some(50.0), Some(-50.0)]
        );

        // a follower with ink as deep as the tail, at its right edge: the tail stays clear
        let deep = draft("و", &[Rect::new(0.0, -150.0, 80.0, 200.0)]);
        let met = lefts(&[reh, alef, deep]);
        let gap = 50.0 - met[0].unwrap();
        assert!((2.0 * CLEAR * 50.0 - gap).abs() < 1e-9, "{met:?}");
    }

    #[test]
    fn letters_that_join_the_next_keep_the_plain_rule() {
        let beh = draft("ب", &[Rect::new(0.0, -100.0, 300.0, 200.0)]);
        let ends = ends(&[beh], 50.0, None, 1000.0);
        assert_eq!((ends[0].left, ends[0].right), (None, Some(350.0)));
    }

    #[test]
    fn half_of_a_wide_top_takes_no_room() {
        let (stem, top) = (
            Rect::new(50.0, 0.0, 130.0, 600.0),
            Rect::new(0.0, 650.0, 200.0, 700.0),
        );
        let madda = draft("آ", &[stem, top]);
        let alef = draft("ا", &[Rect::new(0.0, 0.0, 80.0, 600.0)]);
        let [wide, plain] = ends(&[madda, alef], 50.0, Some(600.0), 1000.0)[..] else {
            panic!("two letters");
        };
        // 50 beside the stem on the left, 70 on the right
        assert_eq!((wide.left, wide.right), (Some(-25.0), Some(215.0)));
        assert_eq!((plain.left, plain.right), (Some(-50.0), Some(130.0)));
    }
}
