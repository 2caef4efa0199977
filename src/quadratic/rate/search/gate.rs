//! Extrema and the ends of spans: joins on a line that is given.

use super::super::{
    curve::{Node, coarse},
    glyf::Stored,
};
use super::lattice::{floor, full, half, is_ahead, smooth};
use super::quad::price;
use super::stage::{Kind, gate_direction, on_gate};
use super::{Join, Leg, Search};
use kurbo::{Point, Vec2};

impl Search<'_> {
    /// The quadratic that ends at the gate or the span's end, if `c` allows one.
    pub(super) fn reach_gate(&mut self, leg: &Leg) -> bool {
        let Leg { gate, c, .. } = *leg;
        let i = self.stages[gate].at;
        let g = match self.stages[gate].kind {
            Kind::Gate(g) | Kind::Pass(g) => g,
            Kind::End => match self.closing {
                Some(g) => g,
                None => return self.reach_end(leg),
            },
            Kind::Free => return false,
        };
        if on_gate(g, c) != c {
            return false;
        }
        let (p, slide) = (on_gate(g, self.curve.dots[i].p), self.slide(i));
        let ahead = gate_direction(g, self.curve.dots[i].t);
        let until = self.until(gate) + slide / self.curve.step;
        let mut hit = false;
        // Inside a run the join lies half way to a control point that the curve ahead asks for.
        for k in 0..self.nexts[gate].len() {
            let next = self.nexts[gate][k];
            let m = c.midpoint(next);
            if (m - c).dot(ahead) > 0.25 && (m - p).hypot() <= slide {
                let foot = self.curve.foot(m, i as f64);
                let keys = [k as u64 | 1 << 16, u64::MAX];
                hit |= self.both(gate, leg, (m, foot, until), (keys, ahead));
            }
        }
        for k in [0.0, -0.35, 0.35, -0.7, 0.7, -1.0, 1.0] {
            let m = full(p + ahead * (k * slide));
            if (m - c).dot(ahead) > 0.25 && self.closing.is_none() {
                let foot = self.curve.foot(m, i as f64);
                hit |= self.both(gate, leg, (m, foot, until), ([u64::MAX, 0], ahead));
            }
        }
        hit
    }

    /// Control points on a gate's line from which the tangents ahead can be reached.
    pub(super) fn nexts_of(&self, gate: usize) -> Vec<Point> {
        let Some(g) = self.stages[gate].kind.gate() else {
            return Vec::new();
        };
        let p = on_gate(g, self.curve.dots[g.at].p);
        let ahead = gate_direction(g, self.curve.dots[g.at].t);
        let mut out = Vec::new();
        if let Some(c) = self.halved(gate, (p, ahead)) {
            let low = floor(c);
            out.extend([low, on_gate(g, low + Vec2::new(1.0, 1.0))].map(|c| on_gate(g, c)));
        }
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

    /// The control point on a line from which two quadratics lead to the next line given, with a join half way
    /// to their second control point on the curve's own tangent: a quadrant's two.
    pub(super) fn halved(&self, stage: usize, (p, u): (Point, Vec2)) -> Option<Point> {
        let gate = *self.ahead.get(stage)?.first()?;
        let (q, v) = self.rail(gate)?;
        let (from, to) = (self.stages[stage].at, self.stages[gate].at);
        let mut last = None;
        for i in from + 1..to {
            let (o, t) = (self.curve.dots[i].p, self.curve.dots[i].t);
            let (before, after) = (u.cross(t), v.cross(t));
            if before.abs() < 1e-3 || after.abs() < 1e-3 {
                continue;
            }
            let c = p + u * ((o - p).cross(t) / before);
            let next = q + v * ((o - q).cross(t) / after);
            let longer = (o - c).dot(t) - (next - o).dot(t);
            match last.replace(longer) {
                Some(l) if l < 0.0 && longer >= 0.0 => return Some(c),
                _ => {}
            }
        }
        None
    }

    /// The line along which the curve passes a gate or ends.
    fn rail(&self, stage: usize) -> Option<(Point, Vec2)> {
        match self.stages[stage].kind {
            Kind::Gate(g) | Kind::Pass(g) => {
                let along = gate_direction(g, self.curve.dots[g.at].t);
                Some((on_gate(g, self.curve.dots[g.at].p), along))
            }
            Kind::End => self.end.along.map(|u| (self.end.at.point(), u)),
            Kind::Free => None,
        }
    }

    fn reach_end(&mut self, leg: &Leg) -> bool {
        let Leg { gate, c, .. } = *leg;
        let (along, ends) = (self.end.along, self.curve.dots[self.curve.last].t);
        let mut hit = false;
        for k in 0..self.ends.len() {
            let m = self.ends[k];
            let fits = along.map_or_else(|| is_ahead(ends, m - c), |u| smooth(u, m - c));
            if m == c || !fits {
                continue;
            }
            let mut pen = leg.pen;
            let cost = leg.cost + price(pen.store(Stored::on(m)));
            if !self.wants((gate, 0), cost) {
                continue;
            }
            let beyond = (m - self.end.at.point()).dot(along.unwrap_or_default()) / self.curve.step;
            if let Some(f) = self.curve.follow(
                [leg.from, c, m],
                leg.at,
                self.until(gate) + beyond,
                self.limit(leg.at, self.until(gate)),
            ) {
                let item = Join {
                    m,
                    c: Some(c),
                    at: f.at,
                    worst: f.worst,
                    next: None,
                    along: None,
                    pen,
                };
                self.offer((gate, 0), leg.id, (cost, f.worst), item);
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
        let Some(u) = node.along else {
            out.extend(self.moved(node, i));
            return out;
        };
        if room == 0 {
            return out;
        }
        let reach = self.slide(i).min(room as f64 * self.curve.step - 1.0);
        for k in [-1.0, -0.5, 0.5, 1.0] {
            let m = full(p + u * (k * reach));
            // The line reaches to the join: where that lies beside the curve, so does the line.
            let guess = i as f64 + k * reach / self.curve.step;
            let (at, beside) = self.curve.foot(m, guess);
            let most = self.effort.beside * self.effort.limit;
            let bulges = self.curve.between(i as f64, at);
            let bulges = bulges.iter().any(|o| u.cross(o.p - m).abs() > most);
            if beside.abs() <= BESIDE * most && !bulges && !out.contains(&m) {
                out.push(m);
            }
        }
        out
    }

    /// Where a corner may move.
    fn moved(&self, node: Node, i: usize) -> Vec<Point> {
        let (p, exact) = (node.at.point(), self.curve.dots[i].p);
        let most = node.free.x.max(node.free.y);
        let reach = Stored::on(Point::new(most, 0.0)).x + 1;
        let every = Stored::on(Point::new(coarse(self.effort.limit).floor(), 0.0)).x;
        let side = move || (-reach..=reach).filter(move |v| v % every == 0);
        let around = side().flat_map(move |x| side().map(move |y| (x, y)));
        let points = around.filter(|&(x, y)| {
            (x == 0 || node.free.x > 0.0) && (y == 0 || node.free.y > 0.0) && (x, y) != (0, 0)
        });
        let points = points.map(|(x, y)| p + Vec2::new(f64::from(x), f64::from(y)));
        points.filter(|m| m.distance(exact) <= most).collect()
    }

    /// Joins after which the next control point lies on the gate's line.
    pub(super) fn towards_gate(&mut self, stage: usize, leg: &Leg) {
        let Leg { gate, c, .. } = *leg;
        let Some((line, u)) = self.rail(gate) else {
            return;
        };
        let n = u.turn_90();
        let want = 0.5 * ((c - line).dot(n));
        let (mut before, mut found) = (f64::NAN, None);
        for s in stage + 1..=gate {
            let p = self.curve.dots[self.stages[s].at].p;
            let now = (p - line).dot(n) - want;
            if before * now <= 0.0 {
                found = Some((s, before / (before - now)));
                break;
            }
            before = now;
        }
        let Some((s, part)) = found else { return };
        let (i, j) = (self.stages[s - 1].at, self.stages[s].at);
        let p = self.curve.dots[i].p.lerp(self.curve.dots[j].p, part);
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
            self.quad(near, leg, m);
        }
    }

    /// How far along a gate its join may slide: where the curve has left the tangent by the tolerance's half.
    pub(super) fn slide(&self, i: usize) -> f64 {
        let inside = |j: usize| {
            self.curve.dots[j.clamp(self.curve.first + 2, self.curve.last - 2)]
                .k
                .abs()
        };
        (2.0 * self.effort.limit / inside(i).max(1e-4)).sqrt()
    }
}
