//! From results to files: which figures, tables and sections a study has.
//!
//! A room a study: results come in from the jobs; text, figures and a [`Bundle`] of files go out. A room uses those above it.
//!
//! | room | study |
//! |---|---|
//! | `bundle.rs`, `grid.rs`, `findings.rs` | the files of a study, in memory until all exist; figures of many panels, panels of many figures; what was found, gathered over the holds |
//! | `simulate/` | simulated contacts, waves, sweeps |
//! | `answer.rs` | which law to use, before everything else |
//! | `forecast.rs`, `first_page.rs` | a hold with its forecast; the first page of a record: the law, one figure, what it means |
//! | `budget.rs` | uncertainty budgets |
//! | `calibration/` | a whole record calibrated, and what the material predicts |
//! | `grip/` | a planned grip |
//! | `comparison/` | laws compared on the holds of records |
//! | `map.rs` | a quantity over the positions of many curves |
//! | `record/` | an analysed record |
//! | `index.rs` | the index of the reports of several specimens |
//! | `reproduction/` | the paper's study |

mod answer;
mod budget;
mod bundle;
mod calibration;
mod comparison;
mod findings;
mod first_page;
mod forecast;
mod grid;
mod grip;
mod index;
mod map;
mod record;
mod reproduction;
mod simulate;

pub use bundle::{Bundle, FileOptions, StudyError};
pub use calibration::{
    batch_figure, batch_page, batch_text, calibration_figure, calibration_page, calibration_text, material_table,
    prediction_figure, prediction_table, write_prediction,
};
pub use comparison::{comparison_bundle, comparison_markdown, comparison_text};
pub use grip::{
    grip_bundle, grip_figure, grip_table, grip_text, neighbour_table, schedule_table, sensitivity_table, tried_figure,
};
pub use index::SpecimenIndex;
pub use map::{MapPoint, map_figure};
pub use record::{analysis_bundle, analysis_text, cut_figure};
pub use reproduction::{claims_text, record_reproduction_bundle, reproduction_bundle, reproduction_text};
pub use simulate::{
    Swept, cycle_table, hysteresis_figure, step_work_table, sweep_grid_figure, sweep_points_figure, trajectory_figure,
    wave_figure, write_trajectory,
};
