//! Two answers of one contour → the cheapest run of points that changes between them where they meet.

use super::assemble;
use super::glyf::{Pen, Stored};
use super::search::smooth;
use crate::numeric::distance::Polyline;
use kurbo::{ParamCurve, Point, QuadBez, Vec2};
use std::collections::BTreeMap;

/// The cheapest of both rings and of those that follow one and the other by turns. They run the same way around, each
/// within `limit` (units) of one contour.
pub(super) fn splice(a: Vec<Stored>, b: Vec<Stored>, limit: f64) -> Vec<Stored> {
    let both = [&a, &b].map(Vec::as_slice);
    let turns = by_turns(both, &meetings(both), limit);
    let all = turns.into_iter().chain([a, b]);
    all.min_by_key(|c| assemble::bytes(c)).unwrap_or_default()
}

/// The point that stands `by` behind one of a ring.
fn after(ring: &[Stored], i: usize, by: usize) -> Stored {
    ring[(i + by) % ring.len()]
}

/// Where one ring may be left for the other: indices of a point that both have, in the order of both.
fn meetings([a, b]: [&[Stored]; 2]) -> Vec<(usize, usize)> {
    // Points that a ring passes twice tell nothing.
    let once = |ring: &[Stored]| {
        let mut all: BTreeMap<Stored, Option<usize>> = BTreeMap::new();
        for (i, &p) in ring.iter().enumerate() {
            let seen = all.entry(p).or_insert(Some(i));
            *seen = seen.filter(|&first| first == i);
        }
        all
    };
    let (in_a, in_b) = (once(a), once(b));
    let may_change = |&(i, j): &(usize, usize)| {
        let p = a[i];
        let (from, to) = (
            [after(a, i, a.len() - 1), after(b, j, b.len() - 1)],
            [after(a, i, 1), after(b, j, 1)],
        );
        let passes = |k: usize, l: usize| {
            let u = p.point() - from[k].point();
            u != Vec2::ZERO && smooth(u.normalize(), to[l].point() - p.point())
        };
        // A control point is left together with the join behind it; at a corner anything goes.
        let is_smooth = p.on && (passes(0, 0) || passes(1, 1));
        to[0] == to[1] || (p.on && (!is_smooth || (passes(0, 1) && passes(1, 0))))
    };
    let place = |all: &BTreeMap<Stored, Option<usize>>, p: &Stored| *all.get(p)?;
    let shared = a
        .iter()
        .filter_map(|p| Some((place(&in_a, p)?, place(&in_b, p)?)));
    let shared: Vec<(usize, usize)> = shared.filter(may_change).collect();
    let next = shared.iter().cycle().skip(1);
    let turns_back = shared.iter().zip(next).filter(|(p, q)| q.1 <= p.1);
    // In one order around both rings the index of the second falls back once, at its start.
    if turns_back.count() == 1 {
        shared
    } else {
        Vec::new()
    }
}

/// The cheapest ring that may change at each meeting, from the first one on. None where rings that meet do not draw the
/// same from one meeting to the next: then it is not at one place of the contour that they meet.
fn by_turns(rings: [&[Stored]; 2], meetings: &[(usize, usize)], limit: f64) -> Option<Vec<Stored>> {
    let &(start, _) = meetings.first().filter(|_| meetings.len() > 1)?;
    let mut ways = vec![(0, Pen::after(rings[0][start]), Vec::new())];
    let next = meetings.iter().cycle().skip(1);
    for (from, to) in meetings.iter().zip(next) {
        let pieces = [(from.0, to.0), (from.1, to.1)];
        let pieces = rings.iter().zip(pieces).map(|(ring, (i, j))| {
            let many = (j + ring.len() - i - 1) % ring.len() + 1;
            (1..=many).map(|k| after(ring, i, k)).collect::<Vec<_>>()
        });
        let pieces: Vec<_> = pieces.collect();
        let begin = after(rings[0], from.0, 0);
        if !alike(begin, [&pieces[0], &pieces[1]], limit) {
            return None;
        }
        let along = |piece: Vec<Stored>| {
            let walked = ways.iter().map(|(cost, pen, _)| {
                let mut pen = *pen;
                let bytes: u32 = piece.iter().map(|&p| pen.store(p)).sum();
                (cost + bytes, pen)
            });
            let ((cost, pen), way) = walked.zip(&ways).min_by_key(|((cost, _), _)| *cost)?;
            Some((cost, pen, [way.2.as_slice(), &piece].concat()))
        };
        ways = pieces.into_iter().filter_map(along).collect();
    }
    let rings = ways.into_iter().map(|(_, _, ring)| ring);
    rings.min_by_key(|c| assemble::bytes(c))
}

/// Whether two runs of points that begin behind `begin` draw the same, as runs do that are within `limit` (units) of
/// one stretch of a contour.
fn alike(begin: Stored, pieces: [&[Stored]; 2], limit: f64) -> bool {
    /// How far they lie from each other at most, limits: twice, and what their samples leave.
    const APART: f64 = 2.5;
    let drawn = pieces.map(|piece| drawn(begin, piece));
    let within = |one: &[Point], other: &[Point]| {
        let line = Polyline::new(other.to_vec());
        line.is_none_or(|line| line.is_within(one.iter().copied(), APART * limit))
    };
    within(&drawn[0], &drawn[1]) && within(&drawn[1], &drawn[0])
}

/// Points of what a run draws between the points that it begins and ends with.
fn drawn(begin: Stored, piece: &[Stored]) -> Vec<Point> {
    /// Points of a quadratic.
    const SAMPLES: usize = 4;
    let all: Vec<Stored> = [&[begin], piece].concat();
    let join = |a: Stored, b: Stored| match (a.on, b.on) {
        (true, _) => a.point(),
        (_, true) => b.point(),
        _ => a.point().midpoint(b.point()),
    };
    let mut out = vec![join(all[0], all[1])];
    for w in all.windows(3) {
        let end = join(w[2], w[1]);
        if w[1].on {
            out.push(w[1].point());
        } else {
            let quad = QuadBez::new(join(w[0], w[1]), w[1].point(), end);
            out.extend((1..=SAMPLES).map(|i| quad.eval(i as f64 / SAMPLES as f64)));
        }
    }
    out.extend(all.last().filter(|p| p.on).map(|p| p.point()));
    out
}

#[cfg(test)]
mod tests {
    use super::{Stored, splice};
    use crate::quadratic::rate::assemble;

    const LIMIT: f64 = 100.0;

    fn ring(points: &[(i32, i32, bool)]) -> Vec<Stored> {
        let stored = |&(x, y, on): &(i32, i32, bool)| Stored { x, y, on };
        points.iter().map(stored).collect()
    }

    #[test]
    fn each_half_is_taken_where_it_is_cheaper() {
        // corners at 0 and at 400; a is short on the way out, b on the way back
        let (out, back) = ((200, 90, false), (200, -90, false));
        let a = [(0, 0, true), out, (400, 0, true), (300, -80, true), back];
        let b = [(400, 0, true), back, (0, 0, true), (100, 80, true), out];
        let (a, b) = (ring(&a), ring(&b));
        let both = splice(a.clone(), b.clone(), LIMIT);
        assert_eq!(both.len(), 4, "{both:?}");
        assert!(assemble::bytes(&both) < assemble::bytes(&a).min(assemble::bytes(&b)));
        assert_eq!(
            assemble::bytes(&splice(b, a, LIMIT)),
            assemble::bytes(&both)
        );
    }

    #[test]
    fn no_smooth_join_becomes_a_corner() {
        // both pass the origin smoothly, but not in one direction
        let a = [
            (-90, -9, false),
            (0, 0, true),
            (90, 9, false),
            (200, 0, true),
            (-200, 9, true),
        ];
        let b = [
            (-90, 9, false),
            (0, 0, true),
            (90, -9, false),
            (200, 0, true),
            (-200, 0, true),
        ];
        let both = splice(ring(&a), ring(&b), LIMIT);
        let at = both.iter().position(|p| (p.x, p.y) == (0, 0)).unwrap();
        assert_eq!(both[at - 1].y, -both[at + 1].y, "{both:?}");
    }

    #[test]
    fn rings_that_never_meet_stay() {
        let a = ring(&[(0, 0, false), (9, 0, false), (9, 9, false), (0, 9, false)]);
        let b = ring(&[(1, 0, false), (300, 0, false), (9, 8, false), (0, 8, false)]);
        assert_eq!(splice(a.clone(), b, LIMIT), a);
        assert_eq!(splice(Vec::new(), a, LIMIT), Vec::new());
    }
}
