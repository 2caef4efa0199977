//! Whole and half font units, and directions between them.

use crate::numeric::cast::index;
use kurbo::{Point, Vec2};

/// The nearest point whose coordinates are whole or half.
pub(super) fn half(p: Point) -> Point {
    let near = full(Point::new(2.0 * p.x, 2.0 * p.y));
    Point::new(0.5 * near.x, 0.5 * near.y)
}

/// The nearest point of the grid.
pub(super) fn full(p: Point) -> Point {
    floor(p + Vec2::new(0.5, 0.5))
}

/// The point of the grid below and to the left; `f64::floor` costs a call here.
#[expect(
    clippy::cast_possible_truncation,
    reason = "font units; `as` saturates"
)]
pub(super) fn floor(p: Point) -> Point {
    /// Makes every coordinate positive, so that truncation is flooring.
    const LIFT: i32 = 1 << 20;
    let low = |v: f64| f64::from(((v + f64::from(LIFT)) as i32).saturating_sub(LIFT));
    Point::new(low(p.x), low(p.y))
}

/// A direction may leave the wanted one by 2 degrees, or by what the lattice makes of it.
pub(in super::super) fn smooth(u: Vec2, v: Vec2) -> bool {
    /// Sine of the turn that no eye sees at a join.
    const TURN: f64 = 0.035;
    /// Half a unit beside the tangent is the lattice's, not the curve's.
    const LATTICE: f64 = 0.5;
    if u.dot(v) <= 0.0 {
        return false;
    }
    let exact = u.x == 0.0 || u.y == 0.0;
    u.cross(v).abs()
        <= if exact {
            1e-9
        } else {
            (TURN * v.hypot()).max(LATTICE)
        }
}

/// Whether a control point beside a corner, `leg` from or to it, lies where the curve leaves it or comes to it along
/// `u`: behind it the curve would turn back on itself.
pub(in super::super) fn is_ahead(u: Vec2, leg: Vec2) -> bool {
    /// Cosine of the largest angle between them.
    const AHEAD: f64 = 0.5;
    u.dot(leg) > AHEAD * leg.hypot()
}

pub(super) fn level(x: f64, most: f64) -> u64 {
    index(x.clamp(-most, most) + most + 0.5) as u64
}
