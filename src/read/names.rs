//! Texts of a name table, and the table with other texts.

use skrifa::MetadataProvider;
use skrifa::raw::{FontRef, TableProvider};
use skrifa::string::StringId;
use std::collections::BTreeMap;

/// The names that tell a font's style, and the prefix of such names in a variable font.
const OF_STYLE: [u16; 10] = [1, 2, 3, 4, 6, 16, 17, 21, 22, 25];
/// Windows, Unicode BMP, US English: what every program reads.
const ENGLISH: [u16; 3] = [3, 1, 0x409];
/// Where languages begin that the table describes itself.
const OWN_LANGUAGES: u16 = 0x8000;

/// The text in English, else in the first language that has it.
pub(super) fn text(font: &FontRef<'_>, id: StringId) -> Option<String> {
    let found = font.localized_strings(id).english_or_first();
    found.map(|s| s.to_string()).filter(|s| !s.is_empty())
}

/// Platform, encoding, language and id of a name.
type Key = [u16; 4];

/// The name table of a font with other names of its style, in English alone.
pub(super) fn restyled(font: &FontRef<'_>, names: Vec<(u16, String)>) -> Option<Vec<u8>> {
    let table = font.name().ok()?;
    let storage = table.string_data();
    let kept = table.name_record().iter().filter_map(|r| {
        let (start, length) = (
            usize::try_from(r.string_offset().to_u32()).ok()?,
            usize::from(r.length()),
        );
        let key = [
            r.platform_id(),
            r.encoding_id(),
            r.language_id(),
            r.name_id().to_u16(),
        ];
        let stays = !OF_STYLE.contains(&key[3]) && key[2] < OWN_LANGUAGES;
        let bytes = storage.as_bytes().get(start..start + length)?;
        stays.then(|| (key, bytes.to_vec()))
    });
    let [platform, encoding, language] = ENGLISH;
    let new = names.into_iter().filter(|(id, _)| OF_STYLE.contains(id));
    let new = new.map(|(id, text)| {
        let bytes = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
        ([platform, encoding, language, id], bytes)
    });
    written(&kept.chain(new).collect())
}

/// The table, if it is not too long for one.
fn written(records: &BTreeMap<Key, Vec<u8>>) -> Option<Vec<u8>> {
    let short = |n: usize| u16::try_from(n).ok();
    let (mut head, mut texts) = (Vec::new(), Vec::new());
    for n in [0, short(records.len())?, short(6 + 12 * records.len())?] {
        head.extend(n.to_be_bytes());
    }
    for (key, text) in records {
        let place = [short(text.len())?, short(texts.len())?];
        head.extend(key.iter().chain(&place).flat_map(|n| n.to_be_bytes()));
        texts.extend(text);
    }
    Some([head, texts].concat())
}
