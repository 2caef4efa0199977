//! TrueType: quadratic outlines, composites, and no instructions.

use super::numbers::{check, count, ids, to_i16};
use super::{WriteError, sfnt};
use crate::numeric::cast::single;
use crate::types::{Component, Font, Glyph};
use kurbo::{Affine, BezPath, PathEl, Point, Rect};
use std::collections::BTreeMap;
use write_fonts::tables::glyf::{
    Anchor, Bbox, Component as Part, ComponentFlags, CompositeGlyph, GlyfLocaBuilder,
    Glyph as Written, SimpleGlyph, Transform,
};
use write_fonts::tables::head::Head;
use write_fonts::tables::loca::LocaFormat;
use write_fonts::tables::maxp::Maxp;
use write_fonts::types::{F2Dot14, GlyphId16, Tag};

/// The control program of an unhinted font: drop-out control on, at every size (`PUSHW 511; SCANCTRL;
/// PUSHB 4; SCANTYPE`).
const PREP: [u8; 7] = [0xB8, 0x01, 0xFF, 0x85, 0xB0, 0x04, 0x8D];

/// A TrueType font.
pub(super) fn bytes(font: &Font) -> Result<Vec<u8>, WriteError> {
    let glyphs = Glyphs::of(font)?;
    let mut outlines = GlyfLocaBuilder::new();
    for (written, glyph) in glyphs.written.iter().zip(font.glyphs()) {
        outlines
            .add_glyph(written)
            .map_err(|e| WriteError::table(&format!("glyf ({})", glyph.name), e))?;
    }
    let extents: Vec<Option<Rect>> = glyphs.written.iter().map(extent).collect();
    let mut common = sfnt::common(font, &extents)?;
    common.maxp = glyphs.maxp()?;
    let (glyf, loca, format) = outlines.build();
    common.head = Head {
        index_to_loc_format: i16::from(format == LocaFormat::Long),
        ..common.head
    };
    common.build(|builder| {
        sfnt::add(builder, "glyf", &glyf)?;
        sfnt::add(builder, "loca", &loca)?;
        sfnt::add(builder, "gasp", &sfnt::gasp())?;
        builder.add_raw(Tag::new(b"prep"), PREP.to_vec());
        Ok(())
    })
}

fn extent(glyph: &Written) -> Option<Rect> {
    let b = glyph.bbox()?;
    let [x0, y0, x1, y1] = [b.x_min, b.y_min, b.x_max, b.y_max].map(f64::from);
    Some(Rect { x0, y0, x1, y1 })
}

/// Every glyph as the file holds it, in glyph-id order.
struct Glyphs<'a> {
    font: &'a Font,
    ids: BTreeMap<&'a str, usize>,
    written: Vec<Written>,
}

impl<'a> Glyphs<'a> {
    fn of(font: &'a Font) -> Result<Self, WriteError> {
        let ids = ids(font);
        let glyphs = || font.glyphs().iter();
        let alone = |g: &Glyph| {
            if is_composite(font, &ids, g) {
                return Ok(Written::Empty);
            }
            simple(font, g)
        };
        let simple: Vec<Written> = glyphs().map(alone).collect::<Result<_, _>>()?;
        let whole = |(g, s): (&Glyph, &Written)| {
            if is_composite(font, &ids, g) {
                return composite(g, &ids, &simple);
            }
            Ok(s.clone())
        };
        let written = glyphs().zip(&simple).map(whole).collect::<Result<_, _>>()?;
        Ok(Self { font, ids, written })
    }

    /// Counts that a rasteriser reserves memory by.
    fn maxp(&self) -> Result<Maxp, WriteError> {
        let mut max = [0_usize; 5];
        for (written, glyph) in self.written.iter().zip(self.font.glyphs()) {
            let size = |glyph: &Written| match glyph {
                Written::Simple(s) => {
                    let points = s.contours.iter().map(|c| c.len());
                    (points.sum::<usize>(), s.contours.len())
                }
                _ => (0, 0),
            };
            let counts = match written {
                Written::Empty => [0; 5],
                Written::Simple(_) => {
                    let (points, contours) = size(written);
                    [points, contours, 0, 0, 0]
                }
                Written::Composite(c) => {
                    let parts = glyph.components.iter();
                    let ids = parts.filter_map(|p| self.ids.get(p.base.as_str()));
                    let bases = ids.filter_map(|&id| self.written.get(id));
                    let sizes = bases.map(size);
                    let (points, contours) = sizes.fold((0, 0), |a, b| (a.0 + b.0, a.1 + b.1));
                    [0, 0, points, contours, c.components().len()]
                }
            };
            for (m, c) in max.iter_mut().zip(counts) {
                *m = (*m).max(c);
            }
        }
        let [
            points,
            contours,
            composite_points,
            composite_contours,
            parts,
        ] = max;
        Ok(Maxp {
            max_points: Some(count(points, "the number of points")?),
            max_contours: Some(count(contours, "the number of contours")?),
            max_composite_points: Some(count(composite_points, "the number of points")?),
            max_composite_contours: Some(count(composite_contours, "the number of contours")?),
            // no instructions but PREP, which needs one cell of the stack
            max_zones: Some(1),
            max_twilight_points: Some(0),
            max_storage: Some(0),
            max_function_defs: Some(0),
            max_instruction_defs: Some(0),
            max_stack_elements: Some(1),
            max_size_of_instructions: Some(0),
            max_component_elements: Some(count(parts, "the number of components")?),
            max_component_depth: Some(u16::from(parts > 0)),
            ..Maxp::new(count(self.written.len(), "the number of glyphs")?)
        })
    }
}

/// Whether a glyph can stand as references: only components, each of a glyph that has only contours,
/// placed by numbers that a file can hold.
fn is_composite(font: &Font, ids: &BTreeMap<&str, usize>, glyph: &Glyph) -> bool {
    let base = |p: &Component| font.glyphs().get(*ids.get(p.base.as_str())?);
    let fits = |p: &Component| {
        let [a, b, c, d, ..] = p.place.as_coeffs();
        [a, b, c, d].iter().all(|v| (-2.0..2.0).contains(v))
            && base(p).is_some_and(|g| g.components.is_empty() && !g.outline.is_empty())
    };
    glyph.outline.is_empty() && !glyph.components.is_empty() && glyph.components.iter().all(fits)
}

/// A glyph's contours, run the way TrueType fills them: outer ones clockwise.
fn simple(font: &Font, glyph: &Glyph) -> Result<Written, WriteError> {
    let shape = font.shape(glyph);
    if shape.is_empty() {
        return Ok(Written::Empty);
    }
    let mut path = BezPath::new();
    for contour in shape.contours() {
        path.extend(contour.reverse_subpaths());
    }
    if path
        .elements()
        .iter()
        .any(|el| matches!(el, PathEl::CurveTo(..)))
    {
        return Err(WriteError::Cubic(glyph.name.to_string()));
    }
    check(&path, glyph)?;
    SimpleGlyph::from_bezpath(&path)
        .map(Written::Simple)
        .map_err(|e| WriteError::table(&format!("glyf ({})", glyph.name), format!("{e:?}")))
}

fn composite(
    glyph: &Glyph,
    ids: &BTreeMap<&str, usize>,
    simple: &[Written],
) -> Result<Written, WriteError> {
    let mut whole: Option<CompositeGlyph> = None;
    for part in &glyph.components {
        let base = ids.get(part.base.as_str()).copied().unwrap_or_default();
        let Some(Written::Simple(shape)) = simple.get(base) else {
            continue;
        };
        let (component, bounds) = place(part, base, shape, glyph)?;
        match &mut whole {
            None => whole = Some(CompositeGlyph::new(component, bounds)),
            Some(w) => w.add_component(component, bounds),
        }
    }
    Ok(whole.map_or(Written::Empty, Written::Composite))
}

fn place(
    part: &Component,
    base: usize,
    shape: &SimpleGlyph,
    glyph: &Glyph,
) -> Result<(Part, Bbox), WriteError> {
    let what = || format!("a component of {}", glyph.name);
    let [a, b, c, d, x, y] = part.place.as_coeffs();
    let (x, y) = (to_i16(x, what)?, to_i16(y, what)?);
    let f = |v: f64| F2Dot14::from_f32(single(v));
    let transform = Transform {
        xx: f(a),
        yx: f(b),
        xy: f(c),
        yy: f(d),
    };
    let flags = ComponentFlags {
        round_xy_to_grid: true,
        ..ComponentFlags::default()
    };
    let id = GlyphId16::new(count(base, "a glyph id")?);
    // as the file says it
    let t = &transform;
    let [xx, yx, xy, yy] = [t.xx, t.yx, t.xy, t.yy].map(|v| f64::from(v.to_f32()));
    let map = Affine::new([xx, yx, xy, yy, f64::from(x), f64::from(y)]);
    let points = shape.contours.iter().flat_map(|c| c.iter());
    let points = points.map(|p| map * Point::new(f64::from(p.x), f64::from(p.y)));
    let bounds = points.map(|p| Rect::from_points(p, p));
    let r = bounds.reduce(|a, b| a.union(b)).unwrap_or(Rect::ZERO);
    let bbox = Bbox {
        x_min: to_i16(r.x0, what)?,
        y_min: to_i16(r.y0, what)?,
        x_max: to_i16(r.x1, what)?,
        y_max: to_i16(r.y1, what)?,
    };
    Ok((
        Part::new(id, Anchor::Offset { x, y }, transform, flags),
        bbox,
    ))
}
