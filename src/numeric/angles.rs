//! Angles, directions and rotations, the same to the last bit on all machines: what the standard library takes from the
//! system's depends on whether the processor multiplies and adds in one step.

use kurbo::{Affine, Point, Vec2};

/// The angle from one direction to another, −π…π radians, left positive; 0 where one of them is none.
#[must_use]
pub fn angle(from: Vec2, to: Vec2) -> f64 {
    libm::atan2(from.cross(to), from.dot(to))
}

/// The angle of a direction from that of x, −π…π radians, towards y positive; 0 where it is none.
#[must_use]
pub fn heading(direction: Vec2) -> f64 {
    libm::atan2(direction.y, direction.x)
}

/// The direction at an angle from that of x, radians, towards y positive; a unit vector.
#[must_use]
pub fn direction(angle: f64) -> Vec2 {
    let (sin, cos) = libm::sincos(angle);
    Vec2::new(cos, sin)
}

/// The rotation about the origin by an angle, radians, from x towards y positive.
#[must_use]
pub fn rotation(angle: f64) -> Affine {
    let (sin, cos) = libm::sincos(angle);
    Affine::new([cos, sin, -sin, cos, 0.0, 0.0])
}

/// The rotation about a point by an angle, radians, from x towards y positive.
#[must_use]
pub fn rotation_about(angle: f64, centre: impl Into<Point>) -> Affine {
    let centre = centre.into().to_vec2();
    Affine::translate(centre) * rotation(angle) * Affine::translate(-centre)
}
