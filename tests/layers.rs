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

/// The code of a file without comments.
fn code(text: &str) -> String {
    let lines = text.lines().filter(|l| !l.trim_start().starts_with("//"));
    lines.collect::<Vec<_>>().join("\n")
}

/// The paths of a tree as `use` has them, and what follows it.
fn tree(text: &str) -> (Vec<Vec<&str>>, &str) {
    let text = text.trim_start();
    if let Some(mut rest) = text.strip_prefix('{') {
        let mut all = Vec::new();
        loop {
            rest = rest.trim_start_matches(|c: char| c == ',' || c.is_whitespace());
            let (paths, after) = tree(rest);
            if paths.is_empty() {
                return (all, after);
            }
            all.extend(paths);
            rest = after;
        }
    }
    let end = text.find(|c: char| !c.is_alphanumeric() && c != '_');
    let (word, rest) = text.split_at(end.unwrap_or(text.len()));
    if word.is_empty() {
        return (Vec::new(), rest.get(1..).unwrap_or_default());
    }
    let Some(below) = rest.strip_prefix("::") else {
        // a name of its own is a name of ours
        let named = rest.strip_prefix(" as ").map(|other| tree(other).1);
        return (vec![vec![word]], named.unwrap_or(rest));
    };
    let (mut paths, rest) = tree(below);
    if paths.is_empty() {
        paths.push(Vec::new());
    }
    paths.iter_mut().for_each(|p| p.insert(0, word));
    (paths, rest)
}

/// The paths in a file's code that begin with a word, such as `crate`.
fn paths<'a>(code: &'a str, first: &str) -> Vec<Vec<&'a str>> {
    let head = format!("{first}::");
    let begins = code.match_indices(&head).map(|(i, _)| i);
    let whole = begins.filter(|&i| {
        let before = code[..i].chars().next_back();
        before.is_none_or(|c| !c.is_alphanumeric() && c != '_' && c != ':')
    });
    whole.flat_map(|i| tree(&code[i..]).0).collect()
}

/// The modules named after `crate::` in a file; of a list in braces, over however many lines, all.
fn named(text: &str) -> Vec<String> {
    let code = code(text);
    let seconds = paths(&code, "crate")
        .into_iter()
        .map(|p| p.get(1).map(|w| (*w).to_owned()));
    seconds.flatten().collect()
}

#[test]
fn names_are_found_in_lists_over_lines() {
    let text = "use crate::{\n    corner::{Detector, sides::Sides},\n    types::Contour,\n};\n// crate::fit\ncrate::scan::whole()";
    assert_eq!(named(text), ["corner", "corner", "types", "scan"]);
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

/// The module of a file: its folders and its name.
fn module(path: &str) -> Vec<&str> {
    let stem = path.trim_end_matches(".rs");
    stem.trim_end_matches("/mod").split('/').collect()
}

/// Where a path of a module's code leads, from the root.
fn resolved<'a>(module: &[&'a str], path: &[&'a str]) -> Vec<&'a str> {
    let up = path.iter().take_while(|w| **w == "super").count();
    let base = match path.first() {
        Some(&"crate") => &[][..],
        _ => &module[..module.len().saturating_sub(up)],
    };
    let down = path.iter().filter(|w| !matches!(**w, "crate" | "super"));
    base.iter().chain(down).copied().collect()
}

#[test]
fn no_files_name_each_other_in_a_circle() {
    let files: Vec<_> = sources()
        .into_iter()
        .filter(|(p, _)| !p.contains("tests"))
        .collect();
    let tested = |text: &str| text.find("#[cfg(test)]\nmod tests {").unwrap_or(text.len());
    let code: Vec<String> = files
        .iter()
        .map(|(_, text)| code(&text[..tested(text)]))
        .collect();
    let modules: Vec<_> = files.iter().map(|(path, _)| module(path)).collect();
    let names = |m: &Vec<&str>, code: &'_ str| -> Vec<usize> {
        let all = paths(code, "crate").into_iter().chain(paths(code, "super"));
        let leads = all.filter_map(|path| {
            let path = resolved(m, &path.iter().map(|w| &**w).collect::<Vec<_>>());
            (1..=path.len())
                .rev()
                .find_map(|n| modules.iter().position(|o| *o == path[..n]))
        });
        // a folder and what is in it are one room
        leads
            .filter(|&o| !m.starts_with(&modules[o]) && !modules[o].starts_with(m))
            .collect()
    };
    let arrows: Vec<Vec<usize>> = modules
        .iter()
        .zip(&code)
        .map(|(m, c)| names(m, c))
        .collect();
    assert!(
        arrows.iter().map(Vec::len).sum::<usize>() > 500,
        "few arrows were found"
    );
    let mut left: Vec<usize> = (0..files.len()).collect();
    loop {
        let (stay, done): (Vec<usize>, Vec<usize>) = left
            .iter()
            .partition(|&&i| arrows[i].iter().any(|o| left.contains(o)));
        left = stay;
        if done.is_empty() {
            break;
        }
    }
    let circle: Vec<&str> = left.iter().map(|&i| files[i].0.as_str()).collect();
    assert!(
        circle.is_empty(),
        "a circle, and what leads to it: {circle:?}"
    );
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
