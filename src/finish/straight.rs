//! Curves that whole units make straight become lines, and nodes that these put within a line go.
//!
//! A stem's side that is bent by a quarter of a unit has a few curves; on the grid it is one line. Its ends stay where
//! they are; the handles of a curve beside it may come to lie on another unit, since they are rounded with what they
//! continue.

use super::round;
use crate::types::{Font, Outline};
use kurbo::{BezPath, Line, ParamCurve, PathEl, PathSeg};

/// Lines that turn by less are one, radians; and how far off a chord of 1 a handle on it may come out.
const STRAIGHT: f64 = 1e-9;

/// What leads from one node to the next.
struct Segment {
    drawn: PathSeg,
    /// The line that it becomes on the grid, if it does.
    on_grid: Option<Line>,
    /// The line that it was drawn as, if it was.
    line: Option<Line>,
}

/// The font with lines where whole units leave nothing else.
#[must_use]
pub fn font(font: &Font) -> Font {
    font.map_glyphs(|glyph| {
        let contours = glyph.outline.contours().iter().map(contour);
        let mut glyph = glyph.clone();
        // closed and finite like what came in
        glyph.outline = Outline::new(contours.collect()).unwrap_or(glyph.outline);
        glyph
    })
}

fn contour(path: &BezPath) -> BezPath {
    let rounded = round::contour(path);
    let segments = 1..rounded.elements().len();
    let segments = segments.filter_map(|i| Some((path.get_seg(i)?, rounded.get_seg(i)?)));
    let mut changed = false;
    let mut out: Vec<Segment> = Vec::new();
    for (drawn, on_grid) in segments {
        let mut next = Segment {
            drawn,
            on_grid: straight(on_grid),
            line: straight(drawn),
        };
        if next.line.is_none() && next.on_grid.is_some() {
            next.drawn = PathSeg::Line(Line::new(drawn.start(), drawn.end()));
            changed = true;
        }
        let both = out.last().and_then(|last| last.with(&next));
        if both.is_some() {
            changed = true;
            out.pop();
        }
        out.push(both.unwrap_or(next));
    }
    // the node where the contour begins
    if let [first, .., last] = out.as_slice()
        && let Some(both) = last.with(first)
    {
        changed = true;
        out.pop();
        out[0] = both;
    }
    if !changed {
        return path.clone();
    }
    let mut path = BezPath::from_path_segments(out.iter().map(|s| s.drawn));
    path.push(PathEl::ClosePath);
    path
}

impl Segment {
    /// This one and the next as one line, where the grid alone puts them on one.
    fn with(&self, next: &Self) -> Option<Self> {
        let (a, b) = self.on_grid.zip(next.on_grid)?;
        let as_drawn = self.line.zip(next.line).is_some_and(|(a, b)| go_on(a, b));
        (go_on(a, b) && !as_drawn).then(|| Self {
            drawn: PathSeg::Line(Line::new(self.drawn.start(), next.drawn.end())),
            on_grid: Some(Line::new(a.p0, b.p1)),
            line: None,
        })
    }
}

/// The chord of a segment that runs along it.
fn straight(segment: PathSeg) -> Option<Line> {
    let c = segment.to_cubic();
    let chord = c.p3 - c.p0;
    let within = |p| {
        let way = p - c.p0;
        let (along, off) = (chord.dot(way), chord.cross(way).abs());
        off <= STRAIGHT * chord.hypot2()
            && (-STRAIGHT..=1.0 + STRAIGHT).contains(&(along / chord.hypot2()))
    };
    (within(c.p1) && within(c.p2)).then(|| Line::new(c.p0, c.p3))
}

/// Whether one line goes on in the direction of another.
fn go_on(a: Line, b: Line) -> bool {
    let (u, v) = (a.p1 - a.p0, b.p1 - b.p0);
    u.dot(v) > 0.0 && u.cross(v).abs() <= STRAIGHT * u.dot(v)
}

#[cfg(test)]
mod tests {
    use super::{contour, round};
    use kurbo::BezPath;

    fn straightened(svg: &str) -> BezPath {
        contour(&BezPath::from_svg(svg).unwrap())
    }

    #[test]
    fn a_stem_s_side_is_one_line() {
        // a curve that stays, then a side of one more and a line
        let svg = "M0 0L60 0C61 50 61 150 60 200C60.2 250 60.3 300 60.1 350L59.8 500L0 500C-.2 300 -.1 200 0 0Z";
        let out = straightened(svg);
        let lines = "M0,0 L60,0 C61,50 61,150 60,200 L59.8,500 L0,500 L0,0 Z";
        assert_eq!(out.to_svg(), lines);
        assert_eq!(contour(&out), out);
        let beyond = "M0,0 L60,0 L60,500 L0,500 C0,600 0,200 0,0 Z";
        assert_eq!(
            straightened(beyond).to_svg(),
            beyond,
            "it leads beyond its end"
        );
    }

    #[test]
    fn nodes_that_were_drawn_in_a_line_stay() {
        for drawn in [
            "M0,0 L60,0 L60,250 L60,500 L0,500 Z",
            "M0.1,0.1 L60.1,0.1 L60.1,250.1 L60.1,500.1 L0.1,500.1 Z",
        ] {
            assert_eq!(straightened(drawn).to_svg(), drawn);
        }
        let bent = straightened("M60,250 L60.3,500 L0,500 L0,0 L60,0 Z");
        assert_eq!(bent.to_svg(), "M60,0 L60.3,500 L0,500 L0,0 L60,0 Z");
        assert_eq!(round::contour(&bent).segments().count(), 4);
    }
}
