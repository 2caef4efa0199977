//! A web page that shows every cell with its outline over the scan, and text set in the font.
//!
//! One self-contained file: pictures, font, style and script are inside. Everything that a user wrote is
//! escaped by the template.

mod budget;
mod changes;
mod draw;
mod shapes;
mod text;

use crate::types::{Frame, Glyph, Info, Png};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use changes::Memory;
use draw::{Drawn, picture};
use kurbo::Point;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use std::collections::BTreeSet;

/// A cell and the glyph that became of it.
#[derive(Debug, Clone)]
pub struct Entry {
    /// The page, as messages name it.
    pub sheet: String,
    /// Position in the page's reading order, from 0.
    pub index: usize,
    /// The cell's picture.
    pub picture: Png,
    /// From the picture's px (y up) to font units.
    pub frame: Frame,
    /// The scanned edge, contour by contour, font units; with each point its distance to the compiled outline.
    pub edge: Vec<Vec<(Point, f64)>>,
    /// The glyph as it stands in the font, cubics.
    pub glyph: Glyph,
    /// What text it stands for: one character, or the parts of a ligature.
    pub text: String,
    /// What to look at in it.
    pub remarks: Vec<String>,
    /// Each step from the scan to the font's file, and the largest distance that it adds, font units; the same
    /// steps for every entry.
    pub steps: [(&'static str, f64); 4],
    /// Millimetres of paper that a font unit measured, where that is known.
    pub mm_per_unit: Option<f64>,
}

/// Ink of a page that is in no glyph.
#[derive(Debug, Clone)]
pub struct LeftOut {
    /// The page, as messages name it.
    pub sheet: String,
    /// Left, top, right and bottom in the page's picture, px.
    pub box_px: [f64; 4],
    /// px²
    pub area_px: usize,
    /// Why.
    pub reason: String,
}

/// All that the page shows.
#[derive(Debug, Clone, Copy)]
pub struct Proof<'a> {
    /// What the font says about itself.
    pub info: &'a Info,
    /// Its cells in reading order.
    pub entries: &'a [Entry],
    /// The ink that is in none of them.
    pub left_out: &'a [LeftOut],
    /// The characters that it can set, composed ones too.
    pub characters: &'a BTreeSet<char>,
    /// The font as WOFF2.
    pub woff2: &'a [u8],
    /// The page of the build before, where there was one: what has changed since is shown.
    pub last: Option<&'a str>,
}

/// The layers that can be switched, with their keys.
const LAYERS: &[(&str, &str, bool)] = &[
    ("scan", "Scan", true),
    ("fill", "Fill", false),
    ("outline", "Outline", true),
    ("nodes", "Nodes", true),
    ("handles", "Handles", true),
    ("guides", "Baseline and advance", true),
    ("extrema", "Corners and extrema", false),
    ("comb", "Curvature comb", false),
    ("heat", "Deviation", false),
    (BEFORE, "Before", true),
];

/// The layer of glyphs as they were, which only a page with changes has.
const BEFORE: &str = "before";

/// The page.
#[must_use]
pub fn page(proof: &Proof<'_>) -> String {
    let info = proof.info;
    let title = format!("{} {}", info.family, info.style);
    let memory = Memory::new(proof.entries, proof.last);
    let off: Vec<String> = LAYERS
        .iter()
        .filter(|(_, _, on)| !on)
        .map(|(key, ..)| format!("no-{key}"))
        .collect();
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (title) ": proof" }
                style { (PreEscaped(face(proof.woff2))) (PreEscaped(include_str!("proof.css"))) }
            }
            body class=(off.join(" ")) {
                header {
                    h1 { (title) }
                    p { "Version " (info.version.0) "." (format!("{:03}", info.version.1)) ", "
                        (proof.entries.len()) " glyphs from " (sheets(proof)) ", " (info.units_per_em) " units an em" }
                }
                (text::specimen(proof.entries, proof.characters))
                (controls(&memory))
                (memory.list())
                main { @for entry in proof.entries { (cell(entry, info, &memory)) } }
                (budget::table(proof.entries))
                (left_out(proof.left_out))
                (memory.markup())
                script { (PreEscaped(include_str!("proof.js"))) }
            }
        }
    };
    page.into_string()
}

/// The rule that embeds the font.
fn face(woff2: &[u8]) -> String {
    let data = STANDARD.encode(woff2);
    format!(
        "@font-face{{font-family:proofed;src:url(data:font/woff2;base64,{data}) format(\"woff2\")}}\n"
    )
}

fn sheets(proof: &Proof<'_>) -> String {
    let mut names: Vec<&str> = proof.entries.iter().map(|e| e.sheet.as_str()).collect();
    names.dedup();
    names.join(", ")
}

fn controls(memory: &Memory) -> Markup {
    let layers = LAYERS
        .iter()
        .filter(|l| l.0 != BEFORE || !memory.is_empty());
    html! {
        nav {
            @for (i, (key, label, on)) in layers.enumerate() {
                label { input type="checkbox" data-layer=(key) checked[*on]; kbd { ((i + 1) % 10) } " " (label) }
            }
            label { "Order " select id="order" {
                option value="page" { "as on the page" }
                option value="worst" { "worst first" }
                @if !memory.is_empty() { option value="changed" { "most changed first" } }
                option value="name" { "by name" }
            } }
            label { "Size " input type="range" id="size" min="120" max="900" value="240"; }
        }
    }
}

fn left_out(pieces: &[LeftOut]) -> Markup {
    html! {
        @if !pieces.is_empty() {
            details {
                summary { "Ink in no glyph: " (pieces.len()) }
                table {
                    tr { th { "page" } th { "left, top, right, bottom, px" } th { "px²" } th { "why" } }
                    @for piece in pieces {
                        tr {
                            td { (piece.sheet) }
                            td { (piece.box_px.map(|v| format!("{v:.0}")).join(", ")) }
                            td { (piece.area_px) }
                            td { (piece.reason) }
                        }
                    }
                }
            }
        }
    }
}

fn cell(entry: &Entry, info: &Info, memory: &Memory) -> Markup {
    let drawn = Drawn::new(entry, info);
    let worst = budget::worst(entry);
    let name = entry.glyph.name.as_str();
    let change = memory.change(name);
    // a new glyph has changed more than any other
    let changed = change.as_ref().map(|c| c.moved.unwrap_or(99_999.0));
    html! {
        figure id=(format!("glyph-{name}")) data-name=(name) data-worst=(format!("{worst:.2}")) data-changed=(changed.unwrap_or(-1.0)) {
            svg viewBox=(drawn.view_box) role="img" aria-label=(name) {
                g.scan { image href=(picture(&entry.picture)) transform=(drawn.picture) width=(entry.picture.width) height=(entry.picture.height) {} }
                path.guides d=(drawn.guides) {}
                path.fill d=(drawn.path) {}
                @if let Some(change) = change.as_ref().filter(|c| !c.path.is_empty()) { path.before d=(change.path) {} }
                path.outline d=(drawn.path) {}
                path.comb d=(shapes::comb(&entry.glyph.outline, info)) {}
                @for (class, d) in shapes::heat(&entry.edge, info) { path class={ "heat " (class) } d=(d) {} }
                path.handles d=(drawn.handles) {}
                path.nodes.off d=(drawn.off_curve) {}
                path.nodes d=(drawn.on_curve) {}
                path.extrema d=(shapes::extrema(&entry.glyph.outline)) {}
                path.extrema.corner d=(shapes::corners(&entry.glyph.outline)) {}
            }
            figcaption {
                b { (name) } " "
                span.sample lang=(text::language(&entry.text)) { (entry.text) }
                br;
                small { (entry.sheet) ", cell " (entry.index + 1) " · " (drawn.count) " nodes · advance " (drawn.advance) " · worst " (budget::length(worst, " units", entry.mm_per_unit)) }
                @if let Some(change) = &change { p.changed { "since the build before: " (change.distance()) } }
                @for remark in &entry.remarks { p.remark { (remark) } }
            }
        }
    }
}

#[cfg(test)]
mod tests;
