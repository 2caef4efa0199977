//! A place where a path is wrong: the nodes around it, fit to the pixels and put back.

use super::{
    Ring,
    beside::Beside,
    budget::Budget,
    fair::is_fair,
    part::{begun_at, open_part, put_back},
    structure::{FAR, Search},
    tangle::Crossing,
    tips::has_tip,
    window::Window,
};
use crate::{
    numeric::chain::{Chain, Kind},
    refine::{curves::polygon, residual::Residual},
};
use kurbo::{ParamCurveNearest, Point};

/// Differences are summed up so far around a place, px, which are so many pixels.
pub(super) const NEAR_PX: f64 = 4.0;
const NEAR: f64 = 81.0;
/// The part of what is wrong there, beyond grain, that nodes must mend to move at all; and beside a tip, of whose
/// length few pixels tell.
const GAIN: f64 = 0.3;
const TIP_GAIN: f64 = 0.1;
/// Which is never more than what so many pixels' grain would make of it.
const TIP_GAIN_GRAIN: f64 = 6.0;
/// A chain into which a part is put back stays if no control point moves further for it, px; with so many segments
/// more at each side fit again, none moves further than this.
const STAYS_PX: f64 = 0.02;
const ALONG: usize = 2;
const MOVES_PX: f64 = 0.1;
/// Chords cut off next to nothing of a path, px.
pub(super) const CHORD_PX: f64 = 0.001;
/// How precisely the nearest place on a curve is found, px.
const NEAREST_PX: f64 = 1e-3;

/// A chain that explains more.
#[derive(Debug)]
pub(super) struct Mended {
    pub(super) chain: Chain,
    /// nodes around the place
    pub(super) moved: Vec<Point>,
}

/// Why a place is looked at.
#[derive(Debug, Clone, Copy)]
pub(super) enum Look {
    /// The path leaves something unexplained there.
    Wrong,
    /// It bends there as tightly as a corner would look, or just before a corner.
    Bend,
    /// It has a corner there whose end may be blunt.
    Corner,
    /// It has a tip there that may lie elsewhere.
    Tip,
}

impl Look {
    /// By how much squares may grow in a place; negative where they must fall.
    pub(super) const fn more(self, grain: f64) -> f64 {
        /// Squares that mean nothing, and in the picture's grain.
        const TIE: (f64, f64) = (0.001, 1.0);
        /// What a line across the end of a corner must mend, squares, and in the picture's grain.
        const BLUNT: (f64, f64) = (0.003, 16.0);
        /// What a tip that moves must mend: of the last px of an acute one hardly a pixel tells.
        const MOVED: f64 = 1e-6;
        match self {
            Self::Wrong => 0.0,
            Self::Bend => TIE.0 + TIE.1 * grain,
            Self::Corner => -(BLUNT.0 + BLUNT.1 * grain),
            Self::Tip => -MOVED,
        }
    }
}

/// Where a path is wrong.
#[derive(Debug)]
pub(super) struct Place<'a> {
    pub(super) residual: &'a Residual<'a>,
    pub(super) chain: &'a Chain,
    pub(super) at: Point,
    /// all paths as chords, and the index of this one
    pub(super) rings: (&'a [Ring], usize),
    /// mean square of the differences that mean nothing
    pub(super) grain: f64,
    pub(super) crossing: Crossing,
    pub(super) work: &'a Budget,
}

impl Place<'_> {
    /// The chain with what is better within `reach` px of the place: at a wrong one its nodes where the pixels have
    /// them, if that explains enough more, at a bend a corner, if that explains as much.
    pub(super) fn mended(&self, look: Look, reach: f64) -> Option<Mended> {
        let (start, count) = self.run(reach)?;
        let ring = begun_at(self.chain, start);
        let part = open_part(&ring, count);
        let rest = rest(&ring, &part);
        let window = self.window((&rest, &part), reach);
        let search = Search {
            window: &window,
            part: &part,
            at: self.at,
            reach,
            grain: self.grain,
            work: self.work,
            beside: self.beside((&rest, &part), FAR * reach),
        };
        let best = match look {
            Look::Wrong => search.best(),
            Look::Bend => search.sharpened(look.more(self.grain)),
            Look::Corner => search.blunted(look.more(self.grain)),
            Look::Tip => search.settled(),
        }?;
        let enough = match look {
            Look::Wrong => self.enough(&best.chain),
            Look::Bend | Look::Corner | Look::Tip => -look.more(self.grain),
        };
        if window.drawn(&part).squares - best.drawn.squares < enough {
            return None;
        }
        // what went out of the window tells nothing in it
        let best = best.chain;
        let window = self.window((&rest, &part), FAR * reach);
        if window.drawn(&best).squares > window.drawn(&part).squares - enough {
            return None;
        }
        let now = best.kinds.len();
        let moved = best.nodes[1..now].iter().map(|n| n.point).collect();
        let (chain, strayed) = put_back(ring.clone(), best, count)?;
        if strayed < STAYS_PX {
            return Some(Mended { chain, moved });
        }
        let chain = self.eased((&ring, count), (&chain, now), (reach, enough))?;
        Some(Mended { chain, moved })
    }

    /// A chain in whose place for `count` segments of a ring others are that took a line beside them along: what is
    /// beside them is fit with them.
    fn eased(
        &self,
        (ring, count): (&Chain, usize),
        (chain, now): (&Chain, usize),
        (reach, enough): (f64, f64),
    ) -> Option<Chain> {
        let beside = ALONG.min((ring.kinds.len() - count) / 2);
        let back = |chain: &Chain| begun_at(chain, chain.kinds.len() - beside);
        let (ring, chain) = (back(ring), back(chain));
        let (count, now) = (count + 2 * beside, now + 2 * beside);
        let part = open_part(&ring, count);
        let window = self.window((&rest(&ring, &part), &part), FAR * reach);
        let most = window.drawn(&part).squares - enough;
        let mut best = open_part(&chain, now);
        if window.fit(&mut best, most).squares > most || !is_fair(&best) {
            return None;
        }
        let (chain, strayed) = put_back(chain, best, now)?;
        (strayed < MOVES_PX).then_some(chain)
    }

    /// Squares that must be mended for a structure.
    fn enough(&self, best: &Chain) -> f64 {
        let left = self.residual.squares(self.at, NEAR_PX) - NEAR * self.grain;
        if has_tip(best) {
            (TIP_GAIN * left).min(TIP_GAIN_GRAIN * self.grain)
        } else {
            GAIN * left
        }
    }

    /// The window in which a `part` of a ring moves, and the `rest` does not.
    fn window(&self, (rest, part): (&[Point], &Chain), reach: f64) -> Window {
        let lines = self.others(reach).chain([rest]);
        Window::new(self.residual, (self.at, reach), lines, part, self.grain)
    }

    /// What such a `part` may not cross, if it may not.
    fn beside(&self, (rest, part): (&[Point], &Chain), reach: f64) -> Option<Beside> {
        if self.crossing == Crossing::OnTheWay {
            return None;
        }
        let lines = self.others(reach).chain([rest]);
        let bounds = Window::bounds(self.residual, (self.at, reach));
        Some(Beside::new(lines, part, bounds))
    }

    /// The other rings that a window can see.
    fn others(&self, reach: f64) -> impl Iterator<Item = &[Point]> {
        let (rings, own) = self.rings;
        let around = Window::bounds(self.residual, (self.at, reach));
        let others = rings.iter().enumerate();
        let others = others.filter(move |(k, r)| *k != own && r.bounds.overlaps(around));
        others.map(|(_, r)| r.chords.as_slice())
    }

    /// The first segment of those that may move, and how many they are: those that end in a node within `reach` px,
    /// and what a line of them takes along.
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

    /// The first segment of those that end in a node within `reach` px, in a row with the nearest one, and how many
    /// they are.
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
}

/// What of a chain that begins with a `part` is not in it, as chords.
fn rest(chain: &Chain, part: &Chain) -> Vec<Point> {
    let rest = chain.part(part.kinds.len()..chain.kinds.len());
    polygon(&rest.to_path(), CHORD_PX)
}
