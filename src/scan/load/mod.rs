//! Picture files → [`Sheet`]s: decoded, turned as the file says, grey, ink made 1.

mod colour;
mod pdf;
mod polarity;
mod profile;
mod tones;

use super::error::{Fault, MAX_PIXELS, ScanError};
use super::header;
use super::paper::is_outermost;
use crate::numeric::median::range;
use crate::types::{Gray, Shade, Sheet};
use image::error::ImageError;
use image::metadata::Orientation;
use image::{DynamicImage, ImageDecoder, ImageReader, Limits};
use image_extras::pcx::PCXDecoder;
use polarity::{Certainty, Guess, guess};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::io::{Cursor, ErrorKind};

pub use tones::Tones;
use tones::{Light, Sample};

/// Bytes that decoding one page may take: eight a pixel, 16 bit RGBA, of the largest page.
const MAX_BYTES: u64 = 8 * MAX_PIXELS;
/// Rec. 709 luma weights of red, green and blue.
const LUMA: [f32; 3] = [0.2126, 0.7152, 0.0722];
/// So many times its size is the most that DEFLATE unpacks to.
const DEFLATE: u64 = 1032;
/// A picture whose colours differ by less than this, of 1, says nothing by its colours.
const FLAT: f32 = 0.02;

/// How closely a picture's colours are looked at.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum ColourDetail {
    /// In blocks: enough to tell pieces of ink apart. Ink is what luma says.
    #[default]
    Blocks,
    /// In pixels: layers are to be made of the inks. Ink is what the darkest of red, green and blue says, so that
    /// light colours count as much as dark ones.
    Pixels,
}

/// Which of dark and light is the ink.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Polarity {
    /// Dark ink, unless most of the picture and nine tenths of its outermost ring of pixels are dark, by the levels
    /// of its own ink and paper, and it shows no light page on a dark table.
    #[default]
    Auto,
    /// Dark ink on light paper.
    DarkInk,
    /// Light ink on a dark ground.
    LightInk,
}

/// How a picture file is read.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Reading {
    /// Which of dark and light is the ink.
    pub polarity: Polarity,
    /// How its numbers tell light.
    pub tones: Tones,
    /// How it must be turned.
    pub turn: Turn,
    /// How closely its colours are looked at.
    pub colours: ColourDetail,
}

impl From<Polarity> for Reading {
    fn from(polarity: Polarity) -> Self {
        Self {
            polarity,
            ..Self::default()
        }
    }
}

/// How a picture must be turned to stand upright, beyond what its file says: clockwise.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "u16", into = "u16")]
pub enum Turn {
    /// It stands upright.
    #[default]
    None,
    /// 90°.
    Quarter,
    /// 180°.
    Half,
    /// 270°.
    ThreeQuarters,
}

impl TryFrom<u16> for Turn {
    type Error = &'static str;

    fn try_from(degrees: u16) -> Result<Self, Self::Error> {
        Ok(match degrees {
            0 => Self::None,
            90 => Self::Quarter,
            180 => Self::Half,
            270 => Self::ThreeQuarters,
            _ => return Err("turn must be 0, 90, 180 or 270 degrees clockwise"),
        })
    }
}

impl From<Turn> for u16 {
    fn from(turn: Turn) -> Self {
        match turn {
            Turn::None => 0,
            Turn::Quarter => 90,
            Turn::Half => 180,
            Turn::ThreeQuarters => 270,
        }
    }
}

impl Turn {
    fn apply(self, image: DynamicImage) -> DynamicImage {
        match self {
            Self::None => image,
            Self::Quarter => image.rotate90(),
            Self::Half => image.rotate180(),
            Self::ThreeQuarters => image.rotate270(),
        }
    }
}

/// The pages of a file in order, almost always one: PNG, JPEG, TIFF, BMP, GIF, WebP, PNM or PCX of 8 or
/// 16 bit, or the scans inside a PDF. `source` names the file in messages.
///
/// Ink is 1 − luma (or luma, see [`Polarity`]), black and white of the file being 1 and 0: levels and noise
/// stay as they were scanned, numbers in proportion to light ([`Tones`]). Transparency lies over white paper; where
/// colour says nothing, opacity is the ink.
///
/// # Errors
/// The content is no picture of these kinds, ends too early, is damaged, or is larger than a page can be.
pub fn load(bytes: &[u8], source: &str, reading: Reading) -> Result<Vec<Sheet>, ScanError> {
    sheets(bytes, source, reading, |_| true).map(|pages| pages.into_iter().flatten().collect())
}

/// The page `number` of a file, from 1, where it has that many, and how many it has; otherwise as [`load`]. No other
/// page of a TIFF or PDF file is decoded.
///
/// # Errors
/// The content is no picture of these kinds, or that page ends too early, is damaged, or is larger than a page can
/// be.
pub fn load_page(
    bytes: &[u8],
    source: &str,
    reading: Reading,
    number: usize,
) -> Result<(Option<Sheet>, usize), ScanError> {
    let mut pages = sheets(bytes, source, reading, |n| n == number)?;
    let page = number.checked_sub(1).and_then(|i| pages.get_mut(i));
    Ok((page.and_then(Option::take), pages.len()))
}

/// The pages of a file, those decoded whose number, from 1, is wanted.
fn sheets(
    bytes: &[u8],
    source: &str,
    reading: Reading,
    wanted: impl Fn(usize) -> bool,
) -> Result<Vec<Option<Sheet>>, ScanError> {
    let pictures = pictures(bytes, reading.tones, wanted);
    let pictures = pictures.map_err(|fault| fault.of(source, None))?;
    let several = pictures.len() > 1;
    let name = |n: usize| {
        if several {
            format!("{source}, page {n}")
        } else {
            source.to_owned()
        }
    };
    let pages = pictures.into_iter().zip(1..);
    pages
        .map(|(picture, n)| picture.map(|p| sheet(p, name(n), reading)).transpose())
        .collect()
}

/// The pictures of a file in order, decoded where their number, from 1, is wanted.
fn pictures(
    bytes: &[u8],
    tones: Tones,
    wanted: impl Fn(usize) -> bool,
) -> Result<Vec<Option<Decoded>>, Fault> {
    if pdf::is_pdf(bytes) {
        return pdf::pages(bytes, tones, wanted);
    }
    let pages = header::tiff_pages(bytes);
    if pages.is_empty() {
        // what cannot be decoded has no pages to count
        return Ok(vec![Some(decode(bytes, tones)?)]);
    }
    // decoders begin at the first page: one copy, whose header points to one after the other
    let mut file = bytes.to_vec();
    let begun = |(first, number): ([u8; 4], usize)| {
        file[header::TIFF_FIRST].copy_from_slice(&first);
        wanted(number).then(|| decode(&file, tones)).transpose()
    };
    pages.into_iter().zip(1..).map(begun).collect()
}

/// A page as its file has it, upright.
struct Decoded {
    image: DynamicImage,
    /// of the image's numbers
    light: Light,
    /// dots an inch
    dpi: Option<f64>,
}

fn sheet(page: Decoded, source: String, reading: Reading) -> Result<Sheet, ScanError> {
    let Decoded { image, light, dpi } = page;
    let image = reading.turn.apply(image);
    let (width, height) = (image.width() as usize, image.height() as usize);
    let mut colours = colour::colours(&image, reading.colours);
    let mut samples = ink(image, &light, reading.colours);
    let told = |shade| Guess {
        shade,
        certainty: Certainty::Sure,
    };
    let guess = match reading.polarity {
        Polarity::Auto => guess(&samples, width),
        Polarity::DarkInk => told(Shade::Dark),
        Polarity::LightInk => told(Shade::Light),
    };
    if guess.shade == Shade::Light {
        samples.par_iter_mut().for_each(|v| *v = 1.0 - *v);
        colours = None; // what light ink swallows says nothing of it
    }
    let gray = Gray::new(width, height, samples)
        .map_err(|e| Fault::Decode(e.to_string()).of(&source, None))?;
    Ok(Sheet {
        gray,
        colours,
        dpi,
        guessed: (guess.certainty == Certainty::Doubtful).then_some(guess.shade),
        source,
    })
}

/// The light of a picture's numbers, which `told` says where `tones` leaves it to the file.
fn light(tones: Tones, told: impl FnOnce() -> Result<Light, String>) -> Result<Light, Fault> {
    let known = tones.light().map_or_else(told, Ok);
    known.map_err(Fault::Tones)
}

/// Whether a picture file says itself that its numbers are not in proportion to light, so that [`Tones::Profile`]
/// reads it otherwise than [`Tones::Linear`]: its first page, and not of a PDF file.
#[must_use]
pub fn describes_light(bytes: &[u8]) -> bool {
    let told = |mut decoder: Box<dyn ImageDecoder + '_>| profile::of_file(bytes, &mut decoder).ok();
    let light = opened(bytes).ok().and_then(told);
    light.is_some() && light != Tones::Linear.light()
}

/// The picture as the file has it, turned upright as its orientation tag says.
fn decode(bytes: &[u8], tones: Tones) -> Result<Decoded, Fault> {
    let mut decoder = opened(bytes)?;
    if bytes.starts_with(b"\xff\xd8") && !header::jpeg_is_whole(bytes) {
        return Err(Fault::Truncated);
    }
    let light = light(tones, || profile::of_file(bytes, &mut decoder))?;
    let orientation = decoder.orientation().unwrap_or(Orientation::NoTransforms);
    let image = DynamicImage::from_decoder(decoder);
    let mut image = image.map_err(unreadable)?;
    image.apply_orientation(orientation);
    let dpi = header::dpi(bytes);
    Ok(Decoded { image, light, dpi })
}

/// What decodes a picture file that is no PDF, held to what a page may take.
fn opened(bytes: &[u8]) -> Result<Box<dyn ImageDecoder + '_>, Fault> {
    // a PNG's is unpacked before any limit holds
    let profile = header::png_chunk(bytes, b"iCCP").map_or(0, <[u8]>::len);
    if profile as u64 > MAX_BYTES / DEFLATE {
        let why = "its colour profile is larger than a page";
        return Err(Fault::Decode(why.to_owned()));
    }
    let mut decoder: Box<dyn ImageDecoder + '_> = if header::is_pcx(bytes) {
        Box::new(PCXDecoder::new(Cursor::new(bytes)).map_err(unreadable)?)
    } else {
        let reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format();
        let mut reader = reader.map_err(|_| Fault::Kind)?;
        reader.format().ok_or(Fault::Kind)?;
        reader.no_limits();
        Box::new(reader.into_decoder().map_err(unreadable)?)
    };
    let (width, height) = decoder.dimensions();
    if u64::from(width) * u64::from(height) > MAX_PIXELS || decoder.total_bytes() > MAX_BYTES {
        return Err(Fault::Large { width, height });
    }
    // `from_decoder` does not hold the decoder to any limit by itself.
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(2 * MAX_BYTES);
    limits.reserve(decoder.total_bytes()).map_err(unreadable)?;
    decoder.set_limits(limits).map_err(unreadable)?;
    Ok(decoder)
}

/// What a decoder says is wrong.
fn unreadable(wrong: ImageError) -> Fault {
    match wrong {
        ImageError::IoError(e) if e.kind() == ErrorKind::UnexpectedEof => Fault::Truncated,
        e => Fault::Decode(e.to_string()),
    }
}

/// Ink of every pixel over white.
fn ink(image: DynamicImage, light: &Light, detail: ColourDetail) -> Vec<f32> {
    let width = image.width() as usize;
    match image {
        DynamicImage::ImageLuma8(i) => grey(i.as_raw(), light),
        DynamicImage::ImageLumaA8(i) => grey_alpha((i.as_raw(), width), light),
        DynamicImage::ImageRgb8(i) => rgb(i.as_raw(), light, detail),
        DynamicImage::ImageRgba8(i) => rgba((i.as_raw(), width), light, detail),
        DynamicImage::ImageLuma16(i) => grey(i.as_raw(), light),
        DynamicImage::ImageLumaA16(i) => grey_alpha((i.as_raw(), width), light),
        DynamicImage::ImageRgb16(i) => rgb(i.as_raw(), light, detail),
        other => rgba((other.into_rgba16().as_raw(), width), light, detail),
    }
}

fn grey<S: Sample>(raw: &[S], light: &Light) -> Vec<f32> {
    raw.par_iter().map(|s| 1.0 - light.grey(*s)).collect()
}

fn rgb<S: Sample>(raw: &[S], light: &Light, detail: ColourDetail) -> Vec<f32> {
    let pixels = raw.par_chunks_exact(3);
    pixels.map(|p| 1.0 - light.colour(p, detail)).collect()
}

fn grey_alpha<S: Sample>((raw, width): (&[S], usize), light: &Light) -> Vec<f32> {
    let pixels = raw.par_chunks_exact(2);
    let pixels = pixels.map(|p| (light.grey(p[0]), p[1].unit()));
    over_white(pixels.collect(), width)
}

fn rgba<S: Sample>((raw, width): (&[S], usize), light: &Light, detail: ColourDetail) -> Vec<f32> {
    let pixels = raw.par_chunks_exact(4);
    let pixels = pixels.map(|p| (light.colour(&p[..3], detail), p[3].unit()));
    over_white(pixels.collect(), width)
}

/// Ink of (luma, opacity) pixels over white paper, in rows of `width`; where the visible colours are all one, or too
/// light to be ink on it though they lie on nothing, the opacity.
fn over_white(pixels: Vec<(f32, f32)>, width: usize) -> Vec<f32> {
    /// No pixel that lets more light through is ink.
    const INK: f32 = 0.5;
    let visible = pixels.iter().filter(|p| p.1 > FLAT).map(|p| &p.0);
    let (dark, light) = range(visible);
    let (clear, opaque) = range(pixels.iter().map(|p| &p.1));
    let over_paper = |(v, a): (f32, f32)| (1.0 - v) * a;
    let pale = || pixels.iter().all(|p| over_paper(*p) < INK);
    let by_opacity = opaque - clear > FLAT
        && (light - dark < FLAT || (opaque > INK && pale() && lies_on_nothing(&pixels, width)));
    let ink = |p: (f32, f32)| if by_opacity { p.1 } else { over_paper(p) };
    pixels.into_par_iter().map(ink).collect()
}

/// Whether what can be seen is a drawing: less than half of the picture, and next to nothing of its outermost ring of
/// pixels. A pale page whose corners are transparent covers more.
fn lies_on_nothing(pixels: &[(f32, f32)], width: usize) -> bool {
    /// Opacity of what can be seen.
    const SEEN: f32 = 0.5;
    let seen = |p: &&(f32, f32)| p.1 >= SEEN;
    let ring = pixels.iter().enumerate();
    let ring = ring.filter(|(i, _)| is_outermost(*i, width, pixels.len()));
    let ring: Vec<_> = ring.map(|(_, p)| p).collect();
    let around = ring.iter().copied().filter(seen).count();
    2 * pixels.iter().filter(seen).count() < pixels.len() && 10 * around < ring.len()
}

#[cfg(test)]
mod tests;
