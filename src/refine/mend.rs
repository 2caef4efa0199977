//! Places that settled paths leave unexplained: their nodes against the pixels, other structures tried.
//!
//! What is left of the picture around an edge tells where a fit is wrong, and by how much. There the few nodes near by are
//! fit to the pixels themselves, as they stand and with a node or corner more or less; what leaves least for its nodes is kept.

use super::{
    comparison::polygon,
    residual::Residual,
    variants::variants,
    window::{Drawn, Window},
};
use crate::numeric::{
    chain::{Chain, Join},
    joins::{DEPTH_PX, divide_at_extrema, is_soft, keep_levels, sharpen, soften},
};
use kurbo::{BezPath, ParamCurve, ParamCurveNearest, Point, Rect, Shape, Vec2};
use std::f64::consts::PI;

/// Directions that differ by less are one, radians.
const SMOOTH: f64 = 0.0175;
/// Chords cut off next to nothing of a path, px.
const CHORD_PX: f64 = 0.001;
/// Way along an edge between places that are looked at, px, around each of which differences are summed up so far, px.
const STEP_PX: f64 = 1.5;
const NEAR_PX: f64 = 4.0;
/// Pixels that are summed up.
const NEAR: f64 = 81.0;
/// Sum of squares there from which a place is wrong, and from which in the picture's grain.
const WRONG: f64 = 0.018;
const WRONG_GRAIN: f64 = 90.0;
/// Places that are tried at most, the worst first: a picture of noise is wrong everywhere.
const MOST: usize = 1000;
/// Places nearer to one that was tried are that one, px.
const SAME_PX: f64 = 5.0;
/// How far the nodes around move, px, and what each px of the lens' deviation adds; and times this where that mends little.
const REACH_PX: f64 = 6.0;
const REACH_LENS: f64 = 2.0;
const WIDE: f64 = 2.0;
/// What a node must save, squares, and in the picture's grain.
const NODE: f64 = 0.1;
const NODE_GRAIN: f64 = 48.0;
/// The part of what is wrong, beyond grain, that a change of structure must mend, and a place for its nodes to move at all.
const WORTH: f64 = 0.4;
const GAIN: f64 = 0.3;
/// A structure that no outline may have gives way to one that leaves so many times as much.
const ASTRAY: f64 = 1.1;
/// Changes of structure in a place, one upon the other.
const CHANGES: usize = 3;
/// A handle's prior is as heavy as so many pixels' grain.
const PRIOR_GRAIN: f64 = 4.0;
/// A smooth node so near to an axis is an extremum, radians.
const AXIS: f64 = 0.15;
/// A corner does not come nearer than this to turning back, radians.
const BACK: f64 = 0.1;
/// A smooth node does not turn by more than this, radians, in such a part of both its curves.
const HIDDEN: f64 = 1.2;
const BESIDE: f64 = 0.3;
/// A curve leaves its chord by no more than this, radians; its handles do not pass the chord, and add up to no more than so
/// many of it.
const HOOK: f64 = 1.75;
const LONG: f64 = 2.0;
/// No segment is shorter, px.
const SHORT_PX: f64 = 0.25;
/// A node is at home within so many reaches of its place, or so near to one that was there, px.
const HOME: f64 = 1.5;
const HOME_PX: f64 = 2.0;

/// The paths, changed where a few nodes explain the picture better, and with nodes at all extrema in the end.
pub(super) fn mended(residual: &Residual<'_>, paths: &[BezPath]) -> Vec<BezPath> {
    let read = |p: &BezPath| Chain::from_path(p, SMOOTH);
    let mut chains: Vec<Option<Chain>> = paths.iter().map(read).collect();
    let mut rings: Vec<Ring> = paths.iter().map(Ring::new).collect();
    let mut residual = residual.against(rings.iter().map(|r| r.chords.as_slice()));
    let wrong = Wrong::new(&residual);
    let mut out = paths.to_vec();
    let mut tried: Vec<Point> = Vec::new();
    for (k, p) in wrong.places(&residual, &rings) {
        let left = residual.squares(p, NEAR_PX);
        if left <= wrong.least || tried.iter().any(|q| q.distance(p) < SAME_PX) {
            continue;
        }
        if tried.len() == MOST {
            break;
        }
        tried.push(p);
        let Some(chain) = &chains[k] else { continue };
        let place = Place {
            chain,
            at: p,
            others: (&rings, k),
        };
        let reach = REACH_PX + REACH_LENS * residual.lens_px();
        let mut reaches = [reach, WIDE * reach].into_iter();
        let found = reaches.find_map(|reach| place.mended(&residual, &wrong, reach));
        if let Some((chain, window, drawn)) = found {
            window.write(&drawn, &mut residual);
            out[k] = chain.to_path();
            rings[k] = Ring::new(&out[k]);
            chains[k] = Some(chain);
        }
    }
    for (chain, path) in chains.iter_mut().zip(&mut out) {
        let Some(chain) = chain else { continue };
        let before = chain.kinds.len();
        divide_at_extrema(chain, 0.0);
        if chain.kinds.len() > before {
            *path = chain.to_path();
        }
    }
    out
}

/// A closed path as chords that come back to its start.
struct Ring {
    chords: Vec<Point>,
    bounds: Rect,
}

impl Ring {
    fn new(path: &BezPath) -> Self {
        let mut chords = polygon(path, CHORD_PX);
        chords.extend(chords.first().copied());
        let bounds = path.bounding_box();
        Self { chords, bounds }
    }
}

/// What counts as wrong in a picture.
struct Wrong {
    grain: f64,
    /// squares within [`NEAR_PX`]
    least: f64,
}

impl Wrong {
    fn new(residual: &Residual<'_>) -> Self {
        let grain = residual.grain();
        Self {
            grain,
            least: WRONG.max(WRONG_GRAIN * grain),
        }
    }

    /// Places along rings with more than that, and their rings, the worst first.
    fn places(&self, residual: &Residual<'_>, rings: &[Ring]) -> Vec<(usize, Point)> {
        let mut places = Vec::new();
        for (k, ring) in rings.iter().enumerate() {
            let mut last = Point::new(f64::INFINITY, 0.0);
            for (a, b) in ring.chords.iter().zip(ring.chords.iter().skip(1)) {
                let mut gone = 0.0;
                while gone < a.distance(*b) {
                    let p = a.lerp(*b, gone / a.distance(*b));
                    gone += STEP_PX;
                    if last.distance(p) < STEP_PX {
                        continue;
                    }
                    last = p;
                    let left = residual.squares(p, NEAR_PX);
                    if left > self.least {
                        places.push((left, k, p));
                    }
                }
            }
        }
        places.sort_by(|a, b| b.0.total_cmp(&a.0));
        places.into_iter().map(|(_, k, p)| (k, p)).collect()
    }
}

/// Where a path is wrong.
struct Place<'a> {
    chain: &'a Chain,
    at: Point,
    /// all paths as chords, and the index of this one
    others: (&'a [Ring], usize),
}

impl Place<'_> {
    /// The chain with the nodes within `reach` px of the place where the pixels have them, if that explains enough more.
    fn mended(
        &self,
        residual: &Residual<'_>,
        wrong: &Wrong,
        reach: f64,
    ) -> Option<(Chain, Window, Drawn)> {
        let (start, count) = self.run(reach)?;
        let mut turned = self.chain.clone();
        turned.nodes.rotate_left(start);
        turned.kinds.rotate_left(start);
        let n = turned.kinds.len();
        let mut part = turned.part(0..count);
        for i in [0, count] {
            let join = &mut part.nodes[i].join;
            *join = if *join == Join::Corner {
                Join::End
            } else {
                Join::Clamped
            };
        }
        let rest = polygon(&turned.part(count..n).to_path(), CHORD_PX);
        let (rings, own) = self.others;
        let around = Window::bounds(residual, (self.at, reach));
        let others = rings.iter().enumerate();
        let others = others.filter(|(k, r)| *k != own && r.bounds.overlaps(around));
        let lines = others.map(|(_, r)| r.chords.as_slice()).chain([&*rest]);
        let prior = (PRIOR_GRAIN * wrong.grain).sqrt();
        let window = Window::new(residual, (self.at, reach), lines, &part, prior);
        let left = residual.squares(self.at, NEAR_PX) - NEAR * wrong.grain;
        let before = window.drawn(&part).squares;
        let (best, drawn) = self.best(&window, &part, wrong, reach)?;
        if before - drawn.squares < GAIN * left {
            return None;
        }
        let whole = put_back(turned, best, count)?;
        Some((whole, window, drawn))
    }

    /// The first segment of those that end in a node within `reach` px, in a row with the nearest one, and how many they are.
    fn run(&self, reach: f64) -> Option<(usize, usize)> {
        let chain = self.chain;
        let n = chain.kinds.len();
        let off = |i: usize| chain.nodes[i % n].point.distance(self.at);
        let nearest = (0..n).min_by(|a, b| off(*a).total_cmp(&off(*b)))?;
        if off(nearest) >= reach {
            let off = |i: &usize| chain.cubic(*i).nearest(self.at, 1e-3).distance_sq;
            let segment = (0..n).min_by(|a, b| off(a).total_cmp(&off(b)))?;
            return Some((segment, 1));
        }
        let near = |i: &usize| off(*i) < reach;
        let after = (nearest + 1..nearest + n).take_while(near).count();
        let before = (nearest + 1..nearest + n).rev().take_while(near).count();
        if before + after + 1 >= n {
            let far = (0..n).max_by(|a, b| off(*a).total_cmp(&off(*b)))?;
            return Some((far, n));
        }
        Some(((nearest + n - before - 1) % n, before + after + 2))
    }

    /// The structure of least squares and nodes.
    fn best(
        &self,
        window: &Window,
        part: &Chain,
        wrong: &Wrong,
        reach: f64,
    ) -> Option<(Chain, Drawn)> {
        let price = NODE + NODE_GRAIN * wrong.grain;
        let noise = wrong.grain * window.pixels();
        let cost = |c: &Chain, squares: f64| squares + price * c.nodes.len() as f64;
        let mut chain = part.clone();
        let mut drawn = fit(window, &mut chain, f64::INFINITY);
        let mut good = self.sound(&chain, part, reach);
        for _ in 0..CHANGES {
            let now = drawn.squares;
            let explained = |squares: f64| squares - noise < WRONG;
            if good && explained(now) {
                break;
            }
            let (mut least, most) = if good {
                (cost(&chain, now), now - WORTH * (now - noise).max(0.0))
            } else {
                (f64::INFINITY, ASTRAY * now)
            };
            let mut found: Option<(Chain, Drawn)> = None;
            for mut other in variants(&chain, self.at, reach) {
                let done = |(c, d): &(Chain, Drawn)| {
                    explained(d.squares) && c.nodes.len() < other.nodes.len()
                };
                if found.as_ref().is_some_and(done) {
                    // what more nodes could save is less than they must
                    break;
                }
                let drawn = fit(window, &mut other, most);
                let cost = cost(&other, drawn.squares);
                if cost < least && drawn.squares < most && self.sound(&other, part, reach) {
                    least = cost;
                    found = Some((other, drawn));
                }
            }
            let Some(better) = found else { break };
            (chain, drawn, good) = (better.0, better.1, true);
        }
        good.then_some((chain, drawn))
    }

    /// Whether an outline may look like that: no curve hooks back, no corner turns back, no node lies astray.
    fn sound(&self, chain: &Chain, was: &Chain, reach: f64) -> bool {
        let mut inner = 1..chain.kinds.len();
        let home = |i: usize| {
            let p = chain.nodes[i].point;
            let mut old = was.nodes.iter().map(|n| n.point.distance(p));
            p.distance(self.at) < HOME * reach || old.any(|off| off < HOME_PX)
        };
        let most = |i: usize| {
            if chain.nodes[i].join.is_smooth() {
                HIDDEN
            } else {
                PI - BACK
            }
        };
        inner.all(|i| home(i) && turn(chain, i) < most(i))
            && (0..chain.kinds.len()).all(|i| runs_on(chain, i))
    }
}

/// Fits a chain, its extrema upright and level, and its soft corners smooth.
fn fit(window: &Window, chain: &mut Chain, enough: f64) -> Drawn {
    let drawn = window.fit(chain, enough);
    let before = chain.clone();
    for i in 1..chain.kinds.len() {
        if is_soft(chain, i) {
            soften(&mut chain.nodes[i]);
        }
        sharpen(chain, i);
        let beside = chain.line_beside(i).is_some();
        let node = &mut chain.nodes[i];
        if beside && node.join != before.nodes[i].join {
            // an axis would move the line's other end
            node.join = Join::Smooth;
        } else if !beside && node.join == Join::Smooth {
            node.join = match node.leave {
                v if v.y.abs() < AXIS => Join::Horizontal,
                v if v.x.abs() < AXIS => Join::Vertical,
                _ => Join::Smooth,
            };
        }
    }
    divide_at_extrema(chain, DEPTH_PX);
    let drawn = if *chain == before {
        drawn
    } else {
        window.fit(chain, enough)
    };
    let before = chain.clone();
    keep_levels(chain);
    if *chain == before {
        drawn
    } else {
        window.drawn(chain)
    }
}

/// By how much a chain turns around a node, radians: handles may be too short to show.
fn turn(chain: &Chain, i: usize) -> f64 {
    let Some((before, after)) = chain.before(i).zip(chain.after(i)) else {
        return 0.0;
    };
    let (before, after) = (chain.cubic(before), chain.cubic(after));
    let p = chain.nodes[i].point;
    let (u, v) = (p - before.eval(1.0 - BESIDE), after.eval(BESIDE) - p);
    u.cross(v).atan2(u.dot(v)).abs()
}

/// Whether a segment goes from its start to its end without hooks.
fn runs_on(chain: &Chain, i: usize) -> bool {
    let c = chain.cubic(i);
    let chord = c.p3 - c.p0;
    let off = |v: Vec2| v.cross(chord).atan2(v.dot(chord)).abs();
    let (start, end) = (c.p1 - c.p0, c.p3 - c.p2);
    let within = |v: Vec2| off(v) < HOOK && v.dot(chord) <= chord.hypot2();
    chord.hypot() >= SHORT_PX
        && within(start)
        && within(end)
        && start.hypot() + end.hypot() < LONG * chord.hypot()
}

/// The chain with its first `count` segments as they are in `part`.
fn put_back(mut chain: Chain, part: Chain, count: usize) -> Option<Chain> {
    let n = chain.kinds.len();
    let (mut nodes, kinds) = (part.nodes, part.kinds);
    let last = nodes.pop()?;
    let own = chain.nodes[0];
    let first = nodes.first_mut()?;
    first.join = own.join;
    let end = if count < n {
        (first.arrive, first.back) = (own.arrive, own.back);
        let node = &mut chain.nodes[count];
        (node.arrive, node.back) = (last.arrive, last.back);
        kinds.len()
    } else {
        (first.arrive, first.back) = (last.arrive, last.back);
        0
    };
    chain.nodes.splice(0..count, nodes);
    chain.kinds.splice(0..count, kinds);
    chain.settle();
    let sound = [0, end].into_iter().all(|i| !is_soft(&chain, i));
    (sound && chain.to_path().is_finite()).then_some(chain)
}
