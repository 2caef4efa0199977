//! Curves as SVG path data.

use kurbo::{BezPath, PathEl, Point};
use std::fmt::Write;

/// Path data, absolute, with numbers as `number` writes them.
pub(super) fn path_data(path: &BezPath, number: impl Fn(f64) -> String) -> String {
    let mut out = String::new();
    let p = |p: Point| format!("{} {}", number(p.x), number(p.y));
    for el in path.elements() {
        let done = match *el {
            PathEl::MoveTo(a) => write!(out, "M{}", p(a)),
            PathEl::LineTo(a) => write!(out, "L{}", p(a)),
            PathEl::QuadTo(a, b) => write!(out, "Q{} {}", p(a), p(b)),
            PathEl::CurveTo(a, b, c) => write!(out, "C{} {} {}", p(a), p(b), p(c)),
            PathEl::ClosePath => write!(out, "Z"),
        };
        debug_assert!(done.is_ok(), "a string takes all that is written to it");
    }
    out
}
