//! Dots and accents that are smaller than dust may be, and dust that is as large as dots: names tell them apart.
//!
//! Heavy styles have dots half as wide as their strokes. Ink below the speckle limit is too much like dust to be
//! shared out with the letters. But a letter whose name says that it has dots or an accent takes the largest such
//! piece beside it, and those like it, unless it has larger ones already; and one that is drawn in one piece has none
//! of them, but a thin end that is parted from its stroke. How large a dot is, the page's letters of one dot say.

mod dots;
mod lost;
mod pieces;
mod small;

pub(super) use lost::{reclaim, restore};
pub(super) use pieces::in_pieces;
pub(super) use small::{SMALL, groups};

use super::{Layer, Reason, Slot, bounds, gap, largest};
use crate::numeric::median::median;
use crate::scan::components::Component;
use crate::scan::letters::{Kind, Pieces, Shape};
use dots::{Dots, opposite, surplus, usual_dot};
use kurbo::{Rect, Vec2};
use pieces::{give_strokes, is_scattered, one_of_many, strayed};
use std::collections::BTreeMap;
use std::ptr;

/// Area of a dot beside that of the largest of the letter's dots at least: two of three may touch.
const ALIKE: f64 = 0.3;
/// A piece is none of its letter's dots if these are so many times as large and it lies beside the letter, by so many
/// of its widths; further off, if they are about as large.
const LARGER: [(f64, f64); 2] = [(1.5, 1.0), (0.8, 3.0)];
/// A letter of one piece has none whose side is a smaller part of its height: hairlines are thinner than dust.
const MOTE: f64 = 0.03;
/// The longer side of a dot beside its shorter one at most, and the share of its box that it covers at least: 0.5
/// where it stands on its point.
const COMPACT: (f64, f64) = (2.0, 0.4);
/// The same of dust beside a letter that has no dots: what is longer may be a short stroke of it.
const ROUND: f64 = 1.5;
/// Letters that say how large dots are on a page, or whether letters are drawn in pieces, at least.
const ENOUGH: usize = 3;
/// Letters of one piece that have specks by dust alone, of all of them at most.
const FEW: f64 = 0.25;
/// What is torn off a letter that has dots, or a sign within it, lies nearer than this share of its length.
const NEAR: f64 = 0.5;
/// The area of a stroke's piece beside the square of its width at least, straight or bent: a straight one is 2.5 times
/// as long as wide, a square has 2.25; and how far from it it lies at most, in strokes.
const STROKE: f64 = 3.6;
const TORN: f64 = 0.6;
/// The same in px at least: a gap of one is blurred to three.
const LEAST_GAP: f64 = 3.0;
/// Compact dust beside a letter of one piece is this many times as thick as its strokes at least, as
/// [`Component::stroke`] measures both: of a square that is two thirds of its side.
const BLOT: f64 = 1.3;
/// What all letters of one body have beside it is drawn where its area differs by this factor at most: dust is not
/// the same everywhere.
const SAME: f64 = 2.0;
/// Areas of grains of one page's dust differ by this factor at most.
const GRAINS: f64 = 4.0;
/// What another letter of the same body and form has beside it lies at the same place from the body's middle up to
/// this share of its height.
const PLACE: f64 = 0.1;
/// How far the dot of a zero lies from its middle at most, as a share of its width and height.
const MIDDLE: f64 = 0.1;
/// How far a dot stands off its letter, as a share of the height of the letter's body.
const REACH: f64 = 0.75;

/// Takes ink smaller than a dot out of the letters that have none, and what lies where no dot does out of those that
/// have; what a user gave to a letter stays, and so do what letters of one body have in common and what is surely
/// drawn.
pub(super) fn dust(
    layer: &mut Layer,
    all: &[Component],
    claims: &[(usize, Vec<usize>)],
    dot: f64,
    is_drawn: impl Fn(&Component) -> bool,
) {
    let drawn = layer.slots.iter().map(|s| (&s.label, s.parts.as_slice()));
    let in_pieces = in_pieces(drawn, all);
    let stray = Stray::on(layer, all);
    let page = Usual {
        in_pieces,
        with_specks: in_pieces || with_specks(layer, (all, &stray)),
        side: usual_side(layer, all),
        a_dot: usual_dot(layer, all),
        stray,
        least: dot,
    };
    let unclaimed = |s: &Slot| claims.iter().all(|c| c.0 != s.index);
    let found = layer.slots.iter().map(|slot| {
        let asked = unclaimed(slot).then_some(slot);
        asked.map_or_else(Vec::new, |slot| beside_letter(slot, all, &page))
    });
    let found: Vec<Vec<usize>> = found.collect();
    let mut drawn = drawn_alike(&layer.slots, &found, all);
    drawn.extend(drawn_again(&layer.slots, &found, all));
    for (slot, mut small) in layer.slots.iter_mut().zip(found) {
        small.retain(|i| !drawn.contains(i) && !is_drawn(&all[*i]));
        slot.parts.retain(|i| !small.contains(i));
        let small = small.into_iter().map(|i| (i, Reason::Dirt));
        layer.rejected.extend(small);
    }
}

/// What is usual among a page's letters.
struct Usual {
    /// They are drawn in pieces, or have specks beside them, that are no dust.
    in_pieces: bool,
    with_specks: bool,
    /// The longer side of a letter's body, px: no sign lies farther off.
    side: f64,
    /// The area of a dot, px².
    a_dot: Option<f64>,
    stray: Stray,
    /// The area below which ink is no larger than dust, px².
    least: f64,
}

/// Areas of a page's compact pieces that lie in no letter's cell, px².
struct Stray(Vec<usize>);

impl Stray {
    fn on(layer: &Layer, all: &[Component]) -> Self {
        let is_stray = |r: &&(usize, Reason)| matches!(r.1, Reason::Outside | Reason::Skipped);
        let stray = layer.rejected.iter().filter(is_stray);
        let compact = stray.map(|r| &all[r.0]).filter(|c| is_dot(c));
        Self(compact.map(|c| c.area).collect())
    }

    /// Whether a page has dust that is about as large as a piece.
    fn has_like(&self, c: &Component) -> bool {
        let areas = self.0.iter();
        let times = areas.map(|&area| area as f64 / c.area.max(1) as f64);
        let alike = times.filter(|t| (1.0 / GRAINS..=GRAINS).contains(t));
        alike.count() >= ENOUGH
    }
}

/// What seems to be dust in a letter's cell.
fn beside_letter(slot: &Slot, all: &[Component], usual: &Usual) -> Vec<usize> {
    let in_pieces = usual.in_pieces;
    let (shape, parts) = (slot.shape, &slot.parts);
    let Some(body) = largest(all, parts) else {
        return Vec::new();
    };
    let dots = Dots::of(&shape, (parts, all), usual.a_dot);
    let is_surplus = |c: &Component| {
        let dots = dots.as_ref().filter(|_| !in_pieces);
        dots.is_some_and(|dots| surplus(c, &shape, dots, usual.a_dot))
    };
    let is_dust = |i: usize| {
        let (c, main) = (&all[i], &all[body]);
        let dust = match shape.pieces {
            _ if i == body => false,
            // a zero may have a dot
            Pieces::One if shape.kind == Kind::Figure && centred(c, main) => false,
            Pieces::One => {
                let mote = (MOTE * main.upright.height()).powi(2);
                let small = (c.area as f64) < mote.max(usual.least);
                small && !torn(c, main)
                    || blot(c, main)
                    || apart(c, parts, all, 1.0)
                    || !usual.with_specks
                        && (speck(c, main) || grain(c, main) && usual.stray.has_like(c))
            }
            Pieces::DotAbove | Pieces::DotBelow | Pieces::Marked => {
                gap(c.upright, main.upright) > side(main).max(usual.side)
                    || astray(c, parts, all)
                    || is_surplus(c)
                    || opposite(c, &shape, parts, all)
                    || blot_by_mark(c, &shape, (main, parts), all)
                    || !usual.with_specks
                        && shape.pieces == Pieces::Marked
                        && aside(c, (main, parts), all)
            }
            Pieces::Within | Pieces::Bare => beside(c, main) && apart(c, parts, all, NEAR),
            Pieces::Unknown => false,
        };
        dust && (!in_pieces || apart(c, parts, all, 1.0))
    };
    let surely = parts.iter().filter(|&&i| i != body && !is_dust(i));
    let surely = surely.map(|&i| all[i].area);
    // the largest of many dots is a piece like the others
    let alike = is_scattered(body, parts, all).then(|| one_of_many(&all[body]));
    let least = surely.chain(alike).min().filter(|_| in_pieces);
    // of letters in pieces what is no smaller than a piece is one
    let is_piece = |i: usize| least.is_some_and(|least| all[i].area >= least);
    let mut found: Vec<usize> = match shape.pieces {
        Pieces::One if alike.is_some() && in_pieces => strayed(parts, all),
        _ => Vec::new(),
    };
    found.extend(parts.iter().filter(|&&i| is_dust(i) && !is_piece(i)));
    found
}

/// What is no dust, since all letters of one body and its forms have about as much of it.
fn drawn_alike(slots: &[Slot], found: &[Vec<usize>], all: &[Component]) -> Vec<usize> {
    let mut bodies: BTreeMap<usize, Vec<&[usize]>> = BTreeMap::new();
    for (slot, small) in slots.iter().zip(found) {
        if let Some(body) = slot.shape.skeleton() {
            bodies.entry(body).or_default().push(small);
        }
    }
    let area = |small: &[usize]| small.iter().map(|&i| all[i].area as f64).sum::<f64>();
    let is_drawn = |letters: &Vec<&[usize]>| {
        let usual = median(letters.iter().map(|s| area(s))).unwrap_or(0.0);
        let is_alike = |small: &&[usize]| area(small) > usual / SAME && area(small) < usual * SAME;
        letters.len() >= ENOUGH && letters.iter().all(is_alike)
    };
    let drawn = bodies.into_values().filter(is_drawn).flatten();
    drawn.flatten().copied().collect()
}

/// What is no dust, since another letter of the same body and form has as much at the same place, where it is none.
fn drawn_again(slots: &[Slot], found: &[Vec<usize>], all: &[Component]) -> Vec<usize> {
    // each piece beside a letter's body: which it is, how far from the body's middle in heights, and whether it seems
    // to be dust
    let mut bodies: BTreeMap<usize, Vec<(usize, Vec2, bool)>> = BTreeMap::new();
    for (slot, small) in slots.iter().zip(found) {
        let main = largest(all, &slot.parts);
        let alike = slot.shape.body;
        let Some((alike, main)) = alike.zip(main) else {
            continue;
        };
        let body = all[main].upright;
        let off = |i: usize| (all[i].upright.center() - body.center()) / body.height().max(1.0);
        let beside = slot.parts.iter().copied().filter(|&i| i != main);
        let beside = beside.map(|i| (i, off(i), small.contains(&i)));
        bodies.entry(alike).or_default().extend(beside);
    }
    let is_again = |(i, at): (usize, Vec2), pieces: &[(usize, Vec2, bool)]| {
        let mut drawn = pieces.iter().filter(|p| !p.2);
        drawn.any(|(other, place, _)| {
            let times = all[i].area as f64 / all[*other].area as f64;
            (*place - at).hypot() < PLACE && (1.0 / SAME..SAME).contains(&times)
        })
    };
    let again = bodies.values().flat_map(|pieces| {
        let small = pieces.iter().filter(|p| p.2);
        small.filter(|p| is_again((p.0, p.1), pieces)).map(|p| p.0)
    });
    again.collect()
}

/// Whether many letters of one piece have specks unlike the page's dust: then the style has them, or these are other
/// letters than their names say.
fn with_specks(layer: &Layer, (all, stray): (&[Component], &Stray)) -> bool {
    let one = |s: &&Slot| s.shape.pieces == Pieces::One;
    let asked = layer.slots.iter().filter(one).filter_map(|s| {
        let body = largest(all, &s.parts)?;
        let (others, main) = (s.parts.iter().filter(|&&i| i != body), &all[body]);
        let mut others = others.map(|&i| &all[i]);
        Some(others.any(|c| (speck(c, main) || inner(c, main)) && !stray.has_like(c)))
    });
    let asked: Vec<bool> = asked.collect();
    let specks = asked.iter().filter(|a| **a).count();
    specks as f64 > FEW * asked.len() as f64
}

/// The usual longer side of the letters' bodies, px.
fn usual_side(layer: &Layer, all: &[Component]) -> f64 {
    let bodies = layer.slots.iter().filter_map(|s| largest(all, &s.parts));
    median(bodies.map(|i| side(&all[i]))).unwrap_or(0.0)
}

/// Its longer side, px.
fn side(c: &Component) -> f64 {
    c.upright.size().max_side()
}

/// Whether a piece is a thin end of a stroke that is parted from it: a dot or dust is no stroke.
fn torn(c: &Component, body: &Component) -> bool {
    c.area as f64 > STROKE * c.stroke().powi(2) && is_close(c, body)
}

/// Whether less than a part of a stroke lies between a piece and the body.
fn is_close(c: &Component, body: &Component) -> bool {
    c.is_near(body, (TORN * body.stroke()).max(LEAST_GAP))
}

/// Whether a compact piece is thicker than any piece of its letter's strokes could be.
fn blot(c: &Component, body: &Component) -> bool {
    is_dot(c) && c.stroke() > BLOT * body.stroke()
}

/// The same of an Arabic letter that has another piece where its hamza or madda is, of strokes as thick as its own.
fn blot_by_mark(
    c: &Component,
    shape: &Shape,
    (body, parts): (&Component, &[usize]),
    all: &[Component],
) -> bool {
    let marked = shape.kind == Kind::Arabic && shape.pieces == Pieces::Marked;
    marked
        && blot(c, body)
        && dots::dots(shape, parts, all)
            .is_some_and(|(_, signs)| signs.iter().any(|o| !blot(o, body)))
}

/// Whether a small compact piece lies outside a letter's body and clear of it: what a pen's lift parts from a stroke
/// lies close to it.
fn speck(c: &Component, body: &Component) -> bool {
    is_compact(c, ROUND) && beside(c, body) && !is_close(c, body)
}

/// Whether a small compact piece may be dust by a letter on a page with dust as large, in it or close to it, too.
fn grain(c: &Component, body: &Component) -> bool {
    is_small(c, body) && is_compact(c, ROUND) && !torn(c, body)
}

/// Whether a small compact piece lies between a letter's strokes and clear of them.
fn inner(c: &Component, body: &Component) -> bool {
    let inside = body.upright.contains(c.centre);
    is_small(c, body) && is_compact(c, ROUND) && inside && !is_close(c, body)
}

/// Whether such a piece lies to the left or right of a letter whose sign, which is larger, lies over or under it.
fn aside(c: &Component, (body, parts): (&Component, &[usize]), all: &[Component]) -> bool {
    let beyond = |o: &Component| {
        let middle = o.upright.center().y;
        middle < body.upright.y0 || middle > body.upright.y1
    };
    let signs = parts.iter().map(|&i| &all[i]);
    let mut signs = signs.filter(|o| o.area > c.area && !ptr::eq(*o, body));
    speck(c, body) && !beyond(c) && signs.any(beyond)
}

/// Whether a piece lies in the middle of a letter's body.
fn centred(c: &Component, body: &Component) -> bool {
    let (off, around) = (c.upright.center() - body.upright.center(), body.upright);
    off.x.abs() < MIDDLE * around.width() && off.y.abs() < MIDDLE * around.height()
}

/// Whether a small piece lies beside a letter, over or under it, where a sign within its box does not.
fn beside(c: &Component, body: &Component) -> bool {
    !body.upright.contains(c.centre) && is_small(c, body)
}

/// Whether a piece is no larger than a dot may be.
fn is_small(c: &Component, body: &Component) -> bool {
    (c.area as f64) < SMALL * body.area as f64
}

/// Whether a compact piece lies farther from all that is larger than so many times its length: what a pen's lift
/// tears off a letter lies close to the rest, or is a stroke.
fn apart(c: &Component, parts: &[usize], all: &[Component], times: f64) -> bool {
    let mut others = parts.iter().map(|&i| &all[i]).filter(|o| o.area > c.area);
    is_dot(c) && !others.any(|o| c.is_near(o, times * side(c)))
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

/// Whether a piece is as compact as a dot is, and no stroke or ring.
fn is_dot(c: &Component) -> bool {
    is_compact(c, COMPACT.0)
}

/// Whether its longer side is less than so many times the shorter one, and it is no ring.
fn is_compact(c: &Component, times: f64) -> bool {
    let (w, h) = (c.upright.width(), c.upright.height());
    side(c) < times * w.min(h) && c.area as f64 > COMPACT.1 * w * h
}

/// Gives small pieces of ink, in no slot so far, to the letters that want them: they go to the end of `all`. Returns
/// how many. Those below `least` px² are dots only where most letters that have dots have none else.
pub(super) fn give(
    layer: &mut Layer,
    all: &mut Vec<Component>,
    mut small: Vec<Component>,
    least: f64,
) -> usize {
    let before = all.len();
    let mut smaller: Vec<_> = small.extract_if(.., |c| (c.area as f64) < least).collect();
    share_out(layer, all, &mut small);
    if lack_dots(layer) {
        share_out(layer, all, &mut smaller);
    }
    small.append(&mut smaller);
    give_strokes(layer, all, small);
    all.len() - before
}

/// Whether most letters of a body and dots are bodies alone.
fn lack_dots(layer: &Layer) -> bool {
    let dotted = |s: &&Slot| !s.parts.is_empty() && s.shape.dots > 0;
    let dotted = layer.slots.iter().filter(dotted);
    let bare: Vec<bool> = dotted.map(|s| s.parts.len() == 1).collect();
    let most = bare.iter().filter(|b| **b).count();
    bare.len() >= ENOUGH && 2 * most > bare.len()
}

/// Moves pieces of ink to the letters beside which they lie and that want them.
fn share_out(layer: &mut Layer, all: &mut Vec<Component>, small: &mut Vec<Component>) {
    let bodies = layer.slots.iter().map(|s| largest(all, &s.parts));
    let bodies = bodies.map(|body| body.map(|i| all[i].upright));
    let bodies: Vec<Option<Rect>> = bodies.collect();
    let mut wanted: Vec<Vec<usize>> = vec![Vec::new(); layer.slots.len()];
    let boxes: Vec<Rect> = small.iter().map(|c| c.upright).collect();
    // the dots of a letter go to it together
    for dots in groups(&boxes) {
        let Some(place) = bounds(small, &dots) else {
            break;
        };
        let near = (0..bodies.len()).filter_map(|s| Some((s, gap(bodies[s]?, place))));
        let nearest = near.min_by(|a, b| a.1.total_cmp(&b.1));
        let close = |&(s, gap): &(usize, f64)| bodies[s].is_some_and(|b| gap < REACH * b.height());
        if let Some((s, _)) = nearest.filter(close) {
            wanted[s].extend(dots);
        }
    }
    let mut given = vec![false; small.len()];
    for (slot, pieces) in layer.slots.iter_mut().zip(wanted) {
        let shape = slot.shape.pieces;
        let Some(body) = largest(all, &slot.parts) else {
            continue;
        };
        let others = slot.parts.iter().filter(|&&i| i != body);
        let others = others.map(|&i| all[i].area);
        let dot = others.chain(pieces.iter().map(|&k| small[k].area)).max();
        let dot = dot.unwrap_or(0) as f64;
        for k in pieces {
            let c = &small[k];
            let sign = c.area as f64 > ALIKE * dot && !astray(c, &slot.parts, all);
            given[k] = match shape {
                Pieces::One => torn(c, &all[body]),
                Pieces::DotAbove | Pieces::DotBelow | Pieces::Marked => sign,
                Pieces::Within => sign && !beside(c, &all[body]),
                Pieces::Bare | Pieces::Unknown => false,
            };
            if given[k] {
                slot.parts.push(all.len());
                all.push(c.clone());
            }
        }
    }
    let mut given = given.into_iter();
    small.retain(|_| !given.next().unwrap_or(false));
}
