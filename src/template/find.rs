//! Picture of a page → which page it is and where it lies.

use super::TemplateError;
use super::draw::RING;
use super::layout::{Code, Layout};
use crate::numeric::angles;
use crate::numeric::bilinear::bilinear;
use crate::numeric::cast::index;
use crate::numeric::surface::Surface;
use crate::numeric::view::View;
use crate::types::{Gray, Sheet};
use image::{GrayImage, Luma};
use imageproc::definitions::Image;
use imageproc::region_labelling::{Connectivity, connected_components};
use kurbo::{Affine, Point, Rect, Vec2};
use rqrr::SimpleGrid;

/// A page recognised.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// What its code says.
    pub code: Code,
    /// Where it lies in the picture.
    pub surface: Surface,
    /// Between the black of the marks and their paper, of black against white.
    pub contrast: f64,
}

/// Longest side of the reduced picture in which marks are looked for: a mark is then 40 px wide on a page that
/// fills the picture, and the search costs nothing beside decoding. px
const SEARCH: usize = 1600;
/// Radius of the local mean that ink must exceed, share of the reduced picture's longest side.
const NEARBY: usize = 20;
/// By how much it must exceed it: above a scanner's noise, below a faded photograph's contrast.
const CONTRAST: f64 = 0.12;
/// Marks tried when drawings look like marks too.
const MOST_MARKS: usize = 9;
/// Marks of one page differ in size by less than this, in perspective; the finder patterns of the code,
/// which are squares in square rings, are half as large. ratio
const MOST_ALIKE: f64 = 1.7;
/// Modules of a code of up to 29 signs at level Q, and of the next sizes.
const MODULES: [usize; 3] = [25, 29, 33];

/// Finds the four ring marks and reads the code beside them, whichever way the page was turned.
///
/// # Errors
/// Fewer than four marks, or no readable code of ours.
pub fn find(sheet: &Sheet, layout: &Layout) -> Result<Found, TemplateError> {
    let source_name = || sheet.source.clone();
    let (small, factor) = reduce(&sheet.gray);
    let marks = rings(&small);
    let Some(corners) = outermost(&marks) else {
        return Err(TemplateError::Marks {
            source_name: source_name(),
            found: marks.len().min(3),
        });
    };
    let corners = corners.map(|p| (p.to_vec2() * factor as f64).to_point());
    let turned = |turn: usize| {
        let mut turned = corners;
        turned.rotate_left(turn);
        refine(&sheet.gray, layout, View::through(layout.marks(), turned)?)
    };
    let turns: Vec<(View, f64)> = (0..4).filter_map(turned).collect();
    let all = || turns.iter().flat_map(|t| MODULES.map(|n| (*t, n)));
    let read = |view: &View, n: usize| read_code(&sheet.gray, layout.code(), view, n);
    let straight = all().filter_map(|(t, n)| Some((t, read(&t.0, n)?)));
    let bent = |view: &View, n: usize| code_view(&sheet.gray, layout.code(), view, n);
    let bent = all().filter_map(|(t, n)| Some((t, read(&bent(&t.0, n), n)?)));
    let mut foreign = None;
    for ((view, contrast), text) in straight.chain(bent) {
        match Code::parse(&text) {
            Some(code) => {
                return Ok(Found {
                    code,
                    surface: view.into(),
                    contrast,
                });
            }
            None => foreign = Some(text),
        }
    }
    Err(match foreign {
        Some(text) => TemplateError::ForeignCode {
            source_name: source_name(),
            text,
        },
        None => TemplateError::NoCode {
            source_name: source_name(),
        },
    })
}

/// The picture at a whole-number reduction, each sample the mean of its block, and the factor.
fn reduce(gray: &Gray) -> (Gray, usize) {
    let factor = gray.width().max(gray.height()).div_ceil(SEARCH).max(1);
    let (w, h) = (gray.width() / factor, gray.height() / factor);
    let share = 1.0 / (factor * factor) as f32;
    let small = Gray::from_fn(w, h, |x, y| {
        let rows = (y * factor..(y + 1) * factor).map(|r| gray.row(r));
        rows.flat_map(|r| &r[x * factor..(x + 1) * factor])
            .sum::<f32>()
            * share
    });
    (small, factor)
}

/// Pixels darker than their neighbourhood.
fn dark(gray: &Gray) -> GrayImage {
    let (w, h) = (gray.width(), gray.height());
    let stride = w + 1;
    let mut sums = vec![0.0f64; stride * (h + 1)];
    for y in 0..h {
        let mut row = 0.0;
        for (x, &v) in gray.row(y).iter().enumerate() {
            row += f64::from(v);
            sums[(y + 1) * stride + x + 1] = sums[y * stride + x + 1] + row;
        }
    }
    let r = (w.max(h) / NEARBY).max(2);
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the reduced picture is small"
    )]
    GrayImage::from_fn(w as u32, h as u32, |x, y| {
        let (x, y) = (x as usize, y as usize);
        let (x0, x1) = (x.saturating_sub(r), (x + r + 1).min(w));
        let (y0, y1) = (y.saturating_sub(r), (y + r + 1).min(h));
        let sum = sums[y1 * stride + x1] - sums[y0 * stride + x1] - sums[y1 * stride + x0]
            + sums[y0 * stride + x0];
        let mean = sum / ((x1 - x0) * (y1 - y0)) as f64;
        Luma([u8::from(f64::from(gray.at(x, y)) > mean + CONTRAST) * 255])
    })
}

/// Connected pixels of a picture of bits.
#[derive(Debug, Clone, Copy)]
pub(super) struct Blot {
    pub(super) bounds: Rect,
    pub(super) area: f64,
}

impl Blot {
    fn fill(&self) -> f64 {
        self.area / self.bounds.area()
    }

    fn width(&self) -> f64 {
        self.bounds.area().sqrt()
    }
}

/// The blots of a picture of bits.
pub(super) fn blots(bits: &GrayImage) -> Vec<Blot> {
    labelled(bits).1
}

/// The blots of a picture of bits, and which of them each pixel is in, counted from 1; 0 outside.
pub(super) fn labelled(bits: &GrayImage) -> (Image<Luma<u32>>, Vec<Blot>) {
    let labels = connected_components(bits, Connectivity::Eight, Luma([0]));
    let mut blots: Vec<Blot> = Vec::new();
    for (x, y, Luma([label])) in labels.enumerate_pixels() {
        let Some(i) = (*label as usize).checked_sub(1) else {
            continue;
        };
        let bounds = Rect::from_origin_size((f64::from(x), f64::from(y)), (1.0, 1.0));
        let none = Blot { bounds, area: 0.0 };
        blots.resize(blots.len().max(i + 1), none);
        let blot = &mut blots[i];
        blot.bounds = if blot.area > 0.0 {
            blot.bounds.union(bounds)
        } else {
            bounds
        };
        blot.area += 1.0;
    }
    (labels, blots)
}

/// Centres of discs with a ring around them: a disc fills π/4 of its box, the ring a third of its own.
fn rings(gray: &Gray) -> Vec<Point> {
    let round = |b: &&Blot| {
        let (w, h) = (b.bounds.width(), b.bounds.height());
        w >= 3.0 && h >= 3.0 && (0.55..1.8).contains(&(w / h))
    };
    let all = blots(&dark(gray));
    let discs: Vec<&Blot> = all
        .iter()
        .filter(round)
        .filter(|b| (0.55..0.97).contains(&b.fill()))
        .collect();
    let hoops = all
        .iter()
        .filter(round)
        .filter(|b| (0.15..0.55).contains(&b.fill()));
    let mut found: Vec<(Point, f64)> = Vec::new();
    for hoop in hoops {
        let inside = discs.iter().find(|d| {
            let off = d.bounds.center().distance(hoop.bounds.center());
            off < 0.15 * hoop.width() && (1.6..3.2).contains(&(hoop.width() / d.width()))
        });
        if let Some(d) = inside {
            found.push((d.bounds.center(), hoop.width()));
        }
    }
    // marks of one page are of one size; drawings that look like marks seldom are
    found.sort_by(|a, b| b.1.total_cmp(&a.1));
    let middle = found.get(found.len().min(4) / 2).map_or(0.0, |f| f.1);
    found.retain(|f| (1.0 / MOST_ALIKE..MOST_ALIKE).contains(&(f.1 / middle)));
    found.truncate(MOST_MARKS);
    found.into_iter().map(|f| f.0).collect()
}

/// The four of `points` with the largest area between them, clockwise as seen.
fn outermost(points: &[Point]) -> Option<[Point; 4]> {
    let n = points.len();
    let mut best: Option<(f64, [Point; 4])> = None;
    for a in 0..n {
        for b in a + 1..n {
            for c in b + 1..n {
                for d in c + 1..n {
                    let ring = clockwise([points[a], points[b], points[c], points[d]]);
                    let area = (ring[2] - ring[0]).cross(ring[3] - ring[1]).abs() / 2.0;
                    if best.as_ref().is_none_or(|(most, _)| area > *most) {
                        best = Some((area, ring));
                    }
                }
            }
        }
    }
    best.map(|(_, ring)| ring)
}

fn clockwise(mut ring: [Point; 4]) -> [Point; 4] {
    let centre = ring.iter().fold(Vec2::ZERO, |s, p| s + p.to_vec2()) / 4.0;
    ring.sort_by(|a, b| {
        let angle = |p: &Point| angles::heading(p.to_vec2() - centre);
        angle(a).total_cmp(&angle(b))
    });
    ring
}

/// The view through the marks' centres of gravity, found at full resolution, and the least of their contrasts.
fn refine(gray: &Gray, layout: &Layout, rough: View) -> Option<(View, f64)> {
    let (mut view, mut contrast) = (rough, 0.0);
    for _ in 0..3 {
        let marks = layout.marks();
        let mut centres = marks;
        contrast = f64::INFINITY;
        for (centre, &mark) in centres.iter_mut().zip(&marks) {
            let (at, own) = disc_centre(gray, &view, mark)?;
            *centre = at;
            contrast = own.min(contrast);
        }
        view = View::through(marks, centres)?;
    }
    Some((view, contrast))
}

/// Centre of gravity of the disc printed at `mark`, px, with the levels of its own black and white, and how far
/// these lie apart.
fn disc_centre(gray: &Gray, view: &View, mark: Point) -> Option<(Point, f64)> {
    let near = view.near(mark);
    let back = near.inverse();
    let reach = (RING[1] + RING[2]) / 2.0;
    let px = near.transform_rect_bbox(Rect::from_center_size(mark, (2.0 * reach, 2.0 * reach)));
    let inside = px.intersect(Rect::new(
        0.0,
        0.0,
        gray.width() as f64,
        gray.height() as f64,
    ));
    if inside.area() < 9.0 {
        return None;
    }
    let samples: Vec<(Point, f64, f64)> = (index(inside.y0)..index(inside.y1))
        .flat_map(|y| (index(inside.x0)..index(inside.x1)).map(move |x| (x, y)))
        .map(|(x, y)| {
            let p = Point::new(x as f64 + 0.5, y as f64 + 0.5);
            (p, (back * p).distance(mark), f64::from(gray.at(x, y)))
        })
        .filter(|(_, r, _)| *r < reach)
        .collect();
    let mean = |range: std::ops::Range<f64>| {
        let hits = samples.iter().filter(|(_, r, _)| range.contains(r));
        let (n, sum) = hits.fold((0.0, 0.0), |(n, s), (_, _, v)| (n + 1.0, s + v));
        (n > 0.0).then_some(sum / n)
    };
    let (ink, paper) = (mean(0.0..0.6 * RING[2])?, mean(reach * 0.93..reach)?);
    if ink - paper < CONTRAST / 2.0 {
        return None;
    }
    let weigh = |v: f64| ((v - paper) / (ink - paper)).clamp(0.0, 1.0);
    let (mass, moment) = samples.iter().fold((0.0, Vec2::ZERO), |(m, s), (p, _, v)| {
        let w = weigh(*v);
        (m + w, s + p.to_vec2() * w)
    });
    Some(((moment / mass).to_point(), ink - paper))
}

/// What the QR code in `square` says, its modules read where the view puts them.
fn read_code(gray: &Gray, square: Rect, view: &View, modules: usize) -> Option<String> {
    let module = square.width() / modules as f64;
    let value = |x: usize, y: usize| {
        let offsets = [-0.2, 0.0, 0.2];
        let at = |dx: f64, dy: f64| {
            let p = Vec2::new(x as f64 + 0.5 + dx, y as f64 + 0.5 + dy) * module;
            bilinear(gray.samples(), gray.width(), view.at(square.origin() + p))
        };
        offsets
            .iter()
            .flat_map(|&dy| offsets.iter().map(move |&dx| at(dx, dy)))
            .sum::<f64>()
            / 9.0
    };
    let values: Vec<f64> = (0..modules * modules)
        .map(|i| value(i % modules, i / modules))
        .collect();
    let (low, high) = values
        .iter()
        .fold((f64::MAX, f64::MIN), |(l, h), &v| (l.min(v), h.max(v)));
    let level = (low + high) / 2.0;
    let grid = SimpleGrid::from_func(modules, |x, y| values[y * modules + x] > level);
    rqrr::Grid::new(grid).decode().ok().map(|(_, text)| text)
}

/// The view of a QR code in `square` that paper or lens have bent away from where `view` puts it: its three corner
/// patterns say where it lies.
fn code_view(gray: &Gray, square: Rect, view: &View, modules: usize) -> View {
    /// How far a pattern is looked for, mm, and in which steps, modules.
    const REACH: f64 = 1.5;
    const STEP: f64 = 0.25;
    let module = square.width() / modules as f64;
    let far = modules as f64 - 3.5;
    let corners = [(3.5, 3.5), (far, 3.5), (3.5, far)]
        .map(|(x, y)| square.origin() + Vec2::new(x, y) * module);
    // rings of dark and light about a dark square of three modules
    let ring = |x: i32, y: i32| match x.abs().max(y.abs()) {
        2 | 4 => -1.0,
        _ => 1.0,
    };
    let alike = |middle: Point| {
        let near = (-4..=4).flat_map(|y| (-4..=4).map(move |x| (x, y)));
        let values = near.map(|(x, y)| {
            let p = middle + Vec2::new(f64::from(x), f64::from(y)) * module;
            ring(x, y) * bilinear(gray.samples(), gray.width(), view.at(p))
        });
        values.sum::<f64>()
    };
    let steps = index(REACH / (STEP * module));
    let seen = corners.map(|corner| {
        let place = |k: usize| (k as f64 - steps as f64) * STEP * module;
        let all = (0..=2 * steps).flat_map(|j| (0..=2 * steps).map(move |i| (i, j)));
        let places = all.map(|(i, j)| corner + Vec2::new(place(i), place(j)));
        let scored = places.map(|p| (alike(p), p));
        let best = scored.max_by(|a, b| a.0.total_cmp(&b.0));
        best.map_or(corner, |(_, p)| p)
    });
    let edges = |[a, b, c]: [Point; 3]| {
        let (x, y) = (b - a, c - a);
        Affine::new([x.x, x.y, y.x, y.y, a.x, a.y])
    };
    *view * View::from(edges(seen) * edges(corners).inverse())
}
