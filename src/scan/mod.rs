//! Image bytes → Cells: load, clean, deskew, cut.
//!
//! | type | unit, axes | guaranteed |
//! |---|---|---|
//! | bytes → [`Sheet`](crate::types::Sheet) | sheet px, y down | the file's own pixels, turned as it says, 1 = ink; nothing resampled |

mod error;
mod header;
mod load;

pub use error::ScanError;
pub use load::{Polarity, load};
