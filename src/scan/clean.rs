//! Uneven light evened out: paper becomes 0 and ink 1 all over the page.
//!
//! Light multiplies: what the scanner sees is light × reflectance. The light is the paper's level ([`Field`]) and
//! divided out. One level of ink and one of noise are then measured for the whole page.

use super::error::{Fault, ScanError};
use super::grain::{self, InkGrain};
use super::light::Field;
use super::paper::Paper;
use super::shading;
use super::steps::softened;
use super::streaks::InkStreaks;
use crate::numeric::cast::{index, single};
use crate::types::{Gray, Sheet};
use rayon::prelude::*;
use std::ops::Range;

/// Standard deviations of the paper's noise above which a pixel may be ink.
const NOISE: f32 = 6.0;
/// The least contrast of ink, of the range between black and white.
const LEAST: f32 = 0.1;
/// Percentile of the inked pixels' levels that is the ink's own: below it are the strokes' blurred edges.
const INK: f64 = 0.8;
/// Share of all pixels that must be inked for a page not to be blank.
const BLANK: f64 = 2e-6;
/// Bins of the histograms, over −¼…1.
const BINS: usize = 1280;

/// A page that covers less than this share of its picture is surely surrounded by something else.
const SURROUNDED: f64 = 0.5;
/// A table's grain swallows so much of its light, and so large a share of what lies beside the page shows it: 0.5 to
/// 0.6 of wood and cloth, 0.02 of paper in a shadow with letters on it.
const GRAINY: (Range<f32>, f64) = (0.1..0.5, 0.2);

/// What becomes of ink that is not one even tone.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Texture {
    /// Of a pencil's grain.
    pub grain: InkGrain,
    /// Of a ballpoint's streaks.
    pub streaks: InkStreaks,
}

/// A page with its light evened out.
#[derive(Debug, Clone)]
pub struct Page {
    /// Coverage: paper is 0 and ink 1.
    pub sheet: Sheet,
    /// Standard deviation of the paper's noise, as a share of the ink's level.
    pub noise: f32,
    /// Over how much ink that is grain was averaged, a Gaussian's standard deviation, px; 0 of other ink.
    pub averaged_px: f64,
    /// Whether pale streaks in its ink were filled.
    pub filled: bool,
    /// What its grain and its streaks were to become.
    pub(super) texture: Texture,
    /// Where the paper lies, in a picture that shows more than it.
    pub(super) paper: Option<Paper>,
    /// The same where it may as well be what lies outside a sharp shadow: enough to know a lid's edge by.
    pub(super) lit: Option<Paper>,
}

impl Page {
    /// Where the paper lies for all that is known.
    pub(super) fn paper(&self) -> Option<&Paper> {
        self.paper.as_ref().or(self.lit.as_ref())
    }
}

/// Evens out the light of a page, of two levels once its steps are softened ([`softened`]). Where the paper covers
/// less than half of the picture, or what lies beside it is all grain, that counts for nothing.
///
/// # Errors
/// Nothing on the page is darker than its paper.
pub fn clean(sheet: Sheet, texture: Texture) -> Result<Page, ScanError> {
    let sheet = grey(sheet);
    let field = Field::measure(&sheet.gray);
    let found = field.paper(sheet.colours.as_ref());
    let seen = match found {
        Some(p) if is_surrounded(&p, &sheet.gray, &field) => (Some(p), None),
        other => (None, other),
    };
    even(sheet, &field, seen, texture)
}

/// The same the other way: what [`clean`] takes for the whole picture's paper is a page with something around it,
/// and what it takes for a page the lighter part of one, beside a shadow with a sharp edge or a fold; `None` where
/// there is no other way. For pictures that cannot be cut as they look at first.
///
/// # Errors
/// Nothing on the page is darker than its paper.
pub fn clean_otherwise(sheet: Sheet, texture: Texture) -> Result<Option<Page>, ScanError> {
    let sheet = grey(sheet);
    let field = Field::measure(&sheet.gray);
    let seen = field.paper(sheet.colours.as_ref()).map(|p| {
        if is_surrounded(&p, &sheet.gray, &field) {
            (None, Some(p))
        } else {
            (Some(p), None)
        }
    });
    seen.map(|seen| even(sheet, &field, seen, texture))
        .transpose()
}

/// Whether a page is surely surrounded by something else.
fn is_surrounded(paper: &Paper, gray: &Gray, field: &Field) -> bool {
    if paper.share < SURROUNDED {
        return true;
    }
    let rim = paper.rim();
    let is_beyond = |x, y| !paper.holds(x, y) && !rim.holds(x, y);
    let beyond = histogram(gray, field, is_beyond, step(gray));
    let grain = (0..BINS).filter(|&i| GRAINY.0.contains(&level(i)));
    let grain: usize = grain.map(|i| beyond[i]).sum();
    grain as f64 > GRAINY.1 * beyond.iter().sum::<usize>() as f64
}

/// The sheet in grey levels, softened where it has but two.
#[must_use]
pub fn grey(sheet: Sheet) -> Sheet {
    match softened(&sheet.gray) {
        Some(gray) => Sheet { gray, ..sheet },
        None => sheet,
    }
}

fn even(
    sheet: Sheet,
    field: &Field,
    (paper, lit): (Option<Paper>, Option<Paper>),
    texture: Texture,
) -> Result<Page, ScanError> {
    let (width, height) = (sheet.gray.width(), sheet.gray.height());
    let levels = Levels::measure(&sheet.gray, field, paper.as_ref())
        .ok_or_else(|| Fault::Blank.of(&sheet.source, sheet.guessed))?;
    let scatter_px = sheet.gray.scatter_px();
    let mut samples = sheet.gray.into_samples();
    let scale = 1.0 / (levels.ink - levels.paper);
    let (low, high) = (-Gray::OVERSHOOT, 1.0 + Gray::OVERSHOOT);
    let rows = samples.par_chunks_mut(width.max(1)).enumerate();
    rows.for_each_init(Vec::new, |buffer, (y, row)| {
        field.row(y, buffer);
        for (v, light) in row.iter_mut().zip(field.along(buffer)) {
            *v = ((reflected(*v, light) - levels.paper) * scale).clamp(low, high);
        }
    });
    let gray = Gray::new(width, height, samples)
        .map_err(|e| Fault::Decode(e.to_string()).of(&sheet.source, None))?
        .with_scatter(scatter_px);
    let seen = paper.as_ref().or(lit.as_ref());
    let averaged = match texture.grain {
        InkGrain::Soften => grain::page(&gray, seen),
        InkGrain::Keep => None,
    };
    let (gray, averaged_px) = averaged.unwrap_or((gray, 0.0));
    let even = shading::page(&gray, seen, texture.streaks);
    let filled = even.as_ref().is_some_and(|even| even.filled);
    let gray = even.map_or(gray, |even| even.gray);
    Ok(Page {
        sheet: Sheet { gray, ..sheet },
        noise: levels.noise * scale,
        averaged_px,
        filled,
        texture,
        paper,
        lit,
    })
}

/// Light swallowed, as a share of the light that falls on the paper there.
fn reflected(ink: f32, paper: f32) -> f32 {
    (ink - paper) / (1.0 - paper).max(LEAST)
}

/// The levels of paper and ink once the light is divided out.
struct Levels {
    paper: f32,
    ink: f32,
    noise: f32,
}

impl Levels {
    fn measure(gray: &Gray, field: &Field, paper: Option<&Paper>) -> Option<Self> {
        let counts = |x, y| paper.is_none_or(|p| p.holds(x, y));
        let histogram = histogram(gray, field, counts, step(gray));
        let peak = (0..BINS).max_by_key(|&i| histogram[i])?;
        let paper = level(peak);
        let below = (0..peak).map(|i| (f64::from(level(i) - paper).powi(2), histogram[i]));
        let (sum, count) = below.fold((0.0, 0), |(s, n), (d, k)| (s + d * k as f64, n + k));
        let noise = single((sum / (count.max(1) as f64)).sqrt());
        let least = (NOISE * noise).max(LEAST);
        let start = (peak..BINS).find(|&i| level(i) > paper + least)?;
        let inked: usize = histogram[start..].iter().sum();
        let all: usize = histogram.iter().sum();
        if (inked as f64) < (BLANK * all as f64).max(1.0) {
            return None;
        }
        let mut left = index(INK * inked as f64);
        let ink = (start..BINS).find(|&i| {
            let here = histogram[i];
            let found = left < here;
            left = left.saturating_sub(here);
            found
        })?;
        Some(Self {
            paper,
            ink: level(ink),
            noise,
        })
    }
}

/// The middle of a bin.
fn level(bin: usize) -> f32 {
    1.25 * (bin as f32 + 0.5) / BINS as f32 - 0.25
}

/// How far the samples lie apart that tell a picture's levels, px.
fn step(gray: &Gray) -> usize {
    (gray.width().min(gray.height()) / 1500).max(1)
}

/// The samples that count, of every `step`-th one of every `step`-th row, light divided out.
fn histogram(
    gray: &Gray,
    field: &Field,
    counts: impl Fn(usize, usize) -> bool + Sync,
    step: usize,
) -> Vec<usize> {
    let rows: Vec<usize> = (0..gray.height()).step_by(step).collect();
    let add = |mut sum: Vec<usize>, &y: &usize| {
        let mut buffer = Vec::new();
        field.row(y, &mut buffer);
        let pixels = gray.row(y).iter().zip(field.along(&buffer)).enumerate();
        for (x, (v, light)) in pixels.step_by(step) {
            if !counts(x, y) {
                continue;
            }
            let place = f64::from(reflected(*v, light) + 0.25) / 1.25;
            sum[index(place * BINS as f64).min(BINS - 1)] += 1;
        }
        sum
    };
    let both = |mut a: Vec<usize>, b: Vec<usize>| {
        a.iter_mut().zip(b).for_each(|(a, b)| *a += b);
        a
    };
    let none = || vec![0; BINS];
    rows.par_iter().fold(none, add).reduce(none, both)
}
