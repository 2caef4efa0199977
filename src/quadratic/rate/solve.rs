//! Course → stored points: a search for each span, a second one to close a ring.

use super::curve::{Course, Curve, Gate, Node, Span, count};
use super::glyf::{Stored, stored_bytes};
use super::search::{Effort, Join, Search, Start};
use kurbo::{Point, QuadBez, Vec2};

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
    let mut out = Vec::new();
    let mut before = spans.last().is_some_and(|s| matches!(s.1, Span::Line));
    for (from, span, to) in spans {
        if from.rounded > effort.limit {
            return None;
        }
        match span {
            Span::Line => {
                out.extend(before.then_some(from.at));
                before = true;
            }
            Span::Curve(curve) => {
                let (start, points) = match open(curve, effort, *from, *to) {
                    Some(joins) => (Stored::on(joins.first()?.m), stored(&joins)),
                    None => (from.at, plain(curve, effort.limit)?),
                };
                out.extend(before.then_some(start));
                out.extend(points);
                before = false;
            }
        }
    }
    Some(out)
}

/// The points after the start of the cheapest path between two nodes.
#[cfg(test)]
pub(super) fn between(curve: &Curve, effort: Effort, from: Node, to: Node) -> Option<Vec<Stored>> {
    open(curve, effort, from, to).map(|joins| stored(&joins))
}

/// The cheapest path between two nodes that stays within the tolerance when it is measured densely.
fn open(curve: &Curve, effort: Effort, from: Node, to: Node) -> Option<Vec<Join>> {
    /// Slack and grain of each attempt, as factors: a search that pruned its only way looks wider.
    const WIDER: [(f64, f64); 3] = [(1.0, 1.0), (4.0, 1.0), (6.0, 2.0)];
    /// Factor on the limit after a path that was within it only where the search looked.
    const TIGHTER: f64 = 0.95;
    /// Part of the limit that the dense measure may use: it looks between its samples no closer.
    const SURE: f64 = 0.998;
    let most = effort.limit;
    let mut limit = most;
    for (slack, grain) in WIDER {
        for _ in 0..4 {
            let effort = Effort {
                limit,
                slack: slack * effort.slack,
                grain: grain * effort.grain,
                ..effort
            };
            let mut search = Search::new(curve, effort, to, None);
            let ends = search.run(Start::Node(from));
            let Some(&id) = ends.first() else { break };
            let joins = search.path(id);
            if strays(curve, &joins) <= SURE * most {
                return Some(joins);
            }
            limit *= TIGHTER;
        }
    }
    None
}

/// The largest distance between a path and its curve, units.
fn strays(curve: &Curve, joins: &[Join]) -> f64 {
    let quads = joins.windows(2).map(|w| {
        let c = w[1].c.unwrap_or(w[0].m.midpoint(w[1].m));
        curve.strays(QuadBez::new(w[0].m, c, w[1].m), w[0].at(), w[1].at())
    });
    quads.fold(0.0, f64::max)
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

fn plain(curve: &Curve, limit: f64) -> Option<Vec<Stored>> {
    let pairs = curve.plain(limit)?;
    Some(
        pairs
            .into_iter()
            .flat_map(|(c, m)| [Stored::off(c), Stored::on(m)])
            .collect(),
    )
}

fn ring(curve: &Curve, gate: Gate, effort: Effort) -> Option<Vec<Stored>> {
    let top = curve.p[curve.first];
    let m = Point::new(top.x.round(), f64::from(gate.level));
    let along = Some(Vec2::new(curve.t[curve.first].x.signum(), 0.0));
    let node = Node {
        at: Stored::on(m),
        along,
        rounded: top.distance(m),
    };
    let Some(joins) = open(curve, effort, node, node) else {
        return plain(curve, effort.limit);
    };
    let first = stored(&joins);
    // Closing inside a run saves the on-curve point: try the control points of the first answer.
    let mut controls = joins.iter().filter_map(|j| j.c);
    let (Some(a), Some(b)) = (controls.next(), controls.next_back()) else {
        return Some(first);
    };
    let tries = [a.midpoint(m + (m - b)).round(), a];
    let closed = tries
        .into_iter()
        .filter_map(|next| closed(curve, gate, effort, (node, next)));
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
    let mut search = Search::new(curve, effort, node, Some(gate));
    let m = node.at.point();
    let ends = search.run(Start::Implied { m, next });
    ends.into_iter().find_map(|id| {
        let mut joins = search.path(id);
        let n = joins.len();
        let meet = joins.last()?.c?.midpoint(next);
        let second = joins.get(1).filter(|_| n > 2)?.m;
        let begin = count(curve.first) + (meet - m).x * curve.t[curve.first].x / curve.step;
        let opens = curve.follow(
            [meet, next, second],
            begin - 1.0,
            count(curve.last),
            effort.limit,
        );
        joins[n - 1].m = meet;
        joins[0].m = meet;
        let fits = opens.is_some() && strays(curve, &joins) <= effort.limit;
        let mut out = stored(&joins);
        // The last join is implied by the first control point.
        out.pop();
        fits.then_some(out)
    })
}
