//! Pale streaks in ink, as a ballpoint leaves them along its strokes: filled.
//!
//! A streak is a valley between ink on both sides, narrower than a stroke; so are slits, narrow counters and hatching
//! that were drawn. Those go down to the paper wherever they are wide enough, and streaks hardly anywhere: they are
//! pale, in ink that is uneven itself. Which of both a picture has all of its valleys tell together. Where streaks
//! are the rule, each is filled up to the lower of its two sides.

use crate::numeric::levels::dilated;
use crate::numeric::median::{NORMAL, median};
use crate::numeric::pieces::{extent, foot, taken};
use crate::types::Gray;
use serde::{Deserialize, Serialize};

/// What becomes of pale streaks in ink, as of a ballpoint.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum InkStreaks {
    /// Where a picture's pale lines surely are such, they are filled.
    #[default]
    Fill,
    /// They stay as pale as they are.
    Keep,
}

impl InkStreaks {
    /// How they are named on the command line and in project files.
    pub const ALL: [(&str, Self); 2] = [("fill", Self::Fill), ("keep", Self::Keep)];
}

/// How far from a valley its sides are looked for, px along rows and columns, and along diagonals; and of streaks, of
/// which two may lie side by side.
const ASIDE: [[isize; 2]; 2] = [[3, 4], [2, 3]];
const FAR: [[isize; 2]; 2] = [[4, 6], [3, 4]];
/// So near to the picture's edge nothing is looked for, px.
const MARGIN: usize = 6;
/// Nor in tiles of so many px without ink in and beside them: more than the sides lie apart.
const TILE: usize = 8;
/// Its sides are ink: at least this part of its level.
const SIDE: f32 = 0.65;
/// It is paler than they are by this part of the ink's level, and by that towards its ends.
const RELIEF: f32 = 0.2;
const FAINT: f32 = 0.12;
/// And long, px along a row or column: grain is not.
const LONG: usize = 6;
/// Valleys of fewer px tell nothing, nor do those of a smaller part of the ink.
const ENOUGH: usize = 40;
const PART: f64 = 0.005;
/// Valleys are streaks' where at most this part of them is paler than this part of the ink's level: of generated
/// ballpoints 0.42 and 0.09 at 250 px an em and more, of drawn slits and hatching at 500 px an em 0.59 and 0.38 at
/// least, at 150 px 0.64 and 0.003 but for one in fifty.
const PALER: [(f32, f64); 2] = [(0.5, 0.45), (0.3, 0.1)];
/// And where they stand out by no more than so many standard deviations of the ink's level: even ink has none.
const DEVIATIONS: f64 = 7.0;
/// What is as pale as this somewhere goes down to the paper.
const PAPER: f32 = 0.2;
/// Ink so far from all that is no ink tells how even it is, px; so many samples of it at least, and at most.
const SURE: usize = 2;
const LEAST: usize = 100;
/// Streaks lie within strokes: at least this part of the ink is so far from its edges, 0.4 and more where they were
/// told, a fifth where all is as narrow as what lies between.
const WITHIN: f64 = 0.3;
const SAMPLES: usize = 100_000;

/// The picture with the streaks in its ink filled, of the levels of paper and ink given; `None` where nothing is
/// filled. Pixels that do not count tell nothing, and stay.
pub(super) fn filled(
    gray: &Gray,
    [paper, ink]: [f32; 2],
    counts: impl Fn(usize, usize) -> bool,
) -> Option<Gray> {
    // what was averaged no longer shows them as the pen left them
    if gray.scatter_px() > 0.0 {
        return None;
    }
    let seen = Seen::new(gray, [paper, ink]);
    // nearly all pictures end here
    let pale = seen.valleys((PALER[1].0, 1.0 - RELIEF), (RELIEF, ASIDE), &counts);
    if pale.len() < ENOUGH {
        return None;
    }
    let lowest = f32::NEG_INFINITY;
    let told = seen.valleys((lowest, 1.0 - RELIEF), (RELIEF, ASIDE), &counts);
    if !seen.has_streaks(&seen.long(&told).concat()) {
        return None;
    }
    let valleys = seen.long(&seen.valleys((lowest, 1.0 - FAINT), (FAINT, FAR), &counts));
    let mut samples = gray.samples().to_vec();
    for valley in valleys {
        if valley.iter().all(|v| seen.at(v.0) >= PAPER) {
            valley.iter().for_each(|v| seen.fill(v.0, &mut samples));
        }
    }
    let full = gray.with_samples(samples);
    (full != *gray).then_some(full)
}

/// A pixel between ink on both sides: its place, and how much paler it is than they are.
type Valley = (usize, f32);

/// A picture, its samples taken as parts of the ink's level.
struct Seen<'a> {
    gray: &'a Gray,
    paper: f32,
    scale: f32,
    /// whether a tile or one beside it has ink that may be a valley's side, row by row
    inked: Vec<bool>,
}

impl<'a> Seen<'a> {
    fn new(gray: &'a Gray, [paper, ink]: [f32; 2]) -> Self {
        let scale = (ink - paper).recip();
        let (across, down) = (gray.width().div_ceil(TILE), gray.height().div_ceil(TILE));
        let mut inked = vec![false; across * down];
        for y in 0..gray.height() {
            let tiles = &mut inked[y / TILE * across..][..across];
            for (tile, part) in tiles.iter_mut().zip(gray.row(y).chunks(TILE)) {
                let side = |v: &f32| (v - paper) * scale >= SIDE;
                *tile |= part.iter().fold(false, |any, v| any | side(v));
            }
        }
        Self {
            gray,
            paper,
            scale,
            inked: dilated(&inked, across, 1),
        }
    }
}

impl Seen<'_> {
    fn at(&self, place: usize) -> f32 {
        (self.gray.samples()[place] - self.paper) * self.scale
    }

    /// Steps of one pixel across a valley, and how far its sides lie in them.
    fn across(&self, [straight, diagonal]: [[isize; 2]; 2]) -> [(usize, [isize; 2]); 4] {
        let w = self.gray.width();
        [
            (1, straight),
            (w, straight),
            (w + 1, diagonal),
            (w.saturating_sub(1), diagonal),
        ]
    }

    /// How much paler a pixel is than ink on both of its sides in this direction, where it is the palest of three.
    fn relief(&self, place: usize, (step, aside): (usize, [isize; 2])) -> f32 {
        let here = self.at(place);
        // a crest of paleness
        let pale = |n: isize| -self.at(place.wrapping_add_signed(n * step.cast_signed()));
        let side = foot(-here, pale, aside).map(|foot| -foot);
        side.map_or(0.0, |side| if side < SIDE { 0.0 } else { side - here })
    }

    /// The columns of a row in which a pixel may have sides.
    fn near_ink(&self, y: usize) -> impl Iterator<Item = usize> {
        let inner = self.gray.width().saturating_sub(MARGIN);
        let across = self.gray.width().div_ceil(TILE);
        let tiles = self.inked[y / TILE * across..][..across].iter();
        let inked = tiles.enumerate().filter(|(_, inked)| **inked);
        inked.flat_map(move |(t, _)| (t * TILE).max(MARGIN)..((t + 1) * TILE).min(inner))
    }

    /// The pixels of levels between two that are valleys by `relief`, row by row.
    fn valleys(
        &self,
        (low, high): (f32, f32),
        (relief, aside): (f32, [[isize; 2]; 2]),
        counts: impl Fn(usize, usize) -> bool,
    ) -> Vec<Valley> {
        let (w, h) = (self.gray.width(), self.gray.height());
        let across = self.across(aside);
        let [low, high] = [low, high].map(|part| self.paper + part / self.scale);
        let mut out = Vec::new();
        for y in MARGIN..h.saturating_sub(MARGIN) {
            for x in self.near_ink(y) {
                let place = y * w + x;
                let v = self.gray.samples()[place];
                if v < low || v > high || !counts(x, y) {
                    continue;
                }
                let all = across.map(|way| self.relief(place, way));
                let most = all.into_iter().fold(0.0, f32::max);
                if most >= relief {
                    out.push((place, most));
                }
            }
        }
        out
    }

    /// The valleys that are long enough, each by itself.
    fn long(&self, pixels: &[Valley]) -> Vec<Vec<Valley>> {
        let w = self.gray.width();
        let mut left = vec![0.0; self.gray.samples().len()];
        pixels.iter().for_each(|v| left[v.0] = v.1);
        let each = pixels.iter().map(|v| taken(&mut left, w, v.0));
        each.filter(|valley| extent(valley, w) >= LONG).collect()
    }

    /// Whether valleys are streaks, all together.
    fn has_streaks(&self, valleys: &[Valley]) -> bool {
        let count = valleys.len() as f64;
        let inked = (0..self.gray.samples().len()).filter(|&p| self.at(p) > 0.5);
        if valleys.len() < ENOUGH || count < PART * inked.count() as f64 {
            return false;
        }
        let paler = |level: f32| valleys.iter().filter(|v| self.at(v.0) < level).count();
        if PALER
            .iter()
            .any(|&(level, most)| paler(level) as f64 > most * count)
        {
            return false;
        }
        let relief = valleys.iter().map(|v| f64::from(v.1)).sum::<f64>() / count;
        self.deviation()
            .is_some_and(|off| relief <= DEVIATIONS * off)
    }

    /// How even the ink is far from its edges: a standard deviation of its level; `None` where too little is.
    fn deviation(&self) -> Option<f64> {
        let bare: Vec<bool> = (0..self.gray.samples().len())
            .map(|p| self.at(p) < 0.5)
            .collect();
        let near = dilated(&bare, self.gray.width(), SURE);
        let ink = near.iter().enumerate().filter(|(_, near)| !**near);
        let ink: Vec<f64> = ink.map(|(p, _)| f64::from(self.at(p))).collect();
        let inked = bare.iter().filter(|bare| !**bare).count() as f64;
        if ink.len() < LEAST || (ink.len() as f64) < WITHIN * inked {
            return None;
        }
        let step = ink.len().div_ceil(SAMPLES);
        let some: Vec<f64> = ink.into_iter().step_by(step).collect();
        let level = median(some.clone())?;
        // of a normal number by the median of its distance
        median(some.into_iter().map(|v| (v - level).abs())).map(|off| NORMAL * off)
    }

    /// Fills a valley, across it in all directions in which it is one, up to the lower of its sides.
    fn fill(&self, valley: usize, samples: &mut [f32]) {
        for way in self.across(FAR) {
            if self.relief(valley, way) < FAINT {
                continue;
            }
            let (step, [_, far]) = way;
            let far = far.unsigned_abs();
            let [back, on] = [
                self.darkest(valley, (1..=far).map(|n| valley - n * step)),
                self.darkest(valley, (1..=far).map(|n| valley + n * step)),
            ];
            let to = self.at(back).min(self.at(on));
            if to < SIDE {
                continue;
            }
            let to = self.paper + to / self.scale;
            for place in (back..=on).step_by(step) {
                samples[place] = samples[place].max(to);
            }
        }
    }

    /// The darkest of places on the way from one, before the paper.
    fn darkest(&self, from: usize, places: impl Iterator<Item = usize>) -> usize {
        let inked = places.take_while(|p| self.at(*p) >= PALER[1].0);
        inked
            .max_by(|a, b| self.at(*a).total_cmp(&self.at(*b)))
            .unwrap_or(from)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::coverage::blur;

    const W: usize = 260;
    const H: usize = 120;

    /// A bar of 240 × 100 px of ink that varies by up to `rough`, with lines along it, 12 px apart, where ink is
    /// `left` of that, `wide` px: under a lens, of the levels given.
    fn lined(rough: f32, wide: f32, left: impl Fn(usize) -> f32, [paper, ink]: [f32; 2]) -> Gray {
        let mut seed = 1_u32;
        let mut samples = vec![0.0; W * H];
        for (i, v) in samples.iter_mut().enumerate() {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let (x, y) = (i % W, i / W);
            if (10..250).contains(&x) && (10..110).contains(&y) {
                let ink = 1.0 + rough * ((seed >> 8) as f32 / 8_388_608.0 - 1.0);
                let near = (y as f32 - 10.0).rem_euclid(12.0) - 6.0;
                // how much of the pixel the line holds
                let part = (near + 0.5).min(wide / 2.0) - (near - 0.5).max(-wide / 2.0);
                let lined = (30..230).contains(&x);
                let part = if lined { part.clamp(0.0, 1.0) } else { 0.0 };
                *v = ink * (1.0 - part * (1.0 - left(x)));
            }
        }
        blur(&mut samples, W, 0.9, 0);
        let samples = samples.iter().map(|v| paper + v * (ink - paper));
        Gray::new(W, H, samples.collect()).unwrap()
    }

    fn streaked(levels: [f32; 2]) -> Gray {
        let depth = |x: usize| 0.45 + 0.15 * libm::sinf(x as f32 / 9.0);
        lined(0.5, 2.5, depth, levels)
    }

    #[test]
    fn streaks_are_filled_and_paper_stays() {
        for levels in [[0.0, 1.0], [0.1, 0.75]] {
            let seen = streaked(levels);
            let even = filled(&seen, levels, |_, _| true).expect("streaks");
            let part = |gray: &Gray, x, y| (gray.at(x, y) - levels[0]) / (levels[1] - levels[0]);
            let least = |gray: &Gray| {
                let inner = (14..106).flat_map(|y| (14..246).map(move |x| (x, y)));
                inner.map(|(x, y)| part(gray, x, y)).fold(1.0, f32::min)
            };
            assert!(least(&seen) < 0.5 && least(&even) > 0.6, "{}", least(&even));
            for (x, y) in (0..H).flat_map(|y| (0..W).map(move |x| (x, y))) {
                let (before, after) = (part(&seen, x, y), part(&even, x, y));
                assert!(before <= after && after < 1.5, "{x}, {y}");
                let inked = (10..250).contains(&x) && (10..110).contains(&y);
                assert!(
                    inked || before.to_bits() == after.to_bits(),
                    "{x}, {y}: paper"
                );
            }
        }
    }

    #[test]
    fn what_was_drawn_stays() {
        let all = [0.0, 1.0];
        // slits of paper in ink as uneven, as far as they show half of it; in even ink all
        for wide in [1.6, 2.0, 3.0, 5.0] {
            assert!(
                filled(&lined(0.5, wide, |_| 0.0, all), all, |_, _| true).is_none(),
                "{wide}"
            );
        }
        for wide in [0.6, 0.8, 1.0, 1.3, 2.0, 4.0] {
            assert!(
                filled(&lined(0.1, wide, |_| 0.0, all), all, |_, _| true).is_none(),
                "{wide}"
            );
        }
        assert!(
            filled(&lined(0.5, 0.0, |_| 0.0, all), all, |_, _| true).is_none(),
            "no lines"
        );
        for (w, h) in [(0, 0), (3, 9), (9, 9), (12, 40)] {
            let small = Gray::from_fn(w, h, |x, y| (x * y % 3) as f32 / 2.0);
            assert!(filled(&small, all, |_, _| true).is_none(), "{w} × {h}");
        }
    }

    #[test]
    fn beside_a_page_nothing_is_looked_at() {
        let seen = streaked([0.0, 1.0]);
        assert!(filled(&seen, [0.0, 1.0], |x, _| x < 20).is_none());
        assert!(filled(&seen, [0.0, 1.0], |x, _| x < 200).is_some());
        let averaged = seen.with_scatter(0.2);
        assert!(filled(&averaged, [0.0, 1.0], |_, _| true).is_none());
    }
}
