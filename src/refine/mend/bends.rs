//! Bends too tight for a lens to tell from corners, and the corners in their place.

use super::side::{HOOKED, behind, reversed, unit};
use crate::numeric::angles::angle;
use crate::{
    numeric::chain::{Chain, Join, Node},
    refine::curves::arriving,
};
use kurbo::{CubicBez, ParamCurve, ParamCurveDeriv, ParamCurveNearest, Point, Vec2};

/// A bend is tight if the path turns by more, radians, between places so far before and after it, px.
const TURN: f64 = 1.0;
const WITHIN_PX: f64 = 2.0;
/// Way over which a direction is taken, and between the places that are looked at, px.
const CHORD_PX: f64 = 1.0;
const STEP_PX: f64 = 0.5;
/// A bend nearer to a corner, or to one that is tighter, is part of it, px.
const APART_PX: f64 = 4.0;
/// A corner in the place of a bend turns by more, radians: one that turns less is a bend that hides in its sides.
const SHARP: f64 = 0.87;
/// Its sides turn less than corners' do on the way of so many px before it.
const SIDE_PX: f64 = 1.5;
/// A corner whose sides turn there by more, radians, may be where they lead from further away.
const BENT: f64 = 0.06;
/// Sides of which a way is seen lead to a corner no further than this, in gaps between them.
const AHEAD: f64 = 12.0;
/// Places along a segment that are looked at for its length.
const STEPS: usize = 32;
/// How precisely the nearest place on a curve is found, px.
const NEAREST_PX: f64 = 1e-3;

/// Tight bends of a ring, the tightest first; `chords` come back to their start.
pub(super) fn tight_bends(chain: &Chain, chords: &[Point]) -> Vec<Point> {
    let way = Way::new(chords);
    let reach = WITHIN_PX + CHORD_PX;
    if way.length < 4.0 * reach {
        return Vec::new();
    }
    let corner = |n: &&Node| n.join == Join::Corner;
    let mut taken: Vec<Point> = chain.nodes.iter().filter(corner).map(|n| n.point).collect();
    let mut found = Vec::new();
    let mut gone = 0.0;
    while gone < way.length {
        let [a, b, c, d] = [-reach, -WITHIN_PX, WITHIN_PX, reach].map(|s| way.at(gone + s));
        let (u, v) = (b - a, d - c);
        // one of less than an eighth of a round, as nearly all are, is told without an arctangent
        let little = u.cross(v).abs() < u.dot(v);
        if !little && angle(u, v).abs() > TURN {
            // the nearer its two sides come, the nearer is the middle of a bend
            found.push((b.distance(c), way.at(gone)));
        }
        gone += STEP_PX;
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let first = taken.len();
    for (_, p) in found {
        if taken.iter().all(|q| q.distance(p) >= APART_PX) {
            taken.push(p);
        }
    }
    taken.split_off(first)
}

/// A closed polygon by the way along it.
struct Way<'a> {
    chords: &'a [Point],
    /// way to each of its points, px
    gone: Vec<f64>,
    length: f64,
}

impl<'a> Way<'a> {
    fn new(chords: &'a [Point]) -> Self {
        let mut length = 0.0;
        let steps = chords.iter().zip(chords.iter().skip(1));
        let steps = steps.map(|(a, b)| {
            length += a.distance(*b);
            length
        });
        let gone = std::iter::once(0.0).chain(steps).collect();
        Self {
            chords,
            gone,
            length,
        }
    }

    /// The place so far along, px, counted around.
    fn at(&self, px: f64) -> Point {
        // no further than once around
        let px = if px < 0.0 {
            px + self.length
        } else if px < self.length {
            px
        } else {
            px - self.length
        };
        let last = self.chords.len() - 1;
        let next = self.gone.partition_point(|g| *g <= px).clamp(1, last);
        let (a, b) = (self.gone[next - 1], self.gone[next]);
        let t = (px - a) / (b - a).max(1e-12);
        self.chords[next - 1].lerp(self.chords[next], t.clamp(0.0, 1.0))
    }
}

/// An open chain with a corner near `p`, where its sides lead from `px` before and after that place, and the corner's
/// node; `None` where it ends before.
pub(super) fn cornered(chain: &Chain, p: Point, px: f64) -> Option<(Chain, usize)> {
    let last = chain.kinds.len();
    let off = |i: usize| (i, chain.cubic(i).nearest(p, NEAREST_PX));
    let nearest = (0..last).map(off);
    let (i, at) = nearest.min_by(|a, b| a.1.distance_sq.total_cmp(&b.1.distance_sq))?;
    let back = |s: usize| reversed(&chain.cubic(s));
    let (a, ta) = walked((0..=i).rev().map(|s| (s, back(s))), 1.0 - at.t, px)?;
    let (b, tb) = walked((i..last).map(|s| (s, chain.cubic(s))), at.t, px)?;
    let before = chain.cubic(a).subsegment(0.0..1.0 - ta);
    let after = chain.cubic(b).subsegment(tb..1.0);
    let u = unit(before.deriv().eval(1.0).to_vec2());
    let v = unit(after.deriv().eval(0.0).to_vec2());
    let corner = corner(
        (before.p3, u, before.p2.distance(before.p3)),
        (after.p0, v, after.p0.distance(after.p1)),
        AHEAD,
    );
    let mut out = chain.clone();
    out.nodes[a].ahead = before.p0.distance(before.p1);
    out.nodes[b + 1].back = after.p2.distance(after.p3);
    out.nodes.splice(a + 1..=b, [corner]);
    out.kinds.splice(a..=b, [chain.kinds[a], chain.kinds[b]]);
    Some((out, a + 1))
}

/// Whether a chain has a corner for a bend at `p`: one to which both sides lead, and turn no more just before it than
/// they do in the chain it came `from`, if that has one.
pub(super) fn is_cornered(chain: &Chain, p: Point, from: &Chain) -> bool {
    let near = |c: &Chain| {
        let near = |i: &usize| {
            let node = &c.nodes[*i];
            node.join == Join::Corner && node.point.distance(p) < APART_PX
        };
        let near = (1..c.kinds.len()).filter(near);
        near.collect::<Vec<_>>()
    };
    let before = near(from).into_iter().map(|i| last_turn(from, i));
    let most = before.reduce(f64::max).unwrap_or(HOOKED);
    let corners = near(chain).into_iter();
    corners
        .filter(|i| is_sharp(chain, *i))
        .any(|i| last_turn(chain, i) <= most)
}

/// Whether an inner node is a corner to which both sides lead: they do not hook just before it.
pub(super) fn is_sharp(chain: &Chain, i: usize) -> bool {
    let Some([before, after]) = sides(chain, i) else {
        return false;
    };
    let (u, v) = (arriving(&before), arriving(&after));
    libm::atan2(-u.cross(v), -u.dot(v)).abs() > SHARP && last_turn(chain, i) < HOOKED
}

/// Whether a node is a corner one of whose sides turns just before it.
pub(super) fn is_bent(chain: &Chain, i: usize) -> bool {
    chain.nodes[i].join == Join::Corner && last_turn(chain, i) > BENT
}

/// By how much the sides of a node turn just before it, the one that turns more, radians.
fn last_turn(chain: &Chain, i: usize) -> f64 {
    let turn = |side: CubicBez| {
        let last = side.p3 - side.eval(1.0 - behind(&side, SIDE_PX));
        angle(last, arriving(&side)).abs()
    };
    let sides = sides(chain, i).into_iter().flatten();
    sides.map(turn).fold(0.0, f64::max)
}

/// Both sides of a node, each on its way there.
fn sides(chain: &Chain, i: usize) -> Option<[CubicBez; 2]> {
    let (before, after) = chain.before(i).zip(chain.after(i))?;
    Some([chain.cubic(before), reversed(&chain.cubic(after))])
}

/// The corner where two sides meet, each carried on from a place, in a direction, with a handle so long, `most` gaps
/// between the places at most; halfway between these where they do not.
pub(super) fn corner(
    (p, u, back): (Point, Vec2, f64),
    (q, v, ahead): (Point, Vec2, f64),
    most: f64,
) -> Node {
    let gap = q - p;
    let cross = u.cross(v);
    let (on, off) = (gap.cross(v) / cross, -gap.cross(u) / cross);
    let far = most * gap.hypot();
    let (point, on, off) = if (0.0..far).contains(&on) && (0.0..far).contains(&off) {
        (p + on * u, on, off)
    } else {
        (p.midpoint(q), 0.0, 0.0)
    };
    Node {
        point,
        join: Join::Corner,
        arrive: u,
        leave: v,
        back: back + on,
        ahead: ahead + off,
    }
}

/// The segment and the parameter on it `px` further on than `from` on the first of some segments that follow each
/// other.
fn walked(
    segments: impl Iterator<Item = (usize, CubicBez)>,
    from: f64,
    px: f64,
) -> Option<(usize, f64)> {
    let mut left = px;
    let mut from = from;
    for (segment, c) in segments {
        let mut p = c.eval(from);
        for k in 1..=STEPS {
            let t = from + (1.0 - from) * k as f64 / STEPS as f64;
            let q = c.eval(t);
            left -= p.distance(q);
            if left <= 0.0 && t < 1.0 {
                return Some((segment, t));
            }
            p = q;
        }
        from = 0.0;
    }
    None
}
