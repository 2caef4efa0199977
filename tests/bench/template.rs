//! Print → draw → scan in simulation: the letters of a font drawn at the printed guides, the pages photographed
//! and read again.
//!
//! `cargo bench --bench template -- FONT [PAGES [BENDS]]`

#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::print_stdout,
    reason = "a bench prints its table; its numbers are small"
)]

#[path = "../common/camera.rs"]
mod camera;
#[path = "../common/moments.rs"]
mod moments;

use camera::Camera;
use khatt::pipeline::picture::{self, trace_picture};
use khatt::read::Pen;
use khatt::scan::{self, InkStreaks, Polarity};
use khatt::template::{self, Layout, Page};
use khatt::types::{Cell, Direction};
use kurbo::{Affine, BezPath, ParamCurve, ParamCurveNearest, PathSeg, Point, Shape, Vec2};
use moments::Moments;
use skrifa::instance::{LocationRef, Size};
use skrifa::outline::DrawSettings;
use skrifa::{FontRef, MetadataProvider};

const TEXT: &str = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789&?!";

/// Letters of a font with their outlines, em, y up.
fn letters(font: &FontRef<'_>) -> Vec<(char, BezPath)> {
    let em = font
        .metrics(Size::unscaled(), LocationRef::default())
        .units_per_em;
    let outline = |c: char| {
        let glyph = font.outline_glyphs().get(font.charmap().map(c)?)?;
        let mut pen = Pen::default();
        let settings = DrawSettings::unhinted(Size::unscaled(), LocationRef::default());
        glyph.draw(settings, &mut pen).ok()?;
        Some((c, Affine::scale(1.0 / f64::from(em)) * pen.path()))
    };
    TEXT.chars().filter_map(outline).collect()
}

/// The page as a user finds it: skewed up to 8°, any way up, hand-held half of the time.
fn camera(i: u64) -> Camera {
    let unit = |k: u64| ((i * 7919 + k * 104_729) % 1009) as f64 / 1009.0;
    let held = if i.is_multiple_of(2) { 0.08 } else { 0.0 };
    Camera {
        dpi: [200.0, 300.0, 400.0, 600.0, 240.0][(i % 5) as usize],
        skew_deg: 16.0 * unit(1) - 8.0,
        quarters: (i % 4) as u32,
        tilt: [held * (2.0 * unit(2) - 1.0), held * (2.0 * unit(3) - 1.0)],
        lens: 0.0,
        bow_mm: [0.0; 2],
        blur: 0.6 + 0.6 * unit(4),
        gamma: 1.0,
        shade: 0.35 * unit(5),
        jpeg: Some(70),
        seed: i + 1,
    }
}

/// The same of paper that does not lie flat, through a lens that bends lines: 1.5 % at the picture's corners, 6 mm from
/// top to foot and waves of 1 mm at most, each so many times.
fn bent(i: u64, much: f64) -> Camera {
    let unit = |k: u64| ((i * 7919 + k * 104_729) % 1009) as f64 / 1009.0;
    Camera {
        lens: much * (0.03 * unit(6) - 0.015),
        bow_mm: [much * (8.0 * unit(7) - 2.0), much * unit(8)],
        ..camera(i)
    }
}

/// Errors of one cell: scale that the page gives it, baseline in em, weight, radius of gyration, mean distance of the
/// outline in em, where it lies on the page in mm.
struct Row([f64; 6]);

/// What they are called, and how many of its unit make one.
const ERRORS: [(&str, f64); 6] = [
    ("scale, %", 100.0),
    ("baseline, % em", 100.0),
    ("weight, %", 100.0),
    ("radius of gyration, %", 100.0),
    ("outline, ‰ em", 1000.0),
    ("place on the page, mm", 1.0),
];

/// The whole shape says scale, height and weight; its extreme points would say the blur of its corners.
fn measure(cell: &Cell, truth: &BezPath, [scale, place]: [f64; 2]) -> Option<Row> {
    let (seen, known) = (Moments::of_cell(cell), Moments::of(truth));
    let radius = (seen.radius / known.radius - 1.0).abs();
    let baseline = (seen.centre.y - known.centre.y).abs();
    let weight = (seen.area / known.area - 1.0).abs();
    let outline = distance(cell, truth, seen.centre - known.centre)?;
    (seen.area > 0.0).then_some(Row([scale, baseline, weight, radius, outline, place]))
}

/// Mean distance of a cell's outline from a letter's, em, after `shift` is taken back.
fn distance(cell: &Cell, truth: &BezPath, shift: Vec2) -> Option<f64> {
    const PLACES: u32 = 5;
    let guides = cell.guides;
    let below = cell.gray.height() as f64 - guides.baseline_px;
    let to_em = Affine::translate(-shift)
        * Affine::scale(1.0 / guides.px_per_em)
        * Affine::translate((0.0, -below));
    let options = picture::Options::default();
    let traced = trace_picture(&cell.gray, InkStreaks::default(), &options).ok()?;
    let segments = traced.paths.iter().flat_map(BezPath::segments);
    let places = |s: PathSeg| (0..PLACES).map(move |k| s.eval(f64::from(k) / f64::from(PLACES)));
    let near = |p: Point| {
        let off = truth
            .segments()
            .map(|s| s.nearest(to_em * p, 1e-7).distance_sq);
        off.fold(f64::INFINITY, f64::min).sqrt()
    };
    let offs: Vec<f64> = segments.flat_map(places).map(near).collect();
    Some(offs.iter().sum::<f64>() / offs.len() as f64)
}

fn page_rows(
    layout: &Layout,
    page: &Page,
    letters: &[(char, BezPath)],
    cam: Camera,
) -> Result<Vec<Row>, String> {
    let em = layout.em();
    let drawn: Vec<BezPath> = page
        .places
        .iter()
        .map(|p| {
            let path = &letters[p.index % letters.len()].1;
            let left = p.field.center().x - path.bounding_box().center().x * em;
            Affine::new([em, 0.0, 0.0, -em, left, p.baseline]) * path.clone()
        })
        .collect();
    let (bytes, sight) = cam.take(page, &drawn);
    let sheet = scan::load(&bytes, "page", Polarity::DarkInk.into()).map_err(|e| e.to_string())?;
    let found = template::find(&sheet[0], layout).map_err(|e| e.to_string())?;
    if found.code != page.code {
        return Err(format!("read as {}", found.code));
    }
    let found = found.bent(&sheet[0], layout, &page.places);
    let gain = template::gain(&sheet[0], layout, &found);
    let drawings = template::drawings(&sheet[0], layout, &found, &page.places, gain.as_ref());
    let read = drawings.iter().map(|d| &d.cell).zip(&page.places);
    read.map(|(cell, place)| {
        let middle = place.field.center();
        let scale = (found.surface.scale(middle) / sight.scale(middle) - 1.0).abs();
        let truth = &letters[cell.index % letters.len()].1;
        let off = found.surface.at(middle).distance(sight.at(middle)) / sight.scale(middle);
        measure(cell, truth, [scale, off]).ok_or(format!("{} is empty", cell.label.0))
    })
    .collect()
}

fn main() {
    let mut args = std::env::args().skip(1).filter(|a| a != "--bench");
    let Some(path) = args.next() else {
        println!("usage: cargo bench --bench template -- FONT [PAGES [BENDS]]");
        return;
    };
    let count: u64 = args.next().and_then(|n| n.parse().ok()).unwrap_or(200);
    let much: f64 = args.next().and_then(|n| n.parse().ok()).unwrap_or(0.0);
    let bytes = std::fs::read(&path).expect("the font file");
    let font = FontRef::new(&bytes).expect("a font");
    let letters = letters(&font);
    let layout = Layout {
        ascender: 0.9,
        cap_height: 0.7,
        x_height: 0.45,
        ..Layout::default()
    };
    let names: Vec<(String, String)> = (0..layout.per_page() * 3)
        .map(|i| (format!("g{i}"), letters[i % letters.len()].0.to_string()))
        .collect();
    let pages = template::pages(&layout, Direction::Ltr, "Simulation", &names).expect("pages");
    let (mut rows, mut lost) = (Vec::new(), Vec::new());
    for i in 0..count {
        let page = &pages[(i * 5 % 3) as usize];
        match page_rows(&layout, page, &letters, bent(i, much)) {
            Ok(r) => rows.extend(r),
            Err(e) => lost.push(format!("page {i} ({:?}): {e}", bent(i, much))),
        }
    }
    println!("| pages | cells read | pages lost | | median | 99 % | worst |");
    println!("|---|---|---|---|---|---|---|");
    for (k, (name, units)) in ERRORS.iter().enumerate() {
        let mut v: Vec<f64> = rows.iter().map(|r| units * r.0[k]).collect();
        v.sort_by(f64::total_cmp);
        let at = |share: f64| {
            v.get(((v.len() - 1) as f64 * share) as usize)
                .copied()
                .unwrap_or(f64::NAN)
        };
        println!(
            "| {count} | {} | {} | {name} | {:.3} | {:.3} | {:.3} |",
            rows.len(),
            lost.len(),
            at(0.5),
            at(0.99),
            at(1.0)
        );
    }
    lost.iter().for_each(|l| println!("{l}"));
}
