//! Iso-contours of the bilinear surface through the pixels' centres.

use super::cast::index;
use kurbo::Point;

/// Even the smallest ring has this many points.
const MIN_POINTS: usize = 16;

/// A sample's column and row; the picture's own run from 0, and one ring of paper lies around them.
type Place = (i64, i64);

/// The grid edge that a walker stands on: ink at its left hand, paper at its right.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Step {
    left: Place,
    right: Place,
}

/// The picture, with paper around it.
struct Field<F> {
    samples: F,
    height: usize,
    level: f64,
}

impl<F: Fn(usize, usize) -> f32> Field<F> {
    fn at(&self, (x, y): Place) -> f64 {
        match (usize::try_from(x), usize::try_from(y)) {
            (Ok(x), Ok(y)) => f64::from((self.samples)(x, y)),
            _ => 0.0,
        }
    }

    fn ink(&self, p: Place) -> bool {
        self.at(p) >= self.level
    }

    /// Where the surface passes the level on a grid edge, px, y up.
    #[expect(clippy::cast_precision_loss, reason = "columns and rows are small")]
    fn crossing(&self, s: Step) -> Point {
        let (a, b) = (self.at(s.left), self.at(s.right));
        let t = (a - self.level) / (a - b);
        let mix = |l: i64, r: i64| l as f64 + t * (r - l) as f64 + 0.5;
        let y = mix(s.left.1, s.right.1);
        Point::new(mix(s.left.0, s.right.0), self.height as f64 - y)
    }

    /// The next grid edge around the same ink.
    fn next(&self, s: Step) -> Step {
        let Step { left, right } = s;
        // a quarter turn left from "to the right hand" is "ahead"; y runs down
        let ahead = (right.1 - left.1, left.0 - right.0);
        let further = |p: Place| (p.0 + ahead.0, p.1 + ahead.1);
        let (far_left, far_right) = (further(left), further(right));
        let around_paper = Step {
            left: far_right,
            right,
        };
        let around_ink = Step {
            left,
            right: far_left,
        };
        match (self.ink(far_left), self.ink(far_right)) {
            (true, true) => around_paper,
            (true, false) => Step {
                left: far_left,
                right: far_right,
            },
            (false, false) => around_ink,
            (false, true) => {
                let [ink, paper] = [[left, far_right], [right, far_left]];
                if saddle(ink.map(|p| self.at(p)), paper.map(|p| self.at(p))) >= self.level {
                    around_paper
                } else {
                    around_ink
                }
            }
        }
    }
}

/// The height of the bilinear surface's saddle between four samples, which says which diagonal is connected: those of
/// one diagonal are higher than those of the other.
#[must_use]
pub fn saddle([a, b]: [f64; 2], [c, d]: [f64; 2]) -> f64 {
    (a * b - c * d) / (a + b - c - d)
}

/// All rings at `level`, ink on the left, px, y up; ordered by their first grid edge in reading order. `samples`
/// takes a column and a row and is 0 outside of the w × h px.
#[must_use]
pub fn rings(
    (w, h): (usize, usize),
    samples: impl Fn(usize, usize) -> f32,
    level: f64,
) -> Vec<Vec<Point>> {
    // below this, the paper around the picture would be ink
    let level = level.max(f64::MIN_POSITIVE);
    let field = Field {
        samples,
        height: h,
        level,
    };
    let mut seen = vec![false; w * h];
    let mut rings = Vec::new();
    for (i, x, y) in (0..h).flat_map(|y| (0..w).map(move |x| (y * w + x, x, y))) {
        let ink = |x: usize| f64::from((field.samples)(x, y)) >= level;
        if !ink(x) || seen[i] || ink(x + 1) {
            continue;
        }
        // every ring somewhere goes up between ink and the paper right of it
        let (x, y) = (signed(x), signed(y));
        let start = Step {
            left: (x, y),
            right: (x + 1, y),
        };
        let mut ring = Vec::new();
        let mut at = start;
        loop {
            ring.push(field.crossing(at));
            if at.right == (at.left.0 + 1, at.left.1)
                && let (Ok(x), Ok(y)) = (usize::try_from(at.left.0), usize::try_from(at.left.1))
            {
                seen[y * w + x] = true;
            }
            at = field.next(at);
            if at == start {
                break;
            }
        }
        rings.push(ring);
    }
    rings
}

/// A column or row as a signed number.
fn signed(i: usize) -> i64 {
    i64::try_from(i).unwrap_or(i64::MAX)
}

/// The same ring with points so many px apart.
#[must_use]
pub fn even(ring: &[Point], spacing: f64) -> Vec<Point> {
    let edges = || ring.iter().zip(ring.iter().cycle().skip(1));
    let length: f64 = edges().map(|(a, b)| a.distance(*b)).sum();
    let n = index(length / spacing).max(MIN_POINTS);
    let step = length / n as f64;
    let mut out = Vec::with_capacity(n);
    let mut passed = 0.0;
    for (a, b) in edges() {
        let d = a.distance(*b);
        while out.len() < n && out.len() as f64 * step < passed + d {
            out.push(a.lerp(*b, (out.len() as f64 * step - passed) / d));
        }
        passed += d;
    }
    out
}
