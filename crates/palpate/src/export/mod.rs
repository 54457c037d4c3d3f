//! A calibrated contact in the terms of other programs: a Prony series of its hold, and contacts without memory fitted to its loading.
//!
//! A [`Contact`](crate::simulate::Contact) and [`Conditions`] come in; a [`PronySeries`] for finite elements goes out, or one of the contact
//! models of rigid-body engines, each with its [`CardError`] against [`simulate`](crate::simulate::simulate()).
//!
//! | file | what |
//! |---|---|
//! | `conditions.rs` | the depth, the speeds and the time that a fit is for |
//! | `loading.rs` | forces in loading and hold by `simulate`, and the error of a model against them |
//! | `hold.rs` | the hold after a loading: peak, equilibrium, decay |
//! | `prony.rs` | the latency law's decay as a gamma mixture of exponentials, and its quadrature |
//! | `minimax.rs` | linear models of few non-negative coefficients with the least largest error |
//! | `spring.rs` | a linear spring and damper: PhysX, Isaac, Newton |
//! | `hunt_crossley.rs` | a point contact and a pressure field, each with Hunt–Crossley dissipation: Drake |
//! | `impedance.rs` | the impedance of a soft constraint: MuJoCo |
//! | `error.rs` | why there is none |

mod conditions;
mod error;
mod hold;
mod hunt_crossley;
mod impedance;
mod loading;
mod minimax;
mod prony;
mod spring;

pub use conditions::Conditions;
pub use error::ExportError;
pub use hold::HoldCurve;
pub use hunt_crossley::{Dissipative, HuntCrossley};
pub use impedance::SoftConstraint;
pub use loading::{CardError, HOLD_TIMES, Loading, LoadingSample};
pub use prony::{PronySeries, PronyTerm};
pub use spring::SpringDamper;
