//! Pictures of every kind of file.

mod carriers;
mod shades;

use super::*;
use image::imageops::invert;
use image::{
    ExtendedColorType, GrayAlphaImage, GrayImage, ImageEncoder, ImageFormat, Luma, LumaA,
    codecs::tiff::TiffEncoder,
};

/// A ramp with a dark spot.
fn picture() -> GrayImage {
    GrayImage::from_fn(40, 30, |x, y| {
        let spot = (10..14).contains(&x) && (8..12).contains(&y);
        Luma([if spot {
            20
        } else {
            200 + u8::try_from(x).unwrap_or(0)
        }])
    })
}

fn encoded(image: impl Into<DynamicImage>, format: ImageFormat) -> Vec<u8> {
    let mut out = Cursor::new(Vec::new());
    image.into().write_to(&mut out, format).unwrap();
    out.into_inner()
}

fn png(image: impl Into<DynamicImage>) -> Vec<u8> {
    encoded(image, ImageFormat::Png)
}

fn one(bytes: &[u8]) -> Sheet {
    let mut pages = load(bytes, "page", Reading::default()).unwrap();
    assert_eq!(pages.len(), 1, "one page");
    pages.remove(0)
}

/// The picture as PCX of 8 bit with a grey palette, by hand.
fn pcx(image: &GrayImage) -> Vec<u8> {
    let mut out = vec![10, 5, 1, 8, 0, 0, 0, 0, 39, 0, 29, 0, 44, 1, 44, 1];
    out.resize(128, 0);
    (out[65], out[66], out[68]) = (1, 40, 1);
    for p in image.as_raw() {
        out.extend(if *p >= 0xc0 { vec![0xc1, *p] } else { vec![*p] });
    }
    out.push(12);
    out.extend((0..=255u8).flat_map(|v| [v, v, v]));
    out
}

#[test]
fn every_kind_of_file_gives_the_same_ink() {
    let grey = DynamicImage::ImageLuma8(picture());
    let colour = DynamicImage::ImageRgb8(grey.to_rgb8());
    let deep = DynamicImage::ImageLuma16(grey.to_luma16());
    let files = [
        png(picture()),
        png(deep.clone()),
        png(colour.clone()),
        png(grey.to_rgba16()),
        png(grey.to_luma_alpha8()),
        encoded(deep, ImageFormat::Tiff),
        encoded(colour.clone(), ImageFormat::Bmp),
        encoded(colour.clone(), ImageFormat::WebP),
        encoded(picture(), ImageFormat::Pnm),
        encoded(colour, ImageFormat::Gif),
        pcx(&picture()),
    ];
    for (i, file) in files.iter().enumerate() {
        let sheet = one(file);
        assert_eq!((sheet.gray.width(), sheet.gray.height()), (40, 30));
        for (got, raw) in sheet.gray.samples().iter().zip(picture().as_raw()) {
            let want = 1.0 - f32::from(*raw) / 255.0;
            assert!((got - want).abs() < 1e-5, "file {i}: {got} for {want}");
        }
    }
    let lossy = one(&encoded(grey, ImageFormat::Jpeg));
    assert!(
        lossy.gray.at(12, 10) > 0.8 && lossy.gray.at(30, 20) < 0.2,
        "JPEG"
    );
}

#[test]
fn every_page_of_a_tiff_is_read() {
    let mut out = Cursor::new(Vec::new());
    let raw = picture().into_raw();
    TiffEncoder::new(&mut out)
        .write_image(&raw, 40, 30, ExtendedColorType::L8)
        .unwrap();
    let mut file = out.into_inner();
    // a second directory that shows the same strips, one column narrower on paper
    let start = u32::from_le_bytes(*file[4..].first_chunk().unwrap()) as usize;
    let entries = usize::from(u16::from_le_bytes([file[start], file[start + 1]]));
    let end = start + 2 + 12 * entries;
    let second = u32::try_from(file.len()).unwrap();
    let copy = file[start..end + 4].to_vec();
    file[end..end + 4].copy_from_slice(&second.to_le_bytes());
    file.extend(copy);
    let pages = load(&file, "two.tif", Reading::default()).unwrap();
    assert_eq!(pages.len(), 2);
    assert_eq!(pages[0].gray, pages[1].gray);
    assert_eq!(pages[1].source, "two.tif, page 2");
    one_by_one(&file, &pages);
    let circle = u32::try_from(start).unwrap().to_le_bytes();
    let last = file.len() - 4;
    file[last..].copy_from_slice(&circle);
    assert!(
        load(&file, "circle.tif", Reading::default()).is_ok(),
        "a circle of pages ends"
    );
}

/// Of the two pages of a TIFF file each is read by itself, the second also where the first is damaged.
fn one_by_one(file: &[u8], pages: &[Sheet]) {
    let page = |file: &[u8], n: usize| load_page(file, "two.tif", Reading::default(), n);
    for (sheet, n) in pages.iter().zip(1..) {
        let (read, count) = page(file, n).unwrap();
        let read = read.unwrap();
        assert_eq!((&read.gray, &read.source), (&sheet.gray, &sheet.source));
        assert_eq!(count, 2);
    }
    for n in [0, 3] {
        let (read, count) = page(file, n).unwrap();
        assert!(read.is_none() && count == 2, "page {n}");
    }
    let start = u32::from_le_bytes(*file[4..].first_chunk().unwrap()) as usize;
    let mut damaged = file.to_vec();
    // the tag of the width
    damaged[start + 2..start + 4].copy_from_slice(&[0xff, 0xff]);
    assert!(page(&damaged, 1).is_err());
    assert!(page(&damaged, 2).unwrap().0.is_some());
}

#[test]
fn light_ink_and_opacity_become_ink() {
    let mut dark = picture();
    invert(&mut dark);
    let bytes = png(dark);
    let turned = one(&bytes);
    assert!(turned.gray.at(12, 10) > 0.9 && turned.gray.at(30, 20) < 0.2);
    let kept = load(&bytes, "dark", Polarity::DarkInk.into()).unwrap();
    assert!(kept[0].gray.at(12, 10) < 0.1, "as told");
    let glass = GrayAlphaImage::from_fn(9, 9, |x, _| LumaA([255, if x == 4 { 200 } else { 0 }]));
    let drawn = one(&png(glass));
    assert!(drawn.gray.at(4, 4) > 0.7 && drawn.gray.at(1, 4) < 0.01);
}

#[test]
fn a_light_drawing_with_a_gradient_on_nothing_is_drawn_by_its_opacity() {
    let shaded = |opaque: fn(u32, u32) -> bool, darkest: u8| {
        let picture = image::RgbaImage::from_fn(40, 40, |x, y| {
            let light = 255 - u8::try_from(y).unwrap() * ((255 - darkest) / 40);
            let alpha = if opaque(x, y) { 255 } else { 0 };
            image::Rgba([light, light, light, alpha])
        });
        one(&png(picture)).gray
    };
    let drawing = |x, y| (10..30).contains(&x) && (5..35).contains(&y);
    let white = shaded(drawing, 175);
    assert!(white.at(20, 6) > 0.99 && white.at(20, 34) > 0.99 && white.at(5, 20) < 0.01);
    // what is dark enough to be ink on paper is that
    let dark = shaded(drawing, 15);
    assert!(dark.at(20, 6) < 0.2 && dark.at(20, 34) > 0.7);
    // and a pale page that lies aslant is no drawing
    let page = shaded(
        |x, y| (10..70).contains(&(x + y)) && (x + 30 > y && y + 30 > x),
        175,
    );
    assert!(page.at(20, 20) < 0.3 && page.at(0, 0) < 0.01);
}

#[test]
fn orientation_and_resolution_come_from_the_file() {
    let jpeg = encoded(picture(), ImageFormat::Jpeg);
    let tiff = [
        b"MM\0*\0\0\0\x08\0\x04".as_slice(),
        b"\x01\x12\0\x03\0\0\0\x01\0\x06\0\0", // orientation: turn by 90°
        b"\x01\x1a\0\x05\0\0\0\x01\0\0\0\x3e",
        b"\x01\x1b\0\x05\0\0\0\x01\0\0\0\x3e",
        b"\x01\x28\0\x03\0\0\0\x01\0\x02\0\0",
        b"\0\0\0\0\0\0\x02\x58\0\0\0\x01",
    ]
    .concat();
    let length = u16::try_from(tiff.len() + 8).unwrap().to_be_bytes();
    let app1 = [b"\xff\xe1".as_slice(), &length, b"Exif\0\0", &tiff].concat();
    let with = [&jpeg[..2], &app1, &jpeg[2..]].concat();
    let sheet = one(&with);
    assert_eq!(
        (sheet.gray.width(), sheet.gray.height()),
        (30, 40),
        "turned"
    );
    assert_eq!(sheet.dpi, Some(600.0));
    let mut jfif = jpeg;
    assert_eq!(&jfif[6..10], b"JFIF");
    jfif[13..18].copy_from_slice(&[2, 0, 118, 0, 118]);
    assert!(
        (one(&jfif).dpi.unwrap() - 299.72).abs() < 0.01,
        "dots a centimetre"
    );
    let png = png(picture());
    assert_eq!(one(&png).dpi, None);
    let phys = b"\0\0\0\x09pHYs\0\0\x2e\x23\0\0\x2e\x23\x01\x78\xa5\x3f\x76";
    let with = [&png[..33], phys, &png[33..]].concat();
    assert!((one(&with).dpi.unwrap() - 300.0).abs() < 0.01);
    assert!((one(&pcx(&picture())).dpi.unwrap() - 300.0).abs() < 0.01);
    let mut bmp = encoded(picture(), ImageFormat::Bmp);
    bmp[38..46].copy_from_slice(&[0x46, 0x5c, 0, 0, 0x46, 0x5c, 0, 0]);
    assert!((one(&bmp).dpi.unwrap() - 600.0).abs() < 0.01);
}

#[test]
fn what_is_no_whole_picture_is_refused_with_its_name() {
    let no = |bytes: &[u8]| load(bytes, "x.png", Reading::default()).unwrap_err();
    assert!(matches!(
        no(b"just some words in a file").fault,
        Fault::Kind
    ));
    assert!(matches!(no(b"").fault, Fault::Kind));
    assert!(no(b"words").to_string().contains("x.png"));
    let colour = DynamicImage::from(picture()).to_rgb8();
    for (file, format) in [
        (encoded(picture(), ImageFormat::Jpeg), "JPEG"),
        (png(picture()), "PNG"),
        (encoded(picture(), ImageFormat::Tiff), "TIFF"),
        (encoded(picture(), ImageFormat::Bmp), "BMP"),
        (encoded(colour, ImageFormat::Gif), "GIF"),
    ] {
        for part in [3, 5, 9] {
            assert!(
                load(&file[..file.len() * part / 10], "x", Reading::default()).is_err(),
                "{format} {part}/10"
            );
        }
    }
    let mut huge = png(picture());
    huge[16..24].copy_from_slice(&[0, 0, 0xea, 0x60, 0, 0, 0xea, 0x60]);
    let sum = crc32fast::hash(&huge[12..29]);
    huge[29..33].copy_from_slice(&sum.to_be_bytes());
    let large = no(&huge).fault;
    assert!(matches!(large, Fault::Large { width: 60_000, .. }));
}

/// A stream of a PDF file.
pub(super) fn pdf_stream(entries: &str, data: &[u8]) -> Vec<u8> {
    let head = format!("<< {entries} /Length {} >>\nstream\n", data.len());
    [head.as_bytes(), data, b"\nendstream"].concat()
}

/// A PDF file of one page of 144 × 108 points with one picture, and other objects from the fifth on.
pub(super) fn pdf_file(entries: &str, data: &[u8], others: &[Vec<u8>]) -> Vec<u8> {
    let mut out = b"%PDF-1.4\n".to_vec();
    let picture = format!("/Type /XObject /Subtype /Image /Width 40 /Height 30 {entries}");
    let mut objects: Vec<Vec<u8>> = vec![
        b"<< /Type /Catalog /Pages 2 0 R >>".to_vec(),
        b"<< /Type /Pages /Kids [3 0 R] /Count 1 >>".to_vec(),
        b"<< /Type /Page /Parent 2 0 R /MediaBox [0 0 144 108] /Resources << /XObject << /Im0 4 0 R >> >> >>".to_vec(),
        pdf_stream(&picture, data),
    ];
    objects.extend_from_slice(others);
    let mut at = Vec::new();
    for (i, body) in objects.iter().enumerate() {
        at.push(out.len());
        out.extend([format!("{} 0 obj\n", i + 1).as_bytes(), body, b"\nendobj\n"].concat());
    }
    let (start, size) = (out.len(), objects.len() + 1);
    out.extend(format!("xref\n0 {size}\n0000000000 65535 f \n").into_bytes());
    out.extend(
        at.iter()
            .flat_map(|a| format!("{a:010} 00000 n \n").into_bytes()),
    );
    out.extend(
        format!("trailer\n<< /Size {size} /Root 1 0 R >>\nstartxref\n{start}\n%%EOF\n")
            .into_bytes(),
    );
    out
}

#[test]
fn a_pdf_that_claims_what_its_scan_has_not() {
    let coding = "/BitsPerComponent 1 /ColorSpace /DeviceGray /Filter [/CCITTFaxDecode]";
    for claim in [
        "/Columns 99999999999",
        "/Columns 40 /Rows 99999999",
        "/Columns -99999999",
    ] {
        let file = pdf_file(
            &format!("{coding} /DecodeParms [<< /K -1 {claim} >>]"),
            b"\x00\x10",
            &[],
        );
        let wrong = load(&file, "page.pdf", Reading::default())
            .unwrap_err()
            .fault;
        assert!(matches!(wrong, Fault::Decode(_)), "{claim}: {wrong}");
    }
}

#[test]
fn a_pdf_gives_the_scan_of_its_page() {
    /// How a grey picture is described.
    const GREY: &str = "/ColorSpace /DeviceGray /BitsPerComponent 8";
    let grey = picture();
    let plain = pdf_file(GREY, grey.as_raw(), &[]);
    let jpeg = encoded(grey.clone(), ImageFormat::Jpeg);
    let jpeg = pdf_file(&format!("{GREY} /Filter /DCTDecode"), &jpeg, &[]);
    let bits: Vec<u8> = grey
        .as_raw()
        .chunks(8)
        .map(|b| b.iter().fold(0, |s, &v| s << 1 | u8::from(v < 128)))
        .collect();
    let bilevel = pdf_file(
        "/ColorSpace /DeviceGray /BitsPerComponent 1 /Decode [1 0]",
        &bits,
        &[],
    );
    for (i, file) in [plain, jpeg, bilevel].iter().enumerate() {
        let sheet = one(file);
        assert_eq!(
            (sheet.gray.width(), sheet.gray.height()),
            (40, 30),
            "file {i}"
        );
        assert!(
            (sheet.dpi.unwrap() - 20.0).abs() < 1e-9,
            "40 px on two inches"
        );
        assert!(
            sheet.gray.at(12, 10) > 0.8 && sheet.gray.at(30, 20) < 0.25,
            "file {i}"
        );
    }
    let short = pdf_file(GREY, &grey.as_raw()[..100], &[]);
    assert!(load(&short, "short.pdf", Reading::default()).is_err());
    assert!(load(b"%PDF-1.4 and nothing", "empty.pdf", Reading::default()).is_err());
}

#[test]
fn opacity_is_no_number_of_srgb() {
    let alpha = |x: u32| if x < 20 { 255 } else { 128 };
    let image = GrayAlphaImage::from_fn(40, 30, |x, _| LumaA([0, alpha(x)]));
    let bytes = png(image);
    let reading = Reading {
        tones: Tones::Srgb,
        polarity: Polarity::DarkInk,
        ..Reading::default()
    };
    let gray = &load(&bytes, "drawing", reading).unwrap()[0].gray;
    assert!(
        (gray.at(30, 9) - 128.0 / 255.0).abs() < 1e-3,
        "{}",
        gray.at(30, 9)
    );
}

#[test]
fn srgb_is_read_as_the_light_that_it_stands_for() {
    // half of the light, whichever of dark and light is the ink
    let column = |x: u32| match x {
        0..20 => 255,
        20 => 188,
        _ => 0,
    };
    let bytes = png(GrayImage::from_fn(40, 30, |x, _| Luma([column(x)])));
    for (polarity, ends) in [
        (Polarity::DarkInk, [0.0, 1.0]),
        (Polarity::LightInk, [1.0, 0.0]),
    ] {
        for (tones, at_edge) in [(Tones::Linear, 188.0 / 255.0), (Tones::Srgb, 0.503)] {
            let reading = Reading {
                polarity,
                tones,
                ..Reading::default()
            };
            let gray = &load(&bytes, "page", reading).unwrap()[0].gray;
            let light = if polarity == Polarity::DarkInk {
                1.0 - gray.at(20, 9)
            } else {
                gray.at(20, 9)
            };
            assert!(
                (light - at_edge).abs() < 1e-3,
                "{polarity:?} {tones:?}: {light}"
            );
            let off = [gray.at(3, 9) - ends[0], gray.at(30, 9) - ends[1]];
            assert!(off.iter().all(|v| v.abs() < 1e-6), "{polarity:?} {tones:?}");
        }
    }
}
