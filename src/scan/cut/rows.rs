//! Boxes → rows: neighbours that stand side by side.

use kurbo::Rect;

/// Share of the lower box's height by which two neighbours of a row overlap.
const BESIDE: f64 = 0.4;

/// Pixels that each pixel of height in which two boxes do not stand beside each other counts for.
const PARTLY: f64 = 4.0;

/// Indices of boxes in rows from the top, each row from the left.
///
/// Each box is linked to the next one on its right that stands beside it, so that rows may drift and letters
/// may differ in height and reach down. What stands beside nothing joins the row that is nearest in height.
pub(super) fn rows(boxes: &[Rect]) -> Vec<Vec<usize>> {
    let mut row: Vec<usize> = (0..boxes.len()).collect();
    let mut linked = vec![false; boxes.len()];
    for (i, a) in boxes.iter().enumerate() {
        let right = |j: &usize| boxes[*j].center().x > a.center().x && beside(a, &boxes[*j]);
        let next = (0..boxes.len()).filter(right);
        let nearest =
            next.min_by(|&p, &q| distance(a, &boxes[p]).total_cmp(&distance(a, &boxes[q])));
        if let Some(j) = nearest {
            let (from, to) = (row[i].max(row[j]), row[i].min(row[j]));
            row.iter_mut().filter(|r| **r == from).for_each(|r| *r = to);
            (linked[i], linked[j]) = (true, true);
        }
    }
    let mut ids: Vec<usize> = row.clone();
    ids.sort_unstable();
    ids.dedup();
    let of = |id: usize| {
        (0..boxes.len())
            .filter(|&i| row[i] == id)
            .collect::<Vec<_>>()
    };
    let (mut rows, alone): (Vec<Vec<usize>>, Vec<Vec<usize>>) = ids
        .into_iter()
        .map(of)
        .partition(|r| r.iter().any(|&i| linked[i]));
    merge(boxes, &mut rows);
    for one in alone.into_iter().flatten() {
        adopt(boxes, &mut rows, one);
    }
    rows.iter_mut()
        .for_each(|r| r.sort_by(|&a, &b| boxes[a].center().x.total_cmp(&boxes[b].center().x)));
    rows.sort_by(|a, b| middle(boxes, a).total_cmp(&middle(boxes, b)));
    rows
}

fn beside(a: &Rect, b: &Rect) -> bool {
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
    let mut all: Vec<f64> = row.iter().map(|&i| boxes[i].center().y).collect();
    all.sort_by(f64::total_cmp);
    all.get(all.len() / 2).copied().unwrap_or(0.0)
}

/// A row's usual extent: medians of tops and of bottoms.
fn band(boxes: &[Rect], row: &[usize]) -> Rect {
    let median = |of: fn(&Rect) -> f64| {
        let mut all: Vec<f64> = row.iter().map(|&i| of(&boxes[i])).collect();
        all.sort_by(f64::total_cmp);
        all.get(all.len() / 2).copied().unwrap_or(0.0)
    };
    Rect::new(0.0, median(|b| b.y0), 1.0, median(|b| b.y1))
}

/// Parts of one row that a gap tore apart become one: their usual extents stand beside each other.
fn merge(boxes: &[Rect], rows: &mut Vec<Vec<usize>>) {
    let mut i = 0;
    while i < rows.len() {
        let here = band(boxes, &rows[i]);
        let twin = (i + 1..rows.len()).find(|&j| beside(&here, &band(boxes, &rows[j])));
        match twin {
            Some(j) => {
                let more = rows.remove(j);
                rows[i].extend(more);
            }
            None => i += 1,
        }
    }
}

/// Puts a single box into the row nearest in height, or into a row of its own where none is near.
fn adopt(boxes: &[Rect], rows: &mut Vec<Vec<usize>>, one: usize) {
    let y = boxes[one].center().y;
    let away = |b: Rect| (b.y0 - y).max(y - b.y1).max(0.0) / b.height().max(1.0);
    let near = rows.iter_mut().map(|r| (away(band(boxes, r)), r));
    match near.min_by(|a, b| a.0.total_cmp(&b.0)) {
        Some((distance, row)) if distance < BESIDE => row.push(one),
        _ => rows.push(vec![one]),
    }
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
}
