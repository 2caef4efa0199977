//! What can be wrong with a page.

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
}
