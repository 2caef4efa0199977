//! Closed curves cut along a straight line that runs along an axis.

use kurbo::{BezPath, Line, ParamCurve, ParamCurveExtrema, PathSeg, Point, Shape};

/// What is left of a segment at a cut is no segment of its own where it is shorter, px.
const SLIVER_PX: f64 = 0.1;
/// A ring that reaches no further than this beyond the line, px, holds nothing.
const FLAT_PX: f64 = 1e-6;
/// Halvings that find a cut: of the widest picture's side a thousandth of the last digit is left.
const HALVINGS: usize = 60;

/// A side of a rectangle: what lies beyond it is cut off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Side {
    /// Greater x stays, px.
    Left(f64),
    /// Smaller x stays, px.
    Right(f64),
    /// Greater y stays, px.
    Bottom(f64),
    /// Smaller y stays, px.
    Top(f64),
}

impl Side {
    /// How far inside a point lies, px.
    fn depth(self, p: Point) -> f64 {
        match self {
            Self::Left(at) => p.x - at,
            Self::Right(at) => at - p.x,
            Self::Bottom(at) => p.y - at,
            Self::Top(at) => at - p.y,
        }
    }

    /// Where along the line a point lies, px.
    const fn along(self, p: Point) -> f64 {
        match self {
            Self::Left(_) | Self::Right(_) => p.y,
            Self::Bottom(_) | Self::Top(_) => p.x,
        }
    }

    /// The point of the line nearest to one.
    const fn onto(self, p: Point) -> Point {
        match self {
            Self::Left(at) | Self::Right(at) => Point::new(at, p.y),
            Self::Bottom(at) | Self::Top(at) => Point::new(p.x, at),
        }
    }
}

/// A part of a ring inside of a side, from where it comes in to where it goes out.
struct Run {
    ring: usize,
    segments: Vec<PathSeg>,
}

/// What of closed `paths` of lines and cubics lies inside of a `side`, closed by straight lines along it; and whether
/// each was cut. Paths that lie inside as a whole come as they are. Paths that neither cross nor touch stay such.
#[must_use]
pub fn clipped(paths: &[BezPath], side: Side) -> Vec<(BezPath, Cut)> {
    let mut out = Vec::new();
    let mut runs = Vec::new();
    for (ring, path) in paths.iter().enumerate() {
        let pieces: Vec<PathSeg> = path.segments().flat_map(|s| pieces(s, side)).collect();
        let inside = |s: &PathSeg| side.depth(s.eval(0.5)) >= 0.0;
        match pieces.iter().position(|s| !inside(s)) {
            None => out.push((path.clone(), Cut::Whole)),
            // a ring begins where it is outside
            Some(first) => {
                let (head, tail) = pieces.split_at(first);
                let around = [tail, head].concat();
                let parts = around.split(|s| !inside(s)).filter(|part| !part.is_empty());
                runs.extend(parts.map(|part| Run::new(ring, part, side)));
            }
        }
    }
    let next = linked(&runs, side);
    let mut done = vec![false; runs.len()];
    for first in 0..runs.len() {
        let mut ring = BezPath::new();
        let mut at = first;
        while !std::mem::replace(&mut done[at], true) {
            runs[at].draw(&mut ring);
            at = next[at];
        }
        let deepest = ring.segments().map(|s| side.depth(s.eval(0.5)));
        if deepest.fold(0.0, f64::max) > FLAT_PX {
            ring.close_path();
            out.push((ring, Cut::Along));
        }
    }
    out
}

/// Whether something was cut off a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cut {
    /// Nothing.
    Whole,
    /// It was cut, and runs along the line.
    Along,
}

impl Run {
    fn new(ring: usize, part: &[PathSeg], side: Side) -> Self {
        let mut segments = part.to_vec();
        while segments.len() > 1 && is_sliver(&segments[0]) {
            segments.remove(0);
        }
        while segments.len() > 1 && segments.last().is_some_and(is_sliver) {
            segments.pop();
        }
        if let Some(first) = segments.first_mut() {
            *first = moved(*first, side.onto(first.start()), first.end());
        }
        if let Some(last) = segments.last_mut() {
            *last = moved(*last, last.start(), side.onto(last.end()));
        }
        Self { ring, segments }
    }

    /// Where it comes in and where it goes out.
    fn ends(&self) -> [Point; 2] {
        let first = self.segments.first().map_or(Point::ZERO, PathSeg::start);
        [first, self.segments.last().map_or(first, PathSeg::end)]
    }

    /// Adds it to a ring, with a line to where it begins.
    fn draw(&self, ring: &mut BezPath) {
        let [start, _] = self.ends();
        match ring.segments().last().map(|s| s.end()) {
            None => ring.move_to(start),
            Some(end) if end.distance(start) > FLAT_PX => ring.line_to(start),
            Some(_) => {}
        }
        for segment in &self.segments {
            ring.push(segment.as_path_el());
        }
    }
}

/// The run that follows each along the line. Of paths that do not cross every second stretch of the line between ends
/// of runs is inside; where that is not so, each ring keeps to itself.
fn linked(runs: &[Run], side: Side) -> Vec<usize> {
    let mut ends: Vec<(f64, usize, usize)> = Vec::new();
    for (i, run) in runs.iter().enumerate() {
        let both = run.ends().into_iter().enumerate();
        ends.extend(both.map(|(end, p)| (side.along(p), end, i)));
    }
    ends.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let mut next: Vec<Option<usize>> = vec![None; runs.len()];
    for pair in ends.chunks_exact(2) {
        match (pair[0], pair[1]) {
            ((_, 1, out), (_, 0, into)) | ((_, 0, into), (_, 1, out)) => next[out] = Some(into),
            _ => {}
        }
    }
    let linked: Option<Vec<usize>> = next.into_iter().collect();
    linked.unwrap_or_else(|| (0..runs.len()).map(|i| beside(runs, i)).collect())
}

/// The next run of the same ring.
fn beside(runs: &[Run], i: usize) -> usize {
    let same = |j: &usize| runs[*j].ring == runs[i].ring;
    let after = (i + 1..runs.len()).find(same);
    after.or_else(|| (0..i).find(same)).unwrap_or(i)
}

/// The parts of a segment between its extrema across the line and where it crosses that, which lie on one side each.
fn pieces(segment: PathSeg, side: Side) -> Vec<PathSeg> {
    let depth = |t: f64| side.depth(segment.eval(t));
    let mut at = vec![0.0];
    at.extend(segment.extrema());
    at.push(1.0);
    let crossing = |(a, b): (&f64, &f64)| {
        let (mut from, mut to) = (*a, *b);
        let first = depth(from) >= 0.0;
        if first == (depth(to) >= 0.0) {
            return None;
        }
        for _ in 0..HALVINGS {
            let middle = f64::midpoint(from, to);
            if (depth(middle) >= 0.0) == first {
                from = middle;
            } else {
                to = middle;
            }
        }
        Some(f64::midpoint(from, to))
    };
    let mut cuts = vec![0.0];
    cuts.extend(at.iter().zip(&at[1..]).filter_map(crossing));
    cuts.push(1.0);
    let parts = cuts.iter().zip(&cuts[1..]).filter(|(a, b)| b > a);
    parts.map(|(a, b)| part(segment, *a, *b)).collect()
}

/// A part of a segment, itself where that is all of it.
fn part(segment: PathSeg, from: f64, to: f64) -> PathSeg {
    if from <= 0.0 && to >= 1.0 {
        segment
    } else {
        segment.subsegment(from..to)
    }
}

fn is_sliver(segment: &PathSeg) -> bool {
    let bounds = Shape::bounding_box(segment);
    bounds.width().hypot(bounds.height()) < SLIVER_PX
}

/// A segment between other ends, the handles moved with them.
fn moved(segment: PathSeg, start: Point, end: Point) -> PathSeg {
    let by = [start - segment.start(), end - segment.end()];
    match segment {
        PathSeg::Cubic(mut c) => {
            (c.p0, c.p1) = (start, c.p1 + by[0]);
            (c.p3, c.p2) = (end, c.p2 + by[1]);
            PathSeg::Cubic(c)
        }
        PathSeg::Quad(mut q) => {
            (q.p0, q.p2) = (start, end);
            q.p1 += (by[0] + by[1]) / 2.0;
            PathSeg::Quad(q)
        }
        PathSeg::Line(_) => PathSeg::Line(Line::new(start, end)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::{Circle, Rect};

    fn area(cut: &[(BezPath, Cut)]) -> f64 {
        cut.iter().map(|(p, _)| p.area()).sum()
    }

    fn circle(x: f64, y: f64, r: f64) -> BezPath {
        let path = Circle::new((x, y), r).to_path(1e-6);
        BezPath::from_iter(
            path.segments()
                .map(|s| PathSeg::Cubic(s.to_cubic()))
                .enumerate()
                .flat_map(|(i, s)| {
                    let start = (i == 0).then(|| kurbo::PathEl::MoveTo(s.start()));
                    start.into_iter().chain([s.as_path_el()])
                })
                .chain([kurbo::PathEl::ClosePath]),
        )
    }

    #[test]
    fn a_disk_is_cut_straight() {
        let disk = circle(0.0, 0.0, 10.0);
        for side in [
            Side::Left(2.6),
            Side::Right(-2.6),
            Side::Bottom(2.6),
            Side::Top(-2.6),
        ] {
            let cut = clipped(std::slice::from_ref(&disk), side);
            assert_eq!(cut.len(), 1, "{side:?}");
            // a segment of a circle
            let half = libm::acos(0.26_f64);
            let expected = 100.0 * (half - libm::sin(half) * libm::cos(half));
            assert!(
                (area(&cut) - expected).abs() < 0.01,
                "{side:?} {}",
                area(&cut)
            );
            let ring = &cut[0].0;
            assert!(
                ring.segments().all(|s| side.depth(s.start()) >= 0.0),
                "{side:?}"
            );
            assert!(
                ring.segments()
                    .any(|s| s.eval(0.5) == side.onto(s.eval(0.5))),
                "{side:?}: no line along it"
            );
        }
    }

    #[test]
    fn what_lies_on_one_side_stays_or_goes() {
        let disk = circle(0.0, 0.0, 10.0);
        let inside = clipped(std::slice::from_ref(&disk), Side::Left(-10.5));
        assert_eq!(inside, [(disk.clone(), Cut::Whole)]);
        assert!(clipped(std::slice::from_ref(&disk), Side::Left(10.5)).is_empty());
        assert!(clipped(&[], Side::Left(0.0)).is_empty());
    }

    #[test]
    fn rings_are_joined_and_parted_along_the_line() {
        // a ring with its hole becomes one ring
        let hole = circle(0.0, 0.0, 5.0).reverse_subpaths();
        let ring = clipped(&[circle(0.0, 0.0, 10.0), hole], Side::Bottom(0.0));
        assert_eq!(ring.len(), 1, "{ring:?}");
        let half = std::f64::consts::PI * 37.5;
        assert!((area(&ring) - half).abs() < 0.01, "{}", area(&ring));
        // a comb falls into its teeth, each a square
        let mut comb = BezPath::new();
        comb.move_to((0.0, 0.0));
        for (x, y) in [
            (5.0, 0.0),
            (5.0, 3.0),
            (4.0, 3.0),
            (4.0, 1.0),
            (1.0, 1.0),
            (1.0, 3.0),
            (0.0, 3.0),
        ] {
            comb.line_to((x, y));
        }
        comb.close_path();
        let teeth = clipped(&[comb], Side::Bottom(2.0));
        assert_eq!(teeth.len(), 2, "{teeth:?}");
        assert!((area(&teeth) - 2.0).abs() < 1e-9, "{teeth:?}");
        assert!(
            teeth.iter().all(|t| t.0.segments().count() == 4),
            "{teeth:?}"
        );
    }

    #[test]
    fn edges_on_the_line_hold_nothing() {
        let square = Rect::new(0.0, 0.0, 4.0, 4.0).to_path(0.1);
        let same = clipped(std::slice::from_ref(&square), Side::Bottom(0.0));
        assert!((area(&same) - 16.0).abs() < 1e-9, "{same:?}");
        let none = clipped(&[square], Side::Bottom(4.0));
        assert!(area(&none).abs() < 1e-9 && none.is_empty(), "{none:?}");
    }

    #[test]
    fn slivers_at_the_cut_are_no_segments() {
        let mut path = BezPath::new();
        path.move_to((0.0, -5.0));
        for (x, y) in [(4.0, -5.0), (4.0, 0.05), (4.0, 5.0), (0.0, 5.0)] {
            path.line_to((x, y));
        }
        path.close_path();
        let cut = clipped(&[path], Side::Bottom(0.0));
        assert_eq!(cut[0].0.segments().count(), 4, "{cut:?}");
    }
}
