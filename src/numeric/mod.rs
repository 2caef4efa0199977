//! Mathematics without pictures; imports nothing of ours.

pub mod assignment;
pub mod banded;
pub mod bspline;
pub mod chain;
pub mod distance;
pub mod minimise;
pub mod refit;
pub mod shortest;
pub mod skyline;
pub mod turns;
