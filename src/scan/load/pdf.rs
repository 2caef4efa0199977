//! The scans that a PDF file holds: the largest picture of each page, at its own resolution.

use super::{Decoded, Tones, light, profile};
use crate::scan::error::{Fault, MAX_PIXELS};
use hayro_syntax::Pdf;
use hayro_syntax::object::stream::{FilterResult, ImageDecodeParams};
use hayro_syntax::object::{Array, Dict, Name, Stream};
use hayro_syntax::page::{Page, Rotation};
use image::{DynamicImage, GrayImage, RgbImage};

/// Points an inch.
const POINTS: f64 = 72.0;
/// How far the proportions of a picture may differ from its page's if it covers it, as a ratio.
const COVERS: f64 = 0.02;

/// Whether the content is a PDF file; some begin with a few other bytes.
pub(super) fn is_pdf(bytes: &[u8]) -> bool {
    bytes.windows(5).take(1024).any(|w| w == b"%PDF-")
}

/// The picture of each page whose number, from 1, is wanted, upright, with its resolution where it covers the page.
pub(super) fn pages(
    bytes: &[u8],
    tones: Tones,
    wanted: impl Fn(usize) -> bool,
) -> Result<Vec<Option<Decoded>>, Fault> {
    let pdf = Pdf::new(bytes.to_vec()).map_err(|_| fail("the PDF file cannot be read"))?;
    let pages = pdf.pages().iter().zip(1..);
    let pages = pages.map(|(p, number)| wanted(number).then(|| page(p, tones)).transpose());
    let found: Vec<Option<Decoded>> = pages.collect::<Result<_, _>>()?;
    if found.is_empty() {
        return Err(fail("the PDF file has no page"));
    }
    Ok(found)
}

fn fail(why: &str) -> Fault {
    Fault::Decode(why.to_owned())
}

fn page(page: &Page<'_>, tones: Tones) -> Result<Decoded, Fault> {
    let objects = &page.resources().x_objects;
    let pictures = objects.keys().filter_map(|key| {
        let stream = objects.get::<Stream<'_>>(&key)?;
        let dict = stream.dict();
        let is_image = dict.get::<Name<'_>>("Subtype")?.as_str() == "Image";
        let size = (dict.get::<u32>("Width")?, dict.get::<u32>("Height")?);
        is_image.then_some((size, stream))
    });
    let largest = pictures.max_by_key(|((w, h), _)| u64::from(*w) * u64::from(*h));
    let ((width, height), stream) = largest
        .ok_or_else(|| fail("a page of the PDF file holds no scan, only drawn text or lines"))?;
    if u64::from(width) * u64::from(height) > MAX_PIXELS {
        return Err(Fault::Large { width, height });
    }
    if claims_more(stream.dict(), width.max(height)) {
        return Err(fail(
            "its scan's coding claims other rows and columns than the scan has",
        ));
    }
    let light = light(tones, || profile::of_pdf(stream.dict()))?;
    let image = decode(&stream, (width, height)).map_err(fail)?;
    let media = page.media_box();
    let (across, down) = (
        (media.x1 - media.x0) / POINTS,
        (media.y1 - media.y0) / POINTS,
    );
    let (x, y) = (
        f64::from(image.width()) / across,
        f64::from(image.height()) / down,
    );
    let dpi = ((x / y - 1.0).abs() < COVERS).then_some(x);
    let image = match page.rotation() {
        Rotation::None => image,
        Rotation::Horizontal => image.rotate90(),
        Rotation::Flipped => image.rotate180(),
        Rotation::FlippedHorizontal => image.rotate270(),
    };
    Ok(Decoded { image, light, dpi })
}

/// Whether the parameters of its coding claim rows or columns far beyond its longer side, by which a decoder would
/// take memory.
fn claims_more(dict: &Dict<'_>, longer: u32) -> bool {
    let most = 64.0 + 4.0 * f64::from(longer);
    let beyond = |p: &Dict<'_>| {
        let numbers = ["Columns", "Rows", "Colors"].map(|key| p.get::<f64>(key));
        numbers.into_iter().flatten().any(|n| n.abs() > most)
    };
    let one = dict.get::<Dict<'_>>("DecodeParms");
    let several = dict.get::<Array<'_>>("DecodeParms");
    let several = several.iter().flat_map(|a| a.iter::<Dict<'_>>());
    one.into_iter().chain(several).any(|p| beyond(&p))
}

/// The picture of a stream; what is wrong with it otherwise.
fn decode(stream: &Stream<'_>, (width, height): (u32, u32)) -> Result<DynamicImage, &'static str> {
    let dict = stream.dict();
    let bits = dict.get::<u8>("BitsPerComponent");
    let space = dict
        .get::<Array<'_>>("ColorSpace")
        .and_then(|a| a.iter::<Name<'_>>().next());
    if space.is_some_and(|s| s.as_str() == "Indexed") {
        return Err("its scan has a palette; save it as a grey or colour picture");
    }
    let params = ImageDecodeParams {
        is_indexed: false,
        bpc: bits,
        num_components: None,
        target_dimension: None,
        width,
        height,
    };
    let FilterResult { data, image_data } = stream
        .decoded_image(&params)
        .map_err(|_| "its scan cannot be decoded")?;
    let (width, height, bits) = image_data.map_or((width, height, bits.unwrap_or(8)), |i| {
        (i.width, i.height, i.bits_per_component)
    });
    let inverted = dict
        .get::<Array<'_>>("Decode")
        .and_then(|a| a.iter::<f64>().next())
        .is_some_and(|v| v > 0.5);
    let samples = unpack(
        &data,
        (width, height),
        bits,
        if inverted { 0xff } else { 0 },
    )
    .ok_or("its scan is cut off")?;
    let pixels = u64::from(width) * u64::from(height);
    let image = match samples.len() as u64 / pixels.max(1) {
        1 => GrayImage::from_raw(width, height, samples).map(DynamicImage::ImageLuma8),
        3 => RgbImage::from_raw(width, height, samples).map(DynamicImage::ImageRgb8),
        4 => RgbImage::from_raw(
            width,
            height,
            samples.chunks_exact(4).flat_map(cmyk).collect(),
        )
        .map(DynamicImage::ImageRgb8),
        _ => None,
    };
    image.ok_or("its scan is neither grey nor colour")
}

/// Samples of 1, 2, 4, 8 or 16 bit, in rows of whole bytes, as 8 bit; `mask` turns them where 0 is white.
fn unpack(data: &[u8], (width, height): (u32, u32), bits: u8, mask: u8) -> Option<Vec<u8>> {
    let (w, h, bits) = (width as usize, height as usize, usize::from(bits));
    let row = data.len().checked_div(h)?;
    let channels = (row * 8).checked_div(w.checked_mul(bits)?)?;
    let count = w * channels;
    let line = |r: &[u8]| -> Vec<u8> {
        match bits {
            8 => r.get(..count).unwrap_or(&[]).to_vec(),
            16 => r.chunks_exact(2).take(count).map(|p| p[0]).collect(),
            1 | 2 | 4 => {
                let most = u8::try_from((1u16 << bits) - 1).unwrap_or(u8::MAX);
                let at = |i: usize| r[i * bits / 8] >> (8 - bits - i * bits % 8) & most;
                (0..count).map(|i| at(i) * (255 / most)).collect()
            }
            _ => Vec::new(),
        }
    };
    let samples: Vec<u8> = data
        .chunks_exact(row.max(1))
        .take(h)
        .flat_map(line)
        .map(|v| v ^ mask)
        .collect();
    (channels > 0 && samples.len() == count * h).then_some(samples)
}

/// Red, green and blue of four inks.
fn cmyk(p: &[u8]) -> [u8; 3] {
    let light = |i: usize| {
        let v = (255 - u16::from(p[i])) * (255 - u16::from(p[3])) / 255;
        u8::try_from(v).unwrap_or(u8::MAX)
    };
    [light(0), light(1), light(2)]
}
