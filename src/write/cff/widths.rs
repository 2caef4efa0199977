//! The two widths of a Private DICT that make the charstrings shortest.

use std::collections::BTreeMap;

/// A charstring leaves its advance out when it is `default`, and gives it less `nominal` otherwise.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Widths {
    pub(super) default: i32,
    pub(super) nominal: i32,
}

impl Widths {
    /// What a charstring says of this advance.
    pub(super) const fn operand(self, advance: i32) -> Option<i32> {
        if advance == self.default {
            None
        } else {
            Some(advance - self.nominal)
        }
    }
}

/// Largest numbers that take one and two bytes.
const STEPS: [i32; 2] = [107, 1131];

/// Bytes that a number takes in a charstring.
const fn cost(v: i32) -> usize {
    let size = v.abs();
    if size <= STEPS[0] {
        1
    } else if size <= STEPS[1] {
        2
    } else {
        3
    }
}

/// The pair for which the advances take fewest bytes: the best nominal width has some advance at the
/// edge of a step, so these edges are all that need be tried.
pub(super) fn choose(advances: &[i32]) -> Widths {
    let mut counts: BTreeMap<i32, usize> = BTreeMap::new();
    for &a in advances {
        *counts.entry(a).or_default() += 1;
    }
    let edges = counts
        .keys()
        .flat_map(|&w| STEPS.into_iter().flat_map(move |s| [w - s, w + s]));
    let candidates = std::iter::once(0).chain(edges);
    let best = candidates.map(|nominal| {
        let bytes: usize = counts.iter().map(|(&w, n)| n * cost(w - nominal)).sum();
        let saved = counts
            .iter()
            .map(|(&w, n)| (n * cost(w - nominal), std::cmp::Reverse(w)))
            .max();
        let (saved, default) = saved.map_or((0, 0), |(s, w)| (s, w.0));
        (bytes - saved, nominal.abs(), Widths { default, nominal })
    });
    best.min_by_key(|b| (b.0, b.1)).map_or(
        Widths {
            default: 0,
            nominal: 0,
        },
        |b| b.2,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_commonest_width_costs_nothing() {
        let w = choose(&[600, 600, 600, 500, 550, 700]);
        assert_eq!(w.default, 600);
        assert_eq!(w.operand(600), None);
        for a in [500, 550, 700] {
            assert!(w.operand(a).is_some_and(|v| v.abs() <= 107), "{a}");
        }
    }

    #[test]
    fn no_glyphs_no_widths() {
        assert_eq!(
            choose(&[]),
            Widths {
                default: 0,
                nominal: 0
            }
        );
    }
}
