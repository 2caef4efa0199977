//! The name table: what a font calls itself.

use super::WriteError;
use crate::types::Info;
use write_fonts::tables::name::{Name, NameRecord};
use write_fonts::types::NameId;

/// Windows, Unicode BMP, US English: what every program reads.
const PLATFORM: (u16, u16, u16) = (3, 1, 0x409);

/// The table.
pub(super) fn table(info: &Info) -> Result<Name, WriteError> {
    let texts = info.names();
    let size: usize = texts.iter().map(|(_, t)| 2 * t.len()).sum();
    if size > usize::from(u16::MAX) {
        return Err(WriteError::table(
            "name",
            "its texts exceed 64 KiB; shorten the licence",
        ));
    }
    let (platform, encoding, language) = PLATFORM;
    let record = |(id, text): (u16, String)| {
        NameRecord::new(platform, encoding, language, NameId::new(id), text.into())
    };
    Ok(Name::new(texts.into_iter().map(record).collect()))
}
