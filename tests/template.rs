//! Print, draw, photograph, read: pages of the template come back whole from any side.

use crate::common::camera::Camera;
use crate::common::moments::Moments;
use khatt::scan::{self, Polarity};
use khatt::template::{self, Direction, Layout, Page, Paper, Place, TemplateError};
use khatt::types::Sheet;
use kurbo::{Affine, BezPath, Circle, Rect, Shape};

/// A flat-bed scanner.
const FLATBED: Camera = Camera {
    dpi: 300.0,
    skew_deg: 0.0,
    quarters: 0,
    tilt: [0.0, 0.0],
    blur: 0.8,
    shade: 0.0,
    jpeg: None,
    seed: 1,
};

fn labels(n: usize) -> Vec<(String, String)> {
    let forms = ["", ".init", ".medi", ".fina"];
    let name = |i: usize| format!("g{i:03}{}", forms[i % 4]);
    (0..n).map(|i| (name(i), name(i))).collect()
}

/// A small sheet of 4 × 4 cells, quick to draw and photograph.
fn small() -> Layout {
    Layout {
        paper: Paper::Size(124.0, 160.0),
        columns: 4,
        rows: 4,
        ..Layout::default()
    }
}

fn pages(layout: &Layout, n: usize) -> Vec<Page> {
    template::pages(layout, Direction::RightToLeft, "Test Family", &labels(n)).expect("a layout")
}

/// A letter-like drawing for a cell, of its own size and place for every index, in em from the baseline, y up:
/// a ring on a stem that stands on the baseline.
fn letter(i: usize) -> BezPath {
    let h = 0.35 + 0.1 * ((i % 5) as f64) / 5.0;
    let r = 0.12 + 0.02 * ((i % 3) as f64);
    let mut path = Rect::new(0.0, 0.0, 0.08, h).to_path(1e-3);
    path.extend(Circle::new((0.1 + r, 0.5), r).to_path(1e-3));
    path.extend(
        Circle::new((0.1 + r, 0.5), r * 0.5)
            .to_path(1e-3)
            .reverse_subpaths(),
    );
    path
}

fn onto_page(layout: &Layout, place: &Place) -> Affine {
    let em = layout.em();
    let left = place.field.center().x - 0.2 * em;
    Affine::new([em, 0.0, 0.0, -em, left, place.baseline])
}

fn load(bytes: &[u8]) -> Sheet {
    let sheets = scan::load(bytes, "photo", Polarity::DarkInk).expect("a picture");
    sheets.into_iter().next().expect("one page")
}

fn check(layout: &Layout, page: &Page, camera: Camera) {
    let drawn: Vec<BezPath> = page
        .places
        .iter()
        .map(|p| onto_page(layout, p) * letter(p.index))
        .collect();
    let (bytes, truth) = camera.take(page, &drawn);
    let sheet = load(&bytes);
    let found = template::find(&sheet, layout).expect("the page is recognised");
    assert_eq!(found.code, page.code, "{camera:?}: another page was read");
    for mark in layout.marks() {
        let off = found.view.at(mark).distance(truth.at(mark));
        assert!(off < 0.06, "{camera:?}: a mark is {off:.3} px off");
    }
    let cells = template::cells(&sheet, layout, &found, &page.places);
    assert_eq!(
        cells.len(),
        page.places.len(),
        "{camera:?}: cells are missing"
    );
    for (cell, place) in cells.iter().zip(&page.places) {
        let (label, index) = (cell.label.0.as_str(), cell.index);
        let expected = (place.label.as_str(), place.index);
        assert_eq!(
            (label, index),
            expected,
            "{camera:?}: cells are out of order"
        );
        let (seen, truth) = (Moments::of_cell(cell), Moments::of(&letter(place.index)));
        let gain = seen.area / truth.area - 1.0;
        assert!(
            gain.abs() < 0.02,
            "{camera:?}: {} weighs {:.1} % more",
            place.label,
            100.0 * gain
        );
        let size = (seen.radius / truth.radius - 1.0).abs();
        assert!(
            size < 0.015,
            "{camera:?}: {label} is {:.1} % off in size",
            100.0 * size
        );
        let up = (seen.centre.y - truth.centre.y).abs();
        assert!(
            up < 0.005,
            "{camera:?}: {} stands {up:.4} em off",
            place.label
        );
        let size = Rect::new(
            0.0,
            0.0,
            cell.gray.width() as f64,
            cell.gray.height() as f64,
        );
        let seen = cell.to_sheet.transform_rect_bbox(size);
        let box_px = cell.in_sheet.inset(3.0);
        assert!(
            box_px.contains_rect(seen),
            "{camera:?}: {seen:?} lies outside {box_px:?}"
        );
    }
}

#[test]
fn pages_are_read_from_any_side() {
    let layout = small();
    let pages = pages(&layout, 32);
    assert_eq!(pages.len(), 2);
    check(
        &layout,
        &pages[0],
        Camera {
            dpi: 200.0,
            quarters: 2,
            skew_deg: -3.0,
            jpeg: Some(70),
            ..FLATBED
        },
    );
    let photo = Camera {
        dpi: 240.0,
        quarters: 1,
        skew_deg: 6.0,
        tilt: [0.06, -0.04],
        ..FLATBED
    };
    check(
        &layout,
        &pages[1],
        Camera {
            shade: 0.3,
            jpeg: Some(70),
            ..photo
        },
    );
}

#[test]
fn guides_are_not_ink() {
    let layout = small();
    let page = &pages(&layout, 16)[0];
    let (bytes, _) = Camera {
        dpi: 200.0,
        ..FLATBED
    }
    .take(page, &[]);
    let sheet = load(&bytes);
    let found = template::find(&sheet, &layout).expect("the page is recognised");
    for cell in template::cells(&sheet, &layout, &found, &page.places) {
        let most = cell.gray.samples().iter().fold(0.0f32, |m, &v| m.max(v));
        assert!(
            most < 0.5,
            "an empty field of {:?} has ink {most}",
            cell.label
        );
    }
}

#[test]
fn wrong_pages_are_named() {
    let layout = small();
    let page = &pages(&layout, 16)[0];
    let mut half = page.clone();
    half.size.height *= 0.5;
    let (bytes, _) = Camera {
        dpi: 150.0,
        ..FLATBED
    }
    .take(&half, &[]);
    let found = template::find(&load(&bytes), &layout);
    assert!(
        matches!(found, Err(TemplateError::Marks { .. })),
        "half a page: {found:?}"
    );
    let mut blank = page.clone();
    blank.paints.clear();
    let (bytes, _) = Camera {
        dpi: 100.0,
        ..FLATBED
    }
    .take(&blank, &[]);
    let found = template::find(&load(&bytes), &layout);
    assert!(
        matches!(found, Err(TemplateError::Marks { found: 0, .. })),
        "no marks: {found:?}"
    );
}

#[test]
fn gain_is_measured() {
    let layout = small();
    let page = &pages(&layout, 1)[0];
    for blur in [0.8, 1.6] {
        let (bytes, _) = Camera { blur, ..FLATBED }.take(page, &[]);
        let sheet = load(&bytes);
        let found = template::find(&sheet, &layout).expect("the page is recognised");
        let gain = template::gain(&sheet, &layout, &found).expect("the strip is in view");
        let px = gain.blur_mm * 300.0 / 25.4;
        // the lens' blur, and that of drawing and sampling, about half a pixel
        assert!(
            px > blur && px < blur + 0.35,
            "blur {blur} measured as {px:.2} px"
        );
        assert!(gain.spread_mm.abs() < 0.01, "spread {}", gain.spread_mm);
        assert!((gain.level() - 0.5).abs() < 0.06);
        for [width, seen] in &gain.ladder_mm {
            assert!(
                (width - seen).abs() < 0.03,
                "a line of {width} mm seems {seen:.3} mm"
            );
        }
        assert!(gain.tone.windows(2).all(|t| t[0] < t[1]), "{:?}", gain.tone);
    }
}

#[test]
fn outputs_are_what_they_say() {
    let layout = Layout::default();
    let pages = pages(&layout, 80);
    assert!(template::svg(&pages[0]).starts_with("<svg "));
    let pdf = template::pdf(&pages);
    assert!(pdf.starts_with(b"%PDF-") && pdf.ends_with(b"%%EOF"));
    let labels = labels(0);
    let none = template::pages(&layout, Direction::LeftToRight, "x", &labels);
    assert_eq!(none, Err(TemplateError::NoGlyphs));
}
