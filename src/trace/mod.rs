//! Picture → Contours: at half coverage, subpixel, or along the boundary pixels.
//!
//! | takes | gives |
//! |---|---|
//! | [`Gray`], px, y down, 1 = ink | [`Contour`]s, px, y up, origin at the picture's bottom left, ink on the left |
//!
//! What follows holds for [`Boundary::Iso`]. The contours come in the order in which a reader meets them,
//! row by row from the top. They neither
//! cross nor touch. Every ink component and every hole above the speckle limit is there, and so are lines and
//! slits whose crest never reaches the level, where it stands out for 6 px (`thin`).

mod chain;
mod edge;
mod iso;
mod levels;
mod ragged;
#[cfg(test)]
mod tests;
mod thin;

use crate::{
    numeric::cast::index,
    types::{Contour, Gray},
};
use kurbo::Point;
use serde::{Deserialize, Serialize};

pub use levels::level;

/// Options of the contour tracer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Options {
    /// Coverage at which the contour runs, 0…1.
    pub level: f64,
    /// Ink and holes of a smaller area are dust, px².
    pub speckle_px2: f64,
    /// What the contour runs along.
    pub boundary: Boundary,
}

/// What a contour runs along.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Boundary {
    /// The line of equal coverage between the pixels' centres.
    Iso,
    /// The centres of the boundary pixels, 8-connected: the chain code of [rasheed05 sec. 4.1.1].
    Chain,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            level: 0.5,
            // a blot of 2 × 2 px: no scanner resolves a drawn mark that small
            speckle_px2: 4.0,
            boundary: Boundary::Iso,
        }
    }
}

/// Distance between neighbouring points, px: a little denser than the pixels they come from.
const SPACING_PX: f64 = 0.8;
/// Even the smallest ring has this many points.
const MIN_POINTS: usize = 16;

/// The contours of a picture's ink, evenly sampled, with the blur of the picture's edges.
#[must_use]
pub fn trace(gray: &Gray, options: &Options) -> Vec<Contour> {
    let rings = match options.boundary {
        Boundary::Iso => iso::rings(gray, options.level),
        Boundary::Chain => {
            let rings = chain::rings(gray, options.level).into_iter();
            return large(rings, options).collect();
        }
    };
    let mut even: Vec<Contour> = large(rings.into_iter(), options)
        .filter_map(spaced)
        .collect();
    let blur = edge::blur_px(gray, &even);
    if let Some(lifted) = thin::lifted(gray, options.level, blur) {
        let rings = iso::rings(&lifted, options.level).into_iter();
        even = large(rings, options).filter_map(spaced).collect();
    }
    let ragged = ragged::ragged_px(&even);
    let told = |c: Contour| c.with_blur(blur).with_ragged(ragged);
    even.into_iter().map(told).collect()
}

/// The contours of rings that are no dust.
fn large<'o>(
    rings: impl Iterator<Item = Vec<Point>> + 'o,
    options: &'o Options,
) -> impl Iterator<Item = Contour> + 'o {
    let contours = rings.filter_map(|r| Contour::new(r).ok());
    contours.filter(|c| c.area().abs() >= options.speckle_px2)
}

/// The contour with points [`SPACING_PX`] apart.
fn spaced(contour: Contour) -> Option<Contour> {
    Contour::new(even(contour.points())).ok()
}

/// The same ring with points [`SPACING_PX`] apart.
fn even(ring: &[Point]) -> Vec<Point> {
    let edges = || ring.iter().zip(ring.iter().cycle().skip(1));
    let length: f64 = edges().map(|(a, b)| a.distance(*b)).sum();
    let n = index(length / SPACING_PX).max(MIN_POINTS);
    let step = length / n as f64;
    let mut out = Vec::with_capacity(n);
    let mut passed = 0.0;
    for (a, b) in edges() {
        let d = a.distance(*b);
        while out.len() < n && out.len() as f64 * step < passed + d {
            out.push(a.lerp(*b, (out.len() as f64 * step - passed) / d));
        }
        passed += d;
    }
    out
}
