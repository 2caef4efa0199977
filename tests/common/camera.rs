//! A printer, a pen and a camera in software: a page with drawings on it becomes the bytes of a photograph.
#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "sizes of pictures that the tests choose"
)]

use image::codecs::jpeg::JpegEncoder;
use khatt::numeric::angles;
use khatt::template::{self, Page, View};
use kurbo::{Affine, BezPath, Point, Vec2};

/// How a page is taken.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Camera {
    /// Pixels an inch of paper.
    pub(crate) dpi: f64,
    /// Turned clockwise on the glass, degrees.
    pub(crate) skew_deg: f64,
    /// Quarter turns.
    pub(crate) quarters: u32,
    /// How much nearer one side is than the other, share of the picture.
    pub(crate) tilt: [f64; 2],
    /// How much farther from its middle the lens puts the picture's corners than its middle, share of their distance;
    /// negative of a barrel.
    pub(crate) lens: f64,
    /// How high the paper's middle stands above its top and foot, and how high a wave across it, mm.
    pub(crate) bow_mm: [f64; 2],
    /// Standard deviation of the lens' blur, px.
    pub(crate) blur: f64,
    /// What the sensor makes of the light, 1 for its own share: above, edges lie farther out.
    pub(crate) gamma: f64,
    /// How much darker the dark corner is, share of the light.
    pub(crate) shade: f64,
    /// JPEG quality, or a lossless picture.
    pub(crate) jpeg: Option<u8>,
    /// Of the noise.
    pub(crate) seed: u64,
}

impl Camera {
    /// The picture's bytes, and where every millimetre of the page went.
    pub(crate) fn take(&self, page: &Page, drawn: &[BezPath]) -> (Vec<u8>, Sight) {
        let mut page = page.clone();
        let ink = |path: &BezPath| template::Paint {
            path: path.clone(),
            ink: template::Ink::Black,
        };
        page.paints.extend(drawn.iter().map(ink));
        let png = template::png(&page, self.dpi * 1.25).expect("a page can be drawn");
        let print = image::load_from_memory(&png)
            .expect("a PNG reads back")
            .to_luma8();
        let (size, view) = self.aim(&page);
        let sight = Sight {
            view,
            middle: (size / 2.0).to_point(),
            lens: self.lens,
            page: page.size.to_vec2(),
            bow_mm: self.bow_mm,
        };
        let seen = Ground::of(&sight, size);
        let scale = f64::from(print.width()) / page.size.width;
        let mut rng = Noise(self.seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
        let mut out = image::GrayImage::new(size.x as u32, size.y as u32);
        let mut light = vec![0.0f32; out.len()];
        for (i, v) in light.iter_mut().enumerate() {
            let (x, y) = ((i % size.x as usize) as f64, (i / size.x as usize) as f64);
            let taps = [(0.25, 0.25), (0.75, 0.25), (0.25, 0.75), (0.75, 0.75)];
            let seen = taps
                .iter()
                .map(|(dx, dy)| bilinear(&print, seen.at(Point::new(x + dx, y + dy)) * scale));
            *v = (seen.sum::<f64>() / 4.0) as f32;
        }
        let light = smooth(light, size.x as usize, self.blur);
        for (i, (pixel, v)) in out.pixels_mut().zip(light).enumerate() {
            let (x, y) = (
                (i % size.x as usize) as f64 / size.x,
                (i / size.x as usize) as f64 / size.y,
            );
            let shade = 1.0 - self.shade * (x + y) / 2.0;
            let v = 255.0 * libm::pow(f64::from(v) / 255.0, self.gamma);
            let v = (30.0 + 0.82 * v) * shade + 3.0 * rng.normal();
            pixel.0 = [v.round().clamp(0.0, 255.0) as u8];
        }
        let mut bytes = std::io::Cursor::new(Vec::new());
        match self.jpeg {
            Some(q) => JpegEncoder::new_with_quality(&mut bytes, q)
                .encode_image(&out)
                .expect("a JPEG in memory"),
            None => out
                .write_to(&mut bytes, image::ImageFormat::Png)
                .expect("a PNG in memory"),
        }
        (bytes.into_inner(), sight)
    }

    /// Size of the picture and the view of the page in it: the whole page with a border of 4 %.
    fn aim(&self, page: &Page) -> (Vec2, View) {
        let px = self.dpi / 25.4;
        let turn =
            self.skew_deg.to_radians() + f64::from(self.quarters) * std::f64::consts::FRAC_PI_2;
        let half = page.size.to_vec2() / 2.0;
        let around = Affine::scale(px) * angles::rotation(turn) * Affine::translate(-half);
        let plane = corners(page.size.to_vec2()).map(|p| around * p);
        let depth =
            |p: Point| 1.0 + (self.tilt[0] * p.x + self.tilt[1] * p.y) / (half.hypot() * px);
        let seen = plane.map(|p| (p.to_vec2() / depth(p)).to_point());
        let low = seen.iter().fold(Vec2::new(1e9, 1e9), |m, p| {
            Vec2::new(m.x.min(p.x), m.y.min(p.y))
        });
        let high = seen.iter().fold(Vec2::new(-1e9, -1e9), |m, p| {
            Vec2::new(m.x.max(p.x), m.y.max(p.y))
        });
        let border = (high - low) * 0.04;
        let size = (high - low) + border * 2.0;
        let placed = seen.map(|p| p - low + border);
        let view = View::through(corners(page.size.to_vec2()), placed).expect("a page is no line");
        (Vec2::new(size.x.ceil(), size.y.ceil()), view)
    }
}

/// Where a page lies in its picture: paper that is not flat, seen in perspective through a lens that bends lines.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sight {
    view: View,
    /// Of the picture, px.
    middle: Point,
    lens: f64,
    /// mm.
    page: Vec2,
    bow_mm: [f64; 2],
}

/// How far away the camera is, mm.
const FAR: f64 = 400.0;
/// How long a wave of the paper is, mm.
const WAVE: f64 = 110.0;

impl Sight {
    /// Where a point of the page is.
    pub(crate) fn at(&self, p: Point) -> Point {
        let middle = (self.page / 2.0).to_point();
        let nearer = FAR / (FAR - self.height(p));
        let p = self.view.at(middle + (p - middle) * nearer) - self.middle;
        self.middle + p * self.bend(p)
    }

    /// Pixels a millimetre around a point of the page.
    pub(crate) fn scale(&self, p: Point) -> f64 {
        let along = |d: Vec2| self.at(p + d) - self.at(p - d);
        let (x, y) = (along(Vec2::new(0.5, 0.0)), along(Vec2::new(0.0, 0.5)));
        x.cross(y).abs().sqrt()
    }

    /// The way back, `back` of the view, step by step.
    fn page_at(&self, back: &View, p: Point) -> Point {
        let (seen, middle) = (p - self.middle, (self.page / 2.0).to_point());
        let mut straight = seen;
        if self.lens.abs() > 0.0 {
            (0..6).for_each(|_| straight = seen / self.bend(straight));
        }
        let flat = back.at(self.middle + straight);
        let mut page = flat;
        if self.bow_mm.iter().any(|h| h.abs() > 0.0) {
            for _ in 0..6 {
                page = middle + (flat - middle) * (1.0 - self.height(page) / FAR);
            }
        }
        page
    }

    fn bend(&self, p: Vec2) -> f64 {
        1.0 + self.lens * p.hypot2() / self.middle.to_vec2().hypot2()
    }

    /// How high the paper stands, mm.
    fn height(&self, p: Point) -> f64 {
        let down = 2.0 * p.y / self.page.y - 1.0;
        let wave = libm::sin(std::f64::consts::TAU * (p.x + 0.3 * p.y) / WAVE);
        self.bow_mm[0] * (1.0 - down * down) + self.bow_mm[1] * wave
    }
}

/// The points of the page that the picture shows, at every so many px and straight between.
struct Ground {
    columns: usize,
    points: Vec<Vec2>,
}

impl Ground {
    const PX: f64 = 8.0;

    fn of(sight: &Sight, size: Vec2) -> Self {
        let back = sight.view.inverse();
        let [columns, rows] = [size.x, size.y].map(|side| (side / Self::PX).ceil() as usize + 2);
        let at = |i: usize| {
            let p = Point::new((i % columns) as f64, (i / columns) as f64).to_vec2() * Self::PX;
            sight.page_at(&back, p.to_point()).to_vec2()
        };
        Self {
            columns,
            points: (0..columns * rows).map(at).collect(),
        }
    }

    fn at(&self, p: Point) -> Vec2 {
        let (u, v) = (p.x / Self::PX, p.y / Self::PX);
        let (s, t) = (u.fract(), v.fract());
        let first = v as usize * self.columns + u as usize;
        let row = |k: usize| self.points[first + k] * (1.0 - s) + self.points[first + k + 1] * s;
        row(0) * (1.0 - t) + row(self.columns) * t
    }
}

fn corners(size: Vec2) -> [Point; 4] {
    [(0.0, 0.0), (size.x, 0.0), (size.x, size.y), (0.0, size.y)].map(Point::from)
}

fn bilinear(print: &image::GrayImage, p: Vec2) -> f64 {
    let q = p - Vec2::new(0.5, 0.5);
    let (x, y) = (q.x.floor(), q.y.floor());
    let (fx, fy) = (q.x - x, q.y - y);
    let at = |dx: f64, dy: f64| {
        let (x, y) = (x + dx, y + dy);
        let inside =
            x >= 0.0 && y >= 0.0 && x < f64::from(print.width()) && y < f64::from(print.height());
        // the table beyond the paper
        if inside {
            f64::from(print.get_pixel(x as u32, y as u32).0[0])
        } else {
            90.0
        }
    };
    (at(0.0, 0.0) * (1.0 - fx) + at(1.0, 0.0) * fx) * (1.0 - fy)
        + (at(0.0, 1.0) * (1.0 - fx) + at(1.0, 1.0) * fx) * fy
}

/// Gaussian blur, both ways.
fn smooth(v: Vec<f32>, width: usize, sigma: f64) -> Vec<f32> {
    let reach = (3.0 * sigma).ceil() as usize;
    let kernel: Vec<f32> = (0..=2 * reach)
        .map(|i| libm::exp(-(i as f64 - reach as f64).powi(2) / (2.0 * sigma * sigma)) as f32)
        .collect();
    let total: f32 = kernel.iter().sum();
    let height = v.len() / width;
    let pass = |v: &[f32], n: usize, stride: usize, lines: usize, line_stride: usize| {
        let mut out = vec![0.0; v.len()];
        for l in 0..lines {
            for i in 0..n {
                let sum: f32 = kernel
                    .iter()
                    .enumerate()
                    .map(|(k, w)| {
                        w * v[l * line_stride + (i + k).saturating_sub(reach).min(n - 1) * stride]
                    })
                    .sum();
                out[l * line_stride + i * stride] = sum / total;
            }
        }
        out
    };
    let across = pass(&v, width, 1, height, width);
    pass(&across, height, width, width, 1)
}

/// A small generator of normal deviates: the sum of twelve uniform ones.
struct Noise(u64);

impl Noise {
    fn uniform(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.uniform()).sum::<f64>() - 6.0
    }
}
