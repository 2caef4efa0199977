//! Which letter a cell holds: [`Gray`](crate::types::Gray) → letters of a reference, best first; and the
//! lines that a pen drew.
//!
//! Guaranteed: the same answer every time; an answer for every picture, empty, solid or huge. Approximate:
//! everything else. Letters that differ in size alone (c and C) are told apart only where the page says
//! where its baseline is.

mod affine;
mod align;
mod alphabet;
mod centerline;
mod check;
mod dissimilar;
mod ink;
mod marks;
mod once;
mod shape;
mod skeleton;
mod spline;
mod thin;

pub use alphabet::{Alphabet, Guess, Look, Method, Sample};
pub use centerline::centerline;
pub use check::{Finding, Reading, check};
pub use once::once;
pub use skeleton::{Pruning, Skeleton, Stroke};
pub use thin::thin;

#[cfg(test)]
mod tests;
