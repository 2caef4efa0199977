//! Kerning, anchors and carets that vary: each becomes the number that it is at a place, where it stands.

use super::Tables;
use skrifa::raw::tables::variations::{DeltaSetIndex, ItemVariationStore};
use skrifa::raw::types::F2Dot14;
use skrifa::raw::{FontRef, TableProvider};
use std::collections::BTreeSet;

/// The format of a device table that points to variations.
const VARIES: usize = 0x8000;

/// Settles what varies in `GPOS` and in the carets of `GDEF`. What a damaged table leaves unreadable stays.
pub(super) fn settle(font: &FontRef<'_>, coords: &[F2Dot14], all: &mut Tables) {
    let store = font.gdef().ok().and_then(|t| t.item_var_store()?.ok());
    if let Some(bytes) = all.get_mut(b"GPOS") {
        Table::new(bytes, store.as_ref(), coords).lookups();
    }
    if let Some(bytes) = all.get_mut(b"GDEF") {
        Table::new(bytes, store.as_ref(), coords).carets();
    }
}

/// A table whose numbers are changed in place.
struct Table<'a> {
    bytes: &'a mut [u8],
    store: Option<&'a ItemVariationStore<'a>>,
    coords: &'a [F2Dot14],
    /// Parts that were settled: several may share one.
    seen: BTreeSet<usize>,
    /// Steps that may follow; no sound table takes more than two a byte.
    left: usize,
}

impl<'a> Table<'a> {
    const fn new(
        bytes: &'a mut [u8],
        store: Option<&'a ItemVariationStore<'a>>,
        coords: &'a [F2Dot14],
    ) -> Self {
        Self {
            left: 2 * bytes.len(),
            bytes,
            store,
            coords,
            seen: BTreeSet::new(),
        }
    }
}

impl Table<'_> {
    fn word(&self, at: usize) -> Option<usize> {
        let &[high, low] = self.bytes.get(at..at.checked_add(2)?)? else {
            return None;
        };
        Some(usize::from(u16::from_be_bytes([high, low])))
    }

    /// The place of a part, by the offset that stands at `at` and counts from `base`; none where there is none, or
    /// where it was settled.
    fn part(&mut self, base: usize, at: usize) -> Option<usize> {
        let offset = self.word(at).filter(|v| *v > 0)?;
        self.seen.insert(base + offset).then_some(base + offset)
    }

    /// All parts by a list of offsets that count from `base`; it begins with their number at `at`.
    fn parts(
        &mut self,
        (base, at): (usize, usize),
        each: impl Fn(&mut Self, usize) -> Option<()>,
    ) -> Option<()> {
        for i in 0..self.word(at)? {
            if let Some(part) = self.part(base, at + 2 + 2 * i) {
                each(self, part);
            }
        }
        Some(())
    }

    fn put(&mut self, at: usize, new: i16) -> Option<()> {
        let two = self.bytes.get_mut(at..at + 2)?;
        two.copy_from_slice(&new.to_be_bytes());
        Some(())
    }

    /// Adds to the number at `at` what the device table makes of it to which the offset at `device` points.
    fn vary(&mut self, at: usize, base: usize, device: usize) -> Option<()> {
        self.left = self.left.checked_sub(1)?;
        let offset = self.word(device)?;
        if offset > 0 {
            let old = i16::from_be_bytes(self.bytes.get(at..at + 2)?.try_into().ok()?);
            let delta = self.delta(base + offset).unwrap_or(0);
            let new = (i32::from(old) + delta).clamp(i16::MIN.into(), i16::MAX.into());
            self.put(at, i16::try_from(new).ok()?)?;
            self.put(device, 0)?;
        }
        Some(())
    }

    fn delta(&self, at: usize) -> Option<i32> {
        let [outer, inner, format] = [self.word(at)?, self.word(at + 2)?, self.word(at + 4)?];
        let [outer, inner] = [outer, inner].map(u16::try_from);
        let index = DeltaSetIndex {
            outer: outer.ok()?,
            inner: inner.ok()?,
        };
        let store = self.store.filter(|_| format == VARIES)?;
        store.compute_delta(index, self.coords).ok()
    }

    fn lookups(&mut self) -> Option<()> {
        let list = self.word(8)?;
        self.parts((list, list), |table, lookup| {
            let kind = table.word(lookup)?;
            table.parts((lookup, lookup + 4), |table, at| table.subtable(kind, at))
        })
    }

    fn subtable(&mut self, kind: usize, at: usize) -> Option<()> {
        match kind {
            1 => self.single(at),
            2 => self.pairs(at),
            // entry and exit
            3 => self.anchors(at, at + 6, 2 * self.word(at + 4)?),
            // marks on bases and on marks, and on ligatures
            4..=6 => {
                let classes = self.word(at + 6)?;
                self.part(at, at + 8).and_then(|marks| self.marks(marks));
                let others = self.part(at, at + 10)?;
                if kind == 5 {
                    self.parts((others, others), |t, one| {
                        t.anchors(one, one + 2, classes * t.word(one)?)
                    })
                } else {
                    self.anchors(others, others + 2, classes * self.word(others)?)
                }
            }
            9 => {
                let inner = self.word(at + 2).filter(|kind| *kind != 9)?;
                let far = at + (self.word(at + 4)? << 16) + self.word(at + 6)?;
                self.seen.insert(far).then(|| self.subtable(inner, far))?
            }
            _ => None,
        }
    }

    fn single(&mut self, at: usize) -> Option<()> {
        let format = self.word(at + 4)?;
        match self.word(at)? {
            1 => self.value(at, at + 6, format),
            2 => {
                let size = size(format);
                (0..self.word(at + 6)?).try_for_each(|i| self.value(at, at + 8 + size * i, format))
            }
            _ => None,
        }
    }

    fn pairs(&mut self, at: usize) -> Option<()> {
        let formats = [self.word(at + 4)?, self.word(at + 6)?];
        let [first, second] = formats.map(size);
        let both = |table: &mut Self, base: usize, pair: usize| {
            table.value(base, pair, formats[0])?;
            table.value(base, pair + first, formats[1])
        };
        match self.word(at)? {
            1 => self.parts((at, at + 8), |table, set| {
                let pairs = 0..table.word(set)?;
                let pair = |i| set + 2 + (2 + first + second) * i + 2;
                pairs
                    .into_iter()
                    .try_for_each(|i| both(table, set, pair(i)))
            }),
            2 => {
                let pairs = self.word(at + 12)? * self.word(at + 14)?;
                (0..pairs).try_for_each(|i| both(self, at, at + 16 + (first + second) * i))
            }
            _ => None,
        }
    }

    /// The numbers of a value record, devices counted from `base`.
    fn value(&mut self, base: usize, at: usize, format: usize) -> Option<()> {
        self.left = self.left.checked_sub(1)?;
        for bit in 0..4 {
            let (number, device) = (1 << bit, 0x10 << bit);
            if format & number > 0 && format & device > 0 {
                let place = |field: usize| at + size(format & (field - 1));
                self.vary(place(number), base, place(device))?;
            }
        }
        Some(())
    }

    fn marks(&mut self, at: usize) -> Option<()> {
        (0..self.word(at)?).try_for_each(|i| self.anchors(at, at + 4 + 4 * i, 1))
    }

    /// So many anchors, by a list of offsets at `at` that count from `base`.
    fn anchors(&mut self, base: usize, at: usize, many: usize) -> Option<()> {
        for i in 0..many {
            self.left = self.left.checked_sub(1)?;
            if let Some(anchor) = self.part(base, at + 2 * i) {
                self.anchor(anchor);
            }
        }
        Some(())
    }

    /// One with devices becomes one without.
    fn anchor(&mut self, at: usize) -> Option<()> {
        if self.word(at)? == 3 {
            self.vary(at + 2, at, at + 6)?;
            self.vary(at + 4, at, at + 8)?;
            self.put(at, 1)?;
        }
        Some(())
    }

    /// Places of the text cursor in ligatures.
    fn carets(&mut self) -> Option<()> {
        let list = self.word(8).filter(|v| *v > 0)?;
        self.parts((list, list + 2), |table, glyph| {
            table.parts((glyph, glyph), |table, caret| {
                if table.word(caret)? == 3 {
                    table.vary(caret + 2, caret, caret + 4)?;
                    table.put(caret, 1)?;
                }
                Some(())
            })
        })
    }
}

/// Bytes of a value record's fields.
const fn size(format: usize) -> usize {
    2 * (format & 0xff).count_ones() as usize
}
