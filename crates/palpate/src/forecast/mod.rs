//! The law to use: laws compared by their held-out errors and their parameters.
//!
//! | file | what |
//! |---|---|
//! | `criteria.rs` | AICc and BIC; forward score: fit the first part of the hold, predict the rest |
//! | `options.rs`, `result.rs` | options and results |
//! | `compare.rs` | all laws on one hold, ranked |
//! | `stacked/` | what the hold will show next, from all laws together |
//! | `confidence_set.rs` | the laws that a test of their forecasts does not distinguish from the best |
//! | `probability.rs` | how probable it is that none predicts better |
//! | `pooled.rs` | the law for all holds of a record together |
//! | `verdict.rs` | the law to use, its certainty, the cost of others |
//! | `sentence.rs` | that in one sentence |

mod compare;
mod confidence_set;
mod criteria;
mod options;
mod pooled;
mod probability;
mod result;
mod sentence;
mod stacked;
mod verdict;

pub(crate) use compare::change;
pub use compare::{KnownFit, compare_laws, compare_laws_watched};
pub use criteria::{Criteria, ForwardScore, criteria};
pub use options::{CompareOptions, RampChoice};
pub use pooled::{PooledVerdict, pooled};
pub use result::{Certainty, Comparison, Ranking, Reservation, Row, Verdict};
pub(crate) use sentence::listed;
pub use sentence::name_in_words;
pub use stacked::{Combination, ForecastMember, Forecasted, HoldForecast, TriedHold};
pub(crate) use verdict::REFUTED;
