//! How a picture differs from the blurred fill of polygons, and how far an edge must move for it.

use crate::{
    numeric::{
        cast::{ceiling, index},
        coverage::{Coverage, blur, kernel},
        levels::normalised,
        median::median,
    },
    types::{Contour, Gray},
};
use kurbo::{Affine, Line, ParamCurveNearest, Point, Rect, Vec2};
use std::{borrow::Cow, f64::consts::TAU, iter::successors, ops::Range};

/// The neighbourhood that moves an edge is at least this wide, px: narrower, it would hang on the one
/// pixel that happens to be next.
const MIN_SPREAD_PX: f64 = 0.6;

/// Deviation of the average along the contour, in points a pixel of the lens' blur.
const AVERAGE: f64 = 5.0;
/// Mean of the squares of a normal number by their median.
const MEDIAN_OF_SQUARES: f64 = 2.198;
/// Mean square that an edge off by the lens' own deviation leaves where it is neither ink nor paper is 0.1, by the
/// squared slope of its profile. Half of it keeps the steps of two levels from being followed; more leaves bends
/// unmended.
const ACROSS: f64 = 0.05;

/// A patch of ink before the lens: how much, px², where, and its variances along a direction and across it, px².
pub(super) struct Blot {
    ink: f64,
    at: Point,
    along: Vec2,
    variance: [f64; 2],
}

impl Blot {
    /// What lies between a tip and the chords that cut it off, whose first and last points are on its sides;
    /// `along` is a unit vector.
    pub(super) fn between(tip: Point, cut: &[Point], along: Vec2) -> Self {
        let across = perp(along);
        let local = |p: &Point| ((*p - tip).dot(along), (*p - tip).dot(across));
        let (mut area, mut first, mut second) = (0.0, (0.0, 0.0), (0.0, 0.0));
        // triangles that the tip makes with the chords
        for (a, b) in cut.iter().map(local).zip(cut.iter().skip(1).map(local)) {
            let part = 0.5 * (a.0 * b.1 - a.1 * b.0);
            let square = |a: f64, b: f64| (a * a + b * b + (a + b) * (a + b)) / 12.0;
            area += part;
            first.0 += part * (a.0 + b.0) / 3.0;
            first.1 += part * (a.1 + b.1) / 3.0;
            second.0 += part * square(a.0, b.0);
            second.1 += part * square(a.1, b.1);
        }
        let whole = if area.abs() > 1e-12 { area } else { 1.0 };
        let mean = (first.0 / whole, first.1 / whole);
        Self {
            ink: area.abs(),
            at: tip + mean.0 * along + mean.1 * across,
            along,
            variance: [
                second.0 / whole - mean.0 * mean.0,
                second.1 / whole - mean.1 * mean.1,
            ]
            .map(|v| v.max(0.0)),
        }
    }
}

/// Picture minus model.
#[derive(Debug)]
pub(super) struct Residual<'g> {
    gray: &'g Gray,
    /// from px of the outlines, which stand upright, to those of the picture, y up
    to_picture: Affine,
    /// its coverage, ink and paper levelled
    seen: Cow<'g, Gray>,
    /// picture minus model, row by row from the top
    off: Vec<f32>,
    /// fill of the polygons, before the lens
    fill: Coverage,
    /// deviation of the lens' blur alone, px
    lens: f64,
    /// deviation of the neighbourhood's weights, px
    spread: f64,
    /// shift of a straight edge, px, for a weighted mean difference of 1
    gain: f64,
}

impl<'g> Residual<'g> {
    /// The picture against the fill of `rings`, both blurred by `blur_px` with the pixel's own box.
    pub(super) fn new<'r>(
        gray: &'g Gray,
        rings: impl Iterator<Item = &'r [Point]>,
        blur_px: f64,
    ) -> Self {
        let mut residual = Self::drawn(gray, rings, blur_px);
        // with the edges known, pixels up to them say what ink and paper are
        let seen = normalised(gray.samples(), gray.width(), &residual.off);
        residual.seen = Cow::Owned(gray.with_samples(seen));
        residual.compare();
        residual
    }

    /// The same with the picture's levels as they are: what the rings leave out passes for no level.
    pub(super) fn as_seen<'r>(
        gray: &'g Gray,
        rings: impl Iterator<Item = &'r [Point]>,
        blur_px: f64,
    ) -> Self {
        let mut residual = Self::drawn(gray, rings, blur_px);
        residual.compare();
        residual
    }

    /// The model in place of the differences.
    fn drawn<'r>(gray: &'g Gray, rings: impl Iterator<Item = &'r [Point]>, blur_px: f64) -> Self {
        let pixel = Contour::PIXEL_BLUR_PX;
        let lens = (blur_px * blur_px - pixel * pixel).max(0.0).sqrt();
        let spread = blur_px.max(MIN_SPREAD_PX);
        let to_picture = gray.to_pixels();
        let mut fill = Coverage::new(gray.width(), gray.height()).mapped(to_picture);
        let mut off = Vec::new();
        draw(rings, (&mut fill, &mut off), lens);
        Self {
            gray,
            to_picture,
            seen: Cow::Borrowed(gray),
            off,
            fill,
            lens,
            spread,
            // a straight edge moved by 1 px changes the pixels by its own profile's slope, a Gaussian of
            // `blur_px`, of which the weights see one of both deviations together
            gain: TAU.sqrt() * blur_px.hypot(spread),
        }
    }
}

impl Residual<'_> {
    /// The same picture and levels against other rings.
    pub(super) fn against<'r>(&self, rings: impl Iterator<Item = &'r [Point]>) -> Residual<'_> {
        let mut residual = Residual {
            seen: Cow::Borrowed(&*self.seen),
            off: Vec::new(),
            fill: Coverage::new(self.seen.width(), self.seen.height()).mapped(self.to_picture),
            ..*self
        };
        residual.update(rings);
        residual
    }

    /// The levels of ink and paper once more, from the pixels that the rings as they are now leave to one of them.
    /// Pixels along the lines `open` tell nothing.
    pub(super) fn level(&mut self, open: impl Iterator<Item = Line>) {
        /// Half the width of those lines, px.
        const OPEN_PX: f64 = 2.0;
        let (w, h) = (self.seen.width(), self.seen.height());
        // the model again
        self.compare();
        let mut told = Cow::Borrowed(&self.off);
        for line in open.map(|line| self.to_picture * line) {
            let around = Rect::from_points(line.p0, line.p1).inflate(OPEN_PX, OPEN_PX);
            let span = |from: f64, to: f64, n: usize| index(from)..index(to + 1.0).min(n);
            for y in span(h as f64 - around.y1, h as f64 - around.y0, h) {
                for x in span(around.x0, around.x1, w) {
                    let p = Point::new(x as f64 + 0.5, (h - y) as f64 - 0.5);
                    if line.nearest(p, 0.0).distance_sq < OPEN_PX * OPEN_PX {
                        told.to_mut()[y * w + x] = 0.5;
                    }
                }
            }
        }
        let seen = normalised(self.gray.samples(), w, &told);
        self.seen = Cow::Owned(self.gray.with_samples(seen));
        self.compare();
    }

    /// The same picture against other rings that hardly differ: levels of ink and paper stay.
    pub(super) fn update<'r>(&mut self, rings: impl Iterator<Item = &'r [Point]>) {
        draw(rings, (&mut self.fill, &mut self.off), self.lens);
        self.compare();
    }

    /// From the model to the differences.
    fn compare(&mut self) {
        let pairs = self.off.iter_mut().zip(self.seen.samples());
        pairs.for_each(|(model, seen)| *model = seen - *model);
    }

    /// Weights by which shifts of neighbouring points are averaged, from the point itself outwards.
    ///
    /// The iso-contour is off by what changes slowly along it; what changes fast is the grain, which a lens
    /// makes worse to undo. Without a lens there is nothing to average.
    pub(super) fn kernel(&self) -> Vec<f64> {
        let sigma = self.lens * AVERAGE;
        let weight = |i: usize| libm::exp(-0.5 * (i as f64 / sigma.max(0.1)).powi(2));
        (0..=index(2.5 * sigma)).map(weight).collect()
    }

    /// The picture's coverage, ink and paper levelled.
    pub(super) fn seen(&self) -> &Gray {
        &self.seen
    }

    /// The same against rings that have changed within `changed`, px, y up; each with its bounds and as a line that
    /// comes back to its start. By how much the sum of squared differences grows.
    pub(super) fn redraw<'r>(
        &mut self,
        changed: Rect,
        rings: impl Iterator<Item = (Rect, &'r [Point])>,
    ) -> f64 {
        let (w, h) = (self.seen.width(), self.seen.height());
        let margin = kernel(self.lens).len();
        let span = |from: f64, to: f64, n: usize| {
            let from = index(from.max(0.0)).saturating_sub(2 * margin);
            from..index(to.max(0.0)).saturating_add(1 + 2 * margin).min(n)
        };
        let changed = self.to_picture.transform_rect_bbox(changed);
        let columns = span(changed.x0, changed.x1, w);
        let rows = span(h as f64 - changed.y1, h as f64 - changed.y0, h);
        let origin = Vec2::new(columns.start as f64, (h - rows.end) as f64);
        if columns.is_empty() || rows.is_empty() {
            return 0.0;
        }
        let to_part = Affine::translate(-origin) * self.to_picture;
        let mut fill = Coverage::new(columns.len(), rows.len()).mapped(to_part);
        let size = (columns.len() as f64, rows.len() as f64);
        let part = Rect::from_origin_size(origin.to_point(), size);
        let around = self.to_picture.inverse().transform_rect_bbox(part);
        let near = rings.filter(|(bounds, _)| bounds.overlaps(around));
        near.for_each(|(_, ring)| fill.line(ring));
        let mut model = fill.samples();
        blur(&mut model, columns.len(), self.lens, 0);
        // what is missing beyond the picture's own sides is paper
        let inner = |all: &Range<usize>, n: usize| {
            let to = if all.end == n { n } else { all.end - margin };
            let from = all.start + if all.start == 0 { 0 } else { margin };
            from.min(to)..to
        };
        let (to_columns, to_rows) = (inner(&columns, w), inner(&rows, h));
        let mut grown = 0.0;
        for y in to_rows {
            let from = (y - rows.start) * columns.len() + to_columns.start - columns.start;
            let at = y * w + to_columns.start;
            let model = &model[from..][..to_columns.len()];
            let pairs = self.off[at..].iter_mut().zip(&self.seen.samples()[at..]);
            for ((off, seen), model) in pairs.zip(model) {
                let now = seen - model;
                grown += f64::from(now * now - *off * *off);
                *off = now;
            }
        }
        grown
    }

    /// Deviation of the lens' blur alone, px.
    pub(super) const fn lens_px(&self) -> f64 {
        self.lens
    }

    /// From px of the outlines to those of the picture, y up.
    pub(super) const fn to_picture(&self) -> Affine {
        self.to_picture
    }

    /// A place in pixels from the first one's centre, y down, and the columns and rows within `reach` px of it.
    fn around(&self, p: Point, reach: f64) -> ((f64, f64), [Range<usize>; 2]) {
        let p = self.to_picture * p;
        let (w, h) = (self.seen.width(), self.seen.height());
        let (cx, cy) = (p.x - 0.5, h as f64 - p.y - 0.5);
        let span = |c: f64, n: usize| ceiling(c - reach)..index(c + reach + 1.0).min(n);
        ((cx, cy), [span(cx, w), span(cy, h)])
    }

    /// How much of a blot of ink the picture has and the model lacks, as a part of it.
    pub(super) fn lacking(&self, blot: &Blot) -> f64 {
        let (seen, whole) = self.weighed(blot);
        seen / whole.max(1e-12)
    }

    /// By how much squares would fall with the best part of a blot of ink more; negative where it is ink less.
    pub(super) fn gain(&self, blot: &Blot) -> f64 {
        let (seen, whole) = self.weighed(blot);
        seen * seen.abs() / whole.max(1e-12)
    }

    /// The differences weighed by what the lens makes of a blot, and that weighed by itself.
    fn weighed(&self, blot: &Blot) -> (f64, f64) {
        let along = (self.to_picture * blot.along.to_point()) - (self.to_picture * Point::ORIGIN);
        let across = perp(along);
        let pixel = Contour::PIXEL_BLUR_PX;
        let [va, vc] = blot
            .variance
            .map(|v| v + self.lens * self.lens + pixel * pixel);
        let height = blot.ink / (TAU * (va * vc).sqrt());
        let reach = 3.0 * va.max(vc).sqrt();
        let ((cx, cy), [columns, rows]) = self.around(blot.at, reach);
        let (mut seen, mut whole) = (0.0, 0.0);
        for y in rows {
            for x in columns.clone() {
                let d = Vec2::new(x as f64 - cx, cy - y as f64);
                let (a, c) = (d.dot(along), d.dot(across));
                let pattern = height * libm::exp(-0.5 * (a * a / va + c * c / vc));
                seen += pattern * f64::from(self.off[y * self.seen.width() + x]);
                whole += pattern * pattern;
            }
        }
        (seen, whole)
    }

    /// Sum of all squared differences.
    pub(super) fn all_squares(&self) -> f64 {
        self.off.iter().map(|off| f64::from(off * off)).sum()
    }

    /// Sum of the squared differences within `reach` px of `p`.
    pub(super) fn squares(&self, p: Point, reach: f64) -> f64 {
        let (_, [columns, rows]) = self.around(p, reach);
        let rows = rows.map(|y| y * self.seen.width());
        let pixels = rows.flat_map(|row| columns.clone().map(move |x| row + x));
        pixels.map(|i| f64::from(self.off[i] * self.off[i])).sum()
    }

    /// Mean square of the differences in the pixels along a polygon.
    pub(super) fn along(&self, ring: &[Point]) -> f64 {
        let (mut sum, mut length) = (0.0, 0.0);
        for (a, b) in ring.iter().zip(ring.iter().cycle().skip(1)) {
            let d = a.distance(*b);
            let p = self.to_picture * a.midpoint(*b);
            let (x, y) = (p.x, self.seen.height() as f64 - p.y);
            let x = index(x).min(self.seen.width().saturating_sub(1));
            let off = self.off.get(index(y) * self.seen.width() + x);
            let off = off.map_or(0.0, |off| f64::from(*off));
            sum += d * off * off;
            length += d;
        }
        sum / f64::max(length, 1e-12)
    }

    /// Mean square of the differences at edges: the grain, and what the model misses.
    pub(super) fn grain(&self) -> f64 {
        let pairs = self.off.iter().zip(self.seen.samples());
        let edge = pairs.filter(|(off, seen)| (0.1..0.9).contains(&(**seen - **off)));
        let squares = edge.map(|(off, _)| f64::from(off * off));
        let seen = MEDIAN_OF_SQUARES * median(squares).unwrap_or(0.0);
        let off = self.seen.scatter_px() / self.lens.max(Contour::PIXEL_BLUR_PX);
        seen.max(ACROSS * off * off)
    }

    /// Radius of the neighbourhood that moves an edge, px.
    pub(super) fn reach_px(&self) -> f64 {
        2.5 * self.spread
    }

    /// Whether no other edge shares the neighbourhood of one through `p`; `outward` is its unit normal.
    pub(super) fn is_alone(&self, p: Point, outward: Vec2) -> bool {
        /// What is ink, and what is paper.
        const PLAIN: (f32, f32) = (0.9, 0.1);
        let (w, h) = (self.seen.width(), self.seen.height());
        let model = |q: Point| {
            let q = self.to_picture * q;
            let inside = (0.0..w as f64).contains(&q.x) && (0.0..h as f64).contains(&q.y);
            let at = inside.then(|| (h - 1 - index(q.y)) * w + index(q.x));
            at.map_or(0.0, |i| self.seen.samples()[i] - self.off[i])
        };
        let way = self.reach_px() * outward;
        model(p - way) > PLAIN.0 && model(p + way) < PLAIN.1
    }

    /// How far outwards an edge through `p` must move, px; linear, good for fractions of a pixel.
    pub(super) fn shift(&self, p: Point) -> f64 {
        let w = self.seen.width();
        let ((cx, cy), [columns, rows]) = self.around(p, self.reach_px());
        let across = self.bell(columns.start as f64 - cx);
        let (mut sum, mut total) = (0.0, 0.0);
        for (y, wy) in rows.clone().zip(self.bell(rows.start as f64 - cy)) {
            // a place outside the picture has none
            let row = self.off[y * w..(y + 1) * w].get(columns.clone());
            let line = row.into_iter().flatten().zip(across.clone());
            let line = line.fold((0.0, 0.0), |(sum, total), (off, wx)| {
                (sum + wx * f64::from(*off), total + wx)
            });
            sum += wy * line.0;
            total += wy * line.1;
        }
        if total > 0.0 {
            self.gain * sum / total
        } else {
            0.0
        }
    }

    /// Weights at distance `d`, `d` + 1, `d` + 2 … px of a place.
    fn bell(&self, d: f64) -> impl Iterator<Item = f64> + Clone {
        let narrow = (self.spread * self.spread).recip();
        let first = libm::exp(-0.5 * d * d * narrow);
        // each is the one before it times what itself shrinks evenly
        let (ratio, shrink) = (libm::exp(-(d + 0.5) * narrow), libm::exp(-narrow));
        let next = move |(w, ratio): &(f64, f64)| Some((w * ratio, ratio * shrink));
        successors(Some((first, ratio)), next).map(|(w, _)| w)
    }
}

/// The blurred fill of rings.
fn draw<'r>(
    rings: impl Iterator<Item = &'r [Point]>,
    (fill, model): (&mut Coverage, &mut Vec<f32>),
    lens: f64,
) {
    fill.clear();
    rings.for_each(|r| fill.add(r));
    fill.write(model);
    blur(model, fill.width(), lens, 0);
}

fn perp(v: Vec2) -> Vec2 {
    Vec2::new(-v.y, v.x)
}
