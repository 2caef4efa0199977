//! A variable font at a place on its axes: where it is, what the font says of itself there, and how its text is set.

mod features;
mod positions;
#[cfg(test)]
mod tests;

use super::{ReadError, names, whole};
use crate::numeric::cast::single;
use crate::types::{Glyph, Info};
use names::text;
use skrifa::instance::Location;
use skrifa::raw::tables::stat::{AxisValue, AxisValueTableFlags};
use skrifa::raw::types::Fixed;
use skrifa::raw::{FontRef, TableProvider};
use skrifa::{MetadataProvider, Tag};
use std::collections::BTreeMap;

/// Tag → binary table.
type Tables = BTreeMap<[u8; 4], Vec<u8>>;

/// A metric that varies (`MVAR`), and the table and byte where it stands; those of lines stand in two tables.
const METRICS: [(&[u8; 4], &[u8; 4], usize); 25] = [
    (b"hasc", b"OS/2", 68),
    (b"hasc", b"hhea", 4),
    (b"hdsc", b"OS/2", 70),
    (b"hdsc", b"hhea", 6),
    (b"hlgp", b"OS/2", 72),
    (b"hlgp", b"hhea", 8),
    (b"hcla", b"OS/2", 74),
    (b"hcld", b"OS/2", 76),
    (b"hcrs", b"hhea", 18),
    (b"hcrn", b"hhea", 20),
    (b"hcof", b"hhea", 22),
    (b"xhgt", b"OS/2", 86),
    (b"cpht", b"OS/2", 88),
    (b"sbxs", b"OS/2", 10),
    (b"sbys", b"OS/2", 12),
    (b"sbxo", b"OS/2", 14),
    (b"sbyo", b"OS/2", 16),
    (b"spxs", b"OS/2", 18),
    (b"spys", b"OS/2", 20),
    (b"spxo", b"OS/2", 22),
    (b"spyo", b"OS/2", 24),
    (b"strs", b"OS/2", 26),
    (b"stro", b"OS/2", 28),
    (b"undo", b"post", 8),
    (b"unds", b"post", 10),
];

/// Widths of the nine width classes, percent of the usual one.
const WIDTHS: [f64; 9] = [50.0, 62.5, 75.0, 87.5, 100.0, 112.5, 125.0, 150.0, 200.0];

/// Names of the weights at the hundreds.
const WEIGHTS: [&str; 9] = [
    "Thin",
    "ExtraLight",
    "Light",
    "Regular",
    "Medium",
    "SemiBold",
    "Bold",
    "ExtraBold",
    "Black",
];

/// Axis values are stored with 16 bits behind the point.
const SAME: f64 = 1.0 / 65536.0;

/// A place on every axis of a font.
pub(super) struct Place {
    /// Tag, value, and whether that is not the default.
    axes: Vec<(Tag, f64, bool)>,
    /// The same for drawing.
    pub(super) location: Location,
}

impl Place {
    /// The place of these values, tag and number; axes without one stand at their default.
    pub(super) fn of(font: &FontRef<'_>, wanted: &[(String, f64)]) -> Result<Self, ReadError> {
        let all = font.axes();
        for (tag, value) in wanted {
            let Some(axis) = all.iter().find(|a| a.tag().to_string() == *tag) else {
                let known: Vec<_> = all.iter().map(|a| a.tag().to_string()).collect();
                return Err(if known.is_empty() {
                    ReadError::NoAxes(tag.clone())
                } else {
                    ReadError::Axis(tag.clone(), known.join(", "))
                });
            };
            let range = [axis.min_value(), axis.max_value()].map(f64::from);
            if !(range[0]..=range[1]).contains(value) {
                let (axis, value) = (tag.clone(), *value);
                return Err(ReadError::Beyond { axis, value, range });
            }
        }
        let axes = all.iter().map(|axis| {
            let usual = f64::from(axis.default_value());
            let own = wanted.iter().rev().find(|w| axis.tag().to_string() == w.0);
            let value = own.map_or(usual, |w| w.1);
            (axis.tag(), value, (value - usual).abs() > SAME)
        });
        let settings = wanted.iter().map(|(tag, v)| (tag.as_str(), single(*v)));
        Ok(Self {
            axes: axes.collect(),
            location: all.location(settings),
        })
    }

    /// Whether it is not where the font's tables describe it.
    pub(super) fn moved(&self) -> bool {
        self.axes.iter().any(|(_, _, moved)| *moved)
    }

    fn at(&self, tag: &[u8; 4]) -> Option<f64> {
        let axis = self.axes.iter().find(|(t, ..)| *t == Tag::new(tag));
        axis.map(|(_, value, _)| *value)
    }

    /// Makes the information that of the style at this place.
    pub(super) fn describe(&self, font: &FontRef<'_>, info: &mut Info) {
        info.style = self.style(font);
        info.weight = self
            .at(b"wght")
            .map_or(info.weight, |v| whole(v.clamp(1.0, 1000.0)));
        info.italic_angle = self
            .at(b"slnt")
            .unwrap_or(info.italic_angle)
            .clamp(-90.0, 90.0);
    }

    /// The style's name: that of the instance that stands here, else what the axes' values are called, else the
    /// values themselves.
    fn style(&self, font: &FontRef<'_>) -> String {
        let named = self.named(font).or_else(|| self.composed(font));
        named.unwrap_or_else(|| self.plain())
    }

    fn named(&self, font: &FontRef<'_>) -> Option<String> {
        let instances = font.named_instances();
        let mut instances = instances.iter();
        let here = |coords: &mut dyn Iterator<Item = f32>| {
            coords
                .zip(&self.axes)
                .all(|(v, (_, at, _))| (f64::from(v) - at).abs() <= SAME)
        };
        let found = instances.find(|i| here(&mut i.user_coords()))?;
        text(font, found.subfamily_name_id())
    }

    /// What `STAT` calls the values one by one, if it knows those of all axes.
    fn composed(&self, font: &FontRef<'_>) -> Option<String> {
        let stat = font.stat().ok()?;
        let values = stat.offset_to_axis_values()?.ok()?;
        let values: Vec<AxisValue<'_>> = values.axis_values().iter().flatten().collect();
        let mut words = Vec::new();
        for (i, axis) in (0..).zip(stat.design_axes().ok()?) {
            let at = self.at(&axis.axis_tag().to_be_bytes());
            let mut own = values.iter().filter(|v| v.axis_index() == Some(i));
            let value = own.find(|v| at.is_none_or(|at| covers(v, at)))?;
            words.push((axis.axis_ordering(), value));
        }
        words.sort_by_key(|(order, _)| *order);
        let silent = AxisValueTableFlags::ELIDABLE_AXIS_VALUE_NAME;
        let words = words.iter().filter(|(_, v)| !v.flags().contains(silent));
        let words: Option<Vec<String>> =
            words.map(|(_, v)| text(font, v.value_name_id())).collect();
        match words?.join(" ") {
            none if none.is_empty() => text(font, stat.elided_fallback_name_id()?),
            some => Some(some),
        }
    }

    /// The values of the axes that have moved, the weights at the hundreds by their names.
    fn plain(&self) -> String {
        let moved = self.axes.iter().filter(|(_, _, moved)| *moved);
        let word = |(tag, value, _): &(Tag, f64, bool)| {
            let is = |n: i32| (value - 100.0 * f64::from(n)).abs() <= SAME;
            let weight = (1..).zip(WEIGHTS).find(|(n, _)| is(*n));
            let weight = weight.filter(|_| *tag == Tag::new(b"wght"));
            weight.map_or_else(|| format!("{tag}{value}"), |(_, name)| name.to_owned())
        };
        moved.map(word).collect::<Vec<_>>().join(" ")
    }

    /// Makes the layout tables those of this place; a line where features that vary could not be told apart there.
    pub(super) fn lay_out(&self, font: &FontRef<'_>, all: &mut Tables) -> Option<String> {
        let coords = self.location.coords();
        positions::settle(font, coords, all);
        let gsub = font.gsub().ok().and_then(|t| t.feature_variations());
        let gpos = font.gpos().ok().and_then(|t| t.feature_variations());
        let vary = [(b"GSUB", gsub), (b"GPOS", gpos)];
        let mut lost = None;
        for (tag, vary) in vary {
            if let (Some(table), Some(Ok(vary))) = (all.get_mut(tag), vary)
                && features::settle(table, &vary, coords).is_none()
            {
                lost = Some("features that vary along the axes: they are the default's".to_owned());
            }
        }
        lost
    }

    /// Makes the tables those of the style at this place.
    pub(super) fn rewrite(
        &self,
        font: &FontRef<'_>,
        info: &Info,
        glyphs: &[Glyph],
        all: &mut Tables,
    ) {
        if let Ok(mvar) = font.mvar() {
            for (metric, table, at) in METRICS {
                let delta = mvar.metric_delta(Tag::new(metric), self.location.coords());
                let delta = delta.map_or(0.0, |d| (d.to_f64() + 0.5).floor());
                change(all, table, at, |old| moved_by(old, delta));
            }
        }
        let width = self.at(b"wdth").map(|percent| {
            let off = |w: &f64| (w - percent).abs();
            let classes = (1_u16..).zip(WIDTHS);
            let nearest = classes.min_by(|a, b| off(&a.1).total_cmp(&off(&b.1)));
            nearest.map_or(5, |(class, _)| class)
        });
        let style = info.linked_style();
        let bits = |old: u16, flags: [(u16, bool); 3]| {
            flags.into_iter().fold(
                old,
                |word, (bit, set)| if set { word | bit } else { word & !bit },
            )
        };
        let plain = !style.is_bold && !style.is_italic;
        let selection = [
            (1, style.is_italic),
            (1 << 5, style.is_bold),
            (1 << 6, plain),
        ];
        let mac = [(1, style.is_bold), (2, style.is_italic), (0, true)];
        let advances = glyphs.iter().map(|g| g.advance).filter(|a| *a > 0.0);
        let mean = advances.clone().sum::<f64>() / advances.count() as f64;
        change(all, b"OS/2", 2, |_| whole(mean));
        change(all, b"OS/2", 4, |_| info.weight);
        change(all, b"OS/2", 6, |old| width.unwrap_or(old));
        change(all, b"OS/2", 62, |old| bits(old, selection));
        change(all, b"head", 44, |old| bits(old, mac));
        if let Some(angle) = self
            .at(b"slnt")
            .and(all.get_mut(b"post"))
            .and_then(|t| t.get_mut(4..8))
        {
            angle.copy_from_slice(&Fixed::from_f64(info.italic_angle).to_be_bytes());
        }
        if let Some(names) = names::restyled(font, info.names()) {
            all.insert(*b"name", names);
        }
    }
}

/// Whether an axis value is one of this place.
fn covers(value: &AxisValue<'_>, at: f64) -> bool {
    match value {
        AxisValue::Format2(v) => {
            (v.range_min_value().to_f64()..=v.range_max_value().to_f64()).contains(&at)
        }
        _ => value
            .value()
            .is_some_and(|v| (v.to_f64() - at).abs() <= SAME),
    }
}

/// Changes 16 bits of a table, where it has them.
fn change(all: &mut Tables, table: &[u8; 4], at: usize, new: impl FnOnce(u16) -> u16) {
    let word = all.get_mut(table).and_then(|t| t.get_mut(at..at + 2));
    if let Some([high, low]) = word {
        [*high, *low] = new(u16::from_be_bytes([*high, *low])).to_be_bytes();
    }
}

/// A signed number moved, in its 16 bits.
#[expect(clippy::cast_possible_truncation, reason = "clamped to 16 bits before")]
fn moved_by(old: u16, delta: f64) -> u16 {
    let new = f64::from(old.cast_signed()) + delta;
    (new.clamp(-32768.0, 32767.0) as i16).cast_unsigned()
}
