//! The spans of one contour, welded where they meet: a corner is where both its sides lead.

use super::found::Draft;
use super::samples::Samples;
use super::{Joint, STRAY, is_within, tidy};
use crate::numeric::chain::{Chain, Join, Node};
use crate::numeric::joins::level_ends;
use crate::numeric::refit::Foot;
use crate::types::{Span, Spans, Verdict};
use kurbo::{BezPath, Point};

/// No corner moves further than this from where it was found, tolerances.
const CORNER_REACH: f64 = 12.0;

/// The path of a contour with corners, all nodes refined at once, and whether it keeps to the tolerance; `None` where
/// it has no corner or the curves lose their way.
pub(super) fn welded(
    joint: &Joint,
    spans: &Spans,
    tolerance_px: f64,
) -> Option<(BezPath, Verdict)> {
    let spans: Vec<&[Point]> = spans
        .iter()
        .map(|s| (!s.is_ring()).then_some(s.points()))
        .collect::<Option<_>>()?;
    let open: Vec<Span<'_>> = spans.iter().map(|p| Span::Open(p)).collect();
    let samples = Samples::together(&open);
    let mut found = joint.search(&samples, tolerance_px, weld)?;
    let corners = corners(&found.chain, *spans.first()?.first()?);
    let chain = &found.chain;
    let near = |(&i, span): (&usize, &&[Point])| {
        let at = chain.nodes[i].point;
        at.distance(span[0]) <= CORNER_REACH * tolerance_px
    };
    let kept = corners.len() == spans.len()
        && corners.iter().zip(&spans).all(near)
        && keeps(chain, &corners, &spans, STRAY * tolerance_px);
    let verdict = if found.worst().iter().all(|w| *w <= tolerance_px) {
        Verdict::Met
    } else {
        Verdict::Exhausted
    };
    kept.then(|| {
        tidy::smooth(&mut found);
        level_ends(&mut found.chain);
        (found.chain.to_path(), verdict)
    })
}

/// One ring of spans that follow one another.
fn weld(drafts: Vec<Draft>) -> Option<Draft> {
    let ends: Option<Vec<Node>> = drafts
        .iter()
        .map(|d| d.chain.nodes.last().copied())
        .collect();
    let ends = ends?;
    let mut all = Draft::default();
    for (draft, end) in drafts
        .into_iter()
        .zip(ends.iter().cycle().skip(ends.len().checked_sub(1)?))
    {
        let (segment, few) = (all.chain.kinds.len(), all.few.len());
        let mut nodes = draft.chain.nodes;
        nodes.pop();
        let start = nodes.first_mut()?;
        *start = Node {
            join: Join::Corner,
            arrive: end.arrive,
            back: end.back,
            ..*start
        };
        all.chain.nodes.append(&mut nodes);
        all.chain.kinds.extend(draft.chain.kinds);
        all.few.extend(draft.few);
        all.spans.extend(draft.spans);
        all.all.extend(draft.all);
        all.near.extend(draft.near.iter().map(|k| k + few));
        all.feet.extend(draft.feet.iter().map(|f| Foot {
            segment: f.segment + segment,
            ..*f
        }));
    }
    (all.chain.nodes.len() > 1).then_some(all)
}

/// The nodes at which spans meet, in order from the one nearest to `first`: a ring may have been turned.
fn corners(chain: &Chain, first: Point) -> Vec<usize> {
    let corner = |&i: &usize| chain.nodes[i].join == Join::Corner;
    let mut at: Vec<usize> = (0..chain.nodes.len()).filter(corner).collect();
    let off = |k: &usize| chain.nodes[at[*k]].point.distance_squared(first);
    let start = (0..at.len()).min_by(|i, j| off(i).total_cmp(&off(j)));
    at.rotate_left(start.unwrap_or(0));
    at
}

/// Whether the path between neighbouring corners stays within `reach` px of its span.
fn keeps(chain: &Chain, corners: &[usize], spans: &[&[Point]], reach: f64) -> bool {
    let n = chain.kinds.len();
    let ends = corners.iter().cycle().skip(1);
    corners
        .iter()
        .zip(ends)
        .zip(spans)
        .all(|((&from, to), span)| {
            let part = chain.part(from..from + (to + n - from - 1) % n + 1);
            let path = part.to_path();
            let mut points = span.to_vec();
            let ends = [part.nodes.first(), part.nodes.last()];
            let given = [0, points.len() - 1];
            for (i, node) in given.into_iter().zip(ends) {
                points[i] = node.map_or(points[i], |n| n.point);
            }
            is_within(Span::Open(&points), &path, reach)
        })
}
