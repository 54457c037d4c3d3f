//! From results to files: which figures, tables and sections a study has.
//!
//! | file | what |
//! |---|---|
//! | `bundle.rs` | the files of a study, in memory until all of them exist |
//! | `record_figures.rs` | figures of an analysed record |
//! | `record_tables.rs` | its tables |
//! | `record_page.rs` | its page |
//! | `comparison_tables.rs` | laws compared: tables, text and Markdown |
//! | `comparison_figures.rs` | forward errors, residuals and spectra |
//! | `comparison_page.rs` | their page |
//! | `calibration.rs` | a whole record calibrated: tables, text and figure |
//! | `prediction.rs` | what a calibrated body does: series, table and figure |
//! | `grip.rs` | a planned grip: tables, sentences, text |
//! | `grip_figure.rs` | its force, margin and displacement over time |
//! | `grip_page.rs` | its page |
//! | `findings.rs` | what was found, gathered over the holds |
//! | `method.rs` | the settings that a page tells |
//! | `law_figures.rs` | the law and its closed form (figures 1 and 2 of the paper) |
//! | `wave_figure.rs` | all layers over time (figure 7) |
//! | `sweep_figure.rs` | many runs as a curve, heat maps or points |
//! | `trajectory.rs` | a simulated series as CSV and figure |
//! | `hysteresis.rs` | force against displacement; work by step and by cycle |
//! | `reproduction.rs` | the paper's study: simulation, re-identification, checks |
//! | `reproduction_page.rs` | its page |

mod bundle;
mod calibration;
mod comparison_figures;
mod comparison_page;
mod comparison_tables;
mod cut_figure;
mod findings;
mod grip;
mod grip_figure;
mod grip_page;
mod hysteresis;
mod law_figures;
mod method;
mod prediction;
mod record_figures;
mod record_page;
mod record_tables;
mod reproduction;
mod reproduction_page;
mod sweep_figure;
mod trajectory;
mod wave_figure;

pub use bundle::{Bundle, Pictures, StudyError};
pub use calibration::{calibration_figure, calibration_page, calibration_remarks, calibration_text, material_table};
pub use comparison_page::comparison_bundle;
pub use comparison_tables::{comparison_markdown, comparison_text};
pub use cut_figure::cut_figure;
pub use grip::{
    grip_question, grip_remarks, grip_table, grip_text, grip_verdict, neighbour_table, schedule_table,
    sensitivity_table,
};
pub use grip_figure::grip_figure;
pub use grip_page::grip_bundle;
pub use hysteresis::{cycle_table, hysteresis_figure, step_work_table};
pub use prediction::{prediction_figure, prediction_table, write_prediction};
pub use record_page::analysis_bundle;
pub use record_tables::analysis_text;
pub use reproduction::{Reproduction, reproduce, reproduction_bundle};
pub use sweep_figure::{MOST_PANELS, SweptAxis, SweptResult, sweep_grid_figure, sweep_points_figure};
pub use trajectory::{trajectory_figure, write_trajectory};
pub use wave_figure::wave_figure;
