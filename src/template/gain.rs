//! Ink gain: how printer, paper and scanner blur and spread what is black, from the strip at the page's foot.

use super::draw::{SQUARE, strip};
use super::find::Found;
use super::layout::Layout;
use crate::numeric::angles;
use crate::numeric::bilinear::bilinear;
use crate::numeric::cast::index;
use crate::types::Sheet;
use kurbo::Point;
use serde::{Deserialize, Serialize};

/// What the strip says.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Gain {
    /// Standard deviation of the edges' blur, mm.
    pub blur_mm: f64,
    /// How far black reaches beyond its true edge at half coverage, mm; negative where it shrank.
    pub spread_mm: f64,
    /// Coverage that the scan shows at a true edge: a half without spread.
    pub edge_level: f64,
}

/// How far from an edge its profile is taken. mm
const REACH: f64 = 0.6;
/// Width of a profile's bin. mm
const BIN: f64 = 0.02;
/// How far from a true edge its profile is taken for straight. mm
const MIDDLE: f64 = 0.05;
/// A level nearer to a half than this is taken for a half: following it moved weights no nearer to the truth.
const LEAST_SHIFT: f64 = 0.03;
/// The contour's level stays within this of a half: further off, thin strokes break or fill.
const MOST_SHIFT: f64 = 0.2;

impl Gain {
    /// The coverage at which contours are to run.
    #[must_use]
    pub fn level(&self) -> f64 {
        if (self.edge_level - 0.5).abs() < LEAST_SHIFT {
            return 0.5;
        }
        self.edge_level.clamp(0.5 - MOST_SHIFT, 0.5 + MOST_SHIFT)
    }
}

/// Measures the strip of a recognised page; `None` where it is hidden or too faint.
#[must_use]
pub fn gain(sheet: &Sheet, layout: &Layout, found: &Found) -> Option<Gain> {
    let at = |p: Point| {
        bilinear(
            sheet.gray.samples(),
            sheet.gray.width(),
            found.surface.at(p),
        )
    };
    let step = 0.5 / found.surface.scale(layout.gain_strip().center());
    let strip = strip(layout);
    let edges: Option<Vec<Edge>> = strip
        .squares
        .iter()
        .flat_map(|&c| (0..4).map(move |k| (c, f64::from(k) * std::f64::consts::FRAC_PI_2)))
        .map(|(centre, turn)| edge(&at, centre, turn + SQUARE.1, step))
        .collect();
    let edges = edges?;
    let mean = |of: fn(&Edge) -> f64| edges.iter().map(of).sum::<f64>() / edges.len() as f64;
    Some(Gain {
        blur_mm: mean(|e| e.variance).max(0.0).sqrt(),
        spread_mm: mean(|e| e.half),
        edge_level: mean(|e| e.level),
    })
}

/// How an edge looks.
struct Edge {
    /// Where it has half coverage, beyond its true place, mm.
    half: f64,
    /// Of its blur, mm².
    variance: f64,
    /// Coverage at its true place.
    level: f64,
}

/// The edge of a square on the side that `turn` points to.
fn edge(at: &impl Fn(Point) -> f64, centre: Point, turn: f64, step: f64) -> Option<Edge> {
    let (out, along) = (angles::direction(turn), angles::direction(turn).turn_90());
    let bins = index(2.0 * REACH / BIN);
    let mut sums = vec![[0.0f64; 2]; bins];
    let half = 0.35 * SQUARE.0;
    for i in 0..index(2.0 * half / step) {
        for k in 0..index(2.0 * REACH / step) {
            // the golden section spreads the samples of neighbouring lines over all bins
            let d = (k as f64 + (i as f64 * 0.618_034).fract()) * step - REACH;
            let t = (i as f64 + 0.5) * step - half;
            let bin = &mut sums[index((d + REACH) / BIN).min(bins - 1)];
            bin[0] += at(centre + out * (SQUARE.0 / 2.0 + d) + along * t);
            bin[1] += 1.0;
        }
    }
    let filled = sums.iter().enumerate().filter(|(_, s)| s[1] > 0.0);
    let profile: Vec<[f64; 2]> = filled
        .map(|(i, s)| [(i as f64 + 0.5) * BIN - REACH, s[0] / s[1]])
        .collect();
    if profile.len() < 8 {
        return None;
    }
    let end = profile.len() / 8;
    let mean = |p: &[[f64; 2]]| p.iter().map(|v| v[1]).sum::<f64>() / p.len() as f64;
    let (ink, paper) = (mean(&profile[..end]), mean(&profile[profile.len() - end..]));
    if ink - paper < 0.1 {
        return None;
    }
    let shade: Vec<[f64; 2]> = profile
        .iter()
        .map(|[d, v]| [*d, (v - paper) / (ink - paper)])
        .collect();
    let fall = shade
        .windows(2)
        .map(|p| [f64::midpoint(p[0][0], p[1][0]), p[0][1] - p[1][1]]);
    let (mass, first, second) = fall.fold((0.0, 0.0, 0.0), |(m, a, b), [d, w]| {
        (m + w, a + w * d, b + w * d * d)
    });
    let place = first / mass;
    let half = shade.windows(2).find(|p| p[0][1] >= 0.5 && p[1][1] < 0.5)?;
    let ([d, v], [e, w]) = (half[0], half[1]);
    Some(Edge {
        half: d + (e - d) * (v - 0.5) / (v - w),
        variance: second / mass - place * place,
        level: level_at_edge(&shade)?,
    })
}

/// Coverage at distance 0 by a straight line through the profile's middle.
fn level_at_edge(shade: &[[f64; 2]]) -> Option<f64> {
    let near = || shade.iter().filter(|[d, _]| d.abs() < MIDDLE);
    let n = near().count();
    let mean = |i: usize| near().map(|p| p[i]).sum::<f64>() / n.max(1) as f64;
    let (d, v) = (mean(0), mean(1));
    let (xy, xx) = near().fold((0.0, 0.0), |(xy, xx), p| {
        (xy + (p[0] - d) * (p[1] - v), xx + (p[0] - d) * (p[0] - d))
    });
    (n > 2).then(|| v - d * xy / xx.max(1e-12))
}
