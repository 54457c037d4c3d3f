//! What names and units of columns stand for, in the languages of headers.
//!
//! | file | what |
//! |---|---|
//! | `quantity.rs` | what a column of a record can hold ([`Quantity`]) |
//! | `vocabulary.rs` | the words that headers use for it |
//! | `unit_words.rs` | units as machines and people write them |
//! | `stated_units.rs` | lines of words that state the units of columns |
//! | `names.rs` | a name, weighed against the words |
//! | `rheometry.rs` | strain, torque and angle, moduli and compliances over time |
//! | `own_topics.rs` | the topics of the logs that palpate writes ([`own_topics`]) |

mod names;
pub mod own_topics;
mod quantity;
mod rheometry;
mod stated_units;
mod unit_words;
mod vocabulary;

pub(crate) use names::{
    is_named_in, last_unit, measured, measures_another, names_another, names_multiples_of, names_quantity,
    rank_of_name, topic_and_field, words,
};
pub use quantity::Quantity;
pub(crate) use rheometry::{is_strain_in, names_strain, names_true_measure, rank_in_rheometry};
pub(crate) use stated_units::stated_units;
pub use unit_words::unit_factor;
pub(crate) use unit_words::{is_share, is_unit_in_words, unit_behind_number, volts_are};
pub(crate) use vocabulary::{
    AXIAL, BENDING, COUNTS, EXTENSOMETERS, MEANS, NUMBERS, OF_A_PART, OTHER_CHARACTERS, RATES_OF_SHEAR, SHEAR,
    SHEAR_RATES, SIGNS_OF_LENGTH, STORAGE, STRAIN_GAUGES, STRAINS, UNCALIBRATED, VOCABULARY, WITHIN_A_TEST, is_listed,
    names_statistic, other_words,
};
