//! What can stand in a section of a page.

use palpate::analysis::Severity;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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
    Figure {
        /// An SVG element, as [`Figure::to_svg`] writes it; it goes into the page unchanged.
        svg: String,
        /// Caption.
        caption: String,
    },
    /// What was noticed in the data or in the analysis.
    Findings(Vec<Finding>),
    /// Names with their values.
    KeyValues(Vec<(String, String)>),
    /// Text to be copied as it stands.
    Code(String),
    /// Comparisons with a criterion.
    Checks(Vec<Check>),
}

/// A finding with its words.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "FindingDocument")]
pub struct Finding {
    /// Stable code.
    pub code: String,
    /// `info`, `caution` or `warning`.
    #[schemars(with = "String")]
    pub severity: Severity,
    /// What was observed.
    pub observation: String,
    /// What it may mean.
    pub meaning: String,
    /// What helps.
    pub remedy: String,
}

/// One thing that the paper reports, checked.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "CheckDocument")]
pub struct Check {
    /// What is checked.
    pub name: String,
    /// When it passes.
    pub criterion: String,
    /// What was found.
    pub found: String,
    /// Whether it passes.
    pub passed: bool,
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
        Ok(Self::Figure {
            svg: figure.to_svg()?,
            caption: figure.caption.clone(),
        })
    }
}
