//! Whether letters stand as their names say: what tells which way up a page is.
//!
//! Feet on one line, capitals of one height, small letters lower, tails below, dots above or below, stems on the
//! left. A page read on its side or head gives names to other letters, and hardly one of these holds.

use super::Layer;
use crate::numeric::median::median;
use crate::scan::components::Component;
use crate::scan::letters::{Foot, Head, Kind, Pieces, Shape};
use glyphs_reader::glyphdata::GlyphData;
use kurbo::{Point, Rect};

/// A height is as wrong as can be when it is off by this share.
const FAR: f64 = 0.25;
/// How far a tail hangs below the baseline at least, as a share of a usual letter's height.
const TAIL: f64 = 0.1;
/// Letters that say how one thing stands, at least.
const ENOUGH: usize = 5;
/// Ink that lies off the middle by less, as a share of its box, says nothing.
const BALANCED: f64 = 0.01;

/// A letter's name and ink.
struct Drawn {
    shape: Shape,
    parts: Vec<(Rect, Point, usize)>,
    whole: Rect,
    baseline: f64,
}

impl Drawn {
    /// The largest part.
    fn body(&self) -> (Rect, Point) {
        let most = self.parts.iter().max_by_key(|p| p.2);
        most.map_or((self.whole, self.whole.center()), |p| (p.0, p.1))
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

/// How badly letters stand, 0 to 1: the worst of the things that their names say of enough of them; `None` where the
/// names say too little. `drop` is how far each row's baseline lies below the slots' levels.
pub(super) fn misfit(layer: &Layer, all: &[Component], drop: &[f64]) -> Option<f64> {
    let names = GlyphData::default();
    let drawn = layer.slots.iter().filter(|s| !s.parts.is_empty()).map(|s| {
        let parts = s
            .parts
            .iter()
            .map(|&i| (all[i].upright, all[i].centre, all[i].area));
        let parts: Vec<_> = parts.collect();
        let whole = parts.iter().map(|p| p.0).reduce(|a, b| a.union(b));
        Drawn {
            shape: Shape::of(&s.label, &names),
            whole: whole.unwrap_or(Rect::ZERO),
            parts,
            baseline: s.level + drop[s.row],
        }
    });
    let drawn: Vec<Drawn> = drawn.collect();
    let height = median(drawn.iter().map(|d| d.body().0.height()))?.max(1.0);
    let feet = drawn.iter().filter_map(|d| {
        let foot = if d.shape.kind == Kind::Arabic {
            d.body().0.y1
        } else {
            d.whole.y1
        };
        matches!(d.shape.foot, Foot::Flat | Foot::Round).then(|| far(foot - d.baseline, height))
    });
    let tails = drawn.iter().filter(|d| d.shape.foot == Foot::Tail);
    let tails = tails.map(|d| f64::from(d.whole.y1 - d.baseline < TAIL * height));
    let lists = [
        feet.collect(),
        tails.collect(),
        heads(&drawn),
        drawn.iter().filter_map(pieces).collect(),
        drawn.iter().flat_map(weight).collect(),
    ];
    let told = lists.iter().filter(|l: &&Vec<f64>| l.len() >= ENOUGH);
    told.map(|l| l.iter().sum::<f64>() / l.len() as f64)
        .reduce(f64::max)
}

/// Heights of capitals and of small letters against their medians, and these against each other.
fn heads(drawn: &[Drawn]) -> Vec<f64> {
    let of = |wanted: [Head; 2]| -> Vec<f64> {
        let such = drawn.iter().filter(|d| wanted.contains(&d.shape.head));
        such.map(|d| d.baseline - d.whole.y0).collect()
    };
    let (capitals, small) = (of([Head::Cap, Head::CapBow]), of([Head::X, Head::XBow]));
    let mut out = Vec::new();
    for heights in [&capitals, &small] {
        let usual = median(heights.iter().copied()).unwrap_or(0.0);
        out.extend(heights.iter().map(|h| far(h - usual, usual)));
    }
    if let Some(cap) = median(capitals) {
        out.extend(small.iter().map(|x| f64::from(*x > 0.95 * cap)));
    }
    out
}

/// Whether a letter has the pieces that its name says.
fn pieces(d: &Drawn) -> Option<f64> {
    let (body, _) = d.body();
    let dots = d.parts.iter().filter(|p| p.0 != body);
    let above = dots
        .clone()
        .map(|p| (body.center().y - p.0.center().y).signum());
    let above: f64 = above.sum();
    match (d.shape.pieces, dots.count()) {
        (Pieces::One, extra) => Some(f64::from(u8::from(extra > 0))),
        (Pieces::Unknown | Pieces::Marked, _) | (_, 0) => None,
        (Pieces::DotAbove, _) => Some(f64::from(above <= 0.0)),
        (Pieces::DotBelow, _) => Some(f64::from(above >= 0.0)),
    }
}

/// Whether a letter's ink lies on the side of its middle that its name says.
fn weight(d: &Drawn) -> Vec<f64> {
    let off = d.centre() - d.whole.center();
    let share = [
        off.x / d.whole.width().max(1.0),
        off.y / d.whole.height().max(1.0),
    ];
    let pairs = share.into_iter().zip(d.shape.heavy);
    let told = pairs.filter(|(share, wanted)| *wanted != 0 && share.abs() > BALANCED);
    told.map(|(share, wanted)| f64::from(share * f64::from(wanted) < 0.0))
        .collect()
}

/// How wrong a length is that is off by so much, 0 to 1.
fn far(off: f64, of: f64) -> f64 {
    (off.abs() / (FAR * of.max(1.0))).min(1.0)
}
