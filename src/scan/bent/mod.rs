//! How a page is bent, by the lines that are printed on it.
//!
//! Lines that lead across a page are straight and parallel on it, and those of a lattice lie at equal distances. Where
//! they do not in its picture, paper and lens bend it, and everything between them with them. What one line does by
//! itself, as one drawn by hand, is no bend.

mod lines;

use super::clean::Page;
use crate::numeric::bilinear::bilinear;
use crate::numeric::cast::{index, single};
use crate::numeric::median::median;
use crate::numeric::surface::{Bend, Seen, Stiffness, Surface};
use crate::numeric::view::View;
use crate::types::Gray;
use kurbo::{Affine, Point, Rect, Size};
use lines::{Line, across, level, reduced, turned};
use nalgebra::{SMatrix, SVector};
use rayon::prelude::*;

/// The longer side of the page, mm, as bends are measured; an A4 page's.
const SIDE_MM: f64 = 297.0;
/// The same of the picture in which lines are looked for, px.
const SIDE_PX: f64 = 1300.0;
/// Lines that tell a bend.
const TELLING: usize = 4;
/// Lines that are nearer to each other are parts of one, px.
const THICK_PX: f64 = 8.0;
/// How far distances of a lattice's lines may be off whole ones, as a share.
const WHOLE: f64 = 0.1;
/// Pitches between the first and the last line from which on a cubic is fit to them.
const CUBIC: f64 = 6.0;
/// Bends by less are left: what lines lie off straight ones in the mean, mm.
const LEAST_MM: f64 = 0.05;
/// Share of its square that a bend leaves at most.
const LEFT: f64 = 0.2;
/// No paper that can be read is as steep.
const STEEPEST: f64 = 0.25;
/// Times that a bend is found: where along a line a place is follows from the bend.
const ROUNDS: usize = 3;

/// From a page's picture to the upright page, which `view` shows as if it were flat.
pub(super) fn upright(page: &Page, view: View) -> Surface {
    let plane = Plane::of(page, view);
    let bent = plane.bend(page);
    bent.map_or_else(|| view.into(), |bend| plane.bent(bend).inverse())
}

/// The upright page as it would be if it were flat.
struct Plane {
    /// To the picture.
    back: View,
    /// Its part that the picture shows, upright px.
    seen: Rect,
}

impl Plane {
    fn of(page: &Page, view: View) -> Self {
        let gray = &page.sheet.gray;
        let all = Rect::new(0.0, 0.0, gray.width() as f64, gray.height() as f64);
        let paper = page.paper().map_or(all, |p| p.bounds().intersect(all));
        Self {
            back: view.inverse(),
            seen: view.bounds(paper),
        }
    }

    /// From it to a plane whose longer side has a length, and the size of that.
    fn scaled(&self, side: f64) -> (Affine, Size) {
        let size = self.seen.size();
        let scale = side / size.max_side();
        let corner = self.seen.origin().to_vec2();
        (
            Affine::scale(scale) * Affine::translate(-corner),
            size * scale,
        )
    }

    /// From the page, which is bent, to its picture.
    fn bent(&self, bend: Bend) -> Surface {
        let (plane, _) = self.scaled(SIDE_MM);
        let flat = self.back * View::from(plane.inverse());
        &Surface::from(flat).with_bend(bend) * plane
    }

    /// How the page is bent; nothing where lines do not say so.
    fn bend(&self, page: &Page) -> Option<Bend> {
        let (_, size) = self.scaled(SIDE_MM);
        let mut spots = self.spots(page);
        if spots.is_empty() {
            return None;
        }
        let mut bend = None;
        for _ in 0..ROUNDS {
            let seen: Vec<Seen> = spots.iter().map(Spot::seen).collect();
            let found = Bend::fitted(size, &seen, Stiffness::SHARED)?;
            spots
                .iter_mut()
                .for_each(|s| s.place = found.before(s.flat));
            bend = Some(found);
        }
        let bend = bend?;
        let squares = |of: &dyn Fn(&Spot) -> f64| spots.iter().map(|s| of(s).powi(2)).sum::<f64>();
        let (off, left) = (
            squares(&Spot::by),
            squares(&|s| s.by() - s.across(bend.at(s.seen().at).to_point())),
        );
        let is_bent = off > LEAST_MM.powi(2) * spots.len() as f64 && left < LEFT * off;
        let is_slight = spots.iter().all(|s| bend.slope(s.place) < STEEPEST);
        (is_bent && is_slight).then_some(bend)
    }

    /// Places of the lines across the page and down it.
    fn spots(&self, page: &Page) -> Vec<Spot> {
        let flat = self.flat(page);
        let (rows, columns) = rayon::join(|| across(&flat), || across(&turned(&flat)));
        let mm = SIDE_MM / SIDE_PX;
        let of = |lines: &[Line], axis: usize, length: usize| {
            let levels = levels(lines, length as f64 / 2.0).into_iter();
            let spots = levels.zip(lines).flat_map(|(level, line)| {
                let at = |p: &Point| if axis == 1 { *p } else { Point::new(p.y, p.x) };
                let flat = line.places.iter().map(move |p| at(p).to_vec2() * mm);
                flat.map(move |p| Spot {
                    flat: p.to_point(),
                    place: p.to_point(),
                    level: level * mm,
                    axis,
                })
            });
            spots.collect::<Vec<Spot>>()
        };
        let mut all = of(&rows, 1, flat.width());
        all.extend(of(&columns, 0, flat.height()));
        all
    }

    /// A small picture of it, without what lies beside the paper.
    fn flat(&self, page: &Page) -> Gray {
        let gray = &page.sheet.gray;
        let (plane, size) = self.scaled(SIDE_PX);
        let small = index(self.seen.size().max_side() / SIDE_PX).max(1);
        let less = reduced(gray, small);
        let back = self.back * View::from(plane.inverse());
        let (w, h) = (index(size.width), index(size.height));
        let at = |i: usize| {
            let p = back.at(Point::new((i % w) as f64 + 0.5, (i / w) as f64 + 0.5));
            let on_page = page
                .paper()
                .is_none_or(|paper| paper.holds(index(p.x.max(0.0)), index(p.y.max(0.0))));
            let p = (p.to_vec2() / small as f64).to_point();
            let v = bilinear(less.samples(), less.width(), p);
            if on_page { single(v) } else { 0.0 }
        };
        let samples: Vec<f32> = (0..w * h).into_par_iter().map(at).collect();
        Gray::from_fn(w, h, |x, y| samples[y * w + x])
    }
}

/// A place of a printed line, mm.
#[derive(Debug, Clone, Copy)]
struct Spot {
    /// Where it was seen, if the page were flat.
    flat: Point,
    /// About where it is on the page.
    place: Point,
    /// Where its line is.
    level: f64,
    /// The coordinate that it tells: 0 for x, 1 for y.
    axis: usize,
}

impl Spot {
    fn across(&self, p: Point) -> f64 {
        if self.axis == 0 { p.x } else { p.y }
    }

    fn by(&self) -> f64 {
        self.across(self.flat) - self.level
    }

    fn seen(&self) -> Seen {
        let at = if self.axis == 0 {
            Point::new(self.level, self.place.y)
        } else {
            Point::new(self.place.x, self.level)
        };
        Seen {
            at,
            axis: self.axis,
            by: self.by(),
            weight: 1.0,
        }
    }
}

/// Where lines are on a flat page, which `middle` halves along them: at equal distances if they can be so, else where
/// each is there. Nothing of few lines.
fn levels(lines: &[Line], middle: f64) -> Vec<f64> {
    if lines.len() < TELLING {
        return Vec::new();
    }
    let found: Vec<f64> = lines.iter().map(|l| level(l, middle)).collect();
    let mut order: Vec<usize> = (0..lines.len()).collect();
    order.sort_by(|&a, &b| found[a].total_cmp(&found[b]));
    let steps: Vec<f64> = order
        .windows(2)
        .map(|w| found[w[1]] - found[w[0]])
        .collect();
    let Some(pitch) = median(steps.iter().copied().filter(|step| *step > THICK_PX)) else {
        return found;
    };
    let (mut near, mut place) = (pitch, 0.0);
    let mut places = vec![0.0; lines.len()];
    for (step, i) in steps.iter().zip(&order[1..]) {
        // none between two parts of one line
        let count = (step / near).round();
        if (step / near - count).abs() > WHOLE {
            return found;
        }
        place += count;
        places[*i] = place;
        near = if count > 0.0 { step / count } else { near };
    }
    let pitch = pitch_amid(&places, &found).unwrap_or(pitch);
    let count = lines.len() as f64;
    let mean = |all: &[f64]| all.iter().sum::<f64>() / count;
    let (at, level) = (mean(&places), mean(&found));
    places.iter().map(|p| level + pitch * (p - at)).collect()
}

/// How far lines are apart in the middle of a page, by the cubic through where they were `found`: there neither lens
/// nor bow stretch a page more one way than the other. Of few lines the straight one through them tells it.
fn pitch_amid(places: &[f64], found: &[f64]) -> Option<f64> {
    let ends = || places.iter().copied();
    let (low, high) = (ends().reduce(f64::min)?, ends().reduce(f64::max)?);
    let (middle, half) = (f64::midpoint(low, high), (high - low) / 2.0);
    let ranks = if high - low < CUBIC { 2 } else { 4 };
    let row = |p: f64| {
        SVector::<f64, 4>::from_fn(|i, _| {
            let share = (p - middle) / half;
            if i < ranks {
                (0..i).map(|_| share).product()
            } else {
                0.0
            }
        })
    };
    let (mut a, mut b) = (SMatrix::<f64, 4, 4>::zeros(), SVector::<f64, 4>::zeros());
    (ranks..4).for_each(|i| a[(i, i)] = 1.0);
    for (p, level) in places.iter().zip(found) {
        a += row(*p) * row(*p).transpose();
        b += row(*p) * *level;
    }
    let pitch = a.cholesky()?.solve(&b)[1] / half;
    pitch.is_finite().then_some(pitch)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lines 100 px apart amid a page, as a lens shows them that stretches what lies far from its middle.
    fn seen(places: &[f64]) -> Vec<Line> {
        let last = places.iter().copied().fold(0.0, f64::max);
        let at = |p: f64| {
            let off = 100.0 * (p - last / 2.0);
            500.0 + off * (1.0 + 0.02 * (off / 400.0).powi(2))
        };
        let line = |p: &f64| Line {
            places: (0..40)
                .map(|k| Point::new(25.0 * f64::from(k), at(*p)))
                .collect(),
        };
        places.iter().map(line).collect()
    }

    #[test]
    fn lines_are_as_far_apart_as_amid_the_page() {
        // one is missing, and one is seen in two parts
        let places = [0.0, 1.0, 2.0, 4.0, 5.0, 5.0, 6.0, 7.0, 8.0];
        let levels = levels(&seen(&places), 500.0);
        for (level, p) in levels.iter().zip(places) {
            let off = level - levels[0] - 100.0 * p;
            assert!(off.abs() < 0.1, "{p}: {off}");
        }
    }

    #[test]
    fn lines_at_unequal_distances_stay_where_they_are() {
        let places = [0.0, 1.0, 2.4, 3.0, 4.0];
        let lines = seen(&places);
        let levels = levels(&lines, 500.0);
        let same = levels
            .iter()
            .zip(&lines)
            .all(|(l, line)| (l - line.places[0].y).abs() < 1e-9);
        assert!(same, "{levels:?}");
    }

    #[test]
    fn few_lines_tell_nothing() {
        assert!(levels(&seen(&[0.0, 1.0, 2.0]), 500.0).is_empty());
    }
}
