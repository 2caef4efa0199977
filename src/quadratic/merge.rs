//! Quadratics back into few cubics: the way from TrueType to formats that store cubics.
//!
//! Between corners and extrema, which stay nodes, a run of quadratics is fitted anew by kurbo's
//! `simplify`; what was cubic or a line before stays.

use crate::types::Outline;
use kurbo::simplify::{SimplifyOptions, simplify_bezpath};
use kurbo::{BezPath, ParamCurve, ParamCurveExtrema, PathEl, PathSeg, Point, Vec2};

/// A smaller turn is the rounding of a smooth join, degrees.
const CORNER_DEG: f64 = 8.0;

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
        pieces.extend(cuts.windows(2).map(|w| seg.subsegment(w[0]..w[1])));
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

/// Whether the join of two pieces stays a node: a corner, an end of a line or cubic, an extremum.
fn is_node(a: &PathSeg, b: &PathSeg) -> bool {
    let (PathSeg::Quad(p), PathSeg::Quad(q)) = (a, b) else {
        return true;
    };
    let (u, v) = (direction(p.p1, p.p2, p.p0), direction(q.p0, q.p1, q.p2));
    let turn = u.cross(v).atan2(u.dot(v)).abs().to_degrees();
    /// Sine of the angle to an axis below which a tangent is level or upright.
    const LEVEL: f64 = 1e-3;
    turn > CORNER_DEG || [u.x, u.y, v.x, v.y].iter().any(|c| c.abs() < LEVEL)
}

/// Unit direction from `a` to `b`, or where they coincide, along with `c`.
fn direction(a: Point, b: Point, c: Point) -> Vec2 {
    let d = if a == b { a - c } else { b - a };
    if d.hypot() > 0.0 {
        d.normalize()
    } else {
        Vec2::new(1.0, 0.0)
    }
}

fn add(run: &mut Vec<PathSeg>, tolerance: f64, out: &mut BezPath) {
    let quads = run.iter().filter(|s| matches!(s, PathSeg::Quad(_))).count();
    let simple = if quads == run.len() && quads > 1 {
        let path = BezPath::from_path_segments(run.iter().copied());
        let options = SimplifyOptions::default().angle_thresh(CORNER_DEG.to_radians());
        simplify_bezpath(path, tolerance, &options)
    } else {
        BezPath::from_path_segments(run.iter().map(|s| match s {
            PathSeg::Quad(q) => PathSeg::Cubic(q.raise()),
            other => *other,
        }))
    };
    out.extend(simple.elements().iter().skip(1).copied());
    run.clear();
}
