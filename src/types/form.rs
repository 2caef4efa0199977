//! The forms of letters that join.

/// The shape that a letter takes beside its neighbours.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Form {
    /// Joined on neither side.
    #[default]
    Isol,
    /// Joined to the letter before it.
    Fina,
    /// Joined to the letter after it.
    Init,
    /// Joined on both sides.
    Medi,
}

impl Form {
    /// All four, in the order in which one of them stands in for a missing isolated form.
    pub const ALL: [Self; 4] = [Self::Isol, Self::Fina, Self::Init, Self::Medi];

    /// The form that one of a name's suffixes says.
    pub(crate) fn of(suffixes: &[String]) -> Option<Self> {
        suffixes.iter().find_map(|s| Self::said(s))
    }

    /// The form that a suffix says: its tag, or its name written out.
    pub(crate) fn said(suffix: &str) -> Option<Self> {
        Some(match suffix {
            "isol" | "isolated" => Self::Isol,
            "fina" | "final" => Self::Fina,
            "init" | "initial" => Self::Init,
            "medi" | "medial" => Self::Medi,
            _ => return None,
        })
    }

    /// The OpenType feature and the suffix of that form.
    #[must_use]
    pub const fn tag(self) -> &'static str {
        match self {
            Self::Isol => "isol",
            Self::Fina => "fina",
            Self::Init => "init",
            Self::Medi => "medi",
        }
    }

    /// Whether this form joins the letter before it, to its right in Arabic.
    #[must_use]
    pub const fn joins_before(self) -> bool {
        matches!(self, Self::Fina | Self::Medi)
    }

    /// Whether this form joins the letter after it, to its left in Arabic.
    #[must_use]
    pub const fn joins_after(self) -> bool {
        matches!(self, Self::Init | Self::Medi)
    }
}
