//! Boxes → rows: neighbours that stand side by side.

use crate::numeric::median;
use crate::numeric::sets::Sets;
use kurbo::Rect;

/// Share of the lower box's height by which two neighbours of a row overlap.
const BESIDE: f64 = 0.4;

/// Two parts of a row lie less than this share of the rows' usual distance apart in height: letters that hang and
/// letters that stand can link among themselves alone. Where letters of the one fill gaps of the other they may lie
/// farther apart than where they do not.
const ASUNDER: (f64, f64) = (0.7, 0.4);
/// Share of the letters of such a part that lie over or under the other's at most: tails reach below the next letter.
const STACKED: f64 = 0.25;

/// Pixels that each pixel of height in which two boxes do not stand beside each other counts for.
const PARTLY: f64 = 4.0;

/// Indices of boxes in rows from the top, each row from the left.
///
/// Each box is linked to the next one on its right that stands beside it, so that rows may drift and letters may
/// differ in height and reach down. Links of one row that do not meet are put together where they lie far nearer to
/// each other than rows do. What stands beside nothing joins the row that is nearest in height.
pub(super) fn rows(boxes: &[Rect]) -> Vec<Vec<usize>> {
    let mut sets = Sets::new(boxes.len());
    let mut linked = vec![false; boxes.len()];
    for (i, a) in boxes.iter().enumerate() {
        let right = |j: &usize| boxes[*j].center().x > a.center().x && beside(a, &boxes[*j]);
        let next = (0..boxes.len()).filter(right);
        let nearest =
            next.min_by(|&p, &q| distance(a, &boxes[p]).total_cmp(&distance(a, &boxes[q])));
        if let Some(j) = nearest {
            sets.join(i, j);
            (linked[i], linked[j]) = (true, true);
        }
    }
    let groups = sets.into_groups().into_iter();
    let (mut rows, alone): (Vec<Vec<usize>>, Vec<Vec<usize>>) =
        groups.partition(|r| r.iter().any(|&i| linked[i]));
    merge(boxes, &mut rows);
    weave(boxes, &mut rows);
    for one in alone.into_iter().flatten() {
        let all: Vec<Vec<Rect>> = rows.iter().map(|r| of_row(boxes, r)).collect();
        match nearest(&all, boxes[one]) {
            Some(row) => rows[row].push(one),
            None => rows.push(vec![one]),
        }
    }
    rows.iter_mut()
        .for_each(|r| r.sort_by(|&a, &b| boxes[a].center().x.total_cmp(&boxes[b].center().x)));
    rows.sort_by(|a, b| middle(boxes, a).total_cmp(&middle(boxes, b)));
    rows
}

/// Whether two boxes stand side by side.
pub(super) fn beside(a: &Rect, b: &Rect) -> bool {
    a.y1.min(b.y1) - a.y0.max(b.y0) >= BESIDE * a.height().min(b.height())
}

/// How far the next box is, px: one that stands only partly beside the first counts as farther away.
fn distance(a: &Rect, b: &Rect) -> f64 {
    let low = a.height().min(b.height());
    let common = a.y1.min(b.y1) - a.y0.max(b.y0);
    b.center().x - a.center().x + PARTLY * (low - common)
}

/// The median height of a row's boxes' middles.
fn middle(boxes: &[Rect], row: &[usize]) -> f64 {
    let heights = row.iter().map(|&i| boxes[i].center().y);
    median::middle(heights, f64::total_cmp).unwrap_or(0.0)
}

fn of_row(boxes: &[Rect], row: &[usize]) -> Vec<Rect> {
    row.iter().map(|&i| boxes[i]).collect()
}

/// A row's usual extent: medians of tops and of bottoms.
fn band(row: &[Rect]) -> Rect {
    let usual =
        |of: fn(&Rect) -> f64| median::middle(row.iter().map(of), f64::total_cmp).unwrap_or(0.0);
    Rect::new(0.0, usual(|b| b.y0), 1.0, usual(|b| b.y1))
}

/// Parts of one row that a gap tore apart become one: their usual extents stand beside each other.
fn merge(boxes: &[Rect], rows: &mut Vec<Vec<usize>>) {
    let mut i = 0;
    while i < rows.len() {
        let here = band(&of_row(boxes, &rows[i]));
        let is_twin = |j: &usize| beside(&here, &band(&of_row(boxes, &rows[*j])));
        let twin = (i + 1..rows.len()).find(is_twin);
        match twin {
            Some(j) => {
                let more = rows.remove(j);
                rows[i].extend(more);
            }
            None => i += 1,
        }
    }
}

/// Parts of one row whose letters stand between each other become one.
fn weave(boxes: &[Rect], rows: &mut Vec<Vec<usize>>) {
    let Some(pitch) = pitch(boxes, rows) else {
        return;
    };
    loop {
        let pairs = (0..rows.len()).flat_map(|i| (i + 1..rows.len()).map(move |j| (i, j)));
        let away = pairs.filter_map(|(i, j)| Some((apart(boxes, &rows[i], &rows[j])?, i, j)));
        let near = away.filter(|&(away, i, j)| {
            let stacked = stacked(boxes, &rows[i], &rows[j]);
            let limit = if stacked { ASUNDER.1 } else { ASUNDER.0 };
            away < limit * pitch
        });
        let Some((_, i, j)) = near.min_by(|a, b| a.0.total_cmp(&b.0)) else {
            return;
        };
        let more = rows.remove(j);
        rows[i].extend(more);
    }
}

/// Whether letters of one part lie over or under those of the other.
fn stacked(boxes: &[Rect], one: &[usize], other: &[usize]) -> bool {
    let (few, many) = by_count(one, other);
    let meets = |i: &&usize| many.iter().any(|&j| lies_over(&boxes[**i], &boxes[j]));
    few.iter().filter(meets).count() as f64 > STACKED * few.len() as f64
}

/// Whether two boxes share half of the narrower one's width.
pub(super) fn lies_over(a: &Rect, b: &Rect) -> bool {
    a.x1.min(b.x1) - a.x0.max(b.x0) > a.width().min(b.width()) / 2.0
}

fn by_count<'a>(one: &'a [usize], other: &'a [usize]) -> (&'a [usize], &'a [usize]) {
    if one.len() < other.len() {
        (one, other)
    } else {
        (other, one)
    }
}

/// The usual distance of rows, px: the median from a box's middle to that of the next one that lies clear below it.
fn pitch(boxes: &[Rect], rows: &[Vec<usize>]) -> Option<f64> {
    let some: Vec<Rect> = rows.iter().flatten().map(|&i| boxes[i]).collect();
    let below = |a: &Rect| {
        let clear = some.iter().filter(|b| b.y0 >= a.y1);
        let under = clear.filter(|b| lies_over(a, b));
        let down = under.map(|b| b.center().y - a.center().y);
        down.min_by(f64::total_cmp)
    };
    median::middle(some.iter().filter_map(below), f64::total_cmp)
}

/// How far two parts of rows lie from each other in height, px: the median over the smaller part's boxes, each
/// against the other's next ones on both sides.
fn apart(boxes: &[Rect], one: &[usize], other: &[usize]) -> Option<f64> {
    let (few, many) = by_count(one, other);
    let off = |&i: &usize| Some((boxes[i].center().y - height(boxes, many, boxes[i])?).abs());
    median::middle(few.iter().filter_map(off), f64::total_cmp)
}

/// The height of the middles of a row where a box stands, px: between its next ones on both sides, or that of the
/// only one.
fn height(boxes: &[Rect], row: &[usize], at: Rect) -> Option<f64> {
    let x = at.center().x;
    let middles = || row.iter().map(|&i| boxes[i].center());
    let left = middles().filter(|p| p.x < x);
    let left = left.max_by(|a, b| a.x.total_cmp(&b.x));
    let right = middles().filter(|p| p.x >= x);
    let right = right.min_by(|a, b| a.x.total_cmp(&b.x));
    match (left, right) {
        (Some(l), Some(r)) => Some(l.y + (x - l.x) / (r.x - l.x) * (r.y - l.y)),
        (one, other) => one.or(other).map(|p| p.y),
    }
}

/// The row whose usual extent is nearest in height to a box, unless none is near.
pub(super) fn nearest(rows: &[Vec<Rect>], one: Rect) -> Option<usize> {
    let y = one.center().y;
    let away = |b: Rect| (b.y0 - y).max(y - b.y1).max(0.0) / b.height().max(1.0);
    let all = rows.iter().map(|r| away(band(r))).enumerate();
    let nearest = all.min_by(|a, b| a.1.total_cmp(&b.1));
    nearest.filter(|n| n.1 < BESIDE).map(|n| n.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_drift_and_letters_reach_down() {
        let mut boxes = Vec::new();
        for i in 0..8 {
            let (x, drift) = (60.0 * f64::from(i), 6.0 * f64::from(i));
            let tail = if i == 3 { 45.0 } else { 0.0 };
            boxes.push(Rect::new(x, 100.0 + drift, x + 40.0, 140.0 + drift + tail));
            boxes.push(Rect::new(x + 9.0, 170.0 + drift, x + 45.0, 205.0 + drift));
        }
        boxes.push(Rect::new(500.0, 175.0, 505.0, 190.0)); // an apostrophe of the first row
        let rows = rows(&boxes);
        assert_eq!(rows.len(), 2);
        assert_eq!(rows[0], [0, 2, 4, 6, 8, 10, 12, 14, 16]);
        assert_eq!(rows[1].len(), 8);
    }

    #[test]
    fn letters_that_hang_stand_in_the_row_of_those_that_do_not() {
        // the second hang a whole letter's height lower
        for (drift, hang) in [(-3.0, 34.0), (0.0, 34.0), (3.0, 34.0), (0.0, 60.0)] {
            let mut boxes = Vec::new();
            for row in 0..3 {
                for i in 0..8 {
                    let (x, foot) = (
                        70.0 * f64::from(i),
                        120.0 * f64::from(row) + drift * f64::from(i),
                    );
                    // two of the last row begin where the others end
                    let low = if row == 2 && (i == 3 || i == 4) {
                        hang
                    } else {
                        0.0
                    };
                    boxes.push(Rect::new(x, foot - 40.0 + low, x + 40.0, foot + low));
                }
            }
            let rows = rows(&boxes);
            assert_eq!(rows.len(), 3, "drift {drift}, {hang} px");
            assert_eq!(rows[2], [16, 17, 18, 19, 20, 21, 22, 23]);
        }
    }

    #[test]
    fn rows_that_stand_close_stay_apart() {
        let mut boxes = Vec::new();
        for row in 0..4 {
            for i in 0..6 {
                let (x, y) = (70.0 * f64::from(i), 46.0 * f64::from(row));
                boxes.push(Rect::new(x, y, x + 40.0, y + 40.0));
            }
        }
        assert_eq!(rows(&boxes).len(), 4);
    }
}
