//! The restricted likelihood of a noise, and where it is greatest among noises of one kind.
//!
//! | file | what |
//! |---|---|
//! | `kind.rs` | the likelihood, and models that stand for a kind |
//! | `lagged.rs` | autoregressions |
//! | `markov.rs` | white noise beside a random walk, or beside noise in time |
//! | `slow.rs` | noise with slow parts |
//! | `filter.rs` | Kalman's filter of noise with slow parts |
//! | `rows.rs` | sums over residuals and columns, as they are or filtered |

mod filter;
mod kind;
mod lagged;
mod markov;
mod rows;
mod slow;

pub(crate) use kind::{Kind, Likelihood};
pub(crate) use lagged::{Lagged, first_order};
pub(crate) use markov::{Beside, Markov, steps_since};
#[cfg(test)]
pub(crate) use markov::{in_time, tests::dense};
pub(crate) use rows::Rows;
pub(crate) use slow::Slow;
