//! What a feature text holds, as its syntax tree tells: words in comments and names are no features.

use fea_rs::parse::{ParseTree, SourceLoadError, parse_root};
use fea_rs::typed::{AstNode, Feature, LanguageSystem};
use fea_rs::{GlyphMap, Kind};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The name under which a text is parsed.
const NAME: &str = "text";

/// A feature text taken apart.
#[derive(Debug, Default)]
pub(super) struct Source {
    features: BTreeSet<String>,
    /// Whether it has a GDEF table.
    pub(super) defines_classes: bool,
    /// Script and language of each language system, in order.
    systems: Vec<(String, String)>,
    /// All of it but its language systems.
    rest: String,
}

impl Source {
    /// Takes a text apart; `None` where it cannot be parsed.
    pub(super) fn read(text: &str, names: &GlyphMap) -> Option<Self> {
        let tree = parse(text, names)?;
        let mut out = Self::default();
        let mut from = 0;
        for item in tree.typed_root().statements() {
            if let Some(feature) = Feature::cast(item) {
                out.features.insert(feature.tag().text().to_string());
            } else if let Some(system) = LanguageSystem::cast(item) {
                let (script, language) = (system.script(), system.language());
                out.systems
                    .push((script.text().to_string(), language.text().to_string()));
                out.rest += text.get(from..system.range().start)?;
                from = system.range().end;
            }
            out.defines_classes |= item.kind() == Kind::GdefTableNode;
        }
        out.rest += text.get(from..)?;
        Some(out)
    }

    pub(super) fn has_feature(&self, tag: &str) -> bool {
        self.features.contains(tag)
    }

    /// This text and another one after it, the language systems of both at the head, those of the default script
    /// first as the syntax asks.
    pub(super) fn joined(&self, more: &Self) -> String {
        let mut systems: Vec<&(String, String)> =
            self.systems.iter().chain(&more.systems).collect();
        systems.sort_by_key(|(script, language)| (script != "DFLT", language != "dflt"));
        let mut seen = BTreeSet::new();
        systems.retain(|s| seen.insert(*s));
        let head = systems
            .iter()
            .map(|(s, l)| format!("languagesystem {s} {l};\n"));
        format!("{}{}\n{}", head.collect::<String>(), self.rest, more.rest)
    }
}

fn parse(text: &str, names: &GlyphMap) -> Option<ParseTree> {
    let parsed = parse_root(
        PathBuf::from(NAME),
        Some(names),
        Box::new(resolver(NAME, text)),
    );
    let (tree, diagnostics) = parsed.ok()?;
    (!diagnostics.has_errors()).then_some(tree)
}

/// Gives a text under its name, and no other file.
pub(super) fn resolver(
    name: &str,
    text: &str,
) -> impl Fn(&Path) -> Result<Arc<str>, SourceLoadError> + use<> {
    let (name, text) = (name.to_owned(), Arc::from(text));
    move |path: &Path| {
        if path == Path::new(&name) {
            Ok(Arc::clone(&text))
        } else {
            let why = "khatt reads one feature file: write what it includes into it, in place of include()";
            Err(SourceLoadError::new(path.to_owned(), why))
        }
    }
}
