//! Errors and intervals of a material.
//!
//! | file | what |
//! |---|---|
//! | `assessed.rs` | parameters with their errors, from the noise and all that follows |
//! | `beyond.rs` | what neither displacement nor instrument explain of the residuals |
//! | `displacement.rs` | what the noise of the displacement adds |
//! | `systematic.rs` | what the uncertainty of the instrument and of the body adds |

mod assessed;
mod beyond;
mod displacement;
mod systematic;

pub(super) use assessed::{AssessedMaterial, FARTHEST};
pub(super) use displacement::from_displacement;
