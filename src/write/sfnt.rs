//! The tables that TrueType and CFF fonts share.

use super::numbers::{around, count, to_i16, to_u16};
use super::{WriteError, cmap, colour, layout, names, os2};
use crate::types::formats::EPOCH_1904;
use crate::types::{Font, Glyph, Info};
use kurbo::Rect;
use std::collections::BTreeMap;
use std::ops::Range;
use write_fonts::read::tables::post::Post as StoredPost;
use write_fonts::read::{FontData, FontRead, TopLevelTable};
use write_fonts::tables::gasp::{Gasp, GaspRange, GaspRangeBehavior};
use write_fonts::tables::head::{Flags, Head, MacStyle};
use write_fonts::tables::hhea::Hhea;
use write_fonts::tables::hmtx::{Hmtx, LongMetric};
use write_fonts::tables::maxp::Maxp;
use write_fonts::tables::os2::Os2;
use write_fonts::tables::post::Post;
use write_fonts::types::{FWord, Fixed, LongDateTime, Tag, UfWord, Version16Dot16};
use write_fonts::validate::Validate;
use write_fonts::{FontBuilder, FontWrite, dump_table};

/// A font file in the making: everything but the outlines.
pub(super) struct Common {
    pub(super) head: Head,
    pub(super) maxp: Maxp,
    pub(super) post: Post,
    builder: FontBuilder<'static>,
    carried: BTreeMap<[u8; 4], Vec<u8>>,
}

/// Builds the shared tables. `extents` holds each glyph's box as it stands in the file, whole units.
pub(super) fn common(font: &Font, extents: &[Option<Rect>]) -> Result<Common, WriteError> {
    let mut builder = FontBuilder::new();
    let advances = advances(font)?;
    add(&mut builder, "hmtx", &hmtx(font, &advances, extents)?)?;
    add(&mut builder, "hhea", &hhea(font, &advances, extents)?)?;
    let features = layout::compile(font)?;
    let (gsub, gpos) = (
        dumped("GSUB", &features.gsub)?,
        dumped("GPOS", &features.gpos)?,
    );
    let written = |tag, made| {
        font.carried
            .get(tag)
            .or(made)
            .map_or(&[][..], Vec::as_slice)
    };
    let context = layout::longest(
        written(b"GSUB", gsub.as_ref()),
        written(b"GPOS", gpos.as_ref()),
    );
    let os2 = Os2 {
        us_max_context: Some(context),
        ..os2::table(font, &advances, extents)?
    };
    add(&mut builder, "OS/2", &os2)?;
    add(&mut builder, "name", &names::table(&font.info)?)?;
    if !font.carried.contains_key(b"cmap") {
        add(&mut builder, "cmap", &cmap::table(font)?)?;
    }
    if let Some((colr, cpal)) = colour::tables(font)? {
        add(&mut builder, "COLR", &colr)?;
        add(&mut builder, "CPAL", &cpal)?;
    }
    for (tag, table) in [(b"GSUB", gsub), (b"GPOS", gpos)] {
        if let Some(table) = table {
            builder.add_raw(Tag::new(tag), table);
        }
    }
    if let Some(gdef) = &features.gdef {
        add(&mut builder, "GDEF", gdef)?;
    }
    Ok(Common {
        head: head(font, extents)?,
        maxp: Maxp::new(count(font.glyphs().len(), "the number of glyphs")?),
        post: post(font)?,
        builder,
        carried: font.carried.clone(),
    })
}

/// The bytes of a table that there may be.
fn dumped<T: FontWrite + Validate>(
    name: &str,
    table: &Option<T>,
) -> Result<Option<Vec<u8>>, WriteError> {
    let bytes = table.as_ref().map(dump_table).transpose();
    bytes.map_err(|e| WriteError::table(name, e))
}

/// Carried tables of which only a part is kept: what does not follow from the outlines.
const KEPT_IN_PART: [&[u8; 4]; 3] = [b"head", b"hhea", b"post"];

/// A table that came with the font, where it is a readable one.
fn carried<'a, T: FontRead<'a, Args = ()>>(font: &'a Font, tag: &[u8; 4]) -> Option<T> {
    T::read(FontData::new(font.carried.get(tag)?)).ok()
}

impl Common {
    /// The file, once the writer has set what it alone knows and added its outlines.
    pub(super) fn build(
        mut self,
        outlines: impl FnOnce(&mut FontBuilder<'static>) -> Result<(), WriteError>,
    ) -> Result<Vec<u8>, WriteError> {
        let mut head = dump_table(&self.head).map_err(|e| WriteError::table("head", e))?;
        if let Some(own) = self.carried.get(b"head") {
            keep_unnamed(&mut head, own);
        }
        self.builder.add_raw(Head::TAG, head);
        add(&mut self.builder, "maxp", &self.maxp)?;
        add(&mut self.builder, "post", &self.post)?;
        outlines(&mut self.builder)?;
        let whole = |(tag, _): &([u8; 4], _)| !KEPT_IN_PART.contains(&tag);
        for (tag, table) in self.carried.into_iter().filter(whole) {
            self.builder.add_raw(Tag::new(&tag), table);
        }
        Ok(self.builder.build())
    }
}

/// Keeps the flags of a `head` table that the library has no names for and leaves out: bits 5 to 10, those of Apple's
/// layout.
fn keep_unnamed(head: &mut [u8], own: &[u8]) {
    const FLAGS: Range<usize> = 16..18;
    const UNNAMED: u16 = 0b0000_0111_1110_0000;
    if let (Some(to), Some(from)) = (head.get_mut(FLAGS), own.get(FLAGS)) {
        let bits = UNNAMED.to_be_bytes();
        for ((to, from), bits) in to.iter_mut().zip(from).zip(bits) {
            *to |= from & bits;
        }
    }
}

/// Adds a table and names it in the error.
pub(super) fn add<T>(builder: &mut FontBuilder<'_>, name: &str, table: &T) -> Result<(), WriteError>
where
    T: FontWrite + Validate + TopLevelTable,
{
    builder
        .add_table(table)
        .map_err(|e| WriteError::table(name, e))?;
    Ok(())
}

fn advances(font: &Font) -> Result<Vec<u16>, WriteError> {
    let advance = |g: &Glyph| to_u16(g.advance, || format!("the advance of {}", g.name));
    font.glyphs().iter().map(advance).collect()
}

fn hmtx(font: &Font, advances: &[u16], extents: &[Option<Rect>]) -> Result<Hmtx, WriteError> {
    let mut metrics = Vec::with_capacity(advances.len());
    for ((glyph, &advance), extent) in font.glyphs().iter().zip(advances).zip(extents) {
        // programs place the outline so that its xMin falls on the bearing: they must agree
        let left = extent.map_or(0.0, |r| r.x0);
        let bearing = to_i16(left, || format!("the left sidebearing of {}", glyph.name))?;
        metrics.push(LongMetric::new(advance, bearing));
    }
    let rest = metrics.split_off(stored(advances)).into_iter();
    Ok(Hmtx::new(metrics, rest.map(|m| m.side_bearing).collect()))
}

/// How many of the advances are stored: a run of equal ones at the end is stored once.
fn stored(advances: &[u16]) -> usize {
    let last = advances.last();
    let tail = advances.iter().rev().take_while(|a| Some(*a) == last);
    advances.len() + 1 - tail.count().max(1)
}

fn hhea(font: &Font, advances: &[u16], extents: &[Option<Rect>]) -> Result<Hhea, WriteError> {
    let inked: Vec<(f64, Rect)> = advances
        .iter()
        .zip(extents)
        .filter_map(|(&a, e)| e.map(|r| (f64::from(a), r)))
        .collect();
    let least =
        |f: &dyn Fn(&(f64, Rect)) -> f64| inked.iter().map(f).reduce(f64::min).unwrap_or(0.0);
    let word = |v: f64, what: &str| to_i16(v, || what.to_owned()).map(FWord::new);
    let own = match carried(font, b"hhea") {
        Some(own) => own,
        None => line(&font.info)?,
    };
    Ok(Hhea {
        advance_width_max: UfWord::new(advances.iter().copied().max().unwrap_or(0)),
        min_left_side_bearing: word(least(&|(_, r)| r.x0), "a left sidebearing")?,
        min_right_side_bearing: word(least(&|(a, r)| a - r.x1), "a right sidebearing")?,
        x_max_extent: word(-least(&|(_, r)| -r.x1), "the right edge of a glyph")?,
        number_of_h_metrics: count(stored(advances), "the number of advances")?,
        ..own
    })
}

/// Ascender, descender and gap of a line in the `hhea` that came with a font.
pub(super) fn line_heights(font: &Font) -> Option<[i16; 3]> {
    let own: Hhea = carried(font, b"hhea")?;
    Some([own.ascender, own.descender, own.line_gap].map(FWord::to_i16))
}

/// What a font says of its lines: their heights, and the slope of the text cursor.
fn line(info: &Info) -> Result<Hhea, WriteError> {
    let word = |v: f64, what: &str| to_i16(v, || what.to_owned()).map(FWord::new);
    let (m, slope) = (info.metrics, caret_slope(info.italic_angle)?);
    Ok(Hhea {
        ascender: word(m.ascender, "the ascender")?,
        descender: word(m.descender, "the descender")?,
        line_gap: word(m.line_gap, "the line gap")?,
        caret_slope_rise: slope.0,
        caret_slope_run: slope.1,
        ..Hhea::default()
    })
}

/// Rise and run of the text cursor.
fn caret_slope(italic_angle: f64) -> Result<(i16, i16), WriteError> {
    if italic_angle.abs() < 0.01 {
        return Ok((1, 0));
    }
    let run = libm::tan((-italic_angle).to_radians()) * 1000.0;
    Ok((1000, to_i16(run, || "the italic angle's slope".to_owned())?))
}

fn head(font: &Font, extents: &[Option<Rect>]) -> Result<Head, WriteError> {
    let all = around(extents);
    let edge = |v: f64| to_i16(v, || "the edge of a glyph".to_owned());
    let own = carried(font, b"head").unwrap_or_else(|| description(&font.info));
    let instructed =
        Flags::INSTRUCTIONS_MAY_DEPEND_ON_POINT_SIZE | Flags::INSTRUCTIONS_MAY_ALTER_ADVANCE_WIDTH;
    Ok(Head {
        checksum_adjustment: 0,
        flags: own.flags.difference(instructed) | Flags::LSB_AT_X_0,
        units_per_em: font.info.units_per_em,
        x_min: edge(all.x0)?,
        y_min: edge(all.y0)?,
        x_max: edge(all.x1)?,
        y_max: edge(all.y1)?,
        ..own
    })
}

/// What a font says of its date, version and style.
fn description(info: &Info) -> Head {
    let style = info.linked_style();
    let when = |set: bool, flag| if set { flag } else { MacStyle::empty() };
    let created = LongDateTime::new(info.created.saturating_add(EPOCH_1904));
    Head {
        font_revision: Fixed::from_f64(info.version_text().parse().unwrap_or_default()),
        flags: Flags::BASELINE_AT_Y_0,
        created,
        modified: created,
        mac_style: when(style.is_bold, MacStyle::BOLD) | when(style.is_italic, MacStyle::ITALIC),
        lowest_rec_ppem: 6,
        ..Head::default()
    }
}

/// A table of names numbers them from behind the 258 of every Macintosh font, in 16 bits.
const NAMED: usize = (1 << 16) - 258;

/// Height of the underline's upper edge and the line's thickness, font units.
pub(super) fn underline(font: &Font) -> (f64, f64) {
    let own = carried::<StoredPost<'_>>(font, b"post");
    let own = own.map(|own| (own.underline_position(), own.underline_thickness()));
    let units = |v: FWord| f64::from(v.to_i16());
    own.map_or_else(
        || font.info.underline(),
        |(height, thick)| (units(height), units(thick)),
    )
}

fn post(font: &Font) -> Result<Post, WriteError> {
    let names = || font.glyphs().iter().map(|g| g.name.as_str());
    let names = if font.glyphs().len() <= NAMED {
        Post::new_v2(names())
    } else {
        Post {
            version: Version16Dot16::VERSION_3_0,
            ..Post::default()
        }
    };
    let word = |v: f64| to_i16(v, || "the underline".to_owned()).map(FWord::new);
    let underline = underline(font);
    let names = Post {
        underline_position: word(underline.0)?,
        underline_thickness: word(underline.1)?,
        ..names
    };
    Ok(match carried::<StoredPost<'_>>(font, b"post") {
        Some(own) => Post {
            italic_angle: own.italic_angle(),
            is_fixed_pitch: own.is_fixed_pitch(),
            ..names
        },
        None => Post {
            italic_angle: Fixed::from_f64(font.info.italic_angle),
            ..names
        },
    })
}

/// Smooth at every size, fitted to the grid at none: what an unhinted font asks of a rasteriser.
pub(super) fn gasp() -> Gasp {
    let all = GaspRangeBehavior::GASP_GRIDFIT
        | GaspRangeBehavior::GASP_DOGRAY
        | GaspRangeBehavior::GASP_SYMMETRIC_GRIDFIT
        | GaspRangeBehavior::GASP_SYMMETRIC_SMOOTHING;
    Gasp::new(1, 1, vec![GaspRange::new(u16::MAX, all)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::types::{Info, Name};

    #[test]
    fn names_beyond_sixteen_bits_are_left_out() {
        let font = |count: usize| {
            let more = (1..count).map(|i| Name::new(format!("g{i}")).unwrap());
            let names = std::iter::once(Name::notdef()).chain(more);
            let glyphs = names.map(|name| Glyph::new(name, Vec::new(), 0.0));
            Font::new(Info::default(), glyphs.collect()).unwrap()
        };
        let version = |count: usize| post(&font(count)).unwrap().version;
        assert_eq!(version(NAMED), Version16Dot16::VERSION_2_0);
        assert_eq!(version(usize::from(u16::MAX)), Version16Dot16::VERSION_3_0);
    }
}
