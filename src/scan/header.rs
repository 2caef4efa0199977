//! What the headers of picture files say beside the pixels: resolution, further pages, completeness.

use exif::{Context, Exif, In, Reader, Tag, Value};
use std::io::Cursor;
use std::ops::Range;

/// Dots an inch below which a figure is taken for a slip.
const MIN_DPI: f64 = 20.0;
/// Dots an inch above which a figure is taken for a slip.
const MAX_DPI: f64 = 20_000.0;
/// What Exif writes when the resolution is unknown, dots an inch (Exif 2.3 sec. 4.6.4, `XResolution`).
const EXIF_UNKNOWN_DPI: f64 = 72.0;
/// How far the resolutions of the two axes may differ, as a ratio, and still count as one.
const SQUARE: f64 = 0.01;
/// Metres an inch.
const METRES_PER_INCH: f64 = 0.0254;
/// Centimetres an inch.
const CM_PER_INCH: f64 = 2.54;

/// Resolution in dots an inch where the file says it, says it for both axes alike, and it makes sense.
pub(super) fn dpi(bytes: &[u8]) -> Option<f64> {
    let exact = || {
        png_dpi(bytes)
            .or_else(|| bmp_dpi(bytes))
            .or_else(|| pcx_dpi(bytes))
    };
    let (x, y) = exact()
        .or_else(|| exif_dpi(bytes))
        .or_else(|| jfif_dpi(bytes))?;
    let fine = (MIN_DPI..=MAX_DPI).contains(&x) && (x / y - 1.0).abs() <= SQUARE;
    fine.then_some(x)
}

/// The number that stands at a place, in this order of its bytes.
fn number<T, const N: usize>(bytes: &[u8], at: usize, of: fn([u8; N]) -> T) -> Option<T> {
    Some(of(*bytes.get(at..)?.first_chunk()?))
}

/// The content of a chunk that stands before the first `IDAT` of a PNG.
pub(super) fn png_chunk<'a>(bytes: &'a [u8], kind: &[u8; 4]) -> Option<&'a [u8]> {
    let mut at = bytes.starts_with(b"\x89PNG").then_some(8)?;
    loop {
        let length = number(bytes, at, u32::from_be_bytes)? as usize;
        let end = at.checked_add(8)?.checked_add(length)?;
        match bytes.get(at + 4..at + 8)? {
            found if found == kind => return bytes.get(at + 8..end),
            b"IDAT" => return None,
            _ => at = end.checked_add(4)?,
        }
    }
}

/// `pHYs`, where it counts pixels a metre.
fn png_dpi(bytes: &[u8]) -> Option<(f64, f64)> {
    let size = png_chunk(bytes, b"pHYs").filter(|c| c.get(8) == Some(&1))?;
    let axis = |o| Some(f64::from(number(size, o, u32::from_be_bytes)?) * METRES_PER_INCH);
    Some((axis(0)?, axis(4)?))
}

/// Pixels a metre of `BITMAPINFOHEADER`.
fn bmp_dpi(bytes: &[u8]) -> Option<(f64, f64)> {
    let known = bytes.starts_with(b"BM") && number(bytes, 14, u32::from_le_bytes)? >= 40;
    let axis = |o| Some(f64::from(number(bytes, o, u32::from_le_bytes)?) * METRES_PER_INCH);
    known.then_some((axis(38)?, axis(42)?))
}

/// Dots an inch of a PCX header.
fn pcx_dpi(bytes: &[u8]) -> Option<(f64, f64)> {
    let axis = |o| number(bytes, o, u16::from_le_bytes).map(f64::from);
    is_pcx(bytes).then_some((axis(12)?, axis(14)?))
}

/// Whether the first bytes are those of a PCX file: maker 10, a known version, run-length coding.
pub(super) fn is_pcx(bytes: &[u8]) -> bool {
    matches!(bytes, [10, 0 | 2 | 3 | 4 | 5, 0 | 1, 1 | 2 | 4 | 8, ..])
}

/// The fields of TIFF itself and of Exif inside JPEG, WebP and PNG.
fn exif(bytes: &[u8]) -> Option<Exif> {
    let read = Reader::new().read_from_container(&mut Cursor::new(bytes));
    read.ok()
}

/// The ICC profile of TIFF's field, however few pixels stand beside it.
pub(super) fn tiff_profile(bytes: &[u8]) -> Option<Vec<u8>> {
    const PROFILE: Tag = Tag(Context::Tiff, 34675);
    match exif(bytes)?.get_field(PROFILE, In::PRIMARY)?.value {
        Value::Undefined(ref profile, _) | Value::Byte(ref profile) => Some(profile.clone()),
        _ => None,
    }
}

/// Whether Exif says that the colours are those of sRGB.
pub(super) fn exif_is_srgb(bytes: &[u8]) -> bool {
    let space = |e: Exif| {
        let field = e.get_field(Tag::ColorSpace, In::PRIMARY)?;
        field.value.get_uint(0)
    };
    exif(bytes).and_then(space) == Some(1)
}

/// `XResolution` and `YResolution`.
fn exif_dpi(bytes: &[u8]) -> Option<(f64, f64)> {
    let exif = exif(bytes)?;
    let axis = |tag| match exif.get_field(tag, In::PRIMARY)?.value {
        Value::Rational(ref v) => v.first().map(|r| r.to_f64()),
        _ => None,
    };
    let unit = exif.get_field(Tag::ResolutionUnit, In::PRIMARY);
    let scale = match unit.and_then(|f| f.value.get_uint(0)) {
        Some(3) => CM_PER_INCH,
        Some(1) => return None,
        _ => 1.0,
    };
    let (x, y) = (
        axis(Tag::XResolution)? * scale,
        axis(Tag::YResolution)? * scale,
    );
    ((x - EXIF_UNKNOWN_DPI).abs() > 1e-9).then_some((x, y))
}

/// Density of a JFIF header, which is the first segment of its file.
fn jfif_dpi(bytes: &[u8]) -> Option<(f64, f64)> {
    let here = bytes.starts_with(b"\xff\xd8\xff\xe0") && bytes.get(6..11) == Some(b"JFIF\0");
    let scale = match (here, bytes.get(13)?) {
        (true, 1) => 1.0,
        (true, 2) => CM_PER_INCH,
        _ => return None,
    };
    let axis = |o| Some(f64::from(number(bytes, o, u16::from_be_bytes)?) * scale);
    Some((axis(14)?, axis(16)?))
}

/// Whether a JPEG file reaches its end marker. Decoders fill what is missing with grey.
pub(super) fn jpeg_is_whole(bytes: &[u8]) -> bool {
    fn end(bytes: &[u8]) -> Option<()> {
        let mut at = 2;
        loop {
            while *bytes.get(at)? != 0xff {
                at += 1;
            }
            match bytes.get(at + 1)? {
                0xd9 => return Some(()),
                0xff => at += 1,
                // stuffed bytes and restarts inside the coded picture, and markers without a length
                0x00 | 0x01 | 0xd0..=0xd8 => at += 2,
                _ => at += 2 + usize::from(number(bytes, at + 2, u16::from_be_bytes)?),
            }
        }
    }
    end(bytes).is_some()
}

/// How a TIFF file's numbers are read, and written.
type Order = (fn([u8; 2]) -> u16, fn([u8; 4]) -> u32, fn(u32) -> [u8; 4]);

/// Where a TIFF file's header says where its first page's directory is.
pub(super) const TIFF_FIRST: Range<usize> = 4..8;

/// What [`TIFF_FIRST`] would hold for each page of a TIFF file, were that page the first; empty when there are fewer
/// than two or the chain is broken.
pub(super) fn tiff_pages(bytes: &[u8]) -> Vec<[u8; 4]> {
    /// Pages of one file; a chain that is longer runs in a circle.
    const MAX_PAGES: usize = 1000;
    let (short, long, order): Order = match bytes.get(..4) {
        Some(b"II*\0") => (u16::from_le_bytes, u32::from_le_bytes, u32::to_le_bytes),
        Some(b"MM\0*") => (u16::from_be_bytes, u32::from_be_bytes, u32::to_be_bytes),
        _ => return Vec::new(),
    };
    let next = |at: usize| {
        let entries = usize::from(number(bytes, at, short)?);
        number(bytes, at.checked_add(2 + 12 * entries)?, long)
    };
    let first = number(bytes, 4, long).filter(|&o| o != 0);
    let chain = std::iter::successors(first, |&o| next(o as usize).filter(|&o| o != 0));
    let starts: Vec<u32> = chain.take(MAX_PAGES + 1).collect();
    if starts.len() < 2 || starts.len() > MAX_PAGES {
        return Vec::new();
    }
    starts.into_iter().map(order).collect()
}
