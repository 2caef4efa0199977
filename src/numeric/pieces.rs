//! Pieces of pixels that touch, also at their corners; and the crests that are such pieces.

use std::mem::take;

/// The pixels of the piece that `start` is part of, taken out of a map in rows of `width`, with what stood there:
/// those that touch and are more than the default.
pub fn taken<T: Copy + Default + PartialOrd>(
    map: &mut [T],
    width: usize,
    start: usize,
) -> Vec<(usize, T)> {
    let none = T::default();
    let mut out = Vec::new();
    let mut open = Vec::from_iter((map[start] > none).then_some(start));
    while let Some(i) = open.pop() {
        if map[i] <= none {
            continue;
        }
        out.push((i, take(&mut map[i])));
        let (x, y) = (i % width, i / width);
        for y in y.saturating_sub(1)..(y + 2).min(map.len() / width) {
            let row = x.saturating_sub(1)..(x + 2).min(width);
            open.extend(row.map(|x| y * width + x).filter(|&j| map[j] > none));
        }
    }
    out
}

/// Indices of the pixels of a map of so many columns and rows that lie no more than `reach` beside one or above or
/// below it, with its own, row by row.
pub fn around(
    (x, y): (usize, usize),
    reach: usize,
    (width, height): (usize, usize),
) -> impl Iterator<Item = usize> {
    let near = |at: usize, count: usize| at.saturating_sub(reach)..(at + reach + 1).min(count);
    let columns = near(x, width);
    near(y, height).flat_map(move |y| columns.clone().map(move |x| y * width + x))
}

/// The larger side of the box around a piece, px.
#[must_use]
pub fn extent<T>(piece: &[(usize, T)], width: usize) -> usize {
    let sides = piece.iter().fold(None, |b: Option<[usize; 4]>, (i, _)| {
        let (x, y) = (i % width, i / width);
        let [x0, x1, y0, y1] = b.unwrap_or([x, x, y, y]);
        Some([x0.min(x), x1.max(x), y0.min(y), y1.max(y)])
    });
    sides.map_or(0, |[x0, x1, y0, y1]| (x1 - x0).max(y1 - y0) + 1)
}

/// The lower of what lies on both sides of a crest, near or far, where `here` is the highest of three across it:
/// `side` gives the heights beside it, `steps` says how far its sides lie.
#[must_use]
pub fn foot(here: f32, side: impl Fn(isize) -> f32, steps: [isize; 2]) -> Option<f32> {
    if here < side(1).max(side(-1)) {
        return None;
    }
    let [near, far] = steps.map(|n| side(n).max(side(-n)));
    Some(near.min(far))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_piece_is_taken_whole_and_once() {
        // two pieces, one of which touches itself at corners alone
        let mut map = [1, 0, 0, 2, 0, 3, 0, 2, 4, 0, 0, 2];
        let mut piece = taken(&mut map, 4, 8);
        assert_eq!(extent(&piece, 4), 3);
        piece.sort_unstable();
        assert_eq!(piece, [(0, 1), (5, 3), (8, 4)]);
        assert!(taken(&mut map, 4, 8).is_empty());
        assert_eq!(map, [0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0, 2]);
        assert_eq!(extent::<u8>(&[], 4), 0);
    }

    #[test]
    fn a_crest_stands_out_of_its_lower_foot() {
        let heights = [0.1, 0.3, 0.5, 0.9, 0.8, 0.4, 0.2];
        let at = |i: usize| move |n: isize| heights[i.wrapping_add_signed(n)];
        assert_eq!(foot(heights[3], at(3), [2, 3]), Some(0.2));
        assert_eq!(foot(heights[4], at(4), [1, 2]), None);
    }
}
