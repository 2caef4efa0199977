//! `khatt convert`: a font or drawings in one format become another.

use super::failure::{Complaint, Failure, chain};
use super::{Common, Khatt, Outcome, files, staged};
use clap::builder::PossibleValuesParser;
use clap::error::ErrorKind;
use clap::{Args, CommandFactory};
use khatt::pipeline::Problem;
use khatt::pipeline::convert::{Options, Outlines, convert};
use khatt::quadratic::{Method, rate::Strictness};
use khatt::read::{self, Reading};
use khatt::types::Font;
use khatt::write::{FORMATS, Format, format};
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::slice;

/// Converts a font or SVG drawings into another format
#[derive(Debug, Args)]
pub(crate) struct Convert {
    /// TTF, OTF, WOFF2 or SVG file, UFO folder, or a folder of SVG files
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// Where it goes; the ending says the format, no ending is a folder of SVG files
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// Largest error of converted outlines, in thousandths of the em [default: 0.5]
    #[arg(long, value_name = "UNITS", value_parser = super::trace::positive)]
    tolerance: Option<f64>,
    /// How cubics become quadratics; `khatt methods` lists the ways
    #[arg(long, value_name = "METHOD", hide_possible_values = true, value_parser = PossibleValuesParser::new(Method::all().iter().map(Method::key)))]
    quadratic: Option<String>,
    /// What the conversion with fewest bytes keeps beside the shape: extrema, corners alone, or extrema
    /// and the places of corners
    #[arg(long, value_name = "WHAT", requires = "quadratic", value_parser = ["extrema", "corners", "places"])]
    keep: Option<String>,
    /// Convert outlines that the format could store as they are, too
    #[arg(long)]
    optimize: bool,
    /// Place of a variable font on an axis, as in wght=700
    #[arg(long, value_name = "AXIS=VALUE", value_parser = axis)]
    location: Vec<(String, f64)>,
    /// Which font of a collection: its number, from 1, or its name
    #[arg(long, value_name = "FACE")]
    face: Option<String>,
}

/// Files of fonts that are not read: their endings, what they are, and what to do.
const SOURCES: [(&[&str], &str, &str); 5] = [
    (
        &["glyphs", "glyphspackage"],
        "a source of Glyphs",
        "export it there as OTF or TTF, or as a UFO",
    ),
    (
        &["designspace"],
        "a designspace, a list of UFOs",
        "convert one of the UFOs that it names, or make a variable font of it with fontmake",
    ),
    (
        &["sfd", "sfdir"],
        "a source of FontForge",
        "generate OTF, TTF or a UFO there",
    ),
    (
        &["vfb", "vfc", "vfj"],
        "a source of FontLab",
        "export it there as OTF or TTF, or as a UFO",
    ),
    (
        &["pfa", "pfb", "eot"],
        "a font of an older kind (Type 1 or EOT)",
        "save it as OTF or TTF in a font editor",
    ),
];

/// What no folder of drawings says of a font.
fn unsaid(font: &Font) -> impl Iterator<Item = String> {
    let em = font.info.units_per_em;
    let em = (em != 1000).then(|| format!("{em} units an em (drawings are read as 1000 units)"));
    let several = font.glyphs().iter().filter(|g| g.codepoints.len() > 1);
    let several = match several.count() {
        0 => None,
        n => Some(format!(
            "second characters (glyphs that have some: {n}; a drawing's name says one)"
        )),
    };
    em.into_iter().chain(several)
}

impl Convert {
    pub(crate) fn run(&self, common: &Common) -> Outcome {
        let options = self.options();
        let target = self.format()?;
        let Reading { font, mut lost } = self.read()?;
        if matches!(target.name, "ufo" | "svg") && !font.carried.is_empty() {
            let tags: Vec<_> = font
                .carried
                .keys()
                .map(|t| String::from_utf8_lossy(t).trim().to_owned())
                .collect();
            lost.push(format!("compiled tables ({})", tags.join(", ")));
        }
        if target.name == "svg" {
            lost.extend(unsaid(&font));
        }
        let name = files::name(&self.input);
        let complaint = |p: &Problem| Complaint::new(format!("{name}: {}", chain(p)), None);
        let files = convert(&font, target, &options)
            .map_err(|problems| problems.iter().map(complaint).collect::<Failure>())?;
        let inputs = slice::from_ref(&self.input);
        staged::write(&[(self.output.clone(), files)], inputs)?;
        for line in lost.iter().filter(|_| !common.quiet) {
            eprintln!("not carried over: {line}");
        }
        Ok(())
    }

    fn format(&self) -> Result<&'static Format, Failure> {
        if files::is_dash(&self.output) {
            let what = "- is standard output, to which no font is written";
            return Err(Failure::of_use(what).help("name a file, or a folder for SVG files"));
        }
        let ending = self
            .output
            .extension()
            .and_then(OsStr::to_str)
            .map(str::to_ascii_lowercase);
        let name = ending.as_deref().unwrap_or("svg");
        let known = format(name).filter(|f| f.name != "svg" || ending.is_none());
        known.ok_or_else(|| {
            let all: Vec<_> = FORMATS.iter().filter_map(|f| f.extension).collect();
            let name = self.output.display();
            let remedy = format!(
                "end it in .{}, or name a folder for SVG files",
                all.join(", .")
            );
            Failure::of_use(format!("{name} is no name for a font")).help(remedy)
        })
    }

    fn read(&self) -> Result<Reading, Failure> {
        let name = files::name(&self.input);
        let fail = |e: &read::ReadError| Failure::new(format!("{name}: {}", chain(e)));
        self.refuse_source(&name)?;
        let is_ufo = self.input.join("metainfo.plist").exists();
        let ending = self.input.extension().and_then(OsStr::to_str);
        let is_drawn = ending.is_some_and(|e| e.eq_ignore_ascii_case("svg"));
        if is_ufo || is_drawn || self.input.is_dir() {
            self.refuse_places();
        }
        if is_ufo {
            return read::ufo(&self.input).map_err(|e| fail(&e));
        }
        if self.input.is_dir() {
            return read::svg(&drawings(&self.input)?).map_err(|e| fail(&e));
        }
        let bytes = files::read(&self.input)?;
        let reading = if is_drawn {
            read::svg(&[(name.clone(), bytes)])
        } else {
            read::font(&bytes, self.face.as_deref(), &self.location)
        };
        reading.map_err(|e| fail(&e))
    }

    /// What other programs keep of a font, by its ending.
    fn refuse_source(&self, name: &str) -> Outcome {
        let ending = self.input.extension().and_then(OsStr::to_str);
        let ending = ending.map(str::to_ascii_lowercase).unwrap_or_default();
        let found = SOURCES.iter().find(|s| s.0.contains(&ending.as_str()));
        found.map_or(Ok(()), |(_, what, remedy)| {
            let why = format!("{name} is {what}, which is not read");
            Err(Failure::new(why).help(*remedy))
        })
    }

    /// Drawings and UFOs hold one font, and it does not vary.
    fn refuse_places(&self) {
        if self.face.is_some() || !self.location.is_empty() {
            let name = self.input.display();
            let why =
                format!("--face and --location are for TTF, OTF and WOFF2 files; {name} is none");
            conflict(why);
        }
    }

    fn options(&self) -> Options {
        let mut options = Options::default();
        options.tolerance = self.tolerance.unwrap_or(options.tolerance);
        if let Some(method) = Method::all()
            .into_iter()
            .find(|m| self.quadratic.as_deref() == Some(m.key()))
        {
            options.quadratic = method;
        }
        if let Some(keep) = &self.keep {
            let Method::Rate(rate) = &mut options.quadratic else {
                let key = options.quadratic.key();
                let why = format!("--keep is for --quadratic rate, and {key} keeps nothing");
                conflict(why);
            };
            rate.keep = match keep.as_str() {
                "corners" => Strictness::Corners,
                "places" => Strictness::Places,
                _ => rate.keep,
            };
        }
        if self.optimize {
            options.outlines = Outlines::All;
        }
        options
    }
}

/// Ends the program: the command line is wrong.
fn conflict(why: String) -> ! {
    let mut command = Khatt::command();
    command.error(ErrorKind::ArgumentConflict, why).exit()
}

/// The SVG files of a folder, by name.
fn drawings(folder: &Path) -> Result<Vec<(String, Vec<u8>)>, Failure> {
    let fail = |e: &std::io::Error| Failure::at(folder.display(), e);
    let mut paths = Vec::new();
    for entry in fs::read_dir(folder).map_err(|e| fail(&e))? {
        let path = entry.map_err(|e| fail(&e))?.path();
        if path
            .extension()
            .is_some_and(|e| e.eq_ignore_ascii_case("svg"))
        {
            paths.push(path);
        }
    }
    paths.sort();
    paths
        .iter()
        .map(|p| Ok((p.display().to_string(), files::read(p)?)))
        .collect()
}

/// `wght=700`
fn axis(text: &str) -> Result<(String, f64), String> {
    let (tag, value) = text.split_once('=').ok_or("write it as AXIS=VALUE")?;
    let value: f64 = value.parse().map_err(|_| format!("{value} is no number"))?;
    if value.is_finite() {
        Ok((tag.to_owned(), value))
    } else {
        Err("must be finite".to_owned())
    }
}
