//! The paper claim by claim: its study, or the analysis of a record of one's own, in; files, page and text out.
//!
//! | file | what |
//! |---|---|
//! | `numbering.rs` | the numbers that figures and tables have in the paper, and the links to them |
//! | `claims.rs` | claims as rows of the page, as a table and as text |
//! | `law_figures.rs` | the law and its closed form: figures 1 and 2 |
//! | `hold_figures.rs` | what is drawn of holds, simulated or measured: figures 4, 6 and 8 |
//! | `study_figures.rs` | what is drawn of the study alone |
//! | `hold_tables.rs` | tables I and II |
//! | `study_tables.rs` | tables of the study alone |
//! | `page.rs` | page and files of the study |
//! | `record.rs` | page and files of a record of one's own |

mod claims;
mod hold_figures;
mod hold_tables;
mod law_figures;
mod numbering;
mod page;
mod record;
mod study_figures;
mod study_tables;

pub use claims::claims_text;
pub use page::{reproduction_bundle, reproduction_text};
pub use record::record_reproduction_bundle;
