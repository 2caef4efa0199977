//! Where a letter ends above and below, to a fraction of a pixel.

use crate::numeric::median::median;
use crate::numeric::surface::Surface;
use crate::scan::components::{Component, Run};
use crate::types::Gray;
use kurbo::Point;

/// Coverage at which ink ends.
const HALF: f32 = 0.5;
/// How far the line of half coverage may lie inside the piece's edge, px.
const BLUR: usize = 4;
/// Depth of the outermost ink, px, whose median is its end: a flat foot's, whatever its noise and however it is
/// turned.
const DEPTH: f64 = 1.0;

/// The highest and the lowest ink of a piece on the upright page, px.
pub(super) fn ends(c: &Component, gray: &Gray, upright: &Surface) -> (f64, f64) {
    let outermost = |sign: f64, rough: f64, steps: [Step; 2]| {
        let near = |r: &&Run| {
            let tips = [r.start, r.end].map(|x| Point::new(x as f64, r.y as f64 + 0.5));
            let reach = tips.map(|p| sign * (upright.at(p).y - rough));
            reach[0].max(reach[1]) > -(DEPTH + BLUR as f64)
        };
        let runs = c.runs.iter().filter(near);
        let pixels = runs.copied().flat_map(Run::pixels);
        let heights =
            pixels.filter_map(|(x, y)| Some(upright.at(crossing(c, gray, (x, y), steps)?).y));
        let heights: Vec<f64> = heights.collect();
        let end = heights.iter().map(|y| sign * y).reduce(f64::max)?;
        median(heights.into_iter().filter(|y| end - sign * y <= DEPTH))
    };
    let (top, bottom) = (c.upright.y0, c.upright.y1);
    let (up, down): (Step, Step) = (|y| y.checked_sub(1), |y| y.checked_add(1));
    (
        outermost(-1.0, top, [up, down]).unwrap_or(top),
        outermost(1.0, bottom, [down, up]).unwrap_or(bottom),
    )
}

/// The row beyond another one, where there is one.
type Step = fn(usize) -> Option<usize>;

/// Where the coverage of a column passes half at an edge pixel of the piece or a little inside it.
fn crossing(
    c: &Component,
    gray: &Gray,
    (x, y): (usize, usize),
    [out, back]: [Step; 2],
) -> Option<Point> {
    let (mut inner, mut outer) = (y, out(y).filter(|&y| y < gray.height())?);
    if c.covers(x, outer) {
        return None;
    }
    for _ in 0..BLUR {
        let (v, beyond) = (gray.at(x, inner), gray.at(x, outer));
        if v >= HALF {
            let t = f64::from((v - HALF) / (v - beyond).max(f32::EPSILON)).min(1.0);
            let y = inner as f64 + (outer as f64 - inner as f64) * t;
            return Some(Point::new(x as f64 + 0.5, y + 0.5));
        }
        (inner, outer) = (back(inner).filter(|&y| y < gray.height())?, inner);
    }
    None
}
