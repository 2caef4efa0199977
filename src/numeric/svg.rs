//! Curves as SVG path data.

use kurbo::{BezPath, PathEl, Point};

/// Path data, absolute, with numbers as `number` writes them.
#[must_use]
pub fn path_data(path: &BezPath, number: impl Fn(f64) -> String) -> String {
    let p = |p: Point| format!("{} {}", number(p.x), number(p.y));
    let step = |el: &PathEl| match *el {
        PathEl::MoveTo(a) => format!("M{}", p(a)),
        PathEl::LineTo(a) => format!("L{}", p(a)),
        PathEl::QuadTo(a, b) => format!("Q{} {}", p(a), p(b)),
        PathEl::CurveTo(a, b, c) => format!("C{} {} {}", p(a), p(b), p(c)),
        PathEl::ClosePath => "Z".to_owned(),
    };
    path.elements().iter().map(step).collect()
}
