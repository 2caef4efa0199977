//! Features that differ from place to place: those of one place, for good.

use skrifa::raw::tables::layout::{Condition, FeatureVariations};
use skrifa::raw::types::F2Dot14;

/// Conditions lie in each other so deep at most.
const DEEP: usize = 8;
/// Bytes of the head of `GSUB` and `GPOS` without feature variations.
const HEAD: usize = 10;

/// Makes `GSUB` or `GPOS` one whose features are those of a place, and vary no more. None, and the features as they
/// were, where the table's parts would lie too far apart.
pub(super) fn settle(
    table: &mut Vec<u8>,
    vary: &FeatureVariations<'_>,
    at: &[F2Dot14],
) -> Option<()> {
    let here = chosen(vary, at);
    let settled = here.map(|lookups| with(table, &lookups));
    if let Some(Some(new)) = &settled {
        table.clone_from(new);
    }
    // 1.0 has no offset of variations
    *table.get_mut(3)? = 0;
    settled.is_none_or(|new| new.is_some()).then_some(())
}

/// Features' numbers and their lookups at a place, of the first set of conditions that hold there; none if none does.
fn chosen(vary: &FeatureVariations<'_>, at: &[F2Dot14]) -> Option<Vec<(usize, Vec<u8>)>> {
    let data = vary.offset_data();
    let mut records = vary.feature_variation_records().iter();
    let here = records.find(|r| match r.condition_set(data) {
        None => true,
        Some(Ok(set)) => set
            .conditions()
            .iter()
            .all(|c| c.is_ok_and(|c| holds(&c, at, DEEP))),
        Some(Err(_)) => false,
    })?;
    let other = here.feature_table_substitution(data)?.ok()?;
    let bytes = other.offset_data().as_bytes();
    let feature = |at: usize| {
        // parameters, number of lookups, lookups
        let many = word(bytes, at + 2)?;
        Some(bytes.get(at + 4..at + 4 + 2 * many)?.to_vec())
    };
    let all = other.substitutions().iter().map(|s| {
        let start = usize::try_from(s.alternate_feature_offset().to_u32()).ok()?;
        Some((usize::from(s.feature_index()), feature(start)?))
    });
    all.collect()
}

fn holds(condition: &Condition<'_>, at: &[F2Dot14], deep: usize) -> bool {
    let Some(deep) = deep.checked_sub(1) else {
        return false;
    };
    match condition {
        Condition::Format1AxisRange(c) => {
            let range = c.filter_range_min_value()..=c.filter_range_max_value();
            let here = at.get(usize::from(c.axis_index())).copied();
            range.contains(&here.unwrap_or_default())
        }
        Condition::Format3And(c) => c
            .conditions()
            .iter()
            .all(|c| c.is_ok_and(|c| holds(&c, at, deep))),
        Condition::Format4Or(c) => c
            .conditions()
            .iter()
            .any(|c| c.is_ok_and(|c| holds(&c, at, deep))),
        Condition::Format5Negate(c) => c.condition().is_ok_and(|c| !holds(&c, at, deep)),
        // a value of the variation store, which no released font asks for
        Condition::Format2VariableValue(_) => false,
    }
}

/// The table with other lookups in some features: a new list of features behind the head, which points to the old
/// list's features where they stay.
fn with(table: &[u8], lookups: &[(usize, Vec<u8>)]) -> Option<Vec<u8>> {
    let [scripts, features, list] = [4, 6, 8].map(|at| word(table, at));
    let (scripts, features, list) = (scripts?, features?, list?);
    let many = word(table, features)?;
    let names = 2 + 6 * many;
    let more = names + lookups.iter().map(|(_, l)| 4 + l.len()).sum::<usize>();
    let mut out = vec![0, 1, 0, 0];
    for at in [scripts + more, HEAD, list + more, many] {
        push(&mut out, at)?;
    }
    for i in 0..many {
        let at = features + 2 + 6 * i;
        out.extend(table.get(at..at + 4)?);
        let mut behind = names;
        let mut new = lookups.iter().map(|(k, l)| {
            behind += 4 + l.len();
            (*k, behind - 4 - l.len())
        });
        let stays = (features + word(table, at + 4)? + more).checked_sub(HEAD)?;
        push(
            &mut out,
            new.find(|(k, _)| *k == i).map_or(stays, |(_, at)| at),
        )?;
    }
    for (_, l) in lookups {
        push(&mut out, 0)?;
        push(&mut out, l.len() / 2)?;
        out.extend(l);
    }
    out.extend(table.get(HEAD..)?);
    Some(out)
}

/// Sixteen bits more; none where the number has more.
fn push(out: &mut Vec<u8>, v: usize) -> Option<()> {
    out.extend(u16::try_from(v).ok()?.to_be_bytes());
    Some(())
}

fn word(bytes: &[u8], at: usize) -> Option<usize> {
    let two = bytes.get(at..at.checked_add(2)?)?;
    Some(usize::from(u16::from_be_bytes(two.try_into().ok()?)))
}
