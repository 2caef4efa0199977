//! Picture → Contours: at half coverage, subpixel, or along the boundary pixels.
//!
//! | takes | gives |
//! |---|---|
//! | [`Gray`], px, y down, 1 = ink | [`Contour`]s, px, y up, origin at the picture's bottom left, ink on the left; upright |
//!
//! What follows holds for [`Boundary::Iso`]. The contours come in the order in which a reader meets them, row by row
//! from the top. They neither cross nor touch. Every ink component and every hole above the speckle limit is there,
//! and so are lines and slits whose crest never reaches the level, where it stands out for 6 px, and lines of ink that
//! the level parts for a few px, where they hold half a pixel of ink across (`thin`).

mod chain;
mod focus;
mod ink;
mod levels;
mod ragged;
#[cfg(test)]
mod tests;
mod thin;

use crate::{
    numeric::{edge, iso},
    types::{Contour, Gray},
};
use kurbo::Point;
use ragged::Ragged;
use serde::{Deserialize, Serialize};

pub use focus::{WIDE_PX, focused, spread_px};
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
    /// What becomes of ragged edges; of [`Boundary::Iso`] alone.
    pub edges: Edges,
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

/// What becomes of edges that are ragged all along, as a felt pen's on paper.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Edges {
    /// What they waver is no part of the drawing: curves need not follow it.
    #[default]
    Smooth,
    /// They are followed as they are.
    Keep,
}

impl Edges {
    /// All, by the names that they have in projects.
    pub const ALL: [(&'static str, Self); 2] = [("smooth", Self::Smooth), ("keep", Self::Keep)];
}

impl Default for Options {
    fn default() -> Self {
        Self {
            level: 0.5,
            // a blot of 2 × 2 px: no scanner resolves a drawn mark that small
            speckle_px2: 4.0,
            boundary: Boundary::Iso,
            edges: Edges::Smooth,
        }
    }
}

/// Distance between neighbouring points, px: a little denser than the pixels they come from.
const SPACING_PX: f64 = 0.8;
/// No edge is taken for softer than this, px.
const MAX_BLUR_PX: f64 = 4.0;

/// The contours of a picture's ink, evenly sampled, with the blur of the picture's edges.
#[must_use]
pub fn trace(gray: &Gray, options: &Options) -> Vec<Contour> {
    let upright = |c: Contour| {
        let points = c.points().iter().map(|p| gray.upright() * *p);
        c.through(points.collect()).ok()
    };
    let rings = match options.boundary {
        Boundary::Iso => rings_at(gray, options.level),
        Boundary::Chain => {
            let rings = chain::rings(gray, options.level).into_iter();
            return large(rings, options).filter_map(upright).collect();
        }
    };
    let mut even: Vec<Contour> = large(rings.into_iter(), options)
        .filter_map(spaced)
        .collect();
    let edges = even.iter().map(Contour::points);
    let blur = edge::blur_px(gray.samples(), gray.width(), edges);
    let blur = blur.clamp(Contour::PIXEL_BLUR_PX, MAX_BLUR_PX);
    if let Some(lifted) = thin::lifted(gray, options.level, blur) {
        let rings = rings_at(&lifted, options.level).into_iter();
        even = large(rings, options).filter_map(spaced).collect();
    }
    let ragged = match options.edges {
        Edges::Smooth => Ragged::of(&even),
        Edges::Keep => Ragged::default(),
    };
    let scatter = gray.scatter_px().hypot(ragged.waver_px);
    let told = |c: Contour| {
        let c = c.with_blur(blur).with_ragged(ragged.hidden_px);
        c.with_scatter(scatter)
    };
    even.into_iter().filter_map(upright).map(told).collect()
}

/// The rings around ink of at least `level`.
fn rings_at(gray: &Gray, level: f64) -> Vec<Vec<Point>> {
    iso::rings((gray.width(), gray.height()), |x, y| gray.at(x, y), level)
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
    Contour::new(iso::even(contour.points(), SPACING_PX)).ok()
}
