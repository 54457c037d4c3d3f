//! Viscoelastic contact: laws from squeeze-and-hold tests, and forces from laws.
//!
//! A soft body is pressed, held and released. In the hold its strain tends to equilibrium at a rate set by its distance
//! from it: strain rate = −v (ε − ε_e)ⁿ, the *nonlinear latency law*. This crate identifies the law in a measured record
//! with its uncertainty, and simulates the contact. It computes only: no files, no terminal, no network.
//!
//! The modules are in the order of the data flow.
//!
//! | module | what |
//! |---|---|
//! | [`prelude`] | the types and functions of the main jobs, with an example of each |
//! | [`units`] | quantities with units, converted to SI |
//! | [`watch`] | progress of long work, and its cancellation |
//! | [`record`] | a measured record, checked |
//! | [`segment`] | its phases: loading, hold, unloading; first touch; Type I and II |
//! | [`strain`] | strain and strain rate, equations (6) to (9) |
//! | [`latency`] | the law and its closed form, equations (1) to (5) and (10) |
//! | [`laws`] | every law of relaxation and creep |
//! | [`special`] | Mittag-Leffler function, exponential integral and related functions |
//! | [`fit`] | laws fitted to holds, with standard errors and the reason of termination |
//! | [`forecast`] | the law to use, by held-out errors |
//! | [`contact`] | the body, its layers and its contact, equations (7) and (11) |
//! | [`simulate`] | the force under a motion of the jaw |
//! | [`batch`] | thousands of contacts at once |
//! | [`statistics`] | means over specimens, medians, coverage factors |
//! | [`budget`] | uncertainty budgets (JCGM 100 and 101) |
//! | [`instrument`] | the uncertainty of the instrument and of the body |
//! | [`analysis`] | the complete analysis of one record, with findings |
//! | [`observe`] | a contact observed tick by tick: holds, their equilibrium, time to slip |
//! | [`calibrate`](mod@calibrate) | a body calibrated on a whole record, and what it does under any drive |
//! | [`grip`] | how a grip holds: time to slip, squeezes, moves |
//! | [`export`] | a calibrated contact in the terms of other simulators: Prony series, contacts without memory |
//! | [`paper`] | the paper claim by claim, each with a verdict |
//!
//! | feature | what |
//! |---|---|
//! | `std` (on) | everything; without it the scalar law, bodies and [one step at a time](simulate::ContactState#without-std) |
//! | `alloc` | tables of bodies and their serde where there is no std; `std` has it |
//! | `rayon` (on) | [`batch`] on all cores |
//!
//! ```
//! use palpate::contact::{Layers, Shape, Sides, Specimen};
//! use palpate::fit::{ExponentChoice, FitOptions, fit_hold};
//! use palpate::latency::LatencyLaw;
//! use palpate::simulate::{ContactModel, ProtocolStep, Sampling, Separation, protocol, simulate};
//!
//! // Squeeze the paper's ball by 5 mm at 500 mm/min, hold for 10 s ...
//! let model = ContactModel {
//!     specimen: Specimen::new(Shape::Ball { radius: 0.035 }, 28e3, Sides::Two)?,
//!     law: LatencyLaw::new(5.0, 2e4)?,
//!     layers: Layers::new(8.0)?,
//!     separation: Separation::Unilateral,
//! };
//! let motion = protocol(&[ProtocolStep { to: 5e-3, rate: 0.5 / 60.0, hold: 10.0 }])?;
//! let series = simulate(&motion, &model, &Sampling::Rate(100.0))?;
//!
//! // ... and find the law again in the strain of the hold.
//! let hold = series.time.partition_point(|t| *t < 0.6);
//! let fit = fit_hold(&series.time[hold..], &series.strain[hold..], ExponentChoice::Free, &FitOptions::default())?;
//! assert!((fit.exponent().value - 5.0).abs() < 1e-6);
//! assert!((fit.rate_coefficient().value / 2e4 - 1.0).abs() < 1e-5);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![cfg_attr(not(feature = "std"), no_std)]

#[cfg(feature = "alloc")]
extern crate alloc;

/// Serialises a type of which one that is read has to be consistent; the type derives both traits for `remote = "Self"`.
#[cfg(feature = "std")]
macro_rules! checked_when_read {
    ($name:ty, $expected:literal, $is_consistent:expr) => {
        impl serde::Serialize for $name {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                Self::serialize(self, serializer)
            }
        }

        impl<'de> serde::Deserialize<'de> for $name {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                let read = Self::deserialize(deserializer)?;
                let is_consistent: fn(&$name) -> bool = $is_consistent;
                let expected = concat!("expected ", $expected, ", found others");
                if is_consistent(&read) { Ok(read) } else { Err(serde::de::Error::custom(expected)) }
            }
        }
    };
}

#[cfg(feature = "std")]
pub mod analysis;
#[cfg(feature = "std")]
pub mod batch;
#[cfg(feature = "std")]
pub mod budget;
#[cfg(feature = "std")]
pub mod calibrate;
pub mod contact;
#[cfg(feature = "std")]
pub mod export;
#[cfg(feature = "std")]
pub mod fit;
#[cfg(feature = "std")]
pub mod forecast;
#[cfg(feature = "std")]
pub mod grip;
#[cfg(feature = "std")]
pub mod instrument;
pub mod latency;
#[cfg(feature = "std")]
pub mod laws;
#[cfg(feature = "std")]
#[doc(hidden)]
pub mod number;
#[cfg(feature = "std")]
pub mod observe;
#[cfg(feature = "std")]
mod ode;
#[cfg(feature = "std")]
mod optimise;
#[cfg(feature = "std")]
pub mod paper;
#[cfg(feature = "std")]
mod parallel;
#[cfg(feature = "std")]
pub mod prelude;
#[cfg(feature = "std")]
#[doc(hidden)]
pub mod random;
#[cfg(feature = "std")]
pub mod record;
#[cfg(feature = "std")]
pub mod segment;
pub mod simulate;
#[cfg(feature = "std")]
pub mod special;
#[cfg(feature = "std")]
pub mod statistics;
#[cfg(feature = "std")]
pub mod strain;
#[cfg(feature = "std")]
#[doc(hidden)]
pub mod test_problems;
#[cfg(feature = "std")]
pub mod units;
#[cfg(feature = "std")]
mod vector;
#[cfg(feature = "std")]
pub mod watch;

/// The README's example, compiled and run with the other ones.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
