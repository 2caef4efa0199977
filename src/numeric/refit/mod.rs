//! Least squares of all nodes, directions and handles of a chain at once.
//!
//! Solves   min Σ wᵢ ρ(dᵢ / σᵢ) + ½ Σ ((handle / chord − ⅓) / spread)², dᵢ the distance of sample i to the chain,
//! ρ Huber's. Gauss–Newton with Levenberg's damping; the feet of the samples slide
//! along the chain between steps (variable projection), over nodes where they must.
//!
//! A row of the Jacobian touches eight numbers of one segment only: x, y, direction and handle of both ends.
//! Their products are summed for each segment, and its 8 × 8 block is carried over to the free numbers once.

mod moments;
mod prior;
#[cfg(test)]
mod tests;

use super::angles::angle;
use super::chain::{Chain, Join, Kind};
use super::powers::{LANES, Powers};
use super::skyline::Skyline;
use crate::numeric::angles;
use kurbo::{Point, Vec2};
use moments::{Moments, Term};
use std::{
    array::from_fn,
    collections::BTreeSet,
    ops::{Range, RangeInclusive},
};

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
/// And a held node.
const HELD: f64 = 1.0;
/// How far a foot goes in one step, and how far beyond its segment before it is asked for on the next, parameter.
const SLIDE: (f64, RangeInclusive<f64>) = (0.3, -0.2..=1.2);
/// How far in one step, in shorter sides.
const STRIDE: f64 = 0.35;

/// Normal equations of one segment, the lower half of them. Order of the eight: x, y, direction, handle of the start;
/// handle, direction, x, y of the end.
#[derive(Debug, Clone, Copy, Default)]
struct Block {
    hessian: [[f64; 8]; 8],
    gradient: [f64; 8],
}

/// A number of a node that an optimiser may or may not move.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Slot {
    Fixed,
    Free(usize),
    /// Direction of this line.
    Along(usize),
}

/// One of a segment's eight numbers grows with a free one, by so much.
#[derive(Debug, Clone, Copy)]
struct Use {
    row: usize,
    free: usize,
    by: f64,
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

/// Working memory of [`Refit::run`], used again from call to call.
#[derive(Debug, Clone, Default)]
pub struct Refit {
    /// Nodes over which no foot slides: corners, whose sides may run close together, and ends.
    sealed: Vec<bool>,
    slots: Vec<Slots>,
    spread: Vec<Use>,
    /// Those of each segment.
    uses: Vec<Range<usize>>,
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
    /// What each tells.
    terms: Vec<Term>,
    /// Where each node came from, and one over the square of how far it may go.
    anchors: Vec<(Point, f64)>,
    /// Nodes that are held.
    held: BTreeSet<usize>,
}

impl Refit {
    /// A refinement in which these nodes of the chain stay about where they are, whatever the samples leave open.
    #[must_use]
    pub fn holding(held: &BTreeSet<usize>) -> Self {
        Self {
            held: held.clone(),
            ..Self::default()
        }
    }

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
        let mut summed = false;
        for _ in 0..stop.rounds {
            if free == 0 {
                break;
            }
            // the last place that is reached needs no equations
            if !summed {
                self.sum(chain, feet);
                summed = true;
            }
            if !self.solve(chain, free, lambda) {
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
                (cost, summed) = (new, false);
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

    /// Slides the feet, and returns the cost.
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
        let (fours, rest) = samples.as_chunks::<LANES>();
        let (four_feet, rest_feet) = feet.as_chunks_mut::<LANES>();
        for (samples, feet) in fours.iter().zip(four_feet) {
            off.extend(self.slide_together(samples, feet));
        }
        let pairs = rest.iter().zip(rest_feet);
        off.extend(pairs.map(|(sample, foot)| self.slide(sample.at, foot)));
        self.terms.clear();
        let run = feet.iter().zip(samples).zip(&off);
        let terms = run.map(|((foot, sample), &(distance, normal))| {
            let precision = sample.sigma.recip();
            let u = distance.abs() * precision;
            let (rho, pull) = if u < scale.robust {
                (0.5 * u * u, 1.0)
            } else {
                (scale.robust * (u - 0.5 * scale.robust), scale.robust / u)
            };
            cost += sample.weight * rho;
            Term {
                t: foot.t,
                normal,
                distance,
                weight: sample.weight * pull * precision * precision,
            }
        });
        self.terms.extend(terms);
        self.off = off;
        cost
    }

    /// Sums the rows of each segment.
    fn sum(&mut self, chain: &Chain, feet: &[Foot]) {
        let mut rest = self.terms.as_slice();
        for feet in feet.chunk_by(|a, b| a.segment == b.segment) {
            let segment = feet[0].segment;
            let mut moments = Moments::new(chain.kinds[segment]);
            let (terms, after) = rest.split_at(feet.len());
            rest = after;
            let (fours, last) = terms.as_chunks::<LANES>();
            fours.iter().for_each(|terms| moments.add(terms));
            if !last.is_empty() {
                let mut together = [Term::default(); LANES];
                together[..last.len()].copy_from_slice(last);
                moments.add(&together);
            }
            moments.write(chain, segment, &mut self.blocks[segment]);
        }
    }

    /// [`Self::slide`] for several samples; for those that stay on one segment, as nearly all do, side by side.
    fn slide_together(
        &self,
        samples: &[Sample; LANES],
        feet: &mut [Foot; LANES],
    ) -> [(f64, Vec2); LANES] {
        let segment = feet[0].segment;
        if feet.iter().any(|f| f.segment != segment) || segment >= self.powers.len() {
            return from_fn(|k| self.slide(samples[k].at, &mut feet[k]));
        }
        let powers = &self.powers[segment];
        let at = samples.each_ref().map(|s| s.at);
        let t = powers.feet(at, feet.each_ref().map(|f| f.t), SLIDE);
        let inside = |t: f64| t > 0.0 && t < 1.0;
        if !t.iter().copied().all(inside) {
            return from_fn(|k| self.slide(samples[k].at, &mut feet[k]));
        }
        feet.iter_mut().zip(t).for_each(|(f, t)| f.t = t);
        from_fn(|k| {
            let (p, d, dd) = powers.at(t[k]);
            across(p - at[k], d, dd)
        })
    }

    /// Moves a foot to the nearest place near by; returns how far it is from the sample along a unit vector, and that
    /// vector: the normal there, or beyond an end the way from the sample.
    fn slide(&self, at: Point, foot: &mut Foot) -> (f64, Vec2) {
        let n = self.powers.len();
        foot.segment = foot.segment.min(n - 1);
        let mut came = 0i8;
        for _ in 0..4 {
            let powers = &self.powers[foot.segment];
            [foot.t] = powers.feet([at], [foot.t], SLIDE);
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
        across(off, d, dd)
    }

    /// Carries the blocks over to the free numbers and leaves the step in `self.step`.
    fn solve(&mut self, chain: &Chain, free: usize, lambda: f64) -> bool {
        self.spread(chain);
        self.first.clear();
        self.first.extend(0..free);
        for uses in self.uses.iter().map(|r| &self.spread[r.clone()]) {
            let least = uses.iter().map(|u| u.free).min().unwrap_or(0);
            for u in uses {
                self.first[u.free] = self.first[u.free].min(least);
            }
        }
        self.matrix.reset(&self.first);
        self.step.clear();
        self.step.resize(free, 0.0);
        for (block, uses) in self.blocks.iter().zip(&self.uses) {
            let uses = &self.spread[uses.clone()];
            for a in uses {
                self.step[a.free] -= a.by * block.gradient[a.row];
                for b in uses.iter().filter(|b| b.free <= a.free) {
                    let (row, column) = (a.row.max(b.row), a.row.min(b.row));
                    let value = a.by * b.by * block.hessian[row][column];
                    self.matrix.add(a.free, b.free, value);
                }
            }
        }
        for v in 0..free {
            // So that a number on which nothing depends stays where it is.
            self.matrix.add(v, v, 1e-9);
        }
        self.matrix.solve_damped(lambda, &mut self.step)
    }

    /// How the eight numbers of each segment depend on the free ones.
    fn spread(&mut self, chain: &Chain) {
        self.spread.clear();
        self.uses.clear();
        for segment in 0..chain.kinds.len() {
            let start = self.spread.len();
            let (a, b) = chain.ends(segment);
            let (p, q) = (self.slots[a], self.slots[b]);
            let slots = [p.x, p.y, p.leave, p.ahead, q.back, q.arrive, q.x, q.y];
            for (row, slot) in slots.into_iter().enumerate() {
                let mut follow = |slot: Slot, by: f64| {
                    if let Slot::Free(free) = slot {
                        self.spread.push(Use { row, free, by });
                    }
                };
                match slot {
                    Slot::Along(line) => {
                        let (a, b) = chain.ends(line);
                        let d = chain.nodes[b].point - chain.nodes[a].point;
                        let d = d / d.hypot2().max(1e-12);
                        let (s, e) = (self.slots[a], self.slots[b]);
                        follow(s.x, d.y);
                        follow(s.y, -d.x);
                        follow(e.x, -d.y);
                        follow(e.y, d.x);
                    }
                    own => follow(own, 1.0),
                }
            }
            self.uses.push(start..self.spread.len());
        }
    }

    fn drop_anchors(&mut self, chain: &Chain, scale: Scale) {
        self.anchors.clear();
        for (i, node) in chain.nodes.iter().enumerate() {
            let side = scale.freedom * shorter_side(chain, i);
            let reach = match node.join {
                _ if self.held.contains(&i) => side.min(HELD * scale.sigma),
                Join::Loose => side.min(LOOSE * scale.sigma),
                _ => side,
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
        let turn = |d: Vec2, by: f64| d.rotate_scale(angles::direction(by.clamp(-0.5, 0.5)));
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

/// How far a curve is off along its normal, and the normal.
fn across(off: Vec2, d: Vec2, dd: Vec2) -> (f64, Vec2) {
    let along = if d.hypot2() > 1e-12 { d } else { dd };
    let normal = along.turn_90() / along.hypot().max(1e-12);
    (off.dot(normal), normal)
}

/// Turns directions at corners and ends back towards the chords.
fn unhook(chain: &mut Chain) {
    for i in 0..chain.kinds.len() {
        let (a, b) = chain.ends(i);
        let chord = chain.direction(i);
        let within = |d: Vec2| {
            let turn = angle(chord, d);
            if turn.abs() <= HOOK {
                return d;
            }
            chord.rotate_scale(angles::direction(HOOK.copysign(turn)))
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
