//! A family's UFOs → a designspace: one axis, the weight.
//!
//! Where all glyphs of all masters have the same contours, with the same kinds of points, the axis is continuous, and
//! fontmake and fontc build a variable font. Drawings seldom agree so: then the axis is discrete (designspace 5),
//! each master is a style of its own, and fontmake builds them as one family.

use super::WriteError;
use super::ufo::files::load;
use crate::types::Files;
use norad::designspace::{Axis, DesignSpaceDocument, Dimension, Instance, Source};
use norad::fontinfo::StyleMapStyle;
use norad::{Font, Glyph, PointType};
use std::collections::BTreeSet;
use thiserror::Error;

/// Tag and name of the axis.
const WEIGHT: (&str, &str) = ("wght", "Weight");
/// The weight that a family is shown in where it has it.
const REGULAR: u32 = 400;

/// A UFO and where it lies.
#[derive(Debug, Clone)]
pub struct Master {
    /// Its path from the designspace's folder.
    pub path: String,
    /// Its files.
    pub files: Files,
}

/// A designspace, and why it may not be interpolated.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Designspace {
    /// XML.
    pub document: String,
    /// Each glyph that differs between masters, and in what; empty for a continuous axis.
    pub apart: Vec<String>,
}

/// Why UFOs are no family.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum FamilyError {
    /// One master spans no axis.
    #[error("a designspace needs two UFOs at least")]
    One,
    /// A UFO cannot be read.
    #[error("{path}: {source}")]
    Ufo {
        /// where it should be
        path: String,
        /// why
        source: WriteError,
    },
    /// A UFO has no family name or weight.
    #[error(
        "{0} says no family name, style name or weight class; build it with khatt, or set them in a font editor"
    )]
    Nameless(String),
    /// Two UFOs are of different families.
    #[error(
        "{first} is of the family “{one}”, {second} of “{other}”; give them one name, [font] family"
    )]
    Families {
        /// a UFO
        first: String,
        /// its family
        one: String,
        /// another UFO
        second: String,
        /// its family
        other: String,
    },
    /// Two UFOs stand at one place of the axis.
    #[error("{first} and {second} both have the weight {weight}; correct [font] weight of one")]
    Weights {
        /// a UFO
        first: String,
        /// another
        second: String,
        /// weight class of both
        weight: u32,
    },
    /// One UFO is upright, the other leans.
    #[error("{italic} is an italic and {upright} is none; give italics a designspace of their own")]
    Slopes {
        /// the upright one
        upright: String,
        /// the italic
        italic: String,
    },
    /// It cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}

/// A master as its UFO describes it.
struct Style<'a> {
    path: &'a str,
    font: Font,
    family: String,
    name: String,
    weight: u32,
    is_italic: bool,
}

/// The designspace of a family's masters, from the lightest to the boldest.
///
/// # Errors
/// They are fewer than two, are no UFOs, or do not belong together.
pub fn designspace(masters: &[Master]) -> Result<Designspace, FamilyError> {
    let styles: Result<Vec<Style<'_>>, FamilyError> = masters.iter().map(Style::of).collect();
    let mut styles = styles?;
    styles.sort_by_key(|s| s.weight);
    for pair in styles.windows(2) {
        pair[0].fits(&pair[1])?;
    }
    let [first, .., last] = styles.as_slice() else {
        return Err(FamilyError::One);
    };
    let apart = apart(&styles);
    let regular = styles.iter().find(|s| s.weight == REGULAR).unwrap_or(first);
    let place = |s: &Style<'_>| f64::from(s.weight);
    let axis = Axis {
        name: WEIGHT.1.to_owned(),
        tag: WEIGHT.0.to_owned(),
        default: place(regular),
        ..Axis::default()
    };
    let axis = if apart.is_empty() {
        Axis {
            minimum: Some(place(first)),
            maximum: Some(place(last)),
            ..axis
        }
    } else {
        Axis {
            values: Some(styles.iter().map(place).collect()),
            ..axis
        }
    };
    let document = DesignSpaceDocument {
        format: 5.0,
        axes: vec![axis],
        sources: styles.iter().map(Style::source).collect(),
        instances: styles.iter().map(Style::instance).collect(),
        ..DesignSpaceDocument::default()
    };
    let document = document.serialize_to_string();
    let document = document.map_err(|e| WriteError::table("designspace", e))?;
    Ok(Designspace { document, apart })
}

impl<'a> Style<'a> {
    fn of(master: &'a Master) -> Result<Self, FamilyError> {
        let path = master.path.as_str();
        let font = load(&master.files).map_err(|source| FamilyError::Ufo {
            path: path.to_owned(),
            source,
        })?;
        let info = &font.font_info;
        let says = (
            &info.family_name,
            &info.style_name,
            info.open_type_os2_weight_class,
        );
        let (Some(family), Some(name), Some(weight)) = says else {
            return Err(FamilyError::Nameless(path.to_owned()));
        };
        let linked = info.style_map_style_name.as_ref();
        let is_linked =
            linked.is_some_and(|s| matches!(s, StyleMapStyle::Italic | StyleMapStyle::BoldItalic));
        Ok(Self {
            is_italic: is_linked || info.italic_angle.is_some_and(|angle| angle != 0.0),
            path,
            family: family.clone(),
            name: name.clone(),
            weight,
            font,
        })
    }

    /// Whether this style and the next heavier one stand on one axis.
    fn fits(&self, next: &Self) -> Result<(), FamilyError> {
        let (first, second) = (self.path.to_owned(), next.path.to_owned());
        if self.family != next.family {
            return Err(FamilyError::Families {
                first,
                one: self.family.clone(),
                second,
                other: next.family.clone(),
            });
        }
        if self.is_italic != next.is_italic {
            let (upright, italic) = if next.is_italic {
                (first, second)
            } else {
                (second, first)
            };
            return Err(FamilyError::Slopes { upright, italic });
        }
        if self.weight == next.weight {
            return Err(FamilyError::Weights {
                first,
                second,
                weight: self.weight,
            });
        }
        Ok(())
    }

    fn location(&self) -> Vec<Dimension> {
        vec![Dimension {
            name: WEIGHT.1.to_owned(),
            xvalue: Some(f64::from(self.weight)),
            ..Dimension::default()
        }]
    }

    fn source(&self) -> Source {
        Source {
            filename: self.path.to_owned(),
            familyname: Some(self.family.clone()),
            stylename: Some(self.name.clone()),
            name: Some(format!("{} {}", self.family, self.name)),
            location: self.location(),
            ..Source::default()
        }
    }

    fn instance(&self) -> Instance {
        Instance {
            familyname: Some(self.family.clone()),
            stylename: Some(self.name.clone()),
            name: Some(format!("{} {}", self.family, self.name)),
            location: self.location(),
            ..Instance::default()
        }
    }
}

/// The glyphs that are not built alike in all styles.
fn apart(styles: &[Style<'_>]) -> Vec<String> {
    let names = styles.iter().flat_map(|s| s.font.default_layer().iter());
    let names: BTreeSet<&str> = names.map(|g| g.name().as_str()).collect();
    let differs = |name: &str| {
        let mut all = styles.iter().map(|s| (s, s.font.get_glyph(name)));
        let (first, glyph) = all.next()?;
        let found = all.find_map(|(other, twin)| {
            let what = match (glyph, twin) {
                (Some(a), Some(b)) => difference(a, b)?,
                (Some(_), None) => ("there".to_owned(), "missing".to_owned()),
                (None, Some(_)) => ("missing".to_owned(), "there".to_owned()),
                (None, None) => return None,
            };
            Some((what, other))
        });
        let ((one, two), other) = found?;
        Some(format!(
            "{name}: {one} in {}, {two} in {}",
            first.name, other.name
        ))
    };
    names.into_iter().filter_map(differs).collect()
}

/// The first thing in which two glyphs are not built alike.
fn difference(a: &Glyph, b: &Glyph) -> Option<(String, String)> {
    let both = |of: &dyn Fn(&Glyph) -> String| {
        let (one, other) = (of(a), of(b));
        (one != other).then_some((one, other))
    };
    let parts = |g: &Glyph| {
        g.components
            .iter()
            .map(|c| c.base.to_string())
            .collect::<Vec<_>>()
    };
    let components = |g: &Glyph| match parts(g) {
        parts if parts.is_empty() => "no components".to_owned(),
        parts => format!("components {}", parts.join(" ")),
    };
    let contours = |g: &Glyph| format!("{} contours", g.contours.len());
    let points = |i: usize| {
        move |g: &Glyph| {
            let count = g.contours.get(i).map_or(0, |c| c.points.len());
            format!("{count} points in contour {}", i + 1)
        }
    };
    let kinds = |i: usize| {
        move |g: &Glyph| {
            let points = g.contours.get(i).into_iter().flat_map(|c| &c.points);
            let kinds: String = points.map(|p| letter(&p.typ)).collect();
            format!("{kinds} in contour {}", i + 1)
        }
    };
    let each = || 0..a.contours.len();
    both(&components)
        .or_else(|| both(&contours))
        .or_else(|| each().find_map(|i| both(&points(i))))
        .or_else(|| each().find_map(|i| both(&kinds(i))))
}

/// The letter that stands for a kind of point: M, L, C, Q, and · for a handle.
const fn letter(kind: &PointType) -> char {
    match kind {
        PointType::Move => 'M',
        PointType::Line => 'L',
        PointType::Curve => 'C',
        PointType::QCurve => 'Q',
        PointType::OffCurve => '·',
    }
}
