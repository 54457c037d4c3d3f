//! Results with what people need beside them: where they come from, and what they say in words.
//!
//! The jobs make them from results of the library. `document` writes them as JSON, `study` as tables, figures and pages; neither changes
//! them.
//!
//! | file | what |
//! |---|---|
//! | `input.rs` | where a record came from |
//! | `parameters.rs` | parameters of laws with units and uncertainty, and their tidy table |
//! | `answer.rs` | which law for a record and its holds |
//! | `compared.rs` | laws compared on the holds of a record |
//! | `calibrated.rs` | laws calibrated on a record, with remarks |
//! | `budget.rs` | uncertainty budgets of results |
//! | `calibrated_batch.rs` | several records calibrated together, with remarks |
//! | `gripped.rs`, `grip_sentences.rs` | a body in a gripper with an answer; the answer in sentences |
//! | `misfit.rs` | what a record shows against the law of its material, in sentences |
//! | `tried.rs` | a squeeze that is tried, with its verdict |
//! | `specimens.rs` | records of several specimens: one law, its parameters between specimens |
//! | `words.rs` | the words for what the library says |

mod answer;
mod budget;
mod calibrated;
mod calibrated_batch;
mod compared;
mod grip_sentences;
mod gripped;
mod input;
mod misfit;
mod parameters;
mod specimens;
mod tried;
mod words;

pub use crate::word::word;
pub(crate) use answer::law_of_record;
pub use answer::{Answer, HoldAnswer, formula};
pub use budget::{BudgetedResult, budgets_of_analysis, budgets_of_material};
pub use calibrated::{CalibratedRecord, formula_of_material};
pub use calibrated_batch::CalibratedBatch;
pub use compared::{ComparedHold, ComparedRecord, LeftOut, Quantity};
pub(crate) use compared::{displacement_held, held_at, travel};
pub(crate) use grip_sentences::{chance, lasted};
pub use gripped::GrippedBody;
pub use input::Input;
pub use misfit::sentence_of_misfit;
pub use parameters::{
    MIXED_EXPONENTS, PARAMETER_COLUMNS, ParameterColumn, ParameterDocument, ParameterRow, Parameters,
    depends_on_exponent, parameter_title, parameters_of, parameters_of_material, parameters_table, si_unit,
};
pub(crate) use specimens::is_scale;
pub use specimens::{BetweenSpecimens, SpecimenHold, SpecimenResult, SpecimenResults};
pub use tried::TriedSqueeze;
pub(crate) use words::{hold_start_word, percent};
pub use words::{mode_word, slips_word};
