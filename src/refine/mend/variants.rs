//! Other structures of a few nodes: what a drawing may have where another was fit.

use super::bends::{corner, cornered};
use super::side::{HOOKED, behind, reversed, unit};
use super::tips::tip;
use crate::numeric::angles::angle;
use crate::{
    numeric::{
        chain::{Chain, Join, Kind, Node},
        joins::divide,
    },
    refine::curves::polygon_px,
};
use kurbo::{CubicBez, ParamCurve, ParamCurveDeriv, ParamCurveNearest, Point, Vec2};

/// How much of each side a corner that is cut off may lose, px.
pub(super) const CUTS_PX: [f64; 2] = [0.8, 2.0];
/// And one that may be a round.
pub(super) const ROUNDS_PX: [f64; 2] = [2.0, 4.0];
/// So far from a smooth node its sides tell how sharp a corner would be, px.
const SHARP_PX: f64 = 4.0;
/// So far before and after a blunt end its sides lead to the tip that may be drawn there, px.
const AWAY_PX: [f64; 2] = [4.0, 8.0];
/// Such a tip turns by more, as the distance of its sides' unit vectors: 137°.
const SLENDER: f64 = 1.86;
/// And lies so far from the path, px.
const SHORT_PX: f64 = 1.0;
/// How much further out a tip is tried, as parts of the reach.
const PULLS: [f64; 2] = [0.4, 0.8];
/// Two nodes' sides lead to a corner no further than this, in gaps between the nodes.
const AHEAD: f64 = 6.0;
/// The largest part of a line that is bent.
const BENT: f64 = 0.5;
/// A round corner's handles, as parts of the way to its tip: those of a circle.
const ROUND: f64 = 0.55;
/// Segments at most in whose place a corner may be.
const RUN: usize = 3;
/// So near to a curve's end no node is put, parameter.
const INSIDE: f64 = 0.02;
/// How precisely the nearest place on a curve is found, px.
const NEAREST_PX: f64 = 1e-3;

/// Structures that differ from an open chain's by a few nodes within `reach` px of `p`, those of fewest nodes first.
pub(super) fn variants(chain: &Chain, p: Point, reach: f64) -> Vec<Chain> {
    let last = chain.kinds.len();
    let near = |i: &usize| chain.nodes[*i].point.distance(p) < reach;
    let mut out = Vec::new();
    for i in (1..last).filter(near) {
        if chain.nodes[i].join == Join::Corner {
            for px in CUTS_PX {
                out.push(cut(chain, i, px, Kind::Line));
                out.push(cut(chain, i, px, Kind::Cubic));
            }
            let pulled = |c: &Chain, parts: &[f64]| {
                let parts = parts.iter();
                let out = parts.filter_map(|part| pulled(c, i, part * reach));
                out.collect::<Vec<_>>()
            };
            out.extend(pulled(chain, &PULLS));
            let sharp = sharp(chain, i);
            if turning(&sharp.nodes[i], &chain.nodes[i]) > HOOKED {
                out.extend(pulled(&sharp, &PULLS));
                out.push(sharp);
            }
        } else {
            out.extend([joined(chain, i, Join::Corner), sharp(chain, i)]);
        }
        out.push(dropped(chain, i));
        for side in [i - 1, i] {
            out.extend(bent(chain, (side, i), reach));
        }
        let runs = (i + 1..last).take(RUN).take_while(near);
        out.extend(runs.map(|j| met(chain, i, j)));
    }
    let off = |i: &usize| chain.cubic(*i).nearest(p, NEAREST_PX);
    let nearest = (0..last).map(|i| (i, off(&i)));
    let nearest = nearest.min_by(|a, b| a.1.distance_sq.total_cmp(&b.1.distance_sq));
    out.extend(slender(chain, p));
    if let Some((i, at)) = nearest {
        out.push(other_kind(chain, i));
        let cubic = chain.kinds[i] == Kind::Cubic;
        if cubic && (INSIDE..1.0 - INSIDE).contains(&at.t) {
            let mut smooth = chain.clone();
            divide(&mut smooth, i, at.t, Join::Smooth);
            let corner = joined(&smooth, i + 1, Join::Corner);
            out.extend([smooth, corner]);
        }
    }
    out.sort_by_key(|c| c.nodes.len());
    out
}

/// With another join at node `i`.
fn joined(chain: &Chain, i: usize, join: Join) -> Chain {
    let mut chain = chain.clone();
    chain.nodes[i].join = join;
    chain
}

/// With a corner at node `i` where the sides turn just before it.
fn sharp(chain: &Chain, i: usize) -> Chain {
    let mut out = joined(chain, i, Join::Corner);
    let way = |c: CubicBez| c.eval(1.0 - behind(&c, SHARP_PX)) - c.p3;
    let chord = |c: &CubicBez| c.p0.distance(c.p3) / 3.0;
    let (before, after) = (chain.cubic(i - 1), chain.cubic(i));
    let node = &mut out.nodes[i];
    (node.arrive, node.leave) = (unit(-way(before)), unit(way(reversed(&after))));
    (node.back, node.ahead) = (chord(&before), chord(&after));
    out
}

/// With the slender tip to which both sides lead from beyond a blunt end at `p`, where the path ends short of it.
fn slender(chain: &Chain, p: Point) -> impl Iterator<Item = Chain> {
    let ends = AWAY_PX.iter().filter_map(move |px| cornered(chain, p, *px));
    ends.filter_map(|(c, i)| {
        let node = &c.nodes[i];
        let off = |s: usize| chain.cubic(s).nearest(node.point, NEAREST_PX).distance_sq;
        let short = || (0..chain.kinds.len()).all(|s| off(s) > SHORT_PX * SHORT_PX);
        ((node.arrive - node.leave).hypot() > SLENDER && short()).then_some(c)
    })
}

/// By how much the directions of a node differ from another's, radians.
fn turning(a: &Node, b: &Node) -> f64 {
    let [before, after] = [angle(a.arrive, b.arrive), angle(a.leave, b.leave)];
    before.abs().max(after.abs())
}

/// With a curve in place of a line, or a line in place of a curve.
fn other_kind(chain: &Chain, i: usize) -> Chain {
    let mut out = chain.clone();
    if chain.kinds[i] == Kind::Cubic {
        out.kinds[i] = Kind::Line;
        return out;
    }
    let (a, b) = chain.ends(i);
    let along = chain.direction(i);
    let third = out.nodes[a].point.distance(out.nodes[b].point) / 3.0;
    out.kinds[i] = Kind::Cubic;
    (out.nodes[a].leave, out.nodes[a].ahead) = (along, third);
    (out.nodes[b].arrive, out.nodes[b].back) = (along, third);
    out
}

/// With the end of a line at node `i` bent, from a new node `px` before it on: by a curve that leaves the line
/// smoothly, or by another line.
fn bent(chain: &Chain, (line, i): (usize, usize), px: f64) -> Vec<Chain> {
    let c = chain.cubic(line);
    let part = px / c.p0.distance(c.p3);
    if chain.kinds[line] != Kind::Line || part > BENT {
        return Vec::new();
    }
    let ends = |join: Join, by: Kind| {
        let mut out = chain.clone();
        let before = line < i;
        divide(&mut out, line, if before { 1.0 - part } else { part }, join);
        out.kinds[line] = if before { Kind::Line } else { by };
        out.kinds[line + 1] = if before { by } else { Kind::Line };
        out
    };
    vec![
        ends(Join::Smooth, Kind::Cubic),
        ends(Join::Corner, Kind::Line),
    ]
}

/// With corner `i` cut off about `px` from its tip, by a line or by a curve that goes on smoothly.
pub(super) fn cut(chain: &Chain, i: usize, px: f64, by: Kind) -> Chain {
    let mut out = chain.clone();
    let sides = [chain.cubic(i - 1), reversed(&chain.cubic(i))];
    let [before, after] = sides.map(|c| c.subsegment(0.0..1.0 - behind(&c, px)));
    let after = reversed(&after);
    let tip = chain.nodes[i].point;
    let join = match by {
        Kind::Line => Join::Corner,
        Kind::Cubic => Join::Smooth,
    };
    out.nodes[i - 1].ahead = before.p0.distance(before.p1);
    out.nodes[i + 1].back = after.p2.distance(after.p3);
    let (u, v) = (
        unit(before.deriv().eval(1.0).to_vec2()),
        unit(after.deriv().eval(0.0).to_vec2()),
    );
    let first = Node {
        point: before.p3,
        join,
        arrive: u,
        leave: u,
        back: before.p2.distance(before.p3),
        ahead: ROUND * tip.distance(before.p3),
    };
    let second = Node {
        point: after.p0,
        join,
        arrive: v,
        leave: v,
        back: ROUND * tip.distance(after.p0),
        ahead: after.p0.distance(after.p1),
    };
    out.nodes.splice(i..=i, [first, second]);
    out.kinds.insert(i, by);
    out
}

/// With the tip at corner `i` `px` further out, its sides' handles where they were.
fn pulled(chain: &Chain, i: usize, px: f64) -> Option<Chain> {
    let (arrive, leave) = tip(chain, i)?;
    let mut out = chain.clone();
    let node = &mut out.nodes[i];
    let (back, front) = (
        node.point - node.back * arrive,
        node.point + node.ahead * leave,
    );
    node.point += px * unit(arrive - leave);
    (node.back, node.ahead) = (node.point.distance(back), node.point.distance(front));
    (node.arrive, node.leave) = (unit(node.point - back), unit(front - node.point));
    Some(out)
}

/// Without node `i`.
fn dropped(chain: &Chain, i: usize) -> Chain {
    let mut out = chain.clone();
    let (before, after) = (chain.cubic(i - 1), chain.cubic(i));
    let third = (polygon_px(&before) + polygon_px(&after)) / 3.0;
    let along = unit(after.p3 - before.p0);
    let lines = [i - 1, i].map(|s| chain.kinds[s] == Kind::Line);
    let free = |n: usize| matches!(chain.nodes[n].join, Join::Corner | Join::End);
    if lines[0] && free(i - 1) {
        out.nodes[i - 1].leave = along;
    }
    if lines[1] && free(i + 1) {
        out.nodes[i + 1].arrive = along;
    }
    out.nodes[i - 1].ahead = third;
    out.nodes[i + 1].back = third;
    out.nodes.remove(i);
    out.kinds.remove(i);
    out.kinds[i - 1] = if lines == [true; 2] {
        Kind::Line
    } else {
        Kind::Cubic
    };
    out
}

/// With one corner in place of the nodes from `i` to `j`, where both sides lead.
fn met(chain: &Chain, i: usize, j: usize) -> Chain {
    let mut out = chain.clone();
    let (a, b) = (chain.nodes[i], chain.nodes[j]);
    let along = |segment: usize, own: Vec2| match chain.kinds[segment] {
        Kind::Line => chain.direction(segment),
        Kind::Cubic => own,
    };
    let (u, v) = (along(i - 1, a.arrive), along(j, b.leave));
    let corner = corner((a.point, u, a.back), (b.point, v, b.ahead), AHEAD);
    out.nodes.splice(i..=j, [corner]);
    out.kinds.drain(i..j);
    out
}
