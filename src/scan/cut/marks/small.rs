//! Small parts of letters: dots and accents.

use crate::numeric::sets::Sets;
use crate::scan::components::close;
use kurbo::Rect;

/// A part smaller than this share of the largest part of its cell is a dot or an accent.
pub(in crate::scan::cut) const SMALL: f64 = 0.4;

/// The boxes of small parts, by their indices, that belong together as two or three dots do: each nearer to another
/// than it is large. In the order of their first ones.
pub(in crate::scan::cut) fn groups(boxes: &[Rect]) -> Vec<Vec<usize>> {
    let mut sets = Sets::new(boxes.len());
    let near = close(boxes, |i| boxes[i].size().max_side());
    near.for_each(|(i, j)| sets.join(i, j));
    sets.into_groups()
}

#[cfg(test)]
mod tests {
    use super::groups;
    use kurbo::Rect;

    #[test]
    fn parts_go_together_that_are_nearer_than_either_is_large() {
        let square = |x: f64, y: f64, side: f64| Rect::new(x, y, x + side, y + side);
        // three in a chain, from right to left; a small one near a large one, by the large one's measure alone
        let boxes = [
            square(36.0, 0.0, 10.0),
            square(18.0, 8.0, 10.0),
            square(100.0, 0.0, 40.0),
            square(0.0, 0.0, 10.0),
            square(150.0, 0.0, 4.0),
            square(18.0, 29.0, 10.0),
        ];
        let expected: [&[usize]; 4] = [&[0, 1, 3], &[2], &[4], &[5]];
        assert_eq!(groups(&boxes), expected);
        assert!(groups(&[]).is_empty());
    }

    #[test]
    fn a_grid_of_parts_is_one_group() {
        let at = |i: u32| (f64::from(i % 300) * 15.0, f64::from(i / 300) * 15.0);
        let boxes: Vec<Rect> = (0..90_000)
            .map(at)
            .map(|(x, y)| Rect::new(x, y, x + 8.0, y + 8.0))
            .collect();
        assert_eq!(groups(&boxes).len(), 1);
    }
}
