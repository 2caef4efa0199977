//! A page's pieces of ink → those that may be letters, what cannot be, and what is too small.

use super::{Reason, Rejected};
use crate::numeric::median::weighted;
use crate::scan::clean::Page;
use crate::scan::components::Component;
use crate::scan::error::Fault;
use crate::scan::options::Options;
use crate::scan::paper::Paper;
use kurbo::Rect;

/// Ink smaller than a square of this many stroke widths is a speck: the dot of a letter is a disc of at least one
/// stroke (0.89 of its side as a square), and loses a little to the threshold.
const SPECK: f64 = 0.7;
/// Ink smaller than a square of this many stroke widths is hardly a dot: those of `DejaVu Sans Bold`, the smallest of
/// a hundred fonts, have 0.52, and 0.35 where strokes are as thick as letters are high.
const DOT: f64 = 0.4;
/// And smaller than of this many it is dust in any style.
const LEAST_DOT: f64 = 0.25;
/// A printed line or lattice: its length at least and its thickness at most, as shares of the longer side of all ink.
pub(super) const LINE: (f64, f64) = (0.5, 0.02);
/// Share of its box that a printed lattice covers at most.
pub(super) const LATTICE_COVER: f64 = 0.12;
/// Share of a piece of ink that lies on the page at least.
const ON_PAPER: f64 = 0.8;

/// Share of the picture's side from which ink is long: shorter pieces weigh less than a row of letters where a page's
/// skew is measured.
const LONG: f64 = 0.25;
/// Share of a long piece that lies along the paper's end where it is the edge of what lies beside.
const ON_RIM: f64 = 0.8;

/// A page's ink.
pub(super) struct Sieved {
    /// What may be letters.
    pub(super) letters: Vec<Component>,
    /// What cannot.
    pub(super) rejected: Vec<Rejected>,
    /// What may be dots of heavy letters.
    pub(super) small: Vec<Component>,
    /// Pieces too small to be either.
    pub(super) specks: usize,
}

/// Parts the letters' ink from dust, from what lies beside the paper or runs along its edge, and from other inks.
pub(super) fn sort(all: Vec<Component>, page: &Page, options: &Options) -> Result<Sieved, Fault> {
    let gray = &page.sheet.gray;
    let (found, mut beyond): (Vec<_>, Vec<_>) = all.into_iter().partition(|c| on_paper(c, page));
    let found = take_rims(found, page, &mut beyond);
    let (mut letters, mut other) = options.ink.part(found, page.sheet.colours.as_ref());
    if letters.is_empty() && !other.is_empty() {
        return Err(Fault::OtherInk(options.ink.to_string()));
    }
    let least = speck_limit(&letters);
    let mut specks = 0;
    let mut take = |pieces: &mut Vec<Component>| -> Vec<Component> {
        let small: Vec<Component> = pieces.extract_if(.., |c| (c.area as f64) < least).collect();
        specks += small.len();
        small
    };
    let mut small = take(&mut letters);
    small.retain(|c| c.area as f64 >= least * (LEAST_DOT / SPECK).powi(2));
    take(&mut other);
    take(&mut beyond);
    let thin = SPECK * stroke_width(&letters);
    let borders = take_borders(&mut letters, (gray.width(), gray.height()), thin);
    let borders = borders.iter().map(|c| Rejected::of(c, Reason::Border));
    let other = other.iter().map(|c| Rejected::of(c, Reason::OtherInk));
    let beyond = beyond.iter().map(|c| Rejected::of(c, Reason::OffPage));
    Ok(Sieved {
        rejected: borders.chain(other).chain(beyond).collect(),
        letters,
        small,
        specks,
    })
}

/// Whether most of a piece of ink lies on the paper.
fn on_paper(c: &Component, page: &Page) -> bool {
    let Some(paper) = &page.paper else {
        return true;
    };
    held(c, paper) >= ON_PAPER * c.area as f64
}

/// Pixels of a piece of ink that lie on the paper.
fn held(c: &Component, paper: &Paper) -> f64 {
    c.pixels().filter(|&(x, y)| paper.holds(x, y)).count() as f64
}

/// Takes the edge of a lid or a table out, which stays where their middle passes for shadow; what it touches is cut
/// free.
fn take_rims(found: Vec<Component>, page: &Page, beyond: &mut Vec<Component>) -> Vec<Component> {
    let Some(paper) = &page.lit else {
        return found;
    };
    let size = (page.sheet.gray.width(), page.sheet.gray.height());
    let rim = paper.rim();
    let mut kept = Vec::new();
    for c in found {
        if !is_long(&c, size) || held(&c, &rim) < ON_RIM * c.area as f64 {
            kept.push(c);
            continue;
        }
        let mut rest = c.without(|x, y| rim.holds(x, y));
        rest.retain(|c| c.bounds.size().min_side() > rim.block_px());
        kept.extend(rest);
        beyond.push(c);
    }
    kept
}

/// The ink that tells how the page is turned: all but what is long and touches the picture's border, which need not
/// lie as the page does.
pub(super) fn telling<'a>(all: &'a [Component], page: &Page) -> Vec<&'a Component> {
    let size = (page.sheet.gray.width(), page.sheet.gray.height());
    let tells = |c: &&Component| !(is_long(c, size) && at_edge(c, size));
    let telling: Vec<&Component> = all.iter().filter(tells).collect();
    if telling.is_empty() {
        return all.iter().collect();
    }
    telling
}

/// Whether a piece of ink is long for a picture of this size.
fn is_long(c: &Component, (width, height): (usize, usize)) -> bool {
    c.bounds.width() > LONG * width as f64 || c.bounds.height() > LONG * height as f64
}

/// Area of the smallest piece of ink that may be a dot, px².
pub(super) fn speck_limit(all: &[Component]) -> f64 {
    (SPECK * stroke_width(all)).powi(2).max(2.0)
}

/// Area of the smallest dot of a usual style, px².
pub(super) fn dot_limit(stroke: f64) -> f64 {
    (DOT * stroke).powi(2)
}

/// The page's usual stroke width, px: the median over the ink, each piece by its area. Printed lines can have more
/// ink than all letters, so what is long for the page and hollow or thin does not count.
pub(super) fn stroke_width(all: &[Component]) -> f64 {
    let page = all.iter().map(|c| c.bounds).reduce(|a, b| a.union(b));
    let side = page.map_or(0.0, |p| p.size().max_side());
    let is_line = |c: &Component| {
        let size = c.bounds.size();
        let (long, short) = (size.max_side(), size.min_side());
        long > LINE.0 * side
            && (short < LINE.1 * side || (c.area as f64) < LATTICE_COVER * long * short)
    };
    let letters = all.iter().filter(|c| !is_line(c));
    weighted(letters.map(|c| (c.stroke(), c.area))).unwrap_or(1.0)
}

/// Takes out ink that touches the picture's border and reaches along half of a side, or lies within `thin` px of the
/// border: what a scanning program leaves of the table.
fn take_borders(all: &mut Vec<Component>, size: (usize, usize), thin: f64) -> Vec<Component> {
    let (w, h) = (size.0 as f64, size.1 as f64);
    let is_border = |c: &Component| {
        let Rect { x0, y0, x1, y1 } = c.bounds;
        let long = x1 - x0 > w / 2.0 || y1 - y0 > h / 2.0;
        let beside = x1 <= thin || y1 <= thin || x0 >= w - thin || y0 >= h - thin;
        at_edge(c, size) && (long || beside)
    };
    all.extract_if(.., |c| is_border(c)).collect()
}

/// Whether a piece of ink touches the border of a picture of this size.
pub(super) fn at_edge(c: &Component, (width, height): (usize, usize)) -> bool {
    let Rect { x0, y0, x1, y1 } = c.bounds;
    x0 <= 0.0 || y0 <= 0.0 || x1 >= width as f64 || y1 >= height as f64
}
