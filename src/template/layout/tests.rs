//! Layouts from lists of glyphs, and codes.

use super::*;

#[test]
fn guides_need_height() {
    let flat = Layout {
        descender: 0.0,
        x_height: 0.0,
        cap_height: 0.0,
        ascender: 0.0,
        ..Layout::default()
    };
    let told = flat.check();
    let is_told = matches!(
        &told,
        Err(TemplateError::Option {
            option: "ascender",
            ..
        })
    );
    assert!(is_told, "{told:?}");
}

#[test]
fn codes_read_back() {
    let code = Code {
        id: "0123ABCD".into(),
        page: 3,
        pages: 12,
    };
    assert_eq!(Code::parse(&code.to_string()), Some(code));
    for bad in [
        "",
        "KHATT1 12 1/1",
        "KHATT1 0123ABCD 0/2",
        "KHATT1 0123ABCD 3/2",
        "http://x",
    ] {
        assert_eq!(Code::parse(bad), None, "{bad}");
    }
}

#[test]
fn fields_neither_overlap_nor_leave_the_paper() {
    let labels: Vec<String> = (0..100).map(|i| format!("g{i}")).collect();
    for paper in [Paper::A4, Paper::Letter, Paper::Size(148.0, 210.0)] {
        let layout = Layout {
            paper,
            ..Layout::default()
        };
        layout.check().unwrap();
        let pages = layout.places(&labels, Direction::Rtl);
        assert_eq!(pages.len(), 2);
        for (i, a) in pages[0].iter().enumerate() {
            assert!(layout.paper_mm().to_rect().contains_rect(a.field));
            for b in &pages[0][..i] {
                assert!(
                    a.field.intersect(b.field).area() <= 0.0,
                    "{} {}",
                    a.label,
                    b.label
                );
            }
        }
        assert!(
            pages[0][0].field.x0 > pages[0][1].field.x0,
            "read from the right"
        );
        assert_eq!(pages[1][0].index, layout.per_page());
    }
}

#[test]
fn a_cells_size_gives_rows_and_columns() {
    let layout = Layout {
        cell_mm: Some([25.0, 31.0]),
        ..Layout::default()
    };
    layout.check().unwrap();
    // 190 × 251 mm of an A4 page
    assert_eq!((layout.columns(), layout.rows()), (7, 8));
}

#[test]
fn fields_may_stand_anywhere() {
    let cell = |field: [f64; 4], baseline: Option<f64>| Field { field, baseline };
    let with = |cells: Vec<Field>| Layout {
        cells,
        ..Layout::default()
    };
    let layout = with(vec![
        cell([20.0, 40.0, 90.0, 120.0], None),
        cell([110.0, 60.0, 180.0, 140.0], Some(100.0)),
    ]);
    layout.check().unwrap();
    let labels: Vec<String> = ["a", "b", "c"].map(str::to_owned).to_vec();
    let pages = layout.places(&labels, Direction::Ltr);
    assert_eq!(pages.iter().map(Vec::len).collect::<Vec<_>>(), [2, 1]);
    assert_eq!(pages[1][0].index, 2);
    assert_eq!(pages[0][1].field, Rect::new(110.0, 60.0, 180.0, 140.0));
    assert!((pages[0][1].baseline - 100.0).abs() < 1e-12);
    let middle = pages[0][0].baseline - 0.8 * layout.em() - 40.0;
    assert!((middle - (120.0 - pages[0][0].baseline - 0.35 * layout.em())).abs() < 1e-9);
    for wrong in [
        vec![cell([20.0, 20.0, 90.0, 120.0], None)],
        vec![cell([20.0, 40.0, 21.0, 120.0], None)],
        vec![cell([20.0, 40.0, 90.0, 120.0], Some(130.0))],
        vec![cell([20.0, 40.0, 90.0, 120.0], None); 2],
        vec![cell([f64::NAN, 40.0, 90.0, 120.0], None)],
    ] {
        let told = with(wrong.clone()).check();
        assert!(
            matches!(
                told,
                Err(TemplateError::Option {
                    option: "cells",
                    ..
                })
            ),
            "{wrong:?}"
        );
    }
}

#[test]
fn a_printing_is_known_by_its_name_and_places() {
    let labels: Vec<String> = ["a", "b"].map(str::to_owned).to_vec();
    let id = |layout: &Layout, name: &str, labels: &[String]| {
        layout.id(name, &layout.places(labels, Direction::Ltr))
    };
    let layout = Layout::default();
    let same = Layout {
        columns: Some(8),
        ..Layout::default()
    };
    let other = Layout {
        rows: Some(8),
        ..Layout::default()
    };
    let first = id(&layout, "x", &labels);
    assert_eq!(first, id(&same, "x", &labels));
    assert_ne!(first, id(&other, "x", &labels));
    assert_ne!(first, id(&layout, "y", &labels));
    assert_ne!(first, id(&layout, "x", &labels[..1]));
}

#[test]
fn bad_layouts_are_named() {
    let bad = [
        Layout {
            rows: Some(0),
            ..Layout::default()
        },
        Layout {
            columns: Some(41),
            ..Layout::default()
        },
        Layout {
            cell_mm: Some([300.0, 20.0]),
            ..Layout::default()
        },
        Layout {
            em_mm: Some(60.0),
            ..Layout::default()
        },
        Layout {
            em_mm: Some(f64::NAN),
            ..Layout::default()
        },
        Layout {
            descender: 0.2,
            ..Layout::default()
        },
        Layout {
            paper: Paper::Size(1e9, 3.0),
            ..Layout::default()
        },
        Layout {
            joining: [0.1, 0.1],
            ..Layout::default()
        },
    ];
    for layout in bad {
        assert!(
            matches!(layout.check(), Err(TemplateError::Option { .. })),
            "{layout:?}"
        );
    }
}
