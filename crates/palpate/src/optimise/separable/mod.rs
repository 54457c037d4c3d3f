//! Separable least squares: y ≈ Σ_l a_l c_l(θ), linear in a, nonlinear in the few numbers θ.
//!
//! Variable projection after Golub and Pereyra in Kaufman's form: at every θ the best a is solved for, and the
//! Gauss–Newton step in θ is taken with the part of the Jacobian that no change of a can imitate. Steps are damped
//! (Levenberg–Marquardt) and kept inside bounds. The residual is always formed explicitly, so that a noise-free
//! signal is fitted to rounding.
//!
//! | file | what |
//! |---|---|
//! | `target.rs` | what is fitted |
//! | `point.rs` | the model at one θ: columns, best linear numbers, residuals |
//! | `step.rs` | the Gauss–Newton step |
//! | `refine.rs` | damped steps from anywhere |
//! | `newton.rs` | undamped steps close to the optimum |
//! | `finish.rs` | where a search ended: from the last point to a solution with its errors |

mod finish;
mod newton;
mod point;
mod refine;
mod step;
mod target;

pub(crate) use finish::{Solution, standing};
pub(crate) use newton::{Near, curvature, descend, polished};
pub(crate) use point::{Shapes, Spare};
pub(crate) use refine::{Refined, refine};
pub(crate) use step::{distance, stepped, stepped_within};
pub(crate) use target::{Ending, Target};
