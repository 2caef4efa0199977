//! The end of a stroke on one side of a glyph: found, measured, cut square, and moved.
//!
//! Sums are done in `u`, the distance inward from the side: `u = x` on the left, `u = -x` on the
//! right. So one piece of code serves both.

use kurbo::{BezPath, Line, ParamCurve, PathEl, PathSeg, Point, Shape};

/// A side of a glyph.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Side {
    /// Where the next letter of Arabic text joins.
    Left,
    /// Where the letter before joins.
    Right,
}

impl Side {
    /// Inward distance of an x coordinate, and an x coordinate of an inward distance.
    pub(super) const fn inward(self, x: f64) -> f64 {
        match self {
            Self::Left => x,
            Self::Right => -x,
        }
    }
}

/// Samples on a segment between which the contour counts as monotone.
const SAMPLES: u32 = 16;

/// Halvings of a sample interval until a crossing is known: to a millionth of it.
const HALVINGS: u32 = 20;

/// Lower and upper edge of a stroke, or something about each.
pub(super) type Edges = (f64, f64);

/// A place on a contour.
#[derive(Debug, Clone, Copy)]
struct Place {
    segment: usize,
    t: f64,
    at: Point,
}

/// The end of a stroke, seen from one side.
#[derive(Debug, Clone)]
pub(super) struct End {
    /// Index of its contour.
    pub(super) contour: usize,
    /// Inward distance of the outermost point.
    pub(super) tip: f64,
    /// Inward distance of the line at which it is measured and cut.
    pub(super) cut: f64,
    /// Lower and upper edge at the cut, y.
    pub(super) edges: Edges,
    /// How the two edges run there, dy/dx.
    pub(super) slopes: Edges,
    /// Where the contour crosses the cut: after the tip, and before it.
    crossings: (Place, Place),
}

/// Heights at which a letter's face is felt, evenly between the edges of a stroke that meets it.
const RAYS: u32 = 5;

/// Inward distances at which a stroke that comes from that side meets ink: the first and the last of its heights.
/// None where it has no ink before it at one of them.
pub(super) fn face(contours: &[BezPath], side: Side, (low, high): Edges) -> Option<Edges> {
    let bounds = contours
        .iter()
        .map(Shape::bounding_box)
        .reduce(|a, b| a.union(b))?
        .inflate(1.0, 1.0);
    let meets = |k: u32| {
        let y = low + (high - low) * (f64::from(k) + 0.5) / f64::from(RAYS);
        let ray = Line::new((bounds.x0, y), (bounds.x1, y));
        let segments = contours.iter().flat_map(BezPath::segments);
        let met = segments.flat_map(|s| s.intersect_line(ray));
        met.map(|at| side.inward(ray.eval(at.line_t).x))
            .reduce(f64::min)
    };
    let met: Option<Vec<f64>> = (0..RAYS).map(meets).collect();
    met?.into_iter()
        .map(|u| (u, u))
        .reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
}

/// A contour's segments and samples in order.
struct Walk {
    segments: Vec<PathSeg>,
    samples: Vec<Place>,
}

impl Walk {
    fn of(path: &BezPath) -> Self {
        let segments: Vec<PathSeg> = path
            .segments()
            .filter(|s| s.start() != s.end() || !matches!(s, PathSeg::Line(_)))
            .collect();
        let place = |(segment, s): (usize, &PathSeg)| {
            let s = *s;
            (0..SAMPLES).map(move |k| {
                let t = f64::from(k) / f64::from(SAMPLES);
                Place {
                    segment,
                    t,
                    at: s.eval(t),
                }
            })
        };
        let samples = segments.iter().enumerate().flat_map(place).collect();
        Self { segments, samples }
    }

    fn get(&self, i: usize) -> Option<Place> {
        let n = self.samples.len();
        (n > 0).then(|| self.samples.get(i % n).copied()).flatten()
    }

    /// Sample numbers of the places that lie further out than what is around them. A straight cut
    /// counts once, at its middle.
    fn tips(&self, side: Side) -> Vec<usize> {
        let n = self.samples.len();
        let u = |i: usize| self.get(i).map_or(0.0, |p| side.inward(p.at.x));
        let level = |a: f64, b: f64| (a - b).abs() < 1e-6;
        let mut out = Vec::new();
        for i in 0..n {
            // i is the first sample of a level run
            if level(u(i + n - 1), u(i)) || u(i + n - 1) < u(i) {
                continue;
            }
            let run = (0..n).take_while(|&k| level(u(i + k), u(i))).count();
            if run < n && u(i + run) > u(i) {
                out.push((i + run / 2) % n);
            }
        }
        out
    }

    /// From a tip, forward or backward, to where the contour is `cut` inward.
    fn cross(&self, tip: usize, cut: f64, side: Side, step: usize) -> Option<Place> {
        let n = self.samples.len();
        let mut i = tip;
        for _ in 0..n {
            let next = (i + step) % n;
            let (here, there) = (self.get(i)?, self.get(next)?);
            if side.inward(there.at.x) >= cut {
                let forward = step == 1;
                let (from, to) = if forward {
                    (here, there)
                } else {
                    (there, here)
                };
                return self.refine(from, to, cut, side);
            }
            i = next;
        }
        None
    }

    /// Between two neighbouring samples in contour order, the place that is `cut` inward.
    fn refine(&self, from: Place, to: Place, cut: f64, side: Side) -> Option<Place> {
        let segment = self.segments.get(from.segment)?;
        let (mut a, mut b) = (
            from.t,
            if to.segment == from.segment && to.t > from.t {
                to.t
            } else {
                1.0
            },
        );
        let rises = side.inward(segment.eval(b).x) >= side.inward(segment.eval(a).x);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (a + b);
            let is_in = side.inward(segment.eval(middle).x) >= cut;
            if is_in == rises {
                b = middle
            } else {
                a = middle
            }
        }
        let t = 0.5 * (a + b);
        Some(Place {
            segment: from.segment,
            t,
            at: segment.eval(t),
        })
    }
}

/// Depths tried until the roundness of an end is over: this many, each a quarter of the first further in.
const DEPTHS: u32 = 17;

/// Growth of a stroke's thickness over a first depth that counts as none, part of the thickness.
const GROWTH: f64 = 0.015;

/// Roundness grows ever less further in. Where the next growth is at least this part of one, the stroke
/// itself widens, unless it opens: then its end is cut at a slant.
const TAPER: f64 = 0.8;

/// How much thicker a stroke becomes over a length of its end at most, part of that length: half a right angle
/// between its edges. What opens wider is a slanted end, or a body's bow or tooth.
pub(super) const OPENING: f64 = 1.0;

/// And behind a slanted end, as soon as that is passed, which takes a first depth: a bow opens ever less.
const PARALLEL: f64 = 0.25;
const PASSED: u32 = 5;
/// Of what a slant opens the stroke's other edge makes this share at most.
const ONE_EDGE: f64 = 1.0 / 3.0;

/// Every stroke end on that side: each place that sticks out, measured where its roundness is over,
/// `depth` inside at least.
pub(super) fn ends(contours: &[BezPath], side: Side, depth: f64) -> Vec<End> {
    let mut out = Vec::new();
    for (contour, path) in contours.iter().enumerate() {
        let walk = Walk::of(path);
        for tip in walk.tips(side) {
            out.extend(walk.end(contour, tip, side, depth));
        }
    }
    out
}

/// How far inside a tip the roundness of a stroke's end is over, and its slant; of what opens all along, where it first
/// does so steadily. None where the contour ends before. `edges` says where the contour passes at a distance inside.
fn over(edges: impl Fn(f64) -> Option<Edges>, depth: f64) -> Option<f64> {
    let thickness = |inside: f64| edges(inside).map(|(a, b)| (a - b).abs());
    let growth = |inside: f64| {
        let here = thickness(inside)?;
        let next = thickness(inside + depth)?;
        let further = thickness(inside + 2.0 * depth).unwrap_or(f64::INFINITY);
        let is_steady = next - here <= (GROWTH * here).max((further - next) / TAPER);
        Some((is_steady, next - here))
    };
    // a slant is one edge's; both open at a tooth
    let is_one_edge = |inside: f64, growth: f64| {
        let moved = edges(inside).zip(edges(inside + depth));
        moved.is_some_and(|(here, next)| {
            let (one, other) = ((next.0 - here.0).abs(), (next.1 - here.1).abs());
            one.min(other) < ONE_EDGE * growth
        })
    };
    // where it opens steadily, and how fast
    let mut slant: Option<(f64, f64)> = None;
    let (mut quarter, mut left) = (4_u32, DEPTHS);
    let mut inside = depth;
    while left > 0 {
        inside = 0.25 * depth * f64::from(quarter);
        let Some((is_steady, growth)) = growth(inside) else {
            return slant.map(|(first, _)| first);
        };
        let most = if slant.is_some() { PARALLEL } else { OPENING };
        if is_steady && growth < most * depth {
            return Some(inside);
        }
        (quarter, left) = (quarter + 1, left - 1);
        if is_steady && slant.is_none() {
            slant = Some((inside, growth));
        }
        if slant.is_some_and(|(_, fast)| growth > TAPER * fast) && is_one_edge(inside, growth) {
            left = left.max(PASSED);
        }
    }
    Some(slant.map_or(inside, |(first, _)| first))
}

impl Walk {
    /// The stroke end behind a tip.
    fn end(&self, contour: usize, tip: usize, side: Side, depth: f64) -> Option<End> {
        let outermost = side.inward(self.get(tip)?.at.x);
        let back = self.samples.len() - 1;
        let at = |inside: f64| {
            let cut = outermost + inside;
            Some((
                self.cross(tip, cut, side, 1)?,
                self.cross(tip, cut, side, back)?,
            ))
        };
        let inside = over(|inside| at(inside).map(|(a, b)| (a.at.y, b.at.y)), depth)?;
        let ((after, before), (far_after, far_before)) = (at(inside)?, at(inside + depth)?);
        let slope = |near: Place, far: Place| (far.at.y - near.at.y) / side.inward(depth);
        let one = (after.at.y, slope(after, far_after));
        let other = (before.at.y, slope(before, far_before));
        let (low, high) = if one.0 <= other.0 {
            (one, other)
        } else {
            (other, one)
        };
        Some(End {
            contour,
            tip: outermost,
            cut: outermost + inside,
            edges: (low.0, high.0),
            slopes: (low.1, high.1),
            crossings: (after, before),
        })
    }
}

/// The contour with everything beyond the cut replaced by a tab of that length, whose edges go on with
/// the given slopes.
pub(super) fn square(path: &BezPath, end: &End, side: Side, tab: Tab) -> Option<BezPath> {
    let walk = Walk::of(path);
    let (after, before) = end.crossings;
    let mut out = BezPath::new();
    let x = |u: f64| side.inward(u);
    // exactly on the cut, where bisection leaves a millionth
    let start = Point::new(x(end.cut), after.at.y);
    let stop = Point::new(x(end.cut), before.at.y);
    out.move_to(start);
    let (n, first) = (walk.segments.len(), walk.segments.get(after.segment)?);
    if after.segment == before.segment && after.t < before.t {
        let part = first.subsegment(after.t..before.t);
        out.push(part.as_path_el());
    } else {
        out.push(first.subsegment(after.t..1.0).as_path_el());
        let mut i = (after.segment + 1) % n;
        while i != before.segment {
            out.push(walk.segments.get(i)?.as_path_el());
            i = (i + 1) % n;
        }
        let last = walk.segments.get(i)?;
        out.push(last.subsegment(0.0..before.t).as_path_el());
    }
    set_end(&mut out, stop);
    let corner = |p: Point| {
        let slope = if (p.y - end.edges.0).abs() < (p.y - end.edges.1).abs() {
            tab.slopes.0
        } else {
            tab.slopes.1
        };
        let reach = x(end.cut - tab.length) - p.x;
        Point::new(p.x + reach, p.y + slope * reach)
    };
    out.line_to(corner(stop));
    out.line_to(corner(start));
    out.close_path();
    Some(out)
}

/// What a cut stroke is continued with.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tab {
    pub(super) length: f64,
    pub(super) slopes: Edges,
}

/// Puts a path's last point, which misses by rounding, where it belongs.
fn set_end(path: &mut BezPath, at: Point) {
    let last = path.elements_mut().last_mut();
    if let Some(PathEl::LineTo(p) | PathEl::QuadTo(_, p) | PathEl::CurveTo(_, _, p)) = last {
        *p = at;
    }
}

/// A smooth vertical shift of a stroke near its end: whole at the cut and beyond, fading to nothing
/// `reach` inside; in y it blends between the shifts of the two edges, and fades a stroke's thickness
/// beyond them, so that dots and bowls stay where they are.
#[derive(Debug, Clone, Copy)]
pub(super) struct Warp {
    pub(super) side: Side,
    pub(super) cut: f64,
    pub(super) reach: f64,
    pub(super) edges: Edges,
    pub(super) shifts: Edges,
    /// What is added to the slopes of the two edges inside the cut, felt over a third of the reach.
    pub(super) shears: Edges,
}

impl Warp {
    /// Where the point goes.
    pub(super) fn apply(&self, p: Point) -> Point {
        let reach = self.reach.max(f64::MIN_POSITIVE);
        let inside = (self.side.inward(p.x) - self.cut) / reach;
        let along = 1.0 - smooth(inside);
        let (low, high) = self.edges;
        let thick = (high - low).max(f64::MIN_POSITIVE);
        let across = ((p.y - low) / thick).clamp(0.0, 1.0);
        let blend = |(low, high): Edges| low * (1.0 - across) + high * across;
        // x beyond the cut, with its sign; the tab outside has its slopes already
        let run = self
            .side
            .inward((self.side.inward(p.x) - self.cut).max(0.0));
        let near = 1.0 - smooth(3.0 * inside);
        let shift = along * blend(self.shifts) + near * run * blend(self.shears);
        let beyond = (low - p.y).max(p.y - high) / thick;
        Point::new(p.x, p.y + shift * (1.0 - smooth(beyond)))
    }

    /// A contour with all its points shifted.
    pub(super) fn contour(&self, path: &BezPath) -> BezPath {
        let map = |el: &PathEl| match *el {
            PathEl::MoveTo(p) => PathEl::MoveTo(self.apply(p)),
            PathEl::LineTo(p) => PathEl::LineTo(self.apply(p)),
            PathEl::QuadTo(a, p) => PathEl::QuadTo(self.apply(a), self.apply(p)),
            PathEl::CurveTo(a, b, p) => {
                PathEl::CurveTo(self.apply(a), self.apply(b), self.apply(p))
            }
            PathEl::ClosePath => PathEl::ClosePath,
        };
        path.elements().iter().map(map).collect()
    }
}

/// 0 below 0, 1 above 1, and between them a cubic that is level at both.
fn smooth(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A bowl with a stroke that leaves to the left at the baseline.
    fn letter() -> BezPath {
        BezPath::from_svg("M0 5C0 2 2 0 5 0L300 0L300 400L200 400L200 60L5 60C2 60 0 58 0 55Z")
            .unwrap()
    }

    #[test]
    fn the_stroke_is_found_on_both_sides() {
        let mirrored = BezPath::from_svg(
            "M0 5C0 2 -2 0 -5 0L-300 0L-300 400L-200 400L-200 60L-5 60C-2 60 0 58 0 55Z",
        )
        .unwrap();
        for (path, side) in [(letter(), Side::Left), (mirrored, Side::Right)] {
            let found = ends(&[path], side, 10.0);
            assert_eq!(found.len(), 1, "{side:?} {found:?}");
            let (low, high) = found[0].edges;
            assert!(
                low.abs() < 1e-9 && (high - 60.0).abs() < 1e-9,
                "{side:?} {low} {high}"
            );
            assert!(found[0].tip.abs() < 1e-9, "{side:?}");
        }
    }

    #[test]
    fn an_end_is_measured_where_its_roundness_is_over() {
        // a pen's tip, 26 out of the full thickness, on a straight and on a widening stroke
        let straight = "M0 0L-10 0L-21 51L-26 77L-16 86L-10 91L0 90L200 90L200 0Z";
        let widening = "M0 0L-10 0L-21 51L-26 77L-16 86L-10 91L0 90L200 130L200 0Z";
        for (svg, least, most) in [(straight, 16.0, 30.0), (widening, 12.0, 30.0)] {
            let end = &ends(&[BezPath::from_svg(svg).unwrap()], Side::Left, 12.0)[0];
            let depth = end.cut - end.tip;
            assert!((least..most).contains(&depth), "{svg}: {depth}");
        }
    }

    #[test]
    fn an_end_cut_at_a_slant_is_measured_behind_it_and_a_tooth_at_once() {
        for (svg, least, edges) in [
            ("M0 0L36 75L200 75L200 0Z", 36.0, (0.0, 75.0)),
            ("M0 0L69 95L200 95L200 0Z", 69.0, (0.0, 95.0)),
            ("M0 0L80 160L200 160L200 -160L80 -160Z", 12.0, (-24.0, 24.0)),
        ] {
            let end = &ends(&[BezPath::from_svg(svg).unwrap()], Side::Left, 12.0)[0];
            let depth = end.cut - end.tip;
            assert!((least..least + 3.1).contains(&depth), "{svg}: {depth}");
            let (low, high) = end.edges;
            assert!(
                (low - edges.0).abs() < 1e-3 && (high - edges.1).abs() < 1e-3,
                "{end:?}"
            );
        }
    }

    #[test]
    fn a_bow_opens_where_it_is_measured() {
        let bow = "M0 120C0 54 54 0 120 0L400 0L400 240L120 240C54 240 0 186 0 120Z";
        let end = &ends(&[BezPath::from_svg(bow).unwrap()], Side::Left, 12.0)[0];
        assert!(end.slopes.1 - end.slopes.0 > OPENING, "{end:?}");
    }

    #[test]
    fn a_square_end_has_straight_edges() {
        let path = letter();
        let end = &ends(std::slice::from_ref(&path), Side::Left, 10.0)[0];
        let cut = square(
            &path,
            end,
            Side::Left,
            Tab {
                length: 25.0,
                slopes: (0.0, 0.0),
            },
        )
        .unwrap();
        let bounds = cut.bounding_box();
        assert!((bounds.x0 - (10.0 - 25.0)).abs() < 1e-9, "{bounds:?}");
        let wanted = 60.0 * 225.0 + 100.0 * 400.0 - 60.0 * 10.0 + 60.0 * 0.0;
        assert!(
            (cut.area() - wanted).abs() < 60.0 * 11.0,
            "{} {wanted}",
            cut.area()
        );
        assert!(cut.winding(Point::new(-14.0, 1.0)) != 0, "the lower corner");
        assert!(
            cut.winding(Point::new(-14.0, 59.0)) != 0,
            "the upper corner"
        );
    }

    #[test]
    fn a_warp_moves_the_end_and_nothing_else() {
        let warp = Warp {
            side: Side::Left,
            cut: 0.0,
            reach: 100.0,
            edges: (0.0, 60.0),
            shifts: (10.0, -4.0),
            shears: (0.0, 0.0),
        };
        let moved = |x, y| warp.apply(Point::new(x, y)).y - y;
        assert!((moved(0.0, 0.0) - 10.0).abs() < 1e-12);
        assert!((moved(-20.0, 60.0) + 4.0).abs() < 1e-12);
        assert!(moved(100.0, 0.0).abs() < 1e-12);
        assert!(moved(0.0, 200.0).abs() < 1e-12);
    }

    #[test]
    fn a_warp_without_reach_moves_what_lies_beyond_the_cut_alone() {
        let warp = Warp {
            side: Side::Left,
            cut: 0.0,
            reach: 0.0,
            edges: (0.0, 60.0),
            shifts: (10.0, 10.0),
            shears: (0.1, 0.1),
        };
        for (x, wanted) in [(-5.0, 10.0), (0.0, 10.0), (1.0, 0.0)] {
            let moved = warp.apply(Point::new(x, 0.0));
            assert!((moved.y - wanted).abs() < 1e-12, "{x}: {moved}");
        }
    }
}
