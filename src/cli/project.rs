//! The project file and what lies beside it.

use super::failure::{Complaint, Failure, chain};
use super::inputs::Digests;
use super::progress::{Progress, Times};
use super::staged::{parent, place};
use super::{Common, Outcome, files};
use khatt::pipeline::project::OutputTable;
use khatt::pipeline::{Inputs, Nothing, Problem, Project, ProjectError, Store, World};
use miette::{
    Diagnostic, GraphicalReportHandler, GraphicalTheme, LabeledSpan, NamedSource, SourceCode,
};
use std::collections::BTreeSet;
use std::path::{Component, Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;
use std::{env, fmt, fs, iter};

/// A project and the folder that its paths start from.
#[derive(Debug)]
pub(crate) struct Opened {
    project: Project,
    /// What the project file says.
    text: String,
    folder: PathBuf,
    file: PathBuf,
    digests: Arc<Digests>,
    /// What was asked for beside the project file.
    used: Mutex<BTreeSet<PathBuf>>,
}

impl Opened {
    /// Reads a project file.
    pub(crate) fn new(path: &Path) -> Result<Self, Failure> {
        Self::noted(path, Arc::default())
    }

    /// Reads a project file; what is read for it is noted in `digests`.
    pub(crate) fn noted(path: &Path, digests: Arc<Digests>) -> Result<Self, Failure> {
        let name = files::name(path);
        if path.is_dir() {
            let file = files::name(&path.join("font.toml"));
            return Err(Failure::new(format!("{name} is a folder"))
                .help(format!("name the project file in it: {file}")));
        }
        let bytes = files::read(path)?;
        digests.is(path, &bytes);
        let text = String::from_utf8(bytes).map_err(|e| Failure::at(&name, &e))?;
        let project =
            Project::parse(&text).map_err(|e| Failure::drawn(draw(&name, text.clone(), e)))?;
        Ok(Self {
            project,
            text,
            folder: parent(path).to_owned(),
            file: path.to_owned(),
            digests,
            used: Mutex::default(),
        })
    }

    /// Takes other reference fonts than the project's; their paths start where the user stands.
    pub(crate) fn compare_with(&mut self, references: &[PathBuf]) {
        let absolute = |p: &PathBuf| std::path::absolute(p).unwrap_or_else(|_| p.clone());
        self.project.matching.reference = references.iter().map(absolute).collect();
    }

    /// Does `work` with the project, watched by a progress bar; nothing is kept between runs.
    pub(crate) fn work<T>(
        &self,
        common: &Common,
        work: impl FnOnce(&Project, World<'_>) -> Result<T, Vec<Problem>>,
    ) -> Result<(T, Duration, Times), Failure> {
        self.work_with(&Nothing, common, work)
    }

    /// Does `work` with the project and what is kept between runs, watched by a progress bar.
    pub(crate) fn work_with<T>(
        &self,
        store: &dyn Store,
        common: &Common,
        work: impl FnOnce(&Project, World<'_>) -> Result<T, Vec<Problem>>,
    ) -> Result<(T, Duration, Times), Failure> {
        let progress = Progress::new(common);
        let world = World {
            inputs: self,
            watch: &progress,
            created: created()?,
            store,
        };
        let done = work(&self.project, world);
        let (total, times) = progress.finish();
        done.map(|value| (value, total, times)).map_err(failure)
    }

    /// Where one of the project's outputs goes.
    pub(crate) fn output(&self, which: fn(&OutputTable) -> Option<&PathBuf>) -> Option<PathBuf> {
        which(&self.project.output).map(|path| self.path(path))
    }

    /// What the project file says.
    pub(crate) fn text(&self) -> &str {
        &self.text
    }

    /// The files that were read, the project file first.
    pub(crate) fn inputs(&self) -> Vec<PathBuf> {
        let used = self.used.lock().unwrap_or_else(PoisonError::into_inner);
        let others = used.iter().filter(|p| **p != self.file);
        iter::once(&self.file).chain(others).cloned().collect()
    }

    /// The project file and all files that it names, read or not.
    pub(crate) fn named(&self) -> Vec<PathBuf> {
        let others = self.project.inputs().map(|(_, path)| self.path(path));
        iter::once(self.file.clone()).chain(others).collect()
    }

    /// Where the project's outputs go.
    pub(crate) fn outputs(&self) -> Vec<PathBuf> {
        let named = self.project.output.named();
        named.map(|(_, path)| self.path(path)).collect()
    }

    /// Fails where what the command line names would take the place of something that the project names, but for the
    /// output `own`.
    pub(crate) fn spare(&self, target: &Path, own: Option<&str>) -> Outcome {
        if files::is_dash(target) {
            return Ok(());
        }
        let outputs = self.project.output.named();
        let outputs = outputs.filter(|(key, _)| Some(*key) != own);
        let outputs = outputs.map(|(key, path)| (format!("[output] {key}"), self.path(path)));
        let inputs = self.project.inputs();
        let inputs = inputs.map(|(key, path)| (key.to_owned(), self.path(path)));
        let file = ("the project file".to_owned(), self.file.clone());
        let at = place(target);
        let meets = |(_, path): &(String, PathBuf)| {
            let there = place(path);
            there.starts_with(&at) || at.starts_with(&there)
        };
        let mut named = iter::once(file).chain(inputs).chain(outputs);
        named.find(meets).map_or(Ok(()), |(key, path)| {
            let (target, path) = (target.display(), path.display());
            let what = format!("{target} would write over {path}, which is {key}");
            Err(Failure::new(what).help("give the output another name"))
        })
    }

    /// The digest of a file as it was first read.
    pub(crate) fn digest_of(&self, path: &Path) -> Option<String> {
        self.digests.of(path).ok()
    }

    /// Where a path of the project file lies, which is used from now on.
    fn use_path(&self, path: &Path) -> PathBuf {
        let path = self.path(path);
        let mut used = self.used.lock().unwrap_or_else(PoisonError::into_inner);
        used.insert(path.clone());
        path
    }

    /// Where a path of the project file lies.
    pub(crate) fn path(&self, path: &Path) -> PathBuf {
        folded(&self.folder.join(path))
    }
}

/// A path without those of its `..` that lead out of a folder which is no link: Make knows a file by its shortest name
/// alone.
fn folded(path: &Path) -> PathBuf {
    let mut short = PathBuf::new();
    for part in path.components() {
        let named = matches!(short.components().next_back(), Some(Component::Normal(_)));
        let folder = || fs::symlink_metadata(&short).is_ok_and(|found| found.is_dir());
        match part {
            Component::CurDir => {}
            Component::ParentDir if named && folder() => {
                short.pop();
            }
            _ => short.push(part),
        }
    }
    if short.as_os_str().is_empty() {
        short.push(".");
    }
    short
}

impl Inputs for Opened {
    fn read(&self, path: &Path) -> Result<Vec<u8>, String> {
        self.digests.read(&self.use_path(path))
    }

    fn digest(&self, path: &Path) -> Result<String, String> {
        self.digests.steady(&self.use_path(path))
    }
}

/// The date that reproducible builds ask for, or the day on which dates begin.
///
/// [SOURCE_DATE_EPOCH](https://reproducible-builds.org/specs/source-date-epoch/) counts seconds.
pub(crate) fn created() -> Result<i64, Failure> {
    #[expect(
        clippy::disallowed_methods,
        reason = "the program alone reads the environment"
    )]
    let text = env::var_os("SOURCE_DATE_EPOCH");
    let Some(text) = text else { return Ok(0) };
    let text = text.to_string_lossy();
    text.parse().map_err(|_| {
        let what = format!("SOURCE_DATE_EPOCH is “{text}”");
        Failure::new(what).help("give whole seconds since 1970-01-01, or unset it")
    })
}

/// Every problem of a run with its remedy.
fn failure(problems: Vec<Problem>) -> Failure {
    let complaint = |p: &Problem| Complaint::new(chain(p), p.help().map(str::to_owned));
    problems.iter().map(complaint).collect()
}

/// A project error over the lines it is about.
#[derive(Debug)]
struct Shown {
    error: ProjectError,
    text: NamedSource<String>,
}

impl fmt::Display for Shown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let message = self.error.message.lines().next().unwrap_or_default();
        write!(f, "{}: {message}", self.text.name())
    }
}

impl std::error::Error for Shown {}

impl Diagnostic for Shown {
    fn help(&self) -> Option<Box<dyn fmt::Display + '_>> {
        let help = self.error.help.as_ref()?;
        Some(Box::new(help))
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.error.span.is_some().then_some(&self.text as _)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let span = self.error.span.clone()?;
        let label = LabeledSpan::new_with_span(Some("here".to_owned()), span);
        Some(Box::new(iter::once(label)))
    }
}

/// The message with file, line, column and the line itself.
fn draw(name: &str, text: String, error: ProjectError) -> String {
    let shown = Shown {
        error,
        text: NamedSource::new(name, text),
    };
    let handler = GraphicalReportHandler::new_themed(GraphicalTheme::unicode_nocolor());
    let mut out = String::new();
    match handler.with_width(100).render_report(&mut out, &shown) {
        Ok(()) => out,
        Err(fmt::Error) => format!("{shown}\n"),
    }
}

#[cfg(test)]
#[expect(
    clippy::disallowed_methods,
    reason = "the tests play the user, who writes files"
)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn what_came_of_a_picture_that_changed_meanwhile_has_no_digest() {
        let dir = tempfile::tempdir().unwrap();
        let (file, page) = (dir.path().join("font.toml"), Path::new("page.png"));
        let text = "[font]\nfamily = \"A\"\n[[sheet]]\nimage = \"page.png\"\nlayout = \"free\"\nglyphs = \"A\"\n";
        fs::write(&file, text).unwrap();
        fs::write(dir.path().join(page), "one").unwrap();
        let opened = Opened::new(&file).unwrap();
        let first = opened.digest(page).unwrap();
        opened.read(page).unwrap();
        assert_eq!(opened.digest(page).as_ref(), Ok(&first));
        fs::write(dir.path().join(page), "two").unwrap();
        opened.read(page).unwrap();
        assert!(opened.digest(page).is_err());
        // what is remembered of the build is its first state
        assert_eq!(opened.digest_of(&dir.path().join(page)), Some(first));
    }
}
