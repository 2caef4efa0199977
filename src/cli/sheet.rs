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
    #[arg(long, value_name = "N", default_value_t = 300, value_parser = clap::value_parser!(u16).range(1..))]
    dpi: u16,
}

/// What pages are written as.
#[derive(Debug, Clone, Copy)]
enum Kind {
    Pdf,
    Svg,
    Png,
}

impl Sheet {
    pub(crate) fn run(&self, common: &Common) -> Outcome {
        let kind = self.kind()?;
        let opened = Opened::new(&self.project)?;
        opened.spare(&self.output, None)?;
        let (pages, ..) = opened.work(common, pipeline::sheets)?;
        let drawn = match kind {
            Kind::Pdf => vec![template::pdf(&pages)],
            Kind::Svg => pages
                .iter()
                .map(|page| template::svg(page).into_bytes())
                .collect(),
            Kind::Png => pages
                .iter()
                .map(|page| template::png(page, f64::from(self.dpi)))
                .collect::<Result<_, _>>()
                .map_err(|e| Failure::at(self.output.display(), &e))?,
        };
        self.numbered(drawn, &opened.named())
    }

    /// What the output's name says.
    fn kind(&self) -> Result<Kind, Failure> {
        if is_dash(&self.output) {
            return Ok(Kind::Pdf);
        }
        let ending = self.output.extension().map(|e| e.to_ascii_lowercase());
        match ending.as_ref().and_then(|e| e.to_str()) {
            Some("pdf") => Ok(Kind::Pdf),
            Some("svg") => Ok(Kind::Svg),
            Some("png") => Ok(Kind::Png),
            _ => {
                let what = format!("{} is no name for pages", self.output.display());
                Err(Failure::of_use(what).help("end it in .pdf, .svg or .png"))
            }
        }
    }

    /// Writes one file under the name that was given, several under it and their numbers.
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
