//! One self-contained HTML page: opens without a network, needs no script, prints well.
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
mod html;

pub use block::{Block, Check, Finding};
pub use palpate::analysis::Severity;

/// A page with its sections and where its content comes from.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Page {
    /// Title.
    pub title: String,
    /// Line below the title; may be empty.
    pub subtitle: String,
    /// Sections in order.
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
