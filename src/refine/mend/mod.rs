//! Places that settled paths leave unexplained: their nodes against the pixels, other structures tried.
//!
//! | | takes | gives |
//! |---|---|---|
//! | here | paths and the picture | places that are wrong, the worst first; levels read again between looks |
//! | [`place`] | a place | the part of its path whose nodes are near, put back where that explains enough more |
//! | [`structure`] | an open part | the [`variants`] of its nodes and corners that leave least |
//! | [`budget`] | the outlines' length | how many fits all that may take |
//! | [`beside`] | a structure | whether it crosses what is around it |
//! | [`tangle`] | paths as they came and are | those that cross now mended once more, without that |
//! | [`window`] | a structure | its nodes by least squares of the pixels around |
//! | [`ends`] | a path's corner | whether its end may be cut off, or it be a round |
//! | [`bends`] | a path | its tight bends and bent corners, and the corners that may stand in their place |
//! | [`straight`] | a path | the same without nodes within a straight line |
//! | [`axes`] | lines that are upright or level but for grain | the same on their axis |
//!
//! What is left of the picture around an edge tells where a fit is wrong, and by how much. There the few nodes near
//! by are fit to the pixels themselves, as they stand and with a node or corner more or less; what leaves least for
//! its nodes is kept. Between such looks the levels of ink and paper are read again: what a path did not follow had
//! passed for a part of them. In the end bends that a lens cannot tell from corners become corners, and corners whose
//! sides bend at the end go where these lead, where the pixels do not speak against it; corners lose their ends or
//! become rounds, where the pixels ask for it; then tips, and all nodes together once more.

mod axes;
mod bends;
mod beside;
mod budget;
mod ends;
mod fair;
mod part;
mod place;
mod side;
mod straight;
mod structure;
mod tangle;
#[cfg(test)]
mod tests;
mod tips;
mod variants;
mod window;

use super::{
    curves::polygon,
    nodes::{Soft, is_noise, settled},
    residual::Residual,
};
use crate::numeric::{chain::Chain, joins::divide_at_extrema, many::each};
use bends::{is_bent, tight_bends};
use budget::Budget;
use ends::hint;
use kurbo::{BezPath, Point, Rect, Shape};
use part::changed;
use place::{CHORD_PX, Look, Mended, NEAR_PX, Place};
use std::mem;
use straight::straightened;
use tangle::Crossing;
use tips::{NEEDLE_PX, ONE_PX, beyond, is_needle, tip, trimmed};

/// Directions that differ by less are one, radians.
const SMOOTH: f64 = 0.0175;
/// Way along an edge between places that are looked at, px.
const STEP_PX: f64 = 1.5;
/// Sum of squares around a place from which it is wrong, and from which in the picture's grain.
const WRONG: f64 = 0.018;
const WRONG_GRAIN: f64 = 90.0;
/// And from which a part of the drawing is missing there.
const LOST: f64 = 0.2;
/// Places that are tried at most, the worst first, and crossings: a picture of noise is wrong everywhere.
const MOST: usize = 1000;
/// Places nearer to one that was tried are that one, px.
const SAME_PX: f64 = 5.0;
/// A node that went further than this, px, is followed by a window of its own, so many of them at most.
const MOVED_PX: f64 = 2.0;
const LOOKS: usize = 4;
/// A corner is tried with a blunt end where its pixels alone would mend such a part of what that must.
const HINT: f64 = 0.3;
/// Places are looked at so often, each time with the levels of ink and paper that the paths leave then.
const PASSES: usize = 4;
/// One that was tried in vain is looked at again beside a change, or where the squares have changed by such a part.
const NEW: f64 = 0.01;
/// What is cut off a tip may leave so many squares more: a loop that no pixel holds leaves 0.2 at most, a lobe behind
/// a narrow neck two and more. Where it leaves more the cut is tried so many steps nearer to the tip.
const LOBE: f64 = 0.5;
const LESS: usize = 4;
/// How far the nodes around move, px, and what each px of the lens' deviation adds; and times this where that mends
/// little.
const REACH_PX: f64 = 6.0;
const REACH_LENS: f64 = 2.0;
const WIDE: f64 = 2.0;

/// The paths, changed where a few nodes explain the picture better, and with nodes at all extrema in the end; and the
/// places where they leave out a part of the drawing that no change of a few nodes brought back.
pub(super) fn mended(residual: &Residual<'_>, paths: &[BezPath]) -> (Vec<BezPath>, Vec<Point>) {
    let mut work = Work::new(residual, paths);
    work.mend();
    work.untangle(paths);
    let lost = mem::take(&mut work.lost);
    (work.finished(), lost)
}

/// Paths on their way.
struct Work<'a> {
    residual: Residual<'a>,
    wrong: Wrong,
    reach: f64,
    /// rings of noise, and those of which there is none or none could be read, stay
    chains: Vec<Option<Chain>>,
    rings: Vec<Ring>,
    /// places that were tried in vain, and the squares around them then
    vain: Vec<(Point, f64)>,
    /// where a part of the drawing is missing
    lost: Vec<Point>,
    crossing: Crossing,
    work: Budget,
}

impl<'a> Work<'a> {
    fn new(residual: &'a Residual<'_>, paths: &[BezPath]) -> Self {
        let rings = rings(paths);
        let chains = rings.iter().map(Ring::chain).collect();
        let residual = residual.against(rings.iter().map(|r| r.chords.as_slice()));
        let length: f64 = rings.iter().map(Ring::length).sum();
        Self {
            wrong: Wrong::new(&residual),
            reach: REACH_PX + REACH_LENS * residual.lens_px(),
            residual,
            chains,
            rings,
            vain: Vec::new(),
            lost: Vec::new(),
            crossing: Crossing::OnTheWay,
            work: Budget::new(length),
        }
    }
}

impl Work<'_> {
    /// All steps.
    fn mend(&mut self) {
        if self.trim(ONE_PX) {
            self.wrong = Wrong::new(&self.residual);
        }
        let mut more = self.pass() || !self.vain.is_empty();
        for _ in 1..PASSES {
            if !more {
                break;
            }
            // what a path does not follow yet has passed for a level
            let chains = self.chains.iter().flatten();
            self.residual.level(chains.flat_map(beyond));
            more = self.pass();
        }
        self.sharpen();
        self.straighten();
        self.blunt();
        self.settle_tips();
        // sides that run close together do so for the pixels' sake now, and may touch once all nodes settle
        self.trim(0.0);
        // nodes that settle make up for a little of what is missing
        self.lost = self.lost();
        self.settle();
        self.put_on_axes();
    }

    /// The places where more is left than an edge leaves that is a little off; none where the budget is why.
    fn lost(&self) -> Vec<Point> {
        let mut lost: Vec<Point> = Vec::new();
        if self.work.is_spent() {
            return lost;
        }
        for (k, p) in self.wrong.places(&self.residual, &self.rings) {
            let known = near(&lost, p, SAME_PX);
            if !known && self.chains[k].is_some() && self.left(p) > LOST {
                lost.push(p);
            }
        }
        lost
    }

    /// The paths as they are, with nodes at all extrema and none within a straight line.
    fn finished(self) -> Vec<BezPath> {
        let finished = |(chain, ring): (Option<Chain>, Ring)| {
            let stays = chain.is_none();
            let Some(mut chain) = chain.or_else(|| read(&ring.path)) else {
                return ring.path;
            };
            let before = chain.kinds.len();
            divide_at_extrema(&mut chain, 0.0);
            let path = if chain.kinds.len() > before {
                chain.to_path()
            } else {
                ring.path
            };
            if stays { path } else { straightened(path) }
        };
        let both = self.chains.into_iter().zip(self.rings);
        both.map(finished).collect()
    }

    /// Cuts the ends off tips whose sides are no more than `one_px` apart or have crossed, where the picture does not
    /// ask for them. Whether there were any.
    fn trim(&mut self, one_px: f64) -> bool {
        let mut trimmed = false;
        for k in 0..self.chains.len() {
            let mut kept = Vec::new();
            let mut i = 0;
            while let Some(chain) = self.chains[k].as_ref().filter(|c| i < c.nodes.len()) {
                let at = chain.nodes[i].point;
                if kept.contains(&at) {
                    i += 1;
                } else if self.shorten(k, i, one_px) {
                    // the ring begins elsewhere now
                    (i, trimmed) = (0, true);
                } else {
                    kept.push(at);
                    i += 1;
                }
            }
        }
        trimmed
    }

    /// Cuts off as much of the end of corner `i` of ring `k` as is nothing to the picture; whether there is such.
    fn shorten(&mut self, k: usize, i: usize, one_px: f64) -> bool {
        let mut steps = usize::MAX;
        let needle = self.chains[k].as_ref().is_some_and(|c| is_needle(c, i));
        let one_px = if needle { NEEDLE_PX } else { one_px };
        let cut = |work: &Self, steps| trimmed(work.chains[k].as_ref()?, i, one_px, steps);
        while let Some((shorter, last)) = cut(self, steps) {
            if self.put(k, shorter, LOBE) {
                return true;
            }
            steps = last.saturating_sub(LESS);
        }
        false
    }

    /// Tries the places that are wrong, but not again where nothing is new; whether any was changed.
    fn pass(&mut self) -> bool {
        let (mut tried, mut changed) = (Vec::new(), Vec::new());
        for (k, p) in self.wrong.places(&self.residual, &self.rings) {
            let stays = self.chains[k].is_none();
            if stays
                || self.left(p) <= self.wrong.least
                || near(&tried, p, SAME_PX)
                || self.is_known(p)
            {
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
                match self.change(k, at, Look::Wrong) {
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

    /// Puts corners in the place of tight bends, if most of them may be corners: a drawing has either.
    fn sharpen(&mut self) {
        let of = |(k, (chain, ring)): (usize, (&Option<Chain>, &Ring))| {
            let places = chain.as_ref().map(|c| tight_bends(c, &ring.chords));
            let places = places.into_iter().flatten();
            places.map(|p| (k, p)).collect::<Vec<_>>()
        };
        let both = self.chains.iter().zip(&self.rings);
        let places: Vec<(usize, Point)> = both.enumerate().flat_map(of).collect();
        if places.len() > MOST {
            return;
        }
        let before = (self.chains.clone(), self.rings.clone());
        let mut round = 0;
        for &(k, at) in &places {
            round += usize::from(self.change(k, at, Look::Bend).is_none());
            if 2 * round >= places.len() {
                (self.chains, self.rings) = before;
                self.redraw_all();
                return;
            }
        }
    }

    /// Puts corners whose sides turn just before them to where those lead, if the pixels do not speak against it.
    fn straighten(&mut self) {
        for (k, at) in self.nodes(is_bent) {
            self.change(k, at, Look::Bend);
        }
    }

    /// Puts lines across the ends of corners, or rounds in their place, where the pixels ask for them, of pictures whose
    /// pixels tell so little.
    fn blunt(&mut self) {
        if self.residual.seen().scatter_px() > 0.0 {
            return;
        }
        let least = -HINT * Look::Corner.more(self.wrong.grain);
        let hinted = |c: &Chain, i: usize| hint(&self.residual, c, i) > least;
        for (k, at) in self.nodes(hinted) {
            self.change(k, at, Look::Corner);
        }
    }

    /// Moves tips to where the pixels have them. They are too few for a wrong place: tips of 15° were 0.4 px short on
    /// scans.
    fn settle_tips(&mut self) {
        for (k, at) in self.nodes(|c, i| tip(c, i).is_some()) {
            self.change(k, at, Look::Tip);
        }
    }

    /// Moves all nodes once more: where a path was wrong it held what is around, too. Not if outlines would cross that
    /// may not.
    fn settle(&mut self) {
        let crossed = self.crossed(None);
        let before = (self.chains.clone(), self.rings.clone());
        let paths = each(&self.rings, |ring| ring.path.clone());
        let settled = settled(&mut self.residual, &paths, Soft::Smooth);
        let both = self.chains.iter_mut().zip(&mut self.rings);
        for ((chain, ring), path) in both.zip(settled) {
            if chain.is_some() {
                *ring = Ring::new(path);
                *chain = ring.chain();
            }
        }
        if self.crossed(None) > crossed {
            (self.chains, self.rings) = before;
        }
        self.redraw_all();
    }

    /// The places of nodes and their rings, as many as are tried.
    fn nodes(&self, wanted: impl Fn(&Chain, usize) -> bool) -> Vec<(usize, Point)> {
        let chains = self.chains.iter().enumerate();
        let chains = chains.filter_map(|(k, c)| Some((k, c.as_ref()?)));
        let nodes = chains.flat_map(|(k, c)| (0..c.nodes.len()).map(move |i| (k, c, i)));
        let wanted = nodes.filter(|(_, c, i)| wanted(c, *i));
        wanted
            .map(|(k, c, i)| (k, c.nodes[i].point))
            .take(MOST)
            .collect()
    }

    /// Whether a place was tried in vain as it is.
    fn is_known(&self, p: Point) -> bool {
        let same = |(q, left): &(Point, f64)| {
            q.distance(p) < SAME_PX && (self.left(*q) - left).abs() < NEW * left
        };
        self.vain.iter().any(same)
    }

    /// Changes ring `k` around a place if that explains enough more; then the nodes around it.
    fn change(&mut self, k: usize, at: Point, look: Look) -> Option<Vec<Point>> {
        if self.work.is_spent() {
            return None;
        }
        let chain = self.chains[k].as_ref()?;
        let place = Place {
            residual: &self.residual,
            chain,
            at,
            rings: (&self.rings, k),
            grain: self.wrong.grain,
            crossing: self.crossing,
            work: &self.work,
        };
        let reaches = [self.reach, WIDE * self.reach];
        let reaches = match look {
            Look::Wrong => &reaches[..],
            Look::Bend | Look::Corner | Look::Tip => &reaches[..1],
        };
        let Mended { chain, moved } = reaches.iter().find_map(|r| place.mended(look, *r))?;
        // what held it beyond its window may have been wrong
        self.put(k, chain, look.more(self.wrong.grain))
            .then_some(moved)
    }

    /// Puts a chain in the place of ring `k`, unless the squares grow by `more`, outlines cross that did not, or it
    /// is the same; whether it is there now.
    fn put(&mut self, k: usize, chain: Chain, more: f64) -> bool {
        let old = self.chains[k].as_ref();
        let Some(bounds) = old.and_then(|old| changed(old, &chain)) else {
            return false;
        };
        let crossed = self.crossed(Some(bounds));
        let old = mem::replace(&mut self.rings[k], Ring::new(chain.to_path()));
        let clear = self.crossed(Some(bounds)) <= crossed;
        if clear && self.redraw(bounds) < more {
            self.chains[k] = Some(chain);
            return true;
        }
        self.rings[k] = old;
        if clear {
            self.redraw(bounds);
        }
        false
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

    fn redraw_all(&mut self) {
        let rings = self.rings.iter().map(|r| r.chords.as_slice());
        self.residual.update(rings);
    }

    /// Squares around a place.
    fn left(&self, p: Point) -> f64 {
        self.residual.squares(p, NEAR_PX)
    }
}

fn near(points: &[Point], p: Point, px: f64) -> bool {
    points.iter().any(|q| q.distance(p) < px)
}

fn read(path: &BezPath) -> Option<Chain> {
    Chain::from_path(path, SMOOTH)
}

fn rings(paths: &[BezPath]) -> Vec<Ring> {
    paths.iter().map(|p| Ring::new(p.clone())).collect()
}

/// A closed path as chords that come back to its start.
#[derive(Debug, Clone)]
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

    /// What of it may move: nothing of noise.
    fn chain(&self) -> Option<Chain> {
        let drawn = !is_noise(&self.chords);
        drawn.then(|| read(&self.path)).flatten()
    }

    /// px
    fn length(&self) -> f64 {
        let chords = self.chords.iter().zip(self.chords.iter().skip(1));
        chords.map(|(a, b)| a.distance(*b)).sum()
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
