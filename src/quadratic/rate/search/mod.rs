//! The cheapest run of stored points along one span, by shortest path.

mod care;
mod gate;
mod lattice;
mod quad;
mod stage;

use super::Strictness;
use super::curve::{Curve, Gate, Node};
use super::glyf::{Pen, Stored};
use crate::numeric::shortest::{Id, Labels};
pub(super) use care::Care;
use kurbo::{Point, Vec2};
use lattice::floor;
pub(super) use lattice::{is_ahead, smooth};
use quad::{LEVELS, Place, places};
pub(super) use stage::on_gate;
use stage::{Kind, Stage, gate_direction, stages};

/// Cost of one byte; what is below it breaks ties by error.
const BYTE: f64 = 4096.0;

/// What is drawn where no path is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Otherwise {
    /// Nothing: another search will.
    Nothing,
    /// The curve's own pieces, rounded.
    Pieces,
}

/// How finely the search looks.
#[derive(Debug, Clone, Copy)]
pub(super) struct Effort {
    /// Largest distance, units.
    pub(super) limit: f64,
    /// Whether extrema must be joins.
    pub(super) keep: Strictness,
    /// Stages for each √(curvature/tolerance) of arc.
    pub(super) grain: f64,
    /// Bytes a label may cost more than the cheapest beyond it.
    pub(super) slack: f64,
    /// Bytes that a unit of largest error, quadratic by quadratic, is worth.
    pub(super) lambda: f64,
    /// Part of the limit that a curve may lie beside a line that is drawn on along it.
    pub(super) beside: f64,
    pub(super) otherwise: Otherwise,
}

/// A join of two quadratics, and the control point before it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Join {
    pub(super) m: Point,
    /// The control point of the quadratic that ends here; none at the start.
    pub(super) c: Option<Point>,
    at: f64,
    /// The largest distance on the way here from the join before, as the search measures.
    worst: f64,
    /// The control point that follows, if it is implied by this join.
    next: Option<Point>,
    /// The direction the next quadratic must have.
    along: Option<Vec2>,
    pen: Pen,
}

impl Join {
    /// The sample where it stands.
    pub(super) const fn at(&self) -> f64 {
        self.at
    }

    /// The largest distance of the quadratic that ends here, as the search measured it.
    pub(super) const fn worst(&self) -> f64 {
        self.worst
    }
}

/// How a ring may begin and end: at an on-curve point, or inside a run whose first control point is this.
#[derive(Debug, Clone, Copy)]
pub(super) enum Start {
    Node(Node),
    Implied { m: Point, next: Point },
}

/// One label to go on from, and the next stage that no quadratic may pass.
#[derive(Debug, Clone, Copy)]
struct Way {
    id: Id,
    gate: usize,
}

/// A label and the control point after it: what all quadratics that leave so share.
#[derive(Debug, Clone, Copy)]
struct Leg {
    id: Id,
    gate: usize,
    from: Point,
    at: f64,
    c: Point,
    /// With the control point stored.
    pen: Pen,
    cost: u64,
}

/// The labels of one span, and what bounds them.
pub(super) struct Search<'a> {
    curve: &'a Curve,
    effort: Effort,
    stages: Vec<Stage>,
    /// For each stage, where joins are tried whatever comes before.
    places: Vec<Vec<Place>>,
    /// For each stage, what a label may cost more than the cheapest beyond it.
    slacks: Vec<u64>,
    labels: Labels<Join>,
    end: Node,
    /// For each gate, the control points that may follow it, in the order of the curve.
    nexts: Vec<Vec<Point>>,
    /// For each stage, the gates that one quadratic may reach: the next two, none beyond one that blocks.
    ahead: Vec<Vec<usize>>,
    /// Where the span may end.
    ends: Vec<Point>,
    /// The gate at which a ring closes with an implied point.
    closing: Option<Gate>,
    care: Care,
}

impl<'a> Search<'a> {
    pub(super) fn new(
        curve: &'a Curve,
        effort: Effort,
        end: Node,
        closing: Option<Gate>,
        care: Care,
    ) -> Self {
        let stages = stages(curve, effort);
        let labels = Labels::new(stages.len());
        let places = stages.iter().map(|s| places(curve, s.at, effort.limit));
        let slacks = stages.iter().map(|s| care.slack(s.at, effort.slack));
        let mut search = Self {
            curve,
            effort,
            places: places.collect(),
            slacks: slacks.collect(),
            stages,
            labels,
            end,
            ends: Vec::new(),
            ahead: Vec::new(),
            nexts: Vec::new(),
            closing,
            care,
        };
        search.ahead = (0..search.stages.len())
            .map(|s| search.gates_after(s))
            .collect();
        search.nexts = (0..search.stages.len())
            .map(|s| search.nexts_of(s))
            .collect();
        let beyond = curve.dots.len() - 1 - curve.last;
        search.ends = if curve.is_ring() {
            vec![end.at.point()]
        } else {
            search.slides(end, curve.last, beyond)
        };
        search
    }

    /// Runs the search; answers the labels at the end, cheapest first.
    pub(super) fn run(&mut self, start: Start) -> Vec<Id> {
        let begin = self.curve.first as f64;
        match start {
            Start::Node(n) => {
                let room = if self.curve.is_ring() {
                    0
                } else {
                    self.curve.first
                };
                let starts = self.slides(n, self.curve.first, room);
                for (k, m) in starts.into_iter().enumerate() {
                    let at = Stored::on(m);
                    let at_sample = begin
                        + (m - n.at.point()).dot(n.along.unwrap_or_default()) / self.curve.step;
                    let join = Join {
                        m,
                        c: None,
                        worst: 0.0,
                        at: at_sample,
                        next: None,
                        along: n.along,
                        pen: Pen::after(at),
                    };
                    self.labels.offer((0, k as u64), 0, None, join);
                }
            }
            Start::Implied { m, next } => {
                let pen = Pen::after(Stored::on(m));
                if let Some(nexts) = self.nexts.last_mut() {
                    nexts.push(next);
                }
                let join = Join {
                    m,
                    c: None,
                    worst: 0.0,
                    at: begin,
                    next: Some(next),
                    along: None,
                    pen,
                };
                self.labels.offer((0, 0), 0, None, join);
            }
        }
        for stage in 0..self.stages.len() {
            let least = self.labels.least_from(stage);
            let most = least.saturating_add(self.slacks[stage]);
            for id in self.labels.at(stage) {
                if self.labels.cost(id) <= most {
                    self.expand(stage, id);
                }
            }
        }
        let mut ends = self.labels.at(self.stages.len() - 1);
        ends.sort_by_key(|&id| (self.labels.cost(id), id));
        ends
    }

    /// The joins on the way to a label.
    pub(super) fn path(&self, id: Id) -> Vec<Join> {
        self.labels.path(id).into_iter().copied().collect()
    }

    fn expand(&mut self, stage: usize, id: Id) {
        let join = *self.labels.item(id);
        let gate = (stage + 1..self.stages.len())
            .find(|&s| self.stages[s].kind.blocks())
            .unwrap_or(self.stages.len() - 1);
        match join.next {
            Some(c) => self.after_control(stage, Way { id, gate }, c),
            None => self.after_node(stage, Way { id, gate }, join),
        }
    }

    /// The next control point is known: the joins that it may lead to.
    fn after_control(&mut self, stage: usize, way: Way, c: Point) {
        /// How far the control point may lie beside the tangent of the join it leads to, in tolerances.
        const BESIDE: f64 = 2.5;
        let Way { gate, .. } = way;
        let reach = BESIDE * self.effort.limit;
        let leg = self.leg(way, c);
        for k in 0..self.ahead[stage].len() {
            let to_gate = Leg {
                gate: self.ahead[stage][k],
                ..leg
            };
            self.reach_gate(&to_gate);
            self.towards_gate(stage, &to_gate);
        }
        let mut inside = false;
        for s in stage + 1..gate {
            let i = self.stages[s].at;
            let beside = self.curve.dots[i].t.cross(c - self.curve.dots[i].p);
            let ahead = (self.curve.dots[i].p - c).dot(self.curve.dots[i].t) > 0.0;
            if beside.abs() <= reach && ahead {
                inside = true;
                for k in 0..self.places[s].len() {
                    if self.places[s][k].is_usual {
                        self.join(s, &leg, k);
                    }
                }
            } else if inside {
                break;
            }
        }
    }

    /// No control point is known: the ones that tangents ahead suggest.
    fn after_node(&mut self, stage: usize, way: Way, join: Join) {
        let Way { gate, .. } = way;
        let limit = self.effort.limit;
        let here = self.stages[stage].at;
        let own = join.along.unwrap_or(self.curve.dots[here].t);
        if join.c.is_none() {
            self.straight(way, join);
        }
        if let Some(c) = self.halved(stage, (join.m, own)) {
            let gate = self.ahead[stage][0];
            for c in self.around(join, c, stage + 1) {
                self.towards_gate(stage, &self.leg(Way { gate, ..way }, c));
            }
        }
        let mut misses = 0;
        for s in stage + 1..=gate {
            let mut hit = false;
            let is_gate = !matches!(self.stages[s].kind, Kind::Free);
            let to = Way {
                gate: if is_gate { s } else { gate },
                ..way
            };
            let levels: &[f64] = if is_gate { &[0.0] } else { &LEVELS };
            for (k, &level) in levels.iter().enumerate() {
                let (target, dir) = self.target(s, level * limit);
                let turn = own.cross(dir);
                let c = if turn.abs() < 1e-3 {
                    join.m.midpoint(target)
                } else {
                    join.m + own * ((target - join.m).cross(dir) / turn)
                };
                let through = self.through(join, here, s);
                for c in through.into_iter().chain([c]) {
                    for c in self.around(join, c, s) {
                        let leg = self.leg(to, c);
                        hit |= if is_gate {
                            self.reach_gate(&leg)
                        } else {
                            self.joins(s, &leg, k)
                        };
                    }
                }
            }
            misses = if hit { 0 } else { misses + 1 };
            if misses > 6 && s > stage + 8 {
                break;
            }
        }
    }

    /// From a corner, or to one, no tangent binds: the control point by which one quadratic passes
    /// the middle of the curve.
    fn through(&self, join: Join, here: usize, s: usize) -> Option<Point> {
        let to_corner = matches!(self.stages[s].kind, Kind::End) && self.end.along.is_none();
        let from_corner = join.c.is_none() && join.along.is_none();
        (to_corner || from_corner).then(|| {
            let i = self.stages[s].at;
            let middle = self.curve.dots[here.midpoint(i)].p;
            let ends = join.m.midpoint(self.target(s, 0.0).0);
            middle + (middle - ends)
        })
    }

    /// A point and direction that the curve should have at a stage, `aside` units to its left.
    fn target(&self, s: usize, aside: f64) -> (Point, Vec2) {
        let i = self.stages[s].at;
        match self.stages[s].kind {
            Kind::Free => (
                self.curve.dots[i].p + self.curve.dots[i].t.turn_90() * aside,
                self.curve.dots[i].t,
            ),
            Kind::Gate(g) | Kind::Pass(g) => (
                on_gate(g, self.curve.dots[i].p),
                gate_direction(g, self.curve.dots[i].t),
            ),
            Kind::End => (
                self.end.at.point(),
                self.end.along.unwrap_or(self.curve.dots[i].t),
            ),
        }
    }

    /// Lattice points near `c` that keep the join smooth, and lie ahead of a corner.
    fn around(&self, join: Join, c: Point, s: usize) -> impl Iterator<Item = Point> + use<> {
        let low = floor(c);
        let mut xs = [low.x, low.x + 1.0];
        let mut ys = [low.y, low.y + 1.0];
        let mut fixed = |u: Vec2, p: Point| {
            if u.x == 0.0 {
                xs = [p.x; 2];
            } else if u.y == 0.0 {
                ys = [p.y; 2];
            }
        };
        if let Some(u) = join.along {
            fixed(u, join.m);
        }
        match self.stages[s].kind {
            Kind::Gate(g) | Kind::Pass(g) => {
                fixed(gate_direction(g, self.curve.dots[g.at].t), on_gate(g, c))
            }
            Kind::End => self
                .end
                .along
                .into_iter()
                .for_each(|u| fixed(u, self.end.at.point())),
            Kind::Free => {}
        }
        let all = [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(i, j)| Point::new(xs[i], ys[j]));
        let begins = self.curve.dots[self.curve.first].t;
        let fits = move |&k: &usize| {
            let (q, leg) = (all[k], all[k] - join.m);
            let fits = join
                .along
                .map_or_else(|| is_ahead(begins, leg), |u| smooth(u, leg));
            fits && q != join.m && !all[..k].contains(&q)
        };
        (0..all.len()).filter(fits).map(move |k| all[k])
    }

    fn gates_after(&self, stage: usize) -> Vec<usize> {
        let mut out = Vec::new();
        for s in stage + 1..self.stages.len() {
            let kind = self.stages[s].kind;
            if !matches!(kind, Kind::Free) {
                out.push(s);
            }
            if kind.blocks() || out.len() == 2 {
                break;
            }
        }
        out
    }

    /// The last sample a quadratic before this gate may reach.
    fn until(&self, gate: usize) -> f64 {
        self.stages[gate].at as f64
    }
}
