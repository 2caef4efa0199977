//! How many glyphs a font's features look at: `usMaxContext` of OS/2.

use write_fonts::read::tables::gpos::{Gpos, PositionLookup, PositionSubtables};
use write_fonts::read::tables::gsub::{
    Gsub, LigatureSubstFormat1, SubstitutionLookup, SubstitutionSubtables,
};
use write_fonts::read::tables::layout::{ChainedSequenceContext, SequenceContext};
use write_fonts::read::{FontData, FontRead};

/// The longest run of glyphs, from the first that changes to the last that is looked at, in these tables; what cannot
/// be read counts nothing. Marks and cursive joins count nothing either, as in other compilers: the specification
/// names pairs, ligatures and contexts.
pub(in crate::write) fn longest(gsub: &[u8], gpos: &[u8]) -> u16 {
    let substitutions = || {
        let table = Gsub::read(FontData::new(gsub)).ok()?;
        let lookups = table.lookup_list().ok()?.lookups();
        lookups
            .iter()
            .flatten()
            .filter_map(|l| substitution(&l))
            .max()
    };
    let positions = || {
        let table = Gpos::read(FontData::new(gpos)).ok()?;
        let lookups = table.lookup_list().ok()?.lookups();
        lookups.iter().flatten().filter_map(|l| position(&l)).max()
    };
    substitutions().max(positions()).unwrap_or(0)
}

fn substitution(lookup: &SubstitutionLookup<'_>) -> Option<u16> {
    use SubstitutionSubtables as S;
    match lookup.subtables().ok()? {
        S::Single(_) | S::Multiple(_) | S::Alternate(_) => Some(1),
        S::Ligature(all) => all.iter().flatten().filter_map(|s| ligature(&s)).max(),
        S::Contextual(all) => all.iter().flatten().filter_map(|s| context(&s)).max(),
        S::ChainContextual(all) => all.iter().flatten().filter_map(|s| chained(&s)).max(),
        S::Reverse(all) => {
            let ahead = all.iter().flatten().map(|s| s.lookahead_glyph_count());
            ahead.max().map(|n| n.saturating_add(1))
        }
        S::EmptyExtension => None,
    }
}

fn position(lookup: &PositionLookup<'_>) -> Option<u16> {
    use PositionSubtables as P;
    match lookup.subtables().ok()? {
        P::Single(_) => Some(1),
        P::Pair(_) => Some(2),
        P::Contextual(all) => all.iter().flatten().filter_map(|s| context(&s)).max(),
        P::ChainContextual(all) => all.iter().flatten().filter_map(|s| chained(&s)).max(),
        P::Cursive(_)
        | P::MarkToBase(_)
        | P::MarkToLig(_)
        | P::MarkToMark(_)
        | P::EmptyExtension => None,
    }
}

fn ligature(table: &LigatureSubstFormat1<'_>) -> Option<u16> {
    let sets = table.ligature_sets();
    let parts = sets.iter().flatten().filter_map(|s| {
        let all = s.ligatures();
        all.iter().flatten().map(|l| l.component_count()).max()
    });
    parts.max()
}

/// The longest of all rules of sets, by a `length`; the four kinds of both have no trait in common.
macro_rules! longest_rule {
    ($sets:expr, $rules:ident, $length:expr) => {{
        let sets = $sets;
        let longest = sets.iter().flatten().flatten().filter_map(|set| {
            let rules = set.$rules();
            rules.iter().flatten().map($length).max()
        });
        longest.max()
    }};
}

fn context(table: &SequenceContext<'_>) -> Option<u16> {
    match table {
        SequenceContext::Format1(t) => {
            longest_rule!(t.seq_rule_sets(), seq_rules, |r| r.glyph_count())
        }
        SequenceContext::Format2(t) => {
            longest_rule!(t.class_seq_rule_sets(), class_seq_rules, |r| r
                .glyph_count())
        }
        SequenceContext::Format3(t) => Some(t.glyph_count()),
    }
}

/// What lies behind the input counts not, what lies ahead does.
fn chained(table: &ChainedSequenceContext<'_>) -> Option<u16> {
    let both = u16::saturating_add;
    match table {
        ChainedSequenceContext::Format1(t) => {
            longest_rule!(t.chained_seq_rule_sets(), chained_seq_rules, |r| both(
                r.input_glyph_count(),
                r.lookahead_glyph_count()
            ))
        }
        ChainedSequenceContext::Format2(t) => {
            longest_rule!(
                t.chained_class_seq_rule_sets(),
                chained_class_seq_rules,
                |r| both(r.input_glyph_count(), r.lookahead_glyph_count())
            )
        }
        ChainedSequenceContext::Format3(t) => {
            Some(both(t.input_glyph_count(), t.lookahead_glyph_count()))
        }
    }
}
