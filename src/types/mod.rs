//! The nouns: every type that crosses a border between two stages, and nothing else.
//!
//! | type | holds | unit, axis |
//! |---|---|---|
//! | [`Gray`] | ink coverage, row-major | px, y down, centre of pixel (0, 0) at (½, ½) |
//! | [`Bitmap`] | ink or paper, row-major | px, y down |
//! | [`Sheet`], [`Cell`] | a page, a letter of it | px, y down |
//! | [`Contour`], [`Spans`] | rings of points, cut at corners | px, y **up**, origin at the picture's bottom left |
//! | [`Fitted`] | curves through a span | px, y up |
//! | [`Centerline`] | the middle of a pen's lines | px, y down |
//! | [`Outline`] | closed curves | font units, y up, origin on the baseline |
//! | [`Glyph`], [`Font`] | outlines with names, advances, anchors | font units |
//! | [`Png`], [`Files`] | a picture to look at, what a writer made | bytes |
//!
//! Three functions cross between spaces, and no others: `scan::cut` (sheet to cell), `trace`
//! (y down to y up) and `finish::place` (px to font units).

mod centerline;
pub(crate) mod characters;
mod contour;
mod curve;
mod files;
mod font;
mod form;
pub(crate) mod formats;
mod glyph;
mod naming;
mod outline;
mod png;
mod raster;
mod sheet;
pub(crate) mod style;

pub use centerline::{Centerline, PenDot, PenLine};
pub use contour::{Contour, ContourError, Span, Spans};
pub use curve::{Fitted, Verdict};
pub use files::Files;
pub use font::{Font, FontError, Info, Kerning, Metrics};
pub use form::Form;
pub(crate) use glyph::label;
pub use glyph::{Anchor, Component, Glyph, Layer, Name, NameError};
pub use outline::{Frame, Outline, OutlineError};
pub use png::Png;
pub use raster::{Bitmap, Gray, RasterError};
pub(crate) use sheet::MM_PER_INCH;
pub use sheet::{Cell, Colours, Direction, Guides, Label, Plate, Shade, Sheet};
