//! An analysed record: an analysis in; tables, text, figures and a page out.
//!
//! | file | what |
//! |---|---|
//! | `figures.rs` | the record, its holds, strain rates and trend |
//! | `tables.rs` | its tables and text |
//! | `conditions.rs` | conditions of the test, R(t) at stated times |
//! | `method.rs` | the settings that a page tells |
//! | `cut.rs` | how a record was cut into phases |
//! | `page.rs` | the page, and all files |

mod conditions;
mod cut;
pub(super) mod figures;
mod method;
mod page;
mod tables;

pub use cut::cut_figure;
pub use page::analysis_bundle;
pub use tables::analysis_text;
