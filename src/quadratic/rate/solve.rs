//! Course → stored points: a search for each span, a second one to close a ring.

use super::curve::{Course, Curve, Gate, Node, Span, count};
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

fn along(spans: &[(Node, Span, Node)], effort: Effort) -> Option<Vec<Stored>> {
    let ends_curved = matches!(spans.last(), Some((_, Span::Curve(_), _)));
    let mut out = Vec::new();
    // Where the curve before has ended, and where the first one began if the last one ends there.
    let (mut met, mut begun) = (None, None);
    for (i, (from, span, to)) in spans.iter().enumerate() {
        if from.rounded > effort.limit {
            return None;
        }
        // A curve's last point is stored with it.
        let stores = met.is_none() && (i > 0 || !ends_curved);
        let Span::Curve(curve) = span else {
            out.extend(stores.then_some(from.at));
            met = None;
            continue;
        };
        let last = i + 1 == spans.len();
        // The only corner of a contour is met again before it could be known where it has moved.
        let from = &if spans.len() == 1 {
            from.held(from.at)
        } else {
            *from
        };
        let to = &if spans.len() == 1 {
            to.held(to.at)
        } else {
            *to
        };
        let from = met.map_or(*from, |m| from.held(m));
        let to = begun.filter(|_| last).map_or(*to, |m| to.held(m));
        let (start, points) = match open(curve, effort, from, to) {
            Some(joins) => (Stored::on(joins.first()?.m), stored(&joins)),
            None => (from.at, plain(curve, effort, to.at)?),
        };
        let run = iter::once(start).chain(points).collect();
        let run = thin::open(curve, effort, [from, to], run);
        let (&start, points) = run.split_first()?;
        out.extend(stores.then_some(start));
        begun = begun.or((i == 0).then_some(start));
        met = points.last().copied();
        out.extend_from_slice(points);
    }
    Some(out)
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
        let first = from.along.is_none().then(|| count(curve.first));
        let last = to.along.is_none().then(|| count(curve.last));
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
        let begin = count(curve.first) + (meet - m).x * curve.dots[curve.first].t.x / curve.step;
        let opens = curve.follow(
            [meet, next, second],
            begin - 1.0,
            count(curve.last),
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
