//! Ink that the picture's edge cuts: carried on beyond it while it is traced, and cut off there again.
//!
//! What lies beyond a picture is not known. Taken for paper, a cut through ink looks like an edge that no lens has
//! blurred, and outlines then go beyond the picture for what the lens would have made of it.

use crate::{
    numeric::{
        cast::{index, single},
        clip::{Cut, Side, clipped},
        coverage,
    },
    types::{Contour, Gray},
};
use kurbo::{Affine, BezPath, Rect, Shape};
use std::ops::Range;

/// Least coverage that is ink.
const INK: f32 = 0.5;
/// The edge cuts ink whose outermost row holds such a part of what the row before it does; less, and it ends there
/// itself.
const CUT: f64 = 0.85;
/// Beside ink the lens' blur is carried on where there is more than this.
const FAINT: f32 = 0.02;
/// Ink goes on so far, px, and so many deviations of the lens' blur: what its end does there must not reach back.
const ON_PX: f64 = 8.0;
const ON_BLUR: f64 = 4.0;
/// Its sides go on as they came for about so long, px, and then straight away from the picture, so that no two meet.
const SLANT_PX: f64 = 6.0;
/// Pictures with a smaller side are taken as they are, px: more would be made up than is seen.
const LEAST_PX: usize = 16;
/// Beyond a side that cuts none ink that was carried on may not come further, px: edges there need so much.
const ROOM_PX: f64 = 1.0;
/// Rows that tell how they came, and the steepest way that counts, px a row.
const ROWS: usize = 4;
const STEEPEST: f64 = 1.5;

/// A picture's coverage with the ink that its edge cuts carried on.
#[derive(Debug)]
pub(super) struct Carried {
    /// px
    pub(super) coverage: Gray,
    /// from its px to those of the picture, which leaves out what lies left of it and below it now
    back: Affine,
    /// where outlines end, in its own px, y up
    sides: [Side; 4],
}

/// Whether the picture's edge cuts any of its ink, and the picture is large enough to tell how that goes on.
pub(super) fn cuts(coverage: &Gray) -> bool {
    if coverage.width().min(coverage.height()) < LEAST_PX {
        return false;
    }
    let (right, bottom) = (coverage.width() - 1, coverage.height() - 1);
    let rows = (0..=right).flat_map(|x| [(x, 0), (x, bottom)]);
    let mut rim = rows.chain((0..=bottom).flat_map(|y| [(0, y), (right, y)]));
    if !rim.any(|(x, y)| coverage.at(x, y) >= INK) {
        return false;
    }
    let mut grid = Grid::new(coverage);
    (0..4).any(|_| {
        let cuts = !grid.strokes().is_empty();
        grid = grid.turned();
        cuts
    })
}

/// The blur of a picture's edges, px, as its contours tell, but where they run along the picture's own edge, which no
/// lens has blurred; `None` without contours.
pub(super) fn blur_px(coverage: &Gray, contours: &[Contour]) -> Option<f64> {
    /// No edge is softer, px.
    const MOST: f64 = 4.0;
    let size = (coverage.width() as f64, coverage.height() as f64);
    let inner = Rect::from_origin_size((0.0, 0.0), size).inset(-1.0);
    let to_picture = coverage.to_pixels();
    let (mut all, mut inside) = (0.0, 0.0);
    for contour in contours {
        let points = contour.points();
        for (a, b) in points.iter().zip(points.iter().cycle().skip(1)) {
            all += a.distance(*b);
            if inner.contains(to_picture * a.midpoint(*b)) {
                inside += a.distance(*b);
            }
        }
    }
    let blur = contours.first()?.blur_px();
    // of a picture that no lens has blurred nothing is to be made good
    let told = if inside > 0.0 && blur > Contour::PIXEL_BLUR_PX {
        blur * all / inside
    } else {
        blur
    };
    Some(told.min(MOST))
}

/// The picture with its cut ink carried on; `None` where the edge cuts none. `blur_px` is the blur of its edges.
pub(super) fn carried(coverage: &Gray, blur_px: f64) -> Option<Carried> {
    let (width, height) = (coverage.width(), coverage.height());
    let mut grid = Grid::new(coverage);
    let mut added = [0; 4];
    for added in &mut added {
        *added = grid.carry_on(blur_px);
        grid = grid.turned();
    }
    if added == [0; 4] {
        return None;
    }
    let [below, _, _, left] = added;
    let room = added.map(|added| if added > 0 { 0.0 } else { ROOM_PX });
    let (w, h) = (width as f64, height as f64);
    let sides = [
        Side::Bottom(-room[0]),
        Side::Right(w + room[1]),
        Side::Top(h + room[2]),
        Side::Left(-room[3]),
    ];
    let rows = grid.samples.len().checked_div(grid.width).unwrap_or(0);
    let carried = Gray::new(grid.width, rows, grid.samples).ok()?;
    let back = Affine::translate((-(left as f64), -(below as f64)));
    Some(Carried {
        coverage: carried
            .with_scatter(coverage.scatter_px())
            .with_upright(back.inverse() * coverage.upright() * back),
        back,
        sides,
    })
}

impl Carried {
    /// Its paths as the picture has them, ended at the sides that cut them; what is left of one is dust below
    /// `dust_px2`.
    pub(super) fn cut(&self, paths: &[BezPath], dust_px2: f64) -> Vec<BezPath> {
        let to_picture = self.back * self.coverage.to_pixels();
        let mut paths: Vec<BezPath> = paths.iter().map(|p| to_picture * p.clone()).collect();
        for side in &self.sides {
            let large = |(path, cut): (BezPath, Cut)| {
                let stays = cut == Cut::Whole || path.area().abs() >= dust_px2;
                stays.then_some(path)
            };
            paths = clipped(&paths, *side)
                .into_iter()
                .filter_map(large)
                .collect();
        }
        let upright = self.back * self.coverage.upright() * self.back.inverse();
        paths.into_iter().map(|p| upright * p).collect()
    }
}

/// Samples row by row from the top.
struct Grid {
    width: usize,
    samples: Vec<f32>,
}

impl Grid {
    fn new(coverage: &Gray) -> Self {
        Self {
            width: coverage.width(),
            samples: coverage.samples().to_vec(),
        }
    }

    /// So many rows above the lowest one.
    fn row(&self, from_below: usize) -> Option<&[f32]> {
        let end = self.samples.len().checked_sub(from_below * self.width)?;
        self.samples.get(end.checked_sub(self.width)?..end)
    }

    /// Turned clockwise by 90°: its right side becomes the lowest.
    fn turned(&self) -> Self {
        let rows = self.samples.len().checked_div(self.width).unwrap_or(0);
        let column = |x: usize| {
            (0..rows)
                .rev()
                .map(move |y| self.samples[y * self.width + x])
        };
        Self {
            width: rows,
            samples: (0..self.width).flat_map(column).collect(),
        }
    }

    /// Adds rows below in which the ink goes on that the lowest row cuts; how many.
    fn carry_on(&mut self, blur_px: f64) -> usize {
        let strokes = self.strokes();
        if strokes.is_empty() {
            return 0;
        }
        let on = ON_PX + ON_BLUR * blur_px;
        let rows = index((on + 3.0 * blur_px).ceil()) + 1;
        // the ink ends as the lens would have it
        let ended = ended(rows, on, blur_px);
        let last = self.row(0).unwrap_or(&[]).to_vec();
        for (k, ended) in ended.iter().enumerate() {
            let gone = SLANT_PX * (1.0 - libm::exp(-((k + 1) as f64) / SLANT_PX));
            let mut row = vec![0.0_f32; self.width];
            for stroke in &strokes {
                stroke.draw(&last, (gone, *ended), &mut row);
            }
            self.samples.extend(row);
        }
        rows
    }

    /// The ink that the lowest row cuts.
    fn strokes(&self) -> Vec<Stroke> {
        let Some(row) = self.row(0) else {
            return Vec::new();
        };
        let above = self.row(1).unwrap_or(row);
        let runs = runs(row);
        let cut = runs.into_iter().filter(|run| {
            let before: f64 = runs_beside(above, run).map(|r| ink(&above[r])).sum();
            ink(&row[run.clone()]) >= CUT * before
        });
        cut.map(|run| self.stroke(row, run)).collect()
    }

    fn stroke(&self, row: &[f32], run: Range<usize>) -> Stroke {
        let ends = ends(row, &run);
        let (mut now, mut last, mut rows) = (run.clone(), ends, 0);
        for k in 1..=ROWS {
            let Some(row) = self.row(k) else { break };
            let mut beside = runs_beside(row, &now);
            let (Some(only), None) = (beside.next(), beside.next()) else {
                break;
            };
            (last, rows) = (self::ends(row, &only), k);
            now = only;
        }
        let slope = |i: usize| {
            let [now, then] = [ends[i], last[i]];
            let slope = now.zip(then).map(|(a, b)| (a - b) / rows.max(1) as f64);
            slope.map_or(0.0, |s| s.clamp(-STEEPEST, STEEPEST))
        };
        let (wide, mut slopes) = (run.len() as f64, [slope(0), slope(1)]);
        // sides that would meet go on side by side
        if (slopes[0] - slopes[1]) * SLANT_PX > wide / 2.0 {
            slopes = [(slopes[0] + slopes[1]) / 2.0; 2];
        }
        let flank = |at: &mut dyn Iterator<Item = usize>, from: f32| {
            let mut before = from;
            let falls = |i: &usize| {
                let falls = row[*i] < before && row[*i] > FAINT;
                before = row[*i];
                falls
            };
            at.take_while(falls).count()
        };
        let first = flank(&mut (0..run.start).rev(), row[run.start]);
        let after = flank(&mut (run.end..row.len()), row[run.end - 1]);
        Stroke {
            sides: [run.start as f64, run.end as f64],
            held: run.start - first..run.end + after,
            slopes,
        }
    }
}

/// Ink where the edge cuts it.
struct Stroke {
    /// its first and last column, px
    sides: [f64; 2],
    /// the columns of it and its blur
    held: Range<usize>,
    /// the way its sides take, columns a row outwards
    slopes: [f64; 2],
}

impl Stroke {
    /// Adds it to a row outside of the picture, whose sides have `gone` so many times their slope; `ended` is what
    /// its end leaves of it.
    fn draw(&self, last: &[f32], (gone, ended): (f64, f32), row: &mut [f32]) {
        let [left, right] = [0, 1].map(|i| self.sides[i] + gone * self.slopes[i]);
        let wide = (right - left).max(1e-3);
        for (x, to) in row.iter_mut().enumerate() {
            let t = ((x as f64 + 0.5 - left) / wide).clamp(0.0, 1.0);
            let from = x as f64 - gone * (self.slopes[0] + t * (self.slopes[1] - self.slopes[0]));
            let ink = self.sample(last, from);
            *to = to.max(ended * ink);
        }
    }

    /// What the picture's last row holds of it at a place between columns; what a side of the picture cuts goes on.
    fn sample(&self, last: &[f32], at: f64) -> f32 {
        let at = at.clamp(-1.0, last.len() as f64);
        let (first, t) = (at.floor(), single(at - at.floor()));
        let column = |x: f64| {
            let x = x.clamp(0.0, last.len().saturating_sub(1) as f64);
            let x = index(x);
            if self.held.contains(&x) { last[x] } else { 0.0 }
        };
        column(first) * (1.0 - t) + column(first + 1.0) * t
    }
}

/// The stretches of ink in a row.
fn runs(row: &[f32]) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for (x, _) in row.iter().enumerate().filter(|(_, v)| **v >= INK) {
        match runs.last_mut() {
            Some(run) if run.end == x => run.end = x + 1,
            _ => runs.push(x..x + 1),
        }
    }
    runs
}

/// The stretches of ink in a row that touch one of the next row.
fn runs_beside(row: &[f32], run: &Range<usize>) -> impl Iterator<Item = Range<usize>> + use<> {
    let (from, to) = (run.start, run.end);
    let beside = move |r: &Range<usize>| r.start <= to && from <= r.end;
    runs(row).into_iter().filter(beside)
}

fn ink(run: &[f32]) -> f64 {
    run.iter().map(|v| f64::from(*v)).sum()
}

/// Where a stretch of ink begins and ends, px; `None` at a side of the picture.
fn ends(row: &[f32], run: &Range<usize>) -> [Option<f64>; 2] {
    let between = |inside: usize, outside: usize| {
        let (a, b) = (f64::from(row[inside]), f64::from(row[outside]));
        let t = (a - f64::from(INK)) / (a - b).max(1e-9);
        inside as f64 + t * (outside as f64 - inside as f64)
    };
    let first = run
        .start
        .checked_sub(1)
        .map(|outside| between(run.start, outside));
    let last = (run.end < row.len()).then(|| between(run.end - 1, run.end));
    [first, last]
}

/// What a lens of `blur_px` leaves in each of so many rows of ink that ends after `on` px.
fn ended(rows: usize, on: f64, blur_px: f64) -> Vec<f32> {
    let weights = coverage::kernel(blur_px);
    let held = |k: f64| single((on - k).clamp(0.0, 1.0));
    let at = |k: usize| {
        let both = weights.iter().enumerate().map(|(far, weight)| {
            let (k, far) = (k as f64, far as f64);
            let two = held(k - far) + held(k + far);
            weight * if far > 0.0 { two } else { two / 2.0 }
        });
        both.sum()
    };
    (0..rows).map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::super::{Options, trace_picture};
    use super::*;
    use crate::numeric::angles;
    use crate::numeric::coverage::{Coverage, blur};
    use crate::scan::InkStreaks;
    use kurbo::{ParamCurve, ParamCurveNearest, Point};

    /// A polygon's fill under a lens, as a picture of 70 × 60 px sees it.
    fn seen(polygon: &[(f64, f64)], lens_px: f64) -> Gray {
        const AROUND: usize = 30;
        let (width, height) = (70 + 2 * AROUND, 60 + 2 * AROUND);
        let mut fill = Coverage::new(width, height);
        let aside = AROUND as f64;
        let points = polygon
            .iter()
            .map(|(x, y)| Point::new(x + aside, y + aside));
        fill.add(&points.collect::<Vec<_>>());
        let mut samples = fill.samples();
        blur(&mut samples, width, lens_px, 0);
        Gray::from_fn(70, 60, |x, y| samples[(y + AROUND) * width + x + AROUND])
    }

    /// How far the outlines of a picture lie from its rectangle and the polygon's sides, at most, px, near the
    /// picture's edge.
    fn off(gray: &Gray, polygon: &[(f64, f64)]) -> f64 {
        let picture = Rect::new(0.0, 0.0, gray.width() as f64, gray.height() as f64);
        let sides = polygon.iter().zip(polygon.iter().cycle().skip(1));
        let mut lines: Vec<kurbo::Line> = sides.map(|(a, b)| kurbo::Line::new(*a, *b)).collect();
        let corners = [
            (0.0, 0.0),
            (picture.x1, 0.0),
            (picture.x1, picture.y1),
            (0.0, picture.y1),
        ];
        let frame = corners.iter().zip(corners.iter().cycle().skip(1));
        lines.extend(frame.map(|(a, b)| kurbo::Line::new(*a, *b)));
        let paths = trace_picture(gray, InkStreaks::Fill, &Options::default())
            .expect("curves")
            .paths;
        assert_eq!(paths.len(), 1, "{paths:?}");
        let mut worst: f64 = 0.0;
        for segment in paths[0].segments() {
            for k in 0..=20 {
                let p = gray.to_pixels() * segment.eval(f64::from(k) / 20.0);
                let near = lines.iter().map(|l| l.nearest(p, 1e-6).distance_sq.sqrt());
                let beyond = (-p.x).max(p.x - picture.x1).max(-p.y).max(p.y - picture.y1);
                if beyond > -10.0 {
                    worst = worst.max(near.fold(f64::INFINITY, f64::min)).max(beyond);
                }
            }
        }
        worst
    }

    #[test]
    fn cut_ink_ends_at_the_edge() {
        let strokes: [&[(f64, f64)]; 4] = [
            &[(25.0, -20.0), (45.0, -20.0), (45.0, 35.0), (25.0, 35.0)],
            &[(20.0, 20.0), (90.0, 40.0), (90.0, 55.0), (20.0, 36.0)],
            &[(20.0, -20.0), (34.0, -20.0), (54.0, 80.0), (40.0, 80.0)],
            // the picture's corner too
            &[(-20.0, -20.0), (40.0, -20.0), (40.0, 30.0), (-20.0, 30.0)],
        ];
        for lens in [0.0, 1.0, 2.0, 3.0] {
            for stroke in strokes {
                let far = off(&seen(stroke, lens), stroke);
                assert!(
                    far < 0.1 + 0.1 * lens,
                    "{far} at a lens of {lens}: {stroke:?}"
                );
                // the same drawing, askew on its pixels
                for turn in [1.0_f64, -7.0] {
                    let turn = angles::rotation_about(turn.to_radians(), (35.0, 30.0));
                    let far = off(&seen(stroke, lens).with_upright(turn), stroke);
                    assert!(
                        far < 0.2 + 0.2 * lens,
                        "{far} at a lens of {lens}, turned: {stroke:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn ink_that_is_carried_on_is_ink_until_it_ends() {
        for blur in [0.3, 1.0, 3.0] {
            let ended = ended(40, 20.0, blur);
            assert!(ended[..9].iter().all(|v| *v > 0.99), "{blur}: {ended:?}");
            assert!(ended[18] > 0.5 && ended[21] < 0.5, "{blur}: {ended:?}");
            assert!(ended[32..].iter().all(|v| *v < 0.01), "{blur}: {ended:?}");
        }
    }

    #[test]
    fn ink_that_ends_at_the_edge_is_not_carried_on() {
        let disk = |x: f64, y: f64| {
            Gray::from_fn(60, 60, |i, j| {
                let off = (i as f64 + 0.5 - x).hypot(j as f64 + 0.5 - y) - 25.0;
                single((0.5 - off).clamp(0.0, 1.0))
            })
        };
        assert!(!cuts(&disk(30.0, 30.0)));
        for touch in [24.6, 25.0, 25.4] {
            assert!(
                !cuts(&disk(touch, 30.0)) && !cuts(&disk(30.0, 60.0 - touch)),
                "{touch}"
            );
        }
        assert!(cuts(&disk(15.0, 30.0)) && cuts(&disk(30.0, 45.0)));
        assert!(!cuts(&Gray::from_fn(0, 0, |_, _| 0.0)));
        assert!(!cuts(&Gray::from_fn(9, 0, |_, _| 0.0)));
    }

    #[test]
    fn ink_that_is_carried_on_stays_within_the_other_sides() {
        let stem = |x: usize, y: usize| (10..20).contains(&x) && y > 15;
        let gray = Gray::from_fn(30, 40, |x, y| f32::from(u8::from(stem(x, y))));
        let carried = carried(&gray, 0.3).expect("cut ink");
        // noise that is carried on may be drawn anywhere
        let astray = Rect::new(-100.0, -100.0, 200.0, 200.0).to_path(0.1);
        let paths = carried.cut(&[astray], 4.0);
        let bounds: Vec<Rect> = paths.iter().map(Shape::bounding_box).collect();
        assert_eq!(bounds, [Rect::new(-1.0, 0.0, 31.0, 41.0)]);
        // and what is left of little is dust
        let little = Rect::new(10.0, 0.0, 13.0, 1.0 - carried.back.translation().y).to_path(0.1);
        assert!(carried.cut(&[little], 4.0).is_empty());
    }

    #[test]
    fn pictures_of_ink_alone_are_rectangles() {
        for (w, h) in [(16, 16), (40, 20), (20, 70)] {
            let all = Gray::from_fn(w, h, |_, _| 1.0);
            let paths = trace_picture(&all, InkStreaks::Fill, &Options::default())
                .expect("curves")
                .paths;
            let area: f64 = paths.iter().map(Shape::area).sum();
            assert!(
                (area - (w * h) as f64).abs() < 0.05 * area,
                "{w} × {h}: {paths:?}"
            );
        }
    }
}
