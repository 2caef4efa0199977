//! A contour as spans between the nodes that must stay, each sampled evenly by arc length.

use super::glyf::Stored;
use crate::numeric::angles::angle;
use crate::numeric::{cast::index, curves};
use kurbo::{BezPath, ParamCurve, ParamCurveDeriv, PathSeg, Point, Vec2};

/// By how much the search's own lengths in units grow at a tolerance, units: 1 up to two thousandths of an em of
/// 2048, the finest they were chosen in; in a finer em they would be ever smaller parts of what the tolerance leaves
/// free.
pub(super) fn coarse(tolerance: f64) -> f64 {
    const USUAL: f64 = 4.1;
    (tolerance / USUAL).max(1.0)
}

/// A node that stays: where, and the direction the curve must have there, if any.
#[derive(Debug, Clone, Copy)]
pub(super) struct Node {
    pub(super) at: Stored,
    /// Unit direction in which the curve leaves or arrives; none at a corner.
    pub(super) along: Option<Vec2>,
    /// How far rounding moved it, units.
    pub(super) rounded: f64,
    /// How far a corner may move in x and y, units: not across a level or upright line that ends there.
    pub(super) free: Vec2,
}

impl Node {
    /// The node at a point that is settled.
    pub(super) const fn held(self, at: Stored) -> Self {
        Self {
            at,
            free: Vec2::ZERO,
            ..self
        }
    }
}

/// What lies between two nodes.
#[derive(Debug, Clone)]
pub(super) enum Span {
    Line,
    Curve(Curve),
}

/// A closed contour: spans, each with the node it begins and the node it ends with.
#[derive(Debug, Clone)]
pub(super) enum Course {
    /// Spans between nodes that stay.
    Spans(Vec<(Node, Span, Node)>),
    /// A smooth ring, cut at one of its extrema.
    Ring(Curve, Gate),
}

/// An extremum that stays: the curve crosses it along the axis at a whole coordinate.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gate {
    /// Sample at which it stands.
    pub(super) at: usize,
    /// Whether the tangent is horizontal (an extremum of y) or vertical.
    pub(super) horizontal: bool,
    /// The rounded y or x.
    pub(super) level: i32,
}

/// A sample of a curve.
#[derive(Debug, Clone, Copy)]
pub(super) struct Dot {
    pub(super) p: Point,
    /// Unit tangent.
    pub(super) t: Vec2,
    /// Curvature, 1/units, positive to the left.
    pub(super) k: f64,
}

/// Even samples of a smooth curve.
#[derive(Debug, Clone)]
pub(super) struct Curve {
    pub(super) dots: Vec<Dot>,
    /// Distance between samples, units.
    pub(super) step: f64,
    pub(super) gates: Vec<Gate>,
    /// Where the span begins and ends among the samples; a ring is sampled beyond both.
    pub(super) first: usize,
    pub(super) last: usize,
    segs: Vec<PathSeg>,
}

/// What of the outline has to stay as it is.
#[derive(Debug, Clone, Copy)]
pub(super) struct Keep {
    pub(super) corner_rad: f64,
    pub(super) tolerance: f64,
    /// Shortest line that stays a line, units.
    pub(super) line: f64,
    /// Least rise of an extremum that stays, units.
    pub(super) least: f64,
    /// How far a corner may move, units.
    pub(super) free: f64,
}

impl Course {
    /// Cuts a contour at its corners and at the ends of its lines. None where nothing is left to draw.
    pub(super) fn new(path: &BezPath, keep: Keep) -> Option<Self> {
        let segs = segments(path);
        let n = segs.len();
        if n == 0 || (n < 3 && segs.iter().all(is_line)) {
            return None;
        }
        let turn = |i: usize| {
            let (a, b) = (
                direction(&segs[(i + n - 1) % n], 1.0),
                direction(&segs[i], 0.0),
            );
            angle(a, b).abs()
        };
        let corner: Vec<bool> = (0..n).map(|i| turn(i) > keep.corner_rad).collect();
        let line = |i: usize| is_line(&segs[i % n]) && control_length(&segs[i % n]) > keep.line;
        let hard = |i: usize| corner[i] || line(i) || line(i + n - 1);
        let nodes: Vec<usize> = (0..n).filter(|&i| hard(i)).collect();
        let Some(&first) = nodes.first() else {
            return Curve::ring(&segs, keep).map(|(c, g)| Self::Ring(c, g));
        };
        let ends = nodes.iter().skip(1).copied().chain([first + n]);
        let mut spans = Vec::new();
        for (&a, b) in nodes.iter().zip(ends) {
            let run: Vec<PathSeg> = (a..b).map(|i| segs[i % n]).collect();
            let (head, tail) = (run[0], run[run.len() - 1]);
            let is_straight = run.len() == 1 && is_line(&head);
            // A smooth end beside a line may slide along it, at most to its middle from both sides.
            let room = |i: usize, beside: usize| {
                let smooth = !corner[i % n] && line(beside) && !is_straight;
                if smooth {
                    0.45 * control_length(&segs[beside % n])
                } else {
                    0.0
                }
            };
            let node = |i: usize, beside: usize, seg: &PathSeg, end: f64| {
                // The direction that stays is the line's, where one ends here.
                let along = if line(beside) {
                    direction(&segs[beside % n], 0.0)
                } else {
                    direction(seg, end)
                };
                let (p, at) = (seg.eval(end), Stored::on(seg.eval(end)));
                let mut free = Vec2::new(keep.free, keep.free);
                for near in [i + n - 1, i]
                    .map(|k| &segs[k % n])
                    .into_iter()
                    .filter(|s| is_line(s))
                {
                    let u = direction(near, 0.0);
                    if u.y == 0.0 {
                        free.y = 0.0;
                    } else if u.x == 0.0 {
                        free.x = 0.0;
                    }
                }
                Node {
                    free: if corner[i % n] { free } else { Vec2::ZERO },
                    at,
                    along: (!corner[i % n]).then_some(along),
                    rounded: p.distance(at.point()),
                }
            };
            let (from, to) = (node(a, a + n - 1, &head, 0.0), node(b, b, &tail, 1.0));
            let span = if is_straight {
                Span::Line
            } else {
                Span::Curve(Curve::open(
                    &run,
                    [room(a, a + n - 1), room(b, b)],
                    [from, to],
                    keep,
                ))
            };
            spans.push((from, span, to));
        }
        Some(Self::Spans(spans))
    }
}

impl Curve {
    fn sampled(segs: &[PathSeg], tolerance: f64) -> Self {
        /// Samples lie no farther apart, units: a bend tighter than that is a corner of the grid.
        const FINE: f64 = 0.4;
        let spacing = tolerance.min(FINE * coarse(tolerance));
        let mut table: Vec<(f64, usize, f64)> = Vec::new();
        let mut length = 0.0;
        for (i, seg) in segs.iter().enumerate() {
            let rough = control_length(seg);
            let m = (rough / (0.5 * spacing)).ceil().clamp(8.0, 4000.0);
            let mut last = seg.eval(0.0);
            table.push((length, i, 0.0));
            let mut j = 1.0;
            while j <= m {
                let q = seg.eval(j / m);
                length += q.distance(last);
                table.push((length, i, j / m));
                last = q;
                j += 1.0;
            }
        }
        let n = index((length / spacing).ceil().clamp(16.0, 60_000.0));
        let step = length / n as f64;
        let (mut dots, mut at) = (Vec::with_capacity(n + 1), 0);
        for i in 0..=n {
            let s = step * i as f64;
            while at + 2 < table.len() && (table[at + 1].0 < s || table[at + 1].1 != table[at].1) {
                at += 1;
            }
            let (a, b) = (table[at], table[at + 1]);
            let f = if b.0 > a.0 {
                ((s - a.0) / (b.0 - a.0)).clamp(0.0, 1.0)
            } else {
                0.0
            };
            let u = a.2 + f * (b.2 - a.2);
            let t = direction(&segs[a.1], u);
            dots.push(Dot {
                p: segs[a.1].eval(u),
                t,
                k: 0.0,
            });
        }
        let mut curve = Self {
            dots,
            step,
            gates: Vec::new(),
            first: 0,
            last: n,
            segs: segs.to_vec(),
        };
        curve.bend();
        curve
    }

    /// The samples from one place to another, in either order.
    pub(super) fn between(&self, one: f64, other: f64) -> &[Dot] {
        let last = self.dots.len() - 1;
        let [from, to] = [one.min(other), one.max(other)].map(|v| index(v.max(0.0)).min(last));
        &self.dots[from..=to]
    }

    /// Whether it closes on itself.
    pub(super) fn is_ring(&self) -> bool {
        self.dots[self.first].p == self.dots[self.last].p
    }

    fn bend(&mut self) {
        let n = self.dots.len();
        let turn = |curve: &Self, i: usize, j: usize| angle(curve.dots[i].t, curve.dots[j].t);
        for i in 0..n {
            let (a, b) = (i.saturating_sub(1), (i + 1).min(n - 1));
            self.dots[i].k = turn(self, a, b) / (self.step * (b - a) as f64);
        }
    }

    /// A span that may begin and end up to `room` (units) beyond its ends, along their lines.
    fn open(segs: &[PathSeg], room: [f64; 2], [from, to]: [Node; 2], keep: Keep) -> Self {
        let mut curve = Self::sampled(segs, keep.tolerance);
        let n = curve.dots.len();
        let beyond = room.map(|r| index((r / curve.step).min(n as f64)));
        let (head, tail) = (curve.dots[0], curve.dots[n - 1]);
        let (u, v) = (from.along.unwrap_or(head.t), to.along.unwrap_or(tail.t));
        let step = curve.step;
        let line = |from: Point, t: Vec2, i: f64| Dot {
            p: from + t * (i * step),
            t,
            k: 0.0,
        };
        let before = (1..=beyond[0]).rev().map(|i| line(head.p, u, -(i as f64)));
        let after = (1..=beyond[1]).map(|i| line(tail.p, v, i as f64));
        curve.dots = before.chain(curve.dots).chain(after).collect();
        (curve.first, curve.last) = (beyond[0], beyond[0] + n - 1);
        curve.bend();
        curve.gates = curve.extrema(keep.least);
        curve
    }

    /// A ring, turned so that it begins at its most prominent extremum.
    fn ring(segs: &[PathSeg], keep: Keep) -> Option<(Self, Gate)> {
        let mut curve = Self::sampled(segs, keep.tolerance);
        let n = curve.dots.len() - 1;
        // The highest sample is an extremum of any ring.
        let top = (0..n).max_by(|&a, &b| curve.dots[a].p.y.total_cmp(&curve.dots[b].p.y))?;
        let pad = n / 3;
        let from = |i: usize| (top + n - pad + i) % n;
        curve.dots = (0..=n + 2 * pad).map(|i| curve.dots[from(i)]).collect();
        (curve.first, curve.last) = (pad, pad + n);
        curve.bend();
        curve.gates = curve.extrema(keep.least);
        let level = Stored::on(curve.dots[pad].p).y;
        let gate = Gate {
            at: pad,
            horizontal: true,
            level,
        };
        Some((curve, gate))
    }

    /// Extrema of y and x inside the span, each at least the tolerance from its neighbours.
    fn extrema(&self, tolerance: f64) -> Vec<Gate> {
        /// Samples that differ by less are at one height, units.
        const LEVEL: f64 = 1e-9;
        let mut gates = Vec::new();
        for horizontal in [true, false] {
            let value = |i: usize| {
                if horizontal {
                    self.dots[i].p.y
                } else {
                    self.dots[i].p.x
                }
            };
            let (first, last) = (self.first, self.last);
            let mut found: Vec<usize> = Vec::new();
            for i in first + 1..last {
                let is_level = |j: &usize| (value(*j) - value(i)).abs() < LEVEL;
                // A level stretch stands for its middle, if it is no step on a slope.
                let flat = (i..last).take_while(is_level).count();
                let turns = [i - 1, i + flat].map(|j| value(j) < value(i));
                if turns[0] == turns[1] && ![i - 1, i + flat].iter().any(is_level) {
                    found.push(i + flat.saturating_sub(1) / 2);
                }
            }
            prominent(&mut found, value, (first, last), tolerance);
            gates.extend(found.into_iter().map(|at| {
                let s = Stored::on(self.dots[at].p);
                Gate {
                    at,
                    horizontal,
                    level: if horizontal { s.y } else { s.x },
                }
            }));
        }
        gates.sort_by_key(|g| g.at);
        gates.dedup_by_key(|g| g.at);
        gates
    }

    /// Control and on-curve points of the curve's own pieces, cut finely and rounded: the plain
    /// answer where no path was found. None if rounding alone may exceed `limit`, units.
    pub(super) fn plain(&self, limit: f64) -> Option<Vec<(Point, Point)>> {
        /// Part of the limit that the cutting may use.
        const CUT: f64 = 0.1;
        if std::f64::consts::FRAC_1_SQRT_2 + CUT * limit > limit {
            return None;
        }
        let cubics = self.segs.iter().map(PathSeg::to_cubic);
        let quads = cubics.flat_map(|c| c.to_quads(CUT * limit).collect::<Vec<_>>());
        Some(
            quads
                .map(|(_, _, q)| (q.p1.round(), q.p2.round()))
                .collect(),
        )
    }
}

/// Leaves the extrema that rise at least `least` over both neighbours; ends count as neighbours.
fn prominent(
    found: &mut Vec<usize>,
    value: impl Fn(usize) -> f64,
    (first, last): (usize, usize),
    least: f64,
) {
    loop {
        let mut ends = vec![first];
        ends.extend(found.iter().copied());
        ends.push(last);
        let rise = |k: usize| (value(ends[k]) - value(ends[k - 1])).abs();
        let worst = (1..ends.len())
            .filter(|&k| ends.len() > 2 && rise(k) < least)
            .min_by(|&a, &b| rise(a).total_cmp(&rise(b)));
        let Some(k) = worst else { return };
        // The pair on both sides of the smallest rise goes; at an end only the inner one.
        if k < ends.len() - 1 {
            found.remove(k - 1);
        }
        if k > 1 {
            found.remove(k - 2);
        }
        if found.is_empty() {
            return;
        }
    }
}

pub(super) fn segments(path: &BezPath) -> Vec<PathSeg> {
    path.segments()
        .filter(|s| control_length(s) > 1e-9)
        .collect()
}

pub(super) fn is_line(seg: &PathSeg) -> bool {
    matches!(seg, PathSeg::Line(_))
}

fn control_length(seg: &PathSeg) -> f64 {
    curves::control_length(&seg.to_cubic())
}

/// Unit tangent; at a collapsed handle the direction to the next control point.
pub(super) fn direction(seg: &PathSeg, u: f64) -> Vec2 {
    /// A shorter derivative is what rounding left of a handle, parts of the curve's length.
    const HANDLE: f64 = 1e-4;
    let c = seg.to_cubic();
    let d = match seg {
        PathSeg::Line(l) => l.p1 - l.p0,
        PathSeg::Quad(q) => q.deriv().eval(u).to_vec2(),
        PathSeg::Cubic(c) => c.deriv().eval(u).to_vec2(),
    };
    if d.hypot() > HANDLE * control_length(seg) {
        return level(d.normalize());
    }
    let spans = if u < 0.5 {
        [c.p2 - c.p0, c.p3 - c.p0]
    } else {
        [c.p3 - c.p1, c.p3 - c.p0]
    };
    let d = spans
        .into_iter()
        .find(|v| v.hypot() > 1e-9)
        .unwrap_or(Vec2::new(1.0, 0.0));
    level(d.normalize())
}

/// A direction along an axis but for the noise of arithmetic is along it.
fn level(d: Vec2) -> Vec2 {
    let snap = |v: f64| if v.abs() < 1e-6 { 0.0 } else { v };
    Vec2::new(snap(d.x), snap(d.y))
}
