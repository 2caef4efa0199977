//! Tests: light that the file itself describes, in every way in which files do.

use super::*;
use image::codecs::{jpeg::JpegEncoder, png::PngEncoder, webp::WebPEncoder};
use image::{GrayImage, ImageBuffer, ImageEncoder, Luma, RgbImage};

/// Where the test pictures' edge lies, px.
const EDGE: f64 = 20.3;
/// How wide it is blurred, px.
const BLUR: f64 = 3.0;
const WIDTH: u32 = 40;
const HEIGHT: u32 = 30;

/// sRGB's number of a light.
fn srgb(light: f64) -> f64 {
    if light <= 0.003_130_8 {
        12.92 * light
    } else {
        1.055 * libm::pow(light, 1.0 / 2.4) - 0.055
    }
}

/// The number of a light by a gamma of 1.8.
fn gamma(light: f64) -> f64 {
    libm::pow(light, 1.0 / 1.8)
}

/// Light on the left, dark on the right, blurred in light.
fn edge(x: u32, number: fn(f64) -> f64) -> f64 {
    let beyond = (f64::from(x) + 0.5 - EDGE) / BLUR;
    number((0.5 - beyond).clamp(0.0, 1.0))
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "0 to 255"
)]
fn grey(number: fn(f64) -> f64) -> DynamicImage {
    let level = |x| (255.0 * edge(x, number)).round() as u8;
    DynamicImage::from(GrayImage::from_fn(WIDTH, HEIGHT, |x, _| Luma([level(x)])))
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "0 to 65535"
)]
fn deep(number: fn(f64) -> f64) -> DynamicImage {
    let level = |x| (65535.0 * edge(x, number)).round() as u16;
    DynamicImage::from(ImageBuffer::from_fn(WIDTH, HEIGHT, |x, _| Luma([level(x)])))
}

fn read(file: &[u8], tones: Tones) -> Result<Gray, ScanError> {
    let reading = Reading {
        tones,
        polarity: Polarity::DarkInk,
        ..Reading::default()
    };
    let mut pages = load(file, "page", reading)?;
    Ok(pages.remove(0).gray)
}

/// Where ink begins, px.
fn place(what: &str, file: &[u8], tones: Tones) -> f64 {
    let gray = read(file, tones).unwrap_or_else(|e| panic!("{what}: {e}"));
    let row: Vec<f64> = (0..40).map(|x| f64::from(gray.at(x, 9))).collect();
    let x = row.iter().position(|v| *v > 0.5).unwrap();
    let back = (row[x] - 0.5) / (row[x] - row[x - 1]);
    x as f64 + 0.5 - back
}

/// An ICC profile of version 2: header, table, tags.
fn icc(space: &[u8; 4], pcs: &[u8; 4], tags: &[(&[u8; 4], Vec<u8>)]) -> Vec<u8> {
    let mut out = vec![0; 128];
    out[8..12].copy_from_slice(&[2, 0x40, 0, 0]);
    for (at, text) in [(12, b"scnr"), (16, space), (20, pcs), (36, b"acsp")] {
        out[at..at + 4].copy_from_slice(text);
    }
    out.extend(u32::try_from(tags.len()).unwrap().to_be_bytes());
    let mut at = 132 + 12 * tags.len();
    for (name, tag) in tags {
        out.extend_from_slice(*name);
        out.extend(
            [at, tag.len()]
                .map(|v| u32::try_from(v).unwrap().to_be_bytes())
                .concat(),
        );
        at += tag.len();
    }
    out.extend(tags.iter().flat_map(|(_, tag)| tag.clone()));
    let size = u32::try_from(out.len()).unwrap();
    out[..4].copy_from_slice(&size.to_be_bytes());
    out
}

/// A tag of numbers in parts of 65536.
fn fixed(kind: &[u8; 8], numbers: &[f64]) -> Vec<u8> {
    #[expect(clippy::cast_possible_truncation, reason = "small")]
    let parts = numbers
        .iter()
        .map(|v| ((v * 65536.0).round() as i32).to_be_bytes());
    [kind.to_vec(), parts.collect::<Vec<_>>().concat()].concat()
}

/// A curve of one gamma; a curve's kind stands before it.
fn power(gamma: f64) -> Vec<u8> {
    fixed(b"para\0\0\0\0", &[0.0, gamma])
}

/// A curve of samples.
fn samples(of: &[f64]) -> Vec<u8> {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "0 to 65535"
    )]
    let levels = of
        .iter()
        .map(|v| ((v * 65535.0).round() as u16).to_be_bytes());
    let count = u32::try_from(of.len()).unwrap().to_be_bytes();
    [
        b"curv\0\0\0\0".to_vec(),
        count.to_vec(),
        levels.collect::<Vec<_>>().concat(),
    ]
    .concat()
}

fn of_grey(curve: Vec<u8>) -> Vec<u8> {
    icc(b"GRAY", b"XYZ ", &[(b"kTRC", curve)])
}

/// Primaries of these luminances, and these curves.
fn of_rgb(luminance: [f64; 3], curves: [Vec<u8>; 3]) -> Vec<u8> {
    let [r, g, b] = luminance.map(|y| fixed(b"XYZ \0\0\0\0", &[0.3, y, 0.3]));
    let [red, green, blue] = curves;
    let tags = [
        (b"rXYZ", r),
        (b"gXYZ", g),
        (b"bXYZ", b),
        (b"rTRC", red),
        (b"gTRC", green),
        (b"bTRC", blue),
    ];
    icc(b"RGB ", b"XYZ ", &tags)
}

/// The parametric curve of sRGB.
fn of_srgb() -> Vec<u8> {
    let parts = [2.4, 1.0 / 1.055, 0.055 / 1.055, 1.0 / 12.92, 0.040_45];
    let curve = fixed(b"para\0\0\0\0", &[&[3.0], parts.as_slice()].concat());
    of_rgb(
        [0.2225, 0.7169, 0.0606],
        [curve.clone(), curve.clone(), curve],
    )
}

fn written(image: &DynamicImage, mut to: impl ImageEncoder, profile: Option<Vec<u8>>) {
    if let Some(profile) = profile {
        to.set_icc_profile(profile).unwrap();
    }
    image.write_with_encoder(to).unwrap();
}

fn png(image: &DynamicImage, profile: Option<Vec<u8>>) -> Vec<u8> {
    let mut out = Vec::new();
    written(image, PngEncoder::new(&mut out), profile);
    out
}

/// With a chunk behind the header.
fn with_chunk(png: &[u8], kind: &[u8; 4], content: &[u8]) -> Vec<u8> {
    let chunk = [kind, content].concat();
    let length = u32::try_from(content.len()).unwrap().to_be_bytes();
    let sum = crc32fast::hash(&chunk).to_be_bytes();
    [&png[..33], &length, &chunk, &sum, &png[33..]].concat()
}

fn jpeg(image: &DynamicImage, profile: Option<Vec<u8>>) -> Vec<u8> {
    let mut out = Vec::new();
    written(image, JpegEncoder::new_with_quality(&mut out, 100), profile);
    out
}

fn webp(image: &DynamicImage, profile: Option<Vec<u8>>) -> Vec<u8> {
    let mut out = Vec::new();
    written(image, WebPEncoder::new_lossless(&mut out), profile);
    out
}

/// A TIFF file of one strip; a field's kind, count and value or place stand behind its tag.
fn tiff(pixels: &[u8], profile: Option<&[u8]>) -> Vec<u8> {
    let profile_at = 8 + pixels.len();
    let colours = profile_at + profile.map_or(0, <[u8]>::len);
    let mut fields = vec![
        (256, 4, 1, WIDTH as usize),
        (257, 4, 1, HEIGHT as usize),
        (258, 3, 1, 8),
        (259, 3, 1, 1),
        (262, 3, 1, 1),
        (273, 4, 1, 8),
        (277, 3, 1, 1),
        (278, 4, 1, HEIGHT as usize),
        (279, 4, 1, pixels.len()),
    ];
    match profile {
        Some(profile) => fields.push((34675, 7, profile.len(), profile_at)),
        None => fields.push((34665, 4, 1, colours)),
    }
    let field = |(tag, kind, count, value): (u16, u16, usize, usize)| {
        let [count, value] = [count, value].map(|v| u32::try_from(v).unwrap().to_le_bytes());
        [&tag.to_le_bytes()[..], &kind.to_le_bytes(), &count, &value].concat()
    };
    let directory = |fields: Vec<_>| {
        let count = u16::try_from(fields.len()).unwrap().to_le_bytes();
        let fields: Vec<_> = fields.into_iter().map(field).collect();
        [&count[..], &fields.concat(), &[0; 4]].concat()
    };
    let exif = directory(vec![(0xa001, 3, 1, 1)]);
    let start = u32::try_from(colours + exif.len()).unwrap().to_le_bytes();
    let head = [b"II*\0", &start[..], pixels, profile.unwrap_or_default()].concat();
    [head, exif, directory(fields)].concat()
}

/// With Exif that names a colour space.
fn with_exif(jpeg: &[u8], space: u8) -> Vec<u8> {
    let exif = [
        b"Exif\0\0MM\0*\0\0\0\x08\0\x01".as_slice(),
        b"\x87\x69\0\x04\0\0\0\x01\0\0\0\x1a\0\0\0\0",
        b"\0\x01\xa0\x01\0\x03\0\0\0\x01\0",
        &[space],
        b"\0\0\0\0\0\0",
    ]
    .concat();
    let length = u16::try_from(exif.len() + 2).unwrap().to_be_bytes();
    [&jpeg[..2], b"\xff\xe1", &length, &exif, &jpeg[2..]].concat()
}

/// A scan in a PDF with a colour space; object 5 is a profile.
fn pdf(image: &DynamicImage, space: &str, profile: &[u8]) -> Vec<u8> {
    let entries = format!("/ColorSpace {space} /BitsPerComponent 8");
    pdf_file(&entries, image.as_bytes(), &[pdf_stream("/N 1", profile)])
}

/// The file's own description puts the edge where it is, and its numbers as they stand do not.
fn is_read(what: &str, file: &[u8]) {
    let (raw, read) = (
        place(what, file, Tones::Linear),
        place(what, file, Tones::Profile),
    );
    assert!((read - EDGE).abs() < 0.02, "{what}: {read}");
    assert!((raw - EDGE).abs() > 0.4, "{what}, as it stands: {raw}");
    assert!(
        describes_light(file) || what.starts_with("PDF"),
        "{what}: told"
    );
}

#[test]
fn a_profile_of_any_carrier_is_read() {
    let (eight, sixteen) = (grey(gamma), deep(gamma));
    let own = of_grey(power(1.8));
    is_read("PNG", &png(&eight, Some(own.clone())));
    is_read("PNG of 16 bit", &png(&sixteen, Some(own.clone())));
    is_read("JPEG", &jpeg(&eight, Some(own.clone())));
    is_read("TIFF", &tiff(eight.as_bytes(), Some(&own)));
    let colour = DynamicImage::from(eight.to_rgb8());
    let alike = of_rgb([0.2, 0.7, 0.1], [power(1.8), power(1.8), power(1.8)]);
    is_read("WebP", &webp(&colour, Some(alike.clone())));
    is_read(
        "red, green and blue",
        &png(&DynamicImage::from(sixteen.to_rgb16()), Some(alike.clone())),
    );
    is_read("grey by curves of colours", &png(&eight, Some(alike)));
    is_read("sRGB", &png(&grey(srgb), Some(of_srgb())));
    let opaque = DynamicImage::from(eight.to_luma_alpha8());
    is_read("with opacity", &png(&opaque, Some(own)));
}

#[test]
fn curves_of_every_kind_are_read() {
    let number = |i: u32| f64::from(i) / 1023.0;
    let table: Vec<f64> = (0..1024).map(|i| libm::pow(number(i), 1.8)).collect();
    is_read(
        "samples",
        &png(&deep(gamma), Some(of_grey(samples(&table)))),
    );
    // one sample is a gamma in parts of 256
    let one = [b"curv\0\0\0\0\0\0\0\x01".as_slice(), &461u16.to_be_bytes()].concat();
    is_read("one number", &png(&deep(gamma), Some(of_grey(one))));
    // light of a grey profile that is connected by lightness
    let lightness: fn(f64) -> f64 = |light| {
        if light > 0.008_856 {
            1.16 * libm::cbrt(light) - 0.16
        } else {
            9.033 * light
        }
    };
    let by_lightness = icc(b"GRAY", b"Lab ", &[(b"kTRC", power(1.0))]);
    is_read("lightness", &png(&deep(lightness), Some(by_lightness)));
}

#[test]
fn chunks_of_png_and_exif_are_read() {
    let plain = png(&grey(srgb), None);
    is_read("sRGB", &with_chunk(&plain, b"sRGB", &[1]));
    is_read("cICP", &with_chunk(&plain, b"cICP", &[1, 13, 0, 1]));
    let coded = png(&deep(gamma), None);
    is_read(
        "gAMA",
        &with_chunk(&coded, b"gAMA", &55_556u32.to_be_bytes()),
    );
    let linear = with_chunk(&plain, b"gAMA", &100_000u32.to_be_bytes());
    assert!(!describes_light(&linear), "numbers that are light");
    is_read("Exif", &with_exif(&jpeg(&grey(srgb), None), 1));
    is_read("Exif in TIFF", &tiff(grey(srgb).as_bytes(), None));
}

#[test]
fn the_better_description_counts() {
    let plain = png(&grey(srgb), None);
    let linear = with_chunk(&plain, b"gAMA", &100_000u32.to_be_bytes());
    is_read("sRGB before gAMA", &with_chunk(&linear, b"sRGB", &[0]));
    let other = png(&grey(srgb), Some(of_grey(power(1.0))));
    is_read(
        "cICP before a profile",
        &with_chunk(&other, b"cICP", &[1, 13, 0, 1]),
    );
    let own = png(&grey(srgb), Some(of_srgb()));
    is_read(
        "a profile before gAMA",
        &with_chunk(&own, b"gAMA", &100_000u32.to_be_bytes()),
    );
    is_read(
        "a profile before Exif",
        &with_exif(&jpeg(&grey(gamma), Some(of_grey(power(1.8)))), 1),
    );
}

#[test]
fn scans_in_a_pdf_are_read_by_their_colour_space() {
    is_read(
        "PDF, profile",
        &pdf(&grey(gamma), "[/ICCBased 5 0 R]", &of_grey(power(1.8))),
    );
    is_read(
        "PDF, grey",
        &pdf(
            &grey(gamma),
            "[/CalGray << /WhitePoint [1 1 1] /Gamma 1.8 >>]",
            b"",
        ),
    );
    let colour = DynamicImage::from(grey(gamma).to_rgb8());
    let space = "[/CalRGB << /Gamma [1.8 1.8 1.8] /Matrix [0.4 0.2 0 0.4 0.7 0.1 0.2 0.1 0.9] >>]";
    is_read("PDF, colours", &pdf(&colour, space, b""));
    for silent in [
        "/DeviceGray",
        "[/CalGray]",
        "[/ICCBased 9 0 R]",
        "[/CalGray << /Gamma 0 >>]",
        "[]",
    ] {
        let wrong = read(&pdf(&grey(gamma), silent, b""), Tones::Profile).unwrap_err();
        assert!(matches!(wrong.fault, Fault::Tones(_)), "{silent}: {wrong}");
    }
    let wrong = read(
        &pdf(&grey(gamma), "[/ICCBased 5 0 R]", b"nothing"),
        Tones::Profile,
    )
    .unwrap_err();
    assert!(wrong.to_string().contains("damaged"), "{wrong}");
}

#[test]
fn colours_count_by_their_luminance() {
    let red = DynamicImage::from(RgbImage::from_pixel(9, 9, image::Rgb([255, 0, 0])));
    let file = |y| png(&red, Some(of_rgb(y, [power(1.8), power(1.8), power(1.8)])));
    for (y, wanted) in [([0.5, 0.25, 0.25], 0.5), ([0.6, 0.9, -0.01], 0.4)] {
        let ink = read(&file(y), Tones::Profile).unwrap().at(4, 4);
        assert!((1.0 - ink - wanted).abs() < 1e-4, "{y:?}: {ink}");
    }
    for dark in [[0.0; 3], [-1.0; 3]] {
        let wrong = read(&file(dark), Tones::Profile).unwrap_err().to_string();
        assert!(wrong.contains("no light"), "{wrong}");
    }
}

#[test]
fn files_that_do_not_say_are_refused_with_what_to_do() {
    let grey = grey(srgb);
    let mut bmp = Cursor::new(Vec::new());
    grey.write_to(&mut bmp, ImageFormat::Bmp).unwrap();
    let table = icc(b"RGB ", b"Lab ", &[]);
    let of_ink = icc(b"CMYK", b"Lab ", &[]);
    let cases = [
        ("nothing said", png(&grey, None), "no colour profile"),
        ("BMP", bmp.into_inner(), "no colour profile"),
        (
            "another space",
            with_exif(&jpeg(&grey, None), 2),
            "no colour profile",
        ),
        ("no curves", png(&grey, Some(table)), "only tables"),
        ("inks", png(&grey, Some(of_ink)), "neither"),
        (
            "narrow",
            with_chunk(&png(&grey, None), b"cICP", &[1, 13, 0, 0]),
            "full range",
        ),
        (
            "unknown",
            with_chunk(&png(&grey, None), b"cICP", &[1, 2, 0, 1]),
            "names no",
        ),
        (
            "reserved",
            with_chunk(&png(&grey, None), b"cICP", &[1, 99, 0, 1]),
            "names no",
        ),
    ];
    for (what, file, why) in cases {
        let wrong = read(&file, Tones::Profile).unwrap_err().to_string();
        let fine =
            wrong.contains(why) && wrong.starts_with("page ") && wrong.contains("tones = \"srgb\"");
        assert!(fine, "{what}: {wrong}");
        assert!(
            read(&file, Tones::Linear).is_ok() && !describes_light(&file),
            "{what}"
        );
    }
}

#[test]
fn hostile_profiles_are_refused() {
    let grey = grey(srgb);
    let file = |profile: Vec<u8>| png(&grey, Some(profile));
    let cut = of_grey(power(1.8))[..150].to_vec();
    let mut huge = of_grey(power(1.8));
    huge.resize(20_000_000, 0);
    let mut far = of_grey(power(1.8));
    far[136..144].fill(0xff);
    let many = [b"curv\0\0\0\0".as_slice(), &[0xff; 4], &[0; 64]].concat();
    let cases = [
        ("words", file(b"just some words".to_vec())),
        ("cut off", file(cut)),
        ("huge", file(huge)),
        ("a tag beyond the end", file(far)),
        ("more samples than there are", file(of_grey(many))),
        ("light of none", file(of_grey(samples(&[0.0; 9])))),
        ("light of all", file(of_grey(samples(&[1.0; 9])))),
        ("falling", file(of_grey(samples(&[1.0, 0.5, 0.0])))),
        ("gamma 0", file(of_grey(power(0.0)))),
        ("gamma -1", file(of_grey(power(-1.0)))),
        ("gamma 100", file(of_grey(power(100.0)))),
        (
            "root of less than nothing",
            file(of_grey(fixed(
                b"para\0\0\0\0",
                &[3.0, 0.5, 1.0, -2.0, 1.0, 0.0],
            ))),
        ),
        (
            "light of no number between others",
            file(of_grey(fixed(
                b"para\0\0\0\0",
                &[3.0, 0.5, 1.0, -0.3, 1.0, 0.1],
            ))),
        ),
        (
            "division by 0",
            file(of_grey(fixed(b"para\0\0\0\0", &[1.0, 1.8, 0.0, 0.0]))),
        ),
        (
            "no such curve",
            file(of_grey(fixed(b"para\0\0\0\0", &[9.0, 1.8]))),
        ),
        ("gAMA of 0", with_chunk(&png(&grey, None), b"gAMA", &[0; 4])),
        (
            "gAMA of all",
            with_chunk(&png(&grey, None), b"gAMA", &[0xff; 4]),
        ),
        (
            "gAMA too short",
            with_chunk(&png(&grey, None), b"gAMA", &[1]),
        ),
    ];
    for (what, file) in cases {
        let wrong = read(&file, Tones::Profile).map_err(|e| e.fault);
        let told = matches!(wrong, Err(Fault::Tones(_) | Fault::Decode(_)));
        assert!(told, "{what}: {wrong:?}");
    }
}

#[test]
fn a_profile_that_would_fill_memory_is_not_unpacked() {
    let packed = vec![0; 2_400_000];
    let wrong = read(
        &with_chunk(&png(&grey(srgb), None), b"iCCP", &packed),
        Tones::Linear,
    );
    assert!(wrong.unwrap_err().to_string().contains("larger than"));
}

#[test]
fn no_damage_of_a_profile_is_the_end() {
    let whole = of_srgb();
    for at in 0..whole.len() {
        let mut damaged = whole.clone();
        damaged[at] = 0xff;
        profile::icc(&damaged).ok();
        assert!(profile::icc(&whole[..at]).is_err(), "cut at {at}");
    }
}
