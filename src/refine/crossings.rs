//! Where outlines cross themselves or each other.

use kurbo::{Point, Rect};

/// The crossings of lines, each other or themselves, as pairs of their indices: of chords within `bounds`, where
/// there are such.
pub(super) fn crossings<'r>(
    lines: impl Iterator<Item = &'r [Point]>,
    bounds: Option<Rect>,
) -> Vec<[usize; 2]> {
    let chords = lines.enumerate().flat_map(|(i, l)| {
        let pairs = l.iter().copied().zip(l.iter().copied().skip(1));
        pairs.map(move |(a, b)| (Rect::from_points(a, b), (a, b), i))
    });
    let within = |r: Rect| bounds.is_none_or(|b| r.overlaps(b));
    let mut chords: Vec<_> = chords.filter(|(r, ..)| within(*r)).collect();
    chords.sort_by(|(a, ..), (b, ..)| a.x0.total_cmp(&b.x0));
    let mut out = Vec::new();
    for (k, (r, chord, i)) in chords.iter().enumerate() {
        let after = chords[k + 1..].iter().take_while(|(s, ..)| s.x0 <= r.x1);
        let crossed = after.filter(|(s, other, _)| r.overlaps(*s) && cross(*chord, *other));
        out.extend(crossed.map(|(.., j)| [*i.min(j), *i.max(j)]));
    }
    out
}

/// Whether two chords cross that do not follow each other.
pub(super) fn cross((a, b): (Point, Point), (c, d): (Point, Point)) -> bool {
    let side = |p: Point, q: Point, r: Point| (q - p).cross(r - p) > 0.0;
    let follow = a == c || a == d || b == c || b == d;
    !follow && side(a, b, c) != side(a, b, d) && side(c, d, a) != side(c, d, b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crossings_are_told_by_the_lines_they_are_of() {
        let points = |text: &[(f64, f64)]| text.iter().map(|p| Point::from(*p)).collect();
        let bow: Vec<Point> = points(&[(0., 0.), (4., 4.), (4., 0.), (0., 4.), (0., 0.)]);
        let bar: Vec<Point> = points(&[(-1., 1.), (5., 1.5)]);
        let square: Vec<Point> = points(&[(9., 0.), (9., 4.), (12., 4.), (12., 0.), (9., 0.)]);
        let lines = [&*bow, &*bar, &*square];
        let mut found = crossings(lines.into_iter(), None);
        found.sort_unstable();
        // the bar crosses both diagonals and both sides
        assert_eq!(found, [[0, 0], [0, 1], [0, 1], [0, 1], [0, 1]]);
        let left = Rect::new(-2.0, -1.0, 0.1, 5.0);
        assert!(crossings(lines.into_iter(), Some(left)).len() >= 2);
        assert_eq!(
            crossings([&*square].into_iter(), None),
            [] as [[usize; 2]; 0]
        );
        assert_eq!(crossings([&*square, &*square].into_iter(), None).len(), 0);
    }
}
