//! Lines and slits too thin to reach half coverage.
//!
//! Under a blur of deviation σ a line of width w is nowhere darker than 2 Φ(w / 2σ) − 1: at σ = 0.95 px one of 1.2 px
//! has no contour at half coverage, and one of 1.3 px has one in pieces. Its crest stands out all the same. Along
//! crests that are long enough the coverage is scaled ([`lifted`]), so that the level is passed at their sides; where
//! those really are the comparison with the picture says (`refine`). Nor do they tell what paper and ink are like
//! ([`beside`]). Short ones that join what is thick, and wider ones that grain parts, are lifted there ([`torn`]). All
//! else stays as it is.

mod torn;

use crate::{
    numeric::{
        cast::{index, single},
        levels::dilated,
        median::{NORMAL, median},
        pieces::{extent, foot, taken},
    },
    types::{Contour, Gray},
};
use std::f64::consts::SQRT_2;

/// A crest stands out by this much coverage somewhere: a line of 0.5 px under the blur of a usual scan.
const RELIEF: f32 = 0.2;
/// And by so many deviations of the grain, and of the ink in which a slit is: pale streaks of a pen are none.
const GRAIN: f32 = 6.0;
/// Ink this far from paper on all sides tells how much it varies, px; so many pixels of it at least.
const SURE: (usize, usize) = (2, 32);
/// It goes on, towards its ends, as long as it stands out by this part of that.
const FAINT: f32 = 0.6;
/// It stands out and stays below [`LOW`] for so many pixels along a row or column.
const LONG: usize = 6;
/// As a multiple of the level: grain parts a contour along a crest that is no higher.
const LOW: f32 = 1.2;
/// For so many where it grows out of what is thick: the tip of a wedge of 5° does not, and its sides tell where it
/// ends.
const TAPERED: usize = 12;
/// As a multiple of the level: what is higher is thick.
const THICK: f32 = 1.5;
/// Its sides are looked for so many deviations of the blur away: hardly anything is left of a thin line there.
const ASIDE: f64 = 2.0;
/// And so far at least, px.
const LEAST_ASIDE_PX: f64 = 2.0;
/// The contour runs at this part of a crest's height, outside of the line's sides: grain does not part it there.
const SIDES: f32 = 0.6;
/// And at this one where a line is torn, which beside that runs where it did.
const JOINED: f32 = 0.7;
/// No further from the crest than so many deviations of the blur.
const HALF_WIDTH: f64 = 1.0;
/// What is so much higher than a crest nearby is no side of it.
const HIGHER: f32 = 1.25;
/// So near to a crest a pixel tells no level, px.
const UNTOLD: usize = 3;
/// Directions across a crest, in columns and rows.
const ACROSS: [(isize, isize); 4] = [(1, 0), (0, 1), (1, 1), (1, -1)];

/// What is thin.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Thin {
    /// A line of ink.
    Line,
    /// A slit of paper.
    Slit,
}

impl Thin {
    const ALL: [Self; 2] = [Self::Line, Self::Slit];
}

/// A pixel of a crest: its index, and its height.
type Crest = (usize, f32);

/// The picture with its thin lines and slits lifted over `level`, and lines that it parts and that go on; nothing where
/// it has none. `blur_px` is the deviation of its edges.
pub(super) fn lifted(gray: &Gray, level: f64, blur_px: f64) -> Option<Gray> {
    let mut samples: Option<Vec<f32>> = None;
    for thin in Thin::ALL {
        let field = Field::new(gray, [0.0, 1.0], (thin, level), blur_px);
        let crests = field.crests();
        if !crests.is_empty() {
            let to = samples.get_or_insert_with(|| gray.samples().to_vec());
            field.lift(&crests, SIDES, blur_px, to);
        }
    }
    let lifted = samples.map(|s| gray.with_samples(s));
    let gray = lifted.as_ref().unwrap_or(gray);
    let field = Field::new(gray, [0.0, 1.0], (Thin::Line, level), blur_px);
    let torn = field.torn();
    if torn.is_empty() {
        return lifted;
    }
    let mut samples = gray.samples().to_vec();
    field.lift(&torn, JOINED, blur_px, &mut samples);
    Some(gray.with_samples(samples))
}

/// Which pixels lie beside crests of thin lines and slits, row by row; nothing where there are none. `levels` are
/// those of paper and ink, which differ.
pub(super) fn beside(gray: &Gray, levels: [f32; 2]) -> Option<Vec<bool>> {
    let blur = Contour::PIXEL_BLUR_PX;
    let crests = Thin::ALL.map(|thin| Field::new(gray, levels, (thin, 0.5), blur).crests());
    if crests.iter().all(Vec::is_empty) {
        return None;
    }
    let mut bits = vec![false; gray.samples().len()];
    crests.iter().flatten().for_each(|c| bits[c.0] = true);
    Some(dilated(&bits, gray.width(), UNTOLD))
}

/// Deviation of the grain, from neighbours in a row that are both plainly paper or both plainly ink.
fn grain(gray: &Gray, [paper, ink]: [f32; 2]) -> f32 {
    /// So near to a level nothing but grain is expected.
    const PLAIN: f32 = 0.15;
    /// Deviation of a normal number by the median of differences of two.
    const DEVIATION: f64 = NORMAL / SQRT_2;
    let plain = |v: f32| !(PLAIN..1.0 - PLAIN).contains(&v);
    let part = |v: &f32| (v - paper) / (ink - paper);
    let rows = gray.samples().chunks_exact(gray.width().max(1));
    let pairs = rows.flat_map(|row| row.iter().map(part).zip(row[1..].iter().map(part)));
    let alike = pairs.filter(|(a, b)| plain(*a) && plain(*b) && (a - b).abs() < PLAIN);
    let off = median(alike.map(|(a, b)| f64::from((a - b).abs())));
    single(off.unwrap_or(0.0) * DEVIATION)
}

/// A picture seen as ink where lines are looked for, and as paper where slits are.
struct Field<'a> {
    gray: &'a Gray,
    /// Paper and ink.
    levels: [f32; 2],
    thin: Thin,
    /// A sample that shows nothing of it, and how much more each step of a sample shows.
    none: f32,
    scale: f32,
    /// Where contours run in it.
    level: f32,
    /// Steps to the sides of a crest, across it along rows and columns, and along diagonals.
    aside: [[isize; 2]; 2],
}

impl<'a> Field<'a> {
    fn new(gray: &'a Gray, levels: [f32; 2], (thin, level): (Thin, f64), blur_px: f64) -> Self {
        let steps = |px: f64| isize::try_from(index(px)).unwrap_or(1).max(1);
        let aside = (ASIDE * blur_px).max(LEAST_ASIDE_PX);
        let (straight, diagonal) = (aside.round(), aside / SQRT_2);
        let [paper, ink] = levels;
        let (level, none, scale) = match thin {
            Thin::Line => (level, paper, (ink - paper).recip()),
            Thin::Slit => (1.0 - level, ink, (paper - ink).recip()),
        };
        Self {
            gray,
            levels,
            thin,
            none,
            scale,
            level: single(level),
            aside: [straight, diagonal].map(|px| [steps(px), steps(px + 1.0)]),
        }
    }

    /// A sample as the part of ink that it shows, or of paper.
    fn seen(&self, v: f32) -> f32 {
        (v - self.none) * self.scale
    }

    /// And back.
    fn shown(&self, part: f32) -> f32 {
        self.none + part / self.scale
    }

    /// The height so many columns and rows from a pixel; paper lies around the picture.
    fn beside(&self, (x, y): (usize, usize), (dx, dy): (isize, isize)) -> f32 {
        let (w, h) = (self.gray.width(), self.gray.height());
        let place = x.checked_add_signed(dx).filter(|x| *x < w);
        let place = place.zip(y.checked_add_signed(dy).filter(|y| *y < h));
        let sample = place.map_or(self.levels[0], |(x, y)| self.gray.samples()[y * w + x]);
        self.seen(sample)
    }

    /// How far a pixel stands out over what lies on both sides of it, where it is the highest of its neighbours
    /// across.
    fn relief(&self, (x, y): (usize, usize)) -> f32 {
        let (w, h) = (self.gray.width(), self.gray.height());
        let most = self.aside[0][1].unsigned_abs();
        let within = |v: usize, n: usize| (most..n.saturating_sub(most)).contains(&v);
        if !within(x, w) || !within(y, h) {
            return self.relief_among(|step| self.beside((x, y), step));
        }
        let at = y * w + x;
        let sample = |(dx, dy): (isize, isize)| at.wrapping_add_signed(dy * w.cast_signed() + dx);
        self.relief_among(|step| self.seen(self.gray.samples()[sample(step)]))
    }

    /// The same where `beside` gives the heights around the pixel.
    fn relief_among(&self, beside: impl Fn((isize, isize)) -> f32) -> f32 {
        let here = beside((0, 0));
        let over = |(dx, dy): (isize, isize)| {
            let steps = self.aside[usize::from(dx != 0 && dy != 0)];
            let foot = foot(here, |n| beside((n * dx, n * dy)), steps);
            foot.map_or(0.0, |foot| here - foot)
        };
        ACROSS.map(over).into_iter().fold(0.0, f32::max)
    }

    /// The pixels of long crests.
    fn crests(&self) -> Vec<Crest> {
        let w = self.gray.width();
        let low = |c: &&Crest| c.1 < LOW * self.level;
        let some = self.standing_out(RELIEF);
        let some: Vec<usize> = some.iter().filter(low).map(|c| c.0).collect();
        // nearly all pictures end here, before anything dear
        if some.len() < LONG {
            return Vec::new();
        }
        let mut map = vec![0.0; self.gray.samples().len()];
        if longest(&some, &mut map, w) < LONG {
            return Vec::new();
        }
        let relief = RELIEF.max(GRAIN * self.deviation());
        let faint = self.standing_out(FAINT * relief);
        let mut left = map.clone();
        faint.iter().for_each(|(i, height)| left[*i] = *height);
        let mut out = Vec::new();
        for (start, _) in faint {
            let crest = taken(&mut left, w, start);
            let place = |c: &Crest| (c.0 % w, c.0 / w);
            let strong = crest
                .iter()
                .filter(low)
                .filter(|c| self.relief(place(c)) >= relief);
            let strong: Vec<usize> = strong.map(|c| c.0).collect();
            let tapered = crest.iter().any(|c| self.is_thick(place(c)));
            if longest(&strong, &mut map, w) >= if tapered { TAPERED } else { LONG } {
                out.extend(crest);
            }
        }
        out
    }

    /// Whether a crest's pixel lies beside what is no thin line.
    fn is_thick(&self, at: (usize, usize)) -> bool {
        let around = ACROSS.iter().flat_map(|&(x, y)| [(x, y), (-x, -y), (0, 0)]);
        around
            .map(|step| self.beside(at, step))
            .any(|v| v > THICK * self.level)
    }

    /// Deviation of what a crest stands out from.
    fn deviation(&self) -> f32 {
        let grain = grain(self.gray, self.levels);
        if self.thin == Thin::Line {
            return grain;
        }
        let paper: Vec<bool> = self
            .gray
            .samples()
            .iter()
            .map(|v| self.seen(*v) > 0.5)
            .collect();
        let near = dilated(&paper, self.gray.width(), SURE.0);
        let ink = self
            .gray
            .samples()
            .iter()
            .zip(near)
            .filter(|(_, near)| !near);
        let off: Vec<f64> = ink.map(|(v, _)| f64::from(self.seen(*v)).abs()).collect();
        if off.len() < SURE.1 {
            return f32::INFINITY;
        }
        grain.max(single(NORMAL * median(off).unwrap_or(0.0)))
    }

    /// The pixels that stand out by `relief` and do not reach far over the level.
    fn standing_out(&self, relief: f32) -> Vec<Crest> {
        /// Pixels that are looked at together: most are plain ink or paper.
        const TOGETHER: usize = 16;
        let w = self.gray.width();
        let [low, high] = [relief, self.level / SIDES].map(|part| self.shown(part));
        let (low, high) = (low.min(high), low.max(high));
        let within = |v: &f32| (low <= *v) & (*v <= high);
        let mut out = Vec::new();
        let samples = self.gray.samples().chunks(TOGETHER).enumerate();
        for (k, some) in samples.filter(|(_, s)| s.iter().fold(false, |any, v| any | within(v))) {
            let pixels = (k * TOGETHER..).zip(some).filter(|(_, v)| within(v));
            let some = pixels.filter(|(i, _)| self.relief((i % w, i / w)) >= relief);
            out.extend(some.map(|(i, v)| (i, self.seen(*v))));
        }
        out
    }

    /// Scales what lies around crests up to where the level is passed at this part of their height.
    fn lift(&self, crests: &[Crest], part: f32, blur_px: f64, samples: &mut [f32]) {
        let (w, h) = (self.gray.width(), self.gray.height());
        let reach = index((HALF_WIDTH * blur_px).round()).max(1);
        for &(i, height) in crests {
            let by = (self.level / (part * height)).max(1.0);
            for y in (i / w).saturating_sub(reach)..(i / w + reach + 1).min(h) {
                for x in (i % w).saturating_sub(reach)..(i % w + reach + 1).min(w) {
                    let here = self.beside((x, y), (0, 0));
                    if here <= HIGHER * height {
                        let to = &mut samples[y * w + x];
                        *to = self.shown(self.seen(*to).max((by * here).min(1.0)));
                    }
                }
            }
        }
    }
}

/// The largest extent of connected pixels among some, on an empty map.
fn longest(pixels: &[usize], map: &mut [f32], w: usize) -> usize {
    pixels.iter().for_each(|&i| map[i] = 1.0);
    let extents = pixels.iter().map(|&i| extent(&taken(map, w, i), w));
    extents.max().unwrap_or(0)
}
