//! A record cut into loading, hold and unloading.
//!
//! A record comes in and goes out as a `Segmentation`; where a column stands still is found by `standstill`.
//!
//! | file | what |
//! |---|---|
//! | `behind_spring.rs` | a machine that stands still behind a spring |
//! | `delayed.rs` | a force that an amplifier or a filter delays |
//! | `find.rs` | the phases of a record: given, labelled or sought |
//! | `given.rs` | phases that are sought, and holds whose limits someone gives |
//! | `labelled.rs` | phases that a file labels |
//! | `from_both.rs` | phases where displacement and force were recorded |
//! | `from_force.rs` | phases where only the force was |
//! | `nothing_held.rs` | standstills in which no body is held in place |
//! | `ramps.rs` | what lies between the holds: loading and unloading |
//! | `rupture.rs` | where the body broke |
//! | `ripple.rs` | the ripple of a controller that hunts |
//! | `turning.rs` | turning points |
//! | `whole.rs` | a record that is one hold throughout |
//! | `fit_start.rs` | from where in a hold the laws are fitted |

mod behind_spring;
mod delayed;
mod find;
mod fit_start;
mod from_both;
mod from_force;
mod given;
mod labelled;
mod nothing_held;
mod ramps;
mod ripple;
mod rupture;
mod turning;
mod whole;

pub(crate) use delayed::{ForceDelay, force_delay};
pub use find::{find_phases, phases_watched, phases_with};
pub(crate) use from_both::stands_in;
pub use given::GivenHold;
pub(crate) use ramps::ramps_alone;
