//! The picture of a cell: its own ink, nobody else's, upright.
//!
//! What lies nearer to other ink than to its own, and what stands out of the noise far from its own, becomes
//! paper. The pixels are the scan's own; where the letter lies askew on them its picture says how it stands upright.
//! Where a page is seen in perspective, or bent, they are interpolated once, by a kernel that keeps what the scanner
//! could resolve ([`lanczos`]).
//!
//! [`lanczos`]: crate::numeric::lanczos

use super::askew::Askew;
use super::{Slot, holes};
use crate::numeric::angles;
use crate::numeric::cast::index;
use crate::numeric::lanczos::{LOBES, Lanczos};
use crate::numeric::surface::Surface;
use crate::scan::chamfer::distances;
use crate::scan::clean::Page;
use crate::scan::components::{Component, Run, components};
use crate::scan::separation::{self, Separation};
use crate::types::{Cell, Gray, Guides, Plate};
use kurbo::{Affine, Point, Rect};

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
        (mut upright, rotation_deg): (Surface, f64),
    ) -> Cell {
        let union =
            |of: fn(&Component) -> Rect| parts.iter().map(|c| of(c)).reduce(|a, b| a.union(b));
        let mut ink = union(|c| c.upright).unwrap_or(Rect::ZERO);
        if rotation_deg.abs() > 0.0 {
            let foot = Point::new(ink.center().x, baseline);
            upright = angles::rotation_about(rotation_deg.to_radians(), foot) * &upright;
            let turned = parts.iter().map(|&c| {
                let mut c = c.clone();
                c.stand(&upright);
                c.upright
            });
            ink = turned.reduce(|a, b| a.union(b)).unwrap_or(ink);
        }
        let window = ink.inflate(MARGIN, MARGIN).expand();
        let frame = Frame::around(window, &upright);
        let middle = Point::new(frame.width as f64 / 2.0, frame.height as f64 / 2.0);
        let (gray, plates) = self.pictures(parts, &frame);
        Cell {
            label: slot.label.clone(),
            index: slot.index,
            gray,
            plates,
            in_sheet: union(|c| c.bounds).unwrap_or(Rect::ZERO),
            to_sheet: (frame.to_sheet.affine()).unwrap_or_else(|| frame.to_sheet.near(middle)),
            guides: Guides {
                baseline_px: baseline - frame.top,
                px_per_em,
                row: Some(slot.row),
            },
        }
    }

    /// The picture of all ink, and of each ink by itself where there are several.
    fn pictures(&self, parts: &[&Component], frame: &Frame) -> (Gray, Vec<Plate>) {
        let needed = frame.in_sheet();
        let mut patch = Patch::new(
            self,
            parts,
            needed.inflate(LOBES as f64 + 1.0, LOBES as f64 + 1.0),
        );
        let Some(separation) = self.separation else {
            return (patch.picture(frame), Vec::new());
        };
        let mut all = separation.plates(&separation::Part {
            corner: (index(patch.origin.x), index(patch.origin.y)),
            width: patch.width,
            samples: &patch.samples,
        });
        for (i, v) in patch.samples.iter_mut().enumerate() {
            *v = all.iter().map(|plate| plate[i]).sum();
        }
        let gray = patch.picture(frame);
        separation::trap(&mut all, patch.width);
        let plates = separation.colours().into_iter().zip(all);
        let plates = plates.map(|(colour, samples)| {
            patch.samples = samples;
            Plate {
                ink: colour.ink,
                gray: patch.picture(frame),
            }
        });
        (gray, plates.collect())
    }
}

/// Where a cell's picture is on the sheet.
struct Frame {
    width: usize,
    height: usize,
    /// From px of the upright drawing, y down, to px of the sheet.
    to_sheet: Surface,
    /// Its upper edge on the upright page, px.
    top: f64,
    /// The sheet's own pixels, where it consists of them.
    own: Option<Askew>,
}

impl Frame {
    /// Around a window of the upright page, to which `upright` takes the sheet.
    fn around(window: Rect, upright: &Surface) -> Self {
        let view = upright.inverse();
        let own = Askew::around(window, &view);
        let corner = Affine::translate(window.origin().to_vec2());
        let size = own.map_or(window, |own| own.pixels).size();
        Self {
            width: index(size.width),
            height: index(size.height),
            to_sheet: own.map_or_else(|| &view * corner, |own| own.to_picture.into()),
            top: own.map_or(window.y0, |own| own.origin.y),
            own,
        }
    }

    /// The part of the sheet from which it is taken.
    fn in_sheet(&self) -> Rect {
        let all = Rect::new(0.0, 0.0, self.width as f64, self.height as f64);
        (self.own).map_or_else(|| self.to_sheet.bounds(all), |own| own.pixels)
    }
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

    /// The picture of a frame.
    fn picture(&self, frame: &Frame) -> Gray {
        let (w, h) = (frame.width, frame.height);
        let gray = if let Some(own) = frame.own {
            let shift = own.pixels.origin() - self.origin;
            let at = |x: usize, y: usize| self.at(x as f64 + shift.x, y as f64 + shift.y);
            Gray::from_fn(w, h, at).with_upright(own.upright)
        } else {
            let kernel = Lanczos::default();
            let back = Affine::translate(-self.origin.to_vec2());
            let to_patch = back * &frame.to_sheet;
            Gray::from_fn(w, h, |x, y| {
                let p = to_patch.at(Point::new(x as f64 + 0.5, y as f64 + 0.5));
                kernel.sample(&self.samples, self.width, (p.x - 0.5, p.y - 0.5))
            })
        };
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
