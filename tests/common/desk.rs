//! A user at work: a folder of files, and the program that is run in it.
#![expect(
    clippy::disallowed_methods,
    reason = "the tests play the user, who writes files"
)]

use crate::common::approved;
use crate::common::pictures::{LETTERS, page};
use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output};

/// What most tests run.
pub(crate) const BUILD: [&str; 2] = ["build", "font.toml"];

/// A folder that is gone in the end. Files are named by their paths from it.
pub(crate) struct Desk(tempfile::TempDir);

impl Desk {
    /// Nothing on it.
    pub(crate) fn new() -> Self {
        Self(tempfile::tempdir().expect("a folder"))
    }

    /// One file on it.
    pub(crate) fn with(name: &str, content: impl AsRef<[u8]>) -> Self {
        let desk = Self::new();
        desk.write(name, content);
        desk
    }

    /// A project of nine glyphs on `page.png`, with every output.
    pub(crate) fn project(glyphs: &str, picture: &[u8]) -> Self {
        let text = format!(
            "[font]\nfamily = \"Test\"\n[[sheet]]\nimage = \"page.png\"\nlayout = {{ grid = [3, 3] }}\n\
             glyphs = \"{glyphs}\"\npixels_per_em = 150\n[output]\nttf = \"out/test.ttf\"\notf = \"out/test.otf\"\n\
             woff2 = \"out/test.woff2\"\nufo = \"out/test.ufo\"\nsvg = \"out/svg\"\nproof = \"out/test.html\"\n"
        );
        let desk = Self::with("font.toml", text);
        desk.write("page.png", picture);
        desk
    }

    /// The project of the page with all its letters.
    pub(crate) fn letters() -> Self {
        Self::project(LETTERS, &page(&[]))
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub(crate) fn has(&self, name: &str) -> bool {
        self.path(name).exists()
    }

    pub(crate) fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).expect(name)
    }

    pub(crate) fn text(&self, name: &str) -> String {
        String::from_utf8(self.read(name)).expect("text")
    }

    pub(crate) fn json(&self, name: &str) -> serde_json::Value {
        serde_json::from_slice(&self.read(name)).expect("JSON")
    }

    pub(crate) fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        let path = self.path(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        fs::write(path, content).expect("a file");
    }

    /// A file, or a folder with all that is in it.
    pub(crate) fn remove(&self, name: &str) {
        let path = self.path(name);
        let gone = if path.is_dir() {
            fs::remove_dir_all(path)
        } else {
            fs::remove_file(path)
        };
        gone.expect("it is there");
    }

    /// Changes the project.
    pub(crate) fn edit(&self, change: impl FnOnce(String) -> String) {
        self.write("font.toml", change(self.text("font.toml")));
    }

    /// Every file below a folder, by its path from there.
    pub(crate) fn files(&self, folder: &str) -> BTreeMap<String, Vec<u8>> {
        let (mut out, root) = (BTreeMap::new(), self.path(folder));
        let mut folders = vec![root.clone()];
        while let Some(at) = folders.pop() {
            for entry in fs::read_dir(at).expect("a folder") {
                let path = entry.expect("an entry").path();
                if path.is_dir() {
                    folders.push(path);
                } else {
                    let name = path.strip_prefix(&root).expect("below the folder");
                    out.insert(name.display().to_string(), fs::read(&path).expect("a file"));
                }
            }
        }
        out
    }

    /// The program with these arguments, told no date; what it keeps between runs lies in the folder, too.
    pub(crate) fn command(&self, args: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_khatt"));
        command.args(args).current_dir(self.0.path());
        command.env_remove("SOURCE_DATE_EPOCH");
        command.env("XDG_CACHE_HOME", self.path("cache"));
        command
    }

    pub(crate) fn run(&self, args: &[&str]) -> Output {
        self.command(args).output().expect("the program runs")
    }

    /// Exit status and what was said.
    pub(crate) fn told(&self, args: &[&str]) -> (Option<i32>, String) {
        let out = self.run(args);
        (out.status.code(), said(&out))
    }

    /// What was said while it was done.
    pub(crate) fn done(&self, args: &[&str]) -> String {
        let (status, said) = self.told(args);
        assert_eq!(status, Some(0), "{args:?}: {said}");
        said
    }

    /// Why it failed.
    pub(crate) fn fails(&self, args: &[&str]) -> String {
        let (status, said) = self.told(args);
        assert_eq!(status, Some(1), "{args:?}: {said}");
        said
    }

    /// It fails with the words that are approved under that name, and there are no outputs.
    pub(crate) fn refuses(&self, args: &[&str], name: &str) {
        let out = self.run(args);
        assert_eq!(out.status.code(), Some(1), "{name}");
        assert!(!self.has("out"), "{name}: nothing may be written");
        approved::check("cli", name, &transcript(args, &out));
    }
}

/// Standard error.
pub(crate) fn said(out: &Output) -> String {
    String::from_utf8_lossy(&out.stderr).into_owned()
}

/// Status, standard output and standard error as one text.
pub(crate) fn transcript(args: &[&str], out: &Output) -> String {
    let stdout = String::from_utf8_lossy(&out.stdout);
    let status = out
        .status
        .code()
        .map_or("killed".to_owned(), |c| c.to_string());
    format!(
        "$ khatt {}\n{stdout}{}status {status}\n",
        args.join(" "),
        said(out)
    )
}
