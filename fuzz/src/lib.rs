//! The doors of khatt that a stranger's bytes come in by. Each function takes any bytes and must return: an answer or
//! an error, never a panic, an endless loop or memory without bound.

use khatt::pipeline::convert::{self, convert};
use khatt::pipeline::picture::{Options, trace_picture};
use khatt::pipeline::{Project, World, build, outputs, reference};
use khatt::recognise::{Alphabet, Look, Method, Pruning, Sample, Skeleton, centerline};
use khatt::scan::{InkStreaks, Reading, Texture, Tones, clean, load};
use khatt::types::{Bitmap, Font, Gray};
use khatt::{corner, fit, read, write};
use std::path::Path;

/// A door.
pub type Target = fn(&[u8]);

/// Every door by its name, which is also that of its folder of seeds.
pub const TARGETS: [(&str, Target); 6] = [
    ("project", project),
    ("image", image),
    ("pdf", pdf),
    ("svg", svg),
    ("font", font),
    ("trace", trace),
];

/// Pictures with more pixels than this are decoded and not looked at further: one input should not take seconds.
const PIXELS: usize = 40_000;

/// A project file. What is understood is built from a small page, whatever name the project gives it.
pub fn project(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else {
        return;
    };
    let Ok(project) = Project::parse(text) else {
        return;
    };
    let read = |path: &Path| match path.extension().and_then(|e| e.to_str()) {
        Some("txt") => Ok(b"A B C d".to_vec()),
        _ => Ok(PAGE.to_vec()),
    };
    let world = World::of(&read);
    if let Ok(built) = build(&project, world) {
        let _ = outputs(&project, &built, None, world);
    }
}

/// A page of four letters, 160 × 60 px.
const PAGE: &[u8] = include_bytes!("../seeds/image/page.png");

/// A picture file of any kind, cleaned as a page is, and its letters cut.
pub fn image(data: &[u8]) {
    by_profile(data);
    for page in load(data, "fuzz", Reading::default()).unwrap_or_default() {
        if page.gray.samples().len() <= PIXELS {
            let _ = clean(page, Texture::default());
        }
    }
}

/// A PDF, also where its head is broken.
pub fn pdf(data: &[u8]) {
    let mut bytes = b"%PDF-1.4\n".to_vec();
    bytes.extend(data.strip_prefix(b"%PDF-1.4\n").unwrap_or(data));
    by_profile(&bytes);
    let _ = load(&bytes, "fuzz.pdf", Reading::default());
}

/// A picture file of any kind whose light is what it says itself.
fn by_profile(data: &[u8]) {
    let reading = Reading {
        tones: Tones::Profile,
        ..Reading::default()
    };
    let _ = load(data, "fuzz", reading);
}

/// An SVG drawing, written again in every format.
pub fn svg(data: &[u8]) {
    if let Ok(reading) = read::svg(&[("A_.svg".to_owned(), data.to_vec())]) {
        written(&reading.font);
    }
}

/// A font: read, written again, and taken for a reference.
pub fn font(data: &[u8]) {
    if let Ok(reading) = read::font(data, None, &[]) {
        written(&reading.font);
    }
    let letters = ["A", "b", "uni0628.medi", "uni06440627.fina"];
    let _ = reference::samples(data, letters.map(str::to_owned));
}

fn written(font: &Font) {
    let units: usize = font
        .glyphs()
        .iter()
        .map(|g| g.outline.to_path().elements().len())
        .sum();
    if units > 2000 {
        return;
    }
    for format in write::FORMATS {
        let _ = convert(font, format, &convert::Options::default());
    }
}

/// A picture of the bytes themselves, traced in each way, thinned, and matched with itself. The first byte is the
/// width less one, the second the way; each byte after it is the coverage of a pixel.
pub fn trace(data: &[u8]) {
    let [width, way, ink @ ..] = data else { return };
    let width = usize::from(*width % 96) + 1;
    let ink = &ink[..ink.len().min(96 * 96)];
    let height = ink.len() / width;
    let gray = Gray::from_fn(width, height, |x, y| f32::from(ink[y * width + x]) / 255.0);
    let (fits, corners) = (fit::Method::all(), corner::Method::all());
    let way = usize::from(*way);
    let mut options = Options::default();
    options.fit = fits[way % fits.len()].clone();
    options.corners = corners[way / fits.len() % corners.len()].clone();
    let _ = trace_picture(&gray, InkStreaks::default(), &options);
    let _ = centerline(&gray);
    let _ = Skeleton::new(&Bitmap::threshold(&gray, 0.5), Pruning::default());
    for method in Method::all() {
        let sample = Sample {
            label: "A".to_owned(),
            gray: gray.clone(),
            guides: None,
        };
        let _ = Alphabet::new(&[sample], method).rank(&Look::new(&gray, None, method));
    }
}
