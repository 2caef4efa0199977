use super::*;
use crate::types::{Gray, Name, Outline};
use kurbo::BezPath;

fn entry(name: &str, text: &str) -> Entry {
    let path = BezPath::from_svg("M0 0L100 0C100 50 50 100 0 100Z").unwrap();
    let mut glyph = Glyph::new(Name::new(name).unwrap(), text.chars().collect(), 120.0);
    glyph.outline = Outline::new(vec![path]).unwrap();
    Entry {
        sheet: "<b>page & \"more\".png".to_owned(),
        index: 3,
        picture: Png::of(&Gray::from_fn(4, 4, |x, y| if x == y { 1.0 } else { 0.0 })),
        frame: Frame {
            units_per_px: 25.0,
            baseline_px: 0.0,
            origin_px: 0.0,
        },
        edge: vec![vec![
            (Point::new(0.0, 0.0), 0.1),
            (Point::new(100.0, 0.0), 3.0),
            (Point::new(0.0, 100.0), 0.7),
        ]],
        glyph,
        text: text.to_owned(),
        remarks: vec!["it looks <odd>".to_owned()],
        steps: [
            ("fit", 0.5),
            ("joining", 0.0),
            ("quadratics", 0.25),
            ("whole units", 0.7),
        ],
        mm_per_unit: Some(0.02),
    }
}

fn proof(entries: &[Entry]) -> String {
    since(None, entries)
}

fn since(last: Option<&str>, entries: &[Entry]) -> String {
    let info = Info {
        family: "A<script>alert(1)</script>".to_owned(),
        ..Info::default()
    };
    let left_out = [LeftOut {
        sheet: "page.png".to_owned(),
        box_px: [1.0, 2.0, 30.0, 40.0],
        area_px: 77,
        reason: "dirt".to_owned(),
    }];
    let characters = entries.iter().flat_map(|e| e.text.chars());
    page(&Proof {
        info: &info,
        entries,
        characters: &characters.collect(),
        left_out: &left_out,
        woff2: b"wOF2",
        last,
    })
}

#[test]
fn what_a_user_wrote_is_escaped() {
    let page = proof(&[entry("a", "<")]);
    assert!(!page.contains("<script>alert"), "the family name is text");
    assert!(!page.contains("<b>page"), "the file name is text");
    assert!(page.contains("&lt;b&gt;page &amp; &quot;more&quot;.png"));
}

#[test]
fn composed_letters_stand_in_the_lines() {
    let known = "fox".chars().collect();
    let lines = text::specimen(&[entry("f", "f")], &known).into_string();
    assert!(lines.contains(">fox<"), "{lines}");
}

#[test]
fn text_is_set_in_the_built_font() {
    let css = include_str!("proof.css");
    for selector in [".set", "#waterfall span", ".sample"] {
        let rules = css.split('}').filter_map(|rule| rule.split_once('{'));
        let mut fonts = rules.filter(|(to, _)| to.split(',').any(|s| s.trim() == selector));
        assert!(
            fonts.any(|(_, rule)| rule.contains("font-family: proofed")),
            "{selector}"
        );
    }
}

#[test]
fn remarks_and_what_was_left_out_are_shown() {
    let page = proof(&[entry("a", "a")]);
    assert!(page.contains("it looks &lt;odd&gt;"));
    assert!(page.contains("Ink in no glyph: 1") && page.contains("1, 2, 30, 40"));
}

#[test]
fn every_cell_has_picture_outline_and_nodes_and_nothing_comes_from_outside() {
    let page = proof(&[entry("a", "a"), entry("uni0628.init", "ب")]);
    assert_eq!(page.matches("<figure").count(), 2);
    assert_eq!(page.matches("data:image/png;base64,").count(), 2);
    assert!(page.contains("id=\"glyph-uni0628.init\"") && page.contains("lang=\"ar\""));
    assert!(page.contains("data:font/woff2;base64,d09GMg=="));
    for outside in ["http://", "https://", "src=\"", "<link"] {
        assert!(!page.contains(outside), "{outside}");
    }
    assert!(page.contains("dir=\"rtl\""), "Arabic runs right to left");
}

#[test]
fn layers_show_corners_comb_and_deviation() {
    let page = proof(&[entry("a", "a")]);
    for class in ["extrema corner", "comb", "heat bad", "heat fair"] {
        assert!(page.contains(&format!("class=\"{class}\"")), "{class}");
    }
    assert!(page.contains("data-worst=\"3.00\""));
    assert_eq!(
        page.matches("data-layer=").count(),
        LAYERS.len() - 1,
        "nothing was before"
    );
}

#[test]
fn the_page_remembers_what_was_before() {
    let moved = |name: &str| {
        let mut entry = entry(name, "a");
        let outline = &entry.glyph.outline;
        entry.glyph.outline = outline.transformed(kurbo::Affine::translate((7.0, 0.0)));
        entry.glyph.advance = 130.0;
        entry
    };
    let first = proof(&[entry("a", "a"), entry("b", "b"), entry("c", "c")]);
    assert!(!first.contains("Changed since"));
    let same = since(
        Some(&first),
        &[entry("a", "a"), entry("b", "b"), entry("c", "c")],
    );
    assert_eq!(same, first, "the same build gives the same page");
    let now = [entry("a", "a"), moved("b"), entry("d", "d")];
    let second = since(Some(&first), &now);
    assert!(second.contains("Changed since the build before: 3"));
    for (name, what) in [("b", "7.00"), ("c", "gone"), ("d", "new")] {
        let row = format!("<a href=\"#glyph-{name}\">{name}</a></td><td>{what}</td>");
        assert!(second.contains(&row), "{name}");
    }
    assert!(second.contains("120 → 130"));
    assert_eq!(second.matches("class=\"before\"").count(), 1);
    assert_eq!(
        since(Some(&second), &now),
        second,
        "it stays until something changes"
    );
    let spoilt = second.replace("M0.0", "M0.0 <script>");
    assert_eq!(
        since(Some(&spoilt), &now),
        proof(&now),
        "what no build wrote counts as none"
    );
}

#[test]
fn the_budget_is_in_units_and_on_paper() {
    let page = proof(&[entry("a", "a")]);
    for told in [
        "worst 3.00 units (0.060 mm)",
        "3.00 (0.060 mm)",
        "0.25 (0.005 mm)",
    ] {
        assert!(page.contains(told), "{told}");
    }
    assert!(page.contains("whole units"));
}
