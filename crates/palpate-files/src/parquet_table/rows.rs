//! Rows in memory, column by column.

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Whole numbers, none missing.
    Count,
    /// Whole numbers, some of which may be missing.
    OptionalCount,
    /// Numbers, some of which may be missing.
    Number,
    /// Texts, some of which may be missing.
    Text,
}

/// A column by its name, which ends in its unit, and its kind.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Field {
    /// Name.
    pub name: String,
    /// What it holds.
    pub kind: Kind,
}

impl Field {
    /// A column.
    #[must_use]
    pub fn new(name: impl Into<String>, kind: Kind) -> Self {
        Self {
            name: name.into(),
            kind,
        }
    }
}

/// The values of one column.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Whole numbers.
    Count(Vec<i64>),
    /// Whole numbers, some of which may be missing.
    OptionalCount(Vec<Option<i64>>),
    /// Numbers.
    Number(Vec<Option<f64>>),
    /// Texts.
    Text(Vec<Option<String>>),
}

/// Some rows of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Rows {
    /// The columns in order, all of one length.
    pub columns: Vec<Values>,
}

impl Values {
    /// No values of this kind.
    #[must_use]
    pub fn empty(kind: Kind) -> Self {
        match kind {
            Kind::Count => Self::Count(Vec::new()),
            Kind::OptionalCount => Self::OptionalCount(Vec::new()),
            Kind::Number => Self::Number(Vec::new()),
            Kind::Text => Self::Text(Vec::new()),
        }
    }

    pub(super) fn len(&self) -> usize {
        match self {
            Self::Count(column) => column.len(),
            Self::OptionalCount(column) => column.len(),
            Self::Number(column) => column.len(),
            Self::Text(column) => column.len(),
        }
    }
}

impl Rows {
    /// How many rows there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.columns.first().map_or(0, Values::len)
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}
