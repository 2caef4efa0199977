//! `khatt trace`: one picture becomes one SVG path.

use super::failure::{Failure, chain};
use super::staged::Staged;
use super::{Outcome, centerline, files};
use clap::Args;
use clap::builder::PossibleValuesParser;
use khatt::pipeline::picture::{Options, to_picture, trace_picture};
use khatt::recognise;
use khatt::scan::{self, Polarity};
use khatt::types::Gray;
use khatt::{corner, fit};
use kurbo::{BezPath, PathEl, Point};
use std::fmt::Write as _;
use std::path::PathBuf;

/// Decimals of a coordinate, px.
const DECIMALS: usize = 4;

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
    #[arg(long, value_name = "PX", value_parser = positive)]
    tolerance: Option<f64>,
    /// Area of ink or paper below which it is dust, in square pixels [default: 4]
    #[arg(long, value_name = "PX2", value_parser = positive)]
    speckle: Option<f64>,
    /// Give the middle of the lines that a pen drew, with their width, in place of their outline
    #[arg(long, conflicts_with_all = ["fit", "corners", "tolerance", "speckle"])]
    centerline: bool,
}

impl Trace {
    pub(crate) fn run(&self) -> Outcome {
        let bytes = files::read(&self.picture)?;
        let name = files::name(&self.picture);
        let pages =
            scan::load(&bytes, &name, Polarity::Auto).map_err(|e| Failure::new(chain(&e)))?;
        let [page] = pages.as_slice() else {
            let several = format!("{name} holds {} pictures; give one at a time", pages.len());
            return Err(Failure::new(several));
        };
        if page.gray.samples().len() > LARGEST {
            let (w, h) = (page.gray.width(), page.gray.height());
            let what = format!("{name} has {w} × {h} px, too many to be traced as one drawing");
            let remedy = "cut it into letters, or scan it at a lower resolution: 100 million pixels are taken";
            return Err(Failure::new(what).help(remedy));
        }
        if self.centerline {
            return self.write_lines(&page.gray);
        }
        let paths =
            trace_picture(&page.gray, &self.options()).map_err(|e| Failure::at(&name, &e))?;
        let size = (page.gray.width(), page.gray.height());
        files::write(&self.output, svg(size, &paths).as_bytes())
    }

    /// Writes the middle of the lines: a UFO where the output is named so, else an SVG.
    fn write_lines(&self, gray: &Gray) -> Outcome {
        let drawn = recognise::centerline(gray);
        if self.output.extension().is_none_or(|e| e != "ufo") {
            return files::write(&self.output, centerline::svg(gray, &drawn).as_bytes());
        }
        let ufo = centerline::ufo(gray, &drawn, &self.output);
        let ufo = ufo.map_err(|e| Failure::at(self.output.display(), &*e))?;
        let mut staged = Staged::default();
        staged.add(&self.output, &ufo)?;
        staged.commit()
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

/// A length or an area: finite and above 0.
pub(super) fn positive(text: &str) -> Result<f64, String> {
    let value = text.parse::<f64>().map_err(|e| e.to_string())?;
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err("must be a finite number above 0".to_owned())
    }
}

/// One path of all contours; user space is the picture's px, y down.
pub(crate) fn svg((w, h): (usize, usize), paths: &[BezPath]) -> String {
    let flip = to_picture(h);
    let mut d = String::new();
    for path in paths {
        for el in (flip * path).elements() {
            path_data(&mut d, *el);
        }
    }
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\">\n\
         <path d=\"{d}\"/>\n</svg>\n"
    )
}

/// Adds one element to an SVG path's data.
pub(super) fn path_data(d: &mut String, el: PathEl) {
    let (letter, points): (char, &[Point]) = match &el {
        PathEl::MoveTo(p) => ('M', &[*p]),
        PathEl::LineTo(p) => ('L', &[*p]),
        PathEl::QuadTo(a, p) => ('Q', &[*a, *p]),
        PathEl::CurveTo(a, b, p) => ('C', &[*a, *b, *p]),
        PathEl::ClosePath => ('Z', &[]),
    };
    d.push(letter);
    for (i, p) in points.iter().enumerate() {
        let space = if i > 0 { " " } else { "" };
        let written = write!(d, "{space}{:.DECIMALS$} {:.DECIMALS$}", p.x, p.y);
        debug_assert!(written.is_ok(), "a String takes everything");
    }
}
