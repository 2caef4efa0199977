//! Image bytes → Cells: load, clean, deskew, cut.
//!
//! | step | from → to | unit, axes | guaranteed |
//! |---|---|---|---|
//! | [`load()`] | bytes → [`Sheet`](crate::types::Sheet)s | sheet px, y down | the file's own pixels, turned as it says, 1 = ink; nothing resampled |
//! | [`clean()`] | `Sheet` → [`Page`] | sheet px | light and shaded ink evened out: paper 0, ink 1; noise and edges as scanned, but for steps of two levels, which are softened, ink that is grain, which is averaged, and a pen's streaks, which are filled |
//! | [`cut()`] | `Page` → [`Cell`](crate::types::Cell)s | upright px | each piece of ink in one cell or in the list of what was rejected, with a reason |
//!
//! Letters of a skewed page stay on the pixels of the scan, and say how they stand upright
//! ([`Gray::upright`](crate::types::Gray::upright)): nothing is resampled between the scanner and the contour. Only
//! where a page is seen in perspective, or bent, are pixels interpolated, once.

mod bent;
mod chamfer;
mod clean;
mod components;
mod cut;
mod deskew;
mod error;
mod grain;
mod header;
mod ink;
mod letters;
mod light;
mod load;
mod options;
mod paper;
mod perspective;
mod range;
mod separation;
mod shading;
mod steps;
mod streaks;
mod upright;

pub use clean::{Page, Texture, clean, clean_otherwise, grey};
pub use cut::{Cut, Pin, Reason, Region, Rejected, Warning, cut};
pub(crate) use cut::{SMALL_LETTER, SMALL_SHARE, is_full};
pub use error::{Fault, ScanError};
pub use grain::{InkGrain, grained};
pub use ink::{Ink, Inks};
pub(crate) use letters::pieces;
pub use load::{ColourDetail, Polarity, Reading, Tones, Turn, describes_light, load, load_page};
pub use options::{Layout, Options, Order, Scale};
pub use range::{full_range, is_all_dark};
pub use separation::Colour;
pub use shading::{Even, legible, shaded};
pub use steps::softened;
pub use streaks::InkStreaks;
pub use upright::upright;
