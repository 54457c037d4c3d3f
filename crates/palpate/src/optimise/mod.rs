//! Minimisers and the small linear algebra under them. They know numbers, bounds and residuals, and nothing of laws.
//!
//! Who comes in: `fit` with the columns of a law, `calibrate` with forces from a simulation. What goes out: numbers, what they leave of
//! the signal, and why the search ended.
//!
//! | file | what |
//! |---|---|
//! | `cholesky.rs`, `elimination.rs` | factors of small symmetric matrices; small systems that are not symmetric |
//! | `effort.rs` | what a search has done so far, and who may end it |
//! | `bounded.rs` | linear least squares with bounds: a method of active sets |
//! | `separable/` | nonlinear least squares with the linear numbers projected out and bounds on all: damped steps |
//! | `orthogonal.rs` | the same model with orthogonal columns, where normal equations lose digits |
//! | `minimum.rs` | a function of one or two numbers that is known by its values alone |
//! | `termination.rs` | why a search ended, and what it cost |
//!
//! One of each kind. `bounded.rs` ends after finitely many sets of bounds and is exact, but solves linear problems only. Damped steps
//! need derivatives of the residuals; a likelihood has none, so `minimum.rs` takes values. The step itself stands once, in
//! `separable/step.rs`: `fit/joint` takes it on the system that is left when every hold's own numbers are eliminated.

mod bounded;
mod cholesky;
mod effort;
mod elimination;
mod minimum;
mod orthogonal;
mod separable;
mod termination;

pub(crate) use bounded::{BoundedProblem, BoundedSolver, Held};
pub(crate) use cholesky::{Cholesky, Few, Square};
pub(crate) use effort::Effort;
pub(crate) use elimination::{LinearFit, eliminate, fit_linear};
pub(crate) use minimum::{Level, Minimum, minimise};
pub(crate) use orthogonal::Orthogonal;
pub(crate) use separable::{
    Ending, Near, Refined, Shapes, Solution, Spare, Target, curvature, descend, distance, polished, refine, standing,
    stepped, stepped_within,
};
pub use termination::{Termination, Work};
