//! The structure of a place: nodes and corners that a window's pixels ask for, one more or less at a time.

use super::{
    WRONG,
    bends::{cornered, is_cornered, is_sharp},
    beside::Beside,
    budget::Budget,
    ends::{is_blunt, is_round, square},
    fair::is_fair,
    tips::{has_tip, tip},
    variants::{CUTS_PX, ROUNDS_PX, cut, variants},
    window::{Drawn, Window},
};
use crate::numeric::{
    chain::{Chain, Join, Kind},
    joins::{DEPTH_PX, divide_at_extrema, keep_levels, sharpen, soften_if_soft},
};
use kurbo::{ParamCurveNearest, Point};

/// Changes of structure in a place, one upon the other.
const CHANGES: usize = 3;
/// What a node must save, squares, and in the picture's grain.
const NODE: f64 = 0.1;
const NODE_GRAIN: f64 = 48.0;
/// The part of what is wrong, beyond grain, that a change of structure must mend.
const WORTH: f64 = 0.4;
/// What a node must save beside a tip, of whose length few pixels tell, and that part there.
const TIP: (f64, f64) = (0.03, 0.2);
/// A structure that no outline may have gives way to one that leaves so many times as much.
const ASTRAY: f64 = 1.1;
/// A smooth node so near to an axis is an extremum, radians.
const AXIS: f64 = 0.15;
/// A node is at home within so many reaches of its place, a tip within as many, or so near to the path that was
/// there, px.
const HOME: f64 = 1.5;
pub(super) const FAR: f64 = 3.0;
const HOME_PX: f64 = 2.0;
/// So far from a tight bend its sides lead to a corner, px.
const SIDES_PX: [f64; 2] = [2.0, 4.0];
/// How precisely the nearest place on a curve is found, px.
const NEAREST_PX: f64 = 1e-3;

/// An open part of a path, a window of the picture around it, and what counts in it.
#[derive(Debug)]
pub(super) struct Search<'a> {
    pub(super) window: &'a Window,
    pub(super) part: &'a Chain,
    /// nodes within `reach` px of `at` may change
    pub(super) at: Point,
    pub(super) reach: f64,
    /// mean square of the differences that mean nothing
    pub(super) grain: f64,
    pub(super) work: &'a Budget,
    /// what no structure may cross
    pub(super) beside: Option<Beside>,
}

/// A structure, fit.
#[derive(Debug)]
pub(super) struct Fitted {
    pub(super) chain: Chain,
    pub(super) drawn: Drawn,
    /// whether an outline may look like that
    sound: bool,
}

impl Search<'_> {
    /// The structure of least squares and nodes that an outline may have.
    pub(super) fn best(&self) -> Option<Fitted> {
        let mut now = self.fit(self.part.clone(), f64::INFINITY);
        for _ in 0..CHANGES {
            if now.sound && self.is_explained(&now) {
                break;
            }
            let Some(better) = self.better(&now) else {
                break;
            };
            now = better;
        }
        now.sound.then_some(now)
    }

    /// The structure as it is, with its nodes where the pixels have them, if that is sound and both sides lead to its
    /// tip.
    pub(super) fn settled(&self) -> Option<Fitted> {
        let now = self.fit(self.part.clone(), f64::INFINITY);
        let tips = (1..now.chain.kinds.len()).filter(|i| tip(&now.chain, *i).is_some());
        let off = |i: &usize| now.chain.nodes[*i].point.distance(self.at);
        let nearest = tips.min_by(|a, b| off(a).total_cmp(&off(b)))?;
        (now.sound && is_sharp(&now.chain, nearest)).then_some(now)
    }

    /// The structure with a corner in place of the bend there, if it is sound and leaves no more than `more` squares
    /// more.
    pub(super) fn sharpened(&self, more: f64) -> Option<Fitted> {
        let now = self.fit(self.part.clone(), f64::INFINITY);
        let left = if now.sound {
            &now.drawn
        } else {
            &self.window.drawn(self.part)
        };
        let mut most = left.squares + more;
        let mut found = None;
        let corners = SIDES_PX.map(|px| cornered(self.part, self.at, px));
        for (other, _) in corners.into_iter().flatten() {
            let other = self.fit(other, most);
            let corner = is_cornered(&other.chain, self.at, self.part);
            if corner && other.sound && other.drawn.squares < most {
                most = other.drawn.squares;
                found = Some(other);
            }
        }
        found
    }

    /// The structure with a line across the end of the corner there, or with a round in its place, if it is sound and
    /// leaves no more than `more` squares more, which is negative: fewer.
    pub(super) fn blunted(&self, more: f64) -> Option<Fitted> {
        let now = self.fit(self.part.clone(), f64::INFINITY);
        let (from, left) = if now.sound {
            (&now.chain, now.drawn.squares)
        } else {
            (self.part, self.window.drawn(self.part).squares)
        };
        let off = |i: &usize| from.nodes[*i].point.distance(self.at);
        let corners = (1..from.kinds.len()).filter(|i| from.nodes[*i].join == Join::Corner);
        let corner = corners.min_by(|a, b| off(a).total_cmp(&off(b)))?;
        let mut most = left + more;
        let mut found = None;
        let lines = CUTS_PX.map(|px| (px, Kind::Line));
        let rounds = ROUNDS_PX.map(|px| (px, Kind::Cubic));
        for (px, by) in lines.into_iter().chain(rounds) {
            let mut other = self.fit(cut(from, corner, px, by), most);
            let is_so = match by {
                Kind::Line => {
                    if !is_blunt(&other.chain, corner) {
                        other = self.squared(other, corner);
                    }
                    is_blunt(&other.chain, corner)
                }
                Kind::Cubic => is_round(&other.chain, self.at),
            };
            if other.sound && is_so && other.drawn.squares < most {
                most = other.drawn.squares;
                found = Some(other);
            }
        }
        found
    }

    /// The same with the line from node `i` to the next square to what it ends: of so short a line's direction grain
    /// leaves nothing.
    fn squared(&self, mut fitted: Fitted, i: usize) -> Fitted {
        if square(&mut fitted.chain, i).is_some() {
            fitted.drawn = self.window.drawn(&fitted.chain);
            fitted.sound = self.is_sound(&fitted.chain);
        }
        fitted
    }

    /// The cheapest sound structure with a node or corner more or less, if that is worth it.
    fn better(&self, now: &Fitted) -> Option<Fitted> {
        let squares = now.drawn.squares;
        let noise = self.noise();
        let most = |other: &Chain| {
            if now.sound {
                squares - asked(now, other).1 * (squares - noise).max(0.0)
            } else {
                ASTRAY * squares.max(noise)
            }
        };
        let price = |other: &Chain| {
            let more = other.nodes.len() as f64 - now.chain.nodes.len() as f64;
            (asked(now, other).0 + NODE_GRAIN * self.grain) * more
        };
        let mut least = if now.sound { squares } else { f64::INFINITY };
        let mut found: Option<Fitted> = None;
        // a fit that ended in what no outline may have is the second place to begin
        let from: &[&Chain] = if now.sound {
            &[&now.chain]
        } else {
            &[self.part, &now.chain]
        };
        for from in from {
            for other in variants(from, self.at, self.reach) {
                let fewer = |f: &Fitted| f.chain.nodes.len() < other.nodes.len();
                // what more nodes could save is less than they must
                let explained = found.as_ref();
                if explained.is_some_and(|f| self.is_explained(f) && fewer(f))
                    || self.work.is_spent()
                {
                    break;
                }
                let enough = most(&other).min(least - price(&other));
                if enough <= 0.0 {
                    continue;
                }
                let other = self.fit(other, enough);
                let cost = other.drawn.squares + price(&other.chain);
                if cost < least && other.drawn.squares < most(&other.chain) && other.sound {
                    (least, found) = (cost, Some(other));
                }
            }
            if found.is_some() {
                break;
            }
        }
        found
    }

    /// Fits a structure, its extrema upright and level, and its soft corners smooth.
    fn fit(&self, mut chain: Chain, enough: f64) -> Fitted {
        self.work.take(chain.kinds.len());
        let mut drawn = self.window.fit(&mut chain, enough);
        let before = chain.clone();
        for i in 1..chain.kinds.len() {
            soften_if_soft(&mut chain, i);
            sharpen(&mut chain, i);
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
        divide_at_extrema(&mut chain, DEPTH_PX);
        if chain != before {
            drawn = self.window.fit(&mut chain, enough);
        }
        let before = chain.clone();
        keep_levels(&mut chain);
        if chain != before {
            drawn = self.window.drawn(&chain);
        }
        Fitted {
            sound: self.is_sound(&chain),
            chain,
            drawn,
        }
    }

    /// Whether an outline may look like that, and no node lies astray.
    fn is_sound(&self, chain: &Chain) -> bool {
        let home = |i: usize| {
            let p = chain.nodes[i].point;
            let far = if tip(chain, i).is_some() { FAR } else { HOME };
            p.distance(self.at) < far * self.reach || {
                let off = |s: usize| self.part.cubic(s).nearest(p, NEAREST_PX).distance_sq;
                (0..self.part.kinds.len()).any(|s| off(s) < HOME_PX * HOME_PX)
            }
        };
        let clear = || self.beside.as_ref().is_none_or(|b| b.is_clear(chain));
        (1..chain.kinds.len()).all(home) && is_fair(chain) && clear()
    }

    fn is_explained(&self, fitted: &Fitted) -> bool {
        fitted.drawn.squares - self.noise() < WRONG
    }

    /// Squares in the window that mean nothing.
    fn noise(&self) -> f64 {
        self.grain * self.window.pixels()
    }
}

/// What another structure must save: squares a node, and a part of what is wrong beyond grain.
fn asked(now: &Fitted, other: &Chain) -> (f64, f64) {
    if alike(other, &now.chain) {
        (0.0, 0.0)
    } else if has_tip(&now.chain) && has_tip(other) {
        TIP
    } else {
        (NODE, WORTH)
    }
}

/// Whether two chains have the same structure.
fn alike(a: &Chain, b: &Chain) -> bool {
    let joins = |c: &Chain| c.nodes.iter().map(|n| n.join).collect::<Vec<_>>();
    a.kinds == b.kinds && joins(a) == joins(b)
}
