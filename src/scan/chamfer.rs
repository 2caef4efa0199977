//! Distances on a picture by the 3-4 chamfer.

/// Distances to the pixels that are 0, in thirds of a pixel: two passes of a 3-4 chamfer.
pub(super) fn distances(field: &mut [u16], width: usize) {
    let last = field.len().saturating_sub(1);
    spread(field, width, |i| i);
    spread(field, width, |i| last - i);
}

/// One pass of the chamfer over the pixels in the order that `at` gives them.
fn spread(field: &mut [u16], width: usize, at: impl Fn(usize) -> usize) {
    let height = field.len() / width.max(1);
    for y in 0..height {
        for x in 0..width {
            let here = at(y * width + x);
            let mut best = field[here];
            let mut from = |dx: isize, dy: usize, cost: u16| {
                let column = x.checked_add_signed(dx).filter(|&c| c < width);
                if let (Some(c), Some(r)) = (column, y.checked_sub(dy)) {
                    best = best.min(field[at(r * width + c)].saturating_add(cost));
                }
            };
            from(-1, 0, 3);
            from(0, 1, 3);
            from(-1, 1, 4);
            from(1, 1, 4);
            field[here] = best;
        }
    }
}
