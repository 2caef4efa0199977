//! Places that settled paths leave unexplained: their nodes against the pixels, other structures tried.
//!
//! What is left of the picture around an edge tells where a fit is wrong, and by how much. There the few nodes near by are
//! fit to the pixels themselves, as they stand and with a node or corner more or less; what leaves least for its nodes is kept.
//! Between such looks the levels of ink and paper are read again: what a path did not follow had passed for a part of them.

use super::{
    comparison::polygon,
    part::{begun_at, changed, open_part, put_back},
    residual::Residual,
    tips::{ONE_PX, beyond, is_needle, tip, trim},
    variants::variants,
    window::{Drawn, Window},
};
use crate::numeric::{
    chain::{Chain, Join, Kind},
    joins::{DEPTH_PX, divide_at_extrema, is_soft, keep_levels, sharpen, soften},
};
use kurbo::{BezPath, ParamCurve, ParamCurveNearest, Point, Rect, Shape, Vec2};
use std::mem;

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
/// A node that went further than this, px, is followed by a window of its own, so many of them at most.
const MOVED_PX: f64 = 2.0;
const LOOKS: usize = 4;
/// Places are looked at so often, each time with the levels of ink and paper that the paths leave then.
const PASSES: usize = 4;
/// One that was tried in vain is looked at again beside a change, or where the squares have changed by such a part.
const NEW: f64 = 0.01;
/// How precisely the nearest place on a curve is found, px.
const NEAREST_PX: f64 = 1e-3;
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
/// What a node must save beside a tip, of whose length few pixels tell, and those parts there.
const TIP: (f64, f64) = (0.03, 0.2);
const TIP_GAIN: f64 = 0.1;
/// Which is never more than what so many pixels' grain would make of it.
const TIP_GAIN_GRAIN: f64 = 6.0;
/// A structure that no outline may have gives way to one that leaves so many times as much.
const ASTRAY: f64 = 1.1;
/// Changes of structure in a place, one upon the other.
const CHANGES: usize = 3;
/// A smooth node so near to an axis is an extremum, radians.
const AXIS: f64 = 0.15;
/// A smooth node does not turn by more than this, radians, in such a part of both its curves.
const HIDDEN: f64 = 1.2;
const BESIDE: f64 = 0.3;
/// A curve leaves its chord by no more than this, radians; each of its handles reaches no further along it than so many of
/// the chord, and both together are no longer than so many.
const HOOK: f64 = 1.75;
const PAST: f64 = 1.1;
const LONG: f64 = 2.0;
/// A chain into which a part is put back stays if no control point moves further for it, px; with so many segments more at
/// each side fit again, none moves further than this.
const STAYS_PX: f64 = 0.02;
const ALONG: usize = 2;
const MOVES_PX: f64 = 0.1;
/// No segment is shorter, px.
const SHORT_PX: f64 = 0.25;
/// A node is at home within so many reaches of its place, a tip within as many, or so near to the path that was there, px.
const HOME: f64 = 1.5;
const FAR: f64 = 3.0;
const HOME_PX: f64 = 2.0;

/// The paths, changed where a few nodes explain the picture better, and with nodes at all extrema in the end.
pub(super) fn mended(residual: &Residual<'_>, paths: &[BezPath]) -> Vec<BezPath> {
    let read = |p: &BezPath| Chain::from_path(p, SMOOTH);
    let mut chains: Vec<Option<Chain>> = paths.iter().map(read).collect();
    let ring = |(chain, path): (&mut Option<Chain>, &BezPath)| {
        let trimmed = chain
            .as_mut()
            .and_then(|c| trim(c, ONE_PX).then(|| c.to_path()));
        Ring::new(trimmed.unwrap_or_else(|| path.clone()))
    };
    let rings: Vec<Ring> = chains.iter_mut().zip(paths).map(ring).collect();
    let residual = residual.against(rings.iter().map(|r| r.chords.as_slice()));
    let mut work = Work {
        wrong: Wrong::new(&residual),
        reach: REACH_PX + REACH_LENS * residual.lens_px(),
        residual,
        chains,
        rings,
        vain: Vec::new(),
    };
    let mut more = work.pass() || !work.vain.is_empty();
    for _ in 1..PASSES {
        if !more {
            break;
        }
        // what a path does not follow yet has passed for a level
        let chains = work.chains.iter().flatten();
        work.residual.level(chains.flat_map(beyond));
        more = work.pass();
    }
    let finished = |(chain, ring): (Option<Chain>, Ring)| {
        let Some(mut chain) = chain else {
            return ring.path;
        };
        // sides that run close together do so for the pixels' sake now
        let trimmed = trim(&mut chain, 0.0);
        let before = chain.kinds.len();
        divide_at_extrema(&mut chain, 0.0);
        if trimmed || chain.kinds.len() > before {
            chain.to_path()
        } else {
            ring.path
        }
    };
    work.chains
        .into_iter()
        .zip(work.rings)
        .map(finished)
        .collect()
}

/// Paths on their way.
struct Work<'a> {
    residual: Residual<'a>,
    wrong: Wrong,
    reach: f64,
    /// those of which no chain could be read stay
    chains: Vec<Option<Chain>>,
    rings: Vec<Ring>,
    /// places that were tried in vain, and the squares around them then
    vain: Vec<(Point, f64)>,
}

impl Work<'_> {
    /// Tries the places that are wrong, but not again where nothing is new; whether any was changed.
    fn pass(&mut self) -> bool {
        let near = |points: &[Point], p: Point, px: f64| points.iter().any(|q| q.distance(p) < px);
        let (mut tried, mut changed) = (Vec::new(), Vec::new());
        for (k, p) in self.wrong.places(&self.residual, &self.rings) {
            if self.left(p) <= self.wrong.least || near(&tried, p, SAME_PX) || self.is_known(p) {
                continue;
            }
            if tried.len() >= MOST {
                break;
            }
            let mut next = Some(p);
            for _ in 0..LOOKS {
                let Some(at) = next.take() else { break };
                tried.push(at);
                self.vain.retain(|(q, _)| q.distance(at) >= SAME_PX);
                let left = self.left(at);
                match self.change(k, at) {
                    Some(moved) => {
                        changed.push(at);
                        next = self.astray(&moved, at);
                    }
                    None => self.vain.push((at, left)),
                }
            }
            tried.extend(next);
        }
        let beside = WIDE * self.reach;
        self.vain.retain(|(p, _)| !near(&changed, *p, beside));
        !changed.is_empty()
    }

    /// Whether a place was tried in vain as it is.
    fn is_known(&self, p: Point) -> bool {
        let same = |(q, left): &(Point, f64)| {
            q.distance(p) < SAME_PX && (self.left(*q) - left).abs() < NEW * left
        };
        self.vain.iter().any(same)
    }

    /// Changes ring `k` around a place if that explains enough more; then the nodes around it.
    fn change(&mut self, k: usize, at: Point) -> Option<Vec<Point>> {
        let others = (self.rings.as_slice(), k);
        let chain = self.chains[k].as_ref()?;
        let place = Place { chain, at, others };
        let mut reaches = [self.reach, WIDE * self.reach].into_iter();
        let found = reaches.find_map(|reach| place.mended(&self.residual, &self.wrong, reach))?;
        let bounds = changed(chain, &found.chain)?;
        let old = mem::replace(&mut self.rings[k], Ring::new(found.chain.to_path()));
        if self.redraw(bounds) >= 0.0 {
            // what held it beyond its window was wrong
            self.rings[k] = old;
            self.redraw(bounds);
            return None;
        }
        self.chains[k] = Some(found.chain);
        Some(found.moved)
    }

    /// The worst of the nodes that went far from a place and left something wrong.
    fn astray(&self, moved: &[Point], at: Point) -> Option<Point> {
        let wrong = |p: &&Point| self.left(**p) > self.wrong.least && p.distance(at) > MOVED_PX;
        let wrong = moved.iter().filter(wrong);
        let worst = wrong.max_by(|a, b| self.left(**a).total_cmp(&self.left(**b)));
        worst.copied()
    }

    /// By how much the squares grow now that a ring has changed there.
    fn redraw(&mut self, bounds: Rect) -> f64 {
        let rings = self.rings.iter().map(|r| (r.bounds, r.chords.as_slice()));
        self.residual.redraw(bounds, rings)
    }

    /// Squares around a place.
    fn left(&self, p: Point) -> f64 {
        self.residual.squares(p, NEAR_PX)
    }
}

/// A closed path as chords that come back to its start.
struct Ring {
    path: BezPath,
    chords: Vec<Point>,
    bounds: Rect,
}

impl Ring {
    fn new(path: BezPath) -> Self {
        let mut chords = polygon(&path, CHORD_PX);
        chords.extend(chords.first().copied());
        let bounds = path.bounding_box();
        Self {
            path,
            chords,
            bounds,
        }
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

/// A chain that explains more.
struct Mended {
    chain: Chain,
    /// nodes around the place
    moved: Vec<Point>,
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
    fn mended(&self, residual: &Residual<'_>, wrong: &Wrong, reach: f64) -> Option<Mended> {
        let (start, count) = self.run(reach)?;
        let ring = begun_at(self.chain, start);
        let part = open_part(&ring, count);
        let around = |reach: f64, chain: &Chain, part: &Chain| {
            self.window(residual, (chain, part), wrong, reach)
        };
        let left = residual.squares(self.at, NEAR_PX) - NEAR * wrong.grain;
        let near = around(reach, &ring, &part);
        let before = near.drawn(&part).squares;
        let (best, drawn) = self.best(&near, &part, wrong, reach)?;
        let enough = if tipped(&best) {
            (TIP_GAIN * left).min(TIP_GAIN_GRAIN * wrong.grain)
        } else {
            GAIN * left
        };
        if before - drawn.squares < enough {
            return None;
        }
        // what went out of the window tells nothing in it
        let window = around(FAR * reach, &ring, &part);
        let drawn = window.drawn(&best);
        let most = window.drawn(&part).squares - enough;
        if drawn.squares > most {
            return None;
        }
        let inner = &best.nodes[1..best.kinds.len()];
        let moved = inner.iter().map(|n| n.point).collect();
        let now = best.kinds.len();
        let (chain, strayed) = put_back(ring.clone(), best, count)?;
        if strayed < STAYS_PX {
            return Some(Mended { chain, moved });
        }
        // a line took what is beside it along, which is fit with it
        let beside = ALONG.min((ring.kinds.len() - count) / 2);
        let back = |chain: &Chain| begun_at(chain, chain.kinds.len() - beside);
        let (was, chain) = (back(&ring), back(&chain));
        let part = open_part(&was, count + 2 * beside);
        let mut best = open_part(&chain, now + 2 * beside);
        let window = around(FAR * reach, &was, &part);
        let most = window.drawn(&part).squares - enough;
        let drawn = window.fit(&mut best, most);
        if drawn.squares > most || !fair(&best) {
            return None;
        }
        let (chain, strayed) = put_back(chain, best, now + 2 * beside)?;
        (strayed < MOVES_PX).then_some(Mended { chain, moved })
    }

    /// The window in which a `part` moves, the first segments of a chain that is turned to begin with it.
    fn window(
        &self,
        residual: &Residual<'_>,
        (chain, part): (&Chain, &Chain),
        wrong: &Wrong,
        reach: f64,
    ) -> Window {
        let rest = chain.part(part.kinds.len()..chain.kinds.len());
        let rest = polygon(&rest.to_path(), CHORD_PX);
        let (rings, own) = self.others;
        let around = Window::bounds(residual, (self.at, reach));
        let others = rings.iter().enumerate();
        let others = others.filter(|(k, r)| *k != own && r.bounds.overlaps(around));
        let lines = others.map(|(_, r)| r.chords.as_slice()).chain([&*rest]);
        Window::new(residual, (self.at, reach), lines, part, wrong.grain)
    }

    /// The first segment of those that may move, and how many they are: those that end in a node within `reach` px, and
    /// what a line of them takes along.
    fn run(&self, reach: f64) -> Option<(usize, usize)> {
        let (first, count) = self.near(reach)?;
        let chain = self.chain;
        let n = chain.kinds.len();
        let taken = |line: usize, end: usize| {
            let along =
                chain.kinds[line % n] == Kind::Line && chain.nodes[end % n].join.is_smooth();
            usize::from(along && count + 2 <= n)
        };
        let before = taken(first, first);
        let after = taken(first + count - 1, first + count);
        Some(((first + n - before) % n, before + count + after))
    }

    /// The first segment of those that end in a node within `reach` px, in a row with the nearest one, and how many they are.
    fn near(&self, reach: f64) -> Option<(usize, usize)> {
        let chain = self.chain;
        let n = chain.kinds.len();
        let off = |i: usize| chain.nodes[i % n].point.distance(self.at);
        let nearest = (0..n).min_by(|a, b| off(*a).total_cmp(&off(*b)))?;
        if off(nearest) >= reach {
            let off = |i: &usize| chain.cubic(*i).nearest(self.at, NEAREST_PX).distance_sq;
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
        let noise = wrong.grain * window.pixels();
        let mut chain = part.clone();
        let mut drawn = fit(window, &mut chain, f64::INFINITY);
        let mut good = self.sound(&chain, part, reach);
        for _ in 0..CHANGES {
            let now = drawn.squares;
            let explained = |squares: f64| squares - noise < WRONG;
            if good && explained(now) {
                break;
            }
            let beside = tipped(&chain);
            let asked = |c: &Chain| match (beside && tipped(c), alike(c, &chain)) {
                (_, true) => (0.0, 0.0),
                (true, _) => TIP,
                _ => (NODE, WORTH),
            };
            let cost = |c: &Chain, squares: f64| {
                let price = asked(c).0 + NODE_GRAIN * wrong.grain;
                squares + price * (c.nodes.len() as f64 - chain.nodes.len() as f64)
            };
            let mut least = if good { now } else { f64::INFINITY };
            let most = |c: &Chain| {
                if good {
                    now - asked(c).1 * (now - noise).max(0.0)
                } else {
                    ASTRAY * now.max(noise)
                }
            };
            let mut found: Option<(Chain, Drawn)> = None;
            // a fit that ended in what no outline may have is no place to begin
            let from = if good { &chain } else { part };
            for mut other in variants(from, self.at, reach) {
                let done = |(c, d): &(Chain, Drawn)| {
                    explained(d.squares) && c.nodes.len() < other.nodes.len()
                };
                if found.as_ref().is_some_and(done) {
                    // what more nodes could save is less than they must
                    break;
                }
                let enough = most(&other);
                let drawn = fit(window, &mut other, enough);
                let cost = cost(&other, drawn.squares);
                if cost < least && drawn.squares < most(&other) && self.sound(&other, part, reach) {
                    least = cost;
                    found = Some((other, drawn));
                }
            }
            let Some(better) = found else { break };
            (chain, drawn, good) = (better.0, better.1, true);
        }
        good.then_some((chain, drawn))
    }

    /// Whether an outline may look like that, and no node lies astray.
    fn sound(&self, chain: &Chain, was: &Chain, reach: f64) -> bool {
        let home = |i: usize| {
            let p = chain.nodes[i].point;
            let far = if tip(chain, i).is_some() { FAR } else { HOME };
            p.distance(self.at) < far * reach || {
                let off = |s: usize| was.cubic(s).nearest(p, NEAREST_PX).distance_sq;
                (0..was.kinds.len()).any(|s| off(s) < HOME_PX * HOME_PX)
            }
        };
        (1..chain.kinds.len()).all(home) && fair(chain)
    }
}

/// Whether an outline may look like that: no curve hooks back, no corner turns back.
fn fair(chain: &Chain) -> bool {
    let open = |i: usize| {
        if chain.nodes[i].join.is_smooth() {
            turn(chain, i) < HIDDEN
        } else {
            !is_needle(chain, i)
        }
    };
    (1..chain.kinds.len()).all(open) && (0..chain.kinds.len()).all(|i| runs_on(chain, i))
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

/// Whether an inner node is a tip.
fn tipped(chain: &Chain) -> bool {
    (1..chain.kinds.len()).any(|i| tip(chain, i).is_some())
}

/// Whether two chains have the same structure.
fn alike(a: &Chain, b: &Chain) -> bool {
    let joins = |c: &Chain| c.nodes.iter().map(|n| n.join).collect::<Vec<_>>();
    a.kinds == b.kinds && joins(a) == joins(b)
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
    let within = |v: Vec2| off(v) < HOOK && v.dot(chord) <= PAST * chord.hypot2();
    chord.hypot() >= SHORT_PX
        && within(start)
        && within(end)
        && start.hypot() + end.hypot() < LONG * chord.hypot()
}
