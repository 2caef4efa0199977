//! Nodes that stand in the middle of a straight line: a structure that came and went has left them.

use kurbo::{BezPath, Line, ParamCurve, PathSeg};
use std::mem;

/// A node goes where the two pieces that meet there are one line but for this, px.
const STRAIGHT_PX: f64 = 0.01;

/// The closed path, with one line in the place of pieces that are one.
pub(super) fn straightened(path: BezPath) -> BezPath {
    let mut runs: Vec<Vec<PathSeg>> = Vec::new();
    for piece in path.segments() {
        match runs.last_mut() {
            Some(run) if are_one(run, &[piece]) => run.push(piece),
            _ => runs.push(vec![piece]),
        }
    }
    // the node where the path begins
    if let [first, .., last] = runs.as_slice()
        && are_one(last, first)
    {
        let both = [last.as_slice(), first].concat();
        runs.pop();
        runs[0] = both;
    }
    if runs.len() < 2 || runs.iter().all(|run| run.len() == 1) {
        return path;
    }
    let piece = |run: &Vec<PathSeg>| match run.as_slice() {
        [first, .., last] => Some(PathSeg::Line(Line::new(first.start(), last.end()))),
        alone => alone.first().copied(),
    };
    let mut straightened = BezPath::from_path_segments(runs.iter().filter_map(piece));
    straightened.close_path();
    straightened
}

/// Whether pieces that follow each other are one line: all of them, since little by little they may bend.
fn are_one(before: &[PathSeg], after: &[PathSeg]) -> bool {
    let (Some(first), Some(last)) = (before.first(), after.last()) else {
        return false;
    };
    let (start, way) = (first.start(), last.end() - first.start());
    let cubics = before.iter().chain(after).map(PathSeg::to_cubic);
    let mut gone = 0.0;
    cubics.flat_map(|c| [c.p1, c.p2, c.p3]).all(|p| {
        let off = p - start;
        let before = mem::replace(&mut gone, off.dot(way));
        // a handle may have no length
        before <= gone && off.cross(way).abs() < STRAIGHT_PX * way.hypot()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::angles;
    use kurbo::{ParamCurveNearest, Point, Shape};

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

    #[test]
    fn short_pieces_of_a_bend_are_no_line() {
        let bend = |k: i32| (100.0 * angles::direction(0.001 * f64::from(k))).to_point();
        let points: Vec<Point> = (0..400).map(bend).collect();
        let mut path = BezPath::from_svg("M0 0").unwrap();
        points.iter().for_each(|p| path.line_to(*p));
        path.close_path();
        let got = straightened(path);
        for p in points {
            let off = |s: PathSeg| s.nearest(p, 1e-9).distance_sq;
            let off = got.segments().map(off).fold(f64::INFINITY, f64::min);
            assert!(off.sqrt() < STRAIGHT_PX, "{p} {}", off.sqrt());
        }
    }
}
