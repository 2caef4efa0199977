//! What font files fix and both reading and writing need.

/// Seconds from the epoch of font files, 1904, to that of Unix, 1970.
pub(crate) const EPOCH_1904: i64 = 2_082_844_800;

/// Bit of OS/2 fsSelection that asks programs to use the typo metrics, as a UFO counts it; every font of ours has it.
pub(crate) const USE_TYPO_METRICS: u8 = 7;

/// How a UFO writes a date.
pub(crate) const UFO_DATE: &str = "%Y/%m/%d %H:%M:%S";

/// Key of a UFO's lib: the names of its glyphs, in order.
pub(crate) const GLYPH_ORDER: &str = "public.glyphOrder";
/// Key of a UFO's lib: what GDEF says of its glyphs.
pub(crate) const CATEGORIES: &str = "public.openTypeCategories";
/// What the names of a UFO's kerning groups begin with, for the first and the second of a pair.
pub(crate) const KERNING_GROUPS: [&str; 2] = ["public.kern1.", "public.kern2."];
/// Keys of a UFO's lib: which glyphs are layers of which colour, and the colours.
pub(crate) const COLOUR_KEYS: [&str; 2] = [
    "com.github.googlei18n.ufo2ft.colorLayers",
    "com.github.googlei18n.ufo2ft.colorPalettes",
];
/// Key of the libs of a UFO and of its glyphs: what the last build wrote.
pub(crate) const BUILT: &str = "khatt.built";
