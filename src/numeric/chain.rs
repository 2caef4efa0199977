//! Paths of lines and cubics whose joins hold by construction.
//!
//! A node carries a place, the direction in which the path arrives and leaves, and two handle lengths;
//! control points follow from them. A smooth node has one direction for both sides, an extremum has an axis
//! for it, a node beside a line takes the line's own. Whatever numbers an optimiser puts in,
//! handles stay collinear and extrema upright.

use super::angles::angle;
use super::curves::{arriving, leaving};
use kurbo::{BezPath, CubicBez, PathEl, Point, Vec2};
use std::ops::Range;

/// A line of a path that is so near to an axis is meant to be parallel to it, radians.
const LEVEL_LINE: f64 = 1e-4;

/// What a node holds fixed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Join {
    /// An end of an open chain: its place is given, its direction free.
    End,
    /// An end of an open chain whose place is known only roughly.
    Loose,
    /// Place and direction are given, the handle's length is free.
    Clamped,
    /// One direction for both sides.
    Smooth,
    /// One direction for both sides, parallel to x: an extremum in y.
    Horizontal,
    /// One direction for both sides, parallel to y: an extremum in x.
    Vertical,
    /// A free place with a direction for each side.
    Corner,
}

impl Join {
    /// Whether both sides share one direction.
    #[must_use]
    pub const fn is_smooth(self) -> bool {
        matches!(self, Self::Smooth | Self::Horizontal | Self::Vertical)
    }

    /// Whether it is an end of an open chain.
    #[must_use]
    pub const fn is_end(self) -> bool {
        matches!(self, Self::End | Self::Loose)
    }

    /// Whether the place is given.
    #[must_use]
    pub const fn is_fixed(self) -> bool {
        matches!(self, Self::End | Self::Clamped)
    }
}

/// What leads from a node to the next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A straight line.
    Line,
    /// A cubic Bézier curve.
    Cubic,
}

/// A place on the path and what meets there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node {
    /// Where it lies.
    pub point: Point,
    /// What it holds fixed.
    pub join: Join,
    /// Unit direction of the path that arrives.
    pub arrive: Vec2,
    /// Unit direction of the path that leaves; `arrive` itself at a smooth node.
    pub leave: Vec2,
    /// Length of the handle before it.
    pub back: f64,
    /// Length of the handle after it.
    pub ahead: f64,
}

/// Nodes and what joins each to the next: one kind fewer than nodes when open, as many when a ring.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Chain {
    /// The nodes in order.
    pub nodes: Vec<Node>,
    /// `kinds[i]` leads from node `i` to the next one.
    pub kinds: Vec<Kind>,
}

impl Chain {
    /// Whether it closes on itself.
    #[must_use]
    pub const fn is_ring(&self) -> bool {
        self.kinds.len() == self.nodes.len()
    }

    /// The nodes at both ends of segment `i`.
    #[must_use]
    pub const fn ends(&self, i: usize) -> (usize, usize) {
        (i, if i + 1 == self.nodes.len() { 0 } else { i + 1 })
    }

    /// The segment that arrives at node `i`.
    #[must_use]
    pub const fn before(&self, i: usize) -> Option<usize> {
        match i.checked_sub(1) {
            Some(j) => Some(j),
            None if self.is_ring() => Some(self.kinds.len() - 1),
            None => None,
        }
    }

    /// The segment that leaves node `i`.
    #[must_use]
    pub const fn after(&self, i: usize) -> Option<usize> {
        if i < self.kinds.len() { Some(i) } else { None }
    }

    /// Kind of an optional segment.
    #[must_use]
    pub fn kind(&self, segment: Option<usize>) -> Option<Kind> {
        segment.and_then(|s| self.kinds.get(s).copied())
    }

    /// Segment `i` as a cubic; a line's handles lie at its thirds.
    #[must_use]
    pub fn cubic(&self, i: usize) -> CubicBez {
        let (a, b) = self.ends(i);
        let (a, b) = (&self.nodes[a], &self.nodes[b]);
        let (p, q) = match self.kinds[i] {
            Kind::Cubic => (a.point + a.ahead * a.leave, b.point - b.back * b.arrive),
            Kind::Line => (
                a.point.lerp(b.point, 1.0 / 3.0),
                a.point.lerp(b.point, 2.0 / 3.0),
            ),
        };
        CubicBez::new(a.point, p, q, b.point)
    }

    /// The path itself.
    #[must_use]
    pub fn to_path(&self) -> BezPath {
        let mut path = BezPath::new();
        if let Some(first) = self.nodes.first() {
            path.move_to(first.point);
        }
        for (i, kind) in self.kinds.iter().enumerate() {
            let c = self.cubic(i);
            match kind {
                Kind::Line => path.line_to(c.p3),
                Kind::Cubic => path.curve_to(c.p1, c.p2, c.p3),
            }
        }
        if self.is_ring() {
            path.close_path();
        }
        path
    }

    /// Makes directions and places agree with the joins: a line beside an extremum becomes parallel to its
    /// axis, both its ends extrema; smooth nodes beside a line take its direction.
    pub fn settle(&mut self) {
        for i in 0..self.kinds.len() {
            if self.kinds[i] == Kind::Line {
                self.settle_line(i);
            }
        }
        self.align();
    }

    fn settle_line(&mut self, i: usize) {
        let (a, b) = self.ends(i);
        let (p, q) = (self.nodes[a], self.nodes[b]);
        for axis in [Join::Horizontal, Join::Vertical] {
            if p.join != axis && q.join != axis {
                continue;
            }
            let mid = match (p.join.is_fixed(), q.join.is_fixed()) {
                (true, _) => p.point,
                (_, true) => q.point,
                _ => p.point.midpoint(q.point),
            };
            for (n, fixed) in [(a, p.join.is_fixed()), (b, q.join.is_fixed())] {
                let node = &mut self.nodes[n];
                if !fixed && axis == Join::Horizontal {
                    node.point.y = mid.y;
                } else if !fixed {
                    node.point.x = mid.x;
                }
                if node.join.is_smooth() {
                    node.join = axis;
                }
            }
            return;
        }
    }

    /// Takes the directions of smooth nodes beside lines from the lines, and of extrema from their axes.
    pub fn align(&mut self) {
        for i in 0..self.nodes.len() {
            let node = self.nodes[i];
            let along = match node.join {
                Join::Horizontal => Vec2::new(1f64.copysign(node.leave.x), 0.0),
                Join::Vertical => Vec2::new(0.0, 1f64.copysign(node.leave.y)),
                Join::Smooth => match self.line_beside(i) {
                    Some(line) => self.direction(line),
                    None => node.leave,
                },
                _ => continue,
            };
            self.nodes[i].arrive = along;
            self.nodes[i].leave = along;
        }
    }

    /// The line that gives smooth node `i` its direction.
    pub fn line_beside(&self, i: usize) -> Option<usize> {
        let line = |s: &usize| self.kinds[*s] == Kind::Line;
        let before = self.before(i).filter(line);
        before.or_else(|| self.after(i).filter(line))
    }

    /// Unit direction of the chord of segment `i`.
    #[must_use]
    pub fn direction(&self, i: usize) -> Vec2 {
        let (a, b) = self.ends(i);
        let d = self.nodes[b].point - self.nodes[a].point;
        let length = d.hypot();
        if length > 0.0 {
            d / length
        } else {
            self.nodes[a].leave
        }
    }

    /// Some segments in a row as an open chain; of a ring the last may lead back to its first node.
    #[must_use]
    pub fn part(&self, segments: Range<usize>) -> Self {
        let n = self.nodes.len();
        let kinds = segments.clone().map(|i| self.kinds[i % n]).collect();
        let nodes = (segments.start..=segments.end).map(|i| self.nodes[i % n]);
        Self {
            nodes: nodes.collect(),
            kinds,
        }
    }

    /// Reads a path of lines and cubics back. Nodes whose sides differ by less than `turn` radians are smooth, and
    /// extrema where that direction is as near to an axis; beside a line it must all but be on it. The ends of an
    /// open path are [`Join::End`]. `None` for a path with quadratics, with fewer than two nodes, or with a second
    /// move.
    #[must_use]
    pub fn from_path(path: &BezPath, turn: f64) -> Option<Self> {
        let (pieces, closed) = pieces(path)?;
        let n = pieces.len();
        let mut chain = Self::default();
        for i in 0..=n {
            let before = match i.checked_sub(1) {
                Some(j) => pieces.get(j),
                None if closed => pieces.last(),
                None => None,
            };
            let after = pieces.get(i);
            if i < n || !closed {
                chain.nodes.push(node_between(before, after, turn)?);
                chain.kinds.extend(after.map(|(k, _)| *k));
            }
        }
        chain.settle();
        (chain.nodes.len() >= 2).then_some(chain)
    }
}

/// The segments of one path, and whether it closes.
fn pieces(path: &BezPath) -> Option<(Vec<(Kind, CubicBez)>, bool)> {
    let mut out = Vec::new();
    let mut start = None;
    let mut at = Point::ORIGIN;
    let mut closed = false;
    for el in path.elements() {
        match *el {
            PathEl::MoveTo(p) if start.is_none() => {
                start = Some(p);
                at = p;
            }
            PathEl::LineTo(p) => {
                out.push((Kind::Line, CubicBez::new(at, at, p, p)));
                at = p;
            }
            PathEl::CurveTo(a, b, p) => {
                out.push((Kind::Cubic, CubicBez::new(at, a, b, p)));
                at = p;
            }
            PathEl::ClosePath => {
                let first = start?;
                out.push((Kind::Line, CubicBez::new(at, at, first, first)));
                closed = true;
            }
            _ => return None,
        }
    }
    out.retain(|(_, c)| c.p0 != c.p3 || c.p1 != c.p0 || c.p2 != c.p0);
    Some((out, closed))
}

fn node_between(
    before: Option<&(Kind, CubicBez)>,
    after: Option<&(Kind, CubicBez)>,
    turn: f64,
) -> Option<Node> {
    let arrive = before.map(|(_, c)| unit(arriving(c)));
    let leave = after.map(|(_, c)| unit(leaving(c)));
    let point = after
        .map(|(_, c)| c.p0)
        .or_else(|| before.map(|(_, c)| c.p3))?;
    let (mut arrive, mut leave) = (arrive.or(leave)?, leave.or(arrive)?);
    let curved = [before, after]
        .iter()
        .any(|s| matches!(s, Some((Kind::Cubic, _))));
    let line = [before, after]
        .iter()
        .any(|s| matches!(s, Some((Kind::Line, _))));
    // a line that is made parallel to an axis takes its other end along
    let level = if line { turn.min(LEVEL_LINE) } else { turn };
    let join = if before.is_none() || after.is_none() {
        Join::End
    } else if !curved || angle(arrive, leave).abs() >= turn {
        Join::Corner
    } else if leave.y.abs() < level && arrive.y.abs() < level {
        Join::Horizontal
    } else if leave.x.abs() < level && arrive.x.abs() < level {
        Join::Vertical
    } else {
        let mean = arrive + leave;
        arrive = mean / mean.hypot();
        leave = arrive;
        Join::Smooth
    };
    let back = before.map_or(0.0, |(_, c)| (c.p3 - c.p2).hypot());
    let ahead = after.map_or(0.0, |(_, c)| (c.p1 - c.p0).hypot());
    Some(Node {
        point,
        join,
        arrive,
        leave,
        back,
        ahead,
    })
}

/// The direction of a vector; to the right for one of no length.
fn unit(d: Vec2) -> Vec2 {
    if d == Vec2::ZERO {
        Vec2::new(1.0, 0.0)
    } else {
        d / d.hypot()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_survives_the_way_through_a_chain() {
        let svg = "M0 0L0 60C0 90 20 110 50 110C80 110 100 90 110 60L110 0Z";
        let path = BezPath::from_svg(svg).unwrap();
        let chain = Chain::from_path(&path, 0.01).unwrap();
        let joins: Vec<Join> = chain.nodes.iter().map(|n| n.join).collect();
        assert_eq!(
            joins,
            [
                Join::Corner,
                Join::Vertical,
                Join::Horizontal,
                Join::Corner,
                Join::Corner
            ]
        );
        let back = chain.to_path();
        for (a, b) in back.segments().zip(path.segments()) {
            let (a, b) = (a.to_cubic(), b.to_cubic());
            assert!((a.p1 - b.p1).hypot() < 1e-9 && (a.p3 - b.p3).hypot() < 1e-9);
        }
        let open = BezPath::from_svg("M0 0C1 1 2 1 3 0C4 -1 5 -1 6 0").unwrap();
        let chain = Chain::from_path(&open, 0.01).unwrap();
        assert!(!chain.is_ring());
        assert_eq!(chain.nodes[1].join, Join::Smooth);
        assert_eq!(chain.nodes[2].join, Join::End);
        assert!(Chain::from_path(&BezPath::from_svg("M0 0Q1 1 2 0").unwrap(), 0.01).is_none());
    }

    #[test]
    fn a_line_beside_an_extremum_is_parallel_to_its_axis() {
        let leaning = BezPath::from_svg("M0 0L1 200C1.15 230 20 250 50 250").unwrap();
        let chain = Chain::from_path(&leaning, 0.01).unwrap();
        assert_eq!(chain.nodes[1].join, Join::Smooth);
        assert_eq!(chain.nodes[1].point, Point::new(1.0, 200.0));
        let path = BezPath::from_svg("M0 0L0.001 60C0 90 20 110 50 110").unwrap();
        let chain = Chain::from_path(&path, 0.01).unwrap();
        assert_eq!(chain.nodes[1].join, Join::Vertical);
        assert!(
            chain.nodes[1].point.x.abs() < 1e-12,
            "the end is given, so the node moves"
        );
    }
}
