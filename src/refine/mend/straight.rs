//! Nodes that stand in the middle of a straight line: a structure that came and went has left them.

use kurbo::{BezPath, Line, ParamCurve, PathSeg};
use std::mem;

/// A node goes where the two pieces that meet there are one line but for this, px.
const STRAIGHT_PX: f64 = 0.01;

/// The closed path, with one line in the place of two pieces that are one.
pub(super) fn straightened(path: BezPath) -> BezPath {
    let mut out: Vec<PathSeg> = Vec::new();
    for next in path.segments() {
        match out.last().and_then(|last| one_line(*last, next)) {
            Some(both) => {
                out.pop();
                out.push(both);
            }
            None => out.push(next),
        }
    }
    // the node where the path begins
    if let [first, .., last] = out[..]
        && let Some(both) = one_line(last, first)
    {
        out.pop();
        out[0] = both;
    }
    if out.len() < 2 || out.len() == path.segments().count() {
        return path;
    }
    let mut straightened = BezPath::from_path_segments(out.into_iter());
    straightened.close_path();
    straightened
}

/// The line that two pieces make which follow each other.
fn one_line(a: PathSeg, b: PathSeg) -> Option<PathSeg> {
    let line = Line::new(a.start(), b.end());
    let way = line.p1 - line.p0;
    let [a, b] = [a.to_cubic(), b.to_cubic()];
    let mut gone = 0.0;
    let straight = [a.p1, a.p2, a.p3, b.p1, b.p2, b.p3].iter().all(|p| {
        let off = *p - line.p0;
        let before = mem::replace(&mut gone, off.dot(way));
        // a handle may have no length
        before <= gone && off.cross(way).abs() < STRAIGHT_PX * way.hypot()
    });
    straight.then_some(PathSeg::Line(line))
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::Shape;

    #[test]
    fn a_node_within_a_line_goes_and_a_corner_stays() {
        let square = "M0 0L20 0L20 20L0 20L0 0Z";
        for more in [
            square,
            "M10 0L20 0L20 20L0 20L0 0L10 0Z",
            "M0 0L5 0L10 0C12 0 14 0.005 16 0L20 0L20 20L0 20L0 0Z",
        ] {
            let got = straightened(BezPath::from_svg(more).unwrap());
            assert_eq!(got.segments().count(), 4, "{}", got.to_svg());
            assert!((got.area() - 400.0).abs() < 0.1);
        }
        for kept in [
            // bent by more, back along itself, of two pieces alone
            "M0 0L10 0.02L20 0L20 20L0 20L0 0Z",
            "M0 0L25 0L20 0L20 20L0 20L0 0Z",
            "M0 0L10 0L0 0Z",
        ] {
            let path = BezPath::from_svg(kept).unwrap();
            assert_eq!(straightened(path.clone()), path);
        }
    }
}
