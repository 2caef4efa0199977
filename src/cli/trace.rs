//! `khatt trace`: one picture becomes one SVG path.

use super::failure::{Failure, chain};
use super::{Common, Outcome, files, staged};
use clap::Args;
use clap::builder::PossibleValuesParser;
use khatt::assemble::names;
use khatt::pipeline::picture::{Options, trace_picture};
use khatt::recognise;
use khatt::scan::{self, InkGrain, InkStreaks, Reading, Tones};
use khatt::trace::Edges;
use khatt::types::{Gray, Label, Sheet};
use khatt::write::{self, centerline};
use khatt::{corner, fit};
use std::path::{Path, PathBuf};
use std::slice;

/// Pixels of a picture that is traced as a whole: more would take over two gigabytes.
const LARGEST: usize = 100_000_000;

/// Traces one picture into an SVG whose unit is the picture's pixel
#[derive(Debug, Args)]
pub(crate) struct Trace {
    /// Picture to trace, or - for standard input
    #[arg(value_name = "IN")]
    picture: PathBuf,
    /// Where the SVG goes, or - for standard output; of a centreline also OUT.ufo
    #[arg(short, long, value_name = "OUT.svg")]
    output: PathBuf,
    /// How curves are fitted; `khatt methods` lists the ways
    #[arg(long, value_name = "METHOD", hide_possible_values = true, value_parser = PossibleValuesParser::new(fit::Method::all().iter().map(fit::Method::key)))]
    fit: Option<String>,
    /// How corners are found; `khatt methods` lists the ways
    #[arg(long, value_name = "METHOD", hide_possible_values = true, value_parser = PossibleValuesParser::new(corner::Method::all().iter().map(corner::Method::key)))]
    corners: Option<String>,
    /// Distance between contour and curve to aim at, in pixels
    #[arg(long, value_name = "PX", value_parser = tolerance)]
    tolerance: Option<f64>,
    /// Area of ink or paper below which it is dust, in square pixels [default: 4]
    #[arg(long, value_name = "PX2", value_parser = positive)]
    speckle: Option<f64>,
    /// How the picture's numbers tell light: in proportion to it, as cameras and most scanners write it, or as the
    /// file says [default: linear]
    #[arg(long, value_name = "TONES", value_parser = PossibleValuesParser::new(Tones::ALL.map(|t| t.0)))]
    tones: Option<String>,
    /// What becomes of ink that is grain, as of a pencil: it is averaged, or followed, which takes long
    /// [default: soften]
    #[arg(long, value_name = "GRAIN", value_parser = PossibleValuesParser::new(InkGrain::ALL.map(|g| g.0)))]
    grain: Option<String>,
    /// What becomes of pale streaks in ink, as of a ballpoint: they are filled, or stay [default: fill]
    #[arg(long, value_name = "STREAKS", value_parser = PossibleValuesParser::new(InkStreaks::ALL.map(|s| s.0)))]
    streaks: Option<String>,
    /// What becomes of ragged edges, as of a felt pen on paper: curves run smoothly along them, or follow them
    /// [default: smooth]
    #[arg(long, value_name = "EDGES", value_parser = PossibleValuesParser::new(Edges::ALL.map(|e| e.0)))]
    edges: Option<String>,
    /// Give the middle of the lines that a pen drew, with their width, in place of their outline
    #[arg(long, conflicts_with_all = ["fit", "corners", "tolerance", "speckle", "edges"])]
    centerline: bool,
}

impl Trace {
    pub(crate) fn run(&self, common: &Common) -> Outcome {
        let kinds: &[&str] = if self.centerline {
            &["svg", "ufo"]
        } else {
            &["svg"]
        };
        files::ends_in(&self.output, kinds)?;
        let name = files::name(&self.picture);
        let seen = picture(&self.picture, named(Tones::ALL, self.tones.as_deref()))?;
        if seen.samples().len() > LARGEST {
            let (w, h) = (seen.width(), seen.height());
            let what = format!("{name} has {w} × {h} px, too many to be traced as one drawing");
            let remedy = "cut it into letters, or scan it at a lower resolution: 100 million pixels are taken";
            return Err(Failure::new(what).help(remedy));
        }
        let seen = in_range(seen);
        let averaged = self.averaged(&seen);
        if let (Some((_, px)), false) = (&averaged, common.quiet) {
            eprintln!(
                "note: the ink of {name} is grain, as of a pencil or a dry brush: it was averaged over {px:.1} px; \
                 --grain keep follows it instead, which takes long"
            );
        }
        let gray = averaged.as_ref().map_or(&seen, |(even, _)| even);
        let streaks = named(InkStreaks::ALL, self.streaks.as_deref());
        let tell = |filled: bool| {
            if filled && !common.quiet {
                eprintln!(
                    "note: the ink of {name} has pale streaks, as of a ballpoint: they were filled; --streaks keep \
                     leaves them"
                );
            }
        };
        if self.centerline {
            let even = scan::legible(gray, streaks);
            tell(even.as_ref().is_some_and(|even| even.filled));
            return self.write_lines(even.as_ref().map_or(gray, |even| &even.gray));
        }
        let options = self.options();
        let trace = |gray: &Gray| {
            trace_picture(gray, streaks, &options).map_err(|e| Failure::at(&name, &e))
        };
        let mut drawn = trace(gray)?;
        if drawn.paths.is_empty()
            && let Some(gray) = scan::full_range(gray)
        {
            drawn = trace(&gray)?;
        }
        tell(drawn.filled);
        let paths = drawn.paths;
        if paths.is_empty() {
            eprintln!("warning: {name} has no ink to trace: the drawing is empty");
        }
        let size = (seen.width(), seen.height());
        self.write(&write::picture::svg(size, &paths))
    }

    /// The picture with its ink averaged, and over how many px, where that is grain that need not be kept.
    fn averaged(&self, gray: &Gray) -> Option<(Gray, f64)> {
        match named(InkGrain::ALL, self.grain.as_deref()) {
            InkGrain::Soften => scan::grained(gray),
            InkGrain::Keep => None,
        }
    }

    /// Writes the middle of the lines: a UFO where the output is named so, else an SVG. The UFO's glyph bears the
    /// output's name, and its character where that names one.
    fn write_lines(&self, gray: &Gray) -> Outcome {
        let drawn = recognise::centerline(gray);
        let size = (gray.width(), gray.height());
        let kind = self.output.extension();
        if kind.is_none_or(|e| !e.eq_ignore_ascii_case("ufo")) {
            return self.write(&centerline::svg(size, &drawn));
        }
        let stem = self.output.file_stem().and_then(|s| s.to_str());
        let known = names::identify(&Label(stem.unwrap_or_default().to_owned())).ok();
        let name = known.as_ref().map_or("drawing", |id| id.name.as_str());
        let character = match known.as_ref().map(|id| id.chars.as_slice()) {
            Some([c]) => Some(*c),
            _ => None,
        };
        let ufo = centerline::ufo(size, &drawn, (name, character));
        let ufo = ufo.map_err(|e| Failure::at(self.output.display(), &e))?;
        let inputs = slice::from_ref(&self.picture);
        staged::write(&[(self.output.clone(), ufo)], inputs)
    }

    fn write(&self, svg: &str) -> Outcome {
        let inputs = slice::from_ref(&self.picture);
        files::write(&self.output, svg.as_bytes(), inputs)
    }

    /// The defaults with what the command line changes.
    fn options(&self) -> Options {
        let mut options = Options::default();
        if let Some(px) = self.tolerance {
            options.tolerance_px = px;
        }
        if let Some(area) = self.speckle {
            options.trace.speckle_px2 = area;
        }
        options.trace.edges = named(Edges::ALL, self.edges.as_deref());
        let fit = |m: &fit::Method| self.fit.as_deref() == Some(m.key());
        if let Some(method) = fit::Method::all().into_iter().find(fit) {
            options.fit = method;
        }
        let corners = |m: &corner::Method| self.corners.as_deref() == Some(m.key());
        if let Some(method) = corner::Method::all().into_iter().find(corners) {
            options.corners = method;
        }
        options
    }
}

/// The one picture of a file.
pub(super) fn picture(path: &Path, tones: Tones) -> Result<Gray, Failure> {
    let name = files::name(path);
    let reading = Reading {
        tones,
        ..Reading::default()
    };
    let pages = scan::load(&files::read(path)?, &name, reading);
    let pages = pages.map_err(|e| Failure::new(chain(&e)))?;
    let several = |pages: Vec<Sheet>| {
        let count = pages.len();
        Failure::new(format!("{name} holds {count} pictures; give one at a time"))
    };
    let [page] = pages.try_into().map_err(several)?;
    Ok(page.gray)
}

/// The picture in its own range where it is dark everywhere.
pub(super) fn in_range(gray: Gray) -> Gray {
    let light = scan::is_all_dark(&gray).then(|| scan::full_range(&gray));
    light.flatten().unwrap_or(gray)
}

/// The value of this name; the default where none is given.
fn named<T: Default, const N: usize>(all: [(&str, T); N], name: Option<&str>) -> T {
    let given = all.into_iter().find(|value| name == Some(value.0));
    given.map_or_else(T::default, |value| value.1)
}

/// A distance between contour and curve, as in project files.
fn tolerance(text: &str) -> Result<f64, String> {
    let px = text.parse::<f64>().map_err(|e| e.to_string())?;
    Options::tolerance(px).map_err(str::to_owned)
}

/// A length or an area: finite and above 0.
pub(super) fn positive(text: &str) -> Result<f64, String> {
    let value = text.parse::<f64>().map_err(|e| e.to_string())?;
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err("must be a finite number above 0".to_owned())
    }
}
