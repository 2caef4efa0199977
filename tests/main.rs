//! All integration tests, linked once.

mod common;
mod detectors;
mod fitters;
mod layers;
mod papers;
