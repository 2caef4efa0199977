//! Kerning and groups of a UFO, as far as their glyphs are there.

use super::{Named, held};
use crate::read::{ReadError, listed};
use crate::types::formats::KERNING_GROUPS;
use crate::types::{Kerning, Name, label};
use std::collections::BTreeMap;

/// Groups and pairs of the glyphs that are there; the prefixes of kerning groups become an `@` in a pair.
pub(super) fn kerning(
    source: &norad::Font,
    named: &Named<'_>,
    lost: &mut Vec<String>,
) -> Result<Kerning, ReadError> {
    // what may stand on a side of a pair, and what the font calls it there
    let glyphs = named.iter().map(|(own, name)| (*own, name.to_string()));
    let glyphs: BTreeMap<&str, String> = glyphs.collect();
    let mut sides = [glyphs.clone(), glyphs];
    let mut groups = [BTreeMap::new(), BTreeMap::new()];
    let (mut others, mut absent, mut dangling) = (Vec::new(), Vec::new(), Vec::new());
    for (group, members) in &source.groups {
        let Some(side) = KERNING_GROUPS.iter().position(|s| group.starts_with(s)) else {
            others.push(group.to_string());
            continue;
        };
        let (there, not): (Vec<_>, Vec<_>) =
            members.iter().partition(|m| named.contains_key(m.as_str()));
        absent.extend(not.iter().map(|m| format!("{m} in {group}")));
        let there = there.iter().filter_map(|m| named.get(m.as_str()).cloned());
        let there: Vec<Name> = there.collect();
        if !there.is_empty() {
            let is_free = |name: &str| {
                let own = format!("{}{name}", KERNING_GROUPS[side]);
                own == group.as_str()
                    || !groups[side].contains_key(name) && !source.groups.contains_key(own.as_str())
            };
            let legal = label(&group[KERNING_GROUPS[side].len()..], is_free);
            sides[side].insert(group, format!("@{legal}"));
            groups[side].insert(legal, there);
        }
    }
    let [first, second] = groups;
    let mut pairs = BTreeMap::new();
    for (a, seconds) in &source.kerning {
        for (b, &value) in seconds {
            if let (Some(first), Some(second)) =
                (sides[0].get(a.as_str()), sides[1].get(b.as_str()))
            {
                let value = held(value, || format!("kerning of {a} and {b}"))?;
                pairs.insert((first.clone(), second.clone()), value);
            } else {
                dangling.push(format!("{a} {b}"));
            }
        }
    }
    let missing = "kerning pairs of glyphs or groups that are not there";
    lost.extend(listed("groups beside those of kerning", &others));
    lost.extend(listed(
        "members of kerning groups that are no glyphs",
        &absent,
    ));
    lost.extend(listed(missing, &dangling));
    Ok(Kerning {
        first,
        second,
        pairs,
    })
}
