//! The side of a node: a curve near its end.

use crate::refine::curves::polygon_px;
use kurbo::{CubicBez, ParamCurve, Vec2};

/// The part of a side that a cut may take away at most.
const CUT: f64 = 0.4;
/// A corner whose sides turn by more than this on their last px is tried with sides that do not, radians.
pub(super) const HOOKED: f64 = 0.3;

/// How far before the end of a curve, in its parameter, it is about `px` from there.
pub(super) fn behind(c: &CubicBez, px: f64) -> f64 {
    let length = polygon_px(c);
    let px = px.min(CUT * length);
    let mut t = (px / length.max(1e-9)).min(CUT);
    for _ in 0..4 {
        let gone = c.eval(1.0 - t).distance(c.p3);
        t = (t * (px / gone.max(1e-9)).clamp(0.5, 2.0)).min(0.5);
    }
    t
}

/// The same curve from its end to its start.
pub(super) fn reversed(c: &CubicBez) -> CubicBez {
    CubicBez::new(c.p3, c.p2, c.p1, c.p0)
}

/// The direction of a vector; nothing for one of no length.
pub(super) fn unit(v: Vec2) -> Vec2 {
    v / v.hypot().max(1e-12)
}
