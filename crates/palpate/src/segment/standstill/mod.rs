//! Where a column stands still.
//!
//! A column of the record comes in and goes out as `Levels`: its standstills with the thresholds that found them.
//!
//! | file | what |
//! |---|---|
//! | `levels.rs` | the steps in order, and every threshold; a standstill with its value |
//! | `pieces.rs` | a column as a polygon of straight lines |
//! | `moves.rs` | the polygon as what the column does |
//! | `standstills.rs` | which parts of the polygon are standstills |
//! | `evidence.rs` | what counts as standing still, and what speaks for it |
//! | `smooth.rs` | a standstill has corners, a turning point has none |
//! | `ripples.rs` | standstills that are waves of a ripple on a ramp |
//! | `edges.rs` | where exactly a standstill begins and ends |

mod edges;
mod evidence;
mod levels;
mod moves;
mod pieces;
mod ripples;
mod smooth;
mod standstills;

pub(super) use levels::{Held, Level, Levels, levels};
