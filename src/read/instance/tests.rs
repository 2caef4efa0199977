use super::{Tables, features, positions};
use skrifa::raw::{FontRead, FontRef, TableProvider};
use write_fonts::tables::gdef::{CaretValue, Gdef, LigCaretList, LigGlyph};
use write_fonts::tables::gpos::{
    AnchorTable, BaseArray, BaseRecord, Class1Record, Class2Record, ComponentRecord,
    CursivePosFormat1, EntryExitRecord, ExtensionPosFormat1, ExtensionSubtable, Gpos,
    LigatureArray, LigatureAttach, Mark2Array, Mark2Record, MarkArray, MarkBasePosFormat1,
    MarkLigPosFormat1, MarkMarkPosFormat1, MarkRecord, PairPos, PairSet, PairValueRecord,
    PositionLookup, PositionLookupList, SinglePos, ValueRecord,
};
use write_fonts::tables::gsub::Gsub;
use write_fonts::tables::layout::{
    ClassDef, Condition, ConditionSet, CoverageTable, DeviceOrVariationIndex, Feature, FeatureList,
    FeatureRecord, FeatureTableSubstitution, FeatureTableSubstitutionRecord,
    FeatureVariationRecord, FeatureVariations, Lookup, LookupFlag, ScriptList,
};
use write_fonts::tables::variations::{
    ItemVariationData, ItemVariationStore, RegionAxisCoordinates, VariationRegion,
    VariationRegionList,
};
use write_fonts::types::{F2Dot14, GlyphId16, Tag};
use write_fonts::{FontBuilder, dump_table};

/// What every number grows by at the end of the axis.
const GROWS: i8 = -40;

/// How numbers are written.
trait Numbers {
    fn value(&self, x: i16) -> ValueRecord;
    fn anchor(&self, x: i16, y: i16) -> AnchorTable;
    fn caret(&self, x: i16) -> CaretValue;
}

/// With what varies.
struct Varying;

/// As they are where all have grown by so much.
struct Grown(i16);

const INDEX: (u16, u16) = (0, 0);

impl Numbers for Varying {
    fn value(&self, x: i16) -> ValueRecord {
        ValueRecord::new()
            .with_x_placement(7)
            .with_x_advance(x)
            .with_x_advance_device(DeviceOrVariationIndex::variation_index(INDEX.0, INDEX.1))
    }

    fn anchor(&self, x: i16, y: i16) -> AnchorTable {
        let index = || Some(DeviceOrVariationIndex::variation_index(INDEX.0, INDEX.1));
        AnchorTable::format_3(x, y, index(), index())
    }

    fn caret(&self, x: i16) -> CaretValue {
        CaretValue::format_3(x, DeviceOrVariationIndex::variation_index(INDEX.0, INDEX.1))
    }
}

impl Numbers for Grown {
    fn value(&self, x: i16) -> ValueRecord {
        let format = Varying.value(x).format();
        ValueRecord::new()
            .with_x_placement(7)
            .with_x_advance(x + self.0)
            .with_explicit_value_format(format)
    }

    fn anchor(&self, x: i16, y: i16) -> AnchorTable {
        AnchorTable::format_1(x + self.0, y + self.0)
    }

    fn caret(&self, x: i16) -> CaretValue {
        CaretValue::format_1(x + self.0)
    }
}

fn cover(glyphs: &[u16]) -> CoverageTable {
    glyphs.iter().map(|g| GlyphId16::new(*g)).collect()
}

fn lookup<T: Default>(subtable: T) -> Lookup<T> {
    Lookup::new(LookupFlag::empty(), vec![subtable])
}

/// A lookup of each kind that has numbers.
fn gpos(n: &impl Numbers) -> Gpos {
    let second = GlyphId16::new(2);
    let pair = || PairSet::new(vec![PairValueRecord::new(second, n.value(10), n.value(0))]);
    let classes = || [(GlyphId16::new(1), 1)].into_iter().collect::<ClassDef>();
    let row = |x| Class1Record::new(vec![Class2Record::new(n.value(x), n.value(x + 1)); 2]);
    let marks = || {
        MarkArray::new(vec![
            MarkRecord::new(0, n.anchor(3, 4)),
            MarkRecord::new(1, n.anchor(5, 6)),
        ])
    };
    let two = || vec![Some(n.anchor(100, 500)), None];
    let (on, under) = (|| cover(&[5, 6]), || cover(&[1]));
    let lookups = vec![
        PositionLookup::Single(lookup(SinglePos::format_1(cover(&[1]), n.value(20)))),
        PositionLookup::Single(lookup(SinglePos::format_2(
            cover(&[1, 2]),
            vec![n.value(30), n.value(31)],
        ))),
        PositionLookup::Pair(lookup(PairPos::format_1(
            cover(&[1, 3]),
            vec![pair(), pair()],
        ))),
        PositionLookup::Extension(lookup(ExtensionSubtable::Pair(ExtensionPosFormat1::new(
            2,
            PairPos::format_2(cover(&[1]), classes(), classes(), vec![row(50), row(60)]),
        )))),
        PositionLookup::Cursive(lookup(CursivePosFormat1::new(
            cover(&[1]),
            vec![EntryExitRecord::new(Some(n.anchor(1, 2)), None)],
        ))),
        PositionLookup::MarkToBase(lookup(MarkBasePosFormat1::new(
            on(),
            under(),
            marks(),
            BaseArray::new(vec![BaseRecord::new(two())]),
        ))),
        PositionLookup::MarkToLig(lookup(MarkLigPosFormat1::new(
            on(),
            under(),
            marks(),
            LigatureArray::new(vec![LigatureAttach::new(vec![
                ComponentRecord::new(two()),
                ComponentRecord::new(two()),
            ])]),
        ))),
        PositionLookup::MarkToMark(lookup(MarkMarkPosFormat1::new(
            on(),
            under(),
            marks(),
            Mark2Array::new(vec![Mark2Record::new(two())]),
        ))),
    ];
    Gpos::new(
        ScriptList::default(),
        FeatureList::default(),
        PositionLookupList::new(lookups),
    )
}

fn gdef(n: &impl Numbers) -> Gdef {
    let carets = LigGlyph::new(vec![n.caret(300), n.caret(600)]);
    Gdef::new(
        None,
        None,
        Some(LigCaretList::new(cover(&[4]), vec![carets])),
        None,
    )
}

/// Tables that vary along one axis, as a font and as they are carried.
fn varying() -> (Vec<u8>, Tables) {
    let [zero, one] = [0.0, 1.0].map(F2Dot14::from_f32);
    let region = VariationRegion::new(vec![RegionAxisCoordinates::new(zero, one, one)]);
    let grows = ItemVariationData::new(1, 0, vec![0], GROWS.to_be_bytes().to_vec());
    let regions = VariationRegionList::new(1, vec![region]);
    let mut gdef = gdef(&Varying);
    gdef.item_var_store = ItemVariationStore::new(regions, vec![Some(grows)]).into();
    let tables = [
        (*b"GPOS", dump_table(&gpos(&Varying)).unwrap()),
        (*b"GDEF", dump_table(&gdef).unwrap()),
    ];
    let mut font = FontBuilder::new();
    for (tag, table) in &tables {
        font.add_raw(Tag::new(tag), table.clone());
    }
    (font.build(), tables.into_iter().collect())
}

#[test]
fn numbers_of_all_lookups_are_those_of_the_place() {
    let (font, tables) = varying();
    let font = FontRef::new(&font).unwrap();
    for (at, grown) in [(0.0, 0), (0.5, -20), (1.0, -40)] {
        let mut settled = tables.clone();
        positions::settle(&font, &[F2Dot14::from_f32(at)], &mut settled);
        let read = Gpos::read(settled[b"GPOS"].as_slice().into()).unwrap();
        let wanted = dump_table(&gpos(&Grown(grown))).unwrap();
        let wanted = Gpos::read(wanted.as_slice().into()).unwrap();
        assert_eq!(read, wanted, "{at}");
        let carets = Gdef::read(settled[b"GDEF"].as_slice().into())
            .unwrap()
            .lig_caret_list;
        let wanted = dump_table(&gdef(&Grown(grown))).unwrap();
        assert_eq!(
            carets,
            Gdef::read(wanted.as_slice().into()).unwrap().lig_caret_list,
            "{at}"
        );
        let again = settled.clone();
        positions::settle(&font, &[F2Dot14::from_f32(1.0)], &mut settled);
        assert_eq!(settled, again, "nothing varies any more");
    }
}

#[test]
fn no_damaged_table_ends_it() {
    let (font, tables) = varying();
    let font = FontRef::new(&font).unwrap();
    let at = [F2Dot14::from_f32(1.0)];
    for tag in [b"GPOS", b"GDEF"] {
        for i in 4..tables[tag].len() {
            for byte in [0, 1, 0x7f, 0xff] {
                let mut damaged = tables.clone();
                damaged.get_mut(tag).unwrap()[i] = byte;
                positions::settle(&font, &at, &mut damaged);
                damaged.get_mut(tag).unwrap().truncate(i);
                positions::settle(&font, &at, &mut damaged);
            }
        }
    }
}

/// A table of three features, whose first and last have other lookups in the axis' upper half.
fn changing() -> Vec<u8> {
    let feature = |tag: &[u8; 4], lookups: &[u16]| {
        FeatureRecord::new(Tag::new(tag), Feature::new(None, lookups.to_vec()))
    };
    let list = FeatureList::new(vec![
        feature(b"aalt", &[4]),
        feature(b"liga", &[5, 6]),
        feature(b"rvrn", &[]),
    ]);
    let mut gsub = Gsub::new(ScriptList::default(), list, Default::default());
    let [half, one] = [0.5, 1.0].map(F2Dot14::from_f32);
    let other = |k, lookups: &[u16]| {
        FeatureTableSubstitutionRecord::new(k, Feature::new(None, lookups.to_vec()))
    };
    let record = FeatureVariationRecord::new(
        Some(ConditionSet::new(vec![Condition::format_1_axis_range(
            0, half, one,
        )])),
        Some(FeatureTableSubstitution::new(vec![
            other(0, &[4, 1]),
            other(2, &[1, 2, 3]),
        ])),
    );
    gsub.feature_variations = FeatureVariations::new(vec![record]).into();
    dump_table(&gsub).unwrap()
}

#[test]
fn features_are_those_of_the_place() {
    let table = changing();
    let mut font = FontBuilder::new();
    font.add_raw(Tag::new(b"GSUB"), table.clone());
    let font = font.build();
    let font = FontRef::new(&font).unwrap();
    let vary = font.gsub().unwrap().feature_variations().unwrap().unwrap();
    let lookups: [(f32, [&[u16]; 3]); 3] = [
        (0.0, [&[4], &[5, 6], &[]]),
        (0.4, [&[4], &[5, 6], &[]]),
        (0.6, [&[4, 1], &[5, 6], &[1, 2, 3]]),
    ];
    for (at, wanted) in lookups {
        let mut settled = table.clone();
        features::settle(&mut settled, &vary, &[F2Dot14::from_f32(at)]).unwrap();
        assert_eq!(settled[..4], [0, 1, 0, 0], "no variations");
        let read = Gsub::read(settled.as_slice().into()).unwrap();
        let found = read.feature_list.feature_records.iter();
        let found = found.map(|r| (r.feature_tag, r.feature.lookup_list_indices.clone()));
        let tags = [b"aalt", b"liga", b"rvrn"].map(Tag::new);
        let wanted = tags.into_iter().zip(wanted.map(<[u16]>::to_vec));
        assert!(found.eq(wanted), "{at}: {:?}", read.feature_list);
    }
}

#[test]
fn features_too_far_apart_are_the_defaults() {
    let mut table = changing();
    let font = {
        let mut font = FontBuilder::new();
        font.add_raw(Tag::new(b"GSUB"), table.clone());
        font.build()
    };
    let font = FontRef::new(&font).unwrap();
    let vary = font.gsub().unwrap().feature_variations().unwrap().unwrap();
    // lookups at the last place that 16 bits can name
    table[8..10].copy_from_slice(&[0xff, 0xff]);
    let whole = table.clone();
    assert_eq!(
        features::settle(&mut table, &vary, &[F2Dot14::from_f32(0.9)]),
        None
    );
    assert_eq!((&table[..4], &table[4..]), (&[0, 1, 0, 0][..], &whole[4..]));
}
