//! Sides that are kerned alike, as groups.

use crate::types::{Kerning, Name};

/// Kerning of one group lies together so far, em: its middle is off by half of that at most. Between 0.01 and 0.03
/// the mean error beside fonts' kerning stays the same.
const LIKE: f64 = 0.02;

/// Adds the pairs of glyphs and their groups: `value` by the places of two, taken away where it is worth a pair.
pub(super) fn group(
    (first, second): (&[&Name], &[&Name]),
    value: impl Fn(usize, usize) -> f64,
    em: f64,
    worth: f64,
    out: &mut Kerning,
) {
    let row = |a: usize| (0..second.len()).map(|b| value(a, b).max(0.0)).collect();
    let firsts = alike((0..first.len()).map(row), LIKE * em);
    let column = |b: usize| firsts.iter().map(|a| a.middle(b)).collect();
    let seconds = alike((0..second.len()).map(column), LIKE * em);
    let names = |group: &Alike, of: &[&Name]| -> Vec<Name> {
        group.members.iter().map(|&i| of[i].clone()).collect()
    };
    for (i, a) in firsts.iter().enumerate() {
        for b in &seconds {
            let value = b.middle(i).round();
            if value >= worth {
                let side = |group: &Alike, of: &[&Name]| of[group.members[0]].to_string();
                let (left, right) = (side(a, first), side(b, second));
                let pair = (format!("@{left}"), format!("@{right}"));
                out.pairs.insert(pair, -value);
                out.first.entry(left).or_insert_with(|| names(a, first));
                out.second.entry(right).or_insert_with(|| names(b, second));
            }
        }
    }
}

/// Sides whose values with each side opposite lie together.
struct Alike {
    members: Vec<usize>,
    low: Vec<f64>,
    high: Vec<f64>,
}

impl Alike {
    fn middle(&self, opposite: usize) -> f64 {
        self.low[opposite].midpoint(self.high[opposite])
    }
}

/// Rows of values put together, each by its place, each into the first group in which no values lie further apart
/// than `tolerance`.
fn alike(rows: impl Iterator<Item = Vec<f64>>, tolerance: f64) -> Vec<Alike> {
    let mut out: Vec<Alike> = Vec::new();
    for (i, row) in rows.enumerate() {
        let near = |g: &&mut Alike| {
            let mut ranges = row.iter().zip(g.low.iter().zip(&g.high));
            ranges.all(|(v, (low, high))| v.max(*high) - v.min(*low) <= tolerance)
        };
        if let Some(group) = out.iter_mut().find(near) {
            group.members.push(i);
            for (v, (low, high)) in row.iter().zip(group.low.iter_mut().zip(&mut group.high)) {
                (*low, *high) = (v.min(*low), v.max(*high));
            }
        } else {
            out.push(Alike {
                members: vec![i],
                low: row.clone(),
                high: row,
            });
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    #[test]
    fn groups_keep_every_pair_near_its_own_kerning() {
        // sides of 40 steps of 3 units, as when a shape grows little by little
        let own = |a: usize, b: usize| 2.0 * a as f64 + 3.0 * b as f64 - 40.0;
        let names: Vec<Name> = (0..40)
            .map(|i| Name::new(format!("g{i}")).unwrap())
            .collect();
        let names: Vec<&Name> = names.iter().collect();
        let mut out = Kerning::default();
        group((&names, &names), own, 1000.0, 15.0, &mut out);
        let find = |groups: &BTreeMap<String, Vec<Name>>, name: &Name| {
            let found: Vec<String> = groups
                .iter()
                .filter(|g| g.1.contains(name))
                .map(|g| format!("@{}", g.0))
                .collect();
            assert!(found.len() <= 1, "{name}: {found:?}");
            found.into_iter().next().unwrap_or_default()
        };
        for (a, first) in names.iter().enumerate() {
            for (b, second) in names.iter().enumerate() {
                let pair = (find(&out.first, first), find(&out.second, second));
                let value = -out.pairs.get(&pair).copied().unwrap_or(0.0);
                let own = own(a, b).max(0.0);
                let off = (value - own).abs();
                assert!(
                    off <= LIKE * 1000.0 + 0.5 || own < 35.5,
                    "{a} {b}: {own} {value}"
                );
            }
        }
        assert!(
            out.first.len() < 10 && out.second.len() < 12,
            "{} {}",
            out.first.len(),
            out.second.len()
        );
    }
}
