//! What a user says better about single letters than the page does.

use super::labels::{SKIP, skips};
use super::picture;
use super::problem::{Problem, unless};
use super::project::{CellTable, Cells, Project};
use super::world::World;
use crate::assemble::names;
use crate::numeric::tone;
use crate::scan::{Cut, Pin, Region};
use crate::types::{Label, Name};
use std::collections::{BTreeMap, BTreeSet};

/// The project with the corrections of the file that it names among its own, which go before them.
///
/// # Errors
/// The file cannot be read, or is none of corrections.
pub(super) fn gathered(project: &Project, world: World<'_>) -> Result<Project, Problem> {
    let mut project = project.clone();
    if let Some(path) = project.cells_file.take() {
        let bytes = world.file(&path)?;
        let read = toml::from_str(&String::from_utf8_lossy(&bytes));
        let cells: Cells = read.map_err(|e| Problem::CellsFile {
            file: path.display().to_string(),
            why: e.to_string().trim_end().to_owned(),
        })?;
        // a glyph has several spellings
        let name = |key: &String| Some(names::identify(&Label(key.clone())).ok()?.name);
        let own: BTreeSet<Name> = project.cells.keys().filter_map(name).collect();
        let others = cells.into_iter();
        let others = others.filter(|(key, _)| name(key).is_none_or(|n| !own.contains(&n)));
        project.cells.extend(others);
    }
    Ok(project)
}

/// The corrections of a project by the glyphs' names in the font.
#[derive(Debug, Default)]
pub(super) struct Corrections(BTreeMap<Name, (CellTable, Option<Region>)>);

impl Corrections {
    /// Those of a project.
    ///
    /// # Errors
    /// A table says two things at once, or names no glyph or that of another table.
    pub(super) fn of(project: &Project) -> Result<Self, Vec<Problem>> {
        let (mut out, mut problems) = (Self::default(), Vec::new());
        for (key, table) in project.cells.clone() {
            let name = names::identify(&Label(key.clone())).map_err(|e| e.to_string());
            match name.and_then(|n| Ok((n.name, table.region()?))) {
                Ok((name, _)) if out.0.contains_key(&name) => problems.push(Problem::Correction {
                    why: format!("two tables are of the glyph {name}; keep one"),
                    name: key,
                }),
                Ok((name, region)) => drop(out.0.insert(name, (table, region))),
                Err(why) => problems.push(Problem::Correction { name: key, why }),
            }
        }
        unless(problems, out)
    }

    fn get(&self, label: &Label) -> Option<&(CellTable, Option<Region>)> {
        if self.0.is_empty() || skips(label) {
            return None;
        }
        self.0.get(&names::identify(label).ok()?.name)
    }

    /// Complaints about corrections of glyphs that no page has.
    pub(super) fn unused<'a>(&self, labels: impl Iterator<Item = &'a Label>) -> Vec<Problem> {
        let known = labels.filter(|l| !skips(l));
        let known: BTreeSet<Name> = known
            .filter_map(|l| Some(names::identify(l).ok()?.name))
            .collect();
        let unused = self.0.keys().filter(|name| !known.contains(name));
        let unused = unused.map(|name| Problem::Correction {
            name: name.to_string(),
            why: "no page has this glyph".to_owned(),
        });
        unused.collect()
    }

    /// Whether a glyph is left out.
    pub(super) fn ignores(&self, label: &Label) -> bool {
        self.get(label).is_some_and(|c| c.0.ignore)
    }

    /// Whether a user says where a letter's ink lies.
    pub(super) fn places(&self, label: &Label) -> bool {
        self.get(label).is_some_and(|c| c.1.is_some())
    }

    /// The labels with those of ignored glyphs skipped.
    pub(super) fn kept(&self, labels: &[Label]) -> Vec<Label> {
        let keep = |l: &Label| {
            if self.ignores(l) {
                Label(SKIP.to_owned())
            } else {
                l.clone()
            }
        };
        labels.iter().map(keep).collect()
    }

    /// Where the cells of a page are said to be.
    pub(super) fn pins(&self, labels: &[Label]) -> Vec<Pin> {
        let labels = labels.iter().enumerate();
        let corrected = labels.filter_map(|(i, l)| Some((i, self.get(l)?)));
        let pins = corrected.map(|(index, (table, region))| Pin {
            index,
            region: region.clone(),
            rotation_deg: table.rotation.unwrap_or(0.0),
        });
        pins.filter(|p| p.region.is_some() || p.rotation_deg.abs() > 0.0)
            .collect()
    }

    /// What a template's page cannot be told.
    pub(super) fn unfit<'a>(&self, labels: impl Iterator<Item = &'a Label>) -> Option<Problem> {
        let pinned = |l: &&Label| {
            let own = self.get(l);
            own.is_some_and(|(table, region)| region.is_some() || table.rotation.is_some())
        };
        let label = labels.into_iter().find(pinned)?;
        Some(Problem::Correction {
            name: label.0.clone(),
            why: "a template's page says itself where its letters lie: box, polygon and rotation are for others"
                .to_owned(),
        })
    }

    /// Whether a hand moved the letter's baseline.
    pub(super) fn moves(&self, label: &Label) -> bool {
        let shift = self.get(label).and_then(|c| c.0.baseline_shift);
        shift.is_some_and(|up| up.abs() > 0.0)
    }

    /// Moves baselines and sets contour levels.
    pub(super) fn apply(&self, cut: &mut Cut, units_per_em: u16) {
        for cell in &mut cut.cells {
            let Some((table, _)) = self.get(&cell.label) else {
                continue;
            };
            if let Some(up) = table.baseline_shift {
                cell.guides.baseline_px += up / f64::from(units_per_em) * cell.guides.px_per_em;
            }
            if let Some(level) = table.threshold {
                let gray = &cell.gray;
                let samples = gray.samples().iter();
                let samples = samples.map(|v| tone::at_half(*v, level)).collect();
                cell.gray = gray.with_samples(samples);
            }
        }
    }

    /// How a letter is traced.
    pub(super) fn trace<'a>(
        &'a self,
        label: &Label,
        usual: &'a picture::Options,
    ) -> &'a picture::Options {
        let own = self.get(label).and_then(|c| c.0.trace.as_ref());
        own.unwrap_or(usual)
    }
}
