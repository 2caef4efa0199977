//! Whether a font's tables hold what they are said to: readers take what is cut off for empty.

use super::ReadError;
use skrifa::raw::tables::glyf::{CompositeGlyphFlags, Glyf, Glyph, SimpleGlyph};
use skrifa::raw::tables::loca::Loca;
use skrifa::raw::{FontRef, ReadError as Unread, TableProvider};
use skrifa::{GlyphId, Tag};

/// Bytes of an advance with its bearing, and of a bearing alone.
const METRICS: (usize, usize) = (4, 2);

/// Fails where the file ends before one of its tables does, or where there are fewer advances or outlines than glyphs.
pub(super) fn check(font: &FontRef<'_>) -> Result<(), ReadError> {
    let there = font.data().len();
    for record in font.table_directory().table_records() {
        let end = u64::from(record.offset()) + u64::from(record.length());
        if end > there as u64 {
            let why = format!("the file ends before it, at {there} of {end} bytes");
            return Err(ReadError::table(record.tag(), why));
        }
    }
    let count = font.maxp().map_err(|e| missing(b"maxp", &e))?.num_glyphs();
    advances(font, usize::from(count))?;
    match (font.loca(None), font.glyf()) {
        (Ok(loca), Ok(glyf)) => places(&loca, &glyf, usize::from(count)),
        (Err(e), Ok(_)) => Err(missing(b"loca", &e)),
        (_, Err(_)) => Ok(()),
    }
}

fn missing(tag: &[u8; 4], error: &Unread) -> ReadError {
    ReadError::table(Tag::new(tag), error)
}

fn advances(font: &FontRef<'_>, count: usize) -> Result<(), ReadError> {
    let hhea = font.hhea().map_err(|e| missing(b"hhea", &e))?;
    let long = usize::from(hhea.number_of_h_metrics());
    if long == 0 && count > 0 {
        let why = "it says that there are no advances";
        return Err(ReadError::table(Tag::new(b"hhea"), why));
    }
    let hmtx = font.table_data(Tag::new(b"hmtx"));
    let there = hmtx.map_or(0, |table| table.len());
    let wanted = METRICS.0 * long + METRICS.1 * count.saturating_sub(long);
    if there < wanted {
        let why = format!("it has {there} bytes, and the advances of {count} glyphs take {wanted}");
        return Err(ReadError::table(Tag::new(b"hmtx"), why));
    }
    Ok(())
}

/// Where outlines lie, one after the other and within their table.
fn places(loca: &Loca<'_>, glyf: &Glyf<'_>, count: usize) -> Result<(), ReadError> {
    let wrong = |why: String| Err(ReadError::table(Tag::new(b"loca"), why));
    if loca.len() < count {
        return wrong(format!(
            "it has places for {} of {count} glyphs",
            loca.len()
        ));
    }
    if !loca.all_offsets_are_ascending() {
        return wrong("a glyph ends before it begins".to_owned());
    }
    let there = glyf.offset_data().len();
    let end = loca.get_raw(count).unwrap_or_default();
    if usize::try_from(end).is_ok_and(|end| end <= there) {
        return Ok(());
    }
    let why = format!("it has {there} bytes, and by loca its glyphs take {end}");
    Err(ReadError::table(Tag::new(b"glyf"), why))
}

/// Whether all of a glyph is stored, or why not: the library draws what there is of it.
pub(super) fn whole(loca: &Loca<'_>, glyf: &Glyf<'_>, id: GlyphId) -> Result<(), String> {
    let is_whole = match loca.get_glyf(id, glyf).map_err(|e| e.to_string())? {
        Some(Glyph::Simple(glyph)) => has_points(&glyph),
        Some(Glyph::Composite(glyph)) => {
            let last = glyph.component_glyphs_and_flags().last();
            last.is_some_and(|(_, flags)| !flags.contains(CompositeGlyphFlags::MORE_COMPONENTS))
        }
        None => true,
    };
    is_whole
        .then_some(())
        .ok_or_else(|| "it is cut off".to_owned())
}

fn has_points(glyph: &SimpleGlyph<'_>) -> bool {
    let contours = usize::try_from(glyph.number_of_contours()).unwrap_or_default();
    let is_listed = glyph.end_pts_of_contours().len() == contours;
    is_listed && (glyph.num_points() == 0 || glyph.points().next().is_some())
}
