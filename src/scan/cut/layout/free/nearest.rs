//! Ink of a bare page → letters where names say nothing of them: pieces are joined from the most to the least obvious
//! pair until there are as many letters as names.

use super::DIRT;
use super::pieces::{is_one, torn};
use crate::numeric::median::middle;
use crate::numeric::sets::Sets;
use crate::scan::components::{Component, close};
use crate::scan::cut::Reason;
use kurbo::Rect;
use std::mem;

/// A part that is joined to something above or below is lower than this share of a usual letter.
const SMALL: f64 = 0.35;
/// Joins that cost more are never made: about this share of a usual letter lies between the two.
const DEAREST: f64 = 0.75;
/// Two dots of one letter differ in size and height by less than this share of their size, and less than one of
/// them would fit between them.
const PAIRED: f64 = 0.4;

/// Letters and what is left out.
pub(super) struct Gathered {
    /// The ink of each letter.
    pub(super) groups: Vec<Vec<usize>>,
    pub(super) out: Vec<(usize, Reason)>,
    /// Cost of the dearest join.
    pub(super) dearest: f64,
}

/// Joins some ink to letters; `scale` is a usual letter's height and stroke, px.
pub(super) fn gather(
    all: &[Component],
    ink: &[usize],
    scale: (f64, f64),
    wanted: usize,
) -> Gathered {
    let (mut groups, dearest) = letters(all, ink, scale, wanted);
    let out = drop_dirt(all, &mut groups, wanted);
    Gathered {
        groups,
        out,
        dearest,
    }
}

/// Joins ink, the most obvious pairs first, until `wanted` groups are left or no pair is near; the groups, and the
/// cost of the last join.
fn letters(
    all: &[Component],
    ink: &[usize],
    scale: (f64, f64),
    wanted: usize,
) -> (Vec<Vec<usize>>, f64) {
    let boxes: Vec<Rect> = ink.iter().map(|&i| all[i].upright).collect();
    let reach = (DEAREST * scale.0).max(torn(scale.1));
    let near = close(&boxes, |_| reach).map(|(i, j)| (i.min(j), i.max(j)));
    let costs = near.map(|(i, j)| (cost(&all[ink[i]], &all[ink[j]], scale), i, j));
    let mut pairs: Vec<(f64, usize, usize)> = costs.filter(|p| p.0 < DEAREST).collect();
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let mut sets = Sets::new(ink.len());
    let mut left = ink.len();
    let mut dearest: f64 = 0.0;
    let small: Vec<bool> = ink
        .iter()
        .map(|&i| all[i].upright.height() < SMALL * scale.0)
        .collect();
    // of each set, by its first index
    let mut full: Vec<bool> = small.iter().map(|s| !s).collect();
    // a dot between two letters belongs to one of them; only if too many pieces are left then, to both
    let between = pairs.iter().map(|p| (true, p));
    let joining = pairs.iter().map(|p| (false, p));
    for (parting, &(cost, i, j)) in between.chain(joining) {
        if left <= wanted {
            break;
        }
        let (one, other) = (sets.first(i), sets.first(j));
        let dot = parting && (small[i] || small[j]) && cost > 0.0;
        if one != other && !(dot && full[one] && full[other]) {
            sets.join(one, other);
            full[one.min(other)] = full[one] || full[other];
            left -= 1;
            dearest = dearest.max(cost);
        }
    }
    let mut groups = sets.into_groups();
    groups.iter_mut().flatten().for_each(|i| *i = ink[*i]);
    (groups, dearest)
}

/// How far two pieces are from being one letter: the gap between them as a share of a usual height, more
/// where they stand beside rather than above each other. Two full letters one above the other never are, unless
/// hardly anything is between them: a pen that ran dry, a stroke parted by a cut. Two dots beside each other are
/// likelier one letter's than a dot beside a letter is.
fn cost(one: &Component, other: &Component, (height, stroke): (f64, f64)) -> f64 {
    let (a, b) = (one.upright, other.upright);
    let dx = (a.x0 - b.x1).max(b.x0 - a.x1);
    let dy = (a.y0 - b.y1).max(b.y0 - a.y1);
    let low = a.height().min(b.height());
    let narrow = a.width().min(b.width()).max(1.0);
    let small = low < SMALL * height;
    if is_one(one, other, torn(stroke)) {
        return 0.0;
    }
    let alike = |p: f64, q: f64| (p - q).abs() < PAIRED * p.min(q);
    let size = b.width();
    let level = (a.center().y - b.center().y).abs() < PAIRED * size;
    let dots = alike(a.width(), size) && alike(a.height(), b.height()) && alike(a.height(), size);
    match (dx < 0.0, dy < 0.0) {
        (false, true) if small && dots && level && dx < size => 0.3 + 0.1 * dx / size,
        (true, true) => {
            0.8 * (1.0 - dx * dy / (narrow * low.max(1.0))).max(0.0) + if small { 0.0 } else { 0.2 }
        }
        (true, false) if small => dy / height + 0.5 * (1.0 + dx / narrow).max(0.0),
        (false, true) if a.height().max(b.height()) < SMALL * height => 0.45 + dx / height,
        (false, _) if small && dx < 0.2 * height => 0.55 + dx.hypot(dy.max(0.0)) / height,
        _ => f64::INFINITY,
    }
}

/// Takes out the least groups while there are too many and they are dirt.
fn drop_dirt(
    all: &[Component],
    groups: &mut Vec<Vec<usize>>,
    wanted: usize,
) -> Vec<(usize, Reason)> {
    let area = |g: &Vec<usize>| g.iter().map(|&i| all[i].area).sum::<usize>();
    let areas: Vec<usize> = groups.iter().map(area).collect();
    let usual = middle(areas.iter().copied(), usize::cmp).unwrap_or(0) as f64;
    let mut least: Vec<usize> = (0..groups.len()).collect();
    least.sort_by_key(|&g| areas[g]);
    least.truncate(groups.len().saturating_sub(wanted));
    least.retain(|&g| (areas[g] as f64) < DIRT * usual);
    let out = least.into_iter().flat_map(|g| mem::take(&mut groups[g]));
    let out = out.map(|i| (i, Reason::Dirt)).collect();
    groups.retain(|g| !g.is_empty());
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scan::components::components;
    use crate::types::Gray;

    /// The letters that some ink is joined to, 40 px high and so thick.
    fn gathered(size: usize, inked: impl Fn(usize, usize) -> bool, letters: usize) -> Gathered {
        let inked = |x: usize, y: usize| f32::from(u8::from(inked(x, y)));
        let all = components(&Gray::from_fn(size, size, inked), 0.33, 0.5);
        let ink: Vec<usize> = (0..all.len()).collect();
        gather(&all, &ink, (40.0, 2.0), letters)
    }

    #[test]
    fn a_hairline_that_paper_shines_through_is_one() {
        let hairline =
            |x: usize, y: usize| (20..22).contains(&x) && (5..55).contains(&y) && y != 30;
        assert_eq!(gathered(60, hairline, 1).groups.len(), 1);
    }

    #[test]
    fn dust_in_any_number_is_gathered() {
        let specks = |x: usize, y: usize| x % 12 < 2 && y % 12 < 2;
        let letters = |x: usize, y: usize| x % 400 < 12 && (100..140).contains(&(y % 400));
        let inked = |x: usize, y: usize| specks(x, y) || letters(x, y);
        let found = gathered(2_400, inked, 36);
        let joined = found.groups.iter().map(Vec::len).max();
        assert!(found.groups.len() >= 36 && joined > Some(1), "{joined:?}");
    }
}
