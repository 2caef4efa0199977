//! Smaller structures: leave a node out, make a direction upright, straighten a curve, put a node at an extremum;
//! refit what lies around; keep it where the description gets shorter.

use super::cost;
use crate::numeric::chain::{Chain, Join, Kind};
use crate::numeric::curves::control_length;
use crate::numeric::joins::{divide, inner_extrema};
use crate::numeric::refit::{Foot, Refit, Sample, Scale, Stop};
use kurbo::Vec2;

/// Nodes on each side of a change that are refitted with it.
const AROUND: usize = 2;
/// Steps of the refinement after a change.
const ROUNDS: usize = 8;
/// A gain that ends it, nats.
const GAIN: f64 = 0.02;
/// Times that all changes are tried.
const SWEEPS: usize = 4;
/// Samples on each side of a new node.
const TOLD: usize = 2;
/// Directions so near to an axis may be meant to lie on it, radians.
const SNAP: f64 = 0.08;
/// A line's ends turn less than this from its direction, radians.
const STRAIGHT: f64 = 0.08;

/// A chain with the samples it follows.
#[derive(Debug)]
pub(super) struct Work<'a> {
    pub(super) chain: Chain,
    pub(super) feet: Vec<Foot>,
    pub(super) samples: &'a [Sample],
    pub(super) scale: Scale,
    pub(super) refit: Refit,
    /// While changes are tried, in place of `feet`: the samples of each segment, with their feet there.
    pub(super) held: Vec<Held>,
    /// Nodes around which nothing was tried since the last change there.
    pub(super) stale: Vec<bool>,
}

/// Indices of samples and parameters of their feet, on one segment.
pub(super) type Held = Vec<(usize, f64)>;

/// A change of structure. Indices of nodes and segments are those of the window.
#[derive(Debug, Clone, Copy)]
enum Change {
    /// Without this node; the kind of what takes its place.
    Drop(usize, Kind),
    /// This node's direction along an axis.
    Snap(usize, Join),
    /// This segment a line.
    Straighten(usize),
    /// A node on this segment, at its extremum in the direction of the axis.
    Split(usize, f64, Join),
}

/// A part of a chain with its samples; `ring` when it is all of one.
#[derive(Debug, Default)]
struct Window {
    chain: Chain,
    /// Index of its first node in the whole chain.
    start: usize,
    samples: Vec<Sample>,
    feet: Vec<Foot>,
    /// Indices of its samples in the whole.
    of: Vec<usize>,
}

impl Work<'_> {
    /// Refines everything at once.
    pub(super) fn settle(&mut self, rounds: usize, gain: f64) {
        let data = (self.samples, &mut self.feet);
        let stop = Stop {
            rounds,
            gain,
            enough: f64::INFINITY,
        };
        self.refit.run(&mut self.chain, data, self.scale, stop);
    }

    /// Tries all changes until none helps.
    pub(super) fn improve(&mut self) {
        self.stale = vec![true; self.chain.nodes.len()];
        self.held = held(self.chain.kinds.len(), (0..).zip(self.feet.iter().copied()));
        for _ in 0..SWEEPS {
            let mut i = 0;
            while i < self.chain.nodes.len() {
                if std::mem::take(&mut self.stale[i]) {
                    self.improve_at(i);
                }
                i += 1;
            }
            if !self.stale.contains(&true) {
                break;
            }
        }
        for (segment, held) in std::mem::take(&mut self.held).into_iter().enumerate() {
            for (k, t) in held {
                self.feet[k] = Foot { segment, t };
            }
        }
    }

    /// Tries the changes of node `i` and of the segment after it.
    fn improve_at(&mut self, i: usize) {
        let before = self.window(i);
        let n = self.chain.nodes.len();
        let at = (i + n - before.start) % n;
        let changes = changes(&before, at);
        if changes.is_empty() {
            return;
        }
        let mut old = self.copy(&before);
        let mut least = self.cost(&mut old, 0, f64::INFINITY) - 0.01;
        let mut best = None;
        for change in changes {
            let mut trial = self.copy(&before);
            apply(&mut trial, change);
            let cost = self.cost(&mut trial, ROUNDS, least);
            if cost < least {
                least = cost;
                best = Some(trial);
            }
        }
        if let Some(window) = best {
            self.put_back(&before, window);
        }
    }

    fn copy(&self, w: &Window) -> Window {
        Window {
            chain: w.chain.clone(),
            start: w.start,
            samples: w.samples.clone(),
            feet: w.feet.clone(),
            of: w.of.clone(),
        }
    }

    /// Description length of a window after `rounds` steps of refinement, or more than `enough`.
    fn cost(&mut self, w: &mut Window, rounds: usize, enough: f64) -> f64 {
        let outside = |s: Option<usize>| s.and_then(|s| self.chain.kinds.get(s).copied());
        let whole = w.chain.is_ring();
        let before = if whole {
            None
        } else {
            outside(self.chain.before(w.start))
        };
        let old = self.window_len(w.start);
        let after = if whole {
            None
        } else {
            outside(
                self.chain
                    .after((w.start + old - 1) % self.chain.nodes.len()),
            )
        };
        let structure = cost::structure(&w.chain, before, after);
        let data = (&w.samples[..], &mut w.feet);
        // An extremum may yet move out of its segment.
        let slack = cost::OVER_EXTREMUM * (w.chain.kinds.len().min(2) as f64);
        let stop = Stop {
            rounds,
            gain: GAIN,
            enough: enough - structure + slack,
        };
        let fit = self.refit.run(&mut w.chain, data, self.scale, stop);
        fit + cost::structure(&w.chain, before, after)
    }

    /// Number of nodes of the window that begins at node `start`, while the whole chain is unchanged.
    fn window_len(&self, start: usize) -> usize {
        let n = self.chain.nodes.len();
        if self.chain.is_ring() {
            (2 * AROUND + 2).min(n)
        } else {
            (2 * AROUND + 2).min(n - start)
        }
    }

    /// What lies around node `i` and the segment after it.
    fn window(&self, i: usize) -> Window {
        let n = self.chain.nodes.len();
        let size = 2 * AROUND + 2;
        if self.chain.is_ring() && n <= size {
            let mut w = Window {
                chain: self.chain.clone(),
                ..Window::default()
            };
            (0..n).for_each(|segment| self.show(&mut w, segment, segment));
            return w;
        }
        let start = if self.chain.is_ring() {
            (i + n - AROUND) % n
        } else {
            i.saturating_sub(AROUND)
        };
        let count = self.window_len(start);
        let mut w = Window {
            start,
            ..Window::default()
        };
        for k in 0..count {
            let mut node = self.chain.nodes[(start + k) % n];
            if (k == 0 || k + 1 == count) && !node.join.is_end() {
                node.join = Join::Clamped;
            }
            w.chain.nodes.push(node);
            if k + 1 < count {
                w.chain.kinds.push(self.chain.kinds[(start + k) % n]);
                self.show(&mut w, (start + k) % n, k);
            }
        }
        w
    }

    /// Puts the samples of a segment into a window, where its number is `there`.
    fn show(&self, w: &mut Window, segment: usize, there: usize) {
        for &(k, t) in &self.held[segment] {
            w.samples.push(self.samples[k]);
            w.feet.push(Foot { segment: there, t });
            w.of.push(k);
        }
    }

    /// Puts a changed window in the place of what it was made from.
    fn put_back(&mut self, from: &Window, w: Window) {
        let now = held(w.chain.kinds.len(), w.of.into_iter().zip(w.feet));
        if w.chain.is_ring() {
            self.chain = w.chain;
            self.held = now;
            self.stale = vec![true; self.chain.nodes.len()];
            return;
        }
        let n = self.chain.nodes.len();
        let old = from.chain.nodes.len();
        let ends = [from.start, (from.start + old - 1) % n].map(|k| self.chain.nodes[k].join);
        // Turned so that the window comes first; only a ring can wrap around.
        let wraps = from.start + old > n;
        let shift = if wraps { from.start } else { 0 };
        self.chain.nodes.rotate_left(shift);
        self.stale.rotate_left(shift);
        if wraps {
            self.chain.kinds.rotate_left(shift);
            self.held.rotate_left(shift);
        }
        let start = from.start - shift;
        let mut nodes = w.chain.nodes;
        let new = nodes.len();
        for (node, join) in [0, new - 1].into_iter().zip(ends) {
            nodes[node].join = join;
        }
        // The handle on the outer side of each end was not the window's to change.
        nodes[0].back = self.chain.nodes[start].back;
        nodes[0].arrive = self.chain.nodes[start].arrive;
        let last = &self.chain.nodes[(start + old - 1) % n];
        nodes[new - 1].ahead = last.ahead;
        nodes[new - 1].leave = last.leave;
        self.stale
            .splice(start..start + old, std::iter::repeat_n(true, new));
        self.chain.nodes.splice(start..start + old, nodes);
        self.chain
            .kinds
            .splice(start..start + old - 1, w.chain.kinds);
        self.held.splice(start..start + old - 1, now);
        self.chain.settle();
    }
}

/// Samples and their feet by the segments these lie on.
fn held(segments: usize, feet: impl Iterator<Item = (usize, Foot)>) -> Vec<Held> {
    let mut held = vec![Held::new(); segments];
    for (k, foot) in feet {
        held[foot.segment].push((k, foot.t));
    }
    held
}

impl Window {
    /// Whether samples were measured on both sides of a place on a segment.
    fn told(&self, segment: usize, t: f64) -> bool {
        let feet = self.samples.iter().zip(&self.feet);
        let here =
            feet.filter(|(s, f)| f.segment == segment && s.weight * cost::CORRELATION >= 1.0);
        let (mut before, mut after) = (0, 0);
        here.for_each(|(_, f)| *(if f.t < t { &mut before } else { &mut after }) += 1);
        before >= TOLD && after >= TOLD
    }
}

/// What may be changed at node `at` of a window and at the segment after it.
fn changes(w: &Window, at: usize) -> Vec<Change> {
    let mut out = Vec::new();
    let chain = &w.chain;
    let node = &chain.nodes[at];
    let least = if chain.is_ring() { 3 } else { 2 };
    let kept = node.join.is_fixed() || node.join.is_end() || node.join == Join::Corner;
    if !kept && chain.nodes.len() > least {
        let kinds = [chain.kind(chain.before(at)), chain.kind(chain.after(at))];
        out.push(Change::Drop(at, Kind::Cubic));
        if kinds.contains(&Some(Kind::Line)) {
            out.push(Change::Drop(at, Kind::Line));
        }
    }
    if node.join == Join::Smooth {
        if node.leave.y.abs() < SNAP {
            out.push(Change::Snap(at, Join::Horizontal));
        } else if node.leave.x.abs() < SNAP {
            out.push(Change::Snap(at, Join::Vertical));
        }
    }
    if at < chain.kinds.len() && chain.kinds[at] == Kind::Cubic {
        let (a, b) = chain.ends(at);
        let d = chain.direction(at);
        let turns = |join: Join| join.is_end() || join == Join::Corner;
        let bars = |v: Vec2, join: Join, beside: Option<usize>| {
            !turns(join) && (d.cross(v).abs() > STRAIGHT || chain.kind(beside) == Some(Kind::Line))
        };
        let (p, q) = (&chain.nodes[a], &chain.nodes[b]);
        if !bars(p.leave, p.join, chain.before(a)) && !bars(q.arrive, q.join, chain.after(b)) {
            out.push(Change::Straighten(at));
        }
        for (t, join) in inner_extrema(&chain.cubic(at)) {
            if w.told(at, t) {
                out.push(Change::Split(at, t, join));
            }
        }
    }
    out
}

fn apply(w: &mut Window, change: Change) {
    match change {
        Change::Drop(at, kind) => drop_node(w, at, kind),
        Change::Snap(at, join) => w.chain.nodes[at].join = join,
        Change::Straighten(at) => w.chain.kinds[at] = Kind::Line,
        Change::Split(at, t, join) => split(w, at, t, join),
    }
}

fn drop_node(w: &mut Window, at: usize, kind: Kind) {
    let Some(before) = w.chain.before(at) else {
        return;
    };
    let Some(after) = w.chain.after(at) else {
        return;
    };
    let lengths = [before, after].map(|s| control_length(&w.chain.cubic(s)));
    let share = lengths[0] / (lengths[0] + lengths[1]).max(1e-12);
    let (p, q) = (w.chain.ends(before).0, w.chain.ends(after).1);
    let third = (lengths[0] + lengths[1]) / 3.0;
    w.chain.nodes[p].ahead = third;
    w.chain.nodes[q].back = third;
    for foot in &mut w.feet {
        if foot.segment == before {
            foot.t *= share;
        } else if foot.segment == after {
            *foot = Foot {
                segment: before,
                t: share + (1.0 - share) * foot.t,
            };
        }
    }
    w.chain.kinds[before] = kind;
    w.chain.nodes.remove(at);
    w.chain.kinds.remove(after);
    for foot in &mut w.feet {
        if foot.segment > after || (foot.segment == before && before > after) {
            foot.segment -= 1;
        }
    }
}

fn split(w: &mut Window, at: usize, t: f64, join: Join) {
    divide(&mut w.chain, at, t, join);
    for foot in &mut w.feet {
        if foot.segment > at || (foot.segment == at && foot.t >= t) {
            let whole = foot.segment > at;
            *foot = Foot {
                segment: foot.segment + 1,
                t: if whole {
                    foot.t
                } else {
                    (foot.t - t) / (1.0 - t)
                },
            };
        } else if foot.segment == at {
            foot.t /= t;
        }
    }
}
