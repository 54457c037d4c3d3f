//! A planned grip: a gripped body in; tables, text, a figure and a page out.
//!
//! | file | what |
//! |---|---|
//! | `tables.rs` | tables and text |
//! | `figure.rs` | force, margin and displacement over time |
//! | `page.rs` | the page, and all files |

mod figure;
mod page;
mod tables;

pub use figure::{grip_figure, tried_figure};
pub use page::grip_bundle;
pub use tables::{grip_table, grip_text, neighbour_table, schedule_table, sensitivity_table};
