//! The order of the stages: a page to cells, cells to outlines, outlines to a font.

pub mod picture;
