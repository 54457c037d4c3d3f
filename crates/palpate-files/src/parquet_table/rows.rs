//! Rows in memory, column by column.

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Whole numbers, none missing.
    Count,
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
    /// Numbers.
    Number(Vec<Option<f64>>),
    /// Texts.
    Text(Vec<Option<String>>),
}

impl Values {
    fn empty(kind: Kind) -> Self {
        match kind {
            Kind::Count => Self::Count(Vec::new()),
            Kind::Number => Self::Number(Vec::new()),
            Kind::Text => Self::Text(Vec::new()),
        }
    }

    fn len(&self) -> usize {
        match self {
            Self::Count(values) => values.len(),
            Self::Number(values) => values.len(),
            Self::Text(values) => values.len(),
        }
    }

    pub(super) fn kind(&self) -> Kind {
        match self {
            Self::Count(_) => Kind::Count,
            Self::Number(_) => Kind::Number,
            Self::Text(_) => Kind::Text,
        }
    }

    /// Moves the values of another column of the same kind to the end of this one; another kind is left out.
    fn append(&mut self, other: Self) {
        match (self, other) {
            (Self::Count(values), Self::Count(more)) => values.extend(more),
            (Self::Number(values), Self::Number(more)) => values.extend(more),
            (Self::Text(values), Self::Text(more)) => values.extend(more),
            _ => {}
        }
    }
}

/// Some rows of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Rows {
    /// The columns in order, all of one length.
    pub columns: Vec<Values>,
}

impl Rows {
    /// No rows of these columns.
    #[must_use]
    pub fn empty(fields: &[Field]) -> Self {
        Self {
            columns: fields.iter().map(|field| Values::empty(field.kind)).collect(),
        }
    }

    /// How many rows there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.columns.first().map_or(0, Values::len)
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether these are rows of a table with these columns.
    pub(super) fn fit(&self, fields: &[Field]) -> bool {
        let kinds = self.columns.iter().map(Values::kind).eq(fields.iter().map(|field| field.kind));
        kinds && self.columns.iter().all(|column| column.len() == self.len())
    }

    pub(super) fn append(&mut self, other: Self) {
        for (column, more) in self.columns.iter_mut().zip(other.columns) {
            column.append(more);
        }
    }
}
