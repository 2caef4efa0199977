//! Pale streaks in ink: filled and told, or kept, in a drawing and on the way from a page to a font.

use crate::common::desk::{BUILD, Desk};
use crate::common::pictures::{LETTERS, edge, png};
use crate::common::shapes::Dice;
use khatt::numeric::{cast::single, coverage::blur};

/// What the two lines along a bar are.
#[derive(Clone, Copy, PartialEq)]
enum Lines {
    /// A ballpoint's, in ink that is as uneven.
    Streaks,
    /// Paper.
    Slits,
    None,
}

/// Bars of 40 × 110 px, three a row in cells of 200 × 200 px, seen through a lens.
fn bars(kinds: &[Lines]) -> Vec<u8> {
    let (mut dice, width) = (Dice(7), 200 * kinds.len().min(3));
    let height = 200 * kinds.len().div_ceil(3);
    let mut samples = vec![0.0; width * height];
    for (i, v) in samples.iter_mut().enumerate() {
        let kind = kinds[i / width / 200 * 3 + i % width / 200];
        let (x, y) = ((i % width % 200) as f32, (i / width % 200) as f32);
        if (80.0..120.0).contains(&x) && (40.0..150.0).contains(&y) {
            let (rough, left) = match kind {
                Lines::Streaks => (0.5, 0.45 + 0.15 * libm::sinf(y / 9.0)),
                Lines::Slits => (0.05, 0.0),
                Lines::None => (0.5, 1.0),
            };
            let on_line = (50.0..140.0).contains(&y) && ((x - 99.5).abs() - 6.5).abs() < 1.5;
            let line = if on_line { left } else { 1.0 };
            *v = (1.0 + rough * single(2.0 * dice.roll() - 1.0)) * line;
        }
    }
    blur(&mut samples, width, 0.9, 0);
    let ink = |i: usize| edge(0.5 - 0.7 * f64::from(samples[i]));
    let [w, h] = [width, height].map(|side| u32::try_from(side).expect("a small picture"));
    png(w, h, |x, y| ink(y as usize * width + x as usize))
}

#[test]
fn a_drawing_with_streaks_is_filled_unless_they_are_to_stay() {
    let desk = Desk::new();
    // the SVG, and what is said
    let traced = |picture: &[u8], more: &[&str]| {
        desk.write("in.png", picture);
        let said = desk.done(&[&["trace", "in.png", "-o", "out.svg"], more].concat());
        (desk.text("out.svg"), said)
    };
    let streaked = bars(&[Lines::Streaks]);
    let (svg, said) = traced(&streaked, &[]);
    assert_eq!(svg.matches('M').count(), 1, "{svg}");
    assert_eq!(said.matches("--streaks keep").count(), 1, "{said}");
    let quiet = traced(&streaked, &["--streaks", "fill", "--quiet"]);
    assert_eq!(quiet, (svg, String::new()), "the default");
    let (kept, said) = traced(&streaked, &["--streaks", "keep"]);
    assert!(kept.matches('M').count() > 2 && said.is_empty(), "{said}");
    for picture in [bars(&[Lines::Slits]), bars(&[Lines::None])] {
        let (svg, said) = traced(&picture, &[]);
        assert_eq!(said, "", "nothing was filled");
        assert_eq!(traced(&picture, &["--streaks", "keep"]), (svg, said));
    }
    let lines = ["--centerline", "--streaks"];
    let [filled, kept] =
        ["fill", "keep"].map(|way| traced(&streaked, &[&lines[..], &[way]].concat()));
    assert!(filled.1.contains("--streaks keep") && kept.1.is_empty());
    assert_ne!(filled.0, kept.0, "the middle of a line");
}

/// The contours of a font of bars, what is said while it is built, and while the page is cut.
fn built(picture: &[u8], line: &str) -> (usize, [String; 2]) {
    let desk = Desk::project(LETTERS, picture);
    desk.edit(|text| text.replace("[output]", &format!("{line}\n[output]")));
    let said = [&BUILD[..], &["cut", "font.toml", "-o", "cells"]].map(|args| desk.done(args));
    let drawings = desk.files("out/svg").into_iter();
    let contours = drawings.filter(|(name, _)| name != "_notdef.svg");
    let contours = contours.map(|(_, svg)| svg.iter().filter(|b| **b == b'M').count());
    (contours.sum(), said)
}

#[test]
fn a_page_with_streaks_is_filled_and_told_once_unless_they_are_to_stay() {
    let told = |said: &String| said.matches("streaks = \"keep\"").count();
    let streaked = bars(&[Lines::Streaks; 9]);
    let (contours, said) = built(&streaked, "");
    assert_eq!(
        (contours, said.each_ref().map(told)),
        (9, [1, 1]),
        "{said:?}"
    );
    let (kept, said) = built(&streaked, "streaks = \"keep\"");
    assert!(kept > 18, "{kept} contours");
    assert_eq!(said.each_ref().map(told), [0, 0], "{said:?}");
    // of a page whose lines are slits but for one letter's that one alone is filled, once it is traced
    let mut mixed = [Lines::Slits; 9];
    mixed[4] = Lines::Streaks;
    let mixed = bars(&mixed);
    let (contours, said) = built(&mixed, "streaks = \"fill\"");
    assert_eq!(
        (contours, said.each_ref().map(told)),
        (25, [1, 0]),
        "{said:?}"
    );
    let (kept, said) = built(&mixed, "streaks = \"keep\"");
    assert!(kept > 25, "{kept} contours");
    assert_eq!(said.each_ref().map(told), [0, 0], "{said:?}");
    let even = built(&bars(&[Lines::None; 9]), "");
    assert_eq!(even.1.each_ref().map(told), [0, 0], "{even:?}");
}

#[test]
fn what_streaks_cannot_become_is_refused() {
    let desk = Desk::project(LETTERS, &bars(&[Lines::None; 9]));
    desk.edit(|text| text.replace("[output]", "streaks = \"kept\"\n[output]"));
    for (args, status) in [
        (&BUILD[..], 1),
        (
            &["trace", "page.png", "-o", "a.svg", "--streaks", "kept"],
            2,
        ),
    ] {
        let (found, said) = desk.told(args);
        assert_eq!(found, Some(status), "{said}");
        assert!(said.contains("fill") && said.contains("keep"), "{said}");
        assert!(!desk.has("a.svg") && !desk.has("out"));
    }
}
