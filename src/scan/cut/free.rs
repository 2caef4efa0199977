//! Letters in rows on a bare page.
//!
//! Pieces of ink are joined to letters from the most to the least obvious pair until there are as many
//! letters as names: a dot and its stem, strokes that the pen left apart, the two bars of an equals sign.

use super::rows::rows;
use super::{Layer, Reason, Slot, stroke_width};
use crate::scan::components::Component;
use crate::scan::error::ScanError;
use crate::scan::options::{Direction, Options};
use crate::types::Label;
use kurbo::Rect;

/// Thickness of a ruled line or a piece of it at most, as a share of its length.
const LINE_SHAPE: f64 = 0.06;
/// Length of a piece of a ruled line at least, in usual letters' heights: a dash is shorter.
const LINE_LENGTH: f64 = 1.5;
/// Thickness of a faint line's scraps at most, in the page's stroke widths, and their length at least, in
/// usual letters' heights.
const SCRAP: (f64, f64) = (0.2, 0.3);
/// Strokes of a label or a guide at most, in the page's stroke widths, where they are told from letters.
const THIN: f64 = 0.4;
/// Pieces of such thin ink at least, for each name: labels stand beside every letter.
const MANY: f64 = 0.5;
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

/// Gathers the ink of a bare page into letters and names them.
pub(super) fn place(
    all: &[Component],
    labels: &[Label],
    claims: &[(usize, Vec<usize>)],
    options: &Options,
    source: &str,
) -> Result<Layer, ScanError> {
    let (height, stroke) = (usual_height(all), stroke_width(all));
    let is_line = |c: &Component| {
        let (long, thin) = (
            c.upright.width().max(c.upright.height()),
            c.upright.width().min(c.upright.height()),
        );
        let line = long > LINE_LENGTH * height && thin < LINE_SHAPE * long;
        line || (long > SCRAP.1 * height && thin < SCRAP.0 * stroke)
    };
    let claimed = |i: &usize| claims.iter().any(|(_, parts)| parts.contains(i));
    let free = (0..all.len()).filter(|i| !claimed(i));
    let (lines, ink): (Vec<usize>, Vec<usize>) = free.partition(|&i| is_line(&all[i]));
    let unclaimed = |index: &usize| claims.iter().all(|(c, _)| c != index);
    let names: Vec<usize> = (0..labels.len()).filter(unclaimed).collect();
    let lines: Vec<(usize, Reason)> = lines.into_iter().map(|i| (i, Reason::Line)).collect();
    let Gathered {
        mut groups, out, ..
    } = choose(all, &ink, (height, stroke), names.len());
    let mut rejected = lines;
    rejected.extend(out);
    if groups.len() != names.len() {
        let boxes: Vec<Rect> = groups.iter().map(|g| bounds(all, g)).collect();
        return Err(count_error(source, &rows(&boxes), names.len()));
    }
    let found = groups.len();
    groups.extend(claims.iter().map(|(_, parts)| parts.clone()));
    let boxes: Vec<Rect> = groups.iter().map(|g| bounds(all, g)).collect();
    let mut order = rows(&boxes);
    if options.direction == Direction::Rtl {
        order.iter_mut().for_each(|r| r.reverse());
    }
    let (mut slots, mut next) = (Vec::new(), names.into_iter());
    let places = order
        .iter()
        .enumerate()
        .flat_map(|(r, row)| row.iter().map(move |&g| (r, g)));
    for (row, g) in places {
        let claim = g.checked_sub(found).and_then(|k| claims.get(k));
        let index = claim.map(|(index, _)| *index).or_else(|| next.next());
        let Some((index, label)) = index.and_then(|i| Some((i, labels.get(i)?))) else {
            continue;
        };
        let parts = std::mem::take(&mut groups[g]);
        if label.0 == "_" {
            rejected.extend(parts.iter().map(|&i| (i, Reason::Skipped)));
        } else {
            let level = level(&boxes, &order[row]);
            slots.push(Slot {
                label: label.clone(),
                index,
                row,
                level,
                parts,
            });
        }
    }
    slots.sort_by_key(|s| s.index);
    Ok(Layer {
        slots,
        rows: order.len(),
        rejected,
    })
}

/// Letters and what is left out.
struct Gathered {
    groups: Vec<Vec<usize>>,
    out: Vec<(usize, Reason)>,
    /// Cost of the dearest join.
    dearest: f64,
}

/// `scale` is a usual letter's height and stroke. Gathers all ink, or without what is drawn with a far thinner pen where that is so much that it must be labels
/// and guides, and the letters come out with more obvious joins.
fn choose(all: &[Component], ink: &[usize], scale: (f64, f64), wanted: usize) -> Gathered {
    let whole = gather(all, ink, scale, wanted);
    let (thin, thick): (Vec<usize>, Vec<usize>) =
        ink.iter().partition(|&&i| all[i].stroke() < THIN * scale.1);
    if (thin.len() as f64) < MANY * wanted as f64 || thick.len() < wanted {
        return whole;
    }
    let mut part = gather(all, &thick, scale, wanted);
    part.out.extend(thin.into_iter().map(|i| (i, Reason::Thin)));
    let better = part.dearest < whole.dearest || whole.groups.len() != wanted;
    if part.groups.len() == wanted && better {
        part
    } else {
        whole
    }
}

fn gather(all: &[Component], ink: &[usize], scale: (f64, f64), wanted: usize) -> Gathered {
    let (mut groups, dearest) = letters(all, ink, scale, wanted);
    let out = drop_dirt(all, &mut groups, wanted);
    Gathered {
        groups,
        out,
        dearest,
    }
}

fn bounds(all: &[Component], group: &[usize]) -> Rect {
    let boxes = group.iter().map(|&i| all[i].upright);
    boxes.reduce(|a, b| a.union(b)).unwrap_or(Rect::ZERO)
}

/// The median of a row's lower ends.
fn level(boxes: &[Rect], row: &[usize]) -> f64 {
    let mut feet: Vec<f64> = row.iter().map(|&i| boxes[i].y1).collect();
    feet.sort_by(f64::total_cmp);
    feet.get(feet.len() / 2).copied().unwrap_or(0.0)
}

fn count_error(source: &str, order: &[Vec<usize>], names: usize) -> ScanError {
    let rows: Vec<String> = order.iter().map(|r| r.len().to_string()).collect();
    ScanError::Count {
        source_name: source.to_owned(),
        found: order.iter().map(Vec::len).sum(),
        rows: rows.join(", "),
        names,
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

/// Height of a usual letter, px: the median over the ink, each piece by its area.
fn usual_height(all: &[Component]) -> f64 {
    let mut sizes: Vec<(f64, usize)> = all.iter().map(|c| (c.upright.height(), c.area)).collect();
    sizes.sort_by(|a, b| a.0.total_cmp(&b.0));
    let half = sizes.iter().map(|s| s.1).sum::<usize>() / 2;
    let mut sum = 0;
    let middle = sizes.iter().find(|s| {
        sum += s.1;
        sum > half
    });
    middle.map_or(1.0, |s| s.0.max(1.0))
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
    let mut areas: Vec<usize> = groups.iter().map(area).collect();
    areas.sort_unstable();
    let usual = areas.get(areas.len() / 2).copied().unwrap_or(0) as f64;
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
