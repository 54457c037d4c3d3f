//! The paper's study, simulated and identified again: nothing in, all its files out.
//!
//! | file | what |
//! |---|---|
//! | `paper.rs` | both tests simulated, re-identified, and checked against what the paper reports |
//! | `law_figures.rs` | the law and its closed form (figures 1 and 2) |
//! | `page.rs` | figures, tables and the page |
//! | `bundle.rs` | all files, the summary among them |

mod bundle;
mod law_figures;
mod page;
mod paper;

pub use bundle::reproduction_bundle;
pub use paper::{Reproduction, reproduce};
