//! Smooth joins on the grid: the handles of a node are rounded together, so that they stay on one line.
//!
//! Rounded one by one, handles of 20 units turn against each other by up to 4°. Of the grid points around both the
//! pair is taken that is nearest to where they were and to being collinear; beside a line there is one to choose.

use crate::numeric::angles::angle;
use kurbo::{PathEl, Point, Vec2};

/// Directions that differ by less are one, radians: what outlines call a smooth join.
const SMOOTH: f64 = 0.0175;
/// A turn as bad as a handle that is one unit off, radians.
const TURN: f64 = 0.0044;

/// What leads to a node or away from it.
#[derive(Debug, Clone, Copy)]
struct Side {
    /// the element with the handle; none for a line
    element: Option<usize>,
    /// the handle, or the other end of the line
    at: Point,
}

/// Moves handles of `rounded`, the elements of `path` with every point on the grid, to where the smooth joins
/// of `path` stay so.
pub(super) fn keep(path: &[PathEl], rounded: &mut [PathEl]) {
    for (node, [before, after]) in joins(path) {
        let (u, v) = (node - before.at, after.at - node);
        let bent = angle(u, v).abs();
        let on_grid = [node, before.at, after.at].iter().all(|p| p.round() == *p);
        if bent > SMOOTH || on_grid || u.hypot() * v.hypot() < 1e-9 {
            continue;
        }
        let node = node.round();
        let places = |side: Side| match side.element {
            Some(_) => around(side.at),
            // the line's other end is a node: where it went is known
            None => vec![side.at.round()],
        };
        let mut best = (f64::INFINITY, None);
        for a in places(before) {
            for b in places(after) {
                let cost = cost(node - a, b - node) + off(before, a) + off(after, b);
                if cost < best.0 {
                    best = (cost, Some((a, b)));
                }
            }
        }
        let Some((a, b)) = best.1 else { continue };
        if let Some(i) = before.element
            && let PathEl::CurveTo(p, _, r) = rounded[i]
        {
            rounded[i] = PathEl::CurveTo(p, a, r);
        }
        if let Some(i) = after.element
            && let PathEl::CurveTo(_, q, r) = rounded[i]
        {
            rounded[i] = PathEl::CurveTo(b, q, r);
        }
    }
}

/// The grid points around `p`, the nearest first.
fn around(p: Point) -> Vec<Point> {
    const STEPS: [(f64, f64); 9] = [
        (0.0, 0.0),
        (1.0, 0.0),
        (-1.0, 0.0),
        (0.0, 1.0),
        (0.0, -1.0),
        (1.0, 1.0),
        (1.0, -1.0),
        (-1.0, 1.0),
        (-1.0, -1.0),
    ];
    let nearest = p.round();
    STEPS.iter().map(|s| nearest + Vec2::from(*s)).collect()
}

/// What a turn from `u` to `v` costs; none of them may be without direction.
fn cost(u: Vec2, v: Vec2) -> f64 {
    if u.hypot2() < 0.5 || v.hypot2() < 0.5 {
        return f64::INFINITY;
    }
    (angle(u, v) / TURN).powi(2)
}

/// What it costs that a handle is not where it was.
fn off(side: Side, at: Point) -> f64 {
    side.element.map_or(0.0, |_| side.at.distance_squared(at))
}

/// The nodes of a closed contour at which a curve begins or ends, and both their sides.
fn joins(path: &[PathEl]) -> Vec<(Point, [Side; 2])> {
    let drawn: Vec<(usize, Point)> = path
        .iter()
        .enumerate()
        .filter(|(_, el)| !matches!(el, PathEl::MoveTo(_)))
        .filter_map(|(i, el)| Some((i, el.end_point()?)))
        .collect();
    let (Some(PathEl::MoveTo(start)), Some((_, last))) = (path.first(), drawn.last()) else {
        return Vec::new();
    };
    // a contour that does not end where it began is closed by a line
    let open = last.distance(*start) > 1e-9;
    let n = drawn.len();
    let leaving = |k: usize| match path[drawn[k].0] {
        PathEl::CurveTo(p, ..) => Some(Side {
            element: Some(drawn[k].0),
            at: p,
        }),
        PathEl::LineTo(p) => Some(Side {
            element: None,
            at: p,
        }),
        _ => None,
    };
    let arriving = |k: usize| match path[drawn[k].0] {
        PathEl::CurveTo(_, q, _) => Some(Side {
            element: Some(drawn[k].0),
            at: q,
        }),
        PathEl::LineTo(_) => Some(Side {
            element: None,
            at: if k == 0 { *start } else { drawn[k - 1].1 },
        }),
        _ => None,
    };
    let line = |at: Point| Some(Side { element: None, at });
    let mut out = Vec::new();
    let mut add = |node: Point, sides: [Option<Side>; 2]| {
        if let [Some(a), Some(b)] = sides
            && (a.element.is_some() || b.element.is_some())
        {
            out.push((node, [a, b]));
        }
    };
    for (k, &(_, node)) in drawn.iter().enumerate() {
        let after = match (k + 1 < n, open) {
            (true, _) => leaving(k + 1),
            (false, true) => line(*start),
            (false, false) => leaving(0),
        };
        add(node, [arriving(k), after]);
    }
    if open {
        add(*start, [line(*last), leaving(0)]);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::super::round::outline;
    use super::angle;
    use crate::numeric::angles;
    use crate::types::Outline;
    use kurbo::{BezPath, PathEl, Point};
    use proptest::prelude::{prop_assert, proptest};
    use std::f64::consts::FRAC_PI_2;

    /// A closed curve through four points around the origin with smooth joins.
    fn blob(radii: [f64; 4], turn: f64, handle: f64) -> BezPath {
        let node = |k: usize| {
            let angle = turn + FRAC_PI_2 * k as f64;
            let out = angles::direction(angle);
            (Point::ORIGIN + radii[k % 4] * out, out.turn_90())
        };
        let mut path = BezPath::new();
        path.move_to(node(0).0);
        for k in 0..4 {
            let ((p, u), (q, v)) = (node(k), node(k + 1));
            path.curve_to(p + handle * u, q - 1.3 * handle * v, q);
        }
        path.close_path();
        path
    }

    /// The largest turn at a node, degrees, and how far a point went from where it was.
    fn judged(path: &BezPath) -> (f64, f64) {
        let whole = outline(&Outline::new(vec![path.clone()]).unwrap());
        let points = |p: &BezPath| -> Vec<Point> {
            p.elements()
                .iter()
                .flat_map(|el| match *el {
                    PathEl::CurveTo(a, b, c) => vec![a, b, c],
                    _ => Vec::new(),
                })
                .collect()
        };
        let (was, is) = (points(path), points(&whole.contours()[0]));
        let moved = was.iter().zip(&is).map(|(a, b)| a.distance(*b));
        let moved = moved.fold(0.0, f64::max);
        let turns = (0..4).map(|k| {
            let (b, n, a) = (is[3 * k + 1], is[3 * k + 2], is[(3 * k + 3) % 12]);
            let (u, v) = (n - b, a - n);
            angle(u, v).abs().to_degrees()
        });
        (turns.fold(0.0, f64::max), moved)
    }

    proptest! {
        #[test]
        fn smooth_joins_stay_smooth(
            r in [60.0..300.0f64, 60.0..300.0f64, 60.0..300.0f64, 60.0..300.0f64],
            turn in 0.0..6.3f64,
            handle in 20.0..120.0f64,
        ) {
            let (bent, moved) = judged(&blob(r, turn, handle));
            prop_assert!(bent < 1.0, "{bent}");
            prop_assert!(moved < 2.2, "{moved}");
        }
    }

    #[test]
    fn extrema_keep_their_handles_level_and_the_grid_stays_as_it_is() {
        let path = blob([80.4; 4], 0.0, 44.3);
        let once = outline(&Outline::new(vec![path]).unwrap());
        for el in once.contours()[0].elements() {
            if let PathEl::CurveTo(_, b, c) = el {
                assert!((b.x - c.x).abs().min((b.y - c.y).abs()) < 1e-9, "{el:?}");
            }
        }
        assert_eq!(outline(&once), once);
    }

    #[test]
    fn a_handle_stays_on_the_line_before_it() {
        let path = BezPath::from_svg("M0 0L100.4 50.2C130.6 65.3 150 100 150 140L0 140Z").unwrap();
        let out = outline(&Outline::new(vec![path]).unwrap());
        let PathEl::CurveTo(a, ..) = out.contours()[0].elements()[2] else {
            panic!("{out:?}");
        };
        let turn = (Point::new(100.0, 50.0).to_vec2()).cross(a - Point::new(100.0, 50.0));
        assert!(turn.abs() < 1e-9, "{a:?}");
    }
}
