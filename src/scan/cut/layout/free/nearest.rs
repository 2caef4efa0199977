//! Ink of a bare page → letters where names say nothing of them: pieces are joined from the most to the least obvious
//! pair until there are as many letters as names.

use crate::numeric::median::middle;
use crate::scan::components::Component;
use crate::scan::cut::Reason;

/// A part that is joined to something above or below is lower than this share of a usual letter.
const SMALL: f64 = 0.35;
/// Two large pieces one above the other are one letter within this share of a stroke's width.
const TORN: f64 = 0.35;
/// Joins that cost more are never made: about this share of a usual letter lies between the two.
const DEAREST: f64 = 0.75;
/// Two dots of one letter differ in size and height by less than this share of their size, and less than one of
/// them would fit between them.
const PAIRED: f64 = 0.4;
/// Groups of less ink than this share of a usual letter's may be dirt.
const DIRT: f64 = 0.06;

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
    let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
    for (i, &a) in ink.iter().enumerate() {
        for (j, &b) in ink.iter().enumerate().skip(i + 1) {
            let cost = cost(&all[a], &all[b], scale);
            if cost < DEAREST {
                pairs.push((cost, i, j));
            }
        }
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut group: Vec<usize> = (0..ink.len()).collect();
    let mut left = ink.len();
    let mut dearest: f64 = 0.0;
    let small: Vec<bool> = ink
        .iter()
        .map(|&i| all[i].upright.height() < SMALL * scale.0)
        .collect();
    // a dot between two letters belongs to one of them; only if too many pieces are left then, to both
    let between = pairs.iter().map(|p| (true, p));
    let joining = pairs.iter().map(|p| (false, p));
    for (parting, &(cost, i, j)) in between.chain(joining) {
        if left <= wanted {
            break;
        }
        let (from, to) = (group[i].max(group[j]), group[i].min(group[j]));
        let full = |id: usize| (0..ink.len()).any(|k| group[k] == id && !small[k]);
        let dot = parting && (small[i] || small[j]) && cost > 0.0;
        if from != to && !(dot && full(from) && full(to)) {
            group
                .iter_mut()
                .filter(|g| **g == from)
                .for_each(|g| *g = to);
            left -= 1;
            dearest = dearest.max(cost);
        }
    }
    let of = |id: usize| {
        (0..ink.len())
            .filter(|&i| group[i] == id)
            .map(|i| ink[i])
            .collect::<Vec<_>>()
    };
    let groups = (0..ink.len()).map(of).filter(|g| !g.is_empty()).collect();
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
    let torn = TORN * stroke;
    if -dx > narrow / 2.0 && dy < torn && one.is_near(other, torn) {
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
    let usual = middle(groups.iter().map(area), usize::cmp).unwrap_or(0) as f64;
    let mut out = Vec::new();
    while groups.len() > wanted {
        let least = (0..groups.len()).min_by_key(|&g| area(&groups[g]));
        let Some(least) = least.filter(|&g| (area(&groups[g]) as f64) < DIRT * usual) else {
            break;
        };
        out.extend(groups.remove(least).into_iter().map(|i| (i, Reason::Dirt)));
    }
    out
}
