//! A contact observed tick by tick, for controllers: start of a hold, equilibrium force, time to slip.
//!
//! Readings of force and displacement come in one tick after the other, an [`Observation`] goes out after each.
//!
//! | file | what | equations |
//! |---|---|---|
//! | `options.rs`, `observation.rs`, `error.rs` | options, results, errors | |
//! | `observer.rs`, `report.rs` | from tick to tick: phase, hold, fit; the resulting observation and warnings | |
//! | `signal/` | noise of a signal, the signal without most of it; that a jaw, or a force, stands still | |
//! | `hold/` | a hold of any length in 64 means, fitted, and the time when its force has fallen to that of slip | (4), (5) |
//! | `filter.rs` | a calibrated body run beside the record | (10), (11) |
//! | `normal.rs`, `kept.rs` | a value with its deviation; the state as bytes, to send an observer elsewhere | |
//!
//! In a position hold F(t) = F_e + A φ(t; λ, n), [`decay`](crate::latency::decay), equations (4) and (5). Its readings are averaged over
//! lengths that grow with the time since the start of the hold, at most 64 means. Each time the hold is 4 % longer F_e, A and λ are fitted
//! to the means, n being given; a profile of the likelihood over λ represents their uncertainty, for the ends of the interval of n too if n
//! has a standard error. The interval of the force at a time is the widest that any of them allows; the interval of the time to slip is
//! where that interval of the force meets the force of slip. Early in a hold it is wide, or open, as it should be.
//!
//! The jaw is at rest once it has stayed within its noise (five standard deviations, estimated by the observer, or 0.1 % of its travel) for
//! as long as it would have taken at its last speed to move four times as far: some five ticks at 1 kHz; four times as long if it slowed down
//! before, since a jaw that comes with a lag creeps in. If the force is constant and the jaw creeps, it is a force hold, and relaxation causes no
//! slip once only a controller can have held it: that shows once the jaw has gone so far that the force would have risen by 15 % of its largest value,
//! or after eight times the time of loading: the peak of a force whose jaw still comes is flat too. A force that falls by more than its noise, or
//! 1.5 % of its range, or one and a half times what it came back from before, is held no more: if the jaw stands, the displacement is held, since it
//! stands; as long as that is undecided, no time to slip is stated, and slip is warned of by the rate at which the force falls.
//!
//! With a calibrated [`Material`](crate::calibrate::Material) its model runs beside the record, so that the excess strain is known from
//! first touch on; the measured forces correct the uncertain parameters, the stiffness of this body and first touch. If the forces are not
//! those of that body, the hold is fitted without the material. Displacements are then measured from first touch. While the jaw stands the
//! model is at the mean of its last readings; the standard errors contain the noise of that mean, or of one reading in motion.
//!
//! What is held slips once its force is at or below that of slip, whatever the phase. A force is held once it was clearly above its noise and
//! above that of slip, or clearly above its noise with a jaw that closed on it.
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
//!     let observed = observer.feed(time, Some(displacement), force)?;
//!     if observed.slip == Slip::Soon {
//!         warned = warned.or(Some(time));
//!     }
//! }
//! assert!(warned.is_some_and(|time| time < 0.5 + 0.81));
//! let observed = observer.feed(60.0, Some(0.005), 1.2 + 1.7 * decay(6.0 * 59.5, 5.0))?;
//! assert_eq!(observed.phase, ContactPhase::Holding);
//! assert!((observed.held_since.unwrap() - 0.5).abs() < 2e-3);
//! assert!((observed.equilibrium_force.unwrap().value - 1.2).abs() < 1e-3);
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
mod report;
mod signal;

pub use error::ObserveError;
use kept::{Kept, kept};
use normal::Normal;
pub use observation::{ContactPhase, Held, Observation, Slip, SlipForecast};
pub use observer::Observer;
pub use options::ObserverOptions;
