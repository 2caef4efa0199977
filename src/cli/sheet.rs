//! `khatt sheet`: pages to draw on.

use super::failure::Failure;
use super::files::{self, is_dash};
use super::project::Opened;
use super::{Common, Outcome, staged};
use clap::Args;
use khatt::pipeline;
use khatt::template;
use khatt::types::Files;
use std::path::{Path, PathBuf};

/// Makes pages to print and draw on, a cell for each of the project's glyphs
#[derive(Debug, Args)]
pub(crate) struct Sheet {
    /// Project file
    #[arg(value_name = "PROJECT.toml")]
    project: PathBuf,
    /// Where to: .pdf holds all pages; of .svg and .png each page is a file; - prints a PDF
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Dots an inch of a .png
    #[arg(long, value_name = "N", default_value_t = 300)]
    dpi: u16,
}

impl Sheet {
    pub(crate) fn run(&self, common: &Common) -> Outcome {
        let opened = Opened::new(&self.project)?;
        let (pages, ..) = opened.work(common, pipeline::sheets)?;
        let each = |draw: &dyn Fn(&template::Page) -> Result<Vec<u8>, Failure>| {
            let drawn = pages.iter().map(draw).collect::<Result<Vec<_>, _>>()?;
            self.numbered(drawn, &opened.named())
        };
        let kind = self.output.extension().map(|e| e.to_ascii_lowercase());
        let pdf = || files::write(&self.output, &template::pdf(&pages), &opened.named());
        match kind.as_ref().and_then(|k| k.to_str()) {
            _ if is_dash(&self.output) => pdf(),
            Some("pdf") => pdf(),
            Some("svg") => each(&|page| Ok(template::svg(page).into_bytes())),
            Some("png") => each(&|page| {
                let picture = template::png(page, f64::from(self.dpi));
                picture.map_err(|e| Failure::at(self.output.display(), &e))
            }),
            _ => {
                let what = format!("{} is no name for pages", self.output.display());
                Err(Failure::new(what).help("end it in .pdf, .svg or .png"))
            }
        }
    }

    /// Writes one page under the name that was given, several under it and their numbers.
    fn numbered(&self, pages: Vec<Vec<u8>>, inputs: &[PathBuf]) -> Outcome {
        if let [page] = pages.as_slice() {
            return files::write(&self.output, page, inputs);
        }
        let numbered = pages.into_iter().zip(1..);
        let outputs: Vec<_> = numbered
            .map(|(page, n)| (with_number(&self.output, n), Files::single(page)))
            .collect();
        staged::write(&outputs, inputs)
    }
}

/// `page.png` → `page-2.png`
fn with_number(path: &Path, n: usize) -> PathBuf {
    let part = |p: Option<&std::ffi::OsStr>| p.unwrap_or_default().to_string_lossy().into_owned();
    path.with_file_name(format!(
        "{}-{n}.{}",
        part(path.file_stem()),
        part(path.extension())
    ))
}
