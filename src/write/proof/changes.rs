//! What has changed since the build before, which the page itself remembers.
//!
//! The page holds every glyph as it is and those that differ as they were. The next build reads both from it: where
//! nothing has changed in the meantime, what was before stays, so the same build gives the same page.

use super::Entry;
use super::draw::path_data;
use crate::numeric::distance::{Polyline, distances};
use kurbo::{Affine, BezPath, Point, flatten};
use maud::{Markup, PreEscaped, html};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// What stands before the memory in the page.
const HEAD: &str = "<script type=\"application/json\" id=\"memory\">";
/// What stands after it.
const TAIL: &str = "</script>";
/// Chords leave the measured curves by no more than this, font units.
const CHORD: f64 = 0.05;

/// A glyph: its advance and its path in user space, font units with y down, as the page draws it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
struct Drawing {
    advance: String,
    path: String,
}

/// The glyphs as they are, and as they were where they differ.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Memory {
    now: BTreeMap<String, Drawing>,
    /// None is a glyph that did not exist.
    before: BTreeMap<String, Option<Drawing>>,
}

/// How a glyph differs from the build before.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Change {
    /// Largest distance between the two outlines, font units; none where one of them has no points.
    pub(super) moved: Option<f64>,
    /// The advance as it was, and as it is.
    advance: (Option<String>, Option<String>),
    /// The path as it was.
    pub(super) path: String,
}

impl Memory {
    /// What the page of the build before and these glyphs give together.
    pub(super) fn new(entries: &[Entry], last: Option<&str>) -> Self {
        let drawing = |e: &Entry| {
            let path = Affine::FLIP_Y * e.glyph.outline.to_path();
            let drawing = Drawing {
                advance: format!("{:.0}", e.glyph.advance),
                path: path_data(&path),
            };
            (e.glyph.name.to_string(), drawing)
        };
        let now: BTreeMap<String, Drawing> = entries.iter().map(drawing).collect();
        match last.and_then(Self::read) {
            None => Self {
                now,
                before: BTreeMap::new(),
            },
            Some(last) if last.now == now => last,
            Some(last) => {
                let gone = last
                    .now
                    .iter()
                    .filter(|(name, was)| now.get(*name) != Some(was));
                let gone = gone.map(|(name, was)| (name.clone(), Some(was.clone())));
                let new = now.keys().filter(|name| !last.now.contains_key(*name));
                let before = gone.chain(new.map(|name| (name.clone(), None))).collect();
                Self { now, before }
            }
        }
    }

    /// The memory of a page; nothing where it has none, or one that no build wrote.
    fn read(page: &str) -> Option<Self> {
        let (_, rest) = page.split_once(HEAD)?;
        let (json, _) = rest.split_once(TAIL)?;
        let memory: Self = serde_json::from_str(json).ok()?;
        let all = memory.now.values().chain(memory.before.values().flatten());
        let mut paths = all.map(|d| BezPath::from_svg(&d.path));
        paths
            .all(|p| p.is_ok_and(|p| p.is_finite()))
            .then_some(memory)
    }

    /// The memory as a part of the page.
    pub(super) fn markup(&self) -> Markup {
        // no tag may begin in a script
        let json = serde_json::to_string(self).unwrap_or_default();
        PreEscaped(format!("{HEAD}{}{TAIL}", json.replace('<', "\\u003c")))
    }

    /// How a glyph has changed, where it has.
    pub(super) fn change(&self, name: &str) -> Option<Change> {
        let was = self.before.get(name)?.as_ref();
        let is = self.now.get(name);
        let path = |d: Option<&Drawing>| d.map(|d| d.path.clone()).unwrap_or_default();
        let advance = |d: Option<&Drawing>| d.map(|d| d.advance.clone());
        Some(Change {
            moved: apart(&path(was), &path(is)),
            advance: (advance(was), advance(is)),
            path: path(was),
        })
    }

    /// Whether anything has changed.
    pub(super) fn is_empty(&self) -> bool {
        self.before.is_empty()
    }

    /// The list of what has changed, the greatest change first; glyphs that came or went before all.
    pub(super) fn list(&self) -> Markup {
        let changes = self
            .before
            .keys()
            .filter_map(|n| Some((n, self.change(n)?)));
        let mut changes: Vec<(&String, Change)> = changes.collect();
        let size = |c: &Change| c.moved.unwrap_or(f64::INFINITY);
        changes.sort_by(|a, b| size(&b.1).total_cmp(&size(&a.1)));
        html! {
            @if !changes.is_empty() {
                details #changes open {
                    summary { "Changed since the build before: " (changes.len()) }
                    table {
                        tr { th { "glyph" } th { "outline moved by, units" } th { "advance" } }
                        @for (name, change) in &changes {
                            tr {
                                td { a href=(format!("#glyph-{name}")) { (name) } }
                                td { (change.distance()) }
                                td { (change.advances()) }
                            }
                        }
                    }
                }
            }
        }
    }
}

impl Change {
    /// How far the outline has moved, in words.
    pub(super) fn distance(&self) -> String {
        match (&self.advance, self.moved) {
            ((None, _), _) => "new".to_owned(),
            ((_, None), _) => "gone".to_owned(),
            (_, Some(moved)) => format!("{moved:.2}"),
            _ => "drawn or emptied".to_owned(),
        }
    }

    fn advances(&self) -> String {
        match &self.advance {
            (Some(was), Some(is)) if was == is => is.clone(),
            (was, is) => {
                let text = |a: &Option<String>| a.clone().unwrap_or_else(|| "–".to_owned());
                format!("{} → {}", text(was), text(is))
            }
        }
    }
}

/// The largest distance of a point of either path to the other; nothing where one has no points.
fn apart(a: &str, b: &str) -> Option<f64> {
    let (a, b) = (rings(a)?, rings(b)?);
    let far = |from: &[Vec<Point>], to: &[Vec<Point>]| {
        let lines: Vec<Polyline> = to.iter().cloned().filter_map(Polyline::new).collect();
        let each = from
            .iter()
            .flat_map(|ring| distances(ring.iter().copied(), &lines));
        each.map(|(_, d)| d).fold(0.0, f64::max)
    };
    Some(far(&a, &b).max(far(&b, &a)))
}

/// The chords of a path, contour by contour; nothing where there are none.
fn rings(path: &str) -> Option<Vec<Vec<Point>>> {
    let path = BezPath::from_svg(path).ok()?;
    let mut rings: Vec<Vec<Point>> = Vec::new();
    flatten(&path, CHORD, |el| match el {
        kurbo::PathEl::MoveTo(p) => rings.push(vec![p]),
        _ => {
            if let Some(ring) = rings.last_mut() {
                let end = el.end_point().or_else(|| ring.first().copied());
                ring.extend(end);
            }
        }
    });
    (!rings.is_empty()).then_some(rings)
}
