//! What can be wrong with a page.

use crate::types::Shade;
use thiserror::Error;

/// The most pixels a page may have: A3 at 1200 dpi has 278 million.
pub(super) const MAX_PIXELS: u64 = 300_000_000;

/// Why a page gives no cells. Every message names the file and what to do.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ScanError {
    /// The content is none of the kinds of picture that are read.
    #[error(
        "{source_name} is not a picture that can be read: give PNG, JPEG, TIFF, BMP, GIF, WebP, PNM or PCX"
    )]
    Kind {
        /// the file
        source_name: String,
    },
    /// The file ends before its picture does.
    #[error("{source_name} is cut off: its picture has no end; copy or scan it again")]
    Truncated {
        /// the file
        source_name: String,
    },
    /// The decoder gave up.
    #[error("{source_name} is damaged or of an unknown variant: {why}")]
    Decode {
        /// the file
        source_name: String,
        /// what the decoder said
        why: String,
    },
    /// More pixels than a page can have.
    #[error(
        "{source_name} claims {width}×{height} px, more than the {} million a page may have; scan at a lower resolution", MAX_PIXELS / 1_000_000
    )]
    Large {
        /// the file
        source_name: String,
        /// px
        width: u32,
        /// px
        height: u32,
    },
    /// A picture is to be read as its file says, which says nothing, or nothing that is understood.
    #[error(
        "{source_name} does not say how much light its numbers stand for: {why}; write tones = \"srgb\" if they are in sRGB, as \
         cameras' are and most scanners', or leave `tones` out"
    )]
    Tones {
        /// the file
        source_name: String,
        /// what it lacks
        why: String,
    },
    /// Nothing on the page is darker than its paper.
    #[error("{source_name} is blank: no ink stands out of its paper")]
    Blank {
        /// the file
        source_name: String,
    },
    /// All cells are to be skipped.
    #[error("{source_name} has no names but _ in `glyphs`; name a letter, or leave the sheet out")]
    NoNames {
        /// the file
        source_name: String,
    },
    /// All ink is of another colour than the letters are said to be.
    #[error(
        "{source_name} has ink, but none of the colour that `ink` asks for ({ink}); correct `ink` or leave it out"
    )]
    OtherInk {
        /// the file
        source_name: String,
        /// the ink that was asked for
        ink: String,
    },
    /// Several inks are to be told apart where there are no colours.
    #[error(
        "{source_name} has no colours by which the inks that `ink` lists could be told apart ({inks}); scan it \
         in colour, dark ink on light paper, or leave `ink` out"
    )]
    NoColours {
        /// the file
        source_name: String,
        /// the inks that were asked for
        inks: String,
    },
    /// More names than cells.
    #[error(
        "{source_name} has {cells} cells, but {names} names are given, the first too many being “{extra}”; \
         take names away or correct the layout"
    )]
    TooManyNames {
        /// the file
        source_name: String,
        /// cells found
        cells: usize,
        /// names given
        names: usize,
        /// the first name without a cell
        extra: String,
    },
    /// Nothing on the page is a printed box that holds letters.
    #[error(
        "{source_name} has no printed boxes for {names} names: {found} places look like boxes, and most of the ink lies outside \
         them; write layout = \"free\" for a page without boxes, or layout = {{ grid = [rows, columns] }} where letters stand in columns"
    )]
    NoBoxes {
        /// the file
        source_name: String,
        /// places that ink encloses
        found: usize,
        /// names given
        names: usize,
    },
    /// A cell with ink in it has no name.
    #[error(
        "{source_name} has ink in row {row}, column {column}, which has no name: only {names} names are given; \
         name it, or write _ to skip it"
    )]
    TooFewNames {
        /// the file
        source_name: String,
        /// from 1
        row: usize,
        /// from 1, from the left
        column: usize,
        /// names given
        names: usize,
    },
    /// A line of names is longer or shorter than its row of letters, and one after it as long as its own.
    #[error(
        "{source_name} has room for {cells} letters in row {line}, and line {line} of `glyphs` has {names} names, so that the names after it are \
         those of other rows; correct the line, write _ for what is to be skipped, draw letters clear of each other, or write all names in one \
         line if lines are no rows"
    )]
    Line {
        /// the file
        source_name: String,
        /// from 1
        line: usize,
        /// names in it
        names: usize,
        /// cells of its row
        cells: usize,
    },
    /// Letters and names differ in number.
    #[error(
        "{source_name} has {found} letters in rows of {rows}, and {names} names that do not go with them: {doubts}; correct the \
         names, write _ for ink to be skipped, draw letters clear of each other, or say where one stands: box under [cells.NAME]"
    )]
    Count {
        /// the file
        source_name: String,
        /// letters found
        found: usize,
        /// letters of each row
        rows: String,
        /// names given
        names: usize,
        /// where letters and names part
        doubts: String,
    },
    /// Nothing on a bare page is like a letter.
    #[error(
        "{source_name} has no ink that could be letters of its {names} names, but lines alone; write \
         layout = {{ grid = [rows, columns] }}, which goes by places, or say where each letter stands: box under \
         [cells.NAME]"
    )]
    NoLetters {
        /// the file
        source_name: String,
        /// names given
        names: usize,
    },
    /// Far less ink than names on a bare page.
    #[error(
        "{source_name} has {pieces} pieces of ink, too few for the letters of {names} names; take names away, or correct `image` if this is not their page"
    )]
    FewPieces {
        /// the file
        source_name: String,
        /// connected pieces of ink
        pieces: usize,
        /// names given
        names: usize,
    },
    /// There is ink for every name, but it is likelier that one has none.
    #[error(
        "{source_name} looks as if it had a letter less than the {names} names: {among} seems to have only a part of another's ink; take \
         the name away, or, where all have their letters, write the names in lines that are the page's rows, or say where one stands: box under \
         [cells.NAME]"
    )]
    SpareName {
        /// the file
        source_name: String,
        /// names given
        names: usize,
        /// the names of which one is likeliest to be too many
        among: String,
    },
    /// The size of an em is to be measured in millimetres, and the file does not say its resolution.
    #[error(
        "{source_name} does not say its resolution, so em_mm means nothing; give pixels_per_em"
    )]
    NoResolution {
        /// the file
        source_name: String,
    },
    /// No letter on the page has the height that the size of an em is to be measured from.
    #[error("{source_name} has no letter to measure {what} from; give pixels_per_em")]
    NoHeight {
        /// the file
        source_name: String,
        /// the height wanted
        what: &'static str,
    },
    /// A page that cannot be read, of which it was guessed whether its ink is dark or light.
    #[error(
        "{cause}. The ink was taken to be {} than its paper; if that is wrong write polarity = \"{}\"",
        shades(*.taken).0, shades(*.taken).1
    )]
    Polarity {
        /// what was wrong
        cause: Box<Self>,
        /// what the ink was taken for
        taken: Shade,
    },
    /// A layout without rows or columns.
    #[error(
        "a grid of {rows} × {columns} cells does not fit the picture: it needs at least one row and one column, and a few pixels for each"
    )]
    NoGrid {
        /// rows asked for
        rows: usize,
        /// columns asked for
        columns: usize,
    },
}

impl ScanError {
    /// What a decoder says of a file.
    pub(super) fn decode(source: &str, why: impl ToString) -> Self {
        Self::Decode {
            source_name: source.to_owned(),
            why: why.to_string(),
        }
    }

    /// The same where it may be due to the ink's shade, which was guessed.
    pub(super) fn or_polarity(self, guessed: Option<Shade>) -> Self {
        match (guessed, self) {
            (None, own) => own,
            (_, own @ (Self::NoNames { .. } | Self::NoGrid { .. } | Self::NoResolution { .. })) => {
                own
            }
            (Some(taken), own) => Self::Polarity {
                cause: Box::new(own),
                taken,
            },
        }
    }
}

/// How ink of a shade differs from its paper, and the polarity of the other shade.
const fn shades(taken: Shade) -> (&'static str, &'static str) {
    match taken {
        Shade::Dark => ("darker", "light-ink"),
        Shade::Light => ("lighter", "dark-ink"),
    }
}
