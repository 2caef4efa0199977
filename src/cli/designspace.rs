//! `khatt designspace`: the UFOs of several weights as one family.

use super::failure::Failure;
use super::staged::{self, parent, place};
use super::{Common, Outcome, files};
use clap::Args;
use khatt::types::Files;
use khatt::write::designspace::{Master, designspace};
use std::path::{Component, Path, PathBuf};

/// Makes a designspace of the UFOs of several weights
#[derive(Debug, Args)]
pub(crate) struct Designspace {
    /// UFO folders of one family, each of its own weight
    #[arg(value_name = "FONT.ufo", required = true)]
    masters: Vec<PathBuf>,
    /// Where it goes
    #[arg(short, long, value_name = "FAMILY.designspace")]
    output: PathBuf,
}

impl Designspace {
    pub(crate) fn run(&self, common: &Common) -> Outcome {
        if files::is_dash(&self.output) {
            let what = "- is standard output, and the document names its masters by their way from its folder";
            return Err(Failure::of_use(what).help("name a file: -o FAMILY.designspace"));
        }
        let masters = self.masters.iter().map(|ufo| {
            Ok(Master {
                path: self.path_to(ufo),
                files: files::folder(ufo)?,
            })
        });
        let masters = masters.collect::<Result<Vec<_>, Failure>>()?;
        let made = designspace(&masters).map_err(|e| Failure::at(files::name(&self.output), &e))?;
        let document = Files::single(made.document.into_bytes());
        staged::write(&[(self.output.clone(), document)], &self.masters)?;
        if !made.apart.is_empty() && !common.quiet {
            let glyphs = match made.apart.len() {
                1 => "1 glyph is".to_owned(),
                count => format!("{count} glyphs are"),
            };
            eprintln!(
                "{glyphs} not built alike, so that the axis is discrete: no font between the masters can be made"
            );
            made.apart.iter().for_each(|line| eprintln!("  {line}"));
        }
        Ok(())
    }

    /// The way from the designspace's folder to a UFO, with `/` on every system.
    fn path_to(&self, ufo: &Path) -> String {
        let (from, to) = (place(parent(&self.output)), place(ufo));
        let shared = from.components().zip(to.components());
        let shared = shared.take_while(|(a, b)| a == b).count();
        let up = from.components().skip(shared).map(|_| "..".to_owned());
        let down = to.components().skip(shared);
        let down = down.map(|c: Component<'_>| c.as_os_str().to_string_lossy().into_owned());
        up.chain(down).collect::<Vec<_>>().join("/")
    }
}
