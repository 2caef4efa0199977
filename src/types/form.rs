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

    /// The form that one of a name's suffixes is the tag of.
    pub(crate) fn of(suffixes: &[String]) -> Option<Self> {
        let is = |f: &Self| suffixes.iter().any(|s| s == f.tag());
        Self::ALL.into_iter().find(is)
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
