//! Sheets of several inks: layers where each ink lay, a palette of how they look.

use crate::common::desk::{BUILD, Desk};
use crate::common::pictures::encoded;
use crate::common::read::face;
use image::{ImageFormat, Rgb, RgbImage};
use skrifa::raw::TableProvider;
use skrifa::{FontRef, MetadataProvider};
use ttf_parser::{Face, GlyphId, RgbaColor, colr};

const PAPER: [u8; 3] = [250, 249, 245];
const BLACK: [u8; 3] = [30, 28, 32];
const RED: [u8; 3] = [200, 40, 45];
/// px
const CELL: u32 = 200;

/// What lies at a place of a cell, px from its corner: the inks of five letters.
fn drawn(cell: u32, x: f64, y: f64) -> [u8; 3] {
    let bar = |x0: f64, y0: f64, x1: f64, y1: f64| (x0..x1).contains(&x) && (y0..y1).contains(&y);
    let disc = |cx: f64, cy: f64, r: f64| (x - cx).hypot(y - cy) < r;
    match cell {
        // black beside red
        0 if bar(60.0, 40.0, 80.5, 140.0) => BLACK,
        0 if bar(80.5, 40.0, 100.0, 140.0) => RED,
        // red in the midst of black
        1 if disc(100.0, 90.0, 10.0) => RED,
        1 if disc(100.0, 90.0, 20.0) => BLACK,
        // one ink alone
        2 if bar(70.0, 40.0, 100.0, 140.0) => BLACK,
        // e in black, its accent in red
        3 if bar(60.0, 110.0, 130.0, 140.0) => BLACK,
        4 if bar(80.0, 60.0, 110.0, 75.0) => RED,
        _ => PAPER,
    }
}

/// Five cells in a row, and as much paper below, smooth at the edges, each pixel the mean of 4 × 4 places.
fn page(drawn: impl Fn(u32, f64, f64) -> [u8; 3]) -> Vec<u8> {
    let place = |p: u32, k: u32| f64::from(p) + (f64::from(k) + 0.5) / 4.0;
    let picture = RgbImage::from_fn(5 * CELL, 2 * CELL, |x, y| {
        let cell = x / CELL + 5 * (y / CELL);
        let places = (0..16).map(|k| drawn(cell, place(x % CELL, k % 4), place(y, k / 4)));
        let places: Vec<[u8; 3]> = places.collect();
        Rgb([0, 1, 2].map(|c| {
            let sum: u32 = places.iter().map(|p| u32::from(p[c])).sum();
            u8::try_from((sum + 8) / 16).expect("a mean")
        }))
    });
    encoded(picture, ImageFormat::Png)
}

/// A project of the page with an `ink` of the sheet.
fn project(picture: &[u8], ink: &str) -> Desk {
    let desk = Desk::with("page.png", picture);
    let project = format!(
        "[font]\nfamily = \"Inks\"\n[[sheet]]\nimage = \"page.png\"\nlayout = {{ grid = [2, 5] }}\nink = {ink}\n\
         glyphs = \"A B C e acutecomb\"\npixels_per_em = 200\n[compose]\nletters = [\"é\"]\n\
         [output]\nttf = \"t.ttf\"\notf = \"t.otf\"\nwoff2 = \"t.woff2\"\nufo = \"t.ufo\"\nsvg = \"svg\"\n"
    );
    desk.write("font.toml", project);
    desk
}

/// Layers as ttf-parser paints them: glyph and colour.
#[derive(Default)]
struct Painted(Vec<(GlyphId, Option<[u8; 3]>)>);

impl<'a> colr::Painter<'a> for Painted {
    fn outline_glyph(&mut self, glyph: GlyphId) {
        self.0.push((glyph, None));
    }
    fn paint(&mut self, paint: colr::Paint<'a>) {
        if let (colr::Paint::Solid(c), Some(last)) = (paint, self.0.last_mut()) {
            last.1 = Some([c.red, c.green, c.blue]);
        }
    }
    fn push_clip(&mut self) {}
    fn push_clip_box(&mut self, _: colr::ClipBox) {}
    fn pop_clip(&mut self) {}
    fn push_layer(&mut self, _: colr::CompositeMode) {}
    fn pop_layer(&mut self) {}
    fn push_transform(&mut self, _: ttf_parser::Transform) {}
    fn pop_transform(&mut self) {}
}

/// A letter's layers: left, bottom, right and top relative to the whole letter, units, and colour.
fn layers(face: &Face<'_>, letter: char) -> Vec<([i16; 4], [u8; 3])> {
    let id = face.glyph_index(letter).expect("the letter");
    let whole = face.glyph_bounding_box(id).expect("ink");
    let mut painted = Painted::default();
    face.paint_color_glyph(id, 0, RgbaColor::new(0, 0, 0, 255), &mut painted);
    let layer = |(glyph, colour): (GlyphId, Option<[u8; 3]>)| {
        let ink = face.glyph_bounding_box(glyph).expect("ink of a layer");
        assert_eq!(
            face.glyph_hor_advance(glyph),
            face.glyph_hor_advance(id),
            "one advance"
        );
        let sides = [
            ink.x_min - whole.x_min,
            ink.y_min,
            ink.x_max - whole.x_min,
            ink.y_max,
        ];
        (sides, colour.expect("a colour"))
    };
    painted.0.into_iter().map(layer).collect()
}

fn near(a: &[i16], b: &[i16], most: i16) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() <= most)
}

fn alike(a: [u8; 3], b: [u8; 3]) -> bool {
    a.iter().zip(b).all(|(a, b)| a.abs_diff(b) <= 4)
}

#[test]
fn every_ink_is_a_layer_where_it_lay() {
    let desk = project(&page(drawn), "[\"black\", \"red\"]");
    desk.done(&BUILD);
    // how the inks look on white paper
    let white = |ink: [u8; 3]| {
        [0, 1, 2]
            .map(|c| u8::try_from(u32::from(ink[c]) * 255 / u32::from(PAPER[c])).expect("a level"))
    };
    let (black, red) = (white(BLACK), white(RED));
    // 5 units a px; black runs on under red by 2 px
    let wanted = [
        (
            'A',
            vec![([0, 0, 102 + 10, 500], black), ([102, 0, 200, 500], red)],
        ),
        (
            'B',
            vec![([0, 0, 200, 200], black), ([50, 50, 150, 150], red)],
        ),
        ('C', vec![([0, 0, 150, 500], black)]),
        ('e', vec![([0, 0, 350, 150], black)]),
    ];
    // black by its numbers is black
    let hex = project(&page(drawn), "[\"#1e1c20\", \"#c8282d\"]");
    hex.done(&BUILD);
    assert_eq!(hex.read("t.ttf"), desk.read("t.ttf"));
    for file in ["t.ttf", "t.otf", "t.woff2"] {
        let bytes = desk.read(file);
        let bytes = wuff::decompress_woff2(&bytes).unwrap_or(bytes);
        let face = face(&bytes);
        for (letter, wanted) in &wanted {
            let found = layers(&face, *letter);
            assert_eq!(found.len(), wanted.len(), "{file} {letter}: {found:?}");
            let foot = wanted[0].0[1] - found[0].0[1];
            for ((sides, colour), (place, ink)) in found.iter().zip(wanted) {
                let [left, bottom, right, top] = *sides;
                let level = [left, bottom + foot, right, top + foot];
                assert!(
                    near(&level, place, 4),
                    "{file} {letter}: {level:?} for {place:?}"
                );
                assert!(
                    alike(*colour, *ink),
                    "{file} {letter}: {colour:?} for {ink:?}"
                );
            }
        }
        // é is composed of both
        let composed = layers(&face, 'é');
        assert_eq!(composed.len(), 2, "{composed:?}");
        assert!(
            composed[1].0[1] > composed[0].0[3],
            "the accent stands above: {composed:?}"
        );

        let font = FontRef::new(&bytes).expect("skrifa reads it");
        assert_eq!(font.color_palettes().len(), 1);
        assert_eq!(font.cpal().expect("a palette").num_palette_entries(), 2);
        assert_eq!(font.colr().expect("layers").version(), 0);
        // what knows no colours draws all of the letter
        let id = face.glyph_index('A').expect("A");
        let ink = face.glyph_bounding_box(id).expect("ink");
        assert!((ink.width() - 200).abs() <= 2, "{ink:?}");
    }
    let lib = desk.text("t.ufo/lib.plist");
    for key in ["colorLayers", "colorPalettes", "<string>A.color1</string>"] {
        assert!(lib.contains(key), "{key}: {lib}");
    }
    let said = desk.done(&["convert", "t.ufo", "-o", "c.ttf"]);
    assert!(said.contains("not carried over: colours"), "{said}");
    let svg = desk.text("svg/A_.svg");
    assert_eq!(svg.matches("fill=\"#").count(), 2, "{svg}");
    assert!(!desk.has("svg/A_.color1.svg"));
}

#[test]
fn no_colours_are_made_where_none_are_asked_for() {
    let desk = project(&page(drawn), "\"any\"");
    desk.done(&BUILD);
    let bytes = desk.read("t.ttf");
    let font = FontRef::new(&bytes).expect("a font");
    assert!(font.colr().is_err() && font.cpal().is_err());
    assert!(!desk.has("svg/A_.color0.svg"));
}

#[test]
fn a_sheet_without_one_of_its_inks_or_without_colours_is_refused() {
    let black = page(|cell, x, y| match drawn(cell, x, y) {
        RED => BLACK,
        other => other,
    });
    let both = "[\"black\", \"red\"]";
    let text = project(&black, both).fails(&BUILD);
    assert!(
        text.contains("page.png has ink, but none of the colour that `ink` asks for (#c81e1e)"),
        "{text}"
    );
    let grey = image::load_from_memory(&black)
        .expect("a picture")
        .to_luma8();
    let desk = project(&encoded(grey, ImageFormat::Png), both);
    let text = desk.fails(&BUILD);
    assert!(
        text.contains(
            "page.png has no colours by which the inks that `ink` lists could be told apart"
        ),
        "{text}"
    );
    assert!(!desk.has("t.ttf"));
    for (ink, why) in [
        ("[\"red\", \"#c02020\"]", "too alike"),
        ("[]", "names each of them"),
        ("7", "a list of inks that become layers"),
    ] {
        let said = project(&black, ink).fails(&BUILD);
        assert!(said.contains(why), "{ink}: {said}");
    }
}
