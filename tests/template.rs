//! Print, draw, photograph, read: pages of the template come back whole from any side.

use crate::common::camera::Camera;
use crate::common::desk::{BUILD, Desk};
use crate::common::moments::Moments;
use crate::common::pictures::{encoded, png};
use crate::common::read;
use khatt::pipeline::{self, Project, World};
use khatt::scan::{self, Polarity};
use khatt::template::{self, Field, Found, Layout, Page, Paper, Place, TemplateError};
use khatt::types::{Direction, Sheet};
use kurbo::{Affine, BezPath, Circle, Rect, Shape};
use std::path::Path;

/// A flat-bed scanner.
pub(crate) const FLATBED: Camera = Camera {
    dpi: 300.0,
    skew_deg: 0.0,
    quarters: 0,
    tilt: [0.0, 0.0],
    lens: 0.0,
    bow_mm: [0.0, 0.0],
    blur: 0.8,
    gamma: 1.0,
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
        columns: Some(4),
        rows: Some(4),
        ..Layout::default()
    }
}

fn pages(layout: &Layout, n: usize) -> Vec<Page> {
    template::pages(layout, Direction::Rtl, "Test Family", &labels(n)).expect("a layout")
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

/// A letter for every cell of a page.
fn letters(layout: &Layout, page: &Page) -> Vec<BezPath> {
    let places = page.places.iter();
    let drawn = places.map(|p| onto_page(layout, p) * letter(p.index));
    drawn.collect()
}

fn load(bytes: &[u8]) -> Sheet {
    let sheets = scan::load(bytes, "photo", Polarity::DarkInk.into()).expect("a picture");
    sheets.into_iter().next().expect("one page")
}

/// A picture, and the page that is recognised in it.
fn seen(layout: &Layout, bytes: &[u8]) -> (Sheet, Found) {
    let sheet = load(bytes);
    let found = template::find(&sheet, layout).expect("the page is recognised");
    (sheet, found)
}

fn check(layout: &Layout, page: &Page, camera: Camera) {
    let (bytes, truth) = camera.take(page, &letters(layout, page));
    let (sheet, found) = seen(layout, &bytes);
    assert_eq!(found.code, page.code, "{camera:?}: another page was read");
    let found = found.bent(&sheet, layout, &page.places);
    for mark in layout.marks() {
        let off = found.surface.at(mark).distance(truth.at(mark));
        assert!(off < 0.06, "{camera:?}: a mark is {off:.3} px off");
    }
    let stray = template::stray(&sheet, layout, &found, &page.places);
    assert!(stray.is_empty(), "{camera:?}: {stray:?}");
    let gain = template::gain(&sheet, layout, &found);
    let drawings = template::drawings(&sheet, layout, &found, &page.places, gain.as_ref());
    assert_eq!(
        drawings.len(),
        page.places.len(),
        "{camera:?}: cells are missing"
    );
    for (drawing, place) in drawings.iter().zip(&page.places) {
        assert!(
            drawing.inked && !drawing.cut_off && drawing.specks == 0,
            "{camera:?}: {drawing:?}"
        );
        let cell = &drawing.cell;
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
        let box_px = cell.in_sheet.inset(-3.0);
        assert!(
            seen.contains_rect(box_px),
            "{camera:?}: {box_px:?} lies outside {seen:?}"
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
fn pages_that_do_not_lie_flat_are_read() {
    let layout = small();
    let page = &pages(&layout, 16)[0];
    let curled = Camera {
        dpi: 240.0,
        lens: -0.012,
        bow_mm: [6.0, 0.8],
        ..FLATBED
    };
    check(&layout, page, curled);
    let held = Camera {
        dpi: 240.0,
        quarters: 1,
        skew_deg: 6.0,
        tilt: [0.06, -0.04],
        lens: 0.02,
        bow_mm: [-3.0, 1.0],
        shade: 0.3,
        jpeg: Some(70),
        ..FLATBED
    };
    check(&layout, page, held);
    // the code, too, is where paper and lens have bent it
    let layout = Layout::default();
    let page = &pages(&layout, 72)[0];
    let bent = Camera {
        dpi: 150.0,
        lens: -0.02,
        bow_mm: [8.0, 1.0],
        tilt: [0.077, 0.044],
        ..FLATBED
    };
    let (bytes, truth) = bent.take(page, &[]);
    let (sheet, flat) = seen(&layout, &bytes);
    let found = flat.clone().bent(&sheet, &layout, &page.places);
    let off = |found: &Found| {
        let places = page.places.iter().map(|p| p.field.center());
        let off = places.map(|p| found.surface.at(p).distance(truth.at(p)) / truth.scale(p));
        off.fold(0.0, f64::max)
    };
    let (before, after) = (off(&flat), off(&found));
    assert!(before > 1.0 && after < 0.08, "{before} mm, then {after} mm");
}

#[test]
fn a_page_without_guides_in_its_picture_lies_flat() {
    let layout = small();
    let mut page = pages(&layout, 16).swap_remove(0);
    page.paints.retain(|p| p.ink != template::Ink::Guide);
    let (bytes, _) = FLATBED.take(&page, &letters(&layout, &page));
    let (sheet, found) = seen(&layout, &bytes);
    assert_eq!(found.clone().bent(&sheet, &layout, &page.places), found);
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
    let (sheet, found) = seen(&layout, &bytes);
    for drawing in template::drawings(&sheet, &layout, &found, &page.places, None) {
        let cell = &drawing.cell;
        let most = cell.gray.samples().iter().fold(0.0f32, |m, &v| m.max(v));
        assert!(
            most < 0.5 && !drawing.inked,
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
    let taken = |dpi: f64, page: &Page| Camera { dpi, ..FLATBED }.take(page, &[]).0;
    let bytes = taken(150.0, &half);
    let found = template::find(&load(&bytes), &layout);
    assert!(
        matches!(found, Err(TemplateError::Marks { .. })),
        "half a page: {found:?}"
    );
    let mut blank = page.clone();
    blank.paints.clear();
    let bytes = taken(100.0, &blank);
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
        let (sheet, found) = seen(&layout, &bytes);
        let gain = template::gain(&sheet, &layout, &found).expect("the strip is in view");
        let px = gain.blur_mm * 300.0 / 25.4;
        // the lens' blur, and that of drawing and sampling, about half a pixel
        assert!(
            px > blur && px < blur + 0.35,
            "blur {blur} measured as {px:.2} px"
        );
        assert!(gain.spread_mm.abs() < 0.01, "spread {}", gain.spread_mm);
        assert!((gain.level() - 0.5).abs() < 0.06);
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
    let none = template::pages(&layout, Direction::Ltr, "x", &labels);
    assert_eq!(none, Err(TemplateError::NoGlyphs));
}

#[test]
fn a_sensor_that_makes_ink_bolder_is_seen_through() {
    let layout = small();
    let page = &pages(&layout, 8)[0];
    let camera = Camera {
        gamma: 1.6,
        blur: 1.6,
        ..FLATBED
    };
    let (bytes, _) = camera.take(page, &letters(&layout, page));
    let (sheet, found) = seen(&layout, &bytes);
    let gain = template::gain(&sheet, &layout, &found).expect("the strip is in view");
    assert!(gain.spread_mm > 0.03 && gain.level() > 0.6, "{gain:?}");
    let weight = |gain| {
        let drawings = template::drawings(&sheet, &layout, &found, &page.places, gain);
        let off = drawings.iter().zip(&page.places).map(|(d, p)| {
            Moments::of_cell(&d.cell).area / Moments::of(&letter(p.index)).area - 1.0
        });
        off.sum::<f64>() / page.places.len() as f64
    };
    let (raw, corrected) = (weight(None), weight(Some(&gain)));
    assert!(raw > 0.04, "without the margin's word letters weigh {raw}");
    assert!(corrected.abs() < 0.02, "letters weigh {corrected} more");
}

#[test]
fn fields_stand_where_the_layout_says() {
    let field = |field: [f64; 4], baseline: Option<f64>| Field { field, baseline };
    let layout = Layout {
        cells: vec![
            field([70.0, 90.0, 110.0, 130.0], Some(122.0)),
            field([15.0, 32.0, 55.0, 72.0], None),
            field([20.5, 80.0, 60.0, 118.0], None),
        ],
        em_mm: Some(28.0),
        ..small()
    };
    let pages = pages(&layout, 5);
    assert_eq!(
        pages.iter().map(|p| p.places.len()).collect::<Vec<_>>(),
        [3, 2]
    );
    let held = Camera {
        skew_deg: -4.0,
        quarters: 3,
        tilt: [0.05, -0.04],
        ..FLATBED
    };
    pages.iter().for_each(|page| check(&layout, page, held));
}

#[test]
fn ink_outside_the_fields_is_listed() {
    let layout = small();
    let page = &pages(&layout, 14)[0];
    let full = &pages(&layout, 16)[0];
    // something in a field without a name, and a dash that a pen left between rows of fields
    let blot = Rect::from_center_size(full.places[15].field.center(), (4.0, 3.0));
    let camera = Camera {
        skew_deg: 3.0,
        shade: 0.2,
        ..FLATBED
    };
    let mut drawn = letters(&layout, page);
    drawn.push(blot.to_path(1e-3));
    let (bytes, view) = camera.take(page, &drawn);
    let (sheet, found) = seen(&layout, &bytes);
    let stray = template::stray(&sheet, &layout, &found, &page.places);
    assert_eq!(stray.len(), 1, "{stray:?}");
    let (r, area) = stray[0];
    assert!(r.center().distance(view.at(blot.center())) < 3.0, "{r:?}");
    let px = view.scale(blot.center());
    assert!((area / (blot.area() * px * px) - 1.0).abs() < 0.2, "{area}");
}

/// A project of twenty letters on two pages.
pub(crate) const PROJECT: &str = r#"
[font]
family = "Test Family"
[template]
paper = { size = [124.0, 160.0] }
columns = 4
rows = 4
[[sheet]]
image = IMAGES
layout = "template"
glyphs = "A B C D E F G H I J K L M N O P & beh-ar.init ! T"
[output]
ttf = "out/test.ttf"
report = "out/report.json"
"#;

/// The pages that are printed for a project.
pub(crate) fn printed(project: &str) -> (Layout, Vec<Page>) {
    let project = Project::parse(&project.replace("IMAGES", "[]")).expect("a project");
    let none = |path: &Path| Err(format!("{} is not wanted", path.display()));
    let pages = pipeline::sheets(&project, World::of(&none)).expect("pages");
    (project.template, pages)
}

/// The picture of a page with a letter in every cell.
pub(crate) fn drawn(layout: &Layout, page: &Page, camera: Camera) -> Vec<u8> {
    camera.take(page, &letters(layout, page)).0
}

/// A picture's file and its bytes.
pub(crate) type Picture<'a> = (&'a str, &'a [u8]);

/// A folder with the project, whose pages are these pictures.
pub(crate) fn folder(pictures: &[Picture<'_>]) -> Desk {
    let names: Vec<&str> = pictures.iter().map(|p| p.0).collect();
    let text = PROJECT.replace("IMAGES", &format!("{names:?}"));
    let desk = Desk::with("font.toml", text);
    pictures
        .iter()
        .for_each(|(name, bytes)| desk.write(name, bytes));
    desk
}

#[test]
fn drawn_pages_become_a_font_whatever_their_order() {
    let (layout, pages) = printed(PROJECT);
    let first = drawn(
        &layout,
        &pages[0],
        Camera {
            dpi: 240.0,
            quarters: 1,
            skew_deg: 5.0,
            jpeg: Some(85),
            ..FLATBED
        },
    );
    let second = drawn(
        &layout,
        &pages[1],
        Camera {
            quarters: 2,
            tilt: [0.05, 0.03],
            shade: 0.25,
            ..FLATBED
        },
    );
    let orders: [[Picture<'_>; 2]; 2] = [
        [("2.png", &second), ("1.jpg", &first)],
        [("1.jpg", &first), ("2.png", &second)],
    ];
    let built = orders.map(|pictures| {
        let desk = folder(&pictures);
        desk.done(&BUILD);
        (desk.read("out/test.ttf"), desk.json("out/report.json"))
    });
    assert!(built[0].0 == built[1].0, "the order of the pictures shows");
    let face = read::face(&built[0].0);
    let others = [('&', 16), ('!', 18), ('T', 19)];
    for (c, index) in ('A'..='P').zip(0..).chain(others) {
        let drawn = read::drawn(&face, c);
        let (seen, truth) = (Moments::of(&drawn), Moments::of(&letter(index)));
        let weight = seen.area / 1e6 / truth.area - 1.0;
        assert!(weight.abs() < 0.02, "{c} weighs {weight:.3} more");
        let size = seen.radius / 1e3 / truth.radius - 1.0;
        assert!(size.abs() < 0.01, "{c} is {size:.3} larger");
        let up = seen.centre.y - 1e3 * truth.centre.y;
        assert!(up.abs() < 5.0, "{c} stands {up:.1} units high");
    }
    let pages = built[0].1["pages"].as_array().expect("a list").clone();
    assert_eq!(pages.len(), 2);
    for page in pages {
        let [blur, spread] = ["blur_mm", "spread_mm"].map(|k| page[k].as_f64().expect("mm"));
        assert!(blur > 0.03 && blur < 0.2 && spread.abs() < 0.02, "{page}");
    }
}

#[test]
fn one_of_a_templates_pages_scanned_again_redoes_no_other() {
    let (layout, pages) = printed(PROJECT);
    let first = drawn(&layout, &pages[0], FLATBED);
    let second = drawn(&layout, &pages[1], FLATBED);
    let desk = folder(&[("1.png", &first), ("2.png", &second)]);
    let build = || {
        desk.done(&["build", "font.toml", "--cache-dir", "kept"]);
        (desk.read("out/test.ttf"), desk.files("kept").len())
    };
    let (font, kept) = build();
    assert_eq!(kept, 3, "two pages and a build");
    let quarters = 2;
    let turned = Camera {
        quarters,
        ..FLATBED
    };
    desk.write("2.png", drawn(&layout, &pages[1], turned));
    let (_, kept) = build();
    assert_eq!(kept, 4, "one page more");
    desk.write("2.png", second);
    assert_eq!(build().0, font);
    desk.remove("kept");
    assert_eq!(build().0, font);
}

#[test]
fn wrong_pictures_are_told_apart_and_nothing_is_written() {
    let scan = Camera {
        dpi: 150.0,
        blur: 0.6,
        ..FLATBED
    };
    let (layout, pages) = printed(PROJECT);
    let [first, second] = [0, 1].map(|i| drawn(&layout, &pages[i], scan));
    let turned = Camera {
        quarters: 2,
        ..scan
    };
    let upside_down = drawn(&layout, &pages[0], turned);
    let (layout, other) = printed(&PROJECT.replace("A B C", "A C B"));
    let foreign = drawn(&layout, &other[0], scan);
    let half = {
        let whole = image::load_from_memory(&first).expect("a picture");
        let half = whole.crop_imm(0, 0, whole.width(), whole.height() / 2);
        encoded(half, image::ImageFormat::Png)
    };
    let cat = cat();
    let cases: [(&str, Vec<Picture<'_>>); 7] = [
        ("none", vec![]),
        ("missing", vec![("1.png", &first)]),
        (
            "twice",
            vec![
                ("1.png", &first),
                ("2.png", &second),
                ("3.png", &upside_down),
            ],
        ),
        ("foreign", vec![("1.png", &foreign), ("2.png", &second)]),
        ("half", vec![("1.png", &half), ("2.png", &second)]),
        (
            "cat",
            vec![("cat.png", &cat), ("1.png", &first), ("2.png", &second)],
        ),
        ("text", vec![("1.png", b"no picture"), ("2.png", &second)]),
    ];
    for (name, pictures) in cases {
        let desk = folder(&pictures);
        desk.refuses(&BUILD, &format!("template-{name}"));
    }
    let desk = folder(&[("2.png", &second), ("1.png", &upside_down)]);
    desk.done(&BUILD);
}

/// A picture that shows no page: a round face with eyes, fur and whiskers before a window.
fn cat() -> Vec<u8> {
    png(700, 500, |x, y| {
        let (x, y) = (f64::from(x), f64::from(y));
        let grain =
            22.0 * (libm::sin(0.9 * x) * libm::sin(1.3 * y + 0.4 * x) + libm::sin(0.37 * x * y));
        let face = ((x - 350.0) / 190.0).hypot((y - 270.0) / 160.0) < 1.0;
        let eye = |at: f64| (x - at).hypot(y - 220.0);
        let eyes = eye(270.0).min(eye(430.0));
        let light = match eyes {
            r if r < 14.0 => 20.0,
            r if r < 40.0 => 170.0,
            _ if face => 90.0 + 0.1 * y,
            _ => 130.0 + 0.15 * x,
        };
        let whisker = face && (y - 330.0 - 0.2 * (x - 350.0)).abs() < 2.0;
        let light = if whisker { 230.0 } else { light + grain };
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "0…255 by the clamp"
        )]
        let ink = (255.0 - light).clamp(0.0, 255.0) as u8;
        ink
    })
}

#[test]
fn pages_to_draw_on_are_written_in_every_format() {
    let desk = folder(&[]);
    desk.done(&["sheet", "font.toml", "-o", "pages.pdf"]);
    desk.done(&["sheet", "font.toml", "-o", "page.svg"]);
    desk.done(&["sheet", "font.toml", "-o", "page.png", "--dpi", "100"]);
    let printed = desk.run(&["sheet", "font.toml", "-o", "-"]);
    assert_eq!(printed.stdout, desk.read("pages.pdf"));
    for n in 1..=2 {
        assert!(desk.text(&format!("page-{n}.svg")).starts_with("<svg"));
        let picture = desk.read(&format!("page-{n}.png"));
        let sheet = scan::load(&picture, "page", Polarity::Auto.into()).expect("a picture");
        let dpi = sheet[0].dpi.expect("its resolution");
        assert!((dpi - 100.0).abs() < 0.02, "{dpi}");
        let picture = image::load_from_memory(&picture).expect("a PNG");
        assert_eq!((picture.width(), picture.height()), (488, 630));
    }
}

#[test]
fn a_printed_page_under_another_layout_is_told() {
    let (layout, pages) = printed(PROJECT);
    let picture = drawn(&layout, &pages[0], FLATBED);
    for other in [
        "{ grid = [4, 4] }",
        "{ grid = [3, 7] }",
        "\"free\"",
        "\"boxes\"",
    ] {
        let desk = folder(&[("page.png", &picture)]);
        desk.edit(|text| text.replace("layout = \"template\"", &format!("layout = {other}")));
        let stderr = desk.fails(&BUILD);
        assert!(
            stderr.contains("page.png: this is page 1 of those that `khatt sheet` prints")
                && stderr.contains("write layout = \"template\""),
            "{other}: {stderr}"
        );
        assert_eq!(stderr.matches("error: ").count(), 1, "{other}: {stderr}");
    }
}

/// What `khatt init` writes goes with what the README says to do next.
#[test]
fn a_new_project_prints_its_pages_and_builds_what_is_drawn_on_them() {
    let desk = Desk::new();
    desk.done(&["init", "letters"]);
    desk.done(&["sheet", "letters/font.toml", "-o", "pages.pdf"]);
    let project = desk.text("letters/font.toml");
    let (layout, pages) = printed(&project);
    let [page] = pages.as_slice() else {
        panic!("{} pages", pages.len());
    };
    let picture = drawn(&layout, page, FLATBED);
    desk.write("letters/page.png", picture);
    desk.done(&["build", "letters/font.toml"]);
    assert!(desk.has("letters/build/MyLetters.ttf"));
}
