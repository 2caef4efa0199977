//! How far from the optimum: every run of points on the grid, by Dijkstra, on contours small enough.

use crate::quadratic::rate::curve::{Course, Curve, Keep, Node, Span};
use crate::quadratic::rate::glyf::{Pen, Stored};
use crate::quadratic::rate::search::{Effort, Otherwise, smooth};
use crate::quadratic::rate::{Strictness, least, solve};
use kurbo::{BezPath, Point, Rect, Vec2};
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

const TOLERANCE: f64 = 0.75;

fn effort() -> Effort {
    Effort {
        limit: TOLERANCE,
        keep: Strictness::Corners,
        grain: 1.0,
        slack: 2.1,
        lambda: 0.0,
        beside: 1.0,
        otherwise: Otherwise::Nothing,
    }
}

/// The only curve between two corners of a path, and its ends.
fn bow(svg: &str) -> (Curve, Node, Node) {
    let keep = Keep {
        corner_rad: 0.14,
        tolerance: TOLERANCE,
        line: 1.0,
        least: 3.0 * TOLERANCE,
        free: 0.0,
    };
    let path = BezPath::from_svg(svg).unwrap();
    let Some(Course::Spans(spans)) = Course::new(&path, keep) else {
        unreachable!("{svg} has corners");
    };
    let curve = spans.into_iter().find_map(|(a, s, b)| match s {
        Span::Curve(c) => Some((c, a, b)),
        Span::Line => None,
    });
    curve.unwrap()
}

/// After `from`, with or without a control point that is chosen already.
#[derive(Debug, Clone, Copy)]
struct State {
    from: Point,
    control: Option<Point>,
    /// Direction the next quadratic must have.
    along: Option<Vec2>,
    at: f64,
    pen: Pen,
}

impl State {
    /// What its future depends on.
    fn key(&self) -> String {
        format!(
            "{:?}{:?}{:?}",
            self.from,
            self.control.or(self.along.map(Vec2::to_point)),
            self.pen
        )
    }
}

/// Points of the grid that lie within `reach` of the curve.
fn near(curve: &Curve, reach: f64) -> Vec<Point> {
    let start = Rect::from_points(curve.dots[0].p, curve.dots[0].p);
    let bounds = curve.dots.iter().fold(start, |r, o| r.union_pt(o.p));
    let bounds = bounds.inset(reach).expand();
    let mut out = Vec::new();
    let mut q = bounds.origin();
    while q.y <= bounds.y1 {
        if curve.dots.iter().any(|o| o.p.distance(q) <= reach) {
            out.push(q);
        }
        q.x += 1.0;
        if q.x > bounds.x1 {
            q = Point::new(bounds.x0, q.y + 1.0);
        }
    }
    out
}

/// What one more stored point leads to, with its bytes.
fn steps(curve: &Curve, s: State, controls: &[Point], joins: &[Point]) -> Vec<(u32, State)> {
    let Some(c) = s.control else {
        let fits = |c: &&Point| **c != s.from && s.along.is_none_or(|u| smooth(u, **c - s.from));
        let chosen = |&c: &Point| {
            (
                0,
                State {
                    control: Some(c),
                    along: None,
                    ..s
                },
            )
        };
        return controls.iter().filter(fits).map(chosen).collect();
    };
    let reach = |m: Point| curve.follow([s.from, c, m], s.at, curve.last as f64, TOLERANCE);
    let mut pen = s.pen;
    let bytes = pen.store(Stored::off(c));
    let implied = controls
        .iter()
        .filter(|&&next| next != c)
        .filter_map(|&next| {
            let from = c.midpoint(next);
            let at = reach(from)?.at;
            Some((
                bytes,
                State {
                    from,
                    control: Some(next),
                    along: None,
                    at,
                    pen,
                },
            ))
        });
    let stored = joins.iter().filter(|&&m| m != c).filter_map(|&from| {
        let (at, mut pen) = (reach(from)?.at, pen);
        let bytes = bytes + pen.store(Stored::on(from));
        let along = Some((from - c).normalize());
        Some((
            bytes,
            State {
                from,
                control: None,
                along,
                at,
                pen,
            },
        ))
    });
    implied.chain(stored).collect()
}

/// Fewest bytes of any run of grid points between the two ends, each quadratic within the limit,
/// joins smooth: what the search looks for, without its short cuts.
fn optimum(curve: &Curve, to: Node, start: Point) -> u32 {
    /// How far outside the curve control points are tried, units.
    const OUTSIDE: f64 = 8.0;
    let begin = State {
        from: start,
        control: None,
        along: None,
        at: curve.first as f64,
        pen: Pen::after(Stored::on(start)),
    };
    let (controls, joins) = (near(curve, OUTSIDE), near(curve, TOLERANCE));
    let mut queue = BinaryHeap::from([(Reverse(0), 0)]);
    let mut states = vec![begin];
    let mut best: BTreeMap<String, u32> = BTreeMap::new();
    while let Some((Reverse(cost), id)) = queue.pop() {
        let s = states[id];
        if s.control.is_none() && s.from == to.at.point() && id > 0 {
            return cost;
        }
        if best.insert(s.key(), cost).is_some_and(|old| old <= cost) {
            continue;
        }
        for (bytes, next) in steps(curve, s, &controls, &joins) {
            if best.get(&next.key()).is_none_or(|&old| cost + bytes < old) {
                queue.push((Reverse(cost + bytes), states.len()));
                states.push(next);
            }
        }
    }
    u32::MAX
}

#[test]
fn small_contours_are_near_the_optimum_and_it_is_not_below_the_bound() {
    let (mut found, mut best, mut bounds) = (Vec::new(), Vec::new(), Vec::new());
    for svg in [
        "M0 0C0 6 12 6 12 0Z",
        "M0 0C0 9 16 9 16 0Z",
        "M0 0C2 8 14 10 18 0Z",
        "M0 0C8 10 10 -10 18 0L9 -20Z",
    ] {
        let (curve, from, to) = bow(svg);
        let points = solve::between(&curve, effort(), from, to).unwrap();
        let mut pen = Pen::after(from.at);
        found.push(points.iter().map(|&p| pen.store(p)).sum::<u32>());
        best.push(optimum(&curve, to, from.at.point()));
        bounds.push(least::between(&curve, from, to, TOLERANCE));
    }
    let below = |a: &[u32], b: &[u32]| a.iter().zip(b).all(|(a, b)| a <= b);
    assert!(below(&best, &found), "{found:?} below {best:?}");
    assert!(below(&bounds, &best), "{best:?} below {bounds:?}");
    let [f, l, b]: [u32; 3] = [found.iter().sum(), best.iter().sum(), bounds.iter().sum()];
    assert!(f <= l + 2, "{found:?} bytes, {best:?} would do");
    assert!(b + 4 >= l, "{bounds:?} bytes at least, {best:?} at best");
}
