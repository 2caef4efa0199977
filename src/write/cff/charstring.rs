//! Type 2 charstrings, as short as their operators allow.
//!
//! Takes an outline on a grid and gives for each contour the cheapest sequence of operators, by a
//! shortest path over its segments: from every segment, every operator is tried on every run of
//! segments it can draw within the stack's 48 operands. So the result is the shortest that the
//! operators can say without subroutines and hints.

use kurbo::{BezPath, PathEl, Point};

/// Operands that the interpreter's stack holds.
const STACK: usize = 48;

// Operators.
const VMOVETO: u8 = 4;
const RLINETO: u8 = 5;
const HLINETO: u8 = 6;
const VLINETO: u8 = 7;
const RRCURVETO: u8 = 8;
const ENDCHAR: u8 = 14;
const RMOVETO: u8 = 21;
const HMOVETO: u8 = 22;
const RCURVELINE: u8 = 24;
const RLINECURVE: u8 = 25;
const VVCURVETO: u8 = 26;
const HHCURVETO: u8 = 27;
const VHCURVETO: u8 = 30;
const HVCURVETO: u8 = 31;

/// Coordinates in 65536ths of a unit: what a charstring's numbers can say.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Grid {
    x: i64,
    y: i64,
}

const ONE: i64 = 1 << 16;

impl Grid {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "coordinates are checked to lie within ±32767"
    )]
    const fn of(p: Point) -> Self {
        Self {
            x: (p.x * 65536.0).round() as i64,
            y: (p.y * 65536.0).round() as i64,
        }
    }

    const fn from(self, other: Self) -> Delta {
        Delta {
            x: self.x - other.x,
            y: self.y - other.y,
        }
    }
}

/// A step on the grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Delta {
    x: i64,
    y: i64,
}

/// A piece of contour as steps from point to point.
#[derive(Debug, Clone, Copy)]
enum Segment {
    Line(Delta),
    Curve([Delta; 3]),
}

/// The charstring of a glyph: `width` is its advance less the nominal one, unless it is the default.
pub(super) fn encode(shape: &BezPath, width: Option<i32>) -> Vec<u8> {
    let mut out = Vec::new();
    if let Some(w) = width {
        number(&mut out, i64::from(w) * ONE);
    }
    let mut at = Grid { x: 0, y: 0 };
    for (start, segments, end) in contours(shape) {
        move_to(&mut out, start.from(at));
        draw(&mut out, &segments);
        at = end;
    }
    out.push(ENDCHAR);
    out
}

/// Start, segments and last point of every contour. A line back to the start is left to the closing.
fn contours(shape: &BezPath) -> Vec<(Grid, Vec<Segment>, Grid)> {
    let mut out: Vec<(Grid, Vec<Segment>, Grid)> = Vec::new();
    for el in shape.elements() {
        if let PathEl::MoveTo(p) = *el {
            out.push((Grid::of(p), Vec::new(), Grid::of(p)));
            continue;
        }
        let Some((start, segments, at)) = out.last_mut() else {
            continue;
        };
        match *el {
            PathEl::LineTo(p) => line(segments, at, Grid::of(p)),
            PathEl::QuadTo(c, p) => {
                let from = Point::new(unit(at.x), unit(at.y));
                // a quadratic on the whole grid stays on it: half a unit is what its maker rounded by
                let is_whole = [from, c, p].iter().all(|p| *p == p.round());
                let lift = |end: Point| {
                    let lifted = end + (c - end) * (2.0 / 3.0);
                    if is_whole { lifted.round() } else { lifted }
                };
                curve(segments, at, [lift(from), lift(p), p]);
            }
            PathEl::CurveTo(a, b, p) => curve(segments, at, [a, b, p]),
            PathEl::MoveTo(_) | PathEl::ClosePath => {
                if let Some(Segment::Line(d)) = segments.last().copied()
                    && *at == *start
                    && segments.len() > 1
                {
                    segments.pop();
                    *at = Grid {
                        x: at.x - d.x,
                        y: at.y - d.y,
                    };
                }
            }
        }
    }
    out
}

fn unit(v: i64) -> f64 {
    v as f64 / 65536.0
}

fn line(segments: &mut Vec<Segment>, at: &mut Grid, to: Grid) {
    if to != *at {
        segments.push(Segment::Line(to.from(*at)));
        *at = to;
    }
}

fn curve(segments: &mut Vec<Segment>, at: &mut Grid, points: [Point; 3]) {
    let mut from = *at;
    let steps = points.map(|p| {
        let to = Grid::of(p);
        let step = to.from(from);
        from = to;
        step
    });
    *at = from;
    segments.push(Segment::Curve(steps));
}

fn move_to(out: &mut Vec<u8>, d: Delta) {
    match d {
        Delta { x, y: 0 } => operation(out, &[x], HMOVETO),
        Delta { x: 0, y } => operation(out, &[y], VMOVETO),
        Delta { x, y } => operation(out, &[x, y], RMOVETO),
    }
}

fn operation(out: &mut Vec<u8>, operands: &[i64], operator: u8) {
    for &v in operands {
        number(out, v);
    }
    out.push(operator);
}

/// A way to draw the first `count` of some segments.
struct Run {
    operator: u8,
    operands: Vec<i64>,
    count: usize,
}

impl Run {
    fn cost(&self) -> usize {
        1 + self.operands.iter().map(|&v| size(v)).sum::<usize>()
    }
}

/// Draws the segments by the cheapest sequence of runs.
fn draw(out: &mut Vec<u8>, segments: &[Segment]) {
    // best[i]: bytes from segment i to the end, and the first run of that way
    let mut best: Vec<(usize, Option<Run>)> = vec![(0, None)];
    for i in (0..segments.len()).rev() {
        let rest = segments.get(i..).unwrap_or_default();
        let after = |run: &Run| {
            best.get(best.len() - run.count)
                .map_or(usize::MAX / 2, |b| b.0)
        };
        let cheapest = runs(rest)
            .into_iter()
            .map(|run| (run.cost() + after(&run), run))
            .min_by_key(|(cost, run)| (*cost, usize::MAX - run.count));
        let (cost, run) = cheapest.map_or((0, None), |(c, r)| (c, Some(r)));
        best.push((cost, run));
    }
    let mut at = best.len() - 1;
    while let Some((_, Some(run))) = best.get(at) {
        operation(out, &run.operands, run.operator);
        at -= run.count;
    }
}

/// Every operator on every run of segments that it can draw, from the first.
fn runs(segments: &[Segment]) -> Vec<Run> {
    let mut out = Vec::new();
    match segments.first() {
        Some(Segment::Line(_)) => lines(segments, &mut out),
        Some(Segment::Curve(_)) => {
            curves(segments, &mut out);
            tangent_curves(segments, &mut out);
            alternating_curves(segments, &mut out);
        }
        None => {}
    }
    out
}

fn push(out: &mut Vec<Run>, operator: u8, operands: &[i64], count: usize) {
    out.push(Run {
        operator,
        operands: operands.to_vec(),
        count,
    });
}

/// `rlineto`, `rlinecurve`, `hlineto`, `vlineto`.
fn lines(segments: &[Segment], out: &mut Vec<Run>) {
    let mut free = Vec::new();
    for (n, segment) in (1..).zip(segments) {
        match segment {
            Segment::Line(d) if free.len() + 2 <= STACK => {
                free.extend([d.x, d.y]);
                push(out, RLINETO, &free, n);
            }
            Segment::Curve(c) if free.len() + 6 <= STACK => {
                free.extend(all(c));
                push(out, RLINECURVE, &free, n);
                break;
            }
            _ => break,
        }
    }
    for (operator, first_is_flat) in [(HLINETO, true), (VLINETO, false)] {
        let mut straight = Vec::new();
        let mut is_flat = first_is_flat;
        for (n, segment) in (1..=STACK).zip(segments) {
            let Segment::Line(d) = segment else { break };
            let (along, across) = if is_flat { (d.x, d.y) } else { (d.y, d.x) };
            if across != 0 {
                break;
            }
            straight.push(along);
            push(out, operator, &straight, n);
            is_flat = !is_flat;
        }
    }
}

const fn all(c: &[Delta; 3]) -> [i64; 6] {
    let [a, b, c] = c;
    [a.x, a.y, b.x, b.y, c.x, c.y]
}

/// `rrcurveto`, `rcurveline`.
fn curves(segments: &[Segment], out: &mut Vec<Run>) {
    let mut free = Vec::new();
    for (n, segment) in (1..).zip(segments) {
        match segment {
            Segment::Curve(c) if free.len() + 6 <= STACK => {
                free.extend(all(c));
                push(out, RRCURVETO, &free, n);
            }
            Segment::Line(d) if free.len() + 2 <= STACK => {
                free.extend([d.x, d.y]);
                push(out, RCURVELINE, &free, n);
                break;
            }
            _ => break,
        }
    }
}

/// `hhcurveto`, `vvcurveto`: both ends flat, or both upright; the first may begin otherwise.
fn tangent_curves(segments: &[Segment], out: &mut Vec<Run>) {
    for (operator, is_flat) in [(HHCURVETO, true), (VVCURVETO, false)] {
        let mut operands = Vec::new();
        for (n, segment) in (1..).zip(segments) {
            let Segment::Curve([a, b, c]) = segment else {
                break;
            };
            let turn = |d: &Delta| if is_flat { (d.x, d.y) } else { (d.y, d.x) };
            let ((a, a_across), (c, c_across)) = (turn(a), turn(c));
            if c_across != 0 || (a_across != 0 && n > 1) {
                break;
            }
            if a_across != 0 {
                operands.push(a_across);
            }
            if operands.len() + 4 > STACK {
                break;
            }
            operands.extend([a, b.x, b.y, c]);
            push(out, operator, &operands, n);
        }
    }
}

/// `hvcurveto`, `vhcurveto`: flat to upright and back in turn; the last may end otherwise.
fn alternating_curves(segments: &[Segment], out: &mut Vec<Run>) {
    for (operator, first_is_flat) in [(HVCURVETO, true), (VHCURVETO, false)] {
        let mut operands = Vec::new();
        let mut is_flat = first_is_flat;
        for (n, segment) in (1..).zip(segments) {
            let Segment::Curve([a, b, c]) = segment else {
                break;
            };
            let (a, a_across, c, c_across) = if is_flat {
                (a.x, a.y, c.y, c.x)
            } else {
                (a.y, a.x, c.x, c.y)
            };
            if a_across != 0 || operands.len() + 4 > STACK {
                break;
            }
            operands.extend([a, b.x, b.y, c]);
            if c_across != 0 {
                if operands.len() < STACK {
                    operands.push(c_across);
                    push(out, operator, &operands, n);
                }
                break;
            }
            push(out, operator, &operands, n);
            is_flat = !is_flat;
        }
    }
}

/// Bytes that a number takes.
const fn size(v: i64) -> usize {
    if v % ONE != 0 {
        return 5;
    }
    let n = (v / ONE).abs();
    if n <= 107 {
        1
    } else if n <= 1131 {
        2
    } else {
        3
    }
}

/// A number of a charstring, in 65536ths: an integer where it is one, else 16.16.
fn number(out: &mut Vec<u8>, v: i64) {
    let whole = i32::try_from(v / ONE).unwrap_or_default();
    if v % ONE == 0 && short_integer(out, whole) {
        return;
    }
    let fixed = i32::try_from(v);
    debug_assert!(
        fixed.is_ok(),
        "coordinates and widths are kept within 16 bits"
    );
    out.push(255);
    out.extend(fixed.unwrap_or_default().to_be_bytes());
}

/// Writes an integer that takes 1 to 3 bytes, in DICT and charstring alike; false where it takes more.
pub(super) fn short_integer(out: &mut Vec<u8>, v: i32) -> bool {
    let low = |n: i32| n.to_be_bytes()[3];
    match v {
        -107..=107 => out.push(low(v + 139)),
        108..=1131 => out.extend([low(((v - 108) >> 8) + 247), low(v - 108)]),
        -1131..=-108 => out.extend([low(((-v - 108) >> 8) + 251), low(-v - 108)]),
        -32768..=32767 => out.extend([28, v.to_be_bytes()[2], low(v)]),
        _ => return false,
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ops(svg: &str) -> Vec<u8> {
        encode(&BezPath::from_svg(svg).unwrap(), None)
    }

    #[test]
    fn a_square_is_one_line_operator() {
        // hmoveto 100; 50 50 -50 hlineto, closed by itself
        assert_eq!(
            ops("M100 0L150 0L150 50L100 50Z"),
            [239, 22, 189, 189, 89, 6, 14]
        );
        assert_eq!(
            ops("M100 0L150 0L150 50L100 50L100 0Z"),
            ops("M100 0L150 0L150 50L100 50Z")
        );
    }

    #[test]
    fn a_circle_is_one_curve_operator() {
        let circle =
            "M100 50C100 77 77 100 50 100C23 100 0 77 0 50C0 23 23 0 50 0C77 0 100 23 100 50Z";
        let bytes = ops(circle);
        assert_eq!(bytes.iter().filter(|&&b| b == VHCURVETO).count(), 1);
        assert_eq!(bytes.len(), 2 + 1 + 16 + 1 + 1);
    }

    #[test]
    fn fractions_do_not_drift() {
        let mut path = BezPath::new();
        path.move_to((0.0, 0.0));
        for i in 1..100 {
            path.line_to((f64::from(i) / 3.0, f64::from(i * i % 7) / 3.0));
        }
        path.close_path();
        let [(_, segments, end)] = &contours(&path)[..] else {
            panic!("one contour")
        };
        let sum = segments.iter().fold((0, 0), |(x, y), s| match s {
            Segment::Line(d) => (x + d.x, y + d.y),
            Segment::Curve(_) => (x, y),
        });
        assert_eq!(Grid { x: sum.0, y: sum.1 }, *end);
        assert_eq!(Grid::of(Point::new(33.0, 1.0 / 3.0)), *end);
    }

    #[test]
    fn the_stack_is_never_exceeded() {
        let mut path = BezPath::new();
        path.move_to((0.0, 0.0));
        for i in 0..90_i32 {
            let x = f64::from(i);
            path.curve_to((x, 9.0), (x + 0.3, 5.0), (x + 1.0, f64::from(i % 3)));
        }
        path.close_path();
        let [(_, segments, _)] = &contours(&path)[..] else {
            panic!("one contour")
        };
        for start in 0..segments.len() {
            for run in runs(&segments[start..]) {
                assert!(run.operands.len() <= STACK, "operator {}", run.operator);
            }
        }
    }
}
