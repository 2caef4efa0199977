//! The ink of a bare page → pieces that are surely one, and how likely each is a part of another.

use crate::numeric::cast::index;
use crate::numeric::sets::Sets;
use crate::scan::components::{Component, close};
use crate::scan::cut::bounds;
use crate::scan::cut::gap;
use kurbo::Rect;

/// Two pieces one above the other are one within this many stroke widths: a pen that ran dry, a stroke parted by a
/// cut.
const TORN: f64 = 0.35;
/// The same in px at least: hairlines tear where paper shines through for a pixel.
const LEAST_TORN: f64 = 1.5;
/// Sizes of dots and signs end at the first, those of full letters begin at the second, in usual letters' sizes.
const FULL: (f64, f64) = (0.35, 0.6);
/// No sign has so much of a usual letter's size: a hamza has 0.63 at most.
const NO_SIGN: f64 = 0.7;
/// Pieces below this share of a usual letter's size may be dirt.
const MOTE: f64 = 0.2;
/// What a piece's width counts beside its height: signs over letters are wide and low.
const WIDTH: f64 = 0.6;
/// A part of a letter lies within this share of a usual letter's size over it, under it or in it: the highest signs
/// of Nastaliq stand off by 0.7.
const REACH: f64 = 0.9;
/// A large one beside it lies within this many stroke widths.
const BESIDE: f64 = 2.0;
/// A part's middle lies beside its letter by less than this share of a usual letter's size: a stem parted from its
/// bowl, the second of two ticks. What it lies beside it counts so many times.
const ASIDE: (f64, f64) = (0.5, 3.0);
/// A letter's body weighs so many times what its parts weigh; what weighs less is so much farther off, as a share of
/// a usual letter's size.
const LARGER: (f64, f64) = (1.5, 0.3);

/// Letters that are wider than a page's wide ones, and higher than its high ones, are this share of all; letters that
/// touch are so many times as wide at least: on 156 pages pairs were 2.1 times as wide, single letters 1.6 times but
/// for one style with 2.2.
const LARGE: f64 = 0.1;
const TOUCHING: f64 = 1.8;
/// What is higher than a page's high letters by more than this may be letters of two rows.
const HIGH: f64 = 1.3;

/// Letters are drawn in pieces where there are so many times as many of these as their names have: on 154 pages of
/// other letters at most as many. Such pieces are joined within a distance that grows by the second.
const MANY: f64 = 1.5;
const FARTHER: f64 = 1.5;

/// What a page's letters measure.
#[derive(Debug, Clone, Copy)]
pub(super) struct Usual {
    /// Size of a letter, px.
    pub(super) size: f64,
    /// Width of a stroke, px.
    pub(super) stroke: f64,
    /// Width of a wide letter, px.
    pub(super) width: f64,
    /// Height of a high letter, px.
    pub(super) height: f64,
}

/// Ink that is surely of one letter.
#[derive(Debug, Clone)]
pub(super) struct Piece {
    /// Indices of its components.
    pub(super) parts: Vec<usize>,
    /// On the upright page, px.
    pub(super) bounds: Rect,
    /// Area of its largest component, px²: three dots are not more than the letter under them.
    pub(super) area: usize,
    /// Size of a single dot where it is several, else its own, px.
    size: f64,
}

/// A page's ink as it is read.
pub(super) struct Joined {
    pub(super) pieces: Vec<Piece>,
    pub(super) usual: Usual,
    /// How many pieces were joined that are not surely one.
    pub(super) scattered: usize,
}

/// A piece that another one may be a part of.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tie {
    /// Its number.
    pub(super) to: usize,
    /// How unlikely that is by their places, in usual letters' sizes: the paper between them, and how far the part's
    /// middle lies beside the other.
    pub(super) off: f64,
}

impl Piece {
    fn of(parts: Vec<usize>, all: &[Component], usual: Usual) -> Option<Self> {
        let mut piece = Self {
            area: parts.iter().map(|&i| all[i].area).max()?,
            size: 0.0,
            bounds: bounds(all, &parts)?,
            parts,
        };
        piece.measure(all, usual);
        Some(piece)
    }

    /// Sets its size among letters of a usual one.
    fn measure(&mut self, all: &[Component], usual: Usual) {
        let sizes = self.parts.iter().map(|&i| size(all[i].upright));
        let largest = sizes.fold(0.0, f64::max);
        let dots = largest < FULL.0 * usual.size;
        self.size = if dots { largest } else { size(self.bounds) };
    }

    /// How much of a full letter it is by its size: 0 for dots, 1 for letters.
    pub(super) fn full(&self, usual: Usual) -> f64 {
        let size = self.size / usual.size;
        ((size - FULL.0) / (FULL.1 - FULL.0)).clamp(0.0, 1.0)
    }

    /// Whether it is too large for a sign.
    pub(super) fn is_large(&self, usual: Usual) -> bool {
        self.size > NO_SIGN * usual.size
    }

    /// How many letters that touch each other it may be by its width.
    pub(super) fn letters(&self, usual: Usual) -> usize {
        let width = self.bounds.width() / usual.width;
        if width < TOUCHING {
            1
        } else {
            index(width + 0.5)
        }
    }

    /// Whether it may be a letter of one row and one of the next.
    pub(super) fn is_high(&self, usual: Usual) -> bool {
        self.bounds.height() > HIGH * usual.height
    }

    /// Whether another one lies within its bounds: of 999 such pieces on 156 pages two were of another letter.
    pub(super) fn holds(&self, other: &Self) -> bool {
        self.bounds.contains_rect(other.bounds)
    }

    /// Whether it is clearly less than another.
    pub(super) fn is_smaller(&self, other: &Self) -> bool {
        other.weight() >= LARGER.0 * self.weight()
    }

    /// By what it is told which of two pieces is the letter's body, px³: dots can have as much ink as the short tooth
    /// that they stand over, and a hamza can be as high.
    pub(super) fn weight(&self) -> f64 {
        self.area as f64 * self.size
    }

    /// Whether it is smaller than most dots.
    pub(super) fn is_mote(&self, usual: Usual) -> bool {
        self.size < MOTE * usual.size
    }

    /// How unlikely a part of another piece's letter it is by its place; `None` where it is too far.
    fn off(&self, other: &Self, all: &[Component], usual: Usual) -> Option<f64> {
        if other.holds(self) {
            return Some(0.0);
        }
        let middle = self.bounds.center().x;
        let beside = (other.bounds.x0 - middle).max(middle - other.bounds.x1);
        let beside = beside.max(0.0);
        let full = if beside > 0.0 {
            self.full(usual).min(other.full(usual))
        } else {
            0.0
        };
        let reach = REACH * usual.size * (1.0 - full) + BESIDE * usual.stroke * full;
        if beside > ASIDE.0 * usual.size || gap(self.bounds, other.bounds) >= reach {
            return None;
        }
        let ours = self.parts.iter();
        let pairs = ours.flat_map(|a| other.parts.iter().map(move |b| (a, b)));
        let paper = pairs.filter_map(|(&a, &b)| all[a].paper_to(&all[b], reach));
        let paper = paper.min_by(f64::total_cmp)?;
        let more = if self.is_smaller(other) {
            0.0
        } else {
            LARGER.1
        };
        Some((paper + ASIDE.1 * beside) / usual.size + more)
    }
}

fn size(r: Rect) -> f64 {
    r.height().max(WIDTH * r.width())
}

impl Usual {
    /// Of so many letters among the boxes of a page's ink, whose strokes are so wide, px.
    pub(super) fn of(boxes: &[Rect], letters: usize, stroke: f64) -> Self {
        let quantile = |of: fn(Rect) -> f64, share: f64| {
            let mut sizes: Vec<f64> = boxes.iter().map(|&b| of(b)).collect();
            sizes.sort_by(|a, b| b.total_cmp(a));
            let at = sizes.get(index(share * letters as f64)).or(sizes.last());
            at.map_or(1.0, |s| s.max(1.0))
        };
        Self {
            size: quantile(size, 0.5),
            stroke,
            width: quantile(|r| r.width(), LARGE),
            height: quantile(|r| r.height(), LARGE),
        }
    }
}

/// Joins what is surely one, and nothing that was `parted`. Where far more is left than the `parts` that the names of
/// so many `letters` have, each is drawn in pieces, and what lies nearest is joined until no more are left than that.
pub(super) fn pieces(
    all: &[Component],
    (ink, parted): (&[usize], &[usize]),
    stroke: f64,
    (letters, parts): (usize, usize),
) -> Joined {
    let is_apart = |i: usize, j: usize| parted.contains(&i) && parted.contains(&j);
    let boxes: Vec<Rect> = ink.iter().map(|&i| all[i].upright).collect();
    let mut usual = Usual::of(&boxes, letters, stroke);
    let mut reach = torn(stroke);
    let sure = |i: usize, j: usize| is_one(&all[i], &all[j], reach) && !is_apart(i, j);
    let mut found = joined(all, ink, usual, (reach, &sure));
    let count = |found: &[Piece], usual| found.iter().filter(|p| !p.is_mote(usual)).count();
    let sure = found.len();
    let in_pieces = count(&found, usual) as f64 > MANY * parts as f64;
    while in_pieces && count(&found, usual) > parts && reach < usual.size {
        reach *= FARTHER;
        let near = |i: usize, j: usize| all[i].is_near(&all[j], reach) && !is_apart(i, j);
        found = joined(all, ink, usual, (reach, &near));
        let boxes: Vec<Rect> = found.iter().map(|p| p.bounds).collect();
        usual = Usual::of(&boxes, letters, stroke);
    }
    found.iter_mut().for_each(|p| p.measure(all, usual));
    Joined {
        scattered: sure.saturating_sub(found.len()),
        pieces: found,
        usual,
    }
}

/// Joins pieces of ink that are `one` and less than `reach` px apart.
fn joined(
    all: &[Component],
    ink: &[usize],
    usual: Usual,
    (reach, one): (f64, &dyn Fn(usize, usize) -> bool),
) -> Vec<Piece> {
    let boxes: Vec<Rect> = ink.iter().map(|&i| all[i].upright).collect();
    let mut sets = Sets::new(ink.len());
    for (i, j) in close(&boxes, |_| reach) {
        if sets.first(i) != sets.first(j) && one(ink[i], ink[j]) {
            sets.join(i, j);
        }
    }
    let members = sets.into_groups().into_iter();
    let members = members.map(|g| g.into_iter().map(|i| ink[i]).collect::<Vec<usize>>());
    members.filter_map(|m| Piece::of(m, all, usual)).collect()
}

/// For each piece those that are not clearly less than it and of which it may be a part.
pub(super) fn ties(pieces: &[Piece], all: &[Component], usual: Usual) -> Vec<Vec<Tie>> {
    let boxes: Vec<Rect> = pieces.iter().map(|p| p.bounds).collect();
    let mut ties: Vec<Vec<Tie>> = vec![Vec::new(); pieces.len()];
    let reach = (REACH * usual.size).max(BESIDE * usual.stroke);
    let mut pairs: Vec<(usize, usize)> = close(&boxes, |_| reach)
        .map(|(i, j)| (i.min(j), i.max(j)))
        .collect();
    pairs.sort_unstable();
    for (i, j) in pairs {
        for (part, to) in [(i, j), (j, i)] {
            if !pieces[to].is_smaller(&pieces[part]) {
                let off = pieces[part].off(&pieces[to], all, usual);
                ties[part].extend(off.map(|off| Tie { to, off }));
            }
        }
    }
    ties
}

/// How far apart the parts of a torn stroke of such a width are at most, px.
pub(super) fn torn(stroke: f64) -> f64 {
    (TORN * stroke).max(LEAST_TORN)
}

/// Whether two pieces are of one letter, whatever its name: one lies over the other, and less than `torn` px are
/// between them.
pub(super) fn is_one(one: &Component, other: &Component, torn: f64) -> bool {
    let (a, b) = (one.upright, other.upright);
    let over = a.x1.min(b.x1) - a.x0.max(b.x0);
    over > a.width().min(b.width()) / 2.0 && one.is_near(other, torn)
}
