//! Where marks attach, by the anchors of glyphs: `mark`, `mkmk`, and the classes of glyphs; and `curs`.

use crate::types::{Anchor, Font, Glyph, label};
use std::collections::{BTreeMap, BTreeSet};
use unicode_normalization::char::canonical_combining_class;

/// The class of a glyph in GDEF.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::write) enum Class {
    Base,
    Ligature,
    Mark,
}

impl Class {
    /// What feature files and UFOs call it.
    pub(in crate::write) const fn word(self) -> &'static str {
        match self {
            Self::Base => "base",
            Self::Ligature => "ligature",
            Self::Mark => "mark",
        }
    }
}

/// A glyph's class, as its anchors tell it: none for one that has none. What only stands for combining characters is a
/// mark without them, too.
pub(in crate::write) fn class(glyph: &Glyph) -> Option<Class> {
    let any = |is: &dyn Fn(&str) -> bool| glyph.anchors.iter().any(|a| is(&a.name));
    let combines = |c: &char| canonical_combining_class(*c) != 0;
    let is_combining = !glyph.codepoints.is_empty() && glyph.codepoints.iter().all(combines);
    if is_combining || any(&|n| n.starts_with('_')) {
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

/// Letters that are shifted until the exit of one is the entry of the next; a word's last letter stays on the line.
pub(super) fn cursive(font: &Font) -> String {
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

/// The marks that attach by one anchor.
struct Attaching<'a> {
    /// The anchor's name as a feature file can have it.
    label: String,
    marks: Vec<(&'a Glyph, &'a Anchor)>,
}

/// Glyphs with anchors, sorted by what they are.
pub(super) struct Marks<'a> {
    /// By the anchor's name without `_`.
    attaching: BTreeMap<&'a str, Attaching<'a>>,
    classed: Vec<(&'a Glyph, Class)>,
}

impl<'a> Marks<'a> {
    pub(super) fn of(font: &'a Font) -> Self {
        let mut found: BTreeMap<&str, Vec<(&Glyph, &Anchor)>> = BTreeMap::new();
        let mut classed = Vec::new();
        for glyph in font.glyphs() {
            classed.extend(class(glyph).map(|c| (glyph, c)));
            for anchor in &glyph.anchors {
                if let Some(name) = anchor.name.strip_prefix('_') {
                    found.entry(name).or_default().push((glyph, anchor));
                }
            }
        }
        let names: BTreeSet<&str> = found.keys().copied().collect();
        let mut attaching = BTreeMap::<&str, Attaching<'_>>::new();
        for (name, marks) in found {
            let free = |label: &str| {
                label == name
                    || !names.contains(label) && attaching.values().all(|a| a.label != label)
            };
            let label = label(name, free);
            attaching.insert(name, Attaching { label, marks });
        }
        Self { attaching, classed }
    }

    /// Whether there are any, attaching to others or not.
    pub(super) fn are_there(&self) -> bool {
        self.classed.iter().any(|(_, class)| *class == Class::Mark)
    }

    pub(super) fn classes(&self) -> String {
        let mut out = String::from("\n");
        for Attaching { label, marks } in self.attaching.values() {
            for (glyph, anchor) in marks {
                out += &format!("markClass {} {} @mark.{label};\n", glyph.name, at(anchor));
            }
        }
        out
    }

    /// A feature of one lookup for each anchor name and class of glyph that carries it.
    pub(super) fn feature(&self, tag: &str, carriers: &[Class]) -> String {
        let mut body = String::new();
        for (name, Attaching { label, .. }) in &self.attaching {
            for &carrier in carriers {
                let glyphs = self.classed.iter().filter(|(_, c)| *c == carrier);
                let rule = |g: &Glyph| rule(g, carrier, [name, label]);
                let rules: String = glyphs.filter_map(|(g, _)| rule(g)).collect();
                if !rules.is_empty() {
                    let label = format!("{tag}_{}_{label}", carrier.word());
                    let flag = self.filter(name, carrier);
                    body += &format!("    lookup {label} {{\n{flag}{rules}    }} {label};\n");
                }
            }
        }
        if body.is_empty() {
            body
        } else {
            format!("\nfeature {tag} {{\n{body}}} {tag};\n")
        }
    }

    /// Where marks carry marks, those of other anchors are passed over: one above does not stand on one below.
    fn filter(&self, anchor: &str, carrier: Class) -> String {
        if carrier != Class::Mark {
            return String::new();
        }
        let has = |g: &Glyph| {
            g.anchors
                .iter()
                .any(|a| a.name.strip_prefix('_').unwrap_or(&a.name) == anchor)
        };
        let marks = self
            .classed
            .iter()
            .filter(|(g, class)| *class == Class::Mark && has(g));
        let names: Vec<&str> = marks.map(|(g, _)| g.name.as_str()).collect();
        format!(
            "        lookupflag UseMarkFilteringSet [{}];\n",
            names.join(" ")
        )
    }

    pub(super) fn definitions(&self) -> String {
        let list = |class: Class| {
            let own = self.classed.iter().filter(|(_, c)| *c == class);
            let names: Vec<&str> = own.map(|(g, _)| g.name.as_str()).collect();
            if names.is_empty() {
                String::new()
            } else {
                format!("[{}]", names.join(" "))
            }
        };
        let [bases, ligatures, marks] = [Class::Base, Class::Ligature, Class::Mark].map(list);
        format!("\ntable GDEF {{\n    GlyphClassDef {bases}, {ligatures}, {marks}, ;\n}} GDEF;\n")
    }
}

fn at(anchor: &Anchor) -> String {
    format!("<anchor {} {}>", anchor.at.x.round(), anchor.at.y.round())
}

/// How one glyph carries the marks of an anchor of that name and label.
fn rule(glyph: &Glyph, carrier: Class, [name, label]: [&str; 2]) -> Option<String> {
    if carrier != Class::Ligature {
        let anchor = glyph.anchors.iter().find(|a| a.name == name)?;
        let (kind, name, at) = (carrier.word(), &glyph.name, at(anchor));
        return Some(format!(
            "        pos {kind} {name} {at} mark @mark.{label};\n"
        ));
    }
    let numbered = || {
        let anchors = glyph.anchors.iter();
        anchors.filter_map(|a| Some((a, part(&a.name)?)))
    };
    let own = numbered().filter(|(_, (n, _))| *n == name);
    let parts: BTreeMap<usize, &Anchor> = own.map(|(a, (_, i))| (i, a)).collect();
    let last = numbered().map(|(_, (_, i))| i).max()?;
    if parts.is_empty() {
        return None;
    }
    let one = |i: usize| {
        parts.get(&i).map_or("<anchor NULL>".to_owned(), |a| {
            format!("{} mark @mark.{label}", at(a))
        })
    };
    let all: Vec<String> = (1..=last).map(one).collect();
    Some(format!(
        "        pos ligature {} {};\n",
        glyph.name,
        all.join(" ligComponent ")
    ))
}
