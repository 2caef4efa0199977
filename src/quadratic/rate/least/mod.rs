//! How few bytes an outline can do with: a bound from below that no search enters.
//!
//! Every stored point takes its flag and the steps to it. Between corners, ends of lines and extrema a single control
//! point does only where one of all the quadratics on the grid lies near the whole curve; the bytes of its steps are
//! known but for how far the ends may move. Otherwise there are two control points at least, each a byte away from
//! the point before; two between a level and an upright tangent stand aslant, as on both lines at once there is one
//! point only. Where that alone leads from extremum to extremum, again and again, the joins lie half way between such
//! points or are stored themselves. Equal flags are stored once where three follow each other, which only lines that
//! run alike ask for: a point more takes as many bytes as it could save. Of each contour one step is not stored, but
//! that to its first point.

mod single;

use super::curve::{Course, Curve, Node, Span};
use super::{Rate, Strictness};
use crate::types::Outline;
use kurbo::{Point, Vec2};
use single::{Side, crossing, singles};
use std::collections::BTreeMap;

/// Points of which a part of a contour may consist: their flags, and the bytes of the steps to them with those to
/// the last where the contour begins with it.
struct Points {
    flags: u32,
    steps: Vec<(u32, u32)>,
}

impl Points {
    fn all(&self) -> u32 {
        self.flags + self.steps.iter().map(|s| s.0).sum::<u32>()
    }

    fn begun(&self) -> u32 {
        let begun = self.steps.iter().map(|s| self.all() - s.0 + s.1);
        begun.min().unwrap_or(self.flags)
    }
}

/// What a contour is written after.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum After {
    /// Nothing: its first step is from the origin.
    Origin,
    /// Another contour, whose last point is not known.
    Another,
}

/// What is kept, the tolerance in units, and where the contour stands in its glyph.
#[derive(Debug, Clone, Copy)]
struct Terms {
    keep: Strictness,
    limit: f64,
    after: After,
}

/// Fewest bytes of a part of a contour, and where the contour begins in it.
#[derive(Debug, Clone, Copy)]
struct Part {
    all: u32,
    begun: u32,
    /// Steps of a line: the flag's bits for x and y where they are sure.
    line: Option<[Option<i8>; 2]>,
}

impl Part {
    const NOTHING: Self = Self {
        all: 0,
        begun: u32::MAX / 4,
        line: None,
    };

    /// The two one behind the other.
    fn and(self, next: Self) -> Self {
        Self {
            all: self.all + next.all,
            begun: (self.begun + next.all).min(self.all + next.begun),
            line: None,
        }
    }

    /// No more than either takes.
    fn or(self, other: Self) -> Self {
        Self {
            all: self.all.min(other.all),
            begun: self.begun.min(other.begun),
            line: None,
        }
    }

    fn of(ways: &[Points]) -> Self {
        let least = |bytes: fn(&Points) -> u32| ways.iter().map(bytes).min().unwrap_or(0);
        Self {
            all: least(Points::all),
            begun: least(Points::begun),
            line: None,
        }
    }
}

impl Rate {
    /// Fewest `glyf` bytes of any outline of lines and quadratics on whole units which lies within `tolerance`
    /// (units) of this one and keeps what these options say.
    #[must_use]
    pub fn least_bytes(&self, outline: &Outline, tolerance: f64) -> u32 {
        let keep = self.kept(tolerance);
        let mut total = 0;
        let mut before: Option<bool> = None;
        for course in outline
            .contours()
            .iter()
            .filter_map(|p| Course::new(&p.reverse_subpaths(), keep))
        {
            let parts = parts(
                &course,
                Terms {
                    keep: self.keep,
                    limit: tolerance,
                    after: before.map_or(After::Origin, |_| After::Another),
                },
            );
            let alike = alike(&parts);
            let all: u32 = parts.iter().map(|p| p.all).sum();
            let begun = parts.iter().map(|p| all - p.all + p.begun).min();
            // Flags may go on from one contour to the next, and from a first step to those like it.
            let chance = u32::from(alike.pairs) + before.map_or(0, |pairs| 1 + u32::from(pairs));
            total += 2 + begun.unwrap_or(0).saturating_sub(chance + alike.saved);
            before = Some(alike.pairs);
        }
        if before.is_none() { 0 } else { 12 + total }
    }
}

/// Flags that lines which run alike may save, and whether two neighbours do.
struct Alike {
    saved: u32,
    pairs: bool,
}

fn alike(parts: &[Part]) -> Alike {
    let n = parts.len();
    let same = |i: usize| {
        let pair = (parts[i % n].line, parts[(i + 1) % n].line);
        matches!(pair, (Some(p), Some(q)) if (0..2).all(|k| p[k].is_none() || q[k].is_none() || p[k] == q[k]))
    };
    let saved = (0..n).filter(|&i| n > 2 && same(i) && same(i + 1)).count();
    Alike {
        saved: u32::try_from(saved).unwrap_or(u32::MAX),
        pairs: n > 1 && (0..n).any(same),
    }
}

fn parts(course: &Course, terms: Terms) -> Vec<Part> {
    let passes = terms.keep == Strictness::Corners;
    match course {
        Course::Ring(curve, top) => {
            let mut sides = vec![(Side::Gate(*top), top.at)];
            sides.extend(curve.gates.iter().map(|&g| (Side::Gate(g), g.at)));
            sides.push((Side::Gate(*top), curve.last));
            if passes {
                // Less than a half turn for each.
                let steps = vec![(1, 0); 3];
                return vec![Part::of(&[Points { flags: 3, steps }])];
            }
            vec![chain(curve, &sides, terms)]
        }
        Course::Spans(spans) => {
            let mut out = Vec::new();
            for (from, span, to) in spans {
                let Span::Curve(curve) = span else {
                    out.push(line(*from, *to, terms));
                    continue;
                };
                let gates = curve.gates.iter().filter(|_| !passes);
                let mut sides = vec![(Side::Node(*from), curve.first)];
                sides.extend(gates.map(|&g| (Side::Gate(g), g.at)));
                sides.push((Side::Node(*to), curve.last));
                out.push(match sides[..] {
                    [from, to] => stretch(curve, [from, to], terms),
                    _ => chain(curve, &sides, terms),
                });
            }
            out
        }
    }
}

/// Fewest bytes of a step in x or in y which may become so much shorter or longer, units.
fn step(d: f64, slack: f64) -> u32 {
    match d.abs() - slack {
        v if v > 255.0 => 2,
        v if v > 0.0 => 1,
        _ => 0,
    }
}

/// How far a node may move along x and y, units.
fn slack(node: Node, limit: f64) -> Vec2 {
    let one = |free: f64| if free > 0.0 { limit + 1.0 } else { 0.0 };
    Vec2::new(one(node.free.x), one(node.free.y))
}

/// How far from where it stands a node may come to lie beside the curve, units.
fn moves(node: Node, limit: f64) -> f64 {
    if node.free == Vec2::ZERO && node.along.is_none() {
        node.rounded
    } else {
        limit + node.rounded
    }
}

/// The step to a node where a contour begins there; the first contour's is from the origin.
fn first_step(node: Node, terms: Terms) -> u32 {
    let (p, s) = (node.at.point(), slack(node, terms.limit));
    if terms.after == After::Origin && node.along.is_none() {
        step(p.x, s.x) + step(p.y, s.y)
    } else {
        0
    }
}

fn line(from: Node, to: Node, terms: Terms) -> Part {
    /// Part of a line that each end may give to a curve.
    const GIVEN: f64 = 0.46;
    let d = to.at.point() - from.at.point();
    let both = slack(from, terms.limit) + slack(to, terms.limit);
    let curved = [from, to].iter().filter(|n| n.along.is_some()).count();
    let part = [1.0, 1.0 - GIVEN, 1.0 - 2.0 * GIVEN][curved];
    let bytes =
        |v: f64, slack: f64| step(v, slack).min(if v.abs() * part - slack > 255.0 { 2 } else { 1 });
    let bits = |v: f64, slack: f64| {
        let is_short = v.abs() + slack <= 255.0;
        let is_long = v.abs() * part - slack > 255.0;
        if v == 0.0 && slack == 0.0 {
            Some(0)
        } else if is_short && v.abs() > slack {
            Some(if v > 0.0 { 1 } else { -1 })
        } else {
            is_long.then_some(2)
        }
    };
    let to_it = bytes(d.x, both.x) + bytes(d.y, both.y);
    let points = Points {
        flags: 1,
        steps: vec![(to_it, first_step(to, terms))],
    };
    Part {
        line: Some([bits(d.x, both.x), bits(d.y, both.y)]),
        ..Part::of(&[points])
    }
}

/// A curve from node to node, or around a ring, by way of its extrema. A single control point at the crossing of
/// two tangents is known, so that between two of them the join lies half way or is stored itself.
fn chain(curve: &Curve, sides: &[(Side, usize)], terms: Terms) -> Part {
    let points = |steps: &[u32]| {
        let flags = u32::try_from(steps.len()).unwrap_or(u32::MAX);
        let steps = steps.iter().map(|&bytes| (bytes, 0)).collect();
        Part::of(&[Points { flags, steps }])
    };
    let [one, two] = [points(&[1]), points(&[1, 2])];
    // So far with a control point that is not known, and with one that is by the join after it.
    let mut free = Part::NOTHING;
    let mut known: Option<(Point, BTreeMap<usize, Part>)> = None;
    for pair in sides.windows(2) {
        let pair = [pair[0], pair[1]];
        let joins = known.iter().flat_map(|k| k.1.values());
        let any = joins.fold(free, |least, &part| least.or(part));
        let Some(found) = crossing(curve, pair, terms.limit) else {
            (free, known) = (any.and(stretch(curve, pair, terms)), None);
            continue;
        };
        let mut next: BTreeMap<usize, Part> = BTreeMap::new();
        for (i, j) in found.pairs {
            let mut part = free;
            if let Some((control, parts)) = &known {
                let half_way = control.midpoint(found.control).distance(found.joins[i]) < 1e-9;
                let join = if half_way { Part::NOTHING } else { one };
                let by_it = parts.get(&i).map(|p| p.and(join));
                part = by_it.map_or(part, |p| part.or(p));
            }
            let part = part.and(one);
            next.entry(j)
                .and_modify(|p| *p = p.or(part))
                .or_insert(part);
        }
        (free, known) = (any.and(two), Some((found.control, next)));
    }
    let joins = known.iter().flat_map(|k| k.1.values());
    joins.fold(free, |least, &part| least.or(part))
}

fn stretch(curve: &Curve, sides: [(Side, usize); 2], terms: Terms) -> Part {
    let [(a, _), (b, _)] = sides;
    let node = match b {
        Side::Node(n) => Some(n),
        Side::Gate(_) => None,
    };
    let start = node.map_or(0, |n| first_step(n, terms));
    let points = |to_controls: &[u32], to_node: u32| {
        let mut steps: Vec<_> = to_controls.iter().map(|&bytes| (bytes, 0)).collect();
        steps.extend(node.map(|_| (to_node, start)));
        let flags = u32::try_from(steps.len()).unwrap_or(u32::MAX);
        Points { flags, steps }
    };
    let mut ways = vec![points(&[1, 1], 1)];
    let single = singles(curve, sides, terms.limit);
    ways.extend(single.into_iter().map(|[to, from]| points(&[to], from)));
    let mut part = Part::of(&ways);
    if let (Side::Node(m), Side::Node(n)) = (a, b) {
        // So flat that a line does; so short that both ends may meet.
        let (p, q) = (m.at.point(), n.at.point());
        let chord = (q - p) / p.distance(q).max(1e-9);
        let moves = [m, n].map(|n| moves(n, terms.limit));
        let flat = terms.limit + moves[0].max(moves[1]);
        let inner = &curve.dots[curve.first..=curve.last];
        if inner.iter().all(|o| chord.cross(o.p - p).abs() <= flat) {
            let straight = line(m, n, terms);
            part.all = part.all.min(straight.all);
            part.begun = part.begun.min(straight.begun);
            part.line = Some([None; 2]);
        }
        if p.distance(q) <= moves[0] + moves[1] {
            (part.all, part.begun) = (0, 0);
        }
    }
    part
}

/// Fewest bytes of a curve between two nodes, no extremum in its way.
#[cfg(test)]
pub(super) fn between(curve: &Curve, from: Node, to: Node, limit: f64) -> u32 {
    let sides = [
        (Side::Node(from), curve.first),
        (Side::Node(to), curve.last),
    ];
    let terms = Terms {
        keep: Strictness::Corners,
        limit,
        after: After::Another,
    };
    stretch(curve, sides, terms).all
}
