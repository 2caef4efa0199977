//! The cheapest run of stored points along one span, by shortest path.

mod care;
mod gate;
mod lattice;
mod quad;
mod stage;

use super::Strictness;
use super::curve::{Curve, Gate, Node, count};
use super::glyf::{Pen, Stored};
use crate::numeric::shortest::{Id, Labels};
pub(super) use care::Care;
use kurbo::{Point, Vec2};
pub(super) use lattice::smooth;
use lattice::{floor, normal};
use stage::{Kind, Stage, gate_direction, on_gate, stages};

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
    pub(super) otherwise: Otherwise,
}

/// A join of two quadratics, and the control point before it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Join {
    pub(super) m: Point,
    /// The control point of the quadratic that ends here; none at the start.
    pub(super) c: Option<Point>,
    at: f64,
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

/// The labels of one span, and what bounds them.
pub(super) struct Search<'a> {
    curve: &'a Curve,
    effort: Effort,
    stages: Vec<Stage>,
    labels: Labels<Join>,
    end: Node,
    /// For each gate, the control points that may follow it.
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
        let mut search = Self {
            curve,
            effort,
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
        let beyond = curve.p.len() - 1 - curve.last;
        search.ends = if curve.is_ring() {
            vec![end.at.point()]
        } else {
            search.slides(end, curve.last, beyond)
        };
        search
    }

    /// Runs the search; answers the labels at the end, cheapest first.
    pub(super) fn run(&mut self, start: Start) -> Vec<Id> {
        let begin = count(self.curve.first);
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
            let most = least.saturating_add(self.slack(stage));
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
        for k in 0..self.ahead[stage].len() {
            let gate = self.ahead[stage][k];
            self.reach_gate(Way { gate, ..way }, c);
            self.towards_gate(stage, Way { gate, ..way }, c);
        }
        let mut inside = false;
        for s in stage + 1..gate {
            let i = self.stages[s].at;
            let beside = self.curve.t[i].cross(c - self.curve.p[i]);
            let ahead = (self.curve.p[i] - c).dot(self.curve.t[i]) > 0.0;
            if beside.abs() <= reach && ahead {
                inside = true;
                self.joins(s, way, c);
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
        let own = join.along.unwrap_or(self.curve.t[here]);
        if join.c.is_none() {
            self.straight(way, join);
        }
        if let Some(c) = self.halved(stage, (join.m, own)) {
            let gate = self.ahead[stage][0];
            for c in self.around(join, c, stage + 1) {
                self.towards_gate(stage, Way { gate, ..way }, c);
            }
        }
        let mut misses = 0;
        for s in stage + 1..=gate {
            let i = self.stages[s].at;
            let mut hit = false;
            let is_gate = !matches!(self.stages[s].kind, Kind::Free);
            let levels: &[f64] = if is_gate { &[0.0] } else { &[0.0, 0.6, -0.6] };
            for &level in levels {
                let (target, dir) = self.target(s, level * limit);
                let turn = own.cross(dir);
                let c = if turn.abs() < 1e-3 {
                    join.m.midpoint(target)
                } else {
                    join.m + own * ((target - join.m).cross(dir) / turn)
                };
                let through = self.through(join, here, s);
                for c in through
                    .into_iter()
                    .chain([c])
                    .flat_map(|c| self.around(join, c, s))
                    .collect::<Vec<_>>()
                {
                    hit |= if is_gate {
                        self.reach_gate(Way { gate: s, ..way }, c)
                    } else {
                        let aside = normal(self.curve.t[i]) * (level * limit);
                        self.join(s, way, c, self.curve.p[i] + aside)
                    };
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
            let middle = self.curve.p[here.midpoint(i)];
            let ends = join.m.midpoint(self.target(s, 0.0).0);
            middle + (middle - ends)
        })
    }

    /// A point and direction that the curve should have at a stage, `aside` units to its left.
    fn target(&self, s: usize, aside: f64) -> (Point, Vec2) {
        let i = self.stages[s].at;
        match self.stages[s].kind {
            Kind::Free => (
                self.curve.p[i] + normal(self.curve.t[i]) * aside,
                self.curve.t[i],
            ),
            Kind::Gate(g) | Kind::Pass(g) => (
                on_gate(g, self.curve.p[i]),
                gate_direction(g, self.curve.t[i]),
            ),
            Kind::End => (
                self.end.at.point(),
                self.end.along.unwrap_or(self.curve.t[i]),
            ),
        }
    }

    /// Lattice points near `c` that keep the join smooth.
    fn around(&self, join: Join, c: Point, s: usize) -> Vec<Point> {
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
                fixed(gate_direction(g, self.curve.t[g.at]), on_gate(g, c))
            }
            Kind::End => self
                .end
                .along
                .into_iter()
                .for_each(|u| fixed(u, self.end.at.point())),
            Kind::Free => {}
        }
        let mut out: Vec<Point> = Vec::with_capacity(4);
        for x in xs {
            for y in ys {
                let q = Point::new(x, y);
                if !out.contains(&q)
                    && q != join.m
                    && join.along.is_none_or(|u| smooth(u, q - join.m))
                {
                    out.push(q);
                }
            }
        }
        out
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
        count(self.stages[gate].at)
    }
}
