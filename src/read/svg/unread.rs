//! What stands in a drawing and is not drawn.

use svgtypes::PathParser;
use usvg::roxmltree::{Document, Node};

/// Elements that are drawn where others refer to them, or not at all.
const ASIDE: [&str; 14] = [
    "clipPath",
    "defs",
    "desc",
    "filter",
    "linearGradient",
    "marker",
    "mask",
    "metadata",
    "pattern",
    "radialGradient",
    "script",
    "style",
    "symbol",
    "title",
];
/// How deep elements refer to each other: more than any drawing nests, and it ends a reference in a circle.
const DEEPEST: usize = 8;
/// As much of a path as is shown.
const SHOWN: usize = 12;

/// The elements of a drawing that are no outlines or cannot be read.
pub(super) fn unread(document: &Document<'_>) -> Vec<String> {
    let mut out = Vec::new();
    let root = document.root_element();
    inside(root, DEEPEST, &mut out);
    out.sort();
    out.dedup();
    out
}

fn inside(parent: Node<'_, '_>, deep: usize, out: &mut Vec<String>) {
    for node in parent.children().filter(Node::is_element) {
        element(node, deep, out);
    }
}

fn element(node: Node<'_, '_>, deep: usize, out: &mut Vec<String>) {
    let name = node.tag_name().name();
    if ASIDE.contains(&name) || node.attribute("display") == Some("none") {
        return;
    }
    match name {
        "text" | "image" | "foreignObject" => out.push(name.to_owned()),
        "path" => {
            let d = node.attribute("d").unwrap_or_default();
            if PathParser::from(d).any(|s| s.is_err()) {
                let start: String = d.chars().take(SHOWN).collect();
                out.push(format!("path of d=\"{start}…\""));
            }
        }
        "use" => used(node, deep, out),
        _ => inside(node, deep, out),
    }
}

/// What a reference leads to.
fn used(node: Node<'_, '_>, deep: usize, out: &mut Vec<String>) {
    let href = node.attributes().find(|a| a.name() == "href");
    let href = href.map_or("", |a| a.value());
    let all = node.document().descendants();
    let id = href.strip_prefix('#');
    let target = id.and_then(|id| all.into_iter().find(|n| n.attribute("id") == Some(id)));
    match target {
        Some(symbol) if deep > 0 && symbol.tag_name().name() == "symbol" => {
            inside(symbol, deep - 1, out);
        }
        Some(target) if deep > 0 => element(target, deep - 1, out),
        _ => out.push(format!("use of {href}")),
    }
}
