//! Law, samples and options made ready in the units of the fit.
//!
//! | file | what |
//! |---|---|
//! | `model.rs` | a law with its free parameters and their bounds, as columns of a separable model |
//! | `build.rs` | options checked against a law, and the model that they ask for |
//! | `condensed.rs` | a hold condensed to a few dozen nodes |
//! | `redundant.rs` | terms that a fit lists and the data do not have |

pub(crate) mod build;
pub(crate) mod condensed;
pub(crate) mod model;
pub(crate) mod redundant;

pub(super) use build::build;
pub(crate) use condensed::Condensed;
pub(super) use condensed::{condense, condense_to};
pub(super) use model::{Model, ModelParameter, Sampled, searched_name};
pub use redundant::RedundantTerm;
pub(super) use redundant::redundant_terms;
