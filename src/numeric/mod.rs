//! Mathematics without pictures; imports nothing of ours.

pub mod assignment;
pub mod banded;
pub mod bspline;
pub mod cast;
pub mod chain;
pub mod clip;
pub mod coverage;
pub mod curves;
pub mod distance;
pub mod iso;
pub mod joins;
pub mod levels;
pub mod many;
pub mod median;
pub mod minimise;
pub mod pieces;
pub mod powers;
pub mod qbc;
pub mod refit;
pub mod shortest;
pub mod side;
pub mod skyline;
pub mod svg;
pub mod tone;
pub mod turns;
pub mod view;
