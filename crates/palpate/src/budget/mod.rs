//! Uncertainty budgets: from the uncertainties of input quantities to that of a result, by JCGM 100:2008 (GUM) and JCGM 101:2008.
//!
//! | file | what |
//! |---|---|
//! | `input.rs` | an input quantity: its estimate, standard uncertainty, distribution and evaluation |
//! | `propagation.rs` | the budget of a result: sensitivities, combined and expanded uncertainty |
//! | `monte_carlo.rs` | the same by propagation of distributions |

mod input;
mod monte_carlo;
mod propagation;

pub use input::{Cause, Distribution, Evaluation, InputError, InputQuantity};
pub use monte_carlo::{MonteCarlo, MonteCarloError, monte_carlo};
pub use propagation::{Budget, BudgetError, Contribution, Correlation, budget};
