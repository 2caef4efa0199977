//! Mathematics without pictures; imports nothing of ours.

pub mod bspline;
pub mod distance;
pub mod skyline;
pub mod turns;
