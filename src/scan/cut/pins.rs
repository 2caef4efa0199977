//! Letters whose place on the page a user says.

use super::{Layer, Reason};
use crate::numeric::surface::Surface;
use crate::numeric::view::View;
use crate::scan::components::{Component, Run};
use kurbo::{BezPath, PathEl, Point, Rect, Shape, Vec2};

/// Share of a piece of ink that a box must hold to take it.
const MOST: f64 = 0.5;

/// Where the ink of a cell lies, px of the sheet's picture.
#[derive(Debug, Clone, PartialEq)]
pub enum Region {
    /// All pieces of ink that lie in it for the larger part, whole.
    Box(Rect),
    /// All ink inside it, cut at its edge.
    Polygon(Vec<Point>),
    /// All ink inside four corners, cut at the edges, which upright were a rectangle: top left, top right, bottom
    /// right, bottom left.
    Quad([Point; 4]),
}

/// What a user says about one cell.
#[derive(Debug, Clone, PartialEq)]
pub struct Pin {
    /// The cell, in reading order.
    pub index: usize,
    /// Where its ink lies; left out, where the layout finds it.
    pub region: Option<Region>,
    /// Turns the letter clockwise about the middle of its baseline, degrees.
    pub rotation_deg: f64,
}

/// The pieces of ink that regions take, by the cell's index. Pieces that a polygon's edge cuts become two.
pub(super) fn claim(all: &mut Vec<Component>, pins: &[Pin]) -> Vec<(usize, Vec<usize>)> {
    let areas = pins
        .iter()
        .filter_map(|p| Some((p.index, p.region.as_ref()?.area())));
    let areas: Vec<(usize, Area)> = areas.collect();
    areas.iter().for_each(|(_, area)| area.split(all));
    let mut claims: Vec<(usize, Vec<usize>)> = areas.iter().map(|a| (a.0, vec![])).collect();
    for (i, c) in all.iter().enumerate() {
        let shares = areas.iter().map(|(_, area)| area.share(c)).enumerate();
        let best = shares.max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((k, _)) = best.filter(|b| b.1 > MOST) {
            claims[k].1.push(i);
        }
    }
    claims
}

impl Region {
    fn area(&self) -> Area {
        let points = match self {
            Self::Box(r) => return Area::Box(*r),
            Self::Polygon(points) => points.as_slice(),
            Self::Quad(points) => points,
        };
        let start = points.first().map(|&p| PathEl::MoveTo(p));
        let lines = points.iter().skip(1).map(|&p| PathEl::LineTo(p));
        let end = start.map(|_| PathEl::ClosePath);
        let path: BezPath = start.into_iter().chain(lines).chain(end).collect();
        Area::Polygon {
            around: path.bounding_box(),
            path,
        }
    }
}

/// A region as ink is measured by it.
enum Area {
    /// It takes ink whole.
    Box(Rect),
    /// Its edge cuts ink; ink that is not `around` it is outside.
    Polygon { path: BezPath, around: Rect },
}

impl Area {
    /// Share of a piece of ink inside it.
    fn share(&self, c: &Component) -> f64 {
        let inside = match self {
            Self::Box(r) => {
                let middle =
                    |run: &Run| (run.y as f64 + 0.5 >= r.y0) && (run.y as f64 + 0.5 < r.y1);
                let across = |run: &Run| {
                    let (a, b) = ((run.start as f64).max(r.x0), (run.end as f64).min(r.x1));
                    (b - a).max(0.0)
                };
                c.runs.iter().filter(|r| middle(r)).map(across).sum::<f64>()
            }
            Self::Polygon { around, .. } if !c.bounds.overlaps(*around) => 0.0,
            Self::Polygon { path, .. } => {
                c.pixels().filter(|&(x, y)| holds(path, x, y)).count() as f64
            }
        };
        inside / c.area.max(1) as f64
    }

    /// Cuts the pieces of ink that lie across its edge.
    fn split(&self, all: &mut Vec<Component>) {
        let Self::Polygon { path, around } = self else {
            return;
        };
        let mut out = Vec::with_capacity(all.len());
        for c in all.drain(..) {
            if c.bounds.overlaps(*around) {
                out.extend(c.parted(|x, y| holds(path, x, y)));
            } else {
                out.push(c);
            }
        }
        *all = out;
    }
}

fn holds(path: &BezPath, x: usize, y: usize) -> bool {
    path.contains(Point::new(x as f64 + 0.5, y as f64 + 0.5))
}

/// Gives claimed ink to its cells, whatever the layout thought of it.
pub(super) fn settle(layer: &mut Layer, claims: &[(usize, Vec<usize>)]) {
    let claimed = |i: &usize| claims.iter().any(|(_, parts)| parts.contains(i));
    for slot in &mut layer.slots {
        let own = claims.iter().find(|(index, _)| *index == slot.index);
        slot.parts.retain(|i| !claimed(i));
        if let Some((_, parts)) = own {
            let left = slot.parts.drain(..).map(|i| (i, Reason::Overridden));
            layer.rejected.extend(left);
            slot.parts.clone_from(parts);
        }
    }
    layer.rejected.retain(|(i, _)| !claimed(i));
}

/// How a cell is seen upright, and how far its letter is turned then, degrees clockwise; `upright` is the page's own
/// view.
pub(super) fn stance(index: usize, pins: &[Pin], upright: &Surface) -> (Surface, f64) {
    let pin = pins.iter().find(|p| p.index == index);
    let quad = pin.and_then(|p| match &p.region {
        Some(Region::Quad(corners)) => straight(*corners, upright),
        _ => None,
    });
    (
        quad.map_or_else(|| upright.clone(), Surface::from),
        pin.map_or(0.0, |p| p.rotation_deg),
    )
}

/// Measures claimed pieces as their cells are seen.
pub(super) fn stand(
    all: &mut [Component],
    claims: &[(usize, Vec<usize>)],
    pins: &[Pin],
    upright: &Surface,
) {
    for (index, parts) in claims {
        let (view, _) = stance(*index, pins, upright);
        parts.iter().for_each(|&i| all[i].stand(&view));
    }
}

/// The view that makes four corners a rectangle: its middle and the mean lengths of its sides stay what they are on
/// the upright page.
fn straight(corners: [Point; 4], upright: &Surface) -> Option<View> {
    let seen = corners.map(|p| upright.at(p));
    let middle = seen.iter().fold(Vec2::ZERO, |s, p| s + p.to_vec2()) / 4.0;
    let side = |a: usize, b: usize| seen[a].distance(seen[b]);
    let size = (
        f64::midpoint(side(0, 1), side(3, 2)),
        f64::midpoint(side(0, 3), side(1, 2)),
    );
    let r = Rect::from_center_size(middle.to_point(), size);
    let upright = [(r.x0, r.y0), (r.x1, r.y0), (r.x1, r.y1), (r.x0, r.y1)];
    View::through(corners, upright.map(Point::from))
}
