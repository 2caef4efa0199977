//! Least squares of all nodes, directions and handles of a chain at once.
//!
//! Solves   min Σ wᵢ ρ(dᵢ / σᵢ) + ½ Σ ((handle / chord − ⅓) / spread)², dᵢ the distance of sample i to the chain,
//! ρ Huber's. Gauss–Newton with Levenberg's damping; the feet of the samples slide
//! along the chain between steps (variable projection), over nodes where they must.
//!
//! A row of the Jacobian touches eight numbers of one segment only: x, y, direction and handle of both ends.
//! Rows are summed over these eight, and the 8 × 8 block of a segment is carried over to the free numbers once.

mod prior;
#[cfg(test)]
mod tests;

use super::chain::{Chain, Join, Kind};
use super::skyline::Skyline;
use kurbo::{CubicBez, Point, Vec2};

/// A point that the chain should pass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Where it lies.
    pub at: Point,
    /// How many independent measurements it stands for.
    pub weight: f64,
    /// Their standard deviation along the normal.
    pub sigma: f64,
}

/// Where on a chain a sample's foot lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Foot {
    /// Index of the segment.
    pub segment: usize,
    /// Parameter there, 0…1.
    pub t: f64,
}

/// What the distances are measured by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// Least standard deviation of the samples, in their units.
    pub sigma: f64,
    /// Distance, in deviations of a sample, from which the cost grows linearly only.
    pub robust: f64,
    /// How far a node may go from where it was, in shorter sides: only what the samples leave open is held by it.
    pub freedom: f64,
}

/// When a refinement ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stop {
    /// Steps at most.
    pub rounds: usize,
    /// Gain of a step, nats, that is not worth another one.
    pub gain: f64,
    /// Cost that must come into reach, or the refinement is given up.
    pub enough: f64,
}

/// Steps as good as the last that a refinement is trusted to take still.
const HOPE: f64 = 4.0;
/// A free direction leaves the chord by no more than this, radians: further, the curve would hook back.
const HOOK: f64 = 1.75;
/// How far a loose end may go, in deviations of a sample: as far as a corner is found astray.
const LOOSE: f64 = 16.0;
/// A step of a foot after which the next is next to nothing, parameter.
const NEAR: f64 = 0.01;
/// How far in one step, in shorter sides.
const STRIDE: f64 = 0.35;

/// Sums over the rows of one segment, the lower half of them. Order of the eight: x, y, direction, handle of the start;
/// handle, direction, x, y of the end.
#[derive(Debug, Clone, Copy, Default)]
struct Block {
    hessian: [[f64; 8]; 8],
    gradient: [f64; 8],
}

impl Block {
    /// Adds a row of the Jacobian.
    fn add(&mut self, row: &[f64; 8], weight: f64, distance: f64) {
        for (g, r) in self.gradient.iter_mut().zip(row) {
            *g += weight * distance * r;
        }
        // two rows at a time, each as long as the longer of them: whole pairs of numbers
        self.pair::<2>(row, weight);
        self.pair::<4>(row, weight);
        self.pair::<6>(row, weight);
        self.pair::<8>(row, weight);
    }

    fn pair<const END: usize>(&mut self, row: &[f64; 8], weight: f64) {
        let two = END - 2..END;
        for (to, r) in self.hessian[two.clone()].iter_mut().zip(&row[two]) {
            let by = weight * r;
            to[..END]
                .iter_mut()
                .zip(&row[..END])
                .for_each(|(h, r)| *h += by * r);
        }
    }
}

/// A number of a node that an optimiser may or may not move.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Slot {
    Fixed,
    Free(usize),
    /// Direction of this line.
    Along(usize),
}

#[derive(Debug, Clone, Copy)]
struct Slots {
    x: Slot,
    y: Slot,
    arrive: Slot,
    leave: Slot,
    back: Slot,
    ahead: Slot,
}

/// A cubic by powers of t.
#[derive(Debug, Clone, Copy)]
struct Powers([Vec2; 4]);

impl Powers {
    fn new(c: &CubicBez) -> Self {
        let [p0, p1, p2, p3] = [c.p0, c.p1, c.p2, c.p3].map(Point::to_vec2);
        Self([
            p0,
            3.0 * (p1 - p0),
            3.0 * (p0 - 2.0 * p1 + p2),
            p3 - p0 + 3.0 * (p1 - p2),
        ])
    }

    fn at(&self, t: f64) -> (Point, Vec2, Vec2) {
        let [a, b, c, d] = self.0;
        let p = ((d * t + c) * t + b) * t + a;
        (
            p.to_point(),
            (3.0 * t * d + 2.0 * c) * t + b,
            6.0 * t * d + 2.0 * c,
        )
    }
}

/// Working memory of [`Refit::run`], used again from call to call.
#[derive(Debug, Clone, Default)]
pub struct Refit {
    /// Nodes over which no foot slides: corners, whose sides may run close together, and ends.
    sealed: Vec<bool>,
    slots: Vec<Slots>,
    powers: Vec<Powers>,
    blocks: Vec<Block>,
    saved: Vec<Block>,
    matrix: Skyline,
    first: Vec<usize>,
    step: Vec<f64>,
    trial: Chain,
    feet: Vec<Foot>,
    /// Distance of each sample to its foot, and the unit normal there.
    off: Vec<(f64, Vec2)>,
    /// Where each node came from, and one over the square of how far it may go.
    anchors: Vec<(Point, f64)>,
}

impl Refit {
    /// Moves what is free of `chain` to the least cost in at most `rounds` steps, and returns that cost.
    /// `feet` starts with a guess for each sample and ends on the chain.
    pub fn run(
        &mut self,
        chain: &mut Chain,
        (samples, feet): (&[Sample], &mut Vec<Foot>),
        scale: Scale,
        stop: Stop,
    ) -> f64 {
        chain.settle();
        let free = self.lay_out(chain);
        self.drop_anchors(chain, scale);
        let mut cost = self.evaluate(chain, samples, feet, scale);
        let mut lambda = 1e-3;
        for _ in 0..stop.rounds {
            if free == 0 || !self.solve(chain, free, lambda) {
                break;
            }
            let mut trial = std::mem::take(&mut self.trial);
            trial.clone_from(chain);
            self.apply(&mut trial);
            let mut slid = std::mem::take(&mut self.feet);
            slid.clone_from(feet);
            std::mem::swap(&mut self.saved, &mut self.blocks);
            let new = self.evaluate(&trial, samples, &mut slid, scale);
            let gain = cost - new;
            if gain > 0.0 {
                std::mem::swap(chain, &mut trial);
                std::mem::swap(feet, &mut slid);
                cost = new;
                lambda = (lambda * 0.2_f64).max(1e-6);
            } else {
                std::mem::swap(&mut self.saved, &mut self.blocks);
                lambda *= 10.0;
            }
            self.trial = trial;
            self.feet = slid;
            let idle = gain.abs() < stop.gain * (1.0 + 0.1 * cost) || lambda > 1e4;
            // Gains shrink from step to step; what is left is hardly more than a few of the last.
            let hopeless = gain > 0.0 && cost - HOPE * gain > stop.enough;
            if idle || hopeless {
                break;
            }
        }
        cost
    }

    /// How many numbers of `chain` are free.
    pub fn free(&mut self, chain: &Chain) -> usize {
        self.lay_out(chain)
    }

    fn lay_out(&mut self, chain: &Chain) -> usize {
        let mut count = 0;
        let mut free = || {
            count += 1;
            Slot::Free(count - 1)
        };
        self.slots.clear();
        for (i, node) in chain.nodes.iter().enumerate() {
            let fixed = node.join.is_fixed();
            let (before, after) = (chain.before(i), chain.after(i));
            let cubic = |s| chain.kind(s) == Some(Kind::Cubic);
            let [x, y] =
                [Join::Vertical, Join::Horizontal].map(|axis| match self.tied(chain, i, axis) {
                    Some(slot) => slot,
                    None if fixed => Slot::Fixed,
                    None => free(),
                });
            let turning = |join: Join| matches!(join, Join::End | Join::Loose | Join::Corner);
            let (arrive, leave) = match node.join {
                Join::Smooth => {
                    let one = chain.line_beside(i).map_or_else(&mut free, Slot::Along);
                    (one, one)
                }
                j if turning(j) => (
                    if cubic(before) { free() } else { Slot::Fixed },
                    if cubic(after) { free() } else { Slot::Fixed },
                ),
                _ => (Slot::Fixed, Slot::Fixed),
            };
            let back = if cubic(before) { free() } else { Slot::Fixed };
            let ahead = if cubic(after) { free() } else { Slot::Fixed };
            self.slots.push(Slots {
                x,
                y,
                arrive,
                leave,
                back,
                ahead,
            });
        }
        count
    }

    /// The slot that an upright or level line before or after node `i` forces upon its x (`Vertical`) or y.
    fn tied(&self, chain: &Chain, i: usize, axis: Join) -> Option<Slot> {
        let runs = |line: usize| {
            let (a, b) = chain.ends(line);
            chain.kinds[line] == Kind::Line
                && (chain.nodes[a].join == axis || chain.nodes[b].join == axis)
        };
        let pick = |s: &Slots| if axis == Join::Vertical { s.x } else { s.y };
        let before = chain
            .before(i)
            .filter(|l| runs(*l))
            .map(|l| chain.ends(l).0);
        let after = chain.after(i).filter(|l| runs(*l)).map(|l| chain.ends(l).1);
        let mut neighbours = before.into_iter().chain(after);
        neighbours.find_map(|other| {
            if chain.nodes[other].join.is_fixed() {
                return Some(Slot::Fixed);
            }
            (other < i).then(|| pick(&self.slots[other]))
        })
    }

    /// Slides the feet, sums the rows of each segment, and returns the cost.
    fn evaluate(
        &mut self,
        chain: &Chain,
        samples: &[Sample],
        feet: &mut [Foot],
        scale: Scale,
    ) -> f64 {
        self.sealed.clear();
        let last = chain.nodes.len() - 1;
        self.sealed
            .extend(chain.nodes.iter().enumerate().map(|(i, n)| {
                let end = !chain.is_ring() && (i == 0 || i == last);
                end || n.join == Join::Corner || n.join.is_end()
            }));
        self.powers.clear();
        self.blocks.clear();
        let mut cost = 0.0;
        for i in 0..chain.kinds.len() {
            self.powers.push(Powers::new(&chain.cubic(i)));
            let mut block = Block::default();
            cost += prior::handles(chain, i, &mut block);
            cost += prior::levels(chain, i, scale.sigma, &mut block);
            cost += prior::anchor(chain.nodes[i].point, self.anchors[i], &mut block);
            self.blocks.push(block);
        }
        // feet first: each is a long chain of steps by itself, and apart from the sums several go on at once
        let mut off = std::mem::take(&mut self.off);
        off.clear();
        let pairs = samples.iter().zip(feet.iter_mut());
        off.extend(pairs.map(|(sample, foot)| self.slide(sample.at, foot)));
        for ((sample, foot), (distance, normal)) in samples.iter().zip(feet).zip(&off) {
            let precision = sample.sigma.recip();
            let u = distance.abs() * precision;
            let (rho, pull) = if u < scale.robust {
                (0.5 * u * u, 1.0)
            } else {
                (scale.robust * (u - 0.5 * scale.robust), scale.robust / u)
            };
            cost += sample.weight * rho;
            let weight = sample.weight * pull * precision * precision;
            self.blocks[foot.segment].add(&row(chain, *foot, *normal), weight, *distance);
        }
        self.off = off;
        cost
    }

    /// Moves a foot to the nearest place near by; returns how far it is from the sample along a unit vector, and that vector:
    /// the normal there, or beyond an end the way from the sample.
    fn slide(&self, at: Point, foot: &mut Foot) -> (f64, Vec2) {
        let n = self.powers.len();
        foot.segment = foot.segment.min(n - 1);
        let mut came = 0i8;
        for _ in 0..4 {
            for _ in 0..2 {
                let (p, d, dd) = self.powers[foot.segment].at(foot.t);
                let speed = d.hypot2();
                let bend = speed + (p - at).dot(dd);
                let step = (p - at).dot(d) / bend.max(0.25 * speed).max(1e-12);
                foot.t = (foot.t - step.clamp(-0.3, 0.3)).clamp(-0.2, 1.2);
                if step.abs() < NEAR {
                    break;
                }
            }
            let over = foot.t > 1.0;
            if !over && foot.t >= 0.0 {
                break;
            }
            let turned = if over { came < 0 } else { came > 0 };
            let node = (foot.segment + usize::from(over)) % self.sealed.len();
            foot.t = f64::from(u8::from(over));
            if turned || self.sealed[node] {
                break;
            }
            foot.segment = if over {
                (foot.segment + 1) % n
            } else {
                (foot.segment + n - 1) % n
            };
            foot.t = 1.0 - foot.t;
            came = if over { 1 } else { -1 };
        }
        foot.t = foot.t.clamp(0.0, 1.0);
        let (p, d, dd) = self.powers[foot.segment].at(foot.t);
        let off = p - at;
        // beyond an end the whole distance counts: the tangent there meets what it does not
        let past = (foot.t <= 0.0 && off.dot(d) > 0.0) || (foot.t >= 1.0 && off.dot(d) < 0.0);
        let distance = off.hypot();
        if past && distance > 1e-9 {
            return (distance, off / distance);
        }
        let along = if d.hypot2() > 1e-12 { d } else { dd };
        let normal = Vec2::new(-along.y, along.x) / along.hypot().max(1e-12);
        (off.dot(normal), normal)
    }

    /// Carries the blocks over to the free numbers and leaves the step in `self.step`.
    fn solve(&mut self, chain: &Chain, free: usize, lambda: f64) -> bool {
        self.first.clear();
        self.first.extend(0..free);
        for i in 0..chain.kinds.len() {
            let spread = self.spread(chain, i);
            let vars = || spread.iter().flat_map(|s| s.iter().flatten());
            let least = vars().map(|v| v.0).min().unwrap_or(0);
            for (v, _) in vars() {
                self.first[*v] = self.first[*v].min(least);
            }
        }
        self.matrix.reset(&self.first);
        self.step.clear();
        self.step.resize(free, 0.0);
        for (i, block) in self.blocks.iter().enumerate() {
            let spread = self.spread(chain, i);
            for (k, to) in spread.iter().enumerate() {
                for &(v, c) in to.iter().flatten() {
                    self.step[v] -= c * block.gradient[k];
                    for (l, other) in spread.iter().enumerate() {
                        for &(u, d) in other.iter().flatten() {
                            if u <= v {
                                self.matrix
                                    .add(v, u, c * d * block.hessian[k.max(l)][k.min(l)]);
                            }
                        }
                    }
                }
            }
        }
        for v in 0..free {
            // So that a number on which nothing depends stays where it is.
            self.matrix.add(v, v, 1e-9);
        }
        self.matrix.solve_damped(lambda, &mut self.step)
    }

    /// How each of a segment's eight numbers depends on the free ones.
    fn spread(&self, chain: &Chain, segment: usize) -> [[Option<(usize, f64)>; 4]; 8] {
        let (a, b) = chain.ends(segment);
        let (p, q) = (&self.slots[a], &self.slots[b]);
        let slots = [p.x, p.y, p.leave, p.ahead, q.back, q.arrive, q.x, q.y];
        slots.map(|slot| match slot {
            Slot::Fixed => [None; 4],
            Slot::Free(v) => [Some((v, 1.0)), None, None, None],
            Slot::Along(line) => {
                let (a, b) = chain.ends(line);
                let d = chain.nodes[b].point - chain.nodes[a].point;
                let d = d / d.hypot2().max(1e-12);
                let (s, e) = (&self.slots[a], &self.slots[b]);
                let of = |slot: Slot, c: f64| match slot {
                    Slot::Free(v) => Some((v, c)),
                    _ => None,
                };
                [of(s.x, d.y), of(s.y, -d.x), of(e.x, -d.y), of(e.y, d.x)]
            }
        })
    }

    fn drop_anchors(&mut self, chain: &Chain, scale: Scale) {
        self.anchors.clear();
        for (i, node) in chain.nodes.iter().enumerate() {
            let side = scale.freedom * shorter_side(chain, i);
            let reach = if node.join == Join::Loose {
                side.min(LOOSE * scale.sigma)
            } else {
                side
            };
            self.anchors
                .push((node.point, 1.0 / (reach * reach).max(1e-6)));
        }
    }

    /// The part of the step that moves no node by more than [`STRIDE`] of its shorter side.
    fn stride(&self, chain: &Chain) -> f64 {
        let nodes = chain.nodes.iter().zip(&self.slots).enumerate();
        nodes.fold(1.0, |part: f64, (i, (_, s))| {
            let moved = Vec2::new(self.stepped(s.x), self.stepped(s.y)).hypot();
            let most = STRIDE * shorter_side(chain, i);
            if moved * part > most {
                most / moved
            } else {
                part
            }
        })
    }

    fn stepped(&self, slot: Slot) -> f64 {
        match slot {
            Slot::Free(v) => self.step[v],
            _ => 0.0,
        }
    }

    fn apply(&self, chain: &mut Chain) {
        let part = self.stride(chain);
        let step = |slot: Slot| part * self.stepped(slot);
        let turn = |d: Vec2, by: f64| {
            let (s, c) = by.clamp(-0.5, 0.5).sin_cos();
            Vec2::new(c * d.x - s * d.y, s * d.x + c * d.y)
        };
        // A handle may shrink or grow only by a factor a step: it must not change sides.
        let grow = |handle: f64, by: f64| (handle + by).clamp(0.3 * handle, 3.0 * handle + 1e-9);
        for (node, s) in chain.nodes.iter_mut().zip(&self.slots) {
            node.point += Vec2::new(step(s.x), step(s.y));
            node.arrive = turn(node.arrive, step(s.arrive));
            node.leave = turn(node.leave, step(s.leave));
            node.back = grow(node.back, step(s.back));
            node.ahead = grow(node.ahead, step(s.ahead));
        }
        unhook(chain);
        chain.align();
    }
}

/// Turns directions at corners and ends back towards the chords.
fn unhook(chain: &mut Chain) {
    for i in 0..chain.kinds.len() {
        let (a, b) = chain.ends(i);
        let chord = chain.direction(i);
        let within = |d: Vec2| {
            let turn = chord.cross(d).atan2(chord.dot(d));
            if turn.abs() <= HOOK {
                return d;
            }
            let (s, c) = HOOK.copysign(turn).sin_cos();
            Vec2::new(c * chord.x - s * chord.y, s * chord.x + c * chord.y)
        };
        let free = |join: Join| join == Join::Corner || join.is_end();
        if free(chain.nodes[a].join) {
            chain.nodes[a].leave = within(chain.nodes[a].leave);
        }
        if free(chain.nodes[b].join) {
            chain.nodes[b].arrive = within(chain.nodes[b].arrive);
        }
    }
}

/// Length of the shorter chord beside a node.
fn shorter_side(chain: &Chain, i: usize) -> f64 {
    let length = |s: usize| {
        let (a, b) = chain.ends(s);
        chain.nodes[a].point.distance(chain.nodes[b].point)
    };
    let sides = [chain.before(i), chain.after(i)]
        .into_iter()
        .flatten()
        .map(length);
    sides.fold(f64::INFINITY, f64::min)
}

/// How the distance at a foot changes with the eight numbers of its segment.
fn row(chain: &Chain, foot: Foot, n: Vec2) -> [f64; 8] {
    let (a, b) = chain.ends(foot.segment);
    let (a, b) = (&chain.nodes[a], &chain.nodes[b]);
    let (t, s) = (foot.t, 1.0 - foot.t);
    if chain.kinds[foot.segment] == Kind::Line {
        return [n.x * s, n.y * s, 0.0, 0.0, 0.0, 0.0, n.x * t, n.y * t];
    }
    let (b1, b2) = (3.0 * s * s * t, 3.0 * s * t * t);
    let (start, end) = (s * s * s + b1, t * t * t + b2);
    // n · (direction turned by a right angle) = direction × … : d/dθ of a unit vector.
    let (turn0, turn1) = (a.leave.cross(n), b.arrive.cross(n));
    [
        n.x * start,
        n.y * start,
        b1 * a.ahead * turn0,
        b1 * a.leave.dot(n),
        -b2 * b.arrive.dot(n),
        -b2 * b.back * turn1,
        n.x * end,
        n.y * end,
    ]
}
