//! Where things stand on the page: no mark is made here.
//!
//! `draw` hands in a figure, and takes frames, positions and free room out.
//!
//! | file | what |
//! |---|---|
//! | `frame.rs` | the place of every panel and its axes |
//! | `scale.rs` | from values to positions; limits of axes, cells and colours |
//! | `ticks.rs` | the numbers at an axis |
//! | `text.rs` | how wide a text is |
//! | `occupancy.rs` | room that data take, so that legends cover none |
//! | `rect.rs` | positions and rectangles |

mod frame;
mod occupancy;
mod rect;
mod scale;
mod text;
mod ticks;

pub(super) use frame::{BAR, BAR_GAP, CAPTION, Frame, INSET, LEGEND_ROW, TICK, TICK_LENGTH, arrange};
pub(super) use occupancy::Occupancy;
pub(super) use rect::{Position, Rect};
pub(super) use scale::{Transform, colour_limits, edges};
pub(super) use text::{markup, width};
pub(super) use ticks::Ticks;
