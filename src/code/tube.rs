//! Where the curve may lie: the tolerance band around the boundary, `T_i` wide on each side.

use super::moat::Moat;
use super::places::{extent, place, to_edge};
use kurbo::{Point, Rect};

/// Nearest boundary points are known up to this, px.
const FAR: f64 = 4.0;

/// Cells in a px.
const FINE: f64 = 2.0;

/// From the middle of a cell to its corners, px.
const HALF: f64 = std::f64::consts::FRAC_1_SQRT_2 / FINE;

/// The tube in cells of half a px around whole and half points.
#[derive(Debug)]
pub(super) struct Tube {
    corner: (i32, i32),
    width: usize,
    /// Whether each cell's middle may lie inside.
    inside: Vec<bool>,
    /// The boundary point nearest to each cell's middle, the first of several; none known beyond [`FAR`].
    nearest: Vec<Option<u32>>,
    moat: Moat,
    /// Edges of the boundary whose part of the tube reaches into the cell, those nearest first, and how many of the
    /// parts hold all of it.
    edges: Vec<(usize, Vec<usize>)>,
    /// Half widths of the edges' parts, squared.
    squares: Vec<f64>,
}

impl Tube {
    /// Of a boundary, its first point again at the end, and `T_i` for each of its points.
    pub(super) fn new(boundary: &[Point], t: &[f64]) -> Self {
        let halves: Vec<f64> = t.windows(2).map(|w| w[0].max(w[1])).collect();
        let margin = halves.iter().copied().fold(0.0, f64::max) + FAR + 1.0;
        let all = extent(boundary);
        let corner = cell_of(Point::new(all.x0 - margin, all.y0 - margin));
        let end = cell_of(Point::new(all.x1 + margin, all.y1 + margin));
        let cells = |from: i32, to: i32| usize::try_from(to - from + 1).unwrap_or_default();
        let (width, height) = (cells(corner.0, end.0), cells(corner.1, end.1));
        let mut inside = vec![false; width * height];
        let mut nearest: Vec<(f64, Option<u32>)> = vec![(FAR * FAR, None); width * height];
        let mut ranked: Vec<Vec<(f64, usize)>> = vec![Vec::new(); width * height];
        for (j, (edge, half)) in boundary.windows(2).zip(&halves).enumerate() {
            let reach = half + FAR;
            let around = Rect::from_points(edge[0], edge[1]).inflate(reach, reach);
            let (least, most) = [around.origin(), Point::new(around.x1, around.y1)]
                .map(cell_of)
                .into();
            for y in least.1..=most.1 {
                for x in least.0..=most.0 {
                    let Some(cell) = place(corner, width, (x, y)).filter(|&i| i < inside.len())
                    else {
                        continue;
                    };
                    let at = middle((x, y));
                    let off = to_edge(at, edge).sqrt() - half;
                    // the square of what is held is a little wider
                    inside[cell] |= off <= 1e-4;
                    if off <= HALF + 1e-9 {
                        ranked[cell].push((off, j));
                    }
                    let square = at.distance_squared(edge[0]);
                    if square < nearest[cell].0 {
                        nearest[cell] = (square, u32::try_from(j).ok());
                    }
                }
            }
        }
        let edges = ranked.into_iter().map(|mut list| {
            list.sort_by(|a, b| a.0.total_cmp(&b.0));
            let whole = list.partition_point(|&(off, _)| off <= -HALF);
            (whole, list.into_iter().map(|(_, j)| j).collect())
        });
        Self {
            corner,
            width,
            inside,
            nearest: nearest.into_iter().map(|(_, j)| j).collect(),
            moat: Moat::new(boundary, &halves),
            edges: edges.collect(),
            squares: halves.iter().map(|h| h * h + 1e-9).collect(),
        }
    }

    /// Whether a point lies in the tube's part along the boundary from one point to another.
    pub(super) fn holds(
        &self,
        boundary: &[Point],
        p: Point,
        (first, last): (usize, usize),
    ) -> bool {
        let edges = self.cell(p).and_then(|cell| self.edges.get(cell));
        edges.is_some_and(|(whole, edges)| {
            let within = |&(k, &j): &(usize, &usize)| {
                k < *whole || to_edge(p, &boundary[j..j + 2]) <= self.squares[j]
            };
            let between = |&(_, &j): &(usize, &usize)| first <= j + 1 && j <= last;
            edges.iter().enumerate().filter(between).any(|e| within(&e))
        })
    }

    /// Whether all points of a disc surely lie outside.
    #[inline]
    pub(super) fn misses(&self, p: Point, radius: f64) -> bool {
        self.moat.misses(p, radius)
    }

    /// Whether a whole or half point, by its coordinates doubled, surely lies outside.
    pub(super) fn shuts(&self, doubled: (i32, i32)) -> bool {
        let cell = place(self.corner, self.width, doubled);
        cell.is_none_or(|i| self.inside.get(i) != Some(&true))
    }

    /// The first of the boundary points nearest to a whole or half point, where it is known.
    pub(super) fn nearest(&self, p: Point) -> Option<usize> {
        let j = *self.nearest.get(self.cell(p)?)?;
        usize::try_from(j?).ok()
    }

    fn cell(&self, p: Point) -> Option<usize> {
        place(self.corner, self.width, cell_of(p))
    }
}

/// The cell around a point.
#[expect(
    clippy::cast_possible_truncation,
    reason = "pictures are smaller than 2^20 px; `as` saturates"
)]
fn cell_of(p: Point) -> (i32, i32) {
    // added before truncation: quicker than rounding
    const ABOVE: i32 = 1 << 21;
    let whole = |v: f64| (v * FINE + (f64::from(ABOVE) + 0.5)) as i32 - ABOVE;
    (whole(p.x), whole(p.y))
}

fn middle((x, y): (i32, i32)) -> Point {
    Point::new(f64::from(x) / FINE, f64::from(y) / FINE)
}
