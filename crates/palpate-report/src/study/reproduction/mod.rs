//! The paper's study: its result in, all its files out.
//!
//! | file | what |
//! |---|---|
//! | `law_figures.rs` | the law and its closed form (figures 1 and 2) |
//! | `page.rs` | figures, tables and the page |
//! | `bundle.rs` | all files, the summary among them |

mod bundle;
mod law_figures;
mod page;

pub use bundle::{reproduction_bundle, reproduction_text};
