//! The demo sheets, built once for all tests.

use khatt::pipeline::{self, Built, Project, World};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// A demo project and what became of it.
pub(crate) struct Demo {
    pub(crate) project: Project,
    pub(crate) built: Built,
    /// Outputs of one file: ending and bytes.
    pub(crate) outputs: Vec<(String, Vec<u8>)>,
}

/// Where the demo sheets lie.
pub(crate) fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("glyphs")
}

/// `glyphs/<name>.toml`, built.
pub(crate) fn built(name: &str) -> &'static Demo {
    static LATIN: OnceLock<Demo> = OnceLock::new();
    static ARABIC: OnceLock<Demo> = OnceLock::new();
    static RASM: OnceLock<Demo> = OnceLock::new();
    let place = match name {
        "latin" => &LATIN,
        "arabic" => &ARABIC,
        _ => &RASM,
    };
    place.get_or_init(|| build(name))
}

fn build(name: &str) -> Demo {
    let folder = folder();
    let text = fs::read_to_string(folder.join(format!("{name}.toml"))).expect("a project");
    let project = Project::parse(&text).expect("a project file");
    let read = |path: &Path| fs::read(folder.join(path)).map_err(|e| e.to_string());
    let world = World::of(&read);
    let built = pipeline::build(&project, world).expect("a font");
    let outputs = pipeline::outputs(&project, &built, None, world).expect("outputs");
    let single = outputs.files.into_iter().filter_map(|(path, files)| {
        let ending = path.extension()?.to_str()?.to_owned();
        Some((ending, files.0.get("")?.clone()))
    });
    let outputs = single.collect();
    Demo {
        project,
        built,
        outputs,
    }
}

pub(crate) fn output<'a>(outputs: &'a [(String, Vec<u8>)], ending: &str) -> &'a [u8] {
    let found = outputs.iter().find(|(e, _)| e == ending);
    &found.expect("an output").1
}
