//! What a record shows against the law that was calibrated on it, in sentences.

use palpate::calibrate::{Misfit, RateLaw};

/// What is against the law of a material, what that means for its probabilities, and what helps.
#[must_use]
pub fn sentence_of_misfit(misfit: &Misfit, law: &str) -> String {
    match misfit {
        Misfit::Law { law: better, rate } => {
            let rate = match rate {
                RateLaw::Constant => "",
                RateLaw::ByStrain => " and the rate by strain",
                RateLaw::ByDirection => " and the rate by direction",
            };
            format!(
                "The record refutes this law: {misfit} describes it better than {law}. Probabilities and intervals count {law} as exact, and may miss by more than they state. What helps: calibrate with the law {better}{rate}."
            )
        }
        Misfit::Residuals => format!(
            "The law {law} misses part of the record that it was calibrated on, or the force drifts: the residuals follow a course. Probabilities and intervals count the law as exact, and may miss by more than they state. What helps: calibrate with another law, or on a record without a drift."
        ),
    }
}

/// What a probability rests on: a law that the record contradicts, and what is beyond the test; empty where on neither.
pub(super) fn condition(misfit: Option<&Misfit>, is_beyond: bool) -> &'static str {
    match (misfit, is_beyond) {
        (None, false) => "",
        (None, true) => ", if the law holds beyond the test",
        (Some(Misfit::Law { .. }), false) => ", by a law that the record refutes",
        (Some(Misfit::Law { .. }), true) => ", if a law that the record refutes holds beyond the test",
        (Some(Misfit::Residuals), false) => ", by a law that misses part of the record",
        (Some(Misfit::Residuals), true) => ", if a law that misses part of the record holds beyond the test",
    }
}
