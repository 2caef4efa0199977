//! Arrows run one way: which module may name which.

use std::{fs, path::Path};

/// Module → what it may name after `crate::`. `types` and `numeric` lie at the bottom and import
/// nothing of ours; no stage names another stage; only the pipeline knows them all.
const MAY_NAME: &[(&str, &[&str])] = &[
    ("types", &[]),
    ("numeric", &[]),
    ("scan", &["types", "numeric"]),
    ("trace", &["types", "numeric"]),
    ("corner", &["types", "numeric"]),
    ("fit", &["types", "numeric"]),
    ("refine", &["types", "numeric"]),
    ("recognise", &["types", "numeric"]),
    ("finish", &["types", "numeric"]),
    ("quadratic", &["types", "numeric"]),
    ("code", &["types", "numeric"]),
    ("assemble", &["types", "numeric"]),
    ("write", &["types", "numeric"]),
    ("read", &["types", "numeric"]),
    ("template", &["types", "numeric"]),
];

/// Every Rust file below `src/`, sorted, with its text.
pub(crate) fn sources() -> Vec<(String, String)> {
    fn walk(dir: &Path, out: &mut Vec<(String, String)>) {
        for entry in fs::read_dir(dir).expect("a folder of sources") {
            let path = entry.expect("an entry of the folder").path();
            if path.is_dir() {
                walk(&path, out);
            } else if path.extension().is_some_and(|e| e == "rs") {
                let text = fs::read_to_string(&path).expect("a source file");
                out.push((path.display().to_string(), text));
            }
        }
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut out = Vec::new();
    walk(&root, &mut out);
    let prefix = format!("{}/", root.display());
    out.iter_mut()
        .for_each(|(p, _)| *p = p.trim_start_matches(&prefix).to_owned());
    out.sort();
    out
}

/// The modules named after `crate::` in a file, comments left out; of a list in braces, over however many lines, all.
fn named(text: &str) -> Vec<String> {
    let code: Vec<&str> = text
        .lines()
        .filter(|l| !l.trim_start().starts_with("//"))
        .collect();
    let first_word = |w: &str| -> String {
        let letters = w.trim_start().chars();
        letters
            .take_while(|c| c.is_alphanumeric() || *c == '_')
            .collect()
    };
    let mut out = Vec::new();
    for rest in code.join("\n").split("crate::").skip(1) {
        match rest.strip_prefix('{') {
            Some(list) => out.extend(top_level(list).into_iter().map(first_word)),
            None => out.push(first_word(rest)),
        }
    }
    out.retain(|w| !w.is_empty());
    out
}

/// The items of a list in braces, from behind its opening to its own closing one.
fn top_level(list: &str) -> Vec<&str> {
    let (mut out, mut start, mut depth) = (Vec::new(), 0, 0);
    for (i, c) in list.char_indices() {
        match c {
            '{' => depth += 1,
            '}' if depth > 0 => depth -= 1,
            ',' | '}' if depth == 0 => {
                out.push(&list[start..i]);
                start = i + 1;
            }
            _ => {}
        }
        if c == '}' && start == i + 1 {
            break;
        }
    }
    out
}

#[test]
fn names_are_found_in_lists_over_lines() {
    let text = "use crate::{\n    corner::{Detector, sides::Sides},\n    types::Contour,\n};\n// crate::fit\ncrate::scan::whole()";
    assert_eq!(named(text), ["corner", "types", "scan"]);
}

#[test]
fn stages_name_only_what_lies_below() {
    let files = sources();
    assert!(
        files.len() >= 20,
        "the scan found only {} sources",
        files.len()
    );
    let mut seen = vec![false; MAY_NAME.len()];
    for (path, text) in &files {
        let module = path.split(['/', '.']).next().unwrap_or_default();
        let Some(i) = MAY_NAME.iter().position(|(m, _)| *m == module) else {
            continue;
        };
        seen[i] = true;
        for name in named(text) {
            let fine = name == module || MAY_NAME[i].1.contains(&name.as_str());
            assert!(
                fine,
                "{path} names crate::{name}; {module} may name only {:?}",
                MAY_NAME[i].1
            );
        }
    }
    let missing: Vec<_> = MAY_NAME
        .iter()
        .zip(&seen)
        .filter(|(_, s)| !**s)
        .map(|(m, _)| m.0)
        .collect();
    assert!(missing.is_empty(), "no source of {missing:?}");
}

#[test]
fn the_program_uses_the_public_library() {
    let cli: Vec<_> = sources()
        .into_iter()
        .filter(|(p, _)| p.starts_with("cli/"))
        .collect();
    for (path, text) in cli {
        for name in named(&text) {
            assert!(
                name == "cli",
                "{path} names crate::{name}: the program must use khatt::{name}"
            );
        }
    }
}
