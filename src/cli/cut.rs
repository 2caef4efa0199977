//! `khatt cut`: the cells of a project's pages as pictures, and where they come from.

use super::failure::Failure;
use super::files::is_dash;
use super::project::Opened;
use super::{Common, Outcome, staged};
use clap::Args;
use khatt::pipeline::project::{CellTable, Cells, Content, Layout, Project, SheetTable};
use khatt::pipeline::{self, Inputs, Page};
use khatt::scan::{self, Tones, Warning};
use khatt::types::{Cell, Files, Png};
use kurbo::Rect;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Writes the cells of the project's pages as pictures, with a list of them in cells.json
#[derive(Debug, Args)]
pub(crate) struct Cut {
    /// Project file
    #[arg(value_name = "PROJECT.toml")]
    project: PathBuf,
    /// Folder for the pictures
    #[arg(
        short,
        long,
        value_name = "DIR",
        required_unless_present = "write_overrides"
    )]
    output: Option<PathBuf>,
    /// Also write where each letter was found, to be corrected: `cells_file` of the project; - prints it
    #[arg(long, value_name = "CELLS.toml")]
    write_overrides: Option<PathBuf>,
}

impl Cut {
    pub(crate) fn run(&self, common: &Common) -> Outcome {
        if self.output.as_deref().is_some_and(is_dash) {
            let what = "- is standard output, and the cells' pictures are a folder of files";
            return Err(Failure::of_use(what).help("name a folder: -o DIR"));
        }
        let opened = Opened::new(&self.project)?;
        let mut targets = self.output.iter().chain(&self.write_overrides);
        targets.try_for_each(|target| opened.spare(target, None))?;
        let ((pages, notes), ..) = opened.work(common, |project, world| {
            let pages = pipeline::pages(project, world, |page| {
                let table = project.sheets.get(page.table);
                let found = table.map_or_else(Cells::new, |t| found(&page, t));
                Ok((entry(&page), found, warnings(&page)))
            })?;
            Ok((pages, unasked(project, &opened)))
        })?;
        let (mut files, mut list, mut cells) = (Files::default(), Vec::new(), Cells::new());
        let mut said = String::new();
        for ((pictures, entry), found, warnings) in pages {
            said.push_str(&warnings);
            files.0.extend(pictures);
            list.push(entry);
            cells.extend(found);
        }
        let text = format!("{:#}\n", Value::Array(list));
        files.0.insert("cells.json".to_owned(), text.into_bytes());
        let mut outputs = Vec::new();
        if let Some(output) = &self.output {
            outputs.push((output.clone(), files));
        }
        if let Some(path) = &self.write_overrides {
            let tables = toml::to_string(&cells).map_err(|e| Failure::at(path.display(), &e))?;
            let text = format!("{HEAD}{tables}");
            outputs.push((path.clone(), Files::single(text.into_bytes())));
        }
        staged::write(&outputs, &opened.named())?;
        if !common.quiet {
            eprint!("{said}{notes}");
        }
        Ok(())
    }
}

/// What stands above the corrections.
const HEAD: &str = "\
# Where khatt found each letter; name this file in the project file: cells_file = \"…\", above its first table.
# Change what is wrong and delete the rest: box (left, top, right, bottom, px of the picture) or polygon,
# rotation (degrees clockwise), baseline_shift (font units upwards), threshold (0.1 to 0.9), ignore = true, trace.

";

/// What to look at on a page, a line each; cells of which the same is said share one.
pub(super) fn warnings(page: &Page) -> String {
    let mut said: Vec<Vec<&Warning>> = Vec::new();
    for warning in &page.cut.warnings {
        let alike = |of: &&mut Vec<&Warning>| {
            warning.index.is_some() && of.iter().any(|w| w.message == warning.message)
        };
        match said.iter_mut().find(alike) {
            Some(of) => of.push(warning),
            None => said.push(vec![warning]),
        }
    }
    let line = |of: &Vec<&Warning>| match of.as_slice() {
        [one] => format!("warning: {}, {one}\n", page.name),
        [] => String::new(),
        [one, ..] => format!("warning: {}, {}: {}\n", page.name, cells(of), one.message),
    };
    said.iter().map(line).collect()
}

/// The cells of some warnings; runs by their ends.
fn cells(warnings: &[&Warning]) -> String {
    let place = |w: &Warning| {
        let number = w.index.map_or(0, |i| i + 1);
        let label = w.label.as_ref().map(|l| format!(" “{}”", l.0));
        format!("{number}{}", label.unwrap_or_default())
    };
    let follows = |a: &&Warning, b: &&Warning| a.index.map(|i| i + 1) == b.index;
    let run = |run: &[&Warning]| match run {
        [first, _, .., last] => format!("{} to {}", place(first), place(last)),
        few => few.iter().map(|w| place(w)).collect::<Vec<_>>().join(", "),
    };
    let runs: Vec<String> = warnings.chunk_by(follows).map(run).collect();
    format!("cells {}", runs.join(", "))
}

/// Pictures that say how much light their numbers stand for, and are not asked: a line each.
fn unasked(project: &Project, inputs: &dyn Inputs) -> String {
    let sheets = project.sheets.iter();
    let linear = sheets.filter(|s| s.tones == Tones::Linear);
    let images: BTreeSet<_> = linear.flat_map(|s| &s.image).collect();
    let says = |path: &Path| {
        let bytes = inputs.read(path);
        bytes.is_ok_and(|b| scan::describes_light(&b))
    };
    let said = images.into_iter().filter(|path| says(path));
    let line = |path: &PathBuf| {
        format!(
            "note: {} says itself how much light its numbers stand for, and is read as if they were light; scanned or \
             photographed strokes come out too thin unless `tones` is \"profile\"\n",
            path.display()
        )
    };
    said.map(line).collect()
}

/// Where a page's letters were found; a template's page says that itself, and words are no letters to correct.
fn found(page: &Page, table: &SheetTable) -> Cells {
    let free = table.layout != Layout::Template;
    let letters = page.cut.cells.iter();
    let letters = letters.filter(|_| table.content == Content::Letters);
    let cells = letters.map(|c| {
        let table = CellTable {
            bounds: free.then(|| corners(c.in_sheet)),
            rotation: free.then_some(0.0),
            baseline_shift: Some(0.0),
            ..CellTable::default()
        };
        (c.label.0.clone(), table)
    });
    cells.collect()
}

/// The pictures of a page's cells and its entry in the list.
fn entry(page: &Page) -> (Vec<(String, Vec<u8>)>, Value) {
    let cut = &page.cut;
    let name = |c: &Cell| format!("{:02}-{:03}.png", page.table + 1, c.index + 1);
    let pictures = cut
        .cells
        .iter()
        .map(|c| (name(c), Png::of(&scan::upright(&c.gray)).bytes));
    let cells = cut.cells.iter().map(|c| {
        json!({
            "cell": c.index + 1,
            "label": c.label.0,
            "picture": name(c),
            "box_px": corners(c.in_sheet),
            "to_sheet": c.to_sheet.as_coeffs(),
            "baseline_px": c.guides.baseline_px,
            "pixels_per_em": c.guides.px_per_em,
        })
    });
    let removed = cut.rejected.iter().map(|r| {
        json!({
            "box_px": corners(r.in_sheet),
            "area_px": r.area_px,
            "reason": r.reason.to_string(),
        })
    });
    let warnings = cut.warnings.iter().map(|w| {
        json!({
            "cell": w.index.map(|i| i + 1),
            "message": w.message,
        })
    });
    let entry = json!({
        "sheet": page.name,
        "skew_deg": cut.skew_deg,
        "to_upright": cut.upright.as_coeffs(),
        "cells": cells.collect::<Vec<_>>(),
        "removed": removed.collect::<Vec<_>>(),
        "specks": cut.specks,
        "warnings": warnings.collect::<Vec<_>>(),
    });
    (pictures.collect(), entry)
}

/// Left, top, right and bottom.
fn corners(r: Rect) -> [f64; 4] {
    [r.x0, r.y0, r.x1, r.y1]
}

#[cfg(test)]
mod tests {
    use super::*;
    use khatt::types::Label;

    #[test]
    fn cells_of_one_remark_are_runs() {
        let warning = |i: usize| Warning {
            index: Some(i),
            label: Some(Label(format!("{i}"))),
            message: "odd".to_owned(),
        };
        let told = |of: &[usize]| {
            let all: Vec<Warning> = of.iter().map(|&i| warning(i)).collect();
            cells(&all.iter().collect::<Vec<_>>())
        };
        assert_eq!(told(&[2, 3, 4, 6]), "cells 3 “2” to 5 “4”, 7 “6”");
        assert_eq!(told(&[2, 3]), "cells 3 “2”, 4 “3”");
    }
}
