//! Course → stored points: a search for each span, a second one to close a ring.

use super::curve::{Course, Curve, Dot, Gate, Node, Span};
use super::glyf::{Stored, stored_bytes};
use super::search::{Care, Effort, Join, Otherwise, Search, Start};
use super::thin;
use kurbo::{Point, QuadBez, Vec2};
use std::iter;

/// The points of one contour, without the implied ones. None where the grid is too coarse.
pub(super) fn contour(course: &Course, effort: Effort) -> Option<Vec<Stored>> {
    let mut out = match course {
        Course::Spans(spans) => along(spans, effort)?,
        Course::Ring(curve, gate) => ring(curve, *gate, effort)?,
    };
    out.dedup_by(|a, b| a.on && b.on && (a.x, a.y) == (b.x, b.y));
    Some(out)
}

/// The points of spans between nodes, all lines within the limit. Where one is not, since its other end turns it,
/// curves may lie less far beside the lines that they end along.
fn along(spans: &[(Node, Span, Node)], effort: Effort) -> Option<Vec<Stored>> {
    /// Parts of the limit, one after the other; with none a line ends where it was drawn.
    const BESIDE: [f64; 4] = [1.0, 0.6, 0.3, 0.0];
    BESIDE.into_iter().find_map(|beside| {
        let runs = runs(spans, Effort { beside, ..effort })?;
        lines_hold(spans, &runs, effort.limit).then(|| joined(spans, &runs))
    })
}

/// The points of each span from its start to its end; none of lines.
fn runs(spans: &[(Node, Span, Node)], effort: Effort) -> Option<Vec<Vec<Stored>>> {
    let mut runs: Vec<Vec<Stored>> = Vec::new();
    for (i, (from, span, to)) in spans.iter().enumerate() {
        if from.rounded > effort.limit {
            return None;
        }
        let Span::Curve(curve) = span else {
            runs.push(Vec::new());
            continue;
        };
        // Where the curve before has ended, and where the first one began if this is the last.
        let met = runs.last().and_then(|r| r.last()).copied();
        let begun = runs.first().filter(|_| i + 1 == spans.len());
        let begun = begun.and_then(|r| r.first()).copied();
        let (from, to) = if spans.len() == 1 {
            // The only corner of a contour is met again before it could be known where it has moved.
            (from.held(from.at), to.held(to.at))
        } else {
            let held = |node: &Node, at: Option<Stored>| at.map_or(*node, |at| node.held(at));
            (held(from, met), held(to, begun))
        };
        let (start, points) = match open(curve, effort, from, to) {
            Some(joins) => (Stored::on(joins.first()?.m), stored(&joins)),
            None => (from.at, plain(curve, effort, to.at)?),
        };
        let run = iter::once(start).chain(points).collect();
        runs.push(thin::open(curve, effort, [from, to], run));
    }
    Some(runs)
}

/// Where the line of a span begins and ends: where the curves beside it do.
fn ends(spans: &[(Node, Span, Node)], runs: &[Vec<Stored>], i: usize) -> [Stored; 2] {
    let (from, _, to) = &spans[i];
    let (before, after) = ((i + spans.len() - 1) % spans.len(), (i + 1) % spans.len());
    [
        runs[before].last().copied().unwrap_or(from.at),
        runs[after].first().copied().unwrap_or(to.at),
    ]
}

/// Whether each line lies within the limit of what it is drawn along of the curves beside it.
fn lines_hold(spans: &[(Node, Span, Node)], runs: &[Vec<Stored>], limit: f64) -> bool {
    let n = spans.len();
    let dots = |i: usize| match &spans[i % n].1 {
        Span::Curve(c) => &c.dots[c.first..=c.last],
        Span::Line => &[],
    };
    (0..n).filter(|&i| runs[i].is_empty()).all(|i| {
        let [a, b] = ends(spans, runs, i).map(Stored::point);
        if a == b {
            return true;
        }
        let u = (b - a).normalize();
        let near = |o: &Dot| u.cross(o.p - a).abs() <= limit;
        let before = dots(i + n - 1).iter().rev();
        let after = dots(i + 1).iter();
        let (from, _, to) = &spans[i];
        // from a corner it is drawn along nothing
        let begins = from.along.is_none() || before.take_while(|o| u.dot(o.p - a) > 0.0).all(near);
        begins && (to.along.is_none() || after.take_while(|o| u.dot(o.p - b) < 0.0).all(near))
    })
}

/// All points around, each node's once.
fn joined(spans: &[(Node, Span, Node)], runs: &[Vec<Stored>]) -> Vec<Stored> {
    let mut out = Vec::new();
    for (i, run) in runs.iter().enumerate() {
        match run.split_last() {
            Some((_, rest)) => out.extend_from_slice(rest),
            None => out.push(ends(spans, runs, i)[0]),
        }
    }
    out
}

/// The points after the start of the cheapest path between two nodes.
#[cfg(test)]
pub(super) fn between(curve: &Curve, effort: Effort, from: Node, to: Node) -> Option<Vec<Stored>> {
    open(curve, effort, from, to).map(|joins| stored(&joins))
}

/// The cheapest path between two nodes that stays within the tolerance when it is measured densely.
/// Where the search ends before it has arrived it is repeated with more labels there, and where the path
/// strays between the places the search looked at, with less room there.
fn open(curve: &Curve, effort: Effort, from: Node, to: Node) -> Option<Vec<Join>> {
    /// Searches at most.
    const TRIES: usize = 8;
    let mut care = Care::default();
    for _ in 0..TRIES {
        let mut search = Search::new(curve, effort, to, None, care);
        let ends = search.run(Start::Node(from));
        let Some(&id) = ends.first() else {
            care = search.widened();
            continue;
        };
        let joins = search.path(id);
        // Between corners all of the curve counts, wherever the ends' feet lie.
        let first = from.along.is_none().then_some(curve.first as f64);
        let last = to.along.is_none().then_some(curve.last as f64);
        let strays = strays(curve, &joins, effort.limit, (first, last));
        if strays.is_empty() {
            return Some(joins);
        }
        care = search.tightened(&strays);
    }
    None
}

/// Where a path lies farther from its curve than the limit: from sample to sample, and which part of
/// the true distance the search had measured.
fn strays(
    curve: &Curve,
    joins: &[Join],
    limit: f64,
    (first, last): (Option<f64>, Option<f64>),
) -> Vec<((f64, f64), f64)> {
    /// Part of the limit that the dense measure may use: it looks between its samples no closer.
    const SURE: f64 = 0.998;
    let end = joins.len().saturating_sub(2);
    let quads = joins.windows(2).enumerate().filter_map(|(i, w)| {
        let c = w[1].c.unwrap_or(w[0].m.midpoint(w[1].m));
        let from = first.filter(|_| i == 0).unwrap_or(w[0].at());
        let to = last.filter(|_| i == end).unwrap_or(w[1].at());
        let far = curve.strays(QuadBez::new(w[0].m, c, w[1].m), from, to);
        (far > SURE * limit).then_some(((from, to), SURE * w[1].worst() / far))
    });
    quads.collect()
}

/// The points a path stores after its start: control points, and the joins that are not implied.
fn stored(joins: &[Join]) -> Vec<Stored> {
    let mut out = Vec::new();
    for (i, join) in joins.iter().enumerate().skip(1) {
        out.extend(join.c.map(Stored::off));
        let next = joins.get(i + 1).and_then(|j| j.c);
        let implied = matches!((join.c, next), (Some(c), Some(n)) if c.midpoint(n) == join.m);
        if !implied {
            out.push(Stored::on(join.m));
        }
    }
    out
}

/// The curve's own pieces to an end, where the effort ends with them.
fn plain(curve: &Curve, effort: Effort, to: Stored) -> Option<Vec<Stored>> {
    if effort.otherwise == Otherwise::Nothing {
        return None;
    }
    let pairs = curve.plain(effort.limit)?;
    let pieces = pairs.into_iter();
    let mut out: Vec<Stored> = pieces
        .flat_map(|(c, m)| [Stored::off(c), Stored::on(m)])
        .collect();
    *out.last_mut()? = to;
    Some(out)
}

fn ring(curve: &Curve, gate: Gate, effort: Effort) -> Option<Vec<Stored>> {
    let top = curve.dots[curve.first].p;
    let m = Point::new(top.x.round(), f64::from(gate.level));
    let along = Some(Vec2::new(curve.dots[curve.first].t.x.signum(), 0.0));
    let node = Node {
        at: Stored::on(m),
        along,
        rounded: top.distance(m),
        free: Vec2::ZERO,
    };
    let Some(joins) = open(curve, effort, node, node) else {
        return plain(curve, effort, node.at);
    };
    let first = thin::ring(curve, effort, stored(&joins));
    // Closing inside a run saves the on-curve point: try the control points of the first answer.
    let mut controls = joins.iter().filter_map(|j| j.c);
    let (Some(a), Some(b)) = (controls.next(), controls.next_back()) else {
        return Some(first);
    };
    let tries = [a.midpoint(m + (m - b)).round(), a];
    let closed = tries
        .into_iter()
        .filter_map(|next| closed(curve, gate, effort, (node, next)))
        .map(|run| thin::ring(curve, effort, run));
    closed
        .chain([first])
        .min_by_key(|run| stored_bytes(std::slice::from_ref(run)))
}

/// A ring whose first control point is `next`, closed by an implied point on the gate.
fn closed(
    curve: &Curve,
    gate: Gate,
    effort: Effort,
    (node, next): (Node, Point),
) -> Option<Vec<Stored>> {
    let mut search = Search::new(curve, effort, node, Some(gate), Care::default());
    let m = node.at.point();
    let ends = search.run(Start::Implied { m, next });
    ends.into_iter().find_map(|id| {
        let mut joins = search.path(id);
        let n = joins.len();
        let meet = joins.last()?.c?.midpoint(next);
        let second = joins.get(1).filter(|_| n > 2)?.m;
        let begin = curve.first as f64 + (meet - m).x * curve.dots[curve.first].t.x / curve.step;
        let opens = curve.follow(
            [meet, next, second],
            begin - 1.0,
            curve.last as f64,
            effort.limit,
        );
        joins[n - 1].m = meet;
        joins[0].m = meet;
        let fits = opens.is_some() && strays(curve, &joins, effort.limit, (None, None)).is_empty();
        let mut out = stored(&joins);
        // The last join is implied by the first control point.
        out.pop();
        fits.then_some(out)
    })
}
