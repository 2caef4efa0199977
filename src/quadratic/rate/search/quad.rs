//! One quadratic more: the labels that it leads to.

use super::super::{curve::Curve, glyf::Stored};
use super::lattice::{full, half, level, smooth};
use super::{BYTE, Join, Leg, Search, Way};
use crate::numeric::cast::index;
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
                worst: f.worst,
                next: None,
                along: self.end.along,
                pen,
            };
            let cost = self.labels.cost(id) + price(bytes);
            self.offer((last, 0), id, (cost, f.worst), item);
        }
    }

    /// A control point laid after a label.
    pub(super) fn leg(&self, way: Way, c: Point) -> Leg {
        let from = self.labels.item(way.id);
        let mut pen = from.pen;
        let cost = self.labels.cost(way.id) + price(pen.store(Stored::off(c)));
        Leg {
            id: way.id,
            gate: way.gate,
            from: from.m,
            at: from.at,
            c,
            pen,
            cost,
        }
    }

    /// Joins at stage `s` on one level; whether any quadratic came so far.
    pub(super) fn joins(&mut self, s: usize, leg: &Leg, level: usize) -> bool {
        let mut hit = false;
        for k in 0..self.places[s].len() {
            if self.places[s][k].level == level {
                hit |= self.join(s, leg, k);
            }
        }
        hit
    }

    /// Offers what a quadratic that ends at a place of stage `s` leads to; whether it comes so far.
    pub(super) fn join(&mut self, s: usize, leg: &Leg, place: usize) -> bool {
        if leg.cost > self.most(s) {
            return true;
        }
        let Place { m, foot, side, .. } = self.places[s][place];
        let keys = self.keys(s, (leg.c, m), side);
        self.both(s, leg, (m, foot, self.until(leg.gate)), (keys, m - leg.c))
    }

    /// Kinds of the futures of an implied and of an on-curve join.
    fn keys(&self, s: usize, (c, m): (Point, Point), side: u64) -> [u64; 2] {
        /// Spacings of stages between which a reach counts as the same.
        const REACH: f64 = 4.0;
        let n = self.curve.dots[self.stages[s].at].t.turn_90();
        let lean = level((c - m).dot(n) / self.effort.limit, 2.0);
        // Half way to the next control point: where that comes to lie the rest of the run depends on.
        let reach = index(((m - c).hypot() / (REACH * self.stages[s].spacing)).min(60.0)) as u64;
        [1 << 16 | reach << 8 | lean << 4 | side, lean << 4 | side]
    }

    /// The same at a place that depends on the control point.
    pub(super) fn quad(&mut self, s: usize, leg: &Leg, m: Point) -> bool {
        if leg.cost > self.most(s) {
            return true;
        }
        let i = self.stages[s].at;
        let side = side(self.curve, i, m, self.effort.limit);
        let keys = self.keys(s, (leg.c, m), side);
        let foot = self.curve.foot(m, i as f64);
        self.both(s, leg, (m, foot, self.until(leg.gate)), (keys, m - leg.c))
    }

    /// Offers the implied and, on the lattice, the on-curve join after one quadratic.
    pub(super) fn both(
        &mut self,
        s: usize,
        leg: &Leg,
        (m, foot, until): (Point, (f64, f64), f64),
        (keys, along): ([u64; 2], Vec2),
    ) -> bool {
        let mut on_pen = leg.pen;
        let may_on = keys[1] != u64::MAX && s + 1 < self.stages.len() && m == full(m);
        let wants_implied = keys[0] != u64::MAX && self.wants((s, keys[0]), leg.cost);
        let on = may_on
            .then(|| leg.cost + price(on_pen.store(Stored::on(m))))
            .filter(|&cost| self.wants((s, keys[1]), cost));
        if !wants_implied && on.is_none() {
            return true;
        }
        let limit = self.limit(leg.at, self.stages[s].at as f64);
        let quad = [leg.from, leg.c, m];
        let Some(f) = self.curve.measure(quad, (leg.at, foot), until, limit) else {
            return false;
        };
        let item = Join {
            m,
            c: Some(leg.c),
            at: f.at,
            worst: f.worst,
            next: Some(m + (m - leg.c)),
            along: None,
            pen: leg.pen,
        };
        if wants_implied {
            self.offer((s, keys[0]), leg.id, (leg.cost, f.worst), item);
        }
        if let Some(cost) = on {
            let item = Join {
                next: None,
                along: Some(along.normalize()),
                pen: on_pen,
                ..item
            };
            self.offer((s, keys[1]), leg.id, (cost, f.worst), item);
        }
        true
    }

    /// What a label may cost at a stage.
    pub(super) fn most(&self, s: usize) -> u64 {
        self.labels.least_from(s).saturating_add(self.slacks[s])
    }

    /// Whether a label of that cost would be kept, and followed.
    pub(super) fn wants(&self, place: (usize, u64), cost: u64) -> bool {
        /// A gain below it is not worth a measurement: a twenty-fifth of a byte.
        const GAIN: u64 = 160;
        cost <= self.most(place.0) && self.labels.wants(place, cost + GAIN)
    }

    pub(super) fn offer(
        &mut self,
        place: (usize, u64),
        prev: Id,
        (cost, worst): (u64, f64),
        item: Join,
    ) {
        let cost = cost + index(self.effort.lambda * worst * BYTE) as u64;
        self.labels.offer(place, cost, Some(prev), item);
    }
}

/// Cost of bytes.
pub(super) fn price(bytes: u32) -> u64 {
    index(f64::from(bytes) * BYTE) as u64
}

/// Where joins are tried across the band, limits.
pub(super) const LEVELS: [f64; 3] = [0.0, 0.6, -0.6];

/// Where joins of a stage are tried whatever comes before.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    m: Point,
    /// The sample beside it, and its distance, left positive.
    foot: (f64, f64),
    side: u64,
    /// Which of the levels.
    level: usize,
    /// Whether it is tried after a control point that is given.
    pub(super) is_usual: bool,
}

/// The joins nearest to the levels whose next control point lies on the lattice, and the points there.
pub(super) fn places(curve: &Curve, i: usize, limit: f64) -> Vec<Place> {
    let n = curve.dots[i].t.turn_90();
    let mut out = Vec::new();
    for (level, &height) in LEVELS.iter().enumerate() {
        let p = curve.dots[i].p + n * (height * limit);
        let (near, full) = (half(p), full(p));
        let both = [(near, true), (full, level == 0)];
        for (m, is_usual) in both.into_iter().take(1 + usize::from(full != near)) {
            out.push(Place {
                m,
                foot: curve.foot(m, i as f64),
                side: side(curve, i, m, limit),
                level,
                is_usual,
            });
        }
    }
    out
}

/// On which side of the curve a join lies, in three steps.
fn side(curve: &Curve, i: usize, m: Point, limit: f64) -> u64 {
    let d = (m - curve.dots[i].p).dot(curve.dots[i].t.turn_90());
    level(d / (0.7 * limit), 1.0)
}
