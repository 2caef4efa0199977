//! What a build has to say in the Static Analysis Results Interchange Format, which code hosts and editors show.
//!
//! Version 2.1.0, OASIS Standard, 27 March 2020.

use super::failure::Failure;
use super::project::Opened;
use khatt::pipeline::{Built, Place};
use khatt::types::Files;
use serde_json::{Value, json};
use std::path::Path;

/// The rules: what a result is about, and how grave it is.
const RULES: [(&str, &str, &str); 4] = [
    ("failed", "error", "The font cannot be built."),
    ("cell", "warning", "Something is odd in a cell of a page."),
    (
        "label",
        "warning",
        "A cell looks like another letter than its label says.",
    ),
    ("glyph", "note", "Something could not be done for a glyph."),
];

/// What a build that went well remarks.
pub(super) fn remarks(opened: &Opened, built: &Built) -> Files {
    let mut results = Vec::new();
    for page in &built.pages {
        for warning in &page.cut.warnings {
            let place = warning.index.map(|index| Place {
                sheet: page.name.clone(),
                index,
                label: warning.label.as_ref().map(|l| l.0.clone()),
            });
            results.push(result(
                opened,
                "cell",
                &warning.message,
                (Some(&page.name), place),
            ));
        }
    }
    for doubt in &built.doubts {
        let text = doubt.to_string();
        results.push(result(opened, "label", &text, (Some(&doubt.sheet), None)));
    }
    for note in &built.notes {
        let drawn = built.letters.iter().find(|l| l.label.0 == note.glyph);
        let place = drawn.map(|l| Place {
            sheet: l.sheet.clone(),
            index: l.index,
            label: Some(note.glyph.clone()),
        });
        let page = drawn.map(|l| l.sheet.as_str());
        let text = format!("{}: {}", note.glyph, note.message);
        results.push(result(opened, "glyph", &text, (page, place)));
    }
    log(&results)
}

/// Why a build failed. `project` is its file.
pub(super) fn failed(project: &Path, failure: &Failure) -> Files {
    let results = failure.texts().map(|text| {
        let location = json!({ "physicalLocation": physical(project) });
        in_words("failed", &text, vec![location])
    });
    log(&results.collect::<Vec<_>>())
}

fn log(results: &[Value]) -> Files {
    let rules = RULES.map(|(id, level, text)| {
        json!({
            "id": id,
            "shortDescription": { "text": text },
            "defaultConfiguration": { "level": level },
        })
    });
    let log = json!({
        "$schema": "https://docs.oasis-open.org/sarif/sarif/v2.1.0/os/schemas/sarif-schema-2.1.0.json",
        "version": "2.1.0",
        "runs": [{
            "tool": { "driver": {
                "name": "khatt",
                "semanticVersion": env!("CARGO_PKG_VERSION"),
                "rules": rules,
            } },
            "results": results,
        }],
    });
    Files::single(format!("{log:#}\n").into_bytes())
}

/// A remark on a page, or on one of its cells.
fn result(
    opened: &Opened,
    rule: &str,
    text: &str,
    (page, place): (Option<&str>, Option<Place>),
) -> Value {
    let mut location = serde_json::Map::new();
    if let Some(page) = page {
        // the page of a file of several
        let file = page.rsplit_once(", page ").map_or(page, |(file, _)| file);
        let path = opened.path(Path::new(file));
        location.insert("physicalLocation".to_owned(), physical(&path));
    }
    if let Some(place) = &place {
        let name = place.label.clone().unwrap_or_default();
        let cell = format!("{}, cell {}", place.sheet, place.index + 1);
        let logical = json!([{ "name": name, "fullyQualifiedName": cell, "kind": "glyph" }]);
        location.insert("logicalLocations".to_owned(), logical);
    }
    let location = Some(location).filter(|l| !l.is_empty());
    in_words(
        rule,
        text,
        location.map(Value::Object).into_iter().collect(),
    )
}

fn in_words(rule: &str, text: &str, locations: Vec<Value>) -> Value {
    let index = RULES.iter().position(|r| r.0 == rule).unwrap_or_default();
    json!({
        "ruleId": rule,
        "ruleIndex": index,
        "level": RULES[index].1,
        "message": { "text": text },
        "locations": locations,
    })
}

fn physical(path: &Path) -> Value {
    json!({ "artifactLocation": { "uri": uri(path) } })
}

/// A path as a relative reference (RFC 3986), or as a file: address where it is absolute.
fn uri(path: &Path) -> String {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-._~/".contains(&byte);
    let escaped = |byte: u8| match byte {
        byte if plain(byte) => char::from(byte).to_string(),
        byte => format!("%{byte:02X}"),
    };
    let out: String = path.to_string_lossy().bytes().map(escaped).collect();
    if path.is_absolute() {
        format!("file://{out}")
    } else {
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_become_references() {
        assert_eq!(uri(Path::new("a b/ب:1.png")), "a%20b/%D8%A8%3A1.png");
        assert_eq!(uri(Path::new("/x/y.png")), "file:///x/y.png");
    }
}
