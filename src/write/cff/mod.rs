//! The `CFF ` table: cubic outlines as Type 2 charstrings, in one font without subroutines.
//!
//! Layout: header, Name INDEX, Top DICT INDEX, String INDEX, empty Global Subr INDEX, charset,
//! `CharStrings` INDEX, Private DICT. Terms are those of Adobe's Technical Notes 5176 and 5177.

mod charstring;
mod dict;
mod widths;

use super::WriteError;
use super::numbers::count;
use crate::types::Font;
use dict::{Dict, index};
use kurbo::{BezPath, Rect};
use read_fonts::ps::string::STANDARD_STRINGS;
use std::collections::BTreeMap;
use write_fonts::tables::post::Post;

// Operators of the Top DICT.
const NOTICE: u16 = 1;
const FULL_NAME: u16 = 2;
const FAMILY_NAME: u16 = 3;
const WEIGHT: u16 = 4;
const FONT_BBOX: u16 = 5;
const CHARSET: u16 = 15;
const CHAR_STRINGS: u16 = 17;
const PRIVATE: u16 = 18;
const VERSION: u16 = 0;
const IS_FIXED_PITCH: u16 = 0x0C01;
const ITALIC_ANGLE: u16 = 0x0C02;
const UNDERLINE_POSITION: u16 = 0x0C03;
const UNDERLINE_THICKNESS: u16 = 0x0C04;
const FONT_MATRIX: u16 = 0x0C07;
// Operators of the Private DICT.
const DEFAULT_WIDTH: u16 = 20;
const NOMINAL_WIDTH: u16 = 21;

/// Glyph count up to which the predefined charset can serve: its last string is number 228.
const ISO_ADOBE_LAST: usize = 228;

/// The table: `shapes` and `advances` in glyph-id order, `bounds` around all of them; `post` says of the underline
/// and the pitch what this table says again.
pub(super) fn table(
    font: &Font,
    post: &Post,
    (shapes, advances): (&[BezPath], &[i32]),
    bounds: Rect,
) -> Result<Vec<u8>, WriteError> {
    let mut strings = Strings::default();
    let charset = charset(font, &mut strings)?;
    let mut top = Dict::default();
    describe(font, &mut top, &mut strings)?;
    repeat(post, &mut top);
    top.numbers(FONT_BBOX, &[bounds.x0, bounds.y0, bounds.x1, bounds.y1]);
    let widths = widths::choose(advances);
    let mut private = Dict::default();
    private.integer_unless(DEFAULT_WIDTH, widths.default, 0);
    private.integer_unless(NOMINAL_WIDTH, widths.nominal, 0);
    let glyphs: Vec<Vec<u8>> = shapes
        .iter()
        .zip(advances)
        .map(|(shape, &advance)| charstring::encode(shape, widths.operand(advance)))
        .collect();
    let names = index(&[font.info.postscript_name().into_bytes()])?;
    let tail = Tail {
        strings: index(&strings.bytes())?,
        charset,
        char_strings: index(&glyphs)?,
        private: private.0,
    };
    tail.assemble(&names, &top)
}

/// Everything behind the Top DICT, which holds the offsets of three of them.
struct Tail {
    strings: Vec<u8>,
    charset: Vec<u8>,
    char_strings: Vec<u8>,
    private: Vec<u8>,
}

impl Tail {
    /// The table. The Top DICT's length depends on the offsets it holds, and these on its length:
    /// begun too short, both grow together until they agree.
    fn assemble(&self, names: &[u8], top: &Dict) -> Result<Vec<u8>, WriteError> {
        const HEADER: [u8; 4] = [1, 0, 4, 4];
        let no_subrs = index(&[])?;
        let mut dict = top.0.clone();
        loop {
            let tops = index(std::slice::from_ref(&dict))?;
            let before =
                HEADER.len() + names.len() + tops.len() + self.strings.len() + no_subrs.len();
            let glyphs_at = before + self.charset.len();
            let private_at = glyphs_at + self.char_strings.len();
            let mut next = top.clone();
            if !self.charset.is_empty() {
                next.offsets(CHARSET, &[before])?;
            }
            next.offsets(CHAR_STRINGS, &[glyphs_at])?;
            next.offsets(PRIVATE, &[self.private.len(), private_at])?;
            if next.0.len() == dict.len() {
                let (tops, glyphs) = (index(&[next.0])?, &self.char_strings);
                let front = [
                    &HEADER,
                    names,
                    &tops,
                    &self.strings,
                    &no_subrs,
                    &self.charset,
                ];
                return Ok([front.concat(), glyphs.clone(), self.private.clone()].concat());
            }
            dict = next.0;
        }
    }
}

/// Strings beyond the standard ones, in order of first use.
#[derive(Default)]
struct Strings {
    ids: BTreeMap<String, usize>,
}

impl Strings {
    /// The string's number (SID).
    fn id(&mut self, text: &str) -> usize {
        if let Some(standard) = STANDARD_STRINGS.iter().position(|s| *s == text) {
            return standard;
        }
        let next = STANDARD_STRINGS.len() + self.ids.len();
        *self.ids.entry(text.to_owned()).or_insert(next)
    }

    fn bytes(&self) -> Vec<Vec<u8>> {
        let mut by_id: Vec<(&usize, &String)> = self.ids.iter().map(|(s, i)| (i, s)).collect();
        by_id.sort_unstable();
        by_id
            .into_iter()
            .map(|(_, s)| s.clone().into_bytes())
            .collect()
    }
}

/// Texts, slope and em of the font.
fn describe(font: &Font, top: &mut Dict, strings: &mut Strings) -> Result<(), WriteError> {
    let info = &font.info;
    let full = format!("{} {}", info.family, info.style);
    let texts = [
        (VERSION, Some(info.version_text())),
        (NOTICE, info.copyright.clone()),
        (FULL_NAME, Some(full)),
        (FAMILY_NAME, Some(info.family.clone())),
        (WEIGHT, Some(info.style.clone())),
    ];
    for (operator, text) in texts {
        // these are old 8-bit fields: what is not ASCII stands in the name table alone
        if let Some(text) = text.filter(|t| !t.is_empty() && t.is_ascii()) {
            let id = strings.id(&text);
            top.integer(operator, i32::from(count(id, "the number of strings")?));
        }
    }
    if info.italic_angle.abs() > 0.0 {
        top.numbers(ITALIC_ANGLE, &[info.italic_angle]);
    }
    if info.units_per_em != 1000 {
        let scale = 1.0 / f64::from(info.units_per_em);
        top.numbers(FONT_MATRIX, &[scale, 0.0, 0.0, scale, 0.0, 0.0]);
    }
    Ok(())
}

/// What `post` says, too. Its underline is told by the line's top, this one's by its middle (OpenType, `post`).
fn repeat(post: &Post, top: &mut Dict) {
    let pitch = i32::from(post.is_fixed_pitch != 0);
    top.integer_unless(IS_FIXED_PITCH, pitch, 0);
    let thickness = f64::from(post.underline_thickness.to_i16());
    let middle = f64::from(post.underline_position.to_i16()) - thickness / 2.0;
    for (operator, value, assumed) in [
        (UNDERLINE_POSITION, middle, -100.0),
        (UNDERLINE_THICKNESS, thickness, 50.0),
    ] {
        if (value - assumed).abs() > 0.0 {
            top.numbers(operator, &[value]);
        }
    }
}

/// The glyphs' string numbers in the shortest of the formats; empty for the predefined `ISOAdobe` set.
fn charset(font: &Font, strings: &mut Strings) -> Result<Vec<u8>, WriteError> {
    let ids: Vec<u16> = font
        .glyphs()
        .iter()
        .skip(1)
        .map(|g| count(strings.id(g.name.as_str()), "the number of glyph names"))
        .collect::<Result<_, _>>()?;
    if ids.len() <= ISO_ADOBE_LAST && ids.iter().zip(1..).all(|(&id, n)| id == n) {
        return Ok(Vec::new());
    }
    let mut runs: Vec<(u16, u16)> = Vec::new();
    for &id in &ids {
        match runs.last_mut() {
            Some((first, left)) if u32::from(*first) + u32::from(*left) + 1 == u32::from(id) => {
                *left += 1
            }
            _ => runs.push((id, 0)),
        }
    }
    let list = std::iter::once(0)
        .chain(ids.iter().flat_map(|id| id.to_be_bytes()))
        .collect();
    let short = runs.iter().flat_map(|&(first, left)| pieces(first, left));
    let short = std::iter::once(1).chain(short).collect();
    let long = runs
        .iter()
        .flat_map(|(first, left)| [first.to_be_bytes(), left.to_be_bytes()].concat());
    let long = std::iter::once(2).chain(long).collect();
    let all: [Vec<u8>; 3] = [list, short, long];
    Ok(all.into_iter().min_by_key(Vec::len).unwrap_or_default())
}

/// A run of string numbers as format 1 holds it: at most 256 a piece.
fn pieces(first: u16, left: u16) -> Vec<u8> {
    let mut out = Vec::new();
    let (mut first, mut left) = (first, left);
    loop {
        let now = left.min(255);
        out.extend(first.to_be_bytes());
        out.extend(now.to_be_bytes().last());
        if left == now {
            return out;
        }
        first += now + 1;
        left -= now + 1;
    }
}
