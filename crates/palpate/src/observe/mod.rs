//! A contact watched tick by tick, for controllers: when a hold begins, where it tends, when it slips.
//!
//! Readings of force and displacement come in one tick after the other, an [`Observation`] goes out after each.
//!
//! | file | what | equations |
//! |---|---|---|
//! | `options.rs`, `observation.rs`, `error.rs` | what goes in, what comes out, what is refused | |
//! | `observer.rs`, `saying.rs` | from tick to tick: phase, hold, fit; and what is said of it, warnings too | |
//! | `signal/` | noise of a signal, the signal without most of it; that a jaw, or a force, stands still | |
//! | `hold/` | a hold of any length in 64 means, fitted, and the time when its force has fallen to that of slip | (4), (5) |
//! | `filter.rs` | a calibrated body run beside the record | (10), (11) |
//! | `normal.rs`, `kept.rs` | a value with its deviation; the state as bytes, to send an observer elsewhere | |
//!
//! In a hold of the displacement F(t) = F_e + A φ(t; λ, n), [`decay`](crate::latency::decay), equations (4) and (5). Its readings become
//! means over lengths that grow with the time since the hold began, at most 64 of them. Each time the hold is 4 % longer F_e, A and λ are
//! fitted to the means, n being given, and what they leave open is kept as a profile of the likelihood over λ, for the ends of the interval of
//! n too where n is known to a deviation only. The interval of the force at a time is the widest that any of them allows; the interval of the time to slip is where that interval of the force meets the force of
//! slip. Early in a hold it is wide, or open, as it should be.
//!
//! A jaw stands once it has stayed within its noise (five standard deviations, found out by the observer, or 0.1 % of its travel) for as long
//! as it would have taken at its last speed to go four times as far: some five ticks at 1 kHz. Where the force stands and the jaw creeps it
//! is the force that is held, and nothing slips by relaxation.
//!
//! With a calibrated [`Material`](crate::calibrate::Material) its model runs beside the record, so that the excess strain is known from first
//! touch on; what the calibration leaves open, the stiffness of this body and first touch are corrected by the forces. Where these are not
//! those of that body, the hold is fitted as it is. Displacements then count from first touch.
//!
//! ```
//! use palpate::latency::decay;
//! use palpate::observe::{ContactPhase, Observer, ObserverOptions, Slip};
//!
//! let mut observer = Observer::new(ObserverOptions { slip_force: Some(2.0), ..ObserverOptions::default() })?;
//! let mut warned = None;
//! for tick in 0..60_000 {
//!     // 5 mm within 0.5 s, then a hold whose force tends to 1.2 N; it is 2 N after 0.81 s
//!     let time = f64::from(tick) * 1e-3;
//!     let (displacement, force) =
//!         if time < 0.5 { (0.01 * time, 5.8 * time) } else { (0.005, 1.2 + 1.7 * decay(6.0 * (time - 0.5), 5.0)) };
//!     let seen = observer.feed(time, Some(displacement), force)?;
//!     if seen.slip == Slip::Soon {
//!         warned = warned.or(Some(time));
//!     }
//! }
//! assert!(warned.is_some_and(|time| time < 0.5 + 0.81));
//! let seen = observer.feed(60.0, Some(0.005), 1.2 + 1.7 * decay(6.0 * 59.5, 5.0))?;
//! assert_eq!(seen.phase, ContactPhase::PositionHold);
//! assert!((seen.held_since.unwrap() - 0.5).abs() < 2e-3);
//! assert!((seen.equilibrium_force.unwrap().value - 1.2).abs() < 1e-3);
//! # Ok::<(), palpate::observe::ObserveError>(())
//! ```

mod error;
mod filter;
mod hold;
mod kept;
mod normal;
mod observation;
mod observer;
mod options;
mod saying;
mod signal;

pub use error::ObserveError;
use kept::{Kept, kept};
use normal::Normal;
pub use observation::{ContactPhase, Held, Observation, Slip, SlipForecast};
pub use observer::Observer;
pub use options::ObserverOptions;
