//! From the noise of a fit to the covariance of its parameters, their errors and intervals.
//!
//! | file | what |
//! |---|---|
//! | `assessed.rs` | the noise of a fit, and estimates with their errors |
//! | `sandwich.rs` | covariances of parameters from that of the noise |
//! | `columns.rs` | products of the columns of a fit with the correlations between them |
//! | `uneven.rs` | noise whose size changes, by the squares of the residuals |
//! | `blocks.rs` | how noise sums up over blocks of neighbours, where no model describes it |
//! | `rounding.rs` | rounding that no noise dithers |
//! | `uncertainty.rs` | covariances under all models that are likely |
//! | `mixture.rs` | intervals of many numbers where several models are likely |

mod assessed;
mod blocks;
mod columns;
mod mixture;
mod rounding;
mod sandwich;
mod uncertainty;
mod uneven;

pub(crate) use assessed::{Assessed, Trust};
#[cfg(test)]
pub(crate) use columns::Columns;
pub use sandwich::ModelCovariance;
pub use uncertainty::Uncertainty;
pub(crate) use uncertainty::{Scale, variance_of};
