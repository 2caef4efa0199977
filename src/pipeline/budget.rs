//! Where the distance between a scan and the font's file comes from.

use super::build::Built;
use super::letter::Letter;
use crate::assemble::names;
use crate::finish::{place, round};
use crate::numeric::distance::{Polyline, chords, distances, largest};
use crate::types::{Contour, Font, Outline};
use kurbo::Point;
use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;

/// Chords of the measured outline leave its curves by no more than this, font units.
const CHORD: f64 = 0.01;
/// The same of an outline whose points are looked at.
const PROBE: f64 = 0.1;

/// A scanned edge, contour by contour: points and their distances to an outline, font units.
pub(super) type Edge = Vec<Vec<(Point, f64)>>;

/// The largest distance that each step from the scan to the font's file adds, font units. Steps can
/// undo each other: the whole is at most their sum.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, JsonSchema)]
pub struct Budget {
    /// From the scanned edge to the curves fitted to it.
    pub fit: f64,
    /// From these to the glyph as it stands in the font: joining strokes are moved.
    pub joining: f64,
    /// From the cubics to TrueType's quadratics.
    pub quadratic: f64,
    /// To whole units, curves that become straight on them included.
    pub rounding: f64,
}

/// A letter beside the outline that is compiled.
#[derive(Debug, Clone)]
pub(super) struct Measured {
    /// The scanned edge where the glyph stands, with each point its distance to the outline as compiled and rounded.
    pub(super) edge: Edge,
    /// The steps of the way.
    pub(super) budget: Budget,
}

/// Every letter of a font measured, with the font's curves as whole units leave them and as quadratics; none where the
/// font has no such glyph.
pub(super) fn measured(built: &Built, straight: &Font, compiled: &Font) -> Vec<Option<Measured>> {
    let letters = built.letters.par_iter();
    let fonts = [&built.font, straight, compiled];
    letters.map(|l| letter(fonts, l)).collect()
}

fn letter(fonts: [&Font; 3], letter: &Letter) -> Option<Measured> {
    let name = names::identify(&letter.label).ok()?.name;
    let frame = letter.frame_in(fonts[0])?;
    let map = frame.to_units();
    let fitted = place::outline(&letter.paths, frame).ok()?;
    let outlines = fonts.map(|font| font.glyph(name.as_str()).map(|g| &g.outline));
    let [Some(cubic), Some(straight), Some(quadratic)] = outlines else {
        return None;
    };
    let rounded = round::outline(quadratic);
    let edge = |outline: &Outline| -> Edge {
        let lines = lines(outline);
        let ring = |c: &Contour| distances(c.points().iter().map(|&p| map * p), &lines);
        letter.edge.iter().map(ring).collect()
    };
    let budget = Budget {
        fit: largest(&edge(&fitted)),
        joining: apart(&fitted, cubic),
        quadratic: apart(straight, quadratic),
        rounding: apart(cubic, straight) + apart(quadratic, &rounded),
    };
    Some(Measured {
        edge: edge(&rounded),
        budget,
    })
}

/// The largest distance of a point of one outline to the other.
fn apart(a: &Outline, b: &Outline) -> f64 {
    let lines = lines(b);
    let rings = a.contours().iter();
    let rings = rings.map(|c| distances(chords(c, PROBE), &lines));
    largest(&rings.collect::<Vec<_>>())
}

fn lines(outline: &Outline) -> Vec<Polyline> {
    let rings = outline.contours().iter().map(|c| chords(c, CHORD));
    rings.filter_map(Polyline::new).collect()
}
