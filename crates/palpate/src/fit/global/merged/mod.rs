//! Local searches where terms of a series merge, or all but imitate each other.
//!
//! | file | what |
//! |---|---|
//! | `confluent.rs` | divided differences in place of columns that imitate each other |
//! | `apart.rs` | where a search ended, merged rates taken apart as far as doubles need |
//! | `exact.rs` | the search |

pub(crate) mod apart;
mod confluent;
pub(crate) mod exact;

pub(super) use apart::{Valley, rounding};
pub(in crate::fit) use exact::local;
pub(super) use exact::{exact, inflation};

use crate::fit::{Model, RedundantTerm, redundant_terms};
use crate::optimise::{Solution, Termination};

/// Says so if what ended well, or could not be distinguished, are merged terms.
pub(super) fn mark_merged(model: &Model, solution: &mut Solution) {
    let open = matches!(solution.termination, Termination::Converged | Termination::Singular);
    if open && redundant_terms(model, solution).iter().any(|term| matches!(term, RedundantTerm::Merged { .. })) {
        solution.termination = Termination::TermsMerged;
    }
}
