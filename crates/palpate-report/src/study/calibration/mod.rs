//! A whole record calibrated, and what the material predicts: tables, text and figures.
//!
//! | file | what |
//! |---|---|
//! | `material.rs` | the laws on the record, the parameters of the material: tables, text, figure, page |
//! | `batch.rs` | several records calibrated together: tables, text, figure, page |
//! | `prediction.rs` | what the body does, with intervals: series, table, figure |

mod batch;
mod material;
mod prediction;

pub use batch::{batch_figure, batch_page, batch_text};
pub use material::{calibration_figure, calibration_page, calibration_text, material_table};
pub use prediction::{prediction_figure, prediction_table, write_prediction};
