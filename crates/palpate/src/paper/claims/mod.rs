//! Every equation, figure, table and statement of the paper, with its comparisons.
//!
//! | file | what |
//! |---|---|
//! | `equations.rs` | equations (1) to (11) |
//! | `figures.rs` | figures 1 to 8 and tables I and II |
//! | `laboratories.rs` | what laboratories would have concluded |
//! | `statements.rs` | what the text states |
//! | `record.rs` | what the paper concludes, on a record of one's own |

mod equations;
mod figures;
mod laboratories;
mod record;
mod statements;

pub use record::record_claims;

use super::{Claim, Reproduction, Verdict};

/// All claims: what is not reproduced first, then what is, then what cannot be checked; in the order of the paper within each.
pub(super) fn claims(study: &Reproduction) -> Vec<Claim> {
    let mut all = statements::abstract_and_introduction(study);
    all.extend(equations::claims(study));
    all.extend(figures::claims(study));
    all.extend(statements::experiments(study));
    all.extend(statements::simulation(study));
    sorted(all)
}

/// A displacement (m) in mm, without digits that only rounding has.
fn millimetres(displacement: f64) -> String {
    format!("{}", (1e6 * displacement).round() / 1e3)
}

fn sorted(mut claims: Vec<Claim>) -> Vec<Claim> {
    claims.sort_by_key(|claim| match claim.verdict() {
        Verdict::NotReproduced => 0,
        Verdict::Reproduced => 1,
        Verdict::CannotBeChecked => 2,
    });
    claims
}

#[cfg(test)]
pub(super) use {equations::strain_error, figures::half_travel};
