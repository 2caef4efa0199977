//! Known fonts taken apart and put together again: how near the sidebearings that we set come to the
//! ones their designers set, and what joining does to their forms.
//!
//!     cargo bench --bench fonts -- [--forms] [--out DIR] FONT…
//!     cargo bench --bench fonts -- --kerning FONT…
//!
//! Takes the shapes alone: letters, digits and signs by default, Arabic letters in all their forms with
//! `--forms`. Prints for each font the median error of the advances in thousandths of the em, and that
//! of the best constant sidebearing, chosen knowing the answer. With `--out` it leaves the fonts there.
//! With `--kerning` letters stand in their fonts' own advances, and the kerning is compared.

#![expect(clippy::print_stdout, reason = "a benchmark prints its table")]

use harfrust::{Feature, ShapeOptions, ShaperData, Tag, UnicodeBuffer};
use khatt::assemble::{self, Drawn, Options};
use khatt::finish::{place, round};
use khatt::quadratic::Method;
use khatt::read::Pen;
use khatt::types::{Font, Frame, Info, Label, Name, Outline};
use khatt::write;
use kurbo::{Affine, BezPath};
use skrifa::outline::DrawSettings;
use skrifa::prelude::{LocationRef, Size};
use skrifa::raw::TableProvider;
use skrifa::{FontRef, GlyphId, MetadataProvider};
use std::collections::BTreeMap;
use std::error::Error;
use std::path::{Path, PathBuf};

const ZWJ: char = '\u{200d}';
const TEXT: &str =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789.,;:!?'\"()[]-&@/*+=";
/// Letters that join on both sides, and those that join the letter before them only.
const DUAL: &str = "بتثجحخسشصضطظعغفقكلمنهيئپچگ";
const RIGHT: &str = "اأإآدذرزوؤةى";
const LIGATURES: &[&str] = &["لا", "لأ", "لإ", "لآ"];

/// The shapes to take out of a font.
type Glyphs = fn(&FontRef<'_>) -> Vec<Truth>;

/// A shape of the known font, in thousandths of the em, and its advance.
struct Truth {
    label: String,
    outline: Outline,
    advance: f64,
}

/// The shape that a text takes in the font.
fn shaped(face: &FontRef<'_>, text: &str, label: String) -> Option<Truth> {
    let data = ShaperData::new(face);
    let mut buffer = UnicodeBuffer::new();
    buffer.push_str(text);
    buffer.guess_segment_properties();
    let shaped = data
        .shaper(face)
        .build()
        .shape(buffer, ShapeOptions::default());
    let em = f64::from(
        face.metrics(Size::unscaled(), LocationRef::default())
            .units_per_em,
    );
    let scale = 1000.0 / em;
    let (mut x, mut contours) = (0.0, Vec::new());
    let outlines = face.outline_glyphs();
    for (info, position) in shaped.glyph_infos().iter().zip(shaped.glyph_positions()) {
        if info.glyph_id == 0 {
            return None;
        }
        let mut pen = Pen::default();
        let settings = DrawSettings::unhinted(Size::unscaled(), LocationRef::default());
        outlines
            .get(GlyphId::new(info.glyph_id))?
            .draw(settings, &mut pen)
            .ok()?;
        let at = (
            x + f64::from(position.x_offset),
            f64::from(position.y_offset),
        );
        contours.push(Affine::scale(scale) * Affine::translate(at) * pen.path());
        x += f64::from(position.x_advance);
    }
    let paths: Vec<BezPath> = contours.iter().flat_map(subpaths).collect();
    let frame = Frame {
        units_per_px: 1.0,
        baseline_px: 0.0,
        origin_px: 0.0,
    };
    let outline = place::outline(&paths, frame).ok()?;
    (!outline.is_empty()).then_some(Truth {
        label,
        outline,
        advance: x * scale,
    })
}

fn subpaths(path: &BezPath) -> Vec<BezPath> {
    let mut out: Vec<BezPath> = Vec::new();
    for el in path.elements() {
        if matches!(el, kurbo::PathEl::MoveTo(_)) {
            out.push(BezPath::new());
        }
        if let Some(last) = out.last_mut() {
            last.push(*el);
        }
    }
    out
}

fn text_glyphs(face: &FontRef<'_>) -> Vec<Truth> {
    TEXT.chars()
        .filter_map(|c| shaped(face, &c.to_string(), c.to_string()))
        .collect()
}

fn arabic_glyphs(face: &FontRef<'_>) -> Vec<Truth> {
    let name = |c: char, form: &str| format!("uni{:04X}{form}", u32::from(c));
    let mut texts = Vec::new();
    for c in DUAL.chars().chain(RIGHT.chars()) {
        texts.push((c.to_string(), name(c, "")));
        texts.push((format!("{ZWJ}{c}"), name(c, ".fina")));
        if DUAL.contains(c) {
            texts.push((format!("{c}{ZWJ}"), name(c, ".init")));
            texts.push((format!("{ZWJ}{c}{ZWJ}"), name(c, ".medi")));
        }
    }
    for text in LIGATURES {
        let hex: String = text
            .chars()
            .map(|c| format!("{:04X}", u32::from(c)))
            .collect();
        texts.push(((*text).to_owned(), format!("uni{hex}")));
        texts.push((format!("{ZWJ}{text}"), format!("uni{hex}.fina")));
    }
    for c in "ءـ،؛؟٠١٢٣٤٥٦٧٨٩\u{64b}\u{64c}\u{64d}\u{64e}\u{64f}\u{650}\u{651}\u{652}".chars()
    {
        texts.push((c.to_string(), name(c, "")));
    }
    texts
        .into_iter()
        .filter_map(|(text, label)| shaped(face, &text, label))
        .collect()
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// The median error of the constant sidebearing that suits the font best.
fn best_constant(truth: &[Truth]) -> f64 {
    let rooms: Vec<f64> = truth
        .iter()
        .filter_map(|t| t.outline.bounds().map(|b| t.advance - b.width()))
        .collect();
    let errors =
        (-100..200).map(|c| median(rooms.iter().map(|r| (r - f64::from(c)).abs()).collect()));
    errors.fold(f64::INFINITY, f64::min)
}

fn write_all(font: &Font, stem: &Path) -> Result<(), Box<dyn Error>> {
    let quadratic = font.try_map_outlines(|g| Method::default().convert(&g.outline, 0.5));
    let quadratic = quadratic.map_err(|errors| format!("{errors:?}"))?;
    let rounded = round::font(font);
    for format in write::FORMATS {
        let source = if format.curves == write::Curves::Quadratic {
            &quadratic
        } else {
            &rounded
        };
        let base = stem.with_extension(format.extension.unwrap_or(format.name));
        for (path, bytes) in (format.write)(source)?.0 {
            let path = if path.is_empty() {
                base.clone()
            } else {
                base.join(path)
            };
            std::fs::create_dir_all(path.parent().unwrap_or(Path::new(".")))?;
            std::io::Write::write_all(&mut std::fs::File::create(path)?, &bytes)?;
        }
    }
    Ok(())
}

/// By how much the font's own kerning changes the advance of two letters.
fn kerned(shaper: &harfrust::Shaper<'_>, text: &str) -> f64 {
    let advance = |kern: u32| {
        let plain = [b"liga", b"clig", b"calt"].map(|tag| Feature::new(Tag::new(tag), 0, ..));
        let mut features = plain.to_vec();
        features.push(Feature::new(Tag::new(b"kern"), kern, ..));
        let mut buffer = UnicodeBuffer::new();
        buffer.push_str(text);
        buffer.guess_segment_properties();
        let shaped = shaper.shape(buffer, ShapeOptions::default().features(&features));
        let advances = shaped.glyph_positions().iter().map(|p| p.x_advance);
        f64::from(advances.sum::<i32>())
    };
    advance(1) - advance(0)
}

/// The kerning of letters that stand in the font's own advances beside that of the font.
fn kerning(path: &Path) -> Result<(), Box<dyn Error>> {
    let bytes = std::fs::read(path)?;
    let face = FontRef::new(&bytes)?;
    let em = f64::from(face.head()?.units_per_em());
    let truth = text_glyphs(&face);
    let drawn = truth.iter().map(|t| Drawn {
        label: Label(t.label.clone()),
        outline: t.outline.clone(),
        plates: Vec::new(),
        advance: Some((0.0, t.advance)),
    });
    let info = Info {
        family: "Khatt".to_owned(),
        ..Info::default()
    };
    let font = assemble::font(drawn.collect(), info, &Options::default())?.font;
    let data = ShaperData::new(&face);
    let shaper = data.shaper(&face).build();
    let sets = &font.kerning;
    let side = |name: &str, groups: &BTreeMap<String, Vec<Name>>| {
        let holds = |g: &(&String, &Vec<Name>)| g.1.iter().any(|n| n.as_str() == name);
        groups
            .iter()
            .find(holds)
            .map_or_else(|| name.to_owned(), |g| format!("@{}", g.0))
    };
    let ours = |a: &str, b: &str| {
        let (a, b) = (name_of(a), name_of(b));
        let pair = (side(&a, &sets.first), side(&b, &sets.second));
        sets.pairs.get(&pair).copied().unwrap_or(0.0)
    };
    let (mut theirs, mut kept, mut other, mut count) = (Vec::new(), Vec::new(), Vec::new(), 0);
    let letters: Vec<char> = TEXT.chars().filter(|c| c.is_alphabetic()).collect();
    for a in &letters {
        for b in letters
            .iter()
            .filter(|b| !(a.is_lowercase() && b.is_uppercase()))
        {
            let own = 1000.0 / em * kerned(&shaper, &format!("{a}{b}"));
            let value = ours(&a.to_string(), &b.to_string());
            count += usize::from(value < 0.0);
            if own.abs() < 5.0 {
                other.push(value.abs());
            } else {
                theirs.push(own.abs());
                kept.push((value - own).abs());
            }
        }
    }
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len().max(1) as f64;
    let ttf = write::FORMATS
        .iter()
        .find(|f| f.name == "ttf")
        .ok_or("no TTF")?;
    let quadratic = font.try_map_outlines(|g| Method::default().convert(&g.outline, 0.5));
    let quadratic = quadratic.map_err(|errors| format!("{errors:?}"))?;
    let files = (ttf.write)(&quadratic)?.0;
    let file = files.values().next().ok_or("no file")?;
    let table = FontRef::new(file)?.data_for_tag(Tag::new(b"GPOS"));
    println!(
        "| {} | {} | {:.1} | {:.1} | {:.1} | {count} | {} × {} | {} |",
        path.file_stem().unwrap_or_default().to_string_lossy(),
        theirs.len(),
        mean(&theirs),
        mean(&kept),
        mean(&other),
        sets.first.len(),
        sets.second.len(),
        table.map_or(0, |t| t.len()),
    );
    Ok(())
}

fn run(path: &Path, glyphs: Glyphs, out: Option<&Path>) -> Result<(), Box<dyn Error>> {
    let bytes = std::fs::read(path)?;
    let face = FontRef::new(&bytes)?;
    let truth = glyphs(&face);
    let drawn = truth.iter().map(|t| Drawn {
        label: Label(t.label.clone()),
        outline: t.outline.clone(),
        plates: Vec::new(),
        advance: None,
    });
    let stem = path
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    let info = Info {
        family: format!("Khatt {stem}"),
        ..Info::default()
    };
    let built = assemble::font(drawn.collect(), info, &Options::default())?;
    let error = |t: &Truth| {
        built
            .font
            .glyph(&name_of(&t.label))
            .map(|g| g.advance - t.advance)
    };
    let errors: Vec<f64> = truth.iter().filter_map(error).collect();
    for note in &built.notes {
        println!("  note: {}: {}", note.glyph, note.message);
    }
    println!(
        "{stem}: {} glyphs, median |advance error| {:.1}, median error {:+.1}, best constant {:.1}, contract {:?}",
        truth.len(),
        median(errors.iter().map(|e| e.abs()).collect()),
        median(errors),
        best_constant(&truth),
        built.joining.contract,
    );
    out.map_or(Ok(()), |dir| write_all(&built.font, &dir.join(stem)))
}

fn name_of(label: &str) -> String {
    assemble::names::identify(&Label(label.to_owned()))
        .map_or_else(|_| String::new(), |i| i.name.to_string())
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut args = std::env::args().skip(1);
    let (mut fonts, mut glyphs, mut out) = (Vec::new(), text_glyphs as Glyphs, None);
    let mut kern = false;
    while let Some(arg) = args.next() {
        match arg.as_str() {
            "--forms" => glyphs = arabic_glyphs,
            "--kerning" => kern = true,
            "--out" => out = args.next().map(PathBuf::from),
            // what cargo itself passes
            "--bench" => {}
            font => fonts.push(PathBuf::from(font)),
        }
    }
    for font in &fonts {
        if kern {
            kerning(font)?;
        } else {
            run(font, glyphs, out.as_deref())?;
        }
    }
    Ok(())
}
