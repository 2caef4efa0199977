//! UFOs of several weights become one family.

use crate::common::desk::Desk;
use khatt::types::{Font, Glyph, Info, Name, Outline};
use khatt::write;
use kurbo::BezPath;
use norad::designspace::DesignSpaceDocument;

/// Writes the UFO of a font of one letter.
fn ufo(desk: &Desk, name: &str, (family, weight): (&str, u16), letter: &str) {
    let a = Glyph {
        outline: Outline::new(vec![BezPath::from_svg(letter).expect("a path")]).expect("closed"),
        ..Glyph::new(Name::new("A").expect("a name"), vec!['A'], 500.0)
    };
    let info = Info {
        family: family.to_owned(),
        style: name.to_owned(),
        weight,
        italic_angle: if name.contains("Italic") { -12.0 } else { 0.0 },
        ..Info::default()
    };
    let font = Font::new(info, vec![Glyph::new(Name::notdef(), Vec::new(), 500.0), a]);
    let format = write::format("ufo").expect("a format");
    let files = (format.write)(&font.expect("a font")).expect("a UFO");
    for (path, content) in files.0 {
        desk.write(&format!("ufo/{name}.ufo/{path}"), content);
    }
}

const THIN: &str = "M0 0L40 0L40 700L0 700Z";
const FAT: &str = "M0 0L140 0L140 700L0 700Z";
const OTHER: &str = "M0 0L140 0L140 300L140 700L0 700Z";

#[test]
fn weights_share_an_axis_and_only_like_outlines_are_interpolated() {
    let desk = Desk::new();
    ufo(&desk, "Bold", ("Family", 700), FAT);
    ufo(&desk, "Regular", ("Family", 400), THIN);
    ufo(&desk, "Odd", ("Family", 900), OTHER);
    ufo(&desk, "Twin", ("Family", 700), FAT);
    ufo(&desk, "Stranger", ("Strangers", 300), FAT);
    ufo(&desk, "Light Italic", ("Family", 300), THIN);
    ufo(&desk, "Black Italic", ("Family", 900), FAT);
    let run = |masters: &[&str]| {
        let ufos: Vec<String> = masters.iter().map(|m| format!("ufo/{m}.ufo")).collect();
        let mut args = vec!["designspace", "-o", "build/Family.designspace"];
        args.extend(ufos.iter().map(String::as_str));
        desk.told(&args)
    };
    let read = || {
        let document = DesignSpaceDocument::load(desk.path("build/Family.designspace"));
        document.expect("a designspace")
    };

    assert_eq!(run(&["Bold", "Regular"]), (Some(0), String::new()));
    let like = read();
    let axis = &like.axes[0];
    assert_eq!((axis.tag.as_str(), axis.values.as_ref()), ("wght", None));
    assert_eq!((axis.minimum, axis.maximum), (Some(400.0), Some(700.0)));
    assert!((axis.default - 400.0).abs() < 1e-9, "{axis:?}");
    let sources: Vec<_> = like.sources.iter().map(|s| s.filename.as_str()).collect();
    assert_eq!(sources, ["../ufo/Regular.ufo", "../ufo/Bold.ufo"]);
    let styles: Vec<_> = like
        .instances
        .iter()
        .map(|i| i.stylename.as_deref())
        .collect();
    assert_eq!(styles, [Some("Regular"), Some("Bold")]);

    assert_eq!(run(&["Light Italic", "Black Italic"]).0, Some(0));

    let (status, said) = run(&["Regular", "Bold", "Odd"]);
    assert_eq!(status, Some(0), "{said}");
    let line = "A: 4 points in contour 1 in Regular, 5 points in contour 1 in Odd";
    assert!(
        said.contains("1 glyph is not built alike") && said.contains(line),
        "{said}"
    );
    assert_eq!(read().axes[0].values, Some(vec![400.0, 700.0, 900.0]));

    for (masters, why) in [
        (&["Bold"][..], "two UFOs at least"),
        (&["Bold", "Twin"], "both have the weight 700"),
        (&["Bold", "Stranger"], "of the family “Strangers”"),
        (&["Bold", "Missing"], "Missing.ufo"),
        (
            &["Bold", "Light Italic"],
            "Light Italic.ufo is an italic and ../ufo/Bold.ufo is none",
        ),
    ] {
        let (status, said) = run(masters);
        assert!(
            status == Some(1) && said.contains(why),
            "{masters:?}: {said}"
        );
    }
    assert_eq!(
        read().sources.len(),
        3,
        "nothing is written where something is wrong"
    );
}
