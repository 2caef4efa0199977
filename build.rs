//! Gives the program a digest of its sources, so that results of another build of the same version count as others.

use blake3::Hasher;
use std::io;
use std::path::Path;
use std::{fs, process::ExitCode};

/// All that a build is made of, but the compiler.
const SOURCES: [&str; 3] = ["src", "Cargo.toml", "Cargo.lock"];

fn main() -> ExitCode {
    let mut digest = Hasher::new();
    for source in SOURCES {
        println!("cargo::rerun-if-changed={source}");
        if let Err(e) = add(&mut digest, Path::new(source)) {
            println!("cargo::error={source}: {e}");
            return ExitCode::FAILURE;
        }
    }
    println!("cargo::rustc-env=KHATT_SOURCES={}", digest.finalize());
    ExitCode::SUCCESS
}

/// Adds a file, or all files of a folder in the order of their names, each after its name and its length.
fn add(digest: &mut Hasher, path: &Path) -> io::Result<()> {
    if path.is_dir() {
        let entries = fs::read_dir(path)?.map(|entry| Ok(entry?.path()));
        let mut paths = entries.collect::<io::Result<Vec<_>>>()?;
        paths.sort();
        return paths.iter().try_for_each(|path| add(digest, path));
    }
    let content = fs::read(path)?;
    let names = path.iter().map(|part| part.to_string_lossy());
    let name = names.collect::<Vec<_>>().join("/");
    let length = (content.len() as u64).to_le_bytes();
    for part in [name.as_bytes(), &length, &content] {
        digest.update(part);
    }
    Ok(())
}
