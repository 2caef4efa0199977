//! Where the pieces begin: end points by curvature, and the spline through them.

use super::spline::Spline;
use crate::numeric::skyline::Skyline;
use crate::numeric::turns::{Ends, Walk};
use kurbo::Point;

/// Least turn over the reach that makes a point an end point, radians.
const BEND: f64 = 0.35;
/// Turn over the reach that is a sharp corner, which takes two end points, radians.
const CORNER: f64 = 1.3;
/// Without a number given, no piece is longer than this part of the whole.
const LONGEST: f64 = 1.0 / 8.0;

/// Weights that rise with the curvature to `ratio` times the least, and sum to 1 [lumilios93 sec. 5].
pub(super) fn weights(walk: &Walk<'_>, reach: f64, ratio: f64) -> Vec<f64> {
    let turns: Vec<f64> = walk.turns(reach).iter().map(|t| t.abs()).collect();
    let most = turns.iter().copied().fold(BEND, f64::max);
    let raw: Vec<f64> = turns
        .iter()
        .map(|t| 1.0 + (ratio - 1.0) * t / most)
        .collect();
    let sum: f64 = raw.iter().sum();
    raw.iter().map(|w| w / sum).collect()
}

/// Indices of the end points, in order: bends, then the middles of the longest gaps. An open row has its
/// outer points among them. With `count`, so many of them if the points allow.
pub(super) fn end_points(
    walk: &Walk<'_>,
    kind: Ends,
    reach: f64,
    count: Option<usize>,
) -> Vec<usize> {
    let s = walk.lengths();
    let last = s.len() - 1;
    let outer: &[usize] = if kind == Ends::Closed {
        &[]
    } else {
        &[0, last]
    };
    let mut bends = bends(walk, kind, reach);
    bends.retain(|(i, _)| !outer.contains(i));
    if let Some(count) = count {
        bends.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        bends.truncate(count.saturating_sub(outer.len()));
    }
    let mut ends: Vec<usize> = bends
        .iter()
        .map(|b| b.0)
        .chain(outer.iter().copied())
        .collect();
    if ends.is_empty() {
        ends.push(0);
    }
    ends.sort_unstable();
    ends.dedup();
    let total = walk.total();
    while let Some((place, index, gap)) = middle(s, total, kind, &ends) {
        let enough = count.map_or(ends.len() >= 4 && gap <= LONGEST * total, |c| {
            ends.len() >= c
        });
        if enough {
            break;
        }
        ends.insert(place, index);
    }
    ends
}

/// Indices of so many end points the same way along from each other, in order, as far as the points allow.
pub(super) fn even(walk: &Walk<'_>, kind: Ends, count: usize) -> Vec<usize> {
    let s = walk.lengths();
    let gaps = if kind == Ends::Closed {
        count
    } else {
        count - 1
    };
    let step = walk.total() / gaps.max(1) as f64;
    let at = |k: usize| s.partition_point(|&s| s < k as f64 * step - 1e-9 * step);
    let mut ends: Vec<usize> = (0..count).map(|k| at(k).min(s.len() - 1)).collect();
    ends.dedup();
    ends
}

/// The local maxima of the turn with its size; sharp corners give a point on either side instead.
fn bends(walk: &Walk<'_>, ends: Ends, reach: f64) -> Vec<(usize, f64)> {
    let closed = ends == Ends::Closed;
    let turns: Vec<f64> = walk.turns(reach).iter().map(|t| t.abs()).collect();
    let (n, s) = (turns.len(), walk.lengths());
    let step = |i: usize, way: usize| {
        let j = (i + way) % n;
        (closed || i.abs_diff(j) == 1).then_some(j)
    };
    let apart = |i: usize, j: usize| {
        let d = (s[i] - s[j]).abs();
        if closed { d.min(walk.total() - d) } else { d }
    };
    let side = |i: usize, way: usize, within: f64| {
        let mut j = i;
        let mut out = Vec::new();
        while let Some(k) = step(j, way).filter(|&k| k != i && apart(i, k) <= within) {
            out.push(k);
            j = k;
        }
        out
    };
    let mut found = Vec::new();
    for i in 0..n {
        if turns[i] < BEND {
            continue;
        }
        let rivals = side(i, 1, 2.0 * reach)
            .into_iter()
            .chain(side(i, n - 1, 2.0 * reach));
        let beaten = |j: usize| turns[j] > turns[i] || (turns[j] >= turns[i] && j < i);
        if rivals.into_iter().any(beaten) {
            continue;
        }
        if turns[i] < CORNER {
            found.push((i, turns[i]));
        } else {
            let both = [side(i, 1, reach), side(i, n - 1, reach)];
            found.extend(
                both.iter()
                    .map(|b| (b.last().copied().unwrap_or(i), turns[i])),
            );
        }
    }
    found
}

/// The middle of the longest gap: its place in the list, the point's index, and the gap's length.
fn middle(s: &[f64], total: f64, kind: Ends, ends: &[usize]) -> Option<(usize, usize, f64)> {
    let n = s.len();
    let around = (kind == Ends::Closed)
        .then(|| ends.first().map(|&f| (f + n, s[f] + total)))
        .flatten();
    let nexts = ends.iter().skip(1).map(|&i| (i, s[i])).chain(around);
    let gaps = ends
        .iter()
        .zip(nexts)
        .enumerate()
        .filter(|(_, (a, b))| **a + 1 < b.0);
    let (place, (&a, (b, sb))) = gaps.max_by(|x, y| {
        let length = |(_, (a, b)): &(usize, (&usize, (usize, f64)))| b.1 - s[**a];
        length(x).total_cmp(&length(y)).then(y.0.cmp(&x.0))
    })?;
    let along = |k: usize| s[k % n] + if k >= n { total } else { 0.0 };
    let half = s[a].midpoint(sb);
    let nearest =
        (a + 1..b).min_by(|&x, &y| (along(x) - half).abs().total_cmp(&(along(y) - half).abs()))?;
    let index = nearest % n;
    let place = if nearest >= n {
        ends.partition_point(|&e| e < index)
    } else {
        place + 1
    };
    Some((place, index, sb - s[a]))
}

/// The spline whose pieces begin at `q` (eq. 20): of a ring, or natural at the ends of an open row.
pub(super) fn through(q: &[Point], ends: Ends) -> Option<Spline> {
    let n = q.len();
    let closed = ends == Ends::Closed;
    if closed {
        let first: Vec<usize> = (0..n)
            .map(|i| if i + 1 == n { 0 } else { i.saturating_sub(1) })
            .collect();
        // vertex j + 1 lies over end point j
        let c = solve(&first, q.to_vec(), |i| Some((i + 1) % n))?;
        let around = c.iter().cycle().skip(n - 1).take(n + 3);
        return Some(Spline {
            vertices: around.copied().collect(),
            closed,
        });
    }
    let (&a, &b) = (q.first()?, q.last()?);
    let mut right = q.get(1..n - 1)?.to_vec();
    if let Some(r) = right.first_mut() {
        *r -= a.to_vec2() / 6.0;
    }
    if let Some(r) = right.last_mut() {
        *r -= b.to_vec2() / 6.0;
    }
    let m = right.len();
    let first: Vec<usize> = (0..m).map(|i: usize| i.saturating_sub(1)).collect();
    let inner = solve(&first, right, |i| (i + 1 < m).then_some(i + 1))?;
    let mut vertices = Vec::with_capacity(n + 2);
    vertices.extend([a, a]);
    vertices.extend(inner);
    vertices.extend([b, b]);
    if let [v0, v1, v2, ..] = vertices.as_mut_slice() {
        *v0 = (v1.to_vec2() * 2.0 - v2.to_vec2()).to_point();
    }
    if let [.., v2, v1, v0] = vertices.as_mut_slice() {
        *v0 = (v1.to_vec2() * 2.0 - v2.to_vec2()).to_point();
    }
    Some(Spline { vertices, closed })
}

/// Solves rows of 1/6, 4/6, 1/6; `next` tells the neighbour after each unknown.
fn solve(
    first: &[usize],
    right: Vec<Point>,
    next: impl Fn(usize) -> Option<usize>,
) -> Option<Vec<Point>> {
    let n = first.len();
    let mut matrix = Skyline::default();
    matrix.reset(first);
    for i in 0..n {
        matrix.add(i, i, 4.0 / 6.0);
        if let Some(j) = next(i) {
            matrix.add(i, j, 1.0 / 6.0);
        }
    }
    let mut x: Vec<f64> = right.iter().map(|p| p.x).collect();
    let mut y: Vec<f64> = right.iter().map(|p| p.y).collect();
    (matrix.solve_damped(0.0, &mut x) && matrix.solve_damped(0.0, &mut y))
        .then(|| x.into_iter().zip(y).map(Point::from).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_spline_passes_through_its_end_points() {
        let q: Vec<Point> = [(0.0, 0.0), (5.0, 1.0), (7.0, 6.0), (2.0, 8.0), (-3.0, 5.0)]
            .map(Point::from)
            .into();
        for ends in [Ends::Closed, Ends::Open] {
            let s = through(&q, ends).unwrap();
            assert_eq!(s.pieces(), if ends == Ends::Closed { 5 } else { 4 });
            for (j, p) in q.iter().enumerate() {
                assert!(s.place(j as f64).p.distance(*p) < 1e-12, "{ends:?} {j}");
            }
        }
        assert_eq!(through(&q[..2], Ends::Open).unwrap().pieces(), 1);
    }

    #[test]
    fn as_many_end_points_as_asked_for() {
        let square: Vec<Point> = (0..80_u8)
            .map(|i| {
                let t = f64::from(i % 20);
                [(t, 0.0), (20.0, t), (20.0 - t, 20.0), (0.0, 20.0 - t)][usize::from(i / 20)].into()
            })
            .collect();
        let ring = Walk::new(&square, Ends::Closed);
        for count in [3, 4, 8, 15, 40] {
            let e = end_points(&ring, Ends::Closed, 3.0, Some(count));
            assert_eq!(e.len(), count);
            assert!(e.windows(2).all(|w| w[0] < w[1]), "{e:?}");
        }
        assert!(
            end_points(&ring, Ends::Closed, 3.0, None).len() >= 8,
            "two at every corner"
        );
        let open = Walk::new(&square[..40], Ends::Open);
        let e = end_points(&open, Ends::Open, 3.0, Some(6));
        assert_eq!((e.len(), e[0], e[5]), (6, 0, 39));
    }

    #[test]
    fn even_end_points_lie_evenly() {
        let row: Vec<Point> = (0..=100_u8).map(|i| (f64::from(i), 0.0).into()).collect();
        let open = even(&Walk::new(&row, Ends::Open), Ends::Open, 5);
        assert_eq!(open, [0, 25, 50, 75, 100]);
        let ring: Vec<Point> = (0..60_u8)
            .map(|i| {
                let a = f64::from(i) / 60.0 * std::f64::consts::TAU;
                (libm::cos(a), libm::sin(a)).into()
            })
            .collect();
        let closed = even(&Walk::new(&ring, Ends::Closed), Ends::Closed, 6);
        assert_eq!(closed, [0, 10, 20, 30, 40, 50]);
    }
}
