//! Simulated contacts: trajectories, waves and sweeps in; series, tables and figures out.
//!
//! | file | what |
//! |---|---|
//! | `trajectory.rs` | a simulated series as CSV and figure |
//! | `hysteresis.rs` | force against displacement; work by step and by cycle |
//! | `wave.rs` | all layers over time (figure 7 of the paper) |
//! | `sweep.rs` | many runs as a curve, heat maps or points |

mod hysteresis;
mod sweep;
mod trajectory;
mod wave;

pub use hysteresis::{cycle_table, hysteresis_figure, step_work_table};
pub use sweep::{Swept, sweep_grid_figure, sweep_points_figure};
pub(super) use trajectory::write_series;
pub use trajectory::{trajectory_figure, write_trajectory};
pub use wave::wave_figure;
