//! Ink that is grain, a pencil's or a dry brush's on the paper's tooth: told, and averaged.
//!
//! Such ink is a density: its edge lies where what it is on average is half of what it is within the stroke. An
//! average over few grains varies, and one over many rounds corners off. Before it is taken all that is surely ink
//! counts alike, so that little is left that varies; the level at which such an average lies where the plain one has
//! its half is measured along the edges.

use super::paper::Paper;
use super::shading::levels;
use super::steps::{Levels, blurred};
use crate::numeric::cast::single;
use crate::numeric::median::{self, quantile};
use crate::numeric::tone::at_half;
use crate::types::Gray;
use kurbo::Vec2;
use serde::{Deserialize, Serialize};

/// What becomes of ink that is grain, as of a pencil or a dry brush.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum InkGrain {
    /// Where ink surely is such, it is averaged over as much as its grain and its strokes ask for.
    #[default]
    Soften,
    /// Its grain is followed.
    Keep,
}

impl InkGrain {
    /// How they are named on the command line and in project files.
    pub const ALL: [(&str, Self); 2] = [("soften", Self::Soften), ("keep", Self::Keep)];
}

/// A pixel and its eight neighbours differ by more than this part of the ink's level where ink is rough.
const ROUGH: f32 = 0.25;
/// Part of the ink within strokes that is rough where ink is grain: on even ink 0.14 at most, on a pencil's 0.52 to 1.
const MOST: f64 = 0.5;
/// How far slopes within strokes may go one way, of 1 for all of them: grain has 0.22 to 0.44, hatching and the edges
/// of thin or pale lines 0.46 and more.
const ONE_WAY: f64 = 0.45;
/// How far slopes within strokes may go the way of the average's, of 1 for all of them: those of grain do by 0.07 to
/// 0.26 on pages of pencil, a real one's by 0.71; those of paper's noise by 0.93, and those of fine dots by 0.98,
/// being their edges.
const ALONG: f64 = 0.85;
/// Slopes are compared within so many pixels to each side: more than a grain.
const AROUND: usize = 4;
/// What lies within strokes is told by an average over this part of their width, a Gaussian's standard deviation,
/// and reaches this part of its level there.
const WIDE: f64 = 0.25;
const WITHIN: f32 = 0.8;
/// The width of strokes that is set out from, px: averaged so, ink has hardly any holes.
const START_PX: f64 = 8.0;
/// Averages that are darker count as ink's, and of them so many are paler than its level.
const INK: f32 = 0.15;
const BELOW: f64 = 0.7;
/// Pixels that tell what ink is like.
const ENOUGH: usize = 100;
const SAMPLES: usize = 100_000;
/// Of so many rows one tells whether ink is rough at all.
const EACH_ROW: usize = 3;
/// What is darker than this part of the ink's level is surely ink: more than paper's noise and smudges.
const SURE: f32 = 0.3;
/// The standard deviation of an average, parts of the ink's level, at which its half makes no holes.
const CALM: f64 = 0.09;
/// The part of a stroke's width that ink is averaged over at most, a Gaussian's standard deviation: with a fifth
/// letters of 125 px an em are off by twice as much. Half a pixel averages nothing.
const OF_STROKE: f64 = 0.125;
const LEAST_PX: f64 = 0.7;
/// Standard deviation of the edges' places, parts of the average's. A page of pencil had 2.7, 1.6 and 1.3 times the
/// points of even ink with 0, 0.07 and this, and a mean of 1.06, 0.80 and 0.77.
const SCATTER: f64 = 0.14;
/// Averages that lie so near to half of the ink's level tell where its edge is.
const NEAR_HALF: f32 = 0.1;

/// A page of paper 0 and ink 1 whose ink is grain, averaged, and over how many px, a Gaussian's standard deviation.
/// `None` of a page of other ink; of a picture that shows more than the page its paper tells, not a table's grain.
pub(super) fn page(gray: &Gray, paper: Option<&Paper>) -> Option<(Gray, f64)> {
    averaged(gray, |x, y| paper.is_none_or(|p| p.holds(x, y)))
}

/// A drawing whose ink is grain, averaged, and over how many px, a Gaussian's standard deviation: a part of its
/// strokes' width at most. Its paper and the level of its darker ink stay. `None` of a drawing of other ink.
#[must_use]
pub fn grained(gray: &Gray) -> Option<(Gray, f64)> {
    let [paper, ink] = levels(gray)?;
    let part = gray.samples().iter().map(|v| (v - paper) / (ink - paper));
    let (even, px) = averaged(&gray.with_samples(part.collect()), |_, _| true)?;
    let level = even.samples().iter().map(|v| paper + v * (ink - paper));
    Some((even.with_samples(level.collect()), px))
}

/// The picture of paper 0 and ink 1 averaged, where the ink of the pixels that count is grain.
fn averaged(gray: &Gray, counts: impl Fn(usize, usize) -> bool) -> Option<(Gray, f64)> {
    if !is_rough(gray, &counts) {
        return None;
    }
    let strokes = Strokes::measure(gray, &counts)?;
    if strokes.rough < MOST || strokes.one_way > ONE_WAY || strokes.along > ALONG {
        return None;
    }
    let px = strokes.averaged_px();
    (px >= LEAST_PX).then(|| (even(gray, strokes.level, px, counts), px))
}

/// Whether most of the dark ink is rough; even ink is where strokes are thin, too.
fn is_rough(gray: &Gray, counts: impl Fn(usize, usize) -> bool) -> bool {
    let (mut dark, mut rough) = (0_usize, 0_usize);
    for y in (1..gray.height().saturating_sub(1)).step_by(EACH_ROW) {
        for x in 1..gray.width().saturating_sub(1) {
            if gray.at(x, y) >= 0.5 && counts(x, y) {
                dark += 1;
                rough += usize::from(range(gray, x, y) > WITHIN * ROUGH);
            }
        }
    }
    EACH_ROW * dark >= ENOUGH && rough as f64 >= MOST * dark as f64
}

/// By how much a pixel and its eight neighbours differ.
fn range(gray: &Gray, x: usize, y: usize) -> f32 {
    let rows = [y - 1, y, y + 1].map(|y| &gray.row(y)[x - 1..=x + 1]);
    let (least, most) = median::range(rows.into_iter().flatten());
    most - least
}

/// What lies within strokes.
struct Strokes {
    /// How dark it is on average.
    level: f32,
    /// Their usual width.
    width_px: f64,
    /// The part of it that is rough.
    rough: f64,
    /// How far its slopes go one way, of 1 for all of them.
    one_way: f64,
    /// How far they go the way of the average's.
    along: f64,
    /// Standard deviation of its darkness, parts of the level.
    deviation: f64,
    /// How well the darkness of a pixel tells that of the next.
    alike: f64,
}

impl Strokes {
    fn measure(gray: &Gray, counts: impl Fn(usize, usize) -> bool) -> Option<Self> {
        let mut width_px = START_PX;
        for _ in 0..2 {
            let soft = gray.with_samples(blurred(gray, WIDE * width_px));
            let most = usual(&soft, &counts)?;
            width_px = Levels { least: 0.0, most }.stroke_px(&soft)?;
        }
        let soft = gray.with_samples(blurred(gray, WIDE * width_px));
        let least = WITHIN * usual(&soft, &counts)?;
        let margin = AROUND + 1;
        let mut places = Vec::new();
        for y in margin..gray.height().saturating_sub(margin) {
            let columns = margin..gray.width().saturating_sub(margin);
            places.extend(
                columns
                    .map(|x| (x, y))
                    .filter(|&(x, y)| soft.at(x, y) > least && counts(x, y)),
            );
        }
        if places.len() < ENOUGH {
            return None;
        }
        let step = places.len().div_ceil(SAMPLES);
        let places: Vec<_> = places.into_iter().step_by(step).collect();
        let count = places.len() as f64;
        let ink = |(x, y): (usize, usize)| f64::from(gray.at(x, y));
        let level = places.iter().map(|&p| ink(p)).sum::<f64>() / count;
        let off = |p: (usize, usize)| ink(p) - level;
        let square = places.iter().map(|&p| off(p).powi(2)).sum::<f64>() / count;
        let next = places
            .iter()
            .map(|&(x, y)| off((x, y)) * off((x + 1, y)))
            .sum::<f64>()
            / count;
        let least_range = ROUGH * single(level);
        let rough = places
            .iter()
            .filter(|&&(x, y)| range(gray, x, y) > least_range);
        Some(Self {
            level: single(level),
            width_px,
            rough: rough.count() as f64 / count,
            one_way: one_way(gray, &soft, least, &places),
            along: along(gray, &soft, &places),
            deviation: square.sqrt() / level,
            alike: next / square,
        })
    }

    /// Over how much ink is averaged, a Gaussian's standard deviation, px: as much as leaves its half without holes,
    /// and no more than its strokes bear. Grain is alike over `g` px as exp(-d²/4g²).
    fn averaged_px(&self) -> f64 {
        let grain_px = (-0.25 / libm::log(self.alike.clamp(0.01, 0.99))).sqrt();
        let calm = ((self.deviation / CALM).powi(2) - 1.0).max(0.0).sqrt();
        (grain_px * calm).min(OF_STROKE * self.width_px)
    }
}

/// The level that most of the darkest samples reach, of those that count.
fn usual(soft: &Gray, counts: impl Fn(usize, usize) -> bool) -> Option<f32> {
    let rows = (0..soft.height()).flat_map(|y| (0..soft.width()).map(move |x| (x, y)));
    let inked = rows.filter(|&(x, y)| soft.at(x, y) > INK && counts(x, y));
    let mut inked: Vec<f32> = inked.map(|(x, y)| soft.at(x, y)).collect();
    quantile(&mut inked, BELOW, f32::total_cmp)
}

/// How far the slopes around places within strokes go one way, by the structure tensor: 0 where they go all ways, 1
/// where all go one. The strokes' own are taken out; within them `soft` is darker than `least`.
fn one_way(gray: &Gray, soft: &Gray, least: f32, places: &[(usize, usize)]) -> f64 {
    let grain = |x: usize, y: usize| gray.at(x, y) / soft.at(x, y).max(INK);
    let (mut one, mut all) = (0.0, 0.0);
    for &(x, y) in places {
        let [mut xx, mut xy, mut yy] = [0.0_f32; 3];
        for v in y - AROUND..=y + AROUND {
            for u in (x - AROUND..=x + AROUND).filter(|&u| soft.at(u, v) > least) {
                let dx = grain(u + 1, v) - grain(u - 1, v);
                let dy = grain(u, v + 1) - grain(u, v - 1);
                [xx, xy, yy] = [xx + dx * dx, xy + dx * dy, yy + dy * dy];
            }
        }
        one += f64::from((xx - yy).hypot(2.0 * xy));
        all += f64::from(xx + yy);
    }
    one / all.max(f64::MIN_POSITIVE)
}

/// How far the slopes at places go the way of those of the average there: 1 where all do, 0 where they go any way.
fn along(gray: &Gray, soft: &Gray, places: &[(usize, usize)]) -> f64 {
    let (mut same, mut all) = (0.0, 0.0);
    for &(x, y) in places {
        let [a, b] = [gray, soft].map(|p| {
            let across = p.at(x + 1, y) - p.at(x - 1, y);
            Vec2::new(across.into(), (p.at(x, y + 1) - p.at(x, y - 1)).into())
        });
        same += a.dot(b);
        all += a.hypot() * b.hypot();
    }
    same / all.max(f64::MIN_POSITIVE)
}

/// The picture, whose ink is grain of this level on average, averaged over so many px: 1 within strokes, a half where
/// the plain average is half of the level.
fn even(gray: &Gray, level: f32, px: f64, counts: impl Fn(usize, usize) -> bool) -> Gray {
    let plain = gray.with_samples(blurred(gray, px));
    // paper's noise keeps its two sides
    let sure = gray
        .samples()
        .iter()
        .map(|v| (v / (SURE * level)).clamp(-1.0, 1.0));
    let sure = gray.with_samples(sure.collect());
    let sure = gray.with_samples(blurred(&sure, px));
    let (mut sum, mut weight) = (0.0, 0.0);
    for y in 1..gray.height().saturating_sub(1) {
        for x in 1..gray.width().saturating_sub(1) {
            if (plain.at(x, y) / level - 0.5).abs() < NEAR_HALF && counts(x, y) {
                let dx = plain.at(x + 1, y) - plain.at(x - 1, y);
                let dy = plain.at(x, y + 1) - plain.at(x, y - 1);
                // what is flat is pale ink, or the middle of a stroke thinner than the average is wide
                let steep = f64::from(dx * dx + dy * dy);
                sum += steep * f64::from(sure.at(x, y));
                weight += steep;
            }
        }
    }
    let half = (sum / weight.max(f64::MIN_POSITIVE)).clamp(0.1, 0.9);
    let samples = sure.samples().iter().map(|v| at_half(*v, half));
    let scatter_px = gray.scatter_px().max(SCATTER * px);
    gray.with_samples(samples.collect())
        .with_scatter(scatter_px)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::coverage::blur;

    const W: usize = 320;
    const H: usize = 240;

    /// Numbers between 0 and 1 that look like chance.
    fn noise() -> impl FnMut() -> f32 {
        let mut seed = 1_u32;
        move || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as f32 / 16_777_216.0
        }
    }

    /// Upright bars, 20 of 40 px, of ink as dark as said at each place; under a lens, on paper `paper`, at most `ink`.
    fn bars(mut level: impl FnMut(usize, usize) -> f32, [paper, ink]: [f32; 2]) -> Gray {
        let mut samples = vec![0.0; W * H];
        for (i, v) in samples.iter_mut().enumerate() {
            let (x, y) = (i % W, i / W);
            if (10..30).contains(&(x % 40)) && (10..H - 10).contains(&y) {
                *v = level(x, y);
            }
        }
        blur(&mut samples, W, 0.7, 0);
        let samples = samples.iter().map(|v| paper + v * (ink - paper));
        Gray::new(W, H, samples.collect()).unwrap()
    }

    /// Grains of a pencil: two thirds of the paper's teeth have taken some.
    fn pencil(levels: [f32; 2]) -> Gray {
        let mut noise = noise();
        bars(|_, _| (1.6 * noise() - 0.4).max(0.0), levels)
    }

    /// Where ink begins and ends in a row, px.
    fn edges(gray: &Gray, y: usize, half: f32) -> Vec<f32> {
        let row = gray.row(y).windows(2).enumerate();
        let crossed = row.filter(|(_, v)| (v[0] < half) != (v[1] < half));
        crossed
            .map(|(x, v)| x as f32 + 0.5 + (half - v[0]) / (v[1] - v[0]))
            .collect()
    }

    #[test]
    fn grain_is_averaged_and_its_edge_stays() {
        for levels in [[0.0, 1.0], [0.1, 0.7]] {
            let rough = pencil(levels);
            let (even, px) = grained(&rough).expect("grain");
            assert!((LEAST_PX..=0.2 * 20.0).contains(&px), "{px}");
            let half = f32::midpoint(levels[0], even.at(20, 100));
            let (mut off, mut count) = (0.0, 0.0);
            for y in 30..H - 30 {
                let edges = edges(&even, y, half);
                assert_eq!(edges.len(), 16, "row {y}: {edges:?}");
                for (i, x) in edges.iter().enumerate() {
                    let drawn = [10.0, 30.0][i % 2] + 40.0 * (i / 2) as f32;
                    // outwards
                    off += if i % 2 == 0 { drawn - x } else { x - drawn };
                    count += 1.0;
                    assert!((x - drawn).abs() < 1.5, "row {y}: {x} for {drawn}");
                }
            }
            assert!((off / count).abs() < 0.15, "{}", off / count);
            assert!(grained(&even).is_none(), "once is enough");
        }
    }

    #[test]
    fn other_ink_stays() {
        for level in [1.0, 0.6] {
            assert!(
                grained(&bars(|_, _| level, [0.0, 1.0])).is_none(),
                "{level}"
            );
        }
        let mut paper = noise();
        let rough_paper = bars(|_, _| 0.85 + 0.3 * paper(), [0.0, 1.0]);
        assert!(grained(&rough_paper).is_none(), "rough paper");
        for small in [(0, 0), (1, 1), (2, 9), (12, 12)] {
            assert!(grained(&Gray::from_fn(small.0, small.1, |x, _| x as f32)).is_none());
        }
    }

    #[test]
    fn hatching_stays() {
        let mut noise = noise();
        // lines that are not quite even, as drawn ones
        let hatched = bars(
            |x, y| f32::from(u8::from((x + 2 * y) % 7 < 4)) * (0.8 + 0.2 * noise()),
            [0.0, 1.0],
        );
        assert!(is_rough(&hatched, |_, _| true), "as rough as grain");
        assert!(grained(&hatched).is_none());
    }

    #[test]
    fn noise_of_paper_around_fine_dots_is_no_grain() {
        let mut noise = noise();
        let mut samples: Vec<f32> = (0..W * H).map(|_| 3.1 * (noise() - 0.5)).collect();
        blur(&mut samples, W, 2.5, 0);
        for (i, v) in samples.iter_mut().enumerate() {
            let (x, y) = (i % W % 80, i / W % 80);
            *v += f32::from(u8::from(x.abs_diff(40).max(y.abs_diff(40)) <= 2));
        }
        let dots = Gray::new(W, H, samples).unwrap();
        assert!(is_rough(&dots, |_, _| true), "as rough as grain");
        assert!(averaged(&dots, |_, _| true).is_none());
    }

    #[test]
    fn fine_dots_stay() {
        let mut noise = noise();
        let mut samples: Vec<f32> = (0..W * H).map(|_| 0.1 * (noise() - 0.5)).collect();
        for (i, v) in samples.iter_mut().enumerate() {
            let (x, y) = (i % W % 20, i / W % 20);
            *v += f32::from(u8::from(x.max(y) < 8));
        }
        blur(&mut samples, W, 1.2, 0);
        let dots = Gray::new(W, H, samples).unwrap();
        assert!(is_rough(&dots, |_, _| true), "as rough as grain");
        assert!(averaged(&dots, |_, _| true).is_none());
    }

    #[test]
    fn beside_a_page_nothing_is_looked_at() {
        assert!(averaged(&pencil([0.0, 1.0]), |x, _| x < 2).is_none());
        assert!(averaged(&pencil([0.0, 1.0]), |x, _| x < 160).is_some());
    }
}
