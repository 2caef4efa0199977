//! Holes in a letter's ink that are no counters: pinholes, and places that are pale and no paper.

use crate::numeric::cast::index;
use crate::numeric::coverage::blur;
use crate::numeric::edge::blur_px;
use crate::numeric::iso::rings;
use crate::scan::components::{Component, Touch, enclosed};
use std::cell::LazyCell;

/// Coverage at which ink ends.
const HALF: f32 = 0.5;
/// Ink is pale where it is all over less than the second, and somewhere less than the first.
const PALE: (f32, f32) = (0.6, 0.7);
/// What lies within a square of this many stroke widths is a pinhole: the smallest counter of a hundred fonts, in Amiri
/// Bold's لا, has 0.40.
const PINHOLE: f64 = 0.25;
/// Pale ink so near to a stroke's edge may be the end of a slit, px.
const APART_PX: f64 = 2.0;
/// The end of a slit aslant comes apart in so many pixels at most: 271 of 279 on pages of fonts did. What is larger is
/// a dry pen's.
const END: usize = 2;
/// Paper within ink is at least this share as light as the lens that blurs the letter's edges lets it be: what is
/// darker is pale ink, or dust on it.
const LIGHT: f32 = 0.75;
/// What is no thicker, as [`Component::stroke`] measures it, may be a streak of paper whose pixels hold ink, too, px.
const CLEAR_PX: f64 = 2.5;
/// A hole's midst is where its lightest place is hardly lighter: dust has sharp edges, a counter has not.
const MIDST: f32 = 0.9;

/// Fills the holes of a picture (coverages, row-major from the top, rows of `width`) that lie within a square of
/// `stroke` px and are no counters.
pub(super) fn fill(samples: &mut [f32], width: usize, stroke: f64) {
    let pale = Picture { samples, width }.pale(stroke);
    darken(samples, width, &pale);
    let pinholes = Picture { samples, width }.pinholes(stroke);
    darken(samples, width, &pinholes);
}

/// Makes each hole as dark as the darkest ink that it touches.
fn darken(samples: &mut [f32], width: usize, holes: &[Component]) {
    for c in holes {
        let beside = |(x, y): (usize, usize)| [(x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1)];
        let around = c.pixels().flat_map(beside);
        let ink = around.fold(0.0, |ink, (x, y)| samples[y * width + x].max(ink));
        for r in &c.runs {
            samples[r.y * width..][r.start..r.end].fill(ink);
        }
    }
}

/// Its longer side, px.
fn side(c: &Component) -> f64 {
    c.bounds.size().max_side()
}

/// Coverages, row-major from the top.
struct Picture<'s> {
    samples: &'s [f32],
    width: usize,
}

impl Picture<'_> {
    fn at(&self, (x, y): (usize, usize)) -> f32 {
        self.samples[y * self.width + x]
    }

    fn size(&self) -> (usize, usize) {
        (self.width, self.samples.len() / self.width.max(1))
    }

    /// Places of less coverage than a level that ink encloses.
    fn enclosed(&self, level: f32, touch: Touch) -> Vec<Component> {
        enclosed(self.size(), touch, |x, y| self.at((x, y)) < level)
    }

    /// Paper too small for a counter, but for the ends of slits: the last pixels of one aslant have corners alone in
    /// common.
    fn pinholes(&self, stroke: f64) -> Vec<Component> {
        let mut holes = self.enclosed(HALF, Touch::Sides);
        let inside = LazyCell::new(|| self.inside(Touch::Corners));
        let ends =
            |c: &Component| c.area <= END && c.pixels().any(|(x, y)| !inside[y * self.width + x]);
        holes.retain(|c| side(c) < PINHOLE * stroke && !ends(c));
        holes
    }

    /// Pale ink that lies within a square of `stroke` px, or dust on it.
    fn pale(&self, stroke: f64) -> Vec<Component> {
        let mut pale = self.enclosed(PALE.1, Touch::Sides);
        let inside = LazyCell::new(|| self.inside(Touch::Sides));
        let lens = LazyCell::new(|| self.lens());
        pale.retain(|c| {
            side(c) < stroke
                && c.stroke() > CLEAR_PX
                && c.pixels().any(|p| self.at(p) < PALE.0)
                && !self.opens(c, &inside)
                && (side(c) < PINHOLE * stroke
                    || self.lightness(c, *lens).is_some_and(|l| l < LIGHT))
        });
        pale
    }

    /// The blur of its edges, px.
    fn lens(&self) -> f64 {
        let (width, height) = self.size();
        let or_paper = |x, y| {
            if x < width && y < height {
                self.at((x, y))
            } else {
                0.0
            }
        };
        let edges = rings((width, height), or_paper, HALF.into());
        blur_px(self.samples, self.width, edges.iter().map(Vec::as_slice))
    }

    /// Pale ink that nowhere touches such as is open to the paper around.
    fn inside(&self, touch: Touch) -> Vec<bool> {
        let mut inside = vec![false; self.samples.len()];
        let enclosed = self.enclosed(PALE.1, touch);
        let pixels = enclosed.iter().flat_map(Component::pixels);
        pixels.for_each(|(x, y)| inside[y * self.width + x] = true);
        inside
    }

    /// Whether a place may be the end of a slit: pale ink that lies not `inside` other ink comes near it.
    fn opens(&self, c: &Component, inside: &[bool]) -> bool {
        let around = c.bounds.inflate(APART_PX, APART_PX);
        let (width, height) = self.size();
        let columns = index(around.x0)..index(around.x1).min(width);
        let rows = index(around.y0)..index(around.y1).min(height);
        let mut around = rows.flat_map(|y| columns.clone().map(move |x| (x, y)));
        around.any(|(x, y)| self.at((x, y)) < PALE.1 && !inside[y * width + x])
    }

    /// How light a hole is in its midst: of paper under a lens of that blur, px, 1, of ink 0; nothing of one that is
    /// nowhere less than half ink.
    fn lightness(&self, hole: &Component, lens: f64) -> Option<f32> {
        let corner = (index(hole.bounds.x0), index(hole.bounds.y0));
        let (w, h) = (index(hole.bounds.width()), index(hole.bounds.height()));
        let light = || hole.pixels().filter(|p| self.at(*p) < HALF);
        let place = |(x, y): (usize, usize)| (y - corner.1) * w + x - corner.0;
        let mut paper = vec![0.0; w * h];
        light().for_each(|p| paper[place(p)] = 1.0);
        blur(&mut paper, w, lens, 0);
        let most = paper.iter().copied().fold(0.0, f32::max);
        let midst = light().filter(|p| paper[place(*p)] >= MIDST * most);
        let pairs = midst.map(|p| (1.0 - self.at(p), paper[place(p)]));
        let (seen, told) = pairs.fold((0.0, 0.0), |sum, p| (sum.0 + p.0, sum.1 + p.1));
        (told > 0.0).then(|| seen / told)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::cast::single;

    const SIDE: usize = 80;

    /// A block of 60 px under a lens, in whose middle coverage lacks where `light` says how much of it, from the middle.
    fn block(lens: f64, light: impl Fn(f64, f64) -> f32) -> Vec<f32> {
        let ink = |i: usize| {
            let from_middle = |v: usize| v as f64 + 0.5 - SIDE as f64 / 2.0;
            let (x, y) = (from_middle(i % SIDE), from_middle(i / SIDE));
            let inside = x.abs().max(y.abs()) < 30.0;
            if inside { 1.0 - light(x, y) } else { 0.0 }
        };
        let mut samples: Vec<f32> = (0..SIDE * SIDE).map(ink).collect();
        blur(&mut samples, SIDE, lens, 0);
        samples
    }

    /// The same with dust on its middle, which no lens blurs.
    fn dusty(lens: f64, side: f64, coverage: f32) -> Vec<f32> {
        let mut samples = block(lens, |_, _| 0.0);
        let from = index(SIDE as f64 / 2.0 - side / 2.0);
        for y in from..from + index(side) {
            samples[y * SIDE + from..][..index(side)].fill(coverage);
        }
        samples
    }

    /// The least coverage of its middle when holes are filled.
    fn middle(mut samples: Vec<f32>) -> f32 {
        fill(&mut samples, SIDE, 20.0);
        let rows = samples.chunks(SIDE).skip(20).take(40);
        rows.flat_map(|row| &row[20..60])
            .fold(1.0, |a, b| a.min(*b))
    }

    /// Eyes so small that a lens lets no pixel of them be as light as paper.
    #[test]
    fn counters_stay_however_blurred() {
        for lens in [1.5, 2.0, 3.0, 4.0] {
            let radius = 1.35 * lens + 1.0;
            let eye = block(lens, |x, y| {
                single(f64::from(u8::from(x.hypot(y) < radius)))
            });
            let mut filled = eye.clone();
            fill(&mut filled, SIDE, 20.0);
            assert_eq!(filled, eye, "a lens of {lens} px");
        }
    }

    #[test]
    fn pale_dust_is_filled_all_over() {
        for (side, coverage) in [(4.0, 0.4), (4.0, 0.57), (8.0, 0.4), (14.0, 0.45)] {
            let filled = middle(dusty(1.6, side, coverage));
            assert!(filled > 0.9, "{side} px, {coverage} dark: {filled}");
        }
    }

    #[test]
    fn ink_may_reach_the_pictures_edge() {
        let mut ink = vec![1.0; SIDE * SIDE];
        for row in ink.chunks_mut(SIDE).skip(30).take(12) {
            row[30..42].fill(0.4);
        }
        assert!(middle(ink) > 0.9);
    }

    /// Of streaks thinner than a pixel no pixel is as light as paper.
    #[test]
    fn thin_streaks_stay() {
        let streak = block(0.0, |x, y| {
            if (y - 0.5).abs() < 0.1 && x.abs() < 8.0 {
                0.55
            } else {
                0.0
            }
        });
        let mut filled = streak.clone();
        fill(&mut filled, SIDE, 20.0);
        assert_eq!(filled, streak);
    }

    /// Whose pixels, in steps along a diagonal, have no side in common with the rest.
    #[test]
    fn a_notchs_end_aslant_stays() {
        let notch = block(0.0, |x, y| match (x - 0.5, y - 0.5) {
            (x, y) if (x - y).abs() < 0.1 && (0.0..4.0).contains(&x) => 0.9,
            (x, y) if y < 0.0 && x.abs() < 2.0 => 1.0,
            _ => 0.0,
        });
        let mut filled = notch.clone();
        fill(&mut filled, SIDE, 20.0);
        assert_eq!(filled, notch);
    }

    /// Beyond a pixel of ink that noise put across the slit.
    #[test]
    fn a_slits_pale_end_stays() {
        let slit = block(0.0, |x, y| match y {
            _ if x.abs() > 2.0 => 0.0,
            6.0.. => 1.0,
            1.0..5.0 => 0.45,
            _ => 0.0,
        });
        let mut filled = slit.clone();
        fill(&mut filled, SIDE, 20.0);
        assert_eq!(filled, slit);
    }
}
