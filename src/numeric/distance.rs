//! Distance from a point to a polyline, by a tree of boxes over its runs; and the polyline of a path.

use super::curves::polygon;
use kurbo::{BezPath, Point, Rect};

/// Segments in a leaf of the tree: below this, looking at all of them is faster than going deeper.
const LEAF: usize = 8;

/// A polyline made ready for many questions: each costs O(log n) where the line does not fold.
#[derive(Debug, Clone)]
pub struct Polyline {
    points: Vec<Point>,
    /// Boxes of a complete binary tree, root at 1; the last `leaves` of them are the runs.
    boxes: Vec<Rect>,
    leaves: usize,
}

/// The point of a polyline that lies nearest to the one asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest {
    /// How far away it is, in the points' own unit.
    pub distance: f64,
    /// The segment it lies on, counted from 0.
    pub segment: usize,
    /// Where on the segment, 0…1.
    pub t: f64,
}

impl Polyline {
    /// Through `points` in order; one point is a segment without length. `None` when there is no point.
    #[must_use]
    pub fn new(mut points: Vec<Point>) -> Option<Self> {
        let &last = points.last()?;
        if points.len() == 1 {
            points.push(last);
        }
        let runs = (points.len() - 1).div_ceil(LEAF);
        let leaves = runs.next_power_of_two();
        let nothing = Rect::new(
            f64::INFINITY,
            f64::INFINITY,
            f64::NEG_INFINITY,
            f64::NEG_INFINITY,
        );
        let mut boxes = vec![nothing; 2 * leaves];
        for (run, b) in boxes[leaves..].iter_mut().take(runs).enumerate() {
            let end = ((run + 1) * LEAF + 1).min(points.len());
            for &p in &points[run * LEAF..end] {
                *b = b.union_pt(p);
            }
        }
        for i in (1..leaves).rev() {
            let (a, b) = (boxes[2 * i], boxes[2 * i + 1]);
            boxes[i] = Rect::new(
                a.x0.min(b.x0),
                a.y0.min(b.y0),
                a.x1.max(b.x1),
                a.y1.max(b.y1),
            );
        }
        Some(Self {
            points,
            boxes,
            leaves,
        })
    }

    /// The nearest point of the line.
    #[must_use]
    pub fn nearest(&self, p: Point) -> Nearest {
        let mut best = Nearest {
            distance: f64::INFINITY,
            segment: 0,
            t: 0.0,
        };
        self.descend(1, p, &mut best);
        best.distance = best.distance.sqrt();
        best
    }

    /// The same, looked for around a segment first: short where that is near.
    #[must_use]
    pub fn nearest_from(&self, segment: usize, p: Point) -> Nearest {
        let mut best = Nearest {
            distance: f64::INFINITY,
            segment,
            t: 0.0,
        };
        let mut node = self.leaves + segment / LEAF;
        self.descend(node, p, &mut best);
        while node > 1 {
            let beside = node ^ 1;
            if to_box(p, self.boxes[beside]) < best.distance {
                self.descend(beside, p, &mut best);
            }
            node /= 2;
        }
        best.distance = best.distance.sqrt();
        best
    }

    /// How far away the line is, or `limit` where it is no nearer: the smaller the limit, the shorter the search.
    fn distance_below(&self, p: Point, limit: f64) -> f64 {
        let mut best = Nearest {
            distance: limit * limit,
            segment: usize::MAX,
            t: 0.0,
        };
        self.descend(1, p, &mut best);
        if best.segment == usize::MAX {
            limit
        } else {
            best.distance.sqrt()
        }
    }

    /// Whether no point of a row lies farther away than `limit`: each is looked for where the one before it was
    /// found.
    #[must_use]
    pub fn is_within(&self, points: impl IntoIterator<Item = Point>, limit: f64) -> bool {
        let mut at = 0;
        points.into_iter().all(|p| {
            let ahead = &self.points[at..self.points.len().min(at + LEAF)];
            let near = |ab: &[Point]| to_segment(p, ab[0], ab[1]).0 <= limit * limit;
            if let Some(on) = ahead.windows(2).position(near) {
                at += on;
                return true;
            }
            let nearest = self.nearest_from(at, p);
            at = nearest.segment;
            nearest.distance <= limit
        })
    }

    /// Lowers `best`, whose distance is squared here, by what lies below `node`.
    fn descend(&self, node: usize, p: Point, best: &mut Nearest) {
        if node >= self.leaves {
            let start = (node - self.leaves) * LEAF;
            let end = (start + LEAF + 1).min(self.points.len());
            for (k, ab) in self.points[start..end].windows(2).enumerate() {
                let (d2, t) = to_segment(p, ab[0], ab[1]);
                if d2 < best.distance {
                    *best = Nearest {
                        distance: d2,
                        segment: start + k,
                        t,
                    };
                }
            }
            return;
        }
        let (mut near, mut far) = (2 * node, 2 * node + 1);
        let (mut dn, mut df) = (to_box(p, self.boxes[near]), to_box(p, self.boxes[far]));
        if df < dn {
            (near, far, dn, df) = (far, near, df, dn);
        }
        if dn < best.distance {
            self.descend(near, p, best);
        }
        if df < best.distance {
            self.descend(far, p, best);
        }
    }
}

/// Squared distance from `p` to segment `ab`, and where on it.
fn to_segment(p: Point, a: Point, b: Point) -> (f64, f64) {
    let (d, v) = (b - a, p - a);
    let len2 = d.hypot2();
    let t = if len2 > 0.0 {
        (v.dot(d) / len2).clamp(0.0, 1.0)
    } else {
        0.0
    };
    ((v - d * t).hypot2(), t)
}

/// Squared distance from `p` to a box, 0 inside; infinite to the empty box.
fn to_box(p: Point, r: Rect) -> f64 {
    let dx = (r.x0 - p.x).max(p.x - r.x1).max(0.0);
    let dy = (r.y0 - p.y).max(p.y - r.y1).max(0.0);
    dx * dx + dy * dy
}

/// Room for rounding in a bound that follows from the neighbour.
const SLACK: f64 = 1.0 + 1e-6;
/// The same where both are 0, the points' own unit.
const NEAR: f64 = 1e-9;

/// The distance of each point of a ring or row to the nearest of these lines; infinite where there is none. A point
/// cannot lie farther from them than its neighbour does, and as far again as the two are apart: neighbours
/// in a row make each other's search short.
#[must_use]
pub fn distances(points: impl IntoIterator<Item = Point>, lines: &[Polyline]) -> Vec<(Point, f64)> {
    let mut last: Option<(Point, f64)> = None;
    let each = points.into_iter().map(|p| {
        let bound = last.map_or(f64::INFINITY, |(q, d)| (d + p.distance(q)) * SLACK + NEAR);
        let least = lines
            .iter()
            .fold(bound, |least, line| line.distance_below(p, least));
        last = Some((p, least));
        (p, least)
    });
    each.collect()
}

/// The largest finite distance of some rings' points, each with its own.
#[must_use]
pub fn largest(rings: &[Vec<(Point, f64)>]) -> f64 {
    let all = rings.iter().flatten().map(|(_, d)| *d);
    all.filter(|d| d.is_finite()).fold(0.0, f64::max)
}

/// The ends of the chords of a closed path, which they leave by no more than `tolerance`, the first again at the end.
#[must_use]
pub fn chords(contour: &BezPath, tolerance: f64) -> Vec<Point> {
    let mut points = polygon(contour, tolerance);
    points.extend(points.first().copied());
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_is_within_its_farthest_distance() {
        let wave = |i: u32, by: f64| {
            let x = 0.1 * f64::from(i);
            Point::new(x, libm::sin(x) + by * libm::cos(1.7 * x))
        };
        let line = Polyline::new((0..=400).map(|i| wave(i, 0.0)).collect()).unwrap();
        let row: Vec<Point> = (0..=1000).map(|i| wave(i * 2 / 5, 0.3)).collect();
        for row in [row.clone(), row.into_iter().rev().collect()] {
            let off = distances(row.iter().copied(), std::slice::from_ref(&line));
            let most = off.iter().map(|(_, d)| *d).fold(0.0, f64::max);
            assert!(line.is_within(row.iter().copied(), most + 1e-9));
            assert!(!line.is_within(row, most - 1e-9));
        }
    }

    #[test]
    fn the_tree_finds_what_looking_at_all_finds() {
        let at = |i: u32| {
            let a = f64::from(i) * 0.37;
            Point::new(libm::cos(a) * (3.0 + a), libm::sin(a) * (2.0 + 0.3 * a))
        };
        let points: Vec<_> = (0..77).map(at).collect();
        let line = Polyline::new(points.clone()).unwrap();
        for (i, segment) in (0..200).zip((0..76).cycle()) {
            let p = Point::new(
                f64::from(i % 17) * 3.1 - 25.0,
                f64::from(i / 17) * 2.7 - 16.0,
            );
            let all = points.windows(2).map(|w| to_segment(p, w[0], w[1]).0);
            let least = all.fold(f64::INFINITY, f64::min).sqrt();
            for n in [line.nearest(p), line.nearest_from(segment, p)] {
                assert!((n.distance - least).abs() < 1e-12, "at {p}");
                let on = points[n.segment].lerp(points[n.segment + 1], n.t);
                assert!(
                    (on.distance(p) - least).abs() < 1e-12,
                    "the place is the nearest one"
                );
            }
        }
    }

    #[test]
    fn neighbours_shorten_the_search_and_change_nothing() {
        let ring = |r: f64, x: f64| {
            let at = move |i: u32| {
                let a = f64::from(i) * 0.11;
                Point::new(x + r * libm::cos(a), r * libm::sin(a))
            };
            (0..60).map(at).collect::<Vec<_>>()
        };
        let lines = [ring(5.0, 0.0), ring(3.0, 1.0), ring(7.0, 40.0)].map(Polyline::new);
        let lines: Vec<Polyline> = lines.into_iter().flatten().collect();
        for points in [ring(4.9, 0.3), ring(30.0, 20.0), lines[0].points.clone()] {
            for (p, d) in distances(points, &lines) {
                let alone = lines.iter().map(|l| l.nearest(p).distance);
                let alone = alone.fold(f64::INFINITY, f64::min);
                assert!(d.total_cmp(&alone).is_eq(), "{d} and {alone} at {p}");
            }
        }
        assert!(distances([Point::ORIGIN], &[])[0].1.is_infinite());
    }

    #[test]
    fn short_lines() {
        assert!(Polyline::new(Vec::new()).is_none());
        let one = Polyline::new(vec![Point::new(3.0, 4.0)]).unwrap();
        assert!((one.nearest(Point::ORIGIN).distance - 5.0).abs() < 1e-12);
    }
}
