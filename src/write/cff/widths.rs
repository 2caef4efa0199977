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

/// Largest numbers that take one, two and three bytes.
const STEPS: [i32; 3] = [107, 1131, 32_767];

/// What a number costs that no charstring can say: more than all others of a font together.
const UNSAYABLE: u64 = 1 << 20;

/// Bytes that a number takes in a charstring.
const fn cost(v: i32) -> u64 {
    match v {
        -107..=107 => 1,
        -1131..=1131 => 2,
        -32_768..=32_767 => 3,
        _ => UNSAYABLE,
    }
}

/// The pair for which the advances take fewest bytes: the best nominal width has some advance at the
/// edge of a step, so these edges are all that need be tried. Of 16-bit advances there is always one that says
/// them all.
pub(super) fn choose(advances: &[i32]) -> Widths {
    let mut counts: BTreeMap<i32, u64> = BTreeMap::new();
    for &a in advances {
        *counts.entry(a).or_default() += 1;
    }
    let edges = counts
        .keys()
        .flat_map(|&w| STEPS.into_iter().flat_map(move |s| [w - s, w + s]));
    let candidates = std::iter::once(0).chain(edges);
    let best = candidates.map(|nominal| {
        let bytes: u64 = counts.iter().map(|(&w, n)| n * cost(w - nominal)).sum();
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
    fn every_advance_of_a_font_can_be_said() {
        let many = [vec![500; 300], vec![0, 60_000, 65_535, 40_000]].concat();
        for advances in [&many[..], &[600, 600, 60_000], &[0, 65_535]] {
            let w = choose(advances);
            let said = advances.iter().filter_map(|&a| w.operand(a));
            let beyond: Vec<i32> = said.filter(|v| i16::try_from(*v).is_err()).collect();
            assert!(beyond.is_empty(), "{w:?}: {beyond:?}");
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
