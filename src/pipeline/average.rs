//! Several drawings of one glyph → the one in the middle of them.
//!
//! Their scanned edges are brought to one size and laid centre of gravity upon centre of gravity, to the fraction of
//! a pixel. Of each pixel's distances to them, positive inside, the median says how far it lies from the middle
//! shape: of two drawings the edge runs halfway, of three it follows the two that agree.

use super::letter::Letter;
use super::problem::Problem;
use crate::numeric::cast::{index, single};
use crate::numeric::coverage::Coverage;
use crate::numeric::median::median;
use crate::types::{Cell, Gray, Guides};
use kurbo::{Affine, Line, ParamCurveNearest, Point, Vec2};

/// Paper around the drawing, px.
const MARGIN: f64 = 12.0;
/// Distances beyond this share of the em count as this: drawings differ by less.
const REACH_EM: f64 = 0.06;
/// Drawings laid upon each other may be so many times as wide or high as the largest of their own pictures: one that
/// is larger has another scale than its page.
const LARGEST: f64 = 4.0;
/// Half the width of the edge's ramp from paper to ink, px.
const SOFT: f64 = 1.0;

/// A drawing's rings about its centre of gravity, px of the common size, y up; and its baseline there.
struct Laid {
    rings: Vec<Vec<Point>>,
    baseline: f64,
}

/// A cell with the middle drawing, in the place of the first; `None` where one of them holds no ink.
///
/// # Errors
/// They differ in size so much that it would be far larger than any of them.
pub(super) fn middle(drawings: &[&Letter]) -> Result<Option<Cell>, Problem> {
    let Some(first) = drawings.first() else {
        return Ok(None);
    };
    let px_per_em = first.guides.px_per_em;
    let laid: Option<Vec<Laid>> = drawings.iter().map(|d| lay(d, px_per_em)).collect();
    let Some(laid) = laid else { return Ok(None) };
    let points = || laid.iter().flat_map(|l| &l.rings).flatten();
    let low = points().fold(Vec2::new(f64::MAX, f64::MAX), |m, p| {
        Vec2::new(m.x.min(p.x), m.y.min(p.y))
    });
    let high = points().fold(Vec2::new(f64::MIN, f64::MIN), |m, p| {
        Vec2::new(m.x.max(p.x), m.y.max(p.y))
    });
    let largest = |side: fn(&Letter) -> usize| drawings.iter().map(|d| side(d)).max();
    let beyond =
        |extent: f64, largest: Option<usize>| largest.is_none_or(|px| extent > LARGEST * px as f64);
    let extent = high - low;
    if beyond(extent.x, largest(|d| d.picture.width))
        || beyond(extent.y, largest(|d| d.picture.height))
    {
        let scale = |d: &&&Letter| d.guides.px_per_em;
        let coarsest = drawings.iter().min_by(|a, b| scale(a).total_cmp(&scale(b)));
        return Err(Problem::Sizes {
            first: Box::new(first.spot()),
            second: coarsest.unwrap_or(first).spot(),
        });
    }
    let corner = low - Vec2::new(MARGIN, MARGIN);
    let (width, height) = (
        index((extent.x + 2.0 * MARGIN).ceil()),
        index((extent.y + 2.0 * MARGIN).ceil()),
    );
    let reach = REACH_EM * px_per_em;
    let fields: Vec<Vec<f64>> = laid
        .iter()
        .map(|l| {
            let rings = l
                .rings
                .iter()
                .map(|r| r.iter().map(|p| *p - corner).collect());
            distances(&rings.collect::<Vec<_>>(), (width, height), reach)
        })
        .collect();
    let gray = Gray::from_fn(width, height, |x, y| {
        let here = median(fields.iter().map(|f| f[y * width + x])).unwrap_or_default();
        single((0.5 + here / (2.0 * SOFT)).clamp(0.0, 1.0))
    });
    let up = median(laid.iter().map(|l| l.baseline)).unwrap_or_default() - corner.y;
    Ok(Some(Cell {
        gray,
        guides: Guides {
            baseline_px: height as f64 - up,
            px_per_em,
            row: None,
        },
        label: first.label.clone(),
        index: first.index,
        plates: Vec::new(),
        in_sheet: first.in_sheet,
        to_sheet: Affine::IDENTITY,
    }))
}

fn lay(letter: &Letter, px_per_em: f64) -> Option<Laid> {
    let size = px_per_em / letter.guides.px_per_em;
    let (mut area, mut moment) = (0.0, Vec2::ZERO);
    for ring in &letter.edge {
        let points = ring.points();
        let next = points.iter().cycle().skip(1);
        for (a, b) in points.iter().zip(next) {
            let cross = a.to_vec2().cross(b.to_vec2());
            area += cross / 2.0;
            moment += (a.to_vec2() + b.to_vec2()) * (cross / 6.0);
        }
    }
    let centre = moment / area;
    let baseline = letter.picture.height as f64 - letter.guides.baseline_px;
    let rings = letter.edge.iter().map(|ring| {
        let about = |p: &Point| ((p.to_vec2() - centre) * size).to_point();
        ring.points().iter().map(about).collect()
    });
    (area > 0.0 && centre.is_finite()).then(|| Laid {
        rings: rings.collect(),
        baseline: (baseline - centre.y) * size,
    })
}

/// Distance of each pixel's centre to the rings, positive inside, at most `reach` either way; rows from the top.
fn distances(rings: &[Vec<Point>], (width, height): (usize, usize), reach: f64) -> Vec<f64> {
    let mut inside = Coverage::new(width, height);
    rings.iter().for_each(|r| inside.add(r));
    let mut field = vec![reach; width * height];
    for ring in rings {
        let next = ring.iter().cycle().skip(1);
        for (&a, &b) in ring.iter().zip(next) {
            let edge = Line::new(a, b);
            let top = height as f64;
            let (x0, x1) = (a.x.min(b.x) - reach, a.x.max(b.x) + reach);
            let (y0, y1) = (top - a.y.max(b.y) - reach, top - a.y.min(b.y) + reach);
            for y in index(y0)..index(y1 + 1.0).min(height) {
                for x in index(x0)..index(x1 + 1.0).min(width) {
                    let p = Point::new(x as f64 + 0.5, top - y as f64 - 0.5);
                    let here = &mut field[y * width + x];
                    *here = here.min(edge.nearest(p, 1e-3).distance_sq.sqrt());
                }
            }
        }
    }
    let signed = field.iter().zip(inside.samples());
    signed
        .map(|(d, ink)| if ink >= 0.5 { *d } else { -d })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace;
    use crate::types::{Label, Png};
    use kurbo::Rect;

    #[expect(
        clippy::cast_possible_truncation,
        reason = "a picture of the test's own"
    )]
    /// A bar of this height and a soft edge, its foot on the baseline, at this many px an em.
    fn bar(width: f64, height: f64, shift: f64, px_per_em: f64) -> Letter {
        let (w, h) = (width * px_per_em, height * px_per_em);
        let gray = Gray::from_fn(200, 200, |x, y| {
            let ink = |at: f64, from: f64, to: f64| {
                (at - from + 0.5).clamp(0.0, 1.0) * (to - at + 0.5).clamp(0.0, 1.0)
            };
            let (x, y) = (x as f64 + 0.5, y as f64 + 0.5);
            (ink(x, 40.0 + shift, 40.0 + shift + w) * ink(y, 160.0 - h, 160.0)) as f32
        });
        Letter {
            plates: Vec::new(),
            sheet: "page".to_owned(),
            table: 0,
            label: Label("l".to_owned()),
            index: 0,
            in_sheet: Rect::ZERO,
            guides: Guides {
                baseline_px: 160.0,
                px_per_em,
                row: None,
            },
            picture: Png::of(&gray),
            edge: trace::trace(&gray, &trace::Options::default()),
            paths: Vec::new(),
            filled: false,
        }
    }

    /// Width and height of the middle of these, em, and where it stands above the baseline.
    fn measured(drawings: &[Letter]) -> [f64; 3] {
        let cell = middle(&drawings.iter().collect::<Vec<_>>());
        let cell = cell.unwrap().unwrap();
        let gray = &cell.gray;
        let (cx, cy) = (gray.width() / 2, gray.height() / 2);
        let sum =
            |n: usize, at: &dyn Fn(usize) -> f32| (0..n).map(|i| f64::from(at(i))).sum::<f64>();
        let (w, h) = (
            sum(gray.width(), &|x| gray.at(x, cy)),
            sum(gray.height(), &|y| gray.at(cx, y)),
        );
        let above = sum(index(cell.guides.baseline_px), &|y| gray.at(cx, y));
        let em = cell.guides.px_per_em;
        [w / em, h / em, (h - above) / em]
    }

    #[test]
    fn the_middle_of_drawings_of_any_size_and_place() {
        let two = [bar(0.2, 0.6, 0.0, 200.0), bar(0.3, 0.5, 7.3, 150.0)];
        let three = [
            bar(0.2, 0.6, 0.0, 200.0),
            bar(0.21, 0.6, 3.4, 180.0),
            bar(0.5, 0.6, 1.0, 200.0),
        ];
        for (drawings, want) in [(&two[..], [0.25, 0.55]), (&three[..], [0.21, 0.6])] {
            let [w, h, below] = measured(drawings);
            assert!(
                (w - want[0]).abs() < 0.006 && (h - want[1]).abs() < 0.006,
                "{w} × {h} for {want:?}"
            );
            assert!(below.abs() < 0.03, "{below} below the baseline");
        }
        assert!(middle(&[]).unwrap().is_none());
    }
}
