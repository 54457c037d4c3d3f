//! What can stand in a section of a page.

use palpate::analysis::Severity;
use palpate::watch::Unwatched;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::claims::ClaimRow;
use crate::figure::{Figure, FigureError, View};
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
        /// What is drawn; it goes into the page unchanged.
        view: View,
        /// Caption.
        caption: String,
    },
    /// The sentence that a page begins with.
    Lede(String),
    /// Formulas, each below what it is of.
    Formulas(Vec<(String, String)>),
    /// Findings in a line each.
    Notes(Vec<(Severity, String)>),
    /// Content that is folded until a reader opens it, and open on paper.
    Folded {
        /// What is folded.
        title: String,
        /// Content in order.
        blocks: Vec<Block>,
    },
    /// Records with links to their reports.
    Cards(Vec<Card>),
    /// What was noticed in the data or in the analysis.
    Findings(Vec<Finding>),
    /// Names with their values.
    KeyValues(Vec<(String, String)>),
    /// Text to be copied as it stands.
    Code(String),
    /// Statements with what became of them.
    Claims(Vec<ClaimRow>),
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

/// A record in an index.
#[derive(Debug, Clone, PartialEq)]
pub struct Card {
    /// Its title.
    pub title: String,
    /// Where its report lies, with forward slashes; a name of a file may contain any character.
    pub path: Vec<String>,
    /// A small figure.
    pub picture: Option<View>,
    /// Sentences about it.
    pub lines: Vec<String>,
    /// Its most severe finding and how many there are.
    pub findings: Option<(Severity, usize)>,
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
            view: figure.drawing(&mut Unwatched)?.view,
            caption: figure.caption.clone(),
        })
    }
}
