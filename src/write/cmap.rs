//! The characters of a font: `cmap`.

use super::WriteError;
use crate::types::Font;
use write_fonts::tables::cmap::{
    Cmap, CmapSubtable, EncodingRecord, PlatformId, SequentialMapGroup,
};
use write_fonts::types::GlyphId;

/// Bytes that a table of format 4, which counts its own in 16 bits, may come to: what is reckoned here can be a little
/// less than what the library makes of it.
const MOST: usize = 60_000;
/// Bytes of a segment of such a table, and of a glyph that is named by itself in one.
const SEGMENT: usize = 8;
const ALONE: usize = 2;

/// Characters that are reckoned together, however many follow each other.
const ROW: usize = 1024;

/// The glyph of each character. Where a table of format 4 cannot hold all of the Basic Multilingual Plane, it has the
/// first of them, for programs that read no other, and one of format 12 has all.
pub(super) fn table(font: &Font) -> Result<Cmap, WriteError> {
    let ids = (0..).map(GlyphId::new);
    let glyphs = font.glyphs().iter().zip(ids);
    let pairs = glyphs.flat_map(|(g, id)| g.codepoints.iter().map(move |&c| (c, id)));
    let mut pairs: Vec<(char, GlyphId)> = pairs.collect();
    pairs.sort_unstable();
    let held = held(&pairs);
    let most = if held < pairs.partition_point(|(c, _)| *c <= '\u{FFFF}') {
        &pairs[..held]
    } else {
        &pairs
    };
    let mut cmap = Cmap::from_mappings(most.to_vec()).map_err(|e| WriteError::table("cmap", e))?;
    if most.len() < pairs.len() {
        const FULL: [(PlatformId, u16); 2] = [(PlatformId::Unicode, 4), (PlatformId::Windows, 10)];
        let all = CmapSubtable::format_12(0, runs(&pairs));
        let records =
            FULL.map(|(platform, encoding)| EncodingRecord::new(platform, encoding, all.clone()));
        cmap.encoding_records.extend(records);
        let key = |r: &EncodingRecord| (r.platform_id, r.encoding_id);
        cmap.encoding_records.sort_by_key(key);
    }
    Ok(cmap)
}

/// Whether a character and its glyph are those that follow others.
fn follows((c, id): (char, GlyphId), (next, after): (char, GlyphId)) -> bool {
    u32::from(c) + 1 == u32::from(next) && id.to_u32() + 1 == after.to_u32()
}

/// How many of the characters, sorted, a table of format 4 holds.
fn held(pairs: &[(char, GlyphId)]) -> usize {
    let (mut bytes, mut count) = (0, 0);
    // characters that follow each other are segments by their glyphs, or one that names each
    let rows = pairs.chunk_by(|a, b| u32::from(a.0) + 1 == u32::from(b.0));
    for row in rows.flat_map(|row| row.chunks(ROW)) {
        let segments = row.chunk_by(|a, b| follows(*a, *b)).count();
        bytes += (SEGMENT * segments).min(SEGMENT + ALONE * row.len());
        if bytes > MOST {
            break;
        }
        count += row.len();
    }
    count
}

/// Characters that follow each other as their glyphs do.
fn runs(pairs: &[(char, GlyphId)]) -> Vec<SequentialMapGroup> {
    let runs = pairs.chunk_by(|a, b| follows(*a, *b));
    let group = |run: &[(char, GlyphId)]| {
        let ((first, id), (last, _)) = run.first().zip(run.last())?;
        Some(SequentialMapGroup::new(
            u32::from(*first),
            u32::from(*last),
            id.to_u32(),
        ))
    };
    runs.filter_map(group).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::types::{Glyph, Info, Name};
    use write_fonts::dump_table;
    use write_fonts::read::tables::cmap as stored;
    use write_fonts::read::{FontData, FontRead};

    /// The glyph of each character, by the subtable of all characters where there is one, and how many the other has.
    fn read(codes: &[u32]) -> (Vec<Option<u32>>, usize) {
        let chars: Vec<char> = codes.iter().filter_map(|c| char::from_u32(*c)).collect();
        let glyph =
            |(i, c): (usize, &char)| Glyph::new(Name::new(format!("g{i}")).unwrap(), vec![*c], 0.0);
        let glyphs = std::iter::once(Glyph::new(Name::notdef(), Vec::new(), 0.0));
        let font = Font::new(
            Info::default(),
            glyphs.chain(chars.iter().enumerate().map(glyph)).collect(),
        );
        let bytes = dump_table(&table(&font.unwrap()).unwrap()).unwrap();
        let cmap = stored::Cmap::read(FontData::new(&bytes)).unwrap();
        let low = cmap.encoding_records()[0]
            .subtable(cmap.offset_data())
            .unwrap();
        let of_low = |c: char| match &low {
            stored::CmapSubtable::Format4(table) => table.map_codepoint(c),
            _ => None,
        };
        let all = chars
            .iter()
            .map(|c| cmap.map_codepoint(*c).map(GlyphId::to_u32));
        (
            all.collect(),
            chars.iter().filter(|c| of_low(**c).is_some()).count(),
        )
    }

    #[test]
    fn more_characters_than_format_4_counts_are_all_found() {
        // with gaps between all; 20,000 that follow each other by glyphs that do not fit in one segment either
        let apart: Vec<u32> = (0..9000).map(|i| 0x3400 + 2 * i).collect();
        let (found, low) = read(&apart);
        assert!(
            (1..=9000).eq(found.iter().filter_map(|id| *id)),
            "{found:?}"
        );
        assert!((7000..9000).contains(&low), "{low}");
        let mut mixed: Vec<u32> = (0x4E00..0x9C00).collect();
        mixed.sort_by_key(|c| c.wrapping_mul(2_654_435_761));
        let (found, low) = read(&mixed);
        assert!(found.iter().all(Option::is_some));
        assert_eq!(low, mixed.len(), "one table holds them");
    }
}
