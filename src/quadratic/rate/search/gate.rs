//! Extrema and the ends of spans: joins on a line that is given.

use super::super::{
    curve::{Node, count},
    glyf::Stored,
};
use super::lattice::{full, half, normal, smooth};
use super::stage::{Kind, gate_direction, on_gate};
use super::{Join, Search, Way};
use kurbo::Point;

impl Search<'_> {
    /// The quadratic that ends at the gate or the span's end, if `c` allows one.
    pub(super) fn reach_gate(&mut self, way: Way, c: Point) -> bool {
        let Way { id, gate } = way;
        let i = self.stages[gate].at;
        let g = match self.stages[gate].kind {
            Kind::Gate(g) | Kind::Pass(g) => g,
            Kind::End => match self.closing {
                Some(g) => g,
                None => return self.reach_end(way, c),
            },
            Kind::Free => return false,
        };
        if on_gate(g, c) != c {
            return false;
        }
        let (p, slide) = (on_gate(g, self.curve.p[i]), self.slide(i));
        let ahead = gate_direction(g, self.curve.t[i]);
        let until = self.until(gate) + slide / self.curve.step;
        let mut hit = false;
        // Inside a run the join lies half way to a control point that the curve ahead asks for.
        for k in 0..self.nexts[gate].len() {
            let next = self.nexts[gate][k];
            let m = c.midpoint(next);
            if (m - c).dot(ahead) > 0.25 && (m - p).hypot() <= slide {
                hit |= self.both(
                    gate,
                    (id, until),
                    [c, m],
                    ([k as u64 | 1 << 16, u64::MAX], ahead),
                );
            }
        }
        for k in [0.0, -0.5, 0.5] {
            let m = full(p + ahead * (k * slide));
            if (m - c).dot(ahead) > 0.25 && self.closing.is_none() {
                hit |= self.both(gate, (id, until), [c, m], ([u64::MAX, 0], ahead));
            }
        }
        hit
    }

    /// Control points on a gate's line from which the tangents ahead can be reached.
    pub(super) fn nexts_of(&self, gate: usize) -> Vec<Point> {
        let Some(g) = self.stages[gate].kind.gate() else {
            return Vec::new();
        };
        let p = on_gate(g, self.curve.p[g.at]);
        let ahead = gate_direction(g, self.curve.t[g.at]);
        let mut out = Vec::new();
        for s in gate + 1..self.stages.len() {
            for level in [0.0, 0.6, -0.6] {
                let (target, dir) = self.target(s, level * self.effort.limit);
                let turn = ahead.cross(dir);
                let along = (target - p).cross(dir) / turn;
                let next = full(p + ahead * along);
                if turn.abs() > 1e-3 && along > 0.0 && !out.contains(&next) {
                    out.push(next);
                }
            }
            if self.stages[s].kind.blocks() {
                break;
            }
        }
        out
    }

    pub(super) fn reach_end(&mut self, way: Way, c: Point) -> bool {
        let Way { id, gate } = way;
        let from = *self.labels.item(id);
        let mut pen = from.pen;
        let bytes = pen.store(Stored::off(c));
        let along = self.end.along;
        let mut hit = false;
        for k in 0..self.ends.len() {
            let m = self.ends[k];
            if m == c || along.is_some_and(|u| !smooth(u, m - c)) {
                continue;
            }
            let mut pen = pen;
            let bytes = bytes + pen.store(Stored::on(m));
            if !self.wants((gate, 0), id, bytes) {
                continue;
            }
            let beyond = (m - self.end.at.point()).dot(along.unwrap_or_default()) / self.curve.step;
            if let Some(f) = self.curve.follow(
                [from.m, c, m],
                from.at,
                self.until(gate) + beyond,
                self.effort.limit,
            ) {
                let item = Join {
                    m,
                    c: Some(c),
                    at: f.at,
                    next: None,
                    along: None,
                    pen,
                };
                self.offer((gate, 0), id, (bytes, f.worst), item);
                hit = true;
            }
        }
        hit
    }

    /// Where the span may begin or end: the node itself, or beside it along its line as far as the
    /// curve's bend and the samples beyond the node allow.
    pub(super) fn slides(&self, node: Node, i: usize, room: usize) -> Vec<Point> {
        /// Part of the limit that a line may lie beside the curve's end, for its own rounding's sake.
        const BESIDE: f64 = 0.8;
        let p = node.at.point();
        let mut out = vec![p];
        let Some(u) = node.along else { return out };
        if room == 0 || (u.x != 0.0 && u.y != 0.0) {
            return out;
        }
        let reach = self.slide(i).min(count(room) * self.curve.step - 1.0);
        for k in [-1.0, -0.5, 0.5, 1.0] {
            let m = full(p + u * (k * reach));
            // The line reaches to the join: where that lies beside the curve, so does the line.
            let guess = count(i) + k * reach / self.curve.step;
            let beside = self.curve.foot(m, guess).1.abs();
            if beside <= BESIDE * self.effort.limit && !out.contains(&m) {
                out.push(m);
            }
        }
        out
    }

    /// Joins after which the next control point lies on the gate's line.
    pub(super) fn towards_gate(&mut self, stage: usize, way: Way, c: Point) {
        let Way { gate, .. } = way;
        let (line, u) = match (self.stages[gate].kind, self.end.along) {
            (Kind::Gate(g) | Kind::Pass(g), _) => (
                on_gate(g, self.curve.p[g.at]),
                gate_direction(g, self.curve.t[g.at]),
            ),
            (Kind::End, Some(u)) => (self.end.at.point(), u),
            _ => return,
        };
        let n = normal(u);
        let want = 0.5 * ((c - line).dot(n));
        let (mut before, mut found) = (f64::NAN, None);
        for s in stage + 1..=gate {
            let p = self.curve.p[self.stages[s].at];
            let now = (p - line).dot(n) - want;
            if before * now <= 0.0 {
                found = Some((s, before / (before - now)));
                break;
            }
            before = now;
        }
        let Some((s, part)) = found else { return };
        let (i, j) = (self.stages[s - 1].at, self.stages[s].at);
        let p = self.curve.p[i].lerp(self.curve.p[j], part);
        let near = if part < 0.5 { s - 1 } else { s };
        if near <= stage || near >= gate {
            return;
        }
        for k in -2..=2 {
            let q = p + u * f64::from(k) * 0.5 * self.effort.limit;
            let m = half(q);
            let m = if u.y == 0.0 {
                Point::new(m.x, line.y + want * n.y)
            } else if u.x == 0.0 {
                Point::new(line.x + want * n.x, m.y)
            } else {
                m
            };
            self.quad(near, way, [c, m]);
        }
    }

    /// How far along a gate its join may slide: where the curve has left the tangent by the tolerance's half.
    pub(super) fn slide(&self, i: usize) -> f64 {
        let inside =
            |j: usize| self.curve.k[j.clamp(self.curve.first + 2, self.curve.last - 2)].abs();
        (self.effort.limit / inside(i).max(1e-4)).sqrt()
    }
}
