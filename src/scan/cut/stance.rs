//! Whether letters stand as their names say: what tells which way up a page is, and that names have slipped.
//!
//! Feet on one line, capitals of one height, small letters lower, tails below, dots above or below, stems on the
//! left. A page read on its side or head gives names to other letters, and hardly one of these holds. Nor do they
//! where a name is missing in the list: from there on each letter has its neighbour's.

use super::{Layer, Slot, Warning};
use crate::numeric::median::median;
use crate::scan::components::Component;
use crate::scan::letters::{Foot, Head, Kind, Pieces, Shape};
use crate::types::Label;
use kurbo::{Point, Rect};

/// A height is as wrong as can be when it is off by this share.
const FAR: f64 = 0.25;
/// How far a tail hangs below the baseline at least, as a share of a usual letter's height.
const TAIL: f64 = 0.1;
/// Letters that say how one thing stands, at least.
const ENOUGH: usize = 5;
/// Ink that lies off the middle by less, as a share of its box, says nothing.
const BALANCED: f64 = 0.01;
/// What capitals are high, and small letters.
const CAPITAL: [Head; 2] = [Head::Cap, Head::CapBow];
const SMALL: [Head; 2] = [Head::X, Head::XBow];
/// Things that speak against a stretch's own names, and not against those beside them, from which on it is said: 2.0
/// on the worst of 40 pages whose names were right but for a font of key caps, 3 or more where a name lacks in the
/// first three quarters of one.
const SHIFTED: f64 = 2.5;

/// A letter's name and ink.
struct Drawn {
    index: usize,
    shape: Shape,
    parts: Vec<(Rect, Point, usize)>,
    whole: Rect,
    baseline: f64,
}

impl Drawn {
    fn of(slot: &Slot, all: &[Component], drop: &[f64]) -> Option<Self> {
        let part = |&i: &usize| (all[i].upright, all[i].centre, all[i].area);
        let parts: Vec<_> = slot.parts.iter().map(part).collect();
        Some(Self {
            index: slot.index,
            shape: slot.shape,
            whole: parts.iter().map(|p| p.0).reduce(|a, b| a.union(b))?,
            parts,
            baseline: slot.level + drop[slot.row],
        })
    }

    /// The largest part.
    fn body(&self) -> Rect {
        let most = self.parts.iter().max_by_key(|p| p.2);
        most.map_or(self.whole, |p| p.0)
    }

    fn centre(&self) -> Point {
        let total: usize = self.parts.iter().map(|p| p.2).sum();
        let sum = self
            .parts
            .iter()
            .fold(Point::ORIGIN, |s, p| s + p.1.to_vec2() * p.2 as f64);
        (sum.to_vec2() / total.max(1) as f64).to_point()
    }
}

/// The letters of a page, and what is usual among them.
pub(super) struct Stance {
    drawn: Vec<Drawn>,
    /// Height of a body, px.
    height: f64,
    /// Heights of capitals and of small letters, px.
    capital: Option<f64>,
    small: Option<f64>,
}

impl Stance {
    /// `drop` is how far each row's baseline lies below the slots' levels.
    pub(super) fn of(layer: &Layer, all: &[Component], drop: &[f64]) -> Self {
        let slots = layer.slots.iter();
        let drawn: Vec<Drawn> = slots.filter_map(|s| Drawn::of(s, all, drop)).collect();
        let height = |wanted: [Head; 2]| {
            let such = drawn.iter().filter(|d| wanted.contains(&d.shape.head));
            median(such.map(|d| d.baseline - d.whole.y0))
        };
        Self {
            height: median(drawn.iter().map(|d| d.body().height())).map_or(1.0, |h| h.max(1.0)),
            capital: height(CAPITAL),
            small: height(SMALL),
            drawn,
        }
    }

    /// How badly letters stand, 0 to 1: the worst of the things that their names say of enough of them; `None` where
    /// the names say too little.
    pub(super) fn misfit(&self) -> Option<f64> {
        let lists = CLAIMS.iter().map(|claim| {
            let letters = self.drawn.iter();
            letters
                .flat_map(|d| claim(self, d, &d.shape))
                .collect::<Vec<f64>>()
        });
        let told = lists.filter(|l| l.len() >= ENOUGH);
        told.map(|l| l.iter().sum::<f64>() / l.len() as f64)
            .reduce(f64::max)
    }

    /// A remark where a stretch of cells stands far better for the names one place before or after their own, in
    /// `labels`.
    pub(super) fn shifted(&self, labels: &[Label]) -> Option<Warning> {
        let shapes: Vec<Shape> = labels.iter().map(Shape::of).collect();
        let before = self.stretch(|i| shapes.get(i.checked_sub(1)?));
        let after = self.stretch(|i| shapes.get(i + 1));
        let (gain, first, last) = if before.0 > after.0 { before } else { after };
        let name = |i: usize| labels.get(i).map_or("", |l| l.0.as_str());
        let (side, why) = if before.0 > after.0 {
            ("before", "is a name missing there")
        } else {
            ("after", "is there a name too many")
        };
        let [from, to] = [first, last].map(|i| format!("{} “{}”", i + 1, name(i)));
        (gain > SHIFTED).then(|| {
            Warning::of_page(format!(
                "cells {from} to {to} look as if each had the name {side} its own: {why}? look at the proof"
            ))
        })
    }

    /// How much better a stretch of cells stands for `other` names than for its own, and its first and last position
    /// in reading order: of all stretches the one that gains most.
    fn stretch<'a>(&self, other: impl Fn(usize) -> Option<&'a Shape>) -> (f64, usize, usize) {
        let (mut best, mut here) = ((0.0, 0, 0), (0.0, 0));
        for d in &self.drawn {
            let own = self.against(d, &d.shape);
            let other = other(d.index).and_then(|o| self.against(d, o));
            if here.0 <= 0.0 {
                here = (0.0, d.index);
            }
            here.0 += own.zip(other).map_or(0.0, |(own, other)| own - other);
            if here.0 > best.0 {
                best = (here.0, here.1, d.index);
            }
        }
        best
    }

    /// How much in a letter's look speaks against a name; nothing where the name says nothing.
    fn against(&self, d: &Drawn, shape: &Shape) -> Option<f64> {
        let told = CLAIMS.iter().flat_map(|claim| claim(self, d, shape));
        told.reduce(|a, b| a + b)
    }
}

/// One of the things that names say, and how wrong it is of a letter, 0 to 1 each.
type Claim = fn(&Stance, &Drawn, &Shape) -> Vec<f64>;
const CLAIMS: [Claim; 5] = [foot, tail, head, pieces, weight];

/// Whether it stands on the line.
fn foot(page: &Stance, d: &Drawn, shape: &Shape) -> Vec<f64> {
    let foot = if shape.kind == Kind::Arabic {
        d.body().y1
    } else {
        d.whole.y1
    };
    let stands = matches!(shape.foot, Foot::Flat | Foot::Round);
    let wrong = stands.then(|| far(foot - d.baseline, page.height));
    wrong.into_iter().collect()
}

/// Whether its tail hangs below the line.
fn tail(page: &Stance, d: &Drawn, shape: &Shape) -> Vec<f64> {
    let hangs = d.whole.y1 - d.baseline >= TAIL * page.height;
    let wrong = (shape.foot == Foot::Tail).then(|| f64::from(!hangs));
    wrong.into_iter().collect()
}

/// Whether it is as high as capitals or small letters are, and these lower than those.
fn head(page: &Stance, d: &Drawn, shape: &Shape) -> Vec<f64> {
    let height = d.baseline - d.whole.y0;
    let off = |usual: Option<f64>| usual.map(|usual| far(height - usual, usual));
    if CAPITAL.contains(&shape.head) {
        off(page.capital).into_iter().collect()
    } else if SMALL.contains(&shape.head) {
        let beside = page
            .capital
            .map(|capital| f64::from(height > 0.95 * capital));
        off(page.small).into_iter().chain(beside).collect()
    } else {
        Vec::new()
    }
}

/// Whether it has the pieces that its name says.
fn pieces(_: &Stance, d: &Drawn, shape: &Shape) -> Vec<f64> {
    let body = d.body();
    let dots = d.parts.iter().filter(|p| p.0 != body);
    let above = dots
        .clone()
        .map(|p| (body.center().y - p.0.center().y).signum());
    let above: f64 = above.sum();
    let wrong = match (shape.pieces, dots.count()) {
        (Pieces::One, extra) => Some(f64::from(u8::from(extra > 0))),
        (Pieces::Unknown | Pieces::Marked | Pieces::Within | Pieces::Bare, _) | (_, 0) => None,
        (Pieces::DotAbove, _) => Some(f64::from(above <= 0.0)),
        (Pieces::DotBelow, _) => Some(f64::from(above >= 0.0)),
    };
    wrong.into_iter().collect()
}

/// Whether its ink lies on the side of its middle that its name says.
fn weight(_: &Stance, d: &Drawn, shape: &Shape) -> Vec<f64> {
    let off = d.centre() - d.whole.center();
    let share = [
        off.x / d.whole.width().max(1.0),
        off.y / d.whole.height().max(1.0),
    ];
    let pairs = share.into_iter().zip(shape.heavy);
    let told = pairs.filter(|(share, wanted)| *wanted != 0 && share.abs() > BALANCED);
    told.map(|(share, wanted)| f64::from(share * f64::from(wanted) < 0.0))
        .collect()
}

/// How wrong a length is that is off by so much, 0 to 1.
fn far(off: f64, of: f64) -> f64 {
    (off.abs() / (FAR * of.max(1.0))).min(1.0)
}
