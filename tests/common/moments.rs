//! Area, centre of gravity and radius of gyration of what a path fills, by its polygon.

use khatt::trace;
use khatt::types::Cell;
use kurbo::{Affine, BezPath, PathEl, Point, Vec2};

#[derive(Debug, Clone, Copy)]
pub(crate) struct Moments {
    pub(crate) area: f64,
    pub(crate) centre: Vec2,
    pub(crate) radius: f64,
}

impl Moments {
    pub(crate) fn of(path: &BezPath) -> Self {
        let (mut area, mut first, mut second) = (0.0, Vec2::ZERO, 0.0);
        let (mut start, mut last) = (Vec2::ZERO, Vec2::ZERO);
        kurbo::flatten(path.iter(), 1e-5, |el| {
            let p = match el {
                PathEl::MoveTo(p) => {
                    (start, last) = (p.to_vec2(), p.to_vec2());
                    start
                }
                el => el.end_point().map_or(start, Point::to_vec2),
            };
            let twice = last.cross(p);
            area += twice / 2.0;
            first += (last + p) * twice / 6.0;
            second += twice * (last.hypot2() + last.dot(p) + p.hypot2()) / 12.0;
            last = p;
        });
        let centre = first / area;
        let radius = (second / area - centre.hypot2()).max(0.0).sqrt();
        Self {
            area: area.abs(),
            centre,
            radius,
        }
    }

    /// Of a cell's contours, in em from the baseline, y up.
    pub(crate) fn of_cell(cell: &Cell) -> Self {
        let em = cell.guides.px_per_em;
        let below = cell.gray.height() as f64 - cell.guides.baseline_px;
        let to_em = Affine::scale(1.0 / em) * Affine::translate((0.0, -below));
        let mut drawn = BezPath::new();
        for contour in trace::trace(&cell.gray, &trace::Options::default()) {
            for (i, &p) in contour.points().iter().enumerate() {
                let p = to_em * p;
                if i == 0 {
                    drawn.move_to(p)
                } else {
                    drawn.line_to(p)
                }
            }
            drawn.close_path();
        }
        Self::of(&drawn)
    }
}
