//! Will it hold: from a calibrated body to the squeeze that a gripper should make.
//!
//! | file | what |
//! |---|---|
//! | `grasp.rs` | the load, and the normal force that it needs: Coulomb friction with the soft finger's limit surface |
//! | `limits.rs` | what the gripper can do |
//! | `plan.rs` | ways to close it |
//! | `time_to_slip.rs` | how long a hold lasts |
//! | `margin.rs` | how far a predicted force is from the one that is needed |
//! | `position_hold.rs` | how long a squeeze holds, with an interval |
//! | `least.rs` | the least squeeze, peak force or work that holds long enough |
//! | `back_off.rs` | squeeze over, go back, and the force stays where it is |
//! | `force_hold.rs` | the same grasp with the force held |
//! | `regrip.rs` | when to squeeze again |
//! | `answer.rs` | all of it for one question |
//! | `error.rs` | why there is none |
//!
//! Two jaws press the body from opposite sides with the same force F; friction at both contacts carries the load. With the displacement
//! held F falls to its equilibrium by the calibrated law; with the force held the body creeps.

mod answer;
mod back_off;
mod error;
mod force_hold;
mod grasp;
mod least;
mod limits;
mod margin;
mod plan;
mod position_hold;
mod regrip;
mod time_to_slip;

pub use answer::{Answer, Control, Question, WithPrediction};
pub use back_off::{BackOff, Sensitivity};
pub use error::GripError;
use error::{above_zero, at_least, check, check_confidence};
pub use force_hold::ForceHold;
pub use grasp::{Grasp, STANDARD_GRAVITY};
pub use least::Objective;
use least::{bisected, check_duration};
pub use limits::Limits;
pub use plan::{Plan, PlanKind};
pub use position_hold::{Grip, PositionHold};
use position_hold::{beyond, peak};
pub use regrip::{Band, Move, Regrip, Schedule};
use time_to_slip::ALWAYS;
pub use time_to_slip::TimeToSlip;
