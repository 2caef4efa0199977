//! The vertex code: its lengths, and its words there and back.

use super::{SPLINES, boundary, code};
use crate::code::{Bounds, Closing, Steps, Width, encode};

const ALL: [Steps; 3] = [Steps::Eight, Steps::Any, Steps::Far];

/// Steps before, of all sectors and many lengths.
const BEFORE: [(i32, i32); 6] = [(1, 0), (-7, 7), (0, -31), (4, 29), (-13, 5), (3, -2)];

/// The bits of a step; none where the code has no word for it.
fn bits(code: Steps, before: Option<(i32, i32)>, step: (i32, i32)) -> Option<u64> {
    let before = match before {
        Some(b) => Some(code.step(b)?),
        None => None,
    };
    code.cost(before, code.step(step)?)
}

/// Every step that may have a word.
fn steps(code: Steps) -> impl Iterator<Item = (i32, i32)> {
    let run = code.longest();
    (-run..=run).flat_map(move |x| (-run..=run).map(move |y| (x, y)))
}

/// What a code has no word for cannot have come before.
fn before(code: Steps) -> impl Iterator<Item = Option<(i32, i32)>> {
    let all = BEFORE
        .into_iter()
        .filter(move |&b| bits(code, None, b).is_some());
    std::iter::once(None).chain(all.map(Some))
}

#[test]
fn the_lengths() {
    let eight = |before, step| bits(Steps::Eight, before, step);
    assert_eq!(eight(None, (1, 0)), Some(6));
    assert_eq!(eight(Some((3, 0)), (15, 0)), Some(7));
    assert_eq!(eight(Some((3, 0)), (-4, -4)), None);
    assert_eq!(eight(Some((3, 3)), (-4, 4)), Some(7));
    assert_eq!(eight(Some((0, 2)), (-1, 1)), Some(5));
    for wrong in [(0, 0), (32, 0), (2, 1)] {
        assert_eq!(eight(None, wrong), None, "{wrong:?}");
    }
    // straight on: the middle of 5 places takes 2 bits of truncated binary, the outer ones 3
    let of = |code: Steps, step| bits(code, Some((10, 4)), step);
    let five = [(5, 2), (5, 0), (-5, 1), (32, 13), (64, 26)];
    assert_eq!(
        five.map(|s| of(Steps::Any, s)),
        [Some(8), Some(9), None, None, None]
    );
    assert_eq!(
        five.map(|s| of(Steps::Far, s)),
        [Some(9), Some(10), None, Some(14), None]
    );
}

#[test]
fn the_words_of_a_code_are_all_the_words_of_their_lengths() {
    // Kraft: a complete prefix code's 2^-bits add to 1
    for code in ALL {
        for before in before(code) {
            let words = steps(code).filter_map(|s| bits(code, before, s));
            let sum: f64 = words.map(|bits| libm::pow(0.5_f64, bits as f64)).sum();
            assert!(
                (sum - 1.0).abs() < 1e-12,
                "{code:?} after {before:?}: {sum}"
            );
        }
    }
}

#[test]
fn every_step_comes_back_from_its_word() {
    for code in ALL {
        for before in before(code) {
            let before = before.and_then(|b| code.step(b));
            for step in steps(code).filter_map(|s| code.step(s)) {
                let Some(words) = code.words(before, step) else {
                    continue;
                };
                let bits =
                    words.map(|(value, count)| (0..count).rev().map(move |b| value >> b & 1));
                let mut bits = bits.into_iter().flatten();
                assert_eq!(code.next(before, &mut bits), Some(step), "{code:?}");
                assert_eq!(bits.next(), None, "{code:?} {step:?}");
            }
        }
    }
}

#[test]
fn a_coded_boundary_comes_back_from_its_bits() {
    let bounds = Bounds {
        t_max: 2.0,
        t_min: 1.0,
    };
    for steps in ALL {
        for kind in SPLINES {
            let coded = encode(
                &boundary(0.5),
                kind,
                bounds,
                code(steps, Width::Bound, Closing::Corner),
            )
            .unwrap();
            let bits = steps.write(&coded.vertices).unwrap();
            assert_eq!(bits.len() as u64, coded.bits, "{steps:?} {kind:?}");
            let first = coded.vertices[0];
            assert_eq!(steps.read(first, &bits), Some(coded.vertices), "{steps:?}");
            assert_eq!(steps.read(first, &bits[..bits.len() - 1]), None);
        }
    }
}
