//! What glyphs are drawn with: contours of a font's outline → paths.

use kurbo::{BezPath, Point};
use skrifa::outline::OutlinePen;

/// The contours that were drawn.
#[derive(Debug, Clone, Default)]
pub struct Pen {
    /// One path each, in the font's units, y up.
    pub paths: Vec<BezPath>,
}

impl Pen {
    /// All of them as one path.
    #[must_use]
    pub fn path(self) -> BezPath {
        self.paths.into_iter().flatten().collect()
    }

    /// The contour being drawn; commands before the first one begins draw nothing.
    fn draw(&mut self, f: impl FnOnce(&mut BezPath)) {
        if let Some(path) = self.paths.last_mut() {
            f(path);
        }
    }
}

impl OutlinePen for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.paths.push(BezPath::new());
        self.draw(|p| p.move_to(float(x, y)));
    }
    fn line_to(&mut self, x: f32, y: f32) {
        self.draw(|p| p.line_to(float(x, y)));
    }
    fn quad_to(&mut self, cx: f32, cy: f32, x: f32, y: f32) {
        self.draw(|p| p.quad_to(float(cx, cy), float(x, y)));
    }
    fn curve_to(&mut self, ax: f32, ay: f32, bx: f32, by: f32, x: f32, y: f32) {
        self.draw(|p| p.curve_to(float(ax, ay), float(bx, by), float(x, y)));
    }
    fn close(&mut self) {
        self.draw(BezPath::close_path);
    }
}

fn float(x: f32, y: f32) -> Point {
    Point::new(x.into(), y.into())
}
