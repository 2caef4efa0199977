//! `khatt trace`: one picture becomes one SVG path.

use super::failure::{Failure, chain};
use super::{Outcome, files};
use clap::Args;
use clap::builder::PossibleValuesParser;
use khatt::pipeline::picture::{Options, to_picture, trace_picture};
use khatt::recognise::{self, Centerline};
use khatt::scan::{self, Polarity};
use khatt::types::Gray;
use khatt::{corner, fit};
use kurbo::{BezPath, PathEl, Point};
use std::fmt::Write as _;
use std::path::PathBuf;

/// Decimals of a coordinate, px.
const DECIMALS: usize = 4;

/// Traces one picture into an SVG whose unit is the picture's pixel
#[derive(Debug, Args)]
pub(crate) struct Trace {
    /// Picture to trace, or - for standard input
    #[arg(value_name = "IN")]
    picture: PathBuf,
    /// Where the SVG goes, or - for standard output
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
    /// Give the middle of the lines that a pen drew, with their width, in place of their outline
    #[arg(long, conflicts_with_all = ["fit", "corners", "tolerance"])]
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
        if self.centerline {
            let lines = svg_lines(&page.gray, &recognise::centerline(&page.gray));
            return files::write(&self.output, lines.as_bytes());
        }
        let paths =
            trace_picture(&page.gray, &self.options()).map_err(|e| Failure::at(&name, &e))?;
        files::write(&self.output, svg(&page.gray, &paths).as_bytes())
    }

    /// The defaults with what the command line changes.
    fn options(&self) -> Options {
        let mut options = Options::default();
        if let Some(px) = self.tolerance {
            options.tolerance_px = px;
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

/// A length: finite and above 0.
pub(super) fn positive(text: &str) -> Result<f64, String> {
    let value = text.parse::<f64>().map_err(|e| e.to_string())?;
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err("must be a finite number above 0".to_owned())
    }
}

/// One path of all contours; user space is the picture's px, y down.
pub(crate) fn svg(gray: &Gray, paths: &[BezPath]) -> String {
    let flip = to_picture(gray);
    let (w, h) = (gray.width(), gray.height());
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

/// A stroked path of each line, as wide as the line is in the middle; the width at each of its nodes in
/// `data-widths`. Dots are circles. User space is the picture's px, y down.
fn svg_lines(gray: &Gray, drawn: &Centerline) -> String {
    let (w, h) = (gray.width(), gray.height());
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\">\n\
         <g fill=\"none\" stroke=\"black\" stroke-linecap=\"round\" stroke-linejoin=\"round\">\n"
    );
    for line in &drawn.lines {
        let mut d = String::new();
        line.path
            .elements()
            .iter()
            .for_each(|el| path_data(&mut d, *el));
        let mut sorted = line.widths.clone();
        sorted.sort_by(f64::total_cmp);
        let middle = sorted.get(sorted.len() / 2).copied().unwrap_or_default();
        let widths: Vec<String> = line.widths.iter().map(|w| format!("{w:.2}")).collect();
        let widths = widths.join(" ");
        out +=
            &format!("<path stroke-width=\"{middle:.2}\" data-widths=\"{widths}\" d=\"{d}\"/>\n");
    }
    out += "</g>\n";
    for dot in &drawn.dots {
        let (x, y, r) = (dot.centre.x, dot.centre.y, dot.radius);
        out += &format!("<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{r:.2}\"/>\n");
    }
    out + "</svg>\n"
}

/// Adds one element to an SVG path's data.
fn path_data(d: &mut String, el: PathEl) {
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
