use crate::numeric::angles;
use crate::numeric::view::View;
use crate::types::{Gray, Sheet};
use kurbo::{Affine, Point, Rect, Vec2};

/// Paper on which letters are drawn as bars, turned, unevenly lit and noisy.
#[derive(Clone)]
pub(super) struct Paper {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) skew_deg: f64,
    /// How much nearer the right and the lower side are than the middle.
    pub(super) tilt: [f64; 2],
    /// How much farther down the middle of each row is seen than its ends, and farther right that of each column, px.
    pub(super) bow: [f64; 2],
    pub(super) bars: Vec<(Rect, f32)>,
}

impl Paper {
    pub(super) fn new(width: usize, height: usize, skew_deg: f64) -> Self {
        Self {
            width,
            height,
            skew_deg,
            tilt: [0.0; 2],
            bow: [0.0; 2],
            bars: Vec::new(),
        }
    }

    pub(super) fn bar(&mut self, x: f64, y: f64, w: f64, h: f64) {
        self.bars.push((Rect::new(x, y, x + w, y + h), 1.0));
    }

    /// A letter of x-height 30 and stroke 6 whose foot stands at (x, y).
    pub(super) fn letter(&mut self, c: char, x: f64, y: f64) {
        match c {
            'i' => {
                self.bar(x, y - 30.0, 6.0, 30.0);
                self.bar(x, y - 42.0, 6.0, 6.0);
            }
            'l' => self.bar(x, y - 45.0, 6.0, 45.0),
            'p' => {
                self.bar(x, y - 30.0, 6.0, 55.0);
                self.bar(x + 6.0, y - 30.0, 20.0, 6.0);
                self.bar(x + 20.0, y - 24.0, 6.0, 24.0);
                self.bar(x + 6.0, y - 6.0, 14.0, 6.0);
            }
            _ => {
                self.bar(x, y - 30.0, 6.0, 30.0);
                self.bar(x + 22.0, y - 30.0, 6.0, 30.0);
                self.bar(x + 6.0, y - 30.0, 16.0, 6.0);
            }
        }
    }

    /// From the page to its picture.
    pub(super) fn view(&self) -> View {
        let middle = Vec2::new(self.width as f64 / 2.0, self.height as f64 / 2.0);
        let [g, k] = self.tilt;
        let tilt = View::of_pencils([1.0, 0.0, 0.0, 1.0, g / middle.x, k / middle.y]);
        let turn = Affine::translate(middle) * angles::rotation(self.skew_deg.to_radians());
        View::from(turn) * tilt * View::from(Affine::translate(-middle))
    }

    /// Where a place of the page is in its picture.
    pub(super) fn at(&self, p: Point) -> Point {
        self.view().at(p + self.bowed(p))
    }

    /// How far it lies from where it would be on a flat page.
    fn bowed(&self, p: Point) -> Vec2 {
        let bow = |at: f64, side: usize| 1.0 - (2.0 * at / side as f64 - 1.0).powi(2);
        let [down, right] = self.bow;
        Vec2::new(right * bow(p.y, self.height), down * bow(p.x, self.width))
    }

    /// The picture: light falls off to the right, and every pixel has its own noise.
    pub(super) fn scan(&self) -> Sheet {
        let back = self.view().inverse();
        let mut seed = 1u32;
        let gray = Gray::from_fn(self.width, self.height, |x, y| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let noise = (seed >> 16) as f32 / 65_536.0 - 0.5;
            let samples = [(0.25, 0.25), (0.75, 0.25), (0.25, 0.75), (0.75, 0.75)];
            let ink = samples.iter().map(|(dx, dy)| {
                let seen = back.at(Point::new(x as f64 + dx, y as f64 + dy));
                let p = (0..4).fold(seen, |p, _| seen - self.bowed(p));
                let here = self.bars.iter().filter(|b| b.0.contains(p)).map(|b| b.1);
                here.fold(0.0, f32::max)
            });
            let ink = ink.sum::<f32>() / 4.0;
            let light = 0.95 - 0.35 * x as f32 / self.width as f32;
            1.0 - light * (1.0 - 0.8 * ink) + 0.02 * noise
        });
        Sheet {
            gray,
            colours: None,
            dpi: Some(300.0),
            guessed: None,
            source: "page.png".to_owned(),
        }
    }
}
