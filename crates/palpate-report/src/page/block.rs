//! What can stand in a section of a page.

use crate::figure::{Figure, FigureError};
use crate::table::Table;

/// One piece of content. All text is plain text and is escaped when it is written.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Block {
    /// A smaller heading.
    Subheading(String),
    /// A paragraph.
    Paragraph(String),
    /// Items of equal rank.
    List(Vec<String>),
    /// A table with its caption, numbered on the page.
    Table(Table),
    /// A drawn figure, numbered on the page.
    Figure(Picture),
    /// What was noticed in the data or in the analysis.
    Findings(Vec<Finding>),
    /// Names with their values.
    KeyValues(Vec<(String, String)>),
    /// Text to be copied as it stands.
    Code(String),
    /// Comparisons with a criterion.
    Checks(Vec<Check>),
}

/// A drawn figure.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Picture {
    /// An SVG element, as [`Figure::to_svg`] writes it; it goes into the page unchanged.
    pub svg: String,
    /// Caption.
    pub caption: String,
}

/// How much attention something deserves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Good to know.
    Info,
    /// May change how far a result can be trusted.
    Caution,
    /// A result should not be used as it stands.
    Warning,
}

/// Something noticed in the data or in the analysis.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finding {
    /// How much attention it deserves.
    pub severity: Severity,
    /// Short stable name.
    pub code: String,
    /// What was seen; each line stands on one of its own.
    pub seen: String,
    /// What it may mean.
    pub meaning: String,
    /// What helps.
    pub remedy: String,
}

/// How a comparison ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// The criterion is met.
    Pass,
    /// The criterion is not met.
    Fail,
    /// The comparison could not be made.
    NotRun,
}

/// A comparison with a criterion.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Check {
    /// What is compared.
    pub name: String,
    /// What is required.
    pub criterion: String,
    /// What was found.
    pub found: String,
    /// How it ended.
    pub outcome: Outcome,
}

impl Block {
    /// A paragraph.
    #[must_use]
    pub fn paragraph(text: impl Into<String>) -> Self {
        Self::Paragraph(text.into())
    }

    /// A figure with its own caption.
    ///
    /// # Errors
    ///
    /// When the figure cannot be drawn.
    pub fn figure(figure: &Figure) -> Result<Self, FigureError> {
        Ok(Self::Figure(Picture {
            svg: figure.to_svg()?,
            caption: figure.caption.clone(),
        }))
    }
}

impl Severity {
    /// The word that stands for it, which is also its name in the style sheet.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Info => "info",
            Self::Caution => "caution",
            Self::Warning => "warning",
        }
    }
}

impl Outcome {
    /// The word that stands for it.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::Fail => "fail",
            Self::NotRun => "not run",
        }
    }
}
