//! One self-contained HTML page: opens without a network, can be read without a script, prints well.
//!
//! The first page stands before everything else and on one sheet of A4; sections are folded below it. A small script of our own adds
//! readings, zooms, switches and sorting, and a policy in the page forbids everything else.
//!
//! ```
//! use palpate_report::page::{Block, Page, Section};
//!
//! let page = Page::new("Report", "Squeeze-and-hold test").section(
//!     Section::new("Summary").block(Block::paragraph("The pad relaxed by 12 %.")),
//! );
//! assert!(page.to_html().starts_with("<!DOCTYPE html>"));
//! ```

mod block;
mod claims;
mod content;
mod html;
mod markup;
mod policy;

pub use block::{Block, Card, Finding};
pub use claims::{ClaimLine, ClaimRow};
pub use palpate::analysis::Severity;
pub use policy::{SCRIPT, STYLE};

/// Blocks as HTML for a page of another kind, which has [`STYLE`] and [`SCRIPT`]; all text in it is escaped.
#[must_use]
pub fn fragment(blocks: &[Block]) -> String {
    let mut counts = content::Counts::default();
    blocks.iter().map(|block| content::written(block, &mut counts)).collect()
}

/// A page with its sections and where its content comes from.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Page {
    /// Title.
    pub title: String,
    /// Line below the title; may be empty.
    pub subtitle: String,
    /// What stands on the first page, on one sheet of paper; may be empty.
    pub first: Vec<Block>,
    /// Sections in order: folded below a first page, open without one.
    pub sections: Vec<Section>,
    /// Names and values in the footer: software, version, input files, settings.
    pub provenance: Vec<(String, String)>,
}

/// A heading with what stands below it.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    /// Heading.
    pub heading: String,
    /// Content in order.
    pub blocks: Vec<Block>,
}

impl Page {
    /// A page without sections.
    #[must_use]
    pub fn new(title: impl Into<String>, subtitle: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            subtitle: subtitle.into(),
            ..Self::default()
        }
    }

    /// Adds content to the first page.
    #[must_use]
    pub fn first(mut self, blocks: impl IntoIterator<Item = Block>) -> Self {
        self.first.extend(blocks);
        self
    }

    /// Adds a section.
    #[must_use]
    pub fn section(mut self, section: Section) -> Self {
        self.sections.push(section);
        self
    }

    /// Adds a line to the footer.
    #[must_use]
    pub fn provenance(mut self, name: impl Into<String>, value: impl Into<String>) -> Self {
        self.provenance.push((name.into(), value.into()));
        self
    }

    /// The page as one HTML document.
    #[must_use]
    pub fn to_html(&self) -> String {
        html::document(self)
    }
}

impl Section {
    /// A section without content.
    #[must_use]
    pub fn new(heading: impl Into<String>) -> Self {
        Self {
            heading: heading.into(),
            blocks: Vec::new(),
        }
    }

    /// Adds content.
    #[must_use]
    pub fn block(mut self, block: Block) -> Self {
        self.blocks.push(block);
        self
    }

    /// Adds several pieces of content.
    #[must_use]
    pub fn blocks(mut self, blocks: impl IntoIterator<Item = Block>) -> Self {
        self.blocks.extend(blocks);
        self
    }
}
