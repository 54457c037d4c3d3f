//! Laws compared on the holds of records: a compared record in; tables, text, figures and a page out.
//!
//! | file | what |
//! |---|---|
//! | `tables.rs` | tables, text and Markdown |
//! | `figures.rs` | forward errors, residuals and spectra |
//! | `page.rs` | the page, and all files |

pub(super) mod figures;
pub(super) mod page;
pub(super) mod tables;

pub use page::comparison_bundle;
pub use tables::{comparison_markdown, comparison_text};
