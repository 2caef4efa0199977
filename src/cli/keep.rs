//! `--keep`: what each stage made of each cell.

use khatt::pipeline::{Built, Letter};
use khatt::types::{Contour, Files};
use khatt::write::{self, picture};
use kurbo::{BezPath, PathEl};

/// For every cell its picture, its contours and its curves in the picture's pixels; for every glyph its
/// outline in font units; the OpenType features.
pub(crate) fn files(built: &Built) -> Files {
    let mut files = Files::default();
    for (n, letter) in built.letters.iter().enumerate() {
        let stem = format!("{:03}-{}", n + 1, letter.index + 1);
        let png = &letter.picture;
        let size = (png.width, png.height);
        let mut add = |stage: &str, kind: &str, content: Vec<u8>| {
            files.0.insert(format!("{stage}/{stem}.{kind}"), content);
        };
        add("1-cut", "png", png.bytes.clone());
        add(
            "2-trace",
            "svg",
            picture::svg(size, &rings(letter)).into_bytes(),
        );
        add(
            "3-fit",
            "svg",
            picture::svg(size, &letter.paths).into_bytes(),
        );
    }
    if let Some(format) = write::format("svg") {
        let outlines = (format.write)(&built.font).unwrap_or_default();
        let placed = outlines
            .0
            .into_iter()
            .map(|(name, svg)| (format!("4-place/{name}"), svg));
        files.0.extend(placed);
    }
    let features = write::layout::text(&built.font).into_bytes();
    files
        .0
        .insert("5-assemble/features.fea".to_owned(), features);
    files
}

/// The contours as closed polygons.
fn rings(letter: &Letter) -> Vec<BezPath> {
    let ring = |c: &Contour| {
        let mut points = c.points().iter();
        let first = points.next().map(|&p| PathEl::MoveTo(p));
        let lines = points.map(|&p| PathEl::LineTo(p));
        let ring = first.into_iter().chain(lines);
        ring.chain([PathEl::ClosePath]).collect()
    };
    letter.edge.iter().map(ring).collect()
}
