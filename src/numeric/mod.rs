//! Mathematics without pictures; imports nothing of ours.

pub mod distance;
