//! One quadratic more: the labels that it leads to.

use super::super::{
    curve::{count, whole},
    glyf::Stored,
};
use super::lattice::{full, half, level, normal, smooth};
use super::{BYTE, Join, Search, Way};
use crate::numeric::shortest::Id;
use kurbo::{Point, Vec2};

impl Search<'_> {
    /// A line from the start to the end of the span.
    pub(super) fn straight(&mut self, way: Way, join: Join) {
        let Way { id, gate } = way;
        let last = self.stages.len() - 1;
        let to = self.end.at.point();
        let bends = |u: Option<Vec2>| u.is_some_and(|u| !smooth(u, to - join.m));
        if gate != last || bends(join.along) || bends(self.end.along) || self.closing.is_some() {
            return;
        }
        let quad = [join.m, join.m.midpoint(to), to];
        if let Some(f) = self.curve.follow(
            quad,
            join.at,
            self.until(last),
            self.limit(join.at, self.until(last)),
        ) {
            let mut pen = join.pen;
            let bytes = pen.store(self.end.at);
            let item = Join {
                m: to,
                c: None,
                at: f.at,
                next: None,
                along: self.end.along,
                pen,
            };
            self.offer((last, 0), id, (bytes, f.worst), item);
        }
    }

    /// Joins near stage `s`, across the band.
    pub(super) fn joins(&mut self, s: usize, way: Way, c: Point) {
        let i = self.stages[s].at;
        let (p, n) = (self.curve.p[i], normal(self.curve.t[i]));
        self.join(s, way, c, p);
        for level in [0.6, -0.6] {
            self.quad(s, way, [c, half(p + n * (level * self.effort.limit))]);
        }
    }

    /// The join nearest to `p` whose next control point lies on the lattice, and the on-curve point there.
    pub(super) fn join(&mut self, s: usize, way: Way, c: Point, p: Point) -> bool {
        let near = half(p);
        let full = full(p);
        let mut hit = self.quad(s, way, [c, near]);
        if full != near {
            hit |= self.quad(s, way, [c, full]);
        }
        hit
    }

    /// Offers what a quadratic with control point `c` and end `m` leads to.
    pub(super) fn quad(&mut self, s: usize, way: Way, [c, m]: [Point; 2]) -> bool {
        let Way { id, gate } = way;
        /// Spacings of stages between which a reach counts as the same.
        const REACH: f64 = 4.0;
        let i = self.stages[s].at;
        let (t, d) = (
            self.curve.t[i],
            (m - self.curve.p[i]).dot(normal(self.curve.t[i])),
        );
        let limit = self.effort.limit;
        let lean = level((c - m).dot(normal(t)) / limit, 2.0);
        let side = level(d / (0.7 * limit), 1.0);
        // Half way to the next control point: where that comes to lie the rest of the run depends on.
        let reach = whole(((m - c).hypot() / (REACH * self.stages[s].spacing)).min(60.0)) as u64;
        let keys = [1 << 16 | reach << 8 | lean << 4 | side, lean << 4 | side];
        self.both(s, (id, self.until(gate)), [c, m], (keys, m - c))
    }

    /// Offers the implied and, on the lattice, the on-curve join after one quadratic.
    pub(super) fn both(
        &mut self,
        s: usize,
        (id, until): (Id, f64),
        [c, m]: [Point; 2],
        (keys, along): ([u64; 2], Vec2),
    ) -> bool {
        let from = *self.labels.item(id);
        let mut pen = from.pen;
        let implied = pen.store(Stored::off(c));
        let mut on_pen = pen;
        let on = implied + on_pen.store(Stored::on(m));
        let may_on = m == full(m) && s + 1 < self.stages.len();
        let wants = [
            keys[0] != u64::MAX && self.wants((s, keys[0]), id, implied),
            keys[1] != u64::MAX && may_on && self.wants((s, keys[1]), id, on),
        ];
        if wants == [false, false] {
            return true;
        }
        let limit = self.limit(from.at, count(self.stages[s].at));
        let Some(f) = self.curve.follow([from.m, c, m], from.at, until, limit) else {
            return false;
        };
        let item = Join {
            m,
            c: Some(c),
            at: f.at,
            next: Some(m + (m - c)),
            along: None,
            pen,
        };
        if wants[0] {
            self.offer((s, keys[0]), id, (implied, f.worst), item);
        }
        if wants[1] {
            let item = Join {
                next: None,
                along: Some(along.normalize()),
                pen: on_pen,
                ..item
            };
            self.offer((s, keys[1]), id, (on, f.worst), item);
        }
        true
    }

    /// Whether a label of that many more bytes would be kept, and followed.
    pub(super) fn wants(&self, place: (usize, u64), prev: Id, bytes: u32) -> bool {
        let cost = self.labels.cost(prev) + whole(f64::from(bytes) * BYTE) as u64;
        let least = self.labels.least_from(place.0);
        let most = least.saturating_add(self.slack(place.0));
        cost <= most && self.labels.wants(place, cost)
    }

    pub(super) fn offer(
        &mut self,
        place: (usize, u64),
        prev: Id,
        (bytes, worst): (u32, f64),
        item: Join,
    ) {
        let cost = f64::from(bytes) * BYTE + self.effort.lambda * worst * BYTE;
        let cost = self.labels.cost(prev) + whole(cost) as u64;
        self.labels.offer(place, cost, Some(prev), item);
    }
}
