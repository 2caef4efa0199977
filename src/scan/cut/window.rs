//! The picture of a cell: its own ink, nobody else's, upright.
//!
//! What lies nearer to other ink than to its own, and what stands out of the noise far from its own, becomes
//! paper. On an upright page the pixels are the scan's own; else they are interpolated once, by a kernel that
//! keeps what the scanner could resolve (Lanczos of three lobes). Perspective is undone in the same step.

use super::{Slot, holes};
use crate::numeric::angles;
use crate::numeric::cast::{index, single};
use crate::numeric::view::View;
use crate::scan::chamfer::distances;
use crate::scan::clean::Page;
use crate::scan::components::{Component, Run, components};
use crate::scan::separation::{self, Separation};
use crate::types::{Cell, Gray, Guides, Plate};
use kurbo::{Affine, Point, Rect, Vec2};
use std::f64::consts::PI;

/// Paper around the ink of a cell, px: enough to see its level.
const MARGIN: f64 = 12.0;
/// How far a stroke's blurred edge reaches, px.
const HALO: u16 = 8;
/// How far from ink its blurred edge stays its own where it runs on into what is somebody else's, px.
const EDGE: u16 = 3;
/// Coverage from which on somebody else's ink is followed as far as that edge: of what is fainter nothing is traced.
const FAINT: f32 = 0.1;
/// Standard deviations of noise above which paper far from the cell's ink is somebody else's.
const NOISE: f32 = 4.0;
/// Lobes of the kernel.
const LOBES: usize = 3;
/// Positions between two pixels for which the kernel is tabled.
const PHASES: usize = 512;

/// Takes pictures of cells.
pub(super) struct Shutter<'a> {
    pub(super) page: &'a Page,
    /// Coverage from which pixels are ink.
    pub(super) low: f32,
    /// The letters' usual stroke, px.
    pub(super) stroke: f64,
    /// What tells the inks apart that become layers.
    pub(super) separation: Option<&'a Separation<'a>>,
}

impl Shutter<'_> {
    pub(super) fn cell(
        &self,
        slot: &Slot,
        parts: &[&Component],
        (baseline, px_per_em): (f64, f64),
        (mut upright, rotation_deg): (View, f64),
    ) -> Cell {
        let union =
            |of: fn(&Component) -> Rect| parts.iter().map(|c| of(c)).reduce(|a, b| a.union(b));
        let mut ink = union(|c| c.upright).unwrap_or(Rect::ZERO);
        if rotation_deg.abs() > 0.0 {
            let foot = Point::new(ink.center().x, baseline);
            upright = View::from(angles::rotation_about(rotation_deg.to_radians(), foot)) * upright;
            let turned = parts.iter().map(|&c| {
                let mut c = c.clone();
                c.stand(&upright);
                c.upright
            });
            ink = turned.reduce(|a, b| a.union(b)).unwrap_or(ink);
        }
        let window = ink.inflate(MARGIN, MARGIN).expand();
        let corner = Affine::translate(window.origin().to_vec2());
        let to_sheet = upright.affine().map_or_else(
            || upright.inverse() * View::from(corner),
            |map| View::from(map.inverse() * corner),
        );
        let middle = (window.center() - window.origin()).to_point();
        let (gray, plates) = self.pictures(parts, window, &to_sheet);
        Cell {
            label: slot.label.clone(),
            index: slot.index,
            gray,
            plates,
            in_sheet: union(|c| c.bounds).unwrap_or(Rect::ZERO),
            to_sheet: to_sheet.affine().unwrap_or_else(|| to_sheet.near(middle)),
            guides: Guides {
                baseline_px: baseline - window.y0,
                px_per_em,
                row: Some(slot.row),
            },
        }
    }

    /// The picture of all ink, and of each ink by itself where there are several.
    fn pictures(&self, parts: &[&Component], window: Rect, to_sheet: &View) -> (Gray, Vec<Plate>) {
        let (w, h) = (index(window.width()), index(window.height()));
        let needed = to_sheet.bounds(Rect::new(0.0, 0.0, w as f64, h as f64));
        let mut patch = Patch::new(
            self,
            parts,
            needed.inflate(LOBES as f64 + 1.0, LOBES as f64 + 1.0),
        );
        let Some(separation) = self.separation else {
            return (patch.picture((w, h), to_sheet), Vec::new());
        };
        let mut all = separation.plates(&separation::Part {
            corner: (index(patch.origin.x), index(patch.origin.y)),
            width: patch.width,
            samples: &patch.samples,
        });
        for (i, v) in patch.samples.iter_mut().enumerate() {
            *v = all.iter().map(|plate| plate[i]).sum();
        }
        let gray = patch.picture((w, h), to_sheet);
        separation::trap(&mut all, patch.width);
        let plates = separation.colours().into_iter().zip(all);
        let plates = plates.map(|(colour, samples)| {
            patch.samples = samples;
            Plate {
                ink: colour.ink,
                gray: patch.picture((w, h), to_sheet),
            }
        });
        (gray, plates.collect())
    }
}

/// The whole pixels by which a map moves all, where it does nothing else.
fn whole_shift(map: Affine) -> Option<Vec2> {
    let [a, b, c, d, e, f] = map.as_coeffs();
    let whole = |v: f64| (v - v.round()).abs() < 1e-9;
    let upright = [a, d].iter().all(|v| (v - 1.0).abs() < 1e-12) && b.abs() + c.abs() < 1e-12;
    (upright && whole(e) && whole(f)).then(|| Vec2::new(e.round(), f.round()))
}

/// A piece of the sheet in which only one cell's ink is left.
struct Patch {
    width: usize,
    height: usize,
    /// Its corner in the sheet, px.
    origin: Point,
    samples: Vec<f32>,
    /// As the page's.
    scatter_px: f64,
}

impl Patch {
    fn new(shutter: &Shutter<'_>, parts: &[&Component], area: Rect) -> Self {
        let gray = &shutter.page.sheet.gray;
        let area = area.expand().intersect(Rect::new(
            0.0,
            0.0,
            gray.width() as f64,
            gray.height() as f64,
        ));
        let (x0, y0) = (index(area.x0), index(area.y0));
        let (width, height) = (index(area.width().max(0.0)), index(area.height().max(0.0)));
        let rows = (y0..y0 + height).flat_map(|y| gray.row(y)[x0..x0 + width].iter().copied());
        let mut new = Self {
            width,
            height,
            origin: area.origin(),
            samples: rows.collect(),
            scatter_px: gray.scatter_px(),
        };
        let mut own = vec![u16::MAX; width * height];
        for r in parts.iter().flat_map(|c| &c.runs) {
            new.mark(r, &mut own);
        }
        let ink = |(v, own): (&f32, &u16)| {
            if *v >= shutter.low && *own > 0 {
                0
            } else {
                u16::MAX
            }
        };
        let mut other: Vec<u16> = new.samples.iter().zip(&own).map(ink).collect();
        distances(&mut own, width);
        if other.contains(&0) {
            distances(&mut other, width);
        }
        let loud = NOISE * shutter.page.noise;
        new.clear_passing(&own, loud.max(FAINT));
        let judged = new.samples.iter_mut().zip(own.iter().zip(&other));
        for (v, (&own, &other)) in judged {
            let near = own <= 3 * HALO;
            if (near && other < own) || (!near && *v > loud) {
                *v = 0.0;
            }
        }
        for &(x, y, share) in parts.iter().flat_map(|c| &c.shares) {
            let at = (x.checked_sub(x0).filter(|x| *x < width))
                .zip(y.checked_sub(y0).filter(|y| *y < height));
            if let Some((x, y)) = at {
                new.samples[y * width + x] *= share;
            }
        }
        // a letter that is nearly all ink has no larger pinholes than others
        let body = parts.iter().max_by_key(|c| c.area);
        let stroke = body.map_or(0.0, |c| c.stroke().min(shutter.stroke));
        holes::fill(&mut new.samples, width, stroke);
        new
    }

    /// Clears what is as dark as `least` and runs from beside a cell's own ink, from which each pixel is `own` thirds
    /// of one away, to far from it: a faint printed line is not the letter's where it passes it, either. The end of a
    /// stroke that fades out does not run on so far.
    fn clear_passing(&mut self, own: &[u16], least: f32) {
        let width = self.width;
        let beyond = |reach: u16, x: usize, y: usize| own[y * width + x] > 3 * reach;
        let passing = Gray::from_fn(width, self.height, |x, y| {
            if beyond(EDGE, x, y) {
                self.samples[y * width + x]
            } else {
                0.0
            }
        });
        let long = |c: &Component| c.bounds.size().max_side() > MARGIN;
        let far = |c: &Component| c.pixels().any(|(x, y)| beyond(HALO, x, y));
        let lines = components(&passing, least, least).into_iter();
        for r in lines.filter(|c| long(c) && far(c)).flat_map(|c| c.runs) {
            self.samples[r.y * width..][r.start..r.end].fill(0.0);
        }
    }

    /// Its picture of a size in px, each of whose places `to_sheet` maps to the sheet's.
    fn picture(&self, (w, h): (usize, usize), to_sheet: &View) -> Gray {
        if let Some(shift) = to_sheet.affine().and_then(whole_shift) {
            let shift = shift - self.origin.to_vec2();
            let at = |x: usize, y: usize| self.at(x as f64 + shift.x, y as f64 + shift.y);
            return Gray::from_fn(w, h, at).with_scatter(self.scatter_px);
        }
        let kernel = Kernel::new();
        let to_patch = View::from(Affine::translate(-self.origin.to_vec2())) * *to_sheet;
        let gray = Gray::from_fn(w, h, |x, y| {
            let p = to_patch.at(Point::new(x as f64 + 0.5, y as f64 + 0.5));
            kernel.sample(self, p.x - 0.5, p.y - 0.5)
        });
        gray.with_scatter(self.scatter_px)
    }

    fn mark(&self, r: &Run, mask: &mut [u16]) {
        let place = |v: usize, origin: f64, size: usize| v.saturating_sub(index(origin)).min(size);
        let y = place(r.y, self.origin.y, self.height);
        let (a, b) = (
            place(r.start, self.origin.x, self.width),
            place(r.end, self.origin.x, self.width),
        );
        if r.y >= index(self.origin.y) && y < self.height {
            mask[y * self.width + a..y * self.width + b].fill(0);
        }
    }

    /// A pixel; paper outside.
    fn at(&self, x: f64, y: f64) -> f32 {
        let inside = x >= 0.0 && y >= 0.0 && x < self.width as f64 && y < self.height as f64;
        if inside {
            self.samples[index(y) * self.width + index(x)]
        } else {
            0.0
        }
    }
}

/// A Lanczos kernel at [`PHASES`] positions between two pixels.
struct Kernel {
    taps: Vec<[f32; 2 * LOBES]>,
}

impl Kernel {
    fn new() -> Self {
        let sinc = |x: f64| {
            if x.abs() < 1e-9 {
                1.0
            } else {
                libm::sin(PI * x) / (PI * x)
            }
        };
        let weight = |x: f64| {
            if x.abs() < LOBES as f64 {
                sinc(x) * sinc(x / LOBES as f64)
            } else {
                0.0
            }
        };
        let phase = |i: usize| {
            let t = i as f64 / PHASES as f64;
            let raw: [f64; 2 * LOBES] =
                std::array::from_fn(|k| weight(k as f64 + 1.0 - LOBES as f64 - t));
            let sum: f64 = raw.iter().sum();
            raw.map(|w| single(w / sum))
        };
        Self {
            taps: (0..=PHASES).map(phase).collect(),
        }
    }

    /// The picture at a place between the centres of its pixels; paper outside.
    fn sample(&self, patch: &Patch, x: f64, y: f64) -> f32 {
        let split = |v: f64| {
            (
                v.floor(),
                &self.taps[index((v - v.floor()) * PHASES as f64 + 0.5)],
            )
        };
        let ((x, across), (y, down)) = (split(x), split(y));
        let first = 1.0 - LOBES as f64;
        let (left, top) = (x + first, y + first);
        let side = (2 * LOBES) as f64;
        let inside = left >= 0.0
            && top >= 0.0
            && left + side <= patch.width as f64
            && top + side <= patch.height as f64;
        if !inside {
            return patch.at(x, y);
        }
        let start = index(top) * patch.width + index(left);
        let line = |(k, w): (usize, &f32)| {
            let row = &patch.samples[start + k * patch.width..][..2 * LOBES];
            w * row.iter().zip(across).map(|(v, w)| v * w).sum::<f32>()
        };
        down.iter().enumerate().map(line).sum()
    }
}
