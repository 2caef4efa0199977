//! All integration tests, linked once.

mod cells;
mod cli;
mod colours;
mod common;
mod compose;
mod convert;
mod demo;
mod designspace;
mod detectors;
mod fitters;
mod fonts;
mod handwork;
mod kept;
mod layers;
mod outlines;
mod outputs;
mod papers;
mod published;
mod recognise;
mod reports;
mod sheets;
mod streaks;
mod template;
mod ufo;
mod watch;
mod words;
