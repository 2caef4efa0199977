//! Which font of a file.

use super::{ReadError, names::text};
use skrifa::FontRef;
use skrifa::raw::FileRef;
use skrifa::string::StringId;

/// The font of a file; of a collection the one that is asked for by its number, from 1, or its name.
pub(super) fn face<'a>(bytes: &'a [u8], asked: Option<&str>) -> Result<FontRef<'a>, ReadError> {
    let file = FileRef::new(bytes).map_err(|e| ReadError::damaged("a font", e))?;
    let fonts: Vec<_> = file.fonts().collect();
    let names = |font: &FontRef<'_>| {
        let ids = [StringId::FULL_NAME, StringId::POSTSCRIPT_NAME];
        ids.into_iter()
            .filter_map(|id| text(font, id))
            .collect::<Vec<_>>()
    };
    let is = |(n, font): &(usize, &Result<FontRef<'_>, _>), asked: &str| match (asked.parse(), font)
    {
        (Ok(number), _) => *n == number,
        (Err::<usize, _>(_), Ok(font)) => names(font).iter().any(|n| n.eq_ignore_ascii_case(asked)),
        _ => false,
    };
    let found = match asked {
        Some(asked) => (1..).zip(&fonts).find(|f| is(f, asked)).map(|f| f.1),
        None => fonts.first().filter(|_| fonts.len() == 1),
    };
    if let Some(font) = found {
        return font.clone().map_err(|e| ReadError::damaged("a font", e));
    }
    let known = (1..).zip(&fonts).map(|(n, font)| {
        let name = font.as_ref().ok().and_then(|f| names(f).into_iter().next());
        format!("{n} {}", name.unwrap_or_default())
    });
    let known: Vec<String> = known.collect();
    Err(match asked {
        Some(asked) => ReadError::Face(asked.to_owned(), known.join(", ")),
        None => ReadError::Faces(known.join(", ")),
    })
}
