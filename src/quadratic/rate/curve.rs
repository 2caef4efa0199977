//! A contour as spans between the nodes that must stay, each sampled evenly by arc length.

use super::glyf::Stored;
use kurbo::{BezPath, ParamCurve, ParamCurveDeriv, PathSeg, Point, QuadBez, Vec2};

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

/// Even samples of a smooth curve.
#[derive(Debug, Clone)]
pub(super) struct Curve {
    pub(super) p: Vec<Point>,
    pub(super) t: Vec<Vec2>,
    /// Curvature, 1/units, positive to the left.
    pub(super) k: Vec<f64>,
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

/// A quadratic beside the curve: the sample where it ends, and its largest distance on the way.
#[derive(Debug, Clone, Copy)]
pub(super) struct Followed {
    pub(super) at: f64,
    pub(super) worst: f64,
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
            a.cross(b).atan2(a.dot(b)).abs()
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
        let spacing = tolerance.min(FINE);
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
        let n = whole((length / spacing).ceil().clamp(16.0, 60_000.0));
        let step = length / count(n);
        let (mut p, mut t, mut at) = (Vec::with_capacity(n + 1), Vec::with_capacity(n + 1), 0);
        for i in 0..=n {
            let s = step * count(i);
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
            p.push(segs[a.1].eval(u));
            t.push(direction(&segs[a.1], u));
        }
        let mut curve = Self {
            p,
            t,
            k: Vec::new(),
            step,
            gates: Vec::new(),
            first: 0,
            last: n,
            segs: segs.to_vec(),
        };
        curve.bend();
        curve
    }

    /// Whether it closes on itself.
    pub(super) fn is_ring(&self) -> bool {
        self.p[self.first] == self.p[self.last]
    }

    fn bend(&mut self) {
        let n = self.t.len();
        let turn = |i: usize, j: usize| self.t[i].cross(self.t[j]).atan2(self.t[i].dot(self.t[j]));
        self.k = (0..n)
            .map(|i| {
                let (a, b) = (i.saturating_sub(1), (i + 1).min(n - 1));
                turn(a, b) / (self.step * count(b - a))
            })
            .collect();
    }

    /// A span that may begin and end up to `room` (units) beyond its ends, along their lines.
    fn open(segs: &[PathSeg], room: [f64; 2], [from, to]: [Node; 2], keep: Keep) -> Self {
        let mut curve = Self::sampled(segs, keep.tolerance);
        let beyond = room.map(|r| whole((r / curve.step).min(count(curve.p.len()))));
        let (p, t) = (curve.p.clone(), curve.t.clone());
        let (u, v) = (
            from.along.unwrap_or(t[0]),
            to.along.unwrap_or(t[t.len() - 1]),
        );
        let step = curve.step;
        let before = (1..=beyond[0]).rev().map(|i| p[0] - u * (count(i) * step));
        let end = p[p.len() - 1];
        let after = (1..=beyond[1]).map(|i| end + v * (count(i) * step));
        curve.p = before.chain(p.iter().copied()).chain(after).collect();
        curve.t = std::iter::repeat_n(u, beyond[0])
            .chain(t)
            .chain(std::iter::repeat_n(v, beyond[1]))
            .collect();
        (curve.first, curve.last) = (beyond[0], beyond[0] + p.len() - 1);
        curve.bend();
        curve.gates = curve.extrema(keep.least);
        curve
    }

    /// A ring, turned so that it begins at its most prominent extremum.
    fn ring(segs: &[PathSeg], keep: Keep) -> Option<(Self, Gate)> {
        let mut curve = Self::sampled(segs, keep.tolerance);
        let n = curve.p.len() - 1;
        // The highest sample is an extremum of any ring.
        let top = (0..n).max_by(|&a, &b| curve.p[a].y.total_cmp(&curve.p[b].y))?;
        let pad = n / 3;
        let from = |i: usize| (top + n - pad + i) % n;
        curve.p = (0..=n + 2 * pad).map(|i| curve.p[from(i)]).collect();
        curve.t = (0..=n + 2 * pad).map(|i| curve.t[from(i)]).collect();
        (curve.first, curve.last) = (pad, pad + n);
        curve.bend();
        curve.gates = curve.extrema(keep.least);
        let level = Stored::on(curve.p[pad]).y;
        let gate = Gate {
            at: pad,
            horizontal: true,
            level,
        };
        Some((curve, gate))
    }

    /// Extrema of y and x inside the span, each at least the tolerance from its neighbours.
    fn extrema(&self, tolerance: f64) -> Vec<Gate> {
        let mut gates = Vec::new();
        for horizontal in [true, false] {
            let value = |i: usize| if horizontal { self.p[i].y } else { self.p[i].x };
            let (first, last) = (self.first, self.last);
            let mut found: Vec<usize> = Vec::new();
            for i in first + 1..last {
                let (a, b, c) = (value(i - 1), value(i), value(i + 1));
                if (b > a && b >= c) || (b < a && b <= c) {
                    // A level stretch stands for its middle.
                    let flat = (i..last)
                        .take_while(|&j| (value(j) - b).abs() < 1e-9)
                        .count();
                    found.push(i + flat.saturating_sub(1) / 2);
                }
            }
            prominent(&mut found, value, (first, last), tolerance);
            gates.extend(found.into_iter().map(|at| {
                let s = Stored::on(self.p[at]);
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

    /// The foot of a point near sample `guess`: the sample as a fraction, and the signed distance, left positive.
    pub(super) fn foot(&self, q: Point, guess: f64) -> (f64, f64) {
        let last = self.p.len() - 1;
        let mut j = whole(guess + 0.5).min(last);
        let per = 1.0 / self.step;
        let mut along = 0.0;
        for _ in 0..6 {
            let r = q - self.p[j];
            along = r.dot(self.t[j]) * per;
            if along.abs() <= 1.0 {
                break;
            }
            let next = if along >= 0.0 {
                (j + whole(along + 0.5)).min(last)
            } else {
                j.saturating_sub(whole(0.5 - along))
            };
            if next == j {
                break;
            }
            j = next;
        }
        let r = q - self.p[j];
        let d = self.t[j].cross(r);
        if along.abs() > 1.0 {
            // Beyond an end, or no foot found: the plain distance.
            return (count(j), r.hypot() * if d < 0.0 { -1.0 } else { 1.0 });
        }
        let s = along * self.step;
        (count(j) + along, d - 0.5 * self.k[j] * s * s)
    }

    /// Follows a quadratic from sample `from`; none if it strays farther than `limit` (units),
    /// turns back, or passes sample `until`.
    pub(super) fn follow(
        &self,
        [a, c, b]: [Point; 3],
        from: f64,
        until: f64,
        limit: f64,
    ) -> Option<Followed> {
        /// Places at which a quadratic is measured, in eighths, the likeliest failure first.
        const LOOK: [usize; 7] = [4, 2, 6, 1, 7, 3, 5];
        /// The curve's arc between two feet may be so many times the quadratic's mean.
        const DETOUR: f64 = 1.0;
        /// A foot may lie so many limits behind the start or beyond the end: what rounding moves it.
        const BEYOND: f64 = 0.6;
        let beyond = BEYOND * limit / self.step;
        let (ca, bc) = (c - a, b - c);
        let chord = ca.hypot() + bc.hypot();
        // Between its chord and its legs, as a quadratic's arc does.
        let arc = (2.0 * a.distance(b) + chord) / 3.0;
        let (end, d) = self.foot(b, from + arc / self.step);
        if d.abs() > limit || end > until + beyond || end <= from {
            return None;
        }
        let mut worst = d.abs();
        let mut feet = [from; 9];
        feet[8] = end;
        for i in LOOK {
            let u = 0.125 * count(i);
            let q = a + ca * (2.0 * u * (1.0 - u) + u * u) + bc * (u * u);
            // Arc length along a quadratic grows about as a blend of its two legs.
            let part = (2.0 * u - u * u) * ca.hypot() + u * u * bc.hypot();
            let (at, d) = self.foot(q, from + (end - from) * part / chord.max(1e-9));
            worst = worst.max(d.abs());
            if worst > limit || at < from - beyond || at > end + beyond {
                return None;
            }
            feet[i] = at;
        }
        // A bend that the quadratic leaves out: the curve goes on much farther than the quadratic does.
        let longest = 0.25 * DETOUR * chord + 2.0 * limit;
        let skips = feet.windows(2).any(|f| (f[1] - f[0]) * self.step > longest);
        (!skips).then_some(Followed { at: end, worst })
    }

    /// The largest distance, units, either way, between a quadratic and the samples from `from` to `to`.
    pub(super) fn strays(&self, quad: QuadBez, from: f64, to: f64) -> f64 {
        /// Chords that stand for a quadratic.
        const CHORDS: usize = 32;
        /// Chords that are looked at beyond the one nearest to the sample before.
        const AHEAD: usize = 6;
        let dots: Vec<Point> = (0..=CHORDS)
            .map(|i| quad.eval(count(i) / count(CHORDS)))
            .collect();
        let (mut worst, mut at): (f64, f64) = (0.0, from);
        for pair in dots.windows(2) {
            at = self
                .foot(pair[1], at + pair[0].distance(pair[1]) / self.step)
                .0;
            let near = whole(at).min(self.p.len() - 1);
            let around = &self.p[near.saturating_sub(2)..(near + 4).min(self.p.len())];
            worst = worst.max(beside(pair[1], around, 0, around.len()).1);
        }
        let mut k = 0;
        for q in &self.p[whole(from.ceil().max(0.0))..=whole(to.max(0.0)).min(self.p.len() - 1)] {
            let (nearest, d) = beside(*q, &dots, k, AHEAD);
            (k, worst) = (nearest, worst.max(d));
        }
        worst
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

/// The chord of a polygon nearest to a point, of `many` from `first` on, and its distance.
fn beside(q: Point, dots: &[Point], first: usize, many: usize) -> (usize, f64) {
    let off = |pair: &[Point]| {
        let (a, v) = (pair[0], pair[1] - pair[0]);
        let u = ((q - a).dot(v) / v.hypot2().max(1e-12)).clamp(0.0, 1.0);
        (a + v * u).distance_squared(q)
    };
    let chords = dots.windows(2).enumerate().skip(first).take(many);
    let nearest = chords
        .map(|(k, pair)| (k, off(pair)))
        .min_by(|a, b| a.1.total_cmp(&b.1));
    nearest.map_or((first, 0.0), |(k, d)| (k, d.sqrt()))
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
    let c = seg.to_cubic();
    c.p0.distance(c.p1) + c.p1.distance(c.p2) + c.p2.distance(c.p3)
}

/// Unit tangent; at a collapsed handle the direction to the next control point.
pub(super) fn direction(seg: &PathSeg, u: f64) -> Vec2 {
    let c = seg.to_cubic();
    let d = match seg {
        PathSeg::Line(l) => l.p1 - l.p0,
        PathSeg::Quad(q) => q.deriv().eval(u).to_vec2(),
        PathSeg::Cubic(c) => c.deriv().eval(u).to_vec2(),
    };
    if d.hypot() > 1e-6 * control_length(seg) {
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

/// A count as a number.
#[expect(
    clippy::cast_precision_loss,
    reason = "sample counts are far below 2^52"
)]
pub(super) const fn count(n: usize) -> f64 {
    n as f64
}

/// A number that is known to be whole and not negative.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "callers clamp to a range of indices"
)]
pub(super) const fn whole(x: f64) -> usize {
    x as usize
}
