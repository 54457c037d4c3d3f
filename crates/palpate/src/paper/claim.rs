//! Statements of the paper, and what became of them.

use serde::{Deserialize, Serialize};

/// What became of a statement.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Every comparison holds within its tolerance.
    Reproduced,
    /// At least one fails, with all of its interval.
    NotReproduced,
    /// There is nothing to compare with, or an interval includes the limit.
    CannotBeChecked,
}

impl Verdict {
    /// As people read it.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Reproduced => "reproduced",
            Self::NotReproduced => "not reproduced",
            Self::CannotBeChecked => "cannot be checked",
        }
    }
}

/// How our number must stand to the paper's.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Relation {
    /// They differ by at most the tolerance.
    Equal,
    /// Ours with all of its interval is at most the paper's plus the tolerance.
    AtMost,
    /// Ours with all of its interval is at least the paper's less the tolerance.
    AtLeast,
}

/// A number with the range that it stands for.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Value {
    /// The number.
    pub value: f64,
    /// Rounding, accuracy, or a 95 % interval; `None` of a limit or a count.
    pub interval: Option<(f64, f64)>,
}

impl From<f64> for Value {
    fn from(value: f64) -> Self {
        Self { value, interval: None }
    }
}

/// A value and half of the width of its range.
impl From<(f64, f64)> for Value {
    fn from((value, half): (f64, f64)) -> Self {
        Self {
            value,
            interval: Some((value - half, value + half)),
        }
    }
}

/// A number of ours against the paper's.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// What is compared.
    pub quantity: String,
    /// Unit of the numbers; empty for a dimensionless one.
    pub unit: String,
    /// The paper's number, or the limit that its statement sets.
    pub paper: Value,
    /// Ours.
    pub ours: Value,
    /// How they must stand to each other.
    pub relation: Relation,
    /// Tolerance, in the same unit.
    pub tolerance: f64,
    /// Why this tolerance.
    pub reason: String,
}

impl Comparison {
    pub(super) fn new(
        quantity: impl Into<String>,
        unit: &str,
        (paper, relation, ours): (impl Into<Value>, Relation, impl Into<Value>),
        (tolerance, reason): (f64, &str),
    ) -> Self {
        Self {
            quantity: quantity.into(),
            unit: unit.to_owned(),
            paper: paper.into(),
            ours: ours.into(),
            relation,
            tolerance,
            reason: reason.to_owned(),
        }
    }

    /// All of a number of things, where the statement leaves no exception.
    pub(super) fn all(quantity: impl Into<String>, found: usize, of: usize) -> Self {
        let (expected, found) = (of.max(1) as f64, found as f64);
        Self::new(quantity, "", (expected, Relation::Equal, found), (0.0, "the statement leaves no exception"))
    }

    /// Whether it holds; a number that is none does not.
    ///
    /// ```
    /// use palpate::paper::{Comparison, Relation};
    /// let strain = Comparison {
    ///     quantity: "equilibrium strain at 5 mm".to_owned(),
    ///     unit: String::new(),
    ///     paper: (-0.1661, 5e-5).into(),
    ///     ours: (-2.5 / 35.0).into(),
    ///     relation: Relation::Equal,
    ///     tolerance: 0.0135,
    ///     reason: "0.2 N of the load cell".to_owned(),
    /// };
    /// assert!(!strain.holds());
    /// ```
    #[must_use]
    pub fn holds(&self) -> bool {
        let off = self.ours.value - self.paper.value;
        let (low, high) = self.ours.interval.unwrap_or((self.ours.value, self.ours.value));
        match self.relation {
            Relation::Equal => off.abs() <= self.tolerance,
            Relation::AtMost => high - self.paper.value <= self.tolerance,
            Relation::AtLeast => self.paper.value - low <= self.tolerance,
        }
    }

    /// Whether it fails, whatever number of its interval is true; a number that is none fails.
    #[must_use]
    pub fn fails(&self) -> bool {
        let (low, high) = self.ours.interval.unwrap_or((self.ours.value, self.ours.value));
        let by_all = match self.relation {
            Relation::Equal => !self.holds(),
            Relation::AtMost => low - self.paper.value > self.tolerance,
            Relation::AtLeast => self.paper.value - high > self.tolerance,
        };
        by_all || self.ours.value.is_nan()
    }
}

/// Where in the paper a statement stands; the numbers are the paper's.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// An equation, such as `4`.
    Equation(&'static str),
    /// A figure, such as `6(a)`.
    Figure(&'static str),
    /// A table, such as `I`.
    Table(&'static str),
    /// A section, such as `III-C`; `Abstract` has no number.
    Section(&'static str),
}

impl std::fmt::Display for Place {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Equation(number) => write!(f, "Eq. ({number})"),
            Self::Figure(number) => write!(f, "Fig. {number}"),
            Self::Table(number) => write!(f, "Table {number}"),
            Self::Section("Abstract") => f.write_str("Abstract"),
            Self::Section(number) => write!(f, "Sec. {number}"),
        }
    }
}

/// What shows a claim: a figure, table or series of the study, by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Evidence {
    /// A figure.
    Figure(&'static str),
    /// A table.
    Table(&'static str),
    /// A series.
    Series(&'static str),
}

/// A statement of the paper with what became of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Claim {
    /// Where it stands.
    pub place: Place,
    /// What is stated.
    pub statement: String,
    /// The comparisons; none where nothing can be compared.
    pub comparisons: Vec<Comparison>,
    /// Why it cannot be checked, or what the comparison does not show; may be empty.
    pub remark: String,
    /// What shows it.
    pub evidence: Option<Evidence>,
}

impl Claim {
    /// The verdict that follows from the comparisons.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        match self.comparisons.as_slice() {
            [] => Verdict::CannotBeChecked,
            all if all.iter().any(Comparison::fails) => Verdict::NotReproduced,
            all if all.iter().all(Comparison::holds) => Verdict::Reproduced,
            _ => Verdict::CannotBeChecked,
        }
    }

    pub(super) fn new(place: Place, statement: impl Into<String>) -> Self {
        Self {
            place,
            statement: statement.into(),
            comparisons: Vec::new(),
            remark: String::new(),
            evidence: None,
        }
    }

    pub(super) fn compared(mut self, comparisons: impl IntoIterator<Item = Comparison>) -> Self {
        self.comparisons.extend(comparisons);
        self
    }

    pub(super) fn remark(mut self, remark: impl Into<String>) -> Self {
        self.remark = remark.into();
        self
    }

    pub(super) fn shown_by(mut self, evidence: Evidence) -> Self {
        self.evidence = Some(evidence);
        self
    }
}
