//! Quadratics back into few cubics: the way from TrueType to formats that store cubics.
//!
//! Between corners and extrema, which stay nodes, a run of quadratics is fitted anew; what was cubic or a line before
//! stays.

use super::bounded;
use crate::types::Outline;
use kurbo::{BezPath, Line, ParamCurve, ParamCurveExtrema, PathEl, PathSeg, QuadBez};

/// A smaller turn is the rounding of a smooth join: tangent of 8°, nearly.
const CORNER: f64 = 0.1396;
/// A control point nearer to its end than this says nothing of the direction there and leaves the curve straight,
/// units.
const HAIR: f64 = 1e-3;

/// The outline with its runs of quadratics as cubics within `tolerance`, font units.
#[must_use]
pub fn merge(outline: &Outline, tolerance: f64) -> Outline {
    let contours = outline
        .contours()
        .iter()
        .map(|c| contour(c, tolerance))
        .collect();
    // A fit that left the numbers would be no outline: then the given one is the answer.
    Outline::new(contours).unwrap_or_else(|_| outline.clone())
}

fn contour(path: &BezPath, tolerance: f64) -> BezPath {
    let mut pieces: Vec<PathSeg> = Vec::new();
    for seg in path.segments() {
        let mut cuts = vec![0.0];
        if matches!(seg, PathSeg::Quad(_)) {
            cuts.extend(
                seg.extrema()
                    .into_iter()
                    .filter(|t| (0.01..0.99).contains(t)),
            );
        }
        cuts.push(1.0);
        cuts.sort_by(f64::total_cmp);
        let parts = cuts.windows(2).map(|w| seg.subsegment(w[0]..w[1]));
        pieces.extend(parts.filter_map(regular));
    }
    if !pieces.iter().any(|s| matches!(s, PathSeg::Quad(_))) {
        return path.clone();
    }
    let n = pieces.len();
    let cut: Vec<bool> = (0..n)
        .map(|i| is_node(&pieces[(i + n - 1) % n], &pieces[i]))
        .collect();
    let first = cut.iter().position(|&c| c).unwrap_or(0);
    let mut out = BezPath::new();
    out.move_to(pieces[first].start());
    let mut run: Vec<PathSeg> = Vec::new();
    for k in 0..n {
        let i = (first + k) % n;
        if k > 0 && cut[i] {
            add(&mut run, tolerance, &mut out);
        }
        run.push(pieces[i]);
    }
    add(&mut run, tolerance, &mut out);
    // Sums of parameters leave a hair between the last point and the first.
    let start = pieces[first].start();
    if let Some(PathEl::CurveTo(.., end) | PathEl::LineTo(end)) = out.elements_mut().last_mut()
        && end.distance(start) < 1e-6
    {
        *end = start;
    }
    out.close_path();
    out
}

/// The piece, as a line where a quadratic's control point lies on one of its ends; nothing where it is a point.
fn regular(piece: PathSeg) -> Option<PathSeg> {
    let PathSeg::Quad(q) = piece else {
        return Some(piece);
    };
    if q.p1.distance(q.p0).min(q.p1.distance(q.p2)) >= HAIR {
        return Some(piece);
    }
    (q.p0 != q.p2).then(|| Line::new(q.p0, q.p2).into())
}

/// Whether the join of two pieces stays a node: a corner, an end of a line or cubic, an extremum.
fn is_node(a: &PathSeg, b: &PathSeg) -> bool {
    let (PathSeg::Quad(p), PathSeg::Quad(q)) = (a, b) else {
        return true;
    };
    let (u, v) = ((p.p2 - p.p1).normalize(), (q.p1 - q.p0).normalize());
    let turns = u.cross(v).abs() > CORNER * u.dot(v);
    /// Sine of the angle to an axis below which a tangent is level or upright.
    const LEVEL: f64 = 1e-3;
    turns || [u.x, u.y, v.x, v.y].iter().any(|c| c.abs() < LEVEL)
}

/// Writes the run: what is of quadratics alone as few cubics, anything else as it is.
fn add(run: &mut Vec<PathSeg>, tolerance: f64, out: &mut BezPath) {
    let quad = |s: &PathSeg| match s {
        PathSeg::Quad(q) => Some(*q),
        _ => None,
    };
    let quads: Option<Vec<QuadBez>> = run.iter().map(quad).collect();
    let pieces = match quads {
        Some(quads) => bounded::fit(&quads, tolerance)
            .into_iter()
            .map(PathSeg::Cubic)
            .collect(),
        None => std::mem::take(run),
    };
    out.extend(pieces.iter().map(PathSeg::as_path_el));
    run.clear();
}
