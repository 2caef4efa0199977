//! OpenType layout: one feature text for every format, compiled in process.
//!
//! The text is the font's own features, then what follows from its data, as UFO compilers write it:
//! kerning from its pairs, `curs`, `mark` and `mkmk` from its anchors, glyph classes from both. A feature or
//! table that the font's text has already is left to it.

use super::WriteError;
use crate::types::{Anchor, Font, Glyph};
use fea_rs::compile::{Compilation, NopFeatureProvider, NopVariationInfo, error::CompilerError};
use fea_rs::parse::SourceLoadError;
use fea_rs::{Compiler, GlyphMap};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;

/// The name that messages give the feature text.
const SOURCE: &str = "features.fea";

/// The class of a glyph in GDEF.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Class {
    Base,
    Ligature,
    Mark,
}

/// A glyph's class, as its anchors tell it: none for one that has none.
pub(super) fn class(glyph: &Glyph) -> Option<Class> {
    let any = |is: &dyn Fn(&str) -> bool| glyph.anchors.iter().any(|a| is(&a.name));
    if any(&|n| n.starts_with('_')) {
        Some(Class::Mark)
    } else if any(&|n| part(n).is_some()) {
        Some(Class::Ligature)
    } else {
        (!glyph.anchors.is_empty()).then_some(Class::Base)
    }
}

/// `top` and 2 of `top_2`.
fn part(anchor: &str) -> Option<(&str, usize)> {
    let (name, number) = anchor.rsplit_once('_').filter(|(n, _)| !n.is_empty())?;
    Some((name, number.parse().ok()?))
}

/// The whole feature text.
#[must_use]
pub fn text(font: &Font) -> String {
    let own = |what: &str| font.features.contains(what);
    let mut out = font.features.clone();
    if !font.kerning.pairs.is_empty() && !own("feature kern") {
        out += &kern(font);
    }
    if !own("feature curs") {
        out += &cursive(font);
    }
    let marks = Marks::of(font);
    if !marks.attaching.is_empty() {
        out += &marks.classes();
        if !own("feature mark") {
            out += &marks.feature("mark", &[Class::Base, Class::Ligature]);
        }
        if !own("feature mkmk") {
            out += &marks.feature("mkmk", &[Class::Mark]);
        }
        if !own("table GDEF") {
            out += &marks.definitions();
        }
    }
    out
}

/// Pairs of glyphs first, then of groups: the first rule that fits counts.
fn kern(font: &Font) -> String {
    let kerning = &font.kerning;
    let leftward = leftward(font);
    let mut out = String::from("\n");
    for (number, groups) in [(1, &kerning.first), (2, &kerning.second)] {
        for (group, members) in groups {
            let members: Vec<&str> = members.iter().map(|m| m.as_str()).collect();
            push(
                &mut out,
                format_args!("@kern{number}.{group} = [{}];\n", members.join(" ")),
            );
        }
    }
    let mut rules = [String::new(), String::new()];
    let side = |side: &str, number: u8| match side.strip_prefix('@') {
        Some(group) => format!("@kern{number}.{group}"),
        None => side.to_owned(),
    };
    let is_group = |pair: &(String, String)| pair.0.starts_with('@') || pair.1.starts_with('@');
    for groups in [false, true] {
        for (pair, value) in kerning.pairs.iter().filter(|(p, _)| is_group(p) == groups) {
            let (first, second) = (side(&pair.0, 1), side(&pair.1, 2));
            let mixed = groups && pair.0.starts_with('@') != pair.1.starts_with('@');
            let keyword = if mixed { "enum pos" } else { "pos" };
            let value = value.round();
            if leftward.contains(&pair.0) || leftward.contains(&pair.1) {
                // the first letter stands right of the second: it moves, and what came before it follows
                let rule =
                    format_args!("        {keyword} {first} {second} <{value} 0 {value} 0>;\n");
                push(&mut rules[1], rule);
            } else {
                push(
                    &mut rules[0],
                    format_args!("        {keyword} {first} {second} {value};\n"),
                );
            }
        }
    }
    out += "feature kern {\n";
    for (name, rules) in ["kern_rightward", "kern_leftward"].iter().zip(&rules) {
        if !rules.is_empty() {
            let body = format_args!(
                "    lookup {name} {{\n        lookupflag IgnoreMarks;\n{rules}    }} {name};\n"
            );
            push(&mut out, body);
        }
    }
    out + "} kern;\n"
}

/// The sides of pairs, as these name them, whose letters read from the right: encoded so, or forms of such.
fn leftward(font: &Font) -> BTreeSet<String> {
    let reads_so =
        |c: &char| matches!(u32::from(*c), 0x590..=0x8FF | 0xFB1D..=0xFDFF | 0xFE70..=0xFEFF);
    let encoded = font
        .glyphs()
        .iter()
        .filter(|g| g.codepoints.iter().any(reads_so));
    let encoded: BTreeSet<&str> = encoded.map(|g| base(g.name.as_str())).collect();
    let is_one = |name: &str| encoded.contains(base(name));
    let kerning = &font.kerning;
    let groups = kerning.first.iter().chain(&kerning.second);
    let groups = groups.filter(|(_, members)| members.iter().any(|m| is_one(m.as_str())));
    let glyphs = font
        .glyphs()
        .iter()
        .map(|g| g.name.to_string())
        .filter(|n| is_one(n));
    groups
        .map(|(name, _)| format!("@{name}"))
        .chain(glyphs)
        .collect()
}

/// A name without its suffixes.
fn base(name: &str) -> &str {
    name.split('.').next().unwrap_or_default()
}

fn push(out: &mut String, text: std::fmt::Arguments<'_>) {
    let done = out.write_fmt(text);
    debug_assert!(done.is_ok(), "a string takes all that is written to it");
}

/// Letters that are shifted until the exit of one is the entry of the next; a word's last letter stays on the line.
fn cursive(font: &Font) -> String {
    let rule = |glyph: &Glyph| {
        let place = |name: &str| glyph.anchors.iter().find(|a| a.name == name).map(at);
        let null = || "<anchor NULL>".to_owned();
        let (entry, exit) = (place("entry"), place("exit"));
        (entry.is_some() || exit.is_some()).then(|| {
            let (entry, exit) = (entry.unwrap_or_else(null), exit.unwrap_or_else(null));
            format!("    pos cursive {} {entry} {exit};\n", glyph.name)
        })
    };
    let rules: String = font.glyphs().iter().filter_map(rule).collect();
    if rules.is_empty() {
        return rules;
    }
    format!("\nfeature curs {{\n    lookupflag RightToLeft IgnoreMarks;\n{rules}}} curs;\n")
}

/// Glyphs with anchors, sorted by what they are.
struct Marks<'a> {
    /// Anchor name without `_` → the marks that attach by it.
    attaching: BTreeMap<&'a str, Vec<(&'a Glyph, &'a Anchor)>>,
    classed: Vec<(&'a Glyph, Class)>,
}

impl<'a> Marks<'a> {
    fn of(font: &'a Font) -> Self {
        let mut attaching: BTreeMap<&str, Vec<(&Glyph, &Anchor)>> = BTreeMap::new();
        let mut classed = Vec::new();
        for glyph in font.glyphs() {
            classed.extend(class(glyph).map(|c| (glyph, c)));
            for anchor in &glyph.anchors {
                if let Some(name) = anchor.name.strip_prefix('_') {
                    attaching.entry(name).or_default().push((glyph, anchor));
                }
            }
        }
        Self { attaching, classed }
    }

    fn classes(&self) -> String {
        let mut out = String::from("\n");
        for (name, marks) in &self.attaching {
            for (glyph, anchor) in marks {
                push(
                    &mut out,
                    format_args!("markClass {} {} @mark.{name};\n", glyph.name, at(anchor)),
                );
            }
        }
        out
    }

    /// A feature of one lookup for each anchor name and class of glyph that carries it.
    fn feature(&self, tag: &str, carriers: &[Class]) -> String {
        let mut body = String::new();
        for name in self.attaching.keys() {
            for &carrier in carriers {
                let glyphs = self.classed.iter().filter(|(_, c)| *c == carrier);
                let rules: String = glyphs.filter_map(|(g, _)| rule(g, carrier, name)).collect();
                if !rules.is_empty() {
                    let kind = match carrier {
                        Class::Base => "base",
                        Class::Ligature => "ligature",
                        Class::Mark => "mark",
                    };
                    let label = format!("{tag}_{kind}_{name}");
                    push(
                        &mut body,
                        format_args!("    lookup {label} {{\n{rules}    }} {label};\n"),
                    );
                }
            }
        }
        if body.is_empty() {
            body
        } else {
            format!("\nfeature {tag} {{\n{body}}} {tag};\n")
        }
    }

    fn definitions(&self) -> String {
        let list = |class: Class| {
            let names: Vec<&str> = self
                .classed
                .iter()
                .filter(|(_, c)| *c == class)
                .map(|(g, _)| g.name.as_str())
                .collect();
            if names.is_empty() {
                String::new()
            } else {
                format!("[{}]", names.join(" "))
            }
        };
        format!(
            "\ntable GDEF {{\n    GlyphClassDef {}, {}, {}, ;\n}} GDEF;\n",
            list(Class::Base),
            list(Class::Ligature),
            list(Class::Mark)
        )
    }
}

fn at(anchor: &Anchor) -> String {
    format!("<anchor {} {}>", anchor.at.x.round(), anchor.at.y.round())
}

/// How one glyph carries the marks of that anchor name.
fn rule(glyph: &Glyph, carrier: Class, name: &str) -> Option<String> {
    if carrier != Class::Ligature {
        let anchor = glyph.anchors.iter().find(|a| a.name == name)?;
        let kind = if carrier == Class::Mark {
            "mark"
        } else {
            "base"
        };
        return Some(format!(
            "        pos {kind} {} {} mark @mark.{name};\n",
            glyph.name,
            at(anchor)
        ));
    }
    let parts: BTreeMap<usize, &Anchor> = glyph
        .anchors
        .iter()
        .filter_map(|a| {
            part(&a.name)
                .filter(|(n, _)| *n == name)
                .map(|(_, i)| (i, a))
        })
        .collect();
    let last = glyph
        .anchors
        .iter()
        .filter_map(|a| part(&a.name))
        .map(|p| p.1)
        .max()?;
    if parts.is_empty() {
        return None;
    }
    let one = |i: usize| {
        parts.get(&i).map_or("<anchor NULL>".to_owned(), |a| {
            format!("{} mark @mark.{name}", at(a))
        })
    };
    let all: Vec<String> = (1..=last).map(one).collect();
    Some(format!(
        "        pos ligature {} {};\n",
        glyph.name,
        all.join(" ligComponent ")
    ))
}

/// GSUB, GPOS and GDEF of the font.
pub(super) fn compile(font: &Font) -> Result<Compilation, WriteError> {
    compiled(font, SOURCE, text(font))
}

/// Whether a feature text compiles by itself for the glyphs of a font; messages call it `name`.
///
/// # Errors
/// What is wrong with it, line by line.
pub fn check(font: &Font, name: &str, text: &str) -> Result<(), WriteError> {
    compiled(font, name, text.to_owned()).map(drop)
}

fn compiled(font: &Font, source: &str, text: String) -> Result<Compilation, WriteError> {
    let names = GlyphMap::new(font.glyphs().iter().map(|g| g.name.as_str()))
        .map_err(|e| WriteError::Features(e.to_string()))?;
    let text: Arc<str> = text.into();
    let only = source.to_owned();
    let resolver = move |path: &Path| {
        if path == Path::new(&only) {
            Ok(text.clone())
        } else {
            Err(SourceLoadError::new(
                path.to_owned(),
                "include() is resolved before a font is built",
            ))
        }
    };
    Compiler::<NopFeatureProvider, NopVariationInfo>::new(source, &names)
        .with_resolver(resolver)
        .compile()
        .map_err(|e| WriteError::Features(message(&e)))
}

fn message(error: &CompilerError) -> String {
    match error {
        CompilerError::ParseFail(d)
        | CompilerError::ValidationFail(d)
        | CompilerError::CompilationFail(d) => d.display().to_string(),
        other => other.to_string(),
    }
}
