//! Why a page could not be printed or read.

use thiserror::Error;

/// What is wrong with a template or with the picture of one.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum TemplateError {
    /// An option of the layout is out of range.
    #[error("template: {option} is {value}; {range}")]
    Option {
        /// name of the option
        option: &'static str,
        /// value given
        value: String,
        /// what is allowed
        range: &'static str,
    },
    /// There is nothing to draw.
    #[error("template: no glyph to print a cell for; name some in glyphs")]
    NoGlyphs,
    /// A page could not be drawn as a picture.
    #[error("template: the page could not be drawn: {0}")]
    Drawing(String),
    /// Fewer than four ring marks.
    #[error(
        "{source_name}: found {found} of the 4 ring marks of a page that khatt sheet prints; scan or photograph the whole page, all four corners in view and sharp"
    )]
    Marks {
        /// the picture
        source_name: String,
        /// marks found
        found: usize,
    },
    /// No readable QR code beside the marks.
    #[error(
        "{source_name}: the page's QR code cannot be read; take the picture sharper or at 200 dpi and more"
    )]
    NoCode {
        /// the picture
        source_name: String,
    },
    /// A QR code that is not ours.
    #[error("{source_name}: the QR code says “{text}”, which is no page of khatt's")]
    ForeignCode {
        /// the picture
        source_name: String,
        /// what it says
        text: String,
    },
    /// A page of another project, or of this one before its glyph list or layout changed.
    #[error(
        "{source_name}: page {found} belongs to another project or was printed before this one's glyphs or layout changed (expected {expected}); name the page's own project, or print it anew"
    )]
    OtherProject {
        /// the picture
        source_name: String,
        /// identity on the page
        found: String,
        /// identity of the project
        expected: String,
    },
    /// Two pictures of one page.
    #[error("{second}: page {page} was already given as {first}; leave one of them out")]
    Twice {
        /// page number from 1
        page: usize,
        /// the first picture
        first: String,
        /// the other
        second: String,
    },
    /// Pages that no picture shows.
    #[error(
        "no picture shows {0} of the template; print, draw and scan, and add the picture to `image`"
    )]
    Missing(String),
}
