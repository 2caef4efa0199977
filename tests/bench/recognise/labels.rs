//! What is said of the Latin demo sheet when its labels are wrong.

use super::{Outcome, stem};
use khatt::pipeline::project::Labels;
use khatt::pipeline::{Project, World, match_letters};
use std::fs;
use std::path::{Path, PathBuf};

/// Labels spoilt, and by what.
type Fault = (&'static str, fn(&mut Vec<String>));

const FAULTS: [Fault; 4] = [
    ("as they are", |_| ()),
    ("R and b swapped", |l| l.swap(17, 27)),
    ("row 5 shifted: its first label stands at its end", |l| {
        l[36..45].rotate_left(1)
    }),
    (
        "a letter forgotten: kcedilla is listed before k, all after it stand one cell early",
        |l| {
            l.insert(36, "kcedilla".to_owned());
            l.pop();
        },
    ),
];

/// Prints what `khatt match` remarks on each fault, with each reference and with all of them together.
pub(super) fn run(references: &[&str]) -> Outcome {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("glyphs");
    let project = Project::parse(&fs::read_to_string(folder.join("latin.toml"))?)?;
    let read = |path: &Path| fs::read(folder.join(path)).map_err(|e| e.to_string());
    let world = World::of(&read);
    let paths = references.iter().map(std::path::absolute);
    let paths: Vec<PathBuf> = paths.collect::<Result<_, _>>()?;
    let mut sets: Vec<(String, Vec<PathBuf>)> = Vec::new();
    for path in &paths {
        sets.push((
            stem(&path.display().to_string()).to_owned(),
            vec![path.clone()],
        ));
    }
    if paths.len() > 1 {
        sets.push(("all together".to_owned(), paths));
    }
    for (fault, spoil) in FAULTS {
        println!("\n{fault}");
        for (name, reference) in &sets {
            let mut spoilt = project.clone();
            spoilt.matching.reference.clone_from(reference);
            for sheet in &mut spoilt.sheets {
                let Labels::Text(text) = &sheet.glyphs else {
                    continue;
                };
                let mut labels: Vec<String> = text.split_whitespace().map(str::to_owned).collect();
                spoil(&mut labels);
                sheet.glyphs = Labels::Text(labels.join(" "));
            }
            let (_, remarks) = match_letters(&spoilt, world).map_err(|p| {
                p.iter()
                    .map(ToString::to_string)
                    .collect::<Vec<_>>()
                    .join("; ")
            })?;
            println!("  {name}: {} remarks", remarks.len());
            remarks.iter().for_each(|r| println!("    {r}"));
        }
    }
    Ok(())
}
