//! The paper's study: its result in, all its files out.
//!
//! | file | what |
//! |---|---|
//! | `law_figures.rs` | the law and its closed form (figures 1 and 2) |
//! | `page.rs` | figures, tables, the page, and all files, the summary among them |

mod law_figures;
mod page;

pub use page::{reproduction_bundle, reproduction_text};
