//! Where the distance between scan and font comes from, a row a glyph.

use super::Entry;
use crate::numeric;
use maud::{Markup, html};

/// Units, and millimetres of paper where these are known; `unit` stands between both.
pub(super) fn length(units: f64, unit: &str, mm_per_unit: Option<f64>) -> String {
    match mm_per_unit {
        Some(mm) => format!("{units:.2}{unit} ({:.3} mm)", units * mm),
        None => format!("{units:.2}{unit}"),
    }
}

/// The largest finite distance between a glyph's scanned edge and its compiled outline, font units.
pub(super) fn worst(entry: &Entry) -> f64 {
    numeric::distance::largest(&entry.edge)
}

/// The table, the worst glyph first.
pub(super) fn table(entries: &[Entry]) -> Markup {
    let mut rows: Vec<(&Entry, f64)> = entries.iter().map(|e| (e, worst(e))).collect();
    rows.sort_by(|a, b| b.1.total_cmp(&a.1));
    let steps = rows.first().map_or(&[][..], |(e, _)| e.steps.as_slice());
    html! {
        @if !rows.is_empty() {
            details #budget {
                summary { "From the scan to the font's file: largest distances, units (and mm on paper)" }
                table {
                    tr { th { "glyph" } @for (step, _) in steps { th { (step) } } th { "all together" } }
                    tr.median {
                        td { "median" }
                        @for k in 0..steps.len() { td { (format!("{:.2}", median(&rows, |e, _| e.steps[k].1))) } }
                        td { (format!("{:.2}", median(&rows, |_, worst| worst))) }
                    }
                    @for (entry, worst) in &rows {
                        tr {
                            td { a href=(format!("#glyph-{}", entry.glyph.name)) { (entry.glyph.name) } }
                            @for (_, units) in &entry.steps { td { (length(*units, "", entry.mm_per_unit)) } }
                            td { (length(*worst, "", entry.mm_per_unit)) }
                        }
                    }
                }
            }
        }
    }
}

/// The value in the middle.
fn median(rows: &[(&Entry, f64)], value: impl Fn(&Entry, f64) -> f64) -> f64 {
    numeric::median::median(rows.iter().map(|(e, worst)| value(e, *worst))).unwrap_or_default()
}
