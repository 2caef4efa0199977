//! Glyph list → pages to draw on, and pictures of drawn pages → Cells.
//!
//! | takes | gives |
//! |---|---|
//! | [`Layout`] and labels | [`Page`]s: filled paths in mm, y down, origin at the paper's top left corner; as SVG, PDF or PNG |
//! | [`Sheet`](crate::types::Sheet) of a page | [`Found`]: which page it is and where every millimetre of it lies, as if it were flat; with the cells on it, [bent](Found::bent) as it is |
//! | both | [`Cell`](crate::types::Cell)s, upright, without the printed guides |
//!
//! A page says of itself what it is: four concentric ring marks give its place to a few hundredths of a
//! pixel, a QR code its number and its way up, and its guides how paper and lens bend it. Nothing is taken from the
//! picture's border or from the ink.

mod bend;
mod cells;
mod draw;
mod error;
mod find;
mod gain;
mod layout;
mod lettering;
mod output;
mod stray;
mod tile;

pub use crate::numeric::surface::Surface;
pub use crate::numeric::view::View;
pub use cells::{Drawing, drawings};
pub use draw::{Ink, Page, Paint, pages};
pub use error::TemplateError;
pub use find::{Found, find};
pub use gain::{Gain, gain};
pub use layout::{Code, Field, Layout, Paper, Place};
pub use output::{pdf, png, svg};
pub use stray::stray;
