//! What can be wrong with a page.

use super::options::Order;
use crate::types::Shade;
use thiserror::Error;

/// The most pixels a page may have: A3 at 1200 dpi has 278 million.
pub(super) const MAX_PIXELS: u64 = 300_000_000;

/// Why a page gives no cells. Every message names the file and what to do.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{page} {fault}{}", taken.map_or_else(String::new, doubt))]
pub struct ScanError {
    /// The file, and its page where it has several.
    pub page: String,
    /// What is wrong with it.
    pub fault: Fault,
    /// What its ink was taken for, where that was guessed and may be the cause.
    pub taken: Option<Shade>,
}

/// What is wrong with a page; every message goes on from the page's name.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum Fault {
    /// The content is none of the kinds of picture that are read.
    #[error("is not a picture that can be read: give PNG, JPEG, TIFF, BMP, GIF, WebP, PNM or PCX")]
    Kind,
    /// The file ends before its picture does.
    #[error("is cut off: its picture has no end; copy or scan it again")]
    Truncated,
    /// The decoder gave up, and said this.
    #[error("is damaged or of an unknown variant: {0}")]
    Decode(String),
    /// More pixels than a page can have.
    #[error(
        "claims {width}×{height} px, more than the {} million a page may have; scan at a lower resolution", MAX_PIXELS / 1_000_000
    )]
    Large {
        /// px
        width: u32,
        /// px
        height: u32,
    },
    /// A picture is to be read as its file says, which says nothing, or nothing that is understood: it lacks this.
    #[error(
        "does not say how much light its numbers stand for: {0}; write tones = \"srgb\" if they are in sRGB, as \
         cameras' are and most scanners', or leave `tones` out"
    )]
    Tones(String),
    /// Nothing on the page is darker than its paper.
    #[error("is blank: no ink stands out of its paper")]
    Blank,
    /// All cells are to be skipped.
    #[error("has no names but _ in `glyphs`; name a letter, or leave the sheet out")]
    NoNames,
    /// All ink is of another colour than this, which the letters are said to be.
    #[error(
        "has ink, but none of the colour that `ink` asks for ({0}); correct `ink` or leave it out"
    )]
    OtherInk(String),
    /// These inks are to be told apart where there are no colours.
    #[error(
        "has no colours by which the inks that `ink` lists could be told apart ({0}); scan it \
         in colour, dark ink on light paper, or leave `ink` out"
    )]
    NoColours(String),
    /// More names than cells.
    #[error(
        "has {cells} cells, but {names} names are given, the first too many being “{extra}”; \
         take names away or correct the layout"
    )]
    TooManyNames {
        /// cells found
        cells: usize,
        /// names given
        names: usize,
        /// the first name without a cell
        extra: String,
    },
    /// Nothing on the page is a printed box that holds letters.
    #[error(
        "has no printed boxes for {names} names: {found} places look like boxes, and most of the ink lies outside \
         them; write layout = \"free\" for a page without boxes, or layout = {{ grid = [rows, columns] }} where letters stand in columns"
    )]
    NoBoxes {
        /// places that ink encloses
        found: usize,
        /// names given
        names: usize,
    },
    /// A cell with ink in it has no name.
    #[error(
        "has ink in row {row}, column {column}, which has no name: only {names} names are given; \
         name it, or write _ to skip it"
    )]
    TooFewNames {
        /// from 1
        row: usize,
        /// from 1, from the left
        column: usize,
        /// names given
        names: usize,
    },
    /// A line of names is longer or shorter than its row of letters, or its column where columns come first, and one
    /// after it as long as its own.
    #[error(
        "has room for {cells} letters in {word} {line}, and line {line} of `glyphs` has {names} names, so that the names after it are \
         those of other {word}s; correct the line, write _ for what is to be skipped, draw letters clear of each other, or write all names in one \
         line if lines are no {word}s", word = line_of(*order)
    )]
    Line {
        /// which come first
        order: Order,
        /// from 1
        line: usize,
        /// names in it
        names: usize,
        /// cells of its row or column
        cells: usize,
    },
    /// Letters and names differ in number.
    #[error(
        "has {found} letters in rows of {rows}, and {names} names that do not go with them: {doubts}; correct the \
         names, write _ for ink to be skipped, draw letters clear of each other, or say where one stands: box under [cells.NAME]"
    )]
    Count {
        /// letters found
        found: usize,
        /// letters of each row
        rows: String,
        /// names given
        names: usize,
        /// where letters and names part
        doubts: String,
    },
    /// Nothing on a bare page of so many names is like a letter.
    #[error(
        "has no ink that could be letters of its {0} names, but lines alone; write \
         layout = {{ grid = [rows, columns] }}, which goes by places, or say where each letter stands: box under \
         [cells.NAME]"
    )]
    NoLetters(usize),
    /// Far less ink than names on a bare page.
    #[error(
        "has {pieces} pieces of ink, too few for the letters of {names} names; take names away, or correct `image` if this is not their page"
    )]
    FewPieces {
        /// connected pieces of ink
        pieces: usize,
        /// names given
        names: usize,
    },
    /// Far more ink than names on a bare page.
    #[error(
        "has {pieces} pieces of ink, too many for the letters of {names} names: are they dust? Clean the picture, or write \
         layout = {{ grid = [rows, columns] }}, which goes by places alone"
    )]
    ManyPieces {
        /// pieces of ink in rows
        pieces: usize,
        /// names given
        names: usize,
    },
    /// There is ink for every name, but it is likelier that one has none.
    #[error(
        "looks as if it had a letter less than the {names} names: {among} seems to have only a part of another's ink; take \
         the name away, or, where all have their letters, write the names in lines that are the page's rows, or say where one stands: box under \
         [cells.NAME]"
    )]
    SpareName {
        /// names given
        names: usize,
        /// the names of which one is likeliest to be too many
        among: String,
    },
    /// The size of an em is to be measured in millimetres, and the file does not say its resolution.
    #[error("does not say its resolution, so em_mm means nothing; give pixels_per_em")]
    NoResolution,
    /// No letter on the page has this height, from which the size of an em is to be measured.
    #[error("has no letter to measure {0} from; give pixels_per_em")]
    NoHeight(&'static str),
    /// A layout without rows or columns.
    #[error(
        "has no room for a grid of {rows} × {columns} cells: it needs at least one row and one column, and a few pixels for each"
    )]
    NoGrid {
        /// rows asked for
        rows: usize,
        /// columns asked for
        columns: usize,
    },
}

impl Fault {
    /// The error of the page that has it, whose ink's shade may have been guessed.
    pub(super) fn of(self, page: &str, guessed: Option<Shade>) -> ScanError {
        let is_told = matches!(
            self,
            Self::NoNames | Self::NoGrid { .. } | Self::NoResolution
        );
        ScanError {
            page: page.to_owned(),
            fault: self,
            taken: guessed.filter(|_| !is_told),
        }
    }
}

/// What a line of names is where such come first.
const fn line_of(order: Order) -> &'static str {
    match order {
        Order::Rows => "row",
        Order::Columns => "column",
    }
}

/// What to do where ink may be of the other shade.
fn doubt(taken: Shade) -> String {
    let (taken, other) = match taken {
        Shade::Dark => ("darker", "light-ink"),
        Shade::Light => ("lighter", "dark-ink"),
    };
    format!(
        ". The ink was taken to be {taken} than its paper; if that is wrong write polarity = \"{other}\""
    )
}
