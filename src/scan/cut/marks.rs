//! Dots and accents that are smaller than dust may be, and dust that is as large as dots: names tell them apart.
//!
//! Heavy styles have dots half as wide as their strokes.
//! Ink below the speckle limit is too much like dust to be shared out with the letters. But a letter whose name says that
//! it has dots or an accent takes the largest such piece beside it, and those like it, unless it has larger ones already;
//! and one that is drawn in one piece has none of them, whatever lies beside it.

use super::grid::{SMALL, group};
use super::{Layer, Reason, gap};
use crate::scan::components::Component;
use crate::scan::letters::{Pieces, Shape};
use glyphs_reader::glyphdata::GlyphData;
use kurbo::Rect;
use std::ptr;

/// Area of a dot beside that of the largest of the letter's dots at least: two of three may touch.
const ALIKE: f64 = 0.3;
/// A piece is none of its letter's dots if these are so many times as large and it lies beside the letter, by so many of its
/// widths; further off, if they are about as large.
const LARGER: [(f64, f64); 2] = [(1.5, 1.0), (0.8, 3.0)];
/// A letter of one piece has none whose side is a smaller part of its height: hairlines are thinner than dust.
const MOTE: f64 = 0.03;
/// The longer side of a dot beside its shorter one at most, and the share of its box that it covers at least: 0.5 where it
/// stands on its point.
const COMPACT: (f64, f64) = (2.0, 0.4);
/// How far a dot stands off its letter, as a share of the height of the letter's body.
const REACH: f64 = 0.75;

/// Takes ink smaller than a dot out of the letters that have none, and what lies where no dot does out of those that have;
/// what a user gave to a letter stays.
pub(super) fn dust(layer: &mut Layer, all: &[Component], claims: &[(usize, Vec<usize>)], dot: f64) {
    let names = GlyphData::default();
    for slot in &mut layer.slots {
        if claims.iter().any(|c| c.0 == slot.index) {
            continue;
        }
        let Some(body) = slot.parts.iter().copied().max_by_key(|&i| all[i].area) else {
            continue;
        };
        let shape = Shape::of(&slot.label, &names);
        let is_dust = |i: usize| match shape.pieces {
            _ if i == body => false,
            Pieces::One => {
                let mote = (MOTE * all[body].upright.height()).powi(2);
                (all[i].area as f64) < mote.max(dot) || apart(&all[i], &slot.parts, all)
            }
            Pieces::DotAbove | Pieces::DotBelow | Pieces::Marked => {
                astray(&all[i], &slot.parts, all)
                    || second(&all[i], &shape, &slot.parts, all)
                    || opposite(&all[i], &shape, &slot.parts, all)
            }
            Pieces::Unknown => false,
        };
        let (small, kept): (Vec<usize>, Vec<usize>) = slot.parts.iter().partition(|&&i| is_dust(i));
        slot.parts = kept;
        let small = small.into_iter().map(|i| (i, Reason::Dirt));
        layer.rejected.extend(small);
    }
}

/// Whether a compact piece lies farther from all that is larger than it is long: what a pen's lift tears off a letter of one
/// piece lies close to the rest, or is a stroke.
fn apart(c: &Component, parts: &[usize], all: &[Component]) -> bool {
    let length = c.upright.width().max(c.upright.height());
    let mut others = parts.iter().map(|&i| &all[i]).filter(|o| o.area > c.area);
    is_dot(c) && !others.any(|o| c.is_near(o, length))
}

/// Whether a piece is hardly larger than the dots of its letter, and lies neither over, under nor in what is larger.
fn astray(c: &Component, parts: &[usize], all: &[Component]) -> bool {
    let at = c.upright.center().x;
    LARGER.into_iter().any(|(times, widths)| {
        let others = parts.iter().map(|&i| &all[i]);
        let larger = others.filter(|o| !ptr::eq(*o, c) && o.area as f64 >= times * c.area as f64);
        let larger: Vec<Rect> = larger.map(|o| o.upright).collect();
        let rest = larger.iter().copied().reduce(|a, b| a.union(b));
        // a body and a dot at least
        rest.filter(|_| larger.len() > 1).is_some_and(|rest| {
            let reach = widths * c.upright.width();
            let beside = at < rest.x0 - reach || at > rest.x1 + reach;
            let far = (c.upright.y0 - rest.y1).max(rest.y0 - c.upright.y1);
            beside || far > widths * REACH * rest.height()
        })
    })
}

/// Whether another piece is rather the one dot of its letter: larger, or about as large and nearer to the body.
fn second(c: &Component, shape: &Shape, parts: &[usize], all: &[Component]) -> bool {
    let Some((body, dots)) = dots(shape, parts, all).filter(|_| shape.one_dot) else {
        return false;
    };
    let off = |o: &Component| gap(o.upright, body);
    dots.iter().any(|o| {
        let times = o.area as f64 / c.area as f64;
        times >= LARGER[0].0 || (times >= LARGER[1].0 && off(o) < off(c))
    })
}

/// Whether a small piece lies apart under a letter that has its dots above it, or over one that has them below.
fn opposite(c: &Component, shape: &Shape, parts: &[usize], all: &[Component]) -> bool {
    let most = parts.iter().map(|&i| all[i].area).max().unwrap_or(0);
    dots(shape, parts, all).is_some_and(|(body, dots)| {
        let beyond = if shape.pieces == Pieces::DotAbove {
            c.upright.y0 >= body.y1
        } else {
            c.upright.y1 <= body.y0
        };
        beyond && !dots.is_empty() && (c.area as f64) < SMALL * most as f64 && apart(c, parts, all)
    })
}

/// The box of a letter's body, and the pieces that lie on the side on which its name says that it has dots.
fn dots<'a>(
    shape: &Shape,
    parts: &[usize],
    all: &'a [Component],
) -> Option<(Rect, Vec<&'a Component>)> {
    let side = match shape.pieces {
        Pieces::DotAbove => -1.0,
        Pieces::DotBelow => 1.0,
        _ => return None,
    };
    let main = parts.iter().copied().max_by_key(|&i| all[i].area)?;
    let body = all[main].upright;
    let rest = parts.iter().filter(|&&i| i != main).map(|&i| &all[i]);
    // pieces of the body lie beside it
    let is_there = |o: &&Component| is_dot(o) && side * (o.centre.y - body.center().y) > 0.0;
    Some((body, rest.filter(is_there).collect()))
}

/// Whether a piece is as compact as dots are, and no stroke or ring.
fn is_dot(c: &Component) -> bool {
    let (w, h) = (c.upright.width(), c.upright.height());
    w.max(h) < COMPACT.0 * w.min(h) && c.area as f64 > COMPACT.1 * w * h
}

/// Gives letters that have none of the signs which their names say what lies beside the grid, close over or under them.
pub(super) fn reclaim(layer: &mut Layer, all: &[Component]) {
    let names = GlyphData::default();
    for slot in &mut layer.slots {
        let pieces = Shape::of(&slot.label, &names).pieces;
        let &[body] = slot.parts.as_slice() else {
            continue;
        };
        if matches!(pieces, Pieces::One | Pieces::Unknown) {
            continue;
        }
        let own = &all[body];
        let is_sign = |&(i, reason): &(usize, Reason)| {
            let sign = &all[i];
            let over = sign.upright.x0 < own.upright.x1 && sign.upright.x1 > own.upright.x0;
            let near = gap(sign.upright, own.upright) < REACH * own.upright.height();
            reason == Reason::Outside && over && near && sign.area < own.area
        };
        let (signs, rest) = layer.rejected.iter().partition(|r| is_sign(r));
        let signs: Vec<(usize, Reason)> = signs;
        layer.rejected = rest;
        slot.parts.extend(signs.into_iter().map(|s| s.0));
    }
}

/// Gives small pieces of ink, in no slot so far, to the letters that want them: they go to the end of `all`. Returns how many.
pub(super) fn give(layer: &mut Layer, all: &mut Vec<Component>, small: &[Component]) -> usize {
    let names = GlyphData::default();
    let bodies: Vec<Option<Rect>> = (layer.slots.iter())
        .map(|s| s.parts.iter().max_by_key(|&&i| all[i].area))
        .map(|body| body.map(|&i| all[i].upright))
        .collect();
    let mut wanted: Vec<Vec<Component>> = vec![Vec::new(); layer.slots.len()];
    let mut left: Vec<usize> = (0..small.len()).collect();
    while let Some(&first) = left.first() {
        // the dots of a letter go to it together
        let dots = group(small, first, left.iter());
        left.retain(|i| !dots.contains(i));
        let place = dots.iter().map(|&i| small[i].upright);
        let Some(place) = place.reduce(|a, b| a.union(b)) else {
            break;
        };
        let near = (0..bodies.len()).filter_map(|s| Some((s, gap(bodies[s]?, place))));
        let nearest = near.min_by(|a, b| a.1.total_cmp(&b.1));
        let close = |&(s, gap): &(usize, f64)| bodies[s].is_some_and(|b| gap < REACH * b.height());
        if let Some((s, _)) = nearest.filter(close) {
            wanted[s].extend(dots.iter().map(|&i| small[i].clone()));
        }
    }
    let before = all.len();
    for (slot, pieces) in layer.slots.iter_mut().zip(wanted) {
        let marked = matches!(
            Shape::of(&slot.label, &names).pieces,
            Pieces::DotAbove | Pieces::DotBelow | Pieces::Marked
        );
        let mut areas: Vec<usize> = slot.parts.iter().map(|&i| all[i].area).collect();
        areas.sort_unstable();
        areas.pop();
        areas.extend(pieces.iter().map(|c| c.area));
        let dot = areas.into_iter().max().unwrap_or(0) as f64;
        for c in pieces {
            if marked && c.area as f64 > ALIKE * dot && !astray(&c, &slot.parts, all) {
                slot.parts.push(all.len());
                all.push(c);
            }
        }
    }
    all.len() - before
}
