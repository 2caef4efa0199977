//! `khatt build`: a project becomes fonts.

use super::cache::CacheArgs;
use super::done::Done;
use super::failure::Failure;
use super::progress::Times;
use super::project::{Opened, created};
use super::staged;
use super::{Common, Outcome, cut, files, keep, sarif};
use clap::Args;
use khatt::pipeline::{
    self, Built, Outputs, Problem, Project, Report, Stage, Store, World, digest,
};
use khatt::types::Files;
use khatt::write::handwork;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Builds what the project's [output] names, all of it or nothing
#[derive(Debug, Args)]
pub(crate) struct Build {
    /// Project file
    #[arg(value_name = "PROJECT.toml")]
    project: PathBuf,
    /// Also write every stage's result into this folder
    #[arg(long, value_name = "DIR")]
    keep: Option<PathBuf>,
    /// Also write a rule for Make or Ninja: outputs, colon, inputs; - prints it
    #[arg(long, value_name = "FILE.d")]
    depfile: Option<PathBuf>,
    /// Also write what there is to remark, or why the build failed, as a SARIF log; - prints it
    #[arg(long, value_name = "FILE.sarif")]
    sarif: Option<PathBuf>,
    /// Write nothing; fail where an output is not what would be written
    #[arg(long, conflicts_with_all = ["keep", "depfile", "sarif", "timings"])]
    locked: bool,
    /// Write the UFO anew, without what was done to it by hand
    #[arg(long)]
    overwrite: bool,
    #[command(flatten)]
    report: ReportArgs,
    #[command(flatten)]
    cache: CacheArgs,
}

/// What the report tells besides the result.
#[derive(Debug, Clone, Copy, Default, Args)]
struct ReportArgs {
    /// Also write into the report how long each stage took
    #[arg(long)]
    timings: bool,
}

/// What a build has made.
#[derive(Debug)]
struct Made<T> {
    files: Vec<(PathBuf, Files)>,
    /// What was to be remarked.
    said: String,
    /// What else was asked for.
    more: T,
}

impl Build {
    /// What the project's [output] names, and nothing else.
    pub(crate) fn of(project: PathBuf) -> Self {
        Self {
            project,
            keep: None,
            depfile: None,
            sarif: None,
            locked: false,
            overwrite: false,
            report: ReportArgs::default(),
            cache: CacheArgs::default(),
        }
    }

    pub(crate) fn cached(self, cache: CacheArgs) -> Self {
        Self { cache, ..self }
    }

    pub(crate) fn run(&self, common: &Common) -> Outcome {
        if self.keep.as_deref().is_some_and(files::is_dash) {
            let what = "- is standard output, and the stages' results are a folder of files";
            return Err(Failure::of_use(what).help("name a folder: --keep DIR"));
        }
        let (inputs, outcome) = match Opened::new(&self.project) {
            Ok(opened) => {
                let inputs = opened.named();
                // before the work, and before its failure is written anywhere
                staged::apart(opened.outputs().iter().chain(self.more()), &inputs)?;
                (inputs, self.build(&opened, common))
            }
            Err(failure) => (vec![self.project.clone()], Err(failure)),
        };
        if let Some((path, failure)) = self.sarif.as_ref().zip(outcome.as_ref().err()) {
            let log = sarif::failed(&self.project, failure);
            staged::write(&[(path.clone(), log)], &inputs)?;
        }
        outcome
    }

    /// Outputs that the command line names.
    fn more(&self) -> impl Iterator<Item = &PathBuf> {
        let files = self.depfile.iter().chain(&self.sarif);
        files.chain(&self.keep)
    }

    /// Builds, where anything has changed since the last time.
    pub(crate) fn build(&self, opened: &Opened, common: &Common) -> Outcome {
        self.build_and(opened, common, |_, _, _| Ok(())).map(drop)
    }

    /// Builds in the same way; the proof: what the project names, else one that shows what has changed since `last`.
    pub(crate) fn proof(
        &self,
        opened: &Opened,
        last: Option<&str>,
        common: &Common,
    ) -> Result<String, Failure> {
        let page = |project: &Project, built: &Built, world: World<'_>| {
            pipeline::proof(project, built, last, world)
        };
        let named = opened.output(|o| o.proof.as_ref());
        let made = match &named {
            Some(path) => {
                self.build(opened, common)?;
                files::last(path)
            }
            None => self.build_and(opened, common, page)?,
        };
        if let Some(page) = made {
            return Ok(page);
        }
        // the outputs are as they should be, and no page is among them
        let (page, ..) = opened.work_with(&self.cache.open(), common, |project, world| {
            let built = pipeline::build(project, world)?;
            page(project, &built, world)
        })?;
        Ok(page)
    }

    /// Builds, where anything has changed; what `more` makes of it, nothing where nothing was built.
    fn build_and<T>(
        &self,
        opened: &Opened,
        common: &Common,
        more: impl FnOnce(&Project, &Built, World<'_>) -> Result<T, Vec<Problem>>,
    ) -> Result<Option<T>, Failure> {
        let cache = self.cache.open();
        let key = self.key(opened)?;
        if self.keep.is_none()
            && let Some(done) = Done::recall(&cache, &key, opened)
        {
            if !self.locked {
                done.date();
            }
            if !common.quiet {
                eprint!("{}", done.said());
                eprintln!("nothing to do: inputs and outputs are as the last build left them");
            }
            return Ok(None);
        }
        let made = self.make(&cache, opened, common, more)?;
        if let Some(done) = Done::new(opened, &made.files, &made.said) {
            done.keep(&cache, &key);
        }
        cache.trim();
        Ok(Some(made.more))
    }

    /// Builds from what `store` has of the pages.
    pub(crate) fn run_with(&self, store: &dyn Store, opened: &Opened, common: &Common) -> Outcome {
        self.make(store, opened, common, |_, _, _| Ok(())).map(drop)
    }

    /// Makes the outputs and tells of it.
    fn make<T>(
        &self,
        store: &dyn Store,
        opened: &Opened,
        common: &Common,
        more: impl FnOnce(&Project, &Built, World<'_>) -> Result<T, Vec<Problem>>,
    ) -> Result<Made<T>, Failure> {
        let last = opened
            .output(|o| o.proof.as_ref())
            .and_then(|path| files::last(&path));
        let ((built, outputs, more), total, times) =
            opened.work_with(store, common, |project, world| {
                let built = pipeline::build(project, world)?;
                let outputs = pipeline::outputs(project, &built, last.as_deref(), world)?;
                let more = more(project, &built, world)?;
                Ok((built, outputs, more))
            })?;
        let mut files = self.files(opened, &outputs, (total, &times));
        let mut said = remarks(&built);
        if !self.overwrite {
            said += &keep_handwork(opened, &mut files)?;
        }
        if let Some(path) = &self.sarif {
            files.push((path.clone(), sarif::remarks(opened, &built)));
        }
        if self.locked {
            staged::same(&files)?;
            return Ok(Made { files, said, more });
        }
        let folder = self.keep.as_ref();
        let kept = folder.map(|folder| (folder.clone(), keep::files(&built)));
        staged::write(files.iter().chain(&kept), &opened.named())?;
        if !common.quiet {
            eprint!("{said}");
            say(&built, total, &times);
            files
                .iter()
                .for_each(|(path, _)| eprintln!("  {}", path.display()));
        }
        Ok(Made { files, said, more })
    }

    /// A digest of what this build is asked for.
    fn key(&self, opened: &Opened) -> Result<String, Failure> {
        let project = std::path::absolute(&self.project);
        let project = project.map_err(|e| Failure::at(self.project.display(), &e))?;
        // a path need be no text
        let named = |path: &Path| digest(path.as_os_str().as_encoded_bytes());
        let asked = json!([
            named(&project),
            opened.text(),
            self.depfile.as_deref().map(named),
            self.sarif.as_deref().map(named),
            self.locked,
            self.overwrite,
            self.report.timings,
            created()?
        ]);
        Ok(digest(asked.to_string().as_bytes()))
    }

    /// The project's outputs and the rule for Make.
    fn files(
        &self,
        opened: &Opened,
        outputs: &Outputs,
        (total, times): (Duration, &Times),
    ) -> Vec<(PathBuf, Files)> {
        let files = outputs.files.iter();
        let mut files: Vec<(PathBuf, Files)> = files
            .map(|(path, files)| (opened.path(path), files.clone()))
            .collect();
        if let Some((path, made)) = opened
            .output(|o| o.report.as_ref())
            .zip(outputs.report.as_ref())
        {
            let report = if self.report.timings {
                timed(made, total, times)
            } else {
                json!(made)
            };
            let text = format!("{report:#}\n");
            files.push((path, Files::single(text.into_bytes())));
        }
        if let Some(path) = &self.depfile {
            let targets = files.iter().map(|(path, _)| path.as_path());
            let rule = rule(targets, &opened.inputs());
            files.push((path.clone(), Files::single(rule.into_bytes())));
        }
        files
    }
}

/// Takes over what was done by hand to the UFO that lies where one is to be written; says what.
fn keep_handwork(opened: &Opened, outputs: &mut [(PathBuf, Files)]) -> Result<String, Failure> {
    // a folder of other things is refused where it would be replaced
    let ufo = opened.output(|o| o.ufo.as_ref());
    let ufo = ufo.filter(|path| path.join("metainfo.plist").is_file());
    let Some((path, files)) = ufo.and_then(|path| outputs.iter_mut().find(|(p, _)| *p == path))
    else {
        return Ok(String::new());
    };
    let name = path.display();
    let old = files::folder(path)?;
    let (merged, kept) = handwork::merge(&old, files).map_err(|e| {
        let remedy = "give another folder; --overwrite replaces what khatt has built there";
        Failure::at(&name, &e).help(remedy)
    })?;
    *files = merged;
    let mut said = String::new();
    if !kept.kept.is_empty() {
        said += &format!(
            "note: {name}: kept as changed by hand: {}\n",
            kept.kept.join(", ")
        );
    }
    for thing in &kept.conflicts {
        said += &format!(
            "warning: {name}: {thing} was changed by hand and by this build; the hand's stays\n"
        );
    }
    Ok(said)
}

/// The report with the time of each stage, and how many times as long as decoding the pages their cleaning and
/// cutting took.
fn timed(report: &Report, total: Duration, times: &Times) -> Value {
    let stages = times.iter();
    let stages: serde_json::Map<_, _> = stages
        .map(|(stage, time)| (stage.to_string(), json!(time.as_secs_f64())))
        .collect();
    let mut report = json!(report);
    if let Some(table) = report.as_object_mut() {
        table.insert("seconds".to_owned(), json!(total.as_secs_f64()));
        table.insert("stage_seconds".to_owned(), stages.into());
        table.insert("pages_per_decoding".to_owned(), json!(per_decoding(times)));
    }
    report
}

/// Cleaning and cutting in times of decoding; nothing where no page was decoded.
fn per_decoding(times: &Times) -> Option<f64> {
    let of = |stage: Stage| times.get(&stage).map(Duration::as_secs_f64);
    let rest = of(Stage::Clean).unwrap_or(0.0) + of(Stage::Cut)?;
    of(Stage::Load).map(|decoding| rest / decoding)
}

/// A rule for Make: its words have their spaces, colons, `#` and `$` escaped.
fn rule<'a>(outputs: impl Iterator<Item = &'a Path>, inputs: &[PathBuf]) -> String {
    let word = |path: &Path| {
        let text = path.display().to_string();
        let text = text.replace(' ', "\\ ").replace('#', "\\#");
        text.replace(':', "\\:").replace('$', "$$")
    };
    let outputs = outputs.map(word).collect::<Vec<_>>().join(" ");
    let inputs: Vec<String> = inputs.iter().map(|path| word(path)).collect();
    let all: String = inputs.iter().map(|input| format!(" {input}")).collect();
    // inputs that are gone are no reason to stop
    let gone: String = inputs.iter().map(|input| format!("{input}:\n")).collect();
    format!("{outputs}:{all}\n{gone}")
}

/// What could not be met and what to look at, a line each.
fn remarks(built: &Built) -> String {
    let notes = built.notes.iter();
    let mut lines: Vec<String> = notes
        .map(|n| format!("note: {}: {}\n", n.glyph, n.message))
        .collect();
    lines.extend(built.pages.iter().map(cut::warnings));
    lines.extend(built.doubts.iter().map(|d| format!("warning: {d}\n")));
    lines.concat()
}

/// What was done, on standard error.
fn say(built: &Built, total: Duration, times: &Times) {
    let stages: Vec<String> = (times.iter())
        .map(|(stage, time)| format!("{stage} {:.2}", time.as_secs_f64()))
        .collect();
    let (glyphs, seconds) = (built.letters.len(), total.as_secs_f64());
    eprintln!("{glyphs} glyphs in {seconds:.2} s ({})", stages.join(", "));
}
