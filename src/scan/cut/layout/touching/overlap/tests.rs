use super::*;
use crate::numeric::surface::Surface;
use crate::scan::components::components;
use crate::scan::cut::layout::touching::{Along, Meeting};
use kurbo::Affine;

/// Side of the pictures, px.
const SIDE: usize = 140;

type Inside<'a> = &'a dyn Fn(f64, f64) -> bool;

/// Which of the pixels of two letters, of which one ends and the next one begins near `at` px, are said to be whose.
fn parted(letters: [Inside<'_>; 2], at: f64) -> Option<[Vec<bool>; 2]> {
    parted_in(letters, at, (None, Meeting::Any))
}

/// The same of letters in the middle of cells so many px apart, of which such strokes meet.
fn parted_in(
    letters: [Inside<'_>; 2],
    at: f64,
    (cells, meeting): (Option<f64>, Meeting),
) -> Option<[Vec<bool>; 2]> {
    let gray = Gray::from_fn(SIDE, SIDE, |x, y| {
        let inked = |l: &Inside<'_>| l(x as f64 + 0.5, y as f64 + 0.5);
        f32::from(u8::from(letters.iter().any(inked)))
    });
    let ink = components(&gray, 0.5, 0.5);
    assert_eq!(ink.len(), 1, "the letters touch");
    let border = Border {
        along: Along::Row,
        stretch: &(at - 20.0..at + 20.0),
        meeting,
        examples: [&[], &[]],
        upright: &Surface::from(Affine::IDENTITY),
        cells,
        is_single: [true; 2],
    };
    let whose = |c: Component| {
        let mut own = vec![false; SIDE * SIDE];
        c.pixels().for_each(|(x, y)| own[y * SIDE + x] = true);
        let less = c.shares.iter().filter(|s| s.2 < 0.5);
        less.for_each(|&(x, y, _)| own[y * SIDE + x] = false);
        own
    };
    let letters = part(&ink[0], &gray, &border)?.pieces;
    let letters = <[Component; 2]>::try_from(letters).expect("each in one piece");
    Some(letters.map(whose))
}

/// Pixels that are wrongly said to be one's or not.
fn wrong(own: &[bool], letter: Inside<'_>) -> usize {
    let at = |i: usize| letter((i % SIDE) as f64 + 0.5, (i / SIDE) as f64 + 0.5);
    (0..own.len()).filter(|&i| own[i] != at(i)).count()
}

fn within(x: f64, y: f64, bars: &[Rect]) -> bool {
    bars.iter().any(|b| b.contains(Point::new(x, y)))
}

#[test]
fn strokes_that_cross_are_whole_in_both_letters() {
    // the first one's tail runs through the second one's stem
    let first = [
        Rect::new(10.0, 20.0, 20.0, 120.0),
        Rect::new(10.0, 60.0, 95.0, 70.0),
    ];
    let second = [
        Rect::new(76.0, 20.0, 86.0, 120.0),
        Rect::new(76.0, 110.0, 130.0, 120.0),
    ];
    let letters: [Inside<'_>; 2] = [&|x, y| within(x, y, &first), &|x, y| within(x, y, &second)];
    let own = parted(letters, 80.0).expect("both are told");
    let off = wrong(&own[0], letters[0]);
    assert!(off < 10, "the first: {off}");
    let off = wrong(&own[1], letters[1]);
    assert!(off < 10, "the second: {off}");
}

#[test]
fn round_letters_that_overlap_are_round() {
    let disk = |middle: f64| move |x: f64, y: f64| (x - middle).hypot(y - 70.0) < 34.0;
    let (first, second) = (disk(39.0), disk(101.0));
    let own = parted([&first, &second], 70.0).expect("both are told");
    // of 3600 px; 200 are both's, and the hidden edges are 30 px long
    for (own, letter) in own.iter().zip([&first as Inside<'_>, &second]) {
        let off = wrong(own, letter);
        assert!(off < 60, "{off}");
    }
}

#[test]
fn corners_beneath_the_other_letter_are_found() {
    // stems side by side that overlap by half their width: the foot of one and the head of the other are hidden
    let first = [
        Rect::new(10.0, 20.0, 72.0, 30.0),
        Rect::new(60.0, 20.0, 72.0, 100.0),
    ];
    let second = [
        Rect::new(66.0, 50.0, 78.0, 120.0),
        Rect::new(66.0, 110.0, 130.0, 120.0),
    ];
    let letters: [Inside<'_>; 2] = [&|x, y| within(x, y, &first), &|x, y| within(x, y, &second)];
    let own = parted(letters, 70.0).expect("both are told");
    for (own, letter) in own.iter().zip(letters) {
        // lens and pixels round each corner
        let off = wrong(own, letter);
        assert!(off <= 12, "{off}");
    }
}

#[test]
fn joining_strokes_in_line_end_where_the_letters_middles_say() {
    let first = [
        Rect::new(10.0, 20.0, 20.0, 110.0),
        Rect::new(10.0, 100.0, 80.0, 110.0),
    ];
    let second = [
        Rect::new(120.0, 20.0, 130.0, 110.0),
        Rect::new(62.0, 100.0, 130.0, 110.0),
    ];
    let letters: [Inside<'_>; 2] = [&|x, y| within(x, y, &first), &|x, y| within(x, y, &second)];
    let middles = |meeting| parted_in(letters, 70.0, (Some(51.0), meeting));
    let own = middles(Meeting::Strokes).expect("both are told");
    for (own, letter) in own.iter().zip(letters) {
        // of 18 px in line; a cell's middle is half a px off
        let off = wrong(own, letter);
        assert!(off <= 20, "{off}");
    }
    assert_eq!(middles(Meeting::Any), None, "there is no corner");
}

#[test]
fn a_plain_bar_tells_nothing() {
    let bar = |x: f64, y: f64| within(x, y, &[Rect::new(5.0, 60.0, 135.0, 72.0)]);
    assert_eq!(parted([&bar, &bar], 70.0), None);
}
