//! The OS/2 table: weight, heights, and the blocks and code pages that the font covers.

use super::WriteError;
use super::numbers::{around, to_i16, to_u16};
use crate::types::{Font, Info};
use kurbo::Rect;
use std::collections::BTreeSet;
use write_fonts::read::{FontData, FontRead};
use write_fonts::tables::os2::{Os2, SelectionFlags};
use write_fonts::types::Tag;

/// First and last character of a block and its bit in ulUnicodeRange, for the scripts and signs that
/// a drawn font can hold. Where blocks share a bit each has its row.
const RANGES: &[(u32, u32, u32)] = &[
    (0x0000, 0x007F, 0),
    (0x0080, 0x00FF, 1),
    (0x0100, 0x017F, 2),
    (0x0180, 0x024F, 3),
    (0x0250, 0x02AF, 4),
    (0x1D00, 0x1DBF, 4),
    (0x02B0, 0x02FF, 5),
    (0xA700, 0xA71F, 5),
    (0x0300, 0x036F, 6),
    (0x1DC0, 0x1DFF, 6),
    (0x0370, 0x03FF, 7),
    (0x2C80, 0x2CFF, 8),
    (0x0400, 0x052F, 9),
    (0x2DE0, 0x2DFF, 9),
    (0xA640, 0xA69F, 9),
    (0x0530, 0x058F, 10),
    (0x0590, 0x05FF, 11),
    (0x0600, 0x06FF, 13),
    (0x0750, 0x077F, 13),
    (0x07C0, 0x07FF, 14),
    (0x0900, 0x097F, 15),
    (0x0E00, 0x0E7F, 24),
    (0x10A0, 0x10FF, 26),
    (0x2D00, 0x2D2F, 26),
    (0x1E00, 0x1EFF, 29),
    (0x2C60, 0x2C7F, 29),
    (0xA720, 0xA7FF, 29),
    (0x1F00, 0x1FFF, 30),
    (0x2000, 0x206F, 31),
    (0x2E00, 0x2E7F, 31),
    (0x2070, 0x209F, 32),
    (0x20A0, 0x20CF, 33),
    (0x20D0, 0x20FF, 34),
    (0x2100, 0x214F, 35),
    (0x2150, 0x218F, 36),
    (0x2190, 0x21FF, 37),
    (0x27F0, 0x27FF, 37),
    (0x2900, 0x297F, 37),
    (0x2B00, 0x2BFF, 37),
    (0x2200, 0x22FF, 38),
    (0x27C0, 0x27EF, 38),
    (0x2980, 0x2AFF, 38),
    (0x2300, 0x23FF, 39),
    (0x2460, 0x24FF, 42),
    (0x2500, 0x257F, 43),
    (0x2580, 0x259F, 44),
    (0x25A0, 0x25FF, 45),
    (0x2600, 0x26FF, 46),
    (0x2700, 0x27BF, 47),
    (0x3000, 0x303F, 48),
    (0x0700, 0x074F, 71),
    (0x0780, 0x07BF, 72),
    (0xE000, 0xF8FF, 60),
    (0xFB00, 0xFB4F, 62),
    (0xFB50, 0xFDFF, 63),
    (0xFE20, 0xFE2F, 64),
    (0xFE70, 0xFEFF, 67),
    (0xFFF0, 0xFFFF, 69),
    (0x10000, 0x10_FFFF, 57),
];

/// Characters of which a font for a code page has one that others lack, and the page's bit in ulCodePageRange1. Of
/// Western languages þ alone is in no other page, but it cannot be composed.
const CODE_PAGES: &[(char, u32)] = &[
    ('\u{de}', 0),
    ('\u{d1}', 0),
    ('\u{13d}', 1),
    ('\u{411}', 2),
    ('\u{386}', 3),
    ('\u{130}', 4),
    ('\u{5d0}', 5),
    ('\u{631}', 6),
    ('\u{157}', 7),
    ('\u{20ab}', 8),
];

/// Sub- and superscripts: size, then rise, parts of the em; what most text fonts have.
const SCRIPT_SIZE: (f64, f64) = (0.65, 0.6);
const SUBSCRIPT_DROP: f64 = 0.075;
const SUPERSCRIPT_RISE: f64 = 0.35;

/// The table that came with the font, where it did.
pub(super) fn carried(font: &Font) -> Option<Os2> {
    let table = font.carried.get(b"OS/2")?;
    Os2::read(FontData::new(table)).ok()
}

/// The table.
pub(super) fn table(
    font: &Font,
    advances: &[u16],
    extents: &[Option<Rect>],
) -> Result<Os2, WriteError> {
    let info = &font.info;
    let em = f64::from(info.units_per_em);
    let part = |share: f64| to_i16(share * em, || "a part of the em".to_owned());
    let m = info.metrics;
    let height = |v: f64, what: &str| to_i16(v, || what.to_owned());
    let strikeout = info.strikeout();
    let all = around(extents);
    let chars: BTreeSet<char> = font
        .glyphs()
        .iter()
        .flat_map(|g| g.codepoints.clone())
        .collect();
    let ranges = unicode_ranges(&chars);
    let edge = |c: Option<&char>| c.map_or(0, |&c| u16::try_from(u32::from(c)).unwrap_or(u16::MAX));
    Ok(Os2 {
        x_avg_char_width: average(advances),
        us_weight_class: info.weight,
        y_subscript_x_size: part(SCRIPT_SIZE.0)?,
        y_subscript_y_size: part(SCRIPT_SIZE.1)?,
        y_subscript_y_offset: part(SUBSCRIPT_DROP)?,
        y_superscript_x_size: part(SCRIPT_SIZE.0)?,
        y_superscript_y_size: part(SCRIPT_SIZE.1)?,
        y_superscript_y_offset: part(SUPERSCRIPT_RISE)?,
        y_strikeout_size: height(strikeout.1, "the strikeout")?,
        y_strikeout_position: height(strikeout.0, "the strikeout")?,
        ul_unicode_range_1: ranges[0],
        ul_unicode_range_2: ranges[1],
        ul_unicode_range_3: ranges[2],
        ul_unicode_range_4: ranges[3],
        ach_vend_id: Tag::new(&info.vendor_id),
        fs_selection: selection(info),
        us_first_char_index: edge(chars.first()),
        us_last_char_index: edge(chars.last()),
        s_typo_ascender: height(m.ascender, "the ascender")?,
        s_typo_descender: height(m.descender, "the descender")?,
        s_typo_line_gap: height(m.line_gap, "the line gap")?,
        us_win_ascent: to_u16(m.ascender.max(all.y1).max(0.0), || "the ascent".to_owned())?,
        us_win_descent: to_u16(-m.descender.min(all.y0).min(0.0), || {
            "the descent".to_owned()
        })?,
        ul_code_page_range_1: Some(code_pages(&chars)),
        ul_code_page_range_2: Some(0),
        sx_height: Some(height(m.x_height, "the x-height")?),
        s_cap_height: Some(height(m.cap_height, "the cap height")?),
        us_default_char: Some(0),
        us_break_char: Some(32),
        ..Os2::default()
    })
}

/// Mean of the advances that are not zero.
fn average(advances: &[u16]) -> i16 {
    let wide = advances.iter().filter(|a| **a > 0).map(|a| usize::from(*a));
    let count = wide.clone().count().max(1);
    let mean = (wide.sum::<usize>() + count / 2) / count;
    i16::try_from(mean).unwrap_or(i16::MAX)
}

fn selection(info: &Info) -> SelectionFlags {
    let style = info.linked_style();
    let when = |set: bool, flag| if set { flag } else { SelectionFlags::empty() };
    SelectionFlags::USE_TYPO_METRICS
        | when(style.is_bold, SelectionFlags::BOLD)
        | when(style.is_italic, SelectionFlags::ITALIC)
        | when(!style.is_bold && !style.is_italic, SelectionFlags::REGULAR)
}

fn unicode_ranges(chars: &BTreeSet<char>) -> [u32; 4] {
    let mut words = [0; 4];
    let codes: Vec<u32> = chars.iter().map(|&c| u32::from(c)).collect();
    for &(first, last, bit) in RANGES {
        if codes.iter().any(|c| (first..=last).contains(c)) {
            for (word, start) in words.iter_mut().zip((0..).step_by(32)) {
                if (start..start + 32).contains(&bit) {
                    *word |= 1 << (bit - start);
                }
            }
        }
    }
    words
}

/// The code pages of which the font has the telling character; Latin 1 where it has none of them.
fn code_pages(chars: &BTreeSet<char>) -> u32 {
    let bits = CODE_PAGES
        .iter()
        .filter(|(c, _)| chars.contains(c))
        .fold(0, |w, (_, b)| w | 1 << b);
    if bits == 0 { 1 } else { bits }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_in_order_of_no_overlap() {
        let mut sorted = RANGES.to_vec();
        sorted.sort_unstable();
        for pair in sorted.windows(2) {
            assert!(pair[0].1 < pair[1].0, "{pair:x?}");
        }
    }

    #[test]
    fn bits() {
        let chars = BTreeSet::from(['a', '\u{628}']);
        assert_eq!(unicode_ranges(&chars), [1 | 1 << 13, 0, 0, 0]);
        assert_eq!(code_pages(&BTreeSet::from(['\u{631}'])), 1 << 6);
        assert_eq!(code_pages(&BTreeSet::new()), 1);
        // what is composed of letters and accents has no þ
        assert_eq!(code_pages(&BTreeSet::from(['Ñ', 'Ľ'])), 1 | 1 << 1);
        assert_eq!(average(&[0, 100, 201]), 151);
    }
}
