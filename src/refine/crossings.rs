//! Where outlines cross themselves or each other.

use kurbo::{Point, Rect};

/// Chords of lines, from left to right.
#[derive(Debug)]
pub(super) struct Chords {
    /// their boxes, their ends, and the line that each is of
    all: Vec<(Rect, (Point, Point), usize)>,
    /// the widest box, px
    widest: f64,
}

impl Chords {
    /// Those within `bounds`, where there are such.
    pub(super) fn new<'r>(lines: impl Iterator<Item = &'r [Point]>, bounds: Option<Rect>) -> Self {
        let chords = lines.enumerate().flat_map(|(i, l)| {
            let pairs = l.iter().copied().zip(l.iter().copied().skip(1));
            pairs.map(move |(a, b)| (Rect::from_points(a, b), (a, b), i))
        });
        let within = |r: Rect| bounds.is_none_or(|b| r.overlaps(b));
        let mut all: Vec<_> = chords.filter(|(r, ..)| within(*r)).collect();
        all.sort_by(|(a, ..), (b, ..)| a.x0.total_cmp(&b.x0));
        let widest = all.iter().map(|(r, ..)| r.width()).fold(0.0, f64::max);
        Self { all, widest }
    }

    /// Their crossings of each other, as pairs of the lines' indices.
    pub(super) fn crossings(&self) -> Vec<[usize; 2]> {
        let mut out = Vec::new();
        for (k, (r, chord, i)) in self.all.iter().enumerate() {
            let after = self.all[k + 1..].iter().take_while(|(s, ..)| s.x0 <= r.x1);
            let crossed = after.filter(|(s, other, _)| r.overlaps(*s) && cross(*chord, *other));
            out.extend(crossed.map(|(.., j)| [*i.min(j), *i.max(j)]));
        }
        out
    }

    /// How often they cross others.
    pub(super) fn crossed_by(&self, others: &Self) -> usize {
        let of = |(r, chord, _): &(Rect, (Point, Point), usize)| {
            let first = self
                .all
                .partition_point(|(s, ..)| s.x0 < r.x0 - self.widest);
            let near = self.all[first..].iter().take_while(|(s, ..)| s.x0 <= r.x1);
            near.filter(|(s, other, _)| r.overlaps(*s) && cross(*chord, *other))
                .count()
        };
        others.all.iter().map(of).sum()
    }
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
        let of = |lines: &[&[Point]], bounds| Chords::new(lines.iter().copied(), bounds);
        let mut found = of(&lines, None).crossings();
        found.sort_unstable();
        // the bar crosses both diagonals and both sides
        assert_eq!(found, [[0, 0], [0, 1], [0, 1], [0, 1], [0, 1]]);
        let left = Rect::new(-2.0, -1.0, 0.1, 5.0);
        assert!(of(&lines, Some(left)).crossings().len() >= 2);
        assert_eq!(of(&[&square], None).crossings(), [] as [[usize; 2]; 0]);
        assert_eq!(of(&[&square, &square], None).crossings().len(), 0);
        let bar = of(&[&bar], None);
        assert_eq!(of(&[&bow, &square], None).crossed_by(&bar), 4);
        assert_eq!(bar.crossed_by(&of(&[&bow, &square], None)), 4);
        assert_eq!(of(&[&square], None).crossed_by(&bar), 0);
    }
}
